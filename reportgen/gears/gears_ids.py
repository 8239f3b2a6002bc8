"""Ids of a gear pair, which begin with `gears`, and their meaning."""

from __future__ import annotations

import math
from collections.abc import Mapping

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import QuantityKind, VocabularyRow

of_wheel = Name("gears.{quantity}.{wheel}")
LENGTH, NUMBER, FIGURE, ANGLE, INVOLUTE = "gear length", "gear number", "gear figure", "gear angle", "involute"

KINDS: Mapping[str, QuantityKind] = {
    LENGTH: QuantityKind("mm", 1e-3, decimals=3),
    NUMBER: QuantityKind("", decimals=4),
    ANGLE: QuantityKind("°", math.pi / 180, decimals=4),
    FIGURE: QuantityKind("", digits=4),
    INVOLUTE: QuantityKind("", decimals=6),
}


def _pair(quantity: str, letter: str, kind: str, below: str = "", above: str = "") -> VocabularyRow:
    return VocabularyRow(Name(f"gears.{quantity}"), letter, kind, below=below, above=above)


def _wheel(quantity: str, letter: str, kind: str, below: str = "", above: str = "") -> VocabularyRow:
    own = of_wheel.only(quantity=quantity)
    return VocabularyRow(own, letter, kind, below=f"{below}{{wheel}}", above=above, name=f"gear {quantity}")


ROWS: tuple[VocabularyRow, ...] = (
    _pair("m", "m", LENGTH),
    _pair("alpha", "α", "angle"),
    _pair("ha", "h", NUMBER, "a", "*"),
    _pair("c", "c", NUMBER, "", "*"),
    _pair("limit.epsilon", "[ε]", NUMBER),
    _pair("limit.tip", "[s/m]", NUMBER),
    _pair("limit.sliding", "[λ]", NUMBER),
    _pair("u", "u", NUMBER),
    _pair("a", "a", LENGTH),
    _pair("inv", "inv α", INVOLUTE),
    _pair("inv_w", "inv α", INVOLUTE, "w"),
    _pair("x_sum", "x", NUMBER, "Σ"),
    _pair("alpha_w", "α", ANGLE, "w"),
    _pair("a_w", "a", LENGTH, "w"),
    _pair("y", "y", NUMBER),
    _pair("dy", "Δy", NUMBER),
    _pair("h", "h", LENGTH),
    _pair("p", "p", LENGTH),
    _pair("p_b", "p", LENGTH, "b"),
    _pair("epsilon", "ε", FIGURE, "α"),
    _pair("g", "g", LENGTH),
    _pair("g_a", "g", LENGTH, "α"),
    _pair("t", "t", NUMBER),
    _wheel("z", "z", "count"),
    _wheel("x", "x", NUMBER),
    _wheel("x_min", "x", NUMBER, "min"),
    _wheel("d", "d", LENGTH),
    _wheel("d_b", "d", LENGTH, "b"),
    _wheel("d_w", "d", LENGTH, "w"),
    _wheel("h_a", "h", LENGTH, "a"),
    _wheel("d_a", "d", LENGTH, "a"),
    _wheel("d_f", "d", LENGTH, "f"),
    _wheel("s", "s", LENGTH),
    _wheel("s_w", "s", LENGTH, "w"),
    _wheel("alpha_a", "α", ANGLE, "a"),
    _wheel("inv_a", "inv α", INVOLUTE, "a"),
    _wheel("s_a", "s", LENGTH, "a"),
    _wheel("tip", "s", FIGURE, "a", "*"),
    _wheel("rho_a", "ρ", LENGTH, "a"),
    _wheel("rho_p", "ρ", LENGTH, "p"),
    _wheel("rho_f", "ρ", LENGTH, "f"),
    _wheel("rho", "ρ", LENGTH),
    _wheel("lambda", "λ", FIGURE),
)
