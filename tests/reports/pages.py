"""What a PDF page shows: glyphs with their ink, words, arrows; read by an independent PDF library."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

MM = 72 / 25.4
"""PDF points in a millimetre."""
BODY, FOOT = 24 * MM, 19 * MM
"""Above and below this much of an A4 page stand header and footer."""
EDGE = 6 * MM
"""What printers leave white along the edge of the paper, with some to spare."""
INK = 0.1
"""Points that the ink of two words may share: the PDF library rounds its boxes to about 0.05."""
BEARING = 0.5
"""Points by which a glyph's ink may hang over the edge of its own box."""
PROSE = (11.6, 12.4)
"""Font sizes of running text, headings of level 3 and formulas; all else is smaller or larger."""

_DROPPED = re.compile("[\\s\N{WORD JOINER}\N{SOFT HYPHEN}\N{HYPHEN}-]+")
CONTINUED = re.compile(r"(?:Table|Bảng)([\d.]+)\((?:continued|tiếptheo)\)")
"""The label of a table that goes on, its spaces left out."""
_SMALL = re.compile("[₀-₉]")


@dataclass(frozen=True, slots=True)
class Glyph:
    """A character, the box of its ink (points, y down), its font size and baseline, and its word's number."""

    char: str
    box: tuple[float, float, float, float]
    size: float
    origin: tuple[float, float]
    bold: bool
    italic: bool
    word: int


def squash(text: str) -> str:
    """Text without what typesetters are free in: spaces, line breaks, hyphens, compatibility forms."""
    return _DROPPED.sub("", unicodedata.normalize("NFKC", text))


def squash_prose(text: str) -> str:
    """The same without small figures below the line, which LaTeX sets as formulas in a smaller size."""
    return squash(_SMALL.sub("", text))


def glyphs(page: Any) -> list[Glyph]:
    """The visible characters of a page in the order of its text."""
    import pymupdf

    flags = (pymupdf.TEXTFLAGS_WORDS | pymupdf.TEXT_ACCURATE_BBOXES) & ~pymupdf.TEXT_PRESERVE_LIGATURES
    found: list[Glyph] = []
    word = 0
    for block in page.get_text("rawdict", flags=flags)["blocks"]:
        for line in block.get("lines", ()):
            word += 1
            for span in line["spans"]:
                font = span["font"].lower()
                bold, italic = "bold" in font, "italic" in font and "math" not in font
                for char in span["chars"]:
                    if not char["c"].strip(" \n\t\N{NO-BREAK SPACE}\N{ZERO WIDTH SPACE}\N{WORD JOINER}"):
                        word += 1
                        continue
                    found.append(
                        Glyph(char["c"], tuple(char["bbox"]), span["size"], tuple(char["origin"]), bold, italic, word)
                    )
    return found


def is_plate(page: Any) -> bool:
    """Whether a page is larger than A4."""
    return bool(page.rect.width > 215 * MM or page.rect.height > 300 * MM)


def body(page: Any) -> list[Glyph]:
    """The glyphs of a page without its header and footer."""
    above, below = (13.5 * MM, 13.5 * MM) if is_plate(page) else (BODY, FOOT)
    return [glyph for glyph in glyphs(page) if above < glyph.origin[1] < page.rect.height - below]


def without_repeated_head(page: Any, found: Sequence[Glyph], before: Sequence[Glyph]) -> Sequence[Glyph]:
    """The glyphs of a page's body without the head of a table that continues from the page before.

    Such a head begins with the table's number and the word that it continues; it lasts until the second rule below,
    and the page before, whose glyphs are `before`, has it too, with other words above it.
    """
    rules = sorted(
        (
            drawing["rect"]
            for drawing in page.get_drawings()
            if drawing["rect"].y0 > BODY and drawing["rect"].height < 1.5 and drawing["rect"].width > 60 * MM
        ),
        key=lambda rule: float(rule.y0),
    )
    label = continued(found)
    if is_plate(page) or not label:
        return found
    base = label[0].origin[1]
    first, *others = (rule for rule in rules if rule.y0 > base)
    last = next(rule for rule in others if rule.y0 > first.y1 + 2 * MM and abs(rule.width - first.width) < 1)
    head = [glyph for glyph in found if base + 1 < glyph.origin[1] <= last.y1]
    assert text(head) in text(before), text(head)
    return [glyph for glyph in found if glyph not in label and glyph not in head]


def continued(found: Sequence[Glyph]) -> list[Glyph]:
    """The line of a page that names the table it continues; none if it continues no table."""
    lines: dict[int, list[Glyph]] = {}
    for glyph in found:
        if glyph.bold:
            lines.setdefault(round(glyph.origin[1]), []).append(glyph)
    return next((line for line in lines.values() if CONTINUED.fullmatch(text(line))), [])


def text(of: Iterable[Glyph]) -> str:
    return squash("".join(glyph.char for glyph in of))


def overlaps(page: Any, tolerance: float) -> list[str]:
    """Pairs of glyphs of different words whose ink overlaps by more than `tolerance` points both ways."""
    found = glyphs(page)
    if not found:
        return []
    boxes = np.array([glyph.box for glyph in found])
    words = np.array([glyph.word for glyph in found])
    across = np.minimum.outer(boxes[:, 2], boxes[:, 2]) - np.maximum.outer(boxes[:, 0], boxes[:, 0])
    down = np.minimum.outer(boxes[:, 3], boxes[:, 3]) - np.maximum.outer(boxes[:, 1], boxes[:, 1])
    met = (np.minimum(across, down) > tolerance) & (words[:, None] < words[None, :])
    return [
        f"page {page.number + 1}: {found[i].char!r} and {found[j].char!r} at {found[i].origin}"
        for i, j in np.argwhere(met)
    ]


def outside(page: Any, bearing: float) -> list[str]:
    """Glyphs outside the margins by more than `bearing` points.

    A4: 30 mm left, 20 mm right; plates 15 mm.  Above and below only header and footer use the margin,
    and keep what printers need from the edge.
    """
    left, right = (15.0, 15.0) if is_plate(page) else (30.0, 20.0)
    allowed = (left * MM - bearing, EDGE, page.rect.width - right * MM + bearing, page.rect.height - EDGE)
    return [
        f"page {page.number + 1}: {glyph.char!r} at {glyph.box}"
        for glyph in glyphs(page)
        if glyph.box[0] < allowed[0]
        or glyph.box[1] < allowed[1]
        or glyph.box[2] > allowed[2]
        or glyph.box[3] > allowed[3]
    ]


def arrows(page: Any) -> Iterator[float]:
    """Lengths (mm) of the straight arrows of a page, in painting order.

    An arrow is a stroke of one straight piece and, painted next, a filled triangle: its tip is the
    triangle's first corner, and the shaft ends inside.
    """
    for shaft, head in pairwise(page.get_drawings()):
        if shaft["type"] != "s" or head["type"] != "f" or len(shaft["items"]) != 1:
            continue
        kind, *points = shaft["items"][0]
        edges = head["items"]
        if kind != "l" or len(edges) not in (2, 3) or any(edge[0] != "l" for edge in edges):
            continue
        tip, start = edges[0][1], points[0]
        yield abs(complex(tip.x - start.x, tip.y - start.y)) / MM
