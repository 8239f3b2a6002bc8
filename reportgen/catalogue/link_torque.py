"""A torque of constant size on a link, as an assignment gives it: always of one sense, or against the link's motion."""

from __future__ import annotations

from typing import Annotated, Literal

from reportgen.assignment.common import Part, Positions
from reportgen.assignment.fields import quantity
from reportgen.catalogue.course import Floats
from reportgen.catalogue.laws import Law
from reportgen.catalogue.machine import Torque
from reportgen.catalogue.resistance import Constant, opposing
from reportgen.mechanism.motion import solve_motion
from reportgen.mechanism.structure import Linkage
from reportgen.units import Given

TorqueSize = Annotated[Given, quantity("N m", least=0, most=1e9)]


class LinkTorque(Part):
    """A torque on a link, of one sense or against its motion."""

    M: TorqueSize
    sense: Literal["opposing", "anticlockwise", "clockwise"] = "opposing"


def acting(
    given: LinkTorque | None, link: int, linkage: Linkage, positions: Positions, start: float
) -> tuple[Torque, ...]:
    """The torque on a link of a crank's linkage whose crank stands at the angle `start` in position 1."""
    if given is None:
        return ()
    size, turn = given.M.si, positions.sign

    def swing(angle: Floats) -> Floats:
        return solve_motion(linkage, start + turn * angle, float(turn)).links[link].omega

    one_sense = Constant(size if given.sense == "anticlockwise" else -size)
    law: Law = opposing(size, swing) if given.sense == "opposing" else one_sense
    return (Torque(f"M{link}", link, law),)
