"""Synthesis exercises: faults at their places, results of the examples, what a sheet asks for, marks and mistakes."""

from __future__ import annotations

import cmath
import math
from pathlib import Path
from typing import Any

import numpy as np
import pymupdf
import pytest

from reportgen import catalogue, load, solve
from reportgen.base.template_folders import languages
from reportgen.base.units import Language
from reportgen.classes.class_marking import Graded
from reportgen.marking.judging import mark
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.toleranced_key import Ask
from reportgen.structure import synthesis_ids as names
from tests.marking import students
from tests.marking.designs import STUDENTS, check_named, drawn_class, graded_class, telling_and_texts
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "synthesis"
EVERY = sorted(FOLDER.glob("*.yaml"))
FILES = [file for file in EVERY if not file.stem.startswith("three-points")]
"""Mechanisms from their extreme positions."""
HEAD = "kind: synthesis\nreport: {language: en}\nparameters:\n"
ROCKER = "task: crank-rocker", "K: 1.3", "psi: 42 deg", "c: 120 mm"
SLIDER = "task: slider-crank", "K: 1.4", "H: 50 mm"
AROUND_D = "task: crank-rocker", "K: 1.4", "psi: 60 deg", "c: 100 mm"
"""With ψ = 2θ the circle of A before the chord is about D."""
FAULTS = [
    ((*ROCKER, "d: 118 mm", "a: 40 mm"), "9:3 both-given"),
    (ROCKER, "3:1 missing-key"),
    ((*ROCKER[:3], "d: 118 mm"), "3:1 missing-key"),
    ((*ROCKER, "d: 118 mm", "e: 10 mm"), "9:3 synthesis-other-task"),
    ((*SLIDER, "e: 20 mm", "c: 100 mm"), "8:3 synthesis-other-task"),
    ((*SLIDER, "e: 100 mm"), "7:6 synthesis-none"),
    ((*ROCKER, "d: 300 mm"), "8:6 synthesis-none"),
    ((*ROCKER, "a: 60 mm"), "8:6 synthesis-none"),
    ((*ROCKER, "d: 100 mm", "A: beyond"), "9:6 synthesis-side"),
    ((*ROCKER, "d: 120 mm"), "8:6 synthesis-none"),
    ((*AROUND_D, "d: 100 mm"), "8:6 synthesis-every-place"),
    ((*AROUND_D, "d: 100 mm", "A: beyond"), "8:6 synthesis-none"),
    ((*AROUND_D, "d: 101 mm"), ""),
    ((*AROUND_D, "d: 101 mm", "A: before"), "9:6 synthesis-side"),
    (("task: slider-crank", "K: 3", "H: 50 mm", "e: 1 mm"), "5:6 synthesis-ratio"),
    (("task: slider-crank", "K: 3", "H: 50 mm", "best: transmission"), "5:6 synthesis-ratio"),
    (("task: slider-crank", "K: 2.9995", "H: 50 mm", "best: transmission"), ""),
    (("task: slider-crank", "K: 2.9995", "H: 50 mm", "e: 1 mm"), "7:6 synthesis-none"),
    (("task: crank-rocker", "K: 3", "psi: 1 deg", "c: 120 mm", "best: transmission"), ""),
    (("task: crank-rocker", "K: 1.3", "psi: 42 deg", "c: 120 mm", "best: transmission", "gamma: 30 deg"), ""),
]


def checked(tmp_path: Path, *lines: str) -> list[Any]:
    file = tmp_path / "mechanism.yaml"
    file.write_text(HEAD + "".join(f"  {line}\n" for line in lines), encoding="utf-8")
    return catalogue.examine(file, "en")


@pytest.mark.parametrize(("lines", "fault"), FAULTS, ids=[f"{k} {fault}" for k, (_, fault) in enumerate(FAULTS)])
def test_faults_are_at_their_places(tmp_path: Path, lines: tuple[str, ...], fault: str) -> None:
    faults = [one for one in checked(tmp_path, *lines) if one.level == "error"]
    assert [f"{one.location.line}:{one.location.column} {one.code}" for one in faults] == ([fault] if fault else [])


def test_the_message_names_the_lengths_with_a_solution(tmp_path: Path) -> None:
    """H/tan θ = 50 mm/tan 30° is the bound of the offset."""
    (fault,) = checked(tmp_path, *SLIDER, "e: 100 mm")
    assert "between 0 mm and 86.603 mm" in fault.message
    assert not [one for one in checked(tmp_path, *SLIDER, "e: 86 mm") if one.level == "error"]


def test_a_poor_transmission_is_a_warning_with_what_is_possible(tmp_path: Path) -> None:
    (warning,) = checked(tmp_path, *SLIDER, "e: 20 mm")
    assert (warning.level, warning.code) == ("warning", "synthesis-poor")
    assert f"the greatest possible is {best_slider(1.4, 50.0):.4g}°" in warning.message
    assert "best: transmission" in warning.hint
    assert checked(tmp_path, *SLIDER, "e: 20 mm", "gamma: 30 deg") == []


def best_slider(K: float, H: float) -> float:
    """The greatest least transmission angle (°), by a scan of the offset: A = (x, e), C₁ and C₂ at ± H/2."""
    θ = math.pi * (K - 1) / (K + 1)
    # The stroke subtends θ at A: the offset e of each x is on the circle about (0, H/(2 tan θ)).
    x = np.linspace(0, H / 2 / math.sin(θ), 400_001)
    e = H / 2 / math.tan(θ) + np.sqrt((H / 2 / math.sin(θ)) ** 2 - x**2) * np.array([[1], [-1]])
    far, near = np.hypot(x + H / 2, e), np.hypot(x - H / 2, e)
    r, rod = (far - near) / 2, (far + near) / 2
    works = (x > H / 2) & (e > 0) & (r + e < rod)
    return math.degrees(float(np.arccos(((r + e) / rod)[works]).max()))


def best_rocker(K: float, ψ: float, c: float, side: int) -> float:
    """The greatest least transmission angle (°) of one side (1 beyond the chord), by a scan of the places of A.

    The angle between coupler and rocker is taken from the points of the mechanism with the crank in line with AD.
    """
    θ = math.pi * (K - 1) / (K + 1)
    ends = [c * cmath.exp(1j * (math.pi / 2 + half)) for half in (-ψ / 2, ψ / 2)]
    ρ = abs(ends[0] - ends[1]) / 2 / math.sin(θ)
    O = 1j * (c * math.cos(ψ / 2) + side * ρ * math.cos(θ))  # noqa: E741
    A = O + ρ * np.exp(1j * np.linspace(0, 2 * math.pi, 400_001))
    A = A[(A.real < 0) & (side * (A.imag - ends[0].imag) > 0)]
    far, near = np.abs(A - ends[0]), np.abs(A - ends[1])
    a, b, d = (far - near) / 2, (far + near) / 2, np.abs(A)
    together = (ends[0] / A).imag * (ends[1] / A).imag > 0
    longest = np.maximum(np.maximum(b, c), d)
    works = together & (a > 0) & (2 * a + 2 * longest < a + b + c + d)
    cosines = [((b**2 + c**2 - (d + s * a) ** 2) / (2 * b * c))[works] for s in (-1, 1)]
    return math.degrees(float(np.minimum(np.arccos(cosines[0]), math.pi - np.arccos(cosines[1])).max()))


@pytest.mark.parametrize(("side", "sign"), [("beyond", 1), ("before", -1)])
def test_the_best_place_is_on_the_required_side(tmp_path: Path, side: str, sign: int) -> None:
    """The warning and the report promise only what is possible there."""
    best = best_rocker(1.3, math.radians(42), 120.0, sign)
    (warning,) = checked(tmp_path, *ROCKER, "d: 200 mm" if sign == 1 else "d: 118 mm", f"A: {side}", "gamma: 60 deg")
    assert warning.code == "synthesis-poor-side"
    assert f"on this side of the chord is {best:.4g}°" in warning.message
    assert f"it would be greatest on this side, {best:.2f}" in printed(tmp_path / "mechanism.yaml", "en")


def printed(file: Path, language: Language) -> str:
    """The text of the report, in lines of one blank."""
    pages = pymupdf.open(stream=built.typeset(built.written(file, language), "typst").pdf)
    return " ".join("".join(page.get_text() for page in pages).split())


@pytest.mark.parametrize("language", languages())
def test_a_slider_crank_of_the_best_transmission(tmp_path: Path, language: Language) -> None:
    """Its offset is a result: of the report, the key and the marking."""
    assert checked(tmp_path, *SLIDER, "best: transmission", "gamma: 30 deg") == []
    file = tmp_path / "mechanism.yaml"
    solution = position(file)["solutions"]["1"]
    r, rod, e = (solution[name] for name in ("crank", "coupler", "offset"))
    assert math.degrees(solution["transmission"]) == pytest.approx(best_slider(1.4, 50.0), abs=1e-6)
    assert math.cos(solution["transmission"]) == pytest.approx((r + e) / rod)
    assert math.sqrt((rod + r) ** 2 - e**2) - math.sqrt((rod - r) ** 2 - e**2) == pytest.approx(0.05)
    text = printed(file, language).replace(",", ".")
    assert all(f"{length * 1e3:.5g}" in text for length in (r, rod, e))
    scheme = marking_scheme(built.case(file, language))
    wanted = {names.OFFSET, names.crank(1), names.coupler(1), names.transmission(1)}
    assert wanted <= {row.id for row in Ask().of(scheme.key).asked}
    marked = mark(scheme, students.written(scheme, students.worked_out(scheme)))
    assert marked.points == marked.out_of


def test_the_task_of_the_best_slider_crank_holds_no_answer(tmp_path: Path) -> None:
    checked(tmp_path, *SLIDER, "best: transmission")
    telling, (task, _) = telling_and_texts(tmp_path / "mechanism.yaml")
    assert telling
    assert not [number for number in telling if number in task]


def test_the_best_transmission_is_not_advised_twice(tmp_path: Path) -> None:
    (warning,) = checked(tmp_path, *SLIDER, "best: transmission")
    assert (warning.code, warning.hint) == ("synthesis-poor", "give a smaller K")


def position(file: Path) -> Any:
    return solve(load(file))["positions"][0]


def test_examples_have_the_published_lengths() -> None:
    """The values of the reference cases (mm, degrees)."""
    best = position(FOLDER / "best-crank-rocker.yaml")
    assert best["chosen"] == 2
    links = [best["solutions"]["2"][name] * 1e3 for name in ("crank", "coupler", "frame")]
    assert links == pytest.approx((39.526358, 92.175010, 116.461850), abs=2e-5)
    assert math.degrees(best["solutions"]["2"]["transmission"]) == pytest.approx(39.876037, abs=1e-6)
    slider = position(FOLDER / "slider-crank-by-offset.yaml")["solutions"]["1"]
    assert [slider[name] * 1e3 for name in ("crank", "coupler")] == pytest.approx((22.159093, 49.910173), abs=1e-6)
    assert math.degrees(slider["transmission"]) == pytest.approx(32.360258, abs=1e-6)


def test_a_given_crank_has_both_frames(tmp_path: Path) -> None:
    """The crank that goes with a frame gives this frame back on its side of the chord."""
    by_frame = position(FOLDER / "crank-rocker-by-frame.yaml")["solutions"]
    for number, side in (("1", "beyond"), ("2", "before")):
        crank = f"a: {by_frame[number]['crank'] * 1e3!r} mm"
        lines = "task: crank-rocker", "K: 1.2", "psi: 60 deg", "c: 100 mm", crank
        assert not [one for one in checked(tmp_path, *lines) if one.level == "error"]
        assert position(tmp_path / "mechanism.yaml")["solutions"][number]["frame"] == pytest.approx(0.13)
        checked(tmp_path, *lines, f"A: {side}")
        assert list(position(tmp_path / "mechanism.yaml")["solutions"]) == [number]


def test_what_the_sheet_asks_for() -> None:
    scheme = marking_scheme(built.case(FOLDER / "crank-rocker-by-frame.yaml", "en"))
    families = (
        *(names.centre, names.along, names.far, names.near, names.crank, names.coupler),
        *(names.near_angle, names.far_angle, names.transmission),
    )
    wanted = {names.ANGLE, names.RADIUS, names.BEST} | {family(n) for family in families for n in (1, 2)}
    assert {row.id for row in Ask().of(scheme.key).asked} == wanted


MISTAKES = [
    ("best-crank-rocker", "synthesis-whole-turn", (names.ANGLE,)),
    ("best-crank-rocker", "synthesis-whole-swing", (names.RADIUS,)),
    ("best-crank-rocker", "synthesis-other-side", (names.centre(2),)),
    ("best-crank-rocker", "synthesis-not-least", (names.transmission(2),)),
    ("crank-rocker-by-frame", "synthesis-worse-solution", (names.BEST,)),
    ("crank-rocker-by-frame", "synthesis-not-halved", (names.crank(1), names.coupler(1))),
    ("slider-crank-by-offset", "synthesis-one-stroke", (names.ANGLE,)),
    ("slider-crank-by-offset", "synthesis-diameter", (names.RADIUS,)),
    ("slider-crank-by-offset", "synthesis-central-angle", (names.RADIUS,)),
    ("slider-crank-by-offset", "synthesis-not-halved", (names.crank(1),)),
    ("slider-crank-by-offset", "synthesis-without-offset", (names.transmission(1),)),
]


@pytest.mark.parametrize(("name", "mistake", "where"), MISTAKES, ids=lambda one: str(one))
def test_the_usual_mistakes_have_names(name: str, mistake: str, where: tuple[str, ...]) -> None:
    check_named(FOLDER / f"{name}.yaml", mistake, where)


@pytest.mark.parametrize("file", EVERY, ids=lambda file: file.stem)
def test_right_sheets_get_all_marks_and_mistakes_have_words(file: Path) -> None:
    scheme = marking_scheme(built.case(file, "en"))
    marked = mark(scheme, students.written(scheme, students.worked_out(scheme)))
    assert marked.points == marked.out_of
    for language in languages():
        case = built.case(file, language)
        for mistake in {name for many in case.misconceptions.changed.values() for name, _ in many}:
            assert "{symbol}" in case.words["mistakes"][mistake]
            assert case.words["mistake_names"][mistake]


@pytest.mark.parametrize("language", languages())
def test_reports_and_sheets_show_every_solution(language: str) -> None:
    for file in FILES:
        case: Any = built.case(file, language)
        figures = [block for block in case.document().blocks if getattr(block, "key", "") == "fig.construction"]
        assert len(figures[0].scenes) == len(case.solved)
        assert len(case.plates()["synthesis"][0].scenes) == len(case.solved)


def test_the_drawing_has_the_lengths_of_the_solution() -> None:
    """AB₁ and AB₂ are the crank, B₁C₁ and B₂C₂ the coupler, the chord subtends θ at A, the frame is AD."""
    from reportgen.structure.synthesis_drawings import ExtremeConstruction

    for file in FILES:
        case: Any = built.case(file, "en")
        for place in case.solved:
            drawn = ExtremeConstruction(case, place)
            links = position(file)["solutions"][str(drawn.number)]
            # The printed angles have hundredths of a degree.
            near = case.wanted.radius * math.radians(0.01)
            for pin, end in zip(drawn.pins, drawn.ends, strict=True):
                assert abs(pin - drawn.pivot) == pytest.approx(links["crank"], abs=near)
                assert abs(end - pin) == pytest.approx(links["coupler"], abs=near)
            beside = abs(drawn.pivot) if case.has_rocker else drawn.pivot.imag
            assert beside == pytest.approx(links["frame" if case.has_rocker else "offset"], abs=near)


PARAMETERS = {
    "crank-rocker": "K: [1.2, 1.25, 1.3], psi: {from: 36 deg, to: 48 deg, step: 2 deg}, c: 120 mm, best: transmission",
    "slider-crank": "K: [1.3, 1.4, 1.5], H: {from: 40 mm, to: 60 mm, step: 5 mm}, e: [15 mm, 18 mm, 20 mm]",
}
SLIPS = {"crank-rocker": ("synthesis-whole-swing", names.RADIUS), "slider-crank": ("synthesis-diameter", names.RADIUS)}


@pytest.fixture(scope="module", params=sorted(PARAMETERS))
def drawn(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    """The folder of twelve variants of a task."""
    task = str(request.param)
    text = f"kind: synthesis\nreport: {{language: en}}\nparameters: {{task: {task}, {PARAMETERS[task]}}}\n"
    return task, drawn_class(tmp_path_factory.mktemp("synthesis"), text)


@pytest.fixture(scope="module")
def graded(drawn: tuple[str, Path]) -> tuple[str, Graded]:
    """Right sheets; the first student takes a wrong radius and goes on from that."""
    task, folder = drawn
    return task, graded_class(folder, *SLIPS[task])


def test_a_class_of_twelve_gets_its_marks(graded: tuple[str, Graded]) -> None:
    task, of_class = graded
    assert of_class.problems == ()
    full = {marking.key.id for marking in of_class.markings if marking.points == marking.out_of}
    assert full == {f"S{number:02d}" for number in range(2, STUDENTS + 1)}
    slipped = next(one for one in of_class.markings if one.key.id == "S01")
    assert {(cell.mistake, cell.id) for cell in slipped.first_errors} == {SLIPS[task]}


@pytest.mark.parametrize("file", EVERY, ids=lambda file: file.stem)
def test_the_task_holds_no_answer(file: Path) -> None:
    telling, (task, key) = telling_and_texts(file)
    assert telling
    assert not [number for number in telling if number in task]
    assert not [number for number in telling if number not in key]


COURSEWORK = """kind: slider-crank
report: {language: en}
parameters: {r: 60 mm, l: 140 mm, n: 960 rpm}
parts:
  - kind: synthesis
    parameters: {task: slider-crank, K: 1.1, H: 120 mm, e: 20 mm}
"""


def test_a_synthesis_is_a_part_of_a_coursework(tmp_path: Path) -> None:
    """Its rows are asked beside those of the machine, its drawings are in the report, right sheets get all marks."""
    (tmp_path / "course.yaml").write_text(COURSEWORK, encoding="utf-8")
    case: Any = built.case(tmp_path / "course.yaml", "en")
    scheme = marking_scheme(case)
    asked = {row.id for row in Ask().of(scheme.key).asked}
    assert {names.ANGLE, names.RADIUS, names.crank(1), names.coupler(1), names.transmission(1)} <= asked
    assert len(asked) > len([id for id in asked if id.startswith("synthesis.")])
    marked = mark(scheme, students.written(scheme, students.worked_out(scheme)))
    assert marked.points == marked.out_of
    keys = {getattr(block, "key", "") for block in case.document().blocks}
    assert any(key.endswith("fig.construction") for key in keys)
