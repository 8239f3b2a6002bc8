"""A rotor as a case: report and task with their tables, key, results, drawing sheet."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from reportgen.balancing import rotor_drawings, rotor_ids, rotor_motion
from reportgen.balancing.places_page import PlacesPage, bare
from reportgen.balancing.rotor_calculation import AFTER, AXES, BEFORE
from reportgen.balancing.rotor_file import BEARINGS, RIGHT
from reportgen.balancing.rotor_solution import SolvedRotor
from reportgen.base.records import replace
from reportgen.case.missing_chapters import MissingChapter
from reportgen.case.result_entries import ResultEntries
from reportgen.case.shafts import Shaft
from reportgen.document import Cell, Column, Equation, Inline, InlineMath, Inlines, Table, Text, Value
from reportgen.drawing import Scene
from reportgen.drawing.animation import Animation
from reportgen.drawing.figure_scale import IN_REPORT
from reportgen.drawing.plates import DrawingPlate
from reportgen.formula import Chain, Expression, Number, Symbol, total
from reportgen.sheets.plates import drawn

OF_BEARING = rotor_ids.at_bearing, rotor_ids.bearing_force
"""Ids of the loads of each bearing."""
WORKED = 6
"""Largest number of masses whose products are all written out; with more, a line shows only the first."""


@dataclass(frozen=True)
class RotorPage(PlacesPage[SolvedRotor]):
    """A rotor for its templates."""

    NAME, TASK, SUMMARY = "rotor", "rotor-task", "rotor-summary"
    SECTIONS = (
        *("rotor-given", "rotor-scheme", "rotor-products", "rotor-moments-plan", "rotor-plane-plan"),
        *(
            "rotor-masses-plan",
            "rotor-plan",
            "rotor-components",
            "rotor-compared",
            "rotor-bearings",
            "rotor-grade",
            "rotor-conclusion",
        ),
    )
    SHORT = frozenset({"rotor-compared"})

    SWITCHES: ClassVar = {
        "rotor-moments-plan": ("planes.B",),
        "rotor-bearings": ("bearings",),
        "rotor-grade": ("grade",),
    }

    def has(self, section: str) -> bool:
        given = self.case.given
        match section:
            case "rotor-plane-plan":
                return given.finds_plane
            case "rotor-masses-plan":
                return bool(given.sought_masses)
            case "rotor-plan":
                return not given.finds_plane
        return super().has(section) and not (section == "rotor-moments-plan" and self.case.finds)

    @property
    def missing(self) -> list[MissingChapter]:
        """The sections that the file could still bring; with masses that are sought there are no further planes."""
        return [] if self.case.given.sought_masses else super().missing

    def names(self) -> dict[str, Any]:
        case, written = self.case, self.case.printed
        has_data = any(True for _ in self.given_rows())
        lines = {name: written.known(quantities) for name, quantities in written.lines.items()}
        for name in ("unbalances", "moments"):
            if len(case.weighed) > WORKED:
                lines[name] = lines.get(name, [])[:1]
        return {
            **self.shared_names,
            "given": case.given,
            "several": len(case.masses) > 1,
            "every_line": len(case.weighed) <= WORKED,
            "two_planes": case.two_planes,
            "two_plans": case.two_planes or case.finds,
            "dynamic": case.two_planes or case.finds,
            "finds_plane": case.given.finds_plane,
            "finds_masses": bool(case.given.sought_masses),
            "found_masses": self.found_masses,
            "has_couple": case.given.has_couple,
            "mass_is_sought": "m" in case.given.sought,
            "radius_is_sought": "r" in case.given.sought,
            "against": any(case.ledger[rotor_ids.moment(place)].values[0] < 0 for place in case.moments),
            "corrects": {plane: bool(written[rotor_ids.unbalance(plane)].at(1)) for plane in case.planes},
            "corrects_nothing": not case.finds
            and not any(written[rotor_ids.unbalance(plane)].at(1) for plane in case.planes),
            "asks_after": not case.two_planes and case.given.has_couple and not case.finds,
            "leaves_couple": self.leaves_couple,
            "place_is_right": self.place_is_right,
            "grade_met": all(case.permitted or ()),
            "has_data": has_data,
            "data": self.data if has_data else "",
            "masses_table": self.masses_table,
            "products": self.products,
            "components": self.components,
            "compared": self.compared,
            "loads_table": self.loads_table if case.given.bearings else "",
            "closing_moments": self.closing("V", case.moments) if case.two_planes or case.finds else "",
            "closing_unbalances": self.closing("U", case.masses),
            "sheet": lines,
        }

    @property
    def place_is_right(self) -> bool:
        """True if plane B is found to the right of plane A."""
        places = [self.case.printed[id].at(1) for id in map(rotor_ids.station, "BA") if id in self.case.printed]
        return len(places) == 2 and bool(places[0] > places[1])

    @property
    def leaves_couple(self) -> bool:
        """True if the moments about the single plane of correction have a resultant."""
        printed, parts = self.case.printed, [rotor_ids.resultant("V", axis) for axis in AXES]
        return (
            not self.case.two_planes and not self.case.finds and any(printed[id].at(1) for id in parts if id in printed)
        )

    def closing(self, of: str, masses: Sequence[str]) -> Equation:
        """Return the equation of a plan, whose vectors add up to zero: those of the masses and of the corrections."""
        vectors = [Symbol(of, place, over="vector") for place in masses]
        if len(vectors) > WORKED:
            vectors = [*vectors[:2], Symbol("…"), vectors[-1]]
        corrections: list[Expression] = [Symbol(of, plane, over="vector") for plane in reversed(self.case.planes)]
        if of == "V" and self.case.given.sought_masses:
            corrections = []
        elif of == "V":
            corrections = [self.case.printed.symbol("rotor.L") * Symbol("U", "B", over="vector")]
        return Equation((Chain((total([*vectors, *corrections]), Number(0.0))),))

    # --- tables

    @property
    def masses_table(self) -> Table:
        """The table of the given masses."""
        columns = [rotor_ids.mass, rotor_ids.radius, rotor_ids.angle]
        columns += [rotor_ids.station] if self.case.given.has_couple else []
        table = self.by_place("masses", columns, self.case.masses)
        asked = {str(row): Cell((Text("?"),)) for row in self.case.given.sought_masses}
        rows = [
            (row[0], asked.get(place, row[1]), *row[2:])
            for place, row in zip(self.case.masses, table.rows, strict=True)
        ]
        return replace(table, rows=tuple(rows))

    @property
    def found_masses(self) -> Inlines:
        """The masses that are sought, with their values."""
        inlines: list[Inline] = []
        for place in self.case.given.sought_masses:
            inlines += [*([Text(", ")] if inlines else []), *self.quantity(rotor_ids.mass(place))]
        return tuple(inlines)

    @property
    def products(self) -> Table:
        """The table of m r and m r z of each mass, and of their lengths in the plans."""
        case = self.case
        columns = [rotor_ids.unbalance, rotor_ids.moment, rotor_ids.angle]
        plans = [(of, rotor_ids.laid_off.only(of=of)) for of in ("V", "U") if rotor_ids.scale(of) in case.printed]
        columns = [name for name in columns if name(case.masses[0]) in case.printed]
        return self.by_place("products", [*columns, *(name for _, name in plans)], case.masses)

    @property
    def components(self) -> Table:
        """The table of the components of all products, and of their sums."""
        printed, kinds = self.case.printed, ("U", "V") if self.case.moments else ("U",)
        columns = [(of, axis) for of in kinds for axis in "xy"]
        sums = [rotor_ids.resultant(*column) for column in columns]
        rows = [
            ((Text(place),), *(bare(printed.number(rotor_ids.component(*column, place))) for column in columns))
            for place in self.case.weighed
        ]
        rows.append(((Text("Σ"),), *(bare(printed.number(id)) for id in sums)))
        heads = [(printed.symbol(id), printed.number(id).unit) for id in sums]
        return self.headed("components", self.words["heads"]["place"], heads, rows)

    @property
    def compared(self) -> Table:
        """The table of the corrections as measured in the plans and as computed from components."""
        printed, words = self.case.printed, self.words["compared"]
        rows: list[tuple[Inlines, ...]] = []
        sought = [
            (rotor_ids.mass(place), rotor_ids.by_components("m", place)) for place in self.case.given.sought_masses
        ]
        rows += (self._compared(*pair) for pair in sought)
        for plane in self.case.planes:
            pairs = [(rotor_ids.unbalance(plane), rotor_ids.by_components("U", plane))]
            if self.case.given.finds_plane and plane == RIGHT:
                pairs.append((rotor_ids.station(plane), rotor_ids.by_components("z", plane)))
            if rotor_ids.by_components("alpha", plane) in printed and printed[rotor_ids.unbalance(plane)].at(1):
                pairs.append((rotor_ids.direction(plane), rotor_ids.by_components("alpha", plane)))
            rows += (self._compared(*pair) for pair in pairs)
        heads = [(Text(one),) for one in words]
        return self.table("compared", (Column(25.0), *(Column(42.0) for _ in range(3))), (heads,), rows)

    def _compared(self, read: str, computed: str) -> tuple[Inlines, ...]:
        """Return the row of a quantity from the plan, its value by components, and the difference."""
        printed = self.case.printed
        pair = printed.number(read), printed.number(computed)
        off = Number(pair[0].printed - pair[1].printed, max(pair[0].decimals or 0, 1), pair[0].unit)
        return (InlineMath(printed.symbol(read)),), *((Value(one),) for one in (*pair, off))

    @property
    def loads_table(self) -> Table:
        """The table of the load of each bearing before and after balancing."""
        printed, words = self.case.printed, self.words["loads"]
        columns = [(family, when) for when in (BEFORE, AFTER) for family in OF_BEARING]
        ids = {place: [family(when, place) for family, when in columns] for place in BEARINGS}
        rows = [((Text(place),), *(bare(printed.number(id)) for id in ids[place])) for place in BEARINGS]
        heads = [(replace(printed.symbol(id), sub=""), printed.number(id).unit) for id in ids[BEARINGS[0]]]
        return self.headed("loads", words["bearing"], heads, rows)

    # --- figures

    def scenes(self, name: str) -> Iterable[Scene]:
        _, draw = rotor_drawings.FIGURES[name]
        return (draw(self.case, IN_REPORT),)


# --- the case --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class RotorCase(SolvedRotor):
    """A rotor, as a `Case`."""

    PAGE = RotorPage
    SAME = (
        *(
            tuple(family(when, place) for when in (BEFORE, AFTER) for place in BEARINGS)
            for family in (*OF_BEARING, rotor_ids.in_metres)
        ),
        tuple(rotor_ids.share(when, axis, at) for when in (BEFORE, AFTER) for axis in "xy" for at in BEARINGS),
    )

    @property
    def shafts(self) -> Sequence[Shaft]:
        if self.given.n is None:
            return ()
        return (Shaft(self.words["rotor"]["shaft"], self.speed, 1, datum="n"),)

    @cached_property
    def entries(self) -> ResultEntries:
        """The corrections in their planes, and the loads of the bearings before and after balancing."""
        position: dict[str, Any] = {"number": 1, "corrections": {}}
        for plane in self.planes:
            size = self.ledger[rotor_ids.unbalance(plane)].at(1)
            angle = self.ledger[rotor_ids.direction(plane)].at(1) if size else None
            entry = {"unbalance": size, "angle": angle}
            if self.given.correction is not None:
                entry |= {
                    name: self.ledger[family(plane)].at(1)
                    for name, family in (("mass", rotor_ids.mass), ("radius", rotor_ids.radius))
                }
            if self.given.finds_plane and plane == RIGHT:
                entry["place"] = self.ledger[rotor_ids.station(plane)].at(1)
            position["corrections"][plane] = entry
        if self.given.sought_masses:
            position["masses"] = {place: self.ledger[rotor_ids.mass(place)].at(1) for place in self.given.sought_masses}
        if self.given.bearings is not None:
            position["bearings"] = {
                place: {when: np.complex128(self.force_on(when, place)) for when in (BEFORE, AFTER)}
                for place in BEARINGS
            }
        return ResultEntries([position])

    def animations(self) -> tuple[Animation, ...]:
        return (rotor_motion.animation(self),)

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return its scheme, its plans and its tables; `sets` is ignored, since there is only one."""
        return {"rotor": [*rotor_drawings.plates(self), *self._tables()]}

    def _tables(self) -> Iterator[DrawingPlate]:
        page, captions = RotorPage(self), self.words["rotor"]["captions"]
        tables = {"products": page.products} | ({"loads": page.loads_table} if self.given.bearings else {})
        for name, table in tables.items():
            yield DrawingPlate(captions[name], (), "tables", (drawn(table, self.assignment.language),), spare=True)
