"""The sizes of further letters for `reportgen/drawing/glyphs.json`, as the typesetter measures them in its own font.

`python -m tests.drawing.glyph_sizes` adds those of `FURTHER` that the table lacks: run it when a language needs others.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import typst

TABLE = Path(__file__).parents[2] / "reportgen" / "drawing" / "glyphs.json"
CYRILLIC = "".join(chr(code) for code in (*range(0x400, 0x460), 0x490, 0x491))
FURTHER = CYRILLIC + "«»„“”№§"
LONGEST = 118
"""Characters of a line of the table."""

QUESTION = """\
#set text(font: "New Computer Modern", size: 1000pt, fallback: false)
#let height(letter, ..edges) = measure(text(..edges, letter)).height / 1pt
#context [#metadata((LETTERS).map(letter => (
  measure(text(letter)).width / 1pt,
  height(letter, top-edge: "bounds", bottom-edge: "baseline"),
  height(letter, top-edge: "baseline", bottom-edge: "bounds"),
))) <sizes>]
"""


def measured(letters: Sequence[str]) -> list[tuple[int, int, int]]:
    """Advance, height above the baseline and depth below it, in thousandths of the font size."""
    listed = "".join(f'"\\u{{{ord(letter):x}}}",' for letter in letters)
    asked = QUESTION.replace("LETTERS", f"{listed}").encode()
    sizes = json.loads(typst.query(asked, "<sizes>", field="value", one=True, ignore_system_fonts=True))
    return [(round(width), round(height), round(depth)) for width, height, depth in sizes]


def written(table: dict[str, dict[str, list[int]]]) -> str:
    """The table as it stands in the file, some letters a line."""
    parts = []
    for name, letters in table.items():
        lines = ["   "]
        for letter, size in letters.items():
            entry = f" {json.dumps(letter, ensure_ascii=False)}: {json.dumps(size)},"
            if len(lines[-1]) + len(entry) > LONGEST:
                lines.append("   ")
            lines[-1] += entry
        body = "\n".join(lines).removesuffix(",")
        parts.append(f'  "{name}": {{\n{body}\n  }}')
    return "{\n" + ",\n".join(parts) + "\n}\n"


if __name__ == "__main__":
    table = json.loads(TABLE.read_text(encoding="utf-8"))
    lacking = [letter for letter in FURTHER if letter not in table["roman"]]
    table["roman"] |= {letter: list(size) for letter, size in zip(lacking, measured(lacking), strict=True)}
    TABLE.write_text(written(table), encoding="utf-8")
