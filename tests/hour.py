"""The first hour of somebody new, played from the built wheel in an empty environment, where there is no TeX.

    python -m tests.hour [--tools]

builds sdist and wheel, installs the wheel where nothing else is, and goes from `new` to `grade` as the README does;
`--tools` also runs the wheel by uvx and pipx.  It prints each step and ends with exit code 1 at the first that fails.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import urllib.request
import venv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
LONGEST = 600
"""Longest duration of a step in seconds."""
WATCHED = 3
"""Duration for which the page is watched, in seconds."""
PORT = 8761
"""Port of the class in the browser."""
STUDENTS = ("K225520103001", "K225520103004", "K225520103007")
"""Some students of the class that comes with the program."""


class StepError(Exception):
    """A step failed that a newcomer would expect to work."""


def wanted(what: str, holds: object, found: object = "") -> None:
    if not holds:
        raise StepError(f"{what}\n{found}")


def done(command: Sequence[str | Path], cwd: Path, code: int = 0, env: Mapping[str, str] | None = None) -> str:
    """Return the output of a command on both streams; it must exit with this code."""
    print("$", *(Path(command[0]).name, *command[1:]), flush=True)
    found = subprocess.run(
        [str(part) for part in command],
        cwd=cwd,
        env=env,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        timeout=LONGEST,
        check=False,
    )
    wanted(f"exit code {code} was expected, not {found.returncode}", found.returncode == code, found.stdout)
    return found.stdout


def environment(folder: Path) -> Path:
    """Create a new Python environment; return the folder of its programs."""
    venv.create(folder, with_pip=True)
    return folder / ("Scripts" if os.name == "nt" else "bin")


@dataclass(frozen=True)
class Newcomer:
    """A place with only the installed program: no TeX, no checkout, no settings."""

    programs: Path
    desk: Path

    @property
    def surroundings(self) -> dict[str, str]:
        return {"PATH": str(self.programs), "HOME": str(self.desk), "LANG": "en_US.UTF-8", "COLUMNS": "100"}

    def reportgen(self, *arguments: str | Path, code: int = 0) -> str:
        return done([self.programs / "reportgen", *arguments], self.desk, code, self.surroundings)

    def made(self, *names: str) -> None:
        for name in names:
            wanted(f"{name} was not made", (self.desk / name).is_file())


# --- the hour ---------------------------------------------------------------------------------------


def a_report(new: Newcomer) -> None:
    """Create a file, a mistake in it, its report, sheets and page."""
    wanted("it tells its version", new.reportgen("--version").startswith("reportgen 1."))
    wanted("a slip is mended", "did you mean “shaper”" in new.reportgen("new", "shapr", code=2))
    new.reportgen("new", "shaper", "-o", "my-shaper.yaml")
    file = new.desk / "my-shaper.yaml"
    right = file.read_text(encoding="utf-8")
    file.write_text(re.sub(r"(?m)^(  n: \d+) rpm", r"\1", right), encoding="utf-8")
    told = new.reportgen("check", file.name, code=1)
    wanted("the mistake is named with its line", "my-shaper.yaml:" in told and "missing-unit" in told, told)
    # As Notepad and PowerShell may save it.
    file.write_text(right, encoding="utf-16")
    wanted("a file in order is silent", new.reportgen("check", file.name) == "")
    new.reportgen("build", file.name, "--format", "pdf,html")
    new.made("out/my-shaper/report.pdf", "out/my-shaper/report.html")
    wanted(
        "TeX is named where it is missing", "texlive" in new.reportgen("build", file.name, "--engine", "latex", code=3)
    )
    new.reportgen("sheet", file.name)
    new.made("out/my-shaper/sheet-1.pdf", "out/my-shaper/sheet-1.dxf")
    wanted("there are results", "by virtual work" in new.reportgen("solve", file.name))
    watched(new, file)


def pages(new: Newcomer) -> None:
    """Check that the installed program has its documentation, as text and for a browser, in two languages."""
    wanted("all pages are listed", "  first-report " in new.reportgen("docs"))
    wanted("a page is readable", new.reportgen("docs", "machines").startswith("# The machines"))
    opened = new.reportgen("docs", "edit", "--open", "--lang", "vi").splitlines()
    place = Path(opened[0]).parent
    for name in ("edit.vi.html", "edit.html", "pictures/page.png"):
        wanted(f"the pages for a browser have {name}", (place / name).is_file(), place)


def watched(new: Newcomer, file: Path) -> None:
    """Check that the page is served, and that Ctrl-C ends it."""
    print("$ reportgen watch", file.name, "--no-open")
    with subprocess.Popen(
        [new.programs / "reportgen", "watch", file.name, "--no-open"],
        cwd=new.desk,
        env=new.surroundings,
        stdout=subprocess.PIPE,
        encoding="utf-8",
    ) as process:
        assert process.stdout is not None
        address = process.stdout.readline().strip()
        with urllib.request.urlopen(address, timeout=LONGEST) as answer:
            page = answer.read().decode()
        time.sleep(WATCHED)
        process.send_signal(signal.SIGINT)
        wanted("Ctrl-C ends it", process.wait(LONGEST) in (0, 130), process.returncode)
    wanted("a page is shown", "<svg" in page or "<html" in page, page[:200])


def a_class(new: Newcomer) -> None:
    """Create variants for three students, their tasks, reports and keys, and mark the sheets that they submit."""
    new.reportgen("samples", "examples")
    demo = new.desk / "examples" / "class-demo"
    head, *rows = (demo / "roster.csv").read_text(encoding="utf-8-sig").splitlines()
    (new.desk / "roster.csv").write_text("\n".join((head, *rows[: len(STUDENTS)])) + "\n", encoding="utf-16")
    new.reportgen("variants", demo / "spec.yaml", "roster.csv", "-o", "class")
    new.made(*(f"class/{student}.yaml" for student in STUDENTS))
    new.reportgen("batch", "roster.csv", "--assignments", "class", "--out", "handed-out")
    products = ("task.pdf", "answers.xlsx", "assignment.yaml", "report.pdf", "key.pdf")
    new.made(*(f"handed-out/{student}/{product}" for student in STUDENTS for product in products))
    new.reportgen("key", f"class/{STUDENTS[0]}.yaml")
    new.made(f"out/{STUDENTS[0]}/key.pdf", f"out/{STUDENTS[0]}/key.xlsx")
    sheets = [path for student in STUDENTS for path in sorted((demo / "sheets").glob(f"{student}.*"))]
    new.reportgen("grade", *sheets, "--assignments", "class", "--policy", demo / "policy.yaml")
    new.made("out/marked/grades.csv", "out/marked/class.pdf")
    grades = (new.desk / "out/marked/grades.csv").read_text(encoding="utf-8-sig")
    wanted("each has a mark", all(student in grades for student in STUDENTS), grades)


def a_class_in_the_browser(new: Newcomer, wheel: Path) -> None:
    """Serve a class: without its packages the command names them, with them it answers."""
    demo = new.desk / "examples" / "class-demo"
    begin = ("serve", "browser", "roster.csv", "--init", "--spec", demo / "spec.yaml", "--port", str(PORT))
    told = new.reportgen(*begin, code=3)
    wanted("the packages are named in one line", "reportgen[server]" in told and told.count("\n") == 1, told)
    done([new.programs / "python", "-m", "pip", "install", "--quiet", f"{wheel}[server]"], new.desk)
    link = new.reportgen(*begin).split()[-1]
    print("$ reportgen serve browser")
    with subprocess.Popen(
        [new.programs / "reportgen", "serve", "browser", "--port", str(PORT)],
        cwd=new.desk,
        env=new.surroundings,
        stdout=subprocess.PIPE,
        encoding="utf-8",
    ) as process:
        assert process.stdout is not None
        wanted("it prints the same link", process.stdout.readline().strip() == link, link)
        page = answered(link)
        process.send_signal(signal.SIGINT)
        wanted("Ctrl-C ends it", process.wait(LONGEST) in (0, 130), process.returncode)
    wanted("the link leads to the desk", "/desk" in page, page[:200])


def answered(address: str) -> str:
    """Return the page of a server that may still be starting."""
    for attempt in range(60):
        try:
            with urllib.request.urlopen(address, timeout=LONGEST) as answer:
                page: str = answer.read().decode()
                return page
        except ConnectionError:
            time.sleep(0.5)
        except OSError as error:
            wanted("the server answers", isinstance(getattr(error, "reason", None), ConnectionError), (attempt, error))
            time.sleep(0.5)
    raise StepError(f"{address} does not answer")


def an_example(new: Newcomer) -> None:
    """Build an example of a checkout, with a school's words that are not in the package."""
    new.reportgen("new", "engine-twin", "--from", "engine-twin-05", "-o", "twin.yaml")
    wanted("an example is in order", new.reportgen("check", "twin.yaml") == "")
    words = new.desk / "words"
    words.mkdir()
    (words / "en.md").write_text("%% foreword\n# Preface {{ unnumbered() }}\n\nAs we have it.\n", encoding="utf-8")
    new.reportgen("build", "my-shaper.yaml", "--templates", "words", "--keep-source", "--out", "ours")
    wanted(
        "the school's words are used", "As we have it." in (new.desk / "ours/my-shaper/report.typ").read_text("utf-8")
    )


def with_tools(tools: Path, wheel: Path, place: Path) -> None:
    """Run the wheel without an installation, by uvx and by pipx."""
    done([tools / "pip", "install", "--quiet", "uv", "pipx"], place)
    for command in ([tools / "uvx", "--from", wheel], [tools / "pipx", "run", "--spec", wheel]):
        wanted("it runs", "kind: shaper" in done([*command, "reportgen", "new", "shaper"], place))


def main(arguments: Sequence[str]) -> int:
    begun = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="first-hour-") as name:
        place = Path(name)
        try:
            tools = environment(place / "tools")
            done([tools / "pip", "install", "--quiet", "build"], place)
            done([tools / "python", "-m", "build", "--outdir", place / "dist", ROOT], place)
            (wheel,) = (place / "dist").glob("*.whl")
            wanted("there is an sdist, too", list((place / "dist").glob("*.tar.gz")))
            programs = environment(place / "empty")
            done([programs / "python", "-m", "pip", "install", "--quiet", wheel], place)
            done([programs / "python", "-m", "pip", "install", "--quiet", "--dry-run", f"{wheel}[cluster]"], place)
            (place / "desk").mkdir()
            new = Newcomer(programs, place / "desk")
            pages(new)
            a_report(new)
            an_example(new)
            a_class(new)
            a_class_in_the_browser(new, wheel)
            if "--tools" in arguments:
                with_tools(tools, wheel, place)
        except (StepError, subprocess.TimeoutExpired) as error:
            print(error, file=sys.stderr)
            return 1
    print(f"the first hour took {time.monotonic() - begun:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
