"""Coursework reports in the Theory of Machines from one assignment file."""

from reportgen.api import analyse, build, check, document, load, solve
from reportgen.errors import AssignmentError, ReportgenError

__all__ = ["AssignmentError", "ReportgenError", "analyse", "build", "check", "document", "load", "solve"]
