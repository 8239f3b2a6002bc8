"""A turning-moment diagram as a case: report and task with their tables, key, results, drawing sheet, page."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from reportgen.case.design_case import DesignPage
from reportgen.case.result_entries import ResultEntries
from reportgen.case.shafts import Shaft
from reportgen.document import Block, Column, Equation, InlineMath, Inlines, Table, Text, Value
from reportgen.drawing import Scene
from reportgen.drawing.animation import Animation
from reportgen.drawing.plates import DrawingPlate
from reportgen.flywheel import turning_drawings, turning_ids, turning_motion
from reportgen.flywheel.turning_calculation import extreme_points
from reportgen.flywheel.turning_file import Torques
from reportgen.flywheel.turning_solution import SolvedTurning
from reportgen.flywheel.turning_torques import DRIVING, RESISTING
from reportgen.formula import Chain, Expression, Number, Symbol, cos, plus, sin
from reportgen.sheets.plates import drawn

LINES = "mean", "factor", "per_speed", "points", "scale", "areas", "share", "power", "acceleration"
"""Names of lines that only some files have."""
FIRST, WIDTH = 18.0, 32.0
"""Widths (mm) of the columns of tables."""


@dataclass(frozen=True)
class TurningPage(DesignPage[SolvedTurning]):
    """A turning-moment diagram for its templates."""

    NAME, TASK, SUMMARY = "turning-moment", "turning-task", "turning-summary"
    SECTIONS = (
        *("turning-given", "turning-mean", "turning-points", "turning-areas", "turning-energies", "turning-wheel"),
        *("turning-acceleration", "turning-conclusion"),
    )
    SHORT: ClassVar[frozenset[str]] = frozenset()
    SWITCHES: ClassVar = {"turning-acceleration": ("at",)}

    def has(self, section: str) -> bool:
        """Return False for the mean line and the points if the file gives areas."""
        if section in ("turning-mean", "turning-points"):
            return self.case.given.areas is None
        return super().has(section)

    def names(self) -> dict[str, Any]:
        case, written, given = self.case, self.case.printed, self.case.given
        lines: dict[str, list[str]] = {name: [] for name in LINES}
        lines |= {name: list(written.known(quantities)) for name, quantities in written.lines.items()}
        for name in ("points", "areas", "energies"):
            lines.setdefault(name, [])
        highest, lowest = extreme_points(case.energies)
        tables = [one for one in (given.driving, given.resisting) if one is not None and one.nodes]
        curves = [one for one in (given.driving, given.resisting) if one is not None and one.terms]
        return {
            **self.shared_names,
            "given": given,
            "data": self.data_table(self.given_rows(self._not_in_data)),
            "torque_table": self.torque_table if tables else "",
            "curves": self.curve_equations if curves else "",
            "has_table": bool(tables),
            "has_sum": any(
                id in written and written[id].written is not None for id in (turning_ids.MEAN, turning_ids.MEAN_OF_LOAD)
            ),
            "has_curve": bool(curves),
            "load_curve": given.resisting is not None and bool(given.resisting.terms),
            "load_varies": given.resisting is not None and given.resisting.varies,
            "both_vary": given.driving is not None and given.resisting is not None and given.resisting.varies,
            "by_speed": given.follows_speed,
            "has_areas": given.areas is not None,
            "on_paper": given.areas is not None and given.areas.unit is None,
            "areas_list": self.areas_list if given.areas is not None else "",
            "scaled": turning_ids.FACTOR in written,
            "finds_wheel": given.delta is not None,
            "finds_mass": given.delta is not None and given.k is not None,
            "highest": str(highest),
            "lowest": str(lowest),
            "energy_table": self.energy_table,
            "sheet": lines,
        }

    @property
    def _not_in_data(self) -> tuple[str, ...]:
        """Ids of data that are not in the table of data: a mean torque that the equation gives."""
        equations = any(one is not None and one.terms for one in (self.case.given.driving, self.case.given.resisting))
        return (turning_ids.MEAN,) if equations else ()

    # --- what is given

    @property
    def curve_equations(self) -> Equation:
        """The equations of torques that are given by their harmonics."""
        case = self.case
        rows: list[Expression] = []
        for side, torques in ((DRIVING, case.given.driving), (RESISTING, case.given.resisting)):
            if torques is not None and torques.terms:
                rows.append(Chain((Symbol("M", side), self._curve(side, torques)), self._torque_unit))
        return Equation(tuple(rows))

    @property
    def _torque_unit(self) -> str:
        return self.case.ledger.printed_unit("N·m")

    def _curve(self, side: str, torques: Torques) -> Expression:
        """Return the formula of a torque with its numbers: 20000 + 9500 sin 2φ − 5700 cos 2φ."""
        ledger = self.case.printed
        mean = turning_ids.MEAN if side == DRIVING or self.case.given.driving is None else turning_ids.MEAN_OF_LOAD
        first = ledger.number(mean if mean in ledger else turning_ids.MEAN)
        terms: list[Expression] = [Number(first.value, first.decimals)]
        for number, term in enumerate(torques.harmonics, start=1):
            angle: Expression = Symbol("φ") if term.order == 1 else Number(term.order) * Symbol("φ")
            for family, function in ((turning_ids.sine, sin), (turning_ids.cosine, cos)):
                amplitude = ledger.number(family(side, number))
                if amplitude.value:
                    size = Number(abs(amplitude.value), amplitude.decimals) * function(angle)
                    terms.append(size if amplitude.value > 0 else -size)
        return plus(*terms)

    @property
    def torque_table(self) -> tuple[Block, ...]:
        """The tables of torques over the crank angle."""
        case, tables = self.case, list[Block]()
        for side, torques in ((DRIVING, case.given.driving), (RESISTING, case.given.resisting)):
            if torques is not None and torques.nodes:
                tables.append(self._table_of(side, len(torques.nodes)))
        return tuple(tables)

    def _table_of(self, side: str, count: int) -> Table:
        """Return the table of a torque, in as many pairs of columns as fit beside each other."""
        printed = self.case.printed
        pairs = 1 if count <= 8 else 2 if count <= 30 else 3
        rows_in = -(-count // pairs)
        symbols: list[Inlines] = [(InlineMath(Symbol("φ")),), (InlineMath(Symbol("M", side)),)] * pairs
        units: list[Inlines] = [(Text("°"),), (Text(self._torque_unit),)] * pairs
        rows: list[tuple[Inlines, ...]] = []
        for row in range(rows_in):
            cells: list[Inlines] = []
            for number in range(row + 1, rows_in * pairs + 1, rows_in):
                for family in (turning_ids.node_angle, turning_ids.node_torque):
                    id = family(side, number)
                    cells.append(self._bare(id) if id in printed else (Text(""),))
            rows.append(tuple(cells))
        name = "driving" if side == DRIVING else "resisting"
        return self.table(name, tuple(Column(WIDTH - 8) for _ in symbols), (symbols, units), rows)

    @property
    def areas_list(self) -> Table:
        """The table of the given areas."""
        printed, on_paper = self.case.printed, self.case.given.areas is not None and self.case.given.areas.unit is None
        family = turning_ids.on_paper if on_paper else turning_ids.area
        ids = [family(k) for k in range(1, self.case.count_of_areas + 1)]
        per_row = 8
        heads = ((Text(str(self.words["heads"]["number"])),), (Text(printed.number(ids[0]).unit),))
        pairs = 1 if len(ids) <= per_row else 2 if len(ids) <= 2 * per_row else 3
        rows_in = -(-len(ids) // pairs)
        rows: list[tuple[Inlines, ...]] = []
        for row in range(rows_in):
            cells: list[Inlines] = []
            for k in range(row, rows_in * pairs, rows_in):
                cells += [(Text(str(k + 1)),), self._bare(ids[k])] if k < len(ids) else [(Text(""),), (Text(""),)]
            rows.append(tuple(cells))
        return self.table("measured", (Column(FIRST), Column(WIDTH)) * pairs, (heads * pairs,), rows)

    def _bare(self, id: str) -> Inlines:
        """Return a number without its unit, which is in the head of its column."""
        number = self.case.printed.number(id)
        return (Value(Number(number.value, number.decimals)),)

    # --- tables and figures

    @property
    def energy_table(self) -> Table:
        """The table of the points: angle, energy there, and the area that follows."""
        printed, case = self.case.printed, self.case
        families = [turning_ids.energy, turning_ids.area]
        if case.given.areas is None:
            families.insert(0, turning_ids.point)
        heads: list[Inlines] = [(Text(str(self.words["heads"]["point"])),)]
        heads += [(InlineMath(Symbol(printed.symbol(family(1)).base)),) for family in families]
        heads.append((Text(""),))
        units: list[Inlines] = [(Text(""),), *((Text(printed.number(family(1)).unit),) for family in families)]
        units.append((Text(""),))
        # Of equal energies the first is marked, which the text names.
        marks = dict(zip(extreme_points(case.energies), case.extremes, strict=True))
        rows: list[tuple[Inlines, ...]] = []
        for k in range(1, case.count_of_areas + 1):
            mark: Inlines = (InlineMath(printed.symbol(marks[k])),) if k in marks else (Text(""),)
            rows.append(((Text(str(k)),), *(self._bare(family(k)) for family in families), mark))
        columns = (Column(FIRST), *(Column(WIDTH) for _ in families), Column(FIRST + 4))
        return self.table("energies", columns, (heads, units), rows)

    def scenes(self, name: str) -> Iterable[Scene]:
        return (turning_drawings.FIGURES[name](self.case).scene,)


@dataclass(frozen=True)
class TurningCase(SolvedTurning):
    """A turning-moment diagram, as a `Case`."""

    PAGE = TurningPage

    @property
    def shafts(self) -> Sequence[Shaft]:
        return (Shaft(self.words["turning-moment"]["shaft"], self.speed, 1, datum="n"),)

    @cached_property
    def entries(self) -> ResultEntries:
        """The points of intersection, areas, energies, and the flywheel with its speeds."""
        ids = {
            "mean": turning_ids.MEAN,
            "range": turning_ids.RANGE,
            "work": turning_ids.WORK,
            "share": turning_ids.SHARE,
            "power": turning_ids.POWER,
            "speed": turning_ids.OMEGA,
            "delta": turning_ids.DELTA,
            "inertia": turning_ids.J,
            "mass": turning_ids.MASS,
            "fastest": turning_ids.speed("max"),
            "slowest": turning_ids.speed("min"),
            "torque_at": turning_ids.TORQUE_AT,
            "acceleration": turning_ids.ACCELERATION,
        }
        series = {"areas": self.areas, "energies": self.energies}
        if self.given.areas is None:
            series = {"intersections": self.run.points, **series}
        position: dict[str, Any] = {"number": 1}
        position |= {name: {str(k): one for k, one in enumerate(of, start=1)} for name, of in series.items()}
        position["wheel"] = {name: float(self.ledger[id].at(1)) for name, id in ids.items() if id in self.ledger}
        return ResultEntries([position])

    def animations(self) -> tuple[Animation, ...]:
        return () if self.given.areas is not None else (turning_motion.animation(self),)

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return both diagrams and the table of energies; `sets` is ignored, since there is only one."""
        return {"turning": [*turning_drawings.plates(self), *self._tables()]}

    def _tables(self) -> Iterator[DrawingPlate]:
        caption = self.words["turning-moment"]["captions"]["energies"]
        scenes = (drawn(TurningPage(self).energy_table, self.assignment.language),)
        yield DrawingPlate(caption, (), "tables", scenes, spare=True)
