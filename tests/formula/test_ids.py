"""Every id is made again by its name from what is read of it, and means one family."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from reportgen.cases import open_case
from reportgen.formula import Symbol, ids, vocabulary
from reportgen.formula.ids import Name
from tests.lanes import proof

FILES = sorted(path for folder in ("", "plane-motion") for path in (Path("assignments") / folder).glob("*.yaml"))
OF_DESIGNS = sorted(path for room in ("cam", "gears") for path in (Path("assignments") / room).glob("*.yaml"))
FAMILIES = list(dict.fromkeys(name for name in vars(ids).values() if isinstance(name, Name)))
BEFORE_OTHERS = frozenset({ids.formula, ids.far, ids.unit, ids.rule, ids.rest})
"""These put a word before any other id: all but the first of them are the only ones that read such an id."""
ONES_OF_THEIR_KIND = frozenset(
    {"alpha", "crank.angle", "delta", "drawing", "lambda", "power", "scale", "span", "steps", "swing", "theta"}
    | {"unevenness", "sum.ends", "sum.others", "t.back", "t.turn", "t.work", "omega.of", "J.r", "J.d", "beta", "free"}
    | {"A.det", "A.excess", "A.lower", "A.upper", "P.angle", "rho", "arc", "gamma.far", "gamma.least", "gamma.near"}
    | {"T.I", "T.range", "J.I", "J.rest", "J.share", "mu.J", "mu.A", "even", "K.5", "P.cut"}
)
"""Ids that stand as text in the code."""


@cache
def every_id() -> frozenset[str]:
    return frozenset(id for path in FILES for id in open_case(path).ledger.families)


def readers(id: str) -> list[Name]:
    return [name for name in FAMILIES if name.read(id) is not None]


@proof
def test_every_id_is_made_again_from_what_is_read_of_it() -> None:
    for id in every_id():
        for name in readers(id):
            words = name.read(id)
            assert words is not None
            assert name.of(words) == id
            assert name(*(word for word in words.values() if word)) == id


@proof
def test_every_id_is_that_of_a_family_or_one_of_its_kind() -> None:
    of_works = {id for id in every_id() if id.partition(".")[0] in vocabulary.heads()}
    alone = {id for id in every_id() - of_works if not readers(id)}
    assert {id for id in alone if len(id) > 1} <= ONES_OF_THEIR_KIND
    # What begins with the word of a kind of work has a row of that kind's vocabulary.
    shown = {id for path in FILES for id, family in open_case(path).ledger.families.items() if not family.hidden}
    for id in of_works & shown:
        assert any(row.ids.read(id) is not None for row in vocabulary.rows_of(id.partition(".")[0])), id


@proof
def test_no_two_families_read_the_same_id() -> None:
    for id in every_id():
        several = [name for name in readers(id) if name not in BEFORE_OTHERS]
        assert several in ([], several[:1], [ids.percussion, ids.length]), id


@proof
def test_every_row_of_the_vocabulary_that_reads_an_id_after_the_first_is_a_wider_one() -> None:
    for id in every_id():
        rows = [row for row in vocabulary.ROWS if row.ids.read(id) is not None]
        assert rows in ([], rows[:1]) or [row.ids for row in rows] == [ids.percussion, ids.length], id


@proof
@pytest.mark.parametrize("path", OF_DESIGNS, ids=lambda path: path.stem)
def test_the_ids_of_a_kind_of_work_all_begin_with_its_word_and_one_row_reads_each_first(path: Path) -> None:
    for id, family in open_case(path).ledger.families.items():
        rows = vocabulary.rows_of(id.partition(".")[0])
        assert rows is not vocabulary.ROWS, id
        narrow = [row.ids.text.count("{") for row in rows if id in row.ids]
        assert narrow == sorted(narrow), f"{id}: a wider row stands before a narrower one"
        assert vocabulary.KINDS[family.kind]


def test_the_common_vocabulary_says_nothing_of_a_kind_of_work() -> None:
    heads = vocabulary.heads()
    assert {"cam", "gears", "train"} <= heads.keys()
    assert [row.ids.text for row in vocabulary.ROWS if row.ids.text.partition(".")[0] in heads] == []
    assert vocabulary.row("v.B").letter == "v"
    assert vocabulary.row("cam.r0").kind == "cam length"
    assert vocabulary.symbol("gears.x_min.2") == Symbol("x", "min2")
    with pytest.raises(KeyError):
        vocabulary.KINDS["no such kind"]


@pytest.mark.parametrize(
    ("name", "words", "id"),
    [
        (ids.velocity, ("B",), "v.B"),
        (ids.acceleration, ("BA",), "a.BA"),
        (ids.acceleration, ("BA", "n"), "a.BA.n"),
        (ids.segment, ("v", "p", "s2"), "seg.v.ps2"),
        (ids.reaction, ("1,12", "t"), "R.1,12.t"),
        (ids.applied_force, (3, "a"), "P3a"),
        (ids.given_force, (), "P.given"),
        (ids.share, ("eps", 3, "a.BA.n"), "share.eps.3.a.BA.n"),
    ],
)
def test_a_name_makes_and_reads(name: Name, words: tuple[object, ...], id: str) -> None:
    assert name(*words) == id
    found = name.read(id)
    assert found is not None
    assert [word for word in found.values() if word] == [str(word) for word in words]


def test_a_name_takes_as_many_words_as_it_has_places() -> None:
    for words in ((), ("B", "n", "x")):
        with pytest.raises(KeyError):
            ids.acceleration(*words)


def test_a_narrower_family_reads_less() -> None:
    narrow = ids.segment.only(what="v")
    assert narrow.read("seg.v.pb") == {"start": "p", "end": "b"}
    assert narrow.read("seg.a.pb") is None


def test_the_points_of_a_line() -> None:
    assert ids.points("O1A") == ["O1", "A"]
    assert ids.points("A12B") == ["A12", "B"]


def test_the_links_of_a_joint() -> None:
    for one, other in ((1, 2), (1, 12), (10, 11)):
        assert ids.linked(ids.joint(one, other)) == (str(one), str(other))
    assert ids.of_force("R12.t") == "R.12.t"
    assert ids.of_force("Pqt2") == "Pqt2"
