"""Names of assignment files that could not name a folder, or would name one elsewhere."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from reportgen.catalogue import check
from reportgen.cli import app
from tests.broken.rows import base

BAD = (
    "...yaml",
    "..yaml",
    "....yaml",
    " .yaml",
    "con.yaml",
    "LPT1.x.yaml",
    "a .yaml",
    " a.yaml",
    "a..yaml",
    "a\n.yaml",
)
GOOD = ("engine.twin.05.yaml", ".hidden.yaml", "Đề số 5.yaml", "console.yaml", "-x.yaml", "a.yml", "a")


@pytest.mark.parametrize("name", BAD)
def test_a_name_that_is_no_folder_is_a_fault(tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    file.write_text(base("engine-twin"), encoding="utf-8")
    assert [problem.code for problem in check(file, "en")] == ["file-name"]


@pytest.mark.parametrize("name", GOOD)
def test_an_ordinary_name_is_none(tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    file.write_text(base("engine-twin"), encoding="utf-8")
    assert check(file, "en") == []


@pytest.mark.parametrize("command", ["build", "key"])
def test_nothing_is_written_above_the_folder_of_results(tmp_path: Path, command: str) -> None:
    file, out = tmp_path / "...yaml", tmp_path / "sub" / "deep"
    file.write_text(base("engine-twin"), encoding="utf-8")
    result = CliRunner().invoke(app, [command, str(file), "--out", str(out)])
    assert result.exit_code == 1
    assert "file-name" in result.stderr
    assert sorted(tmp_path.iterdir()) == [file]
