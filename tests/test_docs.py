"""The documentation is correct: commands run as shown, files work as printed, names exist."""

from __future__ import annotations

import importlib.util
import json
import math
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import pytest
import typer

from reportgen import api, catalogue
from reportgen.base.kinds import kinds
from reportgen.base.template_folders import search_path
from reportgen.cli import app
from reportgen.document.template_rendering import Prose
from reportgen.writers import pdflatex
from tests import house
from tests.lanes import matrix, proof

ROOT = Path(__file__).parent.parent
PAGES = ("README.md", "README.vi.md", *sorted(f"docs/{page.name}" for page in (ROOT / "docs").glob("*.md")))
"""Pages for users; each is read, and its commands are run, separately."""

TELLING = ("README.md",)
"""Pages whose commands `make test` runs."""

DOCUMENTS = (*PAGES, "CONTRIBUTING.md", "ARCHITECTURE.md", "CHANGELOG.md")
LARGEST_PICTURE = 150_000
"""Largest size (bytes) of a picture, so that a page loads quickly over a slow connection."""
LARGEST_MOVING = 1_000_000
"""Largest size (bytes) of a moving picture."""

_FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_FILE = re.compile(r"`([\w./-]+\.\w+)`[^`\n]*:\n\n```\w+\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"\]\(([^)\s]+)\)")


def text_of(document: str) -> str:
    return (ROOT / document).read_text(encoding="utf-8")


def fences(document: str, language: str) -> list[str]:
    return [body for name, body in _FENCE.findall(text_of(document)) if name == language]


def section(text: str, heading: str) -> str:
    """Return the text between a heading and the next one of any level, ignoring headings in code blocks."""
    found = re.search(rf"^{re.escape(heading)}\n((?:^```.*?^```$|.)*?)(?=^##+ |\Z)", text, re.MULTILINE | re.DOTALL)
    assert found, heading
    return found[1]


@dataclass(frozen=True, slots=True)
class Command:
    """A line of a console block and its shown output."""

    line: str
    output: tuple[str, ...]

    @property
    def is_make(self) -> bool:
        return self.line.startswith("make ")

    @property
    def runnable(self) -> str:
        """The command to run; make only does a dry run, because it would install and run everything again."""
        return self.line.replace("make ", "make -n ", 1) if self.is_make else self.line

    @property
    def possible(self) -> bool:
        return "--engine latex" not in self.line or shutil.which("pdflatex") is not None


def commands(document: str) -> Iterator[Command]:
    for block in fences(document, "console"):
        shown = re.split(r"^\$ ", block, flags=re.MULTILINE)
        assert shown[0] == "", f"a console block begins with a command: {block}"
        for one in shown[1:]:
            line, *output = one.splitlines()
            yield Command(line, tuple(output))


def agrees(shown: Sequence[str], printed: Sequence[str]) -> bool:
    """Return True if the lines match the output; `…` stands for any text, or for any lines if alone on its line.

    Columns may be wider or narrower: blanks between words count as two.
    """
    if not shown:
        return not printed
    if shown[0] == "…":
        return any(agrees(shown[1:], printed[start:]) for start in range(len(printed) + 1))
    if not printed:
        return False
    wanted, line = (re.sub(r"(?<=\S) {2,}", "  ", text.rstrip()) for text in (shown[0], printed[0]))
    pattern = re.sub(r"[*?[]", r"[\g<0>]", wanted).replace("…", "*")
    return fnmatchcase(line, pattern) and agrees(shown[1:], printed[1:])


def run(lines: Sequence[str], place: Path) -> list[tuple[list[str], int]]:
    """Return each command's output in one shell that knows `reportgen` and `python`, and its exit code.

    `$?` passes from one to the next.
    """
    programs = place / ".programs"
    programs.mkdir(exist_ok=True)
    for name, arguments in (("reportgen", "-m reportgen.cli"), ("python", "")):
        program = programs / name
        program.write_text(f'#!/bin/sh\nexec "{sys.executable}" {arguments} "$@"\n', encoding="utf-8")
        program.chmod(0o755)
    mark = "\x1e"
    script = "".join(f"(exit $status)\n{line}\nstatus=$?; printf '{mark}%s{mark}' $status\n" for line in lines)
    done = subprocess.run(
        ["sh", "-c", "status=0\n" + script],
        cwd=place,
        env={
            **os.environ,
            "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
            "PYTHONPATH": str(place),
            "COLUMNS": "100",
        },
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        encoding="utf-8",
        timeout=300,
        check=True,
    )
    outputs, codes = done.stdout.split(mark)[:-1:2], done.stdout.split(mark)[1::2]
    return [(output.strip("\n").splitlines(), int(code)) for output, code in zip(outputs, codes, strict=True)]


def copy_of_repository(place: Path) -> Path:
    """Copy the package with its compiled files, since each command is a process that would compile it again."""
    for name in ("reportgen", "templates", "assignments"):
        # What another process is about to write has a name that will be gone.
        shutil.copytree(ROOT / name, place / name, ignore=shutil.ignore_patterns("*.pyc.*"))
    for name in ("Makefile", "pyproject.toml", "requirements-dev.lock"):
        shutil.copy(ROOT / name, place)
    (place / "out").mkdir()
    return place


def follow(document: str, place: Path) -> list[str]:
    """Write the files that a document prints and run its commands in order; return the differences."""
    for name, content in _FILE.findall(text_of(document)):
        file = place / name
        assert not file.exists(), f"{name} is there already"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(content, encoding="utf-8")
    shown = [command for command in commands(document) if command.possible]
    printed = run([command.runnable for command in shown], place)
    return [
        "\n".join((f"$ {command.line}", *output))
        for command, (output, code) in zip(shown, printed, strict=True)
        if not (code == 0 if command.is_make else agrees(command.output, output))
    ]


def lint(place: Path, *files: str) -> str:
    """Return the style and type errors of `make lint` for new or changed files, "" if there are none."""
    if (known := ROOT / ".mypy_cache").is_dir():
        # Where types were checked before, only these files are new.
        shutil.copytree(known, place / known.name, dirs_exist_ok=True)
    code = [file for file in files if file.startswith("reportgen/")]
    checks = (("ruff", "format", "--check", *files), ("ruff", "check", *files), ("mypy", *code))
    done = [
        subprocess.run([sys.executable, "-m", *check], cwd=place, capture_output=True, text=True, check=False)
        for check in checks
    ]
    return "".join(one.stdout + one.stderr for one in done if one.returncode)


# --- what is shown is so --------------------------------------------------------------------------


@pytest.mark.parametrize("page", matrix([page for page in PAGES if fences(page, "console")], TELLING))
def test_the_commands_of_a_page_print_what_it_shows(page: str, tmp_path: Path) -> None:
    assert follow(page, copy_of_repository(tmp_path)) == []


def test_no_command_is_run_on_two_pages() -> None:
    lines = [{command.line for command in commands(page) if command.line.startswith("reportgen")} for page in PAGES]
    assert sum(map(len, lines)) == len(set().union(*lines))


@pytest.mark.proof
def test_a_machine_added_as_described_has_its_report(tmp_path: Path) -> None:
    place = copy_of_repository(tmp_path)
    assert follow("CONTRIBUTING.md", place) == []
    first = json.loads((place / "plunger-pump.json").read_text(encoding="utf-8"))["positions"][0]
    assert "reactions" not in first
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "tests/textbook/test_plunger_pump.py"],
        cwd=place,
        env={**os.environ, "PYTHONPATH": str(place)},
        check=False,
    )
    assert done.returncode == 0
    assert lint(place, "reportgen/catalogue/plunger_pump.py", "tests/textbook/test_plunger_pump.py") == ""
    shutil.copy(ROOT / "ARCHITECTURE.md", place)
    assert house.main(place) == 0


MISTAKEN = """
from reportgen.base.template_folders import search_path
from reportgen.base.words import load_words
from reportgen.marking.judging import mark
from reportgen.marking.mistakes import mistakes_in
from tests.marking import students

scheme = students.scheme("slider-crank-01")
made = [one for id in scheme.ledger.families for one in mistakes_in(scheme, id, {}) if one.name == "cosine-for-sine"]
for mistake in made:
    world = students.worked_out(scheme, mistake)
    if students.effect(scheme, world) is not None:
        named = {cell.mistake for cell in mark(scheme, students.written(scheme, world)).first_errors}
        print(mistake.where, *named)
for language in ("en", "vi"):
    words = load_words(search_path(language))
    print(words["mistakes"]["cosine-for-sine"], words["mistake_names"]["cosine-for-sine"], sep=": ")
"""
"""Names in the marking for the mistake of the test students, who use the cosine for the sine wherever it shows."""


@proof
def test_a_mistake_added_as_described_is_named(tmp_path: Path) -> None:
    place = copy_of_repository(tmp_path)
    shown = section(text_of("docs/extending.md"), "## A mistake")
    code, *words = [body for name, body in _FENCE.findall(shown) if name in ("python", "yaml")]
    changed = place / "reportgen/marking/mistakes.py"
    head, end, rest = changed.read_text(encoding="utf-8").partition("\n\n\ndef _with_a_wrong_input(")
    changed.write_text(f"{head}\n{code.rstrip()}{end}{rest}", encoding="utf-8")
    for language, lines in zip(("en", "vi"), words, strict=True):
        file = place / "templates" / language / "words.yaml"
        text = file.read_text(encoding="utf-8")
        for table, line in re.findall(r"^(\w+:\n)(  .+\n)", lines, re.MULTILINE):
            assert text.count(f"\n{table}") == 1
            text = text.replace(f"\n{table}", f"\n{table}{line}")
        file.write_text(text, encoding="utf-8")
    assert lint(place, str(changed.relative_to(place))) == ""
    done = subprocess.run(
        [sys.executable, "-c", MISTAKEN],
        cwd=place,
        env={**os.environ, "PYTHONPATH": f"{place}{os.pathsep}{ROOT}"},
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=True,
    )
    *named, english, vietnamese = done.stdout.splitlines()
    assert named
    assert all("cosine-for-sine" in line.split() for line in named), named
    assert (english.split(": ")[1], vietnamese.split(": ")[1]) == ("cosine for sine", "cos thay sin")


WORN = """
import json
from pathlib import Path

from reportgen import api, catalogue
from reportgen.base.field_words import field_words
from reportgen.base.translation_coverage import is_whole
from reportgen.cases import opened
from reportgen.formula import ids
from reportgen.marking.judging import mark
from reportgen.marking.mistakes import mistakes_in
from reportgen.marking.marking_scheme import marking_scheme
from tests.marking import students

names = ("slider-crank-worn", "unloaded", "dense", "coarse")
file, unloaded, dense, coarse = (Path(f"worn/{name}.yaml") for name in names)
text = file.read_text(encoding="utf-8")
unloaded.write_text("".join(line for line in text.splitlines(True) if "force:" not in line), encoding="utf-8")
dense.write_text(text.replace("parameters:", "positions: {count: 360}\\nparameters:"), encoding="utf-8")
rising = text.replace("[1000, 1000]", "[0, 2000]").replace("[-1000, -1000]", "[-2000, 0]").replace("[3]", "all")
coarse.write_text(rising.replace("parameters:", "positions: {count: 24}\\nparameters:"), encoding="utf-8")
found = {}
for language in ("en", "vi"):
    case = opened(api.load(file, language))
    (fault,) = catalogue.check(unloaded, language)
    found[language] = {
        "document": repr(case.document()),
        "key": [[row.what, row.part] for row in marking_scheme(case).key.rows if row.id == "wear.p.12"],
        "field": field_words("slider-crank", language)["parameters.wear.pins.k"].whole,
        "fault": [fault.code, fault.message, fault.hint],
    }
found["partial"] = [[one.code, one.location.line] for one in catalogue.check(file, "ru")]
found["whole"] = is_whole("ru", "slider-crank")
found["results"], found["dense"] = api.solve(api.load(file)), api.solve(api.load(dense))


def first_errors(scheme, world):
    marked = mark(scheme, students.written(scheme, world))
    return sorted({f"{cell.id} {cell.mistake}" for cell in marked.first_errors})


scheme = marking_scheme(opened(api.load(file)))
found["right"] = first_errors(scheme, students.worked_out(scheme))
(change,) = (one for one in mistakes_in(scheme, "wear.p.12", {}) if one.name == "radius-for-diameter")
found["mistake"] = first_errors(scheme, students.worked_out(scheme, change))
scheme = marking_scheme(opened(api.load(coarse)))
by_positions = scheme.ledger.evaluate({ids.rest(id): 0.0 for id in ("wear.pv.01", "wear.pv.12")})
found["asked"] = [row.id for row in scheme.key.asked]
found["off"] = float(by_positions["wear.h.12"].real[0] / scheme.ledger["wear.h.12"].values.real[0] - 1)
found["positions"] = first_errors(scheme, by_positions)
print(json.dumps(found))
"""
"""Lines about the wear of pins in the reports, the key, the results and the marks."""


@proof
def test_a_topic_added_as_described_is_in_all_that_is_made(tmp_path: Path) -> None:
    place = copy_of_repository(tmp_path)
    files = dict(_FILE.findall(section(text_of("docs/extending.md"), "## A topic of a machine")))
    for name, content in files.items():
        (place / name).parent.mkdir(exist_ok=True)
        (place / name).write_text(content, encoding="utf-8")
    assert lint(place, *(name for name in files if name.endswith(".py"))) == ""
    done = subprocess.run(
        [sys.executable, "-c", WORN],
        cwd=place,
        env={**os.environ, "PYTHONPATH": f"{place}{os.pathsep}{ROOT}"},
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    for language, title, key, field, fault in (
        ("en", "Wear of the pins", "pressure between link 1 and link 2", "wear factor", "nothing loads the pins"),
        ("vi", "Mòn chốt", "áp suất giữa khâu 1 và khâu 2", "hệ số mòn", "không có tải nào"),
    ):
        said = found[language]
        assert title in said["document"]
        assert "tab.wear" in said["document"]
        ((what, chapter),) = said["key"]
        assert (what, chapter) == (key, "wear")
        assert said["field"] == field
        assert said["fault"][0] == "wear-without-loads"
        assert said["fault"][1].startswith(fault)
        assert said["fault"][2]
    assert found["partial"] == [["language-partial", 9]]
    assert found["whole"]
    _pressures_follow_the_reactions(found["results"], found["dense"])
    assert "wear.h.12" in found["asked"]
    assert 0.05 < abs(found["off"]) < 0.1
    assert (found["right"], found["positions"]) == ([], [])
    assert found["mistake"] == ["wear.p.12 radius-for-diameter"]


def _pressures_follow_the_reactions(results: Any, dense: Any) -> None:
    """Check p = R/(2rb) at each position, and h = k · 2π/ω₁ times the mean of p·v by the rectangle rule."""
    pins = {"01": (0.020, 0.040), "12": (0.015, 0.030)}
    for entry in results["positions"]:
        for joint, (r, b) in pins.items():
            expected = math.hypot(*entry["reactions"][f"R{joint}"]) / (2 * r * b)
            assert entry["wear"][f"p{joint}"] == pytest.approx(expected, rel=1e-12)
        assert entry["wear"]["v12"] == pytest.approx(0.015 * abs(entry["links"]["2"]["omega"] - 10), rel=1e-12)
    for joint in pins:
        rates = [entry["wear"][f"p{joint}"] * entry["wear"][f"v{joint}"] for entry in dense["positions"]]
        depth = 1e-15 * sum(rates) / len(rates) * 2 * math.pi / 10
        # The rule is off by (2π/360)² at the corners of p, of its size at most.
        assert results["wear"][f"h{joint}"] == pytest.approx(depth, rel=3e-4)


@pytest.mark.parametrize(
    ("what", "document", "heading", "count"),
    [
        ("| a machine", "CONTRIBUTING.md", "## A machine", 5),
        ("| [a topic", "docs/extending.md", "## A topic of a machine", 8),
        ("| [a kind of work", "docs/extending.md", "## A kind of work that is no machine", 4),
    ],
)
def test_what_is_added_has_the_files_that_the_table_says(what: str, document: str, heading: str, count: int) -> None:
    """The page has the stated number of files, prints them all, and no existing file mentions them."""
    (row,) = (line for line in text_of("CONTRIBUTING.md").splitlines() if line.startswith(what))
    _, _, new, changed, _ = row.split("|")
    files = re.findall(r"`([\w/.-]+)`", new)
    own = ("jacks/", "worn/")
    printed = [name for name, _ in _FILE.findall(section(text_of(document), heading)) if not name.startswith(own)]
    assert sorted(files) == sorted(printed)
    assert len(files) == count
    assert changed.strip() == "none"


@pytest.mark.parametrize(
    ("document", "file"),
    [
        ("CONTRIBUTING.md", "reportgen/catalogue/plunger_pump.py"),
        ("docs/extending.md", "reportgen/screw/screw_jack.py"),
        ("docs/extending.md", "reportgen/screw/screw_ids.py"),
    ],
)
def test_the_example_machine_and_kind_of_work_are_clean(document: str, file: str) -> None:
    code = dict(_FILE.findall(text_of(document)))[file]
    # The project's own rules; the file's name tells ruff which of them hold for it.
    done = subprocess.run(
        [sys.executable, "-m", "ruff", "check", "--config", ROOT / "pyproject.toml", "--stdin-filename", "a.py", "-"],
        input=code,
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_school_overrides_one_section(tmp_path: Path) -> None:
    (words,) = [content for name, content in _FILE.findall(text_of("docs/templates.md")) if "my-school" in name]
    root = tmp_path / "templates"
    shutil.copytree(ROOT / "templates" / "en", root / "en")
    (root / "my-school").mkdir()
    (root / "my-school" / "en.md").write_text(words, encoding="utf-8")
    prose = Prose(search_path("en", "engine-twin", school="my-school", root=root))
    names = {"machine_title": "A_B & *engine*", "signature": ()}
    foreword = repr(prose.render("foreword", names))
    assert "A_B & *engine*" in foreword
    assert "This report presents" not in foreword
    assert prose.places[1:] == search_path("en", "engine-twin", root=root)


@proof
def test_the_script_runs(tmp_path: Path) -> None:
    place = copy_of_repository(tmp_path)
    (script,) = fences("docs/results.md", "python")
    (place / "script.py").write_text(script, encoding="utf-8")
    (torque, report), _ = run(["python script.py"], place)[0]
    assert torque.startswith("-342.07")
    assert (place / report).read_bytes().startswith(b"%PDF")


# --- nothing is forgotten -------------------------------------------------------------------------


def test_the_readme_begins_with_the_two_commands_and_a_page() -> None:
    text = text_of("README.md")
    places = [text.index(part) for part in ("$ make report", "$ make test", "![", "## ")]
    assert places == sorted(places)


def test_the_readme_is_read_in_five_minutes() -> None:
    """It has 900 to 1200 words and three pictures; the table of speed has the measured values, in six rows."""
    text = text_of("README.md")
    assert 900 <= len(text.split()) <= 1200
    assert text.count("![") == 3
    assert len(re.findall(r"^\| .+ \|$", section(text, "## Speed"), re.MULTILINE)) == 2 + 6


def test_every_command_is_explained_with_its_options() -> None:
    rows = text_of("docs/commands.md").splitlines()
    for name, command in vars(typer.main.get_command(app))["commands"].items():
        (row,) = [row for row in rows if re.match(rf"\| `reportgen {name}\b", row)]
        options = [name for parameter in command.params for name in parameter.opts if name.startswith("-")]
        assert all(option in row for option in options if option != "--help")


def test_every_machine_is_shown_and_all_its_keys_are_explained() -> None:
    text = text_of("docs/machines.md")
    for kind in kinds():
        row = rf"^\| \[`{kind}`\]\(#{kind}\) \| !\[[^\]]+\]\({kind}\.png\) \| "
        assert re.search(row, text, re.MULTILINE)
        explained = section(text, "## Keys of several kinds") + section(text, f"## `{kind}`")
        for name, field in catalogue.kind(kind).parameters.model_fields.items():
            assert f"`{field.alias or name}`" in explained, (kind, name)
    (row,) = [line for line in text.splitlines() if line.startswith("| `flywheel` |")]
    with_flywheel = {kind for kind in kinds() if "flywheel" in catalogue.kind(kind).parameters.model_fields}
    assert set(re.findall(r"`([a-z-]+)`", row)) - {"flywheel"} == with_flywheel


def test_tables_of_keys_are_written_of_the_words() -> None:
    """`make pictures` has written them, so nothing is written twice."""
    spec = importlib.util.spec_from_file_location("keys", ROOT / "docs" / "keys.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert module.written(text_of("docs/machines.md")) == text_of("docs/machines.md")


def test_every_key_of_the_results_is_explained() -> None:
    text = text_of("docs/results.md")
    results = api.solve(api.load(ROOT / "assignments" / "engine-twin-05.yaml"))
    for key in (*results, *results["positions"][0]):
        assert f"`{key}`" in text, key


def test_every_page_is_linked_from_the_readme() -> None:
    assert {page for page in DOCUMENTS if page != "README.md"} <= set(_LINK.findall(text_of("README.md")))


def test_the_one_command_that_installs_tex_is_given() -> None:
    assert fences("docs/commands.md", "sh") == [f"{pdflatex.INSTALL}\n"]


@pytest.mark.parametrize("document", DOCUMENTS)
def test_links_lead_somewhere(document: str) -> None:
    for link in _LINK.findall(text_of(document)):
        if re.match(r"https?:", link):
            continue
        name, _, anchor = link.partition("#")
        target = (ROOT / document).parent / name if name else ROOT / document
        assert target.is_file(), link
        if anchor:
            titles = re.findall(r"^#+ (.+)$", target.read_text(encoding="utf-8"), re.MULTILINE)
            anchors = [re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles]
            assert anchor in anchors, link


@pytest.mark.parametrize(
    "picture", sorted([*(ROOT / "docs").glob("*.png"), *(ROOT / "docs").glob("*.gif")]), ids=lambda path: path.name
)
def test_pictures_are_small_and_used(picture: Path) -> None:
    assert picture.stat().st_size <= (LARGEST_MOVING if picture.suffix == ".gif" else LARGEST_PICTURE)
    shown = [text_of("README.md").replace("(docs/", "("), *(text_of(page) for page in PAGES[1:])]
    assert any(f"({picture.name})" in text for text in shown)


@pytest.mark.parametrize("document", DOCUMENTS)
def test_files_that_are_named_exist(document: str) -> None:
    text = text_of(document)
    printed = {name for other in DOCUMENTS for name, _ in _FILE.findall(text_of(other))}
    for name in set(re.findall(r"`((?:reportgen|templates|tests|assignments|docs)/[\w./-]+)`", text)) - printed:
        assert (ROOT / name).exists(), name


@pytest.mark.parametrize("document", DOCUMENTS)
def test_targets_of_make_that_are_named_exist(document: str) -> None:
    targets = set(re.findall(r"^(\w+):", text_of("Makefile"), re.MULTILINE))
    named = set(re.findall(r"(?:`|^\$ )make (\w+)", text_of(document), re.MULTILINE))
    assert named <= targets


def test_types_that_are_named_exist() -> None:
    code = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "reportgen").rglob("*.py"))
    for name in set(re.findall(r"`([A-Z][a-z][A-Za-z]*)s?`", text_of("ARCHITECTURE.md"))):
        assert re.search(rf"^class {name}\b", code, re.MULTILINE), name


def test_the_architecture_places_every_part() -> None:
    text = text_of("ARCHITECTURE.md")
    parts = [path for path in (ROOT / "reportgen").iterdir() if not path.name.startswith("_")]
    for part in parts:
        # A package that was renamed leaves a folder with what was compiled of it.
        if (part / "__init__.py").is_file() or part.suffix == ".py":
            assert f"`reportgen/{part.name}" in text, part.name


# --- the tools of this file -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("shown", "printed", "same"),
    [
        (["a"], ["a  "], True),
        (["a"], ["a", "b"], False),
        (["a", "…"], ["a", "b", "c"], True),
        (["a", "…", "c"], ["a", "c"], True),
        (["a", "…", "c"], ["a", "b"], False),
        (["x = … m"], ["x = 1.5 m"], True),
        (["[a]"], ["a"], False),
        (["a*"], ["ab"], False),
        (["a  b"], ["a     b"], True),
        (["  a"], ["a"], False),
        ([], ["a"], False),
    ],
)
def test_shown_and_printed_lines(shown: list[str], printed: list[str], same: bool) -> None:
    assert agrees(shown, printed) is same
