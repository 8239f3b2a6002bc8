"""Read assignment files: text with places → sections → an `Assignment` in SI, or all faults in words."""

from reportgen.assignment.common import Assignment

__all__ = ["Assignment"]
