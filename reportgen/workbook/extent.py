"""How much a part of a workbook would make openpyxl hold, counted before openpyxl sees it.

openpyxl builds the tree of a part and lets go of each row of a sheet and each shared string once it is read, so that
memory grows with the largest of them and with all that stands outside.
"""

from __future__ import annotations

from dataclasses import dataclass

from reportgen.workbook.cells import LONGEST_CELL
from reportgen.workbook.package import Attributes, Package

MOST_HELD = 1 << 18
"""Elements and attributes held at once; the longest row there can be, of cells with nothing but a style, has 50 000."""
MOST_GROUPS = 1 << 20
"""Rows of a sheet, strings of a table; no sheet can have more rows."""
MOST_TRANSLATED = 20_000_000
"""Characters of all formulas that take the text of a shared one, as if each were as long as the longest shared."""
_MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
_GROUPS = frozenset({f"{_MAIN} row", f"{_MAIN} si"})
_FORMULA = f"{_MAIN} f"
_PLACE = frozenset({"r", "spans"})


@dataclass(frozen=True, slots=True)
class Extent:
    """The number of elements right inside rows, which are cells, and whether formulas are among what is in them."""

    cells: int
    formulas: bool


def measure(package: Package, name: str) -> Extent:
    """Walk through a part; raises `RefusedError` if it is damaged or has more in it than can be held."""
    depth = held = outside = groups = cells = formulas = dependents = 0

    def start(tag: str, attributes: Attributes) -> None:
        """`depth` is 1 right inside a row or a string, 0 outside of all; `outside` is held whatever is let go."""
        nonlocal depth, held, outside, groups, cells, formulas, dependents
        if depth:
            depth += 1
            cells += depth == 2
        elif tag in _GROUPS:
            # openpyxl keeps what else is said of a row, such as its height.
            depth, groups, outside = 1, groups + 1, held + (not attributes.keys() <= _PLACE)
        held += 1 + len(attributes)
        if tag == _FORMULA:
            formulas += 1
            dependents += attributes.get("t") == "shared"
        if held > MOST_HELD or groups > MOST_GROUPS:
            raise package.bomb()

    def end(_: str) -> None:
        nonlocal depth, held
        if depth:
            depth -= 1
            if not depth:
                held = outside

    package.walk(name, start, end)
    if dependents and dependents * _longest_shared(package, name) > MOST_TRANSLATED:
        raise package.bomb()
    return Extent(cells, formulas > 0)


def _longest_shared(package: Package, name: str) -> int:
    """The most characters in a shared formula; raises `RefusedError` if no cell could hold them."""
    shared = False
    length = longest = 0

    def start(tag: str, attributes: Attributes) -> None:
        nonlocal shared, length
        shared, length = tag == _FORMULA and attributes.get("t") == "shared", 0

    def end(_: str) -> None:
        nonlocal shared
        shared = False

    def text(data: str) -> None:
        nonlocal length, longest
        if shared:
            length += len(data)
            longest = max(longest, length)
            if length > LONGEST_CELL:
                raise package.refused("text-too-long", largest=str(LONGEST_CELL))

    package.walk(name, start, end, text)
    return longest
