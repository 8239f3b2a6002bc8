"""The marking policy of a class: tolerances, points, selection of questions, flags that cost marks, and the mark.

`read_policy` reads it from a YAML file.
"""

from __future__ import annotations

import datetime
import math
from collections.abc import Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Decimal, Flag, Interval, Percent, TypedText, Until, Whole, quantity
from reportgen.assignment.reading import read_model
from reportgen.base.records import Record, field
from reportgen.base.units import Given, Language
from reportgen.marking.tolerance_bands import DIGITS, PAPER_ERROR
from reportgen.marking.toleranced_key import Ask

TAKES = frozenset({"stock", "columns", "other-data", "classmate-key", "classmate-sheet"})
"""Kinds of flags that cost marks by default, because they are certain."""
FLAGS_ONLY = frozenset({"constant", "classmate", "unseen"})
"""Kinds of flags that are only reported by default."""


class Scale(Record):
    """The scale of marks: the highest mark, and the step to which marks are rounded."""

    highest: float = 10.0
    step: float = 0.1

    def mark(self, share: float) -> float:
        """Return the mark for a share of the points; half a step is rounded up."""
        # 1e-9: a share such as 0.85 is slightly off as a float.
        return round(math.floor(share * self.highest / self.step + 0.5 + 1e-9) * self.step, 6)


class Lateness(Record):
    """The deduction from a mark for each day begun after the moment `due`, at most `most` in total."""

    due: datetime.datetime
    per_day: float
    most: float = math.inf

    def days(self, handed_in: datetime.datetime) -> int:
        """Return the number of days begun after the due moment; 0 if handed in on time."""
        return max(math.ceil((handed_in - self.due) / datetime.timedelta(days=1)), 0)


class Browser(Record):
    """What students may do in the browser (`serve`): until when, and how often they check and upload.

    None allows any number; `checks_from` is the moment of the first check.
    """

    closes: datetime.datetime | None = None
    uploads: int | None = None
    checks: int | None = None
    checks_from: datetime.datetime | None = None
    hints: bool = True
    self_report: bool = False


LEAST_READ = 0.8

Twice = Literal["last", "first"]
"""Choice between two sheets of one student."""


class Policy(Record):
    """The requested cells, tolerances (`paper` in m), points and the mark; `weights` by patterns of ids.

    `take` says which kinds of flags cost marks. `overrule` gives, by sheet, the reason why it keeps its marks.
    """

    paper: float = PAPER_ERROR
    digits: int = DIGITS
    share: float = 0.005
    right: float = 1.0
    follows: float = 1.0
    weights: Mapping[str, float] = field(default_factory=dict)
    guard: bool = True
    show_answers: bool = True
    take: Mapping[str, bool] = field(default_factory=dict)
    overrule: Mapping[str, str] = field(default_factory=dict)
    ask: Ask = field(default_factory=Ask)
    scale: Scale = field(default_factory=Scale)
    parts: Mapping[str, float] = field(default_factory=dict)
    """Shares of the parts of a coursework, by name; without them, each value counts alike."""
    late: Lateness | None = None
    twice: Twice = "last"
    least_read: float = LEAST_READ
    """Smallest share of the student's own files that must be read; below it there is no mark."""
    browser: Browser = field(default_factory=Browser)
    approximations: bool = True
    """True if a value by a textbook's approximation earns its points; the feedback names it in any case."""
    file: Path | None = None

    def deducted(self, share: float, days_late: int) -> float:
        """Return the deduction from the mark for a share of the points, handed in `days_late` days late."""
        if self.late is None:
            return 0.0
        return min(self.late.per_day * days_late, self.late.most, self.scale.mark(share))

    def mark(self, share: float, days_late: int = 0) -> float:
        """Return the mark for a share of the points, after deductions."""
        return round(self.scale.mark(share) - self.deducted(share, days_late), 6)

    def takes(self, kind: str, assignment: str) -> bool:
        """Return True if a kind of flag costs marks on the sheet of an assignment."""
        return assignment not in self.overrule and self.take.get(kind, kind in TAKES)

    def worth(self, id: str) -> float:
        """Return the points that a quantity is worth at one position."""
        return next((weight for pattern, weight in self.weights.items() if fnmatchcase(id, pattern)), 1.0)


class _Tolerance(Part):
    paper: Annotated[Given | None, quantity("mm", least=0, most=5)] = None
    digits: Annotated[int, Whole(2, 6)] = DIGITS
    share: Annotated[float, Decimal(Interval(least=0, most=0.2))] = 0.005


class _Points(Part):
    right: Annotated[float, Decimal(Interval(least=0, most=100))] = 1.0
    follows: Annotated[float, Decimal(Interval(least=0, most=100))] = 1.0


class _Mark(Part):
    highest: Annotated[float, Decimal(Interval(above=0, most=1000))] = Scale().highest
    step: Annotated[float, Decimal(Interval(above=0, most=100))] = Scale().step


class _Late(Part):
    due: Annotated[datetime.datetime, Until()]
    per_day: Annotated[float, Decimal(Interval(least=0, most=1000))]
    most: Annotated[float, Decimal(Interval(least=0, most=1000))] = math.inf


class _Browser(Part):
    closes: Annotated[datetime.datetime, Until()] | None = None
    uploads: Annotated[int, Whole(0, 1000)] | None = None
    checks: Annotated[int, Whole(0, 100_000)] | None = None
    checks_from: Annotated[datetime.datetime, Until(end=False)] | None = None
    hints: Annotated[bool, Flag()] = True
    self_report: Annotated[bool, Flag()] = False


class _PolicyFile(Part):
    ask: Annotated[tuple[Annotated[str, TypedText()], ...], Field(min_length=1)] = Ask().patterns
    by_section: Annotated[bool, Flag()] = False
    self_check: Annotated[bool, Flag()] = True
    tolerance: _Tolerance = _Tolerance()
    points: _Points = _Points()
    weights: dict[str, Annotated[float, Decimal(Interval(least=0, most=1000))]] = {}  # noqa: RUF012
    mark: _Mark = _Mark()
    guard: Annotated[bool, Flag()] = True
    take: dict[str, Annotated[bool, Flag()]] = {}  # noqa: RUF012
    overrule: dict[str, Annotated[str, TypedText()]] = {}  # noqa: RUF012
    show_answers: Annotated[bool, Flag()] = True
    parts: dict[str, Annotated[float, Decimal(Interval(least=0, most=1000))]] = {}  # noqa: RUF012
    late: _Late | None = None
    twice: Annotated[Twice, Field(json_schema_extra={})] = "last"
    least_read: Annotated[float, Percent()] = LEAST_READ
    approximations: Annotated[bool, Flag()] = True
    browser: _Browser = _Browser()


def read_policy(path: Path, language: Language | None = None) -> Policy:
    """Return the policy of a YAML file; raise `AssignmentError` with all its faults, located.

    ask: ["*", "-seg.*"]     # sections and ids of the answer sheet; "-" excludes, the last match decides
    by_section: false        # print each section of the sheet on separate pages
    self_check: true         # add the student's data to the task, for checking a filled sheet
    tolerance:
      paper: 0.5 mm          # largest error of each end of a measured length
      digits: 3              # significant figures of computed values
      share: 0.005           # of the quantity's maximum within a quarter turn
    points: {right: 1, follows: 1}
    weights:                 # by id of the quantity, the first match counts; 0: not marked
      "seg.*": 0.5
      "M.eq": 5
    mark: {highest: 10, step: 0.1}
    guard: true              # report sheets that are not the student's own work
    take:                    # whether each kind of finding costs marks
      other-data: false
    overrule:                # sheets that keep their marks, with the reason
      K225520103023: has shown the drawings
    show_answers: true       # the feedback shows the right values
    parts:                   # share of each part of a coursework; default: its number of requested values
      machine: 6
      cam: 4
    late:                    # deduction from the mark for each day begun after `due`, at most `most`
      due: 2026-11-20 23:59
      per_day: 1
      most: 5
    browser:                 # what students may do on the pages of `serve`
      closes: 2026-11-25 23:59   # nothing is accepted after it
      uploads: 20            # how many files and checks; without it, any number
      checks: 40
      checks_from: 2026-11-10 00:00
      hints: true            # a check also says where to look
      self_report: false     # students may build the report of their own data
    twice: last              # which of two sheets of one student is marked, or: first
    least_read: 80 %         # least share of a report or drawing that must be read; below it there is no mark
    approximations: true     # a value computed by a textbook's approximation earns its points
    """
    content = read_model(path, _PolicyFile, language)
    tolerance, points = content.tolerance, content.points
    return Policy(
        paper=PAPER_ERROR if tolerance.paper is None else tolerance.paper.si,
        digits=tolerance.digits,
        share=tolerance.share,
        right=points.right,
        follows=points.follows,
        weights=content.weights,
        guard=content.guard,
        show_answers=content.show_answers,
        take=content.take,
        overrule=content.overrule,
        ask=Ask(
            content.ask, content.by_section, content.self_check, path if "ask" in content.model_fields_set else None
        ),
        scale=Scale(content.mark.highest, content.mark.step),
        parts=content.parts,
        late=Lateness(late.due, late.per_day, late.most) if (late := content.late) else None,
        twice=content.twice,
        least_read=content.least_read,
        approximations=content.approximations,
        browser=Browser(**dict(content.browser)),
        file=path,
    )
