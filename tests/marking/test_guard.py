"""What is not the student's own work is told, little is taken for it, and nobody who worked is accused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from reportgen.base.records import replace
from reportgen.base.template_folders import search_path
from reportgen.base.units import Language
from reportgen.base.words import load_words
from reportgen.cases import opened
from reportgen.formula.vocabulary import KeyChapter
from reportgen.marking.authenticity import Classmate
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Submission, Verdict
from reportgen.marking.marking_policy import FLAGS_ONLY, TAKES, Policy
from reportgen.marking.marking_scheme import MarkingScheme
from reportgen.marking.mistakes import Mistake
from tests.lanes import matrix, proof
from tests.marking import hands, students

WORKED = (4, 12)
OTHERS = (
    {"H": "100 mm", "n": "2000 rpm", "D": "95 mm"},
    {"lambda": "1/3.8", "D": "95 mm", "n": "2100 rpm"},
    {"G2": "24 N", "G3": "18 N", "D": "102 mm"},
)
SIZE = 8
"""Members of the class of these tests; `python -m tests.bench.mistakes` marks a class of 40."""


@pytest.fixture(scope="module")
def mine() -> MarkingScheme:
    return students.scheme("engine-twin-05", WORKED)


def other(**parameters: str) -> MarkingScheme:
    return students.marking_scheme(opened(students.assignment("engine-twin-05", WORKED, **parameters)))


@dataclass(frozen=True)
class Room:
    """A class: its assignments and honest sheets without a mistake."""

    schemes: list[MarkingScheme]
    sheets: list[Submission]

    @property
    def classmates(self) -> list[Classmate]:
        return [Classmate(scheme.key, sheet) for scheme, sheet in zip(self.schemes, self.sheets, strict=True)]


@pytest.fixture(scope="module")
def room() -> Room:
    rng = np.random.default_rng(15)
    schemes = hands.variants(SIZE, rng)
    return Room(schemes, [hands.honest(scheme, rng) for scheme in schemes])


# --- the sheet alone ------------------------------------------------------------------------------


@pytest.mark.parametrize("value", [0.0, 1.0, 50.0])
def test_one_number_throughout(mine: MarkingScheme, value: float) -> None:
    marking = mark(mine, students.sheet(mine, lambda row, k, _: value))
    assert marking.points == 0
    assert "stock" in marking.warnings


def test_few_equal_lengths_are_no_stock_answer(mine: MarkingScheme) -> None:
    """Whoever has only drawn the crank and both poles has written 50 four times, rightly."""
    kept = {"seg.v.pa", "seg.a.pa", "seg.v.pc", "seg.a.pc", "drawn.O1C"}
    marking = mark(mine, students.sheet(mine, lambda row, k, value: value if row.id in kept else None))
    assert marking.flags == ()


@pytest.mark.parametrize("parameters", OTHERS)
def test_three_other_data_keep_what_does_not_depend_on_them(mine: MarkingScheme, parameters: dict[str, str]) -> None:
    copied = students.sheet(other(**parameters), lambda row, k, value: students.figures(value))
    marking = mark(mine, copied)
    assert marking.warnings == ("other-data", "taken")
    # What is told of it stands in the order of the sheet, not in one that changes from run to run.
    (places,) = [flag.places for flag in marking.flags if flag.kind == "other-data"]
    order = {row.id: index for index, row in enumerate(mine.judged)}
    assert list(places) == sorted(places, key=lambda place: order[place[0]])
    assert not any(cell.verdict is Verdict.follows and cell.points for cell in marking.cells if cell.position)
    assert all(cell.points == cell.worth for cell in marking.cells if cell.verdict is Verdict.right)


def test_two_data_are_enough_where_the_sheet_is_a_classmates(mine: MarkingScheme) -> None:
    """Two data misread are mistakes, unless both are those of one classmate, and all else on the sheet too."""
    theirs = replace(other(G2="24 N", D="95 mm"), key=replace(other(G2="24 N", D="95 mm").key, id="SV01"))
    copied = students.sheet(theirs, lambda row, k, value: students.figures(value))
    assert mark(mine, copied).flags == ()
    (flag,) = mark(mine, copied, [Classmate(theirs.key)]).flags
    assert (flag.kind, flag.classmate) == ("other-data", "SV01")
    once = students.sheet(other(G2="24 N"), lambda row, k, value: students.figures(value))
    assert mark(mine, once, [Classmate(theirs.key)]).flags == ()


@pytest.mark.parametrize("parameters", matrix(OTHERS, OTHERS[:1]))
def test_the_key_of_another_variant_with_the_own_geometry(mine: MarkingScheme, parameters: dict[str, str]) -> None:
    """What does not follow from the own data earns nothing, nor what follows from that; what is right stays."""
    theirs = replace(other(**parameters), key=replace(other(**parameters).key, id="SV01"))
    foreign = students.sheet(theirs, lambda row, k, value: students.figures(value))
    own = students.sheet(mine, lambda row, k, value: students.figures(value))
    sheet = replace(
        own,
        values={
            place: own.values[place] if not place[1] else foreign.values[place]
            for place in own.values
            if place[1] == 0 or place in foreign.values
        },
    )
    before = mark(mine, sheet)
    marking = mark(mine, sheet, [Classmate(theirs.key)])
    (flag,) = marking.flags
    assert (flag.kind, flag.classmate) == ("classmate-key", "SV01")
    assert len(flag.taken) > 30
    assert marking.points == before.points - len(flag.taken)
    right = [cell for cell in before.cells if cell.verdict is Verdict.right]
    assert marking.points_at({(cell.id, cell.position) for cell in right})[0] == len(right)


@pytest.mark.parametrize(("datum", "typed", "factor"), [("n", "2000 rpm", 2000 / 2200), ("H", "100 mm", 100 / 95)])
def test_who_takes_a_datum_from_the_line_of_a_classmate_has_misread_it(
    mine: MarkingScheme, datum: str, typed: str, factor: float
) -> None:
    """All that follows is in the classmate's key, too: it follows from the one datum, and costs nothing."""
    theirs = replace(other(**{datum: typed}), key=replace(other(**{datum: typed}).key, id="SV01"))
    mistake = Mistake("", datum, {datum: lambda value, _: value * factor})
    marking = mark(mine, students.written(mine, students.worked_out(mine, mistake)), [Classmate(theirs.key)])
    assert not any(flag.taken for flag in marking.flags)
    assert marking.points >= marking.out_of - 2


@proof
@pytest.mark.parametrize("step", matrix([0.1, 0.5], [0.5]))
def test_lengths_read_to_the_same_step_are_no_copies(room: Room, step: float) -> None:
    """A force of 0.2 mm is so on every sheet, and lengths read to half a millimetre often are."""
    scheme = room.schemes[0]
    sheets = [hands.work(scheme, hands.PLACES, blunt=0.3e-3, step=step, seed=seed) for seed in range(6)]
    classmates = [
        Classmate(replace(scheme.key, id=f"SV{number:02}"), sheet) for number, sheet in enumerate(sheets[1:], start=50)
    ]
    assert mark(scheme, sheets[0], classmates).flags == ()


@pytest.mark.parametrize(("datum", "factor"), [("n", 0.9), ("H", 1.1), ("G2", 1.2), ("D", 0.9), ("s", 1.1)])
def test_a_misread_datum_is_one_mistake(mine: MarkingScheme, datum: str, factor: float) -> None:
    mistake = Mistake("", datum, {datum: lambda value, _: value * factor})
    marking = mark(mine, students.written(mine, students.worked_out(mine, mistake)))
    assert marking.flags == ()
    assert marking.points >= marking.out_of - 2


def test_a_value_out_of_proportion_costs_its_own_mark(mine: MarkingScheme) -> None:
    """From a radius of 7.3 m everything follows; whoever worked it out did the work."""
    mistake = Mistake("", "R", {"R": lambda value, _: value * 0 + 7.3})
    marking = mark(mine, students.written(mine, students.worked_out(mine, mistake)))
    assert marking.flags == ()
    assert marking.points >= marking.out_of - 2


def test_constant_row_is_told(mine: MarkingScheme) -> None:
    scheme = students.scheme("engine-twin-05")
    value = float(scheme.key.row("v.B").values[3])
    marking = mark(scheme, students.sheet(scheme, lambda row, k, right: value if row.id == "v.B" else right))
    assert marking.warnings == ("constant",)
    # Wrong where it is wrong, right where it is right.
    assert {cell.verdict for cell in marking.cells if cell.id == "v.B"} == {Verdict.wrong, Verdict.right}


def test_positions_copied_from_another(room: Room) -> None:
    """Positions 4 and 7 written off from position 2: only what is right in spite of it keeps its marks."""
    scheme, sheet = room.schemes[0], room.sheets[0]
    values = {(id, k): sheet.values.get((id, 2 if k else 0), one) for (id, k), one in sheet.values.items()}
    marking = mark(scheme, replace(sheet, values=values))
    copies = [flag for flag in marking.flags if flag.kind == "columns"]
    assert {k for flag in copies for _, k in flag.places} == {4, 7}
    assert not any(cell.verdict is Verdict.follows for cell in marking.cells if cell.position in (4, 7))


def test_random_numbers_earn_next_to_nothing(mine: MarkingScheme) -> None:
    rng = np.random.default_rng(7)
    marking = mark(mine, students.sheet(mine, lambda row, k, value: float(rng.uniform(0, 100))))
    assert marking.points < 0.06 * marking.out_of


# --- a class --------------------------------------------------------------------------------------


@proof
def test_nobody_who_worked_is_flagged(room: Room) -> None:
    """Every member with no mistake and with each of some, beside all the others' sheets: nothing is told."""
    rng = np.random.default_rng(3)
    mistakes = ["", *hands.MISTAKES]
    for number, scheme in enumerate(room.schemes):
        for mistake in (mistakes[number], mistakes[number + SIZE]):
            sheet = hands.honest(scheme, rng, mistake)
            marking = mark(scheme, sheet, room.classmates)
            assert marking.flags == (), (number, mistake)


@pytest.mark.parametrize("mistake", ["n", "R", "F", "G2"])
def test_the_same_mistake_is_no_copy(room: Room, mistake: str) -> None:
    """Two who make one mistake, each in their own data."""
    rng = np.random.default_rng(4)
    sheets = [hands.honest(scheme, rng, mistake) for scheme in room.schemes[:3]]
    classmates = [Classmate(scheme.key, sheet) for scheme, sheet in zip(room.schemes, sheets, strict=False)]
    for scheme, sheet in zip(room.schemes, sheets, strict=False):
        assert mark(scheme, sheet, classmates).flags == ()


COPIES: dict[str, Callable[[MarkingScheme, str, int], bool]] = {
    "reactions": lambda scheme, id, k: scheme.rows[id].part is KeyChapter.forces,
    "loads and forces": lambda scheme, id, k: (
        scheme.rows[id].part in (KeyChapter.loads, KeyChapter.forces, KeyChapter.torque)
    ),
    "a column": lambda scheme, id, k: k == 4,
    "the sheet": lambda scheme, id, k: True,
}


@pytest.mark.parametrize("what", COPIES)
@pytest.mark.parametrize("digits", matrix([0, 3], [3]), ids=["as written", "key in other digits"])
def test_what_is_a_classmates_is_told(room: Room, what: str, digits: int) -> None:
    scheme, sheet, source = room.schemes[1], room.sheets[1], room.schemes[5]
    theirs = students.sheet(source, lambda row, k, value: students.figures(value, 3)) if digits else room.sheets[5]
    copied = hands.with_cells(sheet, theirs, lambda id, k: COPIES[what](scheme, id, k))
    marking = mark(scheme, copied, room.classmates)
    flags = [flag for flag in marking.flags if flag.kind.startswith("classmate")]
    assert {flag.classmate for flag in flags} == {source.key.id}
    assert all(flag.chance < 1e-3 for flag in flags)
    assert {name for cell in marking.cells for name in cell.classmates} == {source.key.id}
    # Of part of a sheet nothing is taken but what only follows from values of another key.
    taken = {place for flag in marking.flags for place in flag.taken}
    if what != "the sheet":
        assert {flag.kind for flag in marking.flags if flag.taken} <= {"classmate-key"}
        assert all((cell.id, cell.position) not in taken or not cell.points for cell in marking.cells)
        assert taken <= {place for place in copied.values if COPIES[what](scheme, *place)}
    else:
        assert taken


def test_the_policy_can_overrule_it(room: Room) -> None:
    scheme, theirs = room.schemes[1], room.sheets[5]
    taken = mark(scheme, theirs, room.classmates)
    overruled = replace(scheme, policy=Policy(overrule={scheme.key.id: "shown at the board"}))
    kept = mark(overruled, theirs, room.classmates)
    assert "taken" in taken.warnings
    assert "taken" not in kept.warnings
    assert {flag.kind for flag in kept.flags} == {flag.kind for flag in taken.flags}
    assert kept.points > taken.points
    silent = replace(scheme, policy=Policy(take=dict.fromkeys(TAKES, False)))
    assert mark(silent, theirs, room.classmates).points == kept.points
    assert mark(replace(scheme, policy=Policy(guard=False)), theirs, room.classmates).flags == ()


@pytest.mark.parametrize("language", ["vi", "en"])
def test_every_flag_has_its_words(language: Language) -> None:
    words = load_words(search_path(language))
    for kind in (*TAKES, *FLAGS_ONLY, "taken"):
        assert words["warnings"][kind]
        assert words["warning_names"][kind]
