"""What tests share: reports built once a run, and the option that renews snapshots."""

from __future__ import annotations

import pytest

from tests.reports import built


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-snapshots", action="store_true", help="Write tests/snapshots anew.")


@pytest.fixture(params=built.CASES)
def report(request: pytest.FixtureRequest) -> built.Report:
    """Each assignment file of the repository with each writer in each language."""
    return built.report(*request.param)


@pytest.fixture(params=built.PAIRS)
def pair(request: pytest.FixtureRequest) -> tuple[built.Report, built.Report]:
    """The reports of both writers on one assignment file in one language: (typst, latex)."""
    path, language = request.param
    return built.report(path, "typst", language), built.report(path, "latex", language)


@pytest.fixture(params=built.WRITTEN)
def written(request: pytest.FixtureRequest) -> built.Written:
    """The tree of each assignment file in each language."""
    return built.written(*request.param)
