"""Progress events that a worker process sends to its parent."""

from __future__ import annotations

import os
import sys

ASKED = "REPORTGEN_STEPS"
"""Environment variable that requests progress events."""
MARK = "\x1e"
"""A line of the error stream that begins so names a step."""


def step(name: str) -> None:
    """Tell that a step begins: `solve`, `compose`, `typeset`, `page`, `word`."""
    if os.environ.get(ASKED):
        print(f"{MARK}{name}", file=sys.stderr, flush=True)
