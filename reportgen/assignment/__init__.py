"""Read assignment files: nodes with locations → sections → an `Assignment` in SI units, or all faults with messages."""

from reportgen.assignment.common import Assignment

__all__ = ["Assignment"]
