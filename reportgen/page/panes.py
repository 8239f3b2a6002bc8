"""Make the panes of a panel, and the numbers below them in their units."""

from __future__ import annotations

import numpy as np

from reportgen.base.units import significant_decimals
from reportgen.drawing.animation import PANEL, Fitted, MomentValue, MovingItem, Pane, Track
from reportgen.formula import Symbol
from reportgen.formula.vocabulary import KINDS

DIGITS, MOST_DECIMALS = 5, 5
"""Number of figures of the largest value, and largest number of decimals."""


def plan(key: str, title: str, items: list[MovingItem], plan_fitted: Fitted) -> Pane:
    """Return the pane of a plan that was fitted to its panel."""
    return Pane(key, title, tuple(items), -PANEL / 2, PANEL / 2, plan_fitted.scales, finer=plan_fitted.finer)


def value(symbol: Symbol, kind: str, values: np.ndarray) -> MomentValue:
    """Return a number of the panel from its values (SI) [N], converted to the printed unit of its kind."""
    how = KINDS[kind]
    converted = values / how.scale
    greatest = float(np.nanmax(np.abs(converted), initial=0.0))
    decimals = min(max(significant_decimals(greatest, DIGITS), 0), MOST_DECIMALS)
    return MomentValue(symbol, how.unit, Track(converted), decimals)


def scalar(symbol: Symbol) -> Symbol:
    """Return the symbol of a vector's magnitude."""
    return Symbol(symbol.base, symbol.sub, symbol.sup)
