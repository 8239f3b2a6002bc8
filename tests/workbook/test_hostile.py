"""Hostile and damaged workbooks are refused, with no other exception and before they take room or time."""

from __future__ import annotations

import contextlib
import io
import re
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reportgen.base.errors import AssignmentError
from reportgen.workbook import Page, read, write_xlsx
from tests.workbook.tables import (
    BOOK,
    HALF,
    MAIN,
    REL,
    SPREAD,
    STRINGS,
    STYLES,
    TWICE,
    TYPES,
    bordered,
    package,
    refusal,
    rels,
)

ENTITY = '<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]>'
HOSTILE = {
    "no zip": (b"PK\x03\x04 nothing", "sheet-no-zip"),
    "text": (b"id,name\n", "sheet-no-zip"),
    "no workbook": (package(more={"_rels/.rels": f'<Relationships xmlns="{REL}"/>'}), "sheet-no-zip"),
    "old": (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600), "sheet-old"),
    "encrypted": (b"\xd0\xcf\x11\xe0" + bytes(60) + "EncryptedPackage".encode("utf-16-le"), "sheet-encrypted"),
    "bomb": (package(more={"xl/media/a.xml": b" " * 61_000_000}), "sheet-bomb"),
    "ratio": (package("<row/>" * 500_000), "sheet-bomb"),
    "parts": (package(more={f"xl/a{k}.txt": "" for k in range(2100)}), "sheet-bomb"),
    "macros": (package(more={"xl/vbaProject.bin": b"x"}), "sheet-macros"),
    "old macros": (package(more={"xl/macrosheets/sheet1.xml": "<x/>"}), "sheet-macros"),
    "macro type": (
        package(
            more={
                "[Content_Types].xml": f'<Types xmlns="{TYPES}"><Override PartName="/xl/workbook.xml" '
                'ContentType="application/vnd.ms-excel.sheet.macroEnabled.main+xml"/></Types>'
            }
        ),
        "sheet-macros",
    ),
    "external link": (package(more={"xl/externalLinks/externalLink1.xml": "<x/>"}), "sheet-links"),
    "connection": (package(more={"xl/connections.xml": "<x/>"}), "sheet-links"),
    "template": (package(more={"xl/_rels/a.xml.rels": rels("attachedTemplate", "http://x")}), "sheet-links"),
    "entities": (package("&b;", prologue=ENTITY), "sheet-entities"),
    "entities elsewhere": (package(more={"docProps/core.xml": f"{ENTITY}<x>&b;</x>"}), "sheet-entities"),
    "entities in UTF-16": (package(more={"docProps/core.xml": f"{ENTITY}<x/>".encode("utf-16")}), "sheet-entities"),
    "broken XML": (package("<row>"), "sheet-damaged"),
    "missing string": (package('<row><c t="s"><v>7</v></c></row>'), "sheet-damaged"),
    "no number": (package("<row><c><v>1e999</v></c></row>"), "sheet-damaged"),
    "no reference": (package('<row><c r="XXXX1"><v>1</v></c></row>'), "sheet-damaged"),
    "wide": (package('<row r="1"><c r="XFD1"><v>1</v></c></row>'), "table-too-large"),
    "low": (package('<row r="1048576"><c r="A1048576"><v>1</v></c></row>'), "table-too-large"),
    "sparse": (package("".join(f'<row><c r="SF{k}"><v>1</v></c></row>' for k in range(1, 999))), "table-too-large"),
    "one endless row": (package(f"<row>{SPREAD}</row>"), "sheet-bomb"),
    "endless outside of rows": (package(f"{SPREAD}<row/>"), "sheet-bomb"),
    "endless between rows": (package(f"<row/>{HALF}" * 2), "sheet-bomb"),
    "endless inside rows of another kind": (package(f"<x:row xmlns:x='x'>{HALF}</x:row>" * 2), "sheet-bomb"),
    "too many rows with a style": (
        package("".join(f'<row r="{k}" s="{k * 7919 % 99991}"/>' for k in range(1, 270_000))),
        "sheet-bomb",
    ),
    "endless styles": (
        package(more={"xl/styles.xml": f'<styleSheet xmlns="{MAIN}"><cellXfs>{SPREAD}</cellXfs></styleSheet>'}),
        "sheet-bomb",
    ),
    "endless list of sheets": (
        package(more={"xl/workbook.xml": f'<workbook xmlns="{MAIN}">{SPREAD}</workbook>'}),
        "sheet-bomb",
    ),
    "a formula told again and again": (
        package(
            f'<row><c r="A1"><f t="shared" si="0">{"1+" * 4000}1</f></c></row>'
            + "".join(f'<row><c r="A{k}"><f t="shared" si="0"/></c></row>' for k in range(2, 3000))
        ),
        "sheet-bomb",
    ),
    "a long shared formula": (
        package(f'<row><c r="A1"><f t="shared" si="0">{"1+" * 20_000}1</f></c></row>'),
        "text-too-long",
    ),
    "rows out of order": (
        package('<row r="2"><c r="A2"><v>1</v></c></row><row r="1"><c r="A1"><v>2</v></c></row>'),
        "sheet-damaged",
    ),
    "cells out of order": (package('<row r="1"><c r="B1"><v>1</v></c><c r="A1"><v>2</v></c></row>'), "sheet-damaged"),
    "a cell twice": (package('<row r="1"><c r="A1"><v>1</v></c><c r="A1"><v>2</v></c></row>'), "sheet-damaged"),
    "a row beyond all rows": (package('<row r="99999999999999"><c><v>1</v></c></row>'), "sheet-damaged"),
    "no row number": (package('<row r="x"><c><v>1</v></c></row>'), "sheet-damaged"),
    "no sheet part": (
        package(more={"xl/_rels/workbook.xml.rels": rels("worksheet", "none.xml", "Internal")}),
        "sheet-damaged",
    ),
    "charts alone": (
        package(more={"xl/_rels/workbook.xml.rels": rels("chartsheet", "worksheets/s.xml", "Internal")}),
        "sheet-no-zip",
    ),
    "a sheet twice": (package(more={"xl/workbook.xml": TWICE}), "sheet-damaged"),
    "long": (package(f'<row><c t="inlineStr"><is><t>{"x" * 40_000}</t></is></c></row>'), "text-too-long"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_workbook_is_refused(put: Callable[..., Path], name: str) -> None:
    content, code = HOSTILE[name]
    assert f"error[{code}]" in refusal(put(content, "hostile.xlsx"))


def test_far_too_many_rows_are_refused_whatever_the_dimension_says(put: Callable[..., Path]) -> None:
    """The sheet says it is A1:A1; the first row too many stops the reading."""
    rows = "".join(f'<row r="{k}"><c r="A{k}"><v>{k * 7919 % 99991}</v></c></row>' for k in range(1, 150_001))
    assert refusal(put(package(rows), "m.xlsx")) == "FILE:S!A10001: error[table-too-large]"


def test_a_directory_that_lies_of_a_size_is_found_out(put: Callable[..., Path]) -> None:
    """The announced size of the sheet is cut to 10 bytes: what follows is never unpacked."""
    content = bytearray(package("<row><c><v>1</v></c></row>" * 50))
    at = content.rindex(b"PK\x01\x02")
    with zipfile.ZipFile(io.BytesIO(bytes(content))) as made:
        assert made.infolist()[-1].filename == "xl/worksheets/s.xml"
    content[at + 24 : at + 28] = (10).to_bytes(4, "little")
    assert "error[sheet-damaged]" in refusal(put(bytes(content), "lie.xlsx"))


def test_overlapping_parts_are_refused(put: Callable[..., Path]) -> None:
    """Two entries of the directory share one body, as in bombs that need no nesting."""
    content = package(more={"xl/worksheets/t.xml": bytes(200_000), "xl/u.bin": b"0123456789" * 300})
    entries = content.index(b"PK\x01\x02")
    one = content.rindex(b"PK\x01\x02")
    end = content.index(b"PK\x05\x06")
    extra = b"".join(content[one:end].replace(b"xl/u.bin", f"xl/{k:01x}.bin".encode()) for k in range(16))
    tail = bytearray(content[end:])
    count = 7 + 16
    tail[8:10] = tail[10:12] = count.to_bytes(2, "little")
    tail[12:16] = (end - entries + len(extra)).to_bytes(4, "little")
    assert "error[sheet-bomb]" in refusal(put(content[:end] + extra + bytes(tail), "o.xlsx"))


SHARED = {"xl/styles.xml": STYLES, "xl/strings.xml": STRINGS}
WHOLE = (write_xlsx(BOOK), package('<row><c t="s"><v>0</v></c></row>', SHARED))
CHANGE = st.tuples(st.floats(0, 1, exclude_max=True), st.binary(max_size=3))


@settings(max_examples=80, deadline=None)
@given(st.sampled_from(WHOLE), st.lists(CHANGE, max_size=4))
def test_a_damaged_workbook_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, content: bytes, changes: list[tuple[float, bytes]]
) -> None:
    """Never another exception, wherever its bytes are changed."""
    for share, new in changes:
        at = int(share * len(content))
        content = content[:at] + new + content[at + len(new) :]
    path = tmp_path_factory.mktemp("damaged") / "d.xlsx"
    path.write_bytes(content)
    with contextlib.suppress(AssignmentError):
        assert all(isinstance(page, Page) for page in read(path))


PARTS = tuple(
    {name: book.read(name) for name in book.namelist()} for book in (zipfile.ZipFile(io.BytesIO(one)) for one in WHOLE)
)
ODD = (b"", b"<", b'"', b"-1", b"99999999999", b"1e999", b"x", b"\xff", b"<row/>", b"<c/>", b'<f t="shared" si="0"/>')
SPOT = st.tuples(st.integers(0, 99), st.floats(0, 1), st.booleans(), st.sampled_from(ODD))


@settings(max_examples=80, deadline=None)
@given(st.sampled_from(PARTS), st.lists(SPOT, min_size=1, max_size=3))
def test_a_workbook_with_damaged_parts_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, parts: Mapping[str, bytes], spots: list[tuple[int, float, bool, bytes]]
) -> None:
    """Packed again without a fault, so that the damage comes to what reads the XML, inside values or anywhere."""
    damaged = dict(parts)
    for which, share, inside, new in spots:
        name = sorted(damaged)[which % len(damaged)]
        content = damaged[name]
        values = [match.span() for match in re.finditer(rb'(?<=")[^"<>]+(?=")|(?<=>)[^<]+(?=<)', content)]
        at = int(share * len(content))
        start, end = values[int(share * (len(values) - 1))] if inside and values else (at, at + 1)
        damaged[name] = content[:start] + new + content[end:]
    path = tmp_path_factory.mktemp("damaged") / "d.xlsx"
    with zipfile.ZipFile(path, "w") as made:
        for name, content in damaged.items():
            made.writestr(name, content)
    with contextlib.suppress(AssignmentError):
        assert all(isinstance(page, Page) for page in read(path))


@pytest.mark.proof
def test_a_million_empty_cells_with_a_border_are_none(tmp_path: Path) -> None:
    """A border drawn round ten thousand rows of a hundred columns; `make bench` says how soon they are read."""
    path = tmp_path / "a.xlsx"
    path.write_bytes(bordered(10_000))
    (page,) = read(path)
    assert [[cell.value for cell in row] for row in page.rows] == [["id", None, 7.0]]


def test_an_empty_cell_counts_where_the_next_does_not_name_its_place(tmp_path: Path) -> None:
    path = tmp_path / "a.xlsx"
    path.write_bytes(package('<row r="1"><c r="A1" s="1"/><c><v>7</v></c></row>'))
    (page,) = read(path)
    assert [[cell.value for cell in row] for row in page.rows] == [[None, 7.0]]
