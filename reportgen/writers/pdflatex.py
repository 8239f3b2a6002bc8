"""Compile LaTeX source into PDF: run pdflatex in its own directory, as often as the page numbers require.

The run may read and write that directory only, starts no other program, and stops at the first error or at the time
limit. The same source gives the same bytes. Page numbers are cached between reports with the same contents; if they are
still right, one pass is enough. The common beginning of all reports may be read ahead while the rest of one is
computed, and the rest while it is written.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from threading import Timer
from typing import Self

from reportgen.base.errors import TypesetterError
from reportgen.base.files import keep, kept
from reportgen.base.records import Record

INSTALL = (
    "apt-get install --no-install-recommends texlive-latex-base texlive-latex-recommended texlive-lang-other lmodern"
)
"""Command that installs everything this writer needs, on Debian and its derivatives."""

MAX_PASSES = 4
STANDARD_INPUT = Path("/dev/stdin")
REPORTED_EXCESS = 1.0
"""Excess (points) above which a box is reported as overfull."""

_COMMAND = (
    "pdflatex",
    "-halt-on-error",
    "-interaction=nonstopmode",
    "-file-line-error",
    "-no-shell-escape",
    "-no-mktex=tfm",
    "-no-mktex=pk",
    "-no-parse-first-line",
    "-jobname=report",
)
_ENVIRONMENT = {
    # "p": neither parent directories nor absolute paths outside TeX's own trees.
    "openin_any": "p",
    "openout_any": "p",
    "SOURCE_DATE_EPOCH": "0",
    "FORCE_SOURCE_DATE": "1",
    # Messages of the log stay on one line, so that they can be parsed.
    "max_print_line": "1000",
    "error_line": "254",
    "half_error_line": "238",
}
_OVERFULL = re.compile(r"^Overfull \\[hv]box \((?P<excess>[\d.]+)pt too (?:wide|high)\).*$", re.MULTILINE)
_MISSING = re.compile(
    r"File [`'][^']+' not found|Font \S+ (?:at \S+ )?not loadable|Encoding scheme [^\n]* unknown"
    r"|can't find file|Metric \(TFM\) file not found|pdfTeX error[^\n]*(?:font|cannot open)"
)
_ENTRY = re.compile(r"^\\contentsentry\{.*$", re.MULTILINE)
_ERROR = re.compile(r"^(?:!|\S+:\d+:) ", re.MULTILINE)


class Compiled(Record):
    """A finished PDF with its source, its number of passes, and the log's lines about boxes over 1 pt too large."""

    source: str
    pdf: bytes
    passes: int
    overfull: tuple[str, ...]


class Ahead:
    """A run of pdflatex that reads the opening of a source while the rest is computed; a context manager that ends it.

    It does nothing if pdflatex is missing or the system has no file for the standard input.
    """

    def __init__(self, opening: str) -> None:
        self.opening = opening
        self.process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> Self:
        with ExitStack() as stack:
            self.directory = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="reportgen-")))
            program = shutil.which(_COMMAND[0])
            if program is not None and STANDARD_INPUT.exists():
                (self.directory / "ahead.tex").symlink_to(STANDARD_INPUT)
                self.process = _started(program, self.directory, "ahead.tex", subprocess.PIPE)
                stack.callback(_stop, self.process)
                assert self.process.stdin
                self.process.stdin.write(self.opening.encode())
                self.process.stdin.flush()
            self._end = stack.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        self._end.close()

    def begins(self, source: str) -> bool:
        """Return True if a source begins with the opening that is being read."""
        return self.process is not None and source.startswith(self.opening)


def compile(source: str | Iterable[str], timeout: float = 120.0, ahead: Ahead | None = None) -> Compiled:
    """Typeset a whole document; passes end when the auxiliary file no longer changes.

    A source in pieces, whose first one contains the contents, is read as they arrive if its opening was read `ahead`.
    Raises `TypesetterError` if pdflatex or one of its packages is missing (with the command that installs them), if TeX
    stops at an error (with the first lines of the log that explain it), if it runs longer than `timeout` seconds, or if
    the page numbers do not settle.
    """
    program = shutil.which(_COMMAND[0])
    if program is None:
        raise TypesetterError(f"the LaTeX engine needs pdflatex; install it with\n    {INSTALL}")
    pieces = iter((source,) if isinstance(source, str) else source)
    whole = [next(pieces, "")]
    name = _kept_as(whole[0])
    known = kept(name) or b"" if name else b""
    with ExitStack() as stack:
        run: subprocess.Popen[bytes] | None = None
        if ahead and ahead.begins(whole[0]):
            directory, run = ahead.directory, ahead.process
            (directory / "report.aux").write_bytes(known)
            rest = whole[0].removeprefix(ahead.opening)
            whole += _sent(run, rest, pieces, timeout) if run else ()
        else:
            directory = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="reportgen-")))
        whole += pieces
        text = "".join(whole)
        (directory / "report.tex").write_text(text, encoding="utf-8")
        try:
            compiled, auxiliary = _settled(program, directory, timeout, text, known, run)
        except TypesetterError:
            if not known:
                raise
            # The cached file may be damaged.
            compiled, auxiliary = _settled(program, directory, timeout, text, b"")
    if name and auxiliary != known:
        keep(name, auxiliary)
    return compiled


def _sent(run: subprocess.Popen[bytes], begun: str, pieces: Iterable[str], timeout: float) -> Iterator[str]:
    """Yield the pieces of a source after sending each to the run, following the part that it `begun` with."""
    late = Timer(timeout, run.kill)
    late.start()
    assert run.stdin
    try:
        # A run that has ended gives the reason in its log.
        with suppress(BrokenPipeError):
            run.stdin.write(begun.encode())
        for piece in pieces:
            with suppress(BrokenPipeError):
                run.stdin.write(piece.encode())
            yield piece
        if not late.is_alive():
            raise TypesetterError(f"pdflatex was stopped after {timeout:g} s")
    finally:
        late.cancel()


def _settled(
    program: str,
    directory: Path,
    timeout: float,
    source: str,
    auxiliary: bytes,
    first: subprocess.Popen[bytes] | None = None,
) -> tuple[Compiled, bytes]:
    """Return the PDF with stable page numbers, and its auxiliary file; `auxiliary` is an earlier one.

    The `first` pass may have begun. Contents have room for any number, so that the pages do not depend on the numbers
    known before.
    """
    if first is None:
        (directory / "report.aux").write_bytes(auxiliary)
    for passes in range(1, MAX_PASSES + 1):
        _finish(first or _started(program, directory, "report.tex"), directory, timeout)
        first = None
        latest = (directory / "report.aux").read_bytes()
        if latest == auxiliary or b"\\newlabel" not in latest:
            log = _log(directory)
            return Compiled(source, (directory / "report.pdf").read_bytes(), passes, overfull(log)), latest
        auxiliary = latest
    raise TypesetterError(f"the page numbers did not settle within {MAX_PASSES} passes of pdflatex")


def _kept_as(source: str) -> str:
    """Return the name under which page numbers are cached, equal for equal contents; "" without contents."""
    contents = "\n".join(_ENTRY.findall(source))
    return f"contents-{hashlib.sha256(contents.encode()).hexdigest()[:32]}.aux" if contents else ""


def overfull(log: str) -> tuple[str, ...]:
    """Return the lines of a log about boxes that are too large by more than 1 pt."""
    return tuple(match.group() for match in _OVERFULL.finditer(log) if float(match["excess"]) > REPORTED_EXCESS)


def _started(program: str, directory: Path, file: str, given: int = subprocess.DEVNULL) -> subprocess.Popen[bytes]:
    """Start a run on a file of the directory; its standard input is `given`."""
    try:
        return subprocess.Popen(
            (program, *_COMMAND[1:], file),
            cwd=directory,
            env={**os.environ, **_ENVIRONMENT},
            stdin=given,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
    except OSError as error:
        raise TypesetterError(f"pdflatex could not be started: {error}") from error


def _stop(run: subprocess.Popen[bytes]) -> None:
    run.kill()
    run.communicate()


def _finish(run: subprocess.Popen[bytes], directory: Path, timeout: float) -> None:
    try:
        run.communicate(timeout=timeout)
    except subprocess.TimeoutExpired:
        raise TypesetterError(f"pdflatex was stopped after {timeout:g} s") from None
    finally:
        if run.poll() is None:
            _stop(run)
    if run.returncode < 0:
        raise TypesetterError(f"pdflatex was ended by signal {-run.returncode}, most likely for too little memory")
    if run.returncode != 0:
        raise TypesetterError(_reason(_log(directory)))


def _log(directory: Path) -> str:
    try:
        return (directory / "report.log").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""


def _reason(log: str) -> str:
    """Return the error of a log: a missing package with the remedy, else the first error's lines."""
    error = _ERROR.search(log)
    if error is None:
        return "pdflatex failed and left no message"
    lines = [line for line in log[error.start() :].splitlines()[:8] if line.strip()]
    message = "\n".join(lines[:5])
    if _MISSING.search(message):
        return f"a part of LaTeX is missing ({lines[0].strip()}); install it with\n    {INSTALL}"
    return f"pdflatex failed:\n{message}"
