"""What is made ready for all workers of a class."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from reportgen.base.process_limits import ONE_THREAD
from reportgen.classes import preload
from reportgen.classes.worker_pool import SAMPLES

ASKED = (
    "import os, sys\n"
    "import reportgen.classes.preload\n"
    "from reportgen.base import words\n"
    "from reportgen.document import template_rendering\n"
    "print(template_rendering._environment.cache_info().currsize, words._as_of.cache_info().currsize)\n"
    "print(len(os.listdir('/proc/self/task')) if os.path.isdir('/proc/self/task') else 1, *sys.modules)"
)


def in_a_server(samples: str) -> list[int]:
    """How many environments of templates, files of words and threads there are where workers are forked from."""
    return list(map(int, _answer(samples)[:3]))


def loaded_in_a_server(samples: str) -> list[str]:
    return _answer(samples)[3:]


def _answer(samples: str) -> list[str]:
    surroundings = {**os.environ, **ONE_THREAD, SAMPLES: samples}
    done = subprocess.run((sys.executable, "-c", ASKED), env=surroundings, capture_output=True, text=True, check=True)
    return done.stdout.split()


def test_kind_and_language_are_read_off_a_spec_and_off_files(tmp_path: Path) -> None:
    spec = tmp_path / "spec.yaml"
    spec.write_text("kind: shaper\nsalt: 1\nreport:\n  language: en\n", encoding="utf-8")
    assert preload.samples(spec, None, "typst", ("task", "key")) == {"shaper:en:typst:task", "shaper:en:typst:key"}
    assert preload.samples(spec, "vi", "latex", ("docx", "page")) == {"shaper:vi:latex:"}
    spec.write_text("kind: atlas/jaw-crusher\n", encoding="utf-8")
    assert preload.samples(spec, "vi", "typst", ("report",)) == {"atlas/jaw-crusher:vi:typst:report"}
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "1.yaml").write_text("kind: four-bar\n", encoding="utf-8")
    (tmp_path / "a" / "2.yaml").write_bytes(b"\xff\xfe kind")
    assert preload.samples(tmp_path / "a", None, "typst", ("report",)) == {"four-bar:vi:typst:report"}


@pytest.mark.parametrize(
    ("engine", "product"), [*(("typst", product) for product in (*preload.TYPESET, "")), ("latex", "report")]
)
def test_words_and_templates_of_the_kinds_are_there(engine: str, product: str) -> None:
    """No typesetter runs where workers are forked from: its threads are not copied."""
    environments, files, threads = in_a_server(f"no-such-kind:vi:typst: slider-crank:en:{engine}:{product}")
    assert environments >= (product in ("report", ""))
    assert files >= 1
    assert threads == 1


def test_what_a_product_needs_is_loaded() -> None:
    assert "openpyxl" in loaded_in_a_server("slider-crank:en:typst:task")
    assert "openpyxl" not in loaded_in_a_server("slider-crank:en:typst:report")


def test_nothing_is_read_for_no_kind() -> None:
    assert in_a_server("")[0] == 0
