"""How late each sheet was handed in: by the roster's own column, else by the platform's table.

Whom neither gives a date for counts as in time, and is told of where the policy takes something off for lateness.
"""

from __future__ import annotations

import datetime
from collections.abc import Mapping
from dataclasses import dataclass

from reportgen.base.errors import Fault, Mark, Problem
from reportgen.base.moments import moment
from reportgen.base.source import Scalar
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.classes.gradebooks import Gradebook, Participant
from reportgen.marking.policy import Lateness

NONE = frozenset({"", "-", "–"})
"""What stands in place of a date that there is not."""


@dataclass(frozen=True, slots=True)
class Handing:
    """What is known of when a sheet was handed in: the roster's word, and whether the platform calls it late."""

    student: Participant
    file: str
    said: Scalar | None
    late: bool


def days_late(
    rule: Lateness, handings: Mapping[str, Handing], gradebook: Gradebook | None, language: Language | None
) -> tuple[dict[str, int], list[Problem]]:
    """The days of each assignment by a rule of lateness, and dates that cannot be read or are missing."""
    days: dict[str, int] = {}
    faults: list[Fault] = []
    undated: list[Handing] = []
    for name, handing in handings.items():
        handed_in = _handed_in(handing, gradebook)
        if isinstance(handed_in, Fault):
            faults.append(handed_in)
        elif handed_in is None and handing.late:
            faults.append(Fault("late-undated", Mark(handing.file), {"text": handing.student.who}))
        elif handed_in is None:
            undated.append(handing)
        else:
            days[name] = rule.days(handed_in)
    problems = [as_problem(fault, language) for fault in faults]
    if undated:
        about = {"count": str(len(undated)), "known": ", ".join(handing.student.who for handing in undated)}
        problems.append(as_problem(Fault("late-unknown", Mark(undated[0].file), about), language, "warning"))
    return days, problems


def _handed_in(handing: Handing, gradebook: Gradebook | None) -> datetime.datetime | Fault | None:
    """When it was handed in, None where nobody says it; a fault for a date that cannot be read."""
    text = gradebook.handed_in(handing.student) if gradebook else ""
    said, mark = (handing.said.text, handing.said.mark) if handing.said else (text, None)
    if said.strip() in NONE:
        return None
    place = mark or Mark(str(gradebook.path) if gradebook else handing.file)
    return moment(said) or Fault("moment", place, {"text": said})
