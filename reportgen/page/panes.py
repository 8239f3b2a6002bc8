"""Panes of a panel as they are shown: drawings and charts under their titles, numbers in their units."""

from __future__ import annotations

import numpy as np

from reportgen.base.units import significant_decimals
from reportgen.drawing.animation import PANEL, Fitted, MomentValue, MovingItem, Pane, Track
from reportgen.formula import Symbol
from reportgen.formula.vocabulary import KINDS

DIGITS, MOST_DECIMALS = 5, 5
"""Figures of the greatest of its values, decimals at most."""


def plan(key: str, title: str, items: list[MovingItem], plan_fitted: Fitted) -> Pane:
    return Pane(key, title, tuple(items), -PANEL / 2, PANEL / 2, plan_fitted.scales, finer=plan_fitted.finer)


def value(symbol: Symbol, kind: str, values: np.ndarray) -> MomentValue:
    how = KINDS[kind]
    converted = values / how.scale
    greatest = float(np.nanmax(np.abs(converted), initial=0.0))
    decimals = min(max(significant_decimals(greatest, DIGITS), 0), MOST_DECIMALS)
    return MomentValue(symbol, how.unit, Track(converted), decimals)


def scalar(symbol: Symbol) -> Symbol:
    return Symbol(symbol.base, symbol.sub, symbol.sup)
