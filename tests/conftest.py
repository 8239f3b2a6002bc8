"""What tests share: reports built once a run, and the option that renews snapshots.

With several processes (`-n 2 --dist loadgroup`) all tests of one assignment file are run by one of them, so that
its reports are made once; other tests go by their own file.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.reports import built

STEMS = {name: path.stem for path in built.FILES for name in (path, path.stem)}


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-snapshots", action="store_true", help="Write tests/snapshots anew.")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if item.get_closest_marker("xdist_group") is None:
            item.add_marker(pytest.mark.xdist_group(assignment_of(item) or item.nodeid.partition("::")[0]))


def assignment_of(item: pytest.Item) -> str:
    """The assignment file of the repository that a test is run with, by its stem."""
    parameters = (
        item.callspec.params.values() if isinstance(item, pytest.Function) and hasattr(item, "callspec") else ()
    )
    values = (value for one in parameters for value in (one if isinstance(one, tuple) else (one,)))
    return next((STEMS[value] for value in values if isinstance(value, Path | str) and value in STEMS), "")


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
