"""A guide whose force is zero while a moment remains acts with a couple: worked out by hand, said, tabulated, drawn.

A Scotch yoke whose guide is vertical has forces along it alone.  Its pin A stands beside B by r sin φ, φ from the
outer dead centre, clockwise; so M₀₃ = r sin φ · R₂₃ with R₂₃ = G₃ − P₃ + m₃ a_B and a_B = −ω² r cos φ.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from reportgen import api, cases
from reportgen.base.units import Language
from reportgen.base.words import common_words
from reportgen.document import Figure, Table, plain, text_of
from reportgen.drawing import Arc
from reportgen.report.context import ReportContext
from tests.report import built

YOKE = """
kind: scotch-yoke
report: {worked_positions: [2]}
positions: {count: 8, direction: clockwise}
parameters:
  r: 68 mm
  guide: 90 deg
  n: 190 rpm
  G2: 12 N
  G3: 85 N
  force: {by: stroke, unit: N, s: [0, 0.1, 0.9, 1], inward: [-1700, 200, 200, 200], outward: [-1700, -1700, -1700, 200]}
"""
P3 = np.array([-1700, 200, 200, 200, 200, -1700, -1700, -1700.0])
φ = np.arange(8) * np.pi / 4
r, ω, G3, g = 0.068, 2 * np.pi * 190 / 60, 85.0, 9.81
M03 = r * np.sin(φ) * (G3 - P3 + G3 / g * -(ω**2) * r * np.cos(φ))
LEVEL = np.abs(M03) < 1e-9
MEASURED = 1800 * 0.005 * 0.0017 + 0.005
"""The greatest force (N) by half a hundredth of a millimetre of its arm, at 0.0017 m/mm; and half the last digit."""


def opened(text: str, folder: Path, language: Language = "en") -> ReportContext:
    file = folder / "yoke.yaml"
    file.write_text(text.lstrip(), encoding="utf-8")
    return ReportContext(cases.opened(api.load(file, language)))


@pytest.fixture(scope="module")
def yoke(tmp_path_factory: pytest.TempPathFactory) -> ReportContext:
    return opened(YOKE, tmp_path_factory.mktemp("yoke"))


def test_a_couple_has_no_line_of_action(yoke: ReportContext) -> None:
    exact = yoke.case.ledger.families
    assert exact["M.03"].values == pytest.approx(M03, abs=1e-9)
    assert np.abs(M03).max() == pytest.approx(121.38, abs=0.005)
    for place in (exact["x.03"].values, yoke.ledger["x.03"].values):
        assert list(np.isnan(place)) == list(~LEVEL)


def test_the_table_of_reactions_has_the_moment(yoke: ReportContext) -> None:
    document = yoke.case.document()
    (table,) = (one for one in built.walk(document.blocks) if isinstance(one, Table) and one.key == "tab.R")
    columns = list(
        zip(*([plain(cell.inlines, "en") for cell in row] for row in (*table.head, *table.rows)), strict=True)
    )
    moments = next(column for column in columns if column[0] == "M_03")
    assert [float(one.replace("−", "-")) for one in moments[2:]] == pytest.approx(np.where(LEVEL, 0, M03), abs=MEASURED)


def test_the_text_says_so_and_names_no_point(yoke: ReportContext) -> None:
    text = text_of(yoke.case.document())
    assert "equal and opposite to M_03: its magnitude is 13.46 N·m, its sense anticlockwise" in text
    assert "x_03" not in text
    assert "R_03 acts at B" not in text


def test_the_separated_links_show_the_couple(yoke: ReportContext) -> None:
    figures = [one for one in built.walk(yoke.case.document().blocks) if isinstance(one, Figure)]
    (bodies,) = (one for one in figures if one.key == "fig.bodies.23.2")
    # At position 2 the yoke is turned anticlockwise by its guide, in the group and on its own.
    senses = [
        arc.stop - arc.start for scene in bodies.scenes for arc in scene.items if isinstance(arc, Arc) and arc.head
    ]
    assert [sense > 0 for sense in senses] == [True, True]


def test_a_wide_slider_bears_the_couple_at_both_ends(tmp_path: Path) -> None:
    """N₁ = M₀₃/(x₂ − x₁) = −N₂ where N = 0."""
    ledger = opened(f"{YOKE}  faces: {{3: {{from: -40 mm, to: 60 mm}}}}\n", tmp_path).case.ledger
    wanted = np.where(LEVEL, np.nan, M03 / 0.1)
    assert ledger["face.03.1"].values == pytest.approx(wanted, nan_ok=True)
    assert ledger["face.03.2"].values == pytest.approx(-wanted, nan_ok=True)


def test_captions_promise_only_what_has_a_column(yoke: ReportContext) -> None:
    captions = {
        one.key: plain(one.caption, "en") for one in built.walk(yoke.case.document().blocks) if isinstance(one, Table)
    }
    assert captions["tab.v"] == "Magnitudes of the velocities of the points"
    assert captions["tab.a"] == "Magnitudes of the accelerations of the points"
    assert captions["tab.inertia"] == "Inertia forces"
    sample = built.written(built.SAMPLE, "en").document.blocks
    turning = {one.key: plain(one.caption, "en") for one in built.walk(sample) if isinstance(one, Table)}
    assert "angular velocities of the links" in turning["tab.v"]
    assert turning["tab.inertia"] == "Inertia forces and inertia couples"


@pytest.mark.parametrize("language", ["vi", "en", "ru", "zh"])
def test_two_directions_of_one_construction_differ_in_words(language: Language) -> None:
    """Of a block between two slides both lines were “parallel to the guide”, and yet they “meet”."""
    words = common_words(language)
    ways = words["plan"]["directions"]
    assert len({ways["slot"].format(link=3), ways["guide"].format(link=3), ways["guide"].format(link=2)}) == 3
    assert words["vector"]["along_slot"] not in words["vector"]["along_guide"]
