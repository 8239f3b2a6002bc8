"""The assignment file: text with marks → sections → `Assignment` in SI, or all its faults in words."""

from reportgen.assignment.common import Assignment

__all__ = ["Assignment"]
