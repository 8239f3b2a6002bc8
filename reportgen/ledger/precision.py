"""How many decimals each quantity is printed with, so that every printed line recomputes.

For a printed line ŷ = f(x̂₁, x̂₂, …) with half-units uᵢ of the last printed digits, the input error that a
reader's calculator sees is Σ|∂f/∂xᵢ| uᵢ.  Decimals are chosen so that this stays within u_y at every
position: inputs get one more decimal, the largest contribution first, up to six significant
figures; where that is not enough the result gets one fewer.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal

import numpy as np

from reportgen.notation.evaluation import evaluate
from reportgen.notation.expressions import refs
from reportgen.notation.sheet import Family, is_short
from reportgen.notation.symbols import MAX_DIGITS

LEAST_DIGITS = 3
"""A family's largest value keeps at least these; a line that needs fewer is a listed cancellation."""


@dataclass(frozen=True, slots=True)
class _Line:
    id: str
    inputs: tuple[str, ...]
    slopes: np.ndarray
    """|∂f/∂xᵢ| in printed units, [inputs, positions]."""


def _largest(family: Family) -> float:
    finite = np.abs(family.values[np.isfinite(family.values)]) / family.how.scale
    return float(finite.max()) if finite.size else 0.0


def _digits_to_decimals(family: Family, digits: int, at_least: float = 0.0) -> int:
    """Decimals that show the largest value, or one of size `at_least`, with so many figures."""
    largest = max(_largest(family), at_least)
    if largest == 0:
        return max(digits - 1, 0) if family.how.decimals is None else family.how.decimals
    return digits - 1 - math.floor(math.log10(largest) + 1e-12)


def _wanted(family: Family) -> int:
    """The decimals aimed at: those of its kind, counted from what it stands beside (its scale)."""
    if family.how.decimals is not None:
        return family.how.decimals
    return _digits_to_decimals(family, family.how.digits, family.scale / family.how.scale)


def _is_short(family: Family) -> bool:
    """Whether one value serves all positions and has few enough digits to be printed as it is (0.171 m)."""
    if len(family.values) > 1 or family.definition is None:
        return False
    return is_short(float(family.values[0].real) / family.how.scale)


def _shown_decimals(family: Family) -> int:
    value = float(family.values[0].real) / family.how.scale
    return -int(Decimal(f"{value:.12g}").normalize().as_tuple().exponent)


def _slopes(family: Family, inputs: tuple[str, ...], families: Mapping[str, Family]) -> np.ndarray:
    """|∂f/∂xᵢ| by central differences, both sides in printed units."""
    assert family.definition is not None
    values = {id: families[id].values for id in inputs}
    rows = []
    for id in inputs:
        source = families[id]
        step = 1e-6 * max(_largest(source) * source.how.scale, 1e-30)
        with np.errstate(all="ignore"):
            up = evaluate(family.definition, values | {id: source.values + step})
            down = evaluate(family.definition, values | {id: source.values - step})
        slope = np.abs(np.asarray(up) - down) / (2 * step) * source.how.scale / family.how.scale
        rows.append(np.broadcast_to(np.nan_to_num(slope, posinf=0.0), np.broadcast_shapes(slope.shape, (1,))))
    width = max((row.size for row in rows), default=1)
    return np.array([np.broadcast_to(row, (width,)) for row in rows])


def choose(
    families: Mapping[str, Family],
    same: tuple[tuple[str, str], ...] = (),
    fixed: Mapping[str, int | None] | None = None,
) -> tuple[dict[str, int | None], tuple[str, ...]]:
    """Decimals for every family (None: exact) and the ids of lines that cannot be made to recompute.

    Pairs of the `same` number, reached in two ways, are printed with the decimals of the coarser.  Decimals `fixed`
    before stay as they are, and the lines of those families are not judged again.
    """
    fixed = fixed or {}
    decimals: dict[str, int | None] = {}
    ceiling: dict[str, int] = {}
    floor: dict[str, int] = {}
    for id, family in families.items():
        if id in fixed:
            decimals[id], ceiling[id] = fixed[id], fixed[id] or 0
            continue
        if family.exact or family.is_plane or family.hidden or _is_short(family):
            decimals[id] = None
            continue
        most = _digits_to_decimals(family, MAX_DIGITS)
        wanted = _wanted(family)
        ceiling[id], floor[id] = most, min(_digits_to_decimals(family, LEAST_DIGITS), wanted)
        decimals[id] = max(min(wanted, most), 0)
        ceiling[id] = max(ceiling[id], 0)

    lines = [
        _Line(id, inputs, _slopes(family, inputs, families))
        for id, family in families.items()
        if id not in fixed
        and family.definition is not None
        and not (family.constructed or family.is_plane or family.hidden)
        for inputs in (refs(family.definition),)
        if inputs and not any(families[name].is_plane for name in inputs)
    ]

    def half_unit(id: str) -> float:
        digits = decimals[id]
        return 0.0 if digits is None else 0.5 * 10.0**-digits

    def allowed(id: str) -> float:
        """A result printed as it is (0.171 m) is read to its own last digit."""
        return half_unit(id) if decimals[id] is not None else 0.5 * 10.0 ** -_shown_decimals(families[id])

    def holds(line: _Line) -> bool:
        shares = line.slopes * np.array([[half_unit(id)] for id in line.inputs])
        return bool(shares.sum(axis=0).max() <= allowed(line.id) * (1 + 1e-9))

    cancellations: dict[str, None] = {}
    settled = False
    while not settled:
        settled = True
        for line in reversed(lines):
            while True:
                shares = line.slopes * np.array([[half_unit(id)] for id in line.inputs])
                worst = int(shares.sum(axis=0).argmax())
                if shares[:, worst].sum() <= allowed(line.id) * (1 + 1e-9) or line.id in cancellations:
                    break
                raisable = [
                    (shares[index, worst], id)
                    for index, id in enumerate(line.inputs)
                    if (digits := decimals[id]) is not None and digits < ceiling[id]
                ]
                settled = False
                if raisable and max(raisable)[0] > 0:
                    chosen = max(raisable)[1]
                    decimals[chosen] = (decimals[chosen] or 0) + 1
                elif (own := decimals[line.id]) is not None and own > max(floor[line.id], 0):
                    decimals[line.id] = ceiling[line.id] = own - 1
                else:
                    cancellations[line.id] = None
    # Decimals that were raised in vain, before the result gave way, are given back.
    uses: dict[str, list[_Line]] = {}
    for line in lines:
        for id in line.inputs:
            uses.setdefault(id, []).append(line)
    own_lines = {line.id: line for line in lines}
    for id in reversed([id for id in families if id not in fixed]):
        concerned = [*uses.get(id, []), *([own_lines[id]] if id in own_lines else [])]
        concerned = [line for line in concerned if line.id not in cancellations]
        aim = max(_wanted(families[id]), 0)
        while (digits := decimals[id]) is not None and digits > aim:
            decimals[id] = digits - 1
            if not all(map(holds, concerned)):
                decimals[id] = digits
                break
    for pair in same:
        known = [digits for id in pair if (digits := decimals.get(id)) is not None]
        for id in pair:
            if decimals.get(id) is not None:
                decimals[id] = min(known)
    return decimals, tuple(cancellations)
