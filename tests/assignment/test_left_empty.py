"""A key without a value counts as left out, and the check says so: an empty `G2:` would make a rod weightless."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml

from reportgen import catalogue
from tests.kinds import KINDS


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_that_may_be_left_out_is_warned_of_when_it_is_empty(tmp_path: Path, kind: str) -> None:
    """All optional keys of the parameters of a kind that its sample does not have, together."""
    text = catalogue.sample(kind, "en")
    given = yaml.load(text, yaml.BaseLoader)["parameters"]
    fields = catalogue.kind(kind).parameters.model_fields.items()
    empty = [name for name, one in fields if not one.is_required() and name not in given]
    lines = "".join(f"  {name}:\n" for name in empty)
    (file := tmp_path / "given.yaml").write_text(
        re.sub(r"^parameters:.*\n", rf"\g<0>{lines}", text, flags=re.MULTILINE), encoding="utf-8"
    )
    problems = catalogue.examine(file, "en")
    assert [one for one in problems if one.level == "error"] == []
    found = [one.message for one in problems if one.code == "left-empty"]
    assert found == [f"“{name}” has no value and is ignored" for name in empty]


def test_names_for_the_cover_may_stay_empty(tmp_path: Path) -> None:
    (file := tmp_path / "given.yaml").write_text(text := catalogue.sample("slider-crank", "en"), encoding="utf-8")
    assert re.search(r"^  university: +#", text, re.MULTILINE)
    assert catalogue.examine(file, "en") == []
