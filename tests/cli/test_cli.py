"""The command line: exit codes, where things are printed, no traceback; checked as a user's shell sees it."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any

import pytest
import typer

from reportgen.base.kinds import kinds
from reportgen.base.units import Language
from reportgen.cases import open_case
from reportgen.cli.common import ending
from reportgen.marking.toleranced_key import Ask, key_of
from tests.commands import ROOT, process, reportgen
from tests.lanes import matrix, proof
from tests.marking.filled import filled

SAMPLE = ROOT / "assignments" / "engine-twin-05.yaml"


@pytest.fixture
def faulty(tmp_path: Path) -> Path:
    file = tmp_path / "faulty.yaml"
    text = SAMPLE.read_text(encoding="utf-8")
    file.write_text(text.replace("lambda: 1/3.6", "lambda: 3.6").replace("95 mm", "95"), encoding="utf-8")
    return file


KINDS_OF_WORK = tuple(f"reportgen.{room}" for room in ("cam", "gears", "exercise", "coursework"))


def test_check_is_silent_when_all_is_well() -> None:
    done = reportgen("check", SAMPLE)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_check_and_help_leave_heavy_libraries_alone() -> None:
    """They answer at once: pint alone takes longer to import than all of `check`.

    Nor does a machine load other kinds of work, or what renders templates.
    """
    script = (
        "import sys\nfrom pathlib import Path\nimport reportgen.cli, reportgen.api\n"
        f"assert reportgen.api.check(Path({str(SAMPLE)!r})) == []\n"
        "heavy = {'pint', 'matplotlib', 'pylatex', 'typst', 'jinja2', 'reportgen.document.template_rendering'}\n"
        "print(*heavy & set(sys.modules))\n"
        f"print(*(name for name in sys.modules if name.startswith({KINDS_OF_WORK})))"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""


def test_a_report_is_built_without_what_figures_need(tmp_path: Path) -> None:
    """matplotlib alone takes a third of a second to import and forty megabytes."""
    file = ROOT / "assignments" / "slider-crank-01.yaml"
    script = (
        "import sys\nfrom pathlib import Path\nimport reportgen.cli, reportgen.api\n"
        f"reportgen.api.build(Path({str(file)!r}), {str(tmp_path)!r}, formats=('pdf', 'html', 'docx'))\n"
        "print(*{'matplotlib', 'PIL', 'pandas', 'reportgen.export', 'reportgen.notebook'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""


def test_the_command_line_itself_loads_next_to_nothing() -> None:
    """`--help` asks for no assignment; what reads one is loaded by the commands that do."""
    heavy = {"numpy", "pydantic", "yaml", "reportgen.api"}
    script = f"import sys\nfrom reportgen.cli import app\nprint(*{heavy} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""


INTERRUPTED_WHERE = """
import os, signal, sys
module = sys.argv.pop(1)
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == module:
            sys.meta_path.remove(self)
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Finder())
from reportgen.cli import main
sys.argv[0] = "reportgen"
%smain()
"""
IN_WORDS = {"vi": "đã dừng theo yêu cầu; không có tệp nào bị ghi dở", "en": "interrupted; no incomplete files are left"}


@pytest.mark.parametrize("language", matrix(IN_WORDS, ["vi"]))
@pytest.mark.parametrize(
    "module",
    matrix(
        ["reportgen.cli.common", "typer", "reportgen.cli.student", "reportgen.api", "numpy", "jinja2", "typst"],
        ["reportgen.cli.common", "numpy", "typst"],
    ),
)
def test_ctrl_c_is_told_in_one_line(tmp_path: Path, module: str, language: str) -> None:
    """It may come while the program is being loaded, or while a command works."""
    command = (module, "build", SAMPLE, "--lang", language, "--out", tmp_path / "out")
    done = subprocess.run(
        (sys.executable, "-c", INTERRUPTED_WHERE % "", *map(str, command)),
        capture_output=True,
        text=True,
        check=False,
        # As a shell starts it, whatever started the tests.
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),
    )
    told = IN_WORDS[language] if module in {"jinja2", "typst"} else "đã dừng (interrupted)"
    assert (done.returncode, done.stdout, done.stderr) == (130, "", f"reportgen: {told}\n")
    assert list(tmp_path.iterdir()) == []


def test_who_does_not_hear_ctrl_c_goes_on() -> None:
    script = INTERRUPTED_WHERE % "signal.signal(signal.SIGINT, signal.SIG_IGN)\n"
    command = (sys.executable, "-c", script, "typer", "check", str(SAMPLE))
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_the_package_offers_its_functions_by_name() -> None:
    script = (
        "import reportgen\nfrom reportgen import analyse, build, check, load, solve\n"
        f"print(load({str(SAMPLE)!r}).kind, all(callable(getattr(reportgen, name)) for name in reportgen.__all__))\n"
        "print(hasattr(reportgen, 'nothing'))"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["engine-twin", "True", "False"]


def test_check_prints_all_faults_with_hints(faulty: Path) -> None:
    done = reportgen("check", faulty, SAMPLE, "--lang", "en")
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.splitlines() == [
        f"{faulty}:21:6: error[missing-unit]: “95” has no unit",
        "    hint: write for example “95 mm”",
        f"{faulty}:22:11: error[out-of-range]: “3.6” is out of range: at least 0.001 and less than 1",
        "    hint: λ is R/L; did you mean 1/3.6?",
    ]


def test_faults_speak_the_language_of_the_file(faulty: Path) -> None:
    assert "thiếu đơn vị" in reportgen("check", faulty).stderr


def test_a_file_of_wrong_syntax_still_tells_its_language(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    file.write_text("report: {language: en}\nkind: [\n", encoding="utf-8")
    assert reportgen("check", file).stderr.startswith(f"{file}:3:1: error[syntax]: this is not valid YAML")


def test_a_missing_file_is_a_fault_of_input(tmp_path: Path) -> None:
    done = reportgen("check", "none.yaml", cwd=tmp_path)
    assert done.returncode == 1
    assert done.stderr.startswith("none.yaml:1:1: error[unreadable]: ")


@pytest.mark.parametrize(
    "arguments",
    [
        ("check",),
        ("check", SAMPLE, "--lang", "fr"),
        ("build",),
        ("build", SAMPLE, "--engine", "word"),
        ("build", SAMPLE, f"x/{SAMPLE.name}"),
        ("solve", SAMPLE, "--positions", "3"),
        ("solve", SAMPLE, SAMPLE),
        ("new", "time-machine"),
        ("fly",),
        ("kinds", "--all"),
    ],
)
def test_wrong_usage_ends_with_2(arguments: tuple[object, ...]) -> None:
    done = reportgen(*arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr


def test_help_names_every_command() -> None:
    done = reportgen("--help")
    assert done.returncode == 0
    assert all(name in done.stdout for name in ("build", "solve", "check", "new", "kinds", "schema"))


@pytest.mark.parametrize("language", ["vi", "en"])
def test_new_writes_a_file_that_check_accepts(tmp_path: Path, language: str) -> None:
    file = tmp_path / "mine.yaml"
    assert reportgen("new", "engine-twin", "-o", file, "--lang", language).returncode == 0
    assert reportgen("new", "engine-twin", "--lang", language).stdout == file.read_text(encoding="utf-8")
    assert reportgen("check", file).returncode == 0
    assert list(tmp_path.iterdir()) == [file]


def test_new_where_nothing_can_be_written_ends_with_3(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    done = reportgen("new", "engine-twin", "-o", tmp_path / "file" / "a.yaml")
    assert done.returncode == 3
    assert len(done.stderr.splitlines()) == 1


def test_kinds_gives_a_line_each() -> None:
    done = reportgen("kinds", "--lang", "en")
    assert [line.split()[0] for line in done.stdout.splitlines()] == list(kinds())


def test_schema_is_json() -> None:
    assert "oneOf" in json.loads(reportgen("schema").stdout)


def test_grade_gives_a_line_each(tmp_path: Path) -> None:
    """The line of a student, then the files for the whole class; the student's own files are not listed."""
    file = ROOT / "assignments" / "friction" / "wedge.yaml"
    (tmp_path / "wedge.yaml").write_bytes(file.read_bytes())
    (tmp_path / "wedge.xlsx").write_bytes(filled(Ask().of(key_of(open_case(file, "en")))))
    done = reportgen("grade", "wedge.xlsx", "--assignments", ".", "--lang", "en", "--out", "marked", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    line, *files = done.stdout.splitlines()
    assert re.fullmatch(r"wedge: (\d+) of \1 points, first errors: 0", line)
    assert files == [f"marked/{name}" for name in ("grades.csv", "questions.csv", "class.pdf")]
    assert (tmp_path / "marked" / "wedge" / "feedback.pdf").exists()


def solved(*arguments: object) -> dict[str, Any]:
    done = reportgen("solve", *arguments, "--json", "-")
    assert (done.returncode, done.stderr) == (0, "")
    results: dict[str, Any] = json.loads(done.stdout)
    return results


def test_solve_as_json() -> None:
    results = solved(SAMPLE)
    assert (results["format"], results["kind"], results["variant"]) == ("reportgen-results/1", "engine-twin", "5")
    assert [position["number"] for position in results["positions"]] == list(range(1, 17))
    fourth = results["positions"][3]
    # Printed at position 4, drawn by hand: 0.5 %.
    assert abs(fourth["points"]["B"]["v"][1]) == pytest.approx(6.173, rel=0.005)
    assert fourth["links"]["2"]["omega"] == pytest.approx(46.0, rel=0.005)


def test_solve_at_other_positions_and_to_a_file(tmp_path: Path) -> None:
    assert len(solved(SAMPLE, "--positions", 12)["positions"]) == 24
    file = tmp_path / "r.json"
    assert reportgen("solve", SAMPLE, "--json", file).stdout == ""
    assert json.loads(file.read_text(encoding="utf-8")) == solved(SAMPLE)


@proof
def test_build_goes_on_after_a_faulty_file(faulty: Path, tmp_path: Path) -> None:
    done = reportgen("build", faulty, SAMPLE, "--out", tmp_path / "out")
    report = tmp_path / "out" / "engine-twin-05" / "report.pdf"
    assert done.returncode == 1
    assert done.stdout.split() == [str(report)]
    assert report.read_bytes().startswith(b"%PDF")
    assert f"{faulty}:21:6: error[missing-unit]" in done.stderr
    assert not (tmp_path / "out" / "faulty").exists()


@pytest.mark.parametrize("lane", [pytest.param("build"), pytest.param("batch", marks=proof)])
def test_without_a_home_nothing_is_said(tmp_path: Path, lane: str) -> None:
    nowhere = {"HOME": "/dev/null", "XDG_CACHE_HOME": "/dev/null/cache", "XDG_CONFIG_HOME": "/dev/null/config"}
    sample = ROOT / "assignments" / "slotted-lever-01.yaml"
    arguments: tuple[object, ...] = (sample,)
    if lane == "batch":
        (tmp_path / "given").mkdir()
        (tmp_path / "given" / "K1.yaml").write_bytes(sample.read_bytes())
        (tmp_path / "class.csv").write_text("id,name\nK1,An\n", encoding="utf-8")
        arguments = (tmp_path / "class.csv", "--assignments", tmp_path / "given", "--jobs", 2)
    done = process(lane, *arguments, "--out", tmp_path / "out", **nowhere)
    assert done.returncode == 0, done.stderr
    assert "atplotlib" not in done.stderr
    assert "ignored" not in done.stderr
    assert lane == "batch" or done.stderr == ""


TOO_LITTLE = {"vi": "không đủ bộ nhớ để làm việc này", "en": "not enough memory"}


@pytest.mark.parametrize("language", ["vi", "en"])
def test_too_little_memory_says_so(language: Language, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(typer.Exit) as end, ending(language):
        raise MemoryError
    assert end.value.exit_code == 3
    assert capsys.readouterr().err == f"reportgen: {TOO_LITTLE[language]}\n"


@proof
def test_a_typesetter_that_memory_has_no_room_for_is_installed(tmp_path: Path) -> None:
    """As where its library cannot be mapped as a whole."""
    (tmp_path / "typst.py").write_text("raise ImportError('_typst.so: failed to map segment')\n", encoding="utf-8")
    done = process("build", SAMPLE, "--out", tmp_path / "out", PYTHONPATH=f"{tmp_path}:{ROOT}")
    assert (done.returncode, done.stdout) == (3, "")
    assert "typst cannot be loaded, most likely for too little memory" in done.stderr
    assert len(done.stderr.splitlines()) == 1
