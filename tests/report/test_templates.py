"""What templates are made of: words, names and few conditions; lists of ids stand on a machine's sheet."""

from __future__ import annotations

import re
from typing import Any

import pytest
from jinja2 import Environment, nodes

from reportgen.base.kinds import SAMPLE
from reportgen.base.template_folders import languages, templates
from reportgen.base.words import SECTION, sections

ROOT = templates()
FILES = sorted(str(path.relative_to(ROOT)) for path in ROOT.rglob("*.md"))
PARTS = {"dyads", "comments", "steps"}
"""The files whose sections are asked for with the file's name before theirs."""


def parsed(file: str) -> list[nodes.Template]:
    """The sections of a file that are templates."""
    found = sections(ROOT / file)
    return [Environment().parse(each.text) for name, each in found.items() if name not in {SECTION, SAMPLE}]


def each_of(file: str, *kinds: type[nodes.Node]) -> list[Any]:
    return [each for template in parsed(file) for kind in kinds for each in template.find_all(kind)]


@pytest.mark.parametrize("file", FILES)
def test_no_template_lists_ids(file: str) -> None:
    """Which lines belong together is said where they are written, by `Calculation.set_out`."""
    lists = each_of(file, nodes.List, nodes.Tuple)
    assert [each for each in lists if any(isinstance(item, nodes.Const) for item in each.items)] == []


@pytest.mark.parametrize("file", FILES)
def test_a_condition_is_a_name(file: str) -> None:
    """What is compared or counted has a name of its own in the report, or its words stand under a key."""
    conditions = [each.test for each in each_of(file, nodes.If, nodes.CondExpr)]
    reckoning = (nodes.Compare, nodes.And, nodes.Or, nodes.Filter, nodes.Test)
    assert [each for each in conditions if isinstance(each, reckoning) or any(each.find_all(reckoning))] == []


@pytest.mark.parametrize("language", languages())
def test_every_section_is_asked_for(language: str) -> None:
    """By an outline or the code, which name it in a string, or by another section, whose key may end its name."""
    code = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT.parent / "reportgen").rglob("*.py"))
    files = sorted((ROOT / language).rglob("*.md"))
    included = [each for file in files for each in each_of(str(file.relative_to(ROOT)), nodes.Include)]
    # A part that not every report has is named where it is asked for, and where it is left out.
    asked = [each for each in included if not isinstance(each.template, nodes.Name)]
    patterns = [pattern_of(each) for each in asked]
    names = {name if file.stem not in PARTS else f"{file.stem}/{name}" for file in files for name in sections(file)}
    assert [
        name
        for name in sorted(names)
        if f'"{name}"' not in code and not any(re.fullmatch(pattern, name) for pattern in patterns)
    ] == []


def pattern_of(include: nodes.Node) -> str:
    """What the name of an included section looks like, with anything in the place of a key."""
    assert isinstance(include, nodes.Include)
    parts = include.template.nodes if isinstance(include.template, nodes.Concat) else [include.template]
    return "".join(re.escape(part.value) if isinstance(part, nodes.Const) else r"[\w-]+" for part in parts)
