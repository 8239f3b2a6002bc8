"""What is made ready for all workers of a class."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from reportgen.classes import preload
from reportgen.classes.worker_pool import KINDS
from tests.lanes import matrix

ASKED = (
    "import reportgen.classes.preload\n"
    "from reportgen.base import words\n"
    "from reportgen.document import template_rendering\n"
    "print(template_rendering._environment.cache_info().currsize, words._as_of.cache_info().currsize)"
)


def in_a_server(kinds: str) -> list[int]:
    """How many environments of templates and files of words are read where workers are forked from."""
    surroundings = {**os.environ, KINDS: kinds}
    done = subprocess.run((sys.executable, "-c", ASKED), env=surroundings, capture_output=True, text=True, check=True)
    return list(map(int, done.stdout.split()))


def test_kind_and_language_are_read_off_a_spec_and_off_files(tmp_path: Path) -> None:
    spec = tmp_path / "spec.yaml"
    spec.write_text("kind: shaper\nsalt: 1\nreport:\n  language: en\n", encoding="utf-8")
    assert preload.kinds(spec, None) == {"shaper:en"}
    assert preload.kinds(spec, "vi") == {"shaper:vi"}
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "1.yaml").write_text("kind: four-bar\n", encoding="utf-8")
    (tmp_path / "a" / "2.yaml").write_bytes(b"\xff\xfe kind")
    assert preload.kinds(tmp_path / "a", None) == {"four-bar:vi"}


@pytest.mark.parametrize(
    "kinds", matrix(["slider-crank:vi", "no-such-kind:vi slider-crank:en"], ["no-such-kind:vi slider-crank:en"])
)
def test_words_and_templates_of_the_kinds_are_there(kinds: str) -> None:
    environments, files = in_a_server(kinds)
    assert environments >= 1
    assert files >= 1


def test_nothing_is_read_for_no_kind() -> None:
    assert in_a_server("")[0] == 0
