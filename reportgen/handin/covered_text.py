"""Find text of a Word file that is covered by a picture or a filled box in front of it.

The file is not laid out, so positions are estimated from the paragraph that a picture is anchored at. The height of a
block follows from its lines, its font size and its spacing. Only blocks entirely within the height of the picture and
no wider than it count, with a margin for errors of the estimate; leaving room for a picture is therefore safe. Pictures
in the line, those with text around or before them, and those placed relative to the page are ignored.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from reportgen.base.records import Record
from reportgen.handin.invisible_text import Styles, first_of, looks_of
from reportgen.handin.word_nodes import XmlNode

EMU = 36_000.0
"""English metric units per millimetre."""
TWIPS = 56.7
"""Twips (twentieths of a point) per millimetre."""
SMALLEST = (30.0, 8.0)
"""Width and height (mm) below which an object in front is a label or an arrow."""
LETTERS = 95
"""Number of letters of a full line."""
LINE = 165.0
"""Length (mm) of a full line."""
NEAR = 3.0
"""Largest distance (mm) from the left margin of an object that covers the text there."""
PITCH = 1.2 * 25.4 / 72 / 2
"""Distance (mm) between lines for each half point of the font size."""
USUAL = 22
"""Default font size in half points."""
MARGIN = 0.15
"""Error of the estimate, as a share of the distance from the anchor."""
ON = frozenset({"1", "true", "on"})
FILLS = (":solidFill", ":gradFill", ":pattFill", ":blipFill")


def covered_runs(tree: XmlNode, styles: Styles) -> Iterator[XmlNode]:
    """Yield the runs of text that are covered."""
    for anchor in (node for node in tree.walk() if node.tag.endswith(":anchor")):
        reach = _reach(anchor)
        paragraph = next((one for one in anchor.above if one.tag == "w:p"), None)
        if reach is None or paragraph is None or paragraph.parent is None:
            continue
        blocks = [one for one in paragraph.parent.children if one.tag in ("w:p", "w:tbl")]
        for block in _within(blocks, blocks.index(paragraph), reach, styles):
            if _end(block) > reach.right:
                continue
            yield from (
                node
                for node in block.walk()
                if node.tag in ("w:r", "m:r") and all(one is not anchor for one in node.above)
            )


class _Reach(Record):
    """The vertical range (mm below the top of its paragraph) that an object covers, and its right end (mm)."""

    top: float
    bottom: float
    right: float


def _reach(anchor: XmlNode) -> _Reach | None:
    """Return the area that an opaque object in front of the text covers; None for any other object.

    The object must begin at most `NEAR` (mm) from the left margin.
    """
    parts = {one.tag.rpartition(":")[2]: one for one in anchor.children}
    down, across, extent = parts.get("positionV"), parts.get("positionH"), parts.get("extent")
    if anchor.get("behindDoc") in ON or "wrapNone" not in parts or not _is_opaque(anchor):
        return None
    if down is None or across is None or extent is None or down.get("relativeFrom") not in ("paragraph", "line"):
        return None
    width, height = _millimetres(extent.get("cx")), _millimetres(extent.get("cy"))
    if width < SMALLEST[0] or height < SMALLEST[1]:
        return None
    top, left = _offset(down, 0.0), _offset(across, max(0.0, (LINE - width) / 2))
    return _Reach(top, top + height, left + width) if left <= NEAR else None


def _offset(position: XmlNode, aligned: float) -> float:
    """Return an offset (mm), or `aligned` (mm) if the position is given as a word."""
    offset = next((one for one in position.children if one.tag.endswith(":posOffset")), None)
    return aligned if offset is None else _millimetres(offset.text)


def _end(block: XmlNode) -> float:
    """Return the approximate right end of a block's text (mm from the left margin); for a table, 2/3 of a line."""
    if block.tag == "w:tbl":
        return 2 * LINE / 3
    length = min(_letters(block) / LETTERS, 1.0) * LINE
    centre = block.at("w:pPr", "w:jc")
    centred = centre is not None and centre.get("w:val") == "center"
    return (LINE + length) / 2 if centred or block.child("m:oMathPara") else length


def _letters(block: XmlNode) -> int:
    return sum(len(one.text) for one in block.walk() if one.tag in ("w:t", "m:t"))


def _is_opaque(anchor: XmlNode) -> bool:
    """Return True for a picture or a filled shape."""
    for node in anchor.walk():
        if node.tag.endswith(":pic"):
            return True
        if node.tag.endswith(":spPr") and any(one.tag.endswith(FILLS) for one in node.children):
            return True
    return False


def _within(blocks: Sequence[XmlNode], at: int, reach: _Reach, styles: Styles) -> Iterator[XmlNode]:
    """Yield the blocks entirely within a range, measured from the top of the block at index `at`."""
    # The first line may be cut slightly.
    top, bottom = reach.top - 1.0, reach.bottom
    place = 0.0
    for block in blocks[at:]:
        end = place + _height(block, styles)
        if top <= place * (1 - MARGIN) and end * (1 + MARGIN) <= bottom:
            yield block
        place = end
    place = 0.0
    for block in reversed(blocks[:at]):
        start = place - _height(block, styles)
        if top <= start * (1 + MARGIN) and place * (1 - MARGIN) <= bottom:
            yield block
        place = start


def _height(block: XmlNode, styles: Styles) -> float:
    """Return the approximate height of a paragraph or a table (mm)."""
    if block.tag == "w:tbl":
        rows = (one for one in block.children if one.tag == "w:tr")
        return sum(
            max((_cell(cell, styles) for cell in row.children if cell.tag == "w:tc"), default=0.0) for row in rows
        )
    run = next((one for one in block.walk() if one.tag == "w:r"), None)
    looks = list(looks_of(run if run is not None else block, block, styles))
    size = first_of(looks, "w:sz")
    pitch = PITCH * (_whole(size.get("w:val")) or USUAL if size is not None else USUAL)
    named = block.at("w:pPr", "w:pStyle")
    paragraphs = [
        block.child("w:pPr"),
        *(one.child("w:pPr") for one in styles.chain(named.get("w:val") if named else styles.plain)),
    ]
    spacing = first_of([one for one in paragraphs if one is not None], "w:spacing")
    around, lead = 0.0, 240
    if spacing is not None:
        around = (_whole(spacing.get("w:before")) + _whole(spacing.get("w:after"))) / TWIPS
        lead = _whole(spacing.get("w:line")) or 240
    inline = [_inline(one) for one in block.walk() if one.tag.endswith(":inline")]
    return max(1, math.ceil(_letters(block) / LETTERS)) * pitch * lead / 240 + around + sum(inline)


def _cell(cell: XmlNode, styles: Styles) -> float:
    return sum(_height(one, styles) for one in cell.children if one.tag in ("w:p", "w:tbl"))


def _inline(picture: XmlNode) -> float:
    extent = next((one for one in picture.children if one.tag.endswith(":extent")), None)
    return _millimetres(extent.get("cy")) if extent is not None else 0.0


def _millimetres(text: str) -> float:
    return int(text) / EMU if text.strip().lstrip("-").isdecimal() and len(text) < 12 else 0.0


def _whole(text: str) -> int:
    return int(text) if text.isdecimal() and len(text) < 9 else 0
