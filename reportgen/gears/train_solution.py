"""A planetary train as a ledger: tooth numbers by factors, ratio, conditions, rates, triangles of velocities."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from reportgen.base.units import MM, nice_up
from reportgen.formula import PI, Expression, Product, Ref, Symbol, as_expression, ids, signed, sin
from reportgen.formula.ledger import Ledger
from reportgen.formula.rounding import printed
from reportgen.formula.sheet import Sheet
from reportgen.formula.vocabulary import Chapter
from reportgen.gears.planetary_train import Parameters
from reportgen.gears.train import CONDITIONS, SCHEMES, Choice, Scheme, Train, power_way
from reportgen.report.case import Opened, Pitfalls

OTHER = "2′"
"""The second wheel of a double satellite."""
FIRST_ROW_WHEEL = 4
"""Wheels of ordinary rows are numbered from here."""
PLAN_HEIGHT, PLAN_WIDTH, RATES_WIDTH = 85.0, 60.0, 110.0
"""What radii, velocities and the plan of angular velocities may take on paper (mm)."""
POLES = (2, 5, 10, 15, 20, 25, 30, 40)
"""Distances of the pole of the plan of angular velocities (mm)."""
STEPS = (1.0, 2.0, 2.5, 4.0, 5.0)


@dataclass(frozen=True)
class SolvedTrain(Opened):
    """An assignment of a planetary train with its ledger; each part is computed when it is first asked for."""

    @property
    def given(self) -> Parameters:
        found: Parameters = self.assignment.parameters
        return found

    @property
    def scheme(self) -> Scheme:
        return SCHEMES[self.given.scheme]

    @property
    def choice(self) -> Choice:
        return self.given.choice

    @property
    def train(self) -> Train:
        return self.choice.chosen

    @cached_property
    def sheet(self) -> Sheet:
        return TrainSheet(self.given).written()

    @cached_property
    def ledger(self) -> Ledger:
        made = Ledger(self.sheet.families, 1, units=self.words["units"], lines=self.sheet.lines)
        return made.in_language(self.words["symbols"])

    @cached_property
    def printed(self) -> Ledger:
        return printed(self.ledger)

    @property
    def speed(self) -> float:
        """Of the shaft that comes in (rad/s)."""
        return self.given.n_in.si

    @cached_property
    def pitfalls(self) -> Pitfalls:
        """Tooth numbers that miss one condition, and definitions that are often used in place of the right ones."""
        families, changed = self.sheet.families, dict[str, list[tuple[str, Expression]]]()

        def also(name: str, id: str, other: Expression) -> None:
            if id in families:
                changed.setdefault(id, []).append((name, other))

        term, one = self._term, as_expression(1.0)
        also("train-without-one", "train.u1H", signed(self.scheme.sign, term))
        also("train-ratio-sign", "train.u1H", one + signed(-self.scheme.sign, term))
        ω1, ωH = (Ref(ids.train_omega(wheel)) for wheel in ("1", "H"))
        driven, driver = (ids.train_omega("1"), ωH) if self.given.by_carrier else (ids.train_omega("H"), ω1)
        ratio = Ref("train.uH1" if self.given.by_carrier else "train.u1H")
        also("train-inverse", driven, driver * ratio)
        first, _ = self.scheme.signs
        turned = Ref(ids.train_teeth("1")) / Ref(ids.train_teeth("2"))
        also("train-carrier-still", ids.train_omega("2"), signed(first, ω1 * turned))
        also("train-carrier-added", ids.train_omega("2"), signed(first, (ω1 - ωH) * turned))
        also("train-tips", "train.tip", self._reference)
        readings: dict[str, list[tuple[str, np.ndarray]]] = {}
        for name in reversed(CONDITIONS[1:]):
            if (refused := self.choice.refused.get(name)) is not None:
                for wheel, number in zip(("1", "2", OTHER, "3"), refused.teeth, strict=True):
                    if ids.train_teeth(wheel) in families:
                        readings.setdefault(ids.train_teeth(wheel), []).append((f"train-{name}", np.array([number])))
        return Pitfalls(readings=readings, changed=changed)

    @property
    def _term(self) -> Expression:
        """z₂z₃/(z₁z₂′)."""
        return term_of(self.scheme, {wheel: Ref(ids.train_teeth(wheel)) for wheel in ("1", "2", OTHER, "3")})

    @property
    def _reference(self) -> Expression:
        """The reference diameter of the satellite whose tips come nearest to the next one."""
        m, wheel = larger_satellite(self.train)
        return Ref(m) * Ref(ids.train_teeth(wheel))


def term_of(scheme: Scheme, z: Mapping[str, Ref]) -> Expression:
    return z["3"] / z["1"] if scheme.single else Product((z["2"], z["3"])) / Product((z["1"], z[OTHER]))


def larger_satellite(train: Train) -> tuple[str, str]:
    """The module and the wheel of the satellite with the larger tip circle."""
    z, m = train.teeth, float(train.modules)
    return ("train.m2" if m != 1 else "train.m", OTHER) if z.other + 2 > m * (z.two + 2) else ("train.m", "2")


class TrainSheet:
    """The sheet of a planetary train while it is written."""

    def __init__(self, given: Parameters) -> None:
        self.given, self.scheme, self.train = given, SCHEMES[given.scheme], given.choice.chosen
        self.q = Sheet()
        self.z: dict[str, Ref] = {}

    def written(self) -> Sheet:
        self._enter_given()
        self._enter_teeth()
        self._enter_ratio()
        self._enter_conditions()
        self._enter_rates()
        self._enter_triangles()
        self._enter_efficiency()
        return self.q

    def _enter_given(self) -> None:
        q, given = self.q, self.given
        with q.within(Chapter.data):
            n = q.give("train.n.in", given.n_in.value)
            for number, teeth in enumerate((z for row in (*given.before, *given.behind) for z in row), FIRST_ROW_WHEEL):
                self.z[str(number)] = q.give(ids.train_teeth(str(number)), float(teeth))
            symbol = Symbol("u", "H1" if given.by_carrier else "1H")
            if given.u is not None:
                q.give("train.u", given.wanted, Symbol("u", symbol.sub, "*"), exact=True)
            else:
                assert given.n_out is not None
                out: Expression = q.give("train.n.out", given.n_out.value)
                for a, b in self._rows(given.before) + self._rows(given.behind, len(given.before)):
                    out = out * (b / a)
                q.define("train.u", n / out, Symbol("u", symbol.sub, "*"))
            q.give("train.k", float(given.k))
            q.give("train.m", given.m.si)
            if self.train.modules != 1:
                q.give("train.m2", given.second_module.si)

    def _rows(self, rows: tuple[tuple[int, ...], ...], before: int = 0) -> list[tuple[Ref, Ref]]:
        """Driver and driven wheel of each ordinary row."""
        start = FIRST_ROW_WHEEL + 2 * before
        return [(self.z[str(start + 2 * i)], self.z[str(start + 2 * i + 1)]) for i in range(len(rows))]

    # --- tooth numbers by factors

    def _enter_teeth(self) -> None:
        """z₁ = A e t, z₂ = B e t, z₂′ = C f t, z₃ = D f t; of a single satellite z₁ = A t, z₃ = D t."""
        q, z, scheme = self.q, self.train.teeth, self.scheme

        def factor(letter: str, value: int) -> Ref:
            # They follow from the tooth numbers that a student finds: no data, which could be misread.
            return q.give(ids.train_factor(letter), float(value), Symbol(letter), hidden=True)

        if scheme.single:
            ratio = Fraction(z.three, z.one)
            A, D = factor("A", ratio.denominator), factor("D", ratio.numerator)
            t = factor("t", z.one // ratio.denominator)
            for wheel, formula in (("1", A * t), ("3", D * t), ("2", (D - A) * t / 2)):
                self.z[wheel] = q.define(ids.train_teeth(wheel), formula)
            self.z[OTHER] = self.z["2"]
            return
        first, second = Fraction(z.two, z.one), Fraction(z.three, z.other)
        numbers = first.denominator, first.numerator, second.denominator, second.numerator
        A, B, C, D = (factor(letter, value) for letter, value in zip("ABCD", numbers, strict=True))
        one, other = self.scheme.signs
        across, along = A + signed(-one, B), D + signed(-other, C)
        p, r = self.train.modules.numerator, self.train.modules.denominator
        wide, long = p * abs(numbers[0] - one * numbers[1]), r * abs(numbers[3] - other * numbers[2])
        common = math.gcd(wide, long)
        e = q.define(ids.train_factor("e"), _over(_times(r, along), common), Symbol("e"), optional=True)
        f = q.define(ids.train_factor("f"), _over(_times(p, across), common), Symbol("f"), optional=True)
        t = factor("t", z.one // (numbers[0] * long // common))
        for wheel, formula in (("1", A * e * t), ("2", B * e * t), (OTHER, C * f * t), ("3", D * f * t)):
            self.z[wheel] = q.define(ids.train_teeth(wheel), formula, Symbol("z", wheel))

    # --- ratio

    def _enter_ratio(self) -> None:
        q, given = self.q, self.given
        u = q.define("train.u1H", 1 + signed(self.scheme.sign, term_of(self.scheme, self.z)))
        if given.by_carrier:
            u = q.define("train.uH1", 1 / u)
        q.define("train.off", (u - q["train.u"]) / q["train.u"], scale=1.0, optional=True)
        ratios: list[Expression] = []
        for i, (a, b) in enumerate(self._rows(given.before) + self._rows(given.behind, len(given.before))):
            number = FIRST_ROW_WHEEL + 2 * i
            row = q.define(ids.train_row_ratio(str(number)), -(b / a), Symbol("u", f"{number},{number + 1}"))
            ratios.append(row)
        if ratios:
            ratios.insert(len(given.before), u)
            q.define("train.total", Product(tuple(ratios)))
            if given.n_out is None:
                q.define("train.n.out", q["train.n.in"] / q["train.total"])
        elif given.n_out is None:
            q.define("train.n.out", q["train.n.in"] / u)

    # --- conditions

    def _enter_conditions(self) -> None:
        q, z, (first, second) = self.q, self.z, self.scheme.signs
        m = q["train.m"]
        m2 = q.find("train.m2") or m
        a = q.define("train.a.1", m * (z["1"] + signed(-first, z["2"])) / 2)
        names = Symbol("a", f"{OTHER}3" if not self.scheme.single else "23")
        q.define("train.a.2", m2 * (z["3"] + signed(-second, z[OTHER])) / 2, names)
        module, wheel = larger_satellite(self.train)
        tip = q.define("train.tip", q[module] * (z[wheel] + 2), Symbol("d", f"a{wheel}"))
        q.define("train.gap", tip / (2 * a))
        q.define("train.room", sin(PI / q["train.k"]))
        k, turns = q["train.k"], self.train.turns(self.given.k)
        assert turns is not None, "it can be assembled"
        if self.scheme.single:
            q.define("train.N", (z["1"] + z["3"]) / k)
            return
        P = q.give("train.P", float(turns), optional=True)
        whole = Product((z["1"], z[OTHER])) + signed(self.scheme.sign, Product((z["2"], z["3"])))
        over = Product((k, z[OTHER]))
        # N may come out large: it is exact all the same.
        q.define("train.N", Product((whole, 1 + k * P)) / over if turns else whole / over)

    # --- rates

    def _enter_rates(self) -> None:
        q, given, z = self.q, self.given, self.z
        first, _ = self.scheme.signs
        # Shaft by shaft from the motor to the machine; wheels on one shaft turn together.
        rows = [(4 + 2 * i, f"{4 + 2 * i}") for i in range(len(given.before) + len(given.behind))]
        driver, driven = ("H", "1") if given.by_carrier else ("1", "H")
        ω: Expression | None = None

        def on(wheel: str, symbol: Symbol | str = "") -> Ref:
            """The first shaft's rate comes from the speed; another wheel turns with the one before it."""
            formula = 2 * PI * q["train.n.in"] / 60 if ω is None else ω
            return q.define(ids.train_omega(wheel), formula, symbol)

        def row(number: int) -> Ref:
            before = on(str(number))
            ratio = q[ids.train_row_ratio(str(number))]
            return q.define(ids.train_omega(str(number + 1)), before / ratio)

        for number, _ in rows[: len(given.before)]:
            ω = row(number)
        start = on(driver)
        out = q.define(ids.train_omega(driven), start / q["train.uH1" if given.by_carrier else "train.u1H"])
        ω1, ωH = (start, out) if driver == "1" else (out, start)
        turned = (ω1 - ωH) * z["1"] / z["2"]
        q.define(ids.train_omega("2"), ωH + signed(first, turned), scale=abs(given.n_in.si))
        ω = out
        for number, _ in rows[len(given.before) :]:
            ω = row(number)

    # --- triangles of velocities

    def _enter_triangles(self) -> None:
        """Velocities over the distance from the axis are straight lines; parallels to them through a pole cut off ω."""
        q, z, given = self.q, self.z, self.given
        m = q["train.m"]
        m2 = q.find("train.m2") or m
        a = q["train.a.1"]
        r1 = q.define(ids.train_radius("1"), m * z["1"] / 2)
        r3 = q.define(ids.train_radius("3"), m2 * z["3"] / 2)
        ω1, ωH = (q[ids.train_omega(wheel)] for wheel in ("1", "H"))
        vA = q.define(ids.train_velocity("A"), ω1 * r1)
        vB = q.define(ids.train_velocity("B"), ωH * a)
        reach, fastest = max(q.si(r1), q.si(r3), q.si(a)), max(abs(q.si(vA)), abs(q.si(vB)))
        μl = q.give("train.mu.l", nice_up(reach * MM / PLAN_HEIGHT, STEPS), optional=True)
        μv = q.give("train.mu.v", nice_up(fastest * MM / PLAN_WIDTH, STEPS), optional=True)

        def laid(wheel: str, size: Expression, symbol: Symbol) -> Ref:
            return q.define(ids.train_on_paper(wheel), size / μl, symbol, optional=True)

        laid("1", r1, Symbol("OA", over="segment"))
        laid("3", r3, Symbol("OP", over="segment"))
        laid("H", a, Symbol("OB", over="segment"))
        p1, p3, pH = (q.si(ids.train_on_paper(wheel)) for wheel in ("1", "3", "H"))
        driven, driver = ("A", vA), ("B", vB)
        if not given.by_carrier:
            driven, driver = driver, driven
        line = q.define(ids.train_velocity_line(driver[0]), driver[1] / μv, segment(driver[0]), optional=True)
        along = {"A": p1 - p3, "B": pH - p3}
        other = q.si(line) * along[driven[0]] / along[driver[0]]
        q.give(ids.train_velocity_line(driven[0]), other, segment(driven[0]), exact=False, optional=True)
        Aa = q.si(ids.train_velocity_line("A"))
        steep = {"1": Aa / p1, "2": Aa / (p1 - p3), "H": q.si(ids.train_velocity_line("B")) / pH}
        wide = max(*steep.values(), 0.0) - min(*steep.values(), 0.0)
        height = max(pole for pole in POLES if pole * wide <= RATES_WIDTH or pole == POLES[0]) / MM
        h = q.give("train.pole", height, optional=True)
        μω = q.define("train.mu.omega", μv / (μl * h), optional=True)
        for wheel, slope in steep.items():
            s = q.give(ids.train_segment(wheel), height * slope, exact=False, optional=True)
            q.define(ids.train_read(wheel), μω * s, optional=True)

    # --- efficiency

    def _enter_efficiency(self) -> None:
        q, given = self.q, self.given
        if given.efficiency is None:
            return
        of_mesh = [given.efficiency.inner if inner else given.efficiency.outer for inner in self.scheme.inner]
        with q.within(Chapter.data):
            η1 = q.give(ids.train_efficiency("12"), of_mesh[0])
            names = "23" if self.scheme.single else f"{OTHER}3"
            η2 = q.give(ids.train_efficiency("23"), of_mesh[1], Symbol("η", names))
            rows = len(given.before) + len(given.behind)
            ηr = q.give(ids.train_efficiency("row"), given.efficiency.outer, Symbol("η", "r")) if rows else None
        η0 = q.define(ids.train_efficiency("0"), η1 * η2, Symbol("η", "0"))
        way = power_way(float(self.train.ratio), given.by_carrier)
        u0 = q.define("train.u0", 1 - q["train.u1H"], Symbol("u", "13", "(H)"), "ratio")
        lost = 1 - u0 * η0 if way > 0 else 1 - u0 / η0
        lossless = 1 - u0
        η = q.define(
            ids.train_efficiency("train"),
            lossless / lost if given.by_carrier else lost / lossless,
            Symbol("η", "H1" if given.by_carrier else "1H"),
        )
        if ηr is not None:
            q.define(ids.train_efficiency("total"), η * ηr**rows, Symbol("η", "tot"))


def segment(place: str) -> Symbol:
    """The line on paper of the velocity of a point."""
    return Symbol(f"{place}{place.lower()}", over="segment")


def _times(number: int, of: Expression) -> Expression:
    return of if number == 1 else number * of


def _over(of: Expression, number: int) -> Expression:
    return of if number == 1 else of / number
