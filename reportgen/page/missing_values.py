"""List what a file still lacks for each chapter of its report: the panel “What is missing for …” of the form."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from reportgen.base.errors import Location, Problem, Where
from reportgen.base.records import Record
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, Source
from reportgen.base.yaml_values import at, path_text
from reportgen.case import Case
from reportgen.case.missing_chapters import MissingChapter
from reportgen.page.form_fields import FieldGroup, FieldLine, Form

FEW = 3
"""Largest number of alternatives that are named in words; with more, buttons show the keys alone."""


class WantedKey(Record):
    """A key that is missing: its place, its name in words, and as it is written in the file."""

    where: Where
    label: str
    key: str


class MissingRow(Record):
    """Chapters that need the same: one key of each group. Without chapters, the whole report needs them."""

    chapters: tuple[str, ...]
    groups: tuple[tuple[WantedKey, ...], ...]


@dataclass
class MissingPanel:
    """The panel of one form; the chapters that a case lacks are found once."""

    _case: Case | None = None
    _chapters: Sequence[MissingChapter] = ()

    def rows(
        self, case: Case | None, problems: Sequence[Problem], form: Form | None, source: Source
    ) -> list[MissingRow]:
        """Return the rows of a file whose last valid state has this case; none for a file without a form."""
        if case is not None and case is not self._case:
            self._case, self._chapters = case, case.missing_chapters
        return missing_rows(self._chapters, problems, form, source) if form else []


def missing_rows(
    chapters: Sequence[MissingChapter], problems: Sequence[Problem], form: Form, source: Source
) -> list[MissingRow]:
    """Return the rows of the panel for a file with its problems.

    The `chapters` are those that the last valid state of the file lacks. A chapter whose keys the file has by now is
    listed only if the loader misses a key inside them.
    """
    top = source.top or MappingNode((), Location(source.file))
    fields = dict(_fields(form.groups))
    faults = [problem for problem in problems if problem.missing and problem.location.file == source.file]
    wanted: dict[tuple[tuple[Where, ...], ...], list[str]] = {}
    of_report = list(faults)
    for chapter in chapters:
        keys = [key for group in chapter.wanted for key in group]
        own = [fault for fault in faults if any(_concerns(fault, key) for key in keys)]
        begun = {key for fault in own for key in keys if _is_within(fault.missing[0], key)}
        groups = [group for group in chapter.wanted if not any(key in begun or _is_given(top, key) for key in group)]
        of_report = [fault for fault in of_report if fault not in own]
        if needed := dict.fromkeys((*groups, *(fault.missing for fault in own))):
            wanted.setdefault(tuple(needed), []).append(chapter.title)
    first = [MissingRow((), tuple(_keys(fault.missing, fields) for fault in of_report))] if of_report else []
    return [
        *first,
        *(MissingRow(tuple(of), tuple(_keys(group, fields) for group in key)) for key, of in wanted.items()),
    ]


def _concerns(fault: Problem, key: Where) -> bool:
    """Return True if a fault is at a key or inside it, or misses something there."""
    return _is_within(fault.where, key) or _is_within(fault.missing[0], key)


def _is_within(where: Where, key: Where) -> bool:
    return where[: len(key)] == key


def _is_given(top: Node, where: Where) -> bool:
    match at(top, where):
        case None | Scalar(null=True) | MappingNode(entries=()) | SequenceNode(items=()):
            return False
        case _:
            return True


def _fields(groups: Sequence[FieldLine | FieldGroup]) -> Iterator[tuple[Where, str]]:
    """Yield the name of every field and group of a form, by its place."""
    for entry in groups:
        if isinstance(entry, FieldLine):
            yield entry.where, entry.words.label
        else:
            yield entry.where, entry.title
            yield from _fields(entry.entries)


def _keys(group: Sequence[Where], fields: dict[Where, str]) -> tuple[WantedKey, ...]:
    """Return the keys of a group; of those that give the same quantity, the one that has a field."""
    offered = [where for where in group if where in fields] or group
    return tuple(WantedKey(where, fields.get(where, str(where[-1])), path_text(_own(where))) for where in offered)


def _own(where: Where) -> Where:
    return where[1:] if where[0] == "parameters" and len(where) > 1 else where
