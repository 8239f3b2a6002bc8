"""Check a student's own files against their assignment before submission: read them into a sheet, or compare them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from reportgen.base.errors import Fault, Location
from reportgen.base.files import cause, contents
from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.base.words import as_error, word
from reportgen.case import Case
from reportgen.case.answer_key import Key
from reportgen.handin import FileReading, submission
from reportgen.handin.drawing_file import wanted_plans
from reportgen.handin.drawing_reader import WantedPlans
from reportgen.handin.file_kinds import DRAWING, NOT_READ, OWN, content, not_read, read_file
from reportgen.handin.reading_book import NAME, is_unchanged, reading_book
from reportgen.marking.answer_sheet import read_submission
from reportgen.marking.judging import compare as compare_sheet
from reportgen.marking.judging import compared, following_values
from reportgen.marking.marking_data import Submission
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import key_asked, marking_scheme
from reportgen.marking.toleranced_key import Ask, key_of


def read(case: Case, papers: Case, files: Sequence[Path], ask: Ask) -> tuple[Key, Submission]:
    """Return the readings of the requested cells, with the key; raise `AssignmentError` if a file is rejected.

    `papers` are the case in the language of the student's own papers, whose symbols are searched for.
    """
    spoken, policy = case.assignment.language, Policy(ask=ask)
    refuse(files, spoken)
    asked = ask.of(key_of(papers))

    def read_all(some: Sequence[Path], plans: WantedPlans | None = None) -> list[FileReading]:
        return [read_file(path, content(path, None, spoken), asked, spoken, plans) for path in some]

    drawings = [path for path in files if path.suffix.lower() == DRAWING]
    readings = read_all([path for path in files if path not in drawings])
    if drawings:
        scheme = marking_scheme(case, policy)
        # A report gives the values by which its drawings may be found.
        own = submission(readings, spoken) if readings else None
        worlds = following_values(replace(scheme, key=key_asked(policy, scheme.key, own)[0]), own) if own else ()
        readings += read_all(drawings, wanted_plans(papers, scheme.key, worlds))
    whole = submission(readings, spoken)
    return key_asked(policy, key_of(case), whole)[0], whole


def refuse(files: Sequence[Path], language: Language) -> None:
    """Raise `AssignmentError` for files of kinds that are not read."""
    strangers = [path for path in files if path.suffix.lower() not in OWN]
    if strangers:
        faults = (not_read(path) or Fault("own-not-read", Location(str(path))) for path in strangers)
        raise as_error(list(faults), language)


def compare(case: Case, papers: Case, files: Sequence[Path], hint: bool = False) -> tuple[tuple[str, ...], bool]:
    """Return lines that list the differences of a sheet, or of a report and drawings, from the assignment.

    The second value is True if they agree. An unread entry does not count as a difference, and is reported. Raises
    `AssignmentError` if a file cannot be read.
    """
    sheets = [path for path in files if path.suffix.lower() not in OWN | NOT_READ]
    if sheets:
        # A sheet takes precedence over other files; of several sheets the last counts, as for submissions.
        return compare_sheet(case, sheets[-1], hint)
    scheme = marking_scheme(case, Policy(guard=False))
    key, own = read(case, papers, files, Ask())
    rows = frozenset(row.id for row in key.asked)
    return compared(replace(scheme, key=key), replace(own, rows=rows), hint)


def reading(key: Key, own: Submission, target: Path) -> bytes:
    """Return the prefilled sheet for `target`; raise `AssignmentError` if somebody has completed the one there."""
    spoken = key.language
    if target.exists():
        try:
            standing = read_submission(target, key, spoken)
            data = contents(target)
        except OSError as error:
            raise as_error([Fault("unreadable", Location(str(target)), {"reason": cause(error)})], spoken) from error
        if data and not is_unchanged(standing):
            raise as_error([Fault("reading-completed", Location(str(target)))], spoken)
    return reading_book(key, own)


def summary(own: Submission, language: Language | None) -> str:
    """Return a sentence with the share (%) of a student's own files that was read and the number of open values.

    Returns "" for a sheet.
    """
    if not own.own_files:
        return ""
    said = word("graded_read", language, read=f"{100 * own.share_read:.0f}")
    count = len(own.unread)
    return said + (word("graded_to_settle", language, count=count, file=NAME) if count else "")
