"""What an answer sheet asks for: all that can be worked out, or a choice of it by sections and ids.

The key holds every quantity in any case; a choice only takes away cells to be filled in.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from pathlib import Path

from reportgen.assignment.reading import placed
from reportgen.document.key import Key, Row
from reportgen.errors import Finding
from reportgen.notation.numbers import Language
from reportgen.notation.vocabulary import Chapter
from reportgen.source import read_source
from reportgen.words import as_error, close_or_known

NOT = "-"
"""Before a pattern of what is left out."""

DEFAULT = (
    "*",
    # How it was drawn: lengths and angles on paper, scales, arms.
    *("-drawn.*", "-seg.*", "-mu.*", "-h.*", "-ic.*"),
    # Second ways to the same result.
    *("-formulas", "-l.*K[0-9]*", "-e.Pqt*", "-M.*.p"),
    # What is read off a force plan beside the size of a reaction.
    *("-dir.R*", "-R.*.n", "-x.*"),
)
"""What is asked for unless a policy says otherwise: what a quantity comes to, not how it was drawn or checked."""

EVERYTHING = ("*",)


@dataclass(frozen=True, slots=True)
class Ask:
    """A choice: sections and ids by patterns, of which the last that fits decides, "-" before those left out.

    A choice that begins by leaving out takes from the `DEFAULT`.  `by_section` puts each section of the printed
    sheet on pages of its own.  `file` is the policy that gives the patterns, where one does.
    """

    patterns: tuple[str, ...] = DEFAULT
    by_section: bool = False
    file: Path | None = field(default=None, compare=False)

    def __str__(self) -> str:
        return ", ".join((*self.patterns, *(("by section",) if self.by_section else ())))

    def wants(self, row: Row) -> bool:
        """Whether a row that can be asked for is."""
        wanted = False
        for pattern in _whole(self.patterns):
            if _fits(pattern, row):
                wanted = not pattern.startswith(NOT)
        return wanted

    def of(self, key: Key, also: Container[str] = ()) -> Key:
        """The key with the cells that are chosen, and those of the rows whose ids are in `also`."""
        rows = (row if row.id in also or self.wants(row) else replace(row, positions=()) for row in key.rows)
        return replace(key, rows=tuple(rows))

    def check(self, keys: Iterable[Key], language: Language | None = None) -> None:
        """Raises `AssignmentError`, located in the policy, for patterns that fit nothing in any of the keys.

        The keys are taken one after the other, no more of them than it needs.
        """
        if self.file is None:
            return
        left = {index: one for index, one in enumerate(self.patterns) if one.removeprefix(NOT) not in set(Chapter)}
        known: dict[str, None] = dict.fromkeys(Chapter)
        tried = False
        for key in keys if left else ():
            tried = True
            known |= dict.fromkeys(row.id for row in key.asked)
            left = {index: one for index, one in left.items() if not any(_fits(one, row) for row in key.asked)}
            if not left:
                return
        findings = [
            Finding("ask-fits-nothing", ("ask", index), _about(one, list(known))) for index, one in left.items()
        ]
        if tried and findings:
            raise as_error(placed(read_source(self.file), findings), language)


def _fits(pattern: str, row: Row) -> bool:
    """Whether a pattern, with or without `NOT`, is the section of a row or fits its id."""
    bare = pattern.removeprefix(NOT)
    return bare == row.part or (bare not in set(Chapter) and fnmatchcase(row.id, bare))


def _about(pattern: str, known: Sequence[str]) -> dict[str, str]:
    """What to say of a pattern that fits nothing: what it was probably meant to be, or the sections."""
    close = close_or_known(pattern.removeprefix(NOT), known)
    return {"text": pattern, **(close if "close" in close else {"known": ", ".join(Chapter)})}


def _whole(patterns: Sequence[str]) -> Sequence[str]:
    return (*DEFAULT, *patterns) if patterns and patterns[0].startswith(NOT) else patterns
