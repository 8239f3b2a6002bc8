"""The files that a product is made of, besides its assignment file."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from reportgen.assignment.reading import inputs

COURSEWORKS = Path(__file__).parents[2] / "assignments" / "coursework"
SCHOOL = Path(__file__).parents[2] / "templates" / "sample-school"


@pytest.mark.parametrize("codec", ["utf-8", "utf-16"])
def test_parts_and_words_of_a_school_are_among_them(tmp_path: Path, codec: str) -> None:
    """Whatever encoding an editor has saved the file in."""
    shutil.copy(COURSEWORKS / "valve-cam.yaml", tmp_path)
    shutil.copytree(SCHOOL, tmp_path / "words")
    text = (COURSEWORKS / "engine-twin.yaml").read_text(encoding="utf-8")
    file = tmp_path / "engine-twin.yaml"
    assert "\nreport:\n" in text
    file.write_text(text.replace("\nreport:\n", "\nreport:\n  templates: words\n"), encoding=codec)
    content, named = inputs(file)
    assert content == file.read_bytes()
    assert {"valve-cam.yaml", "words/vi.md", "words/en.md"} <= named.keys()
    assert named["words/vi.md"] == (SCHOOL / "vi.md").read_bytes()


def test_a_file_that_names_no_other_stands_alone() -> None:
    assert inputs(COURSEWORKS / "valve-cam.yaml")[1] == {}
