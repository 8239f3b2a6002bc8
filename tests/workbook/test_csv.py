"""CSV in and out: cells know line and column, what is no CSV is refused, no text becomes a formula."""

from __future__ import annotations

import codecs
import csv
import re
import unicodedata
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from reportgen.workbook import read, write_csv
from reportgen.workbook.zip_package import guarded, unguarded
from tests.workbook.tables import CYNICAL, refusal, texts

NAME = unicodedata.normalize("NFD", "Đỗ Hữu Trường")


@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_separators_and_byte_order_mark(put: Callable[..., Path], mark: bytes, separator: str) -> None:
    lines = [["id", "name", "note"], ["01", f'"Trần{separator} Nam"', "a"], ["2", '"say ""x"""', ""]]
    path = put(mark + "\r\n".join(separator.join(line) for line in lines).encode())
    (page,) = read(path)
    assert texts(page) == [["id", "name", "note"], ["01", f"Trần{separator} Nam", "a"], ["2", 'say "x"']]


def test_the_separator_is_that_of_the_header_alone(put: Callable[..., Path]) -> None:
    (page,) = read(put(b'\r\n"a,b,c";id\n1,5;2,5\n'))
    assert texts(page) == [[], ["a,b,c", "id"], ["1,5", "2,5"]]


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_table_may_be_saved_by_notepad_or_powershell(put: Callable[..., Path], encoding: str) -> None:
    (page,) = read(put("mã;tên\r\n1;Ánh\r\n".encode(encoding)))
    assert texts(page) == [["mã", "tên"], ["1", "Ánh"]]


def test_cells_of_csv_know_line_and_column(put: Callable[..., Path]) -> None:
    path = put('id,name\n"1","two\r\nlines"\nx,ý,z\n'.encode())
    (page,) = read(path)
    places = {cell.text: str(cell.location).removeprefix(str(path)) for row in page.rows for cell in row}
    first = {"id": ":1:1", "name": ":1:4", "1": ":2:1", "two\r\nlines": ":2:5"}
    assert places == {**first, "x": ":4:1", "ý": ":4:3", "z": ":4:5"}


def test_csv_is_composed(put: Callable[..., Path]) -> None:
    (page,) = read(put(f"name\n{NAME}\n".encode()))
    assert page.rows[1][0].value == unicodedata.normalize("NFC", NAME)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"id\nab\xe9\n", "FILE:2:3: error[encoding]"),
        ("id\nÁ\n".encode("utf-16") + b"x", "FILE:3:1: error[encoding]"),
        ("id\nÁ\n".encode("utf-16-le"), "FILE:1:2: error[binary]"),
        (codecs.BOM_UTF8 + b"id\nab\xe9\n", "FILE:2:3: error[encoding]"),
        (b"id,name\n1,a\0b\n", "FILE:2:4: error[binary]"),
        (b'id,name\n1,"open\n2,b\n', "FILE:2:3: error[quote-open]"),
        (b"id\n" * 10_001, "FILE:10001:1: error[table-too-large]"),
        (b"," * 600 + b"x", "FILE:1:601: error[table-too-large]"),
        (b"id\n" + b"x" * 40_000, "FILE:2:1: error[text-too-long]"),
        (b" \n", "FILE:1:1: error[empty]"),
        (b"x" * 10_000_001, "FILE:1:1: error[too-large]"),
    ],
)
def test_what_is_no_csv_is_refused_where_it_goes_wrong(put: Callable[..., Path], content: bytes, told: str) -> None:
    assert refusal(put(content)) == told


def test_a_missing_file_is_a_fault(tmp_path: Path) -> None:
    assert refusal(tmp_path / "none.csv") == "FILE:1:1: error[unreadable]"


CELL = st.text(st.characters(exclude_categories=("Cs",), exclude_characters="\0"), max_size=12)


@given(st.lists(st.lists(CELL, min_size=1, max_size=4), min_size=1, max_size=5))
@example([list(CYNICAL)])
@example([["-5", "'-5", "''=1", "'", "sep=;"]])
def test_csv_comes_back_as_it_was_written(tmp_path_factory: pytest.TempPathFactory, rows: list[list[str]]) -> None:
    """A header of five words says which separator it is; what is blank comes back as nothing."""
    path = tmp_path_factory.mktemp("csv") / "t.csv"
    path.write_bytes(write_csv([["a", "b", "c", "d", "e"], *rows]))
    (page,) = read(path)
    want = [[unicodedata.normalize("NFC", text) if text.strip() else "" for text in row] for row in rows]
    for row in want:
        while row and not row[-1]:
            row.pop()
    got = texts(page)[1:]
    assert got == want[: len(got)]
    assert not any(want[len(got) :])


@pytest.mark.parametrize("text", CYNICAL)
def test_csv_never_begins_a_formula(text: str) -> None:
    cell = write_csv([[text]]).decode("utf-8-sig").strip('"\r\n')
    assert cell[0] == "'"


INSIDE = [
    "a;=1+1",
    'a";"=1+1',
    'a;" =1',
    "a;\t@x",
    "a\t+x",
    "a|-x",
    "a\n=1",
    "a,=1",
    'a;"";=1',
    "a;-5;=1",
    "a; ＝1",
    ";'\"=1",
]


@pytest.mark.parametrize("separator", [",", ";", "\t", "|"])
@pytest.mark.parametrize("quotes", [True, False])
@pytest.mark.parametrize("text", INSIDE)
def test_csv_never_begins_a_formula_in_a_program_that_parts_elsewhere(text: str, quotes: bool, separator: str) -> None:
    """Whatever a program parts cells at, and whether or not it minds quotation marks, no cell begins with a sign."""
    content = write_csv([["x", text, text], [text]]).decode("utf-8-sig")
    quoting = csv.QUOTE_MINIMAL if quotes else csv.QUOTE_NONE
    for row in csv.reader(content.splitlines(), delimiter=separator, quoting=quoting):
        for cell in row:
            shown = cell.strip(' "\t')
            assert re.fullmatch(r"-?[0-9.]*", shown) or shown[0] not in "=+-@＝", (cell, content)


@given(st.lists(st.text(",;|\t\n'\" =-+5x", max_size=9), min_size=1, max_size=3))
@settings(max_examples=500)
def test_what_was_guarded_inside_comes_back(row: list[str]) -> None:
    assert [unguarded(guarded(text)) for text in row] == row


def test_a_long_run_of_blanks_stays_as_it_is() -> None:
    """In a time that grows with the blanks: `tests/bench/reading.py`."""
    assert guarded("x" + "\n" * 30_000) == "x" + "\n" * 30_000


def test_negative_numbers_stay_numbers_in_csv() -> None:
    assert write_csv([[-1.5, "-2.5e3", 4.0, None]]) == b"\xef\xbb\xbf-1.5,-2.5e3,4,\r\n"
