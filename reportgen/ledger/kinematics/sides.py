"""What each side of a group's vector equation says, from the dyad kind alone.

Every group of class II is solved by writing the motion of one point M in two ways:

* `Turn`: M and a known point P lie on one link: v_M = v_P + v_MP, v_MP ⊥ PM;
  a_M = a_P + aⁿ_MP + aᵗ_MP.
* `Slide`: M slides over a known point G in a known direction d: v_M = v_G + v_MG, v_MG ∥ d;
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

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass

from reportgen.mechanism.structure import DRIVER, GROUND, Crank, Dyad, DyadKind, Guide, Linkage, owners


def image(name: str) -> str:
    """A point's letter on a plan: S2 → s2."""
    return name.lower()


def under(name: str, link: int, taken: Collection[str]) -> str:
    """The name of the point of a link that lies under a pin now: B on link 3 → B3, B′3 where B3 is taken."""
    plain = f"{name}{link}"
    return f"{name}′{link}" if plain in taken else plain


@dataclass(frozen=True, slots=True)
class Turn:
    """`point` moves about `base` on `link`; `still` when the base is fixed to the ground."""

    point: str
    base: str
    link: int
    still: bool
    measured: bool = False
    """Whether their distance changes and is measured on the drawing."""

    @property
    def relative(self) -> str:
        return f"{self.point}{self.base}"

    @property
    def rod(self) -> str:
        return f"{self.base}{self.point}"

    @property
    def shown(self) -> str:
        """The base as vectors name it."""
        return self.base

    @property
    def turns(self) -> bool:
        return True


@dataclass(frozen=True, slots=True)
class Slide:
    """`point` slides over `base` along the direction `along` (an id); `turning` is the link whose turning
    gives the Coriolis acceleration, 0 if nothing turns.

    `shown` names the base in vectors: B2 for the pin B as a point of block 2.  `carrier` is the link that
    has the guide when the base is that link's point under `point`, None when the base is a pin.
    """

    point: str
    base: str
    along: str
    turning: int
    still: bool
    shown: str
    carrier: int | None = None

    @property
    def relative(self) -> str:
        return f"{self.point}{self.base}"

    @property
    def turns(self) -> bool:
        return False

    @property
    def guided(self) -> bool:
        """Whether the base is the guide's own point, not a pin."""
        return self.carrier is not None


Side = Turn | Slide


@dataclass(frozen=True, slots=True)
class Scheme:
    """A linkage seen as links that turn or only shift."""

    linkage: Linkage
    owner: Mapping[str, int]
    spins: Mapping[int, int]
    """For each link the link whose angular velocity it shares: itself if it turns freely, 0 if it never turns."""

    def still(self, name: str) -> bool:
        return self.owner[name] == GROUND


def scheme(linkage: Linkage) -> Scheme:
    """Which links turn, and with which others; raises `ValueError` for two points of one name."""
    spins = {GROUND: 0, DRIVER: DRIVER if isinstance(linkage.driver, Crank) else 0}
    for dyad in linkage.dyads:
        i, j = dyad.links
        first, second = (
            link if isinstance(end, str) else spins[end.link]
            for link, end in zip(dyad.links, (dyad.start, dyad.end), strict=True)
        )
        # A slide between the two links makes them turn with one angular velocity.
        spins |= {i: second if dyad.kind in {"RPR", "RPP"} else first, j: second}
    return Scheme(linkage, owners(linkage), spins)


def sides(plan: Scheme, dyad: Dyad) -> tuple[Side, Side]:
    """The two sides of a group's vector equations."""
    return SIDES[dyad.kind](plan, dyad)


def _turn(plan: Scheme, point: str, base: str | Guide, link: int, measured: bool = False) -> Turn:
    assert isinstance(base, str)
    return Turn(point, base, link, plan.still(base), measured)


def _on_guide(plan: Scheme, point: str, guide: str | Guide, slider: int, *others: str) -> Slide:
    """A point that slides over its guide's link; `others` are names already taken in the group."""
    assert isinstance(guide, Guide)
    base = under(point, guide.link, {*plan.owner, *others})
    turning = plan.spins[guide.link]
    return Slide(point, base, f"guide.{slider}", turning, guide.link == GROUND, base, guide.link)


def _over_pin(plan: Scheme, dyad: Dyad, point: str) -> Slide:
    """The point of link j under the outer pin P slides over P."""
    assert isinstance(dyad.start, str)
    i, j = dyad.links
    pin = dyad.start
    shown = pin if pin[-1].isdigit() else f"{pin}{i}"
    return Slide(point, pin, f"slot.{j}", plan.spins[j], plan.still(pin), shown)


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
    first = _on_guide(plan, dyad.middle, dyad.start, i)
    return first, _on_guide(plan, dyad.middle, dyad.end, j, first.base)


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
