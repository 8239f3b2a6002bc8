"""How much a report holds, so that the plain script makes a document of the same size.

`python -m tests.bench.size FILE PDF` prints a `Size` as JSON.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

from reportgen import api
from reportgen.document import Block, Equation, Figure, List, Paragraph, Plate, Table, Text
from reportgen.drawing import Label, Scene


@dataclass(frozen=True, slots=True)
class Size:
    """Pages, and what stands on them; `strokes` are all drawn items of the figures, `words` of running text."""

    pages: int
    figures: int
    labels: int
    strokes: int
    formulas: int
    tables: int
    rows: int
    words: int


def size_of(blocks: Iterable[Block], pages: int) -> Size:
    """The size of a document's blocks; a displayed row counts as one formula, a scene as one figure."""
    found: Counter[str] = Counter()
    for block in _all(blocks):
        match block:
            case Equation(rows):
                found["formulas"] += len(rows)
            case Table(rows=rows):
                found["tables"] += 1
                found["rows"] += len(rows)
            case Figure(scenes):
                found += sum(map(_drawn, scenes), Counter())
            case Plate(scene):
                found += _drawn(scene)
            case Paragraph(inlines):
                found["words"] += sum(len(part.text.split()) for part in inlines if isinstance(part, Text))
    names = ("figures", "labels", "strokes", "formulas", "tables", "rows", "words")
    return Size(pages, *(found[name] for name in names))


def _all(blocks: Iterable[Block]) -> Iterator[Block]:
    for block in blocks:
        yield block
        if isinstance(block, List):
            for item in block.items:
                yield from _all(item)


def _drawn(scene: Scene) -> Counter[str]:
    labels = sum(isinstance(item, Label) for item in scene.items)
    return Counter(figures=1, labels=labels, strokes=len(scene.items) - labels)


if __name__ == "__main__":
    import pymupdf

    with pymupdf.open(sys.argv[2]) as pdf:
        pages = len(pdf)
    json.dump(asdict(size_of(api.document(api.load(Path(sys.argv[1]))).blocks, pages)), sys.stdout)
