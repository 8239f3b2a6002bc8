"""A job: one product of one student, as a pure function of what it carries.

A job holds all that decides its result, the bytes of the assignment file included, so that it can run
in this process, in another, or on another machine, and so that its result need not be made twice.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from hashlib import sha256
from pathlib import Path

from reportgen import folders
from reportgen.api import Engine
from reportgen.assignment.messages import word
from reportgen.errors import AssignmentError, Problem, ReportgenError
from reportgen.notation.numbers import Language
from reportgen.products import Maker
from reportgen.version import version

SYSTEM = 3
"""Exit code of what no assignment can mend."""


@dataclass(frozen=True, slots=True)
class Making:
    """What a result depends on besides the assignment.

    `version` is that of this package, `templates` a SHA-256 of all words and frames; `language` is
    empty where each file's own is meant.
    """

    version: str
    templates: str
    engine: Engine
    language: Language | None


@dataclass(frozen=True, slots=True)
class Job:
    """One product of one student: `content` is the assignment file, `file` its name, `folder` the results'."""

    student: str
    folder: str
    product: str
    maker: Maker
    file: str
    content: bytes
    making: Making

    @property
    def assignment(self) -> str:
        """SHA-256 of the assignment file."""
        return sha256(self.content).hexdigest()


@dataclass(frozen=True, slots=True)
class Outcome:
    """The files of a product by name; or, with an exit code other than 0, why there are none.

    Marks of `problems` name the assignment file without its folder.
    """

    files: Mapping[str, bytes] = field(default_factory=dict)
    problems: tuple[Problem | str, ...] = ()
    exit_code: int = 0


def making(engine: Engine, language: Language | None) -> Making:
    """How this installation would make a product now."""
    return Making(version(), templates_hash(), engine, language)


def templates_hash() -> str:
    """SHA-256 of all words and frames, those of schools included: their names and contents, sorted."""
    root = folders.templates()
    digest = sha256()
    for path in sorted(path for path in root.rglob("*") if path.is_file()):
        for part in (path.relative_to(root).as_posix().encode(), path.read_bytes()):
            digest.update(len(part).to_bytes(8, "big") + part)
    return digest.hexdigest()


def run_job(job: Job) -> Outcome:
    """The outcome of a job; whatever goes wrong in it is an outcome, too."""
    language = job.making.language or "vi"
    try:
        if making(job.making.engine, job.making.language) != job.making:
            return Outcome(problems=(word("other_templates", language),), exit_code=SYSTEM)
        with tempfile.TemporaryDirectory(prefix="reportgen-") as name:
            return _make(job, Path(name), language)
    except OSError as fault:
        text = word("system", language).format(text=fault.strerror or fault)
        return Outcome(problems=(text,), exit_code=SYSTEM)


def _make(job: Job, scratch: Path, language: Language) -> Outcome:
    file = scratch / job.file
    file.write_bytes(job.content)
    try:
        return Outcome(files=dict(job.maker(file, job.making.engine, job.making.language)))
    except AssignmentError as fault:
        problems = tuple(_without_folder(problem, job.file) for problem in fault.problems)
        return Outcome(problems=problems, exit_code=fault.exit_code)
    except ReportgenError as fault:
        return Outcome(problems=(_without_paths(str(fault), scratch),), exit_code=fault.exit_code)
    except OSError:
        raise
    except Exception as fault:
        # A fault of the program itself must not cost the others their results.
        said = _without_paths(unexpected(fault, language), scratch)
        return Outcome(problems=(said,), exit_code=SYSTEM)


def unexpected(fault: Exception, language: Language) -> str:
    """A fault of the program, in a line."""
    text = " ".join(str(fault).split())
    return word("unexpected", language).format(name=type(fault).__name__, text=text)


def _without_folder(problem: Problem, file: str) -> Problem:
    return replace(problem, mark=replace(problem.mark, file=file))


def _without_paths(text: str, scratch: Path) -> str:
    """What is said of a file without where this machine keeps it."""
    return text.replace(f"{scratch}{os.sep}", "").replace(str(folders.templates()), "templates")
