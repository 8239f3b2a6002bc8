"""What somebody new types first: slips are met with what was meant, in one language, wherever the files come from."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from reportgen.base.template_folders import samples
from tests.commands import ROOT, process, reportgen
from tests.lanes import matrix, proof

SAMPLE = ROOT / "assignments" / "engine-twin-05.yaml"
SHAPER = ROOT / "assignments" / "shaper-01.yaml"
WORDS = "%% foreword\n# Preface {{ unnumbered() }}\n\nAs we have it.\n"


@pytest.fixture
def own(tmp_path: Path) -> Path:
    """A file that no school is named in, and a school's words beside it."""
    file = tmp_path / "own.yaml"
    file.write_text(SHAPER.read_text(encoding="utf-8").replace("language: vi", "language: en"), encoding="utf-8")
    (tmp_path / "words").mkdir()
    (tmp_path / "words" / "en.md").write_text(WORDS, encoding="utf-8")
    return file


# --- help ---------------------------------------------------------------------------------------------


def test_it_tells_its_version() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["version"] == "1.0.0"
    # The one that is installed may be older than the checkout.
    assert re.fullmatch(r"reportgen \d+\.\d+\.\d+\n", reportgen("--version").stdout)


def test_help_has_a_short_name() -> None:
    assert reportgen("build", "-h").stdout == reportgen("build", "--help").stdout != ""
    nothing = reportgen()
    assert (nothing.returncode, nothing.stderr) == (0, "")
    assert "reportgen -h" in nothing.stdout


@pytest.mark.parametrize(
    ("typed", "meant"),
    matrix([("new sha", "shaper"), ("ch", "check"), ("build --ext", "--extent")], [("new sha", "shaper")]),
)
def test_the_shell_completes(typed: str, meant: str) -> None:
    words = f"reportgen {typed}"
    asked = {"_REPORTGEN_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": str(len(words.split()) - 1)}
    assert reportgen(**asked).stdout.split() == [meant]
    assert "--install-completion" in reportgen("--help").stdout


@pytest.mark.parametrize(
    ("line", "meant"),
    [
        ("buidl a.yaml", "build"),
        ("new shapr", "shaper"),
        ("new shaper --from shaper-1", "shaper-01"),
        ("build a.yaml --engin typst", "--engine"),
        ("build a.yaml --format pfd", "pdf"),
    ],
)
def test_a_slip_is_told_with_what_was_meant(line: str, meant: str) -> None:
    done = reportgen(*line.split(), "--lang", "en")
    assert done.returncode == 2
    assert f": did you mean “{meant}”?\n" in done.stderr


def test_a_kind_misspelt_in_a_file_is_told_with_what_was_meant(own: Path) -> None:
    own.write_text(own.read_text(encoding="utf-8").replace("kind: shaper", "kind: shapre"), encoding="utf-8")
    assert "hint: did you mean “shaper”?" in reportgen("check", own).stderr


# --- one language -------------------------------------------------------------------------------------

WRONG = (
    "fly",
    "build",
    "build a.yaml --engine",
    "build a.yaml --engine word",
    "build a.yaml --keep-source=1",
    "solve a.yaml --positions 3",
    "solve a.yaml b.yaml",
    "kinds --all",
    "batch a.csv --jobs 0",
    "batch a.csv",
    "check a.yaml --templates nowhere",
    "check nowhere.yaml",
    "grade nowhere --assignments nowhere",
)


@pytest.mark.parametrize("line", matrix(WRONG, ["build a.yaml --engine word", "check nowhere.yaml"]))
def test_what_is_wrong_is_told_in_the_language_of_the_locale(line: str, tmp_path: Path) -> None:
    told = {
        locale: reportgen(*line.split(), cwd=tmp_path, LC_ALL=locale).stderr
        for locale in ("vi_VN.UTF-8", "de_DE.UTF-8")
    }
    assert re.search(r"[ạảấầậắặếềệịọốộớợụứựỳ]", told["vi_VN.UTF-8"])
    assert told["de_DE.UTF-8"].isascii() or not re.search(r"[ạấếộợ]", told["de_DE.UTF-8"])
    assert not re.search(r"\b(Usage|Error|Invalid|Missing|Try|the|is)\b", told["vi_VN.UTF-8"])


@pytest.mark.proof
def test_an_option_goes_before_the_file_and_the_file_before_the_locale(own: Path) -> None:
    wrong = ("--engine", "word")
    assert "is expected" in reportgen("build", own, *wrong, LANG="vi_VN.UTF-8").stderr
    assert "phải là" in reportgen("build", own, *wrong, "--lang", "vi", LANG="en_US.UTF-8").stderr
    assert "phải là" in reportgen("build", SHAPER, *wrong, LANG="en_US.UTF-8").stderr
    assert "phải là" in reportgen("build", *wrong, REPORTGEN_LANG="vi", LANG="en_US.UTF-8").stderr
    assert "Twin" not in reportgen("kinds", LANG="C").stdout
    assert "twin" in reportgen("kinds", LANG="en_GB.UTF-8").stdout


def test_what_is_told_of_a_class_is_in_its_language(tmp_path: Path) -> None:
    """No option says it and the roster has none: the assignments do."""
    folder, roster = tmp_path / "class", tmp_path / "roster.csv"
    roster.write_text("id,name\nK1,An\n", encoding="utf-8")
    spec = tmp_path / "spec.yaml"
    spec.write_text(
        "kind: shaper\nreport: {language: en}\nparameters:\n  {a: 270 mm, b: 520 mm, l3: 550 mm, l4: 100 mm,"
        " H: 420 mm, n: [80 rpm, 90 rpm]}\n",
        encoding="utf-8",
    )
    drawn = reportgen("variants", spec, roster, "-o", folder)
    # How alike the variants are is no question where there is one.
    assert (drawn.stdout, drawn.stderr) == (f"{folder / 'K1.yaml'}\n", "")
    graded = reportgen("grade", tmp_path / "none", "--assignments", folder, "--out", tmp_path / "out")
    assert "cannot be read" in graded.stderr
    assert "no sheet from one student" in graded.stdout


# --- files as they come -------------------------------------------------------------------------------


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_file_saved_by_notepad_is_read(own: Path, encoding: str) -> None:
    own.write_text(own.read_text(encoding="utf-8").replace("\n", "\r\n"), encoding=encoding, newline="")
    done = reportgen("check", own)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.proof
def test_units_as_they_are_written_in_vietnamese(own: Path) -> None:
    text = own.read_text(encoding="utf-8")
    solved = []
    for unit in ("rpm", "vg/ph", "vòng/phút"):
        own.write_text(text.replace("n: 89 rpm", f"n: 89 {unit}"), encoding="utf-8")
        solved.append(reportgen("solve", own, "--json", "-").stdout.partition('"printed"')[0])
    assert solved[0] == solved[1] == solved[2] != ""


@pytest.mark.proof
def test_a_folder_is_named_and_refused(tmp_path: Path) -> None:
    for command in ("check", "build", "watch"):
        done = reportgen(command, ".", "--lang", "en", cwd=tmp_path)
        assert done.returncode == 1
        assert done.stderr.splitlines() == [
            ".:1:1: error[unreadable]: the file cannot be read: it is a folder",
            f"    hint: give a file in the folder {tmp_path.resolve()}",
        ]


# --- examples and a school's words, without a checkout ------------------------------------------------


def test_a_name_that_is_none_is_told_in_a_line() -> None:
    assert "error[unreadable]" in reportgen("check", "a" * 5000).stderr


def test_examples_come_with_the_program(tmp_path: Path) -> None:
    file = tmp_path / "twin.yaml"
    assert reportgen("new", "engine-twin", "--from", "engine-twin-05", "-o", file).returncode == 0
    assert file.read_bytes() == SAMPLE.read_bytes()
    other = reportgen("new", "engine-twin", "--from", "engine-twin-05", "--lang", "en").stdout
    assert other == SAMPLE.read_text(encoding="utf-8").replace("language: vi", "language: en")
    copied = tmp_path / "examples"
    assert reportgen("samples", copied).stdout == f"{copied}\n"
    assert {path.relative_to(copied) for path in copied.rglob("*")} == {
        path.relative_to(samples()) for path in samples().rglob("*")
    }
    (copied / "engine-twin-05.yaml").write_text("mine", encoding="utf-8")
    assert reportgen("samples", copied).returncode == 1
    assert (copied / "engine-twin-05.yaml").read_text(encoding="utf-8") == "mine"
    assert reportgen("samples", copied, "--force").returncode == 0
    assert (copied / "engine-twin-05.yaml").read_bytes() == SAMPLE.read_bytes()


@pytest.mark.proof
@pytest.mark.parametrize("way", matrix(["option", "environment", "file"], ["file"]))
def test_a_school_keeps_its_words_where_it_likes(own: Path, way: str) -> None:
    words, out = own.parent / "words", own.parent / "out"
    more: tuple[object, ...] = ("--templates", words) if way == "option" else ()
    if way == "file":
        text = own.read_text(encoding="utf-8")
        own.write_text(text.replace("language: en", "language: en\n  templates: words"), encoding="utf-8")
    named = {"REPORTGEN_TEMPLATES": str(words)} if way == "environment" else {}
    done = reportgen("build", own, "--out", out, "--keep-source", *more, **named)
    assert (done.returncode, done.stderr) == (0, "")
    assert "As we have it." in (out / "own" / "report.typ").read_text(encoding="utf-8")


NO_SCHOOL = [
    (
        "templates: wordz",
        "error[no-templates]: this folder has no templates of a school (no file such as vi.md or ru.md): {}/wordz",
    ),
    ("templates: ../words", "error[path-outside]: "),
    ("templates: " + "a" * 280, "error[no-templates]: "),
    ("templates: [words]", "error[wrong-type]: "),
    ("school: tnut", "error[no-such-school]: there is no folder of templates for the school “tnut” in "),
    ("templates: words\n  school: sample-school", "error[both-given]: "),
]


@pytest.mark.parametrize(("key", "told"), matrix(NO_SCHOOL, NO_SCHOOL[::3]))
def test_where_a_school_was_looked_for_is_told(own: Path, key: str, told: str) -> None:
    text = own.read_text(encoding="utf-8")
    own.write_text(text.replace("language: en", f"language: en\n  {key}"), encoding="utf-8")
    assert told.format(own.parent) in reportgen("check", own).stderr


@proof
def test_a_batch_takes_the_words_beside_its_files_along(own: Path) -> None:
    """And makes anew what they are in when they change."""
    place = own.parent
    text = own.read_text(encoding="utf-8").replace("language: en", "language: en\n  templates: words")
    (place / "spec.yaml").write_text(text, encoding="utf-8")
    (place / "roster.csv").write_text("id,name\nK1,An\n", encoding="utf-8")
    assert reportgen("variants", place / "spec.yaml", place / "roster.csv", "-o", place / "class").returncode == 0
    batch = ("batch", place / "roster.csv", "--assignments", place / "class", "--make", "page", "--out", place / "made")
    page = place / "made" / "K1" / "report.html"
    assert process(*batch).returncode == 0
    assert "As we have it." in page.read_text(encoding="utf-8")
    (place / "class" / "words" / "en.md").write_text(WORDS.replace("have", "had"), encoding="utf-8")
    assert process(*batch).returncode == 0
    assert "As we had it." in page.read_text(encoding="utf-8")
