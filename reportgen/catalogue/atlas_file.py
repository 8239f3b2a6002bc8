"""Read a machine of the atlas from its file: words, parameters with bounds, and a linkage of formulas.

`MachineFile` is the form of the file. `read_machine` checks it and compiles the formulas; the result expands parameters
to the content of a `linkage` file. All faults have their places in the machine's file.
"""

from __future__ import annotations

import ast
import keyword
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any

from pydantic import Field
from pydantic_core import PydanticCustomError

from reportgen.assignment.common import Check, Draft, Drawing, Kind, Part, Positions
from reportgen.assignment.fields import UNIT_KEY, Interval, OneLine, Quantity, Ratio, Reader, fault
from reportgen.assignment.parameter_formulas import FUNCTIONS, PLAIN, UNITS, Amount, Formula, FormulaError, formula
from reportgen.assignment.reading import model_of, placed, read_section
from reportgen.assignment.schema import Schema, parameters_schema, places
from reportgen.base.atlas_words import LONGEST_WORDS
from reportgen.base.errors import Fault, Finding, Where
from reportgen.base.records import Record, replace
from reportgen.base.template_folders import languages
from reportgen.base.topics import topics
from reportgen.base.typing_mistakes import in_quotes
from reportgen.base.units import Dimension, Given, QuantityFault, read_quantity, read_ratio, read_unit, scale
from reportgen.base.words import close_or_known
from reportgen.base.yaml_source import STRANGE, Source, in_a_line
from reportgen.catalogue import linkage_file
from reportgen.catalogue.parameters import UnderGravity

MOST_PARAMETERS = 40
FIGURES = 6
"""Significant figures of a calculated value: it is printed with all its figures and used as printed."""
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9]{0,19}")
_SUM = re.compile(r"\s[-+\N{MINUS SIGN}]\s")
"""The sign of a sum, which no unit has."""
_FRACTIONS = frozenset({"s", "height"})
"""Lists of pure numbers beside others in the `unit` of their table."""
_SECTION = "linkage"


class _Passage(Reader):
    """A text of some sentences, kept as one line."""

    def read(self, value: object) -> str:
        if not isinstance(value, str):
            raise fault("wrong-type", expected="text")
        text = in_a_line(in_quotes(value) or value)
        if len(text) > LONGEST_WORDS:
            raise fault("text-too-long", largest=str(LONGEST_WORDS))
        if STRANGE.search(text):
            raise fault("control-character")
        return text

    def schema(self) -> dict[str, Any]:
        return {"type": "string", "maxLength": LONGEST_WORDS}


Passage = Annotated[str, _Passage()]


class MachineWords(Part):
    """The words of a machine in a language; links are named by their numbers."""

    title: OneLine
    uses: Passage | None = None
    description: Passage
    task: Passage | None = None
    parameters: dict[str, OneLine] = Field(default_factory=dict)
    links: dict[str, OneLine] = Field(default_factory=dict)


class ParameterBounds(Part):
    """A parameter: its default, whose unit gives its dimension, and its bounds."""

    default: OneLine
    least: OneLine | None = None
    most: OneLine | None = None


class MachineFile(Part):
    """A machine of the atlas; `linkage` has the keys of a `linkage` file, with formulas in place of quantities."""

    words: Annotated[dict[str, MachineWords], Field(min_length=1)]
    parameters: Annotated[dict[str, ParameterBounds], Field(max_length=MOST_PARAMETERS)]
    positions: Positions = Positions()
    drawing: Drawing = Drawing()
    linkage: dict[str, Any]


class Parameter(Record):
    """A parameter of a machine, with the reader of its values."""

    name: str
    reader: Quantity | Ratio
    default: Given

    @property
    def unit(self) -> str:
        return self.default.unit


class PlacedFormula(Record):
    """A formula at a place of the linkage, and the unit of its value there; "" for a pure number."""

    where: Where
    formula: Formula
    unit: str
    is_number: bool
    """True in a list of numbers, whose unit is named once beside it."""

    def text(self, given: Mapping[str, Given]) -> str:
        """Return the value as a `linkage` file would have it; a bare parameter as typed.  Raises `FormulaError`."""
        bare = self.formula.bare
        if bare and not self.is_number and Amount.of(given[bare]).dimension == _dimension(self.unit):
            return given[bare].text
        value, unit = self.value(given), self.result_unit(given)
        number = f"{value.si / read_unit(unit, unit) if unit else value.si:.{FIGURES}g}"
        return number if self.is_number or not unit else f"{number} {unit}"

    def value(self, given: Mapping[str, Given]) -> Amount:
        """Return the value for some parameters.  Raises `FormulaError`, also if its unit is not that of the place."""
        value = self.formula.value({name: Amount.of(given[name]) for name in self.formula.names})
        if value.dimension != _dimension(self.unit):
            raise FormulaError("formula-units", text=self.formula.text)
        return value

    def result_unit(self, given: Mapping[str, Given]) -> str:
        """Return the unit of the value: that of the parameters, if they have one and it fits; else of the place."""
        units = {given[name].unit for name in self.formula.names}
        unit = next(iter(units), "")
        fits = not self.is_number and len(units) == 1 and unit and _dimension(unit) == _dimension(self.unit)
        return unit if fits else self.unit


def _is_unit(text: str) -> bool:
    """Return True for the unit of a list of numbers, "" for pure numbers; its table may name anything."""
    try:
        _dimension(text)
    except ValueError:
        return False
    return True


def _dimension(unit: str) -> Dimension:
    return scale(unit)[1] if unit else PLAIN


@dataclass(frozen=True, eq=False)
class CompiledMachine:
    """A machine whose file is in order: its content, its parameters, and the formulas of its linkage."""

    content: MachineFile
    parameters: Mapping[str, Parameter]
    formulas: Sequence[PlacedFormula]

    def expanded(self, given: Mapping[str, Given]) -> dict[str, Any]:
        """Return the plain content of a `linkage` file for some parameters.  Raises `FormulaError`."""
        made: dict[str, Any] = _copied(self.content.linkage)
        for at in self.formulas:
            _put(made, at.where, at.text(given))
        return made

    def names_at(self, where: Where) -> list[str]:
        """Return the parameters on which the values at, below or above a place of the linkage depend."""
        near = (one for one in self.formulas if one.where[: len(where)] == where[: len(one.where)])
        return list(dict.fromkeys(name for one in near for name in one.formula.names))


def read_machine(source: Source, base: Kind) -> tuple[CompiledMachine | None, list[Fault]]:
    """Return the machine of nodes, whose linkage is of the kind `base`; else its faults.

    The assembly is not checked.
    """
    content, faults = model_of(source, MachineFile)
    if faults or content is None:
        return None, faults
    parameters: dict[str, Parameter] = {}
    findings = [*_of_words(content), *_of_parameters(content, parameters)]
    formulas: list[PlacedFormula] = []
    findings += _compiled(content, parameters, base, formulas)
    machine = CompiledMachine(content, parameters, formulas)
    # A formula at a misspelt key is not compiled, so the linkage comes before its unused parameters.
    for further in (_expansion, _unused, _named_links):
        if not findings:
            findings += further(machine)
    faults = placed(source, findings)
    return (None if faults else machine), faults


def _of_words(content: MachineFile) -> Iterator[Finding]:
    """Yield faults for languages, parameters and links that do not exist."""
    for language, words in content.words.items():
        at: Where = ("words", language)
        if language not in languages():
            yield Finding("choice", at, {"allowed": ", ".join(languages())}, at="key")
        for name in words.parameters:
            if name not in content.parameters:
                close = close_or_known(name, list(content.parameters))
                yield Finding("unknown-key", (*at, "parameters", name), {"key": name, **close}, at="key")
        for link in words.links:
            if not re.fullmatch(r"[1-9][0-9]?", link):
                yield Finding("no-such-link", (*at, "links", link), {"text": link, "known": "1, 2, 3 …"}, at="key")


def _of_parameters(content: MachineFile, made: dict[str, Parameter]) -> Iterator[Finding]:
    """Yield faults of the parameters, and enter those without a fault into `made`."""
    for name, about in content.parameters.items():
        at: Where = ("parameters", name)
        if not _NAME.fullmatch(name) or name in RESERVED or hasattr(UnderGravity, name):
            yield Finding("parameter-name", at, {"text": name}, at="key")
            continue
        key = "default"
        try:
            default = read_typed(about.default)
            numbers = {}
            for key, text in (("least", about.least), ("most", about.most)):
                if text is not None:
                    numbers[key] = read_typed(text, default.unit).si / _factor(default.unit)
            if numbers.get("least", -math.inf) > numbers.get("most", math.inf):
                yield Finding("range-order", (*at, "least"), {"last": about.most or ""})
                continue
            reader = _reader(default.unit, Interval(**numbers))
            key = "default"
            made[name] = Parameter(name, reader, reader.read(about.default))
        except QuantityFault as problem:
            text = str(getattr(about, key))
            if _calculates(text, frozenset(content.parameters)):
                yield Finding("formula-here", (*at, key), {"text": text})
            else:
                yield Finding(problem.code, (*at, key), problem.arguments)
        except PydanticCustomError as problem:
            context = dict(problem.context or {})
            yield Finding(context.pop("code"), (*at, key), {name: str(text) for name, text in context.items()})


RESERVED = frozenset(
    {
        *(*UNITS, *FUNCTIONS, *keyword.kwlist, *UnderGravity.model_fields, *topics()),
        *("positions", "linkage", "expanded", "machine", "slides"),
    }
)
"""Names that no parameter can have: units, functions and words of formulas, keys and members of every machine."""


def read_typed(text: str, unit: str | None = None) -> Given:
    """Return a quantity with any unit, or a pure number; of the dimension of `unit` if one is given.

    Raises `QuantityFault`.
    """
    if unit is not None:
        return read_quantity(text, unit) if unit else read_ratio(text)
    match = re.fullmatch(r"[-+\N{MINUS SIGN}\d.eE]+\s*([^\W\d].*|°.*)", text.strip())
    if match is None:
        return read_ratio(text)
    try:
        scale(match[1])
    except ValueError:
        raise QuantityFault("unknown-unit", given=match[1], unit="mm") from None
    return read_quantity(text, match[1])


def _factor(unit: str) -> float:
    return read_unit(unit, unit) if unit else 1.0


def _reader(unit: str, interval: Interval) -> Quantity | Ratio:
    return Quantity(unit, interval) if unit else Ratio(interval)


# --- formulas -------------------------------------------------------------------------------------


def _compiled(
    content: MachineFile, parameters: Mapping[str, Parameter], base: Kind, made: list[PlacedFormula]
) -> Iterator[Finding]:
    """Yield faults of the formulas in the linkage, and enter those without a fault into `made`."""
    known = frozenset(content.parameters)
    given = {name: one.default for name, one in parameters.items()}
    strange: list[Where] = []
    for where, text in _leaves(content.linkage, ()):
        asked = _asked_for(base, content.linkage, where)
        if asked is None or _is_literal(text, *asked, known):
            continue
        at: Where = (_SECTION, *where)
        if not _is_unit(asked[0]):
            table = at[: -1 if isinstance(where[-1], str) else -2]
            if table not in strange:
                strange.append(table)
                yield Finding("unknown-unit", table, {"given": asked[0], "unit": "N"})
            continue
        try:
            entry = PlacedFormula(where, formula(text, known), *asked)
            if all(name in given for name in entry.formula.names):
                entry.text(given)
                made.append(entry)
        except FormulaError as problem:
            arguments = {"unit": asked[0] or "1", **problem.arguments}
            yield Finding(problem.code, at, arguments)


def _leaves(content: Any, where: Where) -> Iterator[tuple[Where, str]]:
    if isinstance(content, str):
        yield where, content
    for step, inner in content.items() if isinstance(content, dict) else _numbered(content):
        yield from _leaves(inner, (*where, step))


def _numbered(content: Any) -> Iterator[tuple[int, Any]]:
    yield from enumerate(content) if isinstance(content, list) else ()


def _asked_for(base: Kind, linkage: Mapping[str, Any], where: Where) -> tuple[str, bool] | None:
    """Return the unit that a value of the linkage has, and True for a number without its unit; None for other texts."""
    schemas = _schemas(base, tuple(0 if isinstance(step, int) else step for step in where))
    units = [schema[UNIT_KEY] for schema in schemas if UNIT_KEY in schema]
    if units:
        return str(units[0]), False
    if not any(schema.get("type") == "number" for schema in schemas):
        return None
    key = [step for step in where if isinstance(step, str)][-1]
    table: Any = linkage
    for step in where[: -1 if isinstance(where[-1], str) else -2]:
        table = table[step]
    unit = table.get("unit") or table.get("torque_unit") if key not in _FRACTIONS else ""
    return str(unit or ""), True


@cache
def _schemas(base: Kind, where: Where) -> list[Schema]:
    schema = parameters_schema(base)
    return places(schema, schema, where)


def _is_literal(text: str, unit: str, is_number: bool, known: frozenset[str]) -> bool:
    """Return True for a text that is a value, perhaps a faulty one, rather than a formula."""
    if _SUM.search(text):
        return False
    try:
        read_ratio(text) if is_number or not unit else read_quantity(text, unit)
    except QuantityFault as problem:
        if problem.code == "unexpected-unit" and unit:
            # In a list of numbers with a common unit, `2 kN` is a formula without parameters.
            return False
        if problem.code not in ("not-a-number", "unknown-unit", "unexpected-unit", "wrong-unit"):
            return True
        # A faulty value begins with a number; the name of a parameter, or a sign, makes it a formula.
        words = set(re.findall(r"[A-Za-z][A-Za-z0-9]*", text))
        return problem.code != "not-a-number" and not words & known and not _is_calculation(text)
    return True


def _is_calculation(text: str) -> bool:
    """Return True for a formula of quantities alone, such as `180 mm/2`."""
    try:
        return isinstance(formula(text, frozenset()).tree, ast.BinOp)
    except FormulaError:
        return False


def _calculates(text: str, known: frozenset[str]) -> bool:
    """Return True for a formula of parameters or quantities that is more than a quantity."""
    try:
        read = formula(text, known)
    except FormulaError:
        return False
    return bool(read.names or (read.constants and not isinstance(read.tree, ast.Name)))


def _copied(content: Any) -> Any:
    if isinstance(content, dict):
        return {key: _copied(value) for key, value in content.items()}
    return [_copied(value) for value in content] if isinstance(content, list) else content


def _put(content: Any, where: Where, text: str) -> None:
    for step in where[:-1]:
        content = content[step]
    content[where[-1]] = text


# --- the linkage with its defaults ----------------------------------------------------------------


def _expansion(machine: CompiledMachine) -> list[Finding]:
    """Return the faults of single values and keys of the linkage with the default parameters."""
    content = machine.expanded({name: one.default for name, one in machine.parameters.items()})
    _, findings = read_section(_SECTION, linkage_file.Parameters, content)
    return findings


def _unused(machine: CompiledMachine) -> Iterator[Finding]:
    """Yield faults for parameters that no formula uses."""
    used = {name for one in machine.formulas for name in one.formula.names}
    for name in machine.parameters:
        if name not in used:
            yield Finding("parameter-unused", ("parameters", name), {"text": name}, at="key")


def _named_links(machine: CompiledMachine) -> Iterator[Finding]:
    """Yield faults for names of links that the machine does not have."""
    known = {1, *(link for group in machine.content.linkage["groups"] for link in map(int, group["links"]))}
    for language, words in machine.content.words.items():
        for link in words.links:
            if int(link) not in known:
                numbers = {"text": link, "known": ", ".join(map(str, sorted(known)))}
                yield Finding("no-such-link", ("words", language, "links", link), numbers, at="key")


def checked(
    machine: CompiledMachine, source: Source, checks: Sequence[Check], given: Mapping[str, Given] | None = None
) -> list[Fault]:
    """Return the faults of a machine with its default parameters but for those `given`, by the checks of its linkage.

    Raises `FormulaError` if a formula has no value.
    """
    content = machine.expanded({name: one.default for name, one in machine.parameters.items()} | dict(given or {}))
    value, _ = read_section("parameters", linkage_file.Parameters, content)
    positions = machine.content.positions
    draft = Draft({"parameters": content}, {"parameters": value, "positions": positions})
    findings = [finding for check in checks for finding in check(draft)]
    return placed(source, (replace(one, where=in_machine(one.where)) for one in findings))


def at_bounds(machine: CompiledMachine, source: Source, checks: Sequence[Check]) -> list[Fault]:
    """Return faults for the bounds at which the machine, with the defaults of the other parameters, has faults."""
    findings = []
    for name, parameter in machine.parameters.items():
        about = machine.content.parameters[name]
        for key, text in (("least", about.least), ("most", about.most)):
            if text is None or text == about.default:
                continue
            try:
                is_right = not checked(machine, source, checks, {name: parameter.reader.read(text)})
            except FormulaError:
                is_right = False
            if not is_right:
                findings.append(Finding("bound-fails", ("parameters", name, key), {"name": name, "text": text}))
    return placed(source, findings)


def without_names(machine: CompiledMachine, source: Source) -> list[Fault]:
    """Return faults for languages whose words do not name all parameters."""
    findings = []
    for language, words in machine.content.words.items():
        if missing := [name for name in machine.parameters if name not in words.parameters]:
            names = {"key": language, "known": ", ".join(missing)}
            findings.append(Finding("parameters-unnamed", ("words", language), names, at="key"))
    return placed(source, findings)


def in_machine(where: Where) -> Where:
    """Return the place in a machine's file of a place in a `linkage` file."""
    return (_SECTION, *where[1:]) if where[:1] == ("parameters",) else where
