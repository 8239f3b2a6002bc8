"""Make coursework reports in the Theory of Machines from one assignment file.

`open` opens a file for a notebook or a script; `load`, `check`, `solve` and `build` are the steps of the command line.
"""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from reportgen.api import analyse, build, check, load, solve
    from reportgen.base.errors import AssignmentError, ReportgenError
    from reportgen.notebook import Model, open

PLACES = {
    "reportgen.api": ("analyse", "build", "check", "load", "solve"),
    "reportgen.base.errors": ("AssignmentError", "ReportgenError"),
    "reportgen.notebook": ("Model", "open"),
}
"""Modules that define the public names of the package; each is loaded when one of its names is first used."""

__all__ = ["AssignmentError", "Model", "ReportgenError", "analyse", "build", "check", "load", "open", "solve"]


def __getattr__(name: str) -> object:
    """Return a function or class of `PLACES`, or an error class; load its module on demand."""
    from importlib import import_module

    for module, names in PLACES.items():
        if name in names:
            return getattr(import_module(module), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    """Return the names of the module, including those that are loaded on demand."""
    return sorted({*globals(), *__all__})
