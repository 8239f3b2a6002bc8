"""Choices that stand on one another are found, however many looks the typesetter would need."""

from __future__ import annotations

import json
import re

import pytest

from reportgen.writers import typst_run

pymupdf = pytest.importorskip("pymupdf")

CHAIN = """\
#set document(date: none)
#let settled = (:)
#for k in range(LENGTH) {
  context {
    let before = query(std.label("c" + str(k - 1))).map(it => it.value).first(default: 0)
    let seen = before + 1
    let choice = settled.at("name " + str(k), default: seen)
    [#metadata(("name " + str(k), choice, seen))<settled>#metadata(choice)#std.label("c" + str(k))#choice \\ ]
  }
}
"""
"""Each number is one more than the one before it on the page; a look finds one of them."""

NEVER = """\
#set document(date: none)
#let settled = (:)
#context {
  let seen = query(<own>).map(it => not it.value).first(default: true)
  let choice = settled.at("a", default: seen)
  [#metadata(("a", choice, seen))<settled>#metadata(choice)<own>#choice]
}
"""
"""What it shows is always the other one."""


def text(pdf: bytes) -> str:
    with pymupdf.open(stream=pdf, filetype="pdf") as document:
        return "".join(page.get_text() for page in document)


@pytest.mark.parametrize("length", [3, 14, 40])
def test_a_chain_of_choices_is_followed_to_its_end(length: int) -> None:
    unsettled = CHAIN.replace("LENGTH", str(length))
    source, pdf = typst_run.settle(unsettled)
    assert [int(number) for number in re.findall(r"\d+", text(pdf))] == list(range(1, length + 1))
    # The source says what it needed: by itself it comes to the same pages.
    assert typst_run.compile(source) == pdf
    found = re.search(r"#let settled = \((.*)\)", source)
    assert found is not None
    chosen = json.loads("{" + found[1].strip(",:") + "}")
    assert all(chosen[f"name {k}"] == k + 1 for k in range(len(chosen)))
    # What the typesetter settles by itself is not told.
    assert len(chosen) == (length if length > 5 else 0)


def test_what_never_settles_comes_to_pages_too() -> None:
    source, pdf = typst_run.settle(NEVER)
    assert "settled = (" in source
    assert text(pdf).strip() in {"true", "false"}
