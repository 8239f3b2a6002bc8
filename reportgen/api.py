"""What a script or the command line calls: load, check, solve, build.

The whole way in one place: file → `Assignment` → `Machine` → `Analysis` → `Ledger` → `Document` → PDF.
What comes before the document is in a `Case`.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from reportgen import catalogue
from reportgen.assignment import Assignment
from reportgen.case import Case, open_case
from reportgen.errors import Problem, ReportgenError
from reportgen.notation.numbers import Language

if TYPE_CHECKING:
    from reportgen.analysis import Analysis
    from reportgen.document.tree import Document

Engine = Literal["typst", "latex"]
SUFFIX = {"typst": ".typ", "latex": ".tex"}


class OutputError(ReportgenError):
    """The result could not be written; exit code 3."""

    exit_code = 3


def load(path: Path | str, language: Language | None = None) -> Assignment:
    """The assignment of a file; raises `AssignmentError` with all its faults, located."""
    return open_case(path, language).assignment


def check(path: Path | str, language: Language | None = None) -> list[Problem]:
    """All faults of an assignment file, none if it is in order."""
    return catalogue.check(Path(path), language)


def analyse(assignment: Assignment) -> Analysis:
    """Everything computed of an assignment, as arrays over its positions."""
    return Case(assignment).analysis


def solve(assignment: Assignment, positions: int | None = None) -> dict[str, Any]:
    """The results as the contract's JSON object (SI, unrounded); `positions` overrides the count a turn."""
    from reportgen.answers.results import results

    chosen = assignment if positions is None else assignment.with_positions(positions)
    return results(Case(chosen))


def document(assignment: Assignment) -> Document:
    """The report as a numbered tree, ready for any writer."""
    from reportgen.document.outline import compose

    return compose(Case(assignment))


def build(
    path: Path | str,
    out: Path | str = "out",
    engine: Engine = "typst",
    language: Language | None = None,
    keep_source: bool = False,
) -> Path:
    """Write the complete report to `out`/<id>/report.pdf and return that path.

    Files appear whole or not at all.  Raises `AssignmentError`, `TemplateError`, `TypesetterError`,
    `OutputError`.
    """
    assignment = load(path, language)
    source, pdf = typeset(document(assignment), engine)
    target = Path(out) / assignment.id / "report.pdf"
    with reported():
        target.parent.mkdir(parents=True, exist_ok=True)
        if keep_source:
            replace(target.with_suffix(SUFFIX[engine]), source.encode())
        replace(target, pdf)
    return target


def typeset(tree: Document, engine: Engine) -> tuple[str, bytes]:
    """The source that a writer makes of a document, and its PDF; raises `TypesetterError`."""
    if engine == "latex":
        from reportgen.writers import latex, pdflatex

        source = latex.write(tree)
        return source, pdflatex.compile(source).pdf
    from reportgen.writers import typst

    source = typst.write(tree)
    return source, typst.compile(source)


def replace(target: Path, content: bytes) -> None:
    """Put `content` in place of a file in one step: a reader sees the old or the new, never a half."""
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current


@contextmanager
def reported() -> Iterator[None]:
    """A full disk or a forbidden folder is a fault in one line."""
    try:
        yield
    except OSError as error:
        raise OutputError(f"{error.filename or ''}: {error.strerror or error}") from error
