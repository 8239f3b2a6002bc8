"""What a table file holds: pages of rows of cells, each of which knows where it stands."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from reportgen.errors import Fault, Mark

CellKind = Literal["empty", "text", "number", "boolean", "date", "error", "formula"]

MOST_ROWS = 10_000
MOST_COLUMNS = 500
MOST_CELLS = 200_000
LONGEST_CELL = 32_767
"""Characters; no spreadsheet program writes more into a cell."""

_LIVE = re.compile(r"'*\s*[=+\-@\t\r\n＝＋－＠]")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_SEPARATORS = ",;|\t\r\n"
"""All that any program parts cells or rows at."""
_INSIDE = re.compile(r"""(?<![,;|'"\s])[,;|'"\s]++(?=[=+\-@＝＋－＠])""")
"""Separators, quotation marks and blanks before a sign; each run of them is looked at once."""
_NUMBER_CELL = re.compile(rf"{_NUMBER.pattern}(?:[{_SEPARATORS}]|$)")


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell as it shows: `value` is a number of kind "number", None of kind "empty", else text.

    A date is ISO text, a boolean TRUE or FALSE, an error its code (#DIV/0!).  Of a formula, `formula` is its
    text with the equals sign and `value` the result stored beside it, None if there is none.
    """

    value: str | float | None
    mark: Mark
    kind: CellKind
    formula: str = ""

    @property
    def text(self) -> str:
        """The value as a reader of the table sees it: whole numbers without a decimal point, empty as ""."""
        if self.value is None:
            return ""
        return self.value if isinstance(self.value, str) else number_text(self.value)

    @property
    def blank(self) -> bool:
        return self.kind == "empty"


@dataclass(frozen=True, slots=True)
class Page:
    """A sheet, or a whole CSV file: rows from the first on, each as long as its last cell that holds something."""

    name: str
    rows: tuple[tuple[Cell, ...], ...]
    hidden: bool = False


class RefusedError(Exception):
    """A file that is not read any further; carries the `Fault`."""

    def __init__(self, code: str, mark: Mark, **arguments: str) -> None:
        super().__init__(code)
        self.fault = Fault(code, mark, arguments)


def exceeds(row: int, column: int, cells: int = 0) -> bool:
    """Whether a table with that row, column or number of cells is larger than any that is read."""
    return row > MOST_ROWS or column > MOST_COLUMNS or cells > MOST_CELLS


def too_large(mark: Mark) -> RefusedError:
    return RefusedError("table-too-large", mark, rows=str(MOST_ROWS), columns=str(MOST_COLUMNS), cells=str(MOST_CELLS))


def too_long(mark: Mark) -> RefusedError:
    return RefusedError("text-too-long", mark, largest=str(LONGEST_CELL))


def number_text(value: float) -> str:
    """A number as short as it can be read back from: 195520103001, 0.35, 1e-20."""
    return str(int(value)) if value.is_integer() and abs(value) < 1e16 else repr(value)


def guarded(text: str) -> str:
    """The text with an apostrophe before all that a spreadsheet would take for the formula of a cell; numbers stay.

    Such a formula may also begin inside: programs of other countries part cells at semicolons, tabs or bars, and
    know nothing of the quotation marks that keep a cell together.
    """
    inside = _INSIDE.sub(_with_apostrophe, text)
    return f"'{inside}" if _LIVE.match(inside) and not _NUMBER.fullmatch(inside) else inside


def unguarded(text: str) -> str:
    """The text that `guarded` was given."""
    rest = text[1:]
    inside = rest if text.startswith("'") and _LIVE.match(rest) and not _NUMBER.fullmatch(rest) else text
    return _INSIDE.sub(_without_apostrophe, inside)


def _with_apostrophe(run: re.Match[str]) -> str:
    """What stands before a sign that could begin a formula, with an apostrophe after its last separator."""
    before, after = _at_last_separator(run[0])
    number = not after and _NUMBER_CELL.match(run.string, run.end())
    return run[0] if not before or number else f"{before}'{after}"


def _without_apostrophe(run: re.Match[str]) -> str:
    before, after = _at_last_separator(run[0])
    return before + after.removeprefix("'") if before else after


def _at_last_separator(run: str) -> tuple[str, str]:
    cut = max(map(run.rfind, _SEPARATORS)) + 1
    return run[:cut], run[cut:]
