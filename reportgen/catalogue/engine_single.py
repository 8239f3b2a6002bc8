"""The single-cylinder four-stroke engine, its cylinder beside the crank centre.

Ground 0, crank 1 (AB), rod 2 (BC, mass centre S2), piston 3 (at C).  The cylinder is vertical above the
crank and offset by e to the side towards which the crank turns at the top, so that the piston takes
longer down than up: their angles are π + θ and π − θ, K = (π + θ)/(π − θ).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from string import ascii_lowercase
from typing import Annotated, ClassVar

from reportgen.assignment.checks import of_parameters, one_of
from reportgen.assignment.common import Assignment, Draft, Positions
from reportgen.assignment.fields import Gravity, Interval, Length, Offset, Ratio, Share
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.catalogue import given_loads
from reportgen.catalogue.crank_sliders import (
    CENTRE_PLANS,
    OFFSET_PLANS,
    OffsetSlider,
    compared,
    loop_equations,
    offset_slider,
)
from reportgen.catalogue.driven_machine import KindSections, driven
from reportgen.catalogue.given_data import CRANK_DRAWN, GivenData, cycle_angles
from reportgen.catalogue.parameters import Driven
from reportgen.formula import PI, Number, Ref, Symbol, sqrt, tan
from reportgen.machine.analysis import Machine, lettered
from reportgen.machine.loads import Piston, gas_forces

TURNS = 2
UP = math.pi / 2
MOST_LETTERED = 4
"""Two dead centres and two greatest speeds."""

TimeRatio = Annotated[Given, Ratio(Interval(least=1 + 1e-6, below=2))]
GyrationRatio = Annotated[Given, Ratio(Interval(least=1e-4, most=1))]
Indicator = given_loads.Diagram


class Parameters(Driven, masses=(2, 3), required=(2, 3), moments=(2,)):
    """The cylinder, then crank and rod by H, e, K or by R and L; the speed; masses of moving links."""

    D: Length
    H: Length | None = None
    K: TimeRatio | None = None
    R: Length | None = None
    L: Length | None = None
    e: Offset = Given(0.0, 0.0, "mm", "0 mm")
    s: Share
    rho: GyrationRatio | None = None
    g: Gravity = Given(9.8, 9.8, "m/s2", "9.8 m/s2")
    crank_on_axis: ClassVar[bool] = True

    @property
    def has_lengths(self) -> bool:
        """True if crank and rod are given in either way."""
        return None not in (self.R, self.L) or None not in (self.H, self.K)


def _start(geometry: OffsetSlider, positions: Positions) -> float:
    """Return φ of the first position: the top, unless the file says otherwise."""
    return geometry.stretched if positions.first is None else geometry.phi(positions.first.si)


def _special(geometry: OffsetSlider, start: float) -> tuple[float, ...]:
    """Return the driver's turns from the first position to the dead centres and the greatest piston speeds."""
    return tuple(phi - start for phi in (geometry.stretched, geometry.folded, *geometry.fastest()))


def position_labels(parameters: Parameters, positions: Positions) -> tuple[str, ...]:
    """Return the labels of the positions of the cycle; for faulty lengths, the largest number that any engine has."""
    if not parameters.has_lengths or _cannot_turn(parameters) is not None:
        return (*map(str, range(TURNS * positions.count)), *ascii_lowercase[: TURNS * MOST_LETTERED])
    geometry = _geometry(parameters, positions)
    return lettered(positions.count, TURNS, _special(geometry, _start(geometry, positions)))[1]


def _check_lengths(draft: Draft) -> Iterator[Finding]:
    """Yield faults unless crank and rod are given one way only: H with e and K, or R with L."""
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
    """Return a finding if the crank cannot turn: L ≤ R + e, or not 0 < e < H/(2 tan θ/2) if H and K are given."""
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


@of_parameters
def _check_turning(given: Parameters) -> Iterator[Finding]:
    obstacle = _cannot_turn(given)
    if obstacle is not None:
        yield obstacle


CHECKS = (
    _check_lengths,
    _check_turning,
    one_of("parameters", "rho", "J2", required=False),
    *given_loads.DIAGRAM_CHECKS,
)


# --- the machine ----------------------------------------------------------------------------------


def _enter_lengths(q: GivenData, given: Parameters) -> tuple[Ref, Ref]:
    """Enter crank R and rod L, from the triangle of A and the dead centres, or as given, and then the stroke.

    The triangle has the sides L + R, L − R and H, at A the angle θ = 180°(K − 1)/(K + 1) and the height e, whence
    4R² = H² − q₁ and 4L² = H² + q₂ with q₁ = 2He tan(θ/2), q₂ = 2He/tan(θ/2).
    """
    e = q.datum("e", given.e) if given.e.si else None
    q.set_out("synthesis")
    if given.R is not None and given.L is not None:
        R, L = q.datum("R", given.R), q.datum("L", given.L)
        q.define("H", 2 * R if e is None else sqrt((L + R) ** 2 - e**2) - sqrt((L - R) ** 2 - e**2))
        return R, L
    assert given.H is not None
    assert given.K is not None
    assert e is not None, "H and K without e are refused by the kind's checks"
    H, K = q.datum("H", given.H), q.datum("K", given.K)
    θ = q.define("theta", Number(180.0, unit="°") * (K - 1) / (K + 1))
    q1 = q.define("q.1", 2 * H * e * tan(θ / 2), Symbol("q", "1"), "product of lengths")
    q2 = q.define("q.2", 2 * H * e / tan(θ / 2), Symbol("q", "2"), "product of lengths")
    R, L = q.define("R", sqrt(H**2 - q1) / 2), q.define("L", sqrt(H**2 + q2) / 2)
    q.set_out("synthesis", q1, q2, R, L)
    return R, L


def _geometry(given: Parameters, positions: Positions) -> OffsetSlider:
    """Return the mechanism in the axes that turn with the rotation, the cylinder on their positive side."""
    q = GivenData(given)
    R, L = _enter_lengths(q, given)
    return OffsetSlider(q.si(R), q.si(L), given.e.si, UP, positions.sign)


def machine(assignment: Assignment) -> Machine:
    """Return the engine of an assignment: synthesis of crank and rod, linkage, gas, closed formulas."""
    given: Parameters = assignment.parameters
    positions, crank = assignment.positions, assignment.drawing.crank
    q = GivenData(given)
    R, L = _enter_lengths(q, given)
    D, s = q.datum("D", given.D), q.datum("s", given.s)
    if given.gravity:
        q.datum("g", given.g)
    q.speed()
    r = q.define("l.AB", R)
    q.define("l.BC", L)
    q.define("l.BS2", s * L)
    if crank is not None:
        q.drawn("A", "B", crank)
    else:  # by a scale of two figures
        q.drawn_by(float(f"{q.si(R) / CRANK_DRAWN:.1e}"), "A", "B", r)
    q.define("F", PI * D**2 / 4)
    for link in (1, 2, 3):
        q.mass(link)
    m2 = q["m.2"]
    ρ = None if given.rho is None or q.of_link("J", 2) else q.give("rho", given.rho.si, "ρ", "ratio")
    q.moment(2, m2 * L**2 / 12 if ρ is None else m2 * (ρ * L) ** 2)

    geometry = _geometry(given, positions)
    start = _start(geometry, positions)
    places, labels = lettered(positions.count, TURNS, _special(geometry, start))
    linkage = geometry.linkage(q.inertias({1: "A", 2: "S2", 3: "C"}), given.gravity, q.si("l.BS2"))
    if given.e.si:
        q.fix("guide.3.at", geometry.line, q["e"])
    piston = Piston.on(geometry.course(start, TURNS), given.D.si, assignment.indicator.table)
    angles = start + cycle_angles(positions, TURNS, places)
    offset = q["e"] if given.e.si else None
    return driven(
        assignment,
        q,
        linkage,
        geometry.crank_angle(start),
        KindSections(sizes="synthesis", load="cycle"),
        formulas=lambda q: offset_slider(q, geometry.turn, angles, offset, True),
        count=len(places),
        applied=gas_forces((piston,)),
        sliders=(piston,),
        paths=("S2",),
        compared=compared((*OFFSET_PLANS, *CENTRE_PLANS)),
        equations=loop_equations(geometry.turn, offset is not None, given.acceleration),
        facts={"form": "inline" if offset is None else f"offset-{positions.direction}"},
        places=places,
        labels=labels,
    )
