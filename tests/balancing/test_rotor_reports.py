"""Reports of rotors: lines and cells recompute, plans measure as they say, faults are located, in both languages."""

from __future__ import annotations

import cmath
import math
import re
from pathlib import Path

import pytest

from reportgen import api
from reportgen import document as tree
from reportgen.balancing import rotor_ids
from reportgen.balancing.rotor_case import RotorCase
from reportgen.balancing.rotor_drawings import moments_plan, two_views, unbalance_plan
from reportgen.balancing.rotor_file import MOST_MASSES
from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.cases import open_case, opened
from reportgen.catalogue import sample
from reportgen.drawing import Arrow, Label, Scene
from reportgen.formula import PI, Chain, Number, walk
from reportgen.formula.evaluation import evaluate
from reportgen.marking.toleranced_key import key_of
from reportgen.results import results as results_of
from reportgen.sheets import drawing_sheets
from tests.gears.test_train_reports import chains
from tests.gears.test_train_reports import recomputes as comes_out
from tests.lanes import matrix

FOLDER = Path(__file__).parents[2] / "assignments" / "rotor"
FILES = sorted(FOLDER.glob("*.yaml"))
NAMES = [file.stem for file in FILES]
MM = 1000
SMALL = 1e-4
"""Of five figures less than one unit of the last."""
ROUNDED = 0.005 + 1e-9
"""How far a length on paper is rounded (mm)."""


def case_of(name: str, language: Language = "en") -> RotorCase:
    return rotor(FOLDER / f"{name}.yaml", language)


def rotor(file: Path, language: Language = "en") -> RotorCase:
    case = open_case(file, language)
    assert isinstance(case, RotorCase)
    return case


def recomputes(chain: Chain) -> bool | None:
    """Whether a line comes to its result as it is printed, an angle in degrees."""
    *parts, result = chain.parts
    if isinstance(result, Number) and result.unit == "°":
        in_degrees = tuple(part * 180 / PI for part in parts[1:])
        return comes_out(Chain((parts[0], *in_degrees, replace(result, unit=""))))
    if isinstance(result, Number) and result.value == 0 and len(chain.parts) > 2 and comes_out(chain) is False:
        # A value that rounds to nothing is written as 0, without decimals: it is small beside what it is made of.
        numbers = [abs(part.value) for part in walk(parts[-1]) if isinstance(part, Number)]
        return bool(abs(float(evaluate(parts[-1]))) <= SMALL * max(numbers, default=0.0))
    return comes_out(chain)


CASES = [(name, language) for name in NAMES for language in ("vi", "en")]
TELLING = [("disc", "vi"), ("rotor-one-plane", "en"), ("rotor-two-planes", "vi")]


@pytest.mark.parametrize(("name", "language"), matrix(CASES, TELLING))
def test_every_line_recomputes(name: str, language: Language) -> None:
    found = [recomputes(chain) for chain in chains(case_of(name, language).document().blocks)]
    assert found.count(True) >= 10
    assert False not in found


def table_of(case: RotorCase, key: str) -> list[list[float]]:
    """The numbers of a table of the report."""
    table = next(one for one in case.document().blocks if isinstance(one, tree.Table) and one.key == key)
    return [[cell.inlines[0].number.printed for cell in row[1:]] for row in table.rows]


@pytest.mark.parametrize("name", NAMES)
def test_the_tables_recompute(name: str) -> None:
    """m r, m r z and lengths on paper from the table of masses; components add up to the last row."""
    case = case_of(name)
    masses, products = table_of(case, "tab.masses"), table_of(case, "tab.products")
    A = case.given.planes.A.si * MM
    for (m, r, α, *z), row in zip(masses, products, strict=True):
        wanted = [m * r, *(m * r * (place - A) for place in z), α]
        if case.two_planes:
            wanted.append(m * r * (z[0] - A) / case.printed.number("rotor.mu.V").value)
        wanted.append(m * r / case.printed.number("rotor.mu.U").value)
        assert row == pytest.approx(wanted, abs=0.0051)
    *rows, sums = table_of(case, "tab.components")
    assert [sum(column) for column in zip(*rows, strict=True)] == pytest.approx(sums, rel=1e-3, abs=0.2)


def arrows(scene: Scene) -> dict[str, complex]:
    return {item.name: item.end - item.start for item in scene.items if isinstance(item, Arrow) and item.name}


@pytest.mark.parametrize("name", NAMES)
def test_a_ruler_on_the_plans(name: str) -> None:
    """Each side is its product over the scale, at its mass's angle; the sides close; the last one gives the result."""
    case = case_of(name)
    printed = case.printed
    plans = [("U", "A", unbalance_plan)] + [("V", "B", moments_plan)] * case.two_planes
    for of, closing, draw in plans:
        sides = arrows(draw(case))
        family = rotor_ids.unbalance if of == "U" else rotor_ids.moment
        assert abs(sum(sides.values())) <= ROUNDED
        μ = printed.number(rotor_ids.scale(of)).value
        for number, mass in enumerate(case.given.masses, start=1):
            side = sides[f"{of}{number}"]
            along = side * cmath.rect(1, -mass.angle.si)
            assert along.imag == pytest.approx(0, abs=1e-6)
            assert along.real * μ == pytest.approx(printed.number(family(str(number))).value, abs=0.005 * μ)
        last = sides[f"{of}{closing}"]
        assert abs(last) == pytest.approx(printed.number(rotor_ids.laid_off(of, closing)).printed, abs=ROUNDED)
        direction = printed.number(rotor_ids.direction(closing))
        assert math.degrees(cmath.phase(last)) % 360 == pytest.approx(direction.printed, abs=direction.half_unit + 1e-9)
        length = printed.number("rotor.L").value if of == "V" else 1.0
        result = printed.number(rotor_ids.unbalance(closing))
        assert abs(last) * μ / length == pytest.approx(result.printed, abs=0.005 * μ / length + result.half_unit)


@pytest.mark.parametrize("name", NAMES)
def test_readings_agree_with_components(name: str) -> None:
    """As closely as a plan can be read: 0.01 mm of its sides, 0.1° of its angles."""
    case = case_of(name)
    for plane in case.planes:
        exact = case.ledger[rotor_ids.by_components("U", plane)].at(1)
        assert case.ledger[rotor_ids.unbalance(plane)].at(1) == pytest.approx(exact, rel=1e-12)
        read = case.printed[rotor_ids.unbalance(plane)].at(1)
        every = sum(case.ledger[rotor_ids.unbalance(mass)].at(1) for mass in case.masses)
        assert read == pytest.approx(exact, abs=2e-3 * every)
        α = [case.ledger[id(plane)].at(1) for id in (rotor_ids.direction, ALPHA)]
        assert α[0] == pytest.approx(α[1], abs=1e-12)


def ALPHA(plane: str) -> str:
    return rotor_ids.by_components("alpha", plane)


@pytest.mark.parametrize("name", NAMES)
def test_words_page_sheet_and_results(name: str) -> None:
    """No row of a key is without words; on the sheet, too, a side is what the scale below it says."""
    for language in ("vi", "en"):
        assert [row.id for row in key_of(case_of(name, language)).rows if not row.what] == []
    case = case_of(name)
    (animation,) = case.animations()
    assert math.isclose(animation.knots[-1], 360)
    assert bool(animation.charts) == (case.given.bearings is not None)
    (sheet,) = drawing_sheets(case)
    measured = set()
    for part in sheet.parts:
        sides = arrows(part.scene)
        labels = [item.content for item in part.scene.items if isinstance(item, Label)]
        μ = {parts[0].sub: parts[1].value for parts in (one.parts for one in labels if isinstance(one, Chain))}
        for place, side in sides.items():
            of, number = place[0], place[1:]
            if number.isdigit():
                family = rotor_ids.unbalance if of == "U" else rotor_ids.moment
                value = case.printed.number(family(number)).value
                assert abs(side) * μ[of] == pytest.approx(abs(value), rel=1e-6)
                measured.add(place)
    assert len(measured) == len(case.masses) * (1 + case.two_planes)
    (position,) = results_of(case)["positions"]
    for plane, entry in position["corrections"].items():
        assert entry["unbalance"] == pytest.approx(entry["mass"] * entry["radius"])
        assert plane in case.planes


def test_a_short_report_has_less() -> None:
    assignment = api.load(FOLDER / "rotor-two-planes.yaml", "en")
    full, short = (len(opened(assignment.with_extent(one)).document().blocks) for one in ("full", "short"))
    assert short < full


def test_the_grade_is_judged_by_what_is_written_down(tmp_path: Path) -> None:
    """G 6.3 at 1500 rpm on 40 kg: e = 6.3/157.08 mm, U = 1.604 kg·mm; a grade of 0.1 asks for finer corrections."""
    file = tmp_path / "rotor.yaml"
    text = (FOLDER / "rotor-two-planes.yaml").read_text(encoding="utf-8")
    for grade, kept in (("6.3", True), ("0.1", False)):
        file.write_text(text.replace("6.3 mm/s", f"{grade} mm/s"), encoding="utf-8")
        case = rotor(file)
        permitted = case.ledger[rotor_ids.permitted("U")].at(1)
        assert permitted == pytest.approx(40 * float(grade) * 1e-3 / (1500 * math.pi / 30))
        assert all(case.permitted) is kept


def test_many_masses(tmp_path: Path) -> None:
    """As many as may be, also to the left of plane A: the report has the first line and the table of all."""
    file = tmp_path / "rotor.yaml"
    masses = "".join(
        f"    - {{m: {1 + k % 5} kg, r: {40 + 3 * k} mm, angle: {47 * k % 360} deg, z: {30 * k - 90} mm}}\n"
        for k in range(MOST_MASSES)
    )
    file.write_text(f"kind: rotor\nparameters:\n  planes: {{A: 0 mm, B: 500 mm}}\n  masses:\n{masses}", "utf-8")
    assert api.check(file, "en") == []
    case = open_case(file, "en")
    found = [recomputes(chain) for chain in chains(case.document().blocks)]
    assert False not in found
    assert len(table_of(case, "tab.products")) == MOST_MASSES


# --- faults -----------------------------------------------------------------------------------------------

TEXT = """kind: rotor
parameters:
  planes: {A: 0 mm, B: 600 mm}
  bearings: [-80 mm, 700 mm]
  n: 1500 rpm
  correction: {r: 80 mm}
  masses:
    - {m: 2 kg, r: 50 mm, angle: 0 deg, z: 100 mm}
    - {m: 2 kg, r: 50 mm, angle: 90 deg, z: 300 mm}
"""
FAULTS = [
    ("B: 600 mm", "B: 0 mm", ["3:24 rotor-places"]),
    ("B: 600 mm", "B: -5 mm", ["3:24 rotor-places"]),
    ("700 mm]", "-80 mm]", ["4:22 rotor-places"]),
    ("  n: 1500 rpm\n", "", ["4:3 needs-besides"]),
    ("{r: 80 mm}", "{r: 80 mm, m: 1 kg}", ["6:26 both-given"]),
    ("{r: 80 mm}", "{}", ["6:3 missing-key"]),
    ("{r: 80 mm}", "{A: {r: 80 mm}, B: {m: 1 kg}}", []),
    ("{r: 80 mm}", "{A: {r: 80 mm}, B: {r: 60 mm, m: 1 kg}}", ["6:45 both-given"]),
    ("{r: 80 mm}", "{A: {r: 80 mm}}", ["6:3 rotor-corrections"]),
    ("{r: 80 mm}", "{r: 80 mm, A: {r: 80 mm}, B: {r: 60 mm}}", ["6:26 both-given"]),
    ("{r: 80 mm}", "{r: 0 mm}", ["6:19 out-of-range"]),
    ("r: 50 mm, angle: 0", "r: 0 mm, angle: 0", ["8:20 out-of-range"]),
    ("m: 2 kg, r: 50 mm, angle: 0", "m: 0 kg, r: 50 mm, angle: 0", ["8:11 out-of-range"]),
    ("angle: 0 deg", "angle: 0", ["8:34 missing-unit"]),
    ("angle: 90 deg, z: 300 mm", "angle: 180 deg, z: 100 mm", ["7:3 rotor-balanced"]),
    ("angle: 0 deg, z: 100 mm", "angle: 0 deg, z: 300 mm", []),
    ("A: 0 mm, B: 600 mm", "A: 150 mm, B: 160 mm", []),
    ("  n: 1500 rpm\n", "  n: 1500 rpm\n  grade: 6.3 mm/s\n", ["6:3 needs-besides"]),
    ("  n: 1500 rpm\n", "  n: 1500 rpm\n  mass: 40 kg\n", ["6:3 needs-besides"]),
]


@pytest.mark.parametrize(("old", "new", "faults"), FAULTS, ids=lambda one: str(one).strip()[:40])
def test_what_cannot_be_is_located(old: str, new: str, faults: list[str], tmp_path: Path) -> None:
    file = tmp_path / "rotor.yaml"
    assert TEXT.count(old) == 1
    file.write_text(TEXT.replace(old, new), encoding="utf-8")
    for language in ("vi", "en"):
        found = api.check(file, language)
        assert [f"{one.location.line}:{one.location.column} {one.code}" for one in found] == faults


def test_no_masses_are_a_fault(tmp_path: Path) -> None:
    file = tmp_path / "rotor.yaml"
    file.write_text(re.sub(r"  masses:\n.*", "  masses: []\n", TEXT, flags=re.DOTALL), encoding="utf-8")
    assert [(one.code, one.location.line) for one in api.check(file, "en")] == [("too-few", 7)]


def test_a_plane_that_is_in_balance_by_itself(tmp_path: Path) -> None:
    """All masses in plane B: nothing is to be put into plane A, and that has no direction."""
    file = tmp_path / "rotor.yaml"
    file.write_text(TEXT.replace("z: 100 mm", "z: 600 mm").replace("z: 300 mm", "z: 600 mm"), encoding="utf-8")
    assert api.check(file, "en") == []
    case = open_case(file, "en")
    assert case.ledger[rotor_ids.unbalance("A")].at(1) == 0
    (entry,) = (one["corrections"]["A"] for one in results_of(case)["positions"])
    assert entry["angle"] is None
    case.document()
    row = key_of(case).row(rotor_ids.direction("A"))
    assert math.isnan(row.values[0])


@pytest.mark.parametrize("language", ["vi", "en"])
def test_the_file_of_new_is_right(language: Language, tmp_path: Path) -> None:
    file = tmp_path / "new.yaml"
    file.write_text(sample("rotor", language), encoding="utf-8")
    assert api.check(file, language) == []


COUPLE = """kind: rotor
parameters:
  planes: {A: 50 mm}
  masses: [{m: 1 kg, r: 50 mm, angle: 0 deg, z: 0 mm}, {m: 1 kg, r: 50 mm, angle: 180 deg, z: 100 mm}]
  bearings: [-50 mm, 150 mm]
  n: 900 rpm
"""
AS_IT_IS = {
    "en": ("static balance as it is", "couple, which one plane cannot correct"),
    "vi": ("cân bằng tĩnh", "ngẫu lực mà một mặt phẳng không cân bằng được"),
    "ru": ("и без корректировки уравновешен статически", "пару сил, которую нельзя уравновесить в одной плоскости"),
    "zh": ("已静平衡", "单个基面无法平衡"),
}


@pytest.mark.parametrize("language", list(AS_IT_IS))
def test_no_correction_is_told_as_none(language: Language, tmp_path: Path) -> None:
    """Σ m r = 0, but the masses at two places have a couple."""
    file = tmp_path / "couple.yaml"
    file.write_text(COUPLE, encoding="utf-8")
    text = tree.text_of(open_case(file, language).document())
    for told in AS_IT_IS[language]:
        assert told in text


def test_masses_alike_on_both_sides_of_the_plane_leave_no_couple(tmp_path: Path) -> None:
    file = tmp_path / "alike.yaml"
    file.write_text(COUPLE.replace("180 deg", "0 deg"), encoding="utf-8")
    text = tree.text_of(open_case(file, "en").document())
    assert "couple" not in text
    assert "The rotor is balanced statically by the correction" in text


def test_masses_in_the_first_plane_need_no_second(tmp_path: Path) -> None:
    file = tmp_path / "rotor.yaml"
    file.write_text(TEXT.replace("z: 100 mm", "z: 0 mm").replace("z: 300 mm", "z: 0 mm"), encoding="utf-8")
    assert [(one.code, one.location.line) for one in api.check(file, "en")] == [("rotor-one-plane", 3)]


def test_a_radius_in_one_plane_and_a_mass_in_the_other(tmp_path: Path) -> None:
    file = tmp_path / "rotor.yaml"
    file.write_text(TEXT.replace("{r: 80 mm}", "{A: {r: 80 mm}, B: {m: 1.5 kg}}"), encoding="utf-8")
    for language in ("vi", "en"):
        case = open_case(file, language)
        for plane, (r, m) in {"A": (0.08, None), "B": (None, 1.5)}.items():
            U = case.ledger[rotor_ids.unbalance(plane)].at(1)
            assert case.ledger[rotor_ids.radius(plane)].at(1) == pytest.approx(r or U / 1.5)
            assert case.ledger[rotor_ids.mass(plane)].at(1) == pytest.approx(m or U / 0.08)
        found = [recomputes(chain) for chain in chains(case.document().blocks)]
        assert False not in found


def test_a_bearing_that_bears_nothing(tmp_path: Path) -> None:
    """All unbalance stands at bearing C: what the other one bears is nothing, and prints as such."""
    file = tmp_path / "rotor.yaml"
    file.write_text(TEXT.replace("z: 100 mm", "z: -80 mm").replace("z: 300 mm", "z: -80 mm"), encoding="utf-8")
    case = open_case(file, "en")
    assert case.ledger[rotor_ids.bearing_force("before", "D")].at(1) == 0
    assert case.printed.number(rotor_ids.bearing_force("before", "D")).value == 0
    assert False not in [recomputes(chain) for chain in chains(case.document().blocks)]


def test_a_slender_engine_or_rotor_keeps_to_its_page(tmp_path: Path) -> None:
    """Radii far larger than the distances along the shaft: a scheme is no higher than a page."""
    file = tmp_path / "rotor.yaml"
    file.write_text(TEXT.replace("r: 50 mm, angle: 0", "r: 5000 mm, angle: 0"), encoding="utf-8")
    scene = two_views(open_case(file, "en"))
    assert scene.height < 200
    assert scene.width < 170
