"""What a student types is printed as typed, whatever it means to a typesetter or to a template."""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from reportgen import api
from reportgen.assignment.common import ReportSection, Student
from reportgen.base.records import field_names, replace
from reportgen.document import Section
from tests.report import built, pages
from tests.report.built import Written

pytest.importorskip("pymupdf")

HOSTILE = (
    "A_B & 100% #1 $x$ \\input{/etc/passwd} *y* {{ 7*7 }}",
    '{% raw %} #import "x" #{1+1} @k <k> `c` ~ ^^41 \\\\ //',
    "Đỗ Thị Hòa – “Ünïcode” Čapek & søn [1] | (2) --- ''",
)
FIELDS = ("university", "faculty", "department", "course", "supervisor", "place")


def quoted(text: str) -> str:
    return "'" + text.replace("'", "''") + "'"


def assignment_with(folder: Path, text: str) -> Path:
    """The engine's sample with a text in every field of `report:` that takes one, each marked by its name."""
    sample = (built.ROOT / "assignments" / "engine-twin-05.yaml").read_text(encoding="utf-8")
    before, _, rest = sample.partition("report:\n")
    after = rest.partition("\npositions:")[2]
    lines = [f"  {name}: {quoted(f'{name} {text}')}" for name in FIELDS]
    lines += ["  student:"]
    lines += [f"    {name}: {quoted(f'{name} {text}')}" for name in student_fields()]
    file = folder / "hostile.yaml"
    file.write_text(
        f"{before}report:\n  date: 2011-03-24\n" + "\n".join(lines) + f"\n\npositions:{after}", encoding="utf-8"
    )
    return file


def student_fields() -> list[str]:
    return [field.alias or name for name, field in Student.model_fields.items()]


def test_every_field_that_takes_a_text_is_tried() -> None:
    others = {
        "language",
        "extent",
        "school",
        "templates",
        "font",
        "size",
        "student",
        "date",
        "worked_positions",
        "sheets",
        "listing",
    }
    assert set(ReportSection.model_fields) - others == set(FIELDS)


def strings(node: Any) -> list[str]:
    """Every string of a tree of dataclasses and tuples."""
    if isinstance(node, str):
        return [node]
    if isinstance(node, tuple | list):
        return [text for item in node for text in strings(item)]
    return [text for name in field_names(type(node)) for text in strings(getattr(node, name))]


@cache
def hostile(text: str) -> Written:
    with tempfile.TemporaryDirectory() as folder:
        return built.compose(api.load(assignment_with(Path(folder), text)))


@pytest.mark.parametrize("text", HOSTILE)
def test_names_reach_the_tree_as_typed(text: str) -> None:
    found = "\n".join(strings(hostile(text).document))
    for name in (*FIELDS, *student_fields()):
        assert f"{name} {text}" in found, name


@pytest.mark.parametrize("engine", built.ENGINE_CASES)
@pytest.mark.parametrize("text", HOSTILE)
def test_names_are_printed_as_typed(engine: api.Engine, text: str) -> None:
    """On the cover, in the running header and in the PDF's own data; what follows the task is left out."""
    whole = hostile(text)
    blocks = whole.document.blocks
    _, second, *_ = (i for i, block in enumerate(blocks) if isinstance(block, Section) and block.level == 1)
    front = blocks[:second]
    report = built.typeset(replace(whole, document=replace(whole.document, blocks=front)), engine)
    cover = pages.text(report.pages[0].glyphs)
    for name in (*FIELDS, *student_fields()):
        assert pages.squash(f"{name} {text}") in cover, name
    header = pages.text(report.pages[1].glyphs)
    assert pages.squash(f"course {text}") in header
    assert report.opened.metadata["author"] == f"name {text}"
    assert report.overfull == ()
    assert [fault for page in report.pages for fault in pages.overlaps(page, pages.INK)] == []
