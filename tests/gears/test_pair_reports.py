"""Reports of gear pairs: every line and cell recomputes from printed operands, in both languages; sheets and page."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from reportgen import catalogue
from reportgen import document as tree
from reportgen.api import load
from reportgen.cases import open_case, opened
from reportgen.catalogue import sample
from reportgen.drawing import Label, Line, Polyline
from reportgen.formula import Call, Chain, Negative, Number, Sum, Symbol, walk
from reportgen.formula.evaluation import evaluate
from reportgen.gears import gears_ids
from reportgen.gears.pair_case import PairCase
from reportgen.gears.pair_drawings import mesh
from reportgen.marking.toleranced_key import key_of
from reportgen.sheets import drawing_sheets
from tests.lanes import matrix
from tests.report import built

FILES = sorted((Path(__file__).parents[2] / "assignments" / "gears").glob("pair-*.yaml"))
CASES = [(file.stem, language) for file in FILES for language in ("vi", "en")]
TELLING = [("pair-equal-sliding", "vi"), ("pair-centre-distance", "en")]
MM = 1e3


def file_of(name: str) -> Path:
    return next(file for file in FILES if file.stem == name)


def pair_case(name: str, language: str = "en") -> PairCase:
    case = built.case(file_of(name), language)  # type: ignore[arg-type]
    assert isinstance(case, PairCase)
    return case


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
    value = float(evaluate(formula))
    value = math.degrees(value) if result.unit == "°" else value
    # Exact results are free of the dust of floats; ties may fall either way.
    return abs(value - result.printed) <= result.half_unit * (1 + 1e-6) + 1e-9 * max(abs(value), 1)


@pytest.mark.parametrize(("name", "language"), matrix(CASES, TELLING))
def test_every_line_recomputes(name: str, language: str) -> None:
    found = [recomputes(chain) for chain in chains(pair_case(name, language).document().blocks)]
    assert found.count(True) >= 40
    assert False not in found


@pytest.mark.parametrize("name", [file.stem for file in FILES])
def test_every_value_recomputes_and_is_the_pair_s(name: str) -> None:
    """Each quantity from the printed values of what its line names; the unrounded ones are those of the formulas."""
    case = pair_case(name)
    for id, family in case.printed.families.items():
        for k in range(1, len(family.values) + 1) if family.definition is not None else ():
            assert recomputes(case.printed.chain(id, k if len(family.values) > 1 else None)) in (True, None), (id, k)
    pair, ledger = case.gears, case.ledger
    both = ("d", "d_b", "d_w", "d_a", "d_f", "s", "s_a", "alpha_a", "rho_a", "rho_p", "rho_f", "x_min", "x")
    for one in both:
        values = [float(ledger[gears_ids.of_wheel(one, wheel)].values[0]) for wheel in (1, 2)]
        assert values == pytest.approx(list(pair[one]), rel=1e-11, abs=1e-15), one
    for one in ("alpha_w", "a_w", "epsilon", "g"):
        assert float(ledger[f"gears.{one}"].values[0]) == pytest.approx(float(pair[one]), rel=1e-11), one
    λ = ledger["gears.lambda.1"].values[0], ledger["gears.lambda.2"].values[-1]
    assert λ == pytest.approx(tuple(pair.sliding), rel=1e-9)


@pytest.mark.parametrize("name", [file.stem for file in FILES])
def test_tables_print_what_the_lines_say(name: str) -> None:
    """Every number in the table of the pair is the result of a line with the figures of its kind, or given."""
    case = pair_case(name)
    printed = {
        (number.printed, number.unit)
        for id, family in case.printed.families.items()
        for k in range(1, len(family.values) + 1)
        for number in (case.printed.number(id, k), case.printed.result(id, k))
    }
    tables = [block for block in case.document().blocks if isinstance(block, tree.Table)]
    values = [
        one.number
        for table in tables
        for row in table.rows
        for cell in row
        for one in cell.inlines
        if isinstance(one, tree.Value)
    ]
    assert len(values) > 80
    off = [one for one in values if (one.printed, one.unit) not in printed and (-one.printed, one.unit) not in printed]
    assert [one for one in off if one.printed != 0] == []


@pytest.mark.parametrize("name", [file.stem for file in FILES])
def test_a_summary_has_the_figures_of_the_table(name: str) -> None:
    """The lines go on from 26.499821°; who sums up says 26.4998°."""
    (paragraph,) = pair_case(name).summary()
    assert isinstance(paragraph, tree.Paragraph)
    told = [one.number for one in paragraph.inlines if isinstance(one, tree.Value)]
    assert len(told) == 8
    assert all(one.decimals is None or one.decimals <= 4 for one in told), told


@pytest.mark.parametrize("language", ["vi", "en"])
def test_a_short_report_has_less(language: str) -> None:
    assignment = load(file_of("pair-equal-sliding"), language)  # type: ignore[arg-type]
    full, short = (len(opened(assignment.with_extent(one)).document().blocks) for one in ("full", "short"))
    assert short < full


def test_every_row_of_the_key_has_words() -> None:
    for language in ("vi", "en"):
        rows = key_of(pair_case("pair-equal-sliding", language)).rows
        assert [row.id for row in rows if not row.what] == []


@pytest.mark.parametrize("language", ["vi", "en"])
def test_the_new_file_is_in_order(language: str, tmp_path: Path) -> None:
    path = tmp_path / "new.yaml"
    path.write_text(sample("gear-pair", language), encoding="utf-8")  # type: ignore[arg-type]
    assert catalogue.examine(path) == []


# --- sheets and page --------------------------------------------------------------------------------


def test_sheets_have_the_pair_and_each_wheel_in_true_size() -> None:
    """The first sheet's teeth are 30 to 50 mm high; the others have the wheels 1:1, as curves."""
    case = pair_case("pair-centre-distance")
    sheet, *wheels = drawing_sheets(case)
    assert sheet.name == "A2"
    for wheel, made, tip in zip((0, 1), wheels, case.gears["d_a"], strict=True):
        part = next(part for part in made.parts if part.layer == "profile")
        outline = next(item for item in part.scene.items if isinstance(item, Polyline))
        assert outline.smooth
        assert outline.closed
        points = np.array(outline.points)
        middle = (points.real.min() + points.real.max()) / 2 + 1j * (points.imag.min() + points.imag.max()) / 2
        assert 2 * np.abs(points - middle).max() == pytest.approx(tip * MM, rel=2e-2), wheel
    drawn = [item for part in sheet.parts if part.layer == "profile" for item in part.scene.items]
    (μ,) = [item.content.parts[1].printed for item in drawn if isinstance(item, Label) and is_scale(item.content)]
    teeth = [np.array(item.points) for item in drawn if isinstance(item, Polyline) and len(item.points) > 300]
    # Both halves of the line of centres begin at the pitch point.
    starts = [item.start for item in drawn if isinstance(item, Line) and item.start.real == item.end.real]
    pitch_point = max(starts, key=starts.count)
    for points, side, d_w, d_a, d_f in zip(
        teeth, (-1j, 1j), case.gears["d_w"], case.gears["d_a"], case.gears["d_f"], strict=True
    ):
        radii = np.abs(points - pitch_point - side * d_w / 2 * MM / μ)
        # As a ruler measures it: to a tenth of a millimetre of paper.
        assert radii.max() == pytest.approx(d_a / 2 * MM / μ, abs=0.1)
        assert radii.min() == pytest.approx(d_f / 2 * MM / μ, abs=0.1)
        assert 30 <= np.ptp(radii) <= 50


@pytest.mark.parametrize("parameters", ["m: 2 mm, z1: 100, z2: 250", "m: 10 mm, z1: 20, z2: 20, by: x_min"])
def test_large_wheels_stay_on_the_page(parameters: str, tmp_path: Path) -> None:
    path = tmp_path / "pair.yaml"
    path.write_text(f"kind: gear-pair\nparameters: {{{parameters}}}\n", encoding="utf-8")
    case = open_case(path, "en")
    figures = [block for block in case.document().blocks if isinstance(block, tree.Figure)]
    assert len(figures) == 3
    for figure in figures:
        for scene in figure.scenes:
            assert scene.width <= 170
            assert scene.height <= 240
    assert drawing_sheets(case)


def is_scale(content: object) -> bool:
    return isinstance(content, Chain) and isinstance(content.parts[0], Symbol) and content.parts[0].base == "μ"


def test_wheels_turn_in_their_ratio_and_touch_on_the_line_of_action() -> None:
    case = pair_case("pair-centre-distance")
    (animation,) = case.animations()
    assert animation.knots[-1] == 360
    touching = animation.values[1].values.values
    # Over a turn the mean number of pairs is the contact ratio.
    assert touching[:-1].mean() == pytest.approx(float(case.gears["epsilon"]), abs=0.02)


@pytest.mark.parametrize("language", ["vi", "en"])
def test_involutes_are_worked_out_in_radians(language: str) -> None:
    """tan 20° − 0.34906585, which is true on a calculator; tan 20° − 20° is not."""
    printed = pair_case("pair-equal-sliding", language).printed
    for id in ("gears.inv", *(gears_ids.of_wheel("inv_a", wheel) for wheel in (1, 2))):
        *_, numbers, result = printed.chain(id).parts
        assert isinstance(numbers, Sum)
        assert isinstance(result, Number)
        tangent, arc = numbers.terms
        assert isinstance(tangent, Call)
        assert isinstance(arc, Negative)
        assert isinstance(arc.of, Number)
        [angle] = tangent.arguments
        assert isinstance(angle, Number)
        assert (angle.unit, arc.of.unit) == ("°", "")
        assert arc.of.printed == pytest.approx(math.radians(angle.printed), abs=arc.of.half_unit * 1.001)
        by_hand = math.tan(math.radians(angle.printed)) - arc.of.printed
        assert by_hand == pytest.approx(result.printed, abs=result.half_unit * 1.001)


@pytest.mark.parametrize("data", ["z1: 20, z2: 90, shifts: {x1: 0.2, x2: 0.1}", "z1: 13, z2: 36"])
def test_the_mesh_names_what_the_text_names(data: str, tmp_path: Path) -> None:
    """Also the ends of the line of action that lie beyond the drawing: there is the direction in which they are."""
    file = tmp_path / "pair.yaml"
    file.write_text(f"kind: gear-pair\nparameters: {{m: 4 mm, {data}}}\n", encoding="utf-8")
    case = open_case(file, "en")
    assert isinstance(case, PairCase)
    found = {item.content for item in mesh(case).items if isinstance(item, Label)}
    assert {Symbol("N", "1"), Symbol("N", "2"), Symbol("B", "1"), Symbol("B", "2"), Symbol("P")} <= found


@pytest.mark.parametrize("language", ["vi", "en"])
def test_a_unit_stands_with_the_value_and_not_with_the_name(language: str) -> None:
    table = next(
        block
        for block in pair_case("pair-equal-sliding", language).document().blocks
        if isinstance(block, tree.Table) and block.key == "tab.pair"
    )
    rows = [[tree.plain(cell.inlines, "en") for cell in row] for row in table.rows]
    assert any("mm" in value for _, _, *values in rows for value in values)
    assert [name for name, *_ in rows if "mm" in name] == []
