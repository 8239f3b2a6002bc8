"""Patterns of the words that are recognised in a report, for all languages together.

A student may write in another language than the assignment's, and reports mix languages. The words are in
`language.yaml` of each language, under `reading`.
"""

from __future__ import annotations

import re
from functools import cache
from operator import attrgetter

from reportgen.base.languages import ReadingWords, languages, setting_of

HAN = "\u3400-\u9fff"
"""Letters of a language without blanks between words: a symbol may follow one directly."""
_LABEL = "([0-9]{1,3}[a-z]?′*)"
"""The label of a position."""


@cache
def any_of(*names: str, whole: bool = True) -> str:
    """Return a pattern for any of the words that `ReadingWords` has under some names.

    With `whole`, words must match at word boundaries, in languages that have blanks between them.
    """
    read = attrgetter(*names)
    patterns: dict[str, None] = {}
    for language in languages():
        setting = setting_of(language)
        lists = read(setting.reading) if len(names) > 1 else (read(setting.reading),)
        for word in (word for words in lists for word in words if "#" not in word):
            patterns[_pattern(word, whole and setting.spaced)] = None
    return f"(?:{'|'.join(sorted(patterns, key=len, reverse=True))})"


@cache
def labelled_position() -> re.Pattern[str]:
    """Return a pattern of a position with its label in one of the groups: “position 3”, “第3个位置”."""
    named = rf"{any_of('position')}[\s(]*{any_of('number', whole=False)}?[\s:(]*{_LABEL}"
    within = [
        re.escape(before) + r"\s*" + _LABEL + r"\s*" + _pattern(behind, False)
        for language in languages()
        for before, sign, behind in (word.partition("#") for word in setting_of(language).reading.position)
        if sign
    ]
    return re.compile(rf"(?:{'|'.join((named, *within))})(?![0-9a-z]|[.,][0-9])", re.IGNORECASE)


def label_of(match: re.Match[str]) -> str:
    """Return the label in a match of a position."""
    return next(group for group in match.groups() if group)


def _pattern(word: str, whole: bool) -> str:
    """Return the pattern of one word; a blank in it matches any number of blanks."""
    body = r"\s*".join(r"\w*".join(map(re.escape, piece.split("*"))) for piece in word.split(" "))
    begins, ends = whole and word[0].isalnum(), whole and word[-1].isalnum()
    return (rf"(?<![^\W\d_{HAN}])" if begins else "") + body + (rf"(?![^\W\d_{HAN}])" if ends else "")


__all__ = ["HAN", "ReadingWords", "any_of", "label_of", "labelled_position"]
