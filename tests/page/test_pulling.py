"""Points of the machine are pulled in a browser, with the mouse and with fingers, and given back."""

from __future__ import annotations

import cmath
import math
from itertools import pairwise
from pathlib import Path
from threading import Event
from typing import Any
from unittest.mock import Mock

import pytest

from tests.lanes import proof
from tests.page.browser import Browser
from tests.page.hand import READY, TOLD, hand_on
from tests.page.typist import PATIENCE, Typist, edit_beside, until

KNOB = """
const { left, top, width, height } = document.querySelector(".handle circle").getBoundingClientRect();
return [left + width / 2, top + height / 2];
"""
SHADED = "return document.querySelector('.region')?.getBoundingClientRect().width > 20"
REGION = "return document.querySelector('.region')?.getAttribute('d')"
RECORD = """
window.seen = [];
const record = () => {
  seen.push(new DOMPoint(...pulls.at("C")).matrixTransform(pulls.svg().getScreenCTM()).x);
  requestAnimationFrame(record);
};
record();
"""
"""Note where C is on the screen (px) at each frame."""
RENEWED = "return document.body.dataset.moving !== arguments[0]"
LOCK = "return document.getElementById('f:parameters.BC').parentElement.querySelector('.lock')"
TIP = """
const place = pulls.placeOf({ load: arguments[0] });
if (!place) return null;
const { x, y } = new DOMPoint(...place).matrixTransform(pulls.svg().getScreenCTM());
return [x, y];
"""
SHOW_LOADS = "document.querySelector('[data-layer=loads]').click()"
BC, CD = "f:parameters.BC", "f:parameters.CD"


@proof
def test_a_pin_changes_its_lengths_and_esc_takes_them_back(browser: Browser, tmp_path: Path) -> None:
    """The fields follow, nothing is written before the release, and one Undo takes all of it back."""
    with hand_on(browser, "four-bar-01.yaml", tmp_path) as hand:
        before, values, here = hand.file.read_bytes(), hand.values(), hand.at("C")
        hand.press(here)
        hand.move((24, -18))
        until(lambda: {key for key, text in hand.values().items() if text != values[key]} == {BC, CD})
        until(lambda: hand.at("C")[0] > here[0] + 12)
        until(lambda: hand.values()[BC] in browser.run(TOLD))
        until(lambda: browser.run(SHADED))
        Typist(browser).press("Escape")
        hand.release()
        until(lambda: hand.values() == values)
        assert not browser.run(SHADED)
        assert hand.at("C") == pytest.approx(here)
        assert hand.file.read_bytes() == before
        hand.press(here)
        hand.move((24, -18))
        until(lambda: hand.values() != values)
        hand.release()
        until(lambda: hand.file.read_bytes() != before)
        Typist(browser).idle()
        browser.run("document.getElementById('undo').click()")
        until(lambda: hand.file.read_bytes() == before)
        assert browser.messages() == []


@proof
def test_a_finger_pulls_and_a_second_one_takes_back(browser: Browser, tmp_path: Path) -> None:
    """A finger need not meet the point exactly, and the page stays where it is."""
    with hand_on(browser, "linkage-8.yaml", tmp_path, finger=True) as hand:
        before, values, (x, y) = hand.file.read_bytes(), hand.values(), hand.at("C")
        hand.press((x + 6, y + 6))
        hand.move((-14, 12))
        until(lambda: hand.values() != values)
        hand.second_finger((60, 600))
        hand.release()
        until(lambda: hand.values() == values)
        assert hand.file.read_bytes() == before
        hand.press((x + 6, y + 6))
        hand.move((-14, 12))
        until(lambda: browser.run(TOLD))
        hand.release()
        until(lambda: hand.file.read_bytes() != before)
        assert browser.run("return scrollY") == 0
        assert "lengths: [170 mm, 110 mm]" not in hand.file.read_text(encoding="utf-8")


@proof
def test_a_handle_turns_the_crank_and_changes_nothing(browser: Browser, tmp_path: Path) -> None:
    """Round the centre as far as the hand goes, past the first of two turns; Esc goes back, and arrow keys turn on."""
    with hand_on(browser, "engine-single-load.yaml", tmp_path) as hand:
        before, begin = hand.file.read_bytes(), browser.run("return moving.angle()")
        centre = complex(*hand.at("A"))
        hand.press(tuple(browser.run(KNOB)))
        arm = complex(*hand.where) - centre
        for eighth in range(1, 11):
            # On the screen y grows downwards; the crank of this engine turns clockwise.
            wanted = centre + arm * cmath.rect(1.0, eighth * math.pi / 4)
            hand.move((wanted.real - hand.where[0], wanted.imag - hand.where[1]))
        assert browser.run("return moving.angle()") == pytest.approx(begin + 450, abs=0.5)
        Typist(browser).press("Escape")
        assert browser.run("return moving.angle()") == begin
        hand.release()
        browser.run("document.querySelector('.handle').focus()")
        Typist(browser).press("ArrowRight")
        assert browser.run("return moving.angle()") == begin + 1
        assert (
            browser.run("return document.querySelector('.handle').getAttribute('aria-valuetext')")
            == f"{begin + 1:.1f}°"
        )
        assert hand.file.read_bytes() == before


@proof
def test_a_locked_length_stays_and_the_other_follows(browser: Browser, tmp_path: Path) -> None:
    """The padlock is a button at the field, reached and pressed by keys; it stays when the form changes."""
    with hand_on(browser, "four-bar-01.yaml", tmp_path) as hand:
        before, values = hand.file.read_text(encoding="utf-8"), hand.values()
        until(lambda: browser.run(LOCK))
        typist = Typist(browser)
        browser.run(f"({LOCK.removeprefix('return ')}).focus()")
        typist.press("Enter")
        assert browser.run(f"{LOCK}.getAttribute('aria-pressed')") == "true"
        assert hand.file.read_text(encoding="utf-8") == before
        hand.press(hand.at("C"))
        # Across the rod whose length stays.
        hand.move((14, 22))
        until(lambda: hand.values()[CD] != values[CD])
        assert hand.values()[BC] == values[BC]
        hand.release()
        until(lambda: hand.file.read_text(encoding="utf-8") != before)
        typist.idle()
        assert "BC: 340 mm" in hand.file.read_text(encoding="utf-8")
        assert browser.run(f"{LOCK}.getAttribute('aria-pressed')") == "true"


@proof
def test_what_is_not_saved_stays_when_a_point_is_pulled(browser: Browser, tmp_path: Path) -> None:
    """The text typed is neither overwritten by the pull nor deleted when the pull is taken back."""
    with hand_on(browser, "four-bar-01.yaml", tmp_path) as hand:
        values = hand.values()
        edit, refused = hand.session.edit, {"refused": "not now", "revision": 0}
        hand.session.edit = lambda asked: refused
        typist = Typist(browser)
        typist.replace("BC", "34")
        hand.press(hand.at("C"))
        hand.move((14, 22))
        until(lambda: hand.values()[CD] != values[CD])
        assert hand.values()[BC] == "34"
        typist.press("Escape")
        hand.release()
        until(lambda: hand.values()[CD] == values[CD])
        assert hand.values()[BC] == "34"
        hand.session.edit = edit


@proof
def test_a_pull_released_before_its_answer_is_written(browser: Browser, tmp_path: Path) -> None:
    with hand_on(browser, "four-bar-01.yaml", tmp_path) as hand:
        before, pull, released = hand.file.read_bytes(), hand.session.pull, Event()

        def late(asked: Any) -> Any:
            assert released.wait(PATIENCE)
            return pull(asked)

        hand.session.pull = late
        hand.press(hand.at("C"))
        hand.move((24, -18))
        hand.release()
        released.set()
        until(lambda: hand.file.read_bytes() != before)
        Typist(browser).idle()
        assert not browser.run("return document.querySelector('.pulled, .pull-ring, .pull-values')")
        browser.run("document.getElementById('undo').click()")
        until(lambda: hand.file.read_bytes() == before)


@proof
@pytest.mark.parametrize("late", [False, True])
def test_a_second_pull_goes_on_where_the_first_one_ended(browser: Browser, tmp_path: Path, late: bool) -> None:
    """It is neither ended nor shown elsewhere by the machine of the first one, which arrives in the middle of it."""
    with hand_on(browser, "four-bar-01.yaml", tmp_path) as hand:
        before, here, moving = hand.file.read_bytes(), hand.at("C"), browser.run("return document.body.dataset.moving")
        pull, show, pressed, begun = hand.session.pull, hand.session.show, Event(), Event()

        def pull_late(asked: Any) -> Any:
            assert pressed.wait(PATIENCE)
            return pull(asked)

        def show_late(*checked: Any) -> None:
            assert begun.wait(PATIENCE)
            show(*checked)

        hand.session.pull = pull_late if late else pull
        hand.session.show = show_late
        hand.press(here)
        hand.move((16, -12))
        if not late:
            until(lambda: hand.at("C")[0] > here[0] + 12)
        hand.release()
        hand.press(hand.at("C") if late else hand.where)
        hand.move((4, -3))
        pressed.set()
        until(lambda: hand.file.read_bytes() != before)
        first, values = hand.file.read_bytes(), hand.values()
        until(lambda: hand.at("C")[0] > here[0] + 12)
        browser.run(RECORD)
        hand.move((12, -9))
        begun.set()
        until(lambda: browser.run(RENEWED, moving))
        hand.move((4, -3))
        until(lambda: hand.at("C")[0] > here[0] + 20)
        assert hand.values() != values
        seen = browser.run("return seen")
        # The drawing of the first pull's machine may have another scale; it never shows the place of the first pull.
        assert all(later > earlier - 4 for earlier, later in pairwise(seen)), seen
        hand.release()
        until(lambda: hand.file.read_bytes() != first)
        Typist(browser).idle()
        assert hand.at("C")[0] > here[0] + 20
        assert all(text in hand.file.read_text(encoding="utf-8") for text in (hand.values()[BC], hand.values()[CD]))
        assert browser.messages() == []


@proof
def test_a_region_is_that_of_the_machine_that_is_shown(browser: Browser, tmp_path: Path) -> None:
    """An editor makes the frame longer in the middle of a pull: the shape is found anew at the scale of the drawing."""
    with hand_on(browser, "four-bar-01.yaml", tmp_path) as hand:
        pulls = hand.session.pulls
        pulls.region = region = Mock(wraps=pulls.region)
        hand.press(hand.at("C"))
        hand.move((8, -6))
        until(lambda: region.call_count == 2 and browser.run(SHADED))
        old, shown = browser.run(REGION), browser.run("return document.body.dataset.moving")
        edit_beside(hand.file, ("parameters", "AD"), "440 mm")
        until(lambda: browser.run(RENEWED, shown))
        until(lambda: region.call_count == 4)
        [asked] = region.call_args.args
        new = pulls.region(asked)["path"]
        assert new != old
        until(lambda: browser.run(REGION) == new)
        Typist(browser).press("Escape")
        hand.release()
        assert browser.messages() == []


@proof
def test_a_page_loaded_anew_in_the_middle_of_a_pull_writes_nothing(browser: Browser, tmp_path: Path) -> None:
    with hand_on(browser, "four-bar-01.yaml", tmp_path) as hand:
        before, values = hand.file.read_bytes(), hand.values()
        hand.session.edit = asked = Mock(wraps=hand.session.edit)
        hand.press(hand.at("C"))
        hand.move((24, -18))
        until(lambda: hand.values() != values)
        browser.run("window.old = true; location.reload()")
        until(lambda: browser.run("return !window.old && document.getElementById('saved') !== null"))
        until(lambda: browser.run(READY))
        Typist(browser).idle()
        assert not asked.called
        assert hand.values() == values
        assert hand.file.read_bytes() == before


@proof
def test_the_tip_of_a_load_changes_its_size_and_esc_takes_it_back(browser: Browser, tmp_path: Path) -> None:
    """Only an arrow that is shown has a tip; it goes with the pointer, and its release is one change."""
    with hand_on(browser, "slider-crank-02.yaml", tmp_path) as hand:
        before, values = hand.file.read_text(encoding="utf-8"), hand.values()
        until(lambda: browser.run("return document.querySelectorAll('[data-layer=loads]').length"))
        browser.run("moving.seek(90)")
        assert browser.run(TIP, "P3") is None
        browser.run(SHOW_LOADS)
        here = browser.run(TIP, "P3")
        field = "f:parameters.force.F"
        assert browser.run(f"return document.getElementById('{field}').parentElement.querySelector('.lock') !== null")
        hand.press(tuple(here))
        hand.move((20, 6))
        until(lambda: {key for key, text in hand.values().items() if text != values[key]} == {field})
        until(lambda: abs(browser.run(TIP, "P3")[0] - here[0] - 20) < 6)
        assert browser.run(TIP, "P3")[1] == pytest.approx(here[1], abs=0.5)
        until(lambda: hand.values()[field] in browser.run(TOLD))
        Typist(browser).press("Escape")
        hand.release()
        until(lambda: hand.values() == values)
        assert browser.run(TIP, "P3") == pytest.approx(here)
        assert hand.file.read_text(encoding="utf-8") == before
        hand.press(tuple(here))
        hand.move((20, 6))
        until(lambda: hand.values() != values)
        hand.release()
        until(lambda: hand.file.read_text(encoding="utf-8") != before)
        assert hand.file.read_text(encoding="utf-8").replace(f"F: {hand.values()[field]}", "F: 50 N") == before
        Typist(browser).idle()
        browser.run("document.getElementById('undo').click()")
        until(lambda: hand.file.read_text(encoding="utf-8") == before)
        assert browser.messages() == []
