"""Straight links between two pins, with a mass centre and a mass if they are given one.

A kind's parameters give for link k its weight Gk or mass mk, the place sk of its mass centre as a share of
its length from its first pin, and its moment of inertia Jk about the centre (default m l²/12).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from reportgen.assignment import checks
from reportgen.assignment.common import Check, Part
from reportgen.catalogue.machine import Item, mass_items
from reportgen.mechanism.structure import Inertia, LinkPoint
from reportgen.notation.expressions import Symbol, divide, multiply, power
from reportgen.units import Given

MIDDLE = 0.5
"""Where the mass centre of a uniform bar lies."""


@dataclass(frozen=True, slots=True)
class Bar:
    """Link `link` from pin `start` to pin `end`, `length` (m) apart; `seen` if its centre is always a point."""

    link: int
    start: str
    end: str
    length: float
    share: Given | None
    weight: Given | None
    mass: Given | None
    moment: Given | None
    seen: bool

    @property
    def centre(self) -> str:
        """The name of its mass centre."""
        return f"S{self.link}"

    @property
    def place(self) -> float:
        """The centre's distance from `start` over the length."""
        return MIDDLE if self.share is None else self.share.si

    @property
    def arm(self) -> str:
        return f"l.{self.start}{self.centre}"

    def has_centre(self) -> bool:
        return self.seen or any((self.share, self.weight, self.mass, self.moment))

    def point(self) -> tuple[LinkPoint, ...]:
        """Its mass centre as a point of the link; none if nothing needs it."""
        return (LinkPoint(self.centre, self.link, complex(self.place * self.length)),) if self.has_centre() else ()

    def inertia(self, g: float) -> tuple[Inertia, ...]:
        """Its inertia; none of a link without mass."""
        mass = self.weight.si / g if self.weight is not None else self.mass.si if self.mass is not None else 0.0
        moment = mass * self.length**2 / 12 if self.moment is None else self.moment.si
        return (Inertia(self.link, self.centre, mass, moment),) if mass or moment else ()

    def items(self) -> tuple[Item, ...]:
        """s, l_AS = s·l, weight and mass, J as given or m l²/12."""
        if not self.has_centre():
            return ()
        number = str(self.link)
        share, length = f"s.{number}", f"l.{self.start}{self.end}"
        along = Symbol("l", f"{self.start}{self.centre}")
        items = [
            Item(share, Symbol("s", number), "ratio", self.place),
            Item(self.arm, along, "length", definition=multiply(share, length)),
            *mass_items(self.link, self.weight, self.mass),
        ]
        symbol = Symbol("J", self.centre)
        if self.moment is not None:
            items.append(Item(f"J.{number}", symbol, "moment of inertia", self.moment.si))
        elif self.weight is not None or self.mass is not None:
            uniform = divide(multiply(f"m.{number}", power(length, 2)), 12)
            items.append(Item(f"J.{number}", symbol, "moment of inertia", definition=uniform))
        return tuple(items)


def bar(given: Part, link: int, start: str, end: str, length: float, seen: bool = False) -> Bar:
    """A link as the parameters s, G, m, J with its number say."""
    share, weight, mass, moment = (getattr(given, f"{name}{link}") for name in ("s", "G", "m", "J"))
    return Bar(link, start, end, length, share, weight, mass, moment, seen)


def one_mass(links: Iterable[int]) -> tuple[Check, ...]:
    """Of each link either its weight or its mass is given."""
    return tuple(checks.one_of("parameters", f"G{link}", f"m{link}", required=False) for link in links)
