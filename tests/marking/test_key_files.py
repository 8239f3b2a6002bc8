"""The key as workbook, CSV, JSON and document: one set of numbers, as the report prints them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from openpyxl import load_workbook

from reportgen import catalogue
from reportgen.base.units import Language
from reportgen.cases import MachineCase, open_case
from reportgen.document import Table, Text, text_of
from reportgen.marking.answer_sheet import read_submission
from reportgen.marking.key_files import band, key_book, key_data, key_document, key_rows
from reportgen.marking.toleranced_key import key_of
from reportgen.workbook import write_xlsx
from tests.marking.keys import small_key
from tests.report import built


def test_json_has_values_to_seven_figures_and_null_for_what_does_not_exist() -> None:
    data = json.loads(json.dumps(key_data(small_key("en")), allow_nan=False))
    assert data["format"] == "reportgen-key/1"
    assert data["positions"] == ["1", "2", "3", "4"]
    rows = {row["id"]: row for row in data["rows"]}
    assert rows["omega.1"]["values"] == [31.41593]
    assert rows["omega.1"]["unit"] == "rad/s"
    assert rows["omega.1"]["asked"] == [""]
    assert rows["dir.v.B"]["values"] == [90.0, 180.0, 270.0, None]
    assert rows["dir.v.B"]["asked"] == ["1", "2", "3"]
    assert rows["M.eq"]["drawn"] == [0.5] * 4
    assert rows["l.AB"]["role"] == "given"


def test_csv_has_a_row_for_each_value_as_printed() -> None:
    head, *rows = key_rows(small_key("en"))
    by_place = {(row[0], row[5]): dict(zip(head, row, strict=True)) for row in rows}
    assert by_place["omega.1", ""]["Value"] == 31.42
    assert by_place["v.B", "3"]["Value"] == -1.2
    assert by_place["dir.v.B", "4"]["Value"] is None
    assert by_place["M.eq", "2"]["Direction"] == "b"
    assert by_place["M.eq", "2"]["Part"] == "Balance of the driving link"
    assert len(rows) == sum(len(row.values) for row in small_key().rows)


@pytest.mark.parametrize("language", ["vi", "en"])
def test_the_workbook_of_a_key_reads_as_a_perfect_sheet(language: Language, tmp_path: Path) -> None:
    key = small_key(language)
    path = tmp_path / "key.xlsx"
    path.write_bytes(write_xlsx(key_book(key)))
    submission = read_submission(path, key)
    assert {place: given.value for place, given in submission.values.items()} == {
        (row.id, k): row.printed[row.at(k)] for row in key.asked for k in row.positions
    }
    assert not submission.problems
    book = load_workbook(path)
    assert len(book.worksheets) == 5
    assert book.worksheets[1]["E5"].value == 0.5


def test_a_band_that_is_nothing_beside_its_row_is_nothing() -> None:
    row = small_key().row("v.B")
    assert band(row, 1e-12) == 0
    assert band(row, 0.01234) == 0.012
    assert band(row, float("nan")) is None


@pytest.mark.parametrize("name", ["slider-crank-01", "engine-twin-05", "linkage-slide"])
def test_the_document_has_every_quantity_at_every_position_on_pages_that_hold_it(name: str) -> None:
    case = built.case(built.ROOT / "assignments" / f"{name}.yaml", "en")
    key = key_of(case)
    tree = key_document(key, case.title)
    tables = [block for block in tree.blocks if isinstance(block, Table)]
    assert all(sum(column.width for column in table.columns) < 160.001 for table in tables)
    # A list has a quantity a row; a table by position spans a quantity over its columns.
    listed = sum(len(table.rows) for table in tables if len(table.head) == 1)
    beside = sum(cell.span > 1 for table in tables if len(table.head) == 2 for cell in table.head[0])
    assert listed == sum(row.single for row in key.rows)
    assert beside == sum(not row.single for row in key.rows)
    assert all(len(table.rows) == len(key.labels) for table in tables if len(table.head) == 2)
    text = text_of(tree)
    for row in key.rows[:40]:
        if row.decimals is not None and row.printed[0] > 0:
            assert f"{row.printed[0]:.{row.decimals}f}" in text or row.decimals == 0


def test_of_very_many_positions_the_document_has_some_with_all_that_are_asked_and_the_csv_every_one() -> None:
    case = MachineCase(catalogue.load(Path("assignments/slider-crank-01.yaml"), "en").with_positions(100))
    key = key_of(case)
    tree = key_document(key, case.title)
    by_position = [block for block in tree.blocks if isinstance(block, Table) and len(block.head) == 2]
    assert by_position
    for table in by_position:
        printed = ["".join(part.text for part in row[0].inlines if isinstance(part, Text)) for row in table.rows]
        assert len(printed) <= 25
        assert {key.label(k) for row in key.asked for k in row.positions if k} <= set(printed)
    assert f"show {len(key.printed)} positions" in text_of(tree)
    every = {row[5] for row in key_rows(key) if row[0] == "v.C"}
    assert every == set(key.labels)


def test_an_endless_angle_has_hundredths_and_a_typed_number_all_its_figures(tmp_path: Path) -> None:
    """Seven positions from 77.7° on: 360/7 = 51.428571…; the start itself has few digits and stays as it is."""
    text = Path("assignments/engine-twin-05.yaml").read_text(encoding="utf-8").replace("s: 0.35", "s: 0.3512345678")
    text = text.replace("count: 8, direction: anticlockwise", "count: 7, start: 77.7 deg")
    text = re.sub("  firing: .*", "", text)
    file = tmp_path / "a.yaml"
    file.write_text(text, encoding="utf-8")
    _, *rows = key_rows(key_of(open_case(file, "en")))
    shown = {(row[0], row[5]): row[6] for row in rows}
    assert [shown["phi.1", position] for position in "128"] == [77.7, 129.13, 437.7]
    assert shown["s", ""] == 0.3512345678
