"""One browser for all tests of a process; the pages that they look at."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.page import made
from tests.page.browser import Browser, opened


@pytest.fixture(scope="session")
def only_browser() -> Iterator[Browser]:
    with opened() as found:
        yield found


@pytest.fixture
def browser(only_browser: Browser) -> Iterator[Browser]:
    """The browser for one test; a page left open would go on moving while all other tests run."""
    yield only_browser
    only_browser.rest()


@pytest.fixture(params=made.CASES, scope="module")
def page(request: pytest.FixtureRequest) -> made.Made:
    """The page of each kind of machine; all tests of a module look at one before the next."""
    return made.made(*request.param)
