"""Points of the machine are pulled in a browser, with the mouse and with fingers, and given back."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.lanes import proof
from tests.page.browser import Browser
from tests.page.hand import TOLD, hand_on
from tests.page.typist import Typist, until

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
        assert hand.values()[BC] in browser.run(TOLD)
        Typist(browser).press("Escape")
        hand.release()
        until(lambda: hand.values() == values)
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
