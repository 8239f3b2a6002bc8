"""Read tables of a Word report: quantities by positions, in rows or columns, or statements laid out in cells."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

from reportgen.base.records import Record
from reportgen.base.units import QuantityFault
from reportgen.case.answer_key import KeyRow
from reportgen.handin import text_statements as said
from reportgen.handin.entry_collection import Gathering
from reportgen.handin.symbol_matching import bare
from reportgen.handin.text_numbers import NUMBER, UNIT, plain_unit, read_value
from reportgen.handin.word_patterns import any_of, label_of
from reportgen.handin.word_text import OBJECT, TextCell, TextGrid, TextLine
from reportgen.marking.student_numbers import is_blank

HEADS = 4
"""Number of rows among which the row with the positions is searched for."""
_PLAIN_LABEL = re.compile(rf"[\s(]*{any_of('number', whole=False)}?[\s:(]*([0-9]{{1,3}}[a-z]?′*)", re.IGNORECASE)
_QUANTITY = re.compile(
    r"(?:[^\d_{}()]*?[\s:])??(?P<symbol>[^\s(),/\[]+?(?:\(\d\)\}?)?)\s*"
    r"(?:,\s*(?P<comma>[^\s,]+(?:\s[^\s,]+)?)|[(\[]\s*(?P<round>[^()]*(?:\([^()]*\))?[^()]*?)\s*[)\]])?"
)
_NUMBER_CELL = re.compile(
    rf"\s*({NUMBER})\s*(?:[(\[]\s*({UNIT})\s*[)\]]|({UNIT}))?\s*[.,;]?\s*((?:\([^()\d]*\)|[^()\d=]*)\s*)"
)
_HEAD_UNIT = re.compile(rf"(?:.*[,;]\s*|.*\s)?[(\[]?\s*({UNIT})\s*[)\]]?|({UNIT})")
_INDEXED = re.compile(r"[^\W\d_]+_\{[^\s{}]*\}")
_INDEX = re.compile(r"[A-Z0-9][A-Z0-9_{}]{0,7}")
"""Index below a letter: the number of an order, the ends of a length."""
_NUMBERED = re.compile(r"\s*\(\d+(?:[.,]\d+)*\)\s*")
"""The number of an equation."""

_HEAD_WORD = re.compile(any_of("head"), re.IGNORECASE)
"""Headings of positions besides their own word; a pair of gears has points."""

Statements = Callable[[TextLine, str | None], None]
TextCells = Sequence[Sequence[TextCell]]


class _Quantity(Record):
    """A cell that names a quantity: its rows and its unit; None for a unit that is not understood."""

    rows: tuple[KeyRow, ...]
    unit: str | None


def read_table(grid: TextGrid, gathering: Gathering, line: Statements, label: str | None) -> None:
    """Read a table at a place where the current position has the `label`."""
    cells = list(dict.fromkeys(cell for row in grid.rows for cell in row))
    nested = [block for cell in cells for block in cell.blocks if isinstance(block, TextGrid)]
    texts = {id(cell): cell.line.text for cell in cells}
    if any(said.RELATION.search(text) for text in texts.values()):
        _read_statements(grid.rows, gathering, line, label)
    elif grid.rows and len({len(row) for row in grid.rows}) == 1:
        layouts: list[TextCells] = [grid.rows, [list(column) for column in zip(*grid.rows, strict=True)]]
        if not (
            any(_read_positions(layout, gathering) for layout in layouts)
            or any(_read_single(layout, gathering, label) for layout in layouts)
            or any(_read_composed(layout, gathering, label) for layout in layouts)
        ):
            _leave(layouts, gathering)
    else:
        _leave([grid.rows], gathering)
    for inner in nested:
        read_table(inner, gathering, line, label)


def _leave(layouts: Sequence[TextCells], gathering: Gathering) -> None:
    """Record doubts for the quantities of a table whose numbers cannot be assigned to positions."""
    for row in (row for layout in layouts for row in layout):
        numbers = [cell for cell in row if _NUMBER_CELL.fullmatch(cell.line.text)]
        named = _named(row, gathering)
        for key_row in named[0].rows if named and numbers else ():
            location = gathering.location(numbers[0].line, 0)
            gathering.doubt(key_row, None, "unread-table", location, numbers[0].line.text)


# --- statements in cells ----------------------------------------------------------------------------


def _read_statements(rows: TextCells, gathering: Gathering, line: Statements, label: str | None) -> None:
    """Read statements laid out in a grid: cells side by side form a line, unless a head names the position of each."""
    heads = {column: text for column, cell in enumerate(rows[0]) if (text := _named_position(cell, gathering))}
    sides = {number: text for number, row in enumerate(rows) if row and (text := _named_position(row[0], gathering))}
    for number, row in enumerate(rows):
        apart = list(dict.fromkeys(row))
        if heads or sides:
            for cell in apart:
                columns = [column for column, one in enumerate(row) if one is cell]
                own = {heads.get(column, sides.get(number)) for column in columns}
                if said.RELATION.search(cell.line.text):
                    line(cell.line, own.pop() if len(own) == 1 else None)
            continue
        joined = TextLine(apart[0].line.number if apart else 0)
        for cell in apart:
            text = cell.line.text
            if not text.strip() or _NUMBERED.fullmatch(text):
                continue
            if joined.letters and not (said.goes_on(text) or said.is_operator(text) or said.is_operator(joined.text)):
                joined.put(" ; ", cell.line.nodes[0])
            elif not joined.letters and said.is_operator(text):
                # This is not a bullet, but a sum that began in another row.
                joined.put("∑", cell.line.nodes[0])
            joined.extend(cell.line)
        if joined.text.strip():
            line(joined, label)


def _named_position(cell: TextCell, gathering: Gathering) -> str | None:
    """Return the label of a cell that names a position with its word, or None."""
    text = cell.line.text
    return _label(text, gathering) if said.SAYS_POSITION.search(text) else None


def _label(text: str, gathering: Gathering) -> str | None:
    text = text.strip().removesuffix(")").strip()
    match = said.POSITION.fullmatch(text) or _PLAIN_LABEL.fullmatch(text)
    return label_of(match).casefold() if match and gathering.is_label(label_of(match)) else None


# --- values in cells --------------------------------------------------------------------------------


def _read_positions(rows: TextCells, gathering: Gathering) -> bool:
    """Read a table with positions across a first row and quantities down the first columns; True if it is one."""
    for number, row in enumerate(rows[:HEADS]):
        labels = {column: text for column, cell in enumerate(row) if (text := _label(cell.line.text, gathering))}
        if not labels or len(set(labels.values())) < len(labels):
            continue
        first = min(labels)
        heads = [rows[above][column].line.text for above in range(number + 1) for column in (*labels, *range(first))]
        if not any(said.SAYS_POSITION.search(text) or _HEAD_WORD.fullmatch(text.strip()) for text in heads):
            continue
        read = [_read_row(one, labels, gathering) for one in rows[number + 1 :]]
        if any(read):
            return True
    return False


def _read_row(cells: Sequence[TextCell], labels: Mapping[int, str], gathering: Gathering) -> bool:
    """Read the values of a quantity by position; return True if the row names a known quantity."""
    beside = [cell for column, cell in enumerate(cells) if column not in labels]
    named = _named(beside, gathering)
    if named is None:
        return False
    quantity, at = named
    unit = _unit_of(quantity, [cell for cell in beside if cell is not at])
    for column, label in labels.items():
        for row in quantity.rows:
            position = gathering.position(row, label)
            if position is not None:
                _read_cell(cells[column], row, position, unit, len(quantity.rows) > 1, gathering)
    return True


def _read_single(rows: TextCells, gathering: Gathering, label: str | None) -> bool:
    """Read a table of quantities with one value each, at the current position or at none; True if it is one."""
    read = False
    for row in rows:
        apart = list(dict.fromkeys(row))
        named = _named(apart, gathering)
        numbers = [
            cell for cell in apart if _NUMBER_CELL.fullmatch(cell.line.text) and (not named or cell is not named[1])
        ]
        own_unit: str | None = ""
        if named is not None and len(numbers) > 1:
            numbers, own_unit = _by_unit(row, numbers, named[0], rows[:HEADS], gathering)
        if named is None or len(numbers) != 1:
            continue
        quantity, at = named
        unit = _unit_of(quantity, [cell for cell in apart if cell is not at and cell is not numbers[0]]) or own_unit
        for asked in quantity.rows:
            position = gathering.position(asked, label)
            line = numbers[0].line
            if position is None:
                gathering.doubt(asked, None, "unread-no-position", gathering.location(line, 0), line.text)
            else:
                _read_cell(numbers[0], asked, position, unit, len(quantity.rows) > 1, gathering)
            read = True
    return read


def _by_unit(
    row: Sequence[TextCell], numbers: Sequence[TextCell], quantity: _Quantity, heads: TextCells, gathering: Gathering
) -> tuple[list[TextCell], str]:
    """Return the numbers of a row below a unit of its quantity, and the unit: G | 20 | 32.9 | 0.62."""
    fitting: dict[TextCell, str] = {}
    for column, cell in enumerate(row):
        unit = next((text for head in heads if head is not row and (text := _unit_in_head(head[column]))), "")
        if cell in numbers and unit and all(_is_unit(unit, one, gathering) for one in quantity.rows):
            fitting[cell] = unit
    return list(fitting), next(iter(fitting.values()), "")


def _unit_in_head(cell: TextCell) -> str:
    """Return the unit in the head of a column, “Magnitude, N” or “N” alone; "" if there is none."""
    text = cell.line.text.strip()
    match = _HEAD_UNIT.fullmatch(text)
    return match[1] or match[2] if match else ""


def _read_composed(rows: TextCells, gathering: Gathering, label: str | None) -> bool:
    """Read a table of symbols across and indices down: A over 2 and 4, V_{1,i} over i, real lengths l over AB.

    Return True if it is one.
    """
    read = False
    head = rows[0]
    running = head[0].line.text.strip()
    for column, cell in enumerate(head[1:], start=1):
        symbol, unit = _symbol_in_head(cell.line.text.strip())
        for row in rows[1:] if symbol else ():
            index = row[0].line.text.strip()
            if not _INDEX.fullmatch(index):
                unit = unit or _unit_in_head(row[column])
                continue
            named = _with_index(symbol, running, index)
            asked = _asked(gathering.symbols.every.get(bare(named), ()))
            for key_row in asked:
                position = gathering.position(key_row, label)
                if position is None or (unit and not _is_unit(unit, key_row, gathering)):
                    continue
                _read_cell(row[column], key_row, position, unit, len(asked) > 1, gathering)
                read = True
    return read


def _symbol_in_head(text: str) -> tuple[str, str]:
    """Return a possible symbol without its index in a head, and the unit after it."""
    if _INDEXED.fullmatch(text):
        return text, ""
    match = _QUANTITY.fullmatch(text)
    return (match["symbol"], (match["comma"] or match["round"] or "").strip()) if match else ("", "")


def _with_index(symbol: str, running: str, index: str) -> str:
    """Return a symbol with its index in place of the running letter, or appended."""
    if len(running) == 1 and running.isalpha():
        put_in = re.sub(rf"(?<=[_{{,]){running}(?=[}},]|$)", index, symbol)
        if put_in != symbol:
            return put_in
    return f"{symbol}{index}"


def _read_cell(
    cell: TextCell, row: KeyRow, position: int, unit: str | None, several: bool, gathering: Gathering
) -> None:
    """Read one cell for a place; `unit` is its row's unit, None if it is not understood."""
    line = cell.line
    text = line.text
    if is_blank(text) or not line.nodes:
        return
    match = _NUMBER_CELL.fullmatch(text)
    location = gathering.location(line, match.start(1) if match else 0)
    if OBJECT in text:
        gathering.doubt(row, position, "unread-object", location, "")
    elif several:
        gathering.doubt(row, position, "unread-several", location, text)
    elif match is None:
        gathering.doubt(row, position, "unread-number", location, text)
    elif unit is None:
        gathering.doubt(row, position, "unread-unit", location, text, unit=row.unit)
    else:
        own = match[2] or match[3] or unit
        gathering.number(row, position, match[1], own, location, words=match[4] or "")


def _named(cells: Sequence[TextCell], gathering: Gathering) -> tuple[_Quantity, TextCell] | None:
    """Return the only quantity that some cells name, and the cell; None if they name none or several."""
    named = [(quantity, cell) for cell in dict.fromkeys(cells) if (quantity := _quantity(cell, gathering))]
    # The unit newton beside a force is not the power N.
    named = [pair for pair in named if not _says_unit(pair[1])] or named
    return named[0] if len({tuple(row.id for row in quantity.rows) for quantity, _ in named}) == 1 else None


def _says_unit(cell: TextCell) -> bool:
    return bool(re.fullmatch(UNIT, cell.line.text.strip().strip("()[]").strip()))


def _quantity(cell: TextCell, gathering: Gathering) -> _Quantity | None:
    """Return the quantity that a cell names, as in “v_B”, “Velocity v_B (m/s)” or “v_B, m/s”; None if it names none."""
    text = cell.line.text.strip()
    if rows := gathering.rows_of(text):
        return _Quantity(_asked(rows), "")
    match = _QUANTITY.fullmatch(text)
    rows = gathering.rows_of(match["symbol"]) if match else ()
    if match is None or not rows:
        return None
    unit = (match["comma"] or match["round"] or "").strip().strip("[]").strip()
    if not unit:
        return _Quantity(_asked(rows), "")
    return _Quantity(_asked(rows), unit if _is_unit(unit, rows[0], gathering) else None)


def _asked(rows: Sequence[KeyRow]) -> tuple[KeyRow, ...]:
    return tuple(row for row in rows if row.positions)


def _unit_of(quantity: _Quantity, beside: Sequence[TextCell]) -> str | None:
    """Return the unit of a row: given beside its symbol, or else in its own cell."""
    if quantity.unit != "":
        return quantity.unit
    texts = (cell.line.text.strip().strip("()[]").strip() for cell in beside)
    return next((text for text in texts if re.fullmatch(UNIT, text)), "")


def _is_unit(text: str, row: KeyRow, gathering: Gathering) -> bool:
    try:
        read_value("1", plain_unit(text), row, gathering.marks)
    except QuantityFault:
        return False
    return True
