"""A synthesis as a case: report and task with their tables, key, results, drawing sheet."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from reportgen.base.records import Record
from reportgen.base.template_access import view
from reportgen.base.units import MM
from reportgen.case.design_case import DesignPage
from reportgen.case.result_entries import ResultEntries
from reportgen.catalogue.extreme_positions import BEYOND, PivotPlace
from reportgen.document import Column, Equation, InlineMath, Inlines, Table, Text, Value
from reportgen.drawing import Scene
from reportgen.drawing.plates import DrawingPlate
from reportgen.formula import Chain, Number, Symbol
from reportgen.sheets.plates import drawn
from reportgen.structure import synthesis_drawings
from reportgen.structure import synthesis_ids as ids
from reportgen.structure.synthesis_solution import SolvedSynthesis, number_of

NARROW, WIDE = 22.0, 26.0
"""Widths (mm) of the columns of tables."""


@view()
class SolutionView(Record):
    """A solution for the templates: the ids of its worked lines, β, and what its words depend on."""

    centre: Sequence[str]
    place: Sequence[str]
    links: Sequence[str]
    branch: Sequence[str]
    grashof: Sequence[str]
    transmission: Sequence[str]
    pivot: Symbol
    beyond: bool
    along: tuple[Equation, ...]
    delta: str
    angle: str


@dataclass(frozen=True)
class SynthesisPage(DesignPage[SolvedSynthesis]):
    """A synthesis for its templates."""

    NAME, TASK, SUMMARY = "synthesis", "synthesis-task", "synthesis-summary"
    SECTIONS = (
        *("synthesis-given", "synthesis-circle", "synthesis-links", "synthesis-checks", "synthesis-choice"),
        "synthesis-conclusion",
    )
    SHORT: ClassVar[frozenset[str]] = frozenset()

    def names(self) -> dict[str, Any]:
        case, given = self.case, self.case.given
        written = case.printed
        lines: dict[str, list[str]] = {"choice": []}
        lines |= {name: list(written.known(quantities)) for name, quantities in written.lines.items()}
        chosen = number_of(case.chosen)
        single = len(case.solved) == 1
        return {
            **self.shared_names,
            "rocker": case.has_rocker,
            "searched": given.best is not None,
            "data": self.data,
            "single": single,
            "side_is_given": given.A is not None,
            "only_beyond": single and case.solved[0].side == BEYOND,
            "solutions": [self.solution(place, lines) for place in case.solved],
            "table": self.table_of_solutions,
            "chosen": Symbol("A", "", case.mark(chosen)),
            "crank": ids.CRANK if case.shares_crank else ids.crank(chosen),
            "coupler": ids.coupler(case.number_of_crank(chosen)),
            "frame": ids.FRAME if given.d is not None else ids.frame(chosen),
            "offset": ids.OFFSET,
            "least": ids.transmission(chosen),
            "permitted": ids.PERMITTED,
            "poor": case.is_poor,
            **self.better_length(),
            "sheet": lines,
        }

    def solution(self, place: PivotPlace, lines: Mapping[str, list[str]]) -> SolutionView:
        """Return a solution for the templates."""
        case, n = self.case, number_of(place)
        worked = case.printed.chain(ids.along(case.number_of_crank(n))).parts
        of = {name: lines.get(f"{name}{n}", []) for name in ("centre", "place", "links", "branch", "grashof")}
        return SolutionView(
            **of,
            transmission=lines.get(f"transmission{n}", []),
            pivot=Symbol("A", "", case.mark(n)),
            beyond=place.side == BEYOND,
            along=(Equation((Chain((worked[0], worked[-1])),)),),
            delta=ids.pivot_angle(n),
            angle=ids.transmission(n),
        )

    def better_length(self) -> dict[str, Any]:
        """Return the greatest least transmission angle that is possible, and the length that gives it, by its name.

        Every value is "" unless the chosen solution is poor and its length is given.
        """
        case, given = self.case, self.case.given
        better: dict[str, Any] = dict.fromkeys(("best_angle", "best_frame", "best_crank", "best_offset"), "")
        if not case.is_poor or given.best is not None:
            return better
        place, mm = case.best_place, case.ledger.printed_unit("mm")
        angle = math.degrees(case.transmission_of(place))
        along = np.array(place.along)
        length = case.wanted.crank(along) if given.a is not None else case.wanted.frame(place.side, along)
        name = "best_crank" if given.a is not None else "best_frame" if case.has_rocker else "best_offset"
        better[name] = Value(Number(float(length) * MM, 2, mm))
        return better | {"best_angle": Value(Number(angle, 2, "°"))}

    @property
    def table_of_solutions(self) -> Table:
        """The table of the lengths and the least transmission angle of each solution."""
        case, written = self.case, self.case.printed
        rows: list[tuple[Inlines, ...]] = []
        heads: tuple[Inlines, ...] = ()
        for place in case.solved:
            n = number_of(place)
            columns = [ids.CRANK if case.shares_crank else ids.crank(n), ids.coupler(case.number_of_crank(n))]
            if case.has_rocker:
                columns += [ids.ROCKER, ids.FRAME if case.given.d is not None else ids.frame(n)]
            else:
                columns.append(ids.OFFSET)
            columns.append(ids.transmission(n))
            if not heads:
                symbols = [written.symbol(id) for id in columns]
                heads = ((Text(""),), *((InlineMath(Symbol(one.base, one.sub)),) for one in symbols))
            name: Inlines = (InlineMath(Symbol("A", "", case.mark(n))),)
            rows.append((name, *((self.value(id),) for id in columns)))
        columns_of = (Column(NARROW), *(Column(WIDE) for _ in heads[1:]))
        return self.table("solutions", columns_of, (heads,), rows)

    def scenes(self, name: str) -> Iterable[Scene]:
        if name == "construction":
            return (synthesis_drawings.construction(self.case, place) for place in self.case.solved)
        if name == "transmission":
            return (synthesis_drawings.transmission(self.case),)
        raise KeyError(name)


@dataclass(frozen=True)
class SynthesisCase(SolvedSynthesis):
    """A synthesis, as a `Case`."""

    PAGE = SynthesisPage

    @cached_property
    def entries(self) -> ResultEntries:
        """The circle (m, rad) and, by their numbers, the lengths (m) and angles (rad) of all solutions."""

        def value(id: str) -> float:
            return float(self.ledger[id].values[0])

        solutions: dict[str, dict[str, float]] = {}
        for place in self.solved:
            n = number_of(place)
            lengths = {
                "crank": value(ids.CRANK if self.shares_crank else ids.crank(n)),
                "coupler": value(ids.coupler(self.number_of_crank(n))),
            }
            if self.has_rocker:
                lengths["rocker"] = value(ids.ROCKER)
                lengths["frame"] = value(ids.FRAME if self.given.d is not None else ids.frame(n))
            else:
                lengths["offset"] = value(ids.OFFSET)
            solutions[str(n)] = {
                "place": value(ids.along(self.number_of_crank(n))),
                **lengths,
                "transmission": value(ids.transmission(n)),
            }
        position = {
            "number": 1,
            "circle": {"theta": value(ids.ANGLE), "radius": value(ids.RADIUS)},
            "solutions": solutions,
            "chosen": number_of(self.chosen),
        }
        return ResultEntries([position])

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return the constructions, the transmission angle and the lengths; `sets` is ignored, since there is one."""
        page, captions = SynthesisPage(self), self.words["synthesis"]["captions"]
        table = drawn(page.table_of_solutions, self.assignment.language)
        tables = DrawingPlate(captions["solutions"], (), "tables", (table,), spare=True)
        return {"synthesis": [*synthesis_drawings.plates(self), tables]}
