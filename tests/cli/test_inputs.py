"""No command writes over what it reads or what was edited: it says so in a line, before anything is computed."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from reportgen import api
from reportgen.base.files import overwritten
from reportgen.classes import batch_run, class_marking, variants
from reportgen.cli import app
from tests.classes.classes import tree
from tests.classes.specs import BARS

ROOT = Path(__file__).parents[2]
SAMPLE = ROOT / "assignments" / "four-bar-02.yaml"
POLICY = ROOT / "assignments" / "class-demo" / "policy.yaml"
ROSTER = "id,name\nK1,An\nK2,Ba\n"


def command(*arguments: object) -> Result:
    return CliRunner().invoke(app, list(map(str, arguments)))


@pytest.fixture
def _idle(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing may be computed."""

    def busy(*_: object, **__: object) -> None:
        pytest.fail("computed")

    for room, name in (
        (api, "opened"),
        (api, "open_case"),
        (class_marking, "grade"),
        (batch_run, "run_batch"),
        (variants, "_efforts"),
    ):
        monkeypatch.setattr(room, name, busy)


# --- new --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("language", "words"), [("vi", "đã có tệp này"), ("en", "this file already exists")])
def test_new_leaves_an_edited_file_alone(tmp_path: Path, language: str, words: str) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text("my own")
    done = command("new", "shaper", "-o", file, "--lang", language)
    assert (done.exit_code, done.stdout) == (1, "")
    assert f"{file}:1:1: error[already-there]: {words}" in done.stderr
    assert file.read_text() == "my own"
    assert command("new", "shaper", "-o", file, "--force").exit_code == 0
    assert command("new", "shaper").stdout == file.read_text(encoding="utf-8")


# --- inputs -----------------------------------------------------------------------------------------

Name = Callable[[Path], Path]


def by_link(file: Path) -> Path:
    (file.parent / "link").symlink_to(file)
    return file.parent / "link"


def by_second_name(file: Path) -> Path:
    os.link(file, file.parent / "twin")
    return file.parent / "twin"


def by_way(file: Path) -> Path:
    (file.parent / "there").mkdir()
    return file.parent / "there" / ".." / "." / file.name


def by_folder(file: Path) -> Path:
    (file.parent / "there").symlink_to(file.parent)
    return file.parent / "there" / file.name


def by_case(file: Path) -> Path:
    return file.with_name(file.name.swapcase())


@pytest.mark.usefixtures("_idle")
@pytest.mark.parametrize("name", [Path, by_link, by_second_name, by_way, by_folder, by_case])
def test_results_are_not_written_over_the_assignment(tmp_path: Path, name: Name) -> None:
    file = Path(shutil.copy(SAMPLE, tmp_path / "me.yaml"))
    output, before = name(file), tree(tmp_path)
    done = command("solve", file, "--json", output, "--lang", "en")
    assert (done.exit_code, done.stdout) == (1, "")
    assert f"{output}:1:1: error[is-input]: the output would overwrite" in done.stderr
    assert tree(tmp_path) == before


TEXTS = {
    "file": SAMPLE.read_text(encoding="utf-8"),
    "policy": POLICY.read_text(encoding="utf-8"),
    "spec": BARS,
    "class": ROSTER,
}


@pytest.mark.usefixtures("_idle")
@pytest.mark.parametrize(
    ("line", "read"),
    [
        ("build report/report.html --out .", "report/report.html:file"),
        ("build report/report.typ --out .", "report/report.typ:file"),
        ("sheet sheet-9/sheet-9.PDF --out .", "sheet-9/sheet-9.PDF:file"),
        ("sheet me.yaml --block me/sheet-7.dxf --out .", "me.yaml:file me/sheet-7.dxf:policy"),
        ("watch report/report.pdf --pdf --no-open --out .", "report/report.pdf:file"),
        ("solve results/results.csv --format csv --out .", "results/results.csv:file"),
        ("key me.yaml --policy me/key.json --out .", "me.yaml:file me/key.json:policy"),
        ("variants spec.yaml variants.csv -o .", "spec.yaml:spec variants.csv:class"),
        ("variants K1.yaml r.csv -o . --force", "r.csv:class K1.yaml:spec"),
        ("batch manifest.json --spec s.yaml --out .", "s.yaml:spec manifest.json:class"),
        ("batch a/key.xlsx --assignments . --out .", "a/key.xlsx:class"),
        ("grade s --assignments . --out s", "s/K1/feedback.xlsx:class"),
        ("grade feedback.zip --assignments . --out .", "feedback.zip:class"),
        ("grade s.csv --assignments . --roster grades.csv --out .", "grades.csv:class"),
        ("grade filled-g.csv --assignments . --gradebook g.csv --out .", "g.csv:class filled-g.csv:class"),
    ],
)
def test_no_command_writes_over_its_inputs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, line: str, read: str
) -> None:
    """The last of the files that it reads would be lost."""
    monkeypatch.chdir(tmp_path)
    for name, kind in (one.split(":") for one in read.split()):
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_text(TEXTS[kind], encoding="utf-8")
    before = tree(tmp_path)
    done = command(*line.split(), "--lang", "en")
    assert (done.exit_code, done.stdout) == (1, "")
    assert f"{name}:1:1: error[is-input]: the output would overwrite" in done.stderr
    assert tree(tmp_path) == before


def test_a_fault_speaks_the_language_of_the_file(tmp_path: Path) -> None:
    file = tmp_path / "me.yaml"
    text = SAMPLE.read_text(encoding="utf-8").replace("language: vi", "language: en")
    file.write_text(text, encoding="utf-8")
    words = "the output would overwrite" if "language: en" in text else "kết quả sẽ ghi đè"
    assert words in command("solve", file, "--json", file).stderr


def test_other_files_are_no_inputs(tmp_path: Path) -> None:
    file = Path(shutil.copy(SAMPLE, tmp_path / "me.yaml"))
    others = [tmp_path / "me.json", tmp_path / "none" / "me.yaml", tmp_path / "me.yaml" / "me.yaml"]
    assert list(overwritten(others, [file, tmp_path / "none"])) == []
    assert command("solve", file, "--json", tmp_path / "me.json").exit_code == 0


@pytest.mark.parametrize("line", ["new four-bar -o {file}", "solve {sample} --json {file}"])
def test_a_missing_folder_of_an_output_is_created(tmp_path: Path, line: str) -> None:
    file = tmp_path / "not" / "there" / "x.out"
    assert command(*(part.format(file=file, sample=SAMPLE) for part in line.split())).exit_code == 0
    assert file.stat().st_size > 1000
