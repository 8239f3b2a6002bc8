"""Position plans: each point under its own full letter, each plan as large as caption and text say."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, cycle
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.assignment import Assignment
from reportgen.assignment.common import Extent
from reportgen.base.units import MM
from reportgen.cases import MachineCase
from reportgen.document import Document, Figure, Paragraph, Plate, plain
from reportgen.document.figure_placement import FigureScenes, in_text
from reportgen.drawing import Circle, Label, Line, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.drawing_sheet import ENLARGED, lettered
from reportgen.drawing.geometry import coincident
from reportgen.drawing.labels import label
from reportgen.drawing.position_plan import DOT
from reportgen.formula import Chain, Symbol, vocabulary
from reportgen.report import mechanism_figures
from reportgen.report.context import ReportContext
from reportgen.sheets.plates import Sources
from tests.drawing.overlaps import astray, cross, overlaps, watched
from tests.lanes import matrix
from tests.report import built, variants

ONE = 0.3
"""Points within this of one another (mm of paper) are one for whoever measures."""
KINDS = ("full", "short", "sheet")
CASES = [(path.stem, kind) for path in built.FILES for kind in KINDS]
TELLING = [("engine-twin-05", "short"), ("linkage-8", "full"), ("shaper-02", "sheet"), ("four-bar-01", "short")]
"""Two cranks on one circle, three groups, letters of a sheet, a plan that has no room at the scale that fits."""
SMALLER = [1.0, 2.0, 2.5, 4.0, 5.0]


def assignment(name: str, extent: Extent = "full") -> Assignment:
    return built.assignment(built.ROOT / "assignments" / f"{name}.yaml").with_extent(extent)


def report(made: Assignment) -> ReportContext:
    return ReportContext(MachineCase(made))


def drawn(name: str, kind: str) -> tuple[ReportContext, list[FigureScenes]]:
    """The plans of a report, alone and beside the gas; of a sheet before it is enlarged."""
    shown = report(assignment(name, "short" if kind == "short" else "full"))
    if kind == "sheet":
        shown = Sources.of(shown.case).small
        return shown, [FigureScenes((mechanism_figures.positions_scene(shown),))]
    return shown, [mechanism_figures.positions(shown), *([mechanism_figures.indicator(shown)] if shown.has_gas else [])]


def rows(scene: Scene) -> Iterator[list[Symbol]]:
    """The symbols that stand together, parted by commas."""
    row: list[Symbol] = []
    labels = [item.content for item in scene.items if isinstance(item, Label)]
    for before, content in zip(["", *labels], labels, strict=False):
        if isinstance(content, Symbol):
            if before != ", ":
                yield row
                row = []
            row.append(content)
    yield row


def places(shown: ReportContext) -> dict[Symbol, complex]:
    """Where each numbered point is on paper at the scale of the text, mm."""
    points, scale = shown.analysis.motion.points, MM / float(shown.ledger["mu.l"].values[0])
    return {
        Symbol(vocabulary.point(name).base, str(k)): complex(points[name].p[k - 1]) * scale
        for name in mechanism_figures._numbered(shown)
        for k in shown.positions
    }


@pytest.mark.parametrize(("name", "kind"), matrix(CASES, TELLING))
def test_each_point_has_its_own_full_letter(name: str, kind: str) -> None:
    """Once, and beside no other but of points that are one on paper; no label hides more than gray lines."""
    shown, plans = drawn(name, kind)
    at = places(shown)
    for plan in plans:
        (scene,) = plan.scenes
        found = list(rows(scene))
        written = [symbol for row in found for symbol in row]
        assert [symbol for symbol in at if written.count(symbol) != 1] == []
        assert [one.content for one in scene.items if isinstance(one, Label) and one.content in map(str, at)] == []
        for row in found:
            assert all(symbol in at for symbol in row) or len(row) == 1 or plan is not plans[0], row
            together = [at[symbol] / plan.smaller for symbol in row if symbol in at]
            assert all(abs(one - other) <= ONE for one, other in combinations(together, 2)), row
        names = [vocabulary.point(name) for name in (*shown.machine.linkage.ground,)]
        assert all(written.count(name) <= 1 for name in names)
        assert overlaps(scene) == []


@pytest.mark.parametrize(("name", "kind"), matrix(CASES, TELLING))
def test_a_plan_is_as_large_as_it_says(name: str, kind: str) -> None:
    """The dots of its points are as far apart as in the scale of the text, or so many times less.

    Points that are one on paper have one dot, which stands at the first of them.
    """
    shown, plans = drawn(name, kind)
    wanted = np.array(list(places(shown).values()))
    for plan in plans:
        scene = lettered(plan.scenes[0]) if kind == "sheet" else plan.scenes[0]
        radius = DOT * (ENLARGED if kind == "sheet" else 1.0)
        dots = np.array([c.centre for c in scene.items if isinstance(c, Circle) and abs(c.radius - radius) < 1e-9])
        assert plan.smaller in SMALLER
        for way in (np.real, np.imag):
            assert np.ptp(way(dots)) * plan.smaller == pytest.approx(
                np.ptp(way(wanted)), abs=0.01 + 2 * ONE * plan.smaller
            )


def test_a_short_plan_that_has_room_in_the_text_takes_no_page_of_its_own() -> None:
    """A slider-crank is 194 mm long at the scale of the text; half as large it has room for all its letters."""
    _, (plan,) = drawn("slider-crank-01", "short")
    assert (plan.smaller, plan.turned) == (2.0, False)
    assert in_text(*plan.scenes)


def blocks(document: Document, key: str) -> Figure | Plate:
    return next(b for b in built.walk(document.blocks) if isinstance(b, (Figure, Plate)) and b.key == key)


PLANS = ("fig.positions", "fig.indicator", "fig.extremes")
SAID = [("slotted-lever-01", "vi"), ("slider-crank-02", "en")]


@pytest.mark.parametrize(("name", "language"), matrix(
    [(path.stem, language) for path, language in zip(built.FILES, cycle(built.LANGUAGES))], SAID
))  # fmt: skip
def test_text_and_caption_say_how_much_smaller_a_plan_is(name: str, language: str) -> None:
    """Both name the factor and no scale but that of the text; one in the scale of the text has it printed below."""
    path = built.ROOT / "assignments" / f"{name}.yaml"
    made = built.written(path, language, "short")
    shown, document = ReportContext(made.case), made.document
    scale = Chain((shown.ledger.symbol("mu.l"), shown.ledger.number("mu.l")))
    said = " ".join(plain(b.inlines, language) for b in built.walk(document.blocks) if isinstance(b, Paragraph))
    captions = {b.key: b for b in built.walk(document.blocks) if isinstance(b, (Figure, Plate)) and b.key in PLANS}
    for key, draw in zip(
        PLANS, (mechanism_figures.positions, mechanism_figures.indicator, mechanism_figures.extremes), strict=True
    ):
        if key not in captions:
            continue
        plan = draw(shown)
        times = f"{plan.smaller:g}".replace(".", "," if language == "vi" else ".")
        words = f"{times} times smaller" if language == "en" else f"thu nhỏ {times} lần"
        caption = plain(captions[key].caption, language)
        below = [i.content for i in plan.scenes[0].items if isinstance(i, Label) and isinstance(i.content, Chain)]
        scales = [chain for chain in below if chain.parts[0] == scale.parts[0]]
        if plan.smaller == 1.0:
            assert "smaller" not in caption
            assert "thu nhỏ" not in caption
            assert [chain.parts[1].value for chain in scales] == [pytest.approx(scale.parts[1].printed)]
        else:
            assert words in caption
            assert key == "fig.extremes" or words in said
            assert scales == []


@pytest.mark.parametrize("path", matrix(built.FILES, [built.ROOT / "assignments" / "shaper-01.yaml"]))
def test_labels_of_a_short_report_stand_at_their_own_points(path: Path) -> None:
    """Where labels have no room a plan is drawn larger, so none stands nearer to another's point."""
    shown = report(built.assignment(path).with_extent("short"))
    plans = [mechanism_figures.positions(shown), *([mechanism_figures.indicator(shown)] if shown.has_gas else [])]
    assert not any(scene.crowded for plan in plans for scene in plan.scenes)


@pytest.mark.parametrize("name", matrix([path.stem for path in built.FILES], ["toggle-press-01"]))
def test_leaders_of_a_sheet_tell_points_apart(name: str) -> None:
    """They are short and cross none; what they alone tie to its point keeps clear of the points of others."""
    small = Sources.of(MachineCase(assignment(name))).small
    with watched() as found:
        mechanism_figures.positions_scene(small)
    (labels,) = found
    leaders = [one.leader for one in labels if one.leader]
    assert max((abs(leader.end - leader.start) for leader in leaders), default=0.0) <= 12.0
    assert not any(cross(*pair) for pair in combinations(leaders, 2))
    for one in astray(labels):
        others = [point for other in labels if other is not one for point in other.named]
        assert one.leader
        assert min(map(one.to, others)) >= 1.5


@pytest.mark.parametrize("count", [16, 24])
def test_many_positions_keep_their_letters(count: int, tmp_path: Path) -> None:
    """The twin with so many: 48 names at two pins and two pistons."""
    variants.CHANGES["many"] = variants.put("positions.count", count)
    file = tmp_path / "many.yaml"
    file.write_text(variants.content("many"), encoding="utf-8")
    shown = report(api.load(file).with_extent("short"))
    (scene,) = mechanism_figures.positions(shown).scenes
    written = [symbol for row in rows(scene) for symbol in row]
    assert [symbol for symbol in places(shown) if written.count(symbol) != 1] == []
    assert overlaps(scene) == []


# --- the rules by themselves ------------------------------------------------------------------------


def test_what_finds_no_white_paper_breaks_gray_lines() -> None:
    """Two points among gray lines 2 mm apart: each has its own name, on paper of its own."""
    gray = tuple(Line(complex(x, -20), complex(x, 20), style.THIN) for x in range(-40, 41, 2))
    scene = finish(Canvas(gray, tuple(label(at, Symbol(name)) for at, name in ((1 + 0j, "A"), (-3 + 0j, "B")))))
    labels = [item for item in scene.items if isinstance(item, Label)]
    assert [item.content for item in labels] == [Symbol("A"), Symbol("B")]
    assert all(item.background for item in labels)
    assert not scene.crowded


def test_no_other_line_is_broken() -> None:
    """Among gray lines a black one: the label stands on its other side or beyond."""
    gray = tuple(Line(complex(x, -20), complex(x, 20), style.THIN) for x in range(-40, 41, 2))
    scene = finish(Canvas((*gray, Line(2 - 20j, 2 + 20j, style.VISIBLE)), (label(1 + 0j, Symbol("A")),)))
    assert overlaps(scene) == []
    assert [item.content for item in scene.items if isinstance(item, Label)] == [Symbol("A")]


def test_points_in_a_row_are_not_one_for_being_each_near_the_next() -> None:
    """At 0, 0.25 and 0.5 mm: the first two are one, the third is 0.5 mm from the first."""
    assert coincident([0.0, 0.25, 0.5], ONE, complex) == [[0.0, 0.25], [0.5]]
