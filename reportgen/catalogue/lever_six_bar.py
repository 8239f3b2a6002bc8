"""The six-link lever mechanism: crank AB about B, coupler AC, rocker CD about D, rod EF from E on AC, slider F.

Ground 0, crank 1 (BA), coupler 2 (AC), rocker 3 (DC), rod 4 (EF), slider 5 (at F) on a horizontal guide.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from reportgen.assignment.checks import of_parameters, of_turning, one_of
from reportgen.assignment.common import Assignment, Part, Positions
from reportgen.assignment.fields import Coordinate, ForceSize, Length, SpeedRatio, SwingAngle
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.catalogue import assembly_checks, extreme_formulas
from reportgen.catalogue.declared_loads import against
from reportgen.catalogue.driven_machine import KindSections, driven
from reportgen.catalogue.extreme_positions import SIDES
from reportgen.catalogue.four_bar import extremes
from reportgen.catalogue.given_data import CRANK_DRAWN, GivenData
from reportgen.catalogue.parameters import Driven, FixedPoint
from reportgen.catalogue.vector_loops import ClosedLoops
from reportgen.formula import Number, Symbol, acos, cos, ids, sqrt, turned
from reportgen.formula.calculation import Calculation
from reportgen.formula.vocabulary import drawn_length
from reportgen.machine import Crank, Dyad, Guide, Linkage, LinkPoint
from reportgen.machine.analysis import Machine
from reportgen.machine.load_laws import ConstantLaw, Law, Stroke
from reportgen.machine.loads import Applied, course, crank_motion, fixed, turning_count

TURNS = 1
TURN = Number(360.0, unit="°")
BARS = {1: ("B", "A"), 2: ("A", "C"), 3: ("D", "C"), 4: ("E", "F")}
"""The bars by the pins at their ends."""


class SliderForce(Part):
    """A force on the slider along its guide, of one sense or against its motion."""

    P: ForceSize
    sense: Literal["opposing", "right", "left"] = "opposing"


class Swing(Part):
    """Requested motion of the rocker: its angle of swing and the time ratio K of its two strokes.

    The crank's centre B lies `beyond` the chord of the ends of the pin's path, seen from D, or `before` it.
    """

    angle: SwingAngle
    K: SpeedRatio
    B: Literal["beyond", "before"] = "beyond"


class Parameters(Driven, masses=(1, 2, 3, 4, 5), moments=(1, 2, 3, 4), shares=(1, 2, 3, 4), loads=("force",)):
    """Lengths, fixed points, the way the groups are assembled, the speed; masses and the load if given.

    Crank and coupler by their lengths, or by the swing that they are to give the rocker.
    """

    AB: Length | None = None
    AC: Length | None = None
    swing: Swing | None = None
    CD: Length
    CE: Length
    EF: Length
    D: FixedPoint
    guide: Coordinate
    C: Literal["left", "right"] = "left"
    F: Literal["left", "right"] = "left"
    force: SliderForce | None = None


def _calculation(given: Parameters, crank: Given | None = None) -> GivenData:
    """Return the given data, the place of E, mass centres, masses and moments of inertia."""
    q = GivenData(given)
    if given.AB and given.AC:
        q.datum("l.BA", given.AB, Symbol("l", "AB"))
        q.datum("l.AC", given.AC)
    q.datum("l.DC", given.CD, Symbol("l", "CD"))
    q.datum("l.CE", given.CE)
    q.datum("l.EF", given.EF)
    q.point("D", given.D)
    if given.swing:
        _synthesis(q, given.swing)
    q.datum("F.y", given.guide, Symbol("y", "F"), "length")
    q.speed()
    q.give("drawn.BA", crank.si if crank else CRANK_DRAWN, drawn_length("A", "B"))
    q.set_out("places", q.define("l.AE", q["l.AC"] - q["l.CE"]))
    q.bodies(BARS, 5, always=True)
    q.set_out(
        "lengths",
        "l.BA",
        "l.AC",
        "l.DC",
        "l.AE",
        "l.EF",
        *(ids.length(start, f"S{link}") for link, (start, _) in BARS.items()),
    )
    q.set_out("loads", "P5")
    if given.force is not None:
        q.datum("P.given", given.force.P, Symbol("P", "5"), "force")
    return q


def _synthesis(q: GivenData, asked: Swing) -> None:
    """Enter crank and coupler from the swing ψ and K: B sees both ends C₁, C₂ of the pin's path at θ = 180°(K − 1)/(K +
    1).

    B lies on the circle about O with radius ρ from which this angle is seen, and at its distance from D: ρ = l_CD
    sin(ψ/2)/sin θ,  DO = l_CD cos(ψ/2) ± ρ cos θ,  AB = (BC₁ − BC₂)/2,  AC = (BC₁ + BC₂)/2.
    """
    ψ, K = q.datum("swing", asked.angle, "ψ", "angle"), q.datum("K", asked.K)
    x, y, CD = q["D.x"], q["D.y"], q["l.DC"]
    BD = q.define("l.BD", sqrt(x**2 + y**2))
    θ = q.define("theta", extreme_formulas.angle_of_sight(K))
    ρ = q.define("rho", extreme_formulas.radius_by_swing(CD, ψ, θ), "ρ", "length")
    DO = q.define("l.DO", extreme_formulas.height_of_centre(CD, ψ, ρ, θ, SIDES[asked.B]))
    δ = q.define("delta", acos((BD**2 + DO**2 - ρ**2) / (2 * BD * DO)), "δ", "angle")
    q.set_out("circle", BD, θ, ρ, DO, δ)
    ends = []
    for number, half in (("1", ψ / 2), ("2", -(ψ / 2))):
        at_D = q.define(ids.outer_angle(number), δ + half, Symbol("ψ", number), "angle")
        ends.append(q.define(ids.length("B", f"C{number}"), sqrt(BD**2 + CD**2 - 2 * BD * CD * cos(at_D))))
        q.set_out("circle", at_D, ends[-1])
    q.set_out("links", q.define("l.BA", extreme_formulas.crank_between(*ends), Symbol("l", "AB")))
    q.set_out("links", q.define("l.AC", extreme_formulas.coupler_between(*ends)))


def _linkage(given: Parameters, q: GivenData) -> Linkage:
    """Return the mechanism with B in the origin."""
    left, right = (1 if side else -1 for side in (given.C == "left", given.F == "right"))
    return Linkage(
        ground={"B": 0j, "D": complex(q.si("D.x"), q.si("D.y"))},
        driver=Crank("B", "A", q.si("l.BA")),
        groups=(
            Dyad("RRR", (2, 3), "A", "C", "D", lengths=(q.si("l.AC"), q.si("l.DC")), sign=left),
            Dyad("RRP", (4, 5), "E", "F", Guide(1j * q.si("F.y"), 0.0), lengths=(q.si("l.EF"), 0.0), sign=right),
        ),
        points=(
            LinkPoint("E", 2, complex(q.si("l.AE"))),
            *q.centre_points({link: start for link, (start, _) in BARS.items()}),
        ),
        inertias=q.inertias({**{link: f"S{link}" for link in BARS}, 5: "F"}),
        gravity=-1j * given.gravity,
    )


def _has_swing(q: GivenData) -> bool:
    """Return True if the links found swing the rocker as requested: both ends on one side of BD, seen from B
    under θ.
    """
    ψ1, ψ2, BD, CD = (q.si(id) for id in ("psi.1", "psi.2", "l.BD", "l.DC"))
    if not (0 < ψ2 < ψ1 < np.pi and q.si("l.BA") > 0):
        return False
    α1, α2 = (np.arctan2(CD * np.sin(ψ), BD - CD * np.cos(ψ)) for ψ in (ψ1, ψ2))
    return bool(np.isclose(abs(α1 - α2), q.si("theta"), rtol=0, atol=1e-9))


def _lengths(given: Parameters) -> Iterator[Finding]:
    """Yield faults unless the requested swing is possible and E lies on the coupler."""
    if given.swing is None and (given.AB is None or given.AC is None):
        return
    q = _calculation(given)
    if given.swing is not None and not _has_swing(q):
        about = {"swing": given.swing.angle.text, "K": given.swing.K.text}
        yield Finding("no-such-swing", ("parameters", "swing"), about)
        return
    if given.CE.si > q.si("l.AC"):
        longest = given.AC.text if given.AC else f"{q.si('l.AC') * 1e3:.6g} mm"
        upper = f"≤ AC = {longest}"
        yield Finding("out-of-range", ("parameters", "CE"), {"text": given.CE.text, "range": upper})


@of_turning
def _check_turning(given: Parameters) -> Iterator[Finding]:
    """Yield faults unless the crank turns fully, without dead points, and CD is a rocker."""
    if (given.swing or (given.AB and given.AC)) is None or list(_lengths(given)):
        return
    linkage = _linkage(given, _calculation(given))
    members = {
        (2, 3): assembly_checks.Member("AC, CD", ("parameters", "CD")),
        (4, 5): assembly_checks.Member("EF", ("parameters", "EF")),
    }
    obstacles = list(assembly_checks.findings(linkage, members))
    yield from obstacles
    if not obstacles and assembly_checks.turns_fully(linkage, 3):
        yield Finding("not-a-rocker", ("parameters", "CD"), {"link": "3", "rods": "CD"})


CHECKS = (
    one_of("parameters", "AB", "swing"),
    one_of("parameters", "AC", "swing"),
    of_parameters(_lengths),
    _check_turning,
)


# --- the machine ----------------------------------------------------------------------------------

SUMMARY = (
    ("v.A", "v.S1", "omega.1"),
    ("v.C", "v.S2", "omega.2"),
    ("v.E", "v.S3", "omega.3"),
    ("v.F", "v.S4", "omega.4"),
    ("a.A", "a.S1", "eps.2"),
    ("a.C", "a.S2", "eps.3"),
    ("a.E", "a.S3", "eps.4"),
    ("a.F", "a.S4", ""),
)
"""The table of velocities and accelerations: a joint, a mass centre and a link's rotation in each row."""


def machine(assignment: Assignment) -> Machine:
    """Return the six-link lever mechanism of an assignment: linkage, load, a summary of its velocities."""
    given: Parameters = assignment.parameters
    positions = assignment.positions
    q = _calculation(given, assignment.drawing.crank)
    linkage, start = _linkage(given, q), positions.start_or()
    q.construct("guide.5.at", turned(q["F.y"]))
    q.set_out("extremes")
    motion_at = crank_motion(linkage, positions, start)
    whole = not positions.at or assembly_checks.turns(linkage)
    to_and_fro = whole and turning_count(linkage, 5, motion_at) == 2
    sliders = (course(linkage, 5, motion_at),) if to_and_fro else ()
    fixed = {name: q.coordinates(name) for name in linkage.ground}
    loops = ClosedLoops(linkage, positions.sign, fixed, guides={5: q.coordinates("F")}, accelerates=given.acceleration)

    def formulas(q: Calculation) -> None:
        if given.swing is None and whole:
            square = q["D.x"] ** 2 + q["D.y"] ** 2
            extremes(q, q["l.BA"], q["l.AC"], q["l.DC"], ("BC1", "BC2"), frame=sqrt(square), square=square)
        for slider in sliders:
            _stroke(q, slider, start, positions.sign)
        loops.write(q)

    return driven(
        assignment,
        q,
        linkage,
        start,
        KindSections(sizes="synthesis" if given.swing else "dimensions", summary=("summary",)),
        formulas=formulas,
        sliders=sliders,
        compared=tuple(loops.compared),
        equations=loops.equations,
        applied=_applied(given, linkage, positions, start),
        paths=("S2", "E", "S4"),
        facts={"summary": SUMMARY, "C": given.C, "F": given.F},
    )


def _stroke(q: Calculation, slider: Stroke, start: float, turn: int) -> None:
    """Enter the slider's ends F₁, F₂ and the crank's angles there, read off its way; its stroke, the turns between."""
    ends, angles = [], []
    for name, place, own in (("F1", slider.top, slider.top_angle), ("F2", slider.bottom, slider.bottom_angle)):
        ends.append(q.give(ids.coordinate(name, "x"), place.real, Symbol("x", name), "length", exact=False))
        at = np.mod(start + turn * (own - slider.phase), 2 * np.pi)
        angles.append(q.give(ids.angle(name), at, exact=False))
    q.set_out("ends", *angles, *ends)
    between = angles[1] - angles[0] if turn > 0 else angles[0] - angles[1]
    forward = turn * (q.si(angles[1]) - q.si(angles[0])) > 0
    there = q.define(ids.angle("12"), between if forward else between + TURN)
    back = q.define(ids.angle("21"), TURN - there)
    slow, fast = (there, back) if q.si(there) > q.si(back) else (back, there)
    stroke = q.define(ids.stroke(5), ends[0] - ends[1], Symbol("H", "5"), "length")
    q.set_out("stroke", stroke, there, back, q.define("K.5", slow / fast, Symbol("K", "5"), "ratio"))


def _applied(given: Parameters, linkage: Linkage, positions: Positions, start: float) -> tuple[Applied, ...]:
    """Return the force on the slider, positive to the right."""
    if given.force is None:
        return ()
    size, sense = given.force.P.si, given.force.sense
    motion_at = crank_motion(linkage, positions, start, given.speed)
    if sense == "opposing":
        law: Law = against(size, lambda motion: motion.points["F"].v.real, motion_at, through=not positions.at)
    else:
        law = ConstantLaw(size if sense == "right" else -size)
    return (Applied("P5", 5, "F", fixed(1 + 0j), law),)
