"""Laws of a cam's own: displacements in a table with dwells, and segments; their faults and their differences."""

from __future__ import annotations

import random
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.cam.motion_laws import FollowerLaw, Segment, graph_of_displacements, law
from reportgen.cases import open_case
from tests.report import trees
from tests.report.calculator import misses

FILE = """kind: cam
report: {language: en, worked_positions: [2]}
parameters:
  follower: translating
  end: roller
  h: 20 mm
  phases: {rise: 120 deg, far: 30 deg, return: 90 deg, near: 120 deg}
  laws:
    rise: RISE
    return: cosine
  r0: 60 mm
  roller: 8 mm
"""
TABLE = "{x: [0, 0.125, 0.25, 0.375, 0.5, 0.6, 0.8, 1], s: [0, 1.464, 5, 8.536, 10, 10, 15, 20]}"
SEGMENTS = "{segments: [{to: 0.4, s: 0.5, law: sine}, {to: 0.6}, {to: 1, s: 1, law: parabolic}]}"


def written(folder: Path, rise: str) -> Path:
    path = folder / "cam.yaml"
    path.write_text(FILE.replace("RISE", rise), encoding="utf-8")
    return path


def test_a_sampled_cubic_is_found_again() -> None:
    """S = 3x² − 2x³ begins and ends at rest, so the spline through any of its points is the cubic itself."""
    x = np.array([0, 0.1, 0.15, 0.4, 0.55, 0.8, 1])
    found = FollowerLaw("displacements", graph_of_displacements(x, 30 * (3 * x**2 - 2 * x**3)))
    at = np.linspace(0, 1, 101)
    S, V, A = found(at)
    for values, exact in ((S, 3 * at**2 - 2 * at**3), (V, 6 * at - 6 * at**2), (A, 6 - 12 * at)):
        np.testing.assert_allclose(values, exact, atol=1e-12)


def test_random_tables_pass_their_nodes_and_rest_in_dwells() -> None:
    """A spline is the one curve with these properties: through the nodes, A linear between them, S and V continuous."""
    chance = np.random.default_rng(64)
    for _ in range(20):
        steps = chance.integers(1, 20, 12) * (chance.random(12) < 0.7)
        steps[chance.integers(0, 12)] += 1
        x = np.concatenate(([0], np.cumsum(chance.integers(1, 9, 12)))).astype(float)
        x, s = x / x[-1], np.concatenate(([0.0], np.cumsum(steps)))
        graph = graph_of_displacements(x, s)
        S, V, _ = FollowerLaw("displacements", graph)(x)
        np.testing.assert_allclose(S, s / s[-1], atol=1e-9)
        still = [i for i in range(12) if steps[i] == 0]
        for i in still:
            inside = FollowerLaw("displacements", graph)(np.linspace(x[i], x[i + 1], 7)[1:-1])
            np.testing.assert_allclose(inside[1:], 0, atol=1e-9)
        assert abs(V[[0, *still]]).max() < 1e-9
        # A is continuous at the nodes within a stretch that moves: only ends of dwells are in the graph twice.
        assert len(graph.x) - len(x) <= 2 * len(still)


def test_segments_are_their_laws_shortened() -> None:
    names = ("uniform", "parabolic", "cosine", "sine", "3-4-5", "4-5-6-7")
    chance = random.Random(64)
    for _ in range(10):
        ends = sorted(chance.sample(range(1, 20), 3))
        x, S = [0, *(end / 20 for end in ends), 1], [0, 0.3, 0.3, 0.65, 1]
        laws = [chance.choice(names), "", chance.choice(names), chance.choice(names)]
        parts = zip(pairwise(x), pairwise(S), laws, strict=True)
        chain = FollowerLaw("segments", segments=tuple(Segment(*along, *up, of) for along, up, of in parts))
        for (start, stop), (low, high), of in zip(pairwise(x), pairwise(S), laws, strict=True):
            share = np.linspace(0, 1, 23)[1:-1]
            got = chain(start + share * (stop - start))
            whole = law(of)(share) if of else np.zeros((3, share.size))
            for order, (values, plain) in enumerate(zip(got, whole, strict=True)):
                wanted = (high - low) * plain / (stop - start) ** order + (low if order == 0 else 0)
                np.testing.assert_allclose(values, wanted, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("rise", [TABLE, SEGMENTS])
def test_the_report_of_a_law_of_ones_own(rise: str, tmp_path: Path) -> None:
    """The ledger has the law's displacements, its printed lines recompute, and every language has the words."""
    path = written(tmp_path, rise)
    assert api.examine(path) == []
    case = open_case(path, "en")
    φ = np.degrees(case.ledger["cam.phi"].values)
    place = {0.0: 0.0, 60.0: 10.0, 120.0: 20.0}
    found = {at: float(s * 1e3) for at, s in zip(φ.round(6), case.ledger["cam.s"].values, strict=True) if at in place}
    assert found == pytest.approx(place, abs=1e-9)
    assert misses(trees.lines(trees.every_chain(case.printed), "en")) == []
    for language in ("vi", "ru", "zh", "en"):
        assert open_case(path, language).document().blocks


@pytest.mark.parametrize(
    ("rise", "fault"),
    [
        ("{x: [0, 0.5, 1], s: [0, 6, 5]}", "9:38 cam-falls"),
        ("{x: [0, 0.5, 1], s: [0, 0, 0]}", "9:38 cam-no-rise"),
        ("{x: [0, 0.5, 1], s: [1, 6, 9]}", "9:32 table-end"),
        ("{x: [0, 0.5, 0.5, 1], s: [0, 6, 6, 9]}", "9:24 not-increasing"),
        ("{x: [0, 0.5, 1], s: [0, 9]}", "9:31 row-length"),
        ("{x: [0, 0.5, 1], s: [0, 6, 9], a: [1, 0, -1]}", "9:42 both-given"),
        ("{x: [0, 0.5, 1]}", "9:5 missing-key"),
        ("{segments: [{to: 0.4, s: 0.5}, {to: 1, s: 1, law: sine}]}", "9:23 cam-segment"),
        ("{segments: [{to: 0.4, law: sine}, {to: 1, s: 1, law: sine}]}", "9:23 cam-segment"),
        ("{segments: [{to: 0.4, s: 0.5, law: sine}, {to: 0.9, s: 1, law: sine}]}", "9:58 table-end"),
        ("{segments: [{to: 0.4, s: 0.5, law: sine}, {to: 0.3, s: 1, law: sine}]}", "9:58 not-increasing"),
        ("{segments: [{to: 0.4, s: 0.5, law: sine}, {to: 1, s: 0.3, law: sine}]}", "9:64 cam-falls"),
        ("{segments: [{to: 0.4, s: 0.5, law: sine}, {to: 1, s: 0.9, law: sine}]}", "9:64 table-end"),
    ],
)
def test_faults_of_tables_and_segments(rise: str, fault: str, tmp_path: Path) -> None:
    found = api.check(written(tmp_path, rise))
    assert [f"{one.location.line}:{one.location.column} {one.code}" for one in found] == [fault]


def test_differences_are_held_against_the_resolution(tmp_path: Path) -> None:
    """A cosine law at 20 steps: to 0.001 it says enough, to 1 mm not, and a misprint makes the follower run back."""
    x = np.round(np.linspace(0, 1, 21), 3)
    exact = 10 * (1 - np.cos(np.pi * x))

    def told(s: np.ndarray) -> list[str]:
        rise = f"{{x: {x.tolist()}, s: {s.tolist()}}}"
        return [one.code for one in api.examine(written(tmp_path, rise))]

    assert told(np.round(exact, 3)) == []
    assert told(np.round(exact, 0)) == ["cam-resolution"]
    misprint = np.round(exact, 3)
    misprint[10] = misprint[11] - 0.001
    assert told(misprint)[0] == "cam-ripple"


@pytest.mark.parametrize("rise", ["{x: [0, 1], s: [0, 20]}", "{x: [0, 0.3, 0.5, 1], s: [0, 8, 8, 20]}"])
def test_a_table_may_have_nodes_only_where_it_rests(rise: str, tmp_path: Path) -> None:
    path = written(tmp_path, rise)
    assert api.check(path) == []
    assert {problem.code for problem in api.examine(path)} <= {"cam-resolution", "cam-undercut", "cam-pressure"}
    assert open_case(path).document().blocks


def test_a_segment_has_a_length(tmp_path: Path) -> None:
    path = written(tmp_path, "{segments: [{to: 1e-13, s: 0.5, law: sine}, {to: 1, s: 1, law: sine}]}")
    assert [fault.code for fault in api.check(path)] == ["not-increasing"]
