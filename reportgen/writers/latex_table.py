"""Tables → long tables of PyLaTeX: fixed columns in mm, the head repeated on every page."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from reportgen.document.tree import Cell, Column, Inlines, Table
from reportgen.writers.flow import TOGETHER, WHOLE_TABLE

OPENING, ROW = 30, 7
"""Millimetres, about: the words before a table with its caption, and a row."""


def table(block: Table, caption: str, inlines: Callable[[Inlines], str]) -> str:
    """The source of a long table under its caption; `inlines` prints what stands in a cell."""
    from pylatex import LongTable, NoEscape

    columns = "".join(_column(column.width, column.align) for column in block.columns)
    environment = LongTable(NoEscape(columns), width=len(block.columns))
    head = _head(block, inlines)
    if caption:
        title = rf"\multicolumn{{{len(block.columns)}}}{{c}}{{\tablecaption{{{caption}}}}}\\*[0pt]"
        environment.append(NoEscape(title))
    environment.append(NoEscape(head + r"\endfirsthead"))
    environment.append(NoEscape(head + r"\endhead"))
    environment.append(NoEscape(r"\bottomrule\endfoot"))
    unbroken = len(block.rows) <= WHOLE_TABLE
    for index, row in enumerate(block.rows):
        end = r"\\*[0pt]"
        if index < len(block.rows) - 1:
            # The first and the last rows never stand alone on a page.
            together = unbroken or not TOGETHER - 1 <= index < len(block.rows) - TOGETHER
            end += rf"\rowrule{{{len(block.columns)}}}{{{10000 if together else 0}}}"
        environment.append(NoEscape(_row(row, block.columns, inlines) + end))
    return f"{{\\tablesize\n{environment.dumps()}\n}}"


def height(block: Table) -> int:
    """Millimetres for a few lines before a table and as much of it as no page break may part, about."""
    rows = len(block.rows) if len(block.rows) <= WHOLE_TABLE else TOGETHER
    return OPENING + ROW * (len(block.head) + rows)


def _head(block: Table, inlines: Callable[[Inlines], str]) -> str:
    # Every option is written out: a cell's text may begin with a bracket.
    lines = [r"\toprule[\heavyrulewidth]"]
    for index, row in enumerate(block.head):
        lines.append(_row(row, block.columns, inlines, head=True) + r"\\*[0pt]")
        if index < len(block.head) - 1:
            lines.append(_rules_below(row))
    lines.append(r"\midrule" if block.head else "")
    return "\n".join(lines) + "\n"


def _row(
    row: Sequence[Cell], columns: Sequence[Column], inlines: Callable[[Inlines], str], head: bool = False
) -> str:
    from pylatex import MultiColumn, NoEscape

    printed, at = [], 0
    for cell in row:
        source = inlines(cell.inlines)
        covered = columns[at : at + cell.span]
        if cell.span > 1 or (head and covered and covered[0].align != "center"):
            align = "center" if head else covered[0].align
            width = sum(column.width for column in covered)
            spec = NoEscape(_column(width, align))
            source = MultiColumn(cell.span, align=spec, data=NoEscape(source)).dumps()
        printed.append(source)
        at += cell.span
    return " & ".join(printed)


def _column(width: float, align: str) -> str:
    return f"{align[0].upper()}{{{width:g}mm}}"


def _rules_below(row: Sequence[Cell]) -> str:
    """A thin rule under every cell of a head row that stands over several columns."""
    rules, at = [], 1
    for cell in row:
        if cell.span > 1:
            rules.append(rf"\cmidrule(lr){{{at}-{at + cell.span - 1}}}")
        at += cell.span
    return "".join(rules)
