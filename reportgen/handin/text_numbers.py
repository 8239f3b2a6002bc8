"""Parse numbers in running text: their decimal mark, their unit, and cases of doubt."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable

from reportgen.base.languages import decimal_mark, typed_units
from reportgen.base.records import Record
from reportgen.base.typed_characters import SPACES
from reportgen.base.units import Language, QuantityFault
from reportgen.case.answer_key import KeyRow
from reportgen.marking.student_numbers import DecimalMark, read_number
from reportgen.marking.toleranced_key import typed_unit

_DECIMALS = re.compile(r"(?<![\d.,])\d+([.,])(\d+)(?![\d]|[.,]\d)")
BOTH = 0.1
"""Share of its numbers from which a text counts as using both decimal marks."""
_PRODUCT = re.compile(r"\d\.\d+,\d|\d,\d+\.\d(?!0\s*\^)|\d\.\d+\.\d|\d,\d+,\d")
"""5.122,95 may be thousands, or 5 times 122,95."""
_THOUSANDS = re.compile(r"[-+–]?\s*\d{1,3}[.,]\d{3}(?!\d)")

_POWER = r"(?:\s*[·.x×*]\s*10\s*(?:\^\s*\{?\(?\s*[-–⁻+]?\s*\d{1,3}\s*\)?\}?|[⁻⁺]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+))"
_MINUTES = r"\d+\s*[°º]\s*\d{1,2}\s*′(?!′)(?:\s*\d{1,2}(?:[.,]\d+)?\s*′′)?"
_PLAIN = rf"\d+(?:[ {SPACES}]\d{{3}}(?!\d))*(?:[.,]\d+)*(?:\s?[eE][-+–]?\d{{1,3}})?"
NUMBER = rf"(?:[+\-–⁻]\s*)?(?:{_MINUTES}|(?:{_PLAIN})(?!\d)(?:{_POWER})?)"
_NO_LETTER = "(?![A-Za-zÀ-ỹα-ωЀ-ӿ])"
_LATIN_UNITS = "Nmm|kNm|Nm|N|kN|mm|cm|dm|m|s|kgm|kg|rad|J|W|kW|MPa|kPa|Pa|độ|v|vg|vòng|rpm|deg|bar"
_WORDS_OF_UNITS = "|".join((_LATIN_UNITS, *map(re.escape, sorted(typed_units(), key=len, reverse=True))))
UNIT = (
    rf"(?:°|%|º|(?:1/[sс]|(?:{_WORDS_OF_UNITS}){_NO_LETTER}))"
    rf"(?:\s*[/·.*]\s*(?:{_WORDS_OF_UNITS}|ph|phút|min|rev){_NO_LETTER}|\s(?:m|mm|s){_NO_LETTER}|\s*\^\s*\{{?\(?[-–]?\d\)?\}}?|[²³⁴⁻¹]+|\d(?!\d)"
    rf"|\s*/\s*\(\s*(?:{_WORDS_OF_UNITS})[^()=]{{0,8}}\))*"
)
_UNIT_BEHIND = re.compile(rf"\s?{UNIT}")
_BRACES = re.compile(r"[{}]")
_JOINED_UNIT = re.compile(r"\s*([/·*])\s*")


class Marks(Record):
    """The decimal mark of a text, and True if it uses both marks."""

    decimal: DecimalMark
    mixed: bool


def marks_of(texts: Iterable[str], language: Language) -> Marks:
    """Return the decimal mark from the unambiguous numbers of a text: a single mark that is not before three figures.

    Only numbers after “=”, before a unit or alone in a cell count, not those of sections, figures and equations.
    """
    counts: Counter[str] = Counter()
    for text in texts:
        for match in _DECIMALS.finditer(text):
            before, behind = text[: match.start()].rstrip(" -–"), text[match.end() :]
            counted = before.endswith(("=", "≈")) or _UNIT_BEHIND.match(behind) or not (before or behind.strip())
            if counted and len(match[2]) != 3:
                counts[match[1]] += 1
    points, commas = counts["."], counts[","]
    if not points and not commas:
        return Marks(decimal_mark(language), mixed=True)
    return Marks("," if commas >= points else ".", min(points, commas) > BOTH * (points + commas))


def read_value(number: str, unit: str, row: KeyRow, marks: Marks) -> float:
    """Return a number of a text in the row's printed unit; without a unit, the number counts as given in it.

    Raises `QuantityFault` for a number or unit that cannot be read, with the code `product` for a doubtful number.
    """
    text = number.strip()
    if _PRODUCT.search(text) or (_THOUSANDS.fullmatch(text) and _is_doubtful(text, marks)):
        raise QuantityFault("product", text=text)
    if not marks.mixed and (match := _DECIMALS.search(text)) and match[1] != marks.decimal:
        raise QuantityFault("product", text=text)
    if not typed_unit(row) and unit == "%":
        return read_number(_BRACES.sub("", text), "", marks.decimal, agreed=True)[0] / 100
    written = f"{_BRACES.sub('', text)} {plain_unit(unit)}".strip()
    return read_number(written, typed_unit(row), marks.decimal, agreed=True)[0]


def _is_doubtful(text: str, marks: Marks) -> bool:
    """Return True if three figures after a mark may be thousands: not in 0,125, nor after the text's decimal mark."""
    whole = re.match(r"[-+–]?\s*(\d+)([.,])", text)
    assert whole is not None
    return not whole[1].startswith("0") and (marks.mixed or whole[2] != marks.decimal)


def plain_unit(unit: str) -> str:
    """Return a unit as it is typed: m/s^{2} becomes m/s²."""
    text = _BRACES.sub("", unit).strip().replace("º", "°").replace("độ", "°")
    text = re.sub(r"\^\s*\(?\s*([-–]?\d)\)?", r"^\1", text).replace("–", "-")
    return _JOINED_UNIT.sub(r"\1", text.replace("^2", "²").replace("^3", "³"))
