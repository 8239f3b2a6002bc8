"""A student who works a machine through by hand, by vectors on paper: own drawing, own equilibrium, own rounding.

The mechanism (`p`), the plans of velocity (`v`), acceleration (`a`) and force are complex numbers in metres of paper:
points by circles and lines, plans by one vector equation a group, reactions by moments about the inner joint and the
closed polygon, M_cb from the crank and by Zhukovsky's lever.  The work goes on from what is written.  Nothing of the
ledger or of marking is used.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

MM, DEGREE = 1e-3, math.pi / 180
PRINTED = {"drawn": MM, "seg": MM, "ic.seg": MM, "h": MM, "F": 1e-4, "p": 1e4, "mu": 1e3} | dict.fromkeys(
    ("dir", "beta", "ic.angle", "theta", "alpha", "psi", "swing"), DEGREE
)
"""What one printed unit is in SI, by the first part of an id; 1 for all others."""
NOTHING = 1e-9
"""A vector shorter than this (m on paper) is none."""

Change = Callable[[float], float]
"""What a student makes of a value that should be another."""


def unit_of(id: str) -> float:
    """What one printed unit of a quantity is in SI."""
    first, *rest = id.split(".")
    return PRINTED.get(f"ic.{rest[0]}" if first == "ic" else first, 1.0)


@dataclass(frozen=True)
class Load:
    """A force (N) at a point of a link, moved `beside` it (m) for its couple, or a couple alone."""

    name: str
    link: int
    point: str
    force: complex = 0j
    beside: float = 0.0
    couple: float = 0.0


@dataclass(frozen=True)
class Side:
    """A link from an outer joint to the inner one of its group: its length (m) and the unit vector along it."""

    link: int
    outer: str
    length: float
    along: complex


@dataclass(frozen=True)
class Group:
    """Two links that were added to what stood: their inner joint, their sides, the line along which a slider moves."""

    kind: str
    links: tuple[int, int]
    start: str
    joint: str
    sides: tuple[Side, ...]
    scheme: complex = 0j


@dataclass(kw_only=True)
class Hand:
    """One position of a machine worked out; `given` are the data of the task (SI), `changes` are mistakes by id.

    The crank is drawn `paper` (m) long; a metre of a force plan is `force_scale` (N), of another plan its `plan_scales`
    (SI); if none is chosen the crank's image is as long as the crank, and the scale v_A/pa `by_lengths`, else ω μ_l.
    Of the forces and normal parts of the plans some are `left_out` or `turned`.

    `figures` are written, all there are if 0; whole degrees of a direction.  A length on paper is off by up to `blunt`
    (m) at each of its ends and read to `step` mm, a direction by up to `askew` (°).
    """

    given: Mapping[str, float]
    turn: int = 1
    paper: float = 0.05
    plan_scales: Mapping[str, float] = field(default_factory=dict)
    force_scale: float | Mapping[str, float] = 1e5
    by_lengths: bool = True
    left_out: frozenset[str] = frozenset()
    turned: frozenset[str] = frozenset()
    changes: Mapping[str, Change] = field(default_factory=dict)
    figures: int = 4
    blunt: float = 0.0
    askew: float = 0.0
    step: float = 0.1
    seed: int = 0

    def __post_init__(self) -> None:
        self.rng = np.random.default_rng(self.seed)
        self.written: dict[str, float] = {}
        self.used: set[str] = set()
        self.mu: dict[str, float] = {}
        self.p: dict[str, complex] = {}
        self.v: dict[str, complex] = {}
        self.a: dict[str, complex] = {}
        self.images = {"v": self.v, "a": self.a}
        self.link_of: dict[str, int] = {}
        self.lengths: dict[tuple[str, str], float] = {}
        self.omega: dict[int, float] = {}
        self.eps: dict[int, float] = {}
        self.groups: list[Group] = []
        self.loads: list[Load] = []

    # --- writing and reading

    def say(self, id: str, value: float) -> float:
        """A value found; gives what is written, in SI."""
        if id in self.changes:
            value = self.changes[id](value)
        unit = unit_of(id)
        printed = value / unit
        if not self.figures:
            pass
        elif id.startswith("dir."):
            printed = float(round(printed % 360))
        elif unit == MM:
            printed = round(round(printed / self.step) * self.step, 2) if self.blunt else round(printed, 2)
        elif printed:
            printed = float(f"{printed:.{self.figures - 1}e}")
        self.written[id] = printed
        return printed * unit

    def choose(self, id: str, value: float) -> float:
        """A length or a scale taken freely and without a mistake."""
        self.written[id] = value / unit_of(id)
        return value

    def datum(self, id: str) -> float:
        """A given value as the student reads it."""
        self.used.add(id)
        value = self.given[id]
        return self.changes[id](value) if id in self.changes else value

    def known(self, id: str) -> float:
        """A value in SI that is worked out already, or given."""
        return self.written[id] if id in self.written else self.datum(id)

    def ends(self) -> float:
        """How far off a length on paper is read, both its ends together (m)."""
        return float(self.rng.uniform(-self.blunt, self.blunt, 2).sum())

    def read(self, id: str, length: float) -> float:
        """A length as it is measured; what is nothing is seen to be nothing."""
        return self.say(id, abs(length + self.ends()) if length > NOTHING else 0.0)

    def read_signed(self, id: str, length: float) -> float:
        """An arm as it is measured, with the sense that the drawing shows."""
        return math.copysign(self.read(id, abs(length)), length)

    def direct(self, id: str, vector: complex) -> None:
        """Where a drawn vector points, if it has a length to show it."""
        if abs(vector) > max(NOTHING, 4 * self.blunt):
            off = DEGREE * self.rng.uniform(-self.askew, self.askew)
            self.say(f"dir.{id}", (float(np.angle(vector)) + off) % (2 * np.pi))

    def tell(self, what: str, name: str, laid: float | None = None) -> None:
        """Velocity or acceleration of a point as it is laid off in its plan, or else read from it."""
        vector = self.images[what][name]
        length = self.read(f"seg.{what}.p{name.lower()}", abs(vector)) if laid is None else laid
        self.say(f"{what}.{name}", self.mu[what] * length)
        self.direct(f"{what}.{name}", vector)

    # --- points and links

    def draw(self, name: str, length: float) -> None:
        """The crank on paper, by a given scale or as long as it is chosen, and the scale that comes of it."""
        id = f"drawn.{name}"
        by_scale = "scale" in self.given
        self.paper = self.say(id, length / self.given["scale"]) if by_scale else self.choose(id, self.paper)
        self.drawing = length / self.paper
        self.mu["l"] = self.say("mu.l", self.drawing)

    def drawn(self, name: str, length: float) -> float:
        """A length (m) as it is laid off on paper."""
        return self.say(f"drawn.{name}", length / self.mu["l"])

    def fixed(self, name: str, at: complex) -> None:
        self.p[name], self.v[name], self.a[name], self.link_of[name] = at / self.drawing, 0j, 0j, 0

    def crank(self, centre: str, pin: str, length: float, angle: float) -> None:
        """The driver: its speed is known, v = ωR and a = ω²R; it is drawn already."""
        by_n = "n" in self.given
        self.speed = self.say("omega.1", 2 * math.pi * self.datum("n") / 60) if by_n else self.datum("omega.1")
        if "unevenness" in self.given:
            for name, side in (("max", 1), ("min", -1)):
                self.say(f"omega.{name}", self.speed * (1 + side * self.datum("unevenness") / 2))
        self.omega[1], self.eps[1], self.radius = self.turn * self.speed, 0.0, length
        v, a = self.say(f"v.{pin}", self.speed * length), self.say(f"a.{pin}", self.speed**2 * length)
        self.larger = self._scale("v", pin, v, self.speed), self._scale("a", pin, a, self.speed**2)
        self._circling(pin, centre, self.paper * np.exp(1j * angle))

    def _scale(self, what: str, pin: str, value: float, rate: float) -> float:
        """The scale of a plan; gives the length in it for the pin's velocity or acceleration, in drawn cranks."""
        image, scale = f"seg.{what}.p{pin.lower()}", f"mu.{what}"
        if what in self.plan_scales:
            self.mu[what] = self.choose(scale, self.plan_scales[what])
            return self.say(image, value / self.mu[what]) / self.paper
        self.choose(image, self.paper)
        self.mu[what] = self.say(scale, value / self.paper if self.by_lengths else rate * self.mu["l"])
        return 1.0

    def _circling(self, name: str, centre: str, arm: complex) -> None:
        """A point of the crank: its images are its arm turned, and turned round."""
        self.p[name], self.link_of[name] = self.p[centre] + arm, 1
        self.v[name], self.a[name] = self.turn * 1j * arm * self.larger[0], -arm * self.larger[1]

    def on_crank(self, name: str, centre: str, pin: str, length: float, ahead: float = 0.0) -> None:
        """Another point of the crank: what the pin has, has one as far from the centre."""
        same = self.by_lengths and length == self.radius
        arm = self.drawn(f"{centre}{name}", length) * _unit(self.p[pin] - self.p[centre])
        for what, rate in (("v", self.speed), ("a", self.speed**2)):
            value = self.say(f"{what}.{name}", self.written[f"{what}.{pin}"] if same else rate * length)
            self.say(f"seg.{what}.p{name.lower()}", value / self.mu[what])
        self._circling(name, centre, arm * np.exp(1j * self.turn * ahead))

    def slide(self, pin: str, at: float, speed: float) -> None:
        """A driver that slides along x at a constant speed, on a drawing of a chosen scale."""
        self.drawing = self.mu["l"] = self.choose("mu.l", self.given["mu.l"])
        self.mu["v"], self.mu["a"] = (self.choose(f"mu.{what}", self.plan_scales[what]) for what in "va")
        self.p[pin], self.link_of[pin], self.speed = at / self.drawing + 0j, 1, speed
        self.v[pin], self.a[pin] = self.say(f"seg.v.p{pin.lower()}", speed / self.mu["v"]) + 0j, 0j

    def point(self, name: str, one: str, other: str, link: int, at: complex) -> None:
        """A point of a link, by similarity with two others: `at` is where it lies from `one` to `other`, as a share."""
        share, turned, still = abs(at), at / abs(at), self.link_of[one] == 0
        length = self.drawn(f"{one}{name}", share * self.lengths[one, other])
        self.p[name] = self.p[one] + length * turned * _unit(self.p[other] - self.p[one])
        self.link_of[name] = link
        origin = "p" if still else one.lower()
        for what, had in self.images.items():
            whole = f"seg.{what}.{origin}{other.lower()}"
            way = had[other] - had[one]
            measured = self.written[whole] * MM if whole in self.written else self.read(whole, abs(way))
            laid = self.say(f"seg.{what}.{origin}{name.lower()}", share * measured)
            if turned.imag:
                ratio = self.known(f"l.{other}{name}") / self.lengths[one, other]
                self.say(f"seg.{what}.{other.lower()}{name.lower()}", ratio * measured)
            had[name] = had[one] + laid * turned * _unit(way)
            self.tell(what, name, laid if still else None)

    def on_lever(self, name: str, under: str, length: float) -> None:
        """A point of a slotted lever at `length` from its pivot: its images by the ratio of the lengths as measured."""
        (side,) = next(one.sides for one in self.groups if one.joint == under)
        self.p[name] = self.p[side.outer] + self.drawn(f"{side.outer}{name}", length) * side.along
        self.link_of[name] = side.link
        for what, had in self.images.items():
            measured = self.written[f"seg.{what}.p{under.lower()}"] * MM
            laid = self.say(f"seg.{what}.p{name.lower()}", length / side.length * measured)
            had[name] = laid * _unit(had[under])
            self.tell(what, name, laid)

    # --- groups

    def rrr(self, links: tuple[int, int], joints: str | Sequence[str], lengths: tuple[float, float], side: int) -> None:
        """Two bars; the joint between them lies to the left (`side` 1) of the way from `start` to `end`."""
        start, joint, end = joints
        a, b = (self.drawn(f"{outer}{joint}", length) for outer, length in zip((start, end), lengths, strict=True))
        way = self.p[end] - self.p[start]
        x = (abs(way) ** 2 + a**2 - b**2) / (2 * abs(way))
        at = self.p[start] + (x + side * 1j * math.sqrt(a**2 - x**2)) * _unit(way)
        self._add(links, at, (joint, start, end), lengths)

    def rrp(self, links: tuple[int, int], start: str, joint: str, length: float, scheme: complex, at: complex) -> None:
        """A rod and a slider on the line through `at` along `scheme`; the slider is the one further along it."""
        rod, foot = self.drawn(f"{start}{joint}", length), at / self.drawing
        way = np.conj(scheme) * (self.p[start] - foot)
        reached = foot + scheme * (way.real + math.sqrt(rod**2 - way.imag**2))
        self.omega[links[1]] = self.eps[links[1]] = 0.0
        self._add(links, reached, (joint, start), (length,), scheme)

    def _add(
        self, links: tuple[int, int], at: complex, joints: Sequence[str], lengths: Sequence[float], scheme: complex = 0j
    ) -> None:
        """A group with its inner joint `at` a point: what both sides say of the joint's velocity, and acceleration."""
        joint, *outers = joints
        self.p[joint], self.link_of[joint] = at, links[1] if scheme else links[0]
        bars = zip(links, outers, lengths, strict=False)  # a slider has no bar
        sides = tuple(Side(link, outer, length, _unit(at - self.p[outer])) for link, outer, length in bars)
        self.groups.append(Group("RRP" if scheme else "RRR", links, outers[0], joint, sides, scheme))
        slider = [(0j, scheme)] if scheme else []
        lines = [(self.v[one.outer], 1j * one.along) for one in sides] + slider
        self.v[joint] = meet(*lines[0], *lines[1])
        self.tell("v", joint)
        starts = []
        for one in sides:
            self.lengths[one.outer, joint] = one.length
            named, way = f"{joint}{one.outer}", self.v[joint] - self.v[one.outer]
            if self.link_of[one.outer] == 0:
                speed = self.say(f"v.{named}", self.written[f"v.{joint}"])
            else:
                between = f"seg.v.{one.outer.lower()}{joint.lower()}"
                speed = self.say(f"v.{named}", self.mu["v"] * self.read(between, abs(way)))
            self.omega[one.link] = self._rate("omega", one, way, speed)
            normal = self.say(f"seg.a.n.{named}", self.say(f"a.{named}.n", speed**2 / one.length) / self.mu["a"])
            starts.append(self.a[one.outer] - (0.0 if f"n.{named}" in self.left_out else normal) * one.along)
        lines = [(start, 1j * one.along) for start, one in zip(starts, sides, strict=True)] + slider
        self.a[joint] = meet(*lines[0], *lines[1])
        self.tell("a", joint)
        for start, one in zip(starts, sides, strict=True):
            named, way = f"{joint}{one.outer}", self.a[joint] - start
            tangential = self.say(f"a.{named}.t", self.mu["a"] * self.read(f"seg.a.t.{named}", abs(way)))
            self.eps[one.link] = self._rate("eps", one, way, tangential)

    def _rate(self, what: str, side: Side, way: complex, size: float) -> float:
        """A signed rate of turning from the size of v or a_t that is written down."""
        sign = math.copysign(1.0, _cross(side.along, way))
        return sign * abs(self.say(f"turn.{what}.{side.link}", sign * size / side.length))

    def rpr(self, links: tuple[int, int], pin: str, pivot: str) -> None:
        """A block on the pin that slides along a lever about a fixed pivot; the lever's point under it is pin3."""
        block, lever = links
        under = f"{pin}{lever}"
        way = self.p[pin] - self.p[pivot]
        length = self.say(f"l.{pivot}{under}", self.mu["l"] * self.read(f"drawn.{pivot}{under}", abs(way)))
        side = Side(lever, pivot, length, _unit(way))
        along, across = side.along, 1j * side.along
        self.groups.append(Group("RPR", links, pin, under, (side,)))
        self.p[under], self.link_of[under] = self.p[pin], lever
        self.v[under] = meet(self.v[pin], along, 0j, across)
        slid = self.v[under] - self.v[pin]
        sliding = self.read(f"seg.v.{pin.lower()}{under.lower()}", abs(slid))
        sliding = self.say(f"v.{under}{pin}", self.mu["v"] * sliding)
        self.tell("v", under)
        speed = self.say(f"v.{under}{pivot}", self.written[f"v.{under}"])
        turning = self.omega[lever] = self._rate("omega", side, self.v[under], speed)
        self.omega[block] = self.say(f"turn.omega.{block}", turning)
        coriolis = self.say(f"a.{under}{pin}.k", 2 * abs(turning) * sliding)
        coriolis = self.say(f"seg.a.k.{under}{pin}", coriolis / self.mu["a"])
        carried = self.a[pin] + coriolis * 1j * math.copysign(1.0, turning) * _unit(slid)
        normal = self.say(f"a.{under}{pivot}.n", speed**2 / length)
        turned = -self.say(f"seg.a.n.{under}{pivot}", normal / self.mu["a"]) * along
        self.a[under] = meet(carried, along, turned, across)
        relative = self.read(f"seg.a.r.{under}{pin}", abs(self.a[under] - carried))
        self.say(f"a.{under}{pin}.r", self.mu["a"] * relative)
        tangential = self.read(f"seg.a.t.{under}{pivot}", abs(self.a[under] - turned))
        tangential = self.say(f"a.{under}{pivot}.t", self.mu["a"] * tangential)
        self.eps[lever] = self._rate("eps", side, self.a[under] - turned, tangential)
        self.tell("a", under)
        self.eps[block] = self.say(f"turn.eps.{block}", self.eps[lever])

    def rpp(self, links: tuple[int, int], pin: str, scheme: complex) -> None:
        """A block on the pin in the slot of a yoke that moves along `scheme`, across its slot."""
        under = f"{pin}{links[1]}"
        self.p[under], self.link_of[under] = self.p[pin], links[1]
        self.groups.append(Group("RPP", links, pin, under, (), scheme))
        for what, part, between in (("v", "", f"{pin}{under}".lower()), ("a", ".r", f"r.{under}{pin}")):
            had = self.images[what]
            had[under] = meet(had[pin], 1j * scheme, 0j, scheme)
            apart = self.read(f"seg.{what}.{between}", abs(had[under] - had[pin]))
            self.say(f"{what}.{under}{pin}{part}", self.mu[what] * apart)
            self.tell(what, under)

    # --- loads and reactions

    def body(self, link: int, centre: str, mass: float, moment: float | None = None) -> None:
        """A link's inertia force, moved beside the centre for its couple, and its weight."""
        name = f"Pqt{link}"
        size, beside, couple = self.say(name, mass * self.written[f"a.{centre}"]), 0.0, 0.0
        if moment is not None:
            couple = self.say(f"M.{name}", moment * abs(self.eps[link]))
            if size:
                beside, couple = math.copysign(self.say(f"e.{name}", couple / size), -self.eps[link]), 0.0
            couple = math.copysign(couple, -self.eps[link])
        self.loads.append(Load(name, link, centre, -size * _unit(self.a[centre]), beside, couple))
        if f"G{link}" in self.given:
            self.weight(link, centre)

    def weight(self, link: int, centre: str) -> None:
        self.loads.append(Load(f"G{link}", link, centre, -1j * self.known(f"G{link}")))

    def force(self, name: str, link: int, point: str, force: complex) -> None:
        self.loads.append(Load(name, link, point, force))

    def torque(self, name: str, link: int, couple: float) -> None:
        self.loads.append(Load(name, link, "", couple=couple))

    def reactions(self, centre: str, pin: str) -> None:
        """Outermost group first, then the driver, which has no centre if it slides, and the works of all loads."""
        on = [*self.loads]
        for group in reversed(self.groups):
            on.append(self._of_group(group, on))
        here = [one for one in on if one.link == 1]
        (end,) = self._polygon("1", here)
        if centre:
            self._close("1", "R01", end, 0j)
            self.say("M.eq", -self._moment(here, centre))
        else:
            along = _unit(self.v[pin])
            corner = along * (np.conj(along) * end).real
            self._close("1", "R01", end, corner)
            pushed = self._close("1", "Rcb", corner, 0j)
            self.say("M.eq", math.copysign(pushed, (np.conj(along) * -corner).real))
        works = {one.name: self._work(one) for one in self.loads}
        self.say("M.vw", -sum(works.values()))
        if "unevenness" in self.given:
            self.say("M.r", self.turn * sum(work for name, work in works.items() if not name.startswith("Pqt")))

    def _work(self, load: Load) -> float:
        """A load's moment by Zhukovsky's lever, about the pole of the velocity plan turned by 90° against ω₁."""
        of_couple = self.turn * load.couple * self.omega[load.link] / self.speed if load.couple else 0.0
        if not load.point:
            return self.say(f"M.{load.name}.p", of_couple)
        if not load.force:
            return of_couple
        turned = load.beside * self.omega[load.link] / self.mu["v"] if load.beside else 0.0
        arm = self.turn * ((np.conj(_unit(load.force)) * self.v[load.point]).real + turned)
        h = self.read_signed(f"h.{load.name}.p", float(arm))
        per = self.mu["v"] / self.speed if "v" in self.plan_scales else self.mu["l"]
        return self.say(f"M.{load.name}.p", abs(load.force) * h * per) + of_couple

    def _moment(self, loads: Sequence[Load], about: str) -> float:
        """The moment (N·m) of forces by their arms on the drawing, and of couples, about a point."""
        total = sum(one.couple for one in loads)
        for one in loads:
            if one.force and (one.point != about or one.beside):
                arm = _cross(self.p[one.point] - self.p[about], _unit(one.force)) + one.beside / self.mu["l"]
                total += abs(one.force) * self.read_signed(f"h.{one.name}.{about}", arm) * self.mu["l"]
        return total

    def _polygon(self, plan: str, *chains: Sequence[Load]) -> list[complex]:
        """Forces laid off one after the other from the origin of a force plan; gives where each chain of them ends."""
        scale = self.force_scale if isinstance(self.force_scale, float) else self.force_scale[plan]
        self.mu[plan] = self.choose(f"mu.R{plan}", scale)
        corner, corners = 0j, []
        for chain in chains:
            for one in (one for one in chain if one.point):
                length = self.say(f"seg.{plan}.{one.name}", abs(one.force) / scale)
                factor = 0.0 if one.name in self.left_out else -1.0 if one.name in self.turned else 1.0
                corner += factor * length * _unit(one.force)
            corners.append(corner)
        return corners

    def _close(self, plan: str, name: str, start: complex, end: complex) -> float:
        """A reaction as it is measured between two corners of a force plan."""
        length = self.read(f"seg.{plan}.{name}", abs(end - start))
        self.direct(name, end - start)
        return self.say(name.replace("R", "R.", 1), self.mu[plan] * length)

    def _of_group(self, group: Group, on: Sequence[Load]) -> Load:
        """The reactions in the joints of a group; gives what it does to the link that it hangs on."""
        i, j = group.links
        k, plan = self.link_of[group.start], f"{i}{j}"
        first, second = ([one for one in on if one.link == number] for number in (i, j))
        rods = group.kind in ("RRR", "RRP")
        outer = self._tangential(f"R0{j}", second, group, 1) if group.kind == "RRR" else []
        inner = self._tangential(f"R{k}{i}", first, group, 0) if rods else []
        if group.kind == "RPR":
            (side,) = group.sides
            across = self.say(f"R.{plan}.s", self._moment(second, side.outer) / side.length)
        whole, middle, last, end = self._polygon(plan, outer, second, first, inner)
        if group.kind == "RRR":
            closed = meet(end, group.sides[0].along, 0j, group.sides[1].along)
            self._close(plan, f"R0{j}.n", closed, 0j)
        elif group.kind == "RRP":
            closed = meet(end, group.sides[0].along, 0j, 1j * group.scheme)
        elif group.kind == "RPR":
            closed = middle - across / self.mu[plan] * 1j * side.along
        else:
            closed = meet(middle, group.scheme, 0j, 1j * group.scheme)
        if rods:
            self._close(plan, f"R{k}{i}.n", end, closed)
        self._close(plan, f"R0{j}", closed, whole)
        pushed = self._close(plan, f"R{j}{i}", closed, middle)
        found = self._close(plan, f"R{k}{i}", last, closed)
        if group.kind != "RRR":
            # The reaction of a slider, or of a block in its slot, goes through its pin.
            self.say(f"x.0{j}" if rods else f"x.{j}{i}", 0.0)
        if group.kind == "RPP":
            push = Load(f"R{plan}", j, group.joint, self.say(f"R.{plan}", pushed) * _unit(closed - middle))
            # The moment that the guide's reaction balances, about the point of the yoke on the guide's line.
            self.say(f"x.0{j}", self.say(f"M.0{j}", self._moment([push], "B")) / self.written[f"R.0{j}"])
        return Load(f"R{i}{k}", k, group.start, self.say(f"R.{i}{k}", found) * _unit(last - closed))

    def _tangential(self, name: str, loads: Sequence[Load], group: Group, number: int) -> list[Load]:
        """R^t in an outer joint by moments about the inner one, along the rod turned by 90° anticlockwise."""
        side, id = group.sides[number], name.replace("R", "R.", 1)
        size = self.say(f"{id}.t", self._moment(loads, group.joint) / side.length) if loads else 0.0
        return [Load(f"{name}.t", side.link, side.outer, size * 1j * side.along)]


def _unit(vector: complex) -> complex:
    """The direction of a vector, nothing of one that is nothing."""
    return complex(vector / abs(vector)) if abs(vector) > NOTHING else 0j


def _cross(one: complex, other: complex) -> float:
    return float((np.conj(one) * other).imag)


def meet(p: complex, d: complex, q: complex, e: complex) -> complex:
    """Where the line through p along d meets the one through q along e."""
    return complex(p + d * _cross(e, q - p) / _cross(e, d))
