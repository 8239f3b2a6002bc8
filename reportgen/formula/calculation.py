"""A sheet of formulas: named quantities with their definitions, each entered once and evaluated when it is entered.

A machine opens the sheet with its given data; the ledger adds entries position by position. `define` and `give`
return the quantity as an expression, so that the next formula can be written with it:

    R = q.define("R", H / 2)
    L = q.define("L", R / λ)
    q.set_out("synthesis", R, L)

The last line groups worked lines that the report prints together, under the name that templates use.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from reportgen.formula import Call, Expression, Number, Operand, Ref, Symbol, as_expression, refs, vocabulary, walk
from reportgen.formula.evaluation import evaluate
from reportgen.formula.vocabulary import KINDS, MAX_DIGITS, KeyChapter, QuantityKind

ZERO = 1e-9
"""A value below this share of its own scale is negligible and prints as 0."""

DUST = 1e-12
"""Shares of a value below this are of floats."""

COMPUTED = 1e-9
"""A computed value is as exact as this share of it, those of integrals among them."""

TYPED = 10
"""Significant figures that given data have at most."""

BELOW_A_TURN = 1e-12
"""An angle this little below a whole turn (rad) is one."""

CONSTRUCTIONS = frozenset(
    {"meet", "circle_line", "circle_circle", "abs", "cis", "turned", "arg", "re", "im", "cross", "dot"}
    | {
        "mean",
        "level",
        "excess",
        "along",
        "summed",
        "stepped",
        "highest",
        "lowest",
        "quotient",
        "if_zero",
        "sign",
        "heading",
    }
)
"""Functions that represent drawing and measuring: a definition with one of them is not printed as a formula."""


@dataclass(frozen=True, slots=True)
class Family:
    """One quantity at all positions.

    `values` are SI (complex for a point or vector of the plane), one per position or a single one. `definition` is
    None for given data. `exact` data print as they were given. An `arm` is a signed length printed by its size, its
    sign going to the term that contains it; an `optional` term is left out of a sum where it is negligible. `scale`
    is a reference size: a value below 1e-9 of it is negligible. A `hidden` family serves a construction and is
    never printed. `of` is the id of the size whose direction, signed value or vector this is, of an arm the load,
    `about` the point an arm is measured from; both are "" for any other quantity. `written` is a formula of the
    same value that replaces the definition on the page, where printed figures would be too few for that. A
    `residue` is the rounding difference of two ways to one number. A `converted` value was typed in a unit that
    gives more figures than anyone types; it is rounded like a result.
    """

    id: str
    symbol: Symbol
    kind: str
    values: np.ndarray
    definition: Expression | None = None
    exact: bool = False
    arm: bool = False
    optional: bool = False
    scale: float = 0.0
    hidden: bool = False
    chapter: KeyChapter = KeyChapter.geometry
    of: str = ""
    about: str = ""
    written: Expression | None = None
    residue: bool = False
    converted: bool = False

    @property
    def line(self) -> Expression | None:
        """The formula of its line on the page."""
        return self.definition if self.written is None else self.written

    @property
    def how(self) -> QuantityKind:
        """The unit and the number of figures with which it is printed."""
        return KINDS[self.kind]

    @property
    def is_plane(self) -> bool:
        """True if its values are points or vectors of the plane, which are drawn and not printed."""
        return bool(np.iscomplexobj(self.values))

    @property
    def is_direction(self) -> bool:
        """True if it is the angle of a vector from +x."""
        return vocabulary.row(self.id).around

    @property
    def is_of_vector(self) -> bool:
        """True if it is an angle of the vector of size `of`; a vector of length 0 has none."""
        return bool(self.of) and self.how.unit == "°"

    @property
    def is_signed_rotation(self) -> bool:
        """True if it is a signed angular velocity or acceleration whose size is another quantity."""
        return bool(self.of) and self.kind in ("angular velocity", "angular acceleration")

    @property
    def constructed(self) -> bool:
        """True if it is measured on a drawing, not computed by a printed formula."""
        return self.line is not None and any(
            isinstance(part, Call) and part.name in CONSTRUCTIONS for part in walk(self.line)
        )

    def at(self, position: int | None) -> Any:
        """Return its SI value at a position counted from 1; a negligible value is exactly 0."""
        value = self.values[0 if len(self.values) == 1 or position is None else position - 1]
        return value * 0 if abs(value) < ZERO * self.scale else value


class Calculation:
    """Quantities in the order of their definition, over `positions` positions; each is evaluated when it is entered."""

    def __init__(self, positions: int = 1) -> None:
        self.positions = positions
        self.families: dict[str, Family] = {}
        self.typed: dict[str, Number] = {}
        """Given data in the units that they were typed with."""
        self.lines: dict[str, tuple[str, ...]] = {}
        """Ids of the lines that the report sets out together, by the names that templates use."""
        self.chapter = KeyChapter.geometry
        """Chapter of quantities for which the vocabulary gives none."""
        self._values: dict[str, np.ndarray] = {}
        self._inputs: dict[str, tuple[str, ...]] = {}

    def copy(self, positions: int = 0) -> Calculation:
        """Return a copy with the entries so far, for more entries; `positions` changes the number of positions."""
        copy = Calculation(positions or self.positions)
        copy.families, copy._values, copy.lines = dict(self.families), dict(self._values), dict(self.lines)
        copy.chapter, copy.typed = self.chapter, dict(self.typed)
        return copy

    def extend(self, sheet: Calculation) -> None:
        """Enter all quantities of another sheet; raises `ValueError` for a quantity that is on both."""
        for family in sheet.families.values():
            self.enter(family)
        for name, ids in sheet.lines.items():
            self.set_out(name, *ids)

    def set_out(self, name: str, *quantities: Ref | str) -> None:
        """Let the report print these quantities in this order, after those already under this name.

        A quantity may be entered later; one that never is, is left out.
        """
        ids = (quantity if isinstance(quantity, str) else quantity.id for quantity in quantities)
        self.lines[name] = (*self.lines.get(name, ()), *ids)

    def worked(self, *quantities: Ref) -> tuple[Ref, ...]:
        """Return the quantities that have a formula, leaving out given data."""
        return tuple(quantity for quantity in quantities if self.families[quantity.id].definition is not None)

    @contextmanager
    def within(self, chapter: KeyChapter) -> Iterator[None]:
        """Assign entries made in this context to a chapter: always if it is `formulas`, else if the vocabulary
        gives none.
        """
        before, self.chapter = self.chapter, chapter
        yield
        self.chapter = before

    def __contains__(self, id: str) -> bool:
        return id in self.families

    def __getitem__(self, id: str) -> Ref:
        """Return a quantity that is entered, as an expression; raises `KeyError` for any other."""
        return Ref(self.families[id].id)

    def find(self, id: str) -> Ref | None:
        """Return a quantity as an expression, None if it is not entered."""
        return Ref(id) if id in self.families else None

    def inputs(self, id: str) -> tuple[str, ...]:
        """Return the ids that the definition of a quantity names."""
        if id not in self._inputs:
            definition = self.families[id].definition
            self._inputs[id] = () if definition is None else refs(definition)
        return self._inputs[id]

    def value(self, quantity: str | Ref) -> np.ndarray:
        """Return the SI values of a quantity, one or one per position."""
        return self._values[quantity if isinstance(quantity, str) else quantity.id]

    def si(self, quantity: str | Ref) -> float:
        """Return the SI value of a quantity that has one for all positions."""
        return float(self.value(quantity)[0])

    def give(
        self, id: str, value: Any, symbol: Symbol | str = "", kind: str = "", *, exact: bool = True, **traits: Any
    ) -> Ref:
        """Enter given data (SI): a number, or one per position."""
        values = np.atleast_1d(np.asarray(value))
        return self._enter(id, symbol, kind, values, None, exact=exact, **traits)

    def define(self, id: str, definition: Operand, symbol: Symbol | str = "", kind: str = "", **traits: Any) -> Ref:
        """Enter a quantity defined by earlier ones; raises `KeyError` if one of them is missing."""
        expression = as_expression(definition)
        with np.errstate(all="ignore"):
            values = np.atleast_1d(np.asarray(evaluate(expression, self._values)))
        return self._enter(id, symbol, kind, values, expression, **traits)

    def angle(self, id: str, values: np.ndarray, symbol: Symbol | str = "") -> Ref:
        """Enter an angle at every position [N], within one turn; whole hundredths of a degree print as they are."""
        turned = np.mod(values + BELOW_A_TURN, 2 * np.pi) - BELOW_A_TURN
        hundredths = np.degrees(turned) * 100
        whole = bool(np.allclose(hundredths, np.round(hundredths), rtol=0, atol=1e-7))
        return self.give(id, turned, symbol, "angle", exact=whole, scale=1.0)

    def construct(self, id: str, definition: Operand, of: str = "") -> Ref:
        """Enter a point or vector of a drawing, which has no printed symbol."""
        return self.define(id, definition, Symbol(id), "ratio", hidden=True, of=of)

    def _enter(
        self, id: str, symbol: Symbol | str, kind: str, values: np.ndarray, definition: Expression | None, **traits: Any
    ) -> Ref:
        row = vocabulary.row(id)
        if isinstance(symbol, str):
            symbol = Symbol(symbol) if symbol else vocabulary.symbol(id)
        chapter = KeyChapter.formulas if self.chapter is KeyChapter.formulas else row.chapter or self.chapter
        return self.enter(Family(id, symbol, kind or row.kind, values, definition, chapter=chapter, **traits))

    def enter(self, family: Family) -> Ref:
        """Enter a quantity unchanged; raises `ValueError` for one that is defined twice or has too few values."""
        id, count = family.id, len(family.values)
        if id in self.families:
            raise ValueError(f"quantity {id} is defined twice")
        if count not in (1, self.positions):
            raise ValueError(f"quantity {id} has {count} values")
        self.families[id] = family
        self._values[id] = family.values
        return Ref(id)


def is_typed(values: np.ndarray | float) -> bool:
    """Return True if the values have finitely many decimals, as typed ones do; 360°/7 does not."""
    sizes = np.abs(np.atleast_1d(values))
    return all(abs(float(f"{size:.{TYPED}g}") - size) <= DUST * sizes.max() for size in sizes)


def is_short(values: np.ndarray | float) -> bool:
    """Return True if values have few digits, as typed ones do, and can be printed exactly (0.171 m)."""
    return bool(np.all(np.abs(shortened(values) - values) <= COMPUTED * np.abs(values)))


def shortened(values: np.ndarray | float) -> np.ndarray:
    """Return values with the few digits that a value has which is printed as it is."""
    return np.array([float(f"{value:.{MAX_DIGITS - 1}g}") for value in np.atleast_1d(values)])
