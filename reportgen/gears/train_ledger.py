"""`SolvedTrain`: a planetary train as a ledger: tooth numbers by factors, ratio, conditions, rates, velocity
triangles.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from reportgen.base.units import MM, SERIES, nice_up
from reportgen.case import Misconceptions
from reportgen.case.design_case import DesignCase
from reportgen.formula import PI, Expression, Operand, Product, Ref, Symbol, as_expression, minus, signed, sin, size
from reportgen.formula.calculation import Calculation
from reportgen.formula.vocabulary import KeyChapter
from reportgen.gears import train_formulas as formulas
from reportgen.gears import train_ids
from reportgen.gears.tooth_numbers import CONDITIONS, LEAST_OUTER, SCHEMES, Train, TrainChoice, power_way
from reportgen.gears.train_file import FIRST_ROW_WHEEL, KnownTorque, Parameters, undercut_wheels
from reportgen.gears.train_formulas import OTHER, TrainScheme, term_of

PLAN_HEIGHT, PLAN_WIDTH, RATES_WIDTH = 85.0, 60.0, 110.0
"""Room for radii, velocities and the plan of angular velocities on paper (mm)."""
NEAREST_POLE, FARTHEST_POLE = 2.0, 40.0
"""Least and largest distance of the pole of the plan of angular velocities, if possible (mm)."""
LINES: Mapping[str, tuple[str, ...]] = {
    "wanted": ("train.u",),
    "factors": ("train.factor.e", "train.factor.f"),
    "ratio": ("train.u1H", "train.uH1", "train.off"),
    "coaxial": ("train.a.1", "train.a.2"),
    "neighbours": ("train.gap", "train.room"),
    "conditions": ("train.a.1", "train.a.2", "train.tip", "train.gap", "train.room"),
    "whole": ("train.N",),
    "reached": ("train.n.reached",),
    "plan": ("train.mu.omega",),
    "efficiency": ("train.eta.0", "train.u0", "train.eta.train"),
    "with_rows": ("train.eta.total",),
}
"""Quantities that the report prints together, except those that differ between schemes."""


@dataclass(frozen=True)
class SolvedTrain(DesignCase):
    """An assignment of a planetary train with its ledger; each value is computed on first use."""

    @property
    def given(self) -> Parameters:
        parameters: Parameters = self.assignment.parameters
        return parameters

    @property
    def scheme(self) -> TrainScheme:
        return SCHEMES[self.given.scheme]

    @property
    def choice(self) -> TrainChoice:
        return self.given.choice

    @property
    def train(self) -> Train:
        return self.choice.chosen

    @cached_property
    def calculation(self) -> Calculation:
        return TrainCalculation(self.given).written()

    @property
    def speed(self) -> float:
        """Return the speed of the input shaft (rad/s)."""
        return self.given.n_in.si

    @cached_property
    def misconceptions(self) -> Misconceptions:
        """Return tooth numbers that miss one condition, and mistaken definitions that students often use."""
        z = {wheel: Ref(train_ids.teeth(wheel)) for wheel in ("1", "2", OTHER, "3")}
        term, sign, unity = term_of(self.scheme, z), self.scheme.sign, as_expression(1.0)
        ω1, ωH = (Ref(train_ids.omega(wheel)) for wheel in ("1", "H"))
        driven, inverse = (ω1, ωH * Ref("train.uH1")) if self.given.by_carrier else (ωH, ω1 * Ref("train.u1H"))
        side, turned = self.scheme.signs[0], z["1"] / z["2"]
        module, wheel = larger_satellite(self.train)
        changed: Mapping[str, list[tuple[str, Expression]]] = {
            "train.u1H": [("train-without-one", signed(sign, term)), ("train-ratio-sign", unity + signed(-sign, term))],
            driven.id: [("train-inverse", inverse)],
            train_ids.omega("2"): [
                ("train-carrier-still", signed(side, ω1 * turned)),
                ("train-carrier-added", signed(side, (ω1 - ωH) * turned)),
            ],
            "train.tip": [("train-tips", Ref(module) * z[wheel])],
        }
        readings: dict[str, list[tuple[str, np.ndarray]]] = {}
        for name in reversed(CONDITIONS[1:]):
            if (refused := self.choice.refused.get(name)) is not None:
                for teeth, number in zip(z.values(), refused.teeth, strict=True):
                    if teeth.id in self.ledger:
                        readings.setdefault(teeth.id, []).append((f"train-{name}", np.array([number])))
        return Misconceptions(readings=readings, changed={**changed, **self._wrong_torques})

    @property
    def _wrong_torques(self) -> Mapping[str, list[tuple[str, Expression]]]:
        """Return the mistaken definitions of torques: divided by the ratio, or without the torque of the driver."""
        if self.given.torque is None:
            return {}
        driver, driven = (Ref(train_ids.torque(name)) for name in ("H1" if self.given.by_carrier else "1H"))
        ratio = Ref("train.uH1" if self.given.by_carrier else "train.u1H")
        return {
            driven.id: [("train-torque-inverse", -(driver / ratio))],
            train_ids.torque("3"): [("train-torque-support", -driven)],
        }


def larger_satellite(train: Train) -> tuple[str, str]:
    """Return the ids of the module and the wheel of the satellite with the larger tip circle."""
    z, m = train.teeth, float(train.modules)
    return ("train.m2" if m != 1 else "train.m", OTHER) if z.z2_prime + 2 > m * (z.z2 + 2) else ("train.m", "2")


class TrainCalculation:
    """The calculation of a planetary train while it is filled."""

    def __init__(self, given: Parameters) -> None:
        self.given, self.scheme, self.train = given, SCHEMES[given.scheme], given.choice.chosen
        self.q = Calculation()
        self.z: dict[str, Ref] = {}

    def written(self) -> Calculation:
        with self.q.within(KeyChapter.data):
            self._enter_given()
        with self.q.within(KeyChapter.geometry):
            self._enter_teeth()
            self._enter_ratio()
            self._enter_conditions()
            self._enter_efficiency()
        with self.q.within(KeyChapter.velocity):
            self._enter_rates()
            self._enter_triangles()
        if self.given.torque is not None:
            with self.q.within(KeyChapter.torque):
                self._enter_torques(self.given.torque)
        for name, lines in LINES.items():
            self.q.set_out(name, *lines)
        return self.q

    def _enter_given(self) -> None:
        q, given = self.q, self.given
        n = q.give("train.n.in", given.n_in.value, Symbol("n", "in"), "speed of rotation")
        self.rows: list[tuple[str, Expression]] = []
        for i, row in enumerate((*given.before, *given.behind)):
            first_wheel, second_wheel = str(FIRST_ROW_WHEEL + 2 * i), str(FIRST_ROW_WHEEL + 2 * i + 1)
            for wheel, teeth in zip((first_wheel, second_wheel), row, strict=True):
                self.z[wheel] = q.give(train_ids.teeth(wheel), float(teeth))
            self.rows.append((first_wheel, self.z[second_wheel] / self.z[first_wheel]))
        wanted = Symbol("u", "H1" if given.by_carrier else "1H", "*")
        if given.u is not None:
            q.give("train.u", given.wanted, wanted, "ratio")
        else:
            assert given.n_out is not None, "a check asks for one of them"
            out: Expression = q.give("train.n.out", given.n_out.value, Symbol("n", "out", "*"), "speed of rotation")
            for (_, slower), row in zip(self.rows, (*given.before, *given.behind), strict=True):
                out = out * (slower if min(row) > 0 else size(slower))
            q.define("train.u", n / out, wanted, "ratio")
        q.give("train.k", float(given.k), "k", "count")
        self.m = self.m2 = q.give("train.m", given.m.si, "m", "gear length")
        if self.train.modules != 1:
            self.m2 = q.give("train.m2", given.second_module.si, Symbol("m", "2"), "gear length")

    # --- tooth numbers by factors

    def _enter_teeth(self) -> None:
        """Enter z₁ = A e t, z₂ = B e t, z₂′ = C f t, z₃ = D f t; for a single satellite z₁ = A t, z₃ = D t."""
        q, z, scheme = self.q, self.train.teeth, self.scheme

        def factor(letter: str, value: int) -> Ref:
            # These follow from the student's tooth numbers: they are not data that could be misread.
            return q.give(train_ids.factor(letter), float(value), letter, "count", hidden=True)

        if scheme.single:
            ratio = Fraction(z.z3, z.z1)
            A, D = factor("A", ratio.denominator), factor("D", ratio.numerator)
            t = factor("t", z.z1 // ratio.denominator)
            formulas: dict[str, Expression] = {"1": A * t, "3": D * t, "2": (D - A) * t / 2}
        else:
            first, second = Fraction(z.z2, z.z1), Fraction(z.z3, z.z2_prime)
            numbers = first.denominator, first.numerator, second.denominator, second.numerator
            A, B, C, D = (factor(letter, value) for letter, value in zip("ABCD", numbers, strict=True))
            side1, side2 = scheme.signs
            # Coaxial: m (A ± B) e = m₂ (D ∓ C) f.
            p, r = self.train.modules.numerator, self.train.modules.denominator
            wide, long = p * (numbers[0] - side1 * numbers[1]), r * (numbers[3] - side2 * numbers[2])
            common = math.gcd(wide, long)
            e = self._factor("e", r, D + signed(-side2, C), common)
            f = self._factor("f", p, A + signed(-side1, B), common)
            t = factor("t", z.z1 // (numbers[0] * long // common))
            formulas = {"1": A * e * t, "2": B * e * t, OTHER: C * f * t, "3": D * f * t}
        for wheel, formula in formulas.items():
            self.z[wheel] = q.define(train_ids.teeth(wheel), formula, Symbol("z", wheel))
        q.set_out("teeth", *(self.z[wheel] for wheel in ("1", "2", OTHER, "3") if wheel in formulas))
        self.z.setdefault(OTHER, self.z["2"])

    def _factor(self, letter: str, times: int, of: Expression, over: int) -> Ref:
        whole: Expression = of if times == 1 else times * of
        formula = whole if over == 1 else whole / over
        return self.q.define(train_ids.factor(letter), formula, letter, "count", optional=True)

    # --- ratio

    def _enter_ratio(self) -> None:
        q, given = self.q, self.given
        u = q.define("train.u1H", formulas.ratio(self.scheme, self.z), Symbol("u", "1H"), "ratio")
        if given.by_carrier:
            u = q.define("train.uH1", 1 / u, Symbol("u", "H1"), "ratio")
        self.u = u
        q.define("train.off", (u - q["train.u"]) / q["train.u"], "Δu", "share", scale=1.0, optional=True)
        of_rows = [
            q.define(train_ids.row_ratio(wheel), -slower, Symbol("u", f"{wheel},{int(wheel) + 1}"))
            for wheel, slower in self.rows
        ]
        if of_rows:
            ratios = *of_rows[: len(given.before)], u, *of_rows[len(given.before) :]
            u = q.define("train.total", Product(ratios), Symbol("u", "tot"), "ratio")
            q.set_out("total", *of_rows, u, "train.n.reached")
        q.define("train.n.reached", q["train.n.in"] / u, Symbol("n", "out"), "speed of rotation")

    # --- conditions

    def _enter_conditions(self) -> None:
        q, z = self.q, self.z
        a = self._length("train.a.1", self.m * formulas.first_axes(self.scheme, z) / 2, Symbol("a", "12"))
        far = Symbol("a", "23" if self.scheme.single else f"{OTHER}3")
        self._length("train.a.2", self.m2 * formulas.second_axes(self.scheme, z) / 2, far)
        module, wheel = larger_satellite(self.train)
        tip = self._length("train.tip", formulas.tip_diameter(q[module], z[wheel]), Symbol("d", f"a{wheel}"))
        q.define("train.gap", tip / (2 * a), "q", "ratio")
        k = q["train.k"]
        q.define("train.room", sin(PI / k), Symbol("q", "max"), "ratio")
        if self.scheme.single:
            whole = (z["1"] + z["3"]) / k
        else:
            turns = self.train.turns(self.given.k)
            assert turns is not None, "it can be assembled"
            P = q.give("train.P", float(turns), "P", "count", hidden=True)
            top = Product((z["1"], z[OTHER])) + signed(self.scheme.sign, Product((z["2"], z["3"])))
            whole = (Product((top, 1 + k * P)) if turns else top) / Product((k, z[OTHER]))
        q.define("train.N", whole, "N", "count")
        q.set_out("undercut")
        for wheel in undercut_wheels(self.given, self.train):
            x = q.define(train_ids.least_shift(wheel), (LEAST_OUTER - z[wheel]) / LEAST_OUTER, Symbol("x", wheel))
            q.set_out("undercut", x)

    def _length(self, id: str, formula: Operand, symbol: Symbol) -> Ref:
        return self.q.define(id, formula, symbol, "gear length")

    # --- rates

    def _enter_rates(self) -> None:
        """Enter the rates shaft by shaft from the motor to the machine; wheels on one shaft turn together."""
        q, given, z = self.q, self.given, self.z
        driver, driven = ("H", "1") if given.by_carrier else ("1", "H")
        pairs = [(one, str(int(one) + 1), q[train_ids.row_ratio(one)]) for one, _ in self.rows]
        pairs.insert(len(given.before), (driver, driven, self.u))
        ω: Expression = 2 * PI * q["train.n.in"] / 60
        for driving, driven_wheel, ratio in pairs:
            start = q.define(train_ids.omega(driving), ω)
            ω = end = q.define(train_ids.omega(driven_wheel), start / ratio)
            q.set_out("rates", start, end)
            if driving == driver:
                ω1, ωH = q[train_ids.omega("1")], q[train_ids.omega("H")]
                turned = signed(self.scheme.signs[0], (ω1 - ωH) * z["1"] / z["2"])
                q.set_out("rates", q.define(train_ids.omega("2"), ωH + turned, scale=given.n_in.si))

    # --- triangles of velocities

    def _enter_triangles(self) -> None:
        """Enter the velocity lines over the distance from the axis; parallels to them through a pole cut off ω."""
        q, z, a = self.q, self.z, self.q["train.a.1"]
        r1 = self._length("train.r.1", formulas.reference_radius(self.m, z["1"]), Symbol("r", "1"))
        r3 = self._length("train.r.3", formulas.reference_radius(self.m2, z["3"]), Symbol("r", "3"))
        v = {
            "A": q.define(train_ids.velocity("A"), q[train_ids.omega("1")] * r1),
            "B": q.define(train_ids.velocity("B"), q[train_ids.omega("H")] * a),
        }
        far, fast = max(q.si(r1), q.si(r3), q.si(a)), max(abs(q.si(one)) for one in v.values())
        μl = self._scale("l", nice_up(far * MM / PLAN_HEIGHT), "length on paper")
        μv = self._scale("v", nice_up(fast * MM / PLAN_WIDTH), "velocity on paper")
        at = {
            place: q.si(q.define(train_ids.line(f"O{place}"), size / μl, over(f"O{place}"), "segment", optional=True))
            for place, size in (("A", r1), ("B", a), ("P", r3))
        }
        known, read = ("B", "A") if self.given.by_carrier else ("A", "B")
        drawn = q.define(
            train_ids.line(known), v[known] / μv, over(f"{known}{known.lower()}"), "segment", optional=True
        )
        q.set_out("velocities", r1, r3, v[known])
        q.set_out("laid_off", *(train_ids.line(f"O{place}") for place in at), drawn)
        length = {known: q.si(drawn)}
        length[read] = length[known] * (at[read] - at["P"]) / (at[known] - at["P"])
        self._measured(train_ids.line(read), length[read], over(f"{read}{read.lower()}"))
        slopes = {"1": length["A"] / at["A"], "2": length["A"] / (at["A"] - at["P"]), "H": length["B"] / at["B"]}
        wide = max(*slopes.values(), 0.0) - min(*slopes.values(), 0.0)
        pole = pole_distance(q.si(μv) / q.si(μl), wide) / MM
        h = q.give("train.pole", pole, "h", "segment", optional=True)
        μω = self._scale("omega", μv / (μl * h), "rotation on paper")
        for wheel, slope in slopes.items():
            s = self._measured(train_ids.segment(wheel), pole * slope, Symbol("s", wheel))
            ω = q.define(train_ids.read(wheel), μω * s, Symbol("ω", wheel), "angular velocity", optional=True)
            q.set_out("segments", s)
            q.set_out("readings", ω)

    def _scale(self, of: str, value: Operand, kind: str) -> Ref:
        enter = self.q.give if isinstance(value, float) else self.q.define
        return enter(train_ids.scale(of), value, Symbol("μ", "ω" if of == "omega" else of), kind, optional=True)

    def _measured(self, id: str, value: float, symbol: Symbol) -> Ref:
        return self.q.give(id, value, symbol, "segment", exact=False, optional=True)

    # --- efficiency

    def _enter_efficiency(self) -> None:
        q, given = self.q, self.given
        if given.efficiency is None:
            return
        of_mesh = [given.efficiency.inner if inner else given.efficiency.outer for inner in self.scheme.inner]
        second = Symbol("η", "23" if self.scheme.single else f"{OTHER}3")

        def give(of: str, value: float, symbol: Symbol) -> Ref:
            with q.within(KeyChapter.data):
                return q.give(train_ids.efficiency(of), value, symbol)

        η0 = q.define(
            train_ids.efficiency("0"),
            give("12", of_mesh[0], Symbol("η", "12")) * give("23", of_mesh[1], second),
            Symbol("η", "0"),
        )
        u0 = q.define("train.u0", 1 - q["train.u1H"], Symbol("u", "13", "(H)"), "ratio")
        lossless = 1 - u0
        lost = 1 - u0 * η0 if power_way(float(self.train.ratio), given.by_carrier) > 0 else 1 - u0 / η0
        formula = lossless / lost if given.by_carrier else lost / lossless
        η = q.define(train_ids.efficiency("train"), formula, Symbol("η", "H1" if given.by_carrier else "1H"))
        if self.rows:
            rows = (*given.before, *given.behind)
            if any(min(row) > 0 for row in rows):
                give("row", given.efficiency.outer, Symbol("η", "r"))
            if any(min(row) < 0 for row in rows):
                give("ring", given.efficiency.inner, Symbol("η", "ri"))
            total = Product((η, *self._lost_in(rows)))
            q.define(train_ids.efficiency("total"), total, Symbol("η", "tot"))

    def _lost_in(self, rows: Sequence[tuple[int, ...]]) -> Iterator[Expression]:
        """Yield the efficiencies of rows of ordinary wheels, those of outer wheels together, if they are known."""
        for name, inner in (("row", False), ("ring", True)):
            number, η = sum((min(row) < 0) == inner for row in rows), self.q.find(train_ids.efficiency(name))
            if η is not None and number:
                yield η**number if number > 1 else η

    # --- torques and power

    def _enter_torques(self, known: KnownTorque) -> None:
        """Enter the torques on the members from one known torque, and the power through the meshes.

        Torques act from outside.  Those of the members are in equilibrium, M₁ + M_H + M₃ = 0, and M₃ does no work; so
        the driven shaft of the train takes −M u η of the torque M of its driving shaft.  Seen from the carrier, the
        meshes transmit M₁(ω₁ − ω_H).
        """
        q, given = self.q, self.given
        driver, driven = ("H", "1") if given.by_carrier else ("1", "H")
        η = q.find(train_ids.efficiency("train"))
        before, behind = self._transmission(given.before, 0), self._transmission(given.behind, len(given.before))
        with q.within(KeyChapter.data):
            M = q.give(train_ids.torque("given"), known.M.si, Symbol("M", "", "*"))
        through = (self.u,) if η is None else (self.u, η)
        amount: Expression = M
        if known.of == "fixed":
            amount = M / size(1 - Product(through))
        elif known.of == "driven":
            amount = M / size(Product((*through, *behind)))
        elif before:
            amount = M * size(Product(before))

        def enter(name: str, torque: Operand) -> Ref:
            return q.define(train_ids.torque(name), torque, Symbol("M", name))

        # The first shaft turns and is driven in the positive sense; rows before the train may change it.
        M_driver = enter(driver, signed(math.prod(map(q.si, self._ratios(before))), amount))
        M_driven = enter(driven, minus(Product((M_driver, *through))))
        members = M_driver, M_driven, enter("3", minus(M_driver + M_driven))
        first = (enter("in", M_driver / Product(before)),) if before and known.of != "driving" else ()
        last = (enter("out", Product((M_driven, *behind))),) if behind and known.of != "driven" else ()
        q.set_out("torques", *members, *first, *last)
        ω1, ωH = q[train_ids.omega("1")], q[train_ids.omega("H")]
        power = q.define(train_ids.power("in"), M_driver * q[train_ids.omega(driver)], Symbol("P", driver))
        mesh = q.define(train_ids.power("mesh"), q[train_ids.torque("1")] * (ω1 - ωH), Symbol("P", "", "(H)"))
        share = q.define("train.share", size(mesh) / power, "ψ", "ratio")
        q.set_out("power", power, mesh, share)
        if (u := q.si("train.u1H")) < 1:
            # M₁ω₁ = M₁(ω₁ − ω_H) + M₁ω_H with opposite signs: the smaller part runs in a circle.
            circle: Expression = mesh if u > 0 else q[train_ids.torque("1")] * ωH
            q.set_out("power", q.define(train_ids.power("circulating"), size(circle), Symbol("P", "c")))

    @staticmethod
    def _ratios(factors: Iterable[Expression]) -> list[Ref]:
        """Return the ratios among the factors of a torque, which give its sense; efficiencies are positive."""
        return [one for one in factors if isinstance(one, Ref) and one.id in train_ids.row_ratio]

    def _transmission(self, rows: Sequence[tuple[int, ...]], first: int) -> tuple[Expression, ...]:
        """Return the factors of a torque through rows of ordinary wheels that begin with the row number `first`."""
        ratios = [self.q[train_ids.row_ratio(wheel)] for wheel, _ in self.rows[first : first + len(rows)]]
        return (*ratios, *self._lost_in(rows))


def pole_distance(rate: float, wide: float, larger: float = 1.0) -> float:
    """Return the distance h of the pole (mm) at which μ_ω = μ_v/(μ_l h) is a standard scale; `rate` is μ_v/μ_l.

    The plan is `wide` times as wide as h, in a room `larger` times as large as in a report.  Among distances that
    differ by less than a factor of ten, a multiple of half a millimetre is preferred.
    """
    most = larger * min(max(RATES_WIDTH / wide, NEAREST_POLE), FARTHEST_POLE)
    distances = [rate / nice_up(rate / most * share) for share in SERIES]
    return next((h for h in distances if math.isclose(2 * h, round(2 * h), rel_tol=1e-9)), distances[0])


def over(points: str) -> Symbol:
    """Return the symbol of a line on paper between two points."""
    return Symbol(points, over="segment")
