"""Worked lines read back from a page as a reader does: glyphs, raised powers, fraction bars."""

from __future__ import annotations

import math
import re
import unicodedata
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from tests.report import pages
from tests.report.built import Report
from tests.report.calculator import RESULT, Line, is_calculation
from tests.report.pages import Glyph

WHITE = 6 * pages.MM
"""Between two equations on a line at least; nothing within one stands so far apart."""


def printed_lines(report: Report) -> Iterator[Line]:
    """Every line of the body of a PDF whose last two parts are numbers put in and a number."""
    for page in report.pages:
        found = page.body
        bars = [
            drawing["rect"]
            for drawing in page.drawings
            if drawing["rect"].height < 1 and drawing["rect"].width < 100 * pages.MM
        ]
        for row, left, right in (part for line in _rows(found) for part in _abreast(line, found)):
            inside = [glyph for glyph in found if left < glyph.origin[0] < right]
            text = _read(row, inside, [bar for bar in bars if left < bar.x0 < right])
            text = text.replace("−", "-").replace(",", ".") if report.language == "vi" else text.replace("−", "-")
            *before, substitution, result = ["", "", *text.split("=")]
            calculated = re.search(r"[-+·/^]", substitution) and is_calculation(substitution)
            if before[2:] and calculated and RESULT.fullmatch(result):
                yield Line(before[2], substitution, result)


def _rows(found: Sequence[Glyph]) -> Iterator[list[Glyph]]:
    """Glyphs of the running text's size on a common baseline that hold a relation, from left to right."""
    rows = defaultdict(list)
    for glyph in found:
        if pages.PROSE[0] < glyph.size < pages.PROSE[1]:
            rows[round(glyph.origin[1])].append(glyph)
    for row in rows.values():
        if any(glyph.char == "=" for glyph in row):
            yield sorted(row, key=lambda glyph: glyph.origin[0])


def _abreast(row: list[Glyph], found: Sequence[Glyph]) -> Iterator[tuple[list[Glyph], float, float]]:
    """The equations of a row that stand side by side, each with the ends of its place: white is between them."""
    baseline = row[0].origin[1]
    near = sorted(
        (glyph.box[0], glyph.box[2]) for glyph in found if abs(glyph.origin[1] - baseline) < 1.5 * row[0].size
    )
    cuts, reached = [-math.inf], near[0][1]
    for start, end in near:
        if start - reached > WHITE:
            cuts.append((start + reached) / 2)
        reached = max(reached, end)
    for left, right in pairwise((*cuts, math.inf)):
        part = [glyph for glyph in row if left < glyph.origin[0] < right]
        if any(glyph.char == "=" for glyph in part):
            yield part, left, right


def _read(row: Sequence[Glyph], found: Sequence[Glyph], bars: Sequence[Any]) -> str:
    """A row as text: powers behind ^, fractions as (…)/(…), indices left out."""
    baseline = Counter(glyph.origin[1] for glyph in row).most_common(1)[0][0]
    left, right = row[0].box[0], row[-1].box[2]
    size = row[0].size
    pieces = [
        (glyph.origin[0], _plain(glyph.char))
        for glyph in row
        if abs(glyph.origin[1] - baseline) < 0.6 and glyph.char != "√"
    ]
    # Tall parentheses have their origin elsewhere.
    pieces += [
        (glyph.origin[0], glyph.char)
        for glyph in found
        if glyph.char in "()"
        and abs(glyph.origin[1] - baseline) >= 0.6
        and glyph.box[3] - glyph.box[1] > size
        and glyph.box[1] < baseline < glyph.box[3]
        and left < glyph.origin[0] < right
    ]
    # The bar of a fraction lies on the axis, a quarter of the size above the baseline.
    own = [bar for bar in bars if 0 < baseline - bar.y0 < 0.5 * size and bar.x1 > left - 60]
    beside = [(bar.x0, bar.x1) for bar in own]
    for bar in own:
        inside = [g for g in found if bar.x0 - 1 < g.origin[0] < bar.x1 + 1]
        top = [g for g in inside if 0 < bar.y0 - g.origin[1] < 1.1 * size]
        bottom = [g for g in inside if 0 < g.origin[1] - bar.y0 < 1.5 * size]
        if not top or not bottom:
            continue
        pieces.append((bar.x0, f"({_level(top, found, bars)})/({_level(bottom, found, bars)})"))
    pieces += _roots(found, bars, baseline, left, right)
    pieces += [
        (glyph.origin[0], f"^{_plain(glyph.char)}")
        for glyph in found
        if glyph.size < 0.8 * size
        and 0.2 * size < baseline - glyph.origin[1] < 0.6 * size
        and left < glyph.origin[0] < right + size
        and not any(x0 - 1 < glyph.origin[0] < x1 + 1 for x0, x1 in beside)
    ]
    return "".join(text for _, text in sorted(pieces))


def _roots(
    found: Sequence[Glyph], bars: Sequence[Any], baseline: float, left: float, right: float
) -> Iterator[tuple[float, str]]:
    """Where the roots of a line open and, at the end of the bar that a sign carries, close."""
    for sign in found:
        if sign.char == "√" and sign.box[1] < baseline < sign.box[3] + 1 and left - 1 < sign.box[0] < right:
            bar = min(bars, key=lambda bar: abs(bar.x0 - sign.box[2]) + abs(bar.y0 - sign.box[1]))
            yield sign.box[0], "sqrt("
            yield bar.x1, ")"


def _level(glyphs: Sequence[Glyph], found: Sequence[Glyph], bars: Sequence[Any]) -> str:
    """The top or bottom of a fraction: its own baseline, powers above it, roots around."""
    size = max(glyph.size for glyph in glyphs if glyph.char != "√")
    plain = [glyph for glyph in glyphs if glyph.char != "√"]
    baseline = Counter(g.origin[1] for g in plain if g.size > 0.9 * size).most_common(1)[0][0]
    pieces = list(_roots(found, bars, baseline, min(g.box[0] for g in glyphs) - size, max(g.box[2] for g in glyphs)))
    for glyph in plain:
        if abs(glyph.origin[1] - baseline) < 0.6:
            pieces.append((glyph.origin[0], _plain(glyph.char)))
        elif glyph.size < 0.8 * size and 0.2 * size < baseline - glyph.origin[1]:
            pieces.append((glyph.origin[0], f"^{_plain(glyph.char)}"))
    return "".join(text for _, text in sorted(pieces))


def _plain(char: str) -> str:
    return pages.squash(unicodedata.normalize("NFKC", char))
