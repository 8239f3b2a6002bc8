"""The ledger as a person writes it: each value is computed from the rounded values above it, then rounded.

The same families are evaluated in the same order, each by the formula of its printed line. So a calculator fed with the
printed numbers of a line gives the printed result, digit by digit, and a plan is drawn from lengths as printed.
Discrete choices (senses, arms, branches) and zeros are taken from the unrounded ledger.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

import numpy as np

from reportgen.base.records import replace
from reportgen.base.units import figure_decimals, rounded
from reportgen.formula import Call, Expression, Negative, Ref, ids
from reportgen.formula.calculation import ZERO, Family, is_short, is_typed, shortened
from reportgen.formula.ledger import Ledger, follow

Ends = Callable[[Family, np.ndarray], bool]
"""Predicate: True if a value (SI, [1]) that is computed from rounded values has few digits and prints exactly."""


def printed(ledger: Ledger) -> Ledger:
    """Return the ledger with every value rounded as printed, and with the decimals of each.

    Values stay in SI, [1] or [N] over the positions.
    """
    rounded, _ = written(ledger, usual_decimals(ledger), lambda family, values: is_short(values / family.how.scale))
    return rounded


def written(ledger: Ledger, given: Mapping[str, int | None], ends: Ends) -> tuple[Ledger, Mapping[str, np.ndarray]]:
    """Return the ledger with rounded values, and the change (SI) that rounding made to each value, by id.

    `given` has the decimals of each family in its printed unit, None for values printed exactly. A single value for
    which `ends` is True is printed exactly, too. Values and changes are SI, [1] or [N] over the positions; hidden
    families, points and vectors are not rounded and have no change. The ledger returned has the decimals used.
    """
    decimals, changes = dict(given), dict[str, np.ndarray]()

    def enter(id: str, values: dict[str, np.ndarray]) -> None:
        family, again = ledger[id], _named_again(ledger[id])
        if family.is_plane and id in ids.place:
            # A joint is drawn at its exact place: near a dead point, 0.01 mm of rounding would become millimetres.
            values[id] = family.values
        if family.is_plane or family.hidden:
            return
        if again and ledger[again].kind == family.kind:
            decimals[id] = decimals[again]
        elif family.definition is not None and len(values[id]) == 1 and ends(family, values[id]):
            decimals[id] = None
            values[id] = shortened(np.real(values[id]) / family.how.scale) * family.how.scale
        computed = values[id]
        values[id] = _entered(family, computed, decimals[id])
        changes[id] = values[id] - np.real(computed)

    values = follow(by_lines(ledger), {}, entered=enter)
    families = {id: replace(family, values=values[id]) for id, family in ledger.families.items()}
    return replace(ledger, families=families, decimals=decimals), changes


def by_lines(ledger: Ledger) -> Ledger:
    """Return the ledger in which each family is defined by the formula of its printed line."""
    lines = {id: replace(family, definition=_line(ledger, family)) for id, family in ledger.families.items()}
    return replace(ledger, families=lines)


def _line(ledger: Ledger, family: Family) -> Expression | None:
    """Return the formula that computes the printed value; None for given data and for an integral that is read off."""
    integral = ids.rule(family.id) in ledger
    size = family.scale or _size(family.values)
    is_read = integral and _size(ledger[ids.rest(family.id)].values) > ZERO * size
    return None if is_read else family.line


def _size(values: np.ndarray) -> float:
    """Return the largest size of values (SI), ignoring nan and infinite ones; 0 if there are none."""
    return float(np.max(np.abs(values), initial=0.0, where=np.isfinite(values)))


def _entered(family: Family, computed: np.ndarray, decimals: int | None) -> np.ndarray:
    """Return values (SI) rounded to `decimals` in the printed unit, or to 12 significant figures if None."""
    exact = np.real(family.values)
    values = np.real(computed) / family.how.scale
    values = _without_dust(values) if decimals is None else rounded(values, decimals)
    if family.is_signed_rotation or family.arm:
        values = np.copysign(values, exact) + 0.0
    if family.how.unit == "°" and family.is_direction:
        values = np.mod(values, 360.0)
    if not family.residue:
        values = np.where(np.abs(exact) <= ZERO * family.scale, 0.0, values)
    written: np.ndarray = values * family.how.scale
    return written


def _without_dust(values: np.ndarray) -> np.ndarray:
    return np.array([float(f"{value:.12g}") for value in np.atleast_1d(values)])


# --- decimals ---------------------------------------------------------------------------------------


def usual_decimals(ledger: Ledger) -> dict[str, int | None]:
    """Return the decimals of every family, one number for all families with the same symbol; None for typed values."""
    together: dict[object, list[Family]] = {}
    names = names_of(ledger)
    for id, family in ledger.families.items():
        together.setdefault(names[id], []).append(family)
    decimals = {name: _of_quantity(members) for name, members in together.items()}
    chosen = {id: None if _is_typed(family) else decimals[names[id]] for id, family in ledger.families.items()}
    return {**chosen, **ledger.decimals}


def _of_quantity(members: Collection[Family]) -> int:
    """Return the decimals of the kind, or those with which the largest value has the kind's significant figures."""
    how = next(iter(members)).how
    if how.decimals is not None:
        return how.decimals
    return figure_decimals(max(map(_largest, members)), how.digits)


def _largest(family: Family) -> float:
    """Return the largest unrounded size of a family in its printed unit; 0 if it is negligible at all positions."""
    sizes = np.abs(family.values[np.isfinite(family.values)])
    return float(np.max(sizes, initial=0.0, where=sizes >= ZERO * family.scale)) / family.how.scale


def _is_typed(family: Family) -> bool:
    """Return True if a value is printed as it was given."""
    return (
        family.is_plane
        or family.hidden
        or (family.exact and not family.converted and is_typed(family.values / family.how.scale))
    )


def _named_again(family: Family) -> str:
    """Return the id of the quantity that a line only repeats or reverses (l = R, R₂₁ = −R₁₂); "" for any other line."""
    match family.line:
        case Ref(id) | Negative(Ref(id)) | Call("size", (Ref(id),)):
            return id
        case _:
            return ""


def names_of(ledger: Ledger) -> dict[str, object]:
    """Return a name for each family as a printed quantity, by id.

    It is the symbol and kind, or the name of the family that the line repeats. Families with equal names get the same
    number of decimals.
    """
    names: dict[str, object] = {id: members[0] for members in ledger.same for id in members}
    for id, family in ledger.families.items():
        again = _named_again(family)
        same = again in names and ledger[again].kind == family.kind
        names.setdefault(id, names[again] if same else (family.symbol, family.kind))
    return names
