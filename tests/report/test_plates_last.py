"""Figures on paper larger than A4 stand together at the end of their chapter."""

from __future__ import annotations

from reportgen.document import Paragraph, Plate, Section, Text
from reportgen.document.layout import plates_last
from reportgen.drawing import Scene


def heading(level: int) -> Section:
    return Section(level, (Text("A heading"),))


def plate(key: str, continues: bool = False) -> Plate:
    return Plate(Scene(300.0, 200.0, ()), (420.0, 297.0), key=key, continues=continues)


def said(one: Plate) -> Paragraph:
    return Paragraph((Text(one.key),))


def test_plates_stand_together_at_the_end_of_their_chapter() -> None:
    """No page of text ends early for a plate within a chapter; where it was called for, the text says where it is."""
    a, b, more, c = plate("a"), plate("b"), plate("", continues=True), plate("c")
    chapter, section, text = heading(1), heading(2), Paragraph((Text("text"),))
    blocks = [chapter, section, a, text, section, b, more, text, chapter, c, section]
    assert list(plates_last(blocks, said)) == [
        *(chapter, section, said(a), text, section, said(b), text),
        *(a, b, more),
        *(chapter, said(c), section),
        c,
    ]
