"""A calculation: named quantities with their definitions, each entered once and evaluated when it is entered.

A machine starts the calculation with its given data; further entries follow position by position. `define` and `give`
return the quantity as an expression, so that the next formula can be written with it:

    R = q.define("R", H / 2)
    L = q.define("L", R / λ)
    q.set_out("synthesis", R, L)

The last line groups worked lines that the report prints together, under the name that templates use.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from reportgen.base.records import Record
from reportgen.formula import Call, Expression, Number, Operand, Ref, Symbol, as_expression, refs, vocabulary, walk
from reportgen.formula.evaluation import evaluate
from reportgen.formula.vocabulary import KINDS, MAX_DIGITS, KeyChapter, QuantityKind

ZERO = 1e-9
"""A value below this share of its own scale is negligible and prints as 0."""

DUST = 1e-12
"""Relative differences below this are floating-point errors."""

COMPUTED = 1e-9
"""Relative accuracy of computed values, including integrals."""

TYPED = 10
"""Largest number of significant figures of given data."""

BELOW_A_TURN = 1e-12
"""An angle that is less than this (rad) below a full turn counts as a full turn."""

CONSTRUCTIONS = frozenset(
    {"meet", "circle_line", "circle_circle", "plate_place", "abs", "cis", "turned", "arg", "re", "im", "cross", "dot"}
    | {
        "mean",
        "level",
        "excess",
        "along",
        "summed",
        "stepped",
        "line_area",
        "line_at",
        "crossing",
        "highest",
        "lowest",
        "quotient",
        "if_zero",
        "sign",
        "heading",
    }
)
"""Functions that represent drawing and measuring: a definition with one of them is not printed as a formula."""


class Family(Record):
    """One quantity at all positions.

    `values` are SI (complex for a point or vector of the plane): [N] over the positions, or [1] if they do not vary.
    `definition` is None for given data. `exact` data print as they were given. An `arm` is a signed length that prints
    its size; its sign moves to the term that contains it. An `optional` term is left out of a sum where it is
    negligible. `scale` is a reference size (SI): a value below 1e-9 of it is negligible. A `hidden` family serves a
    construction and is never printed. `of` is the id of the size whose direction, signed value or vector this is, for
    an arm the id of the load; `about` is the point from which an arm is measured. Both are "" for any other quantity.
    `written` is a formula of the same value that replaces the definition on the page, where printed figures would be
    too few for that. A `residue` is the rounding difference of two computations of one number. A `converted` value was
    typed in a unit that gives more figures than anyone types; it is rounded like a result. A `trial` value belongs to a
    step of an iteration: it depends on where the iteration starts, so nobody is asked for it. A value that a part of a
    coursework gives the machine has in `from_part` its key in the machine's file.
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
    trial: bool = False
    from_part: str = ""

    @property
    def line(self) -> Expression | None:
        """The formula of its line on the page."""
        return self.definition if self.written is None else self.written

    @property
    def how(self) -> QuantityKind:
        """The printed unit with its factor to SI, and the number of figures or decimals."""
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
        """True if it is an angle of the vector with the size `of`; a vector of length 0 has none."""
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
        """Return the SI value at a position counted from 1, a scalar; a negligible value is exactly 0.

        A point or vector of the plane gives a complex number. The position is ignored if there is only one value; None
        selects the first.
        """
        value = self.values[0 if len(self.values) == 1 or position is None else position - 1]
        return value * 0 if abs(value) < ZERO * self.scale else value


class Calculation:
    """Quantities in the order of their definition, over `positions` positions; each is evaluated when it is entered.

    Values are SI, [N] over the positions, or [1] for a quantity that does not vary.
    """

    def __init__(self, positions: int = 1) -> None:
        self.positions = positions
        self.families: dict[str, Family] = {}
        self.typed: dict[str, Number] = {}
        """Given data in the units in which they were typed."""
        self.lines: dict[str, tuple[str, ...]] = {}
        """Ids of the lines that the report prints together, by the names that templates use."""
        self.chapter = KeyChapter.geometry
        """Chapter of quantities for which the vocabulary gives none."""
        self._values: dict[str, np.ndarray] = {}
        self._inputs: dict[str, tuple[str, ...]] = {}

    def copy(self, positions: int = 0) -> Calculation:
        """Return a copy with the entries so far, for further ones; `positions` > 0 changes the number of positions."""
        copy = Calculation(positions or self.positions)
        copy.families, copy._values, copy.lines = dict(self.families), dict(self._values), dict(self.lines)
        copy.chapter, copy.typed = self.chapter, dict(self.typed)
        return copy

    def extend(self, sheet: Calculation) -> None:
        """Enter all quantities of another calculation; raise `ValueError` for a quantity that both have."""
        for family in sheet.families.values():
            self.enter(family)
        for name, ids in sheet.lines.items():
            self.set_out(name, *ids)

    def set_out(self, name: str, *quantities: Ref | str) -> None:
        """Let the report print these quantities in this order, after those already under this name.

        A quantity may be entered later; one that is never entered is left out.
        """
        ids = (quantity if isinstance(quantity, str) else quantity.id for quantity in quantities)
        self.lines[name] = (*self.lines.get(name, ()), *ids)

    def worked(self, *quantities: Ref) -> tuple[Ref, ...]:
        """Return the quantities that have a formula, leaving out given data."""
        return tuple(quantity for quantity in quantities if self.families[quantity.id].definition is not None)

    @contextmanager
    def within(self, chapter: KeyChapter) -> Iterator[None]:
        """Assign entries made in this context to a chapter.

        The chapter `formulas` always applies, any other one only if the vocabulary gives none.
        """
        before, self.chapter = self.chapter, chapter
        yield
        self.chapter = before

    def __contains__(self, id: str) -> bool:
        return id in self.families

    def __getitem__(self, id: str) -> Ref:
        """Return an entered quantity as an expression; raise `KeyError` for any other id."""
        return Ref(self.families[id].id)

    def find(self, id: str) -> Ref | None:
        """Return a quantity as an expression, None if it is not entered."""
        return Ref(id) if id in self.families else None

    def inputs(self, id: str) -> tuple[str, ...]:
        """Return the ids in the definition of a quantity; raise `KeyError` for an id that is not entered."""
        if id not in self._inputs:
            definition = self.families[id].definition
            self._inputs[id] = () if definition is None else refs(definition)
        return self._inputs[id]

    def value(self, quantity: str | Ref) -> np.ndarray:
        """Return the SI values of a quantity: [N] over the positions, or [1] if it does not vary.

        Points and vectors of the plane are complex. Raises `KeyError` for an id that is not entered.
        """
        return self._values[quantity if isinstance(quantity, str) else quantity.id]

    def si(self, quantity: str | Ref) -> float:
        """Return the SI value of a quantity that does not vary, or its value at the first position.

        Raises `KeyError` for an id that is not entered.
        """
        return float(self.value(quantity)[0])

    def give(
        self, id: str, value: Any, symbol: Symbol | str = "", kind: str = "", *, exact: bool = True, **traits: Any
    ) -> Ref:
        """Enter given data (SI), a number or an array [N] over the positions.

        Without a symbol or kind, the vocabulary gives it; `traits` are further fields of the `Family`. Raises
        `ValueError` for a quantity that is entered twice or has neither 1 nor N values.
        """
        values = np.atleast_1d(np.asarray(value))
        return self._enter(id, symbol, kind, values, None, exact=exact, **traits)

    def define(self, id: str, definition: Operand, symbol: Symbol | str = "", kind: str = "", **traits: Any) -> Ref:
        """Enter a quantity that earlier ones define.

        Its values (SI) have the broadcast shape of its inputs, [N] over the positions or [1]; undefined values are nan
        or infinite. Raises `KeyError` if an input is missing, and `ValueError` as `give` does.
        """
        expression = as_expression(definition)
        with np.errstate(all="ignore"):
            values = np.atleast_1d(np.asarray(evaluate(expression, self._values)))
        return self._enter(id, symbol, kind, values, expression, **traits)

    def angle(self, id: str, values: np.ndarray, symbol: Symbol | str = "") -> Ref:
        """Enter an angle (rad) at every position [N], reduced to one turn.

        If all values are whole hundredths of a degree, they print as they are.
        """
        turned = np.mod(values + BELOW_A_TURN, 2 * np.pi) - BELOW_A_TURN
        hundredths = np.degrees(turned) * 100
        whole = bool(np.allclose(hundredths, np.round(hundredths), rtol=0, atol=1e-7))
        return self.give(id, turned, symbol, "angle", exact=whole, scale=1.0)

    def construct(self, id: str, definition: Operand, of: str = "") -> Ref:
        """Enter a point or vector of a drawing (complex), which has no printed symbol."""
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
        """Enter a quantity unchanged; raise `ValueError` if it is defined twice or has neither 1 nor N values."""
        id, count = family.id, len(family.values)
        if id in self.families:
            raise ValueError(f"quantity {id} is defined twice")
        if count not in (1, self.positions):
            raise ValueError(f"quantity {id} has {count} values")
        self.families[id] = family
        self._values[id] = family.values
        return Ref(id)


def is_typed(values: np.ndarray | float) -> bool:
    """Return True if the values have finitely many decimals, as typed values do; 360°/7 does not.

    `values` is [N] or a scalar, in any unit. `TYPED` significant figures must give each of them, within `DUST` of the
    largest.
    """
    sizes = np.abs(np.atleast_1d(values))
    return all(abs(float(f"{size:.{TYPED}g}") - size) <= DUST * sizes.max() for size in sizes)


def is_short(values: np.ndarray | float) -> bool:
    """Return True if the values have few digits, as typed values do, and can be printed exactly (0.171 m).

    `values` is [N] or a scalar, in any unit. `shortened` must not change any of them by more than `COMPUTED` of its
    size.
    """
    return bool(np.all(np.abs(shortened(values) - values) <= COMPUTED * np.abs(values)))


def shortened(values: np.ndarray | float) -> np.ndarray:
    """Return the values rounded to the number of significant figures of exactly printed values (`MAX_DIGITS` − 1).

    `values` is [N] or a scalar, in any unit; the result is [N] or [1], in the same unit.
    """
    return np.array([float(f"{value:.{MAX_DIGITS - 1}g}") for value in np.atleast_1d(values)])
