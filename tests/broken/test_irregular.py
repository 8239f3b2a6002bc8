"""What is no regular file in place of an input is refused at once: nobody knows whether it ever ends."""

from __future__ import annotations

import os
import socket
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner

from reportgen.base.errors import AssignmentError, TemplateError
from reportgen.base.units import Language
from reportgen.base.words import load_words, sections
from reportgen.catalogue import check
from reportgen.classes.variants import _state
from reportgen.cli import app
from reportgen.document.template_rendering import Prose
from reportgen.workbook.table_reading import read
from tests.lanes import proof

ROOT = Path(__file__).parents[2]


def listening(path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as end:
        end.bind(str(path))


def device(path: Path) -> None:
    """A node of our own: nothing is done to one of the machine's, whatever goes wrong."""
    try:
        os.mknod(path, stat.S_IFCHR | 0o600, os.makedev(1, 5))
    except OSError:
        pytest.skip("nodes of devices are for administrators")


MADE: tuple[Callable[[Path], None], ...] = (os.mkfifo, listening, device)


@pytest.mark.parametrize(("language", "told"), [("vi", "đường ống (pipe)"), ("en", "it is a pipe")])
@pytest.mark.parametrize("make", MADE)
def test_inputs(
    make: Callable[[Path], None], language: Language, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The path of a socket must be short.
    monkeypatch.chdir(tmp_path)
    assignment, table = Path("a.yaml"), Path("a.csv")
    make(assignment)
    make(table)
    (fault,) = check(assignment, language)
    assert str(fault).startswith("a.yaml:1:1: error[unreadable]: ")
    assert told in fault.message
    with pytest.raises(AssignmentError, match=r"a\.csv:1:1: error\[unreadable\]: ") as refused:
        read(table, language)
    assert told in str(refused.value)
    with pytest.raises(OSError, match="no regular file"):
        _state(assignment, "", {}, force=False)


@pytest.mark.parametrize("language", ["en", "vi"])
@pytest.mark.parametrize("make", MADE)
def test_templates(
    make: Callable[[Path], None], language: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A school's words, wherever they are looked for."""
    monkeypatch.chdir(tmp_path)
    file = Path(f"{language}.md")
    make(file)
    told = {"en": "it is a pipe", "vi": r"đường ống \(pipe\)"}[language]
    for asking in (sections, lambda file: load_words((file,)), lambda file: Prose((file, common(language)))):
        with pytest.raises(TemplateError, match=rf"^{language}\.md:1:1: error\[unreadable\]: .*{told}"):
            asking(file)


def common(language: str) -> Path:
    return ROOT / "templates" / language


@pytest.mark.parametrize("make", MADE)
def test_a_title_block(make: Callable[[Path], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As any other input, though its name may also be that of a block of the program."""
    monkeypatch.chdir(tmp_path)
    make(Path("ours.yaml"))
    sample = ROOT / "assignments" / "slotted-lever-01.yaml"
    done = CliRunner().invoke(app, ["sheet", str(sample), "--block", "ours.yaml", "--lang", "en"])
    assert (done.exit_code, done.stdout) == (1, "")
    assert done.stderr.startswith("ours.yaml:1:1: error[unreadable]: the file cannot be read: it is a pipe")


@pytest.mark.parametrize(
    "command",
    [
        pytest.param(("check", "PIPE.yaml"), id="check"),
        pytest.param(("build", "PIPE.yaml"), id="build", marks=proof),
        pytest.param(("watch", "PIPE.yaml", "--no-open"), id="watch", marks=proof),
        pytest.param(("grade", "PIPE.xlsx", "--assignments", "assignments/rotor"), id="grade", marks=proof),
        pytest.param(("grade", "PIPE.csv", "--assignments", "assignments/rotor"), id="grade a table", marks=proof),
        pytest.param(
            ("grade", "none.xlsx", "--assignments", "assignments/rotor", "--policy", "PIPE.yaml"),
            id="policy",
            marks=proof,
        ),
        pytest.param(("batch", "PIPE.csv", "--assignments", "assignments/rotor"), id="roster", marks=proof),
        pytest.param(("variants", "PIPE.yaml", "PIPE.csv"), id="variants", marks=proof),
        pytest.param(("sheet", "assignments/slotted-lever-01.yaml", "--block", "PIPE.yaml"), id="block", marks=proof),
    ],
)
def test_commands(command: tuple[str, ...], tmp_path: Path) -> None:
    for suffix in ("yaml", "csv", "xlsx"):
        os.mkfifo(tmp_path / f"PIPE.{suffix}")
    arguments = [word.replace("PIPE", str(tmp_path / "PIPE")) for word in command]
    out = () if command[0] == "check" else ("--out", str(tmp_path / "out"))
    done = subprocess.run(
        (sys.executable, "-m", "reportgen.cli", *arguments, *out, "--lang", "en"),
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, "PIPE" in done.stderr) == (1, True), done.stderr
    assert "error[unreadable]" in done.stderr
    assert "Traceback" not in done.stderr
