"""Specs, draws and frozen files: finite choices, the same draw everywhere, nobody's data in another's file."""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reportgen import api
from reportgen.assignment.source import List, Scalar, Table, plain, read_text
from reportgen.batch.alike import Effort, compare
from reportgen.batch.draw import draw, pick
from reportgen.batch.nodes import put
from reportgen.batch.roster import Roster, Student, read_roster
from reportgen.batch.spec import Spec, read_spec
from reportgen.batch.trial import trial
from reportgen.batch.variants import Variants, make_variants
from reportgen.batch.written import quoted, text_of
from reportgen.cli import app
from reportgen.errors import AssignmentError, Mark
from reportgen.workbook import Book, Sheet, read, write_csv, write_xlsx

ROOT = Path(__file__).parent.parent.parent
DEMO = ROOT / "assignments" / "class-demo"
BARS = """\
kind: four-bar
salt: "2011"
report: {language: en}
parameters:
  AB: {from: 100 mm, to: 130 mm, step: 5 mm}   # the crank
  BC: [340 mm, 350 mm]
  CD: 280 mm
  AD: 400 mm
  omega1: 20 rad/s
  E:
    along: {from: 0.1 mm, to: 0.4 mm, step: 0.1 mm}
    across: 110 mm
  torque: {M: 40 N m, sense: [opposing, clockwise]}
"""
Put = Callable[..., Path]


@pytest.fixture
def put_file(tmp_path: Path) -> Put:
    def write(content: str | bytes, name: str = "spec.yaml") -> Path:
        path = tmp_path / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write


def classes(*ids: str) -> Roster:
    return Roster(tuple(Student(id, "", "", "", "", {}, Mark("r", k)) for k, id in enumerate(ids, start=2)))


def ids(count: int) -> tuple[str, ...]:
    return tuple(f"K{number:03}" for number in range(count))


def choices(spec: Spec) -> dict[str, list[str]]:
    return {axis.name: [choice.text for choice in axis.choices] for axis in spec.axes}


def told(path: Path) -> list[str]:
    with pytest.raises(AssignmentError) as caught:
        read_spec(path, "en")
    return located(caught.value, path)


def located(error: AssignmentError, path: Path) -> list[str]:
    lines = [str(problem).splitlines()[0].replace(str(path), "FILE") for problem in error.problems]
    return [re.sub(r": error\[(.*?)\].*", r" \1", line) for line in lines]


# --- specs ------------------------------------------------------------------------------------------


def test_lists_and_ranges_become_choices_as_typed(put_file: Put) -> None:
    spec = read_spec(put_file(BARS))
    assert choices(spec) == {
        "parameters.AB": ["100 mm", "105 mm", "110 mm", "115 mm", "120 mm", "125 mm", "130 mm"],
        "parameters.BC": ["340 mm", "350 mm"],
        "parameters.E.along": ["0.1 mm", "0.2 mm", "0.3 mm", "0.4 mm"],
        "parameters.torque.sense": ["opposing", "clockwise"],
    }
    assert spec.size == 7 * 2 * 4 * 2
    assert len({spec.combination(number) for number in range(spec.size)}) == spec.size
    assert all(spec.number(spec.combination(number)) == number for number in range(spec.size))


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("{from: 0.9 m, to: 930 mm, step: 1 cm}", ["0.9 m", "0.91 m", "0.92 m", "0.93 m"]),
        ("{from: 1e3 mm, to: 1002 mm, step: 1 mm}", ["1000 mm", "1001 mm", "1002 mm"]),
        ("{from: 100 mm, to: 100 mm, step: 5 mm}", ["100 mm"]),
        ("{from: 100 mm, to: 109 mm, step: 5 mm}", ["100 mm", "105 mm"]),
        ("{from: 100.50mm, to: 101 mm, step: 0.25 mm}", ["100.5 mm", "100.75 mm", "101 mm"]),
    ],
)
def test_a_range_steps_in_decimal_numbers(put_file: Put, text: str, values: list[str]) -> None:
    spec = read_spec(put_file(BARS.replace("CD: 280 mm", f"CD: {text}")))
    assert choices(spec)["parameters.CD"] == values


def test_three_steps_of_a_tenth_are_three_tenths(put_file: Put) -> None:
    """In binary numbers 0.1 + 0.1 + 0.1 is 0.30000000000000004 and the last step of 1.1 … 1.4 is lost."""
    for text, values in {
        "{from: 0.1, to: 0.3, step: 0.1}": ["0.1", "0.2", "0.3"],
        "{from: 0.7, to: 1, step: 0.1}": ["0.7", "0.8", "0.9", "1"],
    }.items():
        spec = read_spec(put_file(BARS.replace("  CD:", f"  s2: {text}\n  G2: 20 N\n  CD:")))
        assert choices(spec)["parameters.s2"] == values


def test_what_a_machine_wants_as_a_list_stays_one(put_file: Put) -> None:
    text = (ROOT / "assignments" / "linkage-8.yaml").read_text(encoding="utf-8")
    assert read_spec(put_file(text)).axes == ()
    changed = re.sub(r"length: ([0-9.]+) mm", r"length: [\1 mm, 1\1 mm]", text, count=1)
    ((name, values),) = choices(read_spec(put_file(changed))).items()
    assert name.startswith("parameters.")
    assert len(values) == 2
    engine = (ROOT / "assignments" / "engine-twin-05.yaml").read_text(encoding="utf-8")
    assert read_spec(put_file(engine)).axes == ()
    assert choices(read_spec(put_file(engine.replace("lambda: 1/3.6", "lambda: [1/3.6, 1/4]")))) == {
        "parameters.lambda": ["1/3.6", "1/4"]
    }


@pytest.mark.parametrize(
    ("old", "new", "faults"),
    [
        ("[340 mm, 350 mm]", "[]", ["FILE:6:7 too-few"]),
        ("[340 mm, 350 mm]", "[340 mm, 340 mm]", ["FILE:6:16 choice-repeated"]),
        ("[340 mm, 350 mm]", "[340 mm, [350 mm]]", ["FILE:6:16 wrong-type"]),
        ("[340 mm, 350 mm]", "[340 mm, 35 kg, 350]", ["FILE:6:16 wrong-unit", "FILE:6:23 missing-unit"]),
        ("step: 5 mm", "step: -5 mm", ["FILE:5:40 range-step"]),
        ("step: 5 mm", "step: 0 mm", ["FILE:5:40 range-step"]),
        ("step: 5 mm", "step: 5", ["FILE:5:40 missing-unit"]),
        ("step: 5 mm", "step: 5 kg", ["FILE:5:40 wrong-unit"]),
        ("step: 5 mm", "step: 0,5 mm", ["FILE:5:40 missing-unit", "FILE:5:42 unknown-key"]),
        ("step: 5 mm", "stop: 5 mm", ["FILE:5:7 missing-key", "FILE:5:34 unknown-key"]),
        ("step: 5 mm", "step: 0.0001 mm", ["FILE:5:7 too-many"]),
        ("from: 100 mm", "from: 140 mm", ["FILE:5:14 range-order"]),
        ("from: 100 mm", "from: [1 mm]", ["FILE:5:14 wrong-type"]),
        ("from: 100 mm", "from: 100 furlongz", ["FILE:5:14 unknown-unit"]),
        ("CD: 280 mm", "CDD: [1 mm, 2 mm]", ["FILE:4:1 missing-key", "FILE:7:3 unknown-key"]),
        ("[opposing, clockwise]", "[opposing, sideways]", ["FILE:13:41 choice"]),
        ("salt:", "sallt:", ["FILE:2:1 unknown-key"]),
        ('salt: "2011"', "salt: [1]", ["FILE:2:7 wrong-type"]),
        ("kind: four-bar", "kind: five-bar", ["FILE:1:7 unknown-kind"]),
    ],
)
def test_faults_of_a_spec_stand_where_they_are(put_file: Put, old: str, new: str, faults: list[str]) -> None:
    assert old in BARS
    got = told(put_file(BARS.replace(old, new)))
    # The keys a spec alone has are unknown to an assignment of an unknown kind too: its kind is told first.
    assert got[: len(faults)] == faults
    assert len(got) == len(faults) or "unknown-kind" in faults[0]


def test_a_table_of_variants(put_file: Put) -> None:
    """Names, units in the headings, other sections, an empty cell: the parameter is left out."""
    base = BARS.replace("  BC: [340 mm, 350 mm]\n", "")
    base = base.replace("{from: 100 mm, to: 130 mm, step: 5 mm}   # the crank", "120 mm")
    base += "variants: table.csv\n"
    put_file("Phương án;BC (mm);BF;positions.start\nI;340;220 mm;0 deg\nII;350;;\n", "table.csv")
    spec = read_spec(put_file(base))
    rows = {axis.name: axis for axis in spec.axes}["variants"]
    assert [choice.text for choice in rows.choices] == ["I", "II"]
    assert [{where: one.text for where, one in choice.settings.items()} for choice in rows.choices] == [
        {("parameters", "BC"): "340 mm", ("parameters", "BF"): "220 mm", ("positions", "start"): "0 deg"},
        {("parameters", "BC"): "350 mm"},
    ]


def test_faults_of_a_table_of_variants_stand_in_its_cells(put_file: Put) -> None:
    base = BARS.replace("  BC: [340 mm, 350 mm]\n", "") + "variants: table.xlsx\n"
    rows = (("variant", "BC", "CD", "Cd"), ("I", 340, "1 mm", None), ("I", "350 mm", None, None))
    table = put_file(write_xlsx(Book((Sheet("T", rows),))), "table.xlsx")
    spec = put_file(base)
    with pytest.raises(AssignmentError) as caught:
        read_spec(spec, "en")
    assert [line.replace(str(table), "TABLE") for line in located(caught.value, spec)] == [
        "FILE:6:7 not-in-table",
        "TABLE:T!D1 unknown-column",
        "TABLE:T!B2 missing-unit",
        "TABLE:T!A3 choice-repeated",
    ]
    table.unlink()
    with pytest.raises(AssignmentError, match="unreadable"):
        read_spec(spec)


# --- draws ------------------------------------------------------------------------------------------


def test_a_draw_is_the_sha256_of_the_text_that_is_documented() -> None:
    """By hand; and one number that must stay for ever: `printf … | sha256sum` gives it too."""
    text = b"reportgen-draw/1\0spec\0" + b"2011\0K195520103001\0parameters.AB\x000"
    assert pick("spec", "2011", "K195520103001", "parameters.AB", 0, 7) == int(hashlib.sha256(text).hexdigest(), 16) % 7
    assert pick("spec", "2011", "K195520103001", "parameters.AB", 0, 10**6) == PINNED
    # Đ is one character, ệ composed or decomposed is the same id.
    assert pick("s", "", "Đie\u0323\u0302n", "p", 3, 10**9) == pick("s", "", "Điện", "p", 3, 10**9)


PINNED = 993029


def test_a_student_more_changes_nobody(put_file: Put) -> None:
    spec = read_spec(put_file(BARS))
    judge = trial(spec)
    full = draw(spec, classes(*ids(60)), judge).drawn
    for count in (1, 7, 30, 59):
        assert draw(spec, classes(*ids(count)), judge).drawn == full[:count]


def test_who_leaves_moves_only_whom_he_clashed_with(put_file: Put) -> None:
    spec = read_spec(put_file(BARS))
    judge = trial(spec)
    full = {one.student.id: one.combination for one in draw(spec, classes(*ids(20)), judge).drawn}
    less = {one.student.id: one.combination for one in draw(spec, classes(*ids(20)[1:]), judge).drawn}
    assert all(less[id] in (full[id], full["K000"]) for id in less)


def test_nobody_shares_while_the_space_allows_it(put_file: Put) -> None:
    """112 combinations, all of which turn: 112 students have them all, 250 have each twice or three times."""
    spec = read_spec(put_file(BARS))
    judge = trial(spec)
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
    result = draw(spec, classes(*ids(14)), trial(spec))
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


@pytest.mark.parametrize("file", sorted((ROOT / "assignments").glob("*.yaml")), ids=lambda file: file.stem)
def test_every_assignment_is_a_usable_spec_of_one_variant(file: Path) -> None:
    """Nothing in it is taken for a choice, and what the reports are made from is not called unusable."""
    spec = read_spec(file)
    assert (spec.axes, spec.size) == ((), 1)
    assert trial(spec)({}) == ()


# --- frozen files -----------------------------------------------------------------------------------


def made(path: Path, roster: Path, **options: bool) -> Variants:
    return make_variants(path, roster, path.parent / "out", **options)


SPECS = {
    "four-bar": BARS,
    "engine-twin": (
        "engine-twin-05",
        {"H: 95 mm": "H: {from: 80 mm, to: 110 mm, step: 5 mm}", "1/3.6": "[1/3.6, 1/4]"},
    ),
    "shaper": (
        "shaper-01",
        {"H: 420 mm": "H: [400 mm, 410 mm, 420 mm]", "89 rpm": "{from: 60 rpm, to: 90 rpm, step: 2 rpm}"},
    ),
    "linkage": ("linkage-8", {"n: 120 rpm": "n: [120 rpm, 61 rpm]"}),
    "engine-single": (
        "engine-single-I",
        {"620 rpm": "{from: 600 rpm, to: 640 rpm, step: 5 rpm}", "K: 1.04": "K: [1.02, 1.04]"},
    ),
}


@pytest.mark.parametrize("kind", SPECS)
def test_every_file_passes_check_and_says_what_was_drawn(put_file: Put, kind: str) -> None:
    text = SPECS[kind]
    if isinstance(text, tuple):
        stem, changes = text
        text = (ROOT / "assignments" / f"{stem}.yaml").read_text(encoding="utf-8")
        for old, new in changes.items():
            assert old in text
            text = text.replace(old, new)
    table = "id,name,class\n" + "".join(f"{id},An {id},K58\n" for id in ids(2))
    path, roster = put_file(text), put_file(table, "r.csv")
    spec = read_spec(path)
    result = draw(spec, read_roster(roster), trial(spec))
    for file, one in zip(made(path, roster).files, result.drawn, strict=True):
        assert api.check(file.path) == []
        assignment = api.load(file.path)
        assert (assignment.kind, assignment.id) == (kind, one.student.id)
        assert assignment.report.student.name == f"An {one.student.id}"
        want = plain(put(spec.source(one.settings).top, ("variant",), Scalar(spec.label(one.combination), Mark(""))))
        student = {"name": f"An {one.student.id}", "id": one.student.id, "class": "K58"}
        want.setdefault("report", {})["student"] = student
        got = plain(read_text(file.text).top)
        assert got["report"].pop("language") in ("vi", "en")
        want["report"].pop("language", None)
        assert got == want


HOSTILE = (
    "../../x",
    "CON",
    "a/b",
    "x" * 300,
    "=cmd|' /C calc'!A0",
    '"; rm -rf ~ #',
    "null",
    "yes",
    "- a: [b",
    "{{ 7*7 }}",
    "\\input{/etc/passwd}",
    "# no comment",
    "&a *b !c",
    "é́\u200e🎓",
    "0x10",
    "1e5",
    "'",
)


def test_hostile_ids_and_names_come_back_as_typed(put_file: Put) -> None:
    path = put_file(BARS)
    roster = put_file(write_csv([["id", "name"], *([text, text] for text in HOSTILE)]), "r.csv")
    files = made(path, roster).files
    assert sorted(one.name for one in (path.parent / "out").iterdir()) == sorted(
        ["variants.csv", *(file.path.name for file in files)]
    )
    want = [one.id for one in read_roster(roster).students]
    students = [api.load(file.path).report.student for file in files]
    assert [one.id for one in students] == [one.name for one in students] == want
    (table,) = read(path.parent / "out" / "variants.csv")
    assert [row[0].text for row in table.rows[1:]] == want
    assert "\n=" not in (path.parent / "out" / "variants.csv").read_text(encoding="utf-8")


def test_nobodys_data_is_in_another_file(put_file: Put) -> None:
    path = put_file((DEMO / "spec.yaml").read_text(encoding="utf-8"))
    roster = put_file((DEMO / "roster.csv").read_bytes(), "r.csv")
    students = read_roster(roster).students
    files = made(path, roster).files
    for file, one in zip(files, students, strict=True):
        for other in students:
            if other is not one:
                assert not any(text in file.text for text in (other.id, other.name, other.email))
        assert "from:" not in file.text


def test_comments_and_tables_of_the_spec_stay_as_they_stand(put_file: Put) -> None:
    path = put_file((DEMO / "spec.yaml").read_text(encoding="utf-8"))
    text = made(path, put_file("id\nK1\n", "r.csv")).files[0].text
    assert "    inward:  [-2400, -600, 60, 60, 60, 60, 60]\n" in text
    assert "  # A compressor: the gas holds the slider back" in text
    assert re.search(r"\n  e: [1-4]0 mm    # offset of the guide\n", text)
    assert "salt:" not in text


def test_an_edited_file_is_kept_and_the_others_made(put_file: Put) -> None:
    path, roster = put_file(BARS), put_file("id,name\nK1,An\nK2,Ba\n", "r.csv")
    first, second = made(path, roster).files
    assert [first.state, second.state] == ["new", "new"]
    before = second.path.read_bytes()
    edited = first.path.read_text(encoding="utf-8").replace("across: 110 mm", "across: 120 mm")
    first.path.write_text(edited, encoding="utf-8")
    path.write_text(BARS.replace("omega1: 20", "omega1: 25"), encoding="utf-8")
    again = made(path, roster)
    assert [file.state for file in again.files] == ["kept", "changed"]
    assert first.path.read_text(encoding="utf-8") == edited
    assert second.path.read_bytes() != before
    assert any(str(first.path) in remark for remark in again.remarks)
    assert [file.state for file in made(path, roster).files] == ["kept", "same"]
    assert [file.state for file in made(path, roster, force=True).files] == ["changed", "same"]
    assert "across: 110 mm" in first.path.read_text(encoding="utf-8")


def test_a_file_of_somebody_elses_is_never_replaced(put_file: Put) -> None:
    path, roster = put_file(BARS), put_file("id\nK1\n", "r.csv")
    (path.parent / "out").mkdir()
    (path.parent / "out" / "K1.yaml").write_text("mine\n", encoding="utf-8")
    (file,) = made(path, roster).files
    assert (file.state, file.path.read_text(encoding="utf-8")) == ("kept", "mine\n")


def test_a_kept_file_may_have_line_ends_of_windows(put_file: Put) -> None:
    path, roster = put_file(BARS), put_file("id\nK1\n", "r.csv")
    (file,) = made(path, roster).files
    file.path.write_bytes(file.path.read_bytes().replace(b"\n", b"\r\n"))
    assert made(path, roster).files[0].state == "same"


# --- values of the roster ---------------------------------------------------------------------------


def test_values_of_the_roster_win(put_file: Put) -> None:
    text = "id,parameters.AB,parameters.E.along (mm),report.supervisor\nK1,90 mm,7,TS. Bình\nK2,,,\n"
    first, second = made(put_file(BARS), put_file(text, "r.csv")).files
    given = api.load(first.path)
    assert (given.parameters.AB.text, given.parameters.E.along.text) == ("90 mm", "7 mm")
    assert given.report.supervisor == "TS. Bình"
    assert api.load(second.path).report.supervisor is None


@pytest.mark.parametrize(
    ("text", "faults"),
    [
        ("id,parameters.XY\nK1,5 mm\n", ["R:1:4 unknown-column"]),
        ("id,parameters.E\nK1,5 mm\n", ["R:1:4 unknown-column"]),
        ("id,parameters.AB\nK1,5\nK2,120 mm\nK3,5 kg\n", ["R:2:4 missing-unit", "R:4:4 wrong-unit"]),
        ("id,parameters.AB\nK1,120 mm\nK2,900 mm\n", ["R:3:4 no-assembly"]),
    ],
)
def test_values_that_fail_are_faults_of_their_cells(put_file: Put, text: str, faults: list[str]) -> None:
    path, roster = put_file(BARS), put_file(text, "r.csv")
    with pytest.raises(AssignmentError) as caught:
        made(path, roster)
    assert [line.replace(str(roster), "R") for line in located(caught.value, path)] == faults
    assert not (path.parent / "out").exists()


def test_values_in_the_lists_of_a_linkage(put_file: Put) -> None:
    """An item there is can be set, one there is not is a fault: it would be lost without a word."""
    path = put_file((ROOT / "assignments" / "linkage-8.yaml").read_text(encoding="utf-8"))
    groups = plain(read_text(path.read_text(encoding="utf-8")).top)["parameters"]["groups"]
    first = next(k for k, group in enumerate(groups) if "lengths" in group)
    name = f"parameters.groups.{first}.lengths.1"
    size = float(groups[first]["lengths"][1].split()[0]) + 1
    (file,) = made(path, put_file(f"id,{name} (mm)\nK1,{size:g}\n", "r.csv")).files
    assert api.load(file.path).parameters.groups[first].lengths[1].si == pytest.approx(size / 1e3)
    assert api.load(file.path).variant == api.load(path).variant
    with pytest.raises(AssignmentError, match="unknown-column"):
        made(path, put_file("id,parameters.groups.99.lengths.1\nK1,5 mm\n", "r.csv"))


def test_the_eight_published_engines_go_round_a_class(put_file: Put) -> None:
    """A table of their parameters: 8 students have all eight, 20 have each two or three times."""
    sources = sorted((ROOT / "assignments").glob("engine-single-*.yaml"))
    tops = [plain(read_text(source.read_text(encoding="utf-8")).top) for source in sources]
    flat = [{key: value for key, value in top["parameters"].items() if isinstance(value, str)} for top in tops]
    keys = list(dict.fromkeys(key for one in flat for key in one))
    rows = [[top["variant"], *(one.get(key) for key in keys)] for top, one in zip(tops, flat, strict=True)]
    put_file(write_xlsx(Book((Sheet("T", (("variant", *keys), *rows)),))), "table.xlsx")
    text = sources[0].read_text(encoding="utf-8")
    text = re.sub(r"(?s)\nparameters:.*?\n\n", "\nvariants: table.xlsx\n\n", text)
    assert "parameters:" not in text
    text += "parameters: {flywheel: {delta: 1/100}}\n"
    spec = read_spec(put_file(text))
    judge = trial(spec)
    assert sorted(spec.label(one.combination) for one in draw(spec, classes(*ids(8)), judge).drawn) == sorted(
        top["variant"] for top in tops
    )
    assert set(Counter(one.combination for one in draw(spec, classes(*ids(20)), judge).drawn).values()) == {2, 3}


# --- text of nodes ----------------------------------------------------------------------------------

PRINTABLE = st.text(st.characters(exclude_categories=("Cc", "Cs", "Co", "Zl", "Zp")), max_size=30)


@given(PRINTABLE)
def test_any_text_is_read_as_it_was_quoted(text: str) -> None:
    source = read_text(f"key: {quoted(text)}\n")
    assert source.faults == ()
    assert isinstance(source.top, Table)
    assert plain(source.top) == {"key": text}


@settings(max_examples=40)
@given(
    st.recursive(
        PRINTABLE,
        lambda inner: st.lists(inner, max_size=4) | st.dictionaries(PRINTABLE, inner, max_size=4),
        max_leaves=12,
    )
)
def test_any_nodes_are_read_as_they_were_written(content: object) -> None:
    def node(value: object) -> Scalar | List | Table:
        if isinstance(value, str):
            return Scalar(value, Mark(""))
        if isinstance(value, list):
            return List(tuple(map(node, value)), Mark(""))
        assert isinstance(value, dict)
        return Table(tuple((Scalar(key, Mark("")), node(item)) for key, item in value.items()), Mark(""))

    top = node({"a": content})
    assert isinstance(top, Table)

    def composed(value: object) -> object:
        if isinstance(value, dict):
            return {unicodedata.normalize("NFC", key): composed(item) for key, item in value.items()}
        return [composed(item) for item in value] if isinstance(value, list) else value

    got = plain(read_text(text_of(top, "", Table((), Mark("")))).top)
    assert got == composed(plain(top))


# --- likeness ---------------------------------------------------------------------------------------


def test_who_stands_apart() -> None:
    """Twice the work and a torque ten times the others' are out of proportion; 1 % more is not."""
    usual = [Effort(600, 100.0 + k, 30.0, 0.5, 10) for k in range(8)]
    odd = [Effort(1300, 104.0, 30.3, 0.5, 10), Effort(600, 1000.0, 30.0, 0.5, 10)]
    apart = {spread.name: spread.apart for spread in compare([*usual, *odd])}
    assert apart == {"worked": (8,), "largest": (9,), "speed": (), "positive": (), "zeros": ()}
    assert [spread.name for spread in compare([Effort(5, None, 1.0, None, 0)])] == ["worked", "speed", "zeros"]


def test_the_instructors_table_has_values_and_figures(put_file: Put) -> None:
    path = put_file((DEMO / "spec.yaml").read_text(encoding="utf-8"))
    roster = put_file((DEMO / "roster.csv").read_bytes(), "r.csv")
    result = made(path, roster)
    (page,) = read(path.parent / "out" / "variants.csv")
    head, *rows = [[cell.text for cell in row] for row in page.rows]
    assert head[:3] == ["id", "file", "variant"]
    assert head[-5:] == ["worked", "largest", "speed", "positive", "zeros"]
    assert len(rows) == len(result.files) == 12
    assert len({tuple(row[3:8]) for row in rows}) == 12
    for row, file in zip(rows, result.files, strict=True):
        assignment = api.load(file.path)
        torque = api.analyse(assignment).torque
        assert float(row[head.index("largest")]) == pytest.approx(abs(torque).max(), rel=1e-5)
        assert row[head.index("parameters.r")] == assignment.parameters.r.text
        assert float(row[head.index("positive")]) == pytest.approx((torque > 0).mean())
    assert "Nguyễn" not in (path.parent / "out" / "variants.csv").read_text(encoding="utf-8")


def test_a_class_that_must_share_is_told_who(put_file: Put) -> None:
    text = BARS.replace("{from: 100 mm, to: 130 mm, step: 5 mm}", "120 mm").replace("[340 mm, 350 mm]", "340 mm")
    text = text.replace("{from: 0.1 mm, to: 0.4 mm, step: 0.1 mm}", "0.1 mm")
    result = made(put_file(text), put_file("id\nK1\nK2\nK3\n", "r.csv"))
    assert result.remarks[0] == "2 usable variants for 3 students: some share one"
    assert len(result.remarks) == 2


# --- the command ------------------------------------------------------------------------------------


def test_the_command_prints_each_path_and_the_table(put_file: Put, capsys: pytest.CaptureFixture[str]) -> None:
    path, roster = put_file(BARS), put_file("id\nK1\n../x\n", "r.csv")
    out = path.parent / "out"
    assert command("variants", path, roster, "-o", out, "--lang", "en") == 0
    printed = capsys.readouterr()
    first, second, blank, head, *_ = printed.out.splitlines()
    assert (first, blank, head) == (str(out / "K1.yaml"), "", "How alike the 2 variants are:")
    assert Path(second).parent == out
    assert printed.err == ""
    first_file = out / "K1.yaml"
    first_file.write_text("mine\n", encoding="utf-8")
    assert command("variants", path, roster, "-o", out, "--lang", "en") == 0
    assert f"kept, since it was edited by hand (--force replaces it): {first_file}" in capsys.readouterr().err
    assert command("variants", path, roster, "-o", out, "--force") == 0
    assert api.check(first_file) == []


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (("spec.yaml", "none.csv"), 1),
        (("none.yaml", "r.csv"), 1),
        (("spec.yaml",), 2),
        (("spec.yaml", "r.csv", "x"), 2),
    ],
)
def test_the_command_ends_as_the_others_do(
    put_file: Put, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...], code: int
) -> None:
    monkeypatch.chdir(put_file(BARS).parent)
    put_file("id\nK1\n", "r.csv")
    assert command("variants", *arguments) == code
    assert not Path("out").exists()


def command(*arguments: object) -> int:
    with pytest.raises(SystemExit) as ended:
        app(list(map(str, arguments)))
    return int(ended.value.code or 0)
