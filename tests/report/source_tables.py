"""Cells of tables read from a Typst source, beside the lines of the same quantity at the same position."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import pairwise

from tests.report.calculator import NUMBER, RESULT
from tests.report.source_lines import STRING, plain, typst_formulas

_HEADING = re.compile(r"#N\(\d,\"[^\"]*\",\[(.*?)\]\)")
_AT = re.compile(r"(?:vị trí|position) (\w+)$")
"""How a heading ends that is of one position."""
_HEADS = (['"Vị trí"'], ['"Position"'])
_CELL = re.compile(rf'\[((?:{STRING}|[^"\[\]])*)\]|({STRING})(?=,)')
"""Content in brackets, or a string."""
_LEADING = re.compile(rf"-?{NUMBER}")
_SYMBOL = re.compile(r"\$(?:abs\((.*)\)|(.*))\$")
_HEARD = re.compile(rf'#M\({STRING},(\$(?:{STRING}|[^"$])*\$)\)')
"""A formula with its words."""


@dataclass(frozen=True, slots=True)
class Compared:
    """A cell of a table and what the lines of its quantity come to."""

    position: str
    symbol: str
    shown: str
    told: frozenset[str]

    @property
    def agrees(self) -> bool:
        """But for the sign: a size and an arm have none, a component and a rotation do."""
        return self.shown.lstrip("-") in {number.lstrip("-") for number in self.told}


def cells(source: str) -> Iterator[Compared]:
    """The cells of which a line tells at their position; those of a table without positions of any line."""
    told: dict[tuple[str, str], set[str]] = defaultdict(set)
    shown: list[tuple[str, str, str]] = []
    position = ""
    for block in _printed(source):
        if heading := _HEADING.search(block):
            at = _AT.search(_words(heading[1]))
            position = at[1] if at else ""
        elif "#R(" in block:
            shown += _of_table(block, position)
        else:
            for formula in typst_formulas(block):
                if formula.result:
                    told[position, formula.symbol].add(formula.result)
                    told["", formula.symbol].add(formula.result)
    for position, symbol, number in shown:
        if lines := told.get((position, symbol)):
            yield Compared(position, symbol, number, frozenset(lines))


def columns(source: str) -> Mapping[str, Sequence[Mapping[str, Decimal]]]:
    """The columns of tables at positions, by the symbols above them: the numbers by their positions.

    What a plan and a formula give stands in two tables under one symbol.
    """
    found: dict[str, list[Mapping[str, Decimal]]] = defaultdict(list)
    for block in _printed(source):
        if "#R(" in block:
            table: dict[str, dict[str, Decimal]] = defaultdict(dict)
            for position, symbol, number in _of_table(block, ""):
                if position:
                    table[symbol][position] = Decimal(number)
            for symbol, column in table.items():
                found[symbol].append(column)
    return found


def extremes(source: str) -> Iterator[tuple[str, Decimal]]:
    """Quantities of the table of largest values with their sizes."""
    for block in _printed(source):
        if block.endswith('#label("tab.extremes")'):
            for row in block.split("\n")[1:]:
                for symbol, cell in pairwise(_cells(row)):
                    name, number = _SYMBOL.fullmatch(symbol), _LEADING.match(plain(_words(cell)))
                    if name and number:
                        yield name[1] or name[2], abs(Decimal(number[0]))


def _cells(row: str) -> list[str]:
    return [content or string for content, string in _CELL.findall(row)]


def _printed(source: str) -> list[str]:
    """The blocks of a source without the words of their formulas."""
    return _HEARD.sub(r"\1", source).split("\n\n")


def _of_table(block: str, position: str) -> Iterator[tuple[str, str, str]]:
    """(position, symbol, number) of a table: under a symbol at positions, or behind one in its row.

    Coordinates stand under their symbols without a unit, in mm: their lines are in m.
    """
    first, *rows = block[block.index("#R(") :].split("\n")
    head, _, units = first.partition(",((")[2].partition("),([],")
    heads = _cells(head)
    at_positions = heads[:1] in _HEADS
    in_mm = at_positions and not units
    for row in rows:
        found = _cells(row)
        if at_positions and found:
            pairs = zip(heads[1:], found[1:], strict=False)
            for symbol, number in _numbers(pairs):
                yield _words(found[0]), symbol, f"{Decimal(number).scaleb(-3):f}" if in_mm and number != "0" else number
        else:
            yield from ((position, symbol, number) for symbol, number in _numbers(pairwise(found)))


def _numbers(pairs: Iterator[tuple[str, str]]) -> Iterator[tuple[str, str]]:
    for symbol, cell in pairs:
        name, number = _SYMBOL.fullmatch(symbol.strip()), RESULT.fullmatch(plain(_words(cell)))
        if name and number:
            yield name[1] or name[2], number["number"]


def _words(cell: str) -> str:
    """The strings of a cell in one."""
    return "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', cell))
