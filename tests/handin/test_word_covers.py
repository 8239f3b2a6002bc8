"""Text under a picture or a filled box is no part of a report; whoever leaves room for a picture loses nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.handin import word_report
from tests.handin import wml
from tests.handin.test_word_reading import HERE, PLACE, key, line

WP = "http://schemas.openxmlformats.org/drawingml/2006/wordprocessingDrawing"
A = "http://schemas.openxmlformats.org/drawingml/2006/main"
PIC = "http://schemas.openxmlformats.org/drawingml/2006/picture"
WPS = "http://schemas.microsoft.com/office/word/2010/wordprocessingShape"
PICTURE = f'<pic:pic xmlns:pic="{PIC}"><pic:spPr/></pic:pic>'
BOX = f'<wps:wsp xmlns:wps="{WPS}"><wps:spPr>{{fill}}</wps:spPr>{{text}}</wps:wsp>'
FILLED = BOX.format(fill="<a:solidFill/>", text="")
EMPTY = BOX.format(fill="<a:noFill/>", text="")
WRITTEN = BOX.format(
    fill="<a:solidFill/>", text=f"<wps:txbx><w:txbxContent>{line('v_D = 0,25 m/s')}</w:txbxContent></wps:txbx>"
)
VALUE = line("v_D = 0,25 m/s")


def anchored(
    shape: str = PICTURE,
    *,
    wide: float = 160.0,
    high: float = 60.0,
    down: float = 0.0,
    across: float = 0.0,
    behind: int = 0,
    wrap: str = "wrapNone",
    by: str = "paragraph",
) -> str:
    """A paragraph at which a shape of so many mm is anchored, that many mm below and beside it."""
    emu = [round(36_000 * one) for one in (wide, high, down, across)]
    return wml.paragraph(
        f'<w:r><w:drawing><wp:anchor xmlns:wp="{WP}" xmlns:a="{A}" behindDoc="{behind}">'
        f'<wp:positionH relativeFrom="column"><wp:posOffset>{emu[3]}</wp:posOffset></wp:positionH>'
        f'<wp:positionV relativeFrom="{by}"><wp:posOffset>{emu[2]}</wp:posOffset></wp:positionV>'
        f'<wp:extent cx="{emu[0]}" cy="{emu[1]}"/><wp:{wrap}/>'
        f"<a:graphic><a:graphicData>{shape}</a:graphicData></a:graphic></wp:anchor></w:drawing></w:r>"
    )


TABLE = wml.table(
    [[wml.cell(wml.run(one)) for one in ("Điểm", "v, m/s")], [wml.cell(wml.run(one)) for one in ("D", "0,25")]], 2
)


@pytest.mark.parametrize(
    ("body", "seen"),
    [
        (anchored() + VALUE, False),
        (anchored(FILLED) + VALUE, False),
        (VALUE + anchored(down=-6.0), False),
        (anchored() + TABLE, False),
        (TABLE, True),
        # Honest ones: with wrapping, behind, without a colour, beside the text, small, with room left, high above.
        (anchored(wrap="wrapTopAndBottom") + VALUE, True),
        (anchored(wrap="wrapSquare") + VALUE, True),
        (anchored(behind=1) + VALUE, True),
        (anchored(EMPTY) + VALUE, True),
        (anchored(across=90.0, wide=70.0) + VALUE, True),
        (anchored(wide=20.0, high=10.0) + VALUE, True),
        (anchored() + 14 * line("") + VALUE, True),
        (anchored(high=30.0, down=-35.0) + VALUE, True),
        (anchored(WRITTEN), True),
    ],
)
def test_what_lies_under_something_is_not_read_and_told(body: str, seen: bool) -> None:
    reading = word_report.read(Path("r.docx"), wml.package(HERE + body + 16 * line("") + line("a_D = 3 m/s²")), key())
    assert ("a.D", 2) in reading.values
    assert (PLACE in reading.values) == seen
    assert reading.unseen == (frozenset() if seen else {PLACE})
    assert [note.code for note in reading.notes] == ([] if seen else ["word-unseen"])
