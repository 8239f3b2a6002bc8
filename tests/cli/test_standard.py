"""`--standard`: what each command that makes a PDF keeps, and what it says of other words."""

from __future__ import annotations

import io
import json
import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from reportgen.base.errors import OutputWarning
from reportgen.base.template_folders import samples
from reportgen.classes.batch_run import Order, run_batch
from reportgen.cli import app
from tests.classes.classes import here, write_class
from tests.lanes import proof
from tests.report.built import ROOT
from tests.writers import tags

USUAL, NONE, OTHER = ("1", "2a"), ("", ""), ("", "2b")
SHORT = ROOT / "assignments" / "friction" / "incline.yaml"
"""An exercise of few pages."""


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, list(map(str, arguments)))


def kept(file: Path) -> tuple[str, str]:
    """The standards that a file names."""
    return tags.read(file.read_bytes()).standards


@pytest.mark.parametrize(
    ("command", "name"),
    [(("build",), "report.pdf"), (("key", "--format", "pdf"), "key.pdf"), (("sheet",), "sheet-1.pdf")],
)
def test_a_file_keeps_what_is_asked_for(command: tuple[str, ...], name: str, tmp_path: Path) -> None:
    for asked, found in (((), USUAL), (("--standard", "none"), NONE), (("--standard", "a-2b"), OTHER)):
        done = run(*command, SHORT, "--out", tmp_path, *asked)
        assert done.exit_code == 0, done.output
        assert kept(tmp_path / SHORT.stem / name) == found


def test_a_file_of_another_standard_is_stale(tmp_path: Path) -> None:
    """The page beside it is made anew of the usual ones."""
    run("build", SHORT, "--out", tmp_path, "--standard", "none")
    done = run("build", SHORT, "--out", tmp_path, "--format", "html")
    assert str(tmp_path / SHORT.stem / "report.pdf") in done.stderr
    assert not (tmp_path / SHORT.stem / "report.pdf").exists()


@pytest.mark.parametrize("wrong", ["a-2c", "none,ua-1", "", "PDF/A"])
@pytest.mark.parametrize("command", ["build", "sheet", "key"])
def test_another_word_is_wrong_usage(command: str, wrong: str, tmp_path: Path) -> None:
    done = run(command, SHORT, "--out", tmp_path, f"--standard={wrong}")
    assert done.exit_code == 2
    assert not list(tmp_path.iterdir())


def test_a_batch_keeps_what_is_asked_for_and_makes_anew_what_keeps_another(tmp_path: Path) -> None:
    roster, given = write_class(tmp_path, {"1": SHORT.read_text(encoding="utf-8")})
    out = tmp_path / "out"

    def batch(*asked: tuple[str, ...]) -> int:
        order = Order(
            roster, None, given, out, ("report", "key"), language="en", **({"standards": asked[0]} if asked else {})
        )
        return run_batch(order, io.StringIO(), pool=here).made

    assert (batch(), batch()) == (2, 0)
    assert kept(out / "1" / "report.pdf") == USUAL
    assert (batch(()), batch(())) == (2, 0)
    assert kept(out / "1" / "report.pdf") == kept(out / "1" / "key.pdf") == NONE
    entries = json.loads((out / "manifest.json").read_text(encoding="utf-8"))["students"]["1"]["products"]
    assert {entry["standards"] for entry in entries.values()} == {"none"}


@proof
def test_feedback_and_the_page_of_a_class_keep_what_is_asked_for(tmp_path: Path) -> None:
    demo = samples() / "class-demo"
    variants = tmp_path / "given"
    assert run("variants", demo / "spec.yaml", demo / "roster.csv", "--out", variants).exit_code == 0
    sheets = tmp_path / "sheets"
    sheets.mkdir()
    shutil.copy(next(path for path in sorted((demo / "sheets").iterdir()) if path.suffix == ".xlsx"), sheets)
    for asked, found in (((), USUAL), (("--standard", "none"), NONE)):
        out = tmp_path / f"out{len(asked)}"
        done = run("grade", sheets, "--assignments", variants, "--out", out, *asked)
        pdfs = list(out.rglob("*.pdf"))
        assert {path.name for path in pdfs} == {"feedback.pdf", "class.pdf"}, done.output
        assert {kept(path) for path in pdfs} == {found}


@pytest.mark.parametrize("school", ["", ", school: sample-school"])
def test_what_standards_refuse_is_made_without_and_told(school: str, tmp_path: Path) -> None:
    """No file keeps both of these.  Of a school the report is made in a process of its own."""
    file = tmp_path / "mine.yaml"
    text = SHORT.read_text(encoding="utf-8").replace("{language: vi", f"{{language: en{school}")
    file.write_text(text, encoding="utf-8")
    with pytest.warns(OutputWarning, match="PDF/A-4 and PDF/UA-1 are mutually incompatible"):
        done = run("build", file, "--out", tmp_path, "--standard", "a-4,ua-1")
    assert done.exit_code == 0
    assert kept(tmp_path / "mine" / "report.pdf") == NONE
