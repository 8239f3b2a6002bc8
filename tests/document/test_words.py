"""Short words by key."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.document.words import load_words
from reportgen.errors import TemplateError


def test_words_of_a_school_stand_before_the_common_ones(tmp_path: Path) -> None:
    own, common = tmp_path / "own", tmp_path / "common"
    for directory, text in (
        (own, "figure: {plan: Sơ đồ}\n"),
        (common, "figure:\n  plan: Họa đồ\n  scheme: Lược đồ\nyes: Có\n"),
    ):
        directory.mkdir()
        (directory / "words.yaml").write_text(text, encoding="utf-8")
    assert load_words((own, common)) == {"figure.plan": "Sơ đồ", "figure.scheme": "Lược đồ", "yes": "Có"}


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("a: b\nc: [d]\n", "2:4: c"),
        ("a:\n  b:\n", "2:5: a.b"),
        ("x", "1:1: this"),
        ("a: 1\na: 2\n", "2:1: dup"),
    ],
)
def test_what_is_not_a_word_is_a_fault_with_its_place(tmp_path: Path, text: str, place: str) -> None:
    (tmp_path / "words.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(TemplateError) as caught:
        load_words((tmp_path,))
    assert f"words.yaml:{place}" in str(caught.value)


def test_a_language_without_words_is_a_fault(tmp_path: Path) -> None:
    with pytest.raises(TemplateError, match=r"words\.yaml: the file is missing"):
        load_words((tmp_path,))
