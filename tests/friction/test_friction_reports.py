"""Reports of tasks with friction: lines recompute, plans close and measure as they say, faults have their places."""

from __future__ import annotations

import cmath
import math
from pathlib import Path

import pytest

from reportgen import api
from reportgen.cases import open_case
from reportgen.catalogue import sample
from reportgen.drawing import Arrow, Circle, Line, Polyline, Scene
from reportgen.friction.brake_drawings import band_scheme, shoe_scheme
from reportgen.friction.exercise_drawings import incline_plans, screw_scheme, wedge_plans
from reportgen.friction.friction_file import TASKS
from reportgen.marking.toleranced_key import key_of
from reportgen.results import results as results_of
from reportgen.sheets import drawing_sheets
from tests.gears.test_pair_reports import recomputes
from tests.gears.test_train_reports import chains
from tests.lanes import matrix, proof
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "friction"
NAMES = sorted(file.stem for file in FOLDER.glob("*.yaml"))
CASES = [(name, language) for name in NAMES for language in ("vi", "en")]
TELLING = [("incline", "vi"), ("wedge", "en"), ("screw-jack", "vi"), ("belt", "en"), ("band-brake", "vi")]


def case_of(name: str, language: str = "en"):  # type: ignore[no-untyped-def]
    return built.case(FOLDER / f"{name}.yaml", language)  # type: ignore[arg-type]


def of_text(text: str, folder: Path, language: str = "en"):  # type: ignore[no-untyped-def]
    file = folder / "friction.yaml"
    file.write_text(f"kind: friction\nparameters:\n  {text}\n", encoding="utf-8")
    return open_case(file, language)  # type: ignore[arg-type]


@pytest.mark.parametrize(("name", "language"), matrix(CASES, TELLING))
def test_every_line_recomputes(name: str, language: str) -> None:
    found = [recomputes(chain) for chain in chains(case_of(name, language).document().blocks)]
    assert found.count(True) >= 5
    assert False not in found


def arrows(scene: Scene) -> dict[str, complex]:
    """The sides of a plan (mm), not those of its insets."""
    return {
        item.name: item.end - item.start for item in scene.items if isinstance(item, Arrow) and "×" not in item.name
    }


@pytest.mark.parametrize(
    "text",
    [
        "incline: {Q: 1200 N, alpha: 25 deg, f: 0.18, beta: horizontal}",
        "incline: {Q: 1200 N, alpha: 8 deg, f: 0.3, beta: 12 deg}",
        "incline: {Q: 1200 N, alpha: 8 deg, f: 0.3}",
    ],
)
def test_a_ruler_on_the_triangles_of_the_plane(text: str, tmp_path: Path) -> None:
    """Q downwards, P at its angle, R at φ beyond the normal against the motion: closed, each its force over μ."""
    case = of_text(text, tmp_path)
    value = {id.rsplit("incline.", 1)[1]: float(family.at(1)) for id, family in case.ledger.families.items()}
    μ, α, β = case.printed.number("friction.incline.mu").value, value["alpha"], value.get("beta", 0.0)
    for scene, end, mark, sense in zip(incline_plans(case), ("", "lowering."), ("", "′"), (1, -1), strict=True):
        sides = arrows(scene)
        assert abs(sum(sides.values())) < 1e-9
        assert sides["Q"] * μ == pytest.approx(-1j * value["Q"], rel=1e-4)
        assert sides[f"P{mark}"] * μ == pytest.approx(value[f"{end}P"] * cmath.rect(1, α + β), rel=1e-4)
        reaction = cmath.rect(math.hypot(value[f"{end}N"], value[f"{end}F"]), math.pi / 2 + α + sense * value["phi"])
        assert sides[f"R{mark}"] * μ == pytest.approx(reaction, rel=1e-3)


@pytest.mark.parametrize("α", [10, 6, 25])
@pytest.mark.parametrize("f3", [0, 0.1])
def test_a_ruler_on_the_triangles_of_the_wedge(α: float, f3: float, tmp_path: Path) -> None:
    """The load's triangle Q, R₃, R₁ closes, and that of the wedge, R₁ turned round, R₂, P; each force over μ."""
    case = of_text(f"wedge: {{Q: 5 kN, alpha: {α} deg, f1: 0.15, f2: 0.12, f3: {f3}}}", tmp_path)
    value = {id.rsplit("wedge.", 1)[1]: float(family.at(1)) for id, family in case.ledger.families.items()}
    μ = case.printed.number("friction.wedge.mu").value
    for scene, end, mark in zip(wedge_plans(case), ("", "lowering."), ("", "′"), strict=True):
        sides = arrows(scene)
        first, across, base, P = (sides[f"{name}{mark}"] for name in ("R1", "R3", "R2", "P"))
        # The corners between R₃ and R₁ follow from printed forces: a hundredth of a millimetre is theirs.
        assert abs(sides["Q"] + across + first) < 1e-9
        assert abs(first - base - P) < 0.02
        for name, side in (("R1", first), ("R2", base), ("R3", across)):
            assert abs(side) * μ == pytest.approx(value[f"{end}{name}"], rel=1e-3)
        assert P * μ == pytest.approx(value[f"{end}P"], rel=1e-4)


def test_a_ruler_on_thread_and_brakes() -> None:
    """The lead over the circumference; drum, lever and pivot of the shoe brake; the arms of the band brake."""
    case = case_of("screw-jack")
    triangle = next(item for item in screw_scheme(case).items if isinstance(item, Polyline) and len(item.points) == 3)
    low, right, top = triangle.points
    # The angle is drawn as it is printed, to 1e-5 degrees.
    assert (top - right).imag / (right - low).real == pytest.approx(14 / (math.pi * 36.5), rel=1e-5)
    items = shoe_scheme(case_of("shoe-brake")).items
    drum = max((item for item in items if isinstance(item, Circle)), key=lambda item: item.radius)
    per = drum.radius / 120
    lever = max((item for item in items if isinstance(item, Line)), key=lambda item: abs(item.end - item.start))
    ends = sorted((lever.start, lever.end), key=lambda end: end.real)
    assert (ends[1] - ends[0]).real == pytest.approx(600 * per, rel=1e-9)
    assert (ends[0] - drum.centre) == pytest.approx(complex(-220, 180) * per, rel=1e-9)
    items = band_scheme(case_of("band-brake")).items
    lever = next(item for item in items if isinstance(item, Line) and abs(item.end.imag - item.start.imag) < 1e-9)
    per = abs(lever.end - lever.start) / 525
    upward = [item.start.real for item in items if isinstance(item, Arrow) and (item.end - item.start).imag > 5]
    assert upward[1] - upward[0] == pytest.approx(125 * per, rel=1e-9)


TOLD = [
    ("incline: {Q: 1 kN, alpha: 8 deg, f: 0.2}", "the plane is self-locking", True),
    ("incline: {Q: 1 kN, alpha: 15 deg, f: 0.2}", "the plane is not self-locking", False),
    ("wedge: {Q: 1 kN, alpha: 20 deg, f1: 0.1, f2: 0.1}", "the wedge is not self-locking", False),
    ("wedge: {Q: 1 kN, alpha: 5 deg, f1: 0.1, f2: 0.1}", "the wedge is self-locking", True),
    ("screw: {Q: 1 kN, d: 30 mm, p: 6 mm, f: 0.1}", "the thread is self-locking", True),
    ("screw: {Q: 1 kN, d: 30 mm, p: 6 mm, n: 3, f: 0.1}", "the screw is not self-locking", False),
    (
        "screw: {Q: 1 kN, d: 30 mm, p: 6 mm, n: 2, f: 0.1, collar: {f: 0.1, d: 40 mm}}",
        "with the friction on the collar the screw holds its load",
        True,
    ),
    (
        "band: {M: 90 N m, d: 300 mm, theta: 230 deg, f: 0.3, l: 500 mm, a: -40 mm, b: 100 mm}",
        "In the sense of the figure the brake is self-locking",
        True,
    ),
    ("shoe: {M: 90 N m, d: 240 mm, f: 0.5, l: 600 mm, a: 220 mm, c: 450 mm}", "the brake is self-locking", True),
]


@pytest.mark.parametrize(("text", "said", "locks"), TOLD, ids=[said for _, said, _ in TOLD])
def test_self_locking_is_told_in_words(text: str, said: str, locks: bool, tmp_path: Path) -> None:
    case = of_text(text, tmp_path)
    words = "".join(str(inline) for block in case.summary() for inline in getattr(block, "inlines", ()))
    assert said in words
    (position,) = results_of(case)["positions"]
    assert position[text.partition(":")[0]]["self_locking"] is locks


@pytest.mark.parametrize("name", NAMES)
def test_words_sheets_and_mistakes(name: str) -> None:
    for language in ("vi", "en"):
        case = case_of(name, language)
        assert [row.id for row in key_of(case).rows if not row.what] == []
        for mistake in {mistake for many in case.misconceptions.changed.values() for mistake, _ in many}:
            assert "{symbol}" in case.words["mistakes"][mistake]
            assert case.words["mistake_names"][mistake]
    (sheet,) = drawing_sheets(case_of(name))
    assert sheet.parts


WHOLE = """kind: slider-crank
report: {language: en, extent: short}
parameters: {r: 100 mm, l: 400 mm, omega1: 10 rad/s, g: 0 m/s2,
  force: {by: stroke, unit: N, s: [0, 1], inward: [1000, 1000], outward: [1000, 1000]},
  friction: {pins: {A: {f: 0.1, r: 20 mm}, B: {f: 0.1, r: 15 mm}}, sliders: {3: 0.12}}}
parts:
  - {kind: friction, parameters: {screw: {Q: 20 kN, d: 36 mm, p: 7 mm, f: 0.1}}}
  - {kind: friction, parameters: {incline: {Q: 1200 N, alpha: 25 deg, f: 0.18}}}
"""


@proof
def test_tasks_are_parts_beside_friction_in_joints(tmp_path: Path) -> None:
    """Ids of a machine with friction and of two tasks do not meet; each task has a chapter, and rows in the key."""
    file = tmp_path / "whole.yaml"
    file.write_text(WHOLE, encoding="utf-8")
    case = open_case(file)
    ids = [row.id for row in key_of(case).rows]
    assert len(set(ids)) == len(ids)
    for id in ("friction.M.01", "friction.screw.M", "friction2.incline.P"):
        assert id in ids
    # Those of the machine are chains of other forms, which its own tests read.
    lines = [
        chain for chain in chains(case.document().blocks) if chain.parts[0] == case.printed.symbol("friction.screw.eta")
    ]
    assert [recomputes(chain) for chain in lines] == [True]


# --- faults -----------------------------------------------------------------------------------------------

WEDGE = "wedge: {Q: 5 kN, alpha: 10 deg, f1: 0.15, f2: 0.12, f3: 0.1}"
BAND = "band: {M: 90 N m, d: 300 mm, theta: 230 deg, f: 0.3, l: 500 mm, a: 0 mm, b: 100 mm}"
FAULTS = [
    ("incline: {Q: 1 kN, alpha: 95 deg, f: 0.2}", "3:29 out-of-range"),
    ("incline: {Q: 1 kN, alpha: 70 deg, f: 0.2, beta: 25 deg}", "3:51 friction-lifts"),
    ("incline: {Q: 1 kN, alpha: 70 deg, f: 0.6, beta: horizontal}", "3:51 friction-jams"),
    ("incline: {Q: 1 kN, alpha: 5 deg, f: 0.6, beta: 70 deg}", "3:50 friction-jams-down"),
    ("incline: {Q: 0 N, alpha: 5 deg, f: 0.6}", "3:16 out-of-range"),
    ("incline: {Q: 1 kN, alpha: 5 deg}", "3:3 missing-key"),
    (WEDGE.replace("10 deg", "80 deg"), "3:27 friction-wedge-jams"),
    ("screw: {Q: 1 kN, d: 10 mm, p: 30 mm, n: 12, f: 0.3}", "3:33 friction-screw-jams"),
    ("belt: {d: 300 mm, theta: 210 deg, f: 0.3}", "missing-key"),
    ("belt: {d: 300 mm, theta: 210 deg, f: 0.3, S1: 1 N, M: 5 N m}", "3:54 both-given"),
    ("belt: {d: 300 mm, theta: 3600 deg, f: 0.5, S1: 1 N}", "3:28 friction-grip"),
    (BAND.replace("b: 100 mm", "b: 0 mm"), "3:79 friction-slackens"),
    (f"{WEDGE}\n  {BAND}", "4:3 both-given"),
    ("{}", "missing-key"),
]


@pytest.mark.parametrize(
    ("text", "fault"), FAULTS, ids=[f"{number}-{fault}" for number, (_, fault) in enumerate(FAULTS)]
)
def test_what_cannot_be_is_located(text: str, fault: str, tmp_path: Path) -> None:
    file = tmp_path / "friction.yaml"
    file.write_text(f"kind: friction\nparameters:\n  {text}\n", encoding="utf-8")
    for language in ("vi", "en"):
        (found,) = api.check(file, language)  # type: ignore[arg-type]
        assert f"{found.location.line}:{found.location.column} {found.code}".endswith(fault)


@pytest.mark.parametrize("language", ["vi", "en"])
def test_each_task_of_the_file_of_new_is_right(language: str, tmp_path: Path) -> None:
    """As it is, and with each of the lines that begin with # in place of the first task."""
    text = sample("friction", language)  # type: ignore[arg-type]
    tasks = [line for line in text.splitlines() if line.strip(" #").split(":")[0] in TASKS]
    assert len(tasks) == len(TASKS)
    for task in tasks:
        file = tmp_path / "new.yaml"
        file.write_text(text.replace(tasks[0], task.replace("  # ", "  ", 1)), encoding="utf-8")
        assert api.check(file, language) == []  # type: ignore[arg-type]
