"""What the tests of tables share: the texts of a page, a refusal, and workbooks put together by hand."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from pathlib import Path

import pytest

from reportgen.base.errors import AssignmentError
from reportgen.workbook import Book, Entry, Page, WorksheetData, read

CYNICAL = ("=cmd|' /C calc'!A0", "+1+1", "-2+3", "@SUM(A1)", "\t=1", '=HYPERLINK("http://x")', "'=1", "＝1")
"""Texts that a spreadsheet would take for formulas."""

BOOK = Book(
    (
        WorksheetData(
            "Điểm: 1/2",
            (
                (Entry("Họ tên", "head"), Entry("n", "head", comment="rpm")),
                *((Entry(text), -1.25) for text in CYNICAL),
                (Entry(None, "input", unlocked=True), Entry(0.5, "good", format="0.00")),
                ("#DIV/0!", "_x0041_"),
                ("a\x01b", 12),
            ),
            widths=(30, 8),
            frozen=(1, 1),
            protected=True,
        ),
        WorksheetData("điểm_ 1_2", (("x",),), hidden=True),
    ),
    title="=1",
)


def texts(page: Page) -> list[list[str]]:
    return [[cell.text for cell in row] for row in page.rows]


def refusal(path: Path) -> str:
    with pytest.raises(AssignmentError) as caught:
        read(path, "en")
    (problem,) = caught.value.problems
    return str(problem).replace(str(path), "FILE").splitlines()[0].rpartition("]")[0] + "]"


# --- packages put together by hand -----------------------------------------------------------------

TYPES = "http://schemas.openxmlformats.org/package/2006/content-types"
REL = "http://schemas.openxmlformats.org/package/2006/relationships"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
BOOK_TYPE = "application/vnd.openxmlformats-officedocument.spreadsheetml"
ROWS = '<row r="1"><c r="A1" t="inlineStr"><is><t>id</t></is></c></row>'


def relation(kind: str, target: str, id: str = "r1", mode: str = "") -> str:
    outside = f' TargetMode="{mode}"' if mode else ""
    return f'<Relationship Id="{id}" Type="{OFFICE}/{kind}" Target="{target}"{outside}/>'


def package(rows: str = ROWS, more: Mapping[str, str | bytes] | None = None, prologue: str = "") -> bytes:
    """The least workbook: one sheet "S" with the given rows."""
    with_strings = "xl/strings.xml" in (more or {})
    parts: dict[str, str | bytes] = {
        "[Content_Types].xml": f'<Types xmlns="{TYPES}">'
        f'<Override PartName="/xl/workbook.xml" ContentType="{BOOK_TYPE}.sheet.main+xml"/>'
        + f'<Override PartName="/xl/strings.xml" ContentType="{BOOK_TYPE}.sharedStrings+xml"/>' * with_strings
        + "</Types>",
        "_rels/.rels": f'<Relationships xmlns="{REL}">{relation("officeDocument", "xl/workbook.xml")}</Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}"><sheets>'
        '<sheet name="S" sheetId="1" r:id="r1"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{REL}">{relation("worksheet", "worksheets/s.xml")}'
        f"{relation('styles', 'styles.xml', 'r2')}{relation('sharedStrings', 'strings.xml', 'r3')}</Relationships>",
        "xl/worksheets/s.xml": f'{prologue}<worksheet xmlns="{MAIN}"><dimension ref="A1:A1"/>'
        f"<sheetData>{rows}</sheetData></worksheet>",
        **(more or {}),
    }
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as made:
        for name, content in parts.items():
            made.writestr(name, content)
    return stream.getvalue()


def rels(kind: str, target: str, mode: str = "External") -> str:
    return f'<Relationships xmlns="{REL}">{relation(kind, target, mode=mode)}</Relationships>'


STYLES = (
    f'<styleSheet xmlns="{MAIN}"><numFmts count="2"><numFmt numFmtId="170" formatCode="dd\\/mm\\/yyyy"/>'
    '<numFmt numFmtId="171" formatCode="&quot;day&quot; 0.0"/></numFmts><cellXfs count="4"><xf numFmtId="0"/>'
    '<xf numFmtId="14"/><xf numFmtId="170"/><xf numFmtId="171"/></cellXfs></styleSheet>'
)
STRINGS = (
    f'<sst xmlns="{MAIN}"><si><t>Anh</t></si><si><r><t>Ngọc </t></r><r><t>Hà</t></r><rPh sb="0" eb="1"><t>no</t></rPh>'
    "</si><si><t>a_x000D_b</t></si></sst>"
)
HALF = "".join(f'<xf s="{k * 7919 % 99991}"/>' for k in range(70_000))
SPREAD = HALF * 2
"""More than is held at once, and less than a hundred times its packed size."""
TWICE = (
    f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}"><sheets><sheet name="S" sheetId="1" r:id="r1"/>'
    '<sheet name="T" sheetId="2" r:id="r1"/></sheets></workbook>'
)


def bordered(count: int) -> bytes:
    """A workbook with two values, and a border drawn round so many rows of a hundred columns below them."""
    letters = [f"{first}{second}" for first in "ABCDE" for second in "ABCDEFGHIJKLMNOPQRST"]
    rows = "".join(
        f'<row r="{row}">' + "".join(f'<c r="{column}{row}" s="1"/>' for column in letters) + "</row>"
        for row in range(2, count + 2)
    )
    first = '<row r="1"><c r="A1" t="inlineStr"><is><t>id</t></is></c><c r="B1" s="1"></c><c r="C1"><v>7</v></c></row>'
    return package(first + rows)
