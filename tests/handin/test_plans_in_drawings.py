"""Plans found in students' drawings: what is read, nothing under a wrong name, and what is told as wrong."""

from __future__ import annotations

import io
import re
from collections import Counter
from functools import cache
from pathlib import Path

import ezdxf
import numpy as np
import pytest

from reportgen.base.records import replace
from reportgen.case import MachineAnalysis
from reportgen.cases import opened
from reportgen.formula.ledger import follow
from reportgen.handin import FileReading, submission
from reportgen.handin.drawing_file import marked, read, wanted_plans
from reportgen.handin.drawing_reader import DrawnLocation
from reportgen.handin.dxf_corrections import LAYER, RedVector, with_corrections
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Verdict
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import MarkingScheme, key_asked, marking_scheme
from reportgen.sheets import drawing_sheets
from reportgen.sheets.dxf import write_sheet
from tests.handin.drawings import RELEASES, Manner, Truth, at, draw, seen, true_plans
from tests.lanes import matrix, proof
from tests.marking import students

SEED = re.compile(rb"\$HANDSEED\s+5\s+\w+")
MACHINES = ("four-bar-02", "slider-crank-01", "shaper-02", "toggle-press-01")


@cache
def opened_at_all(name: str) -> tuple[MachineAnalysis, MarkingScheme]:
    """A machine that is asked about at all its positions."""
    case = opened(students.assignment(name))
    assert isinstance(case, MachineAnalysis)
    return case, marking_scheme(case)


def read_as(name: str, data: bytes, worlds=()) -> FileReading:
    case, scheme = opened_at_all(name)
    return read(Path("sheet.dxf"), data, scheme.key, wanted_plans(case, scheme.key, worlds))


def drawn(name: str, manner: Manner, seed: int = 1) -> tuple[bytes, Truth]:
    return draw(true_plans(opened_at_all(name)[0]), manner, seed)


def counts(name: str, reading: FileReading, truth: Truth, unit: float = 1.0) -> Counter[str]:
    """How many vectors of the truth were read by their own line, how many by another's, by where they begin and end."""
    _, scheme = opened_at_all(name)
    counted: Counter[str] = Counter()
    for place in seen(truth, truth.lines):
        answer = reading.values.get(place)
        if answer is None or not scheme.key.row(place[0]).positions:
            continue
        start = answer.location.at * unit
        own = [truth.lines[other] for other in truth.alike[place] if other in truth.lines]
        near = any(min(abs(start - a), abs(start - b)) < 1e-3 for a, b in own)
        length = float(answer.text.split()[0])
        counted[
            "right" if near and any(abs(abs(b - a) - length) < 0.01 + 1e-3 * length for a, b in own) else "wrong"
        ] += 1
    return counted


@pytest.mark.parametrize("name", matrix(MACHINES, {"four-bar-02"}))
@pytest.mark.parametrize("letters", matrix((False, True), {False}))
def test_vectors_are_read_and_none_under_a_wrong_name(name: str, letters: bool) -> None:
    """Without letters 95, 95 and 80 % of vectors are to be found; of each plan one sets the scale."""
    manner = Manner(noise=0.3, letters=letters, release="R12" if letters else "R2018")
    data, truth = drawn(name, manner, 7)
    reading = read_as(name, data)
    counted = counts(name, reading, truth)
    assert counted["wrong"] == 0
    judged = {place for place in seen(truth, truth.lines) if place[1] and place[0] in opened_at_all(name)[1].rows}
    assert counted["right"] > 0.6 * len(judged)
    assert not any(answer.location.wrong for answer in reading.values.values())


@pytest.mark.parametrize("name", matrix(MACHINES, {"four-bar-02"}))
def test_right_vectors_are_not_called_wrong(name: str) -> None:
    """At ±0.5 mm in each direction, as far as a drawn point may lie off."""
    data, _ = drawn(name, Manner(noise=0.5, left_out=0.0), 3)
    _, scheme = opened_at_all(name)
    own = submission([read_as(name, data)], "en")
    marking = mark(with_key(scheme, own), own)
    verdicts = Counter(cell.verdict for cell in marking.cells if (cell.id, cell.position) in own.measured)
    assert set(verdicts) == {Verdict.right}
    assert verdicts[Verdict.right] > 50


def with_key(scheme: MarkingScheme, own) -> MarkingScheme:
    return replace(scheme, key=key_asked(Policy(), scheme.key, own)[0])


@pytest.mark.parametrize("name", matrix(MACHINES, {"four-bar-02"}))
def test_wrong_vectors_are_told_and_no_others(name: str) -> None:
    told = planted = 0
    for seed in (1, 2):
        data, truth = drawn(name, Manner(noise=0.3, wrong=0.5), seed)
        reading = read_as(name, data)
        places = {place: answer.location for place, answer in reading.values.items() if answer.location.wrong}
        places |= reading.beside
        for place, where in places.items():
            if place[0].startswith("seg."):
                assert place in truth.wrong
                assert min(abs(where.at - end) for end in truth.wrong[place]) < 1e-3
        told += len({truth.wrong[place] for place in places if place in truth.wrong})
        planted += len(set(truth.wrong.values()))
    assert told >= 0.5 * planted


@proof
def test_plans_of_misread_data_are_found_by_the_own_values() -> None:
    name = "four-bar-02"
    case, _ = opened_at_all(name)
    values = follow(case.ledger, {"l.BC": lambda value, _: value * 1.1})
    own = {id: np.atleast_1d(value) for id, value in values.items()}
    data, truth = draw(true_plans(case, own), Manner(), 1)
    by_key, by_own = read_as(name, data), read_as(name, data, (own,))
    assert counts(name, by_own, truth)["wrong"] == 0
    assert len(by_key.values) < 0.2 * len(by_own.values)
    assert len(by_own.values) > 0.6 * len(seen(truth, truth.lines))


@proof
def test_a_place_that_two_plans_fit_is_unread_unless_its_position_stands_beside_it() -> None:
    """Pins at 180°: half a turn on, both pistons of a twin have changed their parts."""
    name = "engine-twin-05"
    without, with_letters = (read_as(name, drawn(name, Manner(letters=one))[0]) for one in (False, True))
    doubtful = {place for place, fault in without.unread.items() if fault.code == "unread-two-plans"}
    assert not any(id.startswith("seg.v") for id, _ in without.values)
    assert {id for id, _ in doubtful} >= {"seg.v.pb", "seg.a.pb"}
    assert {id for id, _ in with_letters.values} >= {"seg.v.pb", "seg.a.pb"}


@proof
def test_our_own_sheets_are_read() -> None:
    case, scheme = opened_at_all("slider-crank-01")
    kinematics, *_ = drawing_sheets(case, "A1")
    reading = read_as("slider-crank-01", write_sheet(kinematics, "vi"))
    own = submission([reading], "en")
    verdicts = Counter(
        cell.verdict for cell in mark(with_key(scheme, own), own).cells if (cell.id, cell.position) in own.measured
    )
    assert set(verdicts) == {Verdict.right}
    assert verdicts[Verdict.right] > 10


@proof
def test_any_unit_will_do() -> None:
    """A drawing in centimetres that says nothing of it reads as that in millimetres."""
    name = "four-bar-02"
    (mm, _), (cm, _) = (drawn(name, Manner(unit=unit)) for unit in (1.0, 10.0))
    first, second = read_as(name, mm), read_as(name, cm)
    assert first.values.keys() == second.values.keys()
    assert all(second.values[place].value == pytest.approx(answer.value) for place, answer in first.values.items())


def test_a_drawing_without_plans_is_told() -> None:
    document = ezdxf.new("R2010")
    document.modelspace().add_line((0, 0), (10, 10))
    stream = io.StringIO()
    document.write(stream)
    reading = read_as("four-bar-02", stream.getvalue().encode())
    assert [note.code for note in reading.notes] == ["drawing-no-plans"]
    assert not reading.values
    assert not reading.unread


# --- given back


@pytest.mark.parametrize("release", matrix(RELEASES, {"R12", "R2010"}))
@pytest.mark.parametrize("newline", matrix((b"\n", b"\r\n"), {b"\n"}))
def test_the_student_s_own_lines_stay_byte_for_byte(release: str, newline: bytes) -> None:
    """Only what is put in is new, and the number from which the file counts its objects."""
    data = drawn("four-bar-02", Manner(release=release, letters=True))[0].replace(b"\n", newline)
    vectors = [RedVector(0j, 30 + 40j, ("v_B (3): chưa đúng",)), RedVector(5j, None, ("μ",))]
    changed = with_corrections(data, vectors, 1.0)
    old, new = (SEED.sub(b"", text).splitlines() for text in (data, changed))
    left = iter(new)
    assert all(line in left for line in old)
    # The ends of lines are those of any text, as where a file is opened by its name.
    text = io.StringIO(changed.decode(ezdxf.new(release).output_encoding, "surrogateescape"), newline=None)
    document = ezdxf.read(text)
    auditor = document.audit()
    assert not auditor.errors
    assert not auditor.fixes
    red = [entity for entity in document.modelspace() if entity.dxf.layer == LAYER]
    assert Counter(entity.dxftype() for entity in red) == {"LINE": 3, "TEXT": 2}
    assert {entity.dxf.color for entity in red} == {1}
    assert document.layers.get(LAYER).color == 1
    line = next(entity for entity in red if entity.dxftype() == "LINE")
    assert (at(line.dxf.start), at(line.dxf.end)) == (0j, 30 + 40j)


def test_a_wrong_vector_is_red_as_it_should_be() -> None:
    """The right vector from the same start; without answers only a text."""
    name = "slider-crank-01"
    case, scheme = opened_at_all(name)
    data, truth = drawn(name, Manner(wrong=1.0, noise=0.1), 4)
    reading = read_as(name, data)
    own = submission([reading], "en")
    marking = mark(with_key(scheme, own), own)
    wrong = [cell for cell in marking.cells if cell.verdict is Verdict.wrong and cell.id.startswith("seg.")]
    assert wrong
    for show, kinds in ((True, {"LINE", "TEXT"}), (False, {"TEXT"})):
        _, copy = marked(Path("sheet.dxf"), data, reading, marking, Policy(show_answers=show))
        red = [e for e in ezdxf.read(io.StringIO(copy.decode())).modelspace() if e.dxf.layer == LAYER]
        assert {entity.dxftype() for entity in red} == kinds
    lines = [(at(e.dxf.start), at(e.dxf.end)) for e in red if e.dxftype() == "LINE"]
    assert not lines
    for cell in wrong:
        where = reading.values[cell.id, cell.position].location
        assert isinstance(where, DrawnLocation)
        factor = truth.factors[next(p.scale for p in true_plans(case) if cell.id in p.vectors), cell.position]
        # What is right in the drawing is the key's length at the drawing's own scale.
        assert abs(where.right - where.at) == pytest.approx(1e3 * cell.expected * factor, rel=0.01)
