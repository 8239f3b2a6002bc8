"""A sheet that takes too long or too much memory to read is told as its student's fault; the others are marked."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

from reportgen.base.errors import Problem
from reportgen.base.process_limits import Limits
from reportgen.base.words import SPOKEN
from reportgen.classes import reading_sheets as sheets
from reportgen.classes.platforms import Handed
from reportgen.cli import app
from tests.lanes import proof
from tests.marking import demo

GREEDY = '"x",' * 19 + '"x"\n'
"""A row of a table; as many as are allowed take a hundred times the time and memory of a filled sheet."""
ROWS = 9_999


@pytest.fixture
def handed(tmp_path: Path) -> list[Path]:
    """A sheet, a greedy file, another sheet."""
    files = [shutil.copy(demo.SHEETS / f"{id}.csv", tmp_path) for id in ("K225520103004", "K225520103012")]
    greedy = tmp_path / "K225520103007.csv"
    greedy.write_text(GREEDY * ROWS, encoding="utf-8")
    return [Path(files[0]), greedy, Path(files[1])]


@proof
@pytest.mark.parametrize(
    "limits", [Limits(seconds=0.4, megabytes=1000), Limits(seconds=60, megabytes=24)], ids=["time", "memory"]
)
def test_a_greedy_sheet_is_given_up(handed: list[Path], limits: Limits, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sheets, "LIMITS", limits)
    found = list(sheets.read_sheets(map(Handed, handed), "en"))
    assert [one.path for one, _ in found] == handed
    first, greedy, last = (pages for _, pages in found)
    assert isinstance(greedy, list)
    assert [(problem.code, problem.location.file) for problem in greedy] == [("sheet-beyond-limits", str(handed[1]))]
    assert isinstance(first, tuple)
    assert isinstance(last, tuple)


@proof
def test_the_rest_of_a_class_is_marked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The file's name and the limits are told, the exit code is that of a file that cannot be read."""
    given, variants, out = tmp_path / "given", tmp_path / "variants", tmp_path / "out"
    given.mkdir()
    for id in ("K225520103004", "K225520103012"):
        shutil.copy(demo.SHEETS / f"{id}.csv", given)
    (given / "K225520103007.csv").write_text(GREEDY * ROWS, encoding="utf-8")
    run = CliRunner().invoke
    made = run(app, ["variants", str(demo.DEMO / "spec.yaml"), str(demo.DEMO / "roster.csv"), "-o", str(variants)])
    assert made.exit_code == 0
    monkeypatch.setattr(sheets, "LIMITS", Limits(seconds=60, megabytes=24))
    result = run(app, ["grade", str(given), "--assignments", str(variants), "--out", str(out), "--lang", "en"])
    assert result.exit_code == 1
    assert "K225520103007.csv:1:1: error[sheet-beyond-limits]: it cannot be read within 60 s and 24 MB" in result.output
    assert {path.name for path in out.iterdir() if path.is_dir()} == {"K225520103004", "K225520103012"}


def test_a_sheet_is_told_in_the_language_of_its_own_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The server that reading processes are forked from lives on, with the environment in which it was started."""
    told = []
    for language in ("vi", "en"):
        monkeypatch.setenv(SPOKEN, language)
        ((_, problems),) = sheets.read_sheets([Handed(tmp_path / "none.csv")], None)
        assert isinstance(problems[0], Problem)
        told.append(problems[0].message)
    assert [text.partition(":")[0] for text in told] == ["không đọc được tệp", "the file cannot be read"]
