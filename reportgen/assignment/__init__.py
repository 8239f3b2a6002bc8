"""The assignment file: text with marks → sections → `Assignment` in SI, or all its faults in words."""

from reportgen.assignment.common import Assignment, Draft, Drawing, Kind, Part, Positions, Report, Student
from reportgen.assignment.faults import Fault, Finding
from reportgen.assignment.reading import Kinds, check, load

__all__ = [
    "Assignment",
    "Draft",
    "Drawing",
    "Fault",
    "Finding",
    "Kind",
    "Kinds",
    "Part",
    "Positions",
    "Report",
    "Student",
    "check",
    "load",
]
