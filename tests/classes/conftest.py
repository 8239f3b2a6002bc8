"""Files that a test writes."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.classes.specs import Put


@pytest.fixture
def put_file(tmp_path: Path) -> Put:
    def write(content: str | bytes, name: str = "spec.yaml") -> Path:
        path = tmp_path / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write
