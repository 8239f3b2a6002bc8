"""One thing in a YAML text changed: all other characters stay, and what comes out is read as it was meant."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from reportgen import catalogue
from reportgen.base.errors import Location, Where
from reportgen.base.yaml_edit import EditError, as_list, exchanged, with_value, without
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, plain, read_text
from reportgen.base.yaml_values import at
from tests.kinds import KINDS
from tests.lanes import matrix

TEXT = """\
# head
kind: shaper
report: {language: en, student: {name: , id: }}   # cover
# drawing: {crank: 30 mm}     # on paper
parameters:
  a: 270 mm      # AC
  H: 420 mm
  # G3: 200 N    # rocker
  cutting:
    F: 1000 N

parts:
  - kind: cam
    variant: 1
  - {file: pair.yaml, title: "Gears: first"}
"""


def said(text: str, where: Where, value: str) -> str:
    return with_value(text, where, Scalar(value, Location("")))


@pytest.mark.parametrize(
    ("where", "value", "old", "new"),
    [
        (("parameters", "a"), "275 mm", "a: 270 mm", "a: 275 mm"),
        (("report", "student", "name"), "Ngô An", "name: , id", "name: Ngô An, id"),
        (("report", "student", "class"), "K57", "id: }}", "id: , class: K57}}"),
        (("report", "course"), "a # b: c", "id: }}", 'id: }, course: "a # b: c"}'),
        (("parameters", "G3"), "210 N", "# G3: 200 N", "G3: 210 N"),
        (("drawing", "crank"), "40 mm", "# drawing: {crank: 30 mm}", "drawing: {crank: 40 mm}"),
        (("parameters", "cutting", "free"), "0.05", "F: 1000 N\n", "F: 1000 N\n    free: 0.05\n"),
        (("parameters", "flywheel", "delta"), "1/50", "F: 1000 N\n", "F: 1000 N\n  flywheel: {delta: 1/50}\n"),
        (("parts", 1, "title"), "Bánh răng", '"Gears: first"', '"Bánh răng"'),
        (("parts", 0, "variant"), "2\n3", "variant: 1", 'variant: "2\\n3"'),
    ],
)
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_a_value_is_put_in_its_place(where: Where, value: str, old: str, new: str, newline: str) -> None:
    text, changed = (one.replace("\n", newline) for one in (TEXT, TEXT.replace(old, new)))
    assert said(text, where, value) == changed


@pytest.mark.parametrize(
    ("where", "old", "new"),
    [
        (("parameters", "H"), "  H: 420 mm", "  # H: 420 mm"),
        (("report", "language"), "{language: en, student", "{student"),
        (("report", "student", "id"), "name: , id: }", "name: }"),
        (("parameters", "cutting"), "  cutting:\n    F: 1000 N\n", ""),
        (("parts", 0), "  - kind: cam\n    variant: 1\n", ""),
        (("parts", 0, "kind"), "kind: cam\n    variant", "variant"),
    ],
)
def test_a_key_or_an_item_is_taken_out(where: Where, old: str, new: str) -> None:
    assert without(TEXT, where) == TEXT.replace(old, new, 1)


def test_what_was_taken_out_comes_back_as_it_was() -> None:
    assert said(without(TEXT, ("parameters", "H")), ("parameters", "H"), "420 mm") == TEXT


def test_only_a_choice_of_its_table_keeps_a_comment_aside() -> None:
    text = "a:\n  by: b\n  # G3: 200 N  # source: book\n  # F: 5 N  # by: c\n"
    assert said(text, ("a", "G3"), "210 N") == text.replace("# G3: 200", "G3: 210")
    assert said(text, ("a", "F"), "7 N") == text.replace("by: b\n", "by: b\n  F: 7 N\n")


def test_a_comment_of_several_lines_is_one_entry() -> None:
    text = "a:\n  b: 1\n  # cutting:   # of the tool\n  #   F: 1 N\n  #   free: 0.05\n"
    changed = "a:\n  b: 1\n  cutting:   # of the tool\n    F: 2 N\n    free: 0.05\n"
    assert said(text, ("a", "cutting", "F"), "2 N") == changed


def test_long_comments_that_are_no_entry_are_read_soon() -> None:
    text = "a:\n  b: 1\n  # rows: [\n" + "  #   [1, 2\n" * 2000
    assert "\n  c: 2\n" in said(text, ("a", "c"), "2")


def test_remarks_that_are_set_deeper_stay_with_their_table() -> None:
    """A new section, a new item stand behind them; a remark of the whole file, and a blank line, is no table's."""
    text = "parameters:\n  a: 270 mm\n\n  # G3: 200 N\n\n# end\n"
    assert said(text, ("variant",), "3") == text.replace("N\n\n# end", "N\nvariant: 3\n\n# end")
    assert said(said(text, ("variant",), "3"), ("parameters", "G3"), "2 N").count("  G3: 2 N\n") == 1
    text = "parts:\n- a: 1\n  # b: 2\n# end"
    assert said(text, ("parts", 1), "3") == text.replace("# end", "- 3\n# end")


def test_items_change_places() -> None:
    changed = plain(read_text(exchanged(TEXT, ("parts",), 0)).top)  # type: ignore[arg-type]
    assert [part.get("kind") for part in changed["parts"]] == [None, "cam"]
    assert exchanged(exchanged(TEXT, ("parts",), 0), ("parts",), 0) == TEXT


def test_comments_of_an_item_go_with_it() -> None:
    text = "a:\n  - b: 1\n    # c: 2\n  - b: 3\n"
    assert without(text, ("a", 0)) == "a:\n  - b: 3\n"
    assert exchanged(text, ("a",), 0) == "a:\n  - b: 3\n  - b: 1\n    # c: 2\n"
    assert without("a:\n  - {b: 1}\n    # c: 2\n# end\n", ("a", 0)) == "a: []\n# end\n"


def test_what_is_set_aside_in_a_table_goes_with_it() -> None:
    """Comments beside the key stay, and the one of a key above the last item that goes."""
    text = "a:\n  # of b\n  b:  # two\n    by: x\n    # c: 2  # by: y\n  # of d\n  d: 1\n"
    assert without(text, ("a", "b")) == "a:\n  # of b\n  # of d\n  d: 1\n"
    assert without(text.replace("  # of d\n  d: 1\n", ""), ("a", "b")) == "a:\n  # of b\n"
    text = "a:  # parts: two\n  # the first\n  - b: 1\nc: 2\n"
    assert without(text, ("a", 0)) == "a: []  # parts: two\n  # the first\nc: 2\n"
    text = "a:\n- by: x  # how\n  # c: 2  # by: y\n  d:\n  - 1\n  e: 3\n"
    assert without(text, ("a", 0, "by")) == "a:\n- d:\n  - 1\n  # c: 2  # by: y\n  e: 3\n"


def test_entries_in_braces_keep_the_comments_between_them() -> None:
    text = "a: {b: 1,  # one\n    c: 2,  # two\n    d: 3  # three\n  }\n"
    assert without(text, ("a", "c")) == "a: {b: 1,  # one\n      # two\n    d: 3  # three\n  }\n"
    assert without(text, ("a", "d")) == "a: {b: 1,  # one\n    c: 2  # two\n      # three\n  }\n"
    assert said(text, ("a", "e"), "4") == text.replace("d: 3  # three", "d: 3,  # three\n    e: 4")
    assert said("a: {b: 1, }\n", ("a", "c"), "2") == "a: {b: 1, c: 2, }\n"


def test_lists() -> None:
    text = "a: [1, 2]\nb:\n  - 1\n"
    assert with_value(text, ("a",), as_list("3, 4 mm")) == "a: [3, 4 mm]\nb:\n  - 1\n"
    assert said(text, ("b", 1), "2") == "a: [1, 2]\nb:\n  - 1\n  - 2\n"
    assert said(text, ("a", 2), "3") == "a: [1, 2, 3]\nb:\n  - 1\n"
    with pytest.raises(EditError):
        as_list("1], c: [2")


@pytest.mark.parametrize("text", ["", "a: [1", "- 1", "a: 1\n b: 2"])
def test_what_is_no_table_is_left(text: str) -> None:
    with pytest.raises(EditError):
        said(text, ("a",), "2")


def places(node: Node, where: Where = ()) -> Iterator[tuple[Where, Scalar]]:
    match node:
        case Scalar():
            yield where, node
        case SequenceNode(items):
            for index, item in enumerate(items):
                yield from places(item, (*where, index))
        case MappingNode(entries):
            for key, value in entries:
                yield from places(value, (*where, key.text))


@pytest.mark.parametrize("kind", matrix(KINDS, ("shaper", "linkage")))
def test_every_value_of_a_file_to_begin_with(kind: str) -> None:
    """Each value of a sample can be another one and its own again, byte for byte; and no other is touched by it."""
    text = catalogue.sample(kind, "vi")
    top = read_text(text).top
    assert top is not None
    for where, scalar in list(places(top))[:: 1 if kind == "shaper" else 5]:
        changed = said(text, where, "95 mm")
        read = at(read_text(changed).top, where)
        assert isinstance(read, Scalar)
        assert (read.text, read.quoted) == ("95 mm", scalar.quoted)
        if not scalar.null:
            back = with_value(changed, where, scalar)
            assert back == text
