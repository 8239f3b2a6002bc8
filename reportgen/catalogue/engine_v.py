"""The V engine: two cylinders at an angle, the second rod articulated on the main rod or on the crank pin.

Ground 0, crank 1 (AB), main rod 2 (BC, with D on it), piston 3 (at C), rod 4 (DE, or BE), piston 5 (at E).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import Annotated

import numpy as np

from reportgen.assignment import checks
from reportgen.assignment.common import Assignment, Draft, Positions
from reportgen.assignment.faults import Finding
from reportgen.assignment.fields import (
    Angle,
    Length,
    Mass,
    MomentOfInertia,
    Share,
    Weight,
    Whole,
    quantity,
)
from reportgen.catalogue import articulated, bars, crank_slider, gas, linkage_loads, reach, regulation
from reportgen.catalogue.bars import Bar
from reportgen.catalogue.course import FULL_TURN, Floats
from reportgen.catalogue.driven import Driven, mass_keys, outline, rate_items
from reportgen.catalogue.machine import (
    Applied,
    Item,
    Machine,
    Piston,
    gas_forces,
    lettered,
    mass_items,
)
from reportgen.catalogue.reach import Member
from reportgen.catalogue.resistance import Constant
from reportgen.mechanism.motion import Motion, solve_motion
from reportgen.mechanism.structure import Crank, Dyad, Guide, Inertia, Linkage, LinkPoint
from reportgen.notation.expressions import PI, Ref, Symbol, divide, multiply, power
from reportgen.units import Given

KIND = "engine-v"
TITLES = {"vi": "Động cơ đốt trong hình chữ V", "en": "Engine with cylinders in V"}
TURNS = 1
"""Four strokes take two: the second turn's positions then count among those added to the first."""

CRANK_DRAWN = 0.04
"""Drawn length of the crank (m on paper) when none is asked for."""

Indicator = gas.Diagram
INDICATOR_OPTIONAL = True
Articulation = Annotated[Given, quantity("mm", least=0, below=1e5)]
Force = Annotated[Given, quantity("N", least=-1e7, most=1e7)]


class Parameters(Driven):
    """Lengths, the two axes, the speed; forces on the pistons, or their bore; what moves has mass if given one."""

    AB: Length
    BC: Length
    BD: Articulation = Given(0.0, 0.0, "mm", "0 mm")
    DE: Length
    alpha: Angle
    beta: Angle
    PC: Force | None = None
    PE: Force | None = None
    D: Length | None = None
    second_top: Annotated[int, Whole(1, 2)] = 2
    s2: Share | None = None
    s4: Share | None = None
    G2: Weight | None = None
    G3: Weight | None = None
    G4: Weight | None = None
    G5: Weight | None = None
    m2: Mass | None = None
    m3: Mass | None = None
    m4: Mass | None = None
    m5: Mass | None = None
    J2: MomentOfInertia | None = None
    J4: MomentOfInertia | None = None

    @property
    def joint(self) -> str:
        """Where rod 4 hangs: D on the main rod, or the crank pin B."""
        return "D" if self.BD.si else "B"

    @property
    def turns(self) -> int:
        """Turns in a cycle: two of a four-stroke engine with its gas, else one."""
        return 2 if self.D is not None else 1

    @property
    def rods(self) -> tuple[Bar, Bar]:
        """Rods 2 and 4, each with its mass centre if anything needs it."""
        return (
            bars.bar(self, 2, "B", "C", self.BC.si),
            bars.bar(self, 4, self.joint, "E", self.DE.si),
        )

    def linkage(self) -> Linkage:
        """The mechanism."""
        articulation = (LinkPoint("D", 2, complex(self.BD.si)),) if self.BD.si else ()
        first, second = (Guide(0j, axis.si) for axis in (self.alpha, self.beta))
        return Linkage(
            ground={"A": 0j},
            driver=Crank("A", "B", self.AB.si),
            dyads=(
                Dyad("RRP", (2, 3), "B", "C", first, (self.BC.si, 0.0)),
                Dyad("RRP", (4, 5), self.joint, "E", second, (self.DE.si, 0.0)),
            ),
            points=(*articulation, *(point for rod in self.rods for point in rod.point())),
            inertias=tuple(self._inertias()),
            gravity=-1j * self.g.si,
        )

    def _inertias(self) -> Iterator[Inertia]:
        for rod, piston, pin in zip(self.rods, (3, 5), "CE", strict=True):
            yield from rod.inertia(self.g.si)
            if self.mass(piston):
                yield Inertia(piston, pin, self.mass(piston))


def _start(positions: Positions) -> float:
    """The crank's angle at the first position: horizontal unless the file says otherwise."""
    return 0.0 if positions.start is None else positions.start.si


def _places(given: Parameters, positions: Positions) -> tuple[tuple[float, ...], tuple[str, ...]]:
    """The even positions, and lettered those where the main piston is at a dead point."""
    top = positions.sign * (given.alpha.si - _start(positions))
    return lettered(positions.count, given.turns, (top, top + math.pi))


def added_positions(parameters: Parameters, positions: Positions) -> int:
    """Positions of the cycle beside the evenly spaced ones of its first turn."""
    return len(_places(parameters, positions)[0]) * parameters.turns - positions.count


# --- checks ---------------------------------------------------------------------------------------


def _check_loads(draft: Draft) -> Iterator[Finding]:
    """Forces on the pistons are given outright, or by their bore and the indicator diagram."""
    raw = draft.raw.get("parameters")
    if not isinstance(raw, dict):
        return
    bore, diagram = raw.get("D") is not None, draft.raw.get("indicator") is not None
    for key in (key for key in ("PC", "PE") if raw.get(key) is not None and (bore or diagram)):
        other = "D" if bore else "indicator"
        yield Finding("both-given", ("parameters", key), {"first": other, "second": key}, at="key")
    if bore and not diagram:
        yield Finding("missing-key", ("indicator",), {"key": "indicator"})
    if diagram and not bore:
        yield Finding("missing-key", ("parameters", "D"), {"key": "D"})


def _check_assembly(draft: Draft) -> Iterator[Finding]:
    """Both pistons follow the crank through a whole turn; the articulation lies on the main rod."""
    given: Parameters | None = draft.sections.get("parameters")
    if given is None:
        return
    if given.BD.si >= given.BC.si:
        most = f"< BC = {given.BC.si * 1e3:g} mm"
        yield Finding("out-of-range", ("parameters", "BD"), {"text": given.BD.text, "range": most})
        return
    members = {
        (2, 3): Member("BC", ("parameters", "BC")),
        (4, 5): Member(f"{given.joint}E", ("parameters", "DE")),
    }
    yield from reach.findings(given.linkage(), members)


CHECKS = (
    checks.one_of("parameters", "n", "omega1"),
    *bars.one_mass((2, 3, 4, 5)),
    *gas.CHECKS,
    _check_loads,
    regulation.needs_loads((*mass_keys((2, 3, 4, 5)), "PC", "PE", "D")),
    _check_assembly,
)


# --- the machine ----------------------------------------------------------------------------------


def machine(assignment: Assignment) -> Machine:
    """The engine of an assignment: linkage, forces on the pistons, closed formulas, the report's outline."""
    given: Parameters = assignment.parameters
    positions, turn = assignment.positions, assignment.positions.sign
    linkage, start = given.linkage(), _start(assignment.positions)
    places, labels = _places(given, positions)

    def motion_at(angle: Floats) -> Motion:
        return solve_motion(linkage, start + turn * angle, turn * given.speed)

    courses = (
        linkage_loads.course(linkage, 3, motion_at, given.turns),
        linkage_loads.course(linkage, 5, motion_at, given.turns, given.second_top if given.turns == 2 else 1),
    )
    pistons: tuple[Piston, ...] = ()
    if given.D is not None:
        table = assignment.indicator.table
        pistons = tuple(Piston.on(course, given.D.si, table) for course in courses)
    applied = gas_forces(pistons) if pistons else _constant(given)
    angle = np.mod(turn * (start - given.alpha.si) + np.tile(places, given.turns) + 1e-12, FULL_TURN) - 1e-12
    return Machine(
        kind=KIND,
        linkage=linkage,
        start=start,
        turn=turn,
        speed=given.speed,
        count=len(places),
        turns=given.turns,
        given=_items(given, turn, assignment.drawing.crank),
        formulas=_formulas(given, angle),
        outline=outline(bool(linkage.inertias), bool(applied), given.flywheel),
        unevenness=given.unevenness,
        pistons=pistons,
        applied=applied,
        sliders=courses,
        paths=("D",) if given.joint == "D" else (),
        compared=_compared(given),
        places=places,
        labels=labels,
    )


def _constant(given: Parameters) -> tuple[Applied, ...]:
    """Constant forces that push the pistons towards the crank."""
    ends = ((3, "C", given.PC, given.alpha), (5, "E", given.PE, given.beta))
    return tuple(
        Applied(f"P{link}", link, pin, -cmath.exp(1j * axis.si), Constant(force.si))
        for link, pin, force, axis in ends
        if force is not None
    )


def _formulas(given: Parameters, angle: Floats) -> tuple[Item, ...]:
    """The closed formulas of both cylinders; the articulation D takes the place of a mass centre on rod 2."""
    items = crank_slider.formulas(2, 3, "B", "C", "D", angle)
    if given.joint == "B":
        items = tuple(item for item in items if not item.id.startswith(("f.x.D", "f.y.D")) and item.id[-2:] != ".D")
        items = (*items, *articulated.crank_pin())
    return (*items, *articulated.place(given.joint), *articulated.second(given.joint, f"{given.joint}E"))


def _compared(given: Parameters) -> tuple[tuple[str, str], ...]:
    on_rod = ("v.D", "a.D") if given.joint == "D" else ()
    plans = ("v.C", "omega.2", "v.E", "omega.4", "a.C", "eps.2", "a.E", "eps.4", *on_rod)
    return tuple((plan, f"f.{plan}") for plan in plans)


def _items(given: Parameters, turn: int, crank: Given | None) -> tuple[Item, ...]:
    """Given data, λ = R/L, the angle between the cylinders, masses and moments of inertia, the area of a piston."""
    rod = f"l.{given.joint}E"
    items = [
        Item("l.AB", Symbol("l", "AB"), "length", given.AB.si),
        Item("l.BC", Symbol("l", "BC"), "length", given.BC.si),
        *((Item("l.BD", Symbol("l", "BD"), "length", given.BD.si),) if given.BD.si else ()),
        Item(rod, Symbol("l", f"{given.joint}E"), "length", given.DE.si),
        Item("alpha", Symbol("α"), "angle", given.alpha.si),
        Item("beta", Symbol("β"), "angle", given.beta.si),
        *rate_items(given),
        Item("drawn.AB", Symbol("AB", over="segment"), "segment", crank.si if crank else CRANK_DRAWN),
        Item("R", Symbol("R"), "length", definition=Ref("l.AB")),
        Item("L", Symbol("L"), "length", definition=Ref("l.BC")),
        Item("lambda", Symbol("λ"), "ratio", definition=divide("R", "L")),
        Item("delta", Symbol("δ"), "angle", turn * (given.beta.si - given.alpha.si)),
    ]
    for force, name in ((given.PC, "PC"), (given.PE, "PE")):
        if force is not None:
            items.append(Item(f"{name}.given", Symbol("P", name[1]), "force", force.si))
    if given.D is not None:
        area = divide(multiply(PI, power("D", 2)), 4)
        items += [
            Item("D", Symbol("D"), "diameter", given.D.si),
            Item("F", Symbol("F"), "area", definition=area),
        ]
    if any(given.mass(link) for link in (2, 3, 4, 5)):
        items.append(Item("g", Symbol("g"), "gravity", given.g.si))
    for bar in given.rods:
        items += bar.items()
    for piston in (3, 5):
        items += mass_items(piston, getattr(given, f"G{piston}"), getattr(given, f"m{piston}"))
    return tuple(items)
