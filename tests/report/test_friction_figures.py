"""Friction circles and reactions as they are drawn: what a ruler finds on the figures of the report and its page."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from reportgen.base.units import MM
from reportgen.cases import MachineCase, open_case
from reportgen.document import text_of
from reportgen.drawing import Circle, Label, Scene
from reportgen.formula import Symbol
from reportgen.friction import friction_ids
from reportgen.friction import views as friction
from reportgen.friction.force_plans import force_plan_with_friction
from reportgen.friction.joints import relative_sense, with_friction
from reportgen.friction.tilting import face_forces
from reportgen.report.context import ReportContext
from reportgen.report.mechanism_figures import drawing_scale
from tests.lanes import matrix

ROOT = Path(__file__).parents[2] / "assignments"
RULER = 0.01
"""mm: the last digit of a measured length."""
SHAPER, SLIDER_CRANK = (ROOT / f"{name}-friction.yaml" for name in ("shaper", "slider-crank"))


def report_of(file: Path) -> tuple[ReportContext, int]:
    case = open_case(file)
    assert isinstance(case, MachineCase)
    report = ReportContext(case)
    return report, report.worked_forces[0]


def circles(scene: Scene, radius: float) -> list[Circle]:
    return [
        item for item in scene.items if isinstance(item, Circle) and math.isclose(item.radius, radius, abs_tol=1e-3)
    ]


@pytest.mark.parametrize("file", [SHAPER, SLIDER_CRANK], ids=lambda path: path.stem)
def test_reactions_are_tangent_to_the_friction_circles(file: Path) -> None:
    """The foot of the radius is at ρ, square to the force, on the side on which the moment opposes turning."""
    report, k = report_of(file)
    for carried in friction.joint_forces(report, k):
        if carried.each.kind != "pin":
            continue
        ρ = float(report.ledger[carried.each.of.share].values[0])
        moment = np.imag(np.conj(carried.offset) * carried.force)
        assert abs(carried.offset) == pytest.approx(ρ, rel=1e-4), carried.each.digits  # as printed, to five figures
        assert abs(np.real(np.conj(carried.offset) * carried.force)) < 1e-9 * abs(carried.force) * ρ
        turning = relative_sense(carried.each.of.joint, report.analysis.motion)[k - 1]
        on_second = carried.each.digits.endswith(str(carried.each.of.joint.links[1]))
        assert np.sign(moment) == (-turning if on_second else turning)


@pytest.mark.parametrize("file", [SHAPER, SLIDER_CRANK], ids=lambda path: path.stem)
def test_reactions_are_drawn_as_they_are_named(file: Path) -> None:
    """The force of link i on link j: with the loads on a link, those named as on it less those as from it balance."""
    report, k = report_of(file)
    drawn = {carried.each.digits: carried.force for carried in friction.joint_forces(report, k)}
    loads = [load for load in report.analysis.loads if load.name[0] != "R"]
    for link in report.machine.linkage.links[1:]:
        given = sum(complex(load.force[k - 1]) for load in loads if load.link == link)
        on = sum(force for digits, force in drawn.items() if digits[1] == str(link))
        by = sum(force for digits, force in drawn.items() if digits[0] == str(link))
        assert abs(given + on - by) < 1e-6 * max(map(abs, drawn.values())), link


def test_the_scheme_shows_circles_to_scale() -> None:
    report, k = report_of(SHAPER)
    scene = friction.scheme_scene(report, k)
    radii = {
        carried.each.point: 0.08 * 0.02 if carried.each.point in "DE" else 0
        for carried in friction.joint_forces(report, k)
    }
    assert len(circles(scene, radii["D"] * drawing_scale(report))) >= 1


@pytest.mark.parametrize("file", [SHAPER, SLIDER_CRANK], ids=lambda path: path.stem)
def test_the_plans_with_friction_close(file: Path) -> None:
    """Head to tail, the vectors of the plan with friction lead back to its first corner, in newtons, too."""
    report, k = report_of(file)
    for group in report.groups:
        assert group.polygon is not None
        plan = force_plan_with_friction(report, group.polygon, k)
        moved = [vector for vector in plan.vectors if vector.name.endswith(".fr")]
        assert moved, group.name
        for earlier, later in pairwise(moved):
            assert abs(earlier.end - later.start) < RULER
        μ = float(report.ledger[f"mu.R{group.polygon.name}"].at(k))
        closing = moved[-1]
        solved = with_friction(report.analysis)
        name = f"R{group.guide}"
        force = abs(
            complex(solved.forces.reactions[name].force[k - 1])
            + sum(complex(load.force[k - 1]) for load in solved.loads if load.name == name)
        )
        assert closing.length == pytest.approx(force / μ * MM, abs=RULER)


@pytest.fixture(scope="module")
def press(tmp_path_factory: pytest.TempPathFactory) -> tuple[ReportContext, int]:
    """The press with a group of class III, with friction in its pins."""
    file = tmp_path_factory.mktemp("press") / "press.yaml"
    text = (ROOT / "linkage" / "press-class-iii.yaml").read_text(encoding="utf-8")
    pins = ", ".join(f"{name}: {{f: 0.1, r: 10 mm}}" for name in "OABCDEF")
    file.write_text(text.replace("  declared:", f"  friction: {{pins: {{{pins}}}}}\n  declared:"), encoding="utf-8")
    return report_of(file)


def test_the_joints_of_a_class_iii_group_are_labelled_as_calculated(press: tuple[ReportContext, int]) -> None:
    """The rotation drawn at a pin has the name with which the text computes it: R_32 acts on link 2, so ω_23."""
    report, k = press
    drawn = {
        item.content for scene in friction.joints(report, k).scenes for item in scene.items if isinstance(item, Label)
    }
    named = [family.symbol for id, family in report.ledger.families.items() if id in friction_ids.turning]
    assert Symbol("ω", "23") in named
    assert len(named) >= 5
    assert set(named) <= drawn


def test_the_plan_of_a_class_iii_group_has_all_its_outer_reactions(press: tuple[ReportContext, int]) -> None:
    """With and without friction, the vectors go head to tail through the reaction of the third leg, and close."""
    report, k = press
    (group,) = report.triads
    assert group.polygon is not None
    plan = force_plan_with_friction(report, group.polygon, k)
    with_it = [vector for vector in plan.vectors if vector.name.endswith(".fr")]
    without = [vector for vector in plan.vectors if vector not in with_it]
    for vectors in (without, with_it):
        for earlier, later in pairwise(vectors):
            assert abs(earlier.end - later.start) < RULER
    assert abs(without[-1].end - without[0].start) < RULER
    solved = with_friction(report.analysis)
    μ = float(report.ledger[f"mu.R{group.polygon.name}"].at(k))
    assert with_it[-1].length == pytest.approx(abs(solved.forces.reactions["R12"].force[k - 1]) / μ * MM, abs=RULER)


def test_the_reaction_of_a_guide_leans_by_the_angle_of_friction() -> None:
    report, k = report_of(SLIDER_CRANK)
    (guide,) = (carried for carried in friction.joint_forces(report, k) if carried.each.kind == "slider")
    along = report.analysis.motion.slides[0, 3].direction[k - 1]
    sideways = guide.force * np.conj(along)
    assert abs(sideways.real / sideways.imag) == pytest.approx(0.12)
    assert np.sign(sideways.real) == -np.sign(report.analysis.motion.slides[0, 3].v[k - 1])


def test_published_figures_are_printed() -> None:
    """M₀, M, η at 60°, the efficiency over the turn and the dead zones, as the reference has them, rounded."""
    report, k = report_of(SLIDER_CRANK)
    numbers = {id: report.ledger.number(id, k).value for id in ("M.eq", "friction.M", "friction.eta")}
    assert numbers == pytest.approx({"M.eq": 97.690859, "friction.M": 105.698777, "friction.eta": 0.924238}, rel=1e-4)
    assert report.ledger.number("friction.eta.cycle").value == pytest.approx(0.906789, abs=1e-5)
    zones = [
        report.ledger.number(f"friction.dead.3.{number}.{side}").value
        for number in (1, 2)
        for side in ("before", "behind")
    ]
    assert zones == pytest.approx([2.46456, 2.46456, 3.34282, 3.34282], abs=0.005)


def test_rounds_stand_as_they_are_printed() -> None:
    """Each torque is what the printed reactions of the round before it give on a calculator; the last two are one."""
    report, k = report_of(SLIDER_CRANK)
    q = report.ledger
    shown = {
        name: q.number(name, k).value
        for name in q.families
        if name.startswith(("friction.", "R.", "M.eq", "omega.", "v."))
    }
    ρ = {"01": 0.0025, "12": 0.002, "32": 0.0015}
    ω = {"01": 10.0, "12": shown["friction.omega.12"], "32": shown["omega.2"]}
    count = sum(name.startswith("friction.round.") for name in shown)
    assert count >= 2
    for number in range(1, count + 1):
        before = "" if number == 1 else f".{number - 1}"
        R = {digits: shown[f"R.{digits}" if number == 1 else f"friction.R.{digits}{before}"] for digits in (*ρ, "03")}
        lost = sum(ρ[digits] * R[digits] * ω[digits] for digits in ρ) + 0.12 * R["03"] * shown["v.C"]
        assert shown[f"friction.round.{number}"] == pytest.approx(shown["M.eq"] + lost / 10.0, abs=0.0051)
    assert shown[f"friction.round.{count}"] == pytest.approx(shown["friction.M"], abs=0.0051)


# --- a slider that tilts ------------------------------------------------------------------------------

WIDE = """kind: slider-crank
report: {language: LANGUAGE, worked_positions: [3]}
positions: {count: 12}
parameters:
  r: 80 mm
  l: 300 mm
  n: 200 rpm
  m3: 7 kg
  force: {by: constant, F: 1200 N, stroke: inward}
  loads: [{by: constant, link: 3, M: -20 N m}]
  faces: {3: {from: -60 mm, to: 60 mm, below: 30 mm}}
  friction: {pins: {B: {f: 0.08, r: 20 mm}}, sliders: {3: 0.12}}
"""


def wide(folder: Path, language: str = "en") -> tuple[ReportContext, int]:
    file = folder / "wide.yaml"
    file.write_text(WIDE.replace("LANGUAGE", language), encoding="utf-8")
    return report_of(file)


def test_where_a_slider_tilts_each_face_reaction_leans_by_the_angle_of_friction(tmp_path: Path) -> None:
    """R₁ and R₂ lean by arctan f against the sliding on opposite sides; together they do not. N is the sum of sizes."""
    report, k = wide(tmp_path)
    (guide,) = (carried for carried in friction.joint_forces(report, k) if carried.each.kind == "slider")
    first, last = face_forces(report, guide.each.of.joint, k)
    slide = report.analysis.motion.slides[0, 3]
    along = complex(slide.direction[k - 1])
    for end in (first, last):
        assert abs(end.along) == pytest.approx(0.12 * abs(end.across))
        assert np.sign((end.along * np.conj(along)).real) == -np.sign(slide.v[k - 1])
    assert (first.across / last.across).real < 0
    together = first.across + first.along + last.across + last.along
    assert together == pytest.approx(guide.force)
    assert abs((together / along).real) > 1.01 * 0.12 * abs((together / along).imag)
    sizes = abs(first.across) + abs(last.across)
    assert report.ledger.number("friction.R.03", k).value == pytest.approx(sizes, rel=1e-4)
    assert abs(last.at - first.at) == pytest.approx(0.12)
    names = {item.content for item in friction.scheme_scene(report, k).items if isinstance(item, Label)}
    assert {Symbol("R", f"03,{end}", "fr", "vector") for end in (1, 2)} <= names
    assert Symbol("R", "03", "fr", "vector") not in names


LEANS = {
    "en": "Each of the two face reactions leans from its normal by the angle of friction",
    "vi": "Mỗi phản lực ở một đầu nghiêng so với pháp tuyến của nó",
    "ru": "Каждая из двух реакций отклонена от своей нормали на угол трения",
    "zh": "每一端的反力各自偏离其法线一个摩擦角",
}


@pytest.mark.parametrize("language", matrix(LEANS, ["vi"]))
def test_words_say_what_leans_where_a_slider_tilts(language: str, tmp_path: Path) -> None:
    report, _ = wide(tmp_path, language)
    assert LEANS[language] in text_of(report.case.document())
