"""Saving a drawing of a page: a file of its own, true to scale, in light colours whatever the page shows."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import pytest

from reportgen.base.words import templates
from tests.lanes import proof
from tests.page.browser import Browser
from tests.page.made import Made, made
from tests.report import built

SAVED = """
const [place, kind, done] = arguments, made = URL.createObjectURL, click = HTMLAnchorElement.prototype.click;
HTMLAnchorElement.prototype.click = function () { name = this.download; };
let name = "";
URL.createObjectURL = (blob) => {
  URL.createObjectURL = made;
  setTimeout(() => { HTMLAnchorElement.prototype.click = click; }, 50);
  blob.arrayBuffer().then(async (bytes) => {
    const size = kind === "png" ? await createImageBitmap(blob).then((image) => [image.width, image.height]) : [];
    done([name, kind === "svg" ? new TextDecoder().decode(bytes) : "", size]);
  });
  return made(blob);
};
document.querySelector(`${place} [data-save=${kind}]`).click();
"""
"""The name of what a button below a drawing saves, its text, its size in dots."""


@pytest.fixture(scope="module")
def page() -> Made:
    """All pages have one script: one is enough."""
    return made(built.SAMPLE, "vi")


@pytest.fixture
def opened(page: Made, browser: Browser) -> Iterator[Browser]:
    browser.show(page.file)
    browser.run("moving.pause(); document.documentElement.dataset.theme = 'dark';")
    yield browser
    browser.run("delete document.documentElement.dataset.theme")


def saved(browser: Browser, place: str, kind: str) -> tuple[str, str, list[Any]]:
    name, text, size = browser.driver.execute_async_script(SAVED, place, kind)
    return name, text, size


def test_the_script_is_short() -> None:
    assert (templates() / "frames" / "html" / "save.js").stat().st_size <= 2048


@proof
def test_a_figure_is_saved_as_it_stands(opened: Browser) -> None:
    (key,) = opened.run("return [document.querySelector('figure[id^=\"k-fig.v.\"]:has(svg)').id]")
    place = f"[id='{key}']"
    name, text, _ = saved(opened, place, "svg")
    assert re.fullmatch(r"v\.[\w.]+(-\d+)?\.svg", name)
    width, height = re.search(r'width="([\d.]+)mm" height="([\d.]+)mm"', text).groups()  # type: ignore[union-attr]
    assert "class=" not in text
    assert 'stroke="rgb(0, 0, 0)"' in text
    assert 'xmlns="http://www.w3.org/2000/svg"' in text
    # The page is as dark as before.
    assert opened.run("return document.documentElement.dataset.theme") == "dark"
    name, _, size = saved(opened, place, "png")
    assert name.endswith(".png")
    # Dots of 300 an inch, cut to whole ones.
    assert size == pytest.approx([float(side) * 300 / 25.4 for side in (width, height)], abs=1)


@proof
def test_what_moves_is_saved_at_its_moment(opened: Browser) -> None:
    texts = []
    for angle in (10, 100):
        opened.run("moving.seek(arguments[0])", angle)
        name, text, _ = saved(opened, "[data-stage=machine]", "svg")
        assert name == "machine.svg"
        texts.append(text)
    assert texts[0] != texts[1]
    assert "spot" not in texts[0]
    assert opened.messages() == []
