"""Wrong files: every fault is found in one run, where it stands, under its code, in both languages."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.catalogue import check

BASE = """\
kind: engine-twin
report: {language: en}
parameters:
  H: 95 mm
  lambda: 1/3.6
  n: 2200 rpm
  D: 98 mm
  s: 0.35
  G2: 20 N
  G3: 22 N
indicator:
  unit: N/cm2
  by: stroke
  s: [0, 0.5, 1]
  intake: [1, -2.5, -2.5]
  compression: [28, 3.4, -2.5]
  expansion: [28, 13, 3.6]
  exhaust: [1, 1, 3.6]
"""

BY_ANGLE = BASE[: BASE.index("  by: stroke")] + "  by: crank_angle\n  angle: [0 deg, 720 deg]\n  p: [1, 1]\n"

NO_REPORT = BASE.replace("report: {language: en}\n", "")

# (name, what is replaced in BASE, by what, the faults expected)
EDITS = [
    # keys
    ("unknown key", "  H: 95 mm", "  H: 95 mm\n  speed: 3", ["5:3 unknown-key"]),
    ("unknown section", "kind: engine-twin", "kind: engine-twin\nsize: 3", ["2:1 unknown-key"]),
    ("unknown key without value", "  H: 95 mm", "  H: 95 mm\n  speed:", ["5:3 unknown-key"]),
    ("unknown section without value", "kind: engine-twin", "kind: engine-twin\nsize:", ["2:1 unknown-key"]),
    ("section without value", BASE[BASE.index("indicator") :], "indicator:", ["11:1 missing-key"]),
    ("form of the table without value", "by: stroke", "by:", ["13:3 choice"]),
    ("unknown key in a row of keys", "{language: en}", "{language: en, tittle: x}", ["2:24 unknown-key"]),
    ("unknown key two levels down", "{language: en}", "{student: {nmae: x}}", ["2:20 unknown-key"]),
    ("unknown key of the indicator", "  by: stroke", "  by: stroke\n  p: [1]", ["14:3 unknown-key"]),
    ("merge key", "parameters:", "parameters:\n  <<: {H: 1 m}", ["4:3 unknown-key"]),
    ("duplicate key", "  D: 98 mm", "  D: 98 mm\n  H: 80 mm", ["8:3 duplicate-key"]),
    ("duplicate section", "indicator:", "report:\nindicator:", ["11:1 duplicate-key"]),
    ("missing key", "  D: 98 mm\n", "", ["3:1 missing-key"]),
    ("key without value", "  D: 98 mm", "  D:", ["7:3 missing-key"]),
    ("missing section", BASE[BASE.index("indicator") :], "", ["1:1 missing-key"]),
    ("missing kind", "kind: engine-twin\n", "", ["1:1 missing-key"]),
    ("missing row", "  exhaust: [1, 1, 3.6]\n", "", ["11:1 missing-key"]),
    ("missing form of the table", "  by: stroke\n", "", ["11:1 missing-key"]),
    ("missing speed", "  n: 2200 rpm\n", "", ["3:1 missing-key"]),
    ("missing weight", "  G2: 20 N\n", "", ["3:1 missing-key"]),
    ("list as key", "parameters:", "parameters:\n  ? [a]\n  : 1", ["4:5 wrong-type"]),
    # units and numbers
    ("missing unit", "H: 95 mm", "H: 95", ["4:6 missing-unit"]),
    ("wrong unit", "H: 95 mm", "H: 95 kg", ["4:6 wrong-unit"]),
    ("unknown unit", "H: 95 mm", "H: 95 parsnip", ["4:6 unknown-unit"]),
    ("frequency for a speed", "2200 rpm", "36 Hz", ["6:6 wrong-unit"]),
    ("mass for a weight", "20 N", "2 kg", ["9:7 wrong-unit"]),
    ("angle without unit", "  s: 0.35", "  s: 0.35\n  crank_angle: 180", ["9:16 missing-unit"]),
    ("unit in a ratio", "s: 0.35", "s: 0.35 mm", ["8:6 unexpected-unit"]),
    ("unit in a table", "[1, 1, 3.6]", "[1, 1 bar, 3.6]", ["18:16 unexpected-unit"]),
    ("decimal comma", "s: 0.35", "s: 0,35", ["8:6 decimal-comma"]),
    ("decimal comma with unit", "H: 95 mm", "H: 95,5 mm", ["4:6 decimal-comma"]),
    ("no number", "H: 95 mm", "H: about 95 mm", ["4:6 not-a-number"]),
    ("no number in a table", "[1, 1, 3.6]", "[1, x, 3.6]", ["18:16 not-a-number"]),
    ("empty item", "[1, 1, 3.6]", "[1, ~, 3.6]", ["18:16 wrong-type"]),
    ("nan", "s: 0.35", "s: .nan", ["8:6 not-finite"]),
    ("inf", "H: 95 mm", "H: .inf mm", ["4:6 not-finite"]),
    ("inf in a table", "[1, 1, 3.6]", "[1, -.inf, 3.6]", ["18:16 not-finite"]),
    ("beyond a float", "H: 95 mm", "H: 1e999 mm", ["4:6 not-finite"]),
    ("division by zero", "1/3.6", "1/0", ["5:11 not-finite"]),
    ("endless digits", "s: 0.35", f"s: {'9' * 5000}", ["8:6 not-a-number"]),
    # ranges
    ("inverse ratio", "1/3.6", "3.6", ["5:11 out-of-range"]),
    ("ratio of one", "1/3.6", "1", ["5:11 out-of-range"]),
    ("negative length", "H: 95 mm", "H: -95 mm", ["4:6 out-of-range"]),
    ("no length", "D: 98 mm", "D: 0 mm", ["7:6 out-of-range"]),
    ("length of a street", "H: 95 mm", "H: 1e300 mm", ["4:6 out-of-range"]),
    ("standing engine", "2200 rpm", "0 rpm", ["6:6 out-of-range"]),
    ("mass centre beyond the rod", "s: 0.35", "s: 1.1", ["8:6 out-of-range"]),
    ("absurd pressure", "[1, 1, 3.6]", "[1, 1e300, 3.6]", ["18:16 out-of-range"]),
    ("fraction above one", "[0, 0.5, 1]", "[0, 0.5, 1.5]", ["14:15 out-of-range"]),
    ("too few positions", "{language: en}", "{}\npositions: {count: 3}", ["3:20 out-of-range"]),
    ("too many positions", "{language: en}", "{}\npositions: {count: 361}", ["3:20 out-of-range"]),
    ("half a position", "{language: en}", "{}\npositions: {count: 8.5}", ["3:20 wrong-type"]),
    ("drawing beyond the paper", "{language: en}", "{}\ndrawing: {crank: 5 m}", ["3:18 out-of-range"]),
    # kinds of value
    ("unknown kind", "engine-twin", "engine-twins", ["1:7 unknown-kind"]),
    ("kind as a list", "engine-twin", "[engine-twin]", ["1:7 wrong-type"]),
    ("section as text", BASE[BASE.index("indicator") :], "indicator: none", ["11:12 wrong-type"]),
    ("report as a list", "{language: en}", "[en]", ["2:9 wrong-type"]),
    ("text as a section", "{language: en}", "{place: {a: b}}", ["2:17 wrong-type"]),
    ("quantity as a list", "H: 95 mm", "H: [95, mm]", ["4:6 wrong-type"]),
    ("row as a number", "[1, 1, 3.6]", "3", ["18:12 wrong-type"]),
    ("another language", "language: en", "language: fr", ["2:20 choice"]),
    ("another direction", "{language: en}", "{}\npositions: {direction: left}", ["3:24 choice"]),
    ("another form of the table", "by: stroke", "by: hand", ["13:7 choice"]),
    ("another reference", "  by: stroke", "  by: stroke\n  reference: vacuum", ["14:14 choice"]),
    ("no date", "language: en", "date: 24/3/2011", ["2:16 date"]),
    ("no such day", "language: en", "date: 2011-02-30", ["2:16 date"]),
    ("control character in a name", "language: en", r'place: "\a"', ["2:17 control-character"]),
    ("line break in a name", "language: en", r'place: "a\nb"', ["2:17 control-character"]),
    ("half a surrogate in a name", "language: en", r'place: "\ud800"', ["2:17 control-character"]),
    ("endless name", "language: en", f"place: {'x' * 301}", ["2:17 text-too-long"]),
    # positions written out
    ("position after the cycle", "language: en", "worked_positions: [4, 17]", ["2:32 no-such-position"]),
    ("position zero", "language: en", "worked_positions: [0]", ["2:28 out-of-range"]),
    ("position twice", "language: en", "worked_positions: [4, 4]", ["2:28 repeated"]),
    ("no position at all", "language: en", "worked_positions: []", ["2:28 too-few"]),
    ("positions in words", "language: en", "worked_positions: some", ["2:28 wrong-type"]),
    # pairs and tables
    ("speed twice", "  n: 2200 rpm", "  n: 2200 rpm\n  omega1: 230 rad/s", ["7:3 both-given"]),
    ("weight and mass", "  G2: 20 N", "  m2: 2 kg\n  G2: 20 N", ["10:3 both-given"]),
    ("second weight and mass", "  G2: 20 N", "  G2: 20 N\n  G4: 1 N\n  m4: 1 kg", ["11:3 both-given"]),
    ("short row", "[1, 1, 3.6]", "[1, 3.6]", ["18:12 row-length"]),
    ("long row", "[1, 1, 3.6]", "[1, 1, 1, 3.6]", ["18:12 row-length"]),
    ("row of one", "[1, 1, 3.6]", "[1]", ["18:12 too-few"]),
    ("unordered s", "[0, 0.5, 1]", "[0, 1, 0.5]", ["14:13 not-increasing"]),
    ("repeated s", "[0, 0.5, 1]", "[0, 0, 1]", ["14:10 not-increasing"]),
    (
        "comma in a list",
        "[0, 0.5, 1]",
        "[0, 0,5, 1]",
        ["14:6 row-length", "14:10 not-increasing", "14:12 out-of-range"],
    ),
    ("table begins late", "[0, 0.5, 1]", "[0.1, 0.5, 1]", ["14:7 table-end"]),
    ("table ends early", "[0, 0.5, 1]", "[0, 0.5, 0.9]", ["14:15 table-end"]),
    ("impossible firing", "  by: stroke", "  by: stroke\n  firing: [intake, intake]", ["14:11 firing"]),
    ("unknown stroke", "  by: stroke", "  by: stroke\n  firing: [intake, idle]", ["14:20 choice"]),
    ("three in a firing pair", "  by: stroke", "  by: stroke\n  firing: [intake, intake, intake]", ["14:11 too-many"]),
    ("half a firing pair", "  by: stroke", "  by: stroke\n  firing: [intake]", ["14:11 too-few"]),
    # YAML
    ("tab before a key", "  H: 95 mm", "\tH: 95 mm", ["4:1 tab"]),
    ("tab after a key", "  H: 95 mm", "  H:\t95 mm", ["4:5 tab"]),
    ("tab in a value", "H: 95 mm", "H: 95\tmm", ["4:8 tab"]),
    ("tag", "H: 95 mm", "H: !!python/object:os.system 95 mm", ["4:6 tag"]),
    ("local tag", "H: 95 mm", "H: !x 95 mm", ["4:6 tag"]),
    ("anchor", "H: 95 mm", "H: &a 95 mm", ["4:6 alias"]),
    ("alias", "  G3: 22 N", "  G3: *a", ["10:7 alias"]),
    ("second colon", "H: 95 mm", "H: 95: mm", ["4:8 syntax"]),
    ("open bracket", "[1, 1, 3.6]", "[1, 1, 3.6", ["19:1 syntax"]),
    ("bracket closed twice", "[1, 1, 3.6]", "[1, 1, 3.6]]", ["18:23 syntax"]),
    ("open quotation", "language: en", "place: 'en", ["19:1 syntax"]),
    ("indentation", "  H: 95 mm", "   H: 95 mm", ["5:3 syntax"]),
    ("second document", "indicator:", "---\nindicator:", ["11:1 syntax"]),
    # several at once, in the order of the file
    (
        "many faults",
        BASE,
        BASE.replace("95 mm", "95").replace("2200 rpm", "2,2 rpm").replace("G2", "Q2").replace("0.5, 1]", "1]"),
        ["3:1 missing-key", "4:6 missing-unit", "6:6 decimal-comma", "9:3 unknown-key", "14:6 row-length"],
    ),
]

TEXTS: list[tuple[str, bytes, list[str]]] = [
    ("empty", b"", ["1:1 empty"]),
    ("comments only", b"# nothing\n\n", ["1:1 empty"]),
    ("an empty document", b"---\n", ["1:1 empty"]),
    ("a list", b"- kind: engine-twin\n", ["1:1 wrong-type"]),
    ("a word", b"engine\n", ["1:1 wrong-type"]),
    ("NUL", b"kind: a\nvariant: \0\n", ["2:10 binary"]),
    ("a picture", b"\x89PNG\r\n\x1a\n\xff\xfe\xfd", ["1:1 encoding"]),
    ("another encoding", "kind: a\nvariant: phương".encode("utf-16-le"), ["1:2 binary"]),
    ("broken UTF-8", "variant: ph\xe9".encode("latin-1"), ["1:12 encoding"]),
    ("control character", b"kind: a\nvariant: \x07\n", ["2:10 control-character"]),
    ("absurd size", b"# " + b"x" * 1_000_000, ["1:1 too-large"]),
    ("endless keys", b"".join(b"k%d: 1\n" % n for n in range(40_000)), ["201:1 too-many"]),
    ("endless row", BASE.replace("[1, 1, 3.6]", str([1] * 2001)).encode(), ["18:12 too-many"]),
    ("endless nesting", b"a: " + b"[" * 5000, ["1:15 too-deep"]),
    ("endless mappings", b"{a: " * 5000, ["1:46 too-deep"]),
    (
        "alias bomb",
        b"a: &a [x, x]\nb: &b [*a, *a]\nc: [*b, *b]\n",
        ["1:4 alias", "2:4 alias", "2:8 alias", "2:12 alias", "3:5 alias", "3:9 alias"],
    ),
    ("angles out of order", BY_ANGLE.replace("0 deg, 720", "720 deg, 0").encode(), ["14:20 not-increasing"]),
    ("angles of one turn", BY_ANGLE.replace("720", "360").encode(), ["14:18 table-end"]),
    ("an angle without unit", BY_ANGLE.replace("0 deg, ", "0, ").encode(), ["14:11 missing-unit"]),
    ("a pressure too many", BY_ANGLE.replace("[1, 1]", "[1, 1, 1]").encode(), ["15:6 row-length"]),
    ("a row of the other form", BY_ANGLE.encode() + b"  intake: [1, 1]\n", ["16:3 unknown-key"]),
]


def faults(path: Path) -> list[str]:
    return [f"{p.mark.line}:{p.mark.column} {p.code}" for p in check(path, "en")]


@pytest.mark.parametrize(("old", "new", "expected"), [e[1:] for e in EDITS], ids=[e[0] for e in EDITS])
def test_edit_of_a_right_file(tmp_path: Path, old: str, new: str, expected: list[str]) -> None:
    assert old in BASE
    file = tmp_path / "a.yaml"
    file.write_text(BASE.replace(old, new, 1), encoding="utf-8")
    assert faults(file) == expected


@pytest.mark.parametrize(("data", "expected"), [t[1:] for t in TEXTS], ids=[t[0] for t in TEXTS])
def test_whole_file(tmp_path: Path, data: bytes, expected: list[str]) -> None:
    file = tmp_path / "a.yaml"
    file.write_bytes(data)
    assert faults(file) == expected


@pytest.mark.parametrize("text", [BASE, BY_ANGLE, NO_REPORT], ids=["by stroke", "by angle", "no report"])
def test_the_files_they_start_from_are_right(tmp_path: Path, text: str) -> None:
    file = tmp_path / "a.yaml"
    file.write_text(text, encoding="utf-8")
    assert check(file) == []


@pytest.mark.parametrize("language", ["vi", "en"])
def test_every_fault_has_words_in_both_languages(tmp_path: Path, language: str) -> None:
    file = tmp_path / "a.yaml"
    for _, old, new, _ in EDITS:
        file.write_text(BASE.replace(old, new, 1), encoding="utf-8")
        for problem in check(file, "en" if language == "en" else "vi"):
            assert str(problem).startswith(f"{file}:{problem.mark.line}:{problem.mark.column}: error[")
            assert "{" not in problem.message.replace("{a: b}", "")


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    assert faults(tmp_path / "none.yaml") == ["1:1 unreadable"]
    assert faults(tmp_path) == ["1:1 unreadable"]
