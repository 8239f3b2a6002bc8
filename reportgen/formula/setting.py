"""A formula as it is set: signs, parentheses and places for breaks are put in once, for all writers and labels.

`laid` turns an expression into a few kinds of parts.  A `Setter` says what each of them looks like and decides nothing
else; columns are what vector equations are made of, and `rows` makes the lines of all others.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import repeat
from typing import ClassVar, Generic, Literal, TypeVar

from reportgen.base.errors import TypesetterError
from reportgen.base.units import Language, by_power_of_ten, write
from reportgen.formula import (
    Call,
    Chain,
    Expression,
    Fraction,
    Matrix,
    Negative,
    Number,
    Power,
    Product,
    Ref,
    Root,
    Sum,
    Symbol,
    Term,
    VectorEquation,
)

RELATION, SUM, PRODUCT, QUOTIENT, MARKED, ATOM = range(6)
"""Levels of binding, the loosest first; MARKED is an atom that already carries a unit or superscript."""
PRIMES = "′″"
NAMED = frozenset({"sin", "cos", "tan", "arcsin", "arccos", "arctan", "min", "max", "arg"})
"""Functions that typesetters know by name; any other prints its own name upright."""
BARE = NAMED | {"inv", "arcinv"}
"""Functions whose argument needs no parentheses."""
UNSPACED = ("", "°", "%")
"""Units that follow their number without a space."""
NARROW = "\N{NARROW NO-BREAK SPACE}"
"""Between a number and its unit in words."""

Role = Literal["prefix", "sum", "product", "slash", "bound", "first", "relation", "last", "separator"]
"""A line may end before a sign of a sum, a product or a relation, but not at a bound sign nor at a chain's first "=" or
a last one before 0."""

# --- parts ----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Sign:
    """A sign between two parts, or before one."""

    of: str
    role: Role

    @property
    def text(self) -> str:
        """The sign in plain text, with the white beside it."""
        if self.role in ("prefix", "product", "slash"):
            return self.of
        return f"{self.of} " if self.role == "separator" else f" {self.of} "


@dataclass(frozen=True, slots=True)
class Written:
    """A number as it is read, in the digits of a language, and its unit."""

    digits: str
    unit: str

    def text(self, gap: str) -> str:
        """Both as plain text, with `gap` between them unless the unit stands close."""
        return self.digits + (gap if self.spaced else "") + self.unit

    @property
    def spaced(self) -> bool:
        return self.unit not in UNSPACED


@dataclass(frozen=True, slots=True)
class MathRow:
    parts: tuple[Part, ...]


@dataclass(frozen=True, slots=True)
class Raised:
    base: Part
    exponent: Part


@dataclass(frozen=True, slots=True)
class Quotient:
    top: Part
    bottom: Part


@dataclass(frozen=True, slots=True)
class Radical:
    of: Part


@dataclass(frozen=True, slots=True)
class Fence:
    """What is one piece for the signs beside it; its marks are "" where it is not misread without them."""

    left: Literal["(", "[", "|", ""]
    of: Part
    right: Literal[")", "]", "|", ""]


@dataclass(frozen=True, slots=True)
class Function:
    """A function before its argument, which is in a fence unless it is one letter."""

    name: str
    exponent: Part | None
    to: Part


@dataclass(frozen=True, slots=True)
class Grid:
    rows: tuple[tuple[Part, ...], ...]


@dataclass(frozen=True, slots=True)
class Note:
    """A reason, printed in parentheses behind a line."""

    text: str


@dataclass(frozen=True, slots=True)
class Bracket:
    """A parenthesis of a sum that goes on over several lines; `tall` beside terms higher than a line."""

    of: Literal["(", ")"]
    tall: bool


Part = Symbol | Written | Sign | MathRow | Raised | Quotient | Radical | Fence | Function | Grid | Note | Bracket

NEGATIVE, PLUS, MINUS = Sign("−", "prefix"), Sign("+", "sum"), Sign("−", "sum")
DOT, SLASH = Sign("·", "product"), Sign("/", "slash")
FIRST, EQUALS, LAST, BOUND = Sign("=", "first"), Sign("=", "relation"), Sign("=", "last"), Sign("=", "bound")

# --- a line ---------------------------------------------------------------------------------------


def laid(node: Expression, language: Language, slashed: bool = False, linear: bool = False) -> Part:
    """An expression as it is set in a line.

    `slashed` fractions keep the line's height.  In `linear` text roots have no bar and functions no letters of their
    own, so that these have parentheses, too.  Raises `TypesetterError` for a reference that nobody has substituted.
    """

    def of(node: Expression) -> Part:
        match node:
            case Symbol():
                return node
            case Number(value, decimals, unit) if parts := by_power_of_ten(value, decimals):
                factor = Written(write(parts.factor, parts.decimals, language), "")
                power = of(Power(Number(10.0), Number(float(parts.exponent))))
                return MathRow((factor, DOT, power, *([Written("", unit)] if unit else [])))
            case Number():
                return written(node, language)
            case Ref(id):
                raise TypesetterError(f"quantity {id!r} came to the page without its symbol or value")
            case Sum(members):
                return MathRow((of(members[0]), *(part for term in members[1:] for part in signed(term))))
            case Product(factors):
                return MathRow(tuple(_joined((tight(factor, PRODUCT) for factor in factors), repeat(DOT))))
            case Negative(inner):
                return MathRow((NEGATIVE, tight(inner, PRODUCT)))
            case Fraction(top, bottom) if slashed or linear:
                return MathRow((tight(top, PRODUCT), SLASH, tight(bottom, ATOM)))
            case Fraction(top, bottom):
                return Quotient(of(top), of(bottom))
            case Power(Call(name, arguments), exponent) if name in NAMED and not linear:
                return applied(name, arguments, of(exponent))
            case Power(base, exponent):
                return Raised(tight(base, ATOM), raised(exponent))
            case Root(inner):
                return Radical(Fence("(", of(inner), ")") if linear else of(inner))
            case Call("abs" | "size", (argument,)):
                return Fence("|", of(argument), "|")
            case Call("cross" | "dot" as product, (left, right)):
                sign = Sign("×" if product == "cross" else "·", "bound")
                return MathRow((tight(left, QUOTIENT), sign, tight(right, QUOTIENT)))
            case Call(name, arguments):
                return applied(name, arguments, None)
            case Matrix(rows):
                return Fence("[", Grid(tuple(tuple(map(of, row)) for row in rows)), "]")
            case Chain(parts):
                signs = [FIRST] + [EQUALS] * (len(parts) - 2)
                if short_end(node):
                    signs[-1] = LAST
                return noted(MathRow(tuple(_joined(map(of, parts), signs))), node)
            case VectorEquation():
                line: list[Part] = []
                for before, term in terms(node):
                    line += (*before, term.symbol)
                return MathRow(tuple(line))

    def tight(node: Expression, least: int) -> Fence:
        return Fence("", of(node), "") if level(node, linear) >= least else Fence("(", of(node), ")")

    def raised(exponent: Expression) -> Part:
        return tight(exponent, MARKED) if linear else of(exponent)

    def signed(term: Expression) -> tuple[Sign, Part]:
        return (MINUS, tight(term.of, PRODUCT)) if isinstance(term, Negative) else (PLUS, tight(term, PRODUCT))

    def applied(name: str, arguments: Sequence[Expression], exponent: Part | None) -> Function:
        if len(arguments) == 1 and name in BARE and level(arguments[0]) >= MARKED and not linear:
            return Function(name, exponent, of(arguments[0]))
        # A comma is the decimal mark in Vietnamese.
        mark = Sign(";" if language == "vi" else ",", "separator")
        return Function(name, exponent, Fence("(", MathRow(tuple(_joined(map(of, arguments), repeat(mark)))), ")"))

    return of(node)


def _joined(parts: Iterable[Part], signs: Iterable[Sign]) -> Iterator[Part]:
    first, *others = parts
    yield first
    for sign, part in zip(signs, others, strict=False):
        yield from (sign, part)


def noted(part: Part, node: Expression) -> Part:
    """A part with the reason that a chain has behind its result."""
    return MathRow((part, Note(node.note))) if isinstance(node, Chain) and node.note else part


def level(node: Expression, linear: bool = False) -> int:
    """How tightly a node binds; a parent that needs a higher level puts it in parentheses."""
    match node:
        case Chain() | VectorEquation():
            return RELATION
        case Sum() | Negative():
            return SUM
        case Number():
            large = by_power_of_ten(node.value, node.decimals)
            return SUM if node.shown < 0 else PRODUCT if large else MARKED if node.unit else ATOM
        case Product():
            return PRODUCT
        case Fraction() | Power() | Call("cross" | "dot"):
            return QUOTIENT
        case Call() | Root():
            return ATOM if linear else QUOTIENT
        case Symbol():
            return MARKED if node.sup or node.base.endswith(tuple(PRIMES)) else ATOM
        case _:
            return ATOM


def is_tall(part: Part) -> bool:
    """Whether a part is higher than a line."""
    match part:
        case Quotient() | Radical() | Grid():
            return True
        case MathRow(parts):
            return any(map(is_tall, parts))
        case Bracket(tall=tall):
            return tall
        case Raised(base, exponent):
            return is_tall(base) or is_tall(exponent)
        case Fence(of=inner) | Function(to=inner):
            return is_tall(inner)
        case _:
            return False


def written(number: Number, language: Language) -> Written:
    return Written(write(number.value, number.decimals, language), number.unit)


def parted(symbol: Symbol) -> tuple[str, str]:
    """A symbol's letters, and what stands above behind them: their primes and the superscript."""
    letters = symbol.base.rstrip(PRIMES)
    return letters, symbol.base[len(letters) :] + symbol.sup


def short_end(row: Expression) -> bool:
    """Whether a row ends in "= 0", which must not stand on a line of its own."""
    return isinstance(row, Chain) and isinstance(row.parts[-1], Number) and row.parts[-1].shown == 0


# --- vector equations -----------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class TermColumn:
    """Of a vector equation: the signs before a term, the term itself, what is known of it in the equation's rows."""

    signs: tuple[Sign, ...]
    term: Part
    known: tuple[Expression | str | None, ...]


def terms(equation: VectorEquation) -> Iterator[tuple[tuple[Sign, ...], Term]]:
    """Each term with the signs before it: "=" at the head of a later side, then its own."""
    for side, members in enumerate(equation.sides):
        for index, term in enumerate(members):
            if index:
                yield (Sign("−" if term.sign < 0 else "+", "bound"),), term
            else:
                yield (BOUND,) * bool(side) + (NEGATIVE,) * (term.sign < 0), term


def columns(equation: VectorEquation) -> list[TermColumn]:
    """The columns of a vector equation.

    A last "= 0", of which nothing is known, stands with the term before it: no row is broken between them.
    """
    found: list[TermColumn] = []
    for signs, term in terms(equation):
        if found and signs[:1] == (BOUND,) and not any(entry != "" for entry in term.known):
            found[-1] = TermColumn(found[-1].signs, MathRow((found[-1].term, *signs, term.symbol)), found[-1].known)
        else:
            found.append(TermColumn(signs, term.symbol, known_of(term, equation)))
    return found


def known_of(term: Term, equation: VectorEquation) -> tuple[Expression | str | None, ...]:
    """What is known of a term, an entry for each of the equation's rows."""
    rows = len(equation.rows)
    return (*term.known, *("",) * (rows - len(term.known)))[:rows]


# --- looks ----------------------------------------------------------------------------------------

Look = TypeVar("Look")


class Setter(ABC, Generic[Look]):
    """What the parts of formulas look like in one language: a typesetter's text, runs of a label, a box."""

    linear: ClassVar[bool] = False
    """Whether it sets letters in a line alone: fractions with a slash, roots without a bar."""

    def __init__(self, language: Language) -> None:
        self.language: Language = language

    def math(self, node: Expression, slashed: bool = False) -> Look:
        """The formula of an expression.

        Raises `TypesetterError` for a reference that nobody has substituted, or a character without a glyph.
        """
        return self.part(laid(node, self.language, slashed, self.linear))

    def content(self, content: Expression | str, slashed: bool = False) -> Look:
        """A formula in a line, or a plain text."""
        return self.text(content) if isinstance(content, str) else self.inline(self.math(content, slashed))

    def known(self, entry: Expression | str | None) -> Look:
        """What is known of a vector, in the row below its term: "?" for nothing; a fraction keeps to the line."""
        return self.content("?" if entry is None else entry, slashed=True)

    def inline(self, mathematics: Look) -> Look:
        """Mathematics as it stands within words."""
        return mathematics

    @abstractmethod
    def text(self, text: str) -> Look: ...

    @abstractmethod
    def part(self, part: Part) -> Look: ...


class TextSetter(Setter[str]):
    """A look in letters, operands in the places of "%s"."""

    BELOW: ClassVar[str] = "%s%s"
    RAISED: ClassVar[str] = "%s^%s"
    POWER: ClassVar[str] = "%s^%s"
    """Of a function."""
    QUOTIENT: ClassVar[str] = "(%s)/(%s)"
    RADICAL: ClassVar[str] = "√%s"
    FENCES: ClassVar[Mapping[str, str]] = {"": "%s", "(": "(%s)", "|": "|%s|", "[": "[%s]"}
    ENTRY: ClassVar[str] = "; "
    LINE: ClassVar[str] = " | "
    """Between the entries and the rows of a matrix."""
    APPLIED: ClassVar[str] = "%s%s"
    """A function and what it is applied to without a fence."""
    CALL: ClassVar[str] = "%s%s"
    NOTE: ClassVar[str] = " %s"

    def part(self, part: Part) -> str:
        of = self.part
        match part:
            case Symbol():
                return self.symbol(part)
            case Written():
                return self.number(part)
            case Sign():
                return self.sign(part)
            case MathRow(parts):
                return "".join(map(of, parts))
            case Raised(base, exponent):
                return self.RAISED % (of(base), of(exponent))
            case Quotient(top, bottom):
                return self.QUOTIENT % (of(top), of(bottom))
            case Radical(inner):
                return self.RADICAL % of(inner)
            case Fence():
                return self.fence(part)
            case Function(name, exponent, to):
                function = self.function(name)
                function = self.POWER % (function, of(exponent)) if exponent else function
                return (self.CALL if isinstance(to, Fence) else self.APPLIED) % (function, of(to))
            case Grid(rows):
                return self.LINE.join(self.ENTRY.join(map(of, row)) for row in rows)
            case Note(text):
                return self.NOTE % self.text(f"({text})")
            case Bracket():
                return self.bracket(part)

    def lowered(self, pieces: Iterable[tuple[str, str]], shown: Callable[[str], str]) -> str:
        """A symbol's letters with the digits of points below them, no smaller than an index."""
        return "".join(
            self.BELOW % (shown(letters), self.upright(digits)) if digits else shown(letters)
            for letters, digits in pieces
        )

    def upright(self, letters: str) -> str:
        return self.text(letters)

    def fence(self, fence: Fence) -> str:
        return self.FENCES[fence.left] % self.part(fence.of)

    def bracket(self, mark: Bracket) -> str:
        return self.text(mark.of)

    @abstractmethod
    def symbol(self, node: Symbol) -> str: ...

    @abstractmethod
    def number(self, number: Written) -> str: ...

    @abstractmethod
    def sign(self, sign: Sign) -> str: ...

    @abstractmethod
    def function(self, name: str) -> str: ...
