"""Displayed rows: what "=" joins, the pieces between which a line may break, and what is too wide for any line.

A fraction of a sum that does not fit its line becomes 1/denominator times the sum, which breaks at its terms.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from reportgen.base.units import Language
from reportgen.formula import Chain, Expression
from reportgen.formula.setting import (
    EQUALS,
    Bracket,
    Fence,
    MathRow,
    Part,
    Quotient,
    Sign,
    Written,
    is_tall,
    laid,
    noted,
    short_end,
)

Fits = Callable[[Sequence[Part]], bool]
"""Whether parts have room beside each other in a line."""


def sides(node: Expression, language: Language, fits: Fits | None = None, slashed: bool = False) -> list[Part]:
    """What "=" joins, the note with the last; what does not fit its line is opened."""
    found = [laid(part, language, slashed) for part in (node.parts if isinstance(node, Chain) else (node,))]
    if fits is not None:
        head = (found[0], EQUALS) if len(found) > 1 else ()
        found = [opened(part, lambda inner: fits((*head, inner))) for part in found]
    return [*found[:-1], noted(found[-1], node)]


def opened(part: Part, fits: Callable[[Part], bool]) -> Part:
    """A side of a row whose fractions that do not fit are products, and its sums that do not fit may break inside.

    (a + b)/c becomes 1/c · (a + b), whose parentheses are marks of one size each.
    """
    match part:
        case _ if fits(part):
            return part
        case MathRow(parts):
            return MathRow(tuple(inner for one in parts for inner in _opened_in_row(one, fits)))
        case Fence("", inner):
            found = opened(inner, fits)
            return part if found == inner else found
        case Quotient(top, bottom) if _is_sum(top):
            return MathRow((Quotient(Written("1", ""), bottom), Sign("·", "bound"), *_marked(top)))
        case Fence("(", inner) if _is_sum(inner):
            return MathRow(_marked(inner))
        case _:
            return part


def _marked(part: Part) -> tuple[Part, ...]:
    """A sum between marks, so that its terms stand in the row itself."""
    return (
        Bracket("(", is_tall(part)),
        *(part.parts if isinstance(part, MathRow) else (part,)),
        Bracket(")", is_tall(part)),
    )


def _is_sum(part: Part) -> bool:
    return isinstance(part, MathRow) and any(isinstance(one, Sign) and one.role == "sum" for one in part.parts)


def _opened_in_row(part: Part, fits: Callable[[Part], bool]) -> tuple[Part, ...]:
    found = opened(part, fits)
    return found.parts if found != part and isinstance(found, MathRow) else (found,)


def displayed(node: Expression, language: Language, fits: Fits | None = None) -> list[list[Part]]:
    """A displayed row: its sides, each in the pieces between which it may break; what does not fit a line is opened.

    A last "= 0" stands with the side before it, but a lone symbol keeps it: there rows are aligned.
    """
    found = [
        pieces(part) for part in sides(replace(node, note="") if isinstance(node, Chain) else node, language, fits)
    ]
    if short_end(node) and (len(found) > 2 or (len(found) == 2 and len(found[0]) > 1)):
        end = found.pop()
        found[-1][-1] = MathRow((found[-1][-1], EQUALS, *end))
    found[-1][-1] = noted(found[-1][-1], node)
    return found


def pieces(part: Part) -> list[Part]:
    """What a displayed line may break between: terms of a sum, factors of a product; within marks terms alone."""
    match part:
        case MathRow((Sign() as sign, Fence("", MathRow(parts)))):
            every: tuple[Part, ...] = (sign, *parts)
        case MathRow(parts):
            every = parts
        case _:
            every = (part,)
    found: list[list[Part]] = [[]]
    within = False
    for one in every:
        if isinstance(one, Bracket):
            within = one.of == "("
        elif isinstance(one, Sign) and (one.role == "sum" or (one.role == "product" and not within)):
            found.append([])
        found[-1].append(one)
    return [MathRow(tuple(some)) for some in found]
