"""The copy of an assignment that a student gets with the task, for checking a sheet: its data, without other files."""

from __future__ import annotations

from pathlib import Path

from reportgen.assignment import parts
from reportgen.base.yaml_source import MappingNode, read_source
from reportgen.base.yaml_values import at, put, text_of, without

REPORT = ("report",)
LOOK = ("school", "templates", "font", "size")
"""Keys of a report's appearance, whose files another computer may not have."""


def handed_out(path: Path) -> str:
    """Return the text of an assignment without comments and a school's appearance, with its parts inserted from their
    files.

    Comments include what `variants` writes above an assignment (spec, salt) and an instructor's notes.  The file has
    been read without a fault.  Raises `OSError` for a file that cannot be read.
    """
    top = read_source(path).top
    assert isinstance(top, MappingNode), "a file without a fault is a table"
    whole, _, _ = parts.in_place(top, path)
    report = at(whole, REPORT)
    if isinstance(report, MappingNode):
        bare = put(whole, REPORT, without(report, LOOK))
        assert isinstance(bare, MappingNode), "a section is put into a table"
        whole = bare
    return text_of(whole, "", MappingNode((), whole.location))
