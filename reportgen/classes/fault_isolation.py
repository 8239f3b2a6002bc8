"""The boundary around one student's files: whatever fails there, the marking of the class continues.

Every step that processes one student's submission runs through `isolated`. A rejected file and any unexpected exception
become problems of that file.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from reportgen.base.errors import AssignmentError, Fault, Location, OutputError, Problem, ReportgenError
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.workbook.zip_package import RefusedError

Result = TypeVar("Result")


def isolated(work: Callable[[], Result], path: Path, language: Language | None) -> Result | list[Problem]:
    """Return the result of `work` on one student's file, or the problems that prevented it.

    Raises only errors that concern the whole class: `OutputError` if nothing can be written, and `MemoryError`, for
    which the process that reads the file has a limit.
    """
    try:
        return work()
    except (MemoryError, OutputError):
        raise
    except AssignmentError as error:
        return list(error.problems)
    except RefusedError as error:
        problem = as_problem(error.fault, language)
        return [problem if problem.location.file else problem.in_file(str(path))]
    except ReportgenError as error:
        return [_failed(path, str(error), language)]
    except Exception as error:
        return [_failed(path, f"{type(error).__name__}: {error}", language)]


def _failed(path: Path, text: str, language: Language | None) -> Problem:
    """Return the one-line problem of a file for which something unexpected failed."""
    return as_problem(Fault("own-failed", Location(str(path)), {"text": " ".join(text.split())}), language)
