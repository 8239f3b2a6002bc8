"""Coursework reports in the Theory of Machines from one assignment file."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from reportgen.api import analyse, build, check, load, solve
    from reportgen.base.errors import AssignmentError, ReportgenError

__all__ = ["AssignmentError", "ReportgenError", "analyse", "build", "check", "load", "solve"]


def __getattr__(name: str) -> object:
    """The functions of `reportgen.api` and its errors, which are loaded when the first of them is asked for."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

    from reportgen import api
    from reportgen.base import errors

    return getattr(errors if name.endswith("Error") else api, name)
