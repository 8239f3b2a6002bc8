"""The sources of plates: a report and the same report drawn small, its scenes with their words, and tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from reportgen.base.records import Record
from reportgen.case import MachineAnalysis
from reportgen.document import Text, plain
from reportgen.document.cjk_punctuation import set_out
from reportgen.drawing import Content, Scene
from reportgen.drawing.drawing_sheet import ENLARGED, grid, widths
from reportgen.formula import Number
from reportgen.report.assur_view import AssurView
from reportgen.report.context import ReportContext

WIDEST, MOST_ROWS = 180.0, 24
"""Largest width (mm) and largest number of positions of a table; further ones get another table beside it."""


SEGMENT = 2
"""Decimals of lengths on paper, mm."""


class Sources(Record):
    """The sources of plates: a report, and the same report with small figures, which are then enlarged.

    With `every`, each plan has its own plate; those of velocities and accelerations use the scales of the worked plans.
    """

    report: ReportContext
    small: ReportContext
    every: bool = False

    @classmethod
    def of(cls, case: MachineAnalysis, every: bool = False) -> Sources:
        return cls(ReportContext(case), ReportContext(case, enlarged=ENLARGED), every)

    @property
    def words(self) -> Mapping[str, Any]:
        words: Mapping[str, Any] = self.report.words["plates"]
        return words

    def called(self, group: AssurView) -> str:
        """Return the name of a group in words: Group (2,3)."""
        return group.title(self.report.words["figure"])

    def place(self, k: int, of: str = "") -> str:
        """Return the name of a position, of a group `of` if given: Group (2,3), position 2."""
        word = f"{self.report.words['table']['position']} {self.report.machine.position(k)}"
        language = self.report.assignment.language
        line = Text(f"{of}, {word[0].lower()}{word[1:]}" if of else word)
        return plain(set_out((line,), language), language)


class Drawn(Record):
    """The scenes of a plate, drawn small; `name` is its key among the words, the others are as in `DrawingPlate`."""

    name: str
    layer: str
    scenes: Sequence[Scene]
    lines: tuple[Content, ...] = ()
    family: str = ""
    larger: Callable[[], Drawn] | None = None
    """The same at the next larger standard scale, if it may be drawn at one."""


Listed = Callable[[ReportContext], Sequence[str]]


def table_of(sources: Sources, name: str, listed: Sequence[Listed], cycle: bool = False) -> Iterator[Drawn]:
    """Yield a plate of tables of the listed quantities; `name` is its key among the words."""
    yield Drawn(name, "tables", grids(sources.report, listed, cycle))


def grids(report: ReportContext, listed: Sequence[Listed], cycle: bool = False) -> list[Scene]:
    """Return quantities at the positions of one turn, or of the cycle, in as many tables as they need."""
    at = report.all_positions if cycle else report.positions
    tabulated = dict.fromkeys(id for columns in listed for id in columns(report))
    listed_ids = [id for id in tabulated if not all(report.is_zero(id, k) for k in at)]
    parts = -(-len(at) // MOST_ROWS)
    rows = [at[len(at) * n // parts : len(at) * (n + 1) // parts] for n in range(parts)]
    head, every = _quantities(report, listed_ids, at)
    first, *across = widths([*head, *every])
    columns: list[list[str]] = []
    right = math.inf
    for id, width in zip(listed_ids, across, strict=True):
        right += ENLARGED * width
        if right > WIDEST:
            columns.append([])
            right = ENLARGED * (first + width)
        columns[-1].append(id)
    return [grid(*_quantities(report, some, at)) for some in columns for at in rows]


def _quantities(
    report: ReportContext, quantities: Sequence[str], positions: Sequence[int]
) -> tuple[list[list[Content]], list[list[Content]]]:
    """Return the head of a table of quantities, and its rows."""
    head: list[list[Content]] = [
        [report.words["table"]["position"], *(report.ledger.symbol(id) for id in quantities)],
        ["", *(unit_of(report, id) for id in quantities)],
    ]
    return head, [[str(report.machine.position(k)), *(bare(report, id, k) for id in quantities)] for k in positions]


def unit_of(report: ReportContext, id: str) -> str:
    """Return the printed unit of a quantity."""
    unit = report.ledger[id].how.unit
    return str(report.ledger.units.get(unit, unit))


def bare(report: ReportContext, id: str, k: int | None) -> Content:
    """Return a number without its unit, or a dash for a value that does not exist."""
    family, number = report.ledger[id], report.ledger.number(id, k)
    if family.kind == "segment" and number.value:
        return Number(number.value, SEGMENT)
    if math.isnan(number.value) or (family.is_of_vector and report.is_zero(family.of, k)):
        return "–"
    return Number(number.value, number.decimals)
