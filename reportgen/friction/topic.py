"""The friction section of a machine's file: the pins with their friction circles, the sliders with their f."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Annotated

from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Interval, Ratio, quantity
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.catalogue.declared_loads import MOST_LOADS, Link, Name, listed
from reportgen.catalogue.topic_sections import Opening, TopicData, TopicParameters, TopicSection, sections_of
from reportgen.formula import ids
from reportgen.friction import friction_ids
from reportgen.friction.friction_torque import LocksError, friction_loss
from reportgen.friction.joints import Friction, with_friction
from reportgen.machine import joints
from reportgen.machine.analysis import Machine, analyse
from reportgen.machine.shared_results import FACES, LOST_TORQUE
from reportgen.machine.slider_faces import Faces

Coefficient = Annotated[Given, Ratio(Interval(least=0, most=2, tiny=1e-6))]
Radius = Annotated[Given, quantity("mm", least=0, below=1e4, tiny=1e-6)]


class PinFriction(Part):
    """A pin with its coefficient of friction and its radius, or with the radius of its friction circle."""

    f: Coefficient | None = None
    r: Radius | None = None
    rho: Radius | None = None

    @property
    def circle(self) -> float:
        """ρ = f r (m)."""
        if self.rho is not None:
            return self.rho.si
        return 0.0 if self.f is None or self.r is None else self.f.si * self.r.si


class JointFriction(Part):
    """The joints that have friction: pins by their points, sliders by their links."""

    pins: Annotated[dict[Name, PinFriction], Field(max_length=MOST_LOADS)] = Field(default_factory=dict)
    sliders: Annotated[dict[Link, Coefficient], Field(max_length=MOST_LOADS)] = Field(default_factory=dict)


def faults(parameters: TopicParameters, machine: Machine) -> Iterator[Finding]:
    """Yield faults unless joints belong to the linkage, each pin has its circle or both f and its radius, and there are
    loads.
    """
    given = parameters.section("friction", JointFriction)
    if given is None:
        return
    linkage, at = machine.linkage, ("parameters", "friction")
    if not (linkage.inertias or machine.loads):
        yield Finding("friction-without-loads", at, at="key")
    pins = {joint.point for joint in joints(linkage) if joint.kind == "R"}
    for name, pin in given.pins.items():
        where = (*at, "pins", name)
        if name not in pins:
            yield Finding("no-such-joint", where, {"text": name, "known": ", ".join(sorted(pins)) or "–"}, at="key")
        alone = [key for key in ("f", "r") if getattr(pin, key) is not None]
        if pin.rho is not None and alone:
            yield Finding("both-given", (*where, alone[0]), {"first": "rho", "second": alone[0]}, at="key")
        elif pin.rho is None and len(alone) < 2:
            yield Finding("missing-key", where, {"key": "rho" if not alone else "f" if alone == ["r"] else "r"})
    sliders = {joint.links[1] for joint in joints(linkage) if joint.kind == "P"}
    for link in given.sliders:
        if link not in sliders:
            words = {"text": str(link), "known": listed(sliders) or "–"}
            yield Finding("no-slider", (*at, "sliders", str(link)), words, at="key")


def enter(opening: Opening) -> TopicData:
    """Enter the data of the joints with friction; faulty ones, which the file's checks report, are left out."""
    given = opening.given.section("friction", JointFriction)
    assert given is not None, "the file asks for friction"
    linkage, datum = opening.linkage, opening.datum
    friction = Friction(
        {name: pin.circle for name, pin in given.pins.items() if pin.circle > 0},
        {link: f.si for link, f in given.sliders.items() if f.si > 0},
        _faces(opening),
    )
    rubbing = friction.joints(linkage)
    for name in dict.fromkeys(joint.point for joint in rubbing if joint.kind == "R"):
        pin = given.pins[name]
        for id, value in (
            (friction_ids.coefficient(name), pin.f),
            (friction_ids.pin_radius(name), pin.r),
            (friction_ids.circle(name), pin.rho),
        ):
            if value is not None:
                datum(id, value, "", "")
    for link in dict.fromkeys(joint.links[1] for joint in rubbing if joint.kind == "P"):
        datum(friction_ids.coefficient_of_slider(link), given.sliders[link], "", "")
    return TopicData(friction if rubbing else None)


def failures(machine: Machine, worked: Sequence[int]) -> Iterator[Finding]:
    """Report a joint in which the mechanism locks.

    Only the worked positions are examined, or the whole cycle if another topic uses the torque with friction.
    """
    solved = with_friction(analyse(machine))
    for name, held in solved.held.items():
        for k in worked:
            if held[k - 1]:
                first, second = ids.links_of(name)
                words = {"first": str(first), "second": str(second), "position": str(machine.position(k))}
                yield Finding("locks", ("parameters", "friction"), words, at="key")
                return
    if not any(LOST_TORQUE in section.uses for section in sections_of(machine.topics)):
        return
    try:
        friction_loss(machine)
    except LocksError as error:
        words = {"angle": f"{math.degrees(error.angle):.1f}"}
        yield Finding("locks-in-cycle", ("parameters", "friction"), words, at="key")


def _faces(opening: Opening) -> dict[int, Faces]:
    """Return the faces of wide sliders, which an earlier topic has entered; {} if all sliders are narrow."""
    faces = opening.provided.get(FACES.name, {})
    assert isinstance(faces, dict), "faces are by their links"
    return faces


HOOKS = TopicSection(
    annotation=JointFriction | None,
    order=30,
    chapter="friction",
    uses=(FACES,),
    enter=enter,
    faults=faults,
    failures=failures,
    not_in_short=frozenset(("friction-plans",)),
)
