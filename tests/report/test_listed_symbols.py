"""The list of symbols: those that the text uses, and no others."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import takewhile

from reportgen.base.units import Language
from reportgen.document import Block, Equation, InlineMath, Paragraph, Plate, Section, Table, plain
from reportgen.document import Figure as Drawn
from reportgen.drawing import Label, Scene
from reportgen.formula.plain_text import formula
from reportgen.report.context import ReportContext
from reportgen.report.overview import symbol_kinds
from tests.report.built import Written, walk

MOBILITY, WATTS = "W = 3", " W"


def parts(written: Written) -> tuple[list[Block], list[Block]]:
    """The blocks of the section with the list of symbols, and all others."""
    blocks = written.document.blocks
    at = next(n for n, block in enumerate(blocks) if isinstance(block, Table) and block.key == "tab.symbols")
    start = max(n for n, block in enumerate(blocks[:at]) if isinstance(block, Section))
    section = [blocks[start], *takewhile(lambda block: not isinstance(block, Section), blocks[start + 1 :])]
    return section, [*blocks[:start], *blocks[start + len(section) :]]


def printed(blocks: list[Block], language: Language) -> Iterator[str]:
    """What is read, block for block."""
    for block in walk(tuple(blocks)):
        match block:
            case Paragraph(inlines):
                yield plain(inlines, language)
            case Equation(rows):
                yield from (formula(row, language) for row in rows)
            case Table():
                yield plain(block.caption, language)
                yield from (plain(cell.inlines, language) for row in (*block.head, *block.rows) for cell in row)
            case Drawn(scenes, caption):
                yield plain(caption, language)
                yield from (label for scene in scenes for label in labels(scene, language))
            case Plate(scene, caption=caption):
                yield plain(caption, language)
                yield from labels(scene, language)


def labels(scene: Scene, language: Language) -> Iterator[str]:
    """The formulas that stand in a drawing."""
    for item in scene.items:
        if isinstance(item, Label) and not isinstance(item.content, str):
            yield formula(item.content, language)


def occurs(symbol: str, text: str) -> bool:
    """As a whole: v_B is no part of v_BA."""
    return re.search(rf"(?<![\w_]){re.escape(symbol)}(?![\w_^])", text) is not None


def test_each_symbol_that_is_listed_occurs(written: Written) -> None:
    section, others = parts(written)
    language = written.document.language
    text = re.sub("[\u20d7\u2192|]", " ", "\n".join(printed(others, language)))
    listed = [
        formula(inline.expression, language)
        for block in section
        if isinstance(block, Table) and block.key == "tab.symbols"
        for row in block.rows
        for inline in row[0].inlines
        if isinstance(inline, InlineMath)
    ]
    assert listed
    assert [one for one in listed if not occurs(one, text)] == []


def test_each_kind_of_symbol_that_occurs_is_listed(written: Written) -> None:
    """But for what is explained where it stands, as the mobility W is, which is no work."""
    section, others = parts(written)
    language = written.document.language
    report = ReportContext(written.case)
    lines = (
        formula(row, language) for block in walk(tuple(others)) if isinstance(block, Equation) for row in block.rows
    )
    text = "\n".join(line.removesuffix(WATTS) for line in lines if not line.startswith(MOBILITY))
    table = next(block for block in section if isinstance(block, Table) and block.key == "tab.symbols")
    listed = {plain(row[1].inlines, language) for row in table.rows}
    for kind, alike in symbol_kinds(report).items():
        if any(occurs(formula(report.ledger.symbol(id), language), text) for id in alike):
            assert kind in listed
