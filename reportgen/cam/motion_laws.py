"""Laws of motion S(x), x = φ/Φ from 0 to 1, and the motion over a turn of two laws and two dwells (`FollowerMotion`).

A law is written once, as textbook formulas; they evaluate over arrays, and the ledger prints them with its own symbols.
With s = h S the reduced velocity is s′ = ds/dφ = h V/Φ and the reduced acceleration s″ = h A/Φ².
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from reportgen.base.arrays import Floats
from reportgen.base.records import Record
from reportgen.formula import PI, Expression, Negative, Operand, Ref, as_expression, cos, sin
from reportgen.formula.evaluation import evaluate

LawFormula = Callable[[Expression], Operand]
NODE = 1e-12
"""Places of a turn (rad), or of a law, that are no farther apart coincide."""
JUMP = 1e-9
"""A smaller jump of V or A is ignored."""


class Piece(Record):
    """S, V and A as formulas of x, from x = `start` to `stop`; `node` is the index of a table's node, otherwise −1."""

    start: float
    stop: float
    S: LawFormula
    V: LawFormula
    A: LawFormula
    node: int = -1


Pieces = tuple[Piece, ...]
NodeQuantity = Callable[[str, int], Operand]
"""Name of a value of a node: A, V, S or J."""


class AccelerationGraph(Record, dict=True):
    """An acceleration graph: ordinates `a` [K] over `x` [K] from 0 to 1, linear in between; a repeated x is a jump.

    It is integrated twice and scaled to end at S = 1: A = c·a, with V and S at each node [K].
    """

    x: Floats
    a: Floats

    @cached_property
    def nodes(self) -> tuple[Floats, Floats, Floats]:
        """Return A, V and S at the nodes, each [K], dimensionless."""
        V, S = _integrated(self.x, self.a)
        return self.a / S[-1], V / S[-1], S / S[-1]

    @property
    def displacement(self) -> float:
        """Return the displacement of the unscaled graph, dimensionless; negative if it is backwards."""
        return float(_integrated(self.x, self.a)[1][-1])

    @property
    def areas(self) -> tuple[float, float]:
        """Return the areas above and below the axis, dimensionless; they must be equal for the follower to come to
        rest.
        """
        parts = _areas(self.x, self.a)
        return float(parts[parts > 0].sum()), float(-parts[parts < 0].sum())

    @property
    def slopes(self) -> Floats:
        """Return the slopes of A from each node to the next [K − 1]; 0 where it jumps."""
        Δ = np.diff(self.x)
        return np.divide(np.diff(self.nodes[0]), Δ, out=np.zeros(Δ.size), where=Δ > NODE)

    def pieces(
        self, named: NodeQuantity | None = None, beyond: Callable[[Expression, int], Expression] | None = None
    ) -> Pieces:
        """Return a cubic S between each two nodes.

        `named` gives the values at nodes as the ledger names them, `beyond` the distance x − xᵢ.
        """
        A, V, S = self.nodes
        values = {"A": A, "V": V, "S": S, "J": self.slopes}
        at = named or (lambda what, i: float(values[what][i]))
        from_node = beyond or (lambda x, i: x - float(self.x[i]))
        return tuple(
            _cubic(i, float(self.x[i]), float(self.x[i + 1]), at, from_node)
            for i in range(len(self.x) - 1)
            if self.x[i + 1] - self.x[i] > NODE
        )


def _crossing(start: tuple[float, float], end: tuple[float, float]) -> Floats:
    """Return the place where a straight piece of a graph crosses the axis, as an array of at most one value."""
    (x0, a0), (x1, a1) = start, end
    return np.array([x0 + (x1 - x0) * a0 / (a0 - a1)] if a0 * a1 < 0 and x1 > x0 else [])


def _areas(x: Floats, a: Floats) -> Floats:
    """Return the areas below a graph with jumps; each straight piece is split where it crosses the axis."""
    parts: list[float] = []
    for start, end in pairwise(zip(x, a, strict=True)):
        corners = [start, *((float(at), 0.0) for at in _crossing(start, end)), end]
        parts += [(q[0] - p[0]) * (p[1] + q[1]) / 2 for p, q in pairwise(corners)]
    return np.array(parts)


def _integrated(x: Floats, a: Floats) -> tuple[Floats, Floats]:
    """Return V and S [K] at the nodes of a graph of A: V grows by (A₁ + A₂)Δ/2 to the next node, S by VΔ + (2A₁ +
    A₂)Δ²/6.
    """
    Δ = np.diff(x)
    V = np.concatenate(([0.0], np.cumsum((a[1:] + a[:-1]) * Δ / 2)))
    return V, np.concatenate(([0.0], np.cumsum(V[:-1] * Δ + (2 * a[:-1] + a[1:]) * Δ**2 / 6)))


def _cubic(
    i: int, start: float, stop: float, at: NodeQuantity, beyond: Callable[[Expression, int], Expression]
) -> Piece:
    """Return the piece behind node i: with z = x − xᵢ it is A = Aᵢ + Jᵢz, and V and S are its integrals."""

    def S(x: Expression) -> Operand:
        z = beyond(x, i)
        return as_expression(at("S", i)) + at("V", i) * z + at("A", i) * z**2 / 2 + at("J", i) * z**3 / 6

    def V(x: Expression) -> Operand:
        z = beyond(x, i)
        return as_expression(at("V", i)) + at("A", i) * z + at("J", i) * z**2 / 2

    def acceleration(x: Expression) -> Operand:
        return as_expression(at("A", i)) + at("J", i) * beyond(x, i)

    return Piece(start, stop, S, V, acceleration, i)


TRAPEZIUM = AccelerationGraph(np.array([0, 1, 3, 5, 7, 8]) / 8, np.array([0.0, 1, 1, -1, -1, 0]))
"""Trapezoidal acceleration: it rises and falls within an eighth of Φ each."""

SMOOTH: dict[str, tuple[Piece, ...]] = {
    "uniform": (Piece(0, 1, lambda x: x, lambda _: 1.0, lambda _: 0.0),),
    "parabolic": (
        Piece(0, 0.5, lambda x: 2 * x**2, lambda x: 4 * x, lambda _: 4.0),
        Piece(0.5, 1, lambda x: 1 - 2 * (1 - x) ** 2, lambda x: 4 * (1 - x), lambda _: -4.0),
    ),
    "cosine": (
        Piece(0, 1, lambda x: (1 - cos(PI * x)) / 2, lambda x: PI / 2 * sin(PI * x), lambda x: PI**2 / 2 * cos(PI * x)),
    ),
    "sine": (
        Piece(
            0,
            1,
            lambda x: x - sin(2 * PI * x) / (2 * PI),
            lambda x: 1 - cos(2 * PI * x),
            lambda x: 2 * PI * sin(2 * PI * x),
        ),
    ),
    "3-4-5": (
        Piece(
            0,
            1,
            lambda x: 10 * x**3 - 15 * x**4 + 6 * x**5,
            lambda x: 30 * x**2 - 60 * x**3 + 30 * x**4,
            lambda x: 60 * x - 180 * x**2 + 120 * x**3,
        ),
    ),
    "4-5-6-7": (
        Piece(
            0,
            1,
            lambda x: 35 * x**4 - 84 * x**5 + 70 * x**6 - 20 * x**7,
            lambda x: 140 * x**3 - 420 * x**4 + 420 * x**5 - 140 * x**6,
            lambda x: 420 * x**2 - 1680 * x**3 + 2100 * x**4 - 840 * x**5,
        ),
    ),
}
LAWS = (*SMOOTH, "trapezoidal")


def graph_of_displacements(x: Floats, s: Floats) -> AccelerationGraph:
    """Return the acceleration of the cubic spline through displacements `s` [K] over x [K] from 0 to 1.

    Equal neighbours are a dwell.  Each stretch between dwells begins and ends with V = 0, and A jumps there.
    """
    at, a = [float(x[0])], [0.0]
    for rests, first, last in _stretches_of(s):
        inside = np.zeros(last - first + 1) if rests else _spline(x[first : last + 1], s[first : last + 1])
        # At the beginning of the next stretch, A jumps to its own value.
        kept = [float(one) for one in inside]
        if kept[0] == a[-1] or len(at) == 1:
            at, a = at[:-1], a[:-1]
        at, a = [*at, *map(float, x[first : last + 1])], [*a, *kept]
    return AccelerationGraph(np.array(at), np.array(a))


def _stretches_of(s: Floats) -> Iterator[tuple[bool, int, int]]:
    """Yield the stretches of a table that rest or move, by the indices of their first and last nodes."""
    rests = np.diff(s) == 0
    first = 0
    for i in range(1, len(s)):
        if i == len(s) - 1 or rests[i] != rests[i - 1]:
            yield bool(rests[i - 1]), first, i
            first = i


def _spline(x: Floats, s: Floats) -> Floats:
    """Return the second derivatives at the nodes [K] of the cubic spline that begins and ends with derivative 0."""
    Δ, slope = np.diff(x), np.diff(s) / np.diff(x)
    matrix = np.diag(np.concatenate(([2 * Δ[0]], 2 * (Δ[1:] + Δ[:-1]), [2 * Δ[-1]])))
    matrix += np.diag(Δ, 1) + np.diag(Δ, -1)
    return np.linalg.solve(matrix, 6 * np.diff(np.concatenate(([0.0], slope, [0.0]))))


class Segment(Record):
    """A part of a law from x = `start` to `stop`, where S goes from `low` to `high` by a law of `SMOOTH`, or rests."""

    start: float
    stop: float
    low: float
    high: float
    law: str = ""

    @property
    def pieces(self) -> Pieces:
        """The pieces of the law, shortened to the segment."""
        if not self.law:
            return (Piece(self.start, self.stop, lambda _: self.low, lambda _: 0.0, lambda _: 0.0),)
        return tuple(self._shortened(piece) for piece in SMOOTH[self.law])

    def _shortened(self, piece: Piece) -> Piece:
        return Piece(
            self._along(piece.start),
            self._along(piece.stop),
            lambda x: self._lifted(piece.S(self._share(x))),
            lambda x: self._rate(piece.V(self._share(x)), 1),
            lambda x: self._rate(piece.A(self._share(x)), 2),
        )

    @property
    def length(self) -> float:
        return round(self.stop - self.start, 12)

    @property
    def lift(self) -> float:
        return round(self.high - self.low, 12)

    def _along(self, share: float) -> float:
        return self.start + share * self.length if share < 1 else self.stop

    def _share(self, x: Expression) -> Expression:
        passed = x - self.start if self.start else x
        return passed / self.length if self.length < 1 else passed

    def _lifted(self, S: Operand) -> Operand:
        risen = self.lift * S if self.lift < 1 else S
        return self.low + risen if self.low else risen

    def _rate(self, rate: Operand, order: int) -> Operand:
        """Return V (`order` 1) or A (2) of the law over the segment's share of x, as a derivative with respect to x."""
        if not isinstance(rate, Expression):
            return float(f"{self.lift * rate / self.length**order:.12g}")
        over = self.lift * rate if self.lift < 1 else rate
        if self.length == 1:
            return over
        return over / self.length if order == 1 else over / as_expression(self.length) ** 2


class FollowerLaw(Record, dict=True):
    """A law by its name, its acceleration table or its segments; its `pieces` follow one another from 0 to 1."""

    name: str
    table: AccelerationGraph | None = None
    segments: tuple[Segment, ...] = ()

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        if self.segments:
            return tuple(piece for segment in self.segments for piece in segment.pieces)
        return self.table.pieces() if self.table is not None else SMOOTH[self.name]

    def __call__(self, x: Floats) -> tuple[Floats, Floats, Floats]:
        """Return S, V and A over x [N], dimensionless; at a corner the values behind it."""
        SVA = np.empty((3, x.size))
        stops = [piece.stop for piece in self.pieces[:-1]]
        inside = np.searchsorted(stops, x, side="right")
        for number, piece in enumerate(self.pieces):
            here = inside == number
            SVA[:, here] = [evaluated(of, x[here]) for of in (piece.S, piece.V, piece.A)]
        return SVA[0], SVA[1], SVA[2]


def evaluated(of: LawFormula, x: Floats) -> Floats:
    """Return the values of a formula over x [N], dimensionless."""
    formula = of(Ref("x"))
    return np.broadcast_to(formula if isinstance(formula, float) else evaluate(formula, {"x": x}), x.shape)


def law(name: str) -> FollowerLaw:
    """Return a law of `LAWS`.

    Raises `KeyError` for any other name.
    """
    if name not in LAWS:
        raise KeyError(name)
    return FollowerLaw(name, TRAPEZIUM if name == "trapezoidal" else None)


# --- a turn ---------------------------------------------------------------------------------------

PHASES = ("rise", "far", "return", "near")


class LawInterval(Record, dict=True):
    """A piece of a turn (rad) in a phase, moving by a `piece` of its law; None in a dwell."""

    phase: str
    start: float
    stop: float
    begin: float
    angle: float
    """Beginning and length of its phase (rad)."""
    piece: Piece | None

    def x(self, φ: Floats) -> Floats:
        """Return the share x of its phase at angles [N] (rad)."""
        return (φ - self.begin) / self.angle

    @cached_property
    def own(self) -> tuple[Expression, ...]:
        """Return s, s′ and s″ by x, Φ (rad) and h (SI)."""
        x, Φ, h = Ref("x"), Ref("Φ"), Ref("h")
        return tuple(map(as_expression, self.formulas(x, Φ, h, h)))

    def formulas(self, x: Expression, Φ: Operand, h: Expression, of_rates: Expression) -> tuple[Operand, ...]:
        """Return s, s′ and s″ by the names of stroke, phase angle (rad) and x; rates use the stroke as an arc,
        `of_rates`.
        """
        match self.phase, self.piece:
            case "rise", Piece(S=S, V=V, A=A):
                return _scaled(h, S(x)), _scaled(of_rates / Φ, V(x)), _scaled(of_rates / Φ**2, A(x))
            case "return", Piece(S=S, V=V, A=A):
                return h - _scaled(h, S(x)), _scaled(-(of_rates / Φ), V(x)), _scaled(-(of_rates / Φ**2), A(x))
            case "far", _:
                return h, 0.0, 0.0
        return 0.0, 0.0, 0.0


def _scaled(rate: Expression, by: Operand) -> Operand:
    """Return a rate times a factor, with a numeric factor written in front."""
    if not isinstance(by, float):
        return rate * by
    if by < 0:
        return _scaled(rate.of if isinstance(rate, Negative) else -rate, -by)
    return 0.0 if by == 0 else rate if by == 1 else _numbered(by, rate)


def _numbered(by: float, rate: Expression) -> Expression:
    return -(by * rate.of) if isinstance(rate, Negative) else by * rate


class Impact(Record):
    """A jump of velocity (rigid) or acceleration (soft) at a cam angle (rad), with its size in s′ or s″."""

    kind: str
    angle: float
    jump: float


class FollowerMotion(Record, dict=True):
    """The follower's motion s(φ) over a turn: stroke (m or rad), phase angles (rad), laws of rise and return."""

    stroke: float
    phases: tuple[float, float, float, float]
    rise: FollowerLaw
    back: FollowerLaw

    @cached_property
    def starts(self) -> dict[str, float]:
        """Return the beginnings of the phases (rad)."""
        return dict(zip(PHASES, np.concatenate(([0.0], np.cumsum(self.phases[:3]))).tolist(), strict=True))

    @cached_property
    def intervals(self) -> tuple[LawInterval, ...]:
        return tuple(self._stretches())

    def _stretches(self) -> Iterator[LawInterval]:
        for phase, angle in zip(PHASES, self.phases, strict=True):
            begin = self.starts[phase]
            law = {"rise": self.rise, "return": self.back}.get(phase)
            pieces: Sequence[Piece | None] = law.pieces if law else (None,)
            for piece in pieces if angle > NODE else ():
                start, stop = (piece.start, piece.stop) if piece else (0.0, 1.0)
                yield LawInterval(phase, begin + start * angle, begin + stop * angle, begin, angle, piece)

    def of(self, φ: Floats) -> NDArray[np.intp]:
        """Return the index of the interval of each angle [N] (rad); the ends of a moving phase belong to it."""
        φ = np.mod(φ, 2 * math.pi)
        starts = np.array([one.start for one in self.intervals])
        number = np.searchsorted(starts - NODE, φ, side="right") - 1
        still = np.array([one.piece is None for one in self.intervals])
        at_start = np.abs(φ - starts[number]) <= NODE
        before = number - 1
        corner = at_start & (number > 0) & still[number] & ~still[before]
        return np.where(corner, before, number)

    def __call__(
        self, φ: Floats, of: NDArray[np.intp] | None = None, derivatives: int = 2
    ) -> tuple[Floats, Floats, Floats]:
        """Return s, s′ and s″ (m or rad) over cam angles [N] (rad); `of` [N] forces the interval of each.

        Beyond the number of `derivatives`, the results are 0.
        """
        numbers = self.of(φ) if of is None else of
        turned = φ if of is not None else np.mod(φ, 2 * math.pi)
        motion = np.zeros((3, φ.size))
        for number, interval in enumerate(self.intervals):
            here = numbers == number
            if here.any():
                values = {"x": interval.x(turned[here]), "Φ": interval.angle, "h": self.stroke}
                for row, formula in zip(motion[: derivatives + 1], interval.own[: derivatives + 1], strict=True):
                    row[here] = evaluate(formula, values)
        return motion[0], motion[1], motion[2]

    @cached_property
    def impacts(self) -> tuple[Impact, ...]:
        """Return the places where the velocity or the acceleration jumps."""
        impacts = []
        numbers = np.arange(len(self.intervals))
        stops = np.array([one.stop for one in self.intervals])
        starts = np.array([one.start for one in self.intervals])
        _, V_end, A_end = self(stops, numbers)
        _, V_begin, A_begin = self(starts, numbers)
        for number in numbers:
            behind = (number + 1) % len(numbers)
            angle = float(np.mod(stops[number], 2 * math.pi))
            for kind, end, begin in (("rigid", V_end, V_begin), ("soft", A_end, A_begin)):
                jump = float(begin[behind] - end[number])
                if abs(jump) > JUMP * self.stroke:
                    impacts.append(Impact(kind, 0.0 if 2 * math.pi - angle < NODE else angle, jump))
                    break
        return tuple(sorted(impacts, key=lambda one: one.angle))
