"""Parse quantities: text with a unit becomes a number in SI that keeps the typed text.

pint knows the units. Since importing it takes 0.3 s, the few spellings that nearly every file uses are also in
`PLAIN`, which a test compares with pint. Angles have a dimension of their own here, so that a bare `60` is not an
angle and `Hz` is not a rotational speed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from decimal import Decimal
from functools import cache
from typing import TYPE_CHECKING, Any, TypeVar

from reportgen.base.languages import Language as Language
from reportgen.base.languages import common_unit, decimal_mark
from reportgen.base.records import Record
from reportgen.base.template_access import template_members

if TYPE_CHECKING:
    import numpy as np

MM = 1e3
"""Millimetres of a metre."""

Dimension = tuple[tuple[str, float], ...]
"""Powers of the SI base units by name, sorted: ((“kilogram”, 1), (“meter”, 1), (“second”, −2))."""

_LENGTH: Dimension = (("meter", 1),)
_ANGLE: Dimension = (("radian", 1),)
_SPEED: Dimension = (("radian", 1), ("second", -1))
_MASS: Dimension = (("kilogram", 1),)
_FORCE: Dimension = (("kilogram", 1), ("meter", 1), ("second", -2))
_PRESSURE: Dimension = (("kilogram", 1), ("meter", -1), ("second", -2))
_INERTIA: Dimension = (("kilogram", 1), ("meter", 2))
_MOMENT: Dimension = (("kilogram", 1), ("meter", 2), ("second", -2))
_TIME: Dimension = (("second", 1),)
_VELOCITY: Dimension = (("meter", 1), ("second", -1))
_ACCELERATION: Dimension = (("meter", 1), ("second", -2))
_STIFFNESS: Dimension = (("kilogram", 1), ("second", -2))
_POWER: Dimension = (("kilogram", 1), ("meter", 2), ("second", -3))
_DAMPING: Dimension = (("kilogram", 1), ("meter", 2), ("second", -1))
_TORSION: Dimension = (("kilogram", 1), ("meter", 2), ("radian", -1), ("second", -2))
_ANGULAR_ACCELERATION: Dimension = (("radian", 1), ("second", -2))

PLAIN: Mapping[str, tuple[float, Dimension]] = {
    "m": (1.0, _LENGTH),
    "cm": (1e-2, _LENGTH),
    "mm": (1e-3, _LENGTH),
    "deg": (math.pi / 180, _ANGLE),
    "rad": (1.0, _ANGLE),
    "rpm": (math.pi / 30, _SPEED),
    "rad/s": (1.0, _SPEED),
    "kg": (1.0, _MASS),
    "g": (1e-3, _MASS),
    "N": (1.0, _FORCE),
    "kN": (1e3, _FORCE),
    "Pa": (1.0, _PRESSURE),
    "MPa": (1e6, _PRESSURE),
    "bar": (1e5, _PRESSURE),
    "N/cm2": (1e4, _PRESSURE),
    "kg m2": (1.0, _INERTIA),
    "N m": (1.0, _MOMENT),
    "kN m": (1e3, _MOMENT),
    "s": (1.0, _TIME),
    "m/s": (1.0, _VELOCITY),
    "cm/s": (1e-2, _VELOCITY),
    "mm/s": (1e-3, _VELOCITY),
    "m/s2": (1.0, _ACCELERATION),
    "cm/s2": (1e-2, _ACCELERATION),
    "mm/s2": (1e-3, _ACCELERATION),
    "rad/s2": (1.0, _ANGULAR_ACCELERATION),
    "N/mm": (1e3, _STIFFNESS),
    "N/m": (1.0, _STIFFNESS),
    "N m/rad": (1.0, _TORSION),
    "N m s": (1.0, _DAMPING),
    "kW": (1e3, _POWER),
}
"""SI factor and dimension of the commonest spellings, including those of all units that files use."""

SPELLED: Mapping[str, str] = {
    "độ": "deg",
    **dict.fromkeys(("vg/ph", "v/ph", "vg/phút", "vòng/phút", "r/min", "rev/min"), "rpm"),
    "%": "percent",
    "1/s": "s-1",
    **dict.fromkeys(("1/mm", "mm⁻¹"), "mm-1"),
    **dict.fromkeys(("1/s2", "1/s²", "1/s^2"), "s-2"),
}
"""Units as people write them, by names that pint knows."""

MEANT: Mapping[str, str] = {
    **dict.fromkeys(("niutơn", "niu-tơn", "niuton", "newton", "newtơn"), "N"),
    **dict.fromkeys(("vòng/giây", "vòng/s", "vg/s", "r/s"), "rps"),
    **dict.fromkeys(("mét", "met"), "m"),
    **dict.fromkeys(("milimét", "milimet", "mi-li-mét"), "mm"),
    **dict.fromkeys(("ki-lô-gam", "kilôgam", "kilogam", "kí", "ký"), "kg"),
    "giây": "s",
    **dict.fromkeys(("об/мин", "обмин"), "rpm"),
}
"""Units in words and in letters that are not accepted, by the unit that is meant."""

NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_KNOWN = "|".join(re.escape(spelling) for spelling in SPELLED if not spelling.isascii())
_LETTER = "A-Za-zµμ°Ω\u0400-\u04ff\u4e00-\u9fff"
UNIT = rf"(?:{_KNOWN}|[{_LETTER}º][{_LETTER}0-9²³⁴⁻¹ */^()·⋅.+-]*)"

_ANY_UNIT = UNIT.replace(_LETTER, f"{_LETTER}À-ÖØ-öø-ɏḀ-ỿ-")
"""Pattern of a unit that may also have letters with accents, which no known unit has but `SPELLED`."""

_QUANTITY = re.compile(rf"({NUMBER})\s*({_ANY_UNIT})?")
_RATIO = re.compile(rf"({NUMBER})\s*(?:/\s*({NUMBER}))?")
_MARKED = re.compile(r"([+-]?)([0-9]+(?:[.,][0-9]+)+)(?![.,0-9])(.*)", re.DOTALL)
_THOUSANDS = re.compile(r"[1-9][0-9]{0,2}[.,][0-9]{2}0")
"""Pattern of numbers that a Vietnamese reader may mean as thousands, 1.400; 1.4 is written so only to three decimals.
"""
_NOT_FINITE = re.compile(r"[+-]?\.?(?:inf|infinity|nan)\b.*", re.IGNORECASE | re.DOTALL)
_JOINED = re.compile(r"(?<![A-Za-z])(k?N|kg)(?=[mc]?m)")
_LONGEST = 60
_TOWER = re.compile(r"[0-9]{2}|[0-9²³⁴¹][\s)]*(?:\^|\*\s*\*|[²³⁴⁻¹])")
"""Powers that no unit has, of two digits or of a power (m^9^9^9), which would take too long to evaluate."""


@template_members("si")
class Given(Record):
    """A quantity as given: `si` is its value in SI units; `value`, `unit` and `text` are as typed."""

    si: float
    value: float
    unit: str = ""
    text: str = ""


class QuantityFault(ValueError):
    """Text that is not a quantity of the requested kind; `code` and `arguments` name a message."""

    def __init__(self, code: str, **arguments: str) -> None:
        super().__init__(code)
        self.code = code
        self.arguments = arguments


def read_number(text: str) -> float:
    """Return a finite number; raises `QuantityFault` (decimal-comma, not-finite, unexpected-unit, not-a-number)."""
    return read_ratio(text, fractions=False).si


def read_ratio(text: str, *, fractions: bool = True) -> Given:
    """Return a number without unit, `0.35` or (with `fractions`) `1/3.6`; raises `QuantityFault`."""
    cleaned = _cleaned(text)
    match = _RATIO.fullmatch(cleaned)
    if match is None or (match[2] and not fractions):
        if _QUANTITY.fullmatch(cleaned):
            raise QuantityFault("unexpected-unit", text=text)
        raise QuantityFault("not-a-number", text=text)
    bottom = float(match[2]) if match[2] else 1.0
    value = float(match[1]) / bottom if bottom else math.inf
    if not math.isfinite(value):
        raise QuantityFault("not-finite", text=text)
    return Given(value, value, "", text)


def read_quantity(text: str, unit: str) -> Given:
    """Return a quantity of the dimension of `unit`; raises `QuantityFault` (also missing-, wrong-, unknown-unit)."""
    cleaned = _cleaned(text)
    match = _QUANTITY.fullmatch(cleaned)
    if match is None:
        raise QuantityFault("not-a-number", text=text)
    if not match[2]:
        # 1.600 gets a hint of both its readings: with the unit alone it would be as doubtful as before.
        readings = two_readings(f"{cleaned} {unit}")
        hint = {"hint": "thousands", "fixed": readings[0], "other": readings[1]} if readings else {}
        raise QuantityFault("missing-unit", text=text, unit=unit, **hint)
    try:
        value, factor = float(match[1]), read_unit(match[2], unit)
    except QuantityFault as fault:
        raise _spelt(fault, match[2], f"{match[1]} ") from None
    if not math.isfinite(value * factor):
        raise QuantityFault("not-finite", text=text)
    return Given(value * factor, value, match[2], text)


def read_named_unit(text: str, unit: str) -> float:
    """Return the same as `read_unit`; the fault of a unit in other letters or in words has the one that is meant."""
    try:
        return read_unit(text, unit)
    except QuantityFault as fault:
        raise _spelt(fault, text, "") from None


def _spelt(fault: QuantityFault, given: str, number: str) -> QuantityFault:
    """Return the fault of a unit with what is meant, if one unit is: MM is no known unit, although chemists have it."""
    close = meant_unit(given, fault.arguments["unit"])
    if not close:
        return fault
    return QuantityFault("unknown-unit", **fault.arguments, hint="unit-spelling", fixed=f"{number}{close}")


def two_readings(text: str) -> tuple[str, str] | None:
    """Return a number with its unit, read as decimals and as thousands: 1.4 N and 1400 N for 1.400 N.

    Return None for any other text; 1.375 mm and 0.350 have only one reading.
    """
    match = _MARKED.fullmatch(text.strip().replace("\N{MINUS SIGN}", "-"))
    if match is None or "," in match[2] or not _THOUSANDS.fullmatch(match[2]):
        return None
    if match[3] and (re.match(r"[eE][+-]?[0-9]", match[3]) or not _is_unit(match[3].strip())):
        return None
    decimals, thousands = (f"{match[1]}{number}{match[3]}" for number in _readings(match[2]))
    return decimals, thousands


def _is_unit(text: str) -> bool:
    try:
        scale(text)
    except ValueError:
        return False
    return True


def _readings(body: str) -> list[str]:
    """Return the readings of digits with points or commas among them, each with a decimal point or none: decimals
    first.

    1,6 is 1.6; 1,600 is 1.6 or 1600; 1.400.000 and 1.400,5 are 1400000 and 1400.5; empty for a text that is not a
    number.
    """
    whole, *groups = re.split("[.,]", body)
    *marks, last = re.findall("[.,]", body)
    if not marks:
        if _THOUSANDS.fullmatch(body):
            return [f"{whole}.{groups[0]}".rstrip("0").rstrip("."), whole + groups[0]]
        return [f"{whole}.{groups[0]}"]
    apart = len(set(marks)) == 1 and len(whole) <= 3 and whole[0] != "0" and all(len(one) == 3 for one in groups[:-1])
    if apart and last != marks[0]:
        return [f"{whole}{''.join(groups[:-1])}.{groups[-1]}"]
    return [whole + "".join(groups)] if apart and len(groups[-1]) == 3 else []


def measures(unit: str, like: str) -> bool:
    """Return True if one unit has the dimension of another."""
    try:
        return read_unit(unit, like) > 0
    except QuantityFault:
        return False


def meant_unit(text: str, like: str) -> str:
    """Return the unit of the dimension of `like` that an unknown unit stands for, written with other letters or in
    words; "" if there is none or more than one.
    """
    plain = text.strip().casefold()
    known = {MEANT[plain]} if plain in MEANT else {unit for unit in (*PLAIN, "MN", "kPa") if unit.casefold() == plain}
    close = [unit for unit in known if measures(unit, like)]
    return close[0] if len(close) == 1 else ""


def read_unit(text: str, unit: str) -> float:
    """Return the SI factor of a unit of the same dimension as `unit`; raises `QuantityFault`."""
    try:
        factor, dimension = scale(text.strip())
    except ValueError:
        raise QuantityFault("unknown-unit", given=text, unit=unit) from None
    if dimension != scale(unit)[1]:
        raise QuantityFault("wrong-unit", given=text, unit=unit)
    return factor


def scale(unit: str) -> tuple[float, Dimension]:
    """Return the SI factor and the dimension of a unit's text; raises `ValueError` for an unknown unit."""
    unit = SPELLED.get(unit.casefold()) or common_unit(unit)
    unit = SPELLED.get(unit.casefold(), unit)
    return PLAIN[unit] if unit in PLAIN else scale_by_pint(unit)


@cache
def scale_by_pint(unit: str) -> tuple[float, Dimension]:
    """Return the same as `scale`, always by pint; `m2`, `m²`, `kg·m2`, `kg.m2` and `kgm2` are understood."""
    if not re.fullmatch(UNIT, unit) or len(unit) > _LONGEST or _TOWER.search(unit):
        raise ValueError(unit)
    spelled = re.sub(r"(?<=[A-Za-z)])\s*[.·⋅]\s*(?=[A-Za-z(])", " ", _JOINED.sub(r"\1 ", unit).replace("º", "°"))
    spelled = re.sub(r"(?<=[A-Za-zµμΩ])(?=[+-]?[0-9])", "**", spelled)
    registry = _registry()
    try:
        factor, base = registry.get_base_units(registry.parse_units(spelled))
    # pint's parser answers nonsense with whatever breaks first: syntax, assertion, type, undefined unit.
    except Exception:
        raise ValueError(unit) from None
    return float(factor), tuple(sorted((str(name), float(power)) for name, power in base._units.items()))


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry()


def _cleaned(text: str) -> str:
    """Return the text without outer blanks, its minus sign plain; raises for a text that cannot be a number."""
    cleaned = text.strip().replace("\N{MINUS SIGN}", "-")
    if len(cleaned) > _LONGEST:
        raise QuantityFault("not-a-number", text=text)
    if (match := _MARKED.fullmatch(cleaned)) and ("," in match[2] or match[2].count(".") > 1):
        readings = (f"{match[1]}{number}{match[3]}" for number in _readings(match[2]))
        code = "decimal-comma" if "," in match[2] else "not-a-number"
        raise QuantityFault(code, text=text, **dict(zip(("fixed", "other"), readings, strict=False)))
    if _NOT_FINITE.fullmatch(cleaned):
        raise QuantityFault("not-finite", text=text)
    return cleaned


# --- rounding and writing of numbers --------------------------------------------------------------
# Decimal comma or point, no negative zero, no rounding dust.

MINUS = "\N{MINUS SIGN}"


Numbers = TypeVar("Numbers", float, "np.ndarray")

TIE = 1e-9
"""Units of the last digit by which floats may miss a five that is rounded up."""


def rounded(values: Numbers, decimals: int) -> Numbers:
    """Return a number, or an array of any shape, rounded half up as by hand to `decimals`, 2.675 to 2.68; never a
    negative zero.
    """
    step = 10.0**decimals
    return (abs(values) * step + 0.5 + TIE) // 1 / step * (1 - 2 * (values < 0)) + 0.0


def write(value: float, decimals: int | None, language: Language) -> str:
    """Return the text of a number (any unit) with fixed `decimals`, or in the shortest exact form if None.

    It has the language's decimal mark, a true minus sign and no thousands mark.  Very large or small numbers have a
    power of ten.
    """
    if not math.isfinite(value):
        return "–"
    if parts := by_power_of_ten(value, decimals):
        return f"{write(parts.factor, parts.decimals, language)}·{power_of_ten(parts.exponent)}"
    number = Decimal(repr(float(value if decimals is None else rounded(value, decimals)))) + 0
    text = f"{number.normalize():f}" if decimals is None else f"{number:.{max(decimals, 0)}f}"
    text = text.replace("-", MINUS)
    return text.replace(".", decimal_mark(language))


LARGE = 1e7
"""From this size on a number is rounded to its significant figures and written with a power of ten."""
MOST_DECIMALS = 8
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class PowerOfTen(Record):
    """A number as `factor`·10^`exponent`, the factor with `decimals` (None: unchanged)."""

    factor: float
    decimals: int | None
    exponent: int


def by_power_of_ten(value: float, decimals: int | None) -> PowerOfTen | None:
    """Return a number (any unit) with `decimals` as factor and power of ten; None if it is written without a power."""
    fixed = decimals is not None and 0 <= decimals <= MOST_DECIMALS
    if abs(value) < 1e9 and (fixed or (decimals is None and (abs(value) >= 1e-6 or value == 0))):
        return None
    number = Decimal(repr(float(value)))
    if decimals is not None:
        number = Decimal(repr(rounded(float(value), decimals))).quantize(Decimal(1).scaleb(-decimals))
    exponent = number.adjusted()
    if number == 0 or (exponent == 0 and decimals is not None):
        return None
    kept = None if fixed or decimals is None else exponent + decimals
    return PowerOfTen(float(number.scaleb(-exponent)), kept, exponent)


def power_of_ten(exponent: int) -> str:
    """Return a power of ten as text: 10⁻⁶."""
    return f"10{str(exponent).translate(_RAISED)}"


def grouped(value: float) -> str:
    """Return a bound (any unit) for a message: 0.000001, 10 000 000, with a decimal point; beyond that 10⁹."""
    if parts := by_power_of_ten(value, None):
        return f"{parts.factor:g}·{power_of_ten(parts.exponent)}".removeprefix("1·").replace("-1·", MINUS)
    whole, point, decimals = f"{Decimal(repr(float(value))).normalize():f}".partition(".")
    groups = f"{int(whole):,}".replace(",", "\N{NO-BREAK SPACE}") if abs(int(whole)) >= 10_000 else whole
    return f"{groups}{point}{decimals}".replace("-", MINUS)


def significant_decimals(value: float, digits: int) -> int:
    """Return the decimals that show `value` (any unit) with `digits` significant figures; 0 for a value of zero.

    A value that is a power of ten up to its last binary digits counts as that power.
    """
    if value == 0 or not math.isfinite(value):
        return 0
    return digits - 1 - math.floor(math.log10(abs(value)) + 1e-12)


def figure_decimals(largest: float, digits: int) -> int:
    """Return the decimals that show numbers up to `largest` (any unit) with `digits` significant figures; at least 0
    below `LARGE`.
    """
    decimals = significant_decimals(largest, digits)
    return decimals if abs(largest) >= LARGE else max(decimals, 0)


SERIES = (1.0, 2.0, 2.5, 4.0, 5.0)
"""Scales one measures with are these times a power of ten."""


def nice_up(value: float, series: Sequence[float] = SERIES) -> float:
    """Return the smallest s·10ⁿ, s of the series, that is not below `value`, in its unit.

    Raises `ValueError` unless `value` is positive and finite.
    """
    if not (value > 0 and math.isfinite(value)):
        raise ValueError("a scale is a positive number")
    decade = math.floor(math.log10(value))
    choices = (float(f"{step}e{power}") for power in (decade, decade + 1, decade + 2) for step in sorted(series))
    # A value that is a member but for its last binary digits is that member.
    return next(choice for choice in choices if choice >= value * (1 - 1e-12))


def nice_down(value: float, series: Sequence[float] = SERIES) -> float:
    """Return the largest s·10ⁿ, s of the series, not above `value`, in its unit; raises `ValueError` as
    `nice_up` does.
    """
    if not (value > 0 and math.isfinite(value)):
        raise ValueError("a scale is a positive number")
    decade = math.floor(math.log10(value))
    choices = (float(f"{step}e{power}") for power in (decade + 1, decade, decade - 1) for step in sorted(series)[::-1])
    return next(choice for choice in choices if choice <= value * (1 + 1e-12))
