"""Short words by key."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.base.errors import TemplateError
from reportgen.base.template_folders import search_path
from reportgen.base.words import load_words, words_alone


def test_words_of_a_school_stand_before_the_common_ones(tmp_path: Path) -> None:
    path = search_path("vi", school="school", root=tmp_path)
    *_, common = path
    common.mkdir()
    (tmp_path / "school").mkdir()
    (tmp_path / "school" / "vi.md").write_text(
        "%% foreword\nLời nói đầu\n\n%% words\nfigure: {plan: Sơ đồ}\nstrokes: [Một, Hai]\n", encoding="utf-8"
    )
    (common / "words.yaml").write_text(
        "figure:\n  plan: Họa đồ\n  scheme: Lược đồ\nyes: Có\nstrokes: [Hút, Nén]\n", encoding="utf-8"
    )
    assert load_words(path) == {
        "figure": {"plan": "Sơ đồ", "scheme": "Lược đồ"},
        "yes": "Có",
        "strokes": ["Một", "Hai"],
    }


UNREADABLE = [
    ("x", "1:1: a table"),
    ("- x", "1:1: a table"),
    ("", "1:1: empty"),
    ("a: 1\na: 2\n", "2:1: duplicate-key"),
]


@pytest.mark.parametrize(("text", "place"), UNREADABLE)
def test_what_cannot_be_read_is_a_fault_with_its_place(tmp_path: Path, text: str, place: str) -> None:
    (tmp_path / "words.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(TemplateError) as caught:
        load_words((tmp_path,))
    assert f"words.yaml:{place}" in str(caught.value)


@pytest.mark.parametrize(("text", "place"), UNREADABLE)
def test_a_fault_in_a_section_of_words_has_its_place_in_the_file(tmp_path: Path, text: str, place: str) -> None:
    file = tmp_path / "pump.md"
    file.write_text(f"%% given\n# Assignment\n\n%% words\n{text}", encoding="utf-8")
    line, _, rest = place.partition(":")
    with pytest.raises(TemplateError) as caught:
        load_words((file,))
    assert f"pump.md:{int(line) + 4}:{rest}" in str(caught.value)


def test_a_language_without_words_is_a_fault(tmp_path: Path) -> None:
    with pytest.raises(TemplateError, match=r"there are no words here"):
        load_words((tmp_path,))


def test_words_changed_between_reports_are_read_again(tmp_path: Path) -> None:
    file = tmp_path / "words.yaml"
    file.write_text("yes: Yes\n", encoding="utf-8")
    assert load_words((tmp_path,)) == {"yes": "Yes"}
    file.write_text("yes: Indeed\n", encoding="utf-8")
    assert load_words((tmp_path,)) == {"yes": "Indeed"}


def test_a_topic_adds_words_to_the_common_ones(tmp_path: Path) -> None:
    """They stand behind the common ones, which none of them changes; those of a kind go before both."""
    (tmp_path / "words.yaml").write_text("tables: {lengths: Lengths}\nyes: Yes\n", encoding="utf-8")
    (tmp_path / "topics").mkdir()
    topic = tmp_path / "topics" / "friction.md"
    topic.write_text("%% words\ntables: {wear: Wear, lengths: Other}\nresults: {wear: Wear}\n", encoding="utf-8")
    kind = tmp_path / "catalogue" / "pump.md"
    kind.parent.mkdir()
    kind.write_text("%% words\ntables: {wear: Of pins}\n", encoding="utf-8")
    added = {"tables": {"lengths": "Lengths", "wear": "Wear"}, "yes": "Yes", "results": {"wear": "Wear"}}
    assert load_words((tmp_path,)) == added
    assert load_words((kind, tmp_path)) == {**added, "tables": {"lengths": "Lengths", "wear": "Of pins"}}
    assert words_alone(tmp_path) == {"tables": {"lengths": "Lengths"}, "yes": "Yes"}
