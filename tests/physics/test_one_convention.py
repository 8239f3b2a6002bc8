"""One sign a quantity: closed formulas, tables and curves count the same sense as positive, clockwise machines too."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from reportgen import api
from reportgen.cases import MachineCase
from reportgen.document import InlineMath, Table, Value
from reportgen.formula import Symbol
from reportgen.report.context import ReportContext
from tests.lanes import matrix
from tests.report.built import walk

ROOT = Path(__file__).parents[2]
SAMPLES = tuple(
    file.stem
    for file in sorted((ROOT / "assignments").glob("*.yaml"))
    if not re.search("^kind: linkage", file.read_text(encoding="utf-8"), re.MULTILINE)
)
"""Every machine of the samples whose crank may turn either way; a declared linkage gives no closed formulas a name."""
KINDS = (
    "engine-single-III",
    "engine-twin-05",
    "engine-v-01",
    "engine-v-02",
    "four-bar-01",
    "four-bar-02",
    "scotch-yoke-01",
    "shaper-01",
    "slider-crank-02",
    "slotted-lever-01",
    "toggle-press-01",
)
"""Every kind with closed formulas."""
AGREE = 1e-9
"""Of the greatest value: two ways of calculation of some hundred operations each."""


def turning(
    name: str, direction: str, folder: Path, extent: str = "full", change: tuple[str, str] = ("", "")
) -> ReportContext:
    """The report of an assignment whose crank turns in a direction."""
    text = (ROOT / "assignments" / f"{name}.yaml").read_text(encoding="utf-8")
    if "direction:" in text.partition("positions:")[2].partition("}")[0]:
        text = re.sub(r"direction: *\w*clockwise", f"direction: {direction}", text)
    else:
        text = re.sub(r"positions: *\{", f"positions: {{direction: {direction}, ", text)
    text = text.replace(*change).replace("report:\n", f"report:\n  extent: {extent}\n")
    file = folder / f"{name}.yaml"
    file.write_text(text, encoding="utf-8")
    return ReportContext(MachineCase(api.load(file)))


@pytest.fixture(params=matrix(["anticlockwise", "clockwise"], ["clockwise"]))
def direction(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.mark.parametrize("name", KINDS)
def test_formulas_have_the_sign_of_tables_and_curves(name: str, direction: str, tmp_path: Path) -> None:
    report = turning(name, direction, tmp_path)
    machine, motion, values = report.machine, report.analysis.motion, report.case.ledger.families
    assert machine.turn == (1 if direction == "anticlockwise" else -1)
    compared = []
    for plan, formula in machine.closed_formulas.compared:
        what, _, of = plan.partition(".")
        if what in ("omega", "eps"):
            link = motion.links[int(of)]
            # What tables and curves show, anticlockwise.
            expected = link.omega if what == "omega" else link.epsilon
        elif of in report.slider_senses:
            expected = np.real(np.conj(report.slider_senses[of]) * getattr(motion.points[of], what))
        else:
            continue
        given = values[formula].values
        assert np.abs(given - expected[: given.size]).max() <= AGREE * np.abs(expected).max(), formula
        compared.append(formula)
    assert compared


def test_a_piston_counts_its_way_as_its_velocity(tmp_path: Path) -> None:
    """x grows from the top dead centre on towards the crank, and so v = dx/dt is positive on the way there."""
    report = turning("engine-twin-05", "anticlockwise", tmp_path)
    for pin, link in (("B", 3), ("D", 5)):
        x, v = (report.case.ledger[id].values for id in (f"x.{link}", f"f.v.{pin}"))
        # From top to bottom dead centre the way grows; the positions stand evenly, the dead centres among them.
        falling = np.flatnonzero(np.roll(x, -1) > x + 1e-12)
        assert (v[falling] >= -AGREE).all()
        # A slider on the page moves down there.
        assert report.slider_senses[pin] == pytest.approx(-1j)


# --- the same quantity in several tables -------------------------------------------------------------


@pytest.mark.parametrize("name", matrix(SAMPLES, {*KINDS, "lever-six-bar-01"}))
def test_no_symbol_has_two_signs(name: str, direction: str, tmp_path: Path) -> None:
    """Coordinates of a formula are those of the page; of quantities with one letter, only magnitudes may differ."""
    report = turning(name, direction, tmp_path)
    compare_coordinates(report)
    seen: dict[tuple[Symbol, str], list[tuple[str, np.ndarray]]] = {}
    for id, family in report.case.ledger.families.items():
        values = np.atleast_1d(family.values)
        if not np.isrealobj(values) or not (values < 0).any():
            continue
        for other, known in seen.setdefault((family.symbol, family.kind), []):
            size, bound = min(known.size, values.size), AGREE * np.abs(values).max()
            ours, theirs = values[:size], known[:size]
            alike = np.abs(np.abs(ours) - np.abs(theirs)).max() <= bound
            assert not alike or np.abs(ours - theirs).max() <= bound, (id, other)
        seen[family.symbol, family.kind].append((id, values))


def compare_coordinates(report: ReportContext) -> None:
    """x_E of a formula is that of the table of positions: x to the right, y upwards, whichever way the crank turns."""
    points = report.analysis.motion.points
    for id, family in report.case.ledger.families.items():
        axis, point = family.symbol.base, family.symbol.sub
        if family.kind == "length" and axis in ("x", "y") and point in points:
            place = points[point].p
            expected = (place.real if axis == "x" else place.imag)[: family.values.size]
            assert family.values == pytest.approx(expected, abs=AGREE * np.abs(place).max()), id


def test_the_way_of_a_yoke_on_an_upright_guide_has_a_letter_of_its_own(direction: str, tmp_path: Path) -> None:
    compare_coordinates(
        turning("scotch-yoke-01", direction, tmp_path, change=("  r: 50 mm", "  r: 50 mm\n  guide: 90 deg"))
    )


# --- the same quantity in several tables of one report ------------------------------------------------


def columns(report: ReportContext) -> dict[Symbol, list[list[float]]]:
    """The columns of all tables by what is on top of them, where it is one symbol and all cells below are numbers."""
    found: dict[Symbol, list[list[float]]] = {}
    for block in walk(report.case.document().blocks):
        if not isinstance(block, Table):
            continue
        for number, top in enumerate(block.head[0]):
            symbols = [inline.expression for inline in top.inlines if isinstance(inline, InlineMath)]
            cells = [row[number].inlines for row in block.rows if number < len(row)]
            values = [inline.number.value for cell in cells for inline in cell if isinstance(inline, Value)]
            if len(symbols) == 1 and isinstance(symbols[0], Symbol) and len(values) == len(block.rows):
                found.setdefault(symbols[0], []).append(values)
    return found


ROUNDED = 6e-4
"""Half a unit of the last of the three decimals that tables print at least of m, m/s and m/s², and its noise."""


@pytest.mark.parametrize("extent", ["full", "short"])
def test_the_ram_moves_alike_in_all_tables(direction: str, extent: str, tmp_path: Path) -> None:
    """Table of positions (mm), of the ram and of the cutting force (m, m/s, m/s²), all with x to the right."""
    report = turning("shaper-02", direction, tmp_path, extent)
    moved, found = report.analysis.motion.points["E"], columns(report)
    printed = 0
    for letter, course in (("x", moved.p), ("v", moved.v), ("a", moved.a)):
        for values in found.get(Symbol(letter, "E"), []):
            expected = course.real[: report.count] if len(values) > 1 else course.real[[4]]
            mm = 1000 if np.abs(values).max() > 2 * np.abs(expected).max() else 1
            assert values == pytest.approx(mm * expected, abs=mm * ROUNDED), letter
            printed += 1
    assert printed == (5 if extent == "full" else 1)


def test_a_shaper_that_turns_clockwise_is_the_mirrored_one(tmp_path: Path) -> None:
    """What counts to the right changes its sign and so do torques and turning; ways, S and heights stay."""
    heavy = ("  G5:", "  G4: 20 N\n  J4: 0.05 kg m2\n  G2: 9 N\n  G1: 30 N\n  G5:")
    one, other = (turning("shaper-02", way, tmp_path, change=heavy) for way in ("anticlockwise", "clockwise"))
    mirrored = ("f.x.E", "x.0", "f.v.E", "f.a.E", "f.a.Dx", "f.x.S4.v", "f.x.S4.a", "f.omega.3", "f.eps.4", "f.M")
    same = ("f.S", "phi.3", "phi.4", "f.s.E", "f.y.S4.v", "f.y.S4.a", "f.v.r")
    for sign, ids in ((-1, mirrored), (1, same)):
        for id in ids:
            ours, theirs = (report.case.ledger.families[id].values for report in (one, other))
            assert theirs == pytest.approx(sign * ours, abs=AGREE * np.abs(ours).max()), id
    torque = other.analysis.torque
    assert other.case.ledger.families["f.M"].values == pytest.approx(torque, abs=AGREE * np.abs(torque).max())
