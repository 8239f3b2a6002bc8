"""Choose the number of decimals of computed values, so that each printed result is right to one unit in its last place.

Each line is computed from the printed values above it, so its result carries their rounding errors:

    r − r₀ = Σ (∂r/∂q) Δq,  Δq the rounding of each value q that r depends on, including r itself

If a printed value is off by more than a unit of its last decimal, the value above it that contributes most to the error
gets one more decimal, and everything is computed again. So each line can be checked on a calculator, and values such as
angles get as many decimals as the results need, but no more.

The actual roundings are used: a chain of twelve lines would have to begin with 16 decimals to be safe in the worst
case. Values measured on a drawing have the accuracy of the drawing, and values computed from them have the figures that
this accuracy gives.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from collections.abc import Set as AbstractSet

import numpy as np

from reportgen.formula import vocabulary
from reportgen.formula.calculation import DUST, ZERO, Family, is_short
from reportgen.formula.ledger import Ledger, follow
from reportgen.formula.rounded_ledger import by_lines, names_of, usual_decimals, written

UNIT = 1 + 1e-6
"""Largest error of a printed value in units of its last decimal, with a margin for floating-point errors."""
MEASURED = "segment"
"""Kind of lengths that are laid off and measured on paper."""

MOST = 10
"""Largest number of decimals of any value."""

Derivatives = Mapping[str, Mapping[str, np.ndarray]]
"""Derivatives ∂r/∂q (SI) of each value r by the values q that it depends on, [1] or [N] over the positions."""


def carried(ledger: Ledger) -> Ledger:
    """Return the ledger rounded as printed, in which each value has the decimals that later values need from it."""
    decimals = dict(usual_decimals(ledger))
    measured = {id for id, family in ledger.families.items() if family.kind == MEASURED and decimals[id] is not None}
    drawn = _standing_on(ledger, measured)
    names = {id: (name, id in drawn) for id, name in names_of(ledger).items()}
    derivatives = _derivatives(ledger, decimals)
    for id in drawn & derivatives.keys():
        by = {one: derivative for one, derivative in derivatives[id].items() if one in measured}
        decimals[id] = min(decimals[id] or 0, _as_drawn(ledger, id, by))
    claimed = {id: by for id, by in derivatives.items() if id not in drawn | measured}
    while True:
        rounded, roundings = written(ledger, decimals, _ends)
        finer = {names[cause] for cause in _causes(ledger, rounded, claimed, roundings)}
        if not finer:
            return rounded
        for id, own in decimals.items():
            if own is not None and names[id] in finer:
                decimals[id] = own + 1


def _standing_on(ledger: Ledger, some: AbstractSet[str]) -> set[str]:
    """Return the ids that depend on any of some quantities, without these quantities."""
    standing = set[str]()
    for id, inputs in ledger.inputs.items():
        if id not in some and not {*inputs}.isdisjoint(standing | some):
            standing.add(id)
    return standing


def _as_drawn(ledger: Ledger, id: str, measured: Mapping[str, np.ndarray]) -> int:
    """Return the decimals to which a value is right to one unit, given the errors of the `measured` lengths.

    `measured` has the derivatives (SI) of the value by these lengths, [1] or [N] over the positions.
    """
    off = sum(_half_unit(ledger[one]) * float(np.max(np.abs(by))) for one, by in measured.items())
    return max(math.floor(-math.log10(2 * off / ledger[id].how.scale)), 0) if off else MOST


def _half_unit(family: Family, decimals: int | None = None) -> float:
    """Return half a unit (SI) of the last of `decimals`; None means the usual decimals of the family's kind."""
    return 0.5 * 10.0 ** -(family.how.decimals or 0 if decimals is None else decimals) * family.how.scale


def _derivatives(ledger: Ledger, decimals: Mapping[str, int | None]) -> Derivatives:
    """Return the derivatives of the rounded values, by finite differences.

    Each value is moved by half a unit of its last decimal, in one row of the arrays [values, positions].
    """
    # A negligible value prints as 0, whatever the values above it are.
    nothing = {id for id, family in ledger.families.items() if np.all(np.abs(family.values) <= ZERO * family.scale)}
    rounded = [id for id, own in decimals.items() if own is not None and id not in nothing]
    steps = {id: _half_unit(ledger[id], decimals[id]) for id in rounded}
    one_each = np.eye(len(rounded) + 1)

    def moved(at: int, id: str) -> Callable[[np.ndarray, object], np.ndarray]:
        return lambda value, _: value + steps[id] * one_each[:, at : at + 1]

    held = {id: ledger[id].values for id in nothing}
    worlds = follow(by_lines(ledger), {**held, **{id: moved(at, id) for at, id in enumerate(rounded)}})
    derivatives: dict[str, Mapping[str, np.ndarray]] = {}
    for id in rounded:
        values, family = worlds[id], ledger[id]
        if family.residue:
            continue
        by = np.real(values) - np.real(values[-1:])
        by[~np.isfinite(by)] = 0.0
        least = DUST * np.max(np.abs(family.values), initial=0.0)
        standing = np.nonzero(np.max(np.abs(by), axis=-1) > least)[0]
        derivatives[id] = {rounded[at]: by[at] / steps[rounded[at]] for at in standing if rounded[at] != id}
    return derivatives


def _causes(ledger: Ledger, rounded: Ledger, derivatives: Derivatives, roundings: Mapping[str, np.ndarray]) -> set[str]:
    """Return, for each value that is too far off, the input that contributes most to its error.

    Values that depend on one of these inputs are skipped, because they will change.
    """
    causes = set[str]()
    for id, by in derivatives.items():
        decimals, how = rounded.decimals[id], ledger[id].how
        apart = np.real(rounded[id].values) - np.real(ledger[id].values)
        size = np.nan_to_num(np.asarray(vocabulary.distance(id, rounded[id].values, ledger[id].values)))
        if decimals is None or np.max(size) * 10.0**decimals <= UNIT * how.scale or causes & {id, *by}:
            continue
        at = int(np.argmax(size))
        shares = {
            source: float((derivative * roundings[source] * np.ones(len(size)))[at] * np.sign(apart[at]))
            for source, derivative in by.items()
            # An exact value gets no further decimals.
            if rounded.decimals[source] is not None
        }
        cause = max(shares, key=lambda source: shares[source], default="")
        if cause and (rounded.decimals[cause] or 0) < MOST:
            causes.add(cause)
    return causes


def _ends(family: Family, values: np.ndarray) -> bool:
    """Return True if a value has few digits because it is exact, not because it is computed from rounded values."""
    exact = np.real(family.values)
    same = np.abs(np.real(values) - exact) <= DUST * np.abs(exact)
    return is_short(exact / family.how.scale) and bool(np.all(same))
