"""Interface for scripts and notebooks: `open` returns a `Model` with arrays, figures, curves and tables."""

from __future__ import annotations

import html
import json
from collections.abc import Mapping, Sequence
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
from reportgen.base.records import Record, replace
from reportgen.base.units import Given, Language, read_unit
from reportgen.base.words import as_error, language_of, unknown, word
from reportgen.base.yaml_source import MappingNode, Scalar, Source, read_source, read_text
from reportgen.base.yaml_values import at, put, without
from reportgen.case import Case
from reportgen.cases import opened
from reportgen.document import TEXT_WIDTH
from reportgen.document.named_figures import NamedFigure, named_figures
from reportgen.drawing import Diagram, Scene
from reportgen.drawing.drawing_sheet import sheets
from reportgen.export import curves, figures
from reportgen.export.curves import Over
from reportgen.export.figures import MovingFigure
from reportgen.export.quantities import QuantityArray, quantity, visible_ids
from reportgen.export.study import Study

PARAMETERS = "parameters"
WRITABLE = 10**300
"""Limit of whole numbers that are valid floating-point numbers, and whose digits Python itself writes."""
UNNAMED = Path("assignment.yaml")
"""Name of a text or a dict in messages."""


def open(source: Path | str | Mapping[str, Any], language: Language | None = None) -> Model:
    """Return an assignment to work with: a file by its path, or its content as a text of several lines or a dict.

    Raises `AssignmentError` with all faults, located.
    """
    if isinstance(source, Mapping):
        # JSON is YAML: each key has its own line.
        text = json.dumps(_written(source), ensure_ascii=False, indent=1)
        return Model(read_text(text, str(UNNAMED)), UNNAMED, language)
    if isinstance(source, str) and "\n" in source:
        return Model(read_text(source, str(UNNAMED)), UNNAMED, language)
    return Model(read_source(Path(source)), Path(source), language)


def _written(value: Any) -> Any:
    """Return a Python value as JSON; a number with more digits than Python writes becomes a text."""
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
    """Return all digits of a whole number; Python itself writes at most 4,300."""
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
        # Computed results are computed again when they are needed.
        return type(self), (self._source, self._path, self._language)

    @cached_property
    def case(self) -> Case:
        """The case with all computed results."""
        return opened(self.assignment)

    # --- numbers

    @property
    def ids(self) -> list[str]:
        """The ids of quantities that vary from position to position, as in answer sheets and keys."""
        return list(visible_ids(self.case))

    def __getitem__(self, id: str) -> QuantityArray:
        """Return a quantity [N], or [1] if it is the same at all positions; motion on a line is signed along it.

        Raises `UnknownNameError`.
        """
        return quantity(self.case, id).array

    def with_parameters(self, **values: Any) -> Model:
        """Return the same assignment with other parameters: texts with units, "260 mm", or numbers in SI units.

        Names with dots denote nested parameters, `**{"cutting.F": "900 N"}`. If several keys give the same quantity,
        such as `n` and `omega1`, the one given here replaces the other. Raises `AssignmentError` as for a file.
        """
        top = self._source.top
        assert isinstance(top, MappingNode), "an assignment in order is a table"
        for name, value in values.items():
            where = (PARAMETERS, *name.split("."))
            nearest = next(node for step in range(len(where), -1, -1) if (node := at(top, where[:step])) is not None)
            changed = put(top, where, Scalar(self._typed(where, value), nearest.location))
            table = at(changed, where[:-1])
            if isinstance(table, MappingNode) and (others := self._alternatives(where) - values.keys()):
                changed = put(changed, where[:-1], without(table, others))
            assert isinstance(changed, MappingNode), "a key is put into a table"
            top = changed
        return Model(replace(self._source, top=top), self._path, self._language)

    def _alternatives(self, where: tuple[str, ...]) -> set[str]:
        """Return the other keys that can give the same quantity."""
        checks = catalogue.kind(self.assignment.kind).checks
        sets = [set(one.names) for one in checks if isinstance(one, OneOf) and one.where == where[:-1]]
        return {name for names in sets if where[-1] in names for name in names} - {where[-1]}

    def _typed(self, where: tuple[str, ...], value: Any) -> str:
        """Return a value as in a file: a number in the unit that the file uses, else in that of its key."""
        if isinstance(value, str):
            return value
        known: Any = self.assignment
        unit = ""
        for step in where:
            fields = {
                (info.alias or name): (name, info) for name, info in getattr(type(known), "model_fields", {}).items()
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
        """Return quantities [values, positions] by their ids over ranges of parameters, which vary together.

        With `grid`, each value of a range is combined with each value of the others: arrays [first, second, …,
        positions] in the order of the ranges. Numbers are in SI units. A value that `check` rejects gives nan. Raises
        `UnknownNameError`, `RangesError` without ranges or for ranges of different lengths, `AssignmentError` if all
        values are rejected.
        """
        ranges = {name: [*np.atleast_1d(np.asarray(row, dtype=object))] for name, row in values.items()}
        lengths = [len(row) for row in ranges.values()]
        if not ranges or not all(lengths) or (not grid and len(set(lengths)) > 1):
            listed = ", ".join(f"{name}: {len(row)}" for name, row in ranges.items()) or "–"
            raise RangesError(word("study_ranges", self.assignment.language, ranges=listed))
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
        arrays = Study(variants, opened).values(of)
        if not grid:
            return arrays
        shaped: dict[str, QuantityArray] = {}
        for id, array in arrays.items():
            shaped[id] = array.reshape(*lengths, *array.shape[1:]).view(QuantityArray)
        return shaped

    def table(self, positions: int | None = None) -> ResultTable:
        """Return the results as a table with a row per position, for `positions` per turn; raise `NotOfferedError`."""
        from reportgen.results.result_files import result_rows

        head, *rows = result_rows(api.solve(self.assignment, positions))
        return ResultTable(tuple(map(str, head)), tuple(map(tuple, rows)))

    # --- figures and curves

    def diagram(self, *of: str, over: Over = "phi", label: str = "") -> Diagram:
        """Return quantities of one unit as curves over a turn.

        Raises `UnknownNameError`, `NotOfferedError` for a quantity that is not a curve, `ValueError` for several units.
        """
        diagrams = curves.diagrams([self._dense], of, over)
        if len(diagrams) != 1:
            raise ValueError(f"one unit a chart, not {len(diagrams)}")
        (diagram,) = diagrams.values()
        if label:
            diagram = replace(diagram, curves=tuple(replace(one, label=label) for one in diagram.curves))
        return diagram

    @cached_property
    def _dense(self) -> Case:
        case = opened(curves.dense(self.assignment))
        curves.check_turning([case])
        return case

    def plot(self, *of: str, ax: Any = None, over: Over = "phi", label: str = "", **look: Any) -> Any:
        """Draw quantities of one unit on matplotlib axes, by default the current ones, and return the axes.

        `look` are arguments of matplotlib's `plot`.
        """
        if ax is None:
            from reportgen.writers import matplotlib_figures

            ax = matplotlib_figures.current_axes()
        return self.diagram(*of, over=over, label=label).on(ax, self.assignment.language, **look)

    @property
    def figures(self) -> list[str]:
        """The names of the figures, then those of the moving figures."""
        return list(dict.fromkeys([*(one.name for one in self._still), *(one.name for one in self._moving)]))

    def figure(self, name: str, at: str | int = "") -> ShownFigure:
        """Return a figure by its name, v.4, or with a position `at` only its content, v; a notebook displays it.

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
        """Return the given data as HTML for a notebook."""
        rows = "".join(
            f"<tr><td>{html.escape(name)}</td><td>{html.escape(str(getattr(value, 'text', value)))}</td></tr>"
            for name, value in self.assignment.parameters
            if value is not None
        )
        return f"<p><b>{html.escape(self.case.title)}</b> {html.escape(self.assignment.id)}</p><table>{rows}</table>"


class RangesError(UnknownNameError, ValueError):
    """A study without ranges of parameters, or with ranges that cannot vary together."""


def _unit_of(annotation: Any, *metadata: Any) -> str:
    """Return the unit of a key of the assignment file by the type of its field, "" if it is not a quantity."""
    inner = (candidate for part in get_args(annotation) for candidate in (part, *getattr(part, "__metadata__", ())))
    for candidate in (*metadata, *inner):
        if isinstance(candidate, Quantity):
            return candidate.unit
    return next((unit for part in get_args(annotation) if (unit := _unit_of(part))), "")


class ShownFigure(Record):
    """A figure of a report: a drawing, several drawings together, or a moving figure."""

    name: str
    scenes: tuple[Scene, ...]
    language: Language
    moving: MovingFigure | None = None

    def __repr__(self) -> str:
        suffix = "gif" if self.moving is not None else "svg"
        scene = self.scene
        return (
            f'<figure {self.name}, {scene.width:.0f} × {scene.height:.0f} mm; save it: .save("{self.name}.{suffix}")>'
        )

    @property
    def scene(self) -> Scene:
        """The drawings on one sheet, in rows as in the report."""
        return self.scenes[0] if len(self.scenes) == 1 else sheets(self.scenes, TEXT_WIDTH, float("inf"), trim=0.0)[0]

    @property
    def diagrams(self) -> tuple[Diagram, ...]:
        """The data of its charts; () for a drawing."""
        return tuple(scene.diagram for scene in self.scenes if scene.diagram is not None)

    def save(self, path: Path | str, dpi: int = 0, layers: Sequence[str] = figures.SHOWN) -> Path:
        """Write it to a file in the format of the suffix: svg, png, pdf, eps; for a moving figure also gif, mp4.

        Raises `NotOfferedError` for another suffix, `TypesetterError`, `OutputError`.
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


class ResultTable(Record):
    """Results with a row per position; a column is named by the path to its number in the JSON of `solve`."""

    columns: tuple[str, ...]
    rows: tuple[tuple[Any, ...], ...]

    def __repr__(self) -> str:
        size = f"{len(self.rows)} rows × {len(self.columns)} columns"
        return f"<table of results, {size}; save it: .to_dataframe().to_csv(…)>"

    def __getitem__(self, column: str) -> np.ndarray:
        """Return a column of numbers, nan for missing ones; raise `KeyError`."""
        if column not in self.columns:
            raise KeyError(column)
        at = self.columns.index(column)
        return np.array([np.nan if row[at] is None else row[at] for row in self.rows])

    def to_dataframe(self) -> Any:
        """Return a `pandas.DataFrame`; raise `ImportError` if pandas is not installed."""
        import pandas

        return pandas.DataFrame(list(self.rows), columns=list(self.columns))

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{html.escape(name)}</th>" for name in self.columns)
        rows = "".join(f"<tr>{''.join(f'<td>{_cell(value)}</td>' for value in row)}</tr>" for row in self.rows)
        return f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"


def _cell(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else html.escape("" if value is None else str(value))
