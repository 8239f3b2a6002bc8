"""What templates are made of: words, names and few conditions; lists of ids stand on a machine's sheet."""

from __future__ import annotations

import pytest
from jinja2 import Environment, nodes

from reportgen.words import templates

ROOT = templates()
NAMES = sorted(str(path.relative_to(ROOT)) for path in ROOT.rglob("*.md"))


def parsed(name: str) -> nodes.Template:
    return Environment().parse((ROOT / name).read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", NAMES)
def test_no_template_lists_ids(name: str) -> None:
    """Which lines belong together is said where they are written, by `Sheet.set_out`."""
    lists = [each for kind in (nodes.List, nodes.Tuple) for each in parsed(name).find_all(kind)]
    assert [each for each in lists if any(isinstance(item, nodes.Const) for item in each.items)] == []


@pytest.mark.parametrize("name", NAMES)
def test_a_condition_is_a_name(name: str) -> None:
    """What is compared or counted has a name of its own in the report, or its words stand under a key."""
    conditions = [each.test for kind in (nodes.If, nodes.CondExpr) for each in parsed(name).find_all(kind)]
    reckoning = (nodes.Compare, nodes.And, nodes.Or, nodes.Filter, nodes.Test)
    assert [each for each in conditions if isinstance(each, reckoning) or any(each.find_all(reckoning))] == []
