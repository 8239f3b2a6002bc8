"""What every room stands on; here how a program ends: its codes, and Ctrl-C before anything else is loaded."""

from __future__ import annotations

import os
import signal

SYSTEM, INTERRUPTED = 3, 130
STOPPED = "reportgen: đã dừng (interrupted)\n"
"""Said where no words are loaded yet."""


def _leave(*_: object) -> None:
    """End at once: until a command begins its work there is nothing to tidy up, and half an import to fall over."""
    os.write(2, STOPPED.encode())
    os._exit(INTERRUPTED)


def hear_at_once() -> None:
    """Until `begin` Ctrl-C ends the program in one line, whatever it is loading."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _leave)


def begin() -> None:
    """From here on Ctrl-C is an exception, after which a command tidies up."""
    if signal.getsignal(signal.SIGINT) is _leave:
        signal.signal(signal.SIGINT, signal.default_int_handler)
