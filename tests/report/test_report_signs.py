"""Signs: an arrow on a separated link times the size is the true force; no number lacks its line."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reportgen import api
from reportgen.base.template_folders import search_path
from reportgen.base.words import load_words
from reportgen.document import Block, Equation, InlineMath, Paragraph, plain
from reportgen.drawing import Arc, Arrow, Scene
from reportgen.drawing.force_drawings import COUPLE_RADIUS
from reportgen.formula import Chain, Expression, Number, Symbol, VectorEquation, walk
from reportgen.formula.calculation import ZERO
from reportgen.formula.formula_layout import BOUND, MathRow, columns
from reportgen.formula.vocabulary import vector
from reportgen.machine import SlidingDriver
from reportgen.report import force_figures, result_tables
from reportgen.report.context import ReportContext
from reportgen.report.triad_views import TriadView
from tests.derivation.printed import SHARE
from tests.lanes import matrix
from tests.report import built
from tests.report.built import Written
from tests.report.test_rare_groups import SLOTTED, TRANSLATED

RARE = {"slotted": SLOTTED, "translated": TRANSLATED}
FURTHER = 4
"""Positions looked at beside the worked ones."""


@pytest.fixture(
    scope="module",
    params=matrix([*built.ALL, *RARE], [*built.TELLING, built.SLIDE, *RARE]),
    ids=lambda one: getattr(one, "stem", one),
)
def written(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Written:
    """Every file of the repository and the groups that none of them has."""
    path = request.param
    if isinstance(path, Path):
        return built.written(path, built.own_language(path))
    file = tmp_path_factory.mktemp(path) / "linkage.yaml"
    file.write_text(RARE[path].strip() + "\n", encoding="utf-8")
    return built.compose(api.load(file))


@pytest.fixture(scope="module")
def report(written: Written) -> ReportContext:
    """Machines with loads only."""
    found = ReportContext(written.case)
    if not found.has_forces:
        pytest.skip("nothing loads this machine")
    return found


@pytest.fixture(scope="module")
def blocks(report: ReportContext, written: Written) -> list[Block]:
    return list(built.walk(written.document.blocks))


def positions(report: ReportContext) -> list[int]:
    further = range(1, report.cycle_count + 1, max(report.cycle_count // FURTHER, 1))
    return sorted({*map(int, report.worked_forces), *further})


def value(report: ReportContext, name: str, k: int) -> float:
    """The size that the formula or the plan of a reaction gives."""
    ledger, digits = report.ledger, name.removeprefix("R")
    if name == "Rcb":
        return abs(float(ledger["M.eq"].at(k)))
    both = (digits, digits[::-1])
    ids = ledger.known([*(f"R.{one}.s" for one in both), *(f"R.{one}" for one in both)])
    return abs(float(ledger[ids[0]].at(k)))


def true(report: ReportContext, name: str, k: int) -> complex:
    """The force on the link by the equations of equilibrium, which know no plans."""
    analysis = report.analysis
    if name == "Rcb":
        driver = report.machine.linkage.driver
        assert isinstance(driver, SlidingDriver)
        return complex(analysis.torque[k - 1] * np.exp(1j * driver.guide.angle))
    digits = name.removeprefix("R").partition(".")[0]
    reactions = analysis.forces.reactions
    if f"R{digits}" in reactions:
        return complex(reactions[f"R{digits}"].force[k - 1])
    return -complex(reactions[f"R{digits[::-1]}"].force[k - 1])


def off(report: ReportContext, scene: Scene, k: int) -> list[str]:
    """The reactions of a scene whose arrow, times the size, is not their true force along the arrow."""
    wrong = []
    for item in scene.items:
        if isinstance(item, Arrow) and item.name.startswith("R"):
            along = (item.end - item.start) / abs(item.end - item.start)
            force = (true(report, item.name, k) * along.conjugate()).real
            # As far as any computed quantity may lie off for the rounding of what it stands on, or but for dust.
            largest = max(abs(true(report, item.name, j)) for j in range(1, report.cycle_count + 1))
            dust = ZERO * np.nanmax(np.abs(report.analysis.loads[0].force))
            if abs(force - value(report, item.name, k)) > SHARE * largest + dust:
                wrong.append(f"{item.name} at {k}")
    return wrong


def test_an_arrow_times_its_size_is_the_true_force(report: ReportContext) -> None:
    found, seen = [], 0
    for k in positions(report):
        for group in report.groups:
            for scene in force_figures.bodies(report, k, group).scenes:
                found += off(report, scene, k)
                seen += sum(isinstance(item, Arrow) and item.name.startswith("R") for item in scene.items)
    assert found == []
    assert seen > 0


def test_what_balances_the_driver_is_drawn_in_its_true_sense(report: ReportContext) -> None:
    for k in positions(report):
        drawing = force_figures.driver(report, k).scenes[0]
        assert off(report, drawing, k) == []
        if report.machine.span:
            # The balancing force of a slide acts on the lever too.
            assert off(report, force_figures.lever(report, k).scenes[0], k) == []
        arcs = [item for item in drawing.items if isinstance(item, Arc) and item.radius == COUPLE_RADIUS]
        if report.driver.centre and not report.is_zero("M.eq", k) and not report.machine.torques:
            (arc,) = arcs
            assert np.sign(arc.stop - arc.start) * abs(report.ledger["M.eq"].at(k)) == pytest.approx(
                report.analysis.torque[k - 1], abs=SHARE * np.max(np.abs(report.analysis.torque))
            )


def test_what_moments_give_is_positive_with_a_clockwise_moment(report: ReportContext) -> None:
    """As the words beside the figure say: the moment of the true force about the centre of the link's moments."""
    for k in positions(report):
        at = {name: complex(one.p[k - 1]) for name, one in report.analysis.motion.points.items()}
        for group in report.groups:
            if isinstance(group, TriadView):
                sought = [(leg.outer, leg.P, leg.Q, "t") for leg in group.legs]
            else:
                by_rod = [(group.outer, group.P, group.Q), (group.guide, group.T, group.Q)]
                every = [*by_rod, (group.across, group.Q, group.T)]
                sought = [(*one, "ts" if one[0] != group.across else "s") for one in every]
            for digits, pin, centre, parts in sought:
                for part in parts:
                    id = f"R.{digits}.{part}"
                    if id in group.by_moments and not report.is_zero(id, k):
                        force = complex(report.ledger[f"F.R{digits}.{part}"].at(k))
                        moment = ((at[pin] - at[centre]).conjugate() * force).imag
                        assert np.sign(moment) == -np.sign(float(report.ledger[id].at(k)))


@pytest.mark.parametrize("language", ["vi", "en"])
def test_power_is_the_moment_in_the_sense_of_rotation(report: ReportContext, language: Any) -> None:
    """Force times velocity is μ_v times the moment on the lever where both turn one way; the words say which way."""
    words = load_words(search_path(language, report.machine.kind))["lever"]
    said = {"vi": "mômen dương theo chiều {ω}", "en": "moments counted positive in the sense of {ω}"}[language]
    assert all(said in words[how]["power"] for how in ("round", "crank"))
    if not report.driver.centre:
        return
    turn, ω = report.machine.turn, float(report.ledger["omega.1"].values[0])
    for load in report.analysis.loads:
        if f"M.{load.name}.p" in report.ledger:
            for k in positions(report):
                moving = report.analysis.motion.of(load.link, load.point)
                spin = float(report.analysis.motion.links[load.link].omega[k - 1])
                power = (complex(load.force[k - 1]).conjugate() * complex(moving.v[k - 1])).real
                power += float(load.couple[k - 1]) * spin
                moment = float(report.ledger[f"M.{load.name}.p"].at(k))
                scale = float(np.max(np.abs(report.analysis.torque))) * ω
                assert turn * moment * ω == pytest.approx(power, abs=SHARE * scale)


# --- every number has its line


def chains(blocks: list[Block]) -> Iterator[Chain]:
    for block in blocks:
        if isinstance(block, Equation):
            yield from (row for row in block.rows if isinstance(row, Chain))


def test_every_reaction_of_the_table_has_a_worked_line(report: ReportContext, blocks: list[Block]) -> None:
    printed = [chain.parts for chain in chains(blocks) if len(chain.parts) > 1]
    first = {parts[0] for parts in printed}
    symbols = {report.ledger.symbol(id) for id in result_tables.reactions(report)}
    assert symbols <= first
    relations = {parts[0] for parts in printed if len(parts) == 2 and parts[0] != parts[1]}
    carried = {vector(report.force_symbol(edge.name)) for polygon in report.case.polygons for edge in polygon.carried}
    assert carried <= relations


def test_no_segment_is_used_before_it_is_measured(blocks: list[Block]) -> None:
    known: set[Expression] = set()
    for block in blocks:
        if isinstance(block, Paragraph):
            known |= {inline.expression for inline in block.inlines if isinstance(inline, InlineMath)}
        if not isinstance(block, Equation):
            continue
        for row in block.rows:
            if not isinstance(row, Chain):
                continue
            shown, formula = row.parts[0], row.parts[1] if len(row.parts) > 2 else Number(0.0)
            if isinstance(shown, Symbol) and shown.over == "segment":
                used = {node for node in walk(formula) if isinstance(node, Symbol) and node.over == "segment"}
                assert used <= known, (shown, used - known)
            known.add(shown)


def test_inertia_forces_are_named_only_where_links_have_mass(report: ReportContext, blocks: list[Block]) -> None:
    words = {"en": "inertia forces included", "vi": "kể cả lực quán tính"}[report.assignment.language]
    assert any(words in said(block) for block in blocks) == bool(report.inertia_lines)


def said(block: Block) -> str:
    return plain(block.inlines, "en") if isinstance(block, Paragraph) else ""


# --- equations in one piece


def test_no_column_of_a_vector_equation_is_zero_alone(blocks: list[Block]) -> None:
    equations = [
        row for block in blocks if isinstance(block, Equation) for row in block.rows if isinstance(row, VectorEquation)
    ]
    balances = [one for one in equations if one.sides[-1][0].symbol == Symbol("0", over="vector")]
    assert balances
    for balance in balances:
        found = columns(balance)
        # Rows are broken between columns, and every column has a force.
        assert len(found) == len(balance.sides[0])
        assert isinstance(found[-1].term, MathRow)
        assert BOUND in found[-1].term.parts
