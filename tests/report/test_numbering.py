"""Numbers of a finished tree and the references to them."""

from __future__ import annotations

import pytest

from reportgen.base.errors import DocumentError
from reportgen.document import (
    Block,
    Cell,
    Column,
    Document,
    Emph,
    Equation,
    Figure,
    Inlines,
    List,
    Paragraph,
    Plate,
    Reference,
    Section,
    Table,
    Text,
    Words,
    text_of,
)
from reportgen.document.numbering import number, unreferenced
from reportgen.drawing import Scene
from reportgen.formula import Symbol

X = Symbol("x")
SCENE = Scene(10, 10)
WORDS = Words("Figure", "Table", "Contents", "page", "continued", "part {part}", "Save figure")


def document(*blocks: Block) -> Document:
    return Document("en", "T", "A", ("", ""), ("", ""), WORDS, blocks)


def title(text: str) -> Inlines:
    return (Text(text),)


def see(*keys: str) -> Paragraph:
    return Paragraph(tuple(Reference(key) for key in keys))


def table(key: str = "", *cells: Inlines, caption: Inlines = ()) -> Table:
    return Table(
        (Column(10),), ((Cell(cells[0]),),) if cells else (), tuple((Cell(c),) for c in cells[1:]), caption, key
    )


def numbers(*blocks: Block) -> list[str]:
    return [block.number for block in number(document(*blocks)).blocks if hasattr(block, "number")]


def test_sections_count_by_level() -> None:
    levels = (1, 2, 3, 3, 4, 2, 3, 1, 2)
    assert numbers(*(Section(level, title("s")) for level in levels)) == [
        *("1", "1.1", "1.1.1", "1.1.2", "", "1.2", "1.2.1", "2", "2.1")
    ]


def test_an_unnumbered_part_does_not_count_nor_do_the_sections_in_it() -> None:
    foreword, hidden = Section(1, title("f"), numbered=False), Section(2, title("h"), numbered=False)
    found = numbers(foreword, Section(2, title("s")), Section(1, title("1")), hidden, Section(3, title("s")),
                    Section(2, title("s")), foreword, Section(1, title("2")))  # fmt: skip
    assert found == ["", "", "1", "", "", "1.1", "", "2"]


def test_each_kind_counts_by_part_and_plates_are_figures() -> None:
    part, equation = Section(1, title("p")), [Equation((X,), key) for key in "abcd"]
    found = numbers(
        see(*"abcd"), part, equation[0], Figure((SCENE,), title("f")), Plate(SCENE, (420, 297), title("p")),
        table("t"), Section(2, title("s")), equation[1], Figure((SCENE,), key="g"), Equation((X,)),
        Figure((SCENE,)), part, equation[2], table("u"), Section(1, title("end"), numbered=False),
        equation[3], table("v"),
    )  # fmt: skip
    assert found == [
        *("1", "1.1", "1.1", "1.2", "1.1", "1.1", "1.2", "1.3", "", ""),
        *("2", "2.1", "2.1", "", "1", "1"),
    ]


def test_parts_without_a_number_share_one_count() -> None:
    aside = Section(1, title("a"), numbered=False)
    part = Section(1, title("p"))
    assert numbers(aside, table("a"), part, table("b"), aside, table("c")) == ["", "1", "1", "1.1", "", "2"]


def test_references_are_filled_wherever_words_stand() -> None:
    line: Inlines = (Text("see "), Emph((Reference("e"),)))
    blocks = (
        Section(1, line, "s"),
        Paragraph(line),
        List(((Paragraph(line), Equation((X,), "e")), (see("s", "t", "f"),))),
        table("t", line, line, caption=line),
        Figure((SCENE,), line, "f"),
        Plate(SCENE, (1, 1), line),
    )
    text = text_of(number(document(*blocks)))
    assert text.splitlines() == [
        *("1 see (1.1)", "see (1.1)", "• see (1.1)", "  x  (1.1)", "• 11.11.1"),
        *("Table 1.1. see (1.1)", "see (1.1)", "see (1.1)"),
        *("Figure 1.1. see (1.1)", "Figure 1.2. see (1.1)"),
    ]


def test_a_section_without_a_number_is_referred_to_by_its_title() -> None:
    blocks = (Section(1, title("Conclusion"), "end", numbered=False), see("end"))
    assert text_of(number(document(*blocks))) == "Conclusion\nConclusion\n"


def test_numbering_twice_changes_nothing() -> None:
    once = number(document(Section(1, title("a"), "s"), Equation((X,), "e"), see("e", "s")))
    assert number(once) == once


def test_all_that_does_not_hold_together_is_told_at_once() -> None:
    blocks = (
        Section(1, title("a"), "s"), Section(3, title("b"), "s"), Equation((X,), "unused"),
        List(((table("t", (Reference("lost"),)),),)), Figure((SCENE,), (Reference("gone"),), "t"),
    )  # fmt: skip
    with pytest.raises(DocumentError) as caught:
        number(document(*blocks))
    assert caught.value.faults == (
        "a heading of level 3 follows one of level 1",
        "two blocks have the key 's'",
        "two blocks have the key 't'",
        "a reference to 'lost', which is not in the document",
        "a reference to 'gone', which is not in the document",
        "nothing refers to the equation 'unused'",
    )


def test_figures_and_tables_that_no_text_refers_to_are_listed() -> None:
    plate = Plate(SCENE, (1, 1), key="p")
    whole = document(table("t"), Figure((SCENE,), key="f"), List(((plate, table("u")),)), see("t", "p"))
    assert unreferenced(whole) == ("f", "u")
