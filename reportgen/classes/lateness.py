"""Days of delay of each sheet, from the roster's own column or else the platform's table.

A student without a date counts as on time. A warning reports this if the policy deducts marks for lateness.
"""

from __future__ import annotations

import datetime
from collections.abc import Mapping

from reportgen.base.errors import Fault, Location, Problem
from reportgen.base.records import Record
from reportgen.base.timestamps import moment
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.base.yaml_source import Scalar
from reportgen.classes.gradebooks import Gradebook, Participant
from reportgen.marking.marking_policy import Lateness

NONE = frozenset({"", "-", "–"})
"""Texts that mean a missing date."""


class Handing(Record):
    """Submission data of a sheet: the roster's date, and whether the platform calls it late."""

    student: Participant
    file: str
    said: Scalar | None
    late: bool


def days_late(
    rule: Lateness, handings: Mapping[str, Handing], gradebook: Gradebook | None, language: Language | None
) -> tuple[dict[str, int], list[Problem]]:
    """Return the days of delay by assignment, and problems for unreadable or missing dates."""
    days: dict[str, int] = {}
    faults: list[Fault] = []
    undated: list[Handing] = []
    for name, handing in handings.items():
        handed_in = _handed_in(handing, gradebook)
        if isinstance(handed_in, Fault):
            faults.append(handed_in)
        elif handed_in is None and handing.late:
            faults.append(Fault("late-undated", Location(handing.file), {"text": handing.student.who}))
        elif handed_in is None:
            undated.append(handing)
        else:
            days[name] = rule.days(handed_in)
    problems = [as_problem(fault, language) for fault in faults]
    if undated:
        about = {"count": str(len(undated)), "known": ", ".join(handing.student.who for handing in undated)}
        problems.append(as_problem(Fault("late-unknown", Location(undated[0].file), about), language, "warning"))
    return days, problems


def _handed_in(handing: Handing, gradebook: Gradebook | None) -> datetime.datetime | Fault | None:
    """Return the submission time, None if there is none, or a fault for a date that cannot be read."""
    text = gradebook.handed_in(handing.student) if gradebook else ""
    said, location = (handing.said.text, handing.said.location) if handing.said else (text, None)
    if said.strip() in NONE:
        return None
    place = location or Location(str(gradebook.path) if gradebook else handing.file)
    return moment(said) or Fault("moment", place, {"text": said})
