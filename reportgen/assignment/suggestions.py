"""Recognise what was meant by faulty keys and values of a section, and say it in one finding with a hint.

`reading` calls `with_suggestions` when a file has faults.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from reportgen.assignment.common import Kind
from reportgen.assignment.fields import UNIT_KEY
from reportgen.assignment.schema import alternatives_to, choices_of, file_schema, keys_at, places
from reportgen.base.errors import Finding, Where
from reportgen.base.records import replace
from reportgen.base.units import measures

SECTION = "parameters"
ENOUGH = 2
"""Number of misplaced parameters from which a deleted line `parameters:` is assumed."""


def with_suggestions(findings: Sequence[Finding], kind: Kind, content: Mapping[str, Any]) -> list[Finding]:
    """Return the findings of a file with what was meant: another key, a choice, or a section whose line is missing."""
    return [_suggested(finding, kind, content) for finding in _with_section(findings, kind)]


def _with_section(findings: Sequence[Finding], kind: Kind) -> list[Finding]:
    """Return the findings with one in place of many if the keys of the section of parameters have lost its line."""
    absent = [finding for finding in findings if finding.code == "missing-key" and finding.where == (SECTION,)]
    if not absent:
        return list(findings)
    known = set(keys_at(file_schema(kind), (SECTION,)))
    stray = [finding for finding in findings if finding.code == "unknown-key" and finding.where[-1] in known]
    if len(stray) < ENOUGH:
        return list(findings)
    about = {"key": SECTION, "text": str(stray[0].where[-1])}
    missing = Finding("missing-section", stray[0].where, about, at="key")
    gone = [*absent, *stray]
    return [missing, *(finding for finding in findings if finding not in gone)]


def _suggested(finding: Finding, kind: Kind, content: Mapping[str, Any]) -> Finding:
    value = _value(content, finding.where)
    if finding.code == "wrong-unit" and "fixed" not in finding.arguments and isinstance(value, str):
        for key in _keys_for(finding.arguments["given"], finding.where, kind):
            return replace(finding, arguments={**finding.arguments, "hint": "other-key", "key": key, "text": value})
    if finding.code == "wrong-type" and isinstance(value, str):
        schema = file_schema(kind)
        choices = [choice for form in places(schema, schema, finding.where) for choice in choices_of(form)]
        if len(choices) == 1:
            return replace(finding, arguments={**finding.arguments, "hint": "or-choice", "fixed": choices[0]})
    return finding


def _keys_for(unit: str, where: Where, kind: Kind) -> Iterator[str]:
    """Yield the keys with the same meaning as that of a place, which take quantities with this unit."""
    path = [step for step in where if isinstance(step, str)]
    schema = file_schema(kind)
    for key in alternatives_to(kind, path):
        units = [form[UNIT_KEY] for form in places(schema, schema, (*where[:-1], key)) if UNIT_KEY in form]
        if any(measures(unit, like) for like in units):
            yield key


def _value(content: Any, where: Where) -> object:
    """Return the value at a place; None if there is none."""
    for step in where:
        try:
            content = content[step]
        except (KeyError, IndexError, TypeError):
            return None
    return content
