"""Wrong files: every fault is found in one run, where it stands, under its code, in words of both languages."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.errors import NotOfferedError, Problem
from reportgen.base.units import Language
from reportgen.catalogue import check, load
from tests.broken.rows import FILES, Row, base, rows
from tests.lanes import matrix

LANGUAGES: tuple[Language, ...] = ("vi", "en")
ROWS = list(rows())
LONG = "slider-crank: a machine that does not start"
"""Its motion is sought for seconds."""
TURNS = [(row, "en" if row.told else LANGUAGES[number % 2]) for number, row in enumerate(ROWS) if row.name != LONG]
"""Each row in one language: in English where words are expected, else by turns."""


def put(folder: Path, content: bytes | str) -> Path:
    file = folder / "a.yaml"
    file.write_bytes(content.encode() if isinstance(content, str) else content)
    return file


def faults(problems: list[Problem]) -> tuple[str, ...]:
    return tuple(f"{one.location.line}:{one.location.column} {one.code}" for one in problems)


@pytest.mark.parametrize(
    ("row", "language"),
    matrix([pytest.param(row, one, id=f"{row.name}-{one}") for row in ROWS for one in LANGUAGES], TURNS),
)
def test_every_row(tmp_path: Path, row: Row, language: Language) -> None:
    file = put(tmp_path, row.content)
    found = check(file, language)
    assert faults(found) == row.faults
    for one in found:
        assert str(one).startswith(f"{file}:{one.location.line}:{one.location.column}: error[{one.code}]: ")
        # Every gap of a sentence is filled; a list of keys may be quoted from the file.
        assert "{" not in one.message.replace("{a: b}", "")
    told = "\n".join(str(one) for one in found)
    assert language != "en" or [words for words in row.told if words not in told] == []


@pytest.mark.parametrize("file", sorted(FILES.glob("*.yaml")), ids=lambda file: file.stem)
def test_the_files_that_rows_start_from_are_right(file: Path) -> None:
    assert check(file) == []


def test_faults_are_told_in_the_language_of_the_file(tmp_path: Path) -> None:
    wrong = base("four-bar").replace("BC: 340 mm", "BC: 340")
    told = [
        check(put(tmp_path, wrong.replace("language: en", f"language: {language}")))[0].message
        for language in LANGUAGES
    ]
    assert told == [check(put(tmp_path, wrong), language)[0].message for language in LANGUAGES]
    assert told[0] != told[1]


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    assert faults(check(tmp_path / "none.yaml", "en")) == ("1:1 unreadable",)
    assert faults(check(tmp_path, "en")) == ("1:1 unreadable",)


def test_what_is_not_offered_is_told_in_one_line(tmp_path: Path) -> None:
    """Positions need a machine; a solution steps that are known: a disc on a plate that turns has none."""
    rods = FILES / "plane-motion.yaml"
    with pytest.raises(NotOfferedError, match="--positions"):
        api.solve(load(rods, "en"), 12)
    with pytest.raises(NotOfferedError, match="plane-motion"):
        api.analyse(load(rods, "en"))
    plate = FILES / "plane-motion-plate.yaml"
    with pytest.raises(NotOfferedError, match=r"a\.M"):
        api.document(load(plate, "en"))
    assert api.solve(load(plate))["positions"][0]["points"]["M"]["a"] is not None
