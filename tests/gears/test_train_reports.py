"""Reports of planetary trains: lines and cells recompute, drawings measure as they say, in both languages."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import pytest

from reportgen import api
from reportgen import document as tree
from reportgen.cases import open_case, opened
from reportgen.drawing import Arrow, Label, Line
from reportgen.formula import Chain, Number, Symbol, walk
from reportgen.formula.evaluation import evaluate
from reportgen.gears import train_ids
from reportgen.gears.tooth_numbers import turned
from reportgen.gears.train_drawings import velocity_triangles
from reportgen.marking.toleranced_key import key_of
from reportgen.results import results as results_of
from reportgen.sheets import drawing_sheets
from tests.lanes import matrix

FILES = sorted((Path(__file__).parents[2] / "assignments" / "gears").glob("train-*.yaml"))
CASES = [(file.stem, language) for file in FILES for language in ("vi", "en")]
TELLING = [("train-single", "vi"), ("train-double", "en"), ("train-motor", "vi"), ("train-rings", "en")]
MM = 1000


def case_of(name: str, language: str = "en"):  # type: ignore[no-untyped-def]
    return open_case(next(file for file in FILES if file.stem == name), language)  # type: ignore[arg-type]


def chains(blocks: tuple[tree.Block, ...]) -> Iterator[Chain]:
    for block in blocks:
        if isinstance(block, tree.Equation):
            yield from (row for row in block.rows if isinstance(row, Chain))


def recomputes(chain: Chain) -> bool | None:
    """Whether the line's last formula comes to its result as it is printed; None for a line without numbers in it."""
    *_, formula, result = chain.parts
    if not isinstance(result, Number) or len(chain.parts) < 3:
        return None
    if any(isinstance(part, Symbol) and part.value is None for part in walk(formula)):
        return None
    value = float(evaluate(formula)) * (100 if result.unit == "%" else 1)
    # Exact results are free of the dust of floats; ties may fall either way.
    return abs(value - result.printed) <= result.half_unit * (1 + 1e-6) + 1e-9 * max(abs(value), 1)


@pytest.mark.parametrize(("name", "language"), matrix(CASES, TELLING))
def test_every_line_recomputes(name: str, language: str) -> None:
    found = [recomputes(chain) for chain in chains(case_of(name, language).document().blocks)]
    assert found.count(True) >= 20
    assert False not in found


def test_a_corrupted_digit_is_caught() -> None:
    assert recomputes(Chain((Symbol("x"), Number(2.0) * Number(1.5, 1), Number(3.1, 1)))) is False


@pytest.mark.parametrize("name", [file.stem for file in FILES])
def test_every_cell_of_the_candidates_recomputes(name: str) -> None:
    """u by Willis, Δu against what is asked for, D around the satellites: of the printed tooth numbers alone."""
    case = case_of(name)
    given, single = case.given, case.given.scheme == "single"
    table = next(one for one in case.document().blocks if isinstance(one, tree.Table) and one.key == "tab.candidates")
    sizes = []
    for row in table.rows:
        cells = [cell.inlines[0] for cell in row]
        texts = [one.text for one in cells[1 : 4 if single else 5]]  # type: ignore[union-attr]
        numbers = [one.number for one in cells[len(texts) + 1 : -1]]  # type: ignore[union-attr]
        z1, z2, *other, z3 = map(int, texts)
        z2p = other[0] if other else z2
        sign = 1 if given.scheme in ("single", "double") else -1
        u = 1 + sign * z2 * z3 / (z1 * z2p)
        u = 1 / u if given.by_carrier else u
        a = given.m.si * (z1 - z2 if given.scheme == "double-inner" else z1 + z2) / 2
        across = 2 * a + max(given.m.si * z2, given.second_module.si * z2p)
        for number, value in zip(numbers, (u, (u / given.wanted - 1) * 100, across * MM), strict=True):
            assert abs(number.value - value) <= number.half_unit * (1 + 1e-6) + 1e-9
        sizes.append(across)
    assert sizes == sorted(sizes)


@pytest.mark.parametrize("name", [file.stem for file in FILES])
def test_rates_hold_to_rolling(name: str) -> None:
    """Without slip: in both meshes the rims move equally fast, that of wheel 3 not at all; and all satellites fit."""
    case = case_of(name)
    ω = {wheel: float(case.ledger[train_ids.omega(wheel)].at(1)) for wheel in ("1", "2", "H")}
    z, m, m2 = case.train.teeth, case.given.m.si, case.given.second_module.si
    s1, s3 = case.scheme.signs
    a = m * abs(z.z1 - s1 * z.z2) / 2
    # The meshes lie on the line of centres, inside or outside of the satellite's axis.
    assert ω["1"] * m * z.z1 / 2 == pytest.approx(ω["H"] * a + ω["2"] * s1 * m * z.z2 / 2)
    still = ω["H"] * a + ω["2"] * s3 * m2 * z.z2_prime / 2
    assert still == pytest.approx(0, abs=1e-9 * abs(ω["H"]) * a)
    assert None not in turned(case.train, case.given.k)[1]


def test_rows_bring_the_motor_to_the_crank(tmp_path: Path) -> None:
    """1440 rpm to 60: rows of 2.5 and 2 leave 4.8, met by 20/76, nearly by 18/66; what is reached goes by the teeth."""
    file = tmp_path / "train.yaml"
    more = "n_out: 60 rpm, before: [[20, 50]], behind: [[18, 36]], tolerance: 0.03"
    for tolerance, teeth in (("0.03", (18, 66)), ("0", (20, 76))):
        text = TEXT.format(scheme="single", u=5, k=3 if tolerance != "0" else 4, more="").replace("u: 5", more)
        file.write_text(text.replace("0.03", tolerance), encoding="utf-8")
        case = open_case(file, "en")
        z = case.train.teeth  # type: ignore[attr-defined]
        assert (z.z1, z.z3) == teeth
        u = (1 + z.z3 / z.z1) * 2.5 * 2
        assert case.ledger["train.n.reached"].at(1) == pytest.approx(1440 / u)
        assert case.ledger["train.omega.7"].at(1) == pytest.approx(2 * math.pi * 24 / u)


@pytest.mark.parametrize("name", [file.stem for file in FILES])
def test_the_triangles_measure_as_they_say(name: str) -> None:
    """Lengths on paper are those of the drawing to 0.01 mm, and the angular velocities read off are those of Willis."""
    case = case_of(name)
    arrows = {item.name: item for item in velocity_triangles(case).items if isinstance(item, Arrow) and item.name}
    printed = case.printed

    def shown(id: str) -> float:
        return float(printed.number(id).printed)

    for place in "AB":
        drawn = (arrows[f"{place}{place.lower()}"].end - arrows[f"{place}{place.lower()}"].start).real
        assert drawn == pytest.approx(shown(train_ids.line(place)), abs=0.01)
    step = shown("train.mu.omega") * 0.01
    lines = [item for item in velocity_triangles(case).items if isinstance(item, Line)]
    for wheel in ("1", "2", "H"):
        ray = arrows[f"s{wheel}"].end - arrows[f"s{wheel}"].start
        assert ray.imag == pytest.approx(shown("train.pole"))
        assert ray.real == pytest.approx(shown(train_ids.segment(wheel)), abs=0.01)
        # It has the figures that the drawing gives: half a unit of the last is its rounding.
        read = printed.number(train_ids.read(wheel))
        assert read.half_unit > step / 4
        assert read.printed == pytest.approx(shown(train_ids.omega(wheel)), abs=step + read.half_unit)
        # Each ray is parallel to a line of the triangles.
        along = [(line.end - line.start) / abs(line.end - line.start) for line in lines if line.end != line.start]
        assert min(abs((ray / abs(ray) / one).imag) for one in along) < 1e-9


@pytest.mark.parametrize("language", ["vi", "en"])
def test_a_short_report_has_less(language: str) -> None:
    assignment = api.load(FILES[0], language)  # type: ignore[arg-type]
    full, short = (len(opened(assignment.with_extent(one)).document().blocks) for one in ("full", "short"))  # type: ignore[arg-type]
    assert short < full


@pytest.mark.parametrize("name", [file.stem for file in FILES])
def test_words_page_sheet_and_results(name: str) -> None:
    """No row of a key is without words; the page, the sheet and the results come of it."""
    for language in ("vi", "en"):
        rows = key_of(case_of(name, language)).rows
        assert [row.id for row in rows if not row.what] == []
    case = case_of(name)
    (animation,) = case.animations()
    assert math.isclose(animation.knots[-1], 360)
    (sheet,) = drawing_sheets(case)
    # On the sheet, too, a length is what the scale below it says, whatever that is in the report.
    plan = next(part.scene for part in sheet.parts for item in part.scene.items if getattr(item, "name", "") == "Aa")
    (drawn,) = (item.end - item.start for item in plan.items if getattr(item, "name", "") == "Aa")
    notes = [item.content.parts for item in plan.items if isinstance(item, Label) and isinstance(item.content, Chain)]
    scale = {symbol.base + symbol.sub[:1]: number.value for symbol, number in notes}
    assert drawn.real * scale["μv"] == pytest.approx(MM * case.ledger[train_ids.velocity("A")].at(1), rel=1e-3)
    segments = {item.name: (item.end - item.start).real for item in plan.items if getattr(item, "name", "")[:1] == "s"}
    for wheel in ("1", "2", "H"):
        ω = case.ledger[train_ids.omega(wheel)].at(1)
        assert segments[f"s{wheel}"] * scale["μω"] == pytest.approx(ω, rel=5e-3, abs=1e-9)
    for part in sheet.parts:
        low, high = part.box
        assert low.real >= 0
        assert high.real <= sheet.width
        assert low.imag >= 0
        assert high.imag <= sheet.height
    results = results_of(case)
    assert results["train"]["z"] == [*case.train.teeth]
    assert results["found"] == len(results["sets"]) == len(case.choice.sets)


# --- faults -----------------------------------------------------------------------------------------------

TEXT = "kind: planetary-train\nparameters: {{scheme: {scheme}, u: {u}, k: {k}, m: 3 mm, n_in: 1440 rpm{more}}}\n"
FAULTS = [
    ({"u": 1}, ["train-no-ratio"]),
    ({"u": 7.123}, ["train-ratio"]),
    ({"u": -3}, ["train-ratio"]),
    ({"u": 7, "k": 4}, ["train-neighbours"]),
    ({"u": 7, "k": 3, "more": ", z: {from: 19, to: 120}"}, ["train-assembly"]),
    ({"u": 5, "more": ", z: {from: 10, to: 20}"}, ["train-interference"]),
    ({"u": 5, "more": ", z: {from: 30, to: 20}"}, ["train-limits"]),
    ({"u": 5, "more": ", m2: 2 mm"}, ["train-one-module"]),
    ({"u": 5, "more": ", n_out: 20 rpm"}, ["both-given"]),
    ({"u": 5, "more": ", before: [[20]]"}, ["too-few"]),
    ({"u": 5, "k": 1, "scheme": "triple"}, ["choice", "out-of-range"]),
]


@pytest.mark.parametrize(("changes", "codes"), FAULTS, ids=lambda one: str(one))
def test_what_cannot_be_is_named(changes: dict[str, object], codes: list[str], tmp_path: Path) -> None:
    file = tmp_path / "train.yaml"
    file.write_text(TEXT.format(**{"scheme": "single", "u": 5, "k": 3, "more": "", **changes}), encoding="utf-8")
    for language in ("vi", "en"):
        found = api.check(file, language)  # type: ignore[arg-type]
        assert sorted(problem.code for problem in found) == sorted(codes)
        for problem in found:
            assert problem.location.line > 0


def test_what_mends_a_fault_is_right(tmp_path: Path) -> None:
    """The number of satellites and the tolerance that a hint names are enough."""
    file = tmp_path / "train.yaml"
    file.write_text(TEXT.format(scheme="single", u=7, k=4, more=""), encoding="utf-8")
    (problem,) = api.check(file, "en")
    assert problem.hint == "it works with k = 2, 3"
    file.write_text(TEXT.format(scheme="single", u=7.123, k=3, more=""), encoding="utf-8")
    (problem,) = api.check(file, "en")
    assert problem.hint is not None
    enough = problem.hint.split()[1]
    file.write_text(TEXT.format(scheme="single", u=7.123, k=3, more=f", tolerance: {enough}"), encoding="utf-8")
    assert [one.code for one in api.check(file, "en")] in ([], ["train-assembly"])


@pytest.mark.parametrize("language", ["vi", "en"])
def test_the_file_of_new_is_right(language: str, tmp_path: Path) -> None:
    from reportgen.catalogue import sample

    file = tmp_path / "new.yaml"
    file.write_text(sample("planetary-train", language), encoding="utf-8")  # type: ignore[arg-type]
    assert api.check(file, language) == []  # type: ignore[arg-type]
