"""What students hand in without an answer sheet, the Word report and the drawing: what was read of it, and what not.

A reader gives a `FileReading` of one file, `submission` joins those of one student to what is marked.  What stands in a
file but is not read beyond doubt is *unread*: it neither earns nor costs anything until somebody settles it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from reportgen.base.errors import Fault
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.marking.marks import Answer, Place, Submission

SAME = 1e-3
"""Two values of one place that differ by no more than this share are one, rounded differently."""


@dataclass(frozen=True)
class FileReading:
    """One file of a student by places: the values that were read, and the faults for which others were not.

    A value is in the row's printed unit, and its mark says where in the file it stands.  `notes` tell of the file as a
    whole: objects that nothing opened, a template that it names.
    """

    assignment: str
    file: str
    values: Mapping[Place, Answer]
    unread: Mapping[Place, Fault] = field(default_factory=dict)
    notes: tuple[Fault, ...] = ()

    @property
    def share(self) -> float:
        """The share of what stands in the file that was read, 1 where nothing stands there."""
        count = len(self.values) + len(self.unread)
        return len(self.values) / count if count else 1.0


def submission(readings: Sequence[FileReading], language: Language | None) -> Submission:
    """The readings of one student's files as what is marked, faults worded in `language`.

    A place with two values, here and there, is unread; one that only a single file leaves unread has the other's.
    """
    values: dict[Place, Answer] = {}
    unread: dict[Place, Fault] = {}
    for reading in readings:
        for place, answer in reading.values.items():
            first = values.setdefault(place, answer)
            if not same(first.value, answer.value):
                unread[place] = Fault("unread-two-values", answer.mark, {"text": answer.text, "first": first.text})
    for place in unread:
        del values[place]
    for reading in readings:
        unread |= {place: fault for place, fault in reading.unread.items() if place not in values | unread}
    first_reading = readings[0]
    return Submission(
        first_reading.assignment,
        first_reading.file,
        values,
        problems={},
        notes=tuple(as_problem(note, language, "note") for reading in readings for note in reading.notes),
        rows=frozenset(id for id, _ in (*values, *unread)),
        unread={place: as_problem(fault, language) for place, fault in unread.items()},
        own_files=True,
    )


def same(first: float, second: float) -> bool:
    """Whether two numbers are one value, written to more or fewer figures."""
    return math.isclose(first, second, rel_tol=SAME, abs_tol=1e-12)
