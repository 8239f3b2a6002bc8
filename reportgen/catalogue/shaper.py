"""The shaper: a crank swings a slotted lever, and a link transmits the swing to the ram with the tool.

Ground 0, crank 1 (AB), block 2 (at B), rocker 3 (CD, mass centre S3), link 4 (DE, S4), ram 5 (at E).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Annotated

from reportgen.assignment.checks import of_parameters
from reportgen.assignment.common import Assignment, Part
from reportgen.assignment.fields import Interval, Length, Ratio, Share, quantity
from reportgen.base.errors import Finding
from reportgen.base.units import Given, nice_up
from reportgen.catalogue import assembly_checks, slotted
from reportgen.catalogue.assembly_checks import Member
from reportgen.catalogue.driven_machine import KindSections, driven
from reportgen.catalogue.given_data import GivenData, cycle_angles
from reportgen.catalogue.parameters import Driven
from reportgen.catalogue.slotted import HIGHEST, Ram, SlottedCrank
from reportgen.formula import Symbol, ids
from reportgen.formula.calculation import Calculation
from reportgen.formula.vocabulary import drawn_length
from reportgen.machine.analysis import Machine
from reportgen.machine.load_laws import CuttingLaw
from reportgen.machine.loads import Applied, crank_motion, fixed

TURNS = 1
CENTRES = {2: "B", 3: "S3", 4: "S4", 5: "E"}
"""Mass centres of the links that may have mass."""
RODS = {3: "CD", 4: "DE"}

ToolForce = Annotated[Given, quantity("N", least=1e-6, most=1e7)]
FreeShare = Annotated[Given, Ratio(Interval(least=0, below=0.5, tiny=1e-6))]


class CuttingForce(Part):
    """The force F against the tool while it cuts, and the share of the stroke at each end where it does not."""

    F: ToolForce
    free: FreeShare = Given(0.0, 0.0, "", "0")


class Parameters(Driven, masses=(2, 3, 4, 5), moments=(3, 4), loads=("cutting",)):
    """Lengths, the stroke, the speed; a moving link has mass only if it is given."""

    a: Length
    b: Length
    l3: Length
    l4: Length
    H: Length
    cutting: CuttingForce | None = None
    s3: Share = Given(0.5, 0.5, "", "0.5")
    s4: Share = Given(0.5, 0.5, "", "0.5")


def _calculation(given: Parameters, crank: Given | None = None) -> GivenData:
    """Return the given data and the synthesis l₁ = aH/(2 l₃); mass centres, masses, moments of inertia; the drawn
    crank.
    """
    q = GivenData(given)
    a, b = q.datum("a", given.a, "a", "length"), q.datum("b", given.b, "b", "length")
    l3 = q.datum("l.CD", given.l3, Symbol("l", "3"))
    l4 = q.datum("l.DE", given.l4, Symbol("l", "4"))
    H = q.datum("H", given.H)
    q.speed()
    l1 = q.define("l.AB", a * H / (2 * l3), Symbol("l", "1"))
    q.set_out("synthesis", "theta", l1)
    q.set_out("lengths", l1, l3, l4)
    if given.cutting is not None:
        q.datum("P.given", given.cutting.F, "P", "force")
        if given.cutting.free.si:
            q.datum("free", given.cutting.free, "k", "ratio")
    q.gravity()
    for link in CENTRES:
        q.mass(link)
    for link, rod in RODS.items():
        l, m, share, moment = q[ids.length(rod)], ids.mass(link), getattr(given, f"s{link}"), q.of_link("J", link)  # noqa: E741
        if m in q or moment:
            centre = q.define(ids.length(rod[0], f"S{link}"), q.give(ids.mass_centre(link), share.si, kind="ratio") * l)
            q.set_out("places", centre)
            q.moment(link, q[m] * l**2 / 12 if m in q else None)
    q.set_out("loads", "f.x.E", "P5")
    if crank is not None:
        q.drawn("A", "B", crank)
    else:  # by the finest round scale at which all stays on the page
        highest = max(q.si(b), q.si(l3))
        q.drawn_by(nice_up(highest / HIGHEST / 1e3) * 1e3, "A", "B", l1)
    return q


def _geometry(given: Parameters, q: GivenData, turn: int) -> Ram:
    """Return the mechanism in the axes that turn with the rotation."""
    crank = SlottedCrank(q.si("l.AB"), q.si("a"), math.pi / 2, turn)
    return Ram(crank, q.si("l.CD"), q.si("l.DE"), q.si("b"))


@of_parameters
def _check_assembly(given: Parameters) -> Iterator[Finding]:
    """Yield faults unless the rocker swings, the block stays in it, and link 4 always reaches from D to the
    ram's line.
    """
    geometry = _geometry(given, _calculation(given), 1)
    crank = geometry.crank.r
    block = {"block": "2", "link": "3", "group": "(2, 3)", "pivot": "C"}
    if crank >= given.a.si:
        sizes = {"crank": f"{crank * 1e3:.6g}", "centres": "AC", "distance": f"{given.a.si * 1e3:.6g}"}
        most = f"{2e3 * given.l3.si:.6g} mm"
        yield Finding("rocker-turns", ("parameters", "H"), block | sizes | {"angle": "270", "most": most})
        return
    farthest = given.a.si + crank
    if given.l3.si <= farthest:
        sizes = {"reach": f"{farthest * 1e3:.6g}", "length": f"{given.l3.si * 1e3:.6g}", "angle": "90"}
        yield Finding("leaves-slot", ("parameters", "l3"), block | sizes)
    members = {(2, 3): Member("CD", ("parameters", "H")), (4, 5): Member("DE", ("parameters", "l4"))}
    yield from assembly_checks.findings(geometry.linkage((), (), 0.0), members)


CHECKS = (_check_assembly,)


def _cutting_interval(q: Calculation, breaks: Iterable[float], start: float) -> None:
    """Enter φ₁ at the start and end of cutting: 360° − θ and 180° + θ, or from the tool's travel if it has free
    ends.
    """
    if "free" not in q:
        q.set_out("interval", q.define(ids.angle("in"), slotted.TURN - q["theta"], Symbol("φ", "a")))
        q.set_out("interval", q.define(ids.angle("out"), slotted.STRAIGHT + q["theta"], Symbol("φ", "b")))
        return
    for id, letter, angle in zip(("in", "out"), "ab", sorted(start + one for one in breaks), strict=True):
        q.set_out("interval", q.give(ids.angle(id), angle, Symbol("φ", letter), exact=False))


def machine(assignment: Assignment) -> Machine:
    """Return the shaper of an assignment: linkage, cutting force, closed formulas."""
    given: Parameters = assignment.parameters
    positions, cutting = assignment.positions, given.cutting
    q = _calculation(given, assignment.drawing.crank)
    geometry = _geometry(given, q, positions.sign)
    start = 0.0 if positions.first is None else geometry.crank.phi(positions.first.si)
    course = geometry.course(start)
    q.fix("p.C", geometry.crank.ground["C"], q["a"])
    q.fix("guide.5.at", geometry.line, q["b"] - q["a"])
    points = q.centre_points({link: rod[0] for link, rod in RODS.items()})

    linkage = geometry.linkage(points, q.inertias(CENTRES), given.gravity)
    applied: tuple[Applied, ...] = ()
    if cutting is not None:
        law = CuttingLaw(course, cutting.F.si, cutting.free.si)
        applied = (Applied("P5", 5, "E", fixed(-course.inward), law),)

    def formulas(q: Calculation) -> None:
        q.define("drawn.AC", q["a"] / q["mu.l"], drawn_length("A", "C"))
        slotted.swing(q, q["H"] / (2 * q["l.CD"]))
        slotted.strokes(q, q["H"])
        slotted.ram_formulas(q, positions.sign, start + cycle_angles(positions))
        if cutting is not None:
            slotted.cutting(q, q["P.given"], q.find("free"))
            _cutting_interval(q, law.breaks(crank_motion(linkage, positions, geometry.crank.crank_angle(start))), start)
        slotted.ram_torque(q, positions.sign)
        q.set_out("functions", "f.M")

    return driven(
        assignment,
        q,
        linkage,
        geometry.crank.crank_angle(start),
        KindSections(sizes="synthesis", course=("course", "functions")),
        formulas=formulas,
        applied=applied,
        sliders=(course,),
        paths=("D",),
        compared=slotted.RAM_COMPARED,
        positive={"E": 1 + 0j},
        equations=slotted.ram_equations(positions.sign, given.acceleration),
        essential=("diagrams", "functions"),
        facts={"form": "parted" if "free" in q else "whole"},
    )
