"""What students hand in without an answer sheet, the Word report and the drawing: what was read of it, and what not.

A reader gives a `FileReading` of one file, `submission` joins those of one student to what is marked.  What stands in a
file but is not read beyond doubt is *unread*: it neither earns nor costs anything until somebody settles it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from reportgen.base.errors import Fault, Mark
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.marking.marks import Answer, Place, ReadOff, Submission

FEWEST_FIGURES = 2
"""Figures that a number has been written with at least."""
SAME = 5e-3
"""Two values of a place that differ by less are one: worked out from other roundings, as by a plan and by a formula.
Marking takes no smaller share of a quantity for wrong."""
_FIGURES = re.compile(r"[1-9]\d*(?:[.,]\d+)?|0?[.,]0*(\d+)")


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
    measured: Mapping[Place, ReadOff] = field(default_factory=dict)
    """How the values of a drawing were read."""
    drawn: frozenset[Place] = frozenset()
    """The places of which a drawing has to show something."""
    unseen: frozenset[Place] = frozenset()
    """The places of which the file says something in text that nobody sees, which is not read."""
    beside: Mapping[Place, Mark] = field(default_factory=dict)
    """Where a drawing has a wrong vector, by its length, that nothing asks for."""

    @property
    def share(self) -> float:
        """The share of what stands in the file that was read, 1 where nothing stands there."""
        count = len(self.values) + len(self.unread)
        return len(self.values) / count if count else 1.0


def submission(readings: Sequence[FileReading], language: Language | None) -> Submission:
    """The readings of one student's files as what is marked, faults worded in `language`.

    A place with two values, here and there, is unread; one that only a single file leaves unread has the other's.  What
    is written counts before what is measured on a drawing, which is at another scale.
    """
    values: dict[Place, Answer] = {}
    unread: dict[Place, Fault] = {}
    measured: dict[Place, ReadOff] = {}
    readings = sorted(readings, key=lambda reading: bool(reading.measured))
    for reading in readings:
        if reading.measured:
            further = {place: answer for place, answer in reading.values.items() if place not in values}
            measured |= {place: reading.measured[place] for place in further}
            values |= further
            continue
        for place, answer in reading.values.items():
            first = values.setdefault(place, answer)
            if not agree(first, answer):
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
        measured={place: how for place, how in measured.items() if place in values},
        drawn=frozenset().union(*(reading.drawn for reading in readings)),
        unseen=frozenset().union(*(reading.unseen for reading in readings)),
    )


def agree(first: Answer, second: Answer) -> bool:
    """Whether two values are one, written to more or fewer figures, 3.214 and 3.2, or come to in another way."""
    coarse = min(figures(first.text), figures(second.text))
    size = max(abs(first.value), abs(second.value))
    half_unit = 0.5 * 10 ** (math.floor(math.log10(size)) + 1 - coarse) if size else 0.0
    return abs(first.value - second.value) <= max(half_unit * (1 + 1e-9), SAME * size)


def figures(text: str) -> int:
    """How many figures the first number of a text is written with."""
    match = _FIGURES.search(text)
    count = sum(map(str.isdigit, match[1] or match[0])) if match else 0
    return max(count, FEWEST_FIGURES)
