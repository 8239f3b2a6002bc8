"""Files made to keep the reader busy: each just under the size limit, each judged in under 2 s."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from reportgen.catalogue import check
from reportgen.source import LARGEST, MOST_FAULTS
from tests.broken.test_broken import BASE

MOST_SECONDS = 2.0
"""Of the processor's time, so that other work on the machine does not count."""

ENDLESS = {
    "aliases": ("variant: [", "*a,", "]"),
    "anchors": ("variant: [", "&a 1,", "]"),
    "tags": ("variant: [", "!a 1,", "]"),
    "keys of a row": ("variant: {", "a,", "}"),
    "values": ("variant: [", "1,", "]"),
    "values below each other": ("variant:\n", "- 1\n", ""),
    "lists in lists": ("variant: ", "- ", ""),
    "tabs": ("", "\t", ""),
    "lines of tabs": ("", "\t\n", ""),
    "empty lines": ("", "\n", ""),
    "comments": ("", "#\n", ""),
    "directives": ("", "%a b\n", ""),
    "documents": ("", "---\n", ""),
    "lines of a text": ("variant: |\n", "  x\n", ""),
    "words": ("variant: x", " x", ""),
    "escapes": ('variant: "', "\\n", '"'),
    "a key": ("", "x", ": 1"),
    "positions": ("kind: engine-twin\nreport: {worked_positions: [", "1,", "]}"),
    "pressures": (BASE.split("  exhaust")[0] + "  exhaust: [", "1,", "]"),
}


@pytest.mark.parametrize("name", ENDLESS)
def test_any_file_is_judged_in_two_seconds(tmp_path: Path, name: str) -> None:
    before, again, after = ENDLESS[name]
    room = LARGEST - len(before) - len(after)
    file = tmp_path / "a.yaml"
    file.write_text(before + again * (room // len(again)) + after, encoding="utf-8")
    start = time.process_time()
    problems = check(file, "en")
    assert time.process_time() - start < MOST_SECONDS
    assert 0 < len(problems) <= MOST_FAULTS


def test_the_longest_honest_file_is_read(tmp_path: Path) -> None:
    """A diagram with the most values there may be in each of its rows."""
    count = 2000
    shares = ", ".join(f"{n / (count - 1):.5f}" for n in range(count))
    values = ", ".join(f"{n % 97}.{n % 10}" for n in range(count))
    text = BASE.replace("[0, 0.5, 1]", f"[{shares}]")
    for row in ("[1, -2.5, -2.5]", "[28, 3.4, -2.5]", "[28, 13, 3.6]", "[1, 1, 3.6]"):
        text = text.replace(row, f"[{values}]")
    file = tmp_path / "a.yaml"
    file.write_text(text, encoding="utf-8")
    assert check(file, "en") == []
