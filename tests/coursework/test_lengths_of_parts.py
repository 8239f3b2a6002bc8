"""A machine whose lengths a synthesis finds: a coursework in which a part comes first and gives the machine data."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from reportgen import catalogue, check
from reportgen.assignment.student_copy import handed_out
from reportgen.base.errors import Location
from reportgen.base.records import replace
from reportgen.base.yaml_source import MappingNode, read_source
from reportgen.cases import open_case
from reportgen.catalogue import load
from reportgen.classes.variants import make_variants
from reportgen.coursework.case import Coursework
from reportgen.document import Section, plain, text_of
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Answer, Marking, Submission, Verdict
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.task_paper import task_of
from reportgen.marking.toleranced_key import Ask, key_of
from reportgen.page.form_fields import FieldGroup, FieldLine, Form
from tests.report import built

SAMPLE = Path(__file__).parents[2] / "assignments" / "coursework" / "four-bar-synthesis.yaml"
MACHINE = """kind: four-bar
variant: 7
positions: {count: 8}
parameters: {AB: find, BC: find, CD: 120 mm, AD: find, n: 120 rpm}
"""
PART = """parts:
  - kind: synthesis
    parameters: {task: crank-rocker, K: 1.3, psi: 42 deg, best: transmission}
    from: {c: {of: CD}}
    gives: {AB: a, BC: b, AD: d}
"""
SLIDER = """kind: slider-crank
variant: 8
positions: {count: 8}
parameters: {r: find, l: find, e: find, n: 300 rpm}
parts:
  - kind: synthesis
    parameters: {task: slider-crank, K: 1.4, H: 50 mm, e: 20 mm, gamma: 30 deg}
    gives: {r: r, l: l, e: e}
"""


@cache
def sample() -> Coursework:
    case = built.case(SAMPLE)
    assert isinstance(case, Coursework)
    return case


def coursework(folder: Path, text: str) -> Coursework:
    path = folder / "work.yaml"
    path.write_text(text, encoding="utf-8")
    case = open_case(path)
    assert isinstance(case, Coursework)
    return case


def faults(folder: Path, text: str) -> list[tuple[str, int, tuple[str | int, ...]]]:
    """The codes of the errors of a file, with their lines and places."""
    path = folder / "work.yaml"
    path.write_text(text, encoding="utf-8")
    return [(one.code, one.location.line, one.where) for one in check(path)]


# --- the lengths ------------------------------------------------------------------------------------


def test_the_machine_has_the_lengths_that_its_part_prints() -> None:
    """The published a 39.526358, b 92.175010, d 116.461850 mm, to the five figures of the part's report."""
    printed = sample().printed
    lengths = {id: float(printed[id].values[0]) for id in ("l.AB", "l.BC", "l.AD", "l.DC")}
    assert lengths == pytest.approx({"l.AB": 39.526e-3, "l.BC": 92.175e-3, "l.AD": 116.46e-3, "l.DC": 0.12}, abs=1e-9)
    assert printed["synthesis.crank.2"].values[0] == pytest.approx(39.526e-3, abs=1e-9)


def test_the_machine_moves_as_its_synthesis_wants() -> None:
    """With lengths of five figures the rocker swings by 42°, at a time ratio of 1.3."""
    ledger = sample().ledger
    assert math.degrees(ledger["swing"].values[0]) == pytest.approx(42, abs=0.005)
    assert ledger["K"].values[0] == pytest.approx(1.3, abs=2e-4)


def test_a_slider_crank_takes_its_offset_too(tmp_path: Path) -> None:
    """The published r 22.159093, l 49.910173 mm, at the given offset of 20 mm."""
    printed = coursework(tmp_path, SLIDER).printed
    lengths = [float(printed[id].values[0]) for id in ("l.AB", "l.BC", "e")]
    assert lengths == pytest.approx([22.159e-3, 49.910e-3, 20e-3], abs=1e-9)


def test_the_part_can_be_in_a_file_beside_it(tmp_path: Path) -> None:
    part = "kind: synthesis\nparameters: {task: crank-rocker, K: 1.3, psi: 42 deg, best: transmission}\n"
    (tmp_path / "lengths.yaml").write_text(part, encoding="utf-8")
    named = "parts:\n  - {file: lengths.yaml, from: {c: {of: CD}}, gives: {AB: a, BC: b, AD: d}}\n"
    case = coursework(tmp_path, MACHINE + named)
    assert case.printed["l.BC"].values[0] == pytest.approx(92.175e-3, abs=1e-9)
    alone = load(tmp_path / "lengths.yaml", whole=tmp_path / "work.yaml")
    assert alone.parameters.c.text == "120 mm"


def test_a_later_part_can_take_a_length_that_an_earlier_one_gives(tmp_path: Path) -> None:
    later = """  - kind: synthesis
    parameters: {task: crank-rocker, K: 1.2, psi: 60 deg, best: transmission}
    from: {c: {of: BC}}
"""
    case = coursework(tmp_path, MACHINE + PART + later)
    assert case.printed["synthesis2.c"].values[0] == pytest.approx(92.175e-3, abs=1e-9)


def test_a_linkage_through_three_points_gives_all_its_lengths(tmp_path: Path) -> None:
    """A link that points away from its angle has the size of its length in the machine."""
    machine = MACHINE.replace("CD: 120 mm", "CD: find").replace("count: 8", "at: [100 deg, 120 deg, 140 deg]")
    part = """parts:
  - kind: synthesis
    parameters:
      {task: three-points, function: ln, x: [1, 2], driver: [90 deg, 150 deg], follower: [30 deg, 90 deg], d: 100 mm}
    gives: {AB: a, BC: b, CD: c, AD: d}
"""
    case = coursework(tmp_path, machine + part)
    lengths = {id: abs(float(case.printed[f"synthesis.{id}"].values[0])) for id in ("points.a", "points.b", "points.c")}
    taken = [float(case.printed[id].values[0]) for id in ("l.AB", "l.BC", "l.DC")]
    assert taken == pytest.approx(list(lengths.values()), abs=1e-12)


# --- papers -----------------------------------------------------------------------------------------


def chapters(case: Coursework) -> list[str]:
    sections = (block for block in case.document().blocks if isinstance(block, Section))
    return [plain(one.title, "vi") for one in sections if one.level == 1 and one.number]


def test_the_synthesis_is_the_first_chapter() -> None:
    first, *rest = chapters(sample())
    assert first == sample().members[0].title
    alone = [block for block in sample().machine.document().blocks if isinstance(block, Section)]
    assert rest == [plain(one.title, "vi") for one in alone if one.level == 1 and one.number]


def test_the_report_gives_each_length_with_its_origin() -> None:
    text = text_of(sample().document())
    assert [line for line in text.splitlines() if line.startswith("l_AB = a")] == ["l_AB = a_syn^′ = 39,526 mm"]
    table = text.partition("Bảng 1")[2].partition("Bảng 2")[0]
    assert "Chiều dài khâu 3 (CD)" in table
    assert "Chiều dài tay quay AB" not in table


def test_the_task_names_the_lengths_without_their_values() -> None:
    key = Ask().on_paper(key_of(sample()))
    text = text_of(task_of(sample(), key))
    assert "lấy theo nghiệm được chọn ở phần “Tổng hợp cơ cấu tay quay – cần lắc”: l_AB, l_BC, l_AD." in text
    assert not re.search(r"39,5|92,1|116,4", text)


def test_the_lengths_are_asked_for_in_the_part_alone() -> None:
    key = key_of(sample())
    assert not any(key.row(id).positions for id in ("l.AB", "l.BC", "l.AD"))
    assert all(key.row(f"synthesis.{name}.2").positions for name in ("crank", "coupler", "frame"))


# --- marks ------------------------------------------------------------------------------------------


def marked(values: Mapping[str, np.ndarray]) -> Marking:
    """The marks of a sheet that has these values (SI) [N] or [1], by the ids of the coursework."""
    scheme = marking_scheme(sample(), Policy(guard=False))
    key = Ask().of(scheme.key)
    answers = {
        (row.id, k): Answer(float(values[row.id][row.at(k)]), "", Location("sheet"))
        for row in key.asked
        for k in row.positions
    }
    return mark(replace(scheme, key=key), Submission(key.id, "sheet", answers, {}))


def printed_units(case: Coursework | None = None) -> dict[str, np.ndarray]:
    return {row.id: row.values for row in key_of(case or sample()).rows}


def carried_forward(folder: Path, coupler: float) -> dict[str, np.ndarray]:
    """The values of a student whose coupler is wrong (mm): the rest of the part, and the machine, follow from it."""
    part = sample().members[0].case
    wrong = {"synthesis.coupler.2": np.array([coupler * 1e-3])}
    scales = {id: family.how.scale for id, family in part.ledger.families.items()}
    own = {id: values / scales[id] for id, values in part.ledger.evaluate(wrong).items()}
    text = SAMPLE.read_text(encoding="utf-8").partition("\nparts:")[0]
    for key, length in {"AB": "39.526 mm", "BC": f"{coupler} mm", "AD": "116.46 mm"}.items():
        text = text.replace(f"{key}: find", f"{key}: {length}")
    (folder / "own.yaml").write_text(text, encoding="utf-8")
    machine = {row.id: row.values for row in key_of(open_case(folder / "own.yaml")).rows}
    return {**printed_units(), **machine, **own}


def test_the_key_itself_is_right() -> None:
    assert {cell.verdict for cell in marked(printed_units()).cells} == {Verdict.right}


def test_a_wrong_length_costs_its_mark_once(tmp_path: Path) -> None:
    """A separate assignment, with the wrong length as a datum, gives the values that the student should get."""
    marking = marked(carried_forward(tmp_path, 88.0))
    wrong = [cell.id for cell in marking.cells if cell.verdict is Verdict.wrong]
    assert wrong == ["synthesis.coupler.2"]
    follow = {marking.key.owner(cell.id) for cell in marking.cells if cell.verdict is Verdict.follows}
    assert follow == {"machine", "synthesis"}


def test_a_machine_with_another_length_than_the_students_own_is_wrong(tmp_path: Path) -> None:
    """The part is right, so a machine that is solved with a coupler of 88 mm does not follow from it."""
    values = carried_forward(tmp_path, 88.0)
    right = {id: row for id, row in printed_units().items() if id.startswith("synthesis.")}
    marking = marked({**values, **right})
    assert not [cell for cell in marking.cells if cell.id.startswith("synthesis.") and cell.verdict is Verdict.wrong]
    first = [cell for cell in marking.first_errors if marking.key.owner(cell.id) == "machine"]
    assert {(cell.mistake, cell.where) for cell in first} == {("wrong-datum", "l.BC")}


# --- a class and its files ----------------------------------------------------------------------------


def test_each_student_of_a_class_has_lengths_from_own_data(tmp_path: Path) -> None:
    """The part of each student is frozen beside the machine, which is solved with its lengths."""
    spec = (MACHINE + PART).replace("variant: 7", "salt: s").replace("K: 1.3", "K: [1.2, 1.3, 1.4]")
    (tmp_path / "spec.yaml").write_text(spec.replace("42 deg", "[40 deg, 42 deg]"), encoding="utf-8")
    (tmp_path / "roster.csv").write_text("id,name\n" + "".join(f"K{n},S\n" for n in range(5)), encoding="utf-8")
    files = make_variants(tmp_path / "spec.yaml", tmp_path / "roster.csv", tmp_path / "out").files
    drawn = set()
    for file in files:
        case = open_case(file.path)
        assert isinstance(case, Coursework)
        given = case.members[0].case.assignment.parameters
        assert math.degrees(case.ledger["swing"].values[0]) == pytest.approx(math.degrees(given.psi.si), abs=0.02)
        assert case.ledger["K"].values[0] == pytest.approx(given.K.si, abs=1e-3)
        drawn.add((given.K.si, given.psi.si))
    assert len(drawn) > 1


def test_a_student_can_check_the_sheet_with_the_data_of_the_task(tmp_path: Path) -> None:
    """The file that comes with a task has the wanted lengths as `find`, and the part with its conditions."""
    (tmp_path / "assignment.yaml").write_bytes(handed_out(SAMPLE).encode())
    case = open_case(tmp_path / "assignment.yaml")
    assert case.printed["l.BC"].values[0] == sample().printed["l.BC"].values[0]
    assert case.assignment.parameters.AB.text == "39.526 mm"
    assert "39.526" not in (tmp_path / "assignment.yaml").read_text(encoding="utf-8")


def test_the_form_shows_what_a_part_gives() -> None:
    top = read_source(SAMPLE).top
    assert isinstance(top, MappingNode)
    (group,) = (one for one in Form(catalogue.kind("four-bar"), "en", top).groups if one.where == ("parts",))
    (part,) = group.entries
    assert isinstance(part, FieldGroup)
    (gives,) = (one for one in part.entries if one.where == ("parts", 0, "gives"))
    assert isinstance(gives, FieldGroup)
    shown = {str(one.where[-1]): one.text for one in gives.entries if isinstance(one, FieldLine)}
    assert shown == {"AB": "a", "BC": "b", "AD": "d"}


# --- faults -----------------------------------------------------------------------------------------


def test_a_length_that_is_not_to_be_found_is_not_given(tmp_path: Path) -> None:
    """Line 4 has the lengths; the part begins on line 6, and gives lengths on line 9."""
    text = (MACHINE + PART).replace("AB: find", "AB: 40 mm")
    assert faults(tmp_path, text) == [("not-to-be-found", 9, ("parts", 0, "gives", "AB"))]
    text = (MACHINE + PART).replace("AB: a", "AE: a").replace("AB: find", "AB: 40 mm")
    assert faults(tmp_path, text) == [("not-of-parts", 9, ("parts", 0, "gives", "AE"))]


def test_a_length_of_two_parts_is_refused_at_the_second(tmp_path: Path) -> None:
    second = PART.removeprefix("parts:\n").replace("gives: {AB: a, BC: b, AD: d}", "gives: {BC: b}")
    assert faults(tmp_path, MACHINE + PART + second) == [("given-by-two-parts", 13, ("parts", 1, "gives", "BC"))]


def test_a_part_cannot_take_the_length_that_it_gives(tmp_path: Path) -> None:
    text = (MACHINE + PART).replace("of: CD", "of: BC")
    assert [(code, line) for code, line, _ in faults(tmp_path, text)] == [("datum-not-yet-found", 8)]


def test_two_parts_cannot_take_from_each_other(tmp_path: Path) -> None:
    first = PART.replace("of: CD", "of: BC").replace("BC: b, ", "")
    second = first.removeprefix("parts:\n").replace("of: BC", "of: AB").replace("AB: a, AD: d", "BC: b")
    codes = [(code, line) for code, line, _ in faults(tmp_path, MACHINE + first + second)]
    assert codes == [("datum-not-yet-found", 8), ("datum-not-yet-found", 12)]


def test_letters_that_a_part_does_not_find_are_listed(tmp_path: Path) -> None:
    path = tmp_path / "work.yaml"
    path.write_text((MACHINE + PART).replace("BC: b", "BC: l"), encoding="utf-8")
    (problem,) = check(path)
    assert (problem.code, problem.location.line, problem.location.column) == ("no-such-length", 9, 24)
    assert "a, b, c, d" in problem.hint


def test_other_kinds_of_parts_give_no_lengths(tmp_path: Path) -> None:
    part = "parts:\n  - kind: structure\n    parameters: {driver: 1, pairs: [[0, 1], [1, 2], [2, 3], [3, 0]]}\n"
    text = f"{MACHINE}{part}    gives: {{AB: a, BC: b, AD: d}}\n"
    assert faults(tmp_path, text) == [("gives-no-length", 8, ("parts", 0, "gives"))]


def test_a_synthesis_without_a_solution_is_the_only_fault(tmp_path: Path) -> None:
    """A rocker cannot swing by 42° with a time ratio of 1.3 and a crank of 90 mm."""
    text = (MACHINE + PART).replace("best: transmission", "a: 90 mm")
    ((code, line, where),) = faults(tmp_path, text)
    assert (code.startswith("synthesis-"), line, where) == (True, 7, ("parts", 0, "parameters", "a"))


def test_a_missing_part_is_the_only_fault(tmp_path: Path) -> None:
    named = "parts:\n  - {file: lengths.yaml, from: {c: {of: CD}}, gives: {AB: a, BC: b, AD: d}}\n"
    assert [(code, line) for code, line, _ in faults(tmp_path, MACHINE + named)] == [("unreadable", 6)]


def test_lengths_that_nobody_gives_are_reported(tmp_path: Path) -> None:
    text = (MACHINE + PART).replace("AB: a, ", "")
    assert [(code, line, where[-1]) for code, line, where in faults(tmp_path, text)] == [
        ("find-without-motion", 4, "AB")
    ]
