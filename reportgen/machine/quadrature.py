"""Integrals of piecewise smooth functions by Gauss–Legendre quadrature, and means with adaptive halving of the
parts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from reportgen.base.arrays import Floats

ORDER = 16
"""Number of places in a part."""
CONVERGED = 1e-12
"""A change by halving below this share of ∫ |f| dx ends the halving."""
AT_ALL = 1e-9
"""The result is accepted up to this share if halving reaches no smaller one."""
MOST_PARTS = 4096
"""Largest number of parts that are halved together."""
MOST_HALVINGS = 50
"""A part so often halved is below the spacing of floats beside it."""


def gauss(low: Floats, high: Floats, order: int = ORDER) -> tuple[Floats, Floats]:
    """Return the Gauss–Legendre places x and weights w [N, order] of the parts from `low` to `high` [N].

    In each part ∫ f dx = Σ w f(x), in the unit of x; exact for polynomials of a degree below 2·order.
    """
    roots, factors = np.polynomial.legendre.leggauss(order)
    half = (high - low)[:, None] / 2
    return low[:, None] + half * (roots + 1), half * factors


def integrals(
    function: Callable[[Floats], Floats], low: Floats, high: Floats, order: int = ORDER
) -> tuple[Floats, Floats]:
    """Return ∫ f dx and ∫ |f| dx [N] over the parts from `low` to `high` [N].

    The function is called once, with all places in order, and returns their values in the same shape.
    """
    x, weights = gauss(low, high, order)
    values = np.asarray(function(x.ravel()), dtype=np.float64).reshape(x.shape)
    return np.sum(weights * values, axis=1), np.sum(weights * np.abs(values), axis=1)


def accumulated(function: Callable[[Floats], Floats], at: Floats, order: int = ORDER) -> Floats:
    """Return ∫ f dx [N] from the first of the rising places `at` [N] to each; f must be smooth between neighbours."""
    parts, _ = integrals(function, at[:-1], at[1:], order)
    return np.concatenate(([0.0], np.cumsum(parts)))


def mean_over(
    function: Callable[[Floats], Floats], breaks: Iterable[float], start: float, stop: float, rounding: float = 0.0
) -> float:
    """Return ∫ f dx / (stop − start) by composite Gauss–Legendre quadrature, split at `breaks`, in the unit of f.

    Every part between breaks must be smooth. Only parts with too large an error are halved, for example beside a
    dead point, until halving no longer changes the result: by 1e-12 of the mean of |f| in all, or by 1e-9 where
    rounding allows no better. A change of f by less than `rounding`, in its own unit, counts as rounding; a
    function that is no larger has the mean 0. Raises `ValueError` on an empty interval or if it does not converge.
    """
    if not stop > start:
        raise ValueError("the interval is empty")
    edges = np.array(sorted({start, stop, *(float(x) for x in breaks if start < x < stop)}))
    low, high = edges[:-1], edges[1:]
    whole, sizes = integrals(function, low, high)
    noise = rounding * (stop - start)
    if sizes.sum() <= noise:
        return 0.0
    settled = settled_size = 0.0
    best, least = np.nan, np.inf
    for _ in range(MOST_HALVINGS):
        middle = (low + high) / 2
        low, high = np.stack((low, middle), 1).ravel(), np.stack((middle, high), 1).ravel()
        halves, sizes = integrals(function, low, high)
        size = settled_size + float(sizes.sum())
        off = np.abs(halves[::2] + halves[1::2] - whole)
        if off.sum() < least * size:
            best, least = (settled + float(halves.sum())) / (stop - start), float(off.sum()) / size
        allowed = max(CONVERGED * size, noise)
        if off.sum() <= allowed:
            return best if size else 0.0
        # A part that is off by less than its even share of all that is allowed is not halved again.
        open_ = np.repeat(off > allowed / MOST_PARTS, 2)
        settled += float(halves[~open_].sum())
        settled_size += float(sizes[~open_].sum())
        low, high, whole = low[open_], high[open_], halves[open_]
        if low.size > MOST_PARTS:
            break
    if least <= AT_ALL:
        return best
    raise ValueError("the quadrature does not settle")
