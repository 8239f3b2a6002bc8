"""Force plans of all positions: each can be measured, to a round scale of its own that stands below it."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from reportgen.drawing import Arrow, Label
from reportgen.formula import Chain, Number
from tests.lanes import matrix
from tests.report import built

ROUND = (1.0, 2.0, 2.5, 4.0, 5.0)
"""Steps of a round scale, in each decade."""
MEASURABLE = 25.0
"""What a plan extends over at least (mm)."""
ENGINE = built.ROOT / "assignments" / "engine-single-I.yaml"
"""A gas engine, whose forces differ by orders over a cycle: to one scale most plans were 2 to 4 mm long."""


@pytest.mark.parametrize("path", matrix([ENGINE, *built.TYPESET], [ENGINE]), ids=lambda path: path.stem)
def test_each_has_its_own_round_scale_and_can_be_measured(path: Path) -> None:
    written = built.written(path, built.own_language(path))
    scenes = [(key, scene) for key, scene in built.scenes(written.document) if key.startswith("fig.R.plates.")]
    assert scenes or path != ENGINE
    for key, scene in scenes:
        ends = [end for item in scene.items if isinstance(item, Arrow) for end in (item.start, item.end)]
        if not ends:
            continue
        extent = max(
            max(z.real for z in ends) - min(z.real for z in ends), max(z.imag for z in ends) - min(z.imag for z in ends)
        )
        assert extent >= MEASURABLE, (key, scene.at)
        (scale,) = (
            item.content.parts[-1]
            for item in scene.items
            if isinstance(item, Label) and isinstance(item.content, Chain)
        )
        assert isinstance(scale, Number)
        step = scale.printed / 10 ** math.floor(math.log10(scale.printed) + 1e-9)
        assert min(abs(step - one) for one in ROUND) < 1e-9, (key, scene.at)
