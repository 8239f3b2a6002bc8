"""Figures of forces: separated links, the driver, Zhukovsky's lever."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from reportgen.document.figures import (
    HALF,
    MM,
    Drawn,
    beside_one_another,
    drawing_scale,
    figure,
    looks,
    on_paper,
)
from reportgen.document.groups import BodyView, GroupView
from reportgen.document.plans import force_plan, motion_plan
from reportgen.document.report import Report
from reportgen.figures.draft import Draft
from reportgen.figures.forces import ArmOf, Couple, Force
from reportgen.figures.forces import bodies as bodies_figure
from reportgen.figures.forces import lever as lever_figure
from reportgen.figures.labels import label
from reportgen.figures.plan import plan
from reportgen.figures.scene import Circle, Item, Line, Scene
from reportgen.figures.style import CONSTRUCTION, PAPER, VISIBLE
from reportgen.ledger.forces.polygon import Polygon
from reportgen.mechanism.loads import Load, as_single_force, percussion_meeting
from reportgen.mechanism.structure import DRIVER
from reportgen.notation import symbols
from reportgen.notation.expressions import Chain, Symbol

# --- groups


@figure("bodies")
def bodies(report: Report, k: int, group: GroupView) -> Drawn:
    """The group with all its forces, at half size; then each link that moments are taken of, with the arms."""
    half, links = drawing_scale(report) * HALF, (group.i, group.j)
    forces = [
        *_loads(report, links, k, half),
        *_found_before(report, group.polygon, links, k, half),
        *_outer(report, group, group.i, k, half),
        *_outer(report, group, group.j, k, half),
    ]
    whole = _scene(
        report,
        k,
        half,
        links,
        forces,
        turning=_couples(report, links, k, half),
        looks=looks(report, half, HALF),
        title=report.words["figure"]["group"].format(i=group.i, j=group.j),
    )
    return beside_one_another(whole, *(_one_link(report, k, group, *moments) for moments in _moments(group)))


def _one_link(report: Report, k: int, group: GroupView, link: int, pin: str) -> Scene:
    """One link of a group with all that acts on it and the arms about a pin."""
    scale = drawing_scale(report)
    forces = [
        *_loads(report, (link,), k, scale),
        *_found_before(report, group.polygon, (link,), k, scale),
        *_outer(report, group, link, k, scale),
        _inner(report, group, link, k, scale),
    ]
    return _scene(
        report,
        k,
        scale,
        (link,),
        forces,
        arms=_arms(report, group.arms(pin, link), pin, k),
        turning=_couples(report, (link,), k, scale),
        extra=_percussion(report, link, k),
        looks=looks(report, scale),
        title=f"{report.words['figure']['link']} {link}",
    )


def _moments(group: GroupView) -> tuple[tuple[int, str], ...]:
    """The links of a group that the force analysis takes moments of, with the pin it takes them about."""
    match group.kind:
        case "RRR":
            return (group.i, group.Q), (group.j, group.Q)
        case "RPR":
            return ((group.j, group.T),)
        case "RRP":
            return ((group.i, group.Q),)
    return ()


def _scene(
    report: Report, k: int, scale: float, links: Sequence[int], forces: Sequence[Force], **more: Any
) -> Scene:
    return bodies_figure(report.machine.linkage, report.analysis.motion, k - 1, scale, links, forces, **more)


def _at(report: Report, name: str, k: int, scale: float) -> complex:
    """Where a point stands on paper."""
    return complex(report.analysis.motion.points[name].p[k - 1]) * scale


def _arms(report: Report, ids: Sequence[str], pin: str, k: int) -> list[ArmOf]:
    """The arms about a pin that are not zero; an arm's id names its force: h.G2.B."""
    about = _at(report, pin, k, drawing_scale(report))
    return [ArmOf(report.ledger.symbol(id), about, id.split(".")[1]) for id in ids if not report.is_zero(id, k)]


# --- reactions


def _outer(report: Report, group: GroupView, link: int, k: int, scale: float) -> list[Force]:
    """The reaction in the outer joint of a group's link, by components where moments gave one of them."""
    first = link == group.i
    digits = group.outer if first else group.guide
    pin = group.P if first else group.T or group.Q
    parts = (".t", ".n") if f"R.{digits}.t" in report.ledger else ("",)
    return [_reaction(report, f"{digits}{part}", pin, k, scale) for part in parts]


def _inner(report: Report, group: GroupView, link: int, k: int, scale: float) -> Force:
    """The reaction in the inner joint on one link of the group, as it is read from the plan."""
    read = _reaction(report, group.inner, group.Q, k, scale)
    if link == group.i:
        return read
    opposite = Symbol("R", group.across, over="vector")
    return Force(opposite, read.at, -read.direction, "reaction", f"R{group.across}")


def _reaction(report: Report, name: str, pin: str, k: int, scale: float) -> Force:
    """A reaction, or a component of it as in 12.t, at a pin."""
    shown = symbols.vector(report.ledger.symbol(f"R.{name}"))
    direction = 0j if report.is_zero(f"R.{name}", k) else complex(report.ledger[f"F.R{name}"].at(k))
    return Force(shown, _at(report, pin, k, scale), direction, "reaction", f"R{name}")


def _found_before(
    report: Report, polygon: Polygon | None, links: Sequence[int], k: int, scale: float
) -> list[Force]:
    """Reactions of other groups, found before, on some links of a force plan."""
    assert polygon is not None
    result = []
    for side in polygon.sides:
        if side.unknown or side.link not in links or side.name.endswith(".t") or side.name[0] != "R":
            continue
        id = f"R.{side.name[1:]}"
        at = complex(report.analysis.forces.reactions[side.name].point[k - 1]) * scale
        known = np.isfinite(at) and not report.is_zero(id, k)
        direction = complex(report.ledger[f"F.{side.name}"].at(k)) if known else 0j
        shown = symbols.vector(report.ledger.symbol(id))
        result.append(Force(shown, at if known else 0j, direction, "reaction", side.name))
    return result


# --- the driver


@figure("crank")
def crank(report: Report, k: int) -> Drawn:
    """The crank with the reactions on it and their arms about its centre, and their polygon."""
    polygon, scale, centre = report.driver_polygon, drawing_scale(report), report.driver.centre
    assert polygon is not None
    forces = [
        *_loads(report, (DRIVER,), k, scale),
        *_found_before(report, polygon, (DRIVER,), k, scale),
        _reaction(report, "01", centre, k, scale),
    ]
    sense = float(np.sign(report.ledger.number("M.eq", k).value))
    drawing = _scene(
        report,
        k,
        scale,
        (DRIVER,),
        forces,
        arms=_arms(report, report.crank_arms, centre, k),
        turning=(Couple(report.ledger.symbol("M.eq"), _at(report, centre, k, scale), sense),),
        looks=looks(report, scale),
    )
    return beside_one_another(drawing, plan(force_plan(report, polygon, k)))


@figure("slide")
def slide(report: Report, k: int) -> Drawn:
    """A sliding driver with the reactions on it and the force that balances it, and their polygon."""
    polygon, scale, pin = report.driver_polygon, drawing_scale(report), report.driver.pin
    assert polygon is not None
    forces = [
        *_loads(report, (DRIVER,), k, scale),
        *_found_before(report, polygon, (DRIVER,), k, scale),
        *(_reaction(report, name, pin, k, scale) for name in ("01", "cb")),
    ]
    drawing = _scene(report, k, scale, (DRIVER,), forces, looks=looks(report, scale))
    return beside_one_another(drawing, plan(force_plan(report, polygon, k)))


# --- loads


def _loads(report: Report, links: Sequence[int], k: int, scale: float) -> list[Force]:
    """Loads on links; a force with a couple acts at the one point where it alone does both."""
    return [
        Force(
            symbols.vector(report.ledger.symbol(load.name)),
            _acts_at(report, load, k) * scale,
            complex(load.force[k - 1]),
            "load",
            load.name,
        )
        for load in report.analysis.loads
        if load.link in links and _has_force(report, load, k)
    ]


def _has_force(report: Report, load: Load, k: int) -> bool:
    return load.name in report.ledger and not _is_torque(report, load) and not report.is_zero(load.name, k)


def _is_torque(report: Report, load: Load) -> bool:
    """Whether a load has no force by its nature."""
    return any(torque.name == load.name for torque in report.machine.torques)


def _acts_at(report: Report, load: Load, k: int) -> complex:
    """Where a load is drawn: an inertia force at the constructed point Q, else where it acts alone."""
    for body in report.couples:
        if load.name == body.force and (points := _percussion_points(report, body, k)):
            return points[1]
    single = complex(as_single_force(load)[k - 1])
    return single if np.isfinite(single) else complex(load.point[k - 1])


def _percussion_points(report: Report, body: BodyView, k: int) -> tuple[complex, complex] | None:
    """The centre of percussion K and the point Q (m); None where their lines do not meet near the link."""
    start, centre = (report.analysis.motion.points[name] for name in (body.start, body.centre))
    l_sk = float(report.ledger[body.ids[-1]].values[0])
    s, a = complex(centre.p[k - 1]), complex(start.p[k - 1])
    q = complex(percussion_meeting(start.p, centre.p, start.a, centre.a, l_sk)[k - 1])
    near = abs(s - a) + 2 * l_sk
    return (s + (s - a) / abs(s - a) * l_sk, q) if np.isfinite(q) and abs(q - s) < near else None


def _percussion(report: Report, link: int, k: int) -> Draft:
    """K on a link, and the two lines of construction that meet in Q."""
    body = next((body for body in report.couples if body.link == link), None)
    points = body and _percussion_points(report, body, k)
    if not body or not points or report.is_zero(body.couple, k):
        return Draft()
    scale, number = drawing_scale(report), str(link)
    known, meeting = (point * scale for point in points)
    marks: tuple[Item, ...] = (
        Line(_at(report, body.centre, k, scale), meeting, CONSTRUCTION),
        Line(known, meeting, CONSTRUCTION),
        Circle(known, 0.6, VISIBLE, PAPER),
        Circle(meeting, 0.6, VISIBLE, PAPER),
    )
    labels = label(known, Symbol("K", number), gap=1.2), label(meeting, Symbol("Q", number), gap=1.2)
    return Draft(marks, labels)


def _couples(report: Report, links: Sequence[int], k: int, scale: float) -> list[Couple]:
    """Torques, and couples whose force is zero."""
    result = []
    for load in report.analysis.loads:
        if load.link not in links or load.couple[k - 1] == 0:
            continue
        torque = _is_torque(report, load)
        if torque or report.is_zero(load.name, k):
            shown = report.ledger.symbol(load.name if torque else f"M.{load.name}")
            result.append(Couple(shown, complex(load.point[k - 1]) * scale, float(load.couple[k - 1])))
    return result


# --- Zhukovsky's lever


@figure("lever")
def lever(report: Report, k: int) -> Drawn:
    """The velocity plan turned by 90° against ω1, every load at its image, arms about the pole."""
    ledger, machine, motion, index = report.ledger, report.machine, report.analysis.motion, k - 1
    per = -1j * machine.turn * MM / float(ledger["mu.v"].values[0])
    forces, arms = [], []
    for load in report.analysis.loads:
        if not _has_force(report, load, k):
            continue
        at = np.full(motion.driver.shape, _acts_at(report, load, k))
        image = complex(motion.of(load.link, at).v[index]) * per
        shown = symbols.vector(ledger.symbol(load.name))
        forces.append(Force(shown, image, complex(load.force[index]), "load", load.name))
        if not report.is_zero(f"h.{load.name}.p", k):
            arms.append(ArmOf(ledger.symbol(f"h.{load.name}.p"), 0j, load.name))
    if machine.span and not report.is_zero("R.cb", k):
        # The force that balances a sliding driver acts on the lever too; that of a crank is a torque.
        image = complex(motion.points[report.driver.pin].v[index]) * per
        shown = symbols.vector(ledger.symbol("M.eq"))
        forces.append(Force(shown, image, complex(ledger["F.Rcb"].at(k)), "reaction", "Rcb"))
        arms.append(ArmOf(ledger.symbol(report.driver.velocity_segment), 0j, "Rcb"))
    scale = Chain((ledger.symbol("mu.v"), ledger.number("mu.v")))
    drawing = motion_plan(report, "v", k)
    return on_paper(lever_figure(drawing, forces, arms, sense=-machine.turn, notes=(scale,)))
