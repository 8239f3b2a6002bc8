"""Scale of a figure: the report's, or on a drawing sheet a larger standard one, printed with the report's beside it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reportgen.base.records import Record
from reportgen.base.units import Language, nice_down, nice_up
from reportgen.formula import Chain, Expression, Number
from reportgen.formula.plain_text import formula, quantity

RATIO = "mm/mm"
"""The unit of a scale that is a ratio of lengths."""
NEXT = 1 - 1e-9
"""A scale below this share of a standard scale counts as the next finer one."""


class FigureSize(Record):
    """Size of a figure: `steps` standard scales larger than in a report, then `enlarged` with its letters.

    `beside` is the phrase for the report's scale on a sheet, as "report: {scale}"; empty in a report.
    """

    steps: int = 0
    enlarged: float = 1.0
    beside: str = ""
    language: Language = "en"

    def scale(self, usual: float) -> float:
        """Return the scale (unit of the drawn quantity per mm of finished paper) for the report's scale `usual`."""
        for _ in range(self.steps):
            usual = nice_down(usual * NEXT)
        return usual

    def fitting(self, points: Sequence[complex], room: complex) -> tuple[float, float]:
        """Return the round scale at which points [N] fit the room of a report, and millimetres of the figure per unit.

        Points are in the unit of the drawn object, `room` is width + i height (mm).  The scale is that of the report,
        in units per mm; the second value is `per_unit` of it.
        """
        array = np.array(points)
        size = complex(np.ptp(array.real), np.ptp(array.imag))
        usual = nice_up(max(size.real / room.real, size.imag / room.imag))
        return usual, self.per_unit(usual)

    def per_unit(self, usual: float) -> float:
        """Return the millimetres of the figure, before enlargement, that one unit of the drawn object takes.

        `usual` is the report's scale (units per mm).
        """
        return 1 / (self.scale(usual) * self.enlarged)

    def note(self, symbol: Expression, usual: float, unit: str = RATIO) -> Chain:
        """Return the scale as it is printed below the figure, from the report's scale `usual` (`unit`).

        On a drawing sheet it is followed by the ratio of lengths, if the unit is mm/mm, and by the report's scale.
        """
        drawn = self.scale(usual)
        return self.compared(symbol, _number(drawn, unit), _number(usual, unit), _ratio(drawn) if unit == RATIO else 0)

    def compared(self, symbol: Expression, drawn: Number, usual: Number, ratio: float = 0) -> Chain:
        """Return the scale as `drawn`; on a drawing sheet, followed by the report's scale `usual`.

        A `ratio` of paper to object other than 0 is printed before the report's scale, as 1:2 or 2:1.
        """
        if not self.beside:
            return Chain((symbol, drawn))
        parts = [self.beside.format(scale=quantity(usual, self.language))]
        if ratio:
            above, below = (formula(_number(max(one, 1.0)), self.language) for one in (ratio, 1 / ratio))
            parts.insert(0, f"{above}:{below}")
        return Chain((symbol, drawn), "; ".join(parts))


IN_REPORT = FigureSize()


def _number(value: float, unit: str = "") -> Number:
    return Number(float(f"{value:.6g}"), None, unit)


def _ratio(scale: float) -> float:
    """Return the ratio of paper to the drawn object, without rounding errors of floats."""
    return float(f"{1 / scale:.9g}")
