"""Progress events that a worker process sends to its parent, and the source that it leaves for a preview."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path

ASKED = "REPORTGEN_STEPS"
"""Environment variable that requests progress events."""
SOURCE = "REPORTGEN_SOURCE"
"""Environment variable with the file into which the typst source of a PDF is put."""
MARK = "\x1e"
"""First character of a line of standard error that names a step."""


def step(name: str) -> None:
    """Print that a step begins (`solve`, `compose`, `typeset`, `page`, `word`), if progress events are requested."""
    if os.environ.get(ASKED):
        print(f"{MARK}{name}", file=sys.stderr, flush=True)


def leave_source(source: str) -> None:
    """Put the typst source of a PDF into the file that the parent names; a preview is not worth an error."""
    if path := os.environ.get(SOURCE):
        with suppress(OSError):
            Path(path).write_text(source, encoding="utf-8")
