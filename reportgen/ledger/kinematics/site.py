"""The drawing board: the ledger being written, the linkage, and what is placed so far."""

from __future__ import annotations

import cmath
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from reportgen.ledger.core import Builder
from reportgen.ledger.kinematics.names import image, length_symbol, segment_symbol
from reportgen.ledger.kinematics.sides import Scheme
from reportgen.mechanism.structure import DRIVER, GROUND, Crank, Guide, Linkage
from reportgen.notation.expressions import (
    Expression,
    Negative,
    Number,
    Ref,
    Symbol,
    add,
    call,
    divide,
    multiply,
    negative,
    power,
    subtract,
)
from reportgen.notation.symbols import MAX_DIGITS, on_plan

What = Literal["v", "a"]
KINDS = {"v": "velocity", "a": "acceleration"}
POLES: dict[str, str] = {"v": "p", "a": "π"}
NOWHERE = Number(0.0)
ROTATION = {"v": ("omega", "ω", "angular velocity", 1), "a": ("eps", "ε", "angular acceleration", 2)}


@dataclass(frozen=True, slots=True)
class Sizes:
    """What counts as one of each kind: a billionth of it is nothing."""

    velocity: float
    acceleration: float
    rotation: float

    def of(self, what: What) -> float:
        return self.velocity if what == "v" else self.acceleration


@dataclass(frozen=True, slots=True)
class Body:
    """A link placed: the point its frame starts at, the id of its unit axis, and how its points move.

    With `tip`, a second point, images follow by similarity; else by `spin` and `swing`, its signed angular
    velocity and acceleration, and where these are None it only shifts.
    """

    origin: str
    axis: str
    tip: str = ""
    spin: Expression | None = None
    swing: Expression | None = None


@dataclass
class Site:
    """Builder, linkage and placed links while a linkage is entered link by link."""

    b: Builder
    scheme: Scheme
    turn: int
    sizes: Sizes
    bodies: dict[int, Body] = field(default_factory=dict)

    # --- points and their images

    def image(self, what: What, name: str) -> Expression:
        """A point on a plan: 0, the pole, for one fixed to the ground."""
        if self.scheme.owner.get(name) == GROUND:
            return NOWHERE
        return Ref(f"plan.{what}.{image(name)}")

    def letter(self, what: What, name: str) -> Symbol:
        """A point's letter on a plan, that of the pole for one fixed to the ground."""
        if self.scheme.owner.get(name) == GROUND:
            return Symbol(POLES[what])
        return on_plan(name, what == "a")

    def carried(self, what: What, link: int, arm: Expression) -> Expression:
        """The image of the point of a link that lies at `arm` from the origin of its frame."""
        body = self.bodies[link]
        base = self.image(what, body.origin)
        if link == DRIVER and body.spin is not None:
            drawn = divide(arm, "mu.l")
            return multiply(self.turn, call("turned", drawn)) if what == "v" else negative(drawn)
        if body.tip:
            ratio = divide(arm, subtract(f"p.{body.tip}", f"p.{body.origin}"))
            return add(base, multiply(ratio, subtract(self.image(what, body.tip), base)))
        if body.spin is None:
            return add(base)
        if what == "v":
            return add(base, divide(multiply(call("turned", arm), body.spin), "mu.v"))
        inward = negative(multiply(arm, power(body.spin, 2)))
        if body.swing is not None:
            inward = add(multiply(call("turned", arm), body.swing), inward)
        return add(base, divide(inward, "mu.a"))

    # --- sizes on paper

    def paper(self, what: What) -> float:
        """The size of a plan on paper (m)."""
        return self.sizes.of(what) / float(self.b.value(f"mu.{what}")[0])

    def span(self) -> float:
        """The size of the mechanism as it is drawn (m)."""
        return longest(self.scheme.linkage) / float(self.b.value("mu.l")[0])

    def segment(self, id: str, first: Symbol | str, second: Symbol | str, along: Expression, what: What) -> str:
        """A segment measured on a plan."""
        return self.b.define(
            id, segment_symbol(first, second), "segment", call("abs", along), scale=self.paper(what)
        )

    def plane(self, id: str, value: complex) -> str:
        """A constant point or direction as a quantity, entered once."""
        if id not in self.b:
            self.b.give(id, Symbol(id), "ratio", complex(value))
        return id

    def length(self, start: str, end: str, value: float) -> str:
        """The id of a link's length, entered as given unless the machine has done so."""
        id = f"l.{start}{end}"
        if id not in self.b:
            short = abs(float(f"{value:.{MAX_DIGITS - 1}g}") - value) <= 1e-12 * abs(value)
            self.b.give(id, Symbol("l", f"{start}{end}"), "length", value, exact=short)
        return id

    def drawn(self, start: str, end: str) -> str:
        """A length as it is drawn."""
        return self.b.define(
            f"drawn.{start}{end}", length_symbol(start, end), "segment", divide(f"l.{start}{end}", "mu.l")
        )

    # --- links

    def omega(self, link: int) -> str:
        """The id of a link's angular velocity, "" for one that never turns."""
        id = f"omega.{link}"
        return id if self.scheme.spins[link] and id in self.b else ""

    def axis(self, link: int) -> Expression:
        """The unit vector along the real axis of a link's frame."""
        return Number(1.0) if link == GROUND else Ref(self.bodies[link].axis)

    def guide(self, slider: int, guide: Guide) -> tuple[str, str]:
        """The ids of a guide's point and direction, carried along by its link."""
        at, along = f"guide.{slider}.at", f"guide.{slider}"
        if guide.link == GROUND:
            return self.plane(at, guide.at), self.plane(along, cmath.exp(1j * guide.angle))
        axis = self.axis(guide.link)
        place = self.plane(f"{at}.local", guide.at)
        turned = self.plane(f"{along}.local", cmath.exp(1j * guide.angle))
        self.b.construct(at, add(f"p.{self.bodies[guide.link].origin}", multiply(place, axis)))
        self.b.construct(along, multiply(turned, axis))
        return at, along

    def share_rotation(self, what: What, link: int) -> None:
        """Enter ω or ε of a link that turns with another one as that of the other."""
        other = self.scheme.spins[link]
        id, symbol, kind, order = ROTATION[what]
        if other == link or f"{id}.{other}" not in self.b:
            return
        size = self.sizes.rotation**order
        print_as = Symbol(symbol, str(link))
        signed = self.spin(other) if what == "v" else Ref(f"turn.{id}.{other}")
        self.b.define(f"{id}.{link}", print_as, kind, f"{id}.{other}", scale=size)
        self.b.define(f"turn.{id}.{link}", print_as, kind, signed, scale=size)

    def spin(self, link: int) -> Expression:
        """The signed angular velocity of a link that turns."""
        if link == DRIVER:
            return Ref("omega.1") if self.turn > 0 else Negative(Ref("omega.1"))
        return Ref(f"turn.omega.{link}")

    def body(self, link: int, origin: str, axis: str, tip: str = "") -> None:
        """Place a link; how its points move follows from what it turns with."""
        source = self.scheme.spins[link]
        self.bodies[link] = Body(
            origin,
            axis,
            tip,
            self.spin(link) if source else None,
            Ref(f"turn.eps.{link}") if source not in (0, DRIVER) else None,
        )


def longest(linkage: Linkage) -> float:
    """The longest length of a linkage (m): of a rod, or between fixed points."""
    fixed = list(linkage.ground.values())
    spans = [abs(p - q) for p in fixed for q in fixed]
    rods = [length for dyad in linkage.dyads for length in dyad.lengths]
    return max((*rods, *spans, *(abs(place.local) for place in linkage.points)), default=0.0) or 1.0


def sizes(b: Builder, linkage: Linkage) -> Sizes:
    """Velocity, acceleration and rotation that are natural to a linkage: those of its driver's pin."""
    driver = linkage.driver
    if isinstance(driver, Crank):
        omega = float(b.value("omega.1")[0])
        return Sizes(omega * driver.length, omega**2 * driver.length, omega)
    speed, size = float(np.abs(b.value(f"v.{driver.pin}")).max()), longest(linkage)
    return Sizes(speed, speed**2 / size, speed / size)
