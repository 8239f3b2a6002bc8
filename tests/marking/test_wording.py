"""Every row of every kind of machine says what it is, in both languages, and two rows never say the same."""

from __future__ import annotations

from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from reportgen.base.template_folders import languages, search_path
from reportgen.base.units import Language
from reportgen.base.words import load_words
from reportgen.case.answer_key import Key
from reportgen.cases import open_case
from reportgen.document import plain
from reportgen.formula import vocabulary
from reportgen.marking.answer_sheet import answer_book
from reportgen.marking.task_paper import answer_tables
from reportgen.marking.toleranced_key import key_of
from tests.lanes import matrix, proof
from tests.marking import students
from tests.report import built

TELLING = ("engine-twin-05", "four-bar-02", "shaper-01", "scotch-yoke-01", "linkage-slide")
"""Groups of all kinds, both languages; the others are for `make proof`."""
FILES = sorted(path.stem for path in Path("assignments").glob("*.yaml"))
DESIGNS = sorted(
    f"{folder}/{path.stem}" for folder in ("cam", "gears") for path in Path("assignments", folder).glob("*")
)
TELLING_DESIGNS = ("cam/roller-01", "cam/shaper-feed", "gears/pair-equal-sliding", "gears/train-motor")
ALL = matrix([*FILES, *DESIGNS], [*TELLING, *TELLING_DESIGNS])


@cache
def key(name: str, language: Language) -> Key:
    path = students.ASSIGNMENTS / f"{name}.yaml"
    return key_of(built.case(path, language)) if "/" not in name else key_of(open_case(path, language))


@pytest.mark.parametrize("name", ALL)
def test_every_row_says_what_it_is(name: str) -> None:
    for language in languages():
        for row in key(name, language).rows:
            assert row.what, row.id
            assert "{" not in row.what, row.id


@pytest.mark.parametrize("name", ALL)
def test_rows_of_one_section_are_told_apart_by_their_words(name: str) -> None:
    """But for the sides of two force plans that stand for one force, which their plan letters tell apart."""
    for language in languages():
        asked = [row for row in key(name, language).asked if not row.id.startswith("seg.")]
        twice = [what for what, count in Counter((row.part, row.what) for row in asked).items() if count > 1]
        assert twice == []


@pytest.mark.parametrize(
    ("name", "id", "en", "vi"),
    [
        ("engine-twin-05", "a.BA.n", "normal acceleration of B about A", "gia tốc pháp tuyến của B đối với A"),
        ("engine-twin-05", "seg.v.pb", "length on the plan of the velocity of B", "đoạn biểu diễn vận tốc của B"),
        (
            "engine-twin-05",
            "seg.v.as2",
            "length on the plan of the velocity of S₂ relative to A",
            "đoạn biểu diễn vận tốc tương đối của S₂ đối với A",
        ),
        ("shaper-01", "a.B3B.k", "Coriolis acceleration of B₃ relative to B₂", "gia tốc Côriôlit của B₃ đối với B₂"),
        (
            "engine-twin-05",
            "dir.R05",
            "direction of the reaction of the frame on link 5",
            "góc chỉ phương chiều của áp lực của giá lên khâu 5",
        ),
        ("engine-twin-05", "P3", "gas force on piston 3", "lực khí thể tác dụng lên pít tông 3"),
        ("linkage-8", "R.76", "reaction of link 7 on link 6", "áp lực của khâu 7 lên khâu 6"),
    ],
)
def test_words_of_the_textbook(name: str, id: str, en: str, vi: str) -> None:
    assert key(name, "en").row(id).what == en
    assert key(name, "vi").row(id).what == vi


def test_the_vector_that_a_length_or_direction_belongs_to() -> None:
    vectors = {
        "seg.v.pb": "v.B",
        "seg.v.ab": "v.BA",
        "seg.a.bb3": "a.B3B",
        "seg.a.n.BA": "a.BA.n",
        "seg.45.R14.n": "R.14.n",
        "seg.1.Rcb": "R.cb",
        "seg.23.Pqt2": "Pqt2",
        "dir.a.S2": "a.S2",
        "dir.R12.n": "R.12.n",
        "h.R21.O1": "R.21",
        "h.G2.p": "G2",
        "M.P3.p": "P3",
        "M.eq": "",
        "v.BA": "",
    }
    assert {id: vocabulary.vector_of(id) for id in vectors} == vectors


def test_paper_has_the_words_beside_the_symbol() -> None:
    texts = [
        [plain(cell.inlines, "vi") for cell in row] for t in answer_tables(key("four-bar-01", "vi")) for row in t.rows
    ]
    assert ["v_B", "Vận tốc của B", "m/s", ""] in texts


@proof
def test_every_phrase_is_that_of_a_quantity_or_a_family() -> None:
    own = (row for head in vocabulary.heads() for row in vocabulary.rows_of(head))
    names = {row.name for row in (*vocabulary.ROWS, *own)}
    ids = {row.id for name in FILES for row in key(name, "en").rows}
    for language in languages():
        keys = load_words(search_path(language))["quantities"]
        for phrase in (name for key in keys for name in key.split(", ")):
            # What is a torque elsewhere is a force where the driver slides.
            name = phrase.removesuffix(":force").removesuffix(".own")
            family = name if name in names else name.rpartition(".")[0]
            assert name in ids or family in names or name in ("link", "frame"), phrase


SAID = [
    ("cam/roller-01", "cam.u", "u = s_0 + s"),
    ("cam/roller-01", "cam.w", "w = s′ − e"),
    ("cam/shaper-feed", "cam.u", "u = l·k·sin(q)"),
    ("cam/shaper-feed", "cam.w", "w = a − l·k·cos(q)"),
    ("gears/pair-equal-sliding", "gears.dy", "Δy = x_Σ − y"),
    ("gears/train-single", "train.N", "N = (z_1 + z_3)/k"),
]


@pytest.mark.parametrize(("name", "id", "formula"), SAID)
def test_what_only_its_formula_defines_is_told_by_it(name: str, id: str, formula: str) -> None:
    """On paper and in the workbook, in both languages; a formula with another sense in the books has either sign."""
    for language, either in (("en", "either sign is right"), ("vi", "lấy dấu nào cũng được")):
        found = key(name, language)
        row = found.row(id)
        assert formula in plain(row.described, language)
        assert row.open_sense == (either in plain(row.described, language)) == (id != "cam.u")
        cells = [cell.value for sheet in answer_book(found).sheets for line in sheet.rows for cell in line]
        assert sum(formula in str(cell) for cell in cells) == 1
        printed = [
            plain(cell.inlines, language) for table in answer_tables(found) for line in table.rows for cell in line
        ]
        assert sum(formula in cell for cell in printed) == 1


def test_no_row_leaves_its_formula_to_be_guessed() -> None:
    """Words that only point to a formula are gone."""
    for name in DESIGNS:
        for row in key(name, "en").rows:
            assert "formula gives" not in plain(row.described, "en")


def test_velocities_of_a_train_name_their_points() -> None:
    for language, words in (
        ("en", ("A, where wheel 1", "B, on the axis")),
        ("vi", ("điểm A, tâm ăn khớp", "điểm B trên")),
    ):
        found = key("gears/train-double", language)
        for id, said in zip(("train.v.A", "train.v.B"), words, strict=True):
            assert said in found.row(id).what
