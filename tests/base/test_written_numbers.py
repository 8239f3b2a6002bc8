"""Numbers as they are written: any size with any decimals."""

from __future__ import annotations

import pytest

from reportgen.base.units import write


@pytest.mark.parametrize(
    ("value", "decimals", "text"),
    [(1.5, 9, "1.500000000"), (0.25, 10, "2.500000000·10⁻¹"), (-123.25, 9, "−1.23250000000·10²"), (2e9, 0, "2·10⁹")],
)
def test_more_decimals_than_usual_are_written(value: float, decimals: int, text: str) -> None:
    assert write(value, decimals, "en") == text
