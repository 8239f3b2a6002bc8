"""What a script or a notebook holds: an assignment opened, its quantities as arrays, its figures, curves and tables."""

from __future__ import annotations

import html
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from functools import cached_property
from itertools import product
from pathlib import Path
from typing import Any, get_args

import numpy as np

from reportgen import api, catalogue
from reportgen.api.figures import worked_at
from reportgen.assignment import Assignment
from reportgen.assignment.checks import OneOf
from reportgen.assignment.fields import Quantity
from reportgen.assignment.reading import name_faults
from reportgen.base.errors import AssignmentError, NotOfferedError, UnknownNameError
from reportgen.base.files import put_file, reported
from reportgen.base.source import MappingNode, Scalar, Source, read_source, read_text
from reportgen.base.source_text import at, put, without
from reportgen.base.units import Given, Language, read_unit
from reportgen.base.words import as_error, language_of, unknown, word
from reportgen.case import Case
from reportgen.cases import opened
from reportgen.document import TEXT_WIDTH
from reportgen.document.named_figures import NamedFigure, named_figures
from reportgen.drawing import Diagram, Scene
from reportgen.drawing.sheet import sheets
from reportgen.export import curves, figures
from reportgen.export.curves import Over
from reportgen.export.figures import MovingFigure
from reportgen.export.quantities import QuantityArray, quantity, shown
from reportgen.export.study import Study

PARAMETERS = "parameters"
WRITABLE = 10**300
"""Whole numbers below it are floating-point numbers, too, and Python itself writes their digits."""
UNNAMED = Path("assignment.yaml")
"""What a text or a dict is called in messages."""


def open(source: Path | str | Mapping[str, Any], language: Language | None = None) -> Model:
    """An assignment to work with: a file by its path, or the content of one as a text of several lines or a dict.

    Raises `AssignmentError` with all faults, located.
    """
    if isinstance(source, Mapping):
        # JSON is YAML: each key has a line of its own.
        text = json.dumps(_written(source), ensure_ascii=False, indent=1)
        return Model(read_text(text, str(UNNAMED)), UNNAMED, language)
    if isinstance(source, str) and "\n" in source:
        return Model(read_text(source, str(UNNAMED)), UNNAMED, language)
    return Model(read_source(Path(source)), Path(source), language)


def _written(value: Any) -> Any:
    """A value of Python as JSON has it; a number with more digits than Python writes is a text of them."""
    if isinstance(value, Mapping):
        return {str(key): _written(one) for key, one in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _written(value.tolist())
    if isinstance(value, list | tuple):
        return [_written(one) for one in value]
    if isinstance(value, int) and not isinstance(value, bool):
        return int(value) if abs(value) < WRITABLE else _digits(value)
    return value if isinstance(value, str | float | bool) or value is None else str(value)


def _digits(value: int) -> str:
    """All digits of a whole number, of which Python itself writes 4,300 at most."""
    return f"{Decimal(value):f}"


class Model:
    """An opened assignment; `model["v.E"]` is a quantity at its positions, in SI units."""

    def __init__(self, source: Source, path: Path, language: Language | None = None) -> None:
        assignment, faults = api.assess(source, path)
        faults = [*name_faults(path), *faults]
        if assignment is None or faults:
            raise as_error(faults, language or language_of(source))
        self._source, self._path, self._language = source, path, language
        self.assignment: Assignment = assignment.with_language(language) if language else assignment

    def __repr__(self) -> str:
        return f"<{self.assignment.kind} {self.assignment.id}>"

    def __reduce__(self) -> tuple[Any, ...]:
        # What is computed is computed again where it is wanted.
        return type(self), (self._source, self._path, self._language)

    @cached_property
    def case(self) -> Case:
        """All that is computed of it."""
        return opened(self.assignment)

    # --- numbers

    @property
    def ids(self) -> list[str]:
        """The ids of what changes from position to position, as answer sheets and keys have them."""
        return list(shown(self.case))

    def __getitem__(self, id: str) -> QuantityArray:
        """A quantity [N], or [1] of one that is the same at all positions; what moves on a line has its sign along it.

        Raises `UnknownNameError`.
        """
        return quantity(self.case, id).array

    def with_parameters(self, **values: Any) -> Model:
        """The same with other parameters: texts with units, "260 mm", or numbers in SI units.

        Names with dots lead into others, `**{"cutting.F": "900 N"}`.  Of keys that give the same quantity, as `n` and
        `omega1`, the one given here takes the place of the other.  Raises `AssignmentError` as for a file.
        """
        top = self._source.top
        assert isinstance(top, MappingNode), "an assignment in order is a table"
        for name, value in values.items():
            where = (PARAMETERS, *name.split("."))
            nearest = next(node for step in range(len(where), -1, -1) if (node := at(top, where[:step])) is not None)
            changed = put(top, where, Scalar(self._typed(where, value), nearest.mark))
            table = at(changed, where[:-1])
            if isinstance(table, MappingNode) and (others := self._alternatives(where) - values.keys()):
                changed = put(changed, where[:-1], without(table, others))
            assert isinstance(changed, MappingNode), "a key is put into a table"
            top = changed
        return Model(replace(self._source, top=top), self._path, self._language)

    def _alternatives(self, where: tuple[str, ...]) -> set[str]:
        """The other keys by which a quantity may be given."""
        checks = catalogue.kind(self.assignment.kind).checks
        sets = [set(one.names) for one in checks if isinstance(one, OneOf) and one.where == where[:-1]]
        return {name for names in sets if where[-1] in names for name in names} - {where[-1]}

    def _typed(self, where: tuple[str, ...], value: Any) -> str:
        """A value as a file has it: a number in the unit that it has there already, else in that of its key."""
        if isinstance(value, str):
            return value
        known: Any = self.assignment
        unit = ""
        for step in where:
            fields = {
                (one.alias or name): (name, one) for name, one in getattr(type(known), "model_fields", {}).items()
            }
            name, field = fields.get(step, (step, None))
            unit = _unit_of(field.annotation, *field.metadata) if field is not None else ""
            known = getattr(known, name, None)
        number = value.item() if isinstance(value, np.generic) else value
        if isinstance(number, int) and abs(number) >= WRITABLE:
            return _digits(number)
        if isinstance(known, Given) and known.unit and known.value:
            return f"{float(number) / (known.si / known.value)!r} {known.unit}"
        return f"{float(number) / read_unit(unit, unit)!r} {unit}" if unit else repr(number)

    def study(
        self, *, of: Sequence[str], grid: bool = False, **values: Sequence[Any] | np.ndarray
    ) -> dict[str, QuantityArray]:
        """Quantities [values, positions] by their ids over ranges of parameters, which go side by side.

        With `grid` every value of each range meets every value of the others: arrays [first, second, …, positions] in
        the order of the ranges.  Numbers are in SI units.  A value that `check` refuses has nan.  Raises
        `UnknownNameError`, `RangesError` without ranges or for ranges of different lengths, `AssignmentError` where all
        values are refused.
        """
        ranges = {name: [*np.atleast_1d(np.asarray(row, dtype=object))] for name, row in values.items()}
        lengths = [len(row) for row in ranges.values()]
        if not ranges or not all(lengths) or (not grid and len(set(lengths)) > 1):
            told = ", ".join(f"{name}: {len(row)}" for name, row in ranges.items()) or "–"
            raise RangesError(word("study_ranges", self.assignment.language, ranges=told))
        combined = product(*ranges.values()) if grid else zip(*ranges.values(), strict=True)
        rows = [dict(zip(ranges, row, strict=True)) for row in combined]
        variants: list[Assignment | None] = []
        refused: AssignmentError | None = None
        for row in rows:
            try:
                variants.append(self.with_parameters(**row).assignment)
            except AssignmentError as error:
                refused = error
                variants.append(None)
        if refused is not None and not any(variants):
            raise refused
        found = Study(variants, opened).values(of)
        if not grid:
            return found
        shaped: dict[str, QuantityArray] = {}
        for id, array in found.items():
            shaped[id] = array.reshape(*lengths, *array.shape[1:]).view(QuantityArray)
        return shaped

    def table(self, positions: int | None = None) -> ResultTable:
        """The results as a table, a row a position, of so many positions a turn; raises `NotOfferedError`."""
        from reportgen.results.files import result_rows

        head, *rows = result_rows(api.solve(self.assignment, positions))
        return ResultTable(tuple(map(str, head)), tuple(map(tuple, rows)))

    # --- figures and curves

    def diagram(self, *of: str, over: Over = "phi", label: str = "") -> Diagram:
        """Quantities of one unit as curves through a turn.

        Raises `UnknownNameError`, `NotOfferedError` for what is no curve, `ValueError` for quantities of several units.
        """
        found = curves.diagrams([self._dense], of, over)
        if len(found) != 1:
            raise ValueError(f"one unit a chart, not {len(found)}")
        (diagram,) = found.values()
        if label:
            diagram = replace(diagram, curves=tuple(replace(one, label=label) for one in diagram.curves))
        return diagram

    @cached_property
    def _dense(self) -> Case:
        case = opened(curves.dense(self.assignment))
        curves.check_turning([case])
        return case

    def plot(self, *of: str, ax: Any = None, over: Over = "phi", label: str = "", **look: Any) -> Any:
        """Draw quantities of one unit on axes of matplotlib, on the current ones without `ax`, and give the axes back.

        `look` is that of matplotlib's `plot`.
        """
        if ax is None:
            from reportgen.writers import figure

            ax = figure.current_axes()
        return self.diagram(*of, over=over, label=label).on(ax, self.assignment.language, **look)

    @property
    def figures(self) -> list[str]:
        """The names of its figures, then of what moves."""
        return list(dict.fromkeys([*(one.name for one in self._still), *(one.name for one in self._moving)]))

    def figure(self, name: str, at: str | int = "") -> ShownFigure:
        """A figure by its name, v.4, or with a position `at` only what it shows, v; it shows itself in a notebook.

        Raises `UnknownNameError`, `NotOfferedError`.
        """
        case, labels = worked_at(self.assignment, str(at)) if at != "" else (self.case, ())
        still = self._still if case is self.case else named_figures(case.document())
        moving = next((one for one in self._moving if one.name == name), None)
        query = figures.FigureQuery((name,), labels)
        scenes = (scene for _, scene in figures.drawings(still, query, lambda: self._moving, self.assignment.language))
        return ShownFigure(name, tuple(scenes), self.assignment.language, moving)

    @cached_property
    def _still(self) -> tuple[NamedFigure, ...]:
        return named_figures(self.case.document())

    @cached_property
    def _moving(self) -> tuple[MovingFigure, ...]:
        return figures.moving(self.case)

    def _repr_html_(self) -> str:
        """Its given data, as a notebook shows it."""
        rows = "".join(
            f"<tr><td>{html.escape(name)}</td><td>{html.escape(str(getattr(value, 'text', value)))}</td></tr>"
            for name, value in self.assignment.parameters
            if value is not None
        )
        return f"<p><b>{html.escape(self.case.title)}</b> {html.escape(self.assignment.id)}</p><table>{rows}</table>"


class RangesError(UnknownNameError, ValueError):
    """A study without ranges of parameters, or with ranges that cannot go side by side."""


def _unit_of(annotation: Any, *metadata: Any) -> str:
    """The unit of a key of the assignment file by the type of its field, "" for what is not a quantity."""
    inner = (one for part in get_args(annotation) for one in (part, *getattr(part, "__metadata__", ())))
    for one in (*metadata, *inner):
        if isinstance(one, Quantity):
            return one.unit
    return next((unit for part in get_args(annotation) if (unit := _unit_of(part))), "")


@dataclass(frozen=True, slots=True)
class ShownFigure:
    """A figure of a report, several drawings of it together, or what moves."""

    name: str
    scenes: tuple[Scene, ...]
    language: Language
    moving: MovingFigure | None = None

    @property
    def scene(self) -> Scene:
        """Its drawings on one sheet, in rows as in the report."""
        return self.scenes[0] if len(self.scenes) == 1 else sheets(self.scenes, TEXT_WIDTH, float("inf"), trim=0.0)[0]

    @property
    def diagrams(self) -> tuple[Diagram, ...]:
        """What its charts are painted of; none of a drawing."""
        return tuple(scene.diagram for scene in self.scenes if scene.diagram is not None)

    def save(self, path: Path | str, dpi: int = 0, layers: Sequence[str] = figures.SHOWN) -> Path:
        """Write it to a file, as the ending of its name says: svg, png, pdf, eps; of what moves also gif, mp4.

        Raises `NotOfferedError` for another ending, `TypesetterError`, `OutputError`.
        """
        path = Path(path)
        format = path.suffix.lower().removeprefix(".")
        if format in figures.STILL:
            (content,) = figures.drawn([self.scene], self.language, [format], dpi)[format]
        elif format in figures.MOVING and self.moving is not None:
            content = figures.animated(self.moving.frames(layers), self.language, format, dpi)
        elif format in figures.MOVING:
            raise NotOfferedError(word("figure_stands", self.language, text=self.name, known=""))
        else:
            raise UnknownNameError(unknown("no_format", format, figures.FORMATS, self.language))
        with reported(path):
            put_file(path, content)
        return path

    def _repr_svg_(self) -> str:
        return figures.drawn([self.scene], self.language)["svg"][0].decode()


@dataclass(frozen=True, slots=True)
class ResultTable:
    """Results, a row a position; a column has the way to its number in the JSON of `solve` as its name."""

    columns: tuple[str, ...]
    rows: tuple[tuple[Any, ...], ...]

    def __getitem__(self, column: str) -> np.ndarray:
        """A column of numbers; nan where there is none.  Raises `KeyError`."""
        if column not in self.columns:
            raise KeyError(column)
        at = self.columns.index(column)
        return np.array([np.nan if row[at] is None else row[at] for row in self.rows])

    def to_dataframe(self) -> Any:
        """It as a `pandas.DataFrame`; raises `ImportError` where pandas is not installed."""
        import pandas

        return pandas.DataFrame(list(self.rows), columns=list(self.columns))

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{html.escape(name)}</th>" for name in self.columns)
        rows = "".join(f"<tr>{''.join(f'<td>{_cell(value)}</td>' for value in row)}</tr>" for row in self.rows)
        return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"


def _cell(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else html.escape("" if value is None else str(value))
