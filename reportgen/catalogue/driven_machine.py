"""Build the machine of an assignment whose crank is driven, and the outline of its report."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import Any

from reportgen.assignment.common import Assignment
from reportgen.base.records import Record, replace
from reportgen.catalogue import declared_loads
from reportgen.catalogue.given_data import GivenData
from reportgen.catalogue.topic_sections import Opening, chapters, entered
from reportgen.formula import Chain
from reportgen.formula.calculation import Calculation
from reportgen.machine import DRIVER, Crank, Linkage
from reportgen.machine.analysis import ClosedFormulas, Machine, no_formulas
from reportgen.machine.loads import LoadsByKind, crank_motion

OPENING = ("contents", "given", "scheme", "overview", "foreword", "symbols", "structure", "motion")
CLOSING = ("conclusion", "references", "checks")


class KindSections(Record):
    """Template sections of a report that differ from kind to kind.

    `sizes` and `load` explain the lengths and loads; `summary` follows the accelerations, `course` the kinematic
    diagrams; `driver` is the balance of the driver.
    """

    sizes: str = "dimensions"
    load: str = "working"
    summary: tuple[str, ...] = ()
    course: tuple[str, ...] = ()
    driver: str = "crank"


USUAL = KindSections()
"""The sections of most kinds."""


def outline(
    masses: bool,
    loads: bool,
    topics: Collection[str],
    *,
    curves: bool = True,
    further: bool = False,
    words: KindSections = USUAL,
) -> tuple[str, ...]:
    """Return the report's sections in order; without mass and load it ends with the kinematics.

    Without `curves` it has no kinematic diagrams.  `further` is True if there are loads besides those of the kind.  The
    chapters of `topics` are placed as their `TopicSection`s say.
    """
    diagrams = ("diagrams", *words.course) if curves else ()
    kinematics = (*OPENING, words.sizes, "positions", "velocity", "acceleration", *words.summary, *diagrams)
    if not (masses or loads):
        return (*kinematics, *CLOSING)
    beside = (*(("further-loads",) if further else ()), *chapters(topics, "loads"))
    inertia = ("loads",) if masses else ()
    behind = chapters(topics, "driver")
    return (
        *(*kinematics, words.load, *beside, *inertia, "groups"),
        *(*chapters(topics, "groups"), words.driver, *behind, *CLOSING),
    )


def with_crank(q: GivenData, linkage: Linkage) -> Linkage:
    """Return the linkage with the body of its crank, if the file gives one and the kind does not place it."""
    driver, given = linkage.driver, q.given
    centre = f"S{DRIVER}"
    placed = any(point.name == centre for point in linkage.points)
    assert given is not None, "a sheet without parameters has no links"
    if placed or not isinstance(driver, Crank) or not any(q.of_link(letter, DRIVER) for letter in "GmJsS"):
        return linkage
    share = q.of_link("s", DRIVER)
    weightless = not any(q.of_link(letter, DRIVER) for letter in "Gm")
    beside = q.centre_of(DRIVER)
    known = None if share is None else share.si
    if beside is not None:
        known = max(abs(size.si) for size in beside)
    if (given.crank_on_axis or weightless) if known is None else known == 0:
        # A body on its own axis is not a rod: its moment of inertia is given, or it has none.
        q.mass(DRIVER)
        q.moment(DRIVER, None)
        centre = next(
            (body.centre for body in linkage.inertias if body.link == DRIVER and known is None), driver.centre
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
    q: GivenData,
    linkage: Linkage,
    start: float,
    sections: KindSections | None = None,
    *,
    formulas: Callable[[Calculation], None] = no_formulas,
    compared: tuple[tuple[str, str], ...] = (),
    equations: Mapping[str, tuple[Chain, ...]] | None = None,
    **own: Any,
) -> Machine:
    """Return the machine of an assignment whose crank is at the angle `start` (rad) in position 1.

    `sections` are passed to `outline`; `formulas`, `compared` and `equations` are its `ClosedFormulas`; all other
    fields of its `Machine` are given by name.  Loads that are always zero are left out.
    """
    given, positions = assignment.parameters, assignment.positions
    q.set_out("places")
    linkage = with_crank(q, linkage)
    of_kind = (*own.pop("applied", ()), *own.pop("torques", ()))
    turns = own.get("turns", assignment.turns)
    motion_at = crank_motion(linkage, positions, start)
    declared = declared_loads.loads(given.loads, linkage, motion_at, of_kind, through=not positions.at)
    topics = entered(Opening(given, linkage, q.datum, (*of_kind, *declared), motion_at))
    loads = LoadsByKind.of((*of_kind, *declared, *topics.loads))
    rows = declared_loads.rows(given.loads, declared, loads.idle)
    further = {*(row.id for row in rows), *(load.name for load in topics.loads)}
    # Loads that a kind sets out by name are its own.
    q.lines = {name: tuple(id for id in lines if id not in further) for name, lines in q.lines.items()}
    own["facts"] = {**own.get("facts", {}), "declared": rows}
    words = sections or USUAL
    acts = LoadsByKind.of(of_kind).act
    if words.load == "cycle" and not acts:
        words = replace(words, load="no-gas")
    beside = bool(rows) and (acts or words.load == "no-gas")
    outlined = partial(outline, curves=not positions.at, further=beside, words=words)
    fields: dict[str, Any] = {
        "count": positions.number,
        "turns": turns,
        "outline": outlined(bool(linkage.inertias), loads.act, topics.subjects),
        "outlined": outlined,
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
        calculation=q,
        closed_formulas=ClosedFormulas(formulas, compared, equations or {}),
        topics=topics.subjects,
        beside=tuple(load.name for load in topics.loads),
        applied=loads.applied,
        torques=loads.torques,
        idle=loads.idle,
        **(fields | own),
    )
