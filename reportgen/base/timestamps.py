"""Parse dates and times as people and platforms write them: 2026-11-20 23:59, 20/11/2026, Friday, 20 November 2026,
11:59 PM.

Names of months and halves of the day are accepted in all languages (`dates` of `messages.yaml`). In a numeric date
the day comes first, unless it begins with the year.
"""

from __future__ import annotations

import datetime
import re
import unicodedata
from collections.abc import Mapping
from functools import cache

from reportgen.base.template_folders import languages
from reportgen.base.words import messages

_TIME = re.compile(r"(?<!\d)(\d{1,2})(?::(\d{2})(?::(\d{2})(?:\.\d+)?)?|h(\d{2})?(?![^\W\d_]))")
_ISO = re.compile(r"(?<!\d)(\d{4})(?:-(\d{1,2})-(\d{1,2})(?!\d)| ?年 ?(\d{1,2}) ?月 ?(\d{1,2}) ?日)")
"""A date that begins with the year, in Chinese with the words for year, month and day."""
_FIGURES = re.compile(r"(?<!\d)(\d{1,2})[/.-](\d{1,2})[/.-](\d{4}|\d{2})(?!\d)")
_DAY, _YEAR = re.compile(r"(?<!\d)(\d{1,2})(?!\d)"), re.compile(r"(?<!\d)(\d{4})(?!\d)")
CENTURY = 2000
"""Century added to a year of two digits."""


def moment(text: str, *, end: bool = False) -> datetime.datetime | None:
    """Return the moment that a text names, None if it names none; a date alone means its start, or with `end`
    its end.
    """
    said = re.sub(r"(?<=\d)t(?=\d)", " ", " ".join(unicodedata.normalize("NFC", text).casefold().split()))
    try:
        time, rest = _time(said)
        day = _day(rest)
    except ValueError:
        return None
    if day is None:
        return None
    return datetime.datetime.combine(day, time or (datetime.time(23, 59, 59) if end else datetime.time()))


def _time(said: str) -> tuple[datetime.time | None, str]:
    """Return the time of day and the rest of the text; raises `ValueError` for an impossible time."""
    match = _TIME.search(said)
    if match is None:
        return None, said
    hour, minute, second = int(match[1]), int(match[2] or match[4] or 0), int(match[3] or 0)
    rest = f"{said[: match.start()]} {said[match.end() :]}"
    for half, first in (("morning", 0), ("afternoon", 12)):
        if word := _among(_halves()[half], rest):
            if not 1 <= hour <= 12:
                raise ValueError(said)
            hour, rest = hour % 12 + first, rest.replace(word, " ", 1)
            break
    return datetime.time(hour, minute, second), rest


def _day(said: str) -> datetime.date | None:
    """Return the date that a text names; raises `ValueError` for an impossible date."""
    if match := _ISO.search(said):
        return datetime.date(int(match[1]), int(match[2] or match[4]), int(match[3] or match[5]))
    if match := _FIGURES.search(said):
        year = int(match[3]) + (CENTURY if len(match[3]) == 2 else 0)
        return datetime.date(year, int(match[2]), int(match[1]))
    plain = re.sub(r"(?<!\d)0(?=\d(?!\d))", "", said)
    name = _among(_months(), plain)
    rest = plain.replace(name, " ", 1)
    day, year_text = _DAY.search(rest), _YEAR.search(rest)
    if not name or day is None or year_text is None:
        return None
    return datetime.date(int(year_text[1]), _months()[name], int(day[1]))


def _among(words: Mapping[str, int], said: str) -> str:
    """Return the longest of some words that occurs in a text as a whole word, "" for none."""
    standing = (word for word in words if re.search(rf"(?<!\w){re.escape(word)}(?!\w)", said))
    return max(standing, key=len, default="")


@cache
def _months() -> Mapping[str, int]:
    """Return the number of a month by each of its names."""
    return {
        name: number
        for language in languages()
        for number, names in enumerate(messages(language)["dates"]["months"], start=1)
        for name in names
    }


@cache
def _halves() -> Mapping[str, Mapping[str, int]]:
    """Return the names of the halves of the day, by `morning` and `afternoon`."""
    tables = [messages(language)["dates"] for language in languages()]
    return {half: {word: 0 for table in tables for word in table[half]} for half in ("morning", "afternoon")}
