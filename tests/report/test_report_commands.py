"""`build` when something fails: the code, one line that says what helps, nothing half-written."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from reportgen.base.provenance import RECORD
from reportgen.writers.pdflatex import INSTALL
from tests.commands import Done, reportgen
from tests.report import built

SAMPLE = built.ROOT / "assignments" / "slotted-lever-01.yaml"
"""A report that is soon made."""
OLD = b"the report of yesterday"


def build(*arguments: object, path: str = os.environ["PATH"]) -> Done:
    return reportgen("build", *arguments, "--lang", "en", PATH=path)


@pytest.fixture
def finished(tmp_path: Path) -> Path:
    """A folder of reports with one of an earlier build."""
    folder = tmp_path / "out" / SAMPLE.stem
    folder.mkdir(parents=True)
    (folder / "report.pdf").write_bytes(OLD)
    return tmp_path / "out"


def files(folder: Path) -> dict[str, bytes]:
    """What a user sees there: not the record of what was made."""
    shown = (path for path in folder.rglob("*") if path.is_file() and path.name != RECORD)
    return {str(path.relative_to(folder)): path.read_bytes() for path in shown}


def test_a_missing_tex_is_told_with_its_remedy_and_leaves_the_old_report(finished: Path, tmp_path: Path) -> None:
    empty = tmp_path / "bin"
    empty.mkdir()
    done = build(SAMPLE, "--out", finished, "--engine", "latex", "--keep-source", path=str(empty))
    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr.startswith("reportgen: ")
    assert INSTALL in done.stderr
    assert files(finished) == {f"{SAMPLE.stem}/report.pdf": OLD}


@built.needs_tex
def test_a_typesetter_that_fails_leaves_the_old_report(finished: Path, tmp_path: Path) -> None:
    program = tmp_path / "bin" / "pdflatex"
    program.parent.mkdir()
    program.write_text("#!/bin/sh\nexit 1\n", encoding="utf-8")
    program.chmod(0o755)
    done = build(SAMPLE, "--out", finished, "--engine", "latex", path=f"{program.parent}:{os.environ['PATH']}")
    assert (done.returncode, done.stdout) == (3, "")
    assert files(finished) == {f"{SAMPLE.stem}/report.pdf": OLD}


def test_a_faulty_assignment_leaves_the_old_report(finished: Path, tmp_path: Path) -> None:
    faulty = tmp_path / SAMPLE.name
    faulty.write_text(SAMPLE.read_text(encoding="utf-8").replace("count: 12", "count: 0"), encoding="utf-8")
    done = build(faulty, "--out", finished)
    assert (done.returncode, done.stdout) == (1, "")
    assert f"{faulty}:" in done.stderr
    assert files(finished) == {f"{SAMPLE.stem}/report.pdf": OLD}


def test_a_folder_that_is_none_ends_with_3(tmp_path: Path) -> None:
    """A file where the folder should be: refused for every user, the administrator too."""
    file = tmp_path / "out"
    file.write_bytes(OLD)
    done = build(SAMPLE, "--out", file)
    assert (done.returncode, done.stdout) == (3, "")
    assert len(done.stderr.splitlines()) == 1
    assert str(file) in done.stderr
    assert files(tmp_path) == {"out": OLD}


@pytest.mark.skipif(os.geteuid() == 0, reason="the administrator may write everywhere")
def test_a_folder_without_permission_ends_with_3(finished: Path) -> None:
    folder = finished / SAMPLE.stem
    folder.chmod(0o500)
    done = build(SAMPLE, "--out", finished, "--keep-source")
    folder.chmod(0o700)
    assert (done.returncode, done.stdout) == (3, "")
    assert files(finished) == {f"{SAMPLE.stem}/report.pdf": OLD}


def test_one_faulty_file_does_not_stop_the_others(tmp_path: Path) -> None:
    done = build(tmp_path / "none.yaml", SAMPLE, "--out", tmp_path / "out")
    assert done.returncode == 1
    assert done.stdout.splitlines() == [str(tmp_path / "out" / SAMPLE.stem / "report.pdf")]
    assert set(files(tmp_path / "out")) == {f"{SAMPLE.stem}/report.pdf"}


def test_a_report_replaces_the_one_before(finished: Path) -> None:
    assert build(SAMPLE, "--out", finished).returncode == 0
    (pdf,) = files(finished).values()
    assert pdf.startswith(b"%PDF-")
    assert pdf.rstrip().endswith(b"%%EOF")
