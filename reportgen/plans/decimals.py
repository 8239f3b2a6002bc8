"""How finely each quantity is printed: every line recomputes, with the figures that a person would write.

A reader's calculator, fed with the printed numbers x̂₁, x̂₂, … of a line y = f(x₁, x₂, …), comes to the printed ŷ
within one unit of its last digit, at every position; this is tried out with the numbers as they are printed.  A line
that does not hold gets one more decimal in the input that puts it off most or one fewer in its result, in this order:
inputs up to five figures, the result down to the four aimed at, inputs as far as their kind allows, the result down to
three.  A whole number of four figures or more keeps its units, of which five figures of the inputs may leave the last
ones open.  What the whole report comes to, as the balancing torque, keeps four figures if its line holds where it is
written out.

Families that print under one symbol, as by plan and by formula, are one quantity and have one number of decimals.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal

import numpy as np

from reportgen.base import units as numbers
from reportgen.formula import Call, Expression, Negative, Ref, refs
from reportgen.formula.evaluation import evaluate
from reportgen.formula.sheet import ZERO, Family, is_short
from reportgen.formula.vocabulary import MAX_DIGITS, Chapter

LEAST_DIGITS = 3
"""A quantity's largest value keeps at least these; a line that needs fewer is a listed cancellation."""
INPUT_DIGITS = 5
"""An input gets so many before its line's result gives up one of those that it should have."""
HOLDS = 1 + 1e-6
"""Units of its last digit that a line may be off, the dust of floats included."""


@dataclass(eq=False)
class _Quantity:
    """What is printed under one name: how many decimals it has, and how many it may have."""

    decimals: int
    least: int
    aim: int
    usual: int
    """What an input is given before results give way."""
    most: int

    def cap(self, most: int) -> None:
        """Let it have no more decimals than so many."""
        self.decimals, self.least, self.aim, self.usual, self.most = (
            min(own, most) for own in (self.decimals, self.least, self.aim, self.usual, self.most)
        )

    def lower(self, least: int) -> bool:
        """One decimal less, for good, unless it has the least already."""
        if self.decimals > least:
            self.cap(self.decimals - 1)
            return True
        return False

    def aim_at(self, decimals: int) -> None:
        """Begin with so many, and have others only where a line would not hold."""
        self.decimals = self.aim = self.usual = min(decimals, self.most)
        self.least = min(self.least, decimals)

    def freeze(self) -> None:
        self.least = self.aim = self.usual = self.most = self.decimals


def _largest(family: Family) -> float:
    """Its largest size as printed; 0 where it is nothing at all positions."""
    sizes = np.abs(family.values[np.isfinite(family.values)])
    sizes = sizes[sizes >= ZERO * family.scale] / family.how.scale
    return float(sizes.max()) if sizes.size else 0.0


def _decimals_for(size: float, digits: int) -> int:
    """Decimals that show a number of that size with so many figures."""
    return digits - 1 - math.floor(math.log10(size) + 1e-12)


def _quantity(families: Sequence[Family]) -> _Quantity:
    how = families[0].how
    largest = max(map(_largest, families))
    beside = max(largest, *(family.scale / how.scale for family in families))
    if largest == 0:
        decimals = how.digits - 1 if how.decimals is None else how.decimals
        return _Quantity(decimals, decimals, decimals, decimals, decimals)
    # A small term of a sum has figures of its own, but no finer ones than the sum itself could show.
    least = min(_decimals_for(largest, LEAST_DIGITS), _decimals_for(beside, MAX_DIGITS))
    aim = max(_decimals_for(beside, how.digits), least) if how.decimals is None else how.decimals
    most = _decimals_for(largest, how.most)
    if how.finest is not None:
        most = min(most, how.finest)
    # A whole number is shown whole: 3970 for 3965 would be read as exact to its last nought.
    most, aim = max(most, 0), max(aim, 0)
    aim = min(aim, most)
    least = min(max(least, 0), aim)
    usual = min(max(_decimals_for(largest, INPUT_DIGITS), aim), most)
    return _Quantity(aim, least, aim, usual, most)


def _is_printed_as_it_is(family: Family) -> bool:
    """Given data, and one value for all positions that has few enough digits to be printed so (0.171 m)."""
    if family.exact or family.is_plane or family.hidden:
        return True
    alone = len(family.values) == 1 and family.definition is not None
    return alone and is_short(float(family.values[0].real) / family.how.scale)


def _last_decimal(value: float) -> int:
    """The place of the last digit of a number printed as it is."""
    return max(-int(Decimal(f"{value:.12g}").normalize().as_tuple().exponent), 0)


def _other_name(definition: Expression | None) -> str:
    """The id of the quantity that a definition only names again or turns round (l = R, R₂₁ = −R₁₂); "" for others."""
    match definition:
        case Ref(id) | Negative(Ref(id)) | Call("size", (Ref(id),)):
            return id
        case _:
            return ""


def _names(families: Mapping[str, Family], same: Sequence[tuple[str, ...]]) -> dict[str, object]:
    """What each family is called as a printed quantity: those of one name have one number of decimals.

    They print under one symbol, have one value, or are said to be the `same`.  A length on paper is for itself.
    """
    names: dict[str, object] = {id: ids[0] for ids in same for id in ids}
    for id, family in families.items():
        other = _other_name(family.definition)
        if family.kind == "segment":
            names[id] = id
        elif other in names and families[other].kind == family.kind:
            names[id] = names[other]
        else:
            names.setdefault(id, (family.symbol, family.kind))
    return names


def _as_printed(family: Family, digits: int | None) -> np.ndarray:
    """A family's values (SI) as a reader sees them: rounded, nothing as 0."""

    def shown(value: float) -> float:
        if abs(value) < ZERO * family.scale:
            return 0.0
        if not math.isfinite(value):
            return value
        size = value / family.how.scale
        return (float(f"{size:.12g}") if digits is None else numbers.printed(size, digits)) * family.how.scale

    return np.array([shown(float(value)) for value in np.real(family.values)])


@dataclass(frozen=True, slots=True)
class _Line:
    id: str
    inputs: tuple[str, ...]
    definition: Expression


class _Calculator:
    """A reader's calculator: what lines come to from numbers as they are printed, each tried once."""

    def __init__(self, families: Mapping[str, Family]) -> None:
        self.families = families
        self._printed: dict[tuple[str, int | None], np.ndarray] = {}
        self._computed: dict[tuple[object, ...], np.ndarray] = {}
        self._off: dict[tuple[object, ...], np.ndarray] = {}

    def printed(self, id: str, digits: int | None) -> np.ndarray:
        """A family's values (SI) as a reader sees them."""
        key = id, digits
        if key not in self._printed:
            self._printed[key] = _as_printed(self.families[id], digits)
        return self._printed[key]

    def computed(self, line: _Line, rounded: Mapping[str, int | None]) -> np.ndarray:
        """What the line comes to in its printed unit, with some of its inputs printed with so many decimals."""
        key = line.id, *rounded.items()
        if key not in self._computed:
            values = {id: self.families[id].values for id in line.inputs}
            values |= {id: self.printed(id, digits) for id, digits in rounded.items()}
            with np.errstate(all="ignore"):
                found = np.atleast_1d(np.asarray(evaluate(line.definition, values)))
            self._computed[key] = found / self.families[line.id].how.scale
        return self._computed[key]

    def off(self, line: _Line, last: int | None, rounded: Mapping[str, int | None]) -> np.ndarray:
        """How far a line is off at each position, as a share of how far a result with the decimals `last` may be."""
        key = line.id, last, *rounded.items()
        if key not in self._off:
            result = self.printed(line.id, last) / self.families[line.id].how.scale
            unit = 10.0 ** -(_last_decimal(float(result[0])) if last is None else last)
            off = np.abs(self.computed(line, rounded) - result) / unit
            self._off[key] = np.where(np.isfinite(off), off, 0.0)
        return self._off[key]


class _Choice:
    """The decimals of a ledger's quantities while they are being chosen."""

    def __init__(self, calculator: _Calculator, same: Sequence[tuple[str, ...]], worked: Sequence[int]) -> None:
        self.calculator = calculator
        self.families = families = calculator.families
        self.worked = worked
        self.results = {id for ids in same for id in ids}
        self.names = _names(families, same)
        self.quantities: dict[str, _Quantity] = {}
        self.by_worked: set[str] = set()
        """Lines that are judged by the positions worked out only."""
        self.lines: list[_Line] = []

    def settle(self, ids: Sequence[str]) -> None:
        """Choose the decimals of further families; those before them change where the new lines need it."""
        self._enter([id for id in ids if not _is_printed_as_it_is(self.families[id])])
        self.lines += [line for line in map(self._line, ids) if line is not None]
        given_up: set[str] = set()
        settled = False
        while not settled:
            settled = True
            for line in reversed(self.lines):
                while line.id not in given_up and not self._holds(line):
                    settled = False
                    if not self._mend(line):
                        given_up.add(line.id)
        self._give_back()

    def freeze(self) -> None:
        """Keep what is chosen so far as it is."""
        for quantity in self.quantities.values():
            quantity.freeze()

    def excess(self) -> float:
        """What all lines together are off beyond what they may be, in units of their last digits."""
        return float(sum(max(self._worst(line) - HOLDS, 0.0) for line in self.lines))

    def cancellations(self) -> tuple[str, ...]:
        """Lines that do not hold; but the last units of a whole number may be what its inputs leave open."""
        off = (line.id for line in self.lines if self._over(line).max() > HOLDS)
        return tuple(id for id in off if not self._is_whole(id))

    def _enter(self, ids: Sequence[str]) -> None:
        """Begin with the decimals aimed at; what has a name from before is meant to have the decimals of that."""
        before = {self.names[id]: quantity.decimals for id, quantity in self.quantities.items()}
        together: dict[object, list[str]] = {}
        for id in ids:
            together.setdefault(self.names[id], []).append(id)
        for name, members in together.items():
            quantity = _quantity([self.families[id] for id in members])
            if name in before:
                quantity.aim_at(before[name])
            self.quantities |= dict.fromkeys(members, quantity)

    def _line(self, id: str) -> _Line | None:
        """The line that a family is printed with; None for what is given, measured or drawn."""
        family = self.families[id]
        if family.line is None or family.constructed or family.is_plane or family.hidden:
            return None
        inputs = refs(family.line)
        if not inputs or any(self.families[name].is_plane for name in inputs):
            return None
        return _Line(id, inputs, family.line)

    def decimals(self, id: str) -> int | None:
        return self.quantities[id].decimals if id in self.quantities else None

    def _over(self, line: _Line) -> np.ndarray:
        """How far a line is off at each position, as a share of how far it may be."""
        return self.calculator.off(line, self.decimals(line.id), {id: self.decimals(id) for id in line.inputs})

    def _worst(self, line: _Line) -> float:
        """How far it is off at most."""
        over = self._over(line)
        judged = [(k - 1) % over.size for k in self.worked] if line.id in self.by_worked else slice(None)
        return float(over[judged].max())

    def _holds(self, line: _Line) -> bool:
        return self._worst(line) <= HOLDS

    def _mend(self, line: _Line) -> bool:
        """Give an input one more decimal or the result one fewer; False if neither may be."""
        own = self.quantities.get(line.id)
        return (
            self._raise_an_input(line, lambda quantity: quantity.usual)
            or (own is not None and own.lower(own.aim))
            or (not self._is_whole(line.id) and self._raise_an_input(line, lambda quantity: quantity.most))
            or self._judge_where_written_out(line)
            or (own is not None and own.lower(own.least))
        )

    def _judge_where_written_out(self, line: _Line) -> bool:
        """Judge a result of the whole report by its written-out lines only, if these hold; False if they do not."""
        if line.id in self.results and self.worked and line.id not in self.by_worked:
            self.by_worked.add(line.id)
            if self._holds(line):
                return True
            self.by_worked.remove(line.id)
        return False

    def _raise_an_input(self, line: _Line, limit: Callable[[_Quantity], int]) -> bool:
        """One decimal more for the input below its limit whose rounding does most where the line is worst."""
        worst, exact = int(self._over(line).argmax()), self.calculator.computed(line, {})
        shares = []
        for id in line.inputs:
            if id in self.quantities and self.quantities[id].decimals < limit(self.quantities[id]):
                share = np.nan_to_num(np.abs(self.calculator.computed(line, {id: self.decimals(id)}) - exact))
                shares.append((float(share[worst % share.size]), id))
        share, chosen = max(shares, default=(0.0, ""))
        if share > 0:
            self.quantities[chosen].decimals += 1
        return share > 0

    def _is_whole(self, id: str) -> bool:
        """Whether it is a whole number with all the figures that one aims at."""
        return self.decimals(id) == 0 and _largest(self.families[id]) >= 10.0 ** (self.families[id].how.digits - 1)

    def _give_back(self) -> None:
        """Take back decimals that were raised in vain, before a result gave way."""
        concerned: dict[_Quantity, list[_Line]] = {quantity: [] for quantity in self.quantities.values()}
        for line in self.lines:
            for quantity in {self.quantities[id] for id in (line.id, *line.inputs) if id in self.quantities}:
                concerned[quantity].append(line)
        for quantity, lines in reversed(concerned.items()):
            worst = [max(self._worst(line), HOLDS) for line in lines]
            while quantity.decimals > quantity.aim:
                quantity.decimals -= 1
                if any(self._worst(line) > before for line, before in zip(lines, worst, strict=True)):
                    quantity.decimals += 1
                    break


def choose_decimals(
    families: Mapping[str, Family],
    same: Sequence[tuple[str, ...]] = (),
    checks: Container[str] = (),
    worked: Sequence[int] = (),
) -> tuple[dict[str, int | None], tuple[str, ...]]:
    """Decimals for every family (None: printed as it is) and the ids of lines that cannot be made to recompute.

    Families named the `same` are results of the whole report that are printed with the same decimals.  The `checks`
    come last and take all other numbers as these are printed.  Lines are written out at the `worked` positions.
    """
    last = [id for id in families if id in checks]
    before = {id: family for id, family in families.items() if id not in checks}
    formulas = [id for id, family in before.items() if family.chapter is Chapter.formulas]
    others = [id for id, family in before.items() if family.chapter is not Chapter.formulas]

    calculator = _Calculator(families)

    def chosen(*steps: Sequence[str]) -> _Choice:
        choice = _Choice(calculator, same, worked)
        for ids in steps:
            choice.settle(ids)
        choice.freeze()
        choice.settle(last)
        return choice

    best = chosen([*others, *formulas])
    if best.excess() > 0:
        # A formula that needs more figures than a plan gives is chosen after it, rather than spoil other lines.
        best = min(best, chosen(others, formulas), key=_Choice.excess)
    return {id: best.decimals(id) for id in families}, best.cancellations()
