"""Build a `Table` from contents: columns beside row titles, rows of any contents, or long and wide tables in parts.

A content is a text, a symbol or formula, a number with its unit, an inline, or a tuple of these. Captions may contain
the markup of `Prose.inlines`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from reportgen.document import TEXT_WIDTH, Cell, Column, InlineMath, Inlines, Table, Text, Value
from reportgen.document.template_rendering import Prose
from reportgen.formula import Expression, Number

WIDEST_COLUMN = 26.0
LONG_WORDS = 10
"""A column with a text this long is one of words and set flush left."""


def cell(content: object) -> Cell:
    """Return a table cell of a text, a symbol, a number or inlines."""
    return Cell(_inlines(content))


def _inlines(content: object) -> Inlines:
    match content:
        case str():
            return (Text(content),) if content else ()
        case Number():
            return (Value(content),)
        case tuple():
            return tuple(inline for part in content for inline in _inlines(part))
        case Text() | Value() | InlineMath():
            return (content,)
    if isinstance(content, Expression):
        return (InlineMath(content),)
    raise TypeError(f"a {type(content).__name__} has no place in a table")


def side_by_side(
    prose: Prose,
    key: str,
    caption: str,
    first: Column,
    titles: Sequence[object],
    columns: Sequence[Sequence[object]],
    most: int,
    heads: int = 1,
    widest: float = WIDEST_COLUMN,
    together: int = 1,
    widths: Sequence[float] = (),
) -> tuple[Table, ...]:
    """Return columns beside a column of row titles, in several tables if there are more than `most` columns.

    `titles` are the contents of the `first` column from top to bottom, and each of the `columns` has as many contents.
    The first `heads` rows, with their titles, are the head of each table. Groups of `together` columns are not divided
    between tables. The key names the first table, `key.2` the second. Columns are at most `widest` (mm) wide; those of
    a single table may have their own `widths` (mm). Raises `ValueError` for a column of another length.
    """
    count = max(-(-len(columns) // most), 1)
    size = together * -(-len(columns) // (together * count))
    parts = [columns[start : start + size] for start in range(0, len(columns), size or 1)]
    tables = []
    for number, part in enumerate(parts, start=1):
        width = min((TEXT_WIDTH - first.width) / len(part), widest)
        rows = [tuple(map(cell, row)) for row in zip(titles, *part, strict=True)]
        title = f"{caption} ({number}/{len(parts)})" if len(parts) > 1 else caption
        tables.append(
            Table(
                (first, *(map(Column, widths) if widths else (Column(width),) * len(part))),
                tuple(rows[:heads]),
                tuple(rows[heads:]),
                prose.inlines(title),
                f"{key}.{number}" if number > 1 else key,
            )
        )
    return tuple(tables)


def list_table(
    prose: Prose,
    key: str,
    caption: str,
    head: Sequence[object],
    rows: Iterable[Sequence[object]],
    widths: Sequence[float],
) -> Table:
    """Return a table of rows under one `head`; `widths` (mm) are those of the columns.

    A column that has a text of `LONG_WORDS` characters or more is set flush left, others are centred.
    """
    body = [tuple(row) for row in rows]
    words = [any(_is_wordy(row[i]) for row in body) for i in range(len(widths))]
    return Table(
        tuple(Column(width, "left" if wordy else "center") for width, wordy in zip(widths, words, strict=True)),
        (tuple(map(cell, head)),),
        tuple(tuple(map(cell, row)) for row in body),
        prose.inlines(caption),
        key,
    )


def _is_wordy(content: object) -> bool:
    return isinstance(content, str) and len(content) >= LONG_WORDS


def exact(value: float) -> Cell:
    """Return a cell with a number to ten significant figures."""
    return Cell((Value(Number(float(f"{value:.10g}"))),))


def folded(prose: Prose, key: str, caption: str, columns: Sequence[tuple[Expression, Sequence[float]]]) -> Table:
    """Return columns of numbers, each a pair of head and values, folded into three or four sets side by side.

    The rows run down the first set, then down the next. Columns of different lengths end with the shortest.
    """
    head = tuple(cell(shown) for shown, _ in columns)
    sets = [tuple(map(exact, row)) for row in zip(*(values for _, values in columns), strict=False)]
    beside = 3 if len(columns) > 2 else 4
    rows_count = -(-len(sets) // beside)
    filled = sets + [(Cell(),) * len(columns)] * (rows_count * beside - len(sets))
    body = tuple(
        tuple(one for block in range(beside) for one in filled[block * rows_count + row]) for row in range(rows_count)
    )
    width = Column(TEXT_WIDTH / beside / len(columns) - 2.0)
    return Table((width,) * (beside * len(columns)), (head * beside,), body, prose.inlines(caption), key)


def in_blocks(
    prose: Prose, key: str, caption: str, head: tuple[Cell, ...], rows: Sequence[tuple[Cell, ...]], first: float
) -> Table:
    """Return a wide table; if rows have more than 12 values, blocks of at most 12 are set one below the other.

    `first` is the width (mm) of the first column, which is repeated in each block.
    """
    most = 12
    width = min((TEXT_WIDTH - first) / min(len(head) - 1, most), 14.0)
    body: list[tuple[Cell, ...]] = []
    for start in range(1, len(head), most):
        stop = min(start + most, len(head))
        pad = (Cell(),) * (most - (stop - start)) if len(head) - 1 > most else ()
        if start > 1:
            body.append((head[0], *head[start:stop], *pad))
        body += [(row[0], *row[start:stop], *pad) for row in rows]
    count = min(len(head) - 1, most)
    columns = (Column(first, "left"), *(Column(width),) * count)
    return Table(columns, ((head[0], *head[1 : count + 1]),), tuple(body), prose.inlines(caption), key)
