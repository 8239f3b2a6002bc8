"""Whether the program has a console to itself, which on Windows opens for what is double-clicked.

The rule is that of the console API: `GetConsoleProcessList` names the processes of a console.  Of a command that was
installed one is its launcher, which waits for Python; a shell is another program.
"""

from __future__ import annotations

import ctypes
import re
from typing import Any

LAUNCHERS = re.compile(r"(?:python|py|reportgen)[\w.-]*", re.IGNORECASE)
"""The programs that only start this one, by their names."""
QUERY_LIMITED_INFORMATION = 0x1000
MOST, LONGEST = 16, 1024
"""So many processes of a console are looked at; so long a name has place."""


def is_double_clicked() -> bool:
    """Whether nobody else is in the console of this process; False on systems that have no such consoles."""
    windll = getattr(ctypes, "windll", None)
    if windll is None:
        return False
    kernel = windll.kernel32
    processes = (ctypes.c_uint32 * MOST)()
    count = kernel.GetConsoleProcessList(processes, MOST)
    if count == 1:
        return True
    return 1 < count <= MOST and all(LAUNCHERS.fullmatch(_program(kernel, process)) for process in processes[:count])


def _program(kernel: Any, process: int) -> str:
    """The name of the program of a process; "" where that may not be asked."""
    handle = kernel.OpenProcess(QUERY_LIMITED_INFORMATION, False, process)
    if not handle:
        return ""
    name, size = ctypes.create_unicode_buffer(LONGEST), ctypes.c_uint32(LONGEST)
    told = kernel.QueryFullProcessImageNameW(handle, 0, name, ctypes.byref(size))
    kernel.CloseHandle(handle)
    return name.value.rpartition("\\")[2] if told else ""
