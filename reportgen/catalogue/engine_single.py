"""The single-cylinder four-stroke engine, its cylinder beside the crank centre.

Ground 0, crank 1 (AB), rod 2 (BC, mass centre S2), piston 3 (at C).  The cylinder is vertical above the
crank and offset by e to the side towards which the crank turns at the top, so that the piston takes
longer down than up: their angles are π + θ and π − θ, K = (π + θ)/(π − θ).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated

import numpy as np

from reportgen.assignment import checks
from reportgen.assignment.common import Assignment, Draft, Positions
from reportgen.assignment.faults import Finding
from reportgen.assignment.fields import (
    Acceleration,
    Interval,
    Length,
    Mass,
    MomentOfInertia,
    Ratio,
    Share,
    Weight,
    quantity,
)
from reportgen.catalogue import gas, offset_slider
from reportgen.catalogue.driven import Driven, outline, rate_items
from reportgen.catalogue.machine import (
    Item,
    Machine,
    Piston,
    gas_forces,
    lettered,
    mass_items,
    ratio_item,
)
from reportgen.catalogue.offset_slider import OffsetSlider
from reportgen.mechanism.structure import Inertia
from reportgen.notation.expressions import (
    PI,
    Expression,
    Number,
    Ref,
    Root,
    Symbol,
    add,
    call,
    divide,
    multiply,
    power,
    subtract,
)
from reportgen.units import Given

KIND = "engine-single"
TITLES = {
    "vi": "Động cơ đốt trong một xi lanh",
    "en": "Single-cylinder combustion engine",
}
TURNS = 2

CRANK_DRAWN = 0.04
"""Drawn length of the crank (m on paper) when none is asked for."""
UP = math.pi / 2
MOST_LETTERED = 4
"""Two dead centres and two greatest speeds."""

Offset = Annotated[Given, quantity("mm", least=0, below=1e5)]
TimeRatio = Annotated[Given, Ratio(Interval(above=1, below=2))]
GyrationRatio = Annotated[Given, Ratio(Interval(above=0, most=1))]
Indicator = gas.Diagram


class Parameters(Driven):
    """The cylinder, then crank and rod by H, e, K or by R and L; the speed; what moves."""

    D: Length
    H: Length | None = None
    K: TimeRatio | None = None
    R: Length | None = None
    L: Length | None = None
    e: Offset = Given(0.0, 0.0, "mm", "0 mm")
    s: Share
    G1: Weight | None = None
    G2: Weight | None = None
    G3: Weight | None = None
    m1: Mass | None = None
    m2: Mass | None = None
    m3: Mass | None = None
    rho: GyrationRatio | None = None
    J2: MomentOfInertia | None = None
    g: Acceleration = Given(9.8, 9.8, "m/s2", "9.8 m/s2")

    @property
    def has_lengths(self) -> bool:
        """Whether crank and rod are given in either way."""
        return None not in (self.R, self.L) or None not in (self.H, self.K)

    @property
    def lengths(self) -> tuple[float, float]:
        """Crank R and rod L (m): as given, or of the triangle that A makes with the dead centres.

        Its sides are L + R, L − R and H, the angle at A is θ = π(K − 1)/(K + 1) and the height e, whence
        4R² = H² − 2H e₁, 4L² = H² + 2H e₂ with e₁ = e tan(θ/2), e₂ = e/tan(θ/2).
        """
        if self.R is not None and self.L is not None:
            return self.R.si, self.L.si
        assert self.H is not None
        assert self.K is not None
        tangent = math.tan(math.pi * (self.K.si - 1) / (self.K.si + 1) / 2)
        quarter, area = self.H.si**2 / 4, self.H.si * self.e.si / 2
        return math.sqrt(quarter - area * tangent), math.sqrt(quarter + area / tangent)

    @property
    def moment(self) -> float:
        """J of the rod about S2 (kg·m²): as given, m (ρL)², else m L²/12."""
        if self.J2 is not None:
            return self.J2.si
        square = 1 / 12 if self.rho is None else self.rho.si**2
        return self.mass(2) * square * self.lengths[1] ** 2

    def geometry(self, positions: Positions) -> OffsetSlider:
        """The mechanism in the axes that turn with the rotation, the cylinder on their positive side."""
        crank, rod = self.lengths
        return OffsetSlider(crank, rod, self.e.si, UP, positions.sign)


def _start(geometry: OffsetSlider, positions: Positions) -> float:
    """φ of the first position: the top, unless the file says otherwise."""
    return geometry.stretched if positions.start is None else geometry.phi(positions.start.si)


def _special(geometry: OffsetSlider, start: float) -> tuple[float, ...]:
    """The driver's turns from the first position to the dead centres and the greatest piston speeds."""
    return tuple(phi - start for phi in (geometry.stretched, geometry.folded, *geometry.fastest()))


def added_positions(parameters: Parameters, positions: Positions) -> int:
    """How many lettered positions a turn has; of an engine with faulty lengths, the most that any has."""
    if not parameters.has_lengths or _cannot_turn(parameters) is not None:
        return MOST_LETTERED
    geometry = parameters.geometry(positions)
    places, _ = lettered(positions.count, 1, _special(geometry, _start(geometry, positions)))
    return len(places) - positions.count


def _check_lengths(draft: Draft) -> Iterator[Finding]:
    """Crank and rod are given one way only: H with e and K, or R with L."""
    raw = draft.raw.get("parameters")
    if not isinstance(raw, dict):
        return
    named = [key for key in ("R", "L", "H", "K") if raw.get(key) is not None]
    direct = [key for key in named if key in {"R", "L"}]
    derived = [key for key in named if key in {"H", "K"}]
    if direct and derived:
        both = {"first": direct[0], "second": derived[0]}
        yield Finding("both-given", ("parameters", derived[0]), both, at="key")
    elif direct:
        for key in {"R", "L"} - set(direct):
            yield Finding("missing-key", ("parameters", key), {"key": key})
    else:
        for key in (key for key in ("H", "e", "K") if raw.get(key) is None):
            yield Finding("missing-key", ("parameters", key), {"key": key})


def _cannot_turn(given: Parameters) -> Finding | None:
    """What keeps the crank from turning: L ≤ R + e, or no 0 < e < H/(2 tan θ/2) beside H and K."""
    if given.R is not None and given.L is not None:
        if given.L.si <= given.R.si + given.e.si:
            least = f"> R + e = {(given.R.si + given.e.si) * 1e3:g} mm"
            return Finding("out-of-range", ("parameters", "L"), {"text": given.L.text, "range": least})
    elif given.H is not None and given.K is not None:
        most = given.H.si / (2 * math.tan(math.pi * (given.K.si - 1) / (given.K.si + 1) / 2))
        if not 0 < given.e.si < most:
            limits = f"> 0, < H/(2·tan(θ/2)) = {most * 1e3:.6g} mm"
            return Finding("out-of-range", ("parameters", "e"), {"text": given.e.text, "range": limits})
    return None


def _check_turning(draft: Draft) -> Iterator[Finding]:
    given = draft.sections.get("parameters")
    found = None if given is None else _cannot_turn(given)
    if found is not None:
        yield found


CHECKS = (
    _check_lengths,
    _check_turning,
    checks.one_of("parameters", "n", "omega1"),
    checks.one_of("parameters", "G1", "m1", required=False),
    checks.one_of("parameters", "G2", "m2"),
    checks.one_of("parameters", "G3", "m3"),
    checks.one_of("parameters", "rho", "J2", required=False),
    *gas.CHECKS,
)


# --- the machine ----------------------------------------------------------------------------------



def machine(assignment: Assignment) -> Machine:
    """The engine of an assignment: linkage, gas, quantities of its own and the report's outline."""
    given: Parameters = assignment.parameters
    positions = assignment.positions
    geometry = given.geometry(positions)
    start = _start(geometry, positions)
    places, labels = lettered(positions.count, TURNS, _special(geometry, start))
    inertias = [Inertia(2, "S2", given.mass(2), given.moment), Inertia(3, "C", given.mass(3))]
    if given.mass(1):
        inertias.insert(0, Inertia(1, "A", given.mass(1)))
    piston = Piston.on(geometry.course(start, TURNS), given.D.si, assignment.indicator.table)
    angles = start + np.tile(places, TURNS)
    return Machine(
        kind=KIND,
        linkage=geometry.linkage(inertias, given.g.si, given.s.si * geometry.l),
        start=geometry.crank_angle(start),
        turn=positions.sign,
        speed=given.speed,
        count=len(places),
        turns=TURNS,
        given=_items(given, assignment.drawing.crank),
        formulas=offset_slider.formulas(angles, Ref("e") if geometry.e else None, True),
        outline=outline(True, True, given.flywheel, sizes="synthesis", load="cycle"),
        unevenness=given.unevenness,
        pistons=(piston,),
        applied=gas_forces((piston,)),
        sliders=(piston,),
        paths=("S2",),
        compared=offset_slider.compared(True),
        equations=offset_slider.equations(geometry.e != 0),
        places=places,
        labels=labels,
    )


def _items(given: Parameters, crank: Given | None) -> tuple[Item, ...]:
    """Given data and the synthesis: θ, R and L, the mass centre, masses and the moment of inertia."""
    items = [
        *((Item("e", Symbol("e"), "length", given.e.si),) if given.e.si else ()),
        *(_synthesis(given) if given.K is not None else _stroke(given)),
        Item("D", Symbol("D"), "diameter", given.D.si),
        Item("s", Symbol("s"), "ratio", given.s.si),
        Item("g", Symbol("g"), "gravity", given.g.si),
        *rate_items(given),
        Item("l.AB", Symbol("l", "AB"), "length", definition=Ref("R")),
        Item("l.BC", Symbol("l", "BC"), "length", definition=Ref("L")),
        Item("l.BS2", Symbol("l", "BS2"), "length", definition=multiply("s", "L")),
        *_drawn(given, crank),
        Item("F", Symbol("F"), "area", definition=divide(multiply(PI, power("D", 2)), 4)),
    ]
    for link in (1, 2, 3):
        items += mass_items(link, getattr(given, f"G{link}"), getattr(given, f"m{link}"))
    symbol = Symbol("J", "S2")
    if given.J2 is not None:
        items.append(Item("J.2", symbol, "moment of inertia", given.J2.si))
    elif given.rho is not None:
        items.append(Item("rho", Symbol("ρ"), "ratio", given.rho.si))
        squared = multiply("m.2", power(multiply("rho", "L"), 2))
        items.append(Item("J.2", symbol, "moment of inertia", definition=squared))
    else:
        by_length = divide(multiply("m.2", power("L", 2)), 12)
        items.append(Item("J.2", symbol, "moment of inertia", definition=by_length))
    return tuple(items)


def _drawn(given: Parameters, crank: Given | None) -> tuple[Item, ...]:
    """The crank's drawn length: as asked for, else about `CRANK_DRAWN` by a scale of two figures."""
    symbol = Symbol("AB", over="segment")
    if crank is not None:
        return (Item("drawn.AB", symbol, "segment", crank.si),)
    scale = float(f"{given.lengths[0] / CRANK_DRAWN:.1e}")
    return (
        Item("scale", Symbol("μ", "l"), "length scale", scale),
        Item("drawn.AB", symbol, "segment", definition=divide("l.AB", "scale")),
    )


def _synthesis(given: Parameters) -> tuple[Item, ...]:
    """R and L of H, e and K, see `Parameters.lengths`: 4R² = H² − q₁, 4L² = H² + q₂ with q = 2He·tan^±1(θ/2)."""
    assert given.H is not None
    assert given.K is not None
    half_turn = Number(180.0, unit="°")
    theta = divide(multiply(half_turn, subtract("K", 1)), add("K", 1))
    tangent, square = call("tan", divide("theta", 2)), power("H", 2)
    return (
        Item("H", Symbol("H"), "length", given.H.si),
        ratio_item("K", Symbol("K"), given.K),
        Item("theta", Symbol("θ"), "angle", definition=theta),
        Item("q.1", Symbol("q", "1"), "product of lengths", definition=multiply(2, "H", "e", tangent)),
        Item("q.2", Symbol("q", "2"), "product of lengths", definition=divide(multiply(2, "H", "e"), tangent)),
        Item("R", Symbol("R"), "length", definition=_half_root(subtract(square, "q.1"))),
        Item("L", Symbol("L"), "length", definition=_half_root(add(square, "q.2"))),
    )


def _half_root(of: Expression) -> Expression:
    return divide(Root(of), 2)


def _stroke(given: Parameters) -> tuple[Item, ...]:
    """R and L as given, and the stroke between the dead centres, H = √((L + R)² − e²) − √((L − R)² − e²)."""
    assert given.R is not None
    assert given.L is not None
    lengths = (
        Item("R", Symbol("R"), "length", given.R.si),
        Item("L", Symbol("L"), "length", given.L.si),
    )
    if not given.e.si:
        return (*lengths, Item("H", Symbol("H"), "length", definition=multiply(2, "R")))
    outer, inner = (
        Root(subtract(power(reach, 2), power("e", 2))) for reach in (add("L", "R"), subtract("L", "R"))
    )
    return (*lengths, Item("H", Symbol("H"), "length", definition=subtract(outer, inner)))
