"""What every paper beside the report has in common: its header, its footer, who it belongs to."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from reportgen.document.numbering import number
from reportgen.document.tree import (
    BlankLine,
    Block,
    Document,
    LineBreak,
    Paragraph,
    Strong,
    Text,
    Words,
)
from reportgen.notation.numbers import Language


def paper(
    language: Language,
    words: Mapping[str, Any],
    title: str,
    owner: str,
    note: str,
    blocks: Iterable[Block],
) -> Document:
    """A numbered document without a cover; title left and `note` right in its header, `owner` its author."""
    return number(
        Document(
            language,
            title,
            owner,
            (title, note),
            ("", words["document"]["page"]),
            Words(**words["document"]),
            tuple(blocks),
        )
    )


def fields(pairs: Iterable[tuple[str, str]]) -> Iterable[Block]:
    """Labelled texts, a line each, as typed; without a text a dotted line to fill in."""
    lines: list[Text | Strong | LineBreak] = []
    empty: list[Block] = []
    for label, text in pairs:
        if not text:
            empty.append(BlankLine(f"{label}:"))
            continue
        lines += [*([LineBreak()] if lines else []), Text(f"{label}: "), Strong((Text(text),))]
    return (*((Paragraph(tuple(lines)),) if lines else ()), *empty)
