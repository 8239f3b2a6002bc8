"""The frame of a drawing sheet and its title block, as scenes: one source for every writer.

Sizes are those of ISO 216, the frame that of ISO 5457: a filing edge at the left, centring marks in the
middle of each side.  Letters have the heights of ISO 3098.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from reportgen.figures.lettering import font_size
from reportgen.figures.metrics import box
from reportgen.figures.scene import Anchor, Item, Label, Line, Polyline, Scene, Stroke
from reportgen.figures.sheet import Room

SIZES: Mapping[str, tuple[float, float]] = {
    "A0": (1189.0, 841.0),
    "A1": (841.0, 594.0),
    "A2": (594.0, 420.0),
    "A3": (420.0, 297.0),
}
"""Width and height of each size of paper, lying, mm."""

HEAVY, FINE, EDGE = Stroke(0.7), Stroke(0.35), Stroke(0.18)
CENTRING = 5.0
"""How far a centring mark reaches into the frame, mm."""
HEIGHTS = (7.0, 5.0, 3.5, 2.5, 1.8)
"""Heights of capital letters, mm; the last in narrow cells of a title block only."""
PADDING = 0.6
"""White beside a text in its cell, mm."""
LEADING = 1.6
"""From line to line, in heights of capitals."""

LINE = 1.3
"""Of a line with what reaches below it, in heights of capitals."""

Align = Literal["left", "center"]


@dataclass(frozen=True, slots=True)
class Cell:
    """A box of a title block, its lower left corner from that of the block, with a printed text or a field."""

    x: float
    y: float
    width: float
    height: float
    text: str = ""
    letters: float = 2.5
    """Height of capitals, mm; a field that needs more room takes a smaller one."""
    align: Align = "center"
    heavy: bool = False


@dataclass(frozen=True, slots=True)
class Margins:
    """From each edge of the paper to the frame, mm."""

    left: float = 20.0
    other: float = 10.0


def room(size: str, margins: Margins, block: tuple[float, float]) -> Room:
    """What the frame and the title block leave free on a sheet."""
    width, height = SIZES[size]
    low, high = complex(margins.left, margins.other), complex(width - margins.other, height - margins.other)
    return Room(low, high, complex(*block))


def frame(size: str, margins: Margins, note: str = "") -> Scene:
    """The edge of the paper, the frame and its centring marks; the format as a `note` below it."""
    width, height = SIZES[size]
    low, high = complex(margins.left, margins.other), complex(width - margins.other, height - margins.other)
    middle = (low + high) / 2
    marks = (
        (complex(0, middle.imag), complex(low.real + CENTRING, middle.imag)),
        (complex(width, middle.imag), complex(high.real - CENTRING, middle.imag)),
        (complex(middle.real, 0), complex(middle.real, low.imag + CENTRING)),
        (complex(middle.real, height), complex(middle.real, high.imag - CENTRING)),
    )
    items: tuple[Item, ...] = (
        Polyline(_corners(0j, complex(width, height)), EDGE, closed=True),
        Polyline(_corners(low, high), HEAVY, closed=True),
        *(Line(start, end, HEAVY) for start, end in marks),
        *([Label(complex(high.real, low.imag / 2), note, "right", font_size(HEIGHTS[-2]))] if note else []),
    )
    return Scene(width, height, items)


def title_block(cells: Sequence[Cell], size: tuple[float, float]) -> Scene:
    """The title block with its cells filled in; the texts keep inside their cells."""
    items: list[Item] = []
    for cell in cells:
        low = complex(cell.x, cell.y)
        pen = HEAVY if cell.heavy else FINE
        items.append(Polyline(_corners(low, low + complex(cell.width, cell.height)), pen, closed=True))
    items.append(Polyline(_corners(0j, complex(*size)), HEAVY, closed=True))
    items += [label for cell in cells for label in _letters(cell)]
    return Scene(*size, tuple(items))


def _corners(low: complex, high: complex) -> tuple[complex, ...]:
    return low, complex(high.real, low.imag), high, complex(low.real, high.imag)


def _letters(cell: Cell) -> Iterator[Label]:
    """The cell's text in the largest letters, not above its own, with which it has room."""
    if not cell.text:
        return
    heights = [height for height in HEIGHTS if height <= cell.letters] or [HEIGHTS[-1]]
    height, lines = next(
        ((height, lines) for height in heights if _fits(lines := _lines(cell, height), cell, height)),
        (heights[-1], [_shortened(cell, heights[-1])]),
    )
    anchor: Anchor = "left" if cell.align == "left" else "center"
    x = cell.x + (PADDING if cell.align == "left" else cell.width / 2)
    top = cell.y + cell.height / 2 + LEADING * height * (len(lines) - 1) / 2
    for number, line in enumerate(lines):
        yield Label(complex(x, top - LEADING * height * number), line, anchor, font_size(height))


def _lines(cell: Cell, height: float) -> list[str]:
    """The text's words in lines no wider than the cell."""
    lines: list[str] = []
    for word in cell.text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and _width(longer, height) <= cell.width - 2 * PADDING:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def _fits(lines: Sequence[str], cell: Cell, height: float) -> bool:
    wide = max(_width(line, height) for line in lines) <= cell.width - 2 * PADDING
    return wide and (LEADING * (len(lines) - 1) + LINE) * height + 2 * PADDING <= cell.height


def _shortened(cell: Cell, height: float) -> str:
    """A name in one line: initials before its last word, without titles; cut where even that is too long."""
    *before, last = cell.text.split()
    short = " ".join([*(f"{word[0]}." for word in before if not word.endswith(".")), last])
    while _width(short, height) > cell.width - 2 * PADDING and len(short) > 1:
        short = short.rstrip("…")[:-1] + "…"
    return short


def _width(text: str, height: float) -> float:
    return box(text, font_size(height)).width
