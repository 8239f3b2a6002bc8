"""Sections of a file of words: found by name, in order, with the line that they begin on."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.base.errors import TemplateError
from reportgen.base.words import find, sections
from reportgen.document import Paragraph, Text
from reportgen.document.template_rendering import Prose


def file_of(folder: Path, text: str) -> Path:
    file = folder / "pump.md"
    file.write_text(text, encoding="utf-8")
    return file


def test_sections_stand_in_the_order_of_the_file(tmp_path: Path) -> None:
    file = file_of(tmp_path, "What this file is.\n\n%% motion\nA crank.\n\nA rod.\n\n\n%% given\n# Task\n%% none\n")
    assert [(name, each.line, each.text) for name, each in sections(file).items()] == [
        ("motion", 3, "A crank.\n\nA rod.\n"),
        ("given", 9, "# Task\n"),
        ("none", 11, "\n"),
    ]


@pytest.mark.parametrize("text", ["", "A note.\n"])
def test_a_file_may_have_no_sections(tmp_path: Path, text: str) -> None:
    assert sections(file_of(tmp_path, text)) == {}


def test_no_file_is_no_section(tmp_path: Path) -> None:
    assert sections(tmp_path / "none.md") == {}
    assert sections(file_of(tmp_path, "") / "none.md") == {}


def test_a_file_of_another_system_reads_the_same(tmp_path: Path) -> None:
    """With a mark of its encoding and other ends of lines, as some editors write them."""
    file = tmp_path / "pump.md"
    file.write_bytes("\ufeff%% given\r\nĐề bài\r\n\r\n%% motion\r\nTay quay".encode())
    assert {name: each.text for name, each in sections(file).items()} == {"given": "Đề bài\n", "motion": "Tay quay\n"}


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("a\n%% given\nb\n%% given\nc\n", 4, "the section given is there already, in line 2"),
        ("%% given\n\n%%\nc\n", 3, "a section has a name"),
        ("%% given\n\n%%  \nc\n", 3, "a section has a name"),
    ],
)
def test_a_fault_of_a_heading_names_file_and_line(tmp_path: Path, text: str, line: int, words: str) -> None:
    with pytest.raises(TemplateError) as caught:
        Prose((file_of(tmp_path, text),)).render("given", {})
    assert f"pump.md:{line}: {words}" in str(caught.value)


def test_what_is_no_text_is_a_fault(tmp_path: Path) -> None:
    (tmp_path / "pump.md").write_bytes(b"%% given\n\xff\n")
    with pytest.raises(TemplateError, match=r"pump\.md:2:1: error\[encoding\]: .*UTF-8"):
        sections(tmp_path / "pump.md")


def test_a_section_that_is_nowhere_is_told_where_it_is_asked_for(tmp_path: Path) -> None:
    prose = Prose((file_of(tmp_path, "%% given\nA.\n\n%% motion\nB.\n{% include 'givne' %}\n"),))
    with pytest.raises(TemplateError, match=r"pump\.md:6: there is no section givne"):
        prose.render("motion", {})


def test_in_a_folder_a_name_may_say_the_file(tmp_path: Path) -> None:
    """`report.md` is the file of names that say none; a single file has whole names as its headings."""
    (tmp_path / "report.md").write_text("%% senses\ncommon\n", encoding="utf-8")
    (tmp_path / "dyads.md").write_text("%% senses\nof a group\n", encoding="utf-8")
    single = file_of(tmp_path, "%% dyads/senses\nof the pump\n")
    names = ("senses", "dyads/senses", "dyads/none")
    found = {places: [find(name, places) for name in names] for places in ((tmp_path,), (single, tmp_path))}
    texts = {len(places): [each and each.text for each in each_found] for places, each_found in found.items()}
    assert texts == {1: ["common\n", "of a group\n", None], 2: ["common\n", "of the pump\n", None]}


def test_sections_of_one_file_are_compiled_apart(tmp_path: Path) -> None:
    prose = Prose((file_of(tmp_path, "%% a\none\n\n%% b\n{% include 'a' %}\ntwo\n"),))
    one, two = Paragraph((Text("one"),)), Paragraph((Text("one two"),))
    assert [prose.render(name, {}) for name in "aba"] == [(one,), (two,), (one,)]
