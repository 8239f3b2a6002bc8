"""Mertsalov's check of the flywheel: the crank, whose inertia is constant, belongs to the flywheel's group.

A moment of inertia J₁ on the crank takes J₁ off the flywheel, by the diagram and by Mertsalov's method alike; what the
two methods differ by is the same with and without it.
"""

from __future__ import annotations

from pathlib import Path

import pytest

import reportgen

FILES = Path(__file__).parents[2] / "assignments"


@pytest.mark.parametrize(
    ("without", "with_crank", "J1"),
    [("toggle-press-01", "toggle-press-02", 0.9), ("engine-single-VII", "engine-single-load", 24.0)],
)
def test_the_crank_belongs_to_the_flywheel(without: str, with_crank: str, J1: float) -> None:
    """J_I is the same, J_d = J_I − J₁; the difference is 0.1 to 13 %, as the bound δ max J_II allows."""
    bare, loaded = (reportgen.open(FILES / f"{name}.yaml").case.ledger for name in (without, with_crank))

    def value(ledger: object, id: str) -> float:
        return float(ledger[id].values[0])  # type: ignore[index]

    assert value(loaded, "J.0") == pytest.approx(J1)
    assert value(loaded, "J.I") == pytest.approx(value(bare, "J.I"), rel=1e-9)
    assert value(loaded, "J.d") == pytest.approx(value(bare, "J.d") - J1, rel=1e-9)
    assert value(loaded, "J.rest") - value(loaded, "J.d") == pytest.approx(
        value(bare, "J.I") - value(bare, "J.d"), rel=1e-6
    )
    assert value(loaded, "J.share") < 0.135
    assert "J.rest" not in bare
