"""Parse numbers as students write them (`read_number`): decimal mark, thousands, powers of ten, unit, blank cells."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable

from reportgen.base import units
from reportgen.base.chinese import narrow
from reportgen.base.languages import DecimalMark as DecimalMark
from reportgen.base.languages import decimal_mark as language_mark
from reportgen.base.typed_characters import DASHES, RAISED_MINUS, SPACES, plain_signs
from reportgen.base.units import Dimension, Language, QuantityFault

BLANKS = frozenset({"", "-", "–", "—", "−", "…", "...", "?", "/"})
"""Texts of a cell without an answer."""
LONGEST = 60
"""Largest number of characters of a number."""

_SPACES = re.compile(rf"[\s{SPACES}]+")
_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺", "0123456789-+")
_BRACED = re.compile(r"\^\s*\{\s*([^{}]*?)\s*\}")
_MINUTES = re.compile(
    r"([+-]?)\s*([0-9]{1,6})\s*[°º]\s*([0-5]?[0-9])\s*['′’](?:\s*([0-5]?[0-9](?:[.,][0-9]+)?)\s*(?:[\"″”]|[′'’]{2}))?"
)
"""An angle in degrees, minutes and seconds: 12°30′."""
_RAISED_POWER = re.compile(r"(?<![0-9])10([⁻⁺]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+)")
_POWER = re.compile(r"(?:(?<=[0-9])\s*[x×·⋅*.]\s*|^([+-]?))10\s*\^\s*\(?\s*([+-]?[0-9]{1,3})\s*\)?", re.IGNORECASE)
_NUMBER = re.compile(
    r"(?P<sign>[+-]?)\s*(?P<body>[0-9]+(?:[ '][0-9]{3}(?![0-9])|[.,][0-9]+)*[.,]?|[.,][0-9]+)"
    r"(?:\s?[eE](?P<power>[+-]?[0-9]{1,3}))?(?P<unit>\s*[^\s0-9].*|\s+1/.*)?"
)


def is_blank(text: str) -> bool:
    """Return True if a cell's text means that there is no answer."""
    return plain_signs(narrow(text)).strip() in BLANKS


def decimal_mark(texts: Iterable[str], language: Language) -> tuple[DecimalMark, bool]:
    """Return the decimal mark that a sheet's texts agree on, and True if they agree; else the language's mark."""
    marks_used: set[DecimalMark] = set()
    for text in texts:
        match = _matched(text)
        marks = re.findall("[.,]", match["body"]) if match else []
        if match and len(marks) == 1 and not _plain(match["body"], ".", text)[2]:
            marks_used.add("." if marks == ["."] else ",")
    if len(marks_used) == 1:
        return marks_used.pop(), True
    return language_mark(language), False


def read_number(text: str, unit: str, mark: DecimalMark, agreed: bool = False) -> tuple[float, bool]:
    """Return a cell's number in `unit` ("" for a pure number), and True if it is doubtful.

    `mark` decides the meaning of 1.234 if the text itself does not; that is doubtful unless the whole sheet `agreed` on
    the mark. Raise `QuantityFault` (not-a-number, not-finite, unexpected-, unknown-, wrong-unit).
    """
    if angle := _MINUTES.fullmatch(_tidy(text)):
        sign, degrees, minutes, seconds = angle.groups(default="0")
        size = int(degrees) + int(minutes) / 60 + float(seconds.replace(",", ".")) / 3600
        return (-size if sign == "-" else size) * _factor("°", unit, text), False
    match = _matched(text)
    if match is None:
        raise QuantityFault("not-a-number", text=text)
    plain, thousands, open_question = _plain(match["body"], mark, text)
    value = float(f"{match['sign']}{plain}e{match['power'] or 0}")
    given = (match["unit"] or "").strip()
    if given:
        value *= _factor(given, unit, text)
    if not math.isfinite(value):
        raise QuantityFault("not-finite", text=text)
    return value, open_question and (thousands or not agreed)


def _matched(text: str) -> re.Match[str] | None:
    return _NUMBER.fullmatch(_tidy(text)) if len(text) <= LONGEST else None


def _tidy(text: str) -> str:
    """Return the text with one kind of blank, minus and power of ten: 1,2·10³ becomes 1,2e3."""
    result = _SPACES.sub(" ", plain_signs(narrow(text))).strip().lstrip("≈~= ")
    if result[:1] in {*DASHES, RAISED_MINUS}:
        result = f"-{result[1:]}"
    result = re.sub(rf"(?<=[eE^])\s*[{''.join(DASHES)}]", "-", _BRACED.sub(r"^\1", result))
    result = _RAISED_POWER.sub(lambda match: f"10^{match[1].translate(_RAISED)}", result)
    return _POWER.sub(lambda match: f"{'' if match[1] is None else match[1] + '1'}e{match[2]}", result)


def _plain(body: str, mark: DecimalMark, text: str) -> tuple[str, bool, bool]:
    """Return the digits with a decimal point, True if thousands were separated, and True if `mark` had to decide it."""
    joined = body.replace(" ", "").replace("'", "")
    marks = re.findall("[.,]", joined)
    whole, *rest = re.split("[.,]", joined)
    if not marks:
        return joined, False, False
    grouped = 1 <= len(whole) <= 3 and all(len(part) == 3 for part in rest[:-1])
    if len(set(marks)) == 2:
        # The last mark is the decimal one: 1.234,5 or 1,234.5.
        if len(set(marks[:-1])) > 1 or marks[-1] in marks[:-1] or not grouped:
            raise QuantityFault("not-a-number", text=text)
        return f"{whole}{''.join(rest[:-1])}.{rest[-1] or 0}", True, False
    if len(marks) > 1:
        if not grouped or len(rest[-1]) != 3:
            raise QuantityFault("not-a-number", text=text)
        return whole + "".join(rest), True, False
    fits = grouped and len(rest[0]) == 3 and not whole.startswith("0") and joined == body
    if fits and marks[0] != mark:
        return whole + rest[0], True, True
    return f"{whole or 0}.{rest[0] or 0}", False, fits


def _factor(given: str, unit: str, text: str) -> float:
    """Return the factor from the given unit to the requested unit."""
    if not unit:
        raise QuantityFault("unexpected-unit", text=text)
    try:
        factor, dimension = units.scale(given)
    except ValueError:
        raise QuantityFault("unknown-unit", given=given, unit=unit) from None
    wanted_factor, wanted = units.scale(unit)
    if dimension not in (wanted, _without_radian(wanted)):
        raise QuantityFault("wrong-unit", given=given, unit=unit)
    return factor / wanted_factor


def _without_radian(dimension: Dimension) -> Dimension:
    """Return the dimension without radian, unless only a bare number is left: 1/s is commonly written for rad/s."""
    return tuple(power for power in dimension if power[0] != "radian") or dimension
