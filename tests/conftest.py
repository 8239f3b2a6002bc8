"""Shared fixtures: reports built once per run, and the option that renews snapshots.

With several processes (`-n 2`) all tests whose parameters name one assignment file are run by one of them, so that its
reports are made once; the others go by their own file.
"""

from __future__ import annotations

import gc
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings
from xdist.scheduler import LoadScopeScheduling

from reportgen.base import process_limits
from reportgen.cli import COLLECTED
from tests.report import built

# As commands have it: what tests share lasts, and there is ever more of it to be looked through.
gc.set_threshold(COLLECTED)
# What is kept between runs is kept here for all processes of the tests, not in the home of whoever runs them.
os.environ["XDG_CACHE_HOME"] = str(Path(__file__).resolve().parents[1] / ".pytest_cache" / "kept")

# A change is judged by the same examples wherever it is tried; `--hypothesis-profile explore` looks for new ones.
settings.register_profile("same", derandomize=True)
settings.register_profile("explore", derandomize=False)
settings.load_profile("same")

STEM = re.compile("|".join(rf"\b{path.stem}\b" for path in built.FILES))


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-snapshots", action="store_true", help="Write tests/snapshots anew.")


class ByAssignment(LoadScopeScheduling):
    """A scheduler that runs the tests of one assignment file together."""

    def _split_scope(self, nodeid: str) -> str:
        file, _, parameters = nodeid.partition("[")
        named = STEM.search(parameters)
        return named[0] if named else file.partition("::")[0]


def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> ByAssignment:
    return ByAssignment(config, log)


@pytest.fixture(autouse=True)
def _surroundings() -> Iterator[None]:
    """Restore the environment after each test: a command leaves its language and its school's folder there."""
    kept = dict(os.environ)
    yield
    if os.environ != kept:
        os.environ.clear()
        os.environ.update(kept)


@pytest.fixture(params=built.CASES)
def report(request: pytest.FixtureRequest) -> built.Report:
    """Return the report of each assignment file of the repository, with each writer in each language."""
    return built.report(*request.param)


@pytest.fixture(params=built.PAIRS)
def pair(request: pytest.FixtureRequest) -> tuple[built.Report, built.Report]:
    """Return the reports of both writers on one assignment file in one language: (typst, latex)."""
    path, language = request.param
    return built.report(path, "typst", language), built.report(path, "latex", language)


@pytest.fixture(params=built.WRITTEN)
def written(request: pytest.FixtureRequest) -> built.Written:
    """Return the tree of each assignment file in each language."""
    return built.written(*request.param)


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Render a school's words in this process, as in one that is already bounded.

    For tests of what the words do; those of the bounds have the process that users have.
    """
    monkeypatch.setattr(process_limits, "_bounded", True)
