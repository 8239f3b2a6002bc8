"""`GivenData`, the calculation with which a machine starts: given data as typed, data of its links, and terms of its
crank.

ω₁ is the size of the crank's angular velocity, ε₁ that of its acceleration, which is 0 unless it is given.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from reportgen.assignment.common import Positions
from reportgen.base.units import Given
from reportgen.catalogue.parameters import Driven, FixedPoint
from reportgen.catalogue.topic_sections import TopicParameters, sections_of
from reportgen.catalogue.typed_quantities import as_typed, size_of
from reportgen.formula import (
    NOTHING,
    PI,
    Expression,
    Number,
    Operand,
    Ref,
    Symbol,
    acos,
    cis,
    ids,
    signed,
    sqrt,
    turned,
    vocabulary,
)
from reportgen.formula.calculation import Calculation
from reportgen.formula.vocabulary import KINDS, drawn_length
from reportgen.machine import DRIVER, Inertia, LinkPoint
from reportgen.machine.load_laws import FULL_TURN

CRANK_DRAWN = 0.04
"""Default of the drawn length of the crank (m on paper)."""
MIDDLE = 0.5
"""Place of the mass centre of a uniform bar, as a share of its length."""
FLAT = 0.01
"""A point this share of its distance beside the rod makes a triangle too flat to be drawn from its sides."""


MOST_FIGURES = 6
"""A number with more significant figures was not typed but converted."""


def _figures(value: float) -> int:
    """Return the significant figures of a number, without the last bits of floats."""
    return len(f"{abs(value):.11e}".partition("e")[0].replace(".", "").rstrip("0"))


class GivenData(Calculation):
    """The calculation that a machine starts: its given data as typed, and the data of its links in the file."""

    def __init__(self, given: Driven | None = None) -> None:
        super().__init__()
        self.given = given

    def datum(self, id: str, given: Given, symbol: Symbol | str = "", kind: str = "", from_part: str = "") -> Ref:
        """Enter a quantity as typed; a ratio `1/3.6` is evaluated in the report.

        If the conversion gives more figures than anyone types (6 lb = 2.72155422 kg), the value is rounded like a
        result. A quantity that a part of the coursework gives, for the key `from_part`, follows the part's own value.
        """
        if from_part:
            symbol, kind = symbol or vocabulary.symbol(id), kind or vocabulary.row(id).kind
            of_part = self.give(ids.of_part(id), given.si, symbol, kind, hidden=True)
            return self.define(id, of_part, symbol, kind, from_part=from_part)
        top, slash, bottom = given.text.partition("/")
        if slash and not given.unit:
            return self.define(id, Number(float(top)) / float(bottom), symbol, kind)
        self.typed[id] = as_typed(given)
        scale = KINDS[kind or vocabulary.row(id).kind].scale
        typed = max(_figures(given.value), MOST_FIGURES)
        return self.give(id, given.si, symbol, kind, converted=_figures(given.si / scale) > typed)

    def speed(
        self,
        n: Given | None = None,
        omega1: Given | None = None,
        epsilon1: Given | None = None,
        topics: TopicParameters | None = None,
    ) -> None:
        """Enter ω₁ (its size) as given, or ω₁ = 2πn/60 from the speed in rpm; ε₁ (its size); data added by topics.

        The kind's checks refuse a file with neither.
        """
        if self.given is not None:
            n, omega1, epsilon1 = self.given.n, self.given.omega1, self.given.epsilon1
            topics = self.given
        if n is not None:
            rpm = n.value if n.unit == "rpm" else n.si * 30 / np.pi
            self.define("omega.1", 2 * PI * self.give("n", rpm) / 60)
        elif omega1 is not None:
            self.give("omega.1", omega1.si)
        if epsilon1 is not None and epsilon1.si:
            self.datum(ids.angular_acceleration(DRIVER), size_of(epsilon1))
        if topics is not None:
            for section in sections_of(topics.asked()):
                section.enter_speed(topics, self.datum)

    def drawn(self, start: str, end: str, asked: Given | None, default: float = CRANK_DRAWN) -> None:
        """Enter the crank's drawn length: as requested, else `default` (m on paper)."""
        self.give(ids.drawn(start, end), asked.si if asked else default, drawn_length(start, end))

    def drawn_by(self, scale: float, start: str, end: str, crank: Ref) -> None:
        """Enter the crank's drawn length (mm) by a round scale (m per mm) of the drawing."""
        μ = self.give("scale", scale, Symbol("μ", "l"), "length scale")
        self.define(ids.drawn(start, end), crank / μ, drawn_length(start, end))

    # --- links

    def of_link(self, letter: str, link: int) -> Given | None:
        """Return the value that the file gives for a link, its `G`, `m`, `J` or `s`; else None."""
        given: Given | None = getattr(self.given, f"{letter}{link}", None)
        return given

    def centre_of(self, link: int) -> tuple[Given, ...] | None:
        """Return the two coordinates `S` of a link's mass centre if the file gives them; else None."""
        given: tuple[Given, ...] | None = getattr(self.given, f"S{link}", None)
        return given

    def gravity(self, letters: str = "Gm") -> None:
        """Enter g if one of these letters is given for any link; not in a horizontal plane."""
        assert self.given is not None, "a sheet without parameters has no links"
        entered = (self.of_link(letter, link) for letter in letters for link in self.given.links[letter])
        if self.given.gravity and any(entered):
            self.datum("g", self.given.g)

    def mass(self, link: int, weight: Given | None = None, mass: Given | None = None, like: int = 0) -> None:
        """Enter weight and mass of a link: one as typed, or equal to that of the link `like`, and the other computed
        from it.

        Nothing is entered if neither is given.  Without gravity there is no weight.
        """
        weight, mass = weight or self.of_link("G", link), mass or self.of_link("m", link)
        G, m = ids.weight(link), ids.mass(link)
        if m in self:
            return
        if "g" not in self:
            if mass is not None:
                self.datum(m, mass)
            elif like:
                self.define(m, self[ids.mass(like)])
        elif weight is not None:
            self.define(m, self.datum(G, weight) / self["g"])
        elif mass is not None:
            self.define(G, self.datum(m, mass) * self["g"])
        elif like and self.families[ids.weight(like)].definition is None:
            self.define(m, self.define(G, self[ids.weight(like)]) / self["g"])
        elif like:
            self.define(G, self.define(m, self[ids.mass(like)]) * self["g"])

    def moment(self, link: int, default: Operand | None) -> None:
        """Enter J about the mass centre: as given, else its `default`, such as m l²/12; nothing without a default."""
        given = self.of_link("J", link)
        if given is not None:
            self.datum(ids.inertia(link), given)
        elif default is not None:
            self.define(ids.inertia(link), default)

    def bar(self, link: int, start: str, end: str, always: bool = False, rod: bool = True) -> None:
        """Enter a straight link from pin `start` to pin `end`: the place of its mass centre l_AS = s·l, its mass, its
        J.

        A centre `S` given by coordinates may lie beside the link; its distance from `end` is entered on a `rod`.
        The centre of a massless link is entered only if its place is given, or `always`.
        """
        self.set_out("places")
        if not (always or self.centre_of(link) or any(self.of_link(letter, link) for letter in "sGmJ")):
            return
        length, share = self[ids.length(start, end)], self.of_link("s", link)
        if not self.centre_beside(link, start, end if rod and link != DRIVER else ""):
            s = self.give(ids.mass_centre(link), MIDDLE if share is None else share.si, kind="ratio")
            self.set_out("places", self.define(ids.length(start, f"S{link}"), s * length))
        self.mass(link)
        m = self.find(ids.mass(link))
        self.moment(link, None if m is None else m * length**2 / 12)

    def centre_beside(self, link: int, start: str, end: str, lines: str = "places") -> bool:
        """Enter the mass centre of a link with pins `start` and `end` by its coordinates `S`, and its distances.

        The distances are set out as `lines`; without an `end` there is only the first.  Returns False if the file does
        not give these coordinates.
        """
        if (place := self.centre_of(link)) is None:
            return False
        name = f"S{link}"
        for id, size in zip((ids.along_link, ids.across_link), place, strict=True):
            self.datum(id(name), size)
        self.point_of_link(name, start, end, lines)
        return True

    def point_of_link(self, name: str, start: str, end: str, lines: str = "places") -> None:
        """Enter l_AP² = x² + y² of a point P of the rod AB given by x along it and y across it; off the rod also
        l_BP² = (l − x)² + y².

        Without an `end` the link is no rod, and only the first distance is entered.
        """
        x, y = self[ids.along_link(name)], self[ids.across_link(name)]
        reach = self.define(ids.length(start, name), sqrt(x**2 + y**2) if self.si(y) else abs(x))
        self.set_out(lines, reach)
        if not end or not self.si(y):
            return
        rod = self[ids.length(start, end)]
        rest = self.define(ids.length(end, name), sqrt((rod - x) ** 2 + y**2))
        self.set_out(lines, rest)
        if abs(self.si(y)) > FLAT * self.si(reach):
            # It is drawn as the triangle of these sides.
            angle = cis(acos((reach**2 + rod**2 - rest**2) / (2 * reach * rod)))
            self.construct(ids.point_turn(name), angle if self.si(y) > 0 else 1 / angle)

    def point(self, name: str, place: FixedPoint) -> None:
        """Enter the coordinates of a fixed point as typed."""
        x = self.datum(ids.coordinate(name, "x"), place.x, Symbol("x", name), "length")
        y = self.datum(ids.coordinate(name, "y"), place.y, Symbol("y", name), "length")
        self.construct(ids.place(name), x + turned(y))

    def coordinates(self, name: str) -> tuple[Expression, Expression]:
        """Return the coordinates of a fixed point; `NOTHING` for one that is 0 or not entered."""
        x, y = (self.find(ids.coordinate(name, axis)) or self.find(ids.frame_coordinate(axis, name)) for axis in "xy")
        return x if x and self.si(x) else NOTHING, y if y and self.si(y) else NOTHING

    def fix(self, id: str, at: complex, length: Operand) -> None:
        """Enter a fixed point or a guide's point `at` (m) so that its distance follows changes of `length`."""
        far = self.construct(ids.far(id), length)
        if self.si(far):
            self.construct(id, far * self.give(ids.unit(id), complex(at / self.si(far)), Symbol(id), "ratio"))

    def bodies(self, bars: Mapping[int, tuple[str, str]], slider: int, always: bool = False) -> None:
        """Enter gravity if anything has mass; the bars by the pins at their ends, as `bar` does; the slider's mass."""
        self.gravity("GmJ")
        for link, (start, end) in bars.items():
            self.bar(link, start, end, always)
        self.mass(slider)

    def centre_points(self, pins: Mapping[int, str]) -> tuple[LinkPoint, ...]:
        """Return the entered mass centres S2, … by their links and the pins from which they are measured."""
        arms = {link: self.find(ids.length(pin, f"S{link}")) for link, pin in pins.items()}
        return tuple(LinkPoint(f"S{link}", link, self._centre(link, arm)) for link, arm in arms.items() if arm)

    def _centre(self, link: int, arm: Ref) -> complex:
        """Return the place of a mass centre in its link's frame (m), at the distance `arm` if it lies on the link."""
        x, y = (self.find(id(f"S{link}")) for id in (ids.along_link, ids.across_link))
        return complex(self.si(x), self.si(y)) if x and y else complex(self.si(arm))

    def inertias(self, centres: Mapping[int, str]) -> tuple[Inertia, ...]:
        """Return the links with a mass or a moment of inertia, by their mass centres."""

        def size(id: str) -> float:
            return self.si(id) if id in self else 0.0

        every = (
            Inertia(link, centre, size(ids.mass(link)), size(ids.inertia(link))) for link, centre in centres.items()
        )
        return tuple(one for one in every if one.mass or one.moment)


def cycle_angles(positions: Positions, turns: int = 1, places: Sequence[float] = ()) -> np.ndarray:
    """Return the cycle angles (rad) of evenly spaced positions [count·turns], or of the instants [N].

    The angles of unevenly spaced `places` of a turn are the same in each turn.
    """
    if positions.at:
        return np.array(positions.instants(turns))
    if places:
        return np.tile(places, turns)
    return np.arange(positions.count * turns) * (FULL_TURN / positions.count)


def natural_sizes(r: float, ω: float) -> dict[str, float]:
    """Return a reference size (SI) for each kind of quantity, for a crank of the length r (m) at ω (rad/s)."""
    return {
        "length": r,
        "velocity": ω * r,
        "acceleration": ω**2 * r,
        "angular velocity": ω,
        "angular acceleration": ω**2,
    }


def natural_lines(q: Calculation, crank: str) -> Callable[..., Ref]:
    """Return `q.define` with a scale by the kind of the quantity: the natural size for the crank of this id."""
    sizes = natural_sizes(q.si(crank), q.si("omega.1"))

    def define(id: str, definition: Operand, symbol: Symbol | str = "", kind: str = "") -> Ref:
        return q.define(id, definition, symbol, kind, scale=sizes.get(kind or vocabulary.row(id).kind, 0.0))

    return define


def driver_acceleration(q: Calculation, turn: int) -> Expression:
    """Return ε₁ as a term of formulas, positive in the sense of ω₁ (`turn`); `NOTHING` for a constant speed."""
    ε1 = q.find(ids.angular_acceleration(DRIVER))
    return NOTHING if ε1 is None else signed(turn * q.si(ids.signed("eps", DRIVER)), ε1)


def accelerating(accelerates: float) -> Expression:
    """Return ε₁ as a term of an equation, positive in the sense of ω₁; `NOTHING` for an acceleration of 0 (any
    unit).
    """
    return signed(accelerates, Symbol("ε", str(DRIVER))) if accelerates else NOTHING


def accelerated(q: Calculation, turn: int, at_constant_speed: Expression, rate: Expression) -> Expression:
    """Return a second derivative of a function of the crank's angle φ: q̈ = q″ω₁² + q′ε₁, with q′ = q̇/ω₁."""
    ε1 = driver_acceleration(q, turn)
    return at_constant_speed if ε1 is NOTHING else at_constant_speed + ε1 * rate / q["omega.1"]
