"""The further parts of a coursework: assignments in files or in place, with data of the machine.

A part is one table, in a separate file or in the coursework's. Each of its nodes keeps the location where it was
written, so that a fault is reported there. Values that it takes `from` the machine are inserted into its parameters
before it is read.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from reportgen.assignment.common import PARTS, AssignedPart, Assignment, Kind, NamedPart, TakenDatum
from reportgen.assignment.fields import FIND
from reportgen.base.errors import Fault, Where
from reportgen.base.files import leads_out
from reportgen.base.kinds import kinds
from reportgen.base.records import replace
from reportgen.base.units import NUMBER, QuantityFault, read_ratio
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, Source, read_source
from reportgen.base.yaml_values import at, put, without

ABOUT = ("file", "title", "from", "gives")
"""The keys of a named part that are not those of an assignment."""
UNUSED = ("report",)
"""Section of a part that the coursework's section replaces."""
ON_SHAFT = "n", "n", "1"
"""Values taken by a part that turns with the driver: its speed is the driver's, times one."""
DIRECTION, ANTICLOCKWISE = "direction", "anticlockwise"
SENSES = (ANTICLOCKWISE, "clockwise")
_TYPED = re.compile(rf"\s*({NUMBER})(.*)")

Assess = Callable[[Source, Path], tuple[Assignment | None, list[Fault]]]


def read(
    top: MappingNode, path: Path, named: Sequence[NamedPart], find: Callable[[str], Kind], assess: Assess
) -> tuple[list[AssignedPart], list[Fault]]:
    """Return the parts of a coursework's file, and all their faults.

    `find` returns the kind with this name, `assess` the assignment of a part's nodes.
    """
    parts: list[AssignedPart] = []
    faults: list[Fault] = []
    numbers: Counter[str] = Counter()
    for index, part in enumerate(named):
        source, own = source_of(top, path, index)
        taken = tuple(
            TakenDatum(key, wanted.of, wanted.times.text.strip() if wanted.times else "1")
            for key, wanted in part.from_.items()
        )
        if source.top is not None and not own:
            factors = {key: wanted.times.si if wanted.times else None for key, wanted in part.from_.items()}
            source, own = _completed(source, top, index, taken, factors, find)
        own = own or list(no_part(source, find))
        assignment, wrong = (None, own) if own else assess(source, Path(source.file))
        if assignment is None:
            faults += [of_part(fault, index, path) for fault in wrong]
            continue
        head = find(assignment.kind).part
        numbers[head] += 1
        parts.append(AssignedPart(numbered(head, numbers[head]), head, part.title or "", assignment, taken))
    return parts, faults


def of_part(fault: Fault, index: int, path: Path) -> Fault:
    """Return a fault of a part with its place in the file `path` of the coursework.

    The faults of a part in place belong to this file, those of a part in a separate file to that one.
    """
    in_place = fault.location.file == str(path) and fault.where[:1] != (PARTS,)
    return replace(fault, where=(PARTS, index, *fault.where)) if in_place else fault


def in_coursework(
    source: Source, path: Path, whole: Path, find: Callable[[str], Kind], solve: Callable[[MappingNode], MappingNode]
) -> Source:
    """Return the nodes of a part's file with the values taken from the machine of the coursework `whole`, and faults.

    `solve` puts the lengths that parts give into the machine's nodes. If the coursework does not name the file, the
    nodes are unchanged.
    """
    top = read_source(whole).top
    if not isinstance(top, MappingNode) or source.top is None:
        return source
    index = next((index for index, file in _named(top, whole) if file == path), None)
    return source if index is None else taking(source, solve(top), index, find)


def taking(source: Source, top: MappingNode, index: int, find: Callable[[str], Kind]) -> Source:
    """Return a part with the values it takes from the coursework's nodes, valid or not, without unreadable ones."""
    table = at(top, (PARTS, index, "from"))
    taken: list[TakenDatum] = []
    factors: dict[str, float | None] = {}
    for key, about in table.entries if isinstance(table, MappingNode) else ():
        of, times = at(about, ("of",)), at(about, ("times",))
        if isinstance(of, Scalar) and not of.null:
            typed = times.text.strip() if isinstance(times, Scalar) and not times.null else ""
            with suppress(QuantityFault):
                factors[key.text] = read_ratio(typed).si if typed else None
                taken.append(TakenDatum(key.text, of.text, typed or "1"))
    completed, faults = _completed(source, top, index, taken, factors, find)
    return replace(completed, faults=(*source.faults, *faults))


def no_part(source: Source, find: Callable[[str], Kind]) -> Iterator[Fault]:
    """Yield a fault for a kind that cannot be a part, such as a machine, which could itself have parts."""
    name = at(source.top, ("kind",))
    if isinstance(name, Scalar) and name.text in kinds() and not find(name.text).part:
        yield Fault("no-part", name.location, {"text": name.text})


def numbered(head: str, number: int) -> str:
    """Return the name of a part: that of its kind, with a number from the second part of a kind on."""
    return f"{head}{number if number > 1 else ''}"


def files(source: Source, path: Path) -> list[Path]:
    """Return the files of the parts that a coursework's file names, leaving out those outside its folder."""
    return [file for _, file in _named(source.top, path) if not leads_out(file, path.parent)]


def _named(top: Node | None, path: Path) -> Iterator[tuple[int, Path]]:
    """Yield the files that a coursework's nodes name, by the numbers of their parts."""
    listed = at(top, (PARTS,))
    for index, item in enumerate(listed.items if isinstance(listed, SequenceNode) else ()):
        file = at(item, ("file",))
        if isinstance(file, Scalar) and not file.null:
            yield index, path.parent / file.text


def in_place(top: MappingNode, path: Path) -> tuple[MappingNode, dict[int, Source], list[Fault]]:
    """Return a coursework's table with its parts in place of their files, these files by part number, and the
    faults.
    """
    whole: Node = top
    listed = at(top, (PARTS,))
    sources: dict[int, Source] = {}
    faults: list[Fault] = []
    for index, item in enumerate(listed.items if isinstance(listed, SequenceNode) else ()):
        if not isinstance(item, MappingNode):
            continue
        source, unread = source_of(top, path, index)
        faults += unread or source.faults
        if not unread and isinstance(source.top, MappingNode):
            about = tuple(entry for entry in item.entries if entry[0].text in ABOUT and entry[0].text != "file")
            own = without(source.top, (*UNUSED, *ABOUT))
            whole = put(whole, (PARTS, index), MappingNode((*about, *own.entries), item.location))
            if item.find("file"):
                sources[index] = source
    assert isinstance(whole, MappingNode), "parts are put into a table"
    return whole, sources, faults


def named(top: MappingNode, find: Callable[[str], Kind]) -> dict[int, str]:
    """Return the names of parts by number: each is that of its kind, numbered from the second on."""
    listed, met = at(top, (PARTS,)), Counter[str]()
    names: dict[int, str] = {}
    for index, item in enumerate(listed.items if isinstance(listed, SequenceNode) else ()):
        name = at(item, ("kind",))
        if isinstance(name, Scalar) and name.text in kinds():
            head = find(name.text).part
            met[head] += 1
            names[index] = numbered(head, met[head])
    return names


def frozen(stem: str, name: str) -> str:
    """Return the name of the file of a student's part, beside the machine's: K1.cam.yaml beside K1.yaml."""
    return f"{stem}.{name}.yaml"


def is_frozen(path: Path, heads: Collection[str]) -> bool:
    """Return True if a file has the name of a student's part, for these prefixes of the names of parts."""
    _, dot, name = path.stem.rpartition(".")
    return bool(dot) and name.rstrip("0123456789") in heads


def source_of(top: MappingNode, path: Path, index: int) -> tuple[Source, list[Fault]]:
    """Return the nodes of a part by its number, and the faults that prevent reading its file."""
    table = at(top, (PARTS, index))
    assert isinstance(table, MappingNode), "the list of parts is in order"
    place = table.find("file")
    inline = without(table, ABOUT)
    if place is None or not isinstance(place[1], Scalar) or place[1].null:
        return Source(str(path), top=inline), []
    named = place[1]
    if inline.entries:
        second = inline.entries[0][0]
        return Source(str(path)), [Fault("both-given", second.location, {"first": "file", "second": second.text})]
    file = path.parent / named.text
    if leads_out(file, path.parent):
        # The file is outside the folder, so it is not read and its content is not reported.
        return Source(str(path)), [Fault("path-outside", named.location, {"text": named.text})]
    source = read_source(file)
    unread = [replace(fault, location=named.location) for fault in source.faults if fault.code == "unreadable"]
    return source, unread


def _completed(
    source: Source,
    top: MappingNode,
    index: int,
    taken: Sequence[TakenDatum],
    factors: Mapping[str, float | None],
    find: Callable[[str], Kind],
) -> tuple[Source, list[Fault]]:
    """Return the part with the values it takes, multiplied, and with the driver's sense if it is on that shaft."""
    source, faults = _with_taken(source, top, index, taken, factors)
    if not faults and any((datum.key, datum.of, datum.times) == ON_SHAFT for datum in taken):
        return _with_direction(source, top, find)
    return source, faults


def _with_taken(
    source: Source, top: MappingNode, index: int, taken: Sequence[TakenDatum], factors: Mapping[str, float | None]
) -> tuple[Source, list[Fault]]:
    """Return the part with the machine's values among its parameters."""
    node: Node | None = source.top
    faults: list[Fault] = []
    for datum in taken:
        here = (PARTS, index, "from", datum.key)
        wanted = at(top, (*here, "of"))
        where = place_of(datum.of)
        value, own = at(top, where), at(node, ("parameters", datum.key))
        assert isinstance(wanted, Scalar), "what is taken is in order"
        if not isinstance(value, Scalar) or value.null:
            known = ", ".join(_quantities(top))
            own_place = ("from", datum.key, "of")
            faults.append(Fault("no-datum", wanted.location, {"text": datum.of, "known": known}, own_place))
        elif value.text == FIND:
            own_place = ("from", datum.key, "of")
            faults.append(Fault("datum-not-yet-found", wanted.location, {"text": datum.of}, own_place))
        elif own is not None:
            faults.append(Fault("datum-twice", own.location, {"key": datum.key}, ("parameters", datum.key)))
        elif node is not None:
            times = factors[datum.key]
            text = value.text if times is None else scaled(value.text, times)
            node = put(node, ("parameters", datum.key), Scalar(text, wanted.location))
    return replace(source, top=node), faults


def _with_direction(source: Source, top: MappingNode, find: Callable[[str], Kind]) -> tuple[Source, list[Fault]]:
    """Return a part on the driver's shaft with the driver's sense of rotation, if its kind has a sense."""
    node, name = source.top, at(source.top, ("kind",))
    if node is None or not isinstance(name, Scalar) or name.text not in kinds():
        return source, []
    if DIRECTION not in find(name.text).parameters.model_fields:
        return source, []
    of_machine, own = at(top, ("positions", DIRECTION)), at(node, ("parameters", DIRECTION))
    sense = of_machine.text if isinstance(of_machine, Scalar) and not of_machine.null else ANTICLOCKWISE
    if isinstance(own, Scalar) and not own.null:
        against = own.text in SENSES and sense in SENSES and own.text != sense
        wrong = Fault("shaft-sense", own.location, {"text": own.text, "of": sense}, ("parameters", DIRECTION))
        return source, [wrong] if against else []
    return replace(source, top=put(node, ("parameters", DIRECTION), Scalar(sense, name.location))), []


def place_of(name: str) -> Where:
    """Return the path of a quantity in the machine's file: among its parameters, or in the section of its name."""
    steps = tuple(name.split("."))
    return steps if len(steps) > 1 else ("parameters", *steps)


def scaled(text: str, times: float) -> str:
    """Return a quantity as typed, multiplied by `times`, in the same unit; any other text stays unchanged."""
    typed = _TYPED.fullmatch(text)
    return f"{float(typed[1]) * times:.12g}{typed[2]}" if typed else text


def _quantities(top: MappingNode) -> Iterator[str]:
    """Yield the keys of the machine's parameters that have one value."""
    section = at(top, ("parameters",))
    for key, value in section.entries if isinstance(section, MappingNode) else ():
        if isinstance(value, Scalar):
            yield key.text
