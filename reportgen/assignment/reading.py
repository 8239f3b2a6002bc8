"""Read an assignment file into an `Assignment`, or report all its faults: nodes → sections → checks → words."""

from __future__ import annotations

import os
import unicodedata
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, TypeAdapter, ValidationError
from pydantic_core import ErrorDetails

from reportgen.assignment import lengths_of_parts, parts
from reportgen.assignment.checks import instants, school_of, worked_positions
from reportgen.assignment.common import PARTS, Assignment, Draft, Drawing, Kind, Positions, sections
from reportgen.assignment.fields import RESERVED
from reportgen.assignment.schema import keys_at, section_schema
from reportgen.assignment.suggestions import with_suggestions
from reportgen.base.errors import Fault, Finding, Location, Where
from reportgen.base.files import contents, leads_out
from reportgen.base.records import replace
from reportgen.base.template_folders import is_of_atlas, school_files
from reportgen.base.typing_mistakes import meant, slip
from reportgen.base.units import Language, two_readings
from reportgen.base.words import as_error, close_or_known, language_of
from reportgen.base.yaml_source import (
    MappingNode,
    Node,
    Scalar,
    SequenceNode,
    Source,
    plain,
    read_source,
    read_text,
    text_in,
)
from reportgen.base.yaml_values import at

Model = TypeVar("Model", bound=BaseModel)
_WHOLE = "file"
MISTYPED = frozenset(
    {
        "unknown-key",
        "unknown-kind",
        "unknown-machine",
        "wrong-type",
        "choice",
        "not-a-number",
        "unknown-unit",
        "date",
        "moment",
    }
)
"""Faults that may be caused by a typing mistake."""
_CONTROLS = {"Cc", "Cf", "Cs", "Zl", "Zp"}


def assess(
    source: Source, path: Path, kinds: Collection[str], find: Callable[[str], Kind]
) -> tuple[Assignment | None, list[Fault]]:
    """Return the assignment of nodes that were read from `path` or put together from several files; else its faults.

    `kinds` are those that a file may name; `find` returns the data of one of them.
    """
    top, faults = _top(source)
    if top is None:
        return None, faults
    solution = _with_lengths(top, path, kinds, find)
    top = solution.top
    raw: dict[str, Any] = plain(top)
    name = raw.get("kind")
    kind = find(name) if isinstance(name, str) and name in kinds else None
    findings, draft = _sections(raw, kind)
    if kind is None:
        findings.insert(0, _no_kind(name, kinds))
    else:
        numbered = (instants, worked_positions(kind.turns, kind.labels)) if kind.has_positions else ()
        for check_one in (school_of(path), *_given(kind, raw).all_checks, *numbered):
            places = {finding.where for finding in findings}
            findings += [finding for finding in check_one(draft) if finding.where not in places]
    # The source has already refused these nodes; they are not checked again.
    refused = {fault.location.line for fault in faults if fault.code in {"alias", "tag", "tab"}}
    placed = [_placed(finding, top) for finding in _without_renamed(findings)]
    faults += [fault for fault in placed if fault.location.line not in refused]
    faults = [*solution.faults, *lengths_of_parts.without_missing(faults, solution.missing)]
    if faults or kind is None:
        return None, faults
    values = {"positions": Positions(), "drawing": Drawing(), "indicator": None, **draft.sections}
    named = values.pop(PARTS, ())
    assignment = Assignment(kind.name, **values, source=path, id=path.stem, turns=kind.turns, names=kind.labels)
    assignment = replace(assignment, lengths=tuple(solution.lengths))
    if not named:
        return assignment, []
    members, faults = parts.read(top, path, named, find, lambda source, file: assess(source, file, kinds, find))
    return (None if faults else replace(assignment, parts=tuple(members))), faults


def unchecked(source: Source, path: Path, kinds: Collection[str], find: Callable[[str], Kind]) -> Assignment | None:
    """Return the assignment of nodes without its parts and without the checks of several values.

    Return None if the kind is unknown or a single value is faulty.
    """
    top, faults = _top(source)
    raw: dict[str, Any] = {} if top is None else plain(_with_lengths(top, path, kinds, find).top)
    name = raw.get("kind")
    if faults or not isinstance(name, str) or name not in kinds:
        return None
    kind = find(name)
    findings, draft = _sections(raw, kind)
    if findings:
        return None
    values = {"positions": Positions(), "drawing": Drawing(), "indicator": None, **draft.sections}
    values.pop(PARTS, ())
    return Assignment(kind.name, **values, source=path, id=path.stem, turns=kind.turns, names=kind.labels)


def in_coursework(
    source: Source, path: Path, whole: Path, kinds: Collection[str], find: Callable[[str], Kind]
) -> Source:
    """Return the nodes of a part's file with the values that it takes from the coursework `whole`, and faults."""
    return parts.in_coursework(source, path, whole, find, lambda top: _with_lengths(top, whole, kinds, find).top)


def _with_lengths(
    top: MappingNode, path: Path, kinds: Collection[str], find: Callable[[str], Kind]
) -> lengths_of_parts.SolvedParts:
    """Return the nodes of a machine's file with the lengths that its parts give."""
    return lengths_of_parts.solved(top, path, find, lambda source, file: assess(source, file, kinds, find))


def name_faults(path: Path) -> Iterator[Fault]:
    """Yield faults unless a file's name, without its ending, is a valid folder name on any system and lies below."""
    stem = path.stem
    printable = "".join(character for character in stem if unicodedata.category(character) not in _CONTROLS)
    if os.path.isdir(path):
        # A folder in place of a file is reported as such.
        return
    outside = stem.strip(" .") == "" or stem != printable.strip() or stem.endswith(".")
    if outside or RESERVED.fullmatch(stem.partition(".")[0].strip().upper()):
        yield Fault("file-name", Location(str(path)), {"text": stem})


def inputs(path: Path) -> tuple[bytes, dict[str, bytes]]:
    """Return an assignment file, and the files it names, by their relative paths: a school's words, files of parts.

    Raises `OSError` for a file that cannot be read.
    """
    content = contents(path)
    named = parts.files(_source_with(PARTS, path), path)
    of_parts = {file.relative_to(path.parent).as_posix(): contents(file) for file in named if file.is_file()}
    return content, {**words_beside(path), **of_parts}


def words_beside(path: Path) -> dict[str, bytes]:
    """Return the files of the school's folder that an assignment file names beside itself, by their relative paths."""
    named = at(_source_with("templates", path).top, ("report", "templates"))
    if not isinstance(named, Scalar) or named.null or leads_out(path.parent / named.text, path.parent):
        return {}
    files = (file for file in school_files(path.parent / named.text) if not leads_out(file, path.parent))
    return {file.relative_to(path.parent).as_posix(): contents(file) for file in files}


def _source_with(key: str, path: Path) -> Source:
    """Return the nodes of a file; none if its text does not have a key: most files have not, and are not parsed."""
    text = text_in(path)
    return read_text(text, str(path)) if isinstance(text, str) and key in text else Source(str(path))


def read_model(path: Path, model: type[Model], language: Language | None = None) -> Model:
    """Return the content of a file other than an assignment, e.g. a marking policy.

    Raises `AssignmentError` with every fault of the file.
    """
    source = read_source(path)
    value, faults = model_of(source, model)
    if faults or value is None:
        raise as_error(faults, language or language_of(source))
    return value


def model_of(source: Source, model: type[Model]) -> tuple[Model | None, list[Fault]]:
    """Return the content of nodes that are not an assignment, and their faults."""
    top, faults = _top(source)
    if top is None:
        return None, faults
    value, findings = read_section(_WHOLE, model, plain(top))
    return value, [*faults, *(_placed(replace(finding, where=finding.where[1:]), top) for finding in findings)]


def read_section(key: str, model: type[Model], content: Any) -> tuple[Model | None, list[Finding]]:
    """Return plain content as a model, and its faults at places below `key`."""
    value: Model | None
    value, findings = _section(key, model, content, lambda: {key: (model, ...)})
    return value, findings


def placed(source: Source, findings: Iterable[Finding]) -> list[Fault]:
    """Return findings with their locations in a file that was read."""
    top = _top(source)[0]
    return [] if top is None else [_placed(finding, top) for finding in findings]


def misread(top: MappingNode, kind: Kind) -> list[Fault]:
    """Return the faults of single values and keys, without the checks of several values."""
    return [_placed(finding, top) for finding in _sections(plain(top), kind)[0]]


WORDED = frozenset({"kind", "variant", "report", "sheet", "title", "file", "salt"})
"""Keys whose values are never quantities, even if the text looks like one."""


def doubtful(source: Source) -> Iterator[Fault]:
    """Yield notes on keys without a value, and on numbers that may be meant as thousands (1.400 N), with their
    reading.
    """
    yield from _doubtful(source.top)


def doubtful_parts(source: Source, path: Path) -> Iterator[Fault]:
    """Yield the same as `doubtful` for the files of a coursework's parts."""
    for file in parts.files(source, path):
        yield from doubtful(read_source(file))


def _doubtful(node: Node | None) -> Iterator[Fault]:
    match node:
        case MappingNode(entries):
            for key, value in entries:
                if key.text in WORDED:
                    continue
                if isinstance(value, Scalar) and value.null:
                    yield Fault("left-empty", key.location, {"key": key.text})
                yield from _doubtful(value)
        case SequenceNode(items):
            texts = [item.text for item in items if isinstance(item, Scalar)]
            # Beside 0.125, a bare 1.250 has only one reading: the list uses the decimal point.
            plain_points = any("." in text and two_readings(text) is None for text in texts)
            for item in items:
                bare = isinstance(item, Scalar) and item.text.strip()[-1:].isdigit()
                if not (bare and plain_points):
                    yield from _doubtful(item)
        case Scalar(text, mark):
            if readings := two_readings(text):
                yield Fault("thousands", mark, {"text": text, "fixed": readings[0], "other": readings[1]})


def _top(source: Source) -> tuple[MappingNode | None, list[Fault]]:
    """Return the table at the top of a file, and the file's faults."""
    faults = list(source.faults)
    if isinstance(source.top, MappingNode):
        return source.top, faults
    if source.top is not None and not faults:
        wrong = Fault("wrong-type", source.top.location, {"expected": "mapping"})
        faults.append((isinstance(source.top, Scalar) and slip(source.top.text, source.top.location)) or wrong)
    return None, faults


def _no_kind(name: object, kinds: Collection[str]) -> Finding:
    if name is None:
        return Finding("missing-key", ("kind",), {"key": "kind"})
    if not isinstance(name, str):
        return Finding("wrong-type", ("kind",), {"expected": "text"})
    code = "unknown-machine" if is_of_atlas(name) else "unknown-kind"
    return Finding(code, ("kind",), {"text": name, **close_or_known(name, list(kinds))})


def _sections(raw: dict[str, Any], kind: Kind | None) -> tuple[list[Finding], Draft]:
    """Read each section on its own, so that the checks can examine valid ones even if others are faulty."""
    known, whole = sections(None if kind is None else _asking(kind, raw)), partial(sections, kind)
    findings: list[Finding] = []
    valid: dict[str, Any] = {}
    for key in raw.keys() - known.keys() - {"kind"}:
        # The own sections of an unknown kind are unknown too: only the kind is reported.
        if kind is not None or key not in {"parameters", "indicator"}:
            findings.append(_unknown((key,), ["kind", *known]))
    for key, (type_, default) in known.items():
        if raw.get(key) is not None:
            valid[key], faulty = _section(key, type_, raw[key], whole)
            findings += faulty
        elif default is ...:
            findings.append(Finding("missing-key", (key,), {"key": key}))
        else:
            valid[key] = default
    if kind is not None and findings:
        findings = with_suggestions(findings, kind, raw)
    return findings, Draft(raw, {key: value for key, value in valid.items() if value is not None})


def _asking(kind: Kind, raw: Mapping[str, Any]) -> Kind:
    """Return the kind with the topics that the file names."""
    parameters = raw.get("parameters")
    return kind.asking(parameters if isinstance(parameters, dict) else ())


def _given(kind: Kind, raw: Mapping[str, Any]) -> Kind:
    """Return the kind with those of its topics whose section is not left empty."""
    parameters = raw.get("parameters")
    table = parameters if isinstance(parameters, dict) else {}
    return kind.asking([key for key, value in table.items() if value is not None])


def _section(
    key: str, type_: Any, content: Any, whole: Callable[[], Mapping[str, tuple[Any, Any]]]
) -> tuple[Any, list[Finding]]:
    """Return the section's value (None if it has none) and its faults; unknown keys alone do not invalidate the value.

    `whole` returns the sections with all topics; an unknown key is compared with all their keys.
    """
    adapter: TypeAdapter[Any] = TypeAdapter(type_)
    try:
        return adapter.validate_python(content), []
    except ValidationError as error:
        details = _telling(error.errors(include_url=False))
    schema = section_schema(whole()[key][0]) if any(one["type"] == "extra_forbidden" for one in details) else {}
    findings = [_finding(key, detail, content, schema) for detail in details]
    if all(detail["type"] == "extra_forbidden" for detail in details):
        return adapter.validate_python(content, extra="ignore"), findings
    return None, findings


def _telling(details: list[ErrorDetails]) -> list[ErrorDetails]:
    """Return the faults without those of a list's length that only follow from faults of its items."""
    inner = {detail["loc"][:depth] for detail in details for depth in range(len(detail["loc"]))}
    return [one for one in details if one["type"] != "too_short" or one["loc"] not in inner]


def _finding(key: str, detail: ErrorDetails, content: Any, schema: dict[str, Any]) -> Finding:
    """Return a pydantic fault as a finding with one of this program's codes."""
    where = (key, *_real(detail["loc"], content))
    if where[-1] == _OF_KEY:
        return replace(_finding(key, {**detail, "loc": detail["loc"][:-1]}, content, schema), at="key")
    if detail["type"] not in _ABSENT:
        where = _written(where, {key: content})
    context = detail.get("ctx", {})
    match detail["type"]:
        case "fault":
            arguments = {name: str(value) for name, value in context.items() if name != "code"}
            return Finding(str(context["code"]), where, arguments)
        case "missing":
            return Finding("missing-key", where, {"key": str(where[-1])})
        case "union_tag_not_found":
            name = str(context["discriminator"]).strip("'")
            return Finding("missing-key", (*where, name), {"key": name})
        case "extra_forbidden":
            return _unknown(where, keys_at(schema, where[1:-1]))
        case "literal_error" | "union_tag_invalid":
            tag = str(context.get("discriminator", "")).strip("'")
            allowed = str(context.get("expected", context.get("expected_tags"))).replace(" or ", ", ")
            place = (*where, tag) if tag else where
            return Finding("choice", place, {"allowed": allowed.replace("'", "")})
        case "too_short":
            return Finding("too-few", where, {"least": str(context["min_length"])})
        case "too_long":
            return Finding("too-many", where, {"most": str(context["max_length"])})
        case kind:
            expected = "list" if kind in {"list_type", "tuple_type"} else "mapping"
            return Finding("wrong-type", where, {"expected": expected})


_OF_KEY = "[key]"
"""Last step of the place of a fault that is one of a key, not of its value."""
_ABSENT = frozenset({"missing", "union_tag_not_found", "extra_forbidden"})
"""Types of faults at places that may not exist in the file."""


def _written(where: Where, content: Any) -> Where:
    """Return the place without last steps that are not in the file: pydantic names the member of a union there."""
    for depth, step in enumerate(where):
        inside = isinstance(content, dict) and step in content
        if not inside and not (isinstance(content, list) and isinstance(step, int) and step < len(content)):
            return where[:depth]
        content = content[step]
    return where


def _unknown(where: Where, known: Sequence[str]) -> Finding:
    key = str(where[-1])
    return Finding("unknown-key", where, {"key": key, **close_or_known(meant(key), known)}, at="key")


def _without_renamed(findings: Sequence[Finding]) -> list[Finding]:
    """Return the findings without those of keys that are missing only because they are misspelt."""
    misspelt = {
        (finding.where[:-1], finding.arguments["close"])
        for finding in findings
        if finding.code == "unknown-key" and "close" in finding.arguments
    }
    return [
        finding
        for finding in findings
        if finding.code != "missing-key"
        or not any((finding.where[:-1], key) in misspelt for key in finding.arguments["key"].split(" | "))
    ]


def _real(location: Where, content: Any) -> Iterator[str | int]:
    """Yield the steps that exist in the file: pydantic also names the member of a union that it chose."""
    for number, step in enumerate(location):
        last = number == len(location) - 1
        if isinstance(content, dict):
            # The member of a union may have the name of one of its keys: `by: way` beside `way: [...]`.
            named_alike = not last and isinstance(location[number + 1], str) and isinstance(content.get(step), list)
            if step in content and not named_alike:
                content = content[step]
            elif not last:
                continue
        elif isinstance(content, list) and isinstance(step, int) and step < len(content):
            content = content[step]
        yield step


def _placed(finding: Finding, top: MappingNode) -> Fault:
    """Return the finding with its location; a missing value is reported at the key of its table."""
    node: Node = top
    key_location = top.location
    for step in finding.where:
        entry = node.find(step) if isinstance(node, MappingNode) else None
        if entry is not None:
            key, node = entry
            key_location = key.location
            continue
        if isinstance(node, SequenceNode) and isinstance(step, int) and step < len(node.items):
            node = node.items[step]
            key_location = node.location
            continue
        return Fault(finding.code, key_location, finding.arguments, finding.where)
    unwritten = isinstance(node, Scalar) and node.null
    at_key = finding.at == "key"
    location: Location = key_location if at_key or unwritten else node.location
    text = str(finding.where[-1]) if at_key else node.text if isinstance(node, Scalar) and not node.quoted else ""
    # Faults of a valid value, for example that it is out of range, stay.
    mistyped = slip(text, location) if finding.code in MISTYPED else None
    if mistyped is not None:
        return replace(mistyped, where=finding.where)
    return Fault(finding.code, location, finding.arguments, finding.where)
