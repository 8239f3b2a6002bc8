"""Entries of a file that have a fault but no field: unknown keys, values of the wrong form, sections that are not used.

Each gets a line that shows its text and can be removed, so that no fault is without a remedy in the form.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from reportgen.base.errors import Problem, Where
from reportgen.base.field_words import FieldWords
from reportgen.base.records import replace
from reportgen.base.yaml_source import Node
from reportgen.base.yaml_values import at, path_text
from reportgen.page.form_fields import FieldGroup, FieldLine, written_at

LOOK = "stray"


def with_strays(
    groups: Sequence[FieldGroup], top: Node | None, faults: Mapping[Where, list[Problem]]
) -> list[FieldGroup]:
    """Return the groups of a form with a line for each faulty place of the file that none of their fields covers."""
    faulty = [where for where, problems in faults.items() if any(one.level == "error" for one in problems)]
    covered = {entry.where for entry in _entries(groups) if _can_be_mended(entry)}
    homes = list(dict.fromkeys(entry.where for entry in _entries(groups) if isinstance(entry, FieldGroup)))
    strays: dict[Where, list[FieldLine]] = {}
    for where in faulty:
        node = at(top, where)
        if where and node is not None and where not in covered:
            home = max((one for one in homes if one == where[: len(one)] and one != where), key=len, default=())
            name = FieldWords(path_text(where[len(home) :]))
            line = FieldLine(where, name, LOOK, written_at(node), there=True, required=False)
            strays.setdefault(home, []).append(line)
    made = [_with_lines(group, strays) for group in groups]
    return [*made, FieldGroup((), "", entries=tuple(strays.pop(())))] if () in strays else made


def by_field(groups: Sequence[FieldGroup], faults: Mapping[Where, list[Problem]]) -> dict[Where, list[Problem]]:
    """Return faults by the places of the fields that show them: that of an equivalent key if the form hides a key."""
    lines = [entry for entry in _entries(groups) if isinstance(entry, FieldLine)]
    hidden = {(*line.where[:-1], key): line.where for line in lines for key, _ in line.instead}
    for line in lines:
        hidden.pop(line.where, None)
    by_place: dict[Where, list[Problem]] = {}
    for where, problems in faults.items():
        by_place.setdefault(hidden.get(where, where), []).extend(problems)
    return by_place


def _entries(groups: Iterable[FieldLine | FieldGroup]) -> Iterator[FieldLine | FieldGroup]:
    for entry in groups:
        yield entry
        if isinstance(entry, FieldGroup):
            yield from _entries(entry.entries)


def _can_be_mended(entry: FieldLine | FieldGroup) -> bool:
    """Return True if a field changes an entry, or fields below it do, or a button removes it."""
    if isinstance(entry, FieldLine):
        return not entry.taken
    return entry.there and (entry.of_list or entry.can_grow or any(map(_can_be_mended, entry.entries)))


def _with_lines(group: FieldGroup, strays: dict[Where, list[FieldLine]]) -> FieldGroup:
    """Return a group with the lines of its table, which are taken from `strays`."""
    own = strays.pop(group.where, [])
    inner = [_with_lines(one, strays) if isinstance(one, FieldGroup) else one for one in group.entries]
    return replace(group, entries=(*own, *inner), there=group.there or bool(own))
