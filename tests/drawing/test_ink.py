"""The ink that labels keep away from, counted anew for each box."""

from __future__ import annotations

import numpy as np
import pytest

from reportgen.drawing.geometry import CELL, Ink


def counted(strokes: np.ndarray, centres: np.ndarray, half: np.ndarray) -> list[int]:
    """Return the number of cells in each box that a stroke inks, counted one by one."""
    low = complex(strokes.real.min(), strokes.imag.min())
    cells = set()
    for start, end in strokes:
        steps = int(np.ceil(abs(end - start) / CELL)) + 1
        for share in np.arange(steps) / max(steps - 1, 1):
            dot = (start + (end - start) * share - low) / CELL
            cells.add((int(dot.real + 1e-9), int(dot.imag + 1e-9)))
    x, y = np.array(sorted(cells)).T
    numbers = []
    for centre, reach in zip(centres, half, strict=True):
        (x0, y0), (x1, y1) = (
            (int(np.rint(corner.real)), int(np.rint(corner.imag)))
            for corner in ((centre - reach - low) / CELL, (centre + reach - low) / CELL)
        )
        numbers.append(int(np.count_nonzero((x0 <= x) & (x < x1) & (y0 <= y) & (y < y1))))
    return numbers


@pytest.mark.parametrize(("width", "lines"), [(40.0, 30), (400.0, 120)])
def test_each_box_has_the_cells_counted_in_it(width: float, lines: int) -> None:
    """Also beside the figure, and where the counts of a large one need more than 16 bits."""
    chance = np.random.default_rng(7)

    def points(*shape: int) -> np.ndarray:
        across, up = chance.integers(0, int(width / CELL), (2, *shape))
        # Where two cells meet, rounding would decide.
        return (across + 1j * up + 0.3 * (1 + 1j)) * CELL

    strokes, centres = points(lines, 2), points(50) - (width / 10) * (1 + 1j)
    half = (chance.integers(1, 40, 50) + 1j * chance.integers(1, 20, 50)) * CELL
    ink = Ink(strokes)
    assert (ink.inked.max() >= 1 << 16) == (width > 100)
    assert ink.covered(centres, half).tolist() == counted(strokes, centres, half)
    assert ink.touches(centres, half).tolist() == [number > 0 for number in counted(strokes, centres, half)]
