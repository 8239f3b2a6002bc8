"""The names that the templates of a cam's report and task may use: tables, worked lines, figures.

`CamPage.names` collects them from the page's properties. The base class `DesignPage` describes the other methods.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from reportgen.base.records import Record
from reportgen.base.template_access import view
from reportgen.base.units import MM
from reportgen.cam import cam_ids
from reportgen.cam.diagrams import curvature_chart, law_diagrams, pressure_chart
from reportgen.cam.drawings import inversion, limit_diagram
from reportgen.cam.file import ALLOWED, Judged, exceeded, judged
from reportgen.cam.ledger import MOVING
from reportgen.cam.motion_laws import FollowerLaw, Piece
from reportgen.cam.solution import SolvedCam
from reportgen.case import AskedFor
from reportgen.case.design_case import DesignPage
from reportgen.document import Cell, Column, Equation, InlineMath, Inlines, Table, Text, Value, listed
from reportgen.document.template_rendering import Prose
from reportgen.drawing import Scene
from reportgen.formula import Call, Chain, Expression, Number, Symbol, substitute
from reportgen.formula.plain_text import formula

CHECKS = (74.0, 30.0, 30.0, 26.0)
ROWS = 16.0
"""The width of the column of positions (mm)."""
WIDEST = 27.0
ANGLE = 2
DUST = 1e-12
"""Rounding error of floats in a length (m)."""
NODES = (16.0, 22.0, 28.0, 28.0, 28.0, 28.0)


@view()
class LawView(Record):
    """The law of a phase: the key of its phrase, and its formulas piece by piece with their ranges of angles."""

    phase: str
    equation: Equation
    table: tuple[Table, ...]
    displaced: bool
    """True if the table gives displacements, False if it gives accelerations."""


@view()
class ImpactView(Record):
    """Impacts of one kind, and the angles at which they are."""

    rigid: bool
    angles: Inlines


class RequirementView(Record):
    """A requirement: the key of its phrase, the limit with its sign, the actual value, and whether it holds."""

    key: str
    sign: str
    wanted: Number
    actual: Number
    holds: bool


@dataclass(frozen=True)
class CamPage(DesignPage[SolvedCam]):
    """A cam as templates read it."""

    NAME, TASK, SUMMARY = "cam", "cam-task", "cam-summary"
    SECTIONS = (
        *("cam-given", "cam-law", "cam-diagrams", "cam-motion-table", "cam-limits", "cam-choice", "cam-pressure"),
        *("cam-profile", "cam-curvature", "cam-checks", "cam-conclusion"),
    )
    SHORT = frozenset({"cam-diagrams", "cam-curvature"})
    SWITCHES: ClassVar = {"cam-limits": ("limits",)}

    @cached_property
    def judged(self) -> Judged:
        return judged(self.case.solution.cam)

    def has(self, section: str) -> bool:
        """Return False for "cam-limits" and "cam-pressure" if the cam does not need them, True for other sections."""
        flat = self.case.solution.cam.flat
        return {"cam-limits": flat or super().has(section), "cam-pressure": not flat}.get(section, True)

    def asked(self, asked: AskedFor) -> dict[str, Any]:
        """Return the further name `asked` of the task: the positions that its questions ask for, as a list in words."""
        return {"asked": listed(map(Text, asked.positions))}

    def names(self) -> dict[str, Any]:
        """Return the names that the templates may use, each with its value or function."""
        case, cam, given = self.case, self.case.solution.cam, self.case.solution.given
        designed = case.solution.designed
        exceeded, undercut = self.exceeded, self.undercut
        all_hold = all(one.holds for one in self.required)
        return {
            **self.shared_names,
            "full": self.full,
            # kind of the cam
            "translating": cam.translating,
            "flat": cam.flat,
            "roller": bool(cam.roller),
            "offset": bool(cam.e),
            "has_axis": cam.translating and not cam.flat,
            "sliding_face": cam.translating and cam.flat,
            "turning_face": cam.flat and not cam.translating,
            "one_curve": not cam.roller,
            "opposite": cam.opposite > 0,
            "lifts": self.lifts,
            "clockwise": cam.turn < 0,
            "with_speed": given.n is not None,
            # requested values and limits
            "finds": given.finds,
            "several": len(given.finds) > 1,
            "finds_e": given.seeks("e"),
            "finds_roller": given.seeks("roller"),
            "found": listed(InlineMath(case.ledger.symbol(_id(key))) for key in given.finds),
            "chosen": tuple(map(_id, given.finds)),
            "has_limits": designed.limits.rise is not None,
            "limited": designed.limits.rise is not None and not cam.flat,
            "both_limits": designed.limits.back is not None,
            "usual": designed.usual,
            "least": designed.least is not None,
            "apex": "cam.apex.s0" in case.ledger,
            "apex_is_least": designed.least is not None and designed.least.rule == "apex",
            "deciding": self.deciding,
            # laws, positions, tables
            "laws": self.laws,
            "law_words": self.law_words,
            "impacts": self.impacts,
            "worked": case.worked,
            "count": case.count,
            "phase_of": lambda k: self.words["phases"][case.solution.intervals[k - 1].phase],
            "data": self.data,
            "motion_table": self.motion_table,
            "profile_table": self.profile_table,
            # checks
            "checks": self.checks,
            "extremes": self.judged,
            "exceeded": exceeded,
            "undercut": undercut,
            "lacking": not (exceeded or undercut or all_hold),
            "sound": not (exceeded or undercut) and all_hold,
            # symbols, numbers, lines, figures
            "sheet": {name: case.printed.known(quantities) for name, quantities in case.printed.lines.items()},
            "value": self.value,
            "angle": lambda angle: Value(Number(math.degrees(angle), ANGLE, "°")),
            "length": lambda size: Value(Number(size * MM, 3, self.case.ledger.printed_unit("mm"))),
        }

    @property
    def deciding(self) -> Mapping[str, str]:
        """Return the deciding limit line: its phase in words, and the ids of the values read where it touches."""
        least = self.case.solution.designed.least
        if least is None:
            return {}
        rule = "return" if least.rule == "return" else "rise"
        read = {name: cam_ids.touch(MOVING[rule], name) for name in ("phi", "psi", "dpsi")}
        return {"phase": str(self.words["phases"][rule]), **read}

    # --- data

    @property
    def data(self) -> Table:
        """Return the table of data with names, symbols and values, without values that were found."""
        case, finds = self.case, self.case.solution.given.finds
        hidden = {_id(key) for key in finds}
        if case.solution.designed.usual:
            hidden.add(cam_ids.limit("return"))
        rows = list(self.given_rows(hidden))
        for key in ("follower", "end", "lifts", "direction", "closed_by"):
            if (said := self._choice(key)) is not None:
                rows.append(((Text(said[0]),), (Text("–"),), (Text(said[1]),)))
        for phase, text in self.law_words.items():
            rows.append(((Text(self.words["law_of"][phase]),), (Text("–"),), (Text(text),)))
        return self.data_table(rows)

    def _choice(self, key: str) -> tuple[str, str] | None:
        """Return a choice of the file in words; None if it is not printed."""
        given = self.case.solution.given
        if key == "lifts" and given.translating:
            return None
        table = self.words["choices"][key]
        return str(table["name"]), str(table[getattr(given, key)])

    @property
    def law_words(self) -> Mapping[str, str]:
        motion = self.case.solution.motion
        return {
            phase: str(self.words["laws"][law.name]) for phase, law in (("rise", motion.rise), ("return", motion.back))
        }

    @property
    def lifts(self) -> str:
        return str(self.words["choices"]["lifts"][self.case.solution.given.lifts])

    # --- the laws

    @property
    def laws(self) -> tuple[LawView, ...]:
        motion = self.case.solution.motion
        return tuple(
            LawView(phase, self._formulas(phase, law), self._nodes(phase, law), law.name == "displacements")
            for phase, law in (("rise", motion.rise), ("return", motion.back))
        )

    def _formulas(self, phase: str, law: FollowerLaw) -> Equation:
        """Return s, s′ and s″ by x, piece by piece; for a graph one piece with the indices of its nodes."""
        ledger, names = self.case.printed, self.case.solution.moved
        rows: list[Expression] = []
        intervals = [interval for interval in self.case.solution.motion.intervals if interval.phase == phase]
        numbers = [n for n, interval in enumerate(self.case.solution.motion.intervals) if interval.phase == phase]
        for n, interval in zip(numbers, intervals, strict=True):
            note = self._between(interval.piece) if len(intervals) > 1 and law.table is None else ""
            for id in names:
                definition = self.case.ledger[id].definition
                assert isinstance(definition, Call)
                branch = definition.arguments[1 + n]
                formula = substitute(branch, lambda ref: ledger.symbol(ref.id))
                rows.append(Chain((ledger.symbol(id), formula), note if id == names[0] else ""))
            if law.table is not None and len(intervals) > 2:
                break
        return Equation(tuple(rows))

    def _between(self, piece: Piece | None) -> str:
        """Return the range of x in which a piece holds."""
        assert piece is not None
        low, high = (formula(Number(one), self.case.assignment.language) for one in (piece.start, piece.stop))
        return f"{low} ≤ x ≤ {high}"

    def _nodes(self, phase: str, law: FollowerLaw) -> tuple[Table, ...]:
        """Return the table of an acceleration graph, integrated twice at its nodes."""
        if law.table is None:
            return ()
        number = MOVING[phase]
        columns = ("x", "A", "V", "S", "J")
        head = (Cell((InlineMath(Symbol("i")),)), *(Cell((InlineMath(Symbol(one, f"{number},i")),)) for one in columns))
        rows = [
            (Cell((Text(str(i)),)), *(Cell(self._at_node(cam_ids.node(number, i, one))) for one in columns))
            for i in range(len(law.table.x))
        ]
        caption = Prose(self.case.places).inlines(
            self.words["captions"]["nodes"].format(phase=self.words["phases"][phase])
        )
        return (Table(tuple(map(Column, NODES)), (head,), tuple(rows), caption, f"tab.nodes.{phase}"),)

    def _at_node(self, id: str) -> Inlines:
        return (Value(self.case.printed.number(id)) if id in self.case.printed else Text("–"),)

    @property
    def impacts(self) -> tuple[ImpactView, ...]:
        """Return the kinds of impact with their angles."""
        angles_by_kind: dict[str, list[float]] = {}
        for impact in self.case.solution.motion.impacts:
            angles_by_kind.setdefault(impact.kind, []).append(math.degrees(impact.angle))
        return tuple(
            ImpactView(kind == "rigid", listed(Value(Number(float(f"{angle:.6g}"), None, "°")) for angle in angles))
            for kind, angles in angles_by_kind.items()
        )

    # --- tables of the positions

    @property
    def motion_table(self) -> Table:
        lines = self.case.printed.known(self.case.printed.lines["motion"])
        return self._positions("motion", ("cam.phi", *(id for id in lines if id != "cam.z")))

    @property
    def profile_table(self) -> Table:
        lines = self.case.printed.lines
        columns = ("cam.contact", "cam.alpha", *lines["points"], "cam.rho", "cam.rho.working")
        name = "profile_flat" if self.case.solution.cam.flat else "profile"
        return self._positions(name, ("cam.phi", *self.case.printed.known(columns)))

    def _positions(self, name: str, quantities: Sequence[str]) -> Table:
        """Return the table of quantities over the positions, a row for each position."""
        ledger, words = self.case.printed, self.case.words["table"]
        units = [ledger.units.get(ledger[id].how.unit, ledger[id].how.unit) for id in quantities]
        heads = (
            (Cell((Text(str(words["position"])),)), *(Cell((InlineMath(ledger.symbol(id)),)) for id in quantities)),
            (Cell(), *(Cell((Text(unit),)) for unit in units)),
        )
        rows = [
            (Cell((Text(str(k)),)), *(Cell(self._bare(id, k)) for id in quantities))
            for k in range(1, self.case.count + 1)
        ]
        width = min((160.0 - ROWS) / len(quantities), WIDEST)
        columns = (Column(ROWS), *(Column(width),) * len(quantities))
        return Table(columns, heads, tuple(rows), self.caption(name), f"tab.{name}")

    def _bare(self, id: str, k: int) -> Inlines:
        number = self.case.printed.result(id, k)
        if not math.isfinite(number.value):
            return (Text("–"),)
        return (Value(Number(number.value, number.decimals)),)

    # --- checks

    @property
    def exceeded(self) -> tuple[str, ...]:
        """Return the keys of the phases in which the pressure angle exceeds its limit."""
        return tuple(phase for phase, _, _ in exceeded(self.case.solution.designed))

    @property
    def undercut(self) -> Inlines:
        """Return the cam angles (degrees) at which the profile is undercut, as a list; empty if there are none."""
        angles = self.case.solution.cam.undercut
        return listed(Value(Number(math.degrees(angle), 1, "°")) for angle in angles)

    @cached_property
    def required(self) -> tuple[RequirementView, ...]:
        """Return the requirements with the actual values, and whether they are met."""
        return tuple(self._required())

    def _required(self) -> Iterator[RequirementView]:
        designed, seen = self.case.solution.designed, self.judged
        cam, limits, mm = designed.cam, designed.limits, self.case.ledger.printed_unit("mm")
        for phase, limit, extreme in (("rise", limits.rise, seen.rise), ("return", limits.back, seen.back)):
            if limit is not None and not cam.flat:
                size = Number(math.degrees(extreme[1]), ANGLE, "°")
                most = Number(float(f"{math.degrees(limit):.6g}"), None, "°")
                yield RequirementView(phase, "≤ ", most, size, extreme[1] <= limit + ALLOWED)
        least, left = Number(float(f"{limits.rho * MM:.6g}"), None, mm), seen.least_working[1]
        yield RequirementView("rho", "≥ ", least, Number(left * MM, 3, mm), left >= limits.rho - DUST)
        if cam.roller:
            for key, radius in (("roller_rho", 0.8 * seen.least_rho[1]), ("roller_r0", 0.4 * cam.r0)):
                size = Number(float(f"{cam.roller * MM:.6g}"), None, mm)
                yield RequirementView(key, "≤ ", Number(radius * MM, 3, mm), size, cam.roller <= radius + DUST)

    @property
    def checks(self) -> Table:
        """Return the table of the requirements: name, limit, actual value, and yes or no."""
        words = self.words["checks"]
        rows = [
            (
                Cell((Text(str(words[requirement.key])),)),
                Cell((Text(requirement.sign), Value(requirement.wanted))),
                Cell((Value(requirement.actual),)),
                Cell((Text(str(words["yes" if requirement.holds else "no"])),)),
            )
            for requirement in self.required
        ]
        head = tuple(Cell((Text(str(requirement)),)) for requirement in words["head"])
        widths = (Column(CHECKS[0], "left"), *(Column(requirement) for requirement in CHECKS[1:]))
        return Table(widths, (head,), tuple(rows), self.caption("checks"), "tab.checks")

    # --- figures

    def scenes(self, name: str) -> Iterator[Scene]:
        """Yield the drawing of a figure by its name, for example "law" or "profile".

        Raises `KeyError` for an unknown name.
        """
        match name:
            case "law":
                yield law_diagrams(self.case)
            case "limits":
                yield limit_diagram(self.case)
            case "pressure":
                yield pressure_chart(self.case).scene
            case "displacements":
                yield inversion(self.case, "displacements")
            case "inversion":
                yield inversion(self.case)
            case "profile":
                yield inversion(self.case, "cam")
            case "curvature":
                yield curvature_chart(self.case).scene
            case _:
                raise KeyError(name)


def _id(key: str) -> str:
    """Return the id of a length that may be found."""
    return {"r0": "cam.r0", "e": "cam.e", "a": "cam.a", "roller": "cam.roller"}[key]
