"""The examples of the documentation work: commands print what is shown, files and code do what the text says."""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from reportgen.base.template_folders import search_path
from reportgen.document.template_rendering import Prose
from tests import house
from tests.documents import (
    FENCE,
    FILE,
    PAGES,
    ROOT,
    agrees,
    commands,
    copy_of_repository,
    fences,
    follow,
    lint,
    run,
    section,
    text_of,
)
from tests.lanes import matrix, proof

TELLING = ("README.md",)
"""Pages whose commands `make test` runs."""

RUN = [page for page in PAGES if fences(page, "console") and not re.match(r"docs/tutorials/.*\.vi\.md$", page)]
"""Pages whose commands are run; `make pictures` runs the Vietnamese tutorials, which show the same steps in words."""


@pytest.mark.parametrize("page", matrix(RUN, TELLING))
def test_the_commands_of_a_page_print_what_it_shows(page: str, tmp_path: Path) -> None:
    assert follow(page, copy_of_repository(tmp_path)) == []


def test_no_command_is_run_on_two_pages_of_reference() -> None:
    """A reference states a thing once; a tutorial may show it again."""
    pages = [page for page in PAGES if page.startswith("docs/reference/") and not page.endswith(".vi.md")]
    lines = [{command.line for command in commands(page) if command.line.startswith("reportgen")} for page in pages]
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
    shown = section(text_of("docs/developers/extending.md"), "## A mistake")
    code, *words = [body for name, body in FENCE.findall(shown) if name in ("python", "yaml")]
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
    files = dict(FILE.findall(section(text_of("docs/developers/extending.md"), "## A topic of a machine")))
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
        ("| [a topic", "docs/developers/extending.md", "## A topic of a machine", 8),
        ("| [a kind of work", "docs/developers/extending.md", "## A kind of work that is no machine", 4),
    ],
)
def test_what_is_added_has_the_files_that_the_table_says(what: str, document: str, heading: str, count: int) -> None:
    """The page has the stated number of files, prints them all, and no existing file mentions them."""
    (row,) = (line for line in text_of("CONTRIBUTING.md").splitlines() if line.startswith(what))
    _, _, new, changed, _ = row.split("|")
    files = re.findall(r"`([\w/.-]+)`", new)
    own = ("jacks/", "worn/")
    printed = [name for name, _ in FILE.findall(section(text_of(document), heading)) if not name.startswith(own)]
    assert sorted(files) == sorted(printed)
    assert len(files) == count
    assert changed.strip() == "none"


@pytest.mark.parametrize(
    ("document", "file"),
    [
        ("CONTRIBUTING.md", "reportgen/catalogue/plunger_pump.py"),
        ("docs/developers/extending.md", "reportgen/screw/screw_jack.py"),
        ("docs/developers/extending.md", "reportgen/screw/screw_ids.py"),
    ],
)
def test_the_example_machine_and_kind_of_work_are_clean(document: str, file: str) -> None:
    code = dict(FILE.findall(text_of(document)))[file]
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
    (words,) = [
        content for name, content in FILE.findall(text_of("docs/developers/templates.md")) if "my-school" in name
    ]
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
    *_, script = fences("docs/reference/python.md", "python")
    (place / "script.py").write_text(script, encoding="utf-8")
    (torque, report), _ = run(["python script.py"], place)[0]
    assert torque.startswith("-342.07")
    assert (place / report).read_bytes().startswith(b"%PDF")


# --- how lines are compared -----------------------------------------------------------------------


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
