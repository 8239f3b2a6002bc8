"""Reports of engines by orders: lines recompute, stars measure as they say, faults and mistakes have their places."""

from __future__ import annotations

import cmath
import math
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.balancing import orders_ids
from reportgen.balancing.engine_calculation import COUPLES, ORDERS
from reportgen.balancing.engine_case import EngineCase
from reportgen.balancing.engine_drawings import UP, star
from reportgen.base.records import replace
from reportgen.base.template_folders import languages
from reportgen.base.units import Language
from reportgen.cases import open_case
from reportgen.catalogue import sample
from reportgen.classes import class_marking
from reportgen.classes.variants import make_variants
from reportgen.document import text_of
from reportgen.drawing import Label
from reportgen.formula import Chain, Number, Symbol
from reportgen.marking.feedback import cell_comment
from reportgen.marking.judging import mark
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import MarkingScheme, marking_scheme
from reportgen.marking.mistakes import Mistake
from reportgen.marking.toleranced_key import Ask, key_of
from reportgen.results import results as results_of
from reportgen.sheets import drawing_sheets
from tests.balancing.test_rotor_reports import ROUNDED, arrows, recomputes
from tests.gears.test_train_reports import chains
from tests.lanes import matrix, proof
from tests.marking import demo, students
from tests.marking.designs import named
from tests.report import built

FOLDER = Path(__file__).parents[2] / "assignments" / "engine-balance"
NAMES = sorted(file.stem for file in FOLDER.glob("*.yaml"))
LANGUAGES: tuple[Language, ...] = languages()
CASES = [(name, language) for name in NAMES for language in LANGUAGES]
TELLING = [("inline-four", "vi"), ("v-six", "en"), ("v-twin", "vi")]


def case_of(name: str, language: Language = "en") -> EngineCase:
    case = built.case(FOLDER / f"{name}.yaml", language)
    assert isinstance(case, EngineCase)
    return case


@pytest.mark.parametrize(("name", "language"), matrix(CASES, TELLING))
def test_every_line_recomputes(name: str, language: Language) -> None:
    found = [recomputes(chain) for chain in chains(case_of(name, language).document().blocks)]
    assert found.count(True) >= 10
    assert False not in found


@pytest.mark.parametrize("name", NAMES)
def test_a_ruler_on_the_stars(name: str) -> None:
    """Each vector is its length over the scale at its angle from x, which points up; the red one closes them."""
    case = case_of(name)
    printed = case.printed
    for letter in "".join(case.stars.values()):
        μ = printed[orders_ids.scale(letter)].values[0]
        for n in ORDERS:
            # What is short stands in an inset, too.
            sides = {name: side for name, side in arrows(star(case, letter, n)).items() if "×" not in name}
            resultant = sides.pop(f"{letter}{n}", 0j)
            assert sum(sides.values()) == pytest.approx(resultant, abs=1e-9)
            assert abs(resultant) == pytest.approx(printed.number(orders_ids.measured(letter, n)).printed, abs=ROUNDED)
            for place, cylinder in zip(case.cylinders, case.given.cylinders, strict=True):
                times = n - 1 if letter in "fp" else n + 1
                angle = n * cylinder.crank.si - (0 if case.given.is_inline else times * cylinder.bank.si)
                weight = case.ledger[orders_ids.arm(place)].at(1) if letter in COUPLES else 1.0
                wanted = UP * weight / μ * 1e3 * cmath.rect(1, angle)
                assert sides.get(f"{letter}{n}.{place}", 0j) == pytest.approx(wanted, abs=1e-6)


@pytest.mark.parametrize("name", NAMES)
def test_the_forces_of_the_page_are_those_of_the_stars(name: str) -> None:
    """The sum of cosines, turned through a period, is as great as both stars say."""
    case = case_of(name)
    φ = [math.tau * k / 7200 for k in range(7200)]
    K = case.ledger["orders.K"].at(1)
    for n, forces in case.forces(φ).items():
        assert abs(forces).max() == pytest.approx(case.ledger[orders_ids.force(n)].at(1), rel=1e-6, abs=1e-9 * K)


@pytest.mark.parametrize("name", NAMES)
def test_words_page_sheet_and_results(name: str) -> None:
    for language in ("vi", "en"):
        assert [row.id for row in key_of(case_of(name, language)).rows if not row.what] == []
    case = case_of(name)
    (animation,) = case.animations()
    assert math.isclose(animation.knots[-1], 360)
    (sheet,) = drawing_sheets(case)
    measured = set()
    for part in sheet.parts:
        labels = [item.content for item in part.scene.items if isinstance(item, Label)]
        notes = [content.parts for content in labels if isinstance(content, Chain)]
        scales = [(parts[0], parts[1]) for parts in notes]
        μ = {of.sub: by.value for of, by in scales if isinstance(of, Symbol) and isinstance(by, Number)}
        for side, length in arrows(part.scene).items():
            if side[1:].isdigit():
                value = case.printed[orders_ids.resultant(side[0], side[1:])].at(1)
                assert abs(length) * μ[side[0]] == pytest.approx(value, rel=2e-3)
                measured.add(side)
    shown = {f"{letter}{n}" for letter in "".join(case.stars.values()) for n in ORDERS}
    assert measured == {side for side in shown if case.ledger[orders_ids.resultant(side[0], side[1:])].at(1)}
    (position,) = results_of(case)["positions"]
    assert set(position["orders"]) == {"1", "2", "4"}


# --- a V8 whose forces are free and whose rotating masses have a couple --------------------------------------

CRANKS, APART = (0, 90, 270, 180), 0.11
V_EIGHT = """kind: engine-balance
parameters:
  r: 44 mm
  l: 150 mm
  n: 4000 rpm
  m3: 0.5 kg
  m2: 0.6 kg
  s: 0.3
  cylinders:
""" + "".join(
    f"    - {{crank: {crank} deg, at: {110 * throw + 20 * side} mm, bank: {45 - 90 * side} deg}}\n"
    for throw, crank in enumerate(CRANKS)
    for side in (0, 1)
)


@pytest.fixture(scope="module", name="v_eight")
def _v_eight(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("eight") / "v8.yaml"
    file.write_text(V_EIGHT, encoding="utf-8")
    return file


def test_the_page_moves_the_couples_with_that_of_the_rotating_masses(v_eight: Path) -> None:
    """m_A r ω² |Σ c e^{iθ}| at constant size, and so its half with m_rec in place of m_A: the star q₁ is closed."""
    (animation,) = open_case(v_eight, "en").animations()
    assert [pane.key for pane in animation.panes] == ["engine", "forces", "couples"]
    found = {value.symbol: value.values.values for value in animation.values}
    ω = 4000 * math.tau / 60
    throws = [(-1.5 + throw) * APART * cmath.rect(2, math.radians(crank)) for throw, crank in enumerate(CRANKS)]
    per_kg = 0.044 * ω**2 * abs(sum(throws))
    assert found[Symbol("M", "rot")] == pytest.approx(0.6 * 0.7 * per_kg, rel=1e-9)
    assert found[Symbol("M", "1")] == pytest.approx((0.5 + 0.6 * 0.3) / 2 * per_kg, rel=1e-9)
    assert not {Symbol("F", "1"), Symbol("F", "rot"), Symbol("M", "2")} & set(found)
    # F₄ of two banks at a right angle stays on x: along y there is nothing to draw.
    charts = [{curve.label for curve in chart.curves} for chart in animation.charts]
    couples = {Symbol("M", of) for of in ("1", "4", "rot")}
    assert charts == [{Symbol("F", "4")}, couples, couples]


NEEDED = {"en": "need no counterweight", "vi": "không cần đối trọng", "ru": "противовеса не требуют", "zh": "不需配重"}


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_conclusion_names_no_counterweight_of_nothing(v_eight: Path, language: Language) -> None:
    conclusion = text_of(open_case(v_eight, language).document()).rpartition("F_2")[2]
    assert NEEDED[language] in conclusion
    assert "U_c" not in conclusion


# --- faults -----------------------------------------------------------------------------------------------

TEXT = """kind: engine-balance
parameters:
  r: 40 mm
  l: 160 mm
  n: 3000 rpm
  m3: 0.5 kg
  m2: 0.6 kg
  s: 0.35
  cylinders:
    - {crank: 0 deg, at: 0 mm}
    - {crank: 180 deg, at: 100 mm}
"""
FAULTS = [
    ("l: 160 mm", "l: 40 mm", ["4:6 rod-too-short"]),
    ("  s: 0.35\n", "", ["7:3 needs-besides"]),
    ("  m2: 0.6 kg\n", "", ["7:3 needs-besides"]),
    ("at: 100 mm", "at: 0 mm", ["11:7 cylinders-in-one-place"]),
    ("m3: 0.5 kg", "m3: 0 kg", ["6:7 out-of-range"]),
    ("at: 100 mm", "at: 0 mm, bank: 90 deg", []),
]


@pytest.mark.parametrize(("old", "new", "faults"), FAULTS, ids=lambda one: str(one).strip()[:40])
def test_what_cannot_be_is_located(old: str, new: str, faults: list[str], tmp_path: Path) -> None:
    file = tmp_path / "engine.yaml"
    assert TEXT.count(old) == 1
    file.write_text(TEXT.replace(old, new), encoding="utf-8")
    for language in LANGUAGES:
        found = api.check(file, language)
        assert [f"{one.location.line}:{one.location.column} {one.code}" for one in found] == faults


@pytest.mark.parametrize("language", ["vi", "en"])
def test_the_file_of_new_is_right(language: Language, tmp_path: Path) -> None:
    file = tmp_path / "new.yaml"
    file.write_text(sample("engine-balance", language), encoding="utf-8")
    assert api.check(file, language) == []


# --- marking ----------------------------------------------------------------------------------------------

MISTAKES = [
    ("v-twin", "orders-single-angle", (orders_ids.resultant("f", 2),)),
    ("inline-four", "orders-single-angle", (orders_ids.resultant("f", 2),)),
    ("v-twin", "orders-inverse-lambda", (orders_ids.factor(2),)),
    ("v-twin", "orders-speed-once", ("orders.K",)),
    ("three", "orders-share-of-rotating", ("orders.U",)),
    ("v-twin", "degrees-for-radians", (orders_ids.resultant("g", 2),)),
    ("three", "orders-share-of-rotating", ("orders.U.M",)),
    ("three", "orders-speed-once", ("orders.rotating.M",)),
]


@pytest.mark.parametrize(("name", "mistake", "where"), MISTAKES, ids=lambda one: str(one))
def test_the_usual_mistakes_have_names(name: str, mistake: str, where: tuple[str, ...], tmp_path: Path) -> None:
    file = FOLDER / f"{name}.yaml"
    if name == "three":
        # Two cylinders on pins at a right angle: their star is open.
        file = tmp_path / "three.yaml"
        file.write_text(TEXT.replace("180 deg", "90 deg"), encoding="utf-8")
    scheme = marking_scheme(open_case(file, "en"))
    sheet = students.written(scheme, students.worked_out(scheme, named(scheme, mistake, *where)))
    first = mark(scheme, sheet).first_errors
    assert {cell.mistake for cell in first} == {mistake}
    assert {cell.id for cell in first} == set(where)


@pytest.mark.parametrize("accepted", [True, False])
@pytest.mark.parametrize("written_down", [True, False], ids=["A₂ on the sheet", "A₂ used only"])
def test_the_first_term_of_the_series_is_known_by_name(accepted: bool, written_down: bool) -> None:
    """A₂ = λ and A₄ = −λ³/4 as in textbooks, and all that stands on them: right or wrong as the policy says."""
    case = built.case(FOLDER / "v-twin.yaml", "en")
    scheme = marking_scheme(case, Policy(approximations=accepted))
    λ = scheme.ledger["orders.lambda"].values[0]
    factors = {orders_ids.factor(2): np.array([λ]), orders_ids.factor(4): np.array([-(λ**3) / 4])}
    changes = {id: (lambda _, __, by=by: by) for id, by in factors.items()}
    world = students.worked_out(scheme, Mistake("", orders_ids.factor(2), changes))
    assert off(scheme, orders_ids.factor(2), world) > 1
    sheet = students.written(scheme, world)
    if not written_down:
        sheet = replace(sheet, values={at: one for at, one in sheet.values.items() if at[0] not in factors})
    marking = mark(scheme, sheet)
    named_so = [cell for cell in marking.cells if cell.mistake == "orders-first-term"]
    assert {cell.where for cell in named_so} <= factors.keys()
    assert named_so
    filled = [cell for cell in marking.cells if cell.given is not None]
    lost = sum(cell.worth - cell.points for cell in filled)
    assert lost == (0 if accepted else len(named_so))
    assert {cell.id for cell in marking.first_errors} == (set() if accepted else {cell.id for cell in named_so})
    if written_down:
        assert {cell.id for cell in named_so} == factors.keys()
    feedback = "\n".join(cell_comment(cell, marking, case.words, show_answers=False) for cell in named_so)
    assert "a textbook's approximation" in feedback


def off(scheme: MarkingScheme, id: str, world: students.World) -> float:
    return students.off(scheme, scheme.rows[id], world, 0)


def test_what_the_sheet_asks_for() -> None:
    key = Ask().of(marking_scheme(built.case(FOLDER / "inline-four.yaml", "en")).key)
    of_orders = {family(n) for family in (orders_ids.force, orders_ids.couple) for n in ORDERS}
    of_stars = {orders_ids.resultant(letter, n) for letter in "fp" for n in ORDERS}
    masses = {"orders.mA", "orders.mB", "orders.m"}
    single = {"orders.omega", "orders.lambda", "orders.K", orders_ids.factor(2), orders_ids.factor(4)}
    counterweight = {f"orders.{name}{of}" for name in ("rotating", "U", "left") for of in ("", ".M")}
    assert {row.id for row in key.asked} == of_orders | of_stars | masses | single | counterweight


@pytest.mark.parametrize("name", NAMES)
def test_mistakes_have_words_in_both_languages(name: str) -> None:
    for language in ("vi", "en"):
        case = case_of(name, language)
        names = {mistake for many in case.misconceptions.changed.values() for mistake, _ in many}
        for mistake in names:
            assert "{symbol}" in case.words["mistakes"][mistake]
            assert case.words["mistake_names"][mistake]


@proof
def test_a_class_from_variants_to_marks(tmp_path: Path) -> None:
    """Twelve engines by banks, cranks and speeds; whoever has everything right has all points."""
    text = TEXT.replace("n: 3000 rpm", "n: {from: 2400 rpm, to: 3600 rpm, step: 100 rpm}")
    text = text.replace("crank: 180 deg", "crank: {from: 60 deg, to: 180 deg, step: 15 deg}")
    (tmp_path / "spec.yaml").write_text(text, encoding="utf-8")
    rows = "".join(f"S{number:02d},Student {number}\n" for number in range(1, 13))
    (tmp_path / "roster.csv").write_text(f"id,name\n{rows}", encoding="utf-8")
    made = make_variants(tmp_path / "spec.yaml", tmp_path / "roster.csv", tmp_path / "variants", False, "en")
    assert len(made.files) == 12
    (tmp_path / "sheets").mkdir()
    for path in sorted((tmp_path / "variants").glob("S*.yaml")):
        scheme = marking_scheme(open_case(path))
        filled = demo.workbook(scheme.key, students.written(scheme, students.worked_out(scheme)))
        (tmp_path / "sheets" / f"{path.stem}.xlsx").write_bytes(filled)
    graded = class_marking.grade([tmp_path / "sheets"], tmp_path / "variants", Policy())
    assert graded.problems == ()
    assert [marking.points for marking in graded.markings] == [marking.out_of for marking in graded.markings]
