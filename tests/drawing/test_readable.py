"""Figures of whole reports as one reads them: labels belong, walls are walls, arrows lie beside each other."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from functools import cache
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
import pytest

from reportgen.document.figure_placement import FigureScenes
from reportgen.drawing import Arc, Arrow, Circle, Hatch, Label, Line, Pen, Polyline, Scene, style
from reportgen.drawing.geometry import on_one_line
from reportgen.drawing.scheme import ARROWS, LINES, line_styles
from reportgen.drawing.style import clip_hatch
from reportgen.drawing.vector_plan import Plan, PlanVector, plan, set_apart
from reportgen.formula import Symbol
from reportgen.report.context import ReportContext
from reportgen.report.named_figures import FIGURES
from tests.lanes import matrix
from tests.report import built

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
NAMES = sorted(file.stem for file in ASSIGNMENTS.glob("*.yaml"))
TOUCHING = 1e-6
"""Millimetres: of pieces cut exactly, what remains of rounding."""
every = pytest.mark.parametrize("name", matrix(NAMES, NAMES[::3]))


@cache
def report(name: str) -> ReportContext:
    return ReportContext(built.case(ASSIGNMENTS / f"{name}.yaml", "en"))


def draw(name: str, figure: str, *shown: object) -> FigureScenes:
    return FIGURES[figure][1](report(name), *shown)


def mechanisms(name: str) -> Iterator[Scene]:
    """The figures of the whole mechanism with its frame."""
    yield from draw(name, "scheme").scenes
    if report(name).plane_links:
        for k in report(name).worked:
            yield from draw(name, "centres", k).scenes


def inside(point: complex, corners: tuple[complex, ...]) -> bool:
    sides = [((b - a).conjugate() * (point - a)).imag for a, b in pairwise((*corners, corners[0]))]
    return all(side > 0 for side in sides) or all(side < 0 for side in sides)


@every
def test_the_number_of_a_bar_stands_in_no_block(name: str) -> None:
    """A block may hold its own number: those of links that have a block are left out."""
    for scene in mechanisms(name):
        blocks = [item.points for item in scene.items if isinstance(item, Polyline) and item.fill == style.TINT]
        sliders = _sliders(name)
        for label in (item for item in scene.items if isinstance(item, Label) and isinstance(item.content, str)):
            if label.content.isdigit() and label.content not in sliders:
                assert not any(len(block) == 4 and inside(label.at, block) for block in blocks), label.content


def _sliders(name: str) -> set[str]:
    return {str(slider) for _, slider in report(name).analysis.motion.slides} | {
        str(group.i) for group in report(name).groups if group.kind in ("RPR", "RPP")
    }


@every
def test_no_bar_crosses_a_hatched_wall(name: str) -> None:
    for scene in mechanisms(name):
        bars = [(i.start, i.end) for i in scene.items if isinstance(i, Line) and i.stroke == style.HEAVY]
        for hatch in (item for item in scene.items if isinstance(item, Hatch)):
            a, b, _, d = hatch.points
            along, out = (b - a) / abs(b - a), (d - a) / abs(d - a)
            if min(abs(a - b), abs(a - d)) < TOUCHING or _is_pivot(scene, hatch):
                continue
            for start, end in bars:
                shares = np.linspace(0, 1, 2000)[:, None]
                way = (start + (end - start) * shares).ravel() - a
                x, y = (way * along.conjugate()).real, (way * out.conjugate()).real
                assert not ((x > 0) & (x < abs(b - a)) & (y > 0) & (y < abs(d - a))).any()


def _is_pivot(scene: Scene, hatch: Hatch) -> bool:
    """Whether a hatch is the ground under a pivot, which a crank turns over."""
    return abs(abs(hatch.points[1] - hatch.points[0]) - 9.2) < TOUCHING


@every
def test_hatching_stands_at_45_degrees_to_its_wall(name: str) -> None:
    for scene in mechanisms(name):
        for hatch in (item for item in scene.items if isinstance(item, Hatch)):
            wall = hatch.points[1] - hatch.points[0]
            for start, end in clip_hatch(hatch.points, hatch.spacing, hatch.turn):
                between = math.degrees(cmath.phase((end - start) / wall)) % 90
                assert between == pytest.approx(45, abs=1e-6)


@pytest.mark.parametrize("name", ["slotted-lever-01", "slotted-lever-02", "shaper-01", "shaper-02"])
def test_the_lever_of_the_position_plan_reaches_its_pivot(name: str) -> None:
    """A straight lever is drawn through its fixed joint at every position."""
    scene, shown = draw(name, "positions").scenes[0], report(name)
    group = next(group for group in shown.groups if group.kind == "RPR")
    legs = [item.points[0] for item in scene.items if isinstance(item, Polyline) and item.fill == style.PAPER]
    fixed = [shown.analysis.motion.points[at].p[0] for at in shown.machine.linkage.ground]
    offset = legs[0] - fixed[0] * 1e3 / float(shown.ledger["mu.l"].values[0])
    pivot = offset + shown.analysis.motion.points[group.T].p[0] * 1e3 / float(shown.ledger["mu.l"].values[0])
    bars = [item for item in scene.items if isinstance(item, Line) and item.stroke in (style.THIN, style.HEAVY)]
    through = [bar for bar in bars if min(abs(bar.start - pivot), abs(bar.end - pivot)) < 1e-3]
    assert len(through) >= shown.count


@every
def test_the_position_plan_says_how_the_crank_turns(name: str) -> None:
    shown = report(name)
    if not shown.driver.centre:
        return
    scene = draw(name, "positions").scenes[0]
    arrows = [item for item in scene.items if isinstance(item, Arc) and item.head]
    assert [np.sign(arc.stop - arc.start) for arc in arrows] == [shown.machine.turn]
    assert sum(isinstance(i, Label) and i.content == Symbol("ω", "1") for i in scene.items) == 1


@every
def test_a_point_that_carries_numbers_has_no_further_name(name: str) -> None:
    """D beside D₁ … D₁₂ names nothing."""
    scene = draw(name, "positions").scenes[0]
    written = [item.content for item in scene.items if isinstance(item, Label) and isinstance(item.content, Symbol)]
    numbered = {one.base for one in written if one.sub and one.base.isupper() and one.sub in _labels(name)}
    fixed = {point[0] for point in report(name).machine.linkage.ground}
    assert not [one for one in written if not one.sub and one.base in numbered - fixed]


def _labels(name: str) -> set[str]:
    return set(map(str, report(name).positions))


@every
def test_a_small_mechanism_stands_beside_each_worked_plan(name: str) -> None:
    """The names of the driver's joints stand in the figure of the plan, beside images in small letters."""
    shown = report(name)
    for figure in ("velocity", "acceleration"):
        for k in shown.worked:
            (scene,) = draw(name, figure, k).scenes
            pin = shown.driver.pin
            assert any(
                isinstance(item, Label) and isinstance(item.content, Symbol) and item.content.base == pin[0]
                for item in scene.items
            )


# --- arrows on one line


def lying_on_each_other(scene: Scene) -> list[tuple[str, str]]:
    arrows = [
        item
        for item in scene.items
        if isinstance(item, Arrow) and item.name and item.name[:2] != "h " and "×" not in item.name
    ]
    return [
        (one.name, other.name)
        for one, other in combinations(arrows, 2)
        if min(abs(one.end - one.start), abs(other.end - other.start)) > 3
        and abs(one.start - other.start) + abs(one.end - other.end) > 0.05
        and on_one_line((one.start, one.end), (other.start, other.end), style.ON_LINE, style.HEAD)
    ]


@every
def test_forces_on_one_line_of_action_are_set_apart(name: str) -> None:
    shown = report(name)
    for k in shown.worked_forces if shown.has_forces else ():
        scenes = [*draw(name, "crank", k).scenes]
        for group in shown.groups:
            scenes += (*draw(name, "forces", k, group).scenes, *draw(name, "bodies", k, group).scenes)
        assert [pair for scene in scenes for pair in lying_on_each_other(scene)] == []


def test_an_arrow_set_apart_keeps_its_length_and_is_tied_to_its_place() -> None:
    there, back = PlanVector("ef", 0j, 60 + 20j), PlanVector("fe", 60 + 20j, 0j, "found")
    beyond = PlanVector("fg", 60 + 20j, 90 + 30j)
    assert set_apart((there, back, beyond))[0] == set_apart((there, beyond))[1] == 0
    scene = plan(Plan((there, back, beyond), pole=False))
    first, second = (item for item in scene.items if isinstance(item, Arrow) and item.name in ("ef", "fe"))
    assert abs(second.end - second.start) == pytest.approx(abs(there.end), rel=1e-12)
    across = (second.start - first.end) / ((there.end - there.start) / abs(there.end))
    assert across == pytest.approx(1j * style.BESIDE, abs=1e-9) or across == pytest.approx(-1j * style.BESIDE, abs=1e-9)
    tied = [item for item in scene.items if isinstance(item, Line) and item.stroke == style.LEADER]
    assert {round(abs(line.end - line.start), 6) for line in tied} == {style.BESIDE}


# --- without colour


def look(pen: Pen) -> tuple[float, tuple[float, ...]]:
    """What a pen looks like in black and white."""
    return pen.width, pen.dash


def test_lines_are_told_apart_without_colour() -> None:
    """One look for several names is one meaning: what is found or is a reaction; what is new or given."""
    lines = [look(pen) for _, pen in LINES]
    assert len(set(lines)) == len(lines)
    pens = dict(ARROWS)
    roles = [look(pens[name]) for name in ("known", "relative", "found")]
    assert len(set(roles)) == 3
    assert look(pens["load"]) != look(pens["reaction"])
    assert look(style.NEW) != look(style.OLD)


def test_curves_of_one_chart_are_told_apart_without_colour() -> None:
    from reportgen.drawing.charts import PENS
    from reportgen.drawing.indicator import STROKES

    for pens in (PENS, STROKES):
        assert len({look(pen) for pen in pens}) == len(pens)


def test_the_legend_has_a_sample_of_every_line() -> None:
    names = {name: f"<{name}>" for name, _ in (*LINES, *ARROWS)}
    scene = line_styles(names)
    drawn = [item.stroke for item in scene.items if isinstance(item, (Line, Arrow))]
    assert drawn == [pen for _, pen in (*LINES, *ARROWS)]
    assert [item.content for item in scene.items if isinstance(item, Label)] == list(names.values())
    assert scene.width < 160


@pytest.mark.parametrize(
    ("name", "left_out"),
    [
        ("slotted-lever-01", {"normal", "reaction"}),
        ("scotch-yoke-01", {"path", "normal"}),
        ("four-bar-02", {"reaction"}),
    ],
)
def test_the_legend_names_no_line_that_the_report_does_not_have(name: str, left_out: set[str]) -> None:
    """A motion alone has no reactions, a link about a fixed point no moving centre, a yoke no curved path."""
    said = {item.content for item in draw(name, "line-styles").scenes[0].items if isinstance(item, Label)}
    names = report(name).words["line_styles"]
    assert {one for one, text in names.items() if text not in said} == left_out


# --- loads of one pin


def test_two_loads_of_one_pin_and_their_resultant_are_named_apart() -> None:
    """R₂₁ + R₄₁ is the sum of both at every position: measured where the marks stand."""
    scenes = draw("engine-v-02", "polar").scenes
    assert [scene.title for scene in scenes] == ["Pin B: R₂₁", "Pin B: R₄₁", "Pin B: R₂₁ + R₄₁"]
    shown = report("engine-v-02")
    for scene in scenes:
        written = [item.content for item in scene.items if isinstance(item, Label)]
        assert shown.words["figure"]["across_crank"] in written
        assert any("AB" in one for one in written if isinstance(one, str))
        marks = [item for item in scene.items if isinstance(item, Circle)]
        assert len(marks) == shown.cycle_count + 1
