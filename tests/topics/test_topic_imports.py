"""A machine imports the topics that its file asks for, and no other."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from reportgen.base.topics import topics
from tests.lanes import matrix

ROOT = Path(__file__).parents[2]
ASKED = {
    "assignments/engine-twin-05.yaml": set(),
    "assignments/shaper-friction.yaml": {"friction"},
    "tests/friction/motion.yaml": {"friction", "flywheel", "motion"},
}
PROGRAM = """
import sys
from reportgen.cases import open_case
case = open_case(sys.argv[1])
case.document(), case.entries, case.plates()
print(*sorted({name.split(".")[1] for name in sys.modules if name.startswith("reportgen.")}))
"""


@pytest.mark.parametrize("file", matrix(ASKED, telling=["assignments/engine-twin-05.yaml"]))
def test_only_topics_that_are_asked_for_are_imported(file: str) -> None:
    """In a process of its own: report, results and drawing sheets."""
    done = subprocess.run([sys.executable, "-c", PROGRAM, file], cwd=ROOT, capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) & set(topics()) == ASKED[file]
