"""Read what students submit without an answer sheet: the Word report and the drawing.

A reader returns a `FileReading` of one file; `submission` joins those of one student for marking. An entry of a file
that cannot be read with certainty is *unread*: it neither earns nor costs points until the lecturer settles it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence

from reportgen.base.errors import Fault, Location
from reportgen.base.records import Record, field
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.marking.marking_data import Answer, Place, ReadOff, Submission

FEWEST_FIGURES = 2
"""Smallest number of figures that a written number is taken to have."""
SAME = 5e-3
"""Relative difference up to which two values of a place count as equal, because roundings or methods differ.

Marking tolerates at least this share of a quantity.
"""
_FIGURES = re.compile(r"[1-9]\d*(?:[.,]\d+)?|0?[.,]0*(\d+)")


class FileReading(Record):
    """The reading of one file of a student: the values by place, and the faults of entries that cannot be read.

    A value is in the row's printed unit and has its location in the file; a length on a drawing is in mm at the
    report's scale, a direction in degrees. `notes` concern the file as a whole: objects that cannot be opened, a
    template that it names.
    """

    assignment: str
    file: str
    values: Mapping[Place, Answer]
    unread: Mapping[Place, Fault] = field(default_factory=dict)
    notes: tuple[Fault, ...] = ()
    measured: Mapping[Place, ReadOff] = field(default_factory=dict)
    """The details of reading each value of a drawing."""
    drawn: frozenset[Place] = frozenset()
    """The places that a drawing must show."""
    unseen: frozenset[Place] = frozenset()
    """The places that the file mentions only in hidden text, which is not read."""
    beside: Mapping[Place, Location] = field(default_factory=dict)
    """Locations of wrong vectors in a drawing that nothing asks for, by the place of their length."""

    @property
    def share(self) -> float:
        """The share (0 to 1) of the file's entries that was read; 1 if there are none."""
        count = len(self.values) + len(self.unread)
        return len(self.values) / count if count else 1.0


def submission(readings: Sequence[FileReading], language: Language | None) -> Submission:
    """Return the readings of one student's files, at least one, as one submission with faults worded in `language`.

    A place with different values in two files is unread. A place that is unread in only one file takes the other's
    value. Written values take precedence over those measured on a drawing, which has another scale.
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
                unread[place] = Fault("unread-two-values", answer.location, {"text": answer.text, "first": first.text})
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
    """Return True if two values in one unit are equal within their figures (3.214 and 3.2) or within `SAME`.

    They may differ by half a unit of the last figure of the coarser one, or by the share `SAME` of the larger one,
    which allows for another method.
    """
    coarse = min(figures(first.text), figures(second.text))
    size = max(abs(first.value), abs(second.value))
    half_unit = 0.5 * 10 ** (math.floor(math.log10(size)) + 1 - coarse) if size else 0.0
    return abs(first.value - second.value) <= max(half_unit * (1 + 1e-9), SAME * size)


def figures(text: str) -> int:
    """Return the number of significant figures of the first number in a text, at least `FEWEST_FIGURES`."""
    match = _FIGURES.search(text)
    count = sum(map(str.isdigit, match[1] or match[0])) if match else 0
    return max(count, FEWEST_FIGURES)
