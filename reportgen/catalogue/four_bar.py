"""The four-bar linkage: crank AB, coupler BC with points E and F, link CD; A and D fixed.

Ground 0, crank 1 (AB), coupler 2 (BC), rocker or second crank 3 (CD, its frame from D to C).

The analytic method: x runs along AD, y is x turned by 90° in the direction of rotation, so that ω₁ > 0; φ are
the angles of AB, BC and DC from x.  With the diagonal BD and the angle δ at D, C on the left of BD (s = +1) or
right of it: φ₂ = sβ − δ, φ₃ = 180° − δ − sγ.  The closed loop, differentiated once and twice:
[A][ω₂ ω₃] = [B]ω₁,  [A][ε₂ ε₃] = −[Ȧ][ω₂ ω₃] + [Ḃ]ω₁.
"""

from __future__ import annotations

import cmath
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from typing import Literal

from reportgen.assignment.checks import of_parameters, of_turning
from reportgen.assignment.common import Assignment, Part
from reportgen.assignment.fields import Angle, Coordinate, ForceSize, FoundLength, Length
from reportgen.base.arrays import Floats
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.catalogue import assembly_checks
from reportgen.catalogue.crank_sliders import arm_of, compared, components
from reportgen.catalogue.driven_machine import KindSections, driven
from reportgen.catalogue.extreme_formulas import STRAIGHT
from reportgen.catalogue.found_lengths import LengthSearch, WantedSwing, find_four_bar, rocker_search
from reportgen.catalogue.given_data import GivenData, accelerated, accelerating, cycle_angles, driver_acceleration
from reportgen.catalogue.given_loads import LinkTorque, torque_on
from reportgen.catalogue.parameters import Driven
from reportgen.formula import (
    NOTHING,
    Chain,
    Expression,
    Matrix,
    Ref,
    Symbol,
    acos,
    atan,
    atan2,
    column,
    cos,
    ids,
    minus,
    plus,
    signed,
    sin,
    sqrt,
    times,
)
from reportgen.formula.calculation import Calculation
from reportgen.machine import Crank, Dyad, Linkage, LinkPoint
from reportgen.machine.analysis import Machine
from reportgen.machine.load_laws import ConstantLaw
from reportgen.machine.loads import Applied, fixed


def _rocks(q: Calculation) -> bool:
    """Return True if CD only swings: the crank, not the frame, is the shortest link."""
    return q.si("l.AB") < q.si("l.AD")


def _turns(q: Calculation) -> bool:
    """Return True if the crank turns fully, by Grashof's theorem: shortest + longest < sum of the two others."""
    AB, BC, CD, AD = (q.si(ids.length(id)) for id in ("AB", "BC", "DC", "AD"))
    first, second, third, last = sorted((AB, BC, CD, AD))
    return first + last < second + third and first in (AB, AD)


def cosine(a: Expression, b: Expression, opposite: Expression) -> Expression:
    """Return the law of cosines for the angle between two sides."""
    return (a**2 + b**2 - opposite**2) / (2 * a * b)


# --- proportions ----------------------------------------------------------------------------------


def proportions(q: Calculation) -> None:
    """Enter Grashof's two sums; for a rocker the extreme positions C₁, C₂, its swing ψ and the ratio of times K.

    Lengths that were found from swing and ratio do not give them again.
    """
    AB, BC, CD, AD = sides = tuple(q[ids.length(id)] for id in ("AB", "BC", "DC", "AD"))
    first, second, third, last = sorted(sides, key=q.si)
    ends = q.define("sum.ends", first + last, Symbol("l", "", "′"), "length")
    q.set_out("sums", ends, q.define("sum.others", second + third, Symbol("l", "", "″"), "length"))
    q.set_out("swing")
    if "rho" in q or not _rocks(q) or not _turns(q):
        return
    extremes(q, AB, BC, CD, ("AC1", "AC2"), frame=AD, square=AD**2)


def extremes(
    q: Calculation,
    crank: Ref,
    coupler: Ref,
    rocker: Ref,
    ends: tuple[str, str],
    *,
    frame: Expression,
    square: Expression,
) -> None:
    """Enter both extreme positions of a rocker, its swing ψ = ψ₁ − ψ₂ and the time ratio K = (180° + θ)/(180° − θ).

    Crank and coupler lie in one line from the crank's centre; θ = α₁ − α₂ is the angle between both lines.  The lines
    to the rocker's pin are called `ends`; the angles are α at the crank's centre and ψ at the rocker's.  The frame is
    given by a formula together with its square, since a small angle needs it unrounded.
    """
    angle = partial(q.define, kind="angle", scale=1.0)
    lengths, α, ψ = [], [], []
    for number, line, length in (("1", ends[0], coupler + crank), ("2", ends[1], coupler - crank)):
        lengths.append(reach := q.define(ids.length(line), length))
        at_centre = acos((reach**2 + square - rocker**2) / (2 * reach * frame))
        α.append(angle(ids.inner_angle(number), at_centre, Symbol("α", number)))
        at_pivot = acos((square + rocker**2 - reach**2) / (2 * frame * rocker))
        ψ.append(angle(ids.outer_angle(number), at_pivot, Symbol("ψ", number)))
    larger, smaller = sorted(α, key=q.si, reverse=True)
    θ = angle("theta", larger - smaller)
    q.set_out("extremes", *lengths, *α, *ψ)
    K = q.define("K", (STRAIGHT + θ) / (STRAIGHT - θ))
    q.set_out("swing", angle("swing", ψ[0] - ψ[1], "ψ"), θ, K)


# --- the analytic method --------------------------------------------------------------------------


def analytic_method(q: Calculation, angle: Floats, points: Iterable[LinkPoint], turn: int, side: int) -> None:
    """Enter positions, entries of the matrices and rates at φ₁ = `angle` [N], C on the `side` ±1 of BD in these axes.

    ω and ε are positive anticlockwise, φ with the crank.

    Ids: `f.phi.1`, `l.BD`, `f.phi.2`, `f.phi.3`; entries `A.11`, `B.1`, `dA.11`, `dB.1`; `A.det`;
    `f.omega.2`, …, `q.2`, `f.eps.3`; of every coupler point `f.x.E.v`, `f.y.E.v`, `f.v.E`, likewise for a.
    """
    AB, BC, CD, ω1 = q["l.AB"], q["l.BC"], q["l.DC"], q["omega.1"]
    φ1, φ2, φ3 = _positions(q, angle, side)
    a, b = partial(_entries, q, "A", "a", "length", 0.1), partial(_entries, q, "B", "b", "length", 0.1)
    q.set_out("entries", *a({"11": -BC * sin(φ2), "12": CD * sin(φ3), "21": BC * cos(φ2), "22": -CD * cos(φ3)}))
    q.set_out("entries", *b({"1": signed(turn, AB * sin(φ1)), "2": signed(-turn, AB * cos(φ1))}))
    q.define("A.det", BC * CD * sin(φ2 - φ3), "Δ", "product of lengths")
    # Cramer's rule, without the factors common to both numerators and Δ.
    ω2 = q.define("f.omega.2", signed(turn, ω1 * AB * sin(φ3 - φ1) / (BC * sin(φ2 - φ3))), scale=1.0)
    ω3 = q.define("f.omega.3", signed(turn, ω1 * AB * sin(φ2 - φ1) / (CD * sin(φ2 - φ3))), scale=1.0)
    q.set_out("velocity", ω2, ω3)
    a, b = partial(_entries, q, "dA", "ȧ", "velocity", 1.0), partial(_entries, q, "dB", "ḃ", "velocity", 1.0)
    rates = [
        *a({"11": signed(-turn, ω2 * BC * cos(φ2)), "12": signed(turn, ω3 * CD * cos(φ3))}),
        *a({"21": signed(-turn, ω2 * BC * sin(φ2)), "22": signed(turn, ω3 * CD * sin(φ3))}),
        *b({"1": signed(turn, ω1 * AB * cos(φ1)), "2": signed(turn, ω1 * AB * sin(φ1))}),
    ]
    q.set_out("entry_rates", *rates)
    top2 = ω1**2 * AB * cos(φ1 - φ3) + ω2**2 * BC * cos(φ2 - φ3) - ω3**2 * CD
    top3 = ω1**2 * AB * cos(φ1 - φ2) + ω2**2 * BC - ω3**2 * CD * cos(φ2 - φ3)
    for link, top, length in (("2", top2, BC), ("3", top3, CD)):
        q_k = q.define(ids.numerator(link), top, Symbol("q", link), "acceleration", scale=1.0)
        evenly = signed(-turn, q_k / (length * sin(φ2 - φ3)))
        ω = q[ids.formula_angular_velocity(link)]
        ε = q.define(ids.formula_angular_acceleration(link), accelerated(q, turn, evenly, ω), scale=1.0)
        q.set_out("acceleration", q_k, ε)
    q.set_out("slopes")
    q.set_out("coupler_velocity")
    q.set_out("coupler_acceleration")
    for point in points:
        _coupler_point(q, point, turn)


def _positions(q: Calculation, angle: Floats, side: int) -> tuple[Ref, Ref, Ref]:
    """Enter BD, then φ₂ = sβ − δ and φ₃ = 180° − δ − sγ, each directly from BD, since sums of rounded angles lose
    a digit.
    """
    AB, BC, CD, AD = q["l.AB"], q["l.BC"], q["l.DC"], q["l.AD"]
    φ1 = q.angle("f.phi.1", angle)
    across, along = AB * sin(φ1), AD - AB * cos(φ1)
    δ = atan(across / along) if _rocks(q) else atan2(across, along)
    BD = q.define("l.BD", sqrt(AB**2 + AD**2 - 2 * AB * AD * cos(φ1)))
    β, γ = acos(cosine(BC, BD, CD)), acos(cosine(CD, BD, BC))
    φ2 = q.define("f.phi.2", β - δ if side > 0 else -β - δ, scale=1.0)
    φ3 = q.define("f.phi.3", STRAIGHT - δ - γ if side > 0 else STRAIGHT - δ + γ, scale=1.0)
    q.set_out("position", BD, φ2, φ3)
    return φ1, φ2, φ3


def _entries(
    q: Calculation, matrix: str, letter: str, kind: str, scale: float, entries: Mapping[str, Expression]
) -> list[Ref]:
    """Return the entries of a matrix by their places: a₁₁ of [A], ȧ₁₁ of [Ȧ]."""
    return [
        q.define(ids.matrix_entry(matrix, place), entry, Symbol(letter, place), kind, scale=scale)
        for place, entry in entries.items()
    ]


def _coupler_point(q: Calculation, point: LinkPoint, turn: int) -> None:
    """Enter v and a of a point P of the coupler by components, BP at the angle φ₂ + η from x."""
    name, AB, φ1, ω1 = point.name, q["l.AB"], q["f.phi.1"], q["omega.1"]
    ω2, ε2 = q["f.omega.2"], q["f.eps.2"]
    BP, φ = arm_of(q, "B", name, q["f.phi.2"], turn)
    v, a = signed(turn, ω2), signed(turn, ε2)
    v_x, v_y = -(ω1 * AB * sin(φ1) + v * BP * sin(φ)), ω1 * AB * cos(φ1) + v * BP * cos(φ)
    q.set_out("coupler_velocity", *components(q, "v", name, v_x, v_y))
    ε1 = driver_acceleration(q, turn)
    a_x = plus(-(ω1**2 * AB * cos(φ1) + a * BP * sin(φ) + ω2**2 * BP * cos(φ)), minus(times(ε1, AB, sin(φ1))))
    a_y = plus(a * BP * cos(φ) - ω1**2 * AB * sin(φ1) - ω2**2 * BP * sin(φ), times(ε1, AB, cos(φ1)))
    q.set_out("coupler_acceleration", *components(q, "a", name, a_x, a_y))


# --- equations for templates ----------------------------------------------------------------------


def equations(turn: int, accelerates: float) -> dict[str, tuple[Chain, ...]]:
    """Return the closed loop by components; the matrix equations in symbols, and `-numbers` with entries to fill in.

    `accelerates` (any unit) is > 0 if the crank accelerates in the sense of ω₁, < 0 against it, 0 if it does not.
    """
    AB, BC, CD, AD = (Symbol("l", name) for name in ("AB", "BC", "CD", "AD"))
    φ1, φ2, φ3 = (Symbol("φ", link) for link in "123")
    ω1, ω2, ω3 = (Symbol("ω", link) for link in "123")
    ω, ε = column(ω2, ω3), column(Symbol("ε", "2"), Symbol("ε", "3"))
    A = Matrix(((-BC * sin(φ2), CD * sin(φ3)), (BC * cos(φ2), -CD * cos(φ3))))
    dA = Matrix(
        (
            (signed(-turn, ω2 * BC * cos(φ2)), signed(turn, ω3 * CD * cos(φ3))),
            (signed(-turn, ω2 * BC * sin(φ2)), signed(turn, ω3 * CD * sin(φ3))),
        )
    )
    B = column(signed(turn, AB * sin(φ1)), signed(-turn, AB * cos(φ1)))
    dB = column(signed(turn, ω1 * AB * cos(φ1)), signed(turn, ω1 * AB * sin(φ1)))
    a11, a12, a21, a22 = (Symbol("a", place) for place in ("11", "12", "21", "22"))
    filled_A, filled_dA = (
        Matrix(tuple(tuple(Ref(ids.matrix_entry(name, f"{i}{j}")) for j in "12") for i in "12")) for name in ("A", "dA")
    )
    filled_B, filled_dB = (column(*(Ref(ids.matrix_entry(name, i)) for i in "12")) for name in ("B", "dB"))
    filled_ω, filled_ω1 = column(Ref("f.omega.2"), Ref("f.omega.3")), Ref("omega.1")
    faster: Expression = NOTHING
    faster_filled: Expression = NOTHING
    if accelerates:
        faster, faster_filled = B * accelerating(accelerates), filled_B * signed(accelerates, Ref("eps.1"))
    return {
        "closure": (
            Chain((AB * cos(φ1) + BC * cos(φ2), AD + CD * cos(φ3))),
            Chain((AB * sin(φ1) + BC * sin(φ2), CD * sin(φ3))),
        ),
        "velocity": (Chain((A * ω, B * ω1)),),
        "determinant": (Chain((Symbol("Δ"), a11 * a22 - a12 * a21, BC * CD * sin(φ2 - φ3))),),
        "velocity-numbers": (Chain((filled_A * ω, filled_B * filled_ω1)),),
        "acceleration": (Chain((A * ε, plus(-(dA * ω) + dB * ω1, faster))),),
        "acceleration-numbers": (
            Chain((filled_A * ε, plus(-(filled_dA * filled_ω) + filled_dB * filled_ω1, faster_filled))),
        ),
    }


TURNS = 1
LINKS = {1: ("A", "B"), 2: ("B", "C"), 3: ("D", "C")}
"""The links by the pins at their ends."""


class CouplerPoint(Part):
    """A point of the coupler: its distances from B along BC, and across it to the left."""

    along: Coordinate
    across: Coordinate = Given(0.0, 0.0, "mm", "0 mm")


class LinkForce(Part):
    """A force on link 3 at C, in a fixed direction of the plane."""

    P: ForceSize
    angle: Angle


class Parameters(Driven, masses=(1, 2, 3), moments=(1, 2, 3), shares=(1, 2, 3), loads=("torque", "force")):
    """Lengths, the branch, the speed; coupler points, masses and loads only if they are given.

    AB, BC and AD may be found from the `swing` that they are to give the rocker; a part of a coursework may give any.
    """

    AB: FoundLength
    BC: FoundLength
    CD: FoundLength
    AD: FoundLength
    swing: WantedSwing | None = None
    frame: Angle = Given(0.0, 0.0, "deg", "0 deg")
    branch: Literal["open", "crossed"] = "open"
    link3: Literal["rocker", "crank"] | None = None
    E: CouplerPoint | None = None
    BF: Length | None = None
    torque: LinkTorque | None = None
    force: LinkForce | None = None

    @property
    def side(self) -> int:
        """+1 if C lies to the left of the line from B to D, else −1."""
        return 1 if self.branch == "open" else -1

    @property
    def search(self) -> LengthSearch:
        """The search for the lengths that are not given."""
        return rocker_search(self.swing, self.AB, self.BC, self.AD, self.CD)


def _calculation(
    given: Parameters, crank: Given | None = None, of_part: Callable[[str], str] = lambda key: ""
) -> GivenData:
    """Return the given data, coupler points, mass centres, masses, moments of inertia and Grashof's sums.

    `of_part` returns a key whose length a part of the coursework gives; "" for any other key.
    """
    q = GivenData(given)
    for key, length in {"AB": given.AB, "BC": given.BC, "CD": given.CD, "AD": given.AD}.items():
        if length is not None:
            q.datum(ids.length("DC" if key == "CD" else key), length, Symbol("l", key), from_part=of_part(key))
    if given.swing is not None:
        find_four_bar(q, given.swing, given.search)
    if given.frame.si:
        q.datum("frame", given.frame, "α", "angle")
    q.speed()
    q.drawn("A", "B", crank)
    if given.E is not None:
        q.datum("E.along", given.E.along)
        q.datum("E.across", given.E.across)
        q.point_of_link("E", "B", "C")
    if given.BF is not None:
        q.datum("l.BF", given.BF)
    q.gravity("GmJ")
    for link, (start, end) in LINKS.items():
        q.bar(link, start, end)
    if given.torque is not None:
        q.datum("M.given", given.torque.M, Symbol("M", "3"))
    if given.force is not None:
        q.datum("P.given", given.force.P, Symbol("P", "3"), "force")
        q.datum("P.angle", given.force.angle, Symbol("α", "P"), "angle")
    q.set_out("loads", "M3", "P3")
    proportions(q)
    return q


def _linkage(given: Parameters, q: GivenData) -> Linkage:
    """Return the mechanism with A in the origin."""
    e = () if given.E is None else (LinkPoint("E", 2, complex(given.E.along.si, given.E.across.si)),)
    f = () if given.BF is None else (LinkPoint("F", 2, complex(given.BF.si)),)
    lengths = q.si("l.BC"), q.si("l.DC")
    return Linkage(
        ground={"A": 0j, "D": cmath.rect(q.si("l.AD"), given.frame.si)},
        driver=Crank("A", "B", q.si("l.AB")),
        groups=(Dyad("RRR", (2, 3), "B", "C", "D", lengths=lengths, sign=given.side),),
        points=(*e, *f, *q.centre_points({link: start for link, (start, _) in LINKS.items()})),
        inertias=q.inertias({link: f"S{link}" for link in LINKS}),
        gravity=-1j * given.gravity,
    )


@of_turning
def _check_turning(given: Parameters) -> Iterator[Finding]:
    """Yield faults unless the crank turns fully, without dead points, and link 3 moves as the file says."""
    if list(given.search.findings()):
        return
    linkage = _linkage(given, _calculation(given))
    obstacles = list(
        assembly_checks.findings(linkage, {(2, 3): assembly_checks.Member("BC, CD", ("parameters", "BC"))})
    )
    yield from obstacles
    if not obstacles and given.link3 is not None:
        fully = assembly_checks.turns_fully(linkage, 3)
        if fully != (given.link3 == "crank"):
            code = "not-a-rocker" if fully else "not-a-crank"
            yield Finding(code, ("parameters", "link3"), {"link": "3", "rods": "CD"})


@of_parameters
def _check_found(given: Parameters) -> Iterator[Finding]:
    """Yield faults unless the lengths are all given, or the requested swing gives the others."""
    yield from given.search.findings()


LENGTHS_OF_PARTS = ("AB", "BC", "CD", "AD")
CHECKS = (_check_found, _check_turning)


def machine(assignment: Assignment) -> Machine:
    """Return the four-bar linkage of an assignment: linkage, loads, analytic method."""
    given: Parameters = assignment.parameters
    positions, turn = assignment.positions, assignment.positions.sign
    q = _calculation(given, assignment.drawing.crank, assignment.key_of_part)
    linkage, frame, force = _linkage(given, q), given.frame.si, given.force
    q.fix("p.D", linkage.ground["D"], q["l.AD"])
    start = positions.start_or(frame)
    points = tuple(point for point in linkage.points if point.link == 2)
    names = [point.name for point in points]
    φ1 = turn * (start + turn * cycle_angles(positions) - frame)
    plans = ("omega.2", "omega.3", *map(ids.velocity, names), "eps.2", "eps.3", *map(ids.acceleration, names))
    return driven(
        assignment,
        q,
        linkage,
        start,
        KindSections() if given.swing is None else KindSections(sizes="synthesis"),
        formulas=lambda q: analytic_method(q, φ1, points, turn, turn * given.side),
        applied=()
        if force is None
        else (Applied("P3", 3, "C", fixed(cmath.rect(1.0, force.angle.si)), ConstantLaw(force.P.si)),),
        torques=torque_on(given.torque, 3, linkage, positions, start),
        paths=tuple(names),
        compared=compared(plans),
        equations=equations(turn, given.acceleration),
        facts={
            "form": ("rocker" if _rocks(q) else "crank") if _turns(q) else "part",
            "side": "left" if turn * given.side > 0 else "right",
            "branch": "left" if given.side > 0 else "right",
            "selected": given.search.selected_by,
            "pivot": given.search.pivot,
            "coupler": "EF" if given.E and given.BF else "E" if given.E else "F" if given.BF else "plain",
        },
    )
