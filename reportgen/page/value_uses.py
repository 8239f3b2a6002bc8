"""Find where the report uses a value of the file: `uses`, from the definitions of the ledger."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from reportgen import catalogue
from reportgen.assignment import Assignment
from reportgen.base.errors import ReportgenError, Where
from reportgen.base.records import replace
from reportgen.base.yaml_source import Node, Scalar, Source
from reportgen.base.yaml_values import at, put
from reportgen.case import Case
from reportgen.document import Block, Document, Equation, Section, plain
from reportgen.document.used_symbols import used_symbols
from reportgen.formula import Chain, refs
from reportgen.formula.calculation import Family
from reportgen.formula.plain_text import formula
from reportgen.page.controlled_parts import variations
from reportgen.page.html import CONTENTS_LEVEL

Families = Mapping[str, Family]


def uses(case: Case, document: Document, data: Collection[str]) -> Mapping[str, Any]:
    """Return the lines of a report that use data first-hand, and the number of other quantities that follow.

    A line has the number and the title of its section, the symbol that it computes, and the `heading`: the position of
    the section among the headings of the contents.
    """
    ledger = case.printed
    first = [id for id, inputs in ledger.inputs.items() if not set(inputs).isdisjoint(data)]
    following = {id for id in ledger.families if not set(ledger.ancestors(id)).isdisjoint(first)} - {*first}
    symbols = {ledger[id].symbol for id in first}
    sources = {ledger[id].symbol for id in data if id in ledger}
    lines: dict[tuple[Any, ...], dict[str, Any]] = {}
    for heading, section, block in _placed(document.blocks):
        for row in block.rows:
            if isinstance(row, Chain) and row.parts[0] in symbols and _names(row, sources):
                symbol = formula(row.parts[0], document.language)
                title = plain(section.title, document.language) if section else ""
                line = {"number": section.number if section else "", "title": title, "symbol": symbol}
                lines.setdefault((heading, symbol), {**line, "heading": heading})
    return {"lines": list(lines.values()), "following": sum(not ledger[id].hidden for id in following)}


def _names(row: Chain, symbols: Collection[Any]) -> bool:
    """Return True if a worked line names one of the symbols behind its first sign of equality."""
    return not used_symbols((Equation((Chain(row.parts[1:]),)),)).isdisjoint(symbols)


def _placed(blocks: Sequence[Block]) -> Iterator[tuple[int, Section | None, Equation]]:
    """Yield each equation with its section, and the position of that among the headings (from 1)."""
    heading, section = 0, None
    for block in blocks:
        if isinstance(block, Section) and block.level <= CONTENTS_LEVEL:
            heading, section = heading + 1, block
        elif isinstance(block, Equation):
            yield heading, section, block


def data_of(top: Node, where: Where, path: Path) -> frozenset[str]:
    """Return the ids of the data that change with the value at a place of a valid file."""
    old = at(top, where)
    if not isinstance(old, Scalar):
        return frozenset()
    before = _data(top, path)
    for text in variations(old.text) if before else ():
        if after := _data(put(top, where, replace(old, text=text)), path):
            return frozenset(id for id, family in before.items() if id not in after or not _same(family, after[id]))
    return frozenset()


def _data(top: Node, path: Path) -> Families:
    """Return the data of a file, which may fail the checks: quantities that no other quantity defines; {} for a
    faulty value.
    """
    assignment = catalogue.unchecked(Source(str(path), top=top), path)
    try:
        families = {} if assignment is None else _families(assignment)
    except (ReportgenError, ArithmeticError, ValueError, LookupError, np.linalg.LinAlgError):
        return {}
    return {id: family for id, family in families.items() if family.definition is None or not refs(family.definition)}


def _families(assignment: Assignment) -> Families:
    module = catalogue.module(assignment.kind)
    if hasattr(module, "machine"):
        sheet: Families = module.machine(assignment).calculation.families
        return sheet
    ledger: Families = module.case(assignment).ledger.families
    return ledger


def _same(family: Family, changed: Family) -> bool:
    return np.shape(family.values) == np.shape(changed.values) and bool(
        np.allclose(family.values, changed.values, rtol=1e-9, atol=0.0, equal_nan=True)
    )
