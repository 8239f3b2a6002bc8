"""Progress events that a worker process sends to its parent."""

from __future__ import annotations

import os
import sys

ASKED = "REPORTGEN_STEPS"
"""Environment variable that requests progress events."""
MARK = "\x1e"
"""First character of a line of standard error that names a step."""


def step(name: str) -> None:
    """Print that a step begins (`solve`, `compose`, `typeset`, `page`, `word`), if progress events are requested."""
    if os.environ.get(ASKED):
        print(f"{MARK}{name}", file=sys.stderr, flush=True)
