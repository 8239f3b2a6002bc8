"""A command that may have little memory says so, whatever ends it: a library in C, Rust or Python."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.lanes import matrix

resource = pytest.importorskip("resource")
ROOT = Path(__file__).parents[2]


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="a system that does not bound addresses")
@pytest.mark.parametrize("megabytes", matrix((60, 100, 150, 200, 250, 300, 350), telling=(150, 300)))
def test_too_little_memory_is_told(megabytes: int, tmp_path: Path) -> None:
    """What is too little depends on the machine: there is a report, or a line that says why there is none."""
    most = megabytes * 1_000_000
    done = subprocess.run(
        (sys.executable, "-m", "reportgen.cli", "build", "assignments/slider-crank-02.yaml", "--out", str(tmp_path)),
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (most, most)),
    )
    if done.returncode == 0:
        assert (tmp_path / "slider-crank-02" / "report.pdf").exists()
    else:
        assert done.returncode == 3
        assert "memory" in done.stderr.splitlines()[-1]
        assert "Traceback" not in done.stderr
