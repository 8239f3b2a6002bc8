"""Everybody can use the page: by keyboard, without motion, in light and dark, on a phone; axe-core finds no fault."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import api
from reportgen.cases import opened
from reportgen.page import page
from tests.lanes import proof
from tests.page import made
from tests.page.browser import Browser, axe
from tests.report import built

pytestmark = proof

EXERCISE = built.ROOT / "assignments" / "plane-motion" / "05.yaml"
PHONE, DESK = 390, 1440


@pytest.fixture(scope="module")
def exercise(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of an exercise, which has one instant."""
    target = tmp_path_factory.mktemp("exercise") / "page.html"
    target.write_text(page(opened(api.load(EXERCISE))), encoding="utf-8")
    return target


@pytest.mark.parametrize(
    ("file", "width", "dark"),
    [pytest.param(built.SAMPLE, DESK, False, id="light"), pytest.param(built.SLIDE, PHONE, True, id="dark")],
)
def test_axe_finds_no_violation(file: Path, width: int, dark: bool, exercise: Path, browser: Browser) -> None:
    source = axe()
    for shown in (made.made(file, built.own_language(file)).file, exercise):
        browser.show(shown, width, dark=dark, still=True)
        browser.run("document.querySelectorAll('[data-layer]').forEach((box) => { if (!box.checked) box.click(); });")
        assert browser.violations(source) == [], shown.name
        assert browser.messages() == []


def test_nothing_stands_beside_a_phone_s_screen(page: made.Made, browser: Browser) -> None:
    browser.show(page.file, PHONE, 844, still=True)
    assert browser.run("return document.documentElement.scrollWidth") == PHONE
    small = "return parseFloat(getComputedStyle(document.querySelector('main p')).fontSize)"
    assert browser.run(small) >= 14
    browser.run("document.getElementById('keep').click(); document.querySelector('#report h2').scrollIntoView();")
    seen = "return [scrollY, moving.angle(), document.getElementById('angle').getBoundingClientRect().top]"
    scrolled, _, top = browser.run(seen)
    # Kept in view, the panel is there while one reads, and leaves two thirds of the screen.
    assert scrolled > 500
    assert 0 <= top < 844 / 3
    assert browser.run("return document.getElementById('moving').getBoundingClientRect().bottom") <= 844 / 3


def test_on_a_phone_there_is_a_way_back_and_captions_stay_where_they_are(browser: Browser) -> None:
    page = made.made(built.SAMPLE, "vi")
    browser.show(page.file, PHONE, 844, still=True)
    browser.run("document.querySelector('#report h2').scrollIntoView()")
    browser.driver.find_element("css selector", ".back a").click()
    top = "return Math.round(document.getElementById('contents').getBoundingClientRect().top)"
    assert 0 <= browser.run(top) < 100
    places = "return wide.querySelector('caption span').getBoundingClientRect().left"
    browser.run(
        "window.wide = [...document.querySelectorAll('.tabled')]"
        ".find((one) => one.scrollWidth > one.clientWidth + 30 && one.querySelector('caption'))"
    )
    before = browser.run(places)
    browser.run("wide.scrollLeft = 30")
    assert browser.run("return wide.scrollLeft") == 30
    assert browser.run(places) == before
    browser.show(page.file, DESK, 844, still=True)
    assert browser.run("return getComputedStyle(document.querySelector('.back')).display") == "none"


def test_reduced_motion_starts_paused(browser: Browser) -> None:
    file = made.made(built.SAMPLE, "vi").file
    browser.show(file, still=True)
    assert not browser.run("return moving.playing()")
    shown = made.made(built.SAMPLE, "vi").animation
    assert browser.run("return moving.angle()") == pytest.approx(shown.positions[shown.opening][1])
    browser.run("document.getElementById('play').click()")
    assert browser.run("return moving.playing()")


def test_the_keyboard_does_all_that_the_mouse_does(browser: Browser) -> None:
    from selenium.webdriver.common.keys import Keys

    browser.show(made.made(built.SAMPLE, "vi").file, still=True)
    slider = browser.driver.find_element("id", "angle")
    slider.send_keys(Keys.HOME)
    assert browser.run("return moving.angle()") == 0
    slider.send_keys(Keys.ARROW_RIGHT * 3 + Keys.ARROW_LEFT)
    assert browser.run("return moving.angle()") == 2
    slider.send_keys(Keys.PAGE_UP)
    assert browser.run("return moving.angle()") == 45
    assert browser.run("return document.querySelector('[aria-current]').textContent") == "2"
    assert browser.run("return document.getElementById('angle').getAttribute('aria-valuetext')") == "45,0°"
    spot = browser.driver.find_element("css selector", '[data-spot="0"]')
    browser.run("arguments[0].focus()", spot)
    assert browser.run("return !document.getElementById('motion').hidden")
    spot.send_keys(Keys.ENTER)
    assert browser.run("return document.getElementById('point').value") == "0"
    # What has the focus is seen to have it.
    for name in ("play", "keep", "point"):
        browser.driver.find_element("id", name).send_keys(Keys.TAB)
        outline = browser.run("return getComputedStyle(document.activeElement).outlineStyle")
        assert outline == "solid", name


def test_light_or_dark_is_the_reader_s_choice(browser: Browser) -> None:
    browser.show(made.made(built.SAMPLE, "vi").file, dark=True)
    colour = "return getComputedStyle(document.querySelector('main')).backgroundColor"
    dark = browser.run(colour)
    choose = "const s = document.getElementById('theme'); s.value = arguments[0]; s.dispatchEvent(new Event('change'))"
    browser.run(choose, "light")
    assert browser.run(colour) == "rgb(255, 255, 255)" != dark
    browser.run(choose, "")


def test_values_of_a_point_over_the_turn(browser: Browser) -> None:
    """What is saved and copied is the solver's own table."""
    page = made.made(built.SAMPLE, "vi")
    browser.show(page.file, still=True)
    browser.run("const s = document.getElementById('point'); s.value = '1'; s.dispatchEvent(new Event('change'))")
    browser.run(
        "window.saved = []; URL.createObjectURL = (blob) => { blob.text().then((t) => saved.push(t)); return '#'; };"
        "document.getElementById('save').click();"
    )
    rows = browser.driver.execute_async_script("setTimeout(() => arguments[0](saved[0]), 300)").split("\r\n")
    spot = page.animation.panes[0].spots[1]
    assert len(rows) == len(page.animation.knots) + 2
    solved = page.solved(page.animation.knots[:-1]).motion.points[spot.name]
    for index in (0, 17, 200):
        angle, x, y, vx, vy, v, *_ = map(float, rows[index + 1].split(","))
        assert angle == pytest.approx(page.animation.knots[index])
        assert complex(x, y) == pytest.approx(complex(solved.p[index]), rel=1e-5)
        assert complex(vx, vy) == pytest.approx(complex(solved.v[index]), rel=1e-5, abs=1e-5)
        assert v == pytest.approx(abs(complex(vx, vy)), rel=1e-5)
