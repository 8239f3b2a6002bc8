"""A student who solves a linkage by vectors: own loop equations, own equilibrium, own rounding.

Positions come from circles and lines, velocities and accelerations from
one vector equation a group, reactions from moments about the inner joint and the closed polygon, M_cb from the crank
and from virtual work, all in complex numbers and SI.  What the machines of the book are made of is said in `machines`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tests.marking.written import NOTHING, Student


@dataclass(frozen=True)
class Paper:
    """Scales of the student's drawings: what a metre on paper is, in SI; those of force plans by their links."""

    length: float
    velocity: float
    acceleration: float
    force: Mapping[str, float]


@dataclass(frozen=True)
class Load:
    """A force and a couple on a link; `point` is where the force acts."""

    name: str
    link: int
    point: str
    force: complex = 0j
    couple: float = 0.0


@dataclass(frozen=True)
class Group:
    """Two links that were added to what stood: the joint between them, and where they hang on `start` and `end`.

    `along` has the unit vectors from the outer joints to the inner one, `lengths` their distances; a slider has no
    outer joint but a `scheme`.
    """

    kind: str
    links: tuple[int, int]
    start: str
    joint: str
    end: str
    along: tuple[complex, complex]
    lengths: tuple[float, float]
    scheme: complex = 0j


@dataclass
class Vectors(Student):
    """One position of a machine worked out by vectors; `given` are the data of the task (SI)."""

    given: Mapping[str, float]
    paper: Paper
    turn: int = 1

    def __post_init__(self) -> None:
        super().__post_init__()
        self.used: set[str] = set()
        self.p: dict[str, complex] = {}
        self.v: dict[str, complex] = {}
        self.a: dict[str, complex] = {}
        self.link_of: dict[str, int] = {}
        self.length: dict[str, float] = {}
        self.omega: dict[int, float] = {}
        self.eps: dict[int, float] = {}
        self.groups: list[Group] = []
        self.loads: list[Load] = []

    # --- writing and reading

    def datum(self, id: str) -> float:
        """A given value as the student reads it."""
        self.used.add(id)
        value = self.given[id]
        return self.changes[id](value) if id in self.changes else value

    # --- points and links

    def fixed(self, name: str, at: complex) -> None:
        self.p[name], self.v[name], self.a[name], self.link_of[name] = at, 0j, 0j, 0

    def crank(self, centre: str, pin: str, length: float, angle: float) -> None:
        """The driver: its speed is known, v = ωR and a = ω²R."""
        turns = "n" in self.given
        speed = self.say("omega.1", 2 * math.pi * self.datum("n") / 60) if turns else self.datum("omega.1")
        if "unevenness" in self.given:
            for name, side in (("max", 1), ("min", -1)):
                self.say(f"omega.{name}", speed * (1 + side * self.datum("unevenness") / 2))
        along = np.exp(1j * angle)
        self.omega[1], self.eps[1] = self.turn * speed, 0.0
        self.p[pin], self.link_of[pin] = self.p[centre] + length * along, 1
        self.v[pin] = self.turn * 1j * along * self.say(f"v.{pin}", speed * length)
        self.a[pin] = -along * self.say(f"a.{pin}", speed**2 * length)

    def on_crank(self, name: str, centre: str, pin: str, length: float) -> None:
        """Another point of the crank, by the same formulas."""
        speed, along = abs(self.omega[1]), (self.p[pin] - self.p[centre]) / abs(self.p[pin] - self.p[centre])
        self.p[name], self.link_of[name] = self.p[centre] + length * along, 1
        self.v[name] = self.turn * 1j * along * self.say(f"v.{name}", speed * length)
        self.a[name] = -along * self.say(f"a.{name}", speed**2 * length)

    def point(self, name: str, one: str, other: str, link: int, at: complex) -> None:
        """A point of a link, by similarity with two others: `at` is where it lies from `one` to `other`, as a share."""
        self.link_of[name] = link
        for had in (self.p, self.v, self.a):
            had[name] = had[one] + at * (had[other] - had[one])
        self.tell(name)

    def on_lever(self, name: str, under: str, length: float) -> None:
        """A point of a slotted lever at `length` from its pivot: its images by the ratio of the lengths as measured."""
        group = next(one for one in self.groups if one.joint == under)
        self.p[name] = self.p[group.end] + length * group.along[1]
        self.link_of[name] = group.links[1]
        for had in (self.v, self.a):
            had[name] = had[under] * length / self.length[under]
        self.tell(name)

    def tell(self, name: str) -> None:
        """Velocity and acceleration of a point as they are read from the plans."""
        for what, vector, scale in (
            ("v", self.v[name], self.paper.velocity),
            ("a", self.a[name], self.paper.acceleration),
        ):
            self.measure(f"{what}.{name}", abs(vector), scale)
            self.direct(f"{what}.{name}", vector, scale)

    def _rate(self, what: str, link: int, signed: float, size: float, radius: float) -> float:
        """A signed rate of turning from the size of v or a_t that is written down."""
        sign = math.copysign(1.0, signed)
        return sign * abs(self.say(f"turn.{what}.{link}", sign * size / radius))

    # --- groups

    def rrr(self, links: tuple[int, int], joints: str | Sequence[str], lengths: tuple[float, float], side: int) -> None:
        """Two bars; the joint between them lies to the left (`side` 1) of the way from `start` to `end`."""
        start, joint, end = joints
        a, b = lengths
        way = self.p[end] - self.p[start]
        d = abs(way)
        x = (d**2 + a**2 - b**2) / (2 * d)
        at = self.p[start] + (x + side * 1j * math.sqrt(a**2 - x**2)) * way / d
        along = ((at - self.p[start]) / a, (at - self.p[end]) / b)
        self.p[joint], self.link_of[joint] = at, links[0]
        ends = (start, end)
        unknown = (1j * along[0], -1j * along[1])
        turned = _solve(*unknown, self.v[end] - self.v[start])
        self.v[joint] = self.v[start] + turned[0] * unknown[0]
        self.measure(f"v.{joint}", abs(self.v[joint]), self.paper.velocity)
        self.direct(f"v.{joint}", self.v[joint], self.paper.velocity)
        relative = []
        for link, outer, length, speed in zip(links, ends, lengths, turned, strict=True):
            relative.append(self._relative("v", joint, outer, speed, self.paper.velocity))
            self.omega[link] = self._rate("omega", link, speed, relative[-1], length)
        normal = [
            self.say(f"a.{joint}{outer}.n", speed**2 / length)
            for outer, speed, length in zip(ends, relative, lengths, strict=True)
        ]
        known = self.a[end] - normal[1] * along[1] - self.a[start] + normal[0] * along[0]
        turned = _solve(*unknown, known)
        self.a[joint] = self.a[start] - normal[0] * along[0] + turned[0] * unknown[0]
        for link, outer, length, part in zip(links, ends, lengths, turned, strict=True):
            size = self.measure(f"a.{joint}{outer}.t", abs(part), self.paper.acceleration)
            self.eps[link] = self._rate("eps", link, part, size, length)
        self.tell_again("a", joint)
        self.groups.append(Group("RRR", links, start, joint, end, along, lengths))

    def rrp(self, links: tuple[int, int], start: str, joint: str, length: float, scheme: complex, at: complex) -> None:
        """A rod and a slider on the line through `at` along `scheme`; the slider is the one further along it."""
        beside = (np.conj(scheme) * (self.p[start] - at)).imag
        along_line = (np.conj(scheme) * (self.p[start] - at)).real + math.sqrt(length**2 - beside**2)
        self.p[joint], self.link_of[joint] = at + scheme * along_line, links[1]
        along = (self.p[joint] - self.p[start]) / length
        unknown = (1j * along, -scheme)
        speed = _solve(*unknown, -self.v[start])
        self.v[joint] = speed[1] * scheme
        relative = self._relative("v", joint, start, speed[0], self.paper.velocity)
        self.omega[links[0]] = self._rate("omega", links[0], speed[0], relative, length)
        self.omega[links[1]] = self.eps[links[1]] = 0.0
        self.tell_again("v", joint)
        normal = self.say(f"a.{joint}{start}.n", relative**2 / length)
        part = _solve(*unknown, normal * along - self.a[start])
        self.a[joint] = part[1] * scheme
        size = self.measure(f"a.{joint}{start}.t", abs(part[0]), self.paper.acceleration)
        self.eps[links[0]] = self._rate("eps", links[0], part[0], size, length)
        self.tell_again("a", joint)
        self.groups.append(Group("RRP", links, start, joint, "", (along, 0j), (length, 0.0), scheme))

    def rpr(self, links: tuple[int, int], pin: str, pivot: str) -> None:
        """A block on the pin that slides along a lever about a fixed pivot; the lever's point under it is pin3."""
        block, lever = links
        under = f"{pin}{lever}"
        way = self.p[pin] - self.p[pivot]
        length = self.length[under] = self.measure(f"l.{pivot}{under}", abs(way), self.paper.length)
        along = way / abs(way)
        sliding, speed = -(np.conj(along) * self.v[pin]).real, (np.conj(along) * self.v[pin]).imag
        self.p[under], self.link_of[under] = self.p[pin], lever
        self.v[under] = speed * 1j * along
        slid = self.measure(f"v.{under}{pin}", abs(sliding), self.paper.velocity)
        about = self.measure(f"v.{under}", abs(speed), self.paper.velocity)
        self.direct(f"v.{under}", self.v[under], self.paper.velocity)
        about = self.say(f"v.{under}{pivot}", about)
        turning = self._rate("omega", lever, speed, about, length)
        self.omega[lever] = turning
        self.omega[block] = self.say(f"turn.omega.{block}", turning)
        coriolis = self.say(f"a.{under}{pin}.k", 2 * abs(turning) * slid)
        known = self.a[pin] + math.copysign(coriolis, turning * sliding) * 1j * along
        normal = self.say(f"a.{under}{pivot}.n", about**2 / length)
        sliding, tangential = -normal - (np.conj(along) * known).real, (np.conj(along) * known).imag
        self.measure(f"a.{under}{pin}.r", abs(sliding), self.paper.acceleration)
        self.a[under] = -normal * along + tangential * 1j * along
        size = self.measure(f"a.{under}{pivot}.t", abs(tangential), self.paper.acceleration)
        self.eps[lever] = self._rate("eps", lever, tangential, size, length)
        self.tell_again("a", under)
        self.eps[block] = self.say(f"turn.eps.{block}", self.eps[lever])
        self.groups.append(Group("RPR", links, pin, under, pivot, (along, along), (length, length)))

    def rpp(self, links: tuple[int, int], pin: str, scheme: complex) -> None:
        """A block on the pin in the slot of a yoke that moves along `scheme`, across its slot."""
        yoke = links[1]
        under = f"{pin}{yoke}"
        self.p[under], self.link_of[under] = self.p[pin], yoke
        for what, had, part, scale in (
            ("v", self.v, f"v.{under}{pin}", self.paper.velocity),
            ("a", self.a, f"a.{under}{pin}.r", self.paper.acceleration),
        ):
            had[under] = (np.conj(scheme) * had[pin]).real * scheme
            self.measure(part, abs(had[under] - had[pin]), scale)
            self.tell_again(what, under)
        self.groups.append(Group("RPP", links, pin, under, "", (1j * scheme, 1j * scheme), (0.0, 0.0), scheme))

    def _relative(self, what: str, joint: str, outer: str, speed: float, scale: float) -> float:
        """A relative velocity: about a fixed point it is the joint's own, already written down."""
        if self.link_of[outer] == 0:
            return self.say(f"{what}.{joint}{outer}", abs(self.written[f"{what}.{joint}"]))
        return self.measure(f"{what}.{joint}{outer}", abs(speed), scale)

    def tell_again(self, what: str, name: str) -> None:
        """One of velocity and acceleration of a point as it is read from its plan."""
        vector = self.v[name] if what == "v" else self.a[name]
        scale = self.paper.velocity if what == "v" else self.paper.acceleration
        self.measure(f"{what}.{name}", abs(vector), scale)
        self.direct(f"{what}.{name}", vector, scale)

    # --- loads and reactions

    def body(self, link: int, centre: str, mass: float, moment: float | None = None) -> None:
        """A link's inertia force, its couple, and its weight."""
        force, size = self.a[centre], self.say(f"Pqt{link}", mass * self.written[f"a.{centre}"])
        direction = -force / abs(force) if abs(force) > NOTHING else 0j
        couple = 0.0
        if moment is not None:
            couple = -math.copysign(self.say(f"M.Pqt{link}", moment * abs(self.eps[link])), self.eps[link])
        self.loads.append(Load(f"Pqt{link}", link, centre, size * direction, couple))
        if f"G{link}" in self.given:
            self.weight(link, centre)

    def weight(self, link: int, centre: str) -> None:
        self.loads.append(Load(f"G{link}", link, centre, -1j * self.datum(f"G{link}")))

    def force(self, name: str, link: int, point: str, force: complex) -> None:
        self.loads.append(Load(name, link, point, force))

    def torque(self, name: str, link: int, couple: float) -> None:
        self.loads.append(Load(name, link, "", 0j, couple))

    def reactions(self, centre: str, pin: str) -> None:
        """Outermost group first, then the driver."""
        on = [(one.link, one.point, one.force, one.couple) for one in self.loads]
        for group in reversed(self.groups):
            for point, vector in self._of_group(group, on):
                on.append((self.link_of[point], point, vector, 0.0))
        here = [(point, vector, couple) for link, point, vector, couple in on if link == 1]
        total = sum(vector for _, vector, _ in here)
        self.measure("R.01", abs(total), self.paper.force["1"])
        if centre:
            self.say("M.eq", -self._moment(here, self.p[centre]))
        else:
            along = self.v[pin] / abs(self.v[pin])
            self.written.pop("R.01")
            self.measure("R.01", (np.conj(along) * total).imag, self.paper.force["1"])
            pushed = -(np.conj(along) * total).real
            self.measure("R.cb", pushed, self.paper.force["1"])
            self.say("M.eq", math.copysign(self.written["R.cb"], pushed))
        rate = self.omega[1] if centre else abs(self.v[pin])
        self.say("M.vw", -self._power(self.loads) / rate)
        if "unevenness" in self.given:
            static = [one for one in self.loads if not one.name.startswith("Pqt")]
            self.say("M.r", self._power(static) / abs(rate))

    def _power(self, loads: Sequence[Load]) -> float:
        """The power of forces and couples on their points and links."""
        of_forces = sum((np.conj(one.force) * self.v[one.point]).real for one in loads if one.point)
        return float(of_forces + sum(one.couple * self.omega[one.link] for one in loads if one.couple))

    def _moment(self, forces: Sequence[tuple[str, complex, float]], about: complex) -> float:
        return float(
            sum((np.conj(self.p[at] - about) * force).imag if at else 0.0 for at, force, _ in forces)
            + sum(couple for _, _, couple in forces)
        )

    def _of_group(self, group: Group, on: Sequence[tuple[int, str, complex, float]]) -> Iterator[tuple[str, complex]]:
        """The reactions in the joints of a group; gives what it does to the links before it, and at which points."""
        i, j = group.links
        first, second = (
            [(point, vector, couple) for link, point, vector, couple in on if link == number] for number in (i, j)
        )
        k = self.link_of[group.start]
        total = [sum((vector for _, vector, _ in forces), 0j) for forces in (first, second)]
        scale = self.paper.force[f"{i}{j}"]

        def tell(name: str, vector: complex) -> complex:
            """A reaction as it is measured, in the direction in which it was drawn."""
            size = self.measure(f"R.{name}", abs(vector), scale)
            return vector * size / abs(vector) if abs(vector) > NOTHING else vector

        if group.kind in ("RRR", "RRP"):
            joint = self.p[group.joint]
            e, f = group.along
            tangential = self._tangential(f"{k}{i}", first, joint, group.lengths[0])
            known = sum(total) + tangential * 1j * e
            if group.kind == "RRR":
                outer = self.link_of[group.end]
                other = self._tangential(f"{outer}{j}", second, joint, group.lengths[1])
                known += other * 1j * f
                normal = _solve(e, f, -known)
                there = tell(f"{outer}{j}", normal[1] * f + other * 1j * f)
                if outer:
                    yield group.end, -there
            else:
                normal = _solve(e, 1j * group.scheme, -known)
                tell(f"0{j}", normal[1] * 1j * group.scheme)
            here = normal[0] * e + tangential * 1j * e
            tell(f"{j}{i}", -(total[0] + here))
            here = tell(f"{k}{i}", here)
        elif group.kind == "RPR":
            along, pivot = group.along[0], self.p[group.end]
            across = self.say(f"R.{i}{j}.s", self._moment(second, pivot) / group.lengths[0])
            pushed = -across * 1j * along
            tell(f"0{j}", -(total[1] + pushed))
            self.say(f"R.{j}{i}", abs(across))
            here = tell(f"{k}{i}", pushed - total[0])
        else:
            u = group.scheme
            across = (np.conj(u) * total[1]).real * u
            tell(f"0{j}", -(total[1] - across))
            tell(f"{j}{i}", across)
            pushed = -across * self.say(f"R.{i}{j}", self.written[f"R.{j}{i}"]) / (abs(across) or 1.0)
            here = tell(f"{k}{i}", -across - total[0])
            forces = [*second, (group.joint, pushed, 0.0)]
            # The moment that the guide's reaction balances, about the point of the yoke on the guide's line.
            self.say(f"M.0{j}", self._moment(forces, self.p["B"]))
        self.say(f"R.{i}{k}", abs(here))
        yield group.start, -here * self.written[f"R.{i}{k}"] / (abs(here) or 1.0)

    def _tangential(
        self, name: str, forces: Sequence[tuple[str, complex, float]], joint: complex, length: float
    ) -> float:
        """R^t in an outer joint by moments about the inner one, along the rod turned by 90° anticlockwise."""
        if not forces:
            return 0.0
        return self.say(f"R.{name}.t", self._moment(forces, joint) / length)


def _solve(one: complex, other: complex, known: complex) -> tuple[float, float]:
    """The real multiples of two vectors that make up a third."""
    area = (np.conj(one) * other).imag
    return float((np.conj(known) * other).imag / area), float((np.conj(one) * known).imag / area)


Work = Callable[[Vectors], None]
"""The way through a machine: data, groups, loads, reactions."""
