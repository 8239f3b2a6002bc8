"""Tables of given data, and of quantities at positions.

A table is a function of a report, its key, caption and head, and of its contents; `named_tables` gives its name in
templates.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any

from reportgen.base.records import Record, field, replace
from reportgen.catalogue.given_loads import ByOrdinates
from reportgen.document import (
    FIRST_COLUMN,
    TEXT_WIDTH,
    Column,
    InlineMath,
    Inlines,
    Paragraph,
    Table,
    Text,
    Value,
    listed,
)
from reportgen.document.tables import WIDEST_COLUMN, cell, exact, folded, in_blocks, list_table, side_by_side
from reportgen.document.template_rendering import subscripted
from reportgen.drawing.label_size import box
from reportgen.formula import Chain, Expression, Fraction, Number, Symbol, ids, refs, size, vocabulary
from reportgen.formula.vocabulary import KINDS
from reportgen.machine.load_laws import Law
from reportgen.report.context import ReportContext

MOST_COLUMNS = 9
TITLES = 40.0
"""Width of the column with the names of the rows of lengths (mm)."""
TABLE_SIZE = 10.0
"""Type size in tables (pt)."""
PADDING = 2.2
"""White space beside the contents of a column (mm)."""
LENGTHS = (ids.length, ids.drawn)
"""The two rows of a table of lengths."""

# --- numbers and columns


def bare(report: ReportContext, id: str, position: int | None, size: bool = False) -> Inlines:
    """Return a number without its unit, or a dash if it does not exist.  An arm has no sign; neither has any number
    with `size`.
    """
    family = report.ledger[id]
    number = report.ledger.number(id, position, size=size or family.arm)
    if math.isnan(number.value) or (family.is_of_vector and report.is_zero(family.of, position)):
        return (Text("–"),)
    return (Value(Number(number.value, number.decimals, "")),)


def head_symbol(report: ReportContext, id: str) -> Expression:
    """Return the symbol over a column: |v| for a vector whose magnitude is read from a plan."""
    symbol = report.ledger.symbol(id)
    return size(symbol) if any(id in rate for rate in ids.POINT_RATE.values()) else symbol


def tables(
    report: ReportContext, key: str, caption: str, quantities: Sequence[str], positions: Iterable[int]
) -> tuple[Table | Paragraph, ...]:
    """Return quantities at positions in one table, or in several below one another if there are too many columns.

    Quantities that are zero at every position have no column; a sentence says so instead.
    """
    at, columns = list(positions), []
    zeros = [id for id in quantities if all(report.is_zero(id, k) for k in at)]
    printed = [id for id in quantities if id not in zeros] or list(quantities)
    for id in printed:
        unit = report.ledger.printed_unit(report.ledger[id].how.unit)
        columns.append([head_symbol(report, id), unit, *(bare(report, id, k) for k in at)])
    titles = [report.words["table"]["position"], "", *map(str, at)]
    room = TEXT_WIDTH - FIRST_COLUMN
    widths = [] if report.parts("usual-type") else [column_width(report, id, at) for id in printed]
    fitting = bool(widths) and sum(widths) <= room
    parts = side_by_side(
        report.prose,
        key,
        caption,
        Column(FIRST_COLUMN),
        titles=titles,
        columns=columns,
        most=len(printed) if fitting else MOST_COLUMNS - 1,
        heads=2,
        widths=[min(width + (room - sum(widths)) / len(widths), WIDEST_COLUMN) for width in widths] if fitting else (),
    )
    if not zeros or printed == list(quantities):
        return parts
    equations = listed(InlineMath(Chain((report.ledger.symbol(id), Number(0.0)))) for id in zeros)
    return *parts, Paragraph((Text(f"{report.words['table']['zero']} "), *equations, Text(".")))


def column_width(report: ReportContext, id: str, at: Iterable[int | None]) -> float:
    """Return the width (mm) of a column for a quantity's numbers and symbol, white space included."""
    numbers = (replace(report.ledger.number(id, k), unit="") for k in at)
    expressions = (head_symbol(report, id), *(number for number in numbers if math.isfinite(number.value)))
    return max(box(expression, TABLE_SIZE).width for expression in expressions) + PADDING


# --- given data


def given_data(
    report: ReportContext, key: str, caption: str, head: Sequence[str], others: Mapping[str, str] | None = None
) -> Table:
    """Return the table of the given quantities; `others` replaces some of their descriptions."""
    return given_table(report, key, caption, {**report.given_names, **(others or {})})


def given_table(report: ReportContext, key: str, caption: str, names: Mapping[str, str]) -> Table:
    """Return a table of the machine's given quantities that `names` describes; derived ones are left out."""
    heads = report.words["table"]
    rows = [
        (name, report.ledger.symbol(id), _as_typed(report, id))
        for id, name in names.items()
        if id in report.ledger and _is_given(report, id)
    ]
    rows += [(name, symbol, (Value(number),)) for name, symbol, number in report.own.get("parameters", ())]
    return list_table(
        report.prose, key, caption, (heads["quantity"], heads["symbol"], heads["value"]), rows, (92.0, 28.0, 40.0)
    )


def _is_given(report: ReportContext, id: str) -> bool:
    definition = report.ledger[id].definition
    return definition is None or not refs(definition)


PRINTED = ("mm", "cm", "m", "°", "N", "kN", "kg", "kg·m²", "N·m", "MPa", "bar", "m/s", "mm/s", "m/s²", "rad/s", "N/mm")
"""Units that are printed as typed; any other unit is converted to that of the report."""


OTHER = ("lb", "in", "inch", "ft", "lbf", "kgf", "gf", "oz", "hp", "psi")
"""Units that are printed as typed and followed by the converted value."""


def _as_typed(report: ReportContext, id: str) -> Inlines:
    """Return a given number with its unit; a ratio typed as 1/3.6 stays a ratio."""
    definition = report.ledger[id].definition
    if isinstance(definition, Fraction):
        ends = [part for part in (definition.top, definition.bottom) if isinstance(part, Number)]
        if len(ends) == 2:
            return Value(ends[0]), Text("/"), Value(ends[1])
    typed = report.machine.calculation.typed.get(id)
    number = report.ledger.number(id)
    if typed is None or typed.unit not in (*PRINTED, *OTHER):
        return (Value(number),)
    value = Value(replace(typed, unit=report.ledger.printed_unit(typed.unit)))
    return (value,) if typed.unit in PRINTED else (value, Text(" = "), Value(number))


def indicator(report: ReportContext, key: str, caption: str, head: Sequence[str]) -> Table:
    """Return the table of the indicator diagram as given, in gauge pressure: by stroke, or over the cycle angle."""
    diagram = report.assignment.indicator
    heights = diagram.height if isinstance(diagram, ByOrdinates) else ()
    piston = report.machine.pistons[0]
    return _law_table(report, piston.name, piston.law, key, caption, names=report.words["strokes"], heights=heights)


def working_force(report: ReportContext, key: str, caption: str, head: Sequence[str]) -> Table:
    """Return the table of the working force as given (N): a row for each stroke of the head, or over the crank
    angle.
    """
    force = report.machine.applied[0]
    return _law_table(report, force.name, force.law, key, caption, head, symbol=Symbol("P"))


def gas_law(report: ReportContext, key: str, caption: str, head: Sequence[str], name: str) -> Table:
    """Return the table of the gauge pressure (N/cm²) on a piston as given: by stroke, or over the cycle angle."""
    gas = next(load for load in report.loads if load.name == name)
    caption = caption.format(link=gas.link)
    return _law_table(report, name, gas.law, key, caption, names=report.words["strokes"])


def load_law(report: ReportContext, key: str, caption: str, head: Sequence[str], name: str) -> Table:
    """Return the table of the load `name` as given: a row for each stroke of the head, or over the driver's angle or
    travel.
    """
    load = next(load for load in report.loads if load.name == name)
    caption = caption.format(link=load.link, unit=report.ledger.printed_unit(report.ledger[name].how.unit))
    return _law_table(report, name, load.law, key, caption, head)


def _law_table(
    report: ReportContext,
    name: str,
    law: Law,
    key: str,
    caption: str,
    names: Sequence[str],
    symbol: Symbol | None = None,
    heights: Sequence[float] = (),
) -> Table:
    """Return the table that gives the load `name`: one row, or a row for each of the strokes called `names`.

    `symbol` replaces the load's symbol; `heights` (mm) are the ordinates that were measured on a drawing, if any.
    """
    given = law.tabled
    assert given is not None, f"{name} is not given by a table"
    unit = KINDS["pressure"].scale if law.symbol else report.ledger[name].how.scale
    rows = [[value / unit for value in row] for row in given.rows]
    if len(rows) > 1:
        head = (cell(given.over), *map(exact, given.nodes))
        lines = [(cell(called), *map(exact, row)) for called, row in zip(names, rows, strict=False)]
        return in_blocks(report.prose, key, caption, head, lines, FIRST_COLUMN + 8)
    columns: list[tuple[Expression, Sequence[float]]] = [
        (given.over, [node / KINDS[given.kind].scale for node in given.nodes]),
        *(((Symbol("y"), heights),) if heights else ()),
        (law.symbol or symbol or report.ledger.symbol(name), rows[0]),
    ]
    return folded(report.prose, key, caption, columns)


def joints(report: ReportContext) -> Iterator[Sequence[object]]:
    """Yield a row for each joint: number, place, links, type."""
    for number, joint in enumerate(report.mobility.joints, start=1):
        acting, acted_on = joint.links
        yield str(number), vocabulary.point(joint.point), f"{acting} – {acted_on}", report.words["joints"][joint.kind]


def lengths(report: ReportContext, key: str, caption: str, head: Sequence[str]) -> tuple[Table, ...]:
    """Return the true and drawn lengths, one column each, in several tables if there are too many columns."""
    columns = [
        (subscripted(line), *(bare(report, name(line), None) for name in LENGTHS)) for line in report.drawn_lines
    ]
    widths = (column_width(report, name(line), (None,)) for line in report.drawn_lines for name in LENGTHS)
    most = int((TEXT_WIDTH - TITLES) / max(widths, default=WIDEST_COLUMN))
    before, _, after = head[1].partition("{l}")
    titles = (head[0], (Text(before), InlineMath(Symbol("l")), Text(after)), *head[2:])
    return side_by_side(
        report.prose, key, caption, Column(TITLES, "left"), titles=titles, columns=columns, most=most, widest=22.0
    )


# --- tables by the functions that give their contents


class QuantityTable(Record):
    """A table of the quantities whose ids a function returns, `at` the positions of that name in the report.

    `groups` maps names of phrases to beginnings of ids: the phrase is added to the caption if such a quantity has a
    column.
    """

    ids: Callable[[ReportContext], Sequence[str]]
    at: str = "positions"
    groups: Mapping[str, Collection[str]] = field(default_factory=dict)

    def __call__(
        self, report: ReportContext, key: str, caption: str, head: Sequence[str], ids: Sequence[str] | None = None
    ) -> tuple[Table | Paragraph, ...]:
        quantities, positions = self.ids(report) if ids is None else ids, getattr(report, self.at)
        nonzero = [id for id in quantities if not all(report.is_zero(id, k) for k in positions)]
        words = report.words["tables"][key.removeprefix("tab.")]
        further = [words[name] for name, of in self.groups.items() if any(id.startswith(tuple(of)) for id in nonzero)]
        return tables(report, key, "".join((caption, *further)), quantities, positions)


class RowTable(Record):
    """A table of the rows that a function returns, in columns of these widths (mm)."""

    rows: Callable[..., Iterable[Sequence[object]]]
    widths: tuple[float, ...]

    def __call__(self, report: ReportContext, key: str, caption: str, head: Sequence[str], *shown: Any) -> Table:
        return list_table(report.prose, key, caption, head, self.rows(report, *shown), self.widths)


# --- a declared linkage


def frame(report: ReportContext) -> Iterable[Sequence[object]]:
    """Return a row for each fixed point."""
    fixed: Iterable[Sequence[object]] = report.own["frame"]
    return fixed


def groups(report: ReportContext) -> Iterator[Sequence[object]]:
    """Yield a row for each group, in the order of assembly, with its assembly mode."""
    choice = report.words["linkage"]["choice"]
    for row in report.own["groups"]:
        joints = listed(InlineMath(vocabulary.point(name)) for name in row.joints)
        yield ", ".join(map(str, row.links)), row.kind, joints, choice[row.choice]


def guides(report: ReportContext) -> Iterator[Sequence[object]]:
    """Return a row for each guide: the slider, the carrier, a point of the line and its direction."""
    return ((str(row.slider), str(row.carrier), row.x, row.y, row.angle) for row in report.own["guides"])


def further_points(report: ReportContext) -> Iterator[Sequence[object]]:
    """Yield a row for each further point of a link: its distances, and the joint and direction from which they are
    measured.
    """
    along = report.words["vector"]
    for row in report.own["points"]:
        start = vocabulary.point(row.origin)
        axis: object = along[f"along_{row.way}"] if row.way in ("guide", "slot") else vocabulary.point(row.way)
        if not isinstance(axis, str):
            axis = (InlineMath(start), Text(" → "), InlineMath(vocabulary.point(row.way)))
        yield vocabulary.point(row.name), str(row.link), start, axis, row.along, row.across
