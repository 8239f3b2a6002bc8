"""Files made to keep the reader busy, each just under the size limit, are judged; `make bench` says how soon."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.base.yaml_source import LARGEST, MOST_FAULTS
from reportgen.catalogue import check
from tests.broken.endless import ENDLESS, endless
from tests.broken.rows import base
from tests.lanes import matrix


@pytest.mark.parametrize("name", matrix(ENDLESS, [*ENDLESS][::3]))
def test_any_file_is_judged_and_few_faults_are_told(tmp_path: Path, name: str) -> None:
    file = tmp_path / "a.yaml"
    file.write_text(endless(name, LARGEST), encoding="utf-8")
    assert 0 < len(check(file, "en")) <= MOST_FAULTS


def test_the_longest_honest_file_is_read(tmp_path: Path) -> None:
    """A diagram with the most values there may be in each of its rows."""
    count = 2000
    shares = ", ".join(f"{n / (count - 1):.5f}" for n in range(count))
    values = ", ".join(f"{n % 97}.{n % 10}" for n in range(count))
    text = base("engine-twin").replace("[0, 0.5, 1]", f"[{shares}]")
    for row in ("[1, -2.5, -2.5]", "[28, 3.4, -2.5]", "[28, 13, 3.6]", "[1, 1, 3.6]"):
        text = text.replace(row, f"[{values}]")
    file = tmp_path / "a.yaml"
    file.write_text(text, encoding="utf-8")
    assert check(file, "en") == []
