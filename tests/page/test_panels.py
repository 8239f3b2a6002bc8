"""The page of a coursework in a browser: a panel for the machine, one for each part, each moving by itself."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from reportgen.cases import open_case
from reportgen.page import page
from tests.lanes import proof
from tests.page.browser import Browser
from tests.page.made import folder
from tests.page.test_build import LARGEST
from tests.page.test_watch import until, watching

pytestmark = proof

ASSIGNMENTS = Path(__file__).parents[2] / "assignments" / "coursework"
WHOLE = "shaper-whole"
PHONE = 390
DRAWN = """
const root = document.getElementById(arguments[0]), panel = panels.find((one) => one.root === root);
panel.pause();
panel.seek(arguments[1]);
const moved = [...root.querySelectorAll("[data-i]")].map((one) => one.getAttribute("transform"));
return [moved, [...root.querySelectorAll("[data-value]")].map((one) => one.textContent)];
"""
"""Where the items of a panel are at an angle, and its numbers there."""


@cache
def pages() -> dict[str, Path]:
    """The page of the whole coursework, and those of its parts alone, by their names."""
    case = open_case(ASSIGNMENTS / f"{WHOLE}.yaml")
    found = {}
    for name, one in {"": case, **case.parts}.items():
        found[name] = folder() / f"{WHOLE}-{name}.html"
        found[name].write_text(page(one), encoding="utf-8")
    return found


def test_each_part_moves_as_on_a_page_of_its_own(browser: Browser) -> None:
    angles = (0.0, 33.0, 201.5)
    names = {"machine": "moving", "train": "train-moving", "gears": "gears-moving", "cam": "cam-moving"}
    browser.show(pages()[""], still=True)
    assert browser.run("return panels.map((one) => one.root.id)") == list(names.values())
    together = {name: [browser.run(DRAWN, root, angle) for angle in angles] for name, root in names.items()}
    for name, shown in together.items():
        browser.show(pages()[name], still=True)
        assert [browser.run(DRAWN, "moving", angle) for angle in angles] == shown, name
    assert together["cam"][0] != together["cam"][1]


def test_a_panel_is_played_and_moved_without_the_others(browser: Browser) -> None:
    from selenium.webdriver.common.keys import Keys

    browser.show(pages()[""], still=True)
    before = browser.run("return panels.map((one) => one.angle())")
    browser.driver.find_element("id", "cam-angle").send_keys(Keys.HOME + Keys.ARROW_RIGHT)
    assert browser.run("return panels.map((one) => one.angle())") == [*before[:-1], 1]
    browser.driver.find_element("id", "gears-play").click()
    assert browser.run("return panels.map((one) => one.playing())") == [False, False, True, False]
    assert browser.messages() == []


@pytest.mark.parametrize("width", [1440, PHONE])
def test_one_panel_at_a_time_is_kept_in_view(width: int, browser: Browser) -> None:
    browser.show(pages()[""], width, still=True)
    assert browser.run("return document.documentElement.scrollWidth") == width
    for name in ("keep", "cam-keep"):
        browser.run(f"document.getElementById('{name}').click()")
    browser.run("document.querySelector('#report h2').scrollIntoView()")
    assert browser.run("return [...document.querySelectorAll('.held')].map((one) => one.id)") == ["cam-moving"]
    shown = browser.run("return document.getElementById('cam-moving').getBoundingClientRect().toJSON()")
    assert 0 <= shown["top"] < 10
    assert shown["height"] > 100
    browser.run("document.getElementById('cam-keep').click()")
    assert not browser.run("return document.body.classList.contains('kept')")


def test_the_page_is_small() -> None:
    assert pages()[""].stat().st_size < LARGEST


def test_a_changed_part_renews_its_panel_alone(tmp_path: Path, browser: Browser) -> None:
    for name in ("shaper", "feed-cam"):
        (tmp_path / f"{name}.yaml").write_bytes((ASSIGNMENTS / f"{name}.yaml").read_bytes())
    part = tmp_path / "feed-cam.yaml"
    given = part.read_text(encoding="utf-8")
    state = "return document.getElementById('state').textContent"
    angles = "return panels.map((one) => one.angle())"
    swing = "return document.querySelector('#cam-moving [data-value]').textContent"
    with watching(tmp_path / "shaper.yaml") as (address, _):
        browser.show(address, still=True)
        until(lambda: browser.run(state) and "…" not in browser.run(state))
        # The first edition that comes is taken whole.
        part.write_text(given + "# again\n", encoding="utf-8")
        until(lambda: browser.run("return document.querySelectorAll('#cam-moving svg').length > 1"))
        browser.run("panels[0].seek(77); panels[1].seek(90)")
        before = browser.run(swing)
        part.write_text(given.replace("15 deg", "14 deg"), encoding="utf-8")
        until(lambda: browser.run(swing) != before)
        browser.run("window.kept = document.querySelector('#moving svg')")
        part.write_text(given, encoding="utf-8")
        until(lambda: browser.run(swing) == before)
        assert browser.run("return window.kept === document.querySelector('#moving svg')")
        assert browser.run(angles) == [77, 90]
        # A part less is another page.
        whole = (tmp_path / "shaper.yaml").read_text(encoding="utf-8")
        (tmp_path / "shaper.yaml").write_text(whole.partition("parts:")[0], encoding="utf-8")
        until(lambda: browser.run("return typeof panels !== 'undefined' && panels.length === 1"))
        assert browser.run("return panels[0].angle()") == 77
