"""Variants as files: each passes check, none holds another's data, one edited by hand is kept."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.errors import AssignmentError, Location
from reportgen.base.yaml_source import Scalar, plain, read_text
from reportgen.base.yaml_values import put
from reportgen.classes.roster import read_roster
from reportgen.classes.variant_draw import fault_finder
from reportgen.classes.variant_spec import read_spec
from reportgen.classes.variants import Variants, make_variants
from reportgen.cli import app
from reportgen.workbook import read, write_csv
from tests.classes.specs import BARS, DEMO, ROOT, Put, draw, ids, located


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
    result = draw(spec, read_roster(roster), fault_finder(spec))
    for file, one in zip(made(path, roster).files, result.drawn, strict=True):
        assert api.check(file.path) == []
        assignment = api.load(file.path)
        assert (assignment.kind, assignment.id) == (kind, one.student.id)
        assert assignment.report.student.name == f"An {one.student.id}"
        want = plain(
            put(spec.source(one.settings).top, ("variant",), Scalar(spec.label(one.combination), Location("")))
        )
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
                assert not any(other.card[key] in file.text for key in ("id", "name", "email"))
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


# --- what the instructor is told --------------------------------------------------------------------


def test_the_instructors_table_has_values_and_figures(put_file: Put) -> None:
    path = put_file((DEMO / "spec.yaml").read_text(encoding="utf-8"))
    roster = put_file((DEMO / "roster.csv").read_bytes(), "r.csv")
    result = made(path, roster)
    (page,) = read(path.parent / "out" / "variants.csv")
    head, *rows = [[cell.text for cell in row] for row in page.rows]
    assert head[:4] == ["id", "name", "file", "variant"]
    assert head[-7:] == ["worked", "largest", "speed", "positive", "zeros", "redrawn", "dropped"]
    assert len(rows) == len(result.files) == 12
    assert len({tuple(row[4:9]) for row in rows}) == 12
    for row, file in zip(rows, result.files, strict=True):
        assignment = api.load(file.path)
        torque = api.analyse(assignment).torque
        assert float(row[head.index("largest")]) == pytest.approx(abs(torque).max(), rel=1e-5)
        assert row[head.index("parameters.r")] == assignment.parameters.r.text
        assert float(row[head.index("positive")]) == pytest.approx((torque > 0).mean())
    # It is for the lecturer alone, who knows the class by its names.
    assert rows[0][1] == "Nguyễn Hoàng An"


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
    assert f"kept because it was edited by hand (use --force to replace it): {first_file}" in capsys.readouterr().err
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
