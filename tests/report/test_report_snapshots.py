"""What changed, to look at: the whole text of the sample, and the sources of one short section.

`pytest tests/report --update-snapshots` writes them anew; their differences are for review.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.document import Block, Document, Section, text_of
from tests.report import built

FOLDER = built.ROOT / "tests" / "snapshots"
SAMPLE = built.SAMPLE
SECTION = "1.3"
"""Synthesis: a section with words, worked lines and a table, and no drawing."""


def compare(name: str, text: str, request: pytest.FixtureRequest) -> None:
    file = FOLDER / name
    if request.config.getoption("--update-snapshots"):
        file.write_text(text, encoding="utf-8")
    assert text == file.read_text(encoding="utf-8"), f"{name} differs; look, then --update-snapshots"


@pytest.mark.parametrize("language", built.LANGUAGES, ids=lambda language: f"{SAMPLE.stem}-{language}")
def test_text_of_the_sample(language: Language, request: pytest.FixtureRequest) -> None:
    compare(f"{SAMPLE.stem}-{language}.txt", text_of(built.written(SAMPLE, language).document), request)


def section(document: Document, number: str) -> tuple[Block, ...]:
    """The blocks from a section's heading to the next of its level or above."""
    blocks = document.blocks
    start = next(i for i, block in enumerate(blocks) if isinstance(block, Section) and block.number == number)
    level = number.count(".") + 1
    end = next(i for i, block in enumerate(blocks) if i > start and isinstance(block, Section) and block.level <= level)
    return blocks[start:end]


@pytest.mark.parametrize("engine", built.ENGINES, ids=lambda engine: f"{SAMPLE.stem}-{engine}")
def test_source_of_a_section(engine: api.Engine, request: pytest.FixtureRequest) -> None:
    from reportgen.writers import latex, typst

    document = built.written(SAMPLE, "vi").document
    writer = latex if engine == "latex" else typst
    source = writer.write(replace(document, blocks=section(document, SECTION)))
    # What stands before is the frame, which is a file of its own.
    _, _, body = source.partition("\\begin{document}\n" if engine == "latex" else "#show: report.with")
    compare(f"synthesis{api.SUFFIX[engine]}", body, request)


def test_snapshots_are_all_compared() -> None:
    names = {f"{SAMPLE.stem}-{language}.txt" for language in built.LANGUAGES}
    names |= {f"synthesis{api.SUFFIX[engine]}" for engine in built.ENGINES}
    assert {path.name for path in Path(FOLDER).iterdir()} == names
