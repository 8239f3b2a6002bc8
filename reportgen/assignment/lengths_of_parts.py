"""Lengths that parts of a coursework find for its machine: `find` in the machine's file is replaced by their values.

A part is solved before the machine is read, so that the machine is checked with the lengths as the part prints them.
Such a part can take data from the machine, but no length that is found only later.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from reportgen.assignment import parts
from reportgen.assignment.common import PARTS, Assignment, Kind, LengthOfPart
from reportgen.assignment.fields import FIND
from reportgen.base.errors import Fault
from reportgen.base.kinds import kinds
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode
from reportgen.base.yaml_values import at, put

GIVES = "gives"
"""The key of a part with the lengths that it gives the machine."""


@dataclass
class SolvedParts:
    """A machine's nodes with the lengths of its parts, what these lengths are, and the faults of the parts.

    `missing` are the keys of the machine whose lengths a faulty part does not give.
    """

    top: MappingNode
    lengths: list[LengthOfPart] = field(default_factory=list)
    faults: list[Fault] = field(default_factory=list)
    missing: set[str] = field(default_factory=set)


def solved(top: MappingNode, path: Path, find: Callable[[str], Kind], assess: parts.Assess) -> SolvedParts:
    """Return the nodes of a machine's file with the lengths that its parts give.

    `find` returns the kind with this name, `assess` the assignment of a part's nodes.
    """
    solution = SolvedParts(top)
    listed = at(top, (PARTS,))
    for index, item in enumerate(listed.items if isinstance(listed, SequenceNode) else ()):
        table = at(item, (GIVES,))
        if isinstance(table, MappingNode):
            _enter(solution, index, table, path, find, assess)
    return solution


def _enter(
    solution: SolvedParts, index: int, table: MappingNode, path: Path, find: Callable[[str], Kind], assess: parts.Assess
) -> None:
    """Put the lengths of one part, named in its `table`, into the machine's nodes."""
    wanted = [(key, value) for key, value in table.entries if isinstance(value, Scalar) and not value.null]
    solution.missing |= {key.text for key, _ in wanted}
    assignment, faults = _assignment(solution.top, index, path, find, assess)
    if assignment is None:
        solution.faults += faults
        return
    lengths_of = find(assignment.kind).lengths
    if lengths_of is None:
        where = (PARTS, index, GIVES)
        solution.faults.append(Fault("gives-no-length", table.location, {"text": assignment.kind}, where))
        return
    lengths, keys = lengths_of(assignment), _keys(solution.top, find)
    for key, value in wanted:
        here, length = (PARTS, index, GIVES, key.text), lengths.get(value.text)
        sought = at(solution.top, ("parameters", key.text))
        if key.text not in keys:
            about = {"key": key.text, "known": ", ".join(keys) or "–"}
            solution.faults.append(Fault("not-of-parts", key.location, about, here))
        elif any(given.key == key.text for given in solution.lengths):
            solution.faults.append(Fault("given-by-two-parts", key.location, {"key": key.text}, here))
        elif not (isinstance(sought, Scalar) and sought.text == FIND):
            solution.faults.append(Fault("not-to-be-found", key.location, {"key": key.text}, here))
        elif length is None:
            about = {"text": value.text, "known": ", ".join(lengths)}
            solution.faults.append(Fault("no-such-length", value.location, about, here))
        else:
            node: Node = put(solution.top, ("parameters", key.text), Scalar(length.text, value.location))
            assert isinstance(node, MappingNode), "a value is put into the file's table"
            solution.top = node
            solution.lengths.append(LengthOfPart(key.text, index, length.id))
            solution.missing.discard(key.text)


def _keys(top: MappingNode, find: Callable[[str], Kind]) -> tuple[str, ...]:
    """Return the keys of a machine whose lengths parts can give."""
    name = at(top, ("kind",))
    return find(name.text).lengths_of_parts if isinstance(name, Scalar) and name.text in kinds() else ()


def _assignment(
    top: MappingNode, index: int, path: Path, find: Callable[[str], Kind], assess: parts.Assess
) -> tuple[Assignment | None, list[Fault]]:
    """Return the assignment of a part with the data that it takes from the machine; else its faults."""
    source, unread = parts.source_of(top, path, index)
    if unread := unread or list(parts.no_part(source, find)):
        return None, [parts.of_part(fault, index, path) for fault in unread]
    source = parts.taking(source, top, index, find)
    # Data that the part cannot take would be reported as missing, too.
    assignment, faults = (None, list(source.faults)) if source.faults else assess(source, Path(source.file))
    return assignment, [parts.of_part(fault, index, path) for fault in faults]


def without_missing(faults: list[Fault], missing: set[str]) -> list[Fault]:
    """Return the faults without those of lengths that a faulty part does not give."""
    return [
        fault
        for fault in faults
        if not (fault.code in ("find-without-motion", "find-by-part") and fault.where and fault.where[-1] in missing)
    ]
