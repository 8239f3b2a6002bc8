"""The sentences after a table say what its numbers say: checked against the arrays, and in cases made for it."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from reportgen.document import Block, Paragraph, Table, plain
from reportgen.formula import vocabulary
from reportgen.report import overview, table_remarks
from reportgen.report.context import ReportContext
from tests.lanes import matrix
from tests.report import built

HALF = 0.5000001
"""Half a unit of the last digit, with room for the rounding of binary numbers."""
FILES = pytest.mark.parametrize("path", matrix(built.ALL, built.TYPESET), ids=lambda path: path.stem)


def opened(path: Path) -> ReportContext:
    return ReportContext(built.case(path, built.own_language(path)))


def sizes(report: ReportContext, id: str, count: int) -> np.ndarray:
    """A quantity in the unit it is printed in, without its sign."""
    family = report.ledger[id]
    values = np.broadcast_to(family.values, report.machine.positions)[:count]
    return np.where(np.abs(values) < 1e-9 * family.scale, 0.0, np.abs(values)) / family.how.scale


@FILES
def test_extremes_are_those_of_the_arrays(path: Path) -> None:
    report = opened(path)
    motion = [*table_remarks.slider_rates(report, "v"), *table_remarks.slider_rates(report, "a")]
    motion += [*table_remarks.turning_rates(report, "omega"), *table_remarks.turning_rates(report, "eps")]
    whole = [
        *table_remarks.reaction_ids(report),
        *table_remarks.inertia_forces(report),
        *table_remarks.load_ids(report),
    ]
    for ids, positions in ((motion, report.positions), (whole, report.all_positions)):
        for one in table_remarks.each_peak(report, ids, positions):
            values = sizes(report, one.ids[0], len(positions))
            unit = HALF * 10.0 ** -(one.value.number.decimals or 0) if one.value.number.decimals is not None else 1e-9
            assert one.value.number.value == pytest.approx(np.nanmax(values), abs=unit, rel=1e-9)
            assert all(values[k - 1] == pytest.approx(np.nanmax(values), abs=2 * unit, rel=1e-9) for k in one.places)
            assert one.zeros <= np.sum(values <= unit)
        nothing = set(report.known(ids)) - {
            id for one in table_remarks.peaks(report, ids, positions is not report.positions) for id in one.ids
        }
        assert all(report.is_zero(id, k) for id in nothing for k in positions)


@FILES
def test_the_balancing_torque_has_each_position_once(path: Path) -> None:
    report = opened(path)
    if not report.has_forces:
        pytest.skip("no forces")
    course, motion = table_remarks.balance_course(report), report.analysis.motion
    power = report.analysis.torque * motion.rate
    nothing = np.array([report.is_zero("M.eq", k) for k in report.all_positions])
    for found, chosen in (
        (course.along, (power > 0) & ~nothing),
        (course.against, (power < 0) & ~nothing),
        (course.none, nothing),
    ):
        assert list(found) == [k for k, here in zip(report.all_positions, chosen, strict=True) if here]
        assert numbers(report, table_remarks.labels(report, found)) == [str(report.machine.position(k)) for k in found]


def numbers(report: ReportContext, text: str) -> list[str]:
    """The labels that a list of positions stands for."""
    every = [str(k) for k in report.all_positions]
    found: list[str] = []
    for part in re.split(rf", | {report.words['and']} ", text) if text else ():
        first, _, last = part.partition("–")
        start = every.index(first)
        found += every[start : every.index(last or first) + 1]
    return found


@pytest.mark.parametrize(
    ("positions", "text"),
    [((3,), "3"), ((1, 5), "1 và 5"), ((1, 2, 3), "1–3"), ((2, 4, 6, 7, 8), "2, 4 và 6–8"), ((), "")],
)
def test_positions_are_listed_as_a_reader_does(positions: tuple[int, ...], text: str) -> None:
    assert table_remarks.labels(opened(built.SAMPLE), positions) == text


def test_quantities_that_go_alike_are_named_together() -> None:
    """Both pistons of the twin are half a turn apart and have one greatest speed at the same positions."""
    report = opened(built.SAMPLE)
    (speed,) = table_remarks.peaks(report, table_remarks.slider_rates(report, "v"))
    assert speed.ids == ("v.B", "v.D")
    assert table_remarks.reverses(report, speed)
    tops = table_remarks.greatest(report, table_remarks.reaction_ids(report))
    assert {id for top in tops for id in top.ids} == {"R.14", "R.12"}


def remarks(blocks: tuple[Block, ...]) -> list[str]:
    texts = [plain(block.inlines, "vi") for block in built.walk(blocks) if isinstance(block, Paragraph)]
    return [text for text in texts if text.startswith(("Nhận xét.", "Remarks."))]


def test_every_report_remarks_on_its_main_tables(written: built.Written) -> None:
    report = ReportContext(written.case)
    found = remarks(written.document.blocks)
    wanted = (
        2
        + bool(report.has_forces) * 2
        + bool(table_remarks.inertia_forces(report))
        + ("flywheel" in report.machine.topics)
    )
    wanted += bool(report.has_forces and table_remarks.peaks(report, table_remarks.load_ids(report), True))
    assert len(found) == (0 if report.instants else wanted), "at single instants nothing is a course to remark on"
    assert all(len(text) > len("Nhận xét. ") + 20 for text in found)


def test_each_kind_of_symbol_has_its_meaning(written: built.Written) -> None:
    """What the vocabulary has a letter for is in the list, but for what stands in the table of given data."""
    report = ReportContext(written.case)
    listed = {id for ids in overview.symbol_kinds(report).values() for id in ids}
    own = {"lambda", "theta", "K", "H", "e", "D", "s", "scale"}
    parts = re.compile(r"f\..*|ic\..*|v\.(work|back)|.*\.lone.*|alpha.*|psi.*|q\..*|[AB]\..*|d[AB]\..*|frame\..*")
    missing = [
        id
        for id, family in report.ledger.families.items()
        if vocabulary.row(id).letter and not (family.hidden or family.is_plane or id in listed | own)
        if not parts.fullmatch(id) and id not in report.given_names
    ]
    assert missing == []


def test_a_page_of_results_follows_the_task(written: built.Written) -> None:
    keys = [block.key for block in built.walk(written.document.blocks) if getattr(block, "key", "")]
    order = [keys.index(key) for key in ("fig.scheme", "tab.main.figures", "tab.extremes", "tab.symbols")]
    assert order == sorted(order)
    tables = {block.key: block for block in built.walk(written.document.blocks) if isinstance(block, Table)}
    symbols = [plain(row[1].inlines, written.language) for row in tables["tab.main.figures"].rows]
    report = ReportContext(written.case)
    assert ("J.d" in report.ledger) == any(text.startswith("J_") for text in symbols)
