"""Draws: the same everywhere, nobody shares while the space allows it, only usable variants."""

from __future__ import annotations

import hashlib
import re
from collections import Counter
from pathlib import Path

import pytest

from reportgen.base.errors import AssignmentError, Fault
from reportgen.base.yaml_source import plain, read_text
from reportgen.classes.variant_draw import FindFaults, fault_finder, pick
from reportgen.classes.variant_spec import Settings, Spec, read_spec
from reportgen.classes.variants import Effort, compare, make_variants
from reportgen.workbook import Book, WorksheetData, write_xlsx
from tests.classes.specs import BARS, ROOT, Put, classes, draw, ids, located
from tests.lanes import matrix

PINNED = 993029
_judged: dict[tuple[object, ...], tuple[Fault, ...]] = {}


def judge_of_bars(spec: Spec) -> FindFaults:
    """The judge of `BARS`, who remembers what was found of a variant in an earlier draw."""
    judge = fault_finder(spec)

    def ask(settings: Settings) -> tuple[Fault, ...]:
        key = tuple((where, plain(node)) for where, node in sorted(settings.items()))
        if key not in _judged:
            _judged[key] = judge(settings)
        return _judged[key]

    return ask


def test_a_draw_is_the_sha256_of_the_text_that_is_documented() -> None:
    """By hand; and one number that must stay for ever: `printf … | sha256sum` gives it too."""
    text = b"reportgen-draw/1\0spec\0" + b"2011\0K195520103001\0parameters.AB\x000"
    assert pick("spec", "2011", "K195520103001", "parameters.AB", 0, 7) == int(hashlib.sha256(text).hexdigest(), 16) % 7
    assert pick("spec", "2011", "K195520103001", "parameters.AB", 0, 10**6) == PINNED
    # Đ is one character, ệ composed or decomposed is the same id.
    assert pick("s", "", "Đie\u0323\u0302n", "p", 3, 10**9) == pick("s", "", "Điện", "p", 3, 10**9)


def test_a_student_more_changes_nobody(put_file: Put) -> None:
    spec = read_spec(put_file(BARS))
    judge = judge_of_bars(spec)
    full = draw(spec, classes(*ids(60)), judge).drawn
    for count in (1, 7, 30, 59):
        assert draw(spec, classes(*ids(count)), judge).drawn == full[:count]


def test_who_leaves_moves_only_whom_he_clashed_with(put_file: Put) -> None:
    spec = read_spec(put_file(BARS))
    judge = judge_of_bars(spec)
    full = {one.student.id: one.combination for one in draw(spec, classes(*ids(20)), judge).drawn}
    less = {one.student.id: one.combination for one in draw(spec, classes(*ids(20)[1:]), judge).drawn}
    assert all(less[id] in (full[id], full["K000"]) for id in less)


def test_nobody_shares_while_the_space_allows_it(put_file: Put) -> None:
    """112 combinations, all of which turn: 112 students have them all, 250 have each twice or three times."""
    spec = read_spec(put_file(BARS))
    judge = judge_of_bars(spec)
    whole = draw(spec, classes(*ids(112)), judge)
    assert len({one.combination for one in whole.drawn}) == 112
    assert whole.usable is None
    crowd = draw(spec, classes(*ids(250)), judge)
    assert set(Counter(one.combination for one in crowd.drawn).values()) == {2, 3}
    assert crowd.usable == 112


def test_combinations_that_do_not_turn_are_not_drawn(put_file: Put) -> None:
    """Grashof: with AD = 400, CD = 280 a crank of 150 … 250 mm turns against BC = 340 only up to 220 mm."""
    text = BARS.replace("{from: 100 mm, to: 130 mm, step: 5 mm}", "{from: 150 mm, to: 250 mm, step: 10 mm}")
    text = text.replace("[340 mm, 350 mm]", "340 mm").replace("[opposing, clockwise]", "opposing")
    text = text.replace("{from: 0.1 mm, to: 0.4 mm, step: 0.1 mm}", "0.1 mm")
    spec = read_spec(put_file(text))
    result = draw(spec, classes(*ids(14)), fault_finder(spec))
    cranks = Counter(one.settings["parameters", "AB"].text for one in result.drawn)
    # s + l < p + q: AB + 400 < 340 + 280.
    assert cranks == {f"{length} mm": 2 for length in range(150, 220, 10)}
    assert result.usable == 7


def test_a_spec_that_never_turns_is_a_fault_with_its_reasons(put_file: Put) -> None:
    text = BARS.replace("{from: 100 mm, to: 130 mm, step: 5 mm}", "[500 mm, 600 mm]")
    path = put_file(text)
    roster = put_file("id\nK1\n", "r.csv")
    with pytest.raises(AssignmentError) as caught:
        make_variants(path, roster, path.parent / "out")
    codes = [line.split()[-1] for line in located(caught.value, path)]
    assert "no-variant" in codes
    assert len(codes) > 1
    assert not (path.parent / "out").exists()


FILES = sorted((ROOT / "assignments").glob("*.yaml"))


@pytest.mark.parametrize("file", matrix(FILES, FILES[::5]), ids=lambda file: file.stem)
def test_every_assignment_is_a_usable_spec_of_one_variant(file: Path) -> None:
    """Nothing in it is taken for a choice, and what the reports are made from is not called unusable."""
    spec = read_spec(file)
    assert (spec.axes, spec.size) == ((), 1)
    assert fault_finder(spec)({}) == ()


def test_the_eight_published_engines_go_round_a_class(put_file: Put) -> None:
    """A table of their parameters: 8 students have all eight, 20 have each two or three times."""
    sources = sorted((ROOT / "assignments").glob("engine-single-[IV]*.yaml"))
    tops = [plain(read_text(source.read_text(encoding="utf-8")).top) for source in sources]
    flat = [{key: value for key, value in top["parameters"].items() if isinstance(value, str)} for top in tops]
    keys = list(dict.fromkeys(key for one in flat for key in one))
    rows = [[top["variant"], *(one.get(key) for key in keys)] for top, one in zip(tops, flat, strict=True)]
    put_file(write_xlsx(Book((WorksheetData("T", (("variant", *keys), *rows)),))), "table.xlsx")
    text = sources[0].read_text(encoding="utf-8")
    text = re.sub(r"(?s)\nparameters:.*?\n\n", "\nvariants: table.xlsx\n\n", text)
    assert "parameters:" not in text
    text += "parameters: {flywheel: {delta: 1/100}}\n"
    spec = read_spec(put_file(text))
    judge = fault_finder(spec)
    assert sorted(spec.label(one.combination) for one in draw(spec, classes(*ids(8)), judge).drawn) == sorted(
        top["variant"] for top in tops
    )
    assert set(Counter(one.combination for one in draw(spec, classes(*ids(20)), judge).drawn).values()) == {2, 3}


def test_what_is_out_of_proportion() -> None:
    """Twice the work and a torque ten times the others' are out of proportion; 1 % more is not."""
    usual = [Effort(600, 100.0 + k, 30.0, 0.5, 10) for k in range(8)]
    odd = [Effort(1300, 104.0, 30.3, 0.5, 10), Effort(600, 1000.0, 30.0, 0.5, 10)]
    outliers = {spread.name: spread.outliers for spread in compare([*usual, *odd])}
    assert outliers == {"worked": (8,), "largest": (9,), "speed": (), "positive": (), "zeros": ()}
    # A value that half of the class has is not an outlier, however narrow the class is.
    halves = compare([Effort(749, 190.0, 30.0, share, 126) for share in (0.5, 0.75) for _ in range(30)])
    assert [spread.outliers for spread in halves] == [()] * 5
    assert [spread.name for spread in compare([Effort(5, None, 1.0, None, 0)])] == ["worked", "speed", "zeros"]
