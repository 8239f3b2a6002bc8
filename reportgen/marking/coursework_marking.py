"""Mark a coursework part by part: `sheets_of` divides a sheet, each part is judged by its own ledger, `joined` joins.

In the coursework, ids are prefixed with the part's name; the part itself uses the ids of its kind.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from reportgen.assignment.reading import placed
from reportgen.base.errors import Finding
from reportgen.base.records import Record, replace
from reportgen.base.units import Language
from reportgen.base.words import as_error
from reportgen.base.yaml_source import read_source
from reportgen.case.answer_key import Key, PartOfKey
from reportgen.formula.vocabulary import KINDS
from reportgen.marking.authenticity import Classmate
from reportgen.marking.marking_data import Marked, Marking, Notice, Place, Submission
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import MarkingScheme


class PartSubmission(Record):
    """The share of a sheet that belongs to one part: its scheme, values and classmates, by the part's own ids."""

    part: PartOfKey
    scheme: MarkingScheme
    submission: Submission
    classmates: tuple[Classmate, ...]


def sheets_of(
    scheme: MarkingScheme, submission: Submission, classmates: Sequence[Classmate]
) -> Iterator[PartSubmission]:
    """Yield the parts of a coursework's sheet in order, weighted with their shares of the mark."""
    pages = {part.name: page for part, (_, page) in zip(scheme.key.parts, scheme.key.pages, strict=True)}
    earned = {
        name: sum(scheme.policy.worth(row.id) * len(row.positions) for row in page.asked)
        for name, page in pages.items()
    }
    for part, alone in zip(scheme.key.parts, scheme.parts, strict=True):
        page = pages[part.name]
        factor = share(scheme.policy.parts, earned, part.name)
        worths = {part.own(row.id): factor * scheme.policy.worth(row.id) for row in page.rows}
        key = _own_key(page, part)
        policy = replace(scheme.policy, weights=worths)
        mates = (_own_classmate(classmate, part.name) for classmate in classmates)
        own = replace(alone, key=key, policy=policy)
        sheet = _own_submission(submission, scheme.key, part)
        if part is scheme.key.parts[0]:
            sheet = replace(sheet, of_parts=dict(_lengths_of_parts(scheme, submission)))
        yield PartSubmission(part, own, sheet, tuple(filter(None, mates)))


def _lengths_of_parts(scheme: MarkingScheme, submission: Submission) -> Iterator[tuple[str, float]]:
    """Yield the student's own lengths (SI) that the machine takes from other parts, by their ids in its ledger.

    A link's length has no sign.
    """
    for id, source in scheme.sources.items():
        given = submission.values.get((source, 0))
        if given is not None and given.value:
            yield id, abs(given.value) * KINDS[scheme.key.row(source).kind].scale


def share(shares: Mapping[str, float], earned: Mapping[str, float], name: str) -> float:
    """Return the factor for a part's points that gives it its share of all points; 1 without shares."""
    if not shares or not earned[name]:
        return 1.0
    here = {one: shares.get(one, 0.0) for one in earned if earned[one]}
    return here[name] / (sum(here.values()) or 1.0) * sum(earned.values()) / earned[name]


def _own_key(page: Key, part: PartOfKey) -> Key:
    rows = (replace(row, id=part.own(row.id), size=part.own(row.size)) for row in page.rows)
    return replace(page, rows=tuple(rows))


def _own_submission(whole: Submission, key: Key, part: PartOfKey) -> Submission:
    """Return the entries of a submission that belong to a part."""

    def own(values: Mapping[Place, Any]) -> dict[Place, Any]:
        return {(part.own(id), k): one for (id, k), one in values.items() if key.owner(id) == part.name}

    rows = frozenset(part.own(id) for id in whole.rows if key.owner(id) == part.name)
    return replace(
        whole,
        values=own(whole.values),
        problems=own(whole.problems),
        notes=(),
        rows=rows,
        unread=own(whole.unread),
        measured=own(whole.measured),
        drawn=frozenset(own(dict.fromkeys(whole.drawn))),
        # Hidden text is reported for the whole report.
        unseen=frozenset(),
    )


def _own_classmate(classmate: Classmate, name: str) -> Classmate | None:
    """Return the same part of a classmate's work, or None if there is none."""
    for part, (_, page) in zip(classmate.key.parts, classmate.key.pages, strict=False):
        if part.name == name:
            sheet = classmate.submission and _own_submission(classmate.submission, classmate.key, part)
            return Classmate(_own_key(page, part), sheet)
    return None


def joined(scheme: MarkingScheme, submission: Submission, marked: Sequence[tuple[PartOfKey, Marking]]) -> Marking:
    """Return one marking of the whole sheet."""
    cells = [_full_cell(cell, part) for part, marking in marked for cell in marking.cells]
    flags = [_full_notice(flag, part) for part, marking in marked for flag in marking.flags]
    return Marking(scheme.key, submission, tuple(cells), tuple(flags))


def _full_cell(cell: Marked, part: PartOfKey) -> Marked:
    return replace(cell, id=part.full(cell.id), where=part.full(cell.where))


def _full_notice(flag: Notice, part: PartOfKey) -> Notice:
    def full(places: Sequence[Place]) -> tuple[Place, ...]:
        return tuple((part.full(id), k) for id, k in places)

    return replace(flag, places=full(flag.places), spoiled=full(flag.spoiled), taken=full(flag.taken))


def check_shares(policy: Policy, keys: Sequence[Key], language: Language | None) -> None:
    """Raise `AssignmentError`, located in the policy, for shares of unknown parts and for parts without a share."""
    if policy.file is None or not policy.parts:
        return
    names = dict.fromkeys(part.name for key in keys for part in key.parts)
    known = ", ".join(names)
    findings = [
        Finding("unknown-key", ("parts", name), {"key": name, "known": known}, at="key")
        for name in policy.parts
        if name not in names
    ]
    findings += [Finding("missing-key", ("parts", name), {"key": name}) for name in names if name not in policy.parts]
    if names and findings:
        raise as_error(placed(read_source(policy.file), findings), language)
