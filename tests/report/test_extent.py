"""A short report: what coursework on paper has and nothing more, within the pages that it may take."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from reportgen import api
from reportgen.assignment.common import Extent
from reportgen.base.template_folders import templates
from reportgen.cases import MachineCase, open_case, opened
from reportgen.classes.variants import make_variants
from reportgen.cli import app
from reportgen.document import Contents, Document, Figure, Plate, Section, Table, Text, plain
from reportgen.document.layout import contents
from reportgen.document.numbering import unreferenced
from reportgen.marking.task_paper import task_of
from reportgen.marking.toleranced_key import key_of
from reportgen.report.context import ReportContext
from reportgen.report.report_extents import LEFT_OUT
from reportgen.sheets import drawing_sheets, plates_by_set
from tests.lanes import matrix
from tests.report import built
from tests.report.built import FILES, MARKS, ROOT, SAMPLE, TYPESET

pymupdf = pytest.importorskip("pymupdf")

NAMES = [path.stem for path in FILES]
TELLING = ["engine-twin-05", "shaper-01", "slotted-lever-01", "linkage-slide"]
"""A book's engine, curves that are asked for, motion alone, a sliding driver."""
ENGINE, OTHER = 25, 20
"""Pages that a short report may take."""


def case(name: str, extent: Extent) -> MachineCase:
    made = built.case(ROOT / "assignments" / f"{name}.yaml", extent=extent)
    assert isinstance(made, MachineCase)
    return made


def document(name: str, extent: Extent) -> Document:
    return built.document(ROOT / "assignments" / f"{name}.yaml", extent=extent)


def keys(name: str, extent: Extent) -> list[str]:
    """Of figures and tables, in order."""
    return [block.key for block in document(name, extent).blocks if isinstance(block, (Figure, Plate, Table))]


# --- what it has ----------------------------------------------------------------------------------


FORCES = ["cycle", "loads", "groups", "crank"]


def test_the_sections_of_the_published_sample() -> None:
    """In its order: contents, foreword, task, structure, motion, synthesis, three plans, forces, balancing torque."""
    kinematics = ["given", "scheme", "structure", "motion", "synthesis", "positions", "velocity", "acceleration"]
    short = ["contents", "foreword", *kinematics, *FORCES, "conclusion", "references"]
    assert ReportContext(case("engine-twin-05", "short")).sections == short


def test_the_sections_of_a_full_report() -> None:
    opening = ["contents", "given", "scheme", "overview", "foreword", "symbols", "structure", "motion"]
    kinematics = ["synthesis", "positions", "velocity", "centres", "acceleration", "diagrams"]
    full = [*opening, *kinematics, *FORCES, "conclusion", "references", "checks"]
    assert ReportContext(case("engine-twin-05", "full")).sections == full


def test_a_short_report_of_other_kinds() -> None:
    """The shaper's task asks for curves, the toggle press has a flywheel, the lever of a book no forces."""
    kinematics = ["positions", "velocity", "acceleration"]
    beginning = ["contents", "given", "scheme", "structure", "motion"]
    end = ["conclusion", "references"]
    forces = ["working", "loads", "groups", "crank"]
    assert ReportContext(case("shaper-02", "short")).sections == [
        *beginning, "synthesis", *kinematics, "diagrams", "functions", *forces, *end,
    ]  # fmt: skip
    assert ReportContext(case("toggle-press-01", "short")).sections == [
        *beginning, "dimensions", *kinematics, *forces, "flywheel", *end,
    ]  # fmt: skip
    assert ReportContext(case("slotted-lever-01", "short")).sections == [*beginning, "dimensions", *kinematics, *end]
    # The source of the six-link lever mechanism has the table of all velocities and accelerations.
    assert ReportContext(case("lever-six-bar-01", "short")).sections == [
        *beginning, "dimensions", *kinematics, "summary", *forces, *end,
    ]  # fmt: skip
    assert "tab.summary.2" in keys("lever-six-bar-01", "short")
    assert [key for key in keys("shaper-02", "short") if key.startswith("fig.coriolis")] == []


@pytest.mark.parametrize("name", matrix(NAMES, TELLING))
def test_its_figures_and_tables(name: str) -> None:
    """None of stages, of plans at all positions, of centres, symbols and checks; each is referred to."""
    left_out = {"tab.symbols", "tab.checks", "tab.extremes", "tab.main.figures", "fig.line-styles", "fig.polar"}
    short = keys(name, "short")
    assert left_out.isdisjoint(short)
    assert [key for key in short if set(key.split(".")) & {"stages", "plates", "segments", "centres"}] == []
    assert set(short) <= set(keys(name, "full"))
    # What a table goes on with has a key and no mention of its own, in a full report as well.
    assert set(unreferenced(document(name, "short"))) <= set(unreferenced(document(name, "full")))


def test_plans_of_the_worked_position_and_tables_of_all() -> None:
    short = keys("engine-twin-05", "short")
    assert [key for key in short if key.startswith("fig.v")] == ["fig.v.4"]
    assert [key for key in short if key.startswith("fig.R")] == ["fig.R.45.4", "fig.R.23.4"]
    assert {"tab.v", "tab.a", "tab.M", "tab.lever.4", "fig.M", "fig.lever.4", "fig.crank.4"} <= set(short)
    rows = {
        block.key: len(block.rows) for block in document("engine-twin-05", "short").blocks if isinstance(block, Table)
    }
    assert (rows["tab.v"], rows["tab.gas"], rows["tab.M"]) == (8, 1, 16)


def test_every_name_that_is_left_out_is_of_a_section() -> None:
    """But what is not said in words: columns and rows of tables, the look."""
    named = "\n".join(path.read_text(encoding="utf-8") for path in (templates() / "en").rglob("*.md"))
    nameless = {"coriolis-turn", "relative", "loads-everywhere", "usual-type", "contents-page"}
    nameless |= {"true-size", "links-together", "mechanism-beside-forces", "high-curves", "friction-plans"}
    sections = (name.rpartition("/")[2] for name in LEFT_OUT["short"] - nameless)
    assert [name for name in sections if f"%% {name}\n" not in named] == []


def test_its_contents_and_its_look() -> None:
    full, short = (document("engine-twin-05", extent) for extent in ("full", "short"))
    assert [one.brief for one in full.blocks if isinstance(one, Contents)] == [False]
    assert [one.brief for one in short.blocks if isinstance(one, Contents)] == [True]
    assert (full.close, short.close) == (False, True)


@pytest.mark.parametrize(("entries", "alone"), [(26, False), (38, True), (50, True), (53, False), (73, False)])
def test_contents_leave_no_page_half_white(entries: int, alone: bool) -> None:
    """About fifty lines fill a page; where few are left for the last one, what follows goes on below them."""
    assert contents("", [Section(1, (Text("–"),))] * entries, False, "vi").alone == alone


# --- how long it is -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "engine"),
    matrix(
        [
            pytest.param(path.stem, engine, marks=MARKS[engine])
            for path in FILES
            for engine in (("typst", "latex") if path in TYPESET else ("typst",))
        ],
        [("engine-twin-05", "typst")],
    ),
)
def test_its_pages(name: str, engine: api.Engine) -> None:
    """At most 25 for an engine, 20 for other machines, one more for a plan on its own sheet, four for true motion.

    What the file asks of its motion stays in a short report: start, stop, forces, the equation of motion.
    """
    pdf = api.typeset(document(name, "short"), engine)[1]
    with pymupdf.open(stream=pdf) as pages:
        sheets = sum(isinstance(block, Plate) for block in document(name, "short").blocks)
        moves = 4 * ("true-motion" in ReportContext(case(name, "short")).sections)
        assert len(pages) <= (ENGINE if name.startswith("engine") else OTHER) + min(sheets, 1) + moves


# --- what does not depend on it -------------------------------------------------------------------


@pytest.mark.parametrize("name", matrix([path.stem for path in TYPESET], ["shaper-01"]))
def test_key_and_answer_sheet_are_the_same(name: str, tmp_path: Path) -> None:
    path = ROOT / "assignments" / f"{name}.yaml"
    made = []
    for extent in ("full", "short"):
        file = tmp_path / extent / path.name
        file.parent.mkdir()
        content = path.read_text(encoding="utf-8").replace("report:\n", f"report:\n  extent: {extent}\n", 1)
        if "extent" not in content:
            content = content.replace("report: {", f"report: {{extent: {extent}, ", 1)
        file.write_text(content, encoding="utf-8")
        assert api.load(file).report.extent == extent
        key = api.key_files(file, "typst", None, ("xlsx", "csv", "json"))
        made.append({**key, "answers": api.task_files(file, "typst", None)["answers.xlsx"]})
    assert made[0] == made[1]


def test_the_task_says_which_extent_is_asked() -> None:
    sentences = []
    for extent in ("full", "short"):
        one = case("shaper-01", extent)
        words = one.words["extents"][extent]
        task = task_of(one, key_of(one))
        sentences.append(words)
        assert any(words in plain(getattr(block, "inlines", ()), "vi") for block in task.blocks)
    assert sentences[0] != sentences[1]


def test_an_exercise_has_one_extent(tmp_path: Path) -> None:
    content = (ROOT / "assignments" / "plane-motion" / "01.yaml").read_text(encoding="utf-8")
    made = []
    for extent in ("full", "short"):
        file = tmp_path / extent / "01.yaml"
        file.parent.mkdir()
        file.write_text(f"{content}\nreport: {{extent: {extent}}}\n", encoding="utf-8")
        loaded = api.load(file)
        assert loaded.report.extent == extent
        made.append(opened(loaded).document())
    assert made[0] == made[1]


# --- how it is asked for --------------------------------------------------------------------------


def test_build_takes_an_extent(tmp_path: Path) -> None:
    arguments = ["build", str(SAMPLE), "--extent", "short", "--format", "html", "--out", str(tmp_path)]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    page = (tmp_path / SAMPLE.stem / "report.html").read_text(encoding="utf-8")
    titles = [plain(one.title, "vi") for one in document(SAMPLE.stem, "short").blocks if isinstance(one, Section)]
    assert all(title in page for title in titles[:6])
    assert "fig.v.stages" not in page


def test_a_spec_gives_the_extent_of_a_class(tmp_path: Path) -> None:
    demo = ROOT / "assignments" / "class-demo"
    spec = tmp_path / "spec.yaml"
    content = (demo / "spec.yaml").read_text(encoding="utf-8")
    spec.write_text(content.replace("report:\n", "report:\n  extent: short\n", 1), encoding="utf-8")
    make_variants(spec, demo / "roster.csv", tmp_path / "out", False, None)
    drawn = sorted((tmp_path / "out").glob("*.yaml"))
    assert drawn
    assert {open_case(path).assignment.report.extent for path in drawn} == {"short"}


def test_sheets_show_what_the_report_has() -> None:
    """Plans of the worked position alone, no curves of the motion; the curve of the balancing torque."""
    full, short = (plates_by_set(case("engine-twin-05", extent)) for extent in ("full", "short"))
    titles = [{plate.title for some in plates.values() for plate in some} for plates in (full, short)]
    names = case("engine-twin-05", "short").words["plates"]
    assert titles[0] - titles[1] == {names[one] for one in ("velocity-plates", "acceleration-plates", "motion")}
    assert names["torque"] in titles[1]
    assert drawing_sheets(case("engine-twin-05", "short"), "A1")
