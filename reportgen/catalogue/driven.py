"""The machine of an assignment whose crank is driven, and the outline of its report."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from reportgen.assignment.common import Assignment
from reportgen.catalogue import (
    declared_loads,
    given_balancing,
    given_friction,
    given_motion,
    given_springs,
    wide_sliders,
)
from reportgen.catalogue.given_sheet import GivenSheet
from reportgen.catalogue.parameters import Flywheel
from reportgen.machine import DRIVER, Crank, Linkage
from reportgen.machine.analysis import Machine
from reportgen.machine.loads import LoadsByKind, crank_motion

OPENING = ("contents", "given", "scheme", "overview", "foreword", "symbols", "structure", "motion")
CLOSING = ("conclusion", "references", "checks")

# --- the machine ------------------------------------------------------------------------------------


def outline(
    masses: bool,
    loads: bool,
    flywheel: Flywheel | None,
    *,
    balancing: bool = False,
    motion: bool = False,
    curves: bool = True,
    further: bool = False,
    springs: bool = False,
    faces: bool = False,
    friction: bool = False,
    sizes: str = "dimensions",
    load: str = "working",
    summary: tuple[str, ...] = (),
    course: tuple[str, ...] = (),
    driver: str = "crank",
) -> tuple[str, ...]:
    """The report's sections in order; without mass and load it ends with the kinematics.

    `sizes` and `load` tell where lengths and loads come from; `summary` follows the accelerations, `course` the
    kinematic diagrams, if there are any `curves`.  `further` loads stand beside those of the kind, there may
    be `springs`, sliders may have `faces` and joints `friction`.  The chapter on `balancing` follows the driver,
    the true `motion` the flywheel.
    """
    diagrams = ("diagrams", *course) if curves else ()
    kinematics = (*OPENING, sizes, "positions", "velocity", "acceleration", *summary, *diagrams)
    if not (masses or loads):
        return (*kinematics, *CLOSING)
    inertia = ("loads",) if masses else ()
    wheel = (*(() if flywheel is None else ("flywheel",)), *(("true-motion",) if motion else ()))
    beside = (*(("further-loads",) if further else ()), *(("springs",) if springs else ()))
    shaking = ("balancing/chapter",) if balancing else ()
    wide = ("faces",) if faces else ()
    rubbing = ("friction",) if friction else ()
    behind = (*rubbing, *shaking, *wheel)
    return (*kinematics, load, *beside, *inertia, "groups", *wide, driver, *behind, *CLOSING)


def with_crank(q: GivenSheet, linkage: Linkage) -> Linkage:
    """The linkage with the body of its crank, if the file gives one that its kind does not place by itself."""
    driver, given = linkage.driver, q.given
    centre = f"S{DRIVER}"
    placed = any(point.name == centre for point in linkage.points)
    assert given is not None, "a sheet without parameters has no links"
    if placed or not isinstance(driver, Crank) or not any(q.of_link(letter, DRIVER) for letter in "GmJs"):
        return linkage
    share = q.of_link("s", DRIVER)
    weightless = not any(q.of_link(letter, DRIVER) for letter in "Gm")
    if (given.crank_on_axis or weightless) if share is None else share.si == 0:
        # A body on its own axis is no rod: its moment of inertia is given, or none.
        q.mass(DRIVER)
        q.moment(DRIVER, None)
        centre = next(
            (body.centre for body in linkage.inertias if body.link == DRIVER and share is None), driver.centre
        )
    else:
        q.bar(DRIVER, driver.centre, driver.pin)
    others = tuple(body for body in linkage.inertias if body.link != DRIVER)
    return replace(
        linkage,
        points=(*q.centre_points({DRIVER: driver.centre}), *linkage.points),
        inertias=(*q.inertias({DRIVER: centre}), *others),
    )


def driven(
    assignment: Assignment,
    q: GivenSheet,
    linkage: Linkage,
    start: float,
    sections: Mapping[str, Any] | None = None,
    **own: Any,
) -> Machine:
    """The machine of an assignment whose crank stands at the angle `start` (rad) in position 1.

    `sections` go to `outline`, all further fields of its `Machine` are given by name; loads that are zero throughout
    are left out.
    """
    given, positions = assignment.parameters, assignment.positions
    q.set_out("places")
    linkage = with_crank(q, linkage)
    of_kind = (*own.pop("applied", ()), *own.pop("torques", ()))
    turns = own.get("turns", assignment.turns)
    motion_at = crank_motion(linkage, positions, start)
    declared = declared_loads.loads(given.loads, linkage, motion_at, of_kind, through=not positions.at)
    of_springs, springs = given_springs.loads(given.springs, linkage, q.datum, (*of_kind, *declared), motion_at)
    loads = LoadsByKind.of((*of_kind, *declared, *of_springs))
    faces = wide_sliders.entered(given.faces, linkage, q.datum)
    balancing = given_balancing.entered(given.balancing, q.datum)
    friction = given_friction.entered(given.friction, linkage, faces, q.datum)
    given_motion.entered(given.motion, q.datum)
    rows = declared_loads.rows(given.loads, declared, loads.idle)
    further = {*(row.id for row in rows), *(load.name for load in of_springs)}
    # What a kind sets out by its name is its own load.
    q.lines = {name: tuple(id for id in lines if id not in further) for name, lines in q.lines.items()}
    own["facts"] = {**own.get("facts", {}), "declared": rows, "springs": springs}
    parts = dict(sections or {})
    acts = LoadsByKind.of(of_kind).act
    if parts.get("load") == "cycle" and not acts:
        parts["load"] = "no-gas"
    parts |= {
        "springs": bool(springs),
        "faces": bool(faces),
        "balancing": balancing is not None,
        "friction": friction is not None,
        "curves": not positions.at,
        "motion": given.motion is not None,
        "further": bool(rows) and (acts or parts.get("load") == "no-gas"),
    }
    fields: dict[str, Any] = {
        "count": positions.number,
        "turns": turns,
        "outline": outline(bool(linkage.inertias), loads.act, given.flywheel, **parts),
    }
    if positions.at:
        own |= {"instants": True, "count": positions.number, "places": positions.instants(turns)}
        own["labels"] = tuple(assignment.labels)
    return Machine(
        kind=assignment.kind,
        linkage=linkage,
        start=start,
        turn=positions.sign,
        speed=given.speed,
        acceleration=given.acceleration,
        faces=faces,
        friction=friction,
        sheet=q,
        unevenness=given.unevenness,
        balancing=balancing,
        true_motion=None if given.motion is None else given.motion.asked,
        applied=loads.applied,
        torques=loads.torques,
        idle=loads.idle,
        **(fields | own),
    )
