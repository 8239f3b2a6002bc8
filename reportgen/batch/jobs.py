"""A job: one product of one student, as a pure function of what it carries.

A job holds all that decides its result, the bytes of the assignment file included, so that it can run
in this process, in another, or on another machine, and so that its result need not be made twice.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

from reportgen import installation
from reportgen.api import Engine, Maker
from reportgen.assignment.faults import unexpected, word
from reportgen.errors import AssignmentError, Problem, ReportgenError
from reportgen.notation.numbers import Language

SYSTEM = 3
"""Exit code of a failure that no change of the assignment can mend."""


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
    return Making(installation.version(), installation.templates_hash(), engine, language)


def failed(problem: str) -> Outcome:
    """The outcome of a job that failed for a reason outside the assignment."""
    return Outcome(problems=(problem,), exit_code=SYSTEM)


def run_job(job: Job) -> Outcome:
    """The outcome of a job; whatever goes wrong in it is an outcome, too.

    It is made in a folder of its own whose name is left out of what is said of failures.
    """
    engine, language = job.making.engine, job.making.language
    scratch = ""

    def without_paths(text: str) -> str:
        return text.replace(f"{scratch}{os.sep}", "").replace(str(installation.templates()), "templates")

    try:
        if making(engine, language) != job.making:
            return failed(word("other_templates", language))
        with tempfile.TemporaryDirectory(prefix="reportgen-") as scratch:
            file = Path(scratch, job.file)
            file.write_bytes(job.content)
            return Outcome(files=dict(job.maker(file, engine, language)))
    except AssignmentError as error:
        problems = tuple(problem.in_file(job.file) for problem in error.problems)
        return Outcome(problems=problems, exit_code=error.exit_code)
    except ReportgenError as error:
        return Outcome(problems=(without_paths(str(error)),), exit_code=error.exit_code)
    except OSError as error:
        return failed(word("system", language, text=error.strerror or error))
    except Exception as error:
        # A fault of the program itself must not cost the others their results.
        return failed(without_paths(unexpected(error, language)))
