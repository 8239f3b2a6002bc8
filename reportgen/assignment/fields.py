"""Types of the values in assignment files: one small reader per kind of value, with its part of the JSON Schema.

A reader is pydantic metadata: `Length = Annotated[Given, Quantity("mm", above=0, below=100)]`. It takes the text of the
file and returns a value or raises a `PydanticCustomError` with a message's code.
"""

from __future__ import annotations

import datetime
import math
import re
from collections.abc import Callable
from typing import Annotated, Any

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

from reportgen.base.records import Record
from reportgen.base.template_folders import languages, school_folder, school_strays, schools, templates
from reportgen.base.timestamps import moment
from reportgen.base.typing_mistakes import in_quotes
from reportgen.base.units import (
    NUMBER,
    Given,
    QuantityFault,
    grouped,
    read_named_unit,
    read_quantity,
    read_ratio,
    read_unit,
)
from reportgen.base.yaml_source import STRANGE, Quoted

UNIT_KEY, RANGE_KEY, UNIT_NAME_KEY = "x-unit", "x-range", "x-unit-name"
"""Extensions of the schema standard: the unit of a quantity, its bounds in that unit, and the unit of a unit's name."""
LONGEST_TEXT = 300
MOST_WORKED = 720
_UNIT_PATTERN = r"[A-Za-zµ°ºđ][^,]*"
_SLUG = r"[a-z0-9][a-z0-9-]{0,60}"
RESERVED = re.compile(r"(CON|PRN|AUX|NUL|CLOCK|CONIN|CONOUT|COM[0-9]|LPT[0-9])")
"""Upper-case names that some systems reserve for devices."""
_INTEGER = re.compile(r"[+-]?[0-9]{1,9}")
_LABEL = re.compile(r"[a-z]|[0-9]{1,3}|[IVX]{1,5}")


def fault(code: str, **arguments: str) -> PydanticCustomError:
    """Return the fault `code` of the message table as a pydantic error."""
    return PydanticCustomError("fault", "{code}", {"code": code, **arguments})


class Reader(Record):
    """Base of the readers: `read` makes a value of the text in the file, `schema` describes that text."""

    def read(self, value: object) -> Any:
        raise fault("wrong-type", expected="text")

    def schema(self) -> dict[str, Any]:
        return {}

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return self.schema()


class Interval(Record):
    """Range of a number; `above` and `below` are open ends, `least` and `most` closed ones.

    A number smaller than `tiny` but not 0 is a typing mistake, too: no machine has a mass of 1e-300 kg.
    """

    above: float = -math.inf
    below: float = math.inf
    least: float = -math.inf
    most: float = math.inf
    tiny: float = 0.0

    def __contains__(self, value: float) -> bool:
        within = self.above < value < self.below and self.least <= value <= self.most
        return within and (value == 0 or abs(value) >= self.tiny)

    @property
    def words(self) -> dict[str, str]:
        """Arguments of a message about the interval: the name of its phrase, and its numbers."""
        low, high = max(self.above, self.least), min(self.below, self.most)
        about_zero = low < 0
        ends = ("above" if self.above > -math.inf else "from") + ("_below" if self.below < math.inf else "_to")
        if math.isinf(low):
            ends = "only_to"
        elif math.isinf(high):
            ends = "only_from"
        zero = "" if not self.tiny else "+or_small" if about_zero else "+or_zero"
        numbers = {"low": low if about_zero else max(low, self.tiny), "high": high, "tiny": self.tiny}
        return {"range": f"{ends}{zero}", **{name: grouped(number) for name, number in numbers.items()}}

    def require(self, value: float, text: str, unit: str = "", **hint: str) -> None:
        """Raise the fault of a value (SI), typed as `text`, that is outside the interval."""
        if value not in self:
            raise fault("out-of-range", text=text, unit=f" {unit}" if unit else "", **self.words, **hint)

    def schema(self) -> dict[str, float]:
        keys = ("exclusiveMinimum", "exclusiveMaximum", "minimum", "maximum")
        ends = zip(keys, (self.above, self.below, self.least, self.most), strict=True)
        return {key: end for key, end in ends if math.isfinite(end)}


class Quantity(Reader):
    """A number with a unit of the dimension of `unit`, its value in `unit` within `interval`."""

    unit: str
    interval: Interval = Interval()

    def read(self, value: object) -> Given:
        given = _measured(lambda text: read_quantity(text, self.unit), value)
        self.interval.require(given.si / read_unit(self.unit, self.unit), given.text, self.unit)
        return given

    def schema(self) -> dict[str, Any]:
        typed = {"type": "string", "pattern": rf"^\s*{NUMBER}\s*{_UNIT_PATTERN}$", "examples": [f"1 {self.unit}"]}
        return {**typed, UNIT_KEY: self.unit, RANGE_KEY: self.interval.schema()}


class SchoolFolder(Reader):
    """The folder of a school's own words beside those of the languages, such as templates/tnut/ for `tnut`."""

    def read(self, value: object) -> str:
        known = schools()
        if value not in known:
            raise fault("no-such-school", text=str(value), known=", ".join(known) or "–", place=str(templates()))
        folder = school_folder(str(value))
        if school_strays(folder, folder.parent):
            raise fault("path-outside", text=str(value))
        return str(value)

    def schema(self) -> dict[str, Any]:
        return {"type": "string", "pattern": f"^{_SLUG}$"}


class LanguageName(Reader):
    """A language that has a folder of words."""

    def read(self, value: object) -> str:
        if value not in languages():
            raise fault("choice", allowed=", ".join(languages()))
        return str(value)

    def schema(self) -> dict[str, Any]:
        return {"type": "string", "enum": list(languages())}


class UnitOf(Reader):
    """The name of a unit of the dimension of `unit`: one of it, as a `Given`."""

    unit: str

    def read(self, value: object) -> Given:
        return _measured(lambda text: Given(read_named_unit(text, self.unit), 1.0, text.strip(), text), value)

    def schema(self) -> dict[str, Any]:
        return {"type": "string", "pattern": f"^{_UNIT_PATTERN}$", "examples": [self.unit], UNIT_NAME_KEY: self.unit}


class Ratio(Reader):
    """A pure number, `0.35` or `1/3.6`; with `inverse`, a value of 1 or more is read as the inverse ratio."""

    interval: Interval = Interval()
    inverse: str = ""

    def read(self, value: object) -> Given:
        given = _measured(read_ratio, value)
        hint = {}
        if self.inverse and given.si >= 1:
            turned = 2 <= given.si <= 10 and "/" not in given.text
            hint = {"hint": self.inverse, "turned": f"1/{given.text.strip()}" if turned else "1/3.6"}
        self.interval.require(given.si, given.text, **hint)
        return given

    def schema(self) -> dict[str, Any]:
        number = {"type": "number", **self.interval.schema()}
        typed = {"type": "string", "pattern": rf"^\s*{NUMBER}\s*(/\s*{NUMBER}\s*)?$", RANGE_KEY: self.interval.schema()}
        return {"anyOf": [number, typed]}


class Decimal(Reader):
    """A pure number of a table: no unit, no fraction."""

    interval: Interval = Interval()

    def read(self, value: object) -> float:
        given = _measured(lambda text: read_ratio(text, fractions=False), value)
        self.interval.require(given.si, given.text)
        return given.si

    def schema(self) -> dict[str, Any]:
        return {"type": "number", **self.interval.schema()}


class Percent(Reader):
    """A share from 0 to 1, written `80 %` or `0.8`."""

    interval: Interval = Interval(least=0, most=1)

    def read(self, value: object) -> float:
        text = _text(value, "number").strip()
        bare = text.removesuffix("%")
        given = _measured(lambda number: read_ratio(number, fractions=False), bare)
        share = given.si / 100 if bare != text else given.si
        self.interval.require(share, text)
        return share

    def schema(self) -> dict[str, Any]:
        return {
            "anyOf": [{"type": "number", **self.interval.schema()}, {"type": "string", "pattern": rf"^{NUMBER}\s*%$"}]
        }


class Whole(Reader):
    """A whole number from `least` to `most`."""

    least: int
    most: int

    def read(self, value: object) -> int:
        text = _text(value, "whole number")
        if not _INTEGER.fullmatch(text.strip()):
            raise fault("wrong-type", expected="whole number", text=text)
        Interval(least=self.least, most=self.most).require(int(text), text)
        return int(text)

    def schema(self) -> dict[str, Any]:
        return {"type": "integer", "minimum": self.least, "maximum": self.most}


class Flag(Reader):
    """`true` or `false`."""

    def read(self, value: object) -> bool:
        if value not in ("true", "false"):
            raise fault("choice", allowed="true, false")
        return value == "true"

    def schema(self) -> dict[str, Any]:
        return {"type": "boolean"}


class TypedText(Reader):
    """One line of text, kept as typed, without typographic quotation marks around the whole of it."""

    def read(self, value: object) -> str:
        text = _text(value, "text")
        if not isinstance(value, Quoted):
            text = in_quotes(text) or text
        if len(text) > LONGEST_TEXT:
            raise fault("text-too-long", largest=str(LONGEST_TEXT))
        if STRANGE.search(text):
            raise fault("control-character")
        return text

    def schema(self) -> dict[str, Any]:
        return {"type": ["string", "number", "boolean", "null"], "maxLength": LONGEST_TEXT}


class Day(Reader):
    """A date, `2011-03-24`."""

    def read(self, value: object) -> datetime.date:
        text = _text(value, "date")
        try:
            if re.fullmatch(r"[0-9]{4}-[0-9]{2}-[0-9]{2}", text.strip()):
                return datetime.date.fromisoformat(text.strip())
        except ValueError:
            pass
        raise fault("date", text=text)

    def schema(self) -> dict[str, Any]:
        return {"type": ["string", "null"], "pattern": "^[0-9]{4}-[0-9]{2}-[0-9]{2}$", "format": "date"}


class Until(Reader):
    """A moment until which something is valid, `2026-11-20 23:59`; a date alone means the end of that day.

    Without `end` it is a moment from which something is valid, and a date alone means the beginning.
    """

    end: bool = True

    def read(self, value: object) -> datetime.datetime:
        text = _text(value, "moment")
        if (result := moment(text, end=self.end)) is None:
            raise fault("moment", text=text)
        return result

    def schema(self) -> dict[str, Any]:
        return {"type": "string"}


class WorkedPositions(Reader):
    """Positions to write out in full: a list of numbers from 1 and of labels, or "all" (None).

    A label is a letter or a Roman number, or a number in quotation marks.
    """

    def read(self, value: object) -> tuple[int | str, ...] | None:
        if value == "all":
            return None
        if not isinstance(value, list):
            raise fault("wrong-type", expected="list", text=str(value))
        if not value:
            raise fault("too-few", least="1")
        if len(value) > MOST_WORKED:
            raise fault("too-many", most=str(MOST_WORKED))
        named = tuple(str(item) if _is_label(item) else Whole(1, MOST_WORKED).read(item) for item in value)
        if len(set(named)) < len(named):
            raise fault("repeated", text=next(str(n) for n in named if named.count(n) > 1))
        return named

    def schema(self) -> dict[str, Any]:
        item = {"anyOf": [Whole(1, MOST_WORKED).schema(), {"type": "string", "pattern": f"^({_LABEL.pattern})$"}]}
        return {"anyOf": [{"const": "all"}, {"type": "array", "items": item, "minItems": 1, "uniqueItems": True}]}


def _is_label(value: object) -> bool:
    """Return True if a text is the label of a position; digits without quotation marks are a number."""
    named = isinstance(value, str) and _LABEL.fullmatch(value) is not None
    return named and (isinstance(value, Quoted) or str(value).isalpha())


def _text(value: object, expected: str) -> str:
    if not isinstance(value, str):
        raise fault("wrong-type", expected=expected)
    return value


def _measured(read: Callable[[str], Given], value: object) -> Given:
    text = _text(value, "number")
    try:
        return read(text)
    except QuantityFault as problem:
        raise fault(problem.code, **problem.arguments) from None


def quantity(unit: str, **ends: float) -> Quantity:
    """Return a `Quantity` with its interval written in place: `quantity("mm", above=0, below=1e5)`."""
    return Quantity(unit, Interval(**ends))


class Either(Reader):
    """A quantity of one dimension or of another: the angle of a crank, or the displacement of a slider."""

    first: Quantity
    second: Quantity

    def read(self, value: object) -> Given:
        try:
            return self.first.read(value)
        except PydanticCustomError as wrong:
            if (wrong.context or {}).get("code") != "wrong-unit":
                raise
        return self.second.read(value)

    def schema(self) -> dict[str, Any]:
        return self.first.schema() | {"examples": [f"1 {one.unit}" for one in (self.first, self.second)]}


FIND = "find"
"""Word in place of a quantity that the program is to find."""


class NumberOrAngle(Reader):
    """A pure number, or an angle with its unit: the argument of ln x or of sin x."""

    number: Interval
    angle: Quantity

    def read(self, value: object) -> Given:
        given = _measured(_number_or_quantity, value)
        if given.unit:
            return self.angle.read(value)
        self.number.require(given.si, given.text)
        return given

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [{"type": "number", **self.number.schema()}, self.angle.schema()]}


def _number_or_quantity(text: str) -> Given:
    """Return a pure number, or an angle."""
    try:
        return read_quantity(text, "deg")
    except QuantityFault as problem:
        if problem.code != "missing-unit":
            raise
    return read_ratio(text, fractions=False)


class Sought(Reader):
    """A quantity, or None for `find`."""

    given: Quantity

    def read(self, value: object) -> Given | None:
        return None if value == FIND else self.given.read(value)

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [{"const": FIND}, self.given.schema()]}


OneLine = Annotated[str, TypedText()]
Date = Annotated[datetime.date, Day()]
Length = Annotated[Given, quantity("mm", least=0.1, below=1e5)]
FoundLength = Annotated[Given | None, Sought(quantity("mm", least=0.1, below=1e5))]
Coordinate = Annotated[Given, quantity("mm", above=-1e5, below=1e5, tiny=1e-4)]
FoundCoordinate = Annotated[Given | None, Sought(quantity("mm", above=-1e5, below=1e5, tiny=1e-4))]
PointCoordinates = Annotated[tuple[Coordinate, ...], Field(min_length=2, max_length=2)]
Offset = Annotated[Given, quantity("mm", least=0, below=1e5, tiny=1e-4)]
Angle = Annotated[Given, quantity("deg", least=-360, most=360, tiny=1e-6)]
CycleAngle = Annotated[Given, quantity("deg", least=0, most=720)]
RotationalSpeed = Annotated[Given, quantity("rpm", least=1e-3, most=1e5)]
AngularVelocity = Annotated[Given, quantity("rad/s", least=1e-4, most=1e5)]
AngularAcceleration = Annotated[Given, quantity("rad/s2", least=-1e9, most=1e9, tiny=1e-6)]
Force = Annotated[Given, quantity("N", least=-1e9, most=1e9, tiny=1e-6)]
ForceSize = Annotated[Given, quantity("N", least=0, most=1e9, tiny=1e-6)]
ForceUnit = Annotated[Given, UnitOf("N")]
Weight = Annotated[Given, quantity("N", least=0, most=1e7, tiny=1e-6)]
Mass = Annotated[Given, quantity("kg", least=0, most=1e6, tiny=1e-6)]
MomentOfInertia = Annotated[Given, quantity("kg m2", least=0, most=1e7, tiny=1e-12)]
Gravity = Annotated[Given, quantity("m/s2", least=0, most=100, tiny=1e-3)]
Acceleration = Annotated[Given, quantity("m/s2", least=-1e5, most=1e5, tiny=1e-6)]
DEGREES, WAY = quantity("deg", least=-360, most=720, tiny=1e-6), quantity("mm", above=-1e5, below=1e5, tiny=1e-4)
Instant = Annotated[Given, Either(DEGREES, WAY)]
Pressure = Annotated[Given, quantity("N/cm2", least=0, most=1e5, tiny=1e-6)]
RodRatio = Annotated[Given, Ratio(Interval(least=0.001, below=1), inverse="inverse-ratio")]
Share = Annotated[Given, Ratio(Interval(least=0, most=1, tiny=1e-6))]
SwingAngle = Annotated[Given, quantity("deg", least=1, most=170)]
SpeedRatio = Annotated[Given, Ratio(Interval(least=1.001, most=3))]
PressureUnit = Annotated[Given, UnitOf("N/cm2")]
Nodes = Field(min_length=2, max_length=2000)
"""Range of the number of nodes of a table."""
Fractions = Annotated[tuple[Annotated[float, Decimal(Interval(least=0, most=1))], ...], Nodes]
CycleAngles = Annotated[tuple[CycleAngle, ...], Nodes]
NodeValues = Annotated[tuple[Annotated[float, Decimal(Interval(least=-1e9, most=1e9, tiny=1e-6))], ...], Nodes]
