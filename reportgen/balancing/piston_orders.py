"""The orders of a piston's acceleration, a = rω²(cos φ + A₂ cos 2φ + A₄ cos 4φ + A₆ cos 6φ + …), by λ = r/l."""

from __future__ import annotations

import math

from reportgen.formula import Expression, Ref, total

EXACT = 1e-18
"""Power of λ² at which the exact series is cut off."""
FEWEST_TERMS = 24


def acceleration_factor(order: int, λ: Ref, about: float) -> Expression:
    """Return Aₙ of a = rω²(cos φ + Σ Aₙ cos nφ), n even, as a power series of λ that is exact to the last digit.

    Aₙ = (2n²/λ) (−1)^{n/2} Σₖ C(½, k) (−1)ᵏ C(2k, k − n/2) (λ/2)^{2k}, from √(1 − λ² sin² φ).
    """
    half = order // 2
    most = max(FEWEST_TERMS, math.ceil(math.log(EXACT) / math.log(about**2)))
    binomial, terms = 1.0, []
    for k in range(1, most + half):
        binomial *= (0.5 - (k - 1)) / k
        if k >= half:
            # In steps that neither overflow nor lose figures: C(2k, k − n/2)/4ᵏ.
            share = math.exp(
                math.lgamma(2 * k + 1) - math.lgamma(k - half + 1) - math.lgamma(k + half + 1) - k * math.log(4)
            )
            factor = 2 * order**2 * (-1) ** half * binomial * (-1) ** k * share
            terms.append(factor * λ ** (2 * k - 1))
    return total(terms)


def short_series(order: int, λ: Ref) -> Expression:
    """Return the first terms of the series, as books have them: λ + λ³/4 + 15λ⁵/128, …"""
    match order:
        case 2:
            return λ + λ**3 / 4 + 15 * λ**5 / 128
        case 4:
            return -(λ**3 / 4 + 3 * λ**5 / 16)
        case _:
            return 9 * λ**5 / 128


def first_term(order: int, λ: Ref) -> Expression:
    """Return the first term of the series alone, as textbooks have it: a = rω²(cos φ + λ cos 2φ − λ³/4 cos 4φ)."""
    match order:
        case 2:
            return λ
        case 4:
            return -(λ**3) / 4
        case _:
            return 9 * λ**5 / 128
