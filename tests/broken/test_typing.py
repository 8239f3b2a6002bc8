"""Forty slips of typing in fifteen kinds: the first line told is the slip's own, and what is told mends it.

Each row is made in the file that `new` writes: the line as it stands, as it was mistyped, and the piece of the message
or hint from which whoever made the slip knows what to write.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import api
from reportgen.catalogue import sample

NBSP, THIN = "\u00a0", "\u202f"
SLIPS = {
    "no blank after the colon": [
        ("  H: 95 mm", "  H:95 mm", "write H: 95 mm"),
        ("  s: 0.35", "  s:0.35", "write s: 0.35"),
        ("kind: engine-twin", "kind:engine-twin", "write kind: engine-twin"),
        ("  crank: 50 mm", "  crank:50 mm", "write crank: 50 mm"),
    ],
    "equals sign": [
        ("  H: 95 mm", "  H = 95 mm", "write H: 95 mm"),
        ("  G2: 20 N", "  G2=20 N", "write G2: 20 N"),
        ("  count: 8", "  count = 8", "write count: 8"),
    ],
    "capital or small letter": [
        ("  G2: 20 N", "  g2: 20 N", "“G2”"),
        ("  H: 95 mm", "  h: 95 mm", "“H”"),
        ("  n: 2200 rpm", "  N: 2200 rpm", "“n”"),
    ],
    "typographic quotes": [
        ("  H: 95 mm", "  H: “95 mm”", "without them: 95 mm"),
        ("kind: engine-twin", "kind: ‘engine-twin’", "without them: engine-twin"),
        ("  direction: anticlockwise", "  direction: „anticlockwise“", "without them: anticlockwise"),
    ],
    "blank that is none": [
        ("  H: 95 mm", f"  H:{NBSP}95 mm", "space bar"),
        ("  D: 98 mm", f"{NBSP} D: 98 mm", "space bar"),
        ("  count: 8", f"  count:{THIN}8", "space bar"),
    ],
    "decimal comma": [("  s: 0.35", "  s: 0,35", "write 0.35"), ("  H: 95 mm", "  H: 95,5 mm", "write 95.5 mm")],
    "no unit": [
        ("  H: 95 mm", "  H: 95", "95 mm"),
        ("  n: 2200 rpm", "  n: 2200", "rpm"),
        ("  G2: 20 N", "  G2: 20", "20 N"),
    ],
    "wrong unit": [("  H: 95 mm", "  H: 95 kg", "mm"), ("  n: 2200 rpm", "  n: 2200 Hz", "rpm")],
    "unknown unit": [("  n: 2200 rpm", "  n: 2200 rmp", "rpm"), ("  H: 95 mm", "  H: 95 mmm", "mm")],
    "misspelt key": [
        ("  direction: anticlockwise", "  direccion: anticlockwise", "“direction”"),
        ("  supervisor:", "  superviser:", "“supervisor”"),
        ("drawing:", "drawings:", "“drawing”"),
    ],
    "misspelt choice": [
        ("  direction: anticlockwise", "  direction: anti-clockwise", "anticlockwise"),
        ("kind: engine-twin", "kind: engine-twins", "“engine-twin”"),
        ("  extent: full", "  extent: long", "full"),
    ],
    "tab": [("  H: 95 mm", "\tH: 95 mm", "spaces"), ("  crank: 50 mm", "\tcrank: 50 mm", "spaces")],
    "indented otherwise": [("  D: 98 mm", "   D: 98 mm", "same column"), ("  count: 8", " count: 8", "same column")],
    "letter for a figure": [("  H: 95 mm", "  H: 9S mm", "“S mm”"), ("  count: 8", "  count: B", "whole number")],
    "the inverse": [
        ("  lambda: 1/3.6", "  lambda: 3.6", "1/3.6"),
        ("  H: 95 mm", "  H: -95 mm", "0"),
        ("  count: 8", "  count: 800", "360"),
    ],
}
CASES = [(kind, *row) for kind, rows in SLIPS.items() for row in rows]


def test_there_are_forty_in_fifteen_kinds() -> None:
    assert (len(SLIPS), len(CASES)) == (15, 40)


@pytest.mark.parametrize(("kind", "right", "slip", "mend"), CASES, ids=[" ".join(case[::2]) for case in CASES])
def test_the_first_line_told_is_the_slips_own_and_mends_it(
    kind: str, right: str, slip: str, mend: str, tmp_path: Path
) -> None:
    text = sample("engine-twin", "en")
    assert text.count(f"\n{right}") + text.startswith(right) == 1
    path = tmp_path / "own.yaml"
    path.write_text(text.replace(right, slip, 1), encoding="utf-8")
    first, *_ = [problem for problem in api.examine(path, "en") if problem.level == "error"]
    assert first.location.line == text[: text.index(right)].count("\n") + 1
    assert mend in f"{first.message} {first.hint}"
