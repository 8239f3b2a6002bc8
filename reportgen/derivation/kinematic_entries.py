"""Kinematics of a linkage during entry: the calculation and every link placed so far, beginning with the driver.

The driver is a crank with ω₁, ε₁ or a slide with v, a; it fixes the scales of the plans.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from reportgen.base.records import Record
from reportgen.base.units import nice_up
from reportgen.derivation.equation_sides import Scheme, Side, group_sides, image
from reportgen.derivation.plan_scales import LEAST_MOTION, PER_MM, SHEET_BOXES, common_scale, drawable, extents
from reportgen.formula import (
    Expression,
    Number,
    Ref,
    Symbol,
    arg,
    call,
    cis,
    cos,
    heading,
    ids,
    meet,
    quotient,
    sign,
    sqrt,
    turned,
    unit,
)
from reportgen.formula.calculation import TYPED, Calculation, is_short
from reportgen.formula.vocabulary import drawn_length, on_plan, point, segment
from reportgen.machine import DRIVER, GROUND, Crank, Guide, Linkage, SlidingDriver

What = Literal["v", "a"]
POLES: dict[str, str] = {"v": "p", "a": "π"}
NOWHERE = Number(0.0)
ROTATION = {"v": ("omega", 1), "a": ("eps", 2)}
"""Name of a link's rotation in ids, and the power of 1/s in its unit."""


class Sizes(Record):
    """Reference sizes (m/s, m/s², rad/s): values below a billionth of them count as zero."""

    velocity: float
    acceleration: float
    rotation: float

    def of(self, what: What) -> float:
        """Return the reference size (SI) of velocities or accelerations."""
        return self.velocity if what == "v" else self.acceleration


class PlacedLink(Record):
    """A placed link: the point at the origin of its frame, its unit axis, and the data of its points' motion.

    With a second point `tip`, images follow by similarity; else by `omega` and `eps`, its signed angular
    velocity and acceleration; a link without them only translates.
    """

    origin: str
    axis: Ref | None
    tip: str = ""
    omega: Expression | None = None
    eps: Expression | None = None


@dataclass
class Kinematics:
    """Calculation `q`, linkage and placed links while a linkage is entered link by link.

    `turn` is +1 for a crank that turns anticlockwise or a slide that moves along its guide's direction, else −1.
    """

    q: Calculation
    scheme: Scheme
    turn: int
    sizes: Sizes
    sense: int = 1
    """+1 where the driver's acceleration has the sense of its speed, −1 where it is opposite."""
    links: dict[int, PlacedLink] = field(default_factory=dict)
    vertices: dict[What, list[Ref]] = field(default_factory=lambda: {"v": [], "a": []})
    """The points entered on the velocity and the acceleration plan (m on paper), in order."""

    @property
    def arm_length(self) -> Ref:
        """The length of the crank."""
        driver = self.scheme.linkage.driver
        assert isinstance(driver, Crank)
        return self.q[ids.length(driver.centre, driver.pin)]

    # --- points and their images

    def place(self, name: str) -> Ref:
        """Return a point of the mechanism."""
        return self.q[ids.place(name)]

    def is_fixed(self, name: str) -> bool:
        return self.scheme.owner.get(name) == GROUND

    def image(self, what: What, name: str) -> Expression:
        """Return a point on a plan: 0, the pole, for one fixed to the ground."""
        return NOWHERE if self.is_fixed(name) else self.q[ids.plan_point(what, image(name))]

    def vertex(self, what: What, name: str, place: Expression) -> Ref:
        """Enter a point of a plan (m on paper)."""
        self.vertices[what].append(self.q.construct(ids.plan_point(what, name), place))
        return self.vertices[what][-1]

    def letter(self, what: What, name: str) -> Symbol:
        """Return a point's letter on a plan, that of the pole for one fixed to the ground."""
        return Symbol(POLES[what]) if self.is_fixed(name) else on_plan(name, what == "a")

    def image_at(self, what: What, link: int, arm: Expression) -> Expression:
        """Return the image of the point of a link that lies at `arm` from the origin of its frame."""
        q, placed = self.q, self.links[link]
        base = self.image(what, placed.origin)
        if link == DRIVER and what == "a" and placed.eps is not None:
            # The similarity theorem on the crank itself.
            driver = self.scheme.linkage.driver
            assert isinstance(driver, Crank)
            return arm / (self.place(driver.pin) - self.place(driver.centre)) * self.image("a", driver.pin)
        if link == DRIVER and placed.omega is not None:
            drawn = arm * (q[ids.segment(what, "p", image(self.scheme.linkage.driver.pin))] / self.arm_length)
            return self.turn * turned(drawn) if what == "v" else -drawn
        if placed.tip:
            ratio = arm / (self.place(placed.tip) - self.place(placed.origin))
            return base + ratio * (self.image(what, placed.tip) - base)
        if placed.omega is None:
            return base
        if what == "v":
            return base + turned(arm) * placed.omega / q["mu.v"]
        inward = -(arm * placed.omega**2)
        if placed.eps is not None:
            return base + (turned(arm) * placed.eps + inward) / q["mu.a"]
        return base + inward / q["mu.a"]

    def absolute(self, what: What, name: str) -> None:
        """Enter the segment from the pole to a point's image, and the velocity or acceleration that it represents."""
        q, point = self.q, image(name)
        on_paper = ids.segment(what, "p", point)
        if on_paper not in q:
            self.segment(on_paper, POLES[what], on_plan(name, what == "a"), self.image(what, name), what)
        q.define(ids.POINT_RATE[what](name), q[ids.scale(what)] * q[on_paper], scale=self.sizes.of(what))
        self.direction(what, name)

    def direction(self, what: What, name: str) -> None:
        """Enter the angle of a point's velocity or acceleration from +x."""
        vector = self.q[ids.plan_point(what, image(name))]
        self.q.define(ids.direction(what, name), heading(vector), scale=1.0, of=ids.POINT_RATE[what](name))

    # --- sizes on paper

    def paper(self, what: What) -> float:
        """Return the reference size of a plan on paper (m)."""
        return self.sizes.of(what) / self.q.si(ids.scale(what))

    def span(self) -> float:
        """Return the longest length of the mechanism as it is drawn (m on paper)."""
        return longest(self.scheme.linkage) / self.q.si("mu.l")

    def segment(self, id: str, first: Symbol | str, second: Symbol | str, along: Expression, what: What) -> Ref:
        """Enter and return the length (m on paper) of the vector `along`, a segment measured on a plan."""
        return self.q.define(id, abs(along), segment(first, second), scale=self.paper(what))

    def constant(self, id: str, value: complex) -> Ref:
        """Return a constant point (m) or direction (of length 1) as a quantity, entered once."""
        return self.q[id] if id in self.q else self.q.give(id, complex(value), Symbol(id), "ratio")

    def length(self, start: str, end: str, value: float) -> Ref:
        """Return a link's length (m), entered as given unless the machine has done so."""
        id = ids.length(start, end)
        return self.q[id] if id in self.q else self.q.give(id, value, exact=is_short(value))

    def distance(self, start: str, end: str, along: float, across: float, rod: Ref | None = None) -> Ref:
        """Return the distance (m) from `start` to a point `end` with given coordinates (m) along and across a link.

        From the link's origin it is √(x² + y²); from the far end of a `rod` of length l, it is √((l − x)² + y²).
        """
        signed = along if rod is not None else abs(along)
        x, y = (Number(float(f"{value:.{TYPED}g}")) for value in (signed, abs(across)))
        first: Expression = x if rod is None else rod - x
        reach = along if rod is None else self.q.si(rod) - along
        id, value = ids.length(start, end), math.hypot(reach, across)
        if id in self.q or not (reach and across):
            return self.length(start, end, value)
        return self.q.give(id, value, exact=is_short(value), written=sqrt(first**2 + y**2))

    def drawn(self, start: str, end: str) -> Expression:
        """Enter a length as it is drawn (m on paper) and return the length (m) that the drawing represents."""
        q, on_paper = self.q, self.q[ids.length(start, end)] / self.q["mu.l"]
        drawn = q.define(ids.drawn(start, end), on_paper, drawn_length(start, end))
        return q["drawing"] * q.construct(ids.laid_line(start, end), on_paper, of=drawn.id)

    # --- links

    def axis(self, link: int) -> Expression:
        """Return the unit vector along the real axis of a link's frame."""
        if link == GROUND:
            return Number(1.0)
        axis = self.links[link].axis
        assert axis is not None, f"nothing is carried by link {link}"
        return axis

    def guide(self, slider: int, guide: Guide) -> tuple[Ref, Ref]:
        """Return a guide's point and direction, carried along by its link."""
        at, along = ids.guide_place(slider), ids.guide(slider)
        if guide.link == GROUND:
            return self.constant(at, guide.at), self.constant(along, cmath.exp(1j * guide.angle))
        axis = self.axis(guide.link)
        own_place = self.constant(ids.guide_place_on_link(slider), guide.at)
        own_direction = self.constant(ids.guide_on_link(slider), cmath.exp(1j * guide.angle))
        start = self.place(self.links[guide.link].origin)
        return self.q.construct(at, start + own_place * axis), self.q.construct(along, own_direction * axis)

    def share_rotation(self, what: What, link: int) -> None:
        """Enter ω or ε of a link that rotates with another link as equal to that of the other."""
        q, leader = self.q, self.scheme.spins[link]
        rate, order = ROTATION[what]
        rotation = ids.LINK_RATE[rate]
        if leader == link or rotation(leader) not in q:
            return
        size = self.sizes.rotation**order
        signed = self.omega(leader) if what == "v" else q[ids.signed(rate, leader)]
        q.define(rotation(link), q[rotation(leader)], scale=size)
        q.define(ids.signed(rate, link), signed, scale=size, of=rotation(link))

    def omega(self, link: int) -> Expression:
        """Return the signed angular velocity of a link that turns."""
        if link == DRIVER:
            return self.q["omega.1"] if self.turn > 0 else -self.q["omega.1"]
        return Ref(ids.signed("omega", link))

    def put(self, link: int, origin: str, axis: Ref | None, tip: str = "") -> None:
        """Place a link; the motion of its points follows from the link with which it rotates."""
        source = self.scheme.spins[link]
        omega = self.omega(link) if source else None
        of_source = ids.signed("eps", source)
        eps = Ref(ids.signed("eps", link)) if source not in (0, DRIVER) or of_source in self.q else None
        self.links[link] = PlacedLink(origin, axis, tip, omega, eps)


def longest(linkage: Linkage) -> float:
    """Return the longest length of a linkage (m): a rod, or a distance of fixed points or points of a link."""
    fixed = list(linkage.ground.values())
    spans = [abs(p - q) for p in fixed for q in fixed]
    rods = [length for dyad in linkage.dyads for length in dyad.lengths]
    rods += [leg.length for triad in linkage.triads for leg in triad.legs]
    return max((*rods, *spans, *(abs(place.local) for place in linkage.points)), default=0.0) or 1.0


def natural_sizes(q: Calculation, linkage: Linkage) -> Sizes:
    """Return the reference sizes of velocity, acceleration and rotation of a linkage, from the motion of its driver."""
    driver = linkage.driver
    if isinstance(driver, Crank):
        omega, ε1 = q.si("omega.1"), ids.angular_acceleration(DRIVER)
        acceleration = max(omega**2, q.si(ε1) if ε1 in q else 0.0)
        return Sizes(omega * driver.length, acceleration * driver.length, math.sqrt(acceleration))
    speed, size = float(np.abs(q.value(ids.velocity(driver.pin))).max()), longest(linkage)
    a = ids.acceleration(driver.pin)
    return Sizes(speed, max(speed**2 / size, q.si(a) if a in q else 0.0), speed / size)


DRAWN = 0.05
"""Drawn length of the crank (m on paper) when the machine does not say."""
LONGEST_DRAWN = 0.08
"""Largest drawn length (m on paper) in a mechanism with a sliding driver."""


def crank(
    q: Calculation, scheme: Scheme, driver: Crank, turn: int, sense: int, scales: Mapping[str, float | None]
) -> Kinematics:
    """Place the driving crank: v_A = ω₁ l, aⁿ_A = ω₁² l, aᵗ_A = ε₁ l.

    `turn` and `sense` are ±1 as in `Kinematics`. `scales` by "v" and "a" are SI per metre of paper; they default to
    μ_v = ω₁ μ_l, μ_a = ω₁² μ_l, at which pa and πn are the drawn crank; without `eps.1`, πn is πa′. `phi.1`,
    `omega.1` and the crank's centre must have been entered.
    """
    centre, pin = driver.centre, driver.pin
    k = Kinematics(q, scheme, turn, natural_sizes(q, scheme.linkage), sense)
    φ1, ω1, length = q["phi.1"], q["omega.1"], k.length(centre, pin, driver.length)
    if ids.drawn(centre, pin) not in q:
        q.give(ids.drawn(centre, pin), DRAWN, drawn_length(centre, pin))
    drawn = q[ids.drawn(centre, pin)]
    exact = q.families[drawn.id].exact
    # A scale chosen from the series is printed as chosen, not as computed from the drawn length.
    chosen_scale = q.find("scale")
    μ_l = q.define("mu.l", length / drawn, written=chosen_scale)
    # Length of one unit on paper: it follows the drawn crank, whatever is written for μ_l.
    q.define("drawing", length / drawn, Symbol("drawing"), "ratio", hidden=True, written=chosen_scale)
    q.construct(ids.place(pin), k.place(centre) + length * cis(φ1))
    further = [place for place in scheme.linkage.points if place.link == DRIVER]
    for place in further:
        k.distance(centre, place.name, place.local.real, place.local.imag)
        reach = k.drawn(centre, place.name)
        q.construct(ids.place(place.name), k.place(centre) + reach * cis(φ1 + cmath.phase(place.local)))

    ε1 = q.find(ids.angular_acceleration(DRIVER))
    q.define(ids.velocity(pin), ω1 * length)
    inward = q.define(ids.acceleration(pin, "n") if ε1 else ids.acceleration(pin), ω1**2 * length)
    along_v = ids.segment("v", "p", image(pin)), segment("p", on_plan(pin)), q[ids.velocity(pin)]
    along_a = ids.segment("a", "p", image(pin)), segment("π", on_plan(pin, True)), inward
    if ε1:
        along_a = ids.relative_segment("n", pin), segment("π", "n"), inward
    for what, (id, letters, rate), by_crank in (("v", along_v, ω1 * μ_l), ("a", along_a, ω1**2 * μ_l)):
        chosen = scales.get(what)
        if chosen is None:
            q.define(id, drawn, letters, exact=exact)
            q.define(ids.scale(what), by_crank)
        else:
            q.define(id, rate / q.give(ids.scale(what), chosen), letters)
    μ_v, μ_a = q["mu.v"], q["mu.a"]
    if ε1:
        _accelerated_pin(k, driver, ε1)

    k.put(DRIVER, centre, None)
    for name in (pin, *(place.name for place in further)):
        arm = k.place(name) - k.place(centre)
        k.vertex("v", image(name), k.image_at("v", DRIVER, arm))
        if name != pin or not ε1:
            k.vertex("a", image(name), k.image_at("a", DRIVER, arm))
        if name != pin:
            own = q[ids.length(centre, name)]
            per_length = sqrt(ω1**4 + ε1**2) if ε1 else ω1**2
            v, a = q.define(ids.velocity(name), ω1 * own), q.define(ids.acceleration(name), per_length * own)
            q.define(ids.segment("v", "p", image(name)), v / μ_v, segment("p", on_plan(name)))
            q.define(ids.segment("a", "p", image(name)), a / μ_a, segment("π", on_plan(name, True)))
    ends = (end for dyad in scheme.linkage.dyads for end in (dyad.start, dyad.end))
    carries = any(getattr(end, "link", None) == DRIVER for end in ends)
    k.put(DRIVER, centre, q.construct("axis.1", cis(φ1)) if carries else None)
    return k


def _accelerated_pin(k: Kinematics, driver: Crank, ε1: Ref) -> None:
    """Enter aᵗ_A = ε₁ l square to the crank, laid off from n behind aⁿ_A: a_A = √(aⁿ² + aᵗ²); and the sense of ε₁."""
    q, pin, arm = k.q, driver.pin, k.place(driver.pin) - k.place(driver.centre)
    sense = k.turn * k.sense
    q.define(ids.signed("eps", DRIVER), ε1 if sense > 0 else -ε1, of=ε1.id)
    inward, across = q[ids.acceleration(pin, "n")], q.define(ids.acceleration(pin, "t"), ε1 * k.arm_length)
    q.define(ids.acceleration(pin), sqrt(inward**2 + across**2))
    drawn = q.define(ids.relative_segment("t", pin), across / q["mu.a"], segment("n", on_plan(pin, True)))
    along = unit(arm)
    corner = k.vertex("a", ids.relative_corner("n", pin), -(q[ids.relative_segment("n", pin)] * along))
    sense_of_eps = sign(q[ids.signed("eps", DRIVER)])
    k.vertex("a", image(pin), corner + sense_of_eps * (drawn * turned(along)))
    k.segment(ids.segment("a", "p", image(pin)), POLES["a"], on_plan(pin, True), k.image("a", pin), "a")
    k.direction("a", pin)


def slide(
    q: Calculation, scheme: Scheme, driver: SlidingDriver, turn: int, sense: int, scales: Mapping[str, float | None]
) -> Kinematics:
    """Place the driving slide: the pin moves along its guide with v_A, and a_A if given.

    `scales` by "v" and "a" are μ_v, μ_a (SI per metre of paper); without them the plans are a trial. The driver's
    coordinate `s.1` and the size of its speed, `v.` and the pin's name, must have been entered.
    """
    pin, size = driver.pin, longest(scheme.linkage)
    k = Kinematics(q, scheme, turn, natural_sizes(q, scheme.linkage), sense)
    if "mu.l" not in q:
        q.give("mu.l", nice_up(size / LONGEST_DRAWN / 1e3) * 1e3)
    q.construct("drawing", q["mu.l"])
    along = k.constant("guide.1", cmath.exp(1j * driver.guide.angle))
    at = k.constant("guide.1.at", driver.guide.at)
    q.construct(ids.place(pin), at + q["s.1"] * along)
    μ_v = q.give("mu.v", scales.get("v") or PER_MM)
    q.give("mu.a", scales.get("a") or PER_MM)
    drawn = q.define(ids.segment("v", "p", image(pin)), q[ids.velocity(pin)] / μ_v, segment("p", on_plan(pin)))
    k.vertex("v", image(pin), turn * drawn * along)
    a = q.find(ids.acceleration(pin))
    if a is None:
        q.give(ids.acceleration(pin), 0.0)
    drawn = q.define(
        ids.segment("a", "p", image(pin)), 0.0 if a is None else a / q["mu.a"], segment("π", on_plan(pin, True))
    )
    k.vertex("a", image(pin), Number(0.0) * along if a is None else turn * sense * drawn * along)
    k.put(DRIVER, pin, along)
    return k


def chosen_scale(trial: Kinematics, what: What, worked: Sequence[int]) -> float | None:
    """Return the common scale of the plans (SI per metre of paper), from a trial.

    None if the scale by the crank already draws the `worked` plans, counted from 1, large enough, and no plan larger
    than a sheet. Beside a dead point, the plan of accelerations would be metres long.
    """
    q, μ = trial.q, trial.q.si(ids.scale(what))
    sizes = extents([np.zeros(1), *map(q.value, trial.vertices[what])], q.positions) * μ
    printed = sizes[:, [k - 1 for k in worked]] if worked else sizes
    least = np.nanmin(printed.max(axis=0), initial=np.inf) / μ
    if isinstance(trial.scheme.linkage.driver, Crank) and least >= LEAST_MOTION and drawable(sizes / μ):
        return None
    return common_scale(sizes, worked, LEAST_MOTION)


# --- instant centres of velocity ------------------------------------------------------------------
# The centres and the projections on a link, with their results for the link's motion.
# For each link k with two moving points B (its base) and C: `ic.k` the centre P, where the normals to both velocities
# meet; `ic.seg.k.B`, `ic.seg.k.C` its distances as drawn, nan where they are too short to measure or P lies off every
# sheet that holds the mechanism; `ic.omega.k` = v_B/(μ_l·PB), `ic.v.k` = v_B·PC/PB; `ic.angle.k.B`, `ic.angle.k.C`
# the angles between the velocities and BC, `ic.along.k.B` = v_B cos ψ_B, `ic.along.k.C` = v_C cos ψ_C.

NEAREST = 0.002
"""The shortest distance of a centre from the base (m on paper) that is measured: a shorter one has no exact length."""
FARTHEST = 0.4
"""Longest distance (m on paper) that a sheet can show."""


def links_in_plane_motion(scheme: Scheme) -> tuple[Side, ...]:
    """Return the links in plane motion, each as one moving point that turns about another."""
    every = (side for group in scheme.linkage.groups for side in group_sides(scheme, group))
    return tuple(side for side in every if side.turns and not side.still)


def centre_symbol(link: int) -> Symbol:
    """Return P with the link's number."""
    return Symbol("P", str(link))


def enter_centres(k: Kinematics) -> None:
    """Enter the instant centres of all links in plane motion, and the checks of ω and v by them."""
    for turn in links_in_plane_motion(k.scheme):
        _enter_centre(k, turn)


def _enter_centre(k: Kinematics, turn: Side) -> None:
    q, link, base, end, sizes = k.q, turn.link, turn.base, turn.point, k.sizes
    normals = k.place(base), _normal(k, base), k.place(end), _normal(k, end)
    centre, μ_l = q.construct(ids.centre(link), meet(*normals)), q["mu.l"]

    reach = q.give(ids.centre_reach(link), _reach(k, q.value(centre)), Symbol("reach"), "ratio", hidden=True)

    def distance(name: str, nearest: float) -> Expression:
        within = call("within", abs(k.place(name) - centre) / q["drawing"], nearest, reach)
        return q.define(
            ids.centre_distance(link, name), within, segment(centre_symbol(link), point(name)), scale=k.span()
        )

    PB, PC, v = distance(base, NEAREST), distance(end, 0.0), q[ids.velocity(base)]
    q.define(ids.centre_omega(link), v / (μ_l * PB), scale=sizes.rotation)
    q.define(ids.centre_velocity(link), v * (PC / PB), Symbol("v", end), scale=sizes.velocity)
    for name in (base, end):
        to_link = abs(arg(quotient(k.image("v", name), q[ids.rod(link)])))
        q.define(ids.rod_angle(link, name), to_link, scale=1.0, of=ids.velocity(name))
    for name in (base, end):
        along = q[ids.velocity(name)] * cos(q[ids.rod_angle(link, name)])
        q.define(ids.projection(link, name), along, scale=sizes.velocity)


def _reach(k: Kinematics, centre: np.ndarray) -> np.ndarray:
    """Return the largest measurable distance (m on paper) of a centre at each position [N].

    It is 0 where no sheet can show the centre with the mechanism.
    """
    q = k.q
    points = [family.values for id, family in q.families.items() if id in ids.place]
    sizes = extents([*points, centre], q.positions) / q.si("mu.l")
    fits = [(sizes <= np.array(box)[:, None]).all(axis=0) for box in SHEET_BOXES]
    return np.where(np.any(fits, axis=0), FARTHEST, 0.0)


def _normal(k: Kinematics, name: str) -> Expression:
    """Return a direction perpendicular to a point's velocity: from the guiding link, so also for v = 0, else from
    the plan.
    """
    scheme, driver = k.scheme, k.scheme.linkage.driver
    owner = scheme.owner.get(name)
    if owner == DRIVER:
        if isinstance(driver, Crank):
            return k.place(name) - k.place(driver.centre)
        return turned(k.q["guide.1"])
    every = (side for group in scheme.linkage.groups for side in group_sides(scheme, group))
    for side in (side for side in every if side.still):
        if side.turns:
            if side.point == name or side.link == owner:
                return k.place(name) - k.place(side.base)
        elif side.point == name or (side.carrier is not None and side.along == ids.guide(owner)):
            return turned(k.q[side.along])
    return turned(k.q[ids.plan_point("v", image(name))])
