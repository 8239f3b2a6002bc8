"""Layout of formulas: signs, parentheses and line breaks are decided once, for all writers and labels.

`laid` turns an expression into a few kinds of parts; a `Setter` renders each of them and decides nothing else.
Displayed equations are made of pieces, sides and columns. The rules for parts that are too wide for a line are
here, too: a fraction of a sum becomes 1/denominator times the sum, which breaks at its terms.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import repeat
from typing import Literal

from reportgen.base.errors import TypesetterError
from reportgen.base.languages import setting_of, unit_names
from reportgen.base.records import Record, replace
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
"""Levels of binding, the loosest first; MARKED is an atom that already has a unit or superscript."""
PRIMES = "′″"
NAMED = frozenset({"sin", "cos", "tan", "arcsin", "arccos", "arctan", "ln", "min", "max", "arg"})
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


class Sign(Record):
    """A sign between two parts, or before one."""

    of: str
    role: Role

    @property
    def text(self) -> str:
        """The sign in plain text, with the spaces beside it."""
        if self.role in ("prefix", "product", "slash"):
            return self.of
        return f"{self.of} " if self.role == "separator" else f" {self.of} "


class Written(Record):
    """A number as printed in the digits of a language, and its unit."""

    digits: str
    unit: str

    def text(self, gap: str) -> str:
        """Return digits and unit as plain text, with `gap` between them if the unit is `spaced`."""
        return self.digits + (gap if self.spaced else "") + self.unit

    @property
    def spaced(self) -> bool:
        """True if a space separates the number from its unit."""
        return self.unit not in UNSPACED


class MathRow(Record):
    """Parts side by side."""

    parts: tuple[Part, ...]


class Raised(Record):
    """A base with an exponent."""

    base: Part
    exponent: Part


class Quotient(Record):
    """A fraction with a bar."""

    top: Part
    bottom: Part


class Radical(Record):
    """A square root."""

    of: Part


class Fence(Record):
    """A group that neighbouring signs treat as one piece; its delimiters are "" if it is clear without them."""

    left: Literal["(", "[", "|", ""]
    of: Part
    right: Literal[")", "]", "|", ""]


class Function(Record):
    """A function before its argument, which is in a fence unless it is one letter.

    A symbol such as inv α, with a space between the name of a function and its argument, is one, too.
    """

    name: str
    exponent: Part | None
    to: Part


class Grid(Record):
    """The entries of a matrix, by rows."""

    rows: tuple[tuple[Part, ...], ...]


class Note(Record):
    """A reason, printed in parentheses behind a line."""

    text: str


class Parenthesis(Record):
    """A parenthesis of a sum that continues over several lines; `tall` beside terms higher than a line."""

    of: Literal["(", ")"]
    tall: bool


Part = Symbol | Written | Sign | MathRow | Raised | Quotient | Radical | Fence | Function | Grid | Note | Parenthesis
Fits = Callable[[Sequence[Part]], bool]
"""Predicate: True if the parts fit beside each other in a line."""

NEGATIVE, PLUS, MINUS = Sign("−", "prefix"), Sign("+", "sum"), Sign("−", "sum")
DOT, SLASH = Sign("·", "product"), Sign("/", "slash")
FIRST, EQUALS, LAST, BOUND = Sign("=", "first"), Sign("=", "relation"), Sign("=", "last"), Sign("=", "bound")

# --- a line ---------------------------------------------------------------------------------------


@lru_cache(maxsize=4096)
def laid(node: Expression, language: Language, slashed: bool = False, linear: bool = False) -> Part:
    """Return the layout of an expression in a line.

    `slashed` fractions do not exceed the line's height. In `linear` text, roots have no bar and functions no
    upright letters, so both need parentheses. Raises `TypesetterError` for a `Ref` that was not substituted.
    """

    def of(node: Expression) -> Part:
        match node:
            case Symbol(base) if " " in base:
                name, _, letters = base.rpartition(" ")
                return Function(name, None, replace(node, base=letters))
            case Symbol():
                return node
            case Number(value, decimals, unit) if parts := by_power_of_ten(value, decimals):
                factor = Written(write(parts.factor, parts.decimals, language), "")
                power = of(Power(Number(10.0), Number(float(parts.exponent))))
                return MathRow((factor, DOT, power, *([Written("", unit_names(language).get(unit))] if unit else [])))
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
            case Call("beyond" | "where_positive", (value, *_)):
                return of(value)
            case Call("single", (moment, force)):
                return of(moment / force)
            case Call(name, arguments):
                return applied(name, arguments, None)
            case Matrix(rows):
                return Fence("[", Grid(tuple(tuple(map(of, row)) for row in rows)), "]")
            case Chain(parts):
                signs = [FIRST] + [EQUALS] * (len(parts) - 2)
                if short_end(node):
                    signs[-1] = LAST
                return _noted(MathRow(tuple(_joined(map(of, parts), signs))), node)
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
        mark = Sign(setting_of(language).separator, "separator")
        return Function(name, exponent, Fence("(", MathRow(tuple(_joined(map(of, arguments), repeat(mark)))), ")"))

    return of(node)


def _joined(parts: Iterable[Part], signs: Iterable[Sign]) -> Iterator[Part]:
    first, *others = parts
    yield first
    for sign, part in zip(signs, others, strict=False):
        yield from (sign, part)


def _noted(part: Part, node: Expression) -> Part:
    """Return a part with the note of a chain after its result."""
    return MathRow((part, Note(node.note))) if isinstance(node, Chain) and node.note else part


def level(node: Expression, linear: bool = False) -> int:
    """Return the binding strength of a node; a parent that needs a higher level puts it in parentheses."""
    match node:
        case Chain() | VectorEquation():
            return RELATION
        case Sum() | Negative():
            return SUM
        case Number():
            large = by_power_of_ten(node.value, node.decimals)
            return SUM if node.printed < 0 else PRODUCT if large else MARKED if node.unit else ATOM
        case Product():
            return PRODUCT
        case Call("beyond" | "where_positive", (value, *_)):
            return level(value, linear)
        case Fraction() | Power() | Call("cross" | "dot" | "single"):
            return QUOTIENT
        case Call() | Root():
            return ATOM if linear else QUOTIENT
        case Symbol(base) if " " in base:
            return ATOM if linear else QUOTIENT
        case Symbol():
            return MARKED if node.sup or node.base.endswith(tuple(PRIMES)) else ATOM
        case _:
            return ATOM


def is_tall(part: Part) -> bool:
    """Return True if a part is higher than a line."""
    match part:
        case Quotient() | Radical() | Grid():
            return True
        case MathRow(parts):
            return any(map(is_tall, parts))
        case Parenthesis(tall=tall):
            return tall
        case Raised(base, exponent):
            return is_tall(base) or is_tall(exponent)
        case Fence(of=inner) | Function(to=inner):
            return is_tall(inner)
        case _:
            return False


def written(number: Number, language: Language) -> Written:
    """Return a number with the digits and the unit of a language."""
    return Written(write(number.value, number.decimals, language), unit_names(language).get(number.unit))


def parted(symbol: Symbol) -> tuple[str, str]:
    """Return a symbol's letters, and the marks above that follow them: primes and the superscript."""
    letters = symbol.base.rstrip(PRIMES)
    return letters, symbol.base[len(letters) :] + symbol.sup


# --- displayed rows -------------------------------------------------------------------------------


def sides(node: Expression, language: Language, fits: Fits | None = None, slashed: bool = False) -> list[Part]:
    """Return the sides between signs "=", the last with its note; sides that do not fit their line are opened."""
    sides = [laid(part, language, slashed) for part in (node.parts if isinstance(node, Chain) else (node,))]
    if fits is not None:
        head = (sides[0], EQUALS) if len(sides) > 1 else ()
        sides = [opened(part, lambda inner: fits((*head, inner))) for part in sides]
    return [*sides[:-1], _noted(sides[-1], node)]


def opened(part: Part, fits: Callable[[Part], bool]) -> Part:
    """Return a side of a row in a form that can break, if it does not fit.

    A fraction becomes a product, and a sum in parentheses may break inside: (a + b)/c becomes 1/c · (a + b), whose
    parentheses are both of one size.
    """
    match part:
        case _ if fits(part):
            return part
        case MathRow(parts):
            return MathRow(tuple(inner for one in parts for inner in _opened_in_row(one, fits)))
        case Fence("", inner):
            opened_inner = opened(inner, fits)
            return part if opened_inner == inner else opened_inner
        case Quotient(top, bottom) if _is_sum(top):
            return MathRow((Quotient(Written("1", ""), bottom), Sign("·", "bound"), *_marked(top)))
        case Fence("(", inner) if _is_sum(inner):
            return MathRow(_marked(inner))
        case _:
            return part


def _marked(part: Part) -> tuple[Part, ...]:
    """Return a sum between parentheses, so that its terms belong to the row itself."""
    return (
        Parenthesis("(", is_tall(part)),
        *(part.parts if isinstance(part, MathRow) else (part,)),
        Parenthesis(")", is_tall(part)),
    )


def _is_sum(part: Part) -> bool:
    return isinstance(part, MathRow) and any(isinstance(one, Sign) and one.role == "sum" for one in part.parts)


def _opened_in_row(part: Part, fits: Callable[[Part], bool]) -> tuple[Part, ...]:
    opened_part = opened(part, fits)
    return opened_part.parts if opened_part != part and isinstance(opened_part, MathRow) else (opened_part,)


def displayed(node: Expression, language: Language, fits: Fits | None = None) -> list[list[Part]]:
    """Return the sides of a displayed row, each as the pieces between which it may break; wide sides are opened.

    A last "= 0" is joined to the side before it, unless that is a lone symbol: such rows are aligned at "=".
    """
    rows = [pieces(part) for part in sides(replace(node, note="") if isinstance(node, Chain) else node, language, fits)]
    if short_end(node) and (len(rows) > 2 or (len(rows) == 2 and len(rows[0]) > 1)):
        end = rows.pop()
        rows[-1][-1] = MathRow((rows[-1][-1], EQUALS, *end))
    rows[-1][-1] = _noted(rows[-1][-1], node)
    return rows


def pieces(part: Part) -> list[Part]:
    """Return the parts between which a displayed line may break: terms of a sum and factors of a product.

    Inside parentheses, a line may break only between terms.
    """
    match part:
        case MathRow((Sign() as sign, Fence("", MathRow(parts)))):
            every: tuple[Part, ...] = (sign, *parts)
        case MathRow(parts):
            every = parts
        case _:
            every = (part,)
    pieces: list[list[Part]] = [[]]
    within = False
    for piece in every:
        if isinstance(piece, Parenthesis):
            within = piece.of == "("
        elif isinstance(piece, Sign) and (piece.role == "sum" or (piece.role == "product" and not within)):
            pieces.append([])
        pieces[-1].append(piece)
    return [MathRow(tuple(some)) for some in pieces]


def short_end(row: Expression) -> bool:
    """Return True if a row ends in "= 0", which must not be alone on a line."""
    return isinstance(row, Chain) and isinstance(row.parts[-1], Number) and row.parts[-1].printed == 0


# --- vector equations -----------------------------------------------------------------------------


class TermColumn(Record):
    """A column of a vector equation: the signs before a term, the term, and its entries in the equation's rows."""

    signs: tuple[Sign, ...]
    term: Part
    known: tuple[Expression | str | None, ...]


def terms(equation: VectorEquation) -> Iterator[tuple[tuple[Sign, ...], Term]]:
    """Yield each term with the signs before it: "=" before the first term of a later side, then the term's own sign."""
    for side, members in enumerate(equation.sides):
        for index, term in enumerate(members):
            if index:
                yield (Sign("−" if term.sign < 0 else "+", "bound"),), term
            else:
                yield (BOUND,) * bool(side) + (NEGATIVE,) * (term.sign < 0), term


def columns(equation: VectorEquation) -> list[TermColumn]:
    """Return the columns of a vector equation.

    A last "= 0" without entries is joined to the term before it, so that no row breaks between them.
    """
    columns: list[TermColumn] = []
    for signs, term in terms(equation):
        if columns and signs[:1] == (BOUND,) and not any(entry != "" for entry in term.known):
            columns[-1] = TermColumn(
                columns[-1].signs, MathRow((columns[-1].term, *signs, term.symbol)), columns[-1].known
            )
        else:
            columns.append(TermColumn(signs, term.symbol, known_of(term, equation)))
    return columns


def known_of(term: Term, equation: VectorEquation) -> tuple[Expression | str | None, ...]:
    """Return the entries of a term, one for each of the equation's rows."""
    rows = len(equation.rows)
    return (*term.known, *("",) * (rows - len(term.known)))[:rows]
