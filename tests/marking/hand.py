"""A student who works out a slider-crank machine by hand: own formulas, own drawing, own rounding.

A plan is drawn on paper in complex numbers (m), everything else by the textbook's formulas.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from tests.marking.written import Student


@dataclass(frozen=True)
class Rod:
    """One rod with its slider: letters and links, how far its pin is ahead of the first, and what is on the slider.

    `force` (N) acts along the guide, positive away from the crank's centre; `pressure` (Pa, positive towards it) is
    read from a diagram instead, of which area `F` makes the force.
    """

    pin: str
    end: str
    centre: str
    links: tuple[int, int]
    ahead: float
    pressure: float | None = None
    force: float = 0.0


@dataclass(frozen=True)
class Task:
    """What the student is given (SI); `scheme` is the direction of the line along which the sliders move."""

    given: Mapping[str, float]
    rods: tuple[Rod, ...]
    angle: float
    """Of the first crank pin, from the guide."""
    scheme: complex = 1j
    crank: str = "O1A"
    turn: int = 1


@dataclass
class Hand(Student):
    """One position of a task worked out by drawing; `left_out` and `turned` are forces of the plans.

    `paper` is the drawn crank and `force_scale` the scale of the force plans (N to a metre on paper); the scales of the
    plans of velocity and acceleration are chosen (`plan_scales`, SI), or v_A/pa `by_lengths`, or ω μ_l.
    """

    task: Task
    left_out: frozenset[str] = frozenset()
    turned: frozenset[str] = frozenset()
    paper: float = 0.05
    force_scale: float | Mapping[str, float] = 1e5
    plan_scales: Mapping[str, float] = field(default_factory=dict)
    by_lengths: bool = True

    def __post_init__(self) -> None:
        super().__post_init__()
        self._work()

    # --- writing and reading

    def read(self, point: complex) -> complex:
        """A drawn point as it is measured."""
        beside = self.rng.uniform(0, self.blunt) * np.exp(1j * self.rng.uniform(0, 2 * np.pi))
        return complex(point + beside)

    def scale_of(self, plan: str) -> float:
        """The scale chosen for a force plan, freely and without a mistake."""
        scale = self.force_scale if isinstance(self.force_scale, float) else self.force_scale[plan]
        self.written[f"mu.R{plan}"] = scale / 1e3
        return scale

    # --- the work

    def _work(self) -> None:
        given, task = dict(self.task.given), self.task
        for id in given.keys() & self.changes.keys():
            given[id] = self.changes[id](given[id])
        self.given = given
        self.omega = given["omega.1"] if "omega.1" in given else self.say("omega.1", 2 * np.pi * given["n"] / 60)
        if "H" in given:
            self.R = self.say("R", given["H"] / 2)
            self.L = self.say("L", self.R / given["lambda"])
            self.cranks = [self.say(f"l.{task.crank[:-1]}{rod.pin}", self.R) for rod in task.rods]
            self.lengths = {rod: self.say(f"l.{rod.pin}{rod.end}", self.L) for rod in task.rods}
            self.area = self.say("F", np.pi * given["D"] ** 2 / 4)
        else:
            self.R, self.L = given["R"], given["L"]
            self.cranks, self.lengths = [self.R], dict.fromkeys(task.rods, self.L)
        self.masses: dict[int, float] = {}
        for number in sorted({link for rod in task.rods for link in rod.links}):
            weight = given.get(f"G{number}")
            if weight is None:
                weight = self.say(f"G{number}", given[f"G{number - 2}"])
                given[f"G{number}"] = weight
            self.masses[number] = self.say(f"m.{number}", weight / given["g"])
        self.shares = {rod: self.say(f"l.{rod.pin}{rod.centre}", given["s"] * self.L) for rod in task.rods}
        self.moments = {
            rod: self.say(f"J.{rod.links[0]}", self.masses[rod.links[0]] * self.L**2 / 12) for rod in task.rods
        }
        self.written[f"drawn.{task.crank}"] = self.paper * 1e3
        self.mu_l = self.say("mu.l", self.cranks[0] / self.paper)
        first = task.rods[0].pin.lower()
        self.v = self.say(f"v.{task.rods[0].pin}", self.omega * self.cranks[0])
        self.mu_v, pa_v = self._plan("v", first, self.v, self.omega)
        self.a = self.say(f"a.{task.rods[0].pin}", self.omega**2 * self.cranks[0])
        self.mu_a, pa_a = self._plan("a", first, self.a, self.omega**2)
        # How much larger than the crank its images are.
        self.larger = pa_v / self.paper, pa_a / self.paper
        self.drawn = [self.paper]
        self.speeds = [self.v]
        for rod, crank in zip(task.rods[1:], self.cranks[1:], strict=True):
            pin = rod.pin
            self.drawn.append(self.say(f"drawn.{task.crank[:-1]}{pin}", crank / self.mu_l))
            # What the first pin has, so has one as far from the centre.
            v, a = (self.v, self.a) if self.by_lengths else (self.omega * crank, self.omega**2 * crank)
            v, a = self.say(f"v.{pin}", v), self.say(f"a.{pin}", a)
            self.speeds.append(v)
            self.say(f"seg.v.p{pin.lower()}", v / self.mu_v)
            self.say(f"seg.a.p{pin.lower()}", a / self.mu_a)
        done = [_Side(self, rod) for rod in task.rods]
        on_crank = [side.reactions() for side in reversed(done)][::-1]
        self._crank(done, on_crank)

    def _plan(self, what: str, pin: str, value: float, rate: float) -> tuple[float, float]:
        """The scale of a plan and the length in it that stands for the crank pin's velocity or acceleration."""
        length = f"seg.{what}.p{pin}"
        if what in self.plan_scales:
            scale = self.plan_scales[what]
            self.written[f"mu.{what}"] = scale / 1e3
            return scale, self.say(length, value / scale)
        self.written[length] = self.paper * 1e3
        return self.say(f"mu.{what}", value / self.paper if self.by_lengths else rate * self.mu_l), self.paper

    def _crank(self, sides: list[_Side], forces: list[complex]) -> None:
        """M_cb by the crank's moments and by Zhukovsky's lever, and the reaction in the bearing."""
        moment, total, μ = 0.0, 0j, self.scale_of("1")
        for side, force in zip(sides, forces, strict=True):
            digits = f"{side.rod.links[0]}1"
            size = self.say(f"R.{digits}", abs(force))
            centre = self.task.crank[:-1]
            h = self.arm(f"h.R{digits}.{centre}", side.A, force, 0j, 0.0)
            moment += size * h * self.mu_l
            total += self.say(f"seg.1.R{digits}", size / μ) * force / abs(force)
        self.say("M.eq", -moment)
        drawn = self.say("seg.1.R01", abs(self.read(total) - self.read(0j)))
        self.say("R.01", drawn * μ)
        self.direct("R01", -total)
        work, per = 0.0, self.mu_v / self.omega if self.plan_scales else self.mu_l
        for side in sides:
            for name, size, force, image, beside in side.loads():
                h = self.lever(f"h.{name}.p", size, force, image, beside * side.turning / self.mu_v)
                work += self.say(f"M.{name}.p", size * h * per)
        self.say("M.vw", -work)

    def arm(self, id: str, at: complex, force: complex, about: complex, beside: float) -> float:
        """The arm (m on paper, signed) of a force moved `beside` its point (m), measured on the drawn mechanism."""
        if abs(force) == 0:
            return 0.0
        h = (np.conj(at - about) * force).imag / abs(force) + beside / self.mu_l
        return self._measured(id, float(h))

    def lever(self, id: str, size: float, force: complex, image: complex, turned: float) -> float:
        """The arm of a force about the pole of the velocity plan turned by 90° against ω₁."""
        if size == 0:
            return 0.0
        return self._measured(id, float(self.task.turn * ((np.conj(force) * image).real / size + turned)))

    def _measured(self, id: str, h: float) -> float:
        return math.copysign(self.measure(id, h), h)


class _Side:
    """One rod with its slider: drawn, then its plans, its closed formulas, its loads and its reactions."""

    def __init__(self, hand: Hand, rod: Rod) -> None:
        self.hand, self.rod = hand, rod
        task, say, read = hand.task, hand.say, hand.read
        i, j = rod.links
        pin, end, centre = rod.pin, rod.end, rod.centre
        p, e, s = pin.lower(), end.lower(), centre.lower()
        angle = task.angle + task.turn * rod.ahead
        # The mechanism on paper, by the drawn lengths.
        AB = say(f"drawn.{pin}{end}", hand.lengths[rod] / hand.mu_l)
        AS = say(f"drawn.{pin}{centre}", hand.shares[rod] / hand.mu_l)
        u = task.scheme
        number = task.rods.index(rod)
        crank, self.v = hand.drawn[number], hand.speeds[number]
        self.length = hand.lengths[rod]
        self.A = A = crank * u * np.exp(1j * angle)
        across = (np.conj(u) * A).imag
        self.B = B = u * ((np.conj(u) * A).real + math.sqrt(AB**2 - across**2))
        along = (B - A) / abs(B - A)
        self.S, self.along = A + AS * along, along
        # Velocities.
        a1 = task.turn * 1j * A * hand.larger[0]
        b1 = _meet(a1, 1j * along, 0j, u)
        ab = say(f"seg.v.{p}{e}", abs(read(b1) - read(a1)))
        v_BA = say(f"v.{end}{pin}", hand.mu_v * ab)
        sense = float(np.sign((np.conj(along) * (b1 - a1)).imag))
        self.omega = abs(say(f"turn.omega.{i}", sense * v_BA / self.length))
        self.turning = sense * self.omega
        v_B = say(f"v.{end}", hand.mu_v * say(f"seg.v.p{e}", abs(read(b1))))
        hand.direct(f"v.{end}", b1)
        as2 = say(f"seg.v.{p}{s}", hand.shares[rod] / self.length * ab)
        s1 = a1 + as2 * (b1 - a1) / abs(b1 - a1)
        self.b1, self.s1 = b1, s1
        say(f"v.{centre}", hand.mu_v * say(f"seg.v.p{s}", abs(read(s1))))
        hand.direct(f"v.{centre}", s1)
        # Accelerations.
        a2 = -A * hand.larger[1]
        normal = say(f"seg.a.n.{end}{pin}", say(f"a.{end}{pin}.n", v_BA**2 / self.length) / hand.mu_a)
        n2 = a2 if f"n.{end}{pin}" in hand.left_out else a2 - normal * along
        b2 = _meet(n2, 1j * along, 0j, u)
        tangential = say(f"a.{end}{pin}.t", hand.mu_a * say(f"seg.a.t.{end}{pin}", abs(read(b2) - read(n2))))
        turning = float(np.sign((np.conj(along) * (b2 - n2)).imag))
        self.eps = turning * abs(say(f"turn.eps.{i}", turning * tangential / self.length))
        a_B = say(f"a.{end}", hand.mu_a * say(f"seg.a.p{e}", abs(read(b2))))
        hand.direct(f"a.{end}", b2)
        whole = say(f"seg.a.{p}{e}", abs(read(b2) - read(a2)))
        part = say(f"seg.a.{p}{s}", hand.shares[rod] / self.length * whole)
        s2 = a2 + part * (b2 - a2) / abs(b2 - a2)
        a_S = say(f"a.{centre}", hand.mu_a * say(f"seg.a.p{s}", abs(read(s2))))
        hand.direct(f"a.{centre}", s2)
        self._centre_of_velocity(v_B)
        self._formulas(angle)
        # Loads.
        self.size: dict[str, float] = {}
        self.force: dict[str, complex] = {}
        self._load(f"Pqt{i}", say(f"Pqt{i}", hand.masses[i] * a_S), -s2 / abs(s2))
        couple = say(f"M.Pqt{i}", hand.moments[rod] * abs(self.eps))
        self.beside = math.copysign(say(f"e.Pqt{i}", couple / self.size[f"Pqt{i}"]), -self.eps)
        say(f"l.{centre}K{i}", hand.moments[rod] / (hand.masses[i] * hand.shares[rod]))
        self._load(f"Pqt{j}", say(f"Pqt{j}", hand.masses[j] * a_B), -b2 / abs(b2))
        self._load(f"G{i}", hand.given[f"G{i}"], -1j)
        self._load(f"G{j}", hand.given[f"G{j}"], -1j)
        say(f"s.{j}", hand.mu_l * abs(read(u * (crank + AB)) - read(B)))
        if rod.pressure is not None:
            pressure = say(f"p.{j}", rod.pressure)
            self._load(f"P{j}", say(f"P{j}", pressure * hand.area), -u)
        else:
            self._load(f"P{j}", say(f"P{j}", rod.force), u)

    def _load(self, name: str, size: float, direction: complex) -> None:
        self.size[name], self.force[name] = size, size * direction

    def _centre_of_velocity(self, v_B: float) -> None:
        hand, rod, i = self.hand, self.rod, self.rod.links[0]
        u, A, B = hand.task.scheme, self.A, self.B
        P = _meet(0j, A, B, 1j * u)
        PA, PB = abs(hand.read(P) - hand.read(A)), abs(hand.read(P) - hand.read(B))
        if 0.002 <= PA <= 0.3 and PB <= 0.3:
            PA, PB = hand.say(f"ic.seg.{i}.{rod.pin}", PA), hand.say(f"ic.seg.{i}.{rod.end}", PB)
            hand.say(f"ic.omega.{i}", self.v / (hand.mu_l * PA))
            hand.say(f"ic.v.{i}", self.v * PB / PA)
        for name, vector, size in ((rod.pin, hand.task.turn * 1j * A, self.v), (rod.end, self.b1, v_B)):
            turned = abs(float(np.angle(vector / self.along)))
            noise = hand.rng.uniform(-hand.blunt, hand.blunt, 2).sum() / hand.paper
            psi = hand.say(f"ic.angle.{i}.{name}", min(max(turned + noise, 0.0), np.pi))
            hand.say(f"ic.along.{i}.{name}", size * math.cos(psi))

    def _formulas(self, angle: float) -> None:
        """The closed formulas of an engine; φ from the top in the sense of rotation."""
        hand, rod = self.hand, self.rod
        if rod.pressure is None:
            return
        (i, j), end, say, R, L, ω = rod.links, rod.end, hand.say, hand.R, hand.L, hand.omega
        φ, λ = hand.task.turn * angle, hand.given["lambda"]
        β = say(f"beta.{i}", math.asin(λ * math.sin(φ)))
        say(f"x.{j}", R * (1 - math.cos(φ)) + L * (1 - math.cos(β)))
        say(f"f.v.{end}", ω * R * math.sin(φ + β) / math.cos(β))
        # β grows as the rod turns against the crank; ω and ε are positive anticlockwise.
        against = -hand.task.turn
        turning = against * say(f"f.omega.{i}", against * λ * ω * math.cos(φ) / math.cos(β))
        a = ω**2 * R * (math.cos(φ + β) / math.cos(β) + λ * math.cos(φ) ** 2 / math.cos(β) ** 3)
        say(f"f.a.{end}", a)
        growing = -(ω**2) * λ * (1 - λ**2) * math.sin(φ) / math.cos(β) ** 3
        rising = against * say(f"f.eps.{i}", against * growing)
        to_S, S = hand.shares[rod], rod.centre
        vx = say(f"f.x.{S}.v", (1 - to_S / L) * ω * R * math.cos(φ))
        vy = say(f"f.y.{S}.v", -ω * R * math.sin(φ) - turning * to_S * math.sin(β))
        say(f"f.v.{S}", math.hypot(vx, vy))
        ax = -(1 - to_S / L) * ω**2 * R * math.sin(φ)
        ay = -(ω**2) * R * math.cos(φ) - to_S * (rising * math.sin(β) + turning**2 * math.cos(β))
        say(f"f.a.{S}", math.hypot(say(f"f.x.{S}.a", ax), say(f"f.y.{S}.a", ay)))

    def loads(self) -> list[tuple[str, float, complex, complex, float]]:
        """Name, size, vector, image on the velocity plan and way beside its point of every load."""
        i = self.rod.links[0]
        images = {f"Pqt{i}": self.s1, f"G{i}": self.s1}
        return [
            (name, size, self.force[name], images.get(name, self.b1), self.beside if name == f"Pqt{i}" else 0.0)
            for name, size in self.size.items()
        ]

    def reactions(self) -> complex:
        """The group's reactions by moments about the slider's pin and by the force plan; gives that on the crank."""
        hand, say, read = self.hand, self.hand.say, self.hand.read
        i, j = self.rod.links
        plan, u = f"{i}{j}", hand.task.scheme
        μ = hand.scale_of(plan)
        P, G, end = f"Pqt{i}", f"G{i}", self.rod.end
        h = hand.arm(f"h.{P}.{end}", self.S, self.force[P], self.B, self.beside)
        g = hand.arm(f"h.{G}.{end}", self.S, self.force[G], self.B, 0.0)
        tangential = say(f"R.1{i}.t", (self.size[P] * h + self.size[G] * g) * hand.mu_l / self.length)
        corner, corners = 0j, [0j]
        order = [f"Pqt{j}", f"P{j}", f"G{j}", P, G, f"R1{i}.t"]
        vectors = {**self.force, f"R1{i}.t": tangential * 1j * self.along}
        for name in order:
            length = say(f"seg.{plan}.{name}", abs(vectors[name]) / μ)
            factor = 0.0 if name in hand.left_out else -1.0 if name in hand.turned else 1.0
            corner = corner + factor * length * vectors[name] / (abs(vectors[name]) or 1.0)
            corners.append(corner)
        n = _meet(corner, self.along, 0j, 1j * u)
        points = [read(one) for one in corners]
        read_n = read(n)
        ends = {
            f"R1{i}": (points[5], n - corners[5]),
            f"R1{i}.n": (points[6], n - corners[6]),
            f"R0{j}": (points[0], corners[0] - n),
            f"R{j}{i}": (points[3], corners[3] - n),
        }
        found = {}
        for name, (point, vector) in ends.items():
            found[name] = say(name.replace("R", "R.", 1), μ * say(f"seg.{plan}.{name}", abs(read_n - point)))
            hand.direct(name, vector)
        say(f"x.0{j}", 0.0)
        whole = ends[f"R1{i}"][1]
        return -found[f"R1{i}"] * whole / abs(whole)


def _meet(p: complex, d: complex, q: complex, e: complex) -> complex:
    """Where the line through p along d meets the one through q along e."""
    t = (np.conj(e) * (q - p)).imag / (np.conj(e) * d).imag
    return complex(p + t * d)
