"""The ledger: all quantities of a report with their definitions. It can be evaluated again from other values.

A ledger contains the families of a finished calculation (`formula.calculation`) with their decimals; a
`PrintedQuantity` is a family at one position. Definitions are expressions over other families. So the ledger evaluates
itself (`Ledger.evaluate`), knows the inputs of every quantity (`Ledger.inputs`), and prints its own worked lines
(`Ledger.chain`).

A plan's point and the length measured to it are two families, and later definitions use one or the other. A student who
measured another length continues with a vector of that length; one who computed another length lays off a vector of
that length. `Ledger.vectors` pairs each size with its vector, and `follow` adapts the vector's length. A value computed
from a measured length with a scale moves nothing on paper.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from reportgen.base.records import Record, field, replace
from reportgen.base.units import rounded
from reportgen.formula import (
    Call,
    Chain,
    Expression,
    Fraction,
    Negative,
    Number,
    Power,
    Product,
    Ref,
    Root,
    Sum,
    Symbol,
    rebuild,
    refs,
    vocabulary,
)
from reportgen.formula.calculation import Family
from reportgen.formula.evaluation import evaluate

MistakenValues = Iterator[tuple[str, str, Expression]]
"""The id of a quantity, the name of a mistake, and the quantity's definition with the mistake."""

Entered = Callable[[str, dict[str, np.ndarray]], None]
"""Callback after each quantity of an evaluation, with its id and all values so far (SI), [1], [N] or [cases, N]."""


class PrintedQuantity(Record):
    """A family at one position, as printed: `value` in `unit` with `decimals`.

    `position` is None for a quantity with one value for all positions, `decimals` None for a value printed exactly, and
    `definition` None for given data.
    """

    id: str
    position: int | None
    symbol: Symbol
    unit: str
    value: float
    decimals: int | None
    definition: Expression | None

    @property
    def number(self) -> Number:
        """The value as a number of an expression, in the printed unit."""
        return Number(self.value, self.decimals, self.unit)


class Ledger(Record, dict=True):
    """All families of a report.

    `positions` is the number N of positions. If values are rounded as printed (`formula.rounded_ledger`), `decimals`
    gives the decimals of each family, None for values printed exactly.
    """

    families: Mapping[str, Family]
    positions: int
    decimals: Mapping[str, int | None] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    """Units whose printed form depends on the language, e.g. rpm."""
    same: tuple[tuple[str, ...], ...] = ()
    """Ids of families that are one quantity under several symbols, with one number of decimals."""
    lines: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Ids of the lines that the report prints together, by the names that the machine's calculation gives."""

    @cached_property
    def inputs(self) -> Mapping[str, tuple[str, ...]]:
        """Ids in the definition of each quantity."""
        return {
            id: () if family.definition is None else refs(family.definition) for id, family in self.families.items()
        }

    @cached_property
    def constructed(self) -> frozenset[str]:
        """Ids of the quantities that are read from a drawing."""
        return frozenset(id for id, family in self.families.items() if family.constructed)

    @cached_property
    def signed(self) -> Mapping[str, str]:
        """The signed angular velocities and accelerations by their sizes: omega.2 → turn.omega.2."""
        return {family.of: id for id, family in self.families.items() if family.is_signed_rotation}

    @cached_property
    def vectors(self) -> Mapping[str, str]:
        """The vectors by their sizes: seg.v.pb → plan.v.b, seg.v.as2 → laid.v.as2, Pqt2 → F.Pqt2."""
        vectors: dict[str, str] = {}
        for id, family in self.families.items():
            match family.definition:
                case Call("abs", (Ref(vector),)):
                    vectors[id] = vector
            # A vector that is computed from its size follows it without a correction.
            size = family.of if family.hidden else ""
            if size in self and family.definition is not None and size not in self.inputs[id]:
                vectors[size] = id
        return vectors

    def size_of(self, id: str) -> str:
        """Return the id of a signed rotation's size; any other quantity is its own size.

        Raises `KeyError` for an unknown id.
        """
        family = self.families[id]
        return family.of if family.is_signed_rotation else id

    def in_language(self, names: Mapping[str, str]) -> Ledger:
        """Return the ledger with its symbols in a language; `names` maps letters and indices to that language."""
        symbols = {id: vocabulary.in_language(family.symbol, names) for id, family in self.families.items()}
        return replace(self, families={id: replace(one, symbol=symbols[id]) for id, one in self.families.items()})

    def __contains__(self, id: str) -> bool:
        return id in self.families

    def __getitem__(self, id: str) -> Family:
        return self.families[id]

    def known(self, ids: Iterable[str]) -> list[str]:
        """Return the ids that are in the ledger, each once."""
        return [id for id in dict.fromkeys(ids) if id in self.families]

    def printed_unit(self, unit: str) -> str:
        """Return a unit as the language of this ledger writes it."""
        return self.units.get(unit, unit)

    def quantity(self, id: str, position: int | None = None) -> PrintedQuantity:
        """Return a quantity at a position (from 1) as printed, in its printed unit.

        Without decimals, the value is rounded to 12 significant figures. Raises `KeyError` for an unknown id.
        """
        family = self.families[id]
        how = family.how
        value = float(family.at(position).real) / how.scale
        decimals = self.decimals.get(id) if value else None
        return PrintedQuantity(
            id=id,
            position=None if len(family.values) == 1 else position,
            symbol=family.symbol,
            unit=self.printed_unit(how.unit),
            value=value if decimals is not None else float(f"{value:.12g}"),
            decimals=decimals,
            definition=family.definition,
        )

    def number(self, id: str, position: int | None = None, *, size: bool = False) -> Number:
        """Return the printed number of a quantity with its unit; `size` removes its sign.

        Raises `KeyError` for an unknown id.
        """
        number = self.quantity(id, position).number
        return Number(abs(number.value), number.decimals, number.unit) if size else number

    def result(self, id: str, position: int | None = None) -> Number:
        """Return the number of a quantity as a result, with no more decimals than usual for its kind.

        Lines that continue with the quantity may use more decimals. Raises `KeyError` for an unknown id.
        """
        number, usual = self.number(id, position), self.families[id].how.decimals
        carried = usual is not None and number.decimals is not None and number.decimals > usual
        return Number(number.printed, usual, number.unit) if carried else number

    def symbol(self, id: str) -> Symbol:
        """Return the symbol of a quantity; raise `KeyError` for an unknown id."""
        return self.families[id].symbol

    def chain(self, id: str, position: int | None = None, note: str = "") -> Chain:
        """Return the worked line: symbol = formula = substituted numbers = result with its unit.

        A quantity that is given or measured on a drawing has no formula: symbol = value. Raises `KeyError` for an
        unknown id.
        """
        family = self.families[id]
        result = self.number(id, position)
        if family.arm:
            result = Number(abs(result.value), result.decimals, result.unit)
        if family.line is None or family.constructed or self._says_its_symbol(family):
            return Chain((family.symbol, result), note)
        line = self._signs_out(family.line, position)
        formula = _replace(line, lambda ref: self.symbol(ref.id))
        numbers = _in_radians(_replace(line, lambda ref: self._bare(ref.id, position)), result)
        parts: list[Expression] = [family.symbol, formula]
        if numbers != formula and not (isinstance(numbers, Number) and numbers.printed == result.printed):
            parts.append(numbers)
        return Chain((*parts, result), note)

    def _says_its_symbol(self, family: Family) -> bool:
        """Return True if its formula only names another quantity with the same symbol."""
        return isinstance(family.line, Ref) and self.symbol(family.line.id) == family.symbol

    def _bare(self, id: str, position: int | None) -> Number:
        """Return a number inside a line, without its unit (but degrees keep theirs)."""
        number = self.number(id, position, size=self.families[id].arm)
        return Number(number.value, number.decimals, "°" if number.unit == "°" else "")

    def _signs_out(self, node: Expression, position: int | None) -> Expression:
        """Return the definition at one position: its branch, signs of arms before terms, negligible terms left out."""
        match node:
            case Sum(terms):
                kept = [self._signs_out(term, position) for term in terms if not self._is_nothing(term, position)]
                if not kept:
                    return Number(0.0)
                return kept[0] if len(kept) == 1 else Sum(tuple(kept))
            case Negative(of):
                inner = self._signs_out(of, position)
                if isinstance(inner, Sum):
                    return Sum(tuple(_negated(term) for term in inner.terms))
                return _negated(inner)
            case Product(factors):
                minus = sum(self._is_negative_arm(factor, position) for factor in factors)
                product = Product(tuple(self._signs_out(factor, position) for factor in factors))
                return Negative(product) if minus % 2 else product
            case Fraction(top, Ref() as bottom) if self._is_negative_arm(bottom, position):
                return _negated(Fraction(self._signs_out(top, position), bottom))
            case Fraction(top, Product() as bottom):
                over, under = self._signs_out(top, position), self._signs_out(bottom, position)
                return _negated(Fraction(over, under.of)) if isinstance(under, Negative) else Fraction(over, under)
            case Call("branch", (Ref(id), *branches)):
                return self._signs_out(branches[int(self.families[id].at(position))], position)
            case _:
                return rebuild(node, lambda child: self._signs_out(child, position))

    def _is_negative_arm(self, factor: Expression, position: int | None) -> bool:
        if not isinstance(factor, Ref) or not self.families[factor.id].arm:
            return False
        return float(self.families[factor.id].at(position).real) < 0

    def _is_nothing(self, term: Expression, position: int | None) -> bool:
        return any(self.families[id].optional and self.families[id].at(position) == 0 for id in refs(term))

    def evaluate(
        self,
        changes: Mapping[str, Any] | None = None,
        *,
        entered: Entered | None = None,
        only: Container[str] | None = None,
    ) -> dict[str, np.ndarray]:
        """Evaluate all definitions again from the given data, with some values replaced; return the values (SI) by id.

        `changes` maps ids to SI values (a number or [N] over the positions), or to functions of the value computed and
        of all values before it; all dependent values follow. Changes may have a further axis in front, [cases, N], to
        evaluate many cases together. The result has [1] or [N] for each id, and [cases, N] or [cases, 1] for those that
        depend on such a change; undefined values are nan.

        `entered` is called with each id and the values so far. If `only` is given, the other families keep their
        values.
        """
        values: dict[str, np.ndarray] = {}
        # An impossible drawing (a sine above 1) gives NaN, and so do the values that depend on it.
        with np.errstate(all="ignore"):
            for id, family in self.families.items():
                change = None if changes is None else changes.get(id)
                if change is not None and not callable(change):
                    values[id] = np.atleast_1d(np.asarray(change))
                else:
                    values[id] = family.values
                    if family.definition is not None and (only is None or id in only):
                        values[id] = np.atleast_1d(np.asarray(evaluate(family.definition, values)))
                    if change is not None:
                        values[id] = np.atleast_1d(np.asarray(change(values[id], values)))
                if entered is not None:
                    entered(id, values)
        return values

    def ancestors(self, id: str) -> tuple[str, ...]:
        """Return every quantity on which a quantity depends, directly or through others, nearest first."""
        ancestors: dict[str, None] = {}
        waiting = list(self.inputs[id])
        while waiting:
            current = waiting.pop(0)
            if current not in ancestors:
                ancestors[current] = None
                waiting.extend(self.inputs[current])
        return tuple(ancestors)


def _negated(node: Expression) -> Expression:
    return node.of if isinstance(node, Negative) else Negative(node)


def _replace(node: Expression, change: Any) -> Expression:
    """Substitute as `substitute` does, and simplify a factor 1, a double minus, a fraction of a minus."""
    if isinstance(node, Ref):
        result: Expression = change(node)
        return result
    node = rebuild(node, lambda child: _replace(child, change))
    if isinstance(node, Fraction) and isinstance(node.top, Negative):
        return Negative(Fraction(node.top.of, node.bottom))
    if isinstance(node, Sum):
        return Sum((node.terms[0], *map(_sign_before, node.terms[1:])))
    return node


def _sign_before(term: Expression) -> Expression:
    """Return a later term of a sum without a negative number: the sign becomes that of the term."""
    match term:
        case Number(value) if value < 0:
            return Negative(replace(term, value=-value))
        case Negative(Number(value) as number) if value < 0:
            return replace(number, value=-value)
        case _:
            return term


# --- angles outside functions ------------------------------------------------------------------------


ARC_DECIMALS = 6
"""Smallest number of decimals of an angle in radians."""


def _in_radians(numbers: Expression, result: Number) -> Expression:
    """Return the numbers of a line with angles in radians if it computes with an angle itself.

    Arguments of functions stay in degrees. So do all angles if the result is an angle, or if only their ratios count.
    The angles get the fewest decimals with which the line gives the printed result, but not fewer than `ARC_DECIMALS`
    or the decimals of the result.
    """
    if result.unit == "°" or _power_of_angle(numbers) == 0:
        return numbers
    least = max(result.decimals or 0, ARC_DECIMALS)
    written = (_with_arcs(numbers, decimals) for decimals in range(least, least + ARC_DECIMALS))
    return next((one for one in written if _comes_to(one, result)), _with_arcs(numbers, least))


def _power_of_angle(node: Expression) -> int | None:
    """Return the power in which an angle outside functions is a factor; None for a sum with several powers."""
    match node:
        case Number(unit="°"):
            return 1
        case Sum(terms):
            powers = {_power_of_angle(term) for term in terms}
            return powers.pop() if len(powers) == 1 else None
        case Product(factors):
            each = [_power_of_angle(factor) for factor in factors]
            return None if None in each else sum(power for power in each if power is not None)
        case Fraction(top, bottom):
            above, below = _power_of_angle(top), _power_of_angle(bottom)
            return None if above is None or below is None else above - below
        case Negative(of):
            return _power_of_angle(of)
        case Power(base) | Root(base):
            # A power of an angle needs radians; a ratio of angles has no unit.
            return 0 if _power_of_angle(base) == 0 else None
        case _:
            return 0


def _with_arcs(node: Expression, decimals: int) -> Expression:
    match node:
        case Number(unit="°"):
            return Number(math.radians(node.printed), decimals)
        case Call():
            return node
        case _:
            return rebuild(node, lambda child: _with_arcs(child, decimals))


def _comes_to(numbers: Expression, result: Number) -> bool:
    value = float(evaluate(numbers))
    return (value if result.decimals is None else rounded(value, result.decimals)) == result.printed


def follow(
    ledger: Ledger, changes: Mapping[str, Any], *, entered: Entered | None = None, only: Container[str] | None = None
) -> dict[str, np.ndarray]:
    """Evaluate as `Ledger.evaluate` does, and give each vector the length that its size has, measured or laid off.

    Vectors (complex) are multiplied by |size|/|vector|, and left unchanged where this is not finite. Values are SI, by
    id, [1], [N] over the positions or [cases, N], as in `Ledger.evaluate`.
    """
    vectors = {size: one for size, one in ledger.vectors.items() if only is None or size in only}
    sizes: dict[str, list[str]] = {}
    for size, vector in vectors.items():
        sizes.setdefault(vector, []).append(size)

    def stretch(size: str, values: dict[str, np.ndarray]) -> None:
        vector = vectors[size]
        factor = np.abs(values[size]) / np.abs(values[vector])
        values[vector] = values[vector] * np.where(np.isfinite(factor), factor, 1.0)

    def enter(id: str, values: dict[str, np.ndarray]) -> None:
        if entered is not None:
            entered(id, values)
        if id in vectors and vectors[id] in values:
            stretch(id, values)
        for size in sizes.get(id, ()):
            if size in values:
                stretch(size, values)

    return ledger.evaluate(changes, entered=enter, only=only)


def standing_on(ledger: Ledger, id: str) -> tuple[str, ...]:
    """Return all quantities on which a quantity depends, nearest first.

    These are its `ancestors` and the sizes read from the vectors among them.
    """
    read: dict[str, list[str]] = {}
    order = {name: index for index, name in enumerate(ledger.families)}
    for size, vector in ledger.vectors.items():
        read.setdefault(vector, []).append(size)
    ancestors: dict[str, None] = {}
    waiting = [id]
    while waiting:
        current = waiting.pop(0)
        nearer = [*ledger.inputs[current]]
        nearer += [size for size in read.get(current, ()) if order[size] < order[id]]
        for name in nearer:
            if name not in ancestors and name != id:
                ancestors[name] = None
                waiting.append(name)
    return tuple(ancestors)
