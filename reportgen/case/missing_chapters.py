"""Chapters that a report could have but lacks, with the keys of the file that would bring them: `MissingChapter`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from reportgen.base.errors import Where
from reportgen.base.records import Record
from reportgen.base.words import find

_HEADING = re.compile(r"^#+ +(.*)$", re.MULTILINE)
_OTHERWISE = re.compile(r"{% *else *%}.*?{% *endif *%}")
_MARKS = re.compile(r"{%.*?%}|{{.*?}}")


class MissingChapter(Record):
    """A chapter by its title, with the keys that it needs: one of each group in `wanted`."""

    title: str
    wanted: tuple[tuple[Where, ...], ...]

    def below(self, where: Where, title: str) -> MissingChapter:
        """Return the same chapter of a part at a place of a coursework's file."""
        wanted = tuple(tuple((*where, *key) for key in group) for group in self.wanted)
        return MissingChapter(f"{title}: {self.title}", wanted)


def heading_of(section: str, places: Sequence[Path]) -> str:
    """Return the first heading of a template section as plain text, "" if it has none.

    If the heading has two forms, the first one is returned.
    """
    passage = find(section, places)
    heading = _HEADING.search(passage.text) if passage else None
    return _MARKS.sub("", _OTHERWISE.sub("", heading[1])).strip() if heading else ""
