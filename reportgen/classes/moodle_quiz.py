"""Export a class's variants as questions of a Moodle quiz (`question_bank`), one cloze question for each variant.

A question shows the task without its answer sheet, and asks for the cells that a policy selects. A number is right
within the wider of the key's two bands. If textbooks differ in the sense, either sign is accepted; a direction may
differ by a whole turn. Source: docs.moodle.org, Moodle XML format, and Embedded Answers (Cloze) question type.
"""

from __future__ import annotations

import base64
import html
import re
from collections.abc import Iterable, Mapping
from decimal import Decimal
from itertools import groupby
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from reportgen import document as tree
from reportgen.base.kinds import title
from reportgen.base.units import Language
from reportgen.case.answer_key import Key, KeyRow, Role
from reportgen.cases import open_case
from reportgen.marking.marking_policy import Policy
from reportgen.marking.task_paper import given_of
from reportgen.marking.toleranced_key import key_of, shown_number, symbol_text, words_of
from reportgen.page.html import Blocks
from reportgen.page.svg_elements import Pens
from reportgen.writers import picture_files

DOTS = 110
"""Resolution of a picture (dots per inch), for reading on a screen."""
TURN = 360.0
FIGURES = 9
"""Number of figures of a value, more than any band needs."""
_ANCHOR = re.compile(r' id="[^"]*"')
"""Anchors, which are removed: several questions on a page may not share them."""
SCALES = (1, 2, 4, 5, 10, 20, 100)
"""Factors, one of which makes the weights whole numbers, as Moodle requires."""


def question_bank(files: Iterable[Path], policy: Policy, category: str, language: Language | None = None) -> bytes:
    """Return the questions of assignment files in Moodle's XML format, below a category.

    Raises `AssignmentError` for an invalid file, and for a policy that asks for something that does not exist.
    """
    parts = ['<?xml version="1.0" encoding="UTF-8"?>', "<quiz>", _category(category)]
    parts += [_question(file, policy, language) for file in files]
    return "\n".join((*parts, "</quiz>", "")).encode()


def _category(name: str) -> str:
    # A slash separates a category from the one above it.
    text = escape(f"$course$/top/{name.replace('/', '//')}")
    return f'<question type="category"><category><text>{text}</text></category></question>'


def _question(file: Path, policy: Policy, language: Language | None) -> str:
    case = open_case(file, language)
    whole = key_of(case)
    policy.ask.check([whole], language)
    key = policy.ask.of(whole)
    words = words_of(key)["quiz"]
    blocks = _QuestionBlocks(given_of(case, whole), words["scheme"])
    given = blocks.given()
    lead = html.escape(title(key.kind, key.language))
    scales = _scales(key, words, blocks)
    text = f"<p>{lead}</p>{given}{scales}<p>{html.escape(words['lead'])}</p>{_cells(key, policy)}"
    attached = "".join(
        f'<file name={quoteattr(name)} path="/" encoding="base64">{base64.b64encode(data).decode()}</file>'
        for name, data in blocks.pictures.items()
    )
    # A CDATA section must not contain its own end.
    body = text.replace("]]>", "]]&gt;")
    return (
        f'<question type="cloze"><name><text>{escape(key.id)}</text></name>'
        f'<questiontext format="html"><text><![CDATA[{body}]]></text>{attached}</questiontext>'
        '<generalfeedback format="html"><text></text></generalfeedback>'
        f"<penalty>0</penalty><hidden>0</hidden><idnumber>{escape(key.id)}</idnumber></question>"
    )


class _QuestionBlocks(Blocks):
    """Writer of a task as well-formed HTML without anchors; its figures are attached pictures."""

    def __init__(self, document: tree.Document, alt: str) -> None:
        super().__init__(document, Pens())
        self._blocks, self._alt = document.blocks, alt
        self.pictures: dict[str, bytes] = {}
        """The figures written so far as PNG, by the names that the text uses."""

    def given(self) -> str:
        """Return the blocks with empty elements closed, and with braces escaped, which would open an answer."""
        written = self.write(self._blocks)
        written = _ANCHOR.sub("", written).replace("<br>", "<br/>").replace("<wbr>", "<wbr/>")
        return written.replace("{", "&#123;").replace("}", "&#125;")

    def inline(self, inline: tree.Inline) -> str:
        return html.escape(inline.text) if isinstance(inline, tree.Reference) else super().inline(inline)

    def block(self, block: tree.Block, room: float) -> str:
        if not isinstance(block, tree.Figure):
            return super().block(block, room)
        caption = self.caption(self.words.figure, block)
        pictures = "".join(map(self._picture, picture_files.pngs(block.scenes, self.language, DOTS)))
        return f"{pictures}<p>{caption}</p>" if caption else pictures

    def _picture(self, data: bytes) -> str:
        name = f"figure-{len(self.pictures) + 1}.png"
        self.pictures[name] = data
        return f'<p><img src="@@PLUGINFILE@@/{name}" alt={quoteattr(self._alt)}/></p>'


def _scales(key: Key, words: Mapping[str, Any], blocks: Blocks) -> str:
    """Return the scales of the requested lengths, as a list."""
    scales = {row.id for row in key.rows if row.role is Role.scale and any(row.id in one.plans for one in key.asked)}
    rows = [row for row in key.rows if row.single and row.id in scales]
    items = "".join(f"<li>{_named(row, key)} = {_printed_value(row, blocks)}</li>" for row in rows)
    return f"<p>{html.escape(words['data'])}</p><ul>{items}</ul>" if items else ""


def _named(row: KeyRow, key: Key) -> str:
    what = f" ({row.named})" if row.named else ""
    return html.escape(f"{symbol_text(row, key)}{what}")


def _printed_value(row: KeyRow, blocks: Blocks) -> str:
    value = blocks.inline(tree.Value(shown_number(row, float(row.printed[0]))))
    return f"{value} {html.escape(row.unit)}".strip()


def _cells(key: Key, policy: Policy) -> str:
    """Return a table of the requested cells by section; cells worth nothing are left out."""
    words = words_of(key)
    rows = [row for row in key.asked if row.role is Role.asked and policy.worth(row.id)]
    worths = [policy.worth(row.id) for row in rows]
    factor = next((scale for scale in SCALES if all(_is_whole(scale * worth) for worth in worths)), SCALES[-1])
    lines: list[str] = []
    for part, members in groupby(rows, lambda row: row.part):
        lines.append(f"<tr><th colspan='3'>{html.escape(str(words['parts'][part]))}</th></tr>")
        for row in members:
            weight = max(round(policy.worth(row.id) * factor), 1)
            for position in row.positions:
                if (answer := _answer(row, position, weight)) is not None:
                    label = key.label(position, row.id)
                    at = f", {words['answer_sheet']['at'].format(label=label)}" if label else ""
                    named = f"{_named(row, key)}{html.escape(at)}"
                    lines.append(f"<tr><td>{named}</td><td>{answer}</td><td>{html.escape(row.unit)}</td></tr>")
    return f"<table>{''.join(lines)}</table>"


def _is_whole(value: float) -> bool:
    return abs(value - round(value)) < 1e-9


def _answer(row: KeyRow, position: int, weight: int) -> str | None:
    """Return a cell as a cloze answer, `{1:NUMERICAL:=4.71:0.05}`; None if the quantity does not exist."""
    index = row.at(position)
    value = float(row.values[index])
    if not np.isfinite(value):
        return None
    band = max(float(np.nan_to_num(bands[index if len(bands) > 1 else 0])) for bands in (row.drawn, row.computed))
    values = [value]
    if row.open_sense and value:
        values.append(-value)
    if row.unit == "°":
        values += [one + turn for one in values[:] for turn in (-TURN, TURN) if abs(one + turn) <= TURN + band]
    right = "~".join(f"={_number(one)}:{_number(band)}" for one in values)
    return f"{{{weight}:NUMERICAL:{right}}}"


def _number(value: float) -> str:
    """Return a number as Moodle reads it: with a decimal point and without a power of ten."""
    return f"{Decimal(f'{value:.{FIGURES}g}'):f}"
