"""Coursework reports in the Theory of Machines from one assignment file."""

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
"""Where the names are that the package offers; a module is loaded when the first of them is asked for."""

__all__ = ["AssignmentError", "Model", "ReportgenError", "analyse", "build", "check", "load", "open", "solve"]


def __getattr__(name: str) -> object:
    """The functions and classes of `PLACES`, and the errors."""
    from importlib import import_module

    for module, names in PLACES.items():
        if name in names:
            return getattr(import_module(module), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    """The names of the module with those that are loaded when they are asked for."""
    return sorted({*globals(), *__all__})
