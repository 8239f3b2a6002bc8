"""What a PDF page shows: glyphs with their ink, words, arrows; read once, by an independent PDF library."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

MM = 72 / 25.4
"""PDF points in a millimetre."""
BODY, FOOT = 21 * MM, 17 * MM
"""Above and below this much of an A4 page stand header and footer."""
EDGE = 6 * MM
"""What printers leave white along the edge of the paper, with some to spare."""
INK = 0.1
"""Points that the ink of two words may share: the PDF library rounds its boxes to about 0.05."""
BEARING = 0.5
"""Points by which a glyph's ink may hang over the edge of its own box."""
TUCKED = 0.15
"""Share of a letter's size by which an index below the line may begin before the letter ends."""
PROSE = (11.6, 12.4)
"""Font sizes of running text, headings of level 3 and formulas; all else is smaller or larger."""

_DROPPED = re.compile("[\\s\N{WORD JOINER}\N{SOFT HYPHEN}\N{HYPHEN}-]+")
CONTINUED = re.compile(r"(?:Table|Bảng)([\d.]+)\((?:continued|tiếptheo)\)")
"""The label of a table that goes on, its spaces left out."""
_SMALL = re.compile("[₀-₉]")


@dataclass(frozen=True, slots=True)
class Glyph:
    """A character: its ink's box (points, y down), size and baseline, its word's number, where its line runs."""

    char: str
    box: tuple[float, float, float, float]
    size: float
    origin: tuple[float, float]
    bold: bool
    italic: bool
    word: int
    along: complex = 1


def squash(text: str) -> str:
    """Text without what typesetters are free in: spaces, line breaks, hyphens, compatibility forms."""
    return _DROPPED.sub("", unicodedata.normalize("NFKC", text))


def squash_prose(text: str) -> str:
    """The same without small figures below the line, which LaTeX sets as formulas in a smaller size."""
    return squash(_SMALL.sub("", text))


class Page:
    """A page of an open PDF; what takes time to read is kept."""

    def __init__(self, sheet: Any) -> None:
        self.sheet = sheet
        self.number: int = sheet.number
        self.rect = sheet.rect

    @cached_property
    def is_plate(self) -> bool:
        """Whether the page is larger than A4."""
        return bool(self.rect.width > 215 * MM or self.rect.height > 300 * MM)

    @cached_property
    def glyphs(self) -> list[Glyph]:
        """The visible characters in the order of the text."""
        return _glyphs(self.sheet)

    @cached_property
    def body(self) -> list[Glyph]:
        """The glyphs without header and footer."""
        above, below = (15 * MM, 13.5 * MM) if self.is_plate else (BODY, FOOT)
        return [glyph for glyph in self.glyphs if above < glyph.origin[1] < self.rect.height - below]

    @cached_property
    def drawings(self) -> list[Any]:
        """The painted paths in order."""
        return list(self.sheet.get_drawings())

    @cached_property
    def lines(self) -> list[tuple[str, float]]:
        """(text, upper edge in points) of each line."""
        return [
            ("".join(span["text"] for span in line["spans"]).strip(), line["bbox"][1])
            for block in self.sheet.get_text("dict")["blocks"]
            for line in block.get("lines", ())
        ]


def _glyphs(sheet: Any) -> list[Glyph]:
    import pymupdf

    flags = (pymupdf.TEXTFLAGS_WORDS | pymupdf.TEXT_ACCURATE_BBOXES) & ~pymupdf.TEXT_PRESERVE_LIGATURES
    found: list[Glyph] = []
    word = 0
    for block in sheet.get_text("rawdict", flags=flags)["blocks"]:
        for line in block.get("lines", ()):
            word += 1
            along = complex(*line["dir"])
            for span in line["spans"]:
                font = span["font"].lower()
                bold, italic = "bold" in font, "italic" in font and "math" not in font
                for char in span["chars"]:
                    if not char["c"].strip(" \n\t\N{NO-BREAK SPACE}\N{ZERO WIDTH SPACE}\N{WORD JOINER}"):
                        word += 1
                        continue
                    # A letter that a font makes of two parts is told twice, at its left and its right edge.
                    if found and is_other_edge(found[-1], char):
                        continue
                    box, origin = tuple(char["bbox"]), tuple(char["origin"])
                    found.append(Glyph(char["c"], box, span["size"], origin, bold, italic, word, along))
    return found


def is_other_edge(last: Glyph, char: Mapping[str, Any]) -> bool:
    """Whether a character without width repeats the one before it."""
    left, right = last.box[0], last.box[2]
    return last.char == char["c"] and left == right and char["bbox"][0] == char["bbox"][2]


def without_repeated_head(page: Page, before: Sequence[Glyph]) -> Sequence[Glyph]:
    """The glyphs of a page's body without the head of a table that continues from the page before.

    Such a head begins with the table's number and the word that it continues; it lasts until the second rule below,
    and one of the pages before, whose glyphs are `before`, has it too, with other words above it.
    """
    found = page.body
    label = continued(found)
    if page.is_plate or not label:
        return found
    rules = sorted(
        (
            drawing["rect"]
            for drawing in page.drawings
            if drawing["rect"].y0 > BODY and drawing["rect"].height < 1.5 and drawing["rect"].width > 60 * MM
        ),
        key=lambda rule: float(rule.y0),
    )
    base = label[0].origin[1]
    first, *others = (rule for rule in rules if rule.y0 > base)
    last = next(rule for rule in others if rule.y0 > first.y1 + 2 * MM and abs(rule.width - first.width) < 1)
    head = [glyph for glyph in found if base + 1 < glyph.origin[1] <= last.y1]
    assert text(head) in text(before), text(head)
    repeated = {id(glyph) for glyph in (*label, *head)}
    return [glyph for glyph in found if id(glyph) not in repeated]


def continued(found: Sequence[Glyph]) -> list[Glyph]:
    """The line of a page that names the table it continues; none if it continues no table."""
    lines: dict[int, list[Glyph]] = {}
    for glyph in found:
        if glyph.bold:
            lines.setdefault(round(glyph.origin[1]), []).append(glyph)
    return next((line for line in lines.values() if CONTINUED.fullmatch(text(line))), [])


def text(of: Iterable[Glyph]) -> str:
    return squash("".join(glyph.char for glyph in of))


def overlaps(page: Page, tolerance: float) -> list[str]:
    """Pairs of glyphs of different words whose ink overlaps by more than `tolerance` points both ways."""
    found = sorted(page.glyphs, key=lambda glyph: glyph.box[1])
    if not found:
        return []
    left, top, right, bottom = np.array([glyph.box for glyph in found]).T
    # From the top down a glyph can only meet those that begin above its own lower edge.
    first = np.arange(len(found))
    below = np.maximum(np.searchsorted(top, bottom) - first - 1, 0)
    one = np.repeat(first, below)
    other = np.arange(len(one)) - np.repeat(np.cumsum(below) - below, below) + one + 1
    across = np.minimum(right[one], right[other]) - np.maximum(left[one], left[other])
    down = np.minimum(bottom[one], bottom[other]) - top[other]
    met = np.minimum(across, down) > tolerance
    pairs = [(found[i], found[j]) for i, j in zip(one[met], other[met], strict=True)]
    return [
        f"page {page.number + 1}: {one.char!r} and {other.char!r} at {one.origin}"
        for one, other in pairs
        if one.word != other.word and not tucked(one, other) and not tucked(other, one)
    ]


def tucked(letter: Glyph, index: Glyph) -> bool:
    """Whether an index begins under the overhang of its letter, as that of P does: its box, not its ink, meets it."""
    origin = complex(*letter.origin)
    corners = (complex(x, y) for x in letter.box[::2] for y in letter.box[1::2])
    width = max(((corner - origin) / letter.along).real for corner in corners)
    step = (complex(*index.origin) - origin) / letter.along
    return (
        index.size < 0.8 * letter.size
        and 0.1 * letter.size < step.imag < 0.5 * letter.size
        and width - TUCKED * letter.size < step.real
    )


def outside(page: Page, bearing: float) -> list[str]:
    """Glyphs outside the margins by more than `bearing` points.

    A4: 30 mm left, 20 mm right; plates 15 mm.  Above and below only header and footer use the margin,
    and keep what printers need from the edge.
    """
    left, right = (15.0, 15.0) if page.is_plate else (30.0, 20.0)
    allowed = (left * MM - bearing, EDGE, page.rect.width - right * MM + bearing, page.rect.height - EDGE)
    return [
        f"page {page.number + 1}: {glyph.char!r} at {glyph.box}"
        for glyph in page.glyphs
        if glyph.box[0] < allowed[0]
        or glyph.box[1] < allowed[1]
        or glyph.box[2] > allowed[2]
        or glyph.box[3] > allowed[3]
    ]


def arrows(page: Page) -> Iterator[float]:
    """Lengths (mm) of the straight arrows of a page, in painting order.

    An arrow is a stroke of one straight piece and, painted next, a filled triangle: its tip is the
    triangle's first corner, and the shaft ends inside.
    """
    for shaft, head in pairwise(page.drawings):
        if shaft["type"] != "s" or head["type"] != "f" or len(shaft["items"]) != 1:
            continue
        kind, *points = shaft["items"][0]
        edges = head["items"]
        if kind != "l" or len(edges) not in (2, 3) or any(edge[0] != "l" for edge in edges):
            continue
        tip, start = edges[0][1], points[0]
        yield abs(complex(tip.x - start.x, tip.y - start.y)) / MM
