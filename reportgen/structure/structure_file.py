"""Model of the file of a structure exercise: which links each pair joins, and which link drives."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Literal

from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Angle, PointCoordinates, Whole, quantity
from reportgen.base.template_access import template_members
from reportgen.base.units import Given
from reportgen.catalogue.declared_loads import Name
from reportgen.structure.splitting import ChainJoint, KinematicChain

LAST_LINK = 30
MOST_PAIRS, MOST_ON_PIN = 45, 6

JointLink = Annotated[int, Whole(0, LAST_LINK)]
MovingLink = Annotated[int, Whole(1, LAST_LINK)]
LowerPair = Annotated[tuple[JointLink, ...], Field(min_length=2, max_length=MOST_ON_PIN)]
HigherPair = Annotated[tuple[JointLink, ...], Field(min_length=2, max_length=2)]
LowerPairs = Annotated[tuple[LowerPair, ...], Field(min_length=1, max_length=MOST_PAIRS)]
HigherPairs = Annotated[tuple[HigherPair, ...], Field(min_length=1, max_length=MOST_PAIRS)]
MovingLinks = Annotated[tuple[MovingLink, ...], Field(min_length=1, max_length=LAST_LINK)]
PressureAngle = Annotated[Given, quantity("deg", least=5, most=45)]
ProfileCentres = Annotated[tuple[PointCoordinates, ...], Field(min_length=1, max_length=2)]
LETTERS = 60


class PairPoint(Part):
    """The place of a pair in the drawing of the mechanism, by the links that it joins.

    A pair with `slide` is a sliding one: the first link is a block that slides in this direction on the second, or on
    the frame. A higher pair has either `centres`, the centres of curvature of the profiles of its first and its second
    link, which is straight without one, or `teeth`, the pressure angle of two gears in mesh.
    """

    links: LowerPair
    at: PointCoordinates
    slide: Angle | None = None
    centres: ProfileCentres | None = None
    teeth: PressureAngle | None = None


@template_members("driver", "pairs", "higher", "rollers", "passive", "other_drivers")
class Parameters(Part):
    """The pairs of a mechanism by the links that they join; link 0 is the frame.

    A pin that joins more than two links is one entry of `pairs` with all of them. `rollers` turn on their pins without
    effect on the motion, and `passive` links can be removed without effect on it. `points` place the pairs in a
    drawing.
    """

    pairs: LowerPairs
    higher: HigherPairs | None = None
    driver: MovingLink = 1
    rollers: MovingLinks | None = None
    passive: MovingLinks | None = None
    other_drivers: Literal["all"] | None = None
    points: Annotated[dict[Name, PairPoint], Field(min_length=1, max_length=LETTERS)] | None = None

    @property
    def whole_chain(self) -> KinematicChain:
        """The mechanism as given, with its rollers and passive links."""
        lower = (ChainJoint(links) for links in self.pairs)
        return KinematicChain((*lower, *(ChainJoint(links, higher=True) for links in self.higher or ())))

    @property
    def needed_chain(self) -> KinematicChain:
        """The mechanism without passive links, its rollers fixed to the links that carry them."""
        return active(self.whole_chain, self.passive or ()).without(self.rollers or ())


def active(chain: KinematicChain, passive: Iterable[int]) -> KinematicChain:
    """Return the chain without its passive links."""
    removed = {*passive}
    kept = (ChainJoint(tuple(x for x in joint.links if x not in removed), joint.higher) for joint in chain.joints)
    return KinematicChain(tuple(joint for joint in kept if len(joint.links) > 1))
