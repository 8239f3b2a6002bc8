"""The empty answer sheet and the task: all that is asked, nothing that is to be found out."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from openpyxl import load_workbook

from reportgen.base.records import replace
from reportgen.base.units import Language, write
from reportgen.case.answer_key import Key, Role
from reportgen.document import Document, Table, plain, text_of
from reportgen.marking.answer_sheet import answer_book, number_format
from reportgen.marking.task_paper import answer_tables, task_of
from reportgen.marking.toleranced_key import key_of, words_of
from reportgen.workbook import write_xlsx
from tests.lanes import matrix
from tests.marking.keys import small_key
from tests.report import built


def cells(key: Key, tmp_path: Path) -> Iterator[tuple[str, str, object, bool]]:
    """id, head of the column, value and whether it can be filled in, of every cell of the sheet."""
    path = tmp_path / "sheet.xlsx"
    path.write_bytes(write_xlsx(answer_book(key)))
    page = load_workbook(path).worksheets[0]
    assert page.protection.sheet
    heads = [cell.value for cell in page[3]]
    for line in page.iter_rows(min_row=4):
        for head, cell in zip(heads, line, strict=True):
            yield str(line[0].value or ""), str(head), cell.value, not cell.protection.locked


def test_what_is_asked_can_be_filled_in_and_nothing_else(tmp_path: Path) -> None:
    key = small_key("en")
    empty = {(id, head) for id, head, value, unlocked in cells(key, tmp_path) if unlocked and value is None}
    asked = {(row.id, f"Position {key.labels[k - 1]}" if k else "Value") for row in key.asked for k in row.positions}
    # v_B is zero at position 4, which a sheet without a cell for its direction would tell.
    assert empty == asked | {("dir.v.B", "Position 4")}
    shown = {(id, head): value for id, head, value, _ in cells(key, tmp_path)}
    assert shown["l.AB", "Value"] == 0.15
    assert shown["v.B", "Symbol"] == "v_B"
    assert shown["v.B", "Unit"] == "m/s"


def test_the_sheet_names_assignment_and_student_and_is_the_same_bytes_each_time(tmp_path: Path) -> None:
    path = tmp_path / "sheet.xlsx"
    data = write_xlsx(answer_book(small_key("en", student="=cmd|'/c calc'!A1")))
    assert data == write_xlsx(answer_book(small_key("en", student="=cmd|'/c calc'!A1")))
    path.write_bytes(data)
    info = load_workbook(path)["Info"]
    rows = {row[0].value: row[1] for row in info.iter_rows()}
    assert rows["Assignment"].value == "crank-07"
    assert rows["Variant"].value == "7"
    # A name that looks like a formula stays text.
    assert rows["Student"].value == "=cmd|'/c calc'!A1"
    assert rows["Student"].data_type == "s"


def test_a_format_shows_the_decimals_of_the_report() -> None:
    formats = {row.id: number_format(row) for row in small_key().rows}
    assert formats["v.B"] == "0.00"
    assert formats["l.AB"] == "General"


def test_rows_that_share_a_symbol_are_told_apart_on_paper() -> None:
    key = small_key("en")
    twin = next(row for row in key.rows if row.id == "v.B")
    both = replace(key, rows=(*key.rows[:5], replace(twin, id="f.v.B")))
    texts = [plain(cell.inlines, "en") for table in answer_tables(both) for row in table.rows for cell in row]
    assert [text for text in texts if text.startswith("v_B")] == ["v_B v.B", "v_B f.v.B"]


def test_many_positions_are_split_over_tables_that_fit_the_page() -> None:
    key = small_key("en")
    (wide,) = (row for row in key.rows if row.id == "v.B")
    labels = tuple(map(str, range(1, 21)))
    row = replace(wide, values=np.ones(20), positions=tuple(range(1, 21)), sense=("",) * 20)
    many = Key("x", "slider-crank", "", "en", {}, labels, (row,))
    tables = list(answer_tables(many))
    heads = [plain(cell.inlines, "en") for table in tables for cell in table.head[0]]
    assert [head for head in heads if head.isdigit()] == list(labels)
    assert all(sum(column.width for column in table.columns) < 160.001 for table in tables)


def test_paper_does_not_tell_where_a_direction_does_not_exist() -> None:
    tables = list(answer_tables(small_key("en")))
    (line,) = [row for table in tables for row in table.rows if plain(row[0].inlines, "en") == "α_vB"]
    assert all(cell.inlines == () for cell in line[3:])


# --- the task -------------------------------------------------------------------------------------


def handout(name: str, language: Language) -> tuple[Key, Document]:
    case = built.case(built.ROOT / "assignments" / f"{name}.yaml", language)
    key = key_of(case)
    return key, task_of(case, key)


NAMES = ("engine-twin-05", "slider-crank-01", "shaper-01", "linkage-8", "linkage-slide", "four-bar-01")


@pytest.mark.parametrize("language", matrix(["vi", "en"], ["vi"]))
@pytest.mark.parametrize("name", NAMES)
def test_a_task_gives_no_answer_away(name: str, language: Language) -> None:
    key, tree = handout(name, language)
    text = text_of(tree)
    told = set(re.findall(r"[\d.,]+\d", text))
    for row in key.asked:
        if row.role is Role.scale:
            continue
        for k in row.positions:
            value = float(row.values[row.at(k)])
            shown = write(abs(value), row.decimals, language)
            # Short numbers occur by chance (counts, given data); five figures do not.
            if sum(map(str.isdigit, shown.lstrip("0.,"))) >= 5:
                assert shown not in told, row.id


@pytest.mark.parametrize("name", NAMES)
def test_a_task_has_a_place_for_every_value_that_is_asked(name: str) -> None:
    key, tree = handout(name, "en")
    (last,) = [i for i, block in enumerate(tree.blocks) if "Answer sheet" in str(getattr(block, "title", ""))]
    tables = [block for block in tree.blocks[last:] if isinstance(block, Table)]
    empty, parts = 0, []
    for table in tables:
        for line in table.rows:
            # What is asked for once has a cell across all positions, a part's name the whole line.
            assert sum(cell.span for cell in line) == len(table.columns)
            symbol, *others = (plain(cell.inlines, "en") for cell in line)
            if not others:
                parts.append(symbol)
                continue
            _, _, *values = others
            assert symbol
            empty += values.count("")
    assert empty == sum(len(row.positions) for row in key.asked)
    words = words_of(key)["parts"]
    assert set(parts) == {words[row.part] for row in key.asked}


@pytest.mark.parametrize(
    ("name", "loads"),
    [
        # The values of the files' own laws, signs as they act; a torque against the motion turns with it.
        ("linkage-8", ("on link 3, always against its rotation", "−500", "−200", "200")),
        ("linkage-slide", ("300", "380", "600", "900", "on link 3, always against its rotation")),
        ("four-bar-01", ("40", "−40")),
        ("lever-six-bar-01", ("400",)),
        ("slotted-lever-02", ("24", "−24")),
    ],
)
def test_a_task_tells_the_loads(name: str, loads: tuple[str, ...]) -> None:
    _, tree = handout(name, "en")
    text = text_of(tree)
    for load in loads:
        assert re.search(rf"(?<![\d.,]){re.escape(load)}(?!\d|[.,]\d)", text), load


@pytest.mark.parametrize("name", ["four-bar-01", "engine-twin-05", "shaper-01"])
def test_a_task_tells_where_the_positions_are(name: str) -> None:
    key, tree = handout(name, "en")
    angles: list[str] = []
    for table in (block for block in tree.blocks if isinstance(block, Table)):
        for line in table.rows:
            cells = [plain(cell.inlines, "en") for cell in table.head[0]], [plain(cell.inlines, "en") for cell in line]
            if cells[1][0] == "φ_1" and cells[0][0] == "Symbol":
                angles += cells[1][2:]
    assert angles == [f"{value:g}" for value in key.row("phi.1").values]


@pytest.mark.parametrize("name", ["engine-single-I", "shaper-01", "four-bar-01", "linkage-slide"])
def test_a_scale_is_asked_for_once(name: str) -> None:
    key, _ = handout(name, "en")
    scales = [row.symbol for row in key.asked if row.kind.endswith("scale")]
    assert len(scales) == len(set(scales))
