"""What an answer sheet asks for: all that can be worked out, or a choice of it by sections and ids.

The key holds every quantity in any case; a choice only takes away cells to be filled in.
"""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase

from reportgen.answers.key import Key, Row
from reportgen.notation.vocabulary import Chapter

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
    sheet on pages of its own.
    """

    patterns: tuple[str, ...] = DEFAULT
    by_section: bool = False

    def __str__(self) -> str:
        return ", ".join((*self.patterns, *(("by section",) if self.by_section else ())))

    def wants(self, row: Row) -> bool:
        """Whether a row that can be asked for is."""
        wanted = False
        for pattern in _whole(self.patterns):
            left_out = pattern.startswith(NOT)
            bare = pattern.removeprefix(NOT)
            if bare == row.part or (bare not in set(Chapter) and fnmatchcase(row.id, bare)):
                wanted = not left_out
        return wanted

    def of(self, key: Key, also: Container[str] = ()) -> Key:
        """The key with the cells that are chosen, and those of the rows whose ids are in `also`."""
        rows = (row if row.id in also or self.wants(row) else replace(row, positions=()) for row in key.rows)
        return replace(key, rows=tuple(rows))


def _whole(patterns: Sequence[str]) -> Sequence[str]:
    return (*DEFAULT, *patterns) if patterns and patterns[0].startswith(NOT) else patterns
