"""Friction in a report: values of each joint for templates, the rounds, and figures with friction circles."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial

from reportgen.base.records import Record
from reportgen.base.template_access import view
from reportgen.document import FIRST_COLUMN, Column, Inlines, Table, Text
from reportgen.document.figure_placement import FigureScenes, beside_one_another, on_paper
from reportgen.document.tables import side_by_side
from reportgen.document.template_rendering import NamedPoint, subscripted
from reportgen.drawing import Arc, Circle, Item, Line, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.drawing_description import PaperLength, fact, turning
from reportgen.drawing.force_drawings import Force, draw_forces
from reportgen.drawing.geometry import polar
from reportgen.drawing.labels import label
from reportgen.drawing.scheme import mechanism, skeleton
from reportgen.drawing.vector_plan import plan
from reportgen.formula import Number, Symbol, ids, vocabulary
from reportgen.friction import friction_ids
from reportgen.friction.force_plans import force_plan_with_friction
from reportgen.friction.joints import FrictionForces, friction_of, relative_sense, with_friction
from reportgen.friction.ledger import RubbingJoint, rubbing_joints
from reportgen.friction.tilting import FaceForce, Leaning, any_tilts, at_both_ends, face_forces, leaning_forces, tilting
from reportgen.machine import GROUND
from reportgen.machine.force_analysis import reaction_name
from reportgen.report import template_equations
from reportgen.report.context import ReportContext
from reportgen.report.link_views import GroupView
from reportgen.report.mechanism_figures import as_large_as_asked, drawing_scale, looks
from reportgen.report.quantity_tables import QuantityTable, RowTable, bare
from reportgen.report.slider_faces import face
from reportgen.report.topic_views import Passages, ViewHooks

ENLARGED = 8.0
"""Largest radius (mm) of an enlarged friction circle."""
REACH = 22.0
"""Length (mm) by which the lines of forces are drawn beyond their joints."""
ENLARGEMENTS = (2.0, 2.5, 4.0, 5.0, 10.0, 20.0, 25.0, 40.0, 50.0, 100.0, 200.0, 500.0, 1000.0)


@view()
class Rubbing(Record):
    """A joint with friction for templates: the digits of its reaction, its pin or its slider."""

    of: RubbingJoint
    digits: str
    kind: str
    point: NamedPoint
    link: int


def rubbing(report: ReportContext) -> tuple[Rubbing, ...]:
    """Return the joints with friction, in the order of assembly."""
    friction = friction_of(report.machine)
    if friction is None or not report.has_forces:
        return ()
    return tuple(
        Rubbing(
            each, each.digits, "pin" if each.is_pin else "slider", NamedPoint(each.joint.point), each.joint.links[1]
        )
        for each in rubbing_joints(report.ledger.families, report.machine.linkage, friction)
        if each.lost in report.ledger
    )


def resting(report: ReportContext) -> str:
    """Return the links of joints that have no friction because they never move against each other: "2–3, 1–4"."""
    friction = friction_of(report.machine)
    if friction is None or not report.has_forces:
        return ""
    joints = rubbing_joints(report.ledger.families, report.machine.linkage, friction)
    return ", ".join("–".join(map(str, sorted(each.joint.links))) for each in joints if each.lost not in report.ledger)


def solved_exactly(report: ReportContext, k: int) -> bool:
    """Return True if the rounds do not converge at a position, so that the equations are solved instead."""
    return bool(_solved_friction(report).exact[k - 1])


def data(report: ReportContext) -> Inlines:
    """Return the given data of the joints with friction."""
    joints = rubbing(report)
    at = dict.fromkeys(str(each.point) if each.kind == "pin" else str(each.link) for each in joints)
    names = (friction_ids.coefficient, friction_ids.pin_radius, friction_ids.circle)
    given = (name(place) for place in at for name in names)
    quantities = [template_equations.quantity(report, id) for id in given if id in report.machine.calculation]
    return tuple(inline for n, carried in enumerate(quantities) for inline in (*((Text("; "),) if n else ()), *carried))


def loss_lines(report: ReportContext) -> list[str]:
    """Return the ids of the couples and forces of friction."""
    return [each.of.lost for each in rubbing(report)]


def part_lines(report: ReportContext) -> list[str]:
    """Return the ids of the torques that overcome the friction of each joint, and of the torque with friction."""
    return [*(friction_ids.part(each.digits) for each in rubbing(report)), friction_ids.torque]


def mean_lines(report: ReportContext) -> list[str]:
    """Return the ids of the mean torque with friction and of the efficiency over the cycle."""
    return report.known((friction_ids.mean, friction_ids.cycle_efficiency))


def circle_lines(report: ReportContext) -> list[str]:
    """Return the ids of the friction circles that are calculated, not given."""
    points = dict.fromkeys(each.point for each in rubbing(report) if each.kind == "pin")
    return [id for id in map(friction_ids.circle, points) if report.ledger[id].definition is not None]


def angle_lines(report: ReportContext) -> list[str]:
    """Return the ids of the angles of friction of the sliders."""
    links = dict.fromkeys(each.link for each in rubbing(report) if each.kind == "slider")
    return [friction_ids.angle(link) for link in links]


def turning_lines(report: ReportContext) -> list[str]:
    """Return the ids of the relative rotations in pins between two moving links."""
    return report.known(friction_ids.turning(each.digits) for each in rubbing(report))


def drives(report: ReportContext, k: int) -> str:
    """Return "drives" if the driver does work at position `k`, so that an efficiency exists, else "driven"."""
    return "driven" if math.isnan(report.ledger.number(friction_ids.efficiency, k).value) else "drives"


def has_efficiency(report: ReportContext, k: int) -> bool:
    """Return True if the driver does work at position `k`."""
    return drives(report, k) == "drives"


def cycle(report: ReportContext) -> str:
    """Return the state of the cycle for its efficiency: the driver "drives", is "driven", is neither ("even"), or
    "locks".

    "consumed" means that friction takes all work of the machine.
    """
    if friction_ids.mean not in report.ledger:
        return "locks"
    mean = report.ledger["M.mean"].at(None) * report.machine.turn
    if friction_ids.cycle_efficiency in report.ledger:
        return "drives" if mean > 0 else "driven"
    return "consumed" if mean < 0 else "even"


# --- tables ---------------------------------------------------------------------------------------


def results(report: ReportContext) -> list[str]:
    """Return the ids of the torque with friction and of the efficiency."""
    return report.known((friction_ids.torque, friction_ids.efficiency))


def reactions(report: ReportContext) -> tuple[str, ...]:
    """Return the ids of the reactions with friction."""
    return tuple(friction_ids.reaction(each.digits) for each in rubbing(report))


def rounds(report: ReportContext, key: str, caption: str, head: Sequence[str], k: int) -> tuple[Table, ...]:
    """Return a table of the reactions in each round and the torque that the previous ones give; the first are without
    friction.
    """
    ledger, joints = report.ledger, rubbing(report)
    numbers = [n for n in range(1, len(ledger.families)) if friction_ids.torque_of_round(n) in ledger]
    names = ["", *map(str, range(1, len(numbers) + 1))]
    columns: list[list[object]] = []
    for each in joints:
        without = ids.reaction(each.digits)
        of_rounds = [friction_ids.reaction.of({"joint": each.digits, "round": name}) for name in names[1:]]
        reactions = [without, *(id for id in of_rounds if id in ledger), friction_ids.reaction(each.digits)]
        columns.append([ledger.symbol(without), ledger.printed_unit("N"), *(bare(report, id, k) for id in reactions)])
    torques = ["M.eq", *map(friction_ids.torque_of_round, numbers), friction_ids.torque]
    kind = ledger["M.eq"].how
    columns.append([report.balance_symbol(), ledger.printed_unit(kind.unit), *(bare(report, id, k) for id in torques)])
    titles = [report.words["tables"]["friction.rounds"]["round"], "", *(str(n) for n in range(len(torques)))]
    return side_by_side(
        report.prose, key, caption, Column(FIRST_COLUMN), titles=titles, columns=columns, most=8, heads=2
    )


def dead_rows(report: ReportContext) -> Iterator[Sequence[object]]:
    """Yield each slider's dead centres by the crank angle from position 1, and the angles before and after in which it
    locks.
    """
    machine = report.machine
    for course in machine.sliders:
        for number, angle in enumerate(course.dead_centres[:2], 1):
            turn = math.degrees((angle - course.phase) % (2 * math.pi))
            sides = [friction_ids.dead(course.link, number, side) for side in ("before", "behind")]
            if all(id in report.ledger for id in sides):
                angle_printed = Number(0.0 if abs(turn - 360) < 1e-9 else turn, 2)
                yield str(course.link), angle_printed, *(bare(report, id, None) for id in sides)


# --- figures --------------------------------------------------------------------------------------


class JointForce(Record):
    """Force (N) in a joint with friction at a position, on the second link of the reaction's name, and its
    place (m).
    """

    each: Rubbing
    force: complex
    at: complex
    k: int
    offset: complex
    """Vector (m) from the centre of the pin to the line of the force; 0 in a guide."""


def _solved_friction(report: ReportContext) -> FrictionForces:
    solved = with_friction(report.analysis)
    assert solved is not None
    return solved


def joint_forces(report: ReportContext, k: int) -> Iterator[JointForce]:
    """Yield the force in each joint, friction included."""
    solved, motion, index = _solved_friction(report), report.analysis.motion, k - 1
    loads = {(load.name, load.link): load for load in solved.loads}
    for each in rubbing(report):
        joint = each.of.joint
        name = reaction_name(*joint.links)
        reaction, rubs = solved.forces.reactions[name], loads[name, joint.links[1]]
        force, pin = complex(reaction.force[index]), complex(motion.points[joint.point].p[index])
        # The forces are found for the second link; the reaction may be named as the one on the first.
        sign = 1 if each.of.ends == joint.links else -1
        if each.kind == "pin":
            couple = float(rubs.couple[index])
            offset = -1j * force * couple / abs(force) ** 2 if force else 0j
            yield JointForce(each, sign * force, pin, k, offset)
        else:
            place, whole = complex(reaction.point[index]), sign * (force + complex(rubs.force[index]))
            yield JointForce(each, whole, place if cmath.isfinite(place) else pin, k, 0j)


def scheme(report: ReportContext, k: int) -> FigureScenes:
    """Draw the mechanism with its friction circles and the lines of the reactions, which are tangent to them."""
    return as_large_as_asked(report, partial(scheme_scene, report, k))


def scheme_scene(report: ReportContext, k: int, factor: float = 1.0) -> Scene:
    """Return the same drawing, enlarged by `factor` relative to μ_l."""
    machine, motion, scale = report.machine.linkage, report.analysis.motion, drawing_scale(report) * factor
    loaded = [carried for carried in joint_forces(report, k) if carried.force]
    bones, look = skeleton(machine, motion, k - 1, scale), looks(report, scale, factor)
    draft = mechanism(bones, (0, *machine.links), look)
    circles = {
        carried.each.point: _circle(report, carried.each) * scale for carried in loaded if carried.each.kind == "pin"
    }
    marks: list[Item] = [Circle(bones.points[point], radius, style.REACTION) for point, radius in circles.items()]
    forces = []
    for carried in loaded:
        if ends := _at_ends(report, carried):
            marks += face(report, carried.each.link, k, scale)
            forces += [Force(name, end.at * scale, end.across + end.along, "reaction") for end, name in ends]
            continue
        marks += _line(carried, loaded, scale)
        forces.append(
            Force(_named(report, carried.each), (carried.at + carried.offset) * scale, carried.force, "reaction")
        )
    facts = tuple(
        fact("friction-circle", vocabulary.point(point), PaperLength(radius)) for point, radius in circles.items()
    )
    return finish(Canvas(says=facts) + draft + Canvas(tuple(marks)) + draw_forces(forces), notes=look.notes)


def _line(carried: JointForce, loaded: Sequence[JointForce], scale: float) -> Iterator[Item]:
    """Yield the line of a force: to the next joint of its link if it is tangent to that friction circle too."""
    along, here = carried.force / abs(carried.force), (carried.at + carried.offset) * scale
    for further in loaded:
        there = (further.at + further.offset) * scale
        share_link = set(carried.each.of.joint.links) & set(further.each.of.joint.links) - {0}
        apart = (there - here) * along.conjugate()
        if further is not carried and share_link and abs(apart) > REACH / 2 and abs(apart.imag) < style.ON_LINE:
            yield Line(here, there, style.CONSTRUCTION)
            return
    yield Line(here - REACH / 2 * along, here + REACH * along, style.CONSTRUCTION)


def _circle(report: ReportContext, each: Rubbing) -> float:
    """Return the radius of a friction circle (m) as it is printed."""
    return float(report.ledger[friction_ids.circle(each.point)].values[0])


def _named(report: ReportContext, each: Rubbing) -> Symbol:
    return report.named(Symbol("R", each.digits, "fr", "vector"))


def joints(report: ReportContext, k: int) -> FigureScenes:
    """Draw each friction circle enlarged with the line of its reaction, and each guide with its angle of friction."""
    scale = drawing_scale(report)
    return beside_one_another(
        *(_detail(report, k, carried, scale) for carried in joint_forces(report, k) if carried.force)
    )


def _detail(report: ReportContext, k: int, carried: JointForce, scale: float) -> Scene:
    """Return a friction circle enlarged, or the angle of friction of a guide with the parts of its reaction."""
    if carried.each.kind == "slider":
        return _guide_detail(report, carried)
    radius = _circle(report, carried.each) * scale
    factor = max((factor for factor in ENLARGEMENTS if radius * factor <= ENLARGED), default=1.0)
    radius *= factor
    along, foot = carried.force / abs(carried.force), carried.offset / abs(carried.offset) * radius
    joint = carried.each.of.joint
    acting, loaded = carried.each.of.ends
    sense = float(relative_sense(joint, report.analysis.motion)[k - 1]) * (1 if loaded == joint.links[1] else -1)
    turn = cmath.phase(-foot)
    start, stop = (turn - 0.7, turn + 0.7) if sense > 0 else (turn + 0.7, turn - 0.7)
    items: list[Item] = [
        Circle(0j, radius, style.VISIBLE),
        Circle(0j, style.POINT, style.VISIBLE, style.PAPER),
        Line(0j, foot, style.DIMENSION),
        Line(foot - REACH / 2 * along, foot + REACH / 2 * along, style.CONSTRUCTION),
        Arc(0j, radius + 3.0, start, stop, style.DIMENSION, style.DIMENSION_HEAD),
    ]
    # The link that the force acts on turns against the other; on the frame, that is its own rotation.
    ω = Symbol("ω", str(loaded) if acting == GROUND else ids.joint(loaded, acting))
    ρ = report.ledger.symbol(friction_ids.circle(carried.each.point))
    names = [label(foot / 2, ρ), label((radius + 3.0) * polar(turn), ω)]
    forces = draw_forces((Force(_named(report, carried.each), foot, carried.force, "reaction"),))
    title = f"{subscripted(carried.each.point)} ({factor:g} : 1)"
    facts = fact("radius", ρ, PaperLength(radius)), turning(ω, sense)
    return finish(Canvas(tuple(items), tuple(names), facts) + forces, title=title)


def _guide_detail(report: ReportContext, carried: JointForce) -> Scene:
    """Draw N across the guide and F along it against the sliding, in their ratio; the reaction leans by φ = arctan F/N.

    For a slider that tilts, draw the two forces on the ends of its face.
    """
    joint, digits = carried.each.of.joint, carried.each.digits
    guide = complex(report.analysis.motion.slides[joint.links].direction[carried.k - 1])
    φ = report.ledger.symbol(friction_ids.angle(carried.each.link))
    title = f"{report.words['figure']['link']} {carried.each.link}"
    if ends := _at_ends(report, carried):
        return at_both_ends(ends, guide, φ, title)
    along = guide * (carried.force * guide.conjugate()).real
    names = [report.named(Symbol(*of, "", "vector")) for of in (("N", digits), ("F", f"fr{digits}"))]
    names.append(_named(report, carried.each))
    return leaning_forces(guide, [Leaning(carried.force - along, along, 0j, names)], φ, title)


def _at_ends(report: ReportContext, carried: JointForce) -> list[tuple[FaceForce, Symbol]]:
    """Return the forces on the ends of a slider that tilts, with their names; an empty list for any other joint."""
    joint, digits = carried.each.of.joint, carried.each.digits
    return [
        (force, report.named(Symbol("R", f"{digits},{force.number}", "fr", "vector")))
        for force in face_forces(report, joint, carried.k)
    ]


# --- force plans ----------------------------------------------------------------------------------


def force_plan_of_group(report: ReportContext, k: int, group: GroupView) -> FigureScenes:
    """Return the force plan of a group with friction over the one without."""
    assert group.polygon is not None
    return on_paper(plan(force_plan_with_friction(report, group.polygon, k)))


def force_plan_of_driver(report: ReportContext, k: int) -> FigureScenes:
    """Return the force plan of the driver with friction over the one without."""
    assert report.driver_polygon is not None
    return on_paper(plan(force_plan_with_friction(report, report.driver_polygon, k)))


VALUES: Mapping[str, Callable[[ReportContext], object]] = {
    "dead_zones": lambda report: any(dead_rows(report)),
    "friction_angles": angle_lines,
    "friction_circles": circle_lines,
    "friction_cycle": cycle,
    "friction_tilts": any_tilts,
    "friction_data": data,
    "friction_losses": loss_lines,
    "friction_means": mean_lines,
    "friction_parts": part_lines,
    "friction_reactions": reactions,
    "friction_resting": resting,
    "friction_turning": turning_lines,
}
"""Values that templates name without parentheses."""

FIGURES: Mapping[str, tuple[str, Callable[..., FigureScenes]]] = {
    "friction": ("fig.friction", scheme),
    "friction-joints": ("fig.friction.joints", joints),
    "friction-plan": ("fig.friction.R", force_plan_of_group),
    "friction-driver": ("fig.friction.R.1", force_plan_of_driver),
}
"""Its figures, as `outline.FIGURES` has them."""


def _where_it_takes(section: str) -> Passages:
    """Return a passage for machines whose joints take a torque from the driver."""
    return lambda report: (section,) if friction_ids.reduced in report.ledger else ()


HOOKS = ViewHooks(
    values=VALUES,
    functions={
        "drives": drives,
        "has_efficiency": has_efficiency,
        "solved_exactly": solved_exactly,
        "tilting_with_friction": tilting,
    },
    figures=FIGURES,
    tables={
        "friction": QuantityTable(results, "all_positions"),
        "friction.rounds": rounds,
        "friction.dead": RowTable(dead_rows, (24.0, 48.0, 44.0, 44.0)),
    },
    passages={
        "given": lambda report: ("friction-given",) if data(report) else (),
        "reduced": _where_it_takes("reduced-friction"),
        "reduced-part": _where_it_takes("friction-reduced-part"),
        "reduced-task": _where_it_takes("friction-reduced-task"),
        "conclusion": lambda report: ("friction-conclusion",) if friction_ids.torque in report.ledger else (),
        "task": lambda report: ("friction-task",) if friction_ids.torque in report.ledger else (),
    },
)
