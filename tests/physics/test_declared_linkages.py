"""The V engine and the linkage of the user's own against the independent witness, all loads of the file included."""

from __future__ import annotations

from pathlib import Path

import agreement
import linkages as made
import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from reportgen import api
from reportgen.machine.analysis import Analysis
from tests.lanes import proof

EIGHT = Path(__file__).parents[2] / "assignments" / "linkage-8.yaml"
quick = settings(max_examples=15, deadline=None, suppress_health_check=list(HealthCheck))


def prove(analysis: Analysis) -> None:
    """At every position; weights and applied loads as plain numbers."""
    loads = [
        [
            (load.link, complex(load.force[k]), complex(load.point[k]), float(load.couple[k]))
            for load in (*analysis.weights, *analysis.applied)
        ]
        for k in range(len(analysis.cycle_angle))
    ]
    agreement.prove(analysis, *made.told(analysis.machine.linkage), made.poses(analysis.motion), loads)


def whole(first: int, last: int) -> st.SearchStrategy[int]:
    return st.integers(first, last)


@quick
@given(
    crank=whole(40, 100),
    rod=whole(240, 400),
    articulation=whole(0, 80),
    second=whole(190, 300),
    axes=st.tuples(whole(0, 90), whole(20, 120)),
    rpm=whole(100, 4000),
    direction=st.sampled_from(("anticlockwise", "clockwise")),
)
def test_v_engine(
    tmp_path_factory: pytest.TempPathFactory,
    crank: int,
    rod: int,
    articulation: int,
    second: int,
    axes: tuple[int, int],
    rpm: int,
    direction: str,
) -> None:
    path = tmp_path_factory.mktemp("v") / "v.yaml"
    path.write_text(
        f"kind: engine-v\npositions: {{direction: {direction}}}\n"
        f"parameters: {{AB: {crank} mm, BC: {rod} mm, BD: {articulation} mm, DE: {second} mm,\n"
        f"  alpha: {axes[0]} deg, beta: {axes[0] + axes[1]} deg, n: {rpm} rpm, PC: 5600 N, PE: 2200 N,\n"
        "  G2: 25 N, s2: 0.3, G3: 20 N, m4: 1.5 kg, J4: 0.01 kg m2, G5: 18 N}\n",
        encoding="utf-8",
    )
    assume(not api.check(path))
    prove(api.analyse(api.load(path)))


@proof
@quick
@given(length=whole(40, 55), rpm=whole(10, 1000), direction=st.sampled_from(("anticlockwise", "clockwise")))
def test_eight_links(tmp_path_factory: pytest.TempPathFactory, length: int, rpm: int, direction: str) -> None:
    text = EIGHT.read_text(encoding="utf-8")
    for old, new in (
        ("length: 50 mm", f"length: {length} mm"),
        ("n: 120 rpm", f"n: {rpm} rpm"),
        ("direction: anticlockwise", f"direction: {direction}"),
    ):
        assert text.count(old) == 1
        text = text.replace(old, new)
    path = tmp_path_factory.mktemp("eight") / "eight.yaml"
    path.write_text(text, encoding="utf-8")
    assume(not api.check(path))
    prove(api.analyse(api.load(path)))
    assert np.isfinite(api.analyse(api.load(path)).torque).all()
