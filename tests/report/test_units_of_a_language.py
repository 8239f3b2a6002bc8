"""A report has its units in its language wherever one stands: behind numbers, in tables, at axes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from reportgen.document import Figure, Plate, lines_of
from reportgen.drawing import Label
from reportgen.formula.plain_text import formula
from tests.lanes import matrix
from tests.report import built

LATIN = r"(?:k?N|mm|cm|m|kg|rad|rpm|J|W|s)(?![\w_^=])"
"""Units as they are written in English."""
SPOILT = re.compile(rf"(?:\d\s|\(){LATIN}|(?:^|[|,] )(?:mm|cm|kg|rad|rpm|m/s|N·m)(?![\w_])")
"""Behind a number, in parentheses, at the head of a column."""
FILES = matrix(built.TYPESET, telling=[built.SAMPLE])


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_units_are_in_the_language_of_the_report(path: Path) -> None:
    written = built.written(path, "ru")
    document = written.document
    for block in built.walk(document.blocks):
        for line in lines_of(block, document):
            assert SPOILT.findall(line) == [], line
        scenes = block.scenes if isinstance(block, Figure) else (block.scene,) if isinstance(block, Plate) else ()
        for item in (item for scene in scenes for item in scene.items if isinstance(item, Label)):
            said = item.content if isinstance(item.content, str) else formula(item.content, "ru")
            assert SPOILT.findall(said) == [], said
