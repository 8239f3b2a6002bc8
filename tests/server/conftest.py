"""A class of three students, made once; each test gets its own copy, served without a network."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.server.served import Served, begun


@pytest.fixture(scope="session")
def made_class(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return begun(tmp_path_factory.mktemp("class") / "class")


@pytest.fixture
def served(made_class: Path, tmp_path: Path) -> Iterator[Served]:
    with Served.copied(made_class, tmp_path / "class") as one:
        yield one
