"""Detect if the program has its own console, which Windows opens for a double click.

`GetConsoleProcessList` of the console API lists the processes of a console. An installed command has a launcher among
them, which waits for Python; a shell is another program.
"""

from __future__ import annotations

import ctypes
import re
from typing import Any

LAUNCHERS = re.compile(r"(?:python|py|reportgen)[\w.-]*", re.IGNORECASE)
"""Names of programs that only start this one."""
QUERY_LIMITED_INFORMATION = 0x1000
MOST, LONGEST = 16, 1024
"""Largest number of console processes that are checked, and longest program name."""


def is_double_clicked() -> bool:
    """Return True if no other program uses this console; False on systems without such consoles."""
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
    """Return the program name of a process; "" if access is denied."""
    handle = kernel.OpenProcess(QUERY_LIMITED_INFORMATION, False, process)
    if not handle:
        return ""
    name, size = ctypes.create_unicode_buffer(LONGEST), ctypes.c_uint32(LONGEST)
    success = kernel.QueryFullProcessImageNameW(handle, 0, name, ctypes.byref(size))
    kernel.CloseHandle(handle)
    return name.value.rpartition("\\")[2] if success else ""
