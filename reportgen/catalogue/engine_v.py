"""The V engine: two cylinders at an angle, the second rod articulated on the main rod or on the crank pin.

Ground 0, crank 1 (AB), main rod 2 (BC, with D on it), piston 3 (at C), rod 4 (DE, or BE), piston 5 (at E).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import Annotated

from reportgen.assignment.checks import of_parameters
from reportgen.assignment.common import Assignment, Draft, Positions
from reportgen.assignment.fields import Angle, Length, Offset, Whole, quantity
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.catalogue import assembly_checks, given_loads
from reportgen.catalogue.assembly_checks import Member
from reportgen.catalogue.crank_sliders import centred_slider, compared, second_cylinder
from reportgen.catalogue.driven_machine import driven
from reportgen.catalogue.given_data import GivenData, cycle_angles
from reportgen.catalogue.parameters import Driven
from reportgen.formula import PI, Symbol, cis, ids
from reportgen.formula.calculation import Calculation
from reportgen.machine import Crank, Dyad, Guide, Linkage, LinkPoint
from reportgen.machine.analysis import Machine, lettered
from reportgen.machine.load_laws import ConstantLaw
from reportgen.machine.loads import Applied, Piston, course, crank_motion, fixed, gas_forces

TURNS = 1
"""Turns of a cycle without an indicator diagram; with one, four strokes take two turns."""

Indicator = given_loads.Diagram
INDICATOR_OPTIONAL = True
EngineForce = Annotated[Given, quantity("N", least=-1e7, most=1e7, tiny=1e-6)]


class Parameters(Driven, masses=(2, 3, 4, 5), moments=(2, 4), shares=(2, 4), loads=("PC", "PE", "D")):
    """Lengths, the two axes, the speed; forces on the pistons, or their bore; a moving link has mass only if it is
    given.
    """

    AB: Length
    BC: Length
    BD: Offset = Given(0.0, 0.0, "mm", "0 mm")
    DE: Length
    alpha: Angle
    beta: Angle
    PC: EngineForce | None = None
    PE: EngineForce | None = None
    D: Length | None = None
    second_top: Annotated[int, Whole(1, 2)] = 2

    @property
    def joint(self) -> str:
        """Joint that carries rod 4: D on the main rod, or the crank pin B."""
        return "D" if self.BD.si else "B"

    @property
    def turns(self) -> int:
        """Turns in a cycle: two of a four-stroke engine with its gas, else one."""
        return 2 if self.D is not None else 1


def _places(given: Parameters, positions: Positions) -> tuple[tuple[float, ...], tuple[str, ...]]:
    """Return the even positions, and lettered those where the main piston is at a dead point."""
    top = positions.sign * (given.alpha.si - positions.start_or())
    return lettered(positions.count, given.turns, (top, top + math.pi))


def position_labels(parameters: Parameters, positions: Positions) -> tuple[str, ...]:
    """Return the labels of the positions of the cycle."""
    return _places(parameters, positions)[1]


# --- checks ---------------------------------------------------------------------------------------


def _check_loads(draft: Draft) -> Iterator[Finding]:
    """Yield faults unless forces on the pistons are given directly, or by their bore and the indicator diagram."""
    raw = draft.raw.get("parameters")
    if not isinstance(raw, dict):
        return
    bore, diagram = raw.get("D") is not None, draft.raw.get("indicator") is not None
    for key in (key for key in ("PC", "PE") if raw.get(key) is not None and (bore or diagram)):
        instead = "D" if bore else "indicator"
        yield Finding("both-given", ("parameters", key), {"first": instead, "second": key}, at="key")
    if bore and not diagram:
        yield Finding("missing-key", ("indicator",), {"key": "indicator"})
    if diagram and not bore:
        yield Finding("missing-key", ("parameters", "D"), {"key": "D"})


@of_parameters
def _check_assembly(given: Parameters) -> Iterator[Finding]:
    """Yield faults unless both pistons follow the crank through a whole turn and reverse twice, with D on the
    main rod.
    """
    if given.BD.si >= given.BC.si:
        most = f"< BC = {given.BC.si * 1e3:g} mm"
        yield Finding("out-of-range", ("parameters", "BD"), {"text": given.BD.text, "range": most})
        return
    members = {(2, 3): Member("BC", ("parameters", "BC")), (4, 5): Member(f"{given.joint}E", ("parameters", "DE"))}
    linkage = _linkage(given, _calculation(given))
    if obstacles := list(assembly_checks.findings(linkage, members)):
        yield from obstacles
        return
    motion_at = crank_motion(linkage, Positions(), 0.0)
    for slider, key in ((3, "BC"), (5, "DE")):
        yield from assembly_checks.to_and_fro(linkage, slider, motion_at, ("parameters", key))


CHECKS = (*given_loads.DIAGRAM_CHECKS, _check_loads, _check_assembly)


def _idle_engine(assignment: Assignment) -> Iterator[Finding]:
    """Warn that constant forces on the pistons do no work over a turn: an engine needs its diagram to deliver work."""
    key = next((key for key in ("PC", "PE") if getattr(assignment.parameters, key) is not None), None)
    if key is not None:
        yield Finding("engine-without-work", ("parameters", key), at="key")


WARNINGS = (_idle_engine,)
"""Checks for values that are allowed but probably not intended, applied to an assignment in order."""


# --- the machine ----------------------------------------------------------------------------------


def _calculation(given: Parameters, turn: int = 1, crank: Given | None = None) -> GivenData:
    """Return the given data, λ = R/L, the angle between the cylinders, masses, moments of inertia, a piston's area."""
    q, rod = GivenData(given), f"{given.joint}E"
    for id, length in {"AB": given.AB, "BC": given.BC, "BD": given.BD, rod: given.DE}.items():
        if length.si:
            q.datum(ids.length(id), length)
    q.datum("alpha", given.alpha, "α", "angle")
    q.datum("beta", given.beta, "β", "angle")
    q.speed()
    q.drawn("A", "B", crank)
    R, L = q.define("R", q["l.AB"]), q.define("L", q["l.BC"])
    q.set_out("proportions", R, L, q.define("lambda", R / L))
    q.give("delta", turn * (given.beta.si - given.alpha.si), "δ", "angle")
    for force, pin in ((given.PC, "C"), (given.PE, "E")):
        if force is not None:
            q.datum(ids.given_force(pin), force, Symbol("P", pin), "force")
    if given.D is not None:
        q.define("F", PI * q.datum("D", given.D) ** 2 / 4)
    q.gravity()
    q.bar(2, "B", "C")
    q.bar(4, given.joint, "E")
    for piston in (3, 5):
        q.mass(piston)
    return q


def _linkage(given: Parameters, q: GivenData) -> Linkage:
    articulation = (LinkPoint("D", 2, complex(given.BD.si)),) if given.BD.si else ()
    first, second = (Guide(0j, axis.si) for axis in (given.alpha, given.beta))
    return Linkage(
        ground={"A": 0j},
        driver=Crank("A", "B", q.si("R")),
        groups=(
            Dyad("RRP", (2, 3), "B", "C", first, (q.si("L"), 0.0)),
            Dyad("RRP", (4, 5), given.joint, "E", second, (given.DE.si, 0.0)),
        ),
        points=(*articulation, *q.centre_points({2: "B", 4: given.joint})),
        inertias=q.inertias({2: "S2", 3: "C", 4: "S4", 5: "E"}),
        gravity=-1j * given.gravity,
    )


def machine(assignment: Assignment) -> Machine:
    """Return the engine of an assignment: linkage, forces on the pistons, closed formulas."""
    given: Parameters = assignment.parameters
    positions, turn = assignment.positions, assignment.positions.sign
    q = _calculation(given, turn, assignment.drawing.crank)
    linkage, start = _linkage(given, q), positions.start_or()
    for link, axis in ((3, q["alpha"]), (5, q["beta"])):
        outwards = q.construct(ids.guide(link), cis(axis))
        q.construct(ids.sense(ids.applied_force(link)), -outwards)
    places, labels = _places(given, positions)

    motion_at = crank_motion(linkage, positions, start, given.speed)
    second_top = given.second_top if given.turns == 2 else 1
    courses = (course(linkage, 3, motion_at, given.turns), course(linkage, 5, motion_at, given.turns, second_top))
    pistons: tuple[Piston, ...] = ()
    if given.D is not None:
        pistons = tuple(Piston.on(one, given.D.si, assignment.indicator.table) for one in courses)
    angle = turn * (start - given.alpha.si) + cycle_angles(positions, given.turns, places)
    on_rod = given.joint == "D"

    def formulas(q: Calculation) -> None:
        centred_slider(q, turn, 2, 3, "C", angle=angle, along="l.BD", centre="D" if on_rod else "", axes="ξη")
        second_cylinder(q, turn, given.joint)

    plans = ("v.C", "omega.2", "v.E", "omega.4", "a.C", "eps.2", "a.E", "eps.4", *(("v.D", "a.D") if on_rod else ()))
    return driven(
        assignment,
        q,
        linkage,
        start,
        formulas=formulas,
        count=len(places),
        turns=given.turns,
        applied=gas_forces(pistons) if pistons else _constant(given),
        sliders=pistons or courses,
        positive={"C": -cmath.exp(1j * given.alpha.si), "E": -cmath.exp(1j * given.beta.si)},
        paths=("D",) if on_rod else (),
        facts={"joint": given.joint, "top": given.second_top - 1, "form": "articulated" if on_rod else "common"},
        compared=compared(plans),
        places=places,
        labels=labels,
    )


def _constant(given: Parameters) -> tuple[Applied, ...]:
    """Return constant forces that push the pistons towards the crank."""
    ends = ((3, "C", given.PC, given.alpha), (5, "E", given.PE, given.beta))
    return tuple(
        Applied(ids.applied_force(link), link, pin, fixed(-cmath.exp(1j * axis.si)), ConstantLaw(force.si))
        for link, pin, force, axis in ends
        if force is not None
    )
