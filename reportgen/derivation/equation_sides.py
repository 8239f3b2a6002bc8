"""The two sides of a group's vector equation, derived from the dyad kind alone.

Every group of class II is solved with two expressions for the motion of one point M, of which each has one of two
forms:

* M turns about a known point P of its link: v_M = v_P + v_MP, v_MP ⊥ PM;
  a_M = a_P + aⁿ_MP + aᵗ_MP.
* M slides over a known point G in a known direction d: v_M = v_G + v_MG, v_MG ∥ d;
  a_M = a_G + aᵏ_MG + aʳ_MG with aᵏ = 2ω v_MG where the guide turns.

==== ================================= =========================================
kind first side                        second side
==== ================================= =========================================
RRR  Q turns about P on link i         Q turns about T on link j
RRP  Q turns about P on link i         Q slides over the guide's point under it
RPR  P's point of j slides over P      it turns about T on link j
PRP  Q slides over the first guide     Q slides over the second guide
RPP  P's point of j slides over P      it slides over the guide's link
==== ================================= =========================================
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from reportgen.base.records import Record
from reportgen.formula import ids
from reportgen.machine import DRIVER, GROUND, Crank, Dyad, DyadKind, Group, Guide, Linkage, Triad, owners, under


def image(name: str) -> str:
    """Return a point's letter on a plan: S2 → s2."""
    return name.lower()


class Side(Record):
    """One side of a group's vector equation: the motion of a `point` as that of its `base` plus the relative motion.

    Either both are points of `link`, and the point turns about the base; then `along` is empty. Or the point slides
    over the base along the direction with the id `along`; then `link` is 0. `still` is True if the base is fixed to the
    ground; `shown` is the name of the base in the symbols of vectors: B2 for the pin B as a point of block 2.
    """

    point: str
    base: str
    still: bool
    shown: str
    link: int = 0
    measured: bool = False
    """True if the distance of a turning point from its base changes and is measured on the drawing."""
    along: str = ""
    turning: int = 0
    """The link whose rotation gives a sliding point its Coriolis acceleration; 0 if the guide does not rotate."""
    carrier: int | None = None
    """The link that has the guide, if the base is that link's point under `point`; None if the base is a pin."""
    alike: bool = False
    """True if the other side of the group also slides along a guide, so that a guide must be named by its link."""

    @property
    def turns(self) -> bool:
        """True if the point turns about its base, False if it slides."""
        return not self.along

    @property
    def way(self) -> str:
        """Motion of the point relative to its base: it "turns", or slides along a "guide" or a "slot"."""
        return "turns" if self.turns else "guide" if self.guided else "slot"

    @property
    def slide(self) -> int:
        """The link that slides along the guide, or that has the slot; 0 where the point turns."""
        named = ids.guide.read(self.along) or ids.slot.read(self.along) or {"link": "0"}
        return int(named["link"])

    @property
    def state(self) -> str:
        """State of the base: "still" or "moving"."""
        return "still" if self.still else "moving"

    @property
    def guided(self) -> bool:
        """True if the base is the guide's own point, not a pin."""
        return self.carrier is not None

    @property
    def relative(self) -> str:
        """The point and its base as ids name a relative motion: "BA"."""
        return f"{self.point}{self.base}"

    @property
    def pair(self) -> str:
        """The point and its base as the symbols of vectors name them."""
        return f"{self.point}{self.shown}"

    @property
    def rod(self) -> str:
        """Name of the rod with which a turning point turns."""
        return f"{self.base}{self.point}"

    @property
    def part(self) -> str:
        """Letter of the part of the relative acceleration that velocities give, n or k; "" without such a part."""
        return "n" if self.turns else "k" if self.turning else ""

    @property
    def sought(self) -> str:
        """Letter of the unknown part, t or r; "" if the point's own acceleration takes its place."""
        return "t" if self.turns else "r" if self.turning or not self.still else ""

    # --- ids

    @property
    def velocity(self) -> str:
        """Id of the relative velocity."""
        return ids.velocity(self.relative)

    @property
    def known(self) -> str:
        """Id of the segment of the relative acceleration that follows from velocities."""
        return ids.relative_segment(self.part, self.relative)

    @property
    def omega(self) -> str:
        """Id of the angular velocity of the link `turning`."""
        return ids.angular_velocity(self.turning)


class Scheme(Record):
    """A linkage with the link of each point (`owner`), and the links that rotate together (`spins`)."""

    linkage: Linkage
    owner: Mapping[str, int]
    spins: Mapping[int, int]
    """For each link the link whose angular velocity it shares: itself if it turns freely, 0 if it never turns."""

    def still(self, name: str) -> bool:
        """Return True if a point is fixed to the ground."""
        return self.owner[name] == GROUND


def scheme(linkage: Linkage) -> Scheme:
    """Return the scheme of a linkage: the owners of its points and the links that rotate together.

    Raises `ValueError` for two points of one name.
    """
    spins = {GROUND: 0, DRIVER: DRIVER if isinstance(linkage.driver, Crank) else 0}
    for dyad in linkage.groups:
        if isinstance(dyad, Triad):
            spins |= {link: link for link in dyad.links}
            continue
        i, j = dyad.links
        first, second = (
            link if isinstance(end, str) else spins[end.link]
            for link, end in zip(dyad.links, (dyad.start, dyad.end), strict=True)
        )
        # A slide between the two links makes them turn with one angular velocity.
        spins |= {i: second if dyad.kind in {"RPR", "RPP"} else first, j: second}
    return Scheme(linkage, owners(linkage), spins)


def sides(plan: Scheme, dyad: Dyad) -> tuple[Side, Side]:
    """Return the two sides of a group's vector equations."""
    return SIDES[dyad.kind](plan, dyad)


def triad_sides(plan: Scheme, triad: Triad) -> tuple[Side, ...]:
    """Return each link of a triad as one joint that turns about another: the legs in their order, then the plate."""
    first, second, _ = (leg.inner for leg in triad.legs)
    legs = (_turn(plan, leg.inner, leg.outer, leg.link) for leg in triad.legs)
    return *legs, Side(second, first, False, first, triad.plate)


def group_sides(plan: Scheme, group: Group) -> tuple[Side, ...]:
    """Return the sides of the vector equations of a group, for a triad one for each of its links."""
    return triad_sides(plan, group) if isinstance(group, Triad) else sides(plan, group)


def _turn(plan: Scheme, point: str, base: str | Guide, link: int, measured: bool = False) -> Side:
    assert isinstance(base, str)
    return Side(point, base, plan.still(base), base, link, measured)


def _on_guide(plan: Scheme, point: str, guide: str | Guide, slider: int, *others: str, alike: bool = False) -> Side:
    """Return a point that slides over its guide's link; `others` are names already taken in the group."""
    assert isinstance(guide, Guide)
    base = under(point, guide.link, {*plan.owner, *others})
    on = guide.link
    turning = plan.spins[on]
    return Side(point, base, on == GROUND, base, along=ids.guide(slider), turning=turning, carrier=on, alike=alike)


def _over_pin(plan: Scheme, dyad: Dyad, point: str) -> Side:
    """Return the point of link j under the outer pin P slides over P."""
    assert isinstance(dyad.start, str)
    i, j = dyad.links
    pin = dyad.start
    printed = pin if pin[-1].isdigit() else f"{pin}{i}"
    return Side(point, pin, plan.still(pin), printed, along=ids.slot(j), turning=plan.spins[j])


def _rrr(plan: Scheme, dyad: Dyad) -> tuple[Side, Side]:
    i, j = dyad.links
    return _turn(plan, dyad.middle, dyad.start, i), _turn(plan, dyad.middle, dyad.end, j)


def _rrp(plan: Scheme, dyad: Dyad) -> tuple[Side, Side]:
    i, j = dyad.links
    return _turn(plan, dyad.middle, dyad.start, i), _on_guide(plan, dyad.middle, dyad.end, j)


def _rpr(plan: Scheme, dyad: Dyad) -> tuple[Side, Side]:
    j = dyad.links[1]
    return _over_pin(plan, dyad, dyad.middle), _turn(plan, dyad.middle, dyad.end, j, measured=True)


def _prp(plan: Scheme, dyad: Dyad) -> tuple[Side, Side]:
    i, j = dyad.links
    first = _on_guide(plan, dyad.middle, dyad.start, i, alike=True)
    return first, _on_guide(plan, dyad.middle, dyad.end, j, first.base, alike=True)


def _rpp(plan: Scheme, dyad: Dyad) -> tuple[Side, Side]:
    assert isinstance(dyad.start, str)
    j = dyad.links[1]
    point = under(dyad.start, j, plan.owner)
    return _over_pin(plan, dyad, point), _on_guide(plan, point, dyad.end, j)


SIDES: Mapping[DyadKind, Callable[[Scheme, Dyad], tuple[Side, Side]]] = {
    "RRR": _rrr,
    "RRP": _rrp,
    "RPR": _rpr,
    "PRP": _prp,
    "RPP": _rpp,
}
