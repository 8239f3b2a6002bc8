"""A typed or pulled value is taken back, refused or typed over: exactly that value, and the machine follows."""

from __future__ import annotations

from pathlib import Path
from threading import Event
from typing import Any

import pytest

from reportgen import catalogue
from reportgen.page.edit_session import EditSession
from tests.lanes import proof
from tests.page.browser import Browser
from tests.page.hand import hand_on
from tests.page.typist import PATIENCE, Typist, edit_beside, form_alone, until, value

PRESS = """
document.activeElement.dispatchEvent(new KeyboardEvent("keydown", { key: arguments[0], bubbles: true }));
"""
FOCUS = "document.getElementById(arguments[0]).focus()"
THEIRS = "document.querySelector('[data-settle=theirs]')"
DRAWN = "return pulls.at('C')"
"""Where the joint C is on the drawing, wherever that is on the screen."""
MOVING = "return document.body.dataset.moving"
ANSWERED = """
const done = arguments[0];
(async () => {
  for (let count = 0; count < 20; count += 1) await fetch("form.json");
  done();
})();
"""
"""Waits until answers have come, and what the page asks for when it has them."""
BC, CD = "f:parameters.BC", "f:parameters.CD"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (made := tmp_path / "mine.yaml").write_text(catalogue.sample("slider-crank", "en"), encoding="utf-8")
    return made


@proof
def test_the_machine_follows_a_value_that_is_taken_back(browser: Browser, tmp_path: Path) -> None:
    """By Esc, by Esc before the machine has followed, and by the choice of the file's value."""
    with hand_on(browser, "four-bar-01.yaml", tmp_path) as hand:
        values, here, drag = hand.values(), browser.run(DRAWN), hand.session.drag
        browser.run(FOCUS, BC)
        browser.run(PRESS, "PageUp")
        until(lambda: browser.run(DRAWN) != here)
        browser.run(PRESS, "Escape")
        assert hand.values() == values
        assert browser.run(DRAWN) == here
        begun, released, answered = Event(), Event(), Event()

        def late(asked: Any) -> Any:
            begun.set()
            assert released.wait(PATIENCE)
            answer = drag(asked)
            answered.set()
            return answer

        hand.session.drag = late
        browser.run(PRESS, "PageUp")
        assert begun.wait(PATIENCE)
        browser.run(PRESS, "Escape")
        released.set()
        assert answered.wait(PATIENCE)
        hand.session.drag = drag
        # The next question is asked after this answer has come.
        browser.run(FOCUS, CD)
        browser.run(PRESS, "PageUp")
        until(lambda: browser.run(DRAWN) != here)
        browser.run(PRESS, "Escape")
        assert browser.run(DRAWN) == here
        Typist(browser).replace("BC", "345 mm")
        moving = browser.run(MOVING)
        edit_beside(hand.file, ("parameters", "BC"), "350 mm")
        until(lambda: browser.run(f"return {THEIRS} !== null"))
        until(lambda: browser.run(MOVING) != moving)
        there = browser.run(DRAWN)
        browser.run(PRESS, "PageUp")
        until(lambda: browser.run(DRAWN) != there)
        browser.run(f"{THEIRS}.click()")
        assert hand.values()[BC] == "350 mm"
        assert browser.run(DRAWN) == there
        assert browser.messages() == []


@proof
def test_what_is_typed_after_a_refusal_is_sent(browser: Browser, file: Path) -> None:
    """In the field that still has the focus; and two refused values do not call each other up again and again."""
    with form_alone(file) as server:
        session, asked = server.session, list[str]()
        assert isinstance(session, EditSession)
        edit = session.edit

        def refuse(body: Any) -> Any:
            asked.append(body["value"])
            return {**session.numbered_form(), "refused": "not now"}

        def refused(key: str, text: str) -> None:
            typist.replace(key, text)
            typist.press("Enter")
            until(lambda: text in asked)
            browser.driver.execute_async_script(ANSWERED)

        session.edit = refuse  # type: ignore[method-assign, assignment]
        browser.show(server.address, still=True)
        typist = Typist(browser)
        refused("r", "160 mm")
        session.edit = edit  # type: ignore[method-assign]
        typist.replace("r", "165 mm")
        typist.press("Enter")
        until(lambda: value(file, ("parameters", "r")) == "165 mm")
        typist.idle()
        session.edit = refuse  # type: ignore[method-assign, assignment]
        refused("l", "610 mm")
        refused("n", "61 rpm")
        assert asked == ["160 mm", "610 mm", "610 mm", "61 rpm"]


@proof
def test_a_value_typed_while_the_server_was_away_is_sent_when_it_is_back(browser: Browser, file: Path) -> None:
    """The server reports itself to the page when the connection is there again; the file is as it was."""
    with form_alone(file) as server:
        browser.show(server.address, still=True)
        browser.run("window.kept = fetch; window.fetch = () => Promise.reject(new TypeError('no connection'))")
        typist = Typist(browser)
        typist.replace("r", "160 mm")
        typist.press("Enter")
        until(lambda: browser.run("return document.querySelector('#refused').textContent"))
        browser.run("window.fetch = window.kept")
        server.session._publish(busy=True)
        typist.idle()
        assert value(file, ("parameters", "r")) == "160 mm"
        assert not browser.run("return document.querySelector('#refused').textContent")


@proof
def test_a_value_typed_after_a_pull_is_neither_changed_nor_undone_with_it(browser: Browser, tmp_path: Path) -> None:
    """The last answer to the pull comes while one types."""
    with hand_on(browser, "four-bar-01.yaml", tmp_path) as hand:
        values, pull, released = hand.values(), hand.session.pull, Event()

        def late(asked: Any) -> Any:
            assert released.wait(PATIENCE)
            return pull(asked)

        hand.session.pull = late
        hand.press(hand.at("C"))
        hand.move((24, -18))
        hand.release()
        typist = Typist(browser)
        typist.replace("BC", "333")
        released.set()
        until(lambda: hand.values()[CD] != values[CD])
        typist.type(" mm")
        assert hand.values()[BC] == "333 mm"
        typist.press("Enter")
        typist.idle()
        assert value(hand.file, ("parameters", "BC")) == "333 mm"
        written = hand.file.read_bytes()
        assert value(hand.file, ("parameters", "CD")) == hand.values()[CD] != values[CD]
        browser.run("document.getElementById('undo').click()")
        until(lambda: hand.file.read_bytes() != written)
        kept = value(hand.file, ("parameters", "BC")) == "333 mm", value(hand.file, ("parameters", "CD")) != values[CD]
        assert sum(kept) == 1


@proof
def test_a_pull_begins_when_the_last_one_is_written(browser: Browser, tmp_path: Path) -> None:
    """Its first question does not take the place of the last one's last."""
    with hand_on(browser, "four-bar-01.yaml", tmp_path) as hand:
        before, pull, released, asked = hand.file.read_bytes(), hand.session.pull, Event(), list[Any]()

        def late(body: Any) -> Any:
            asked.append((body["grab"], tuple(body["to"])))
            assert released.wait(PATIENCE)
            return pull(body)

        hand.session.pull = late
        here = hand.at("C")
        hand.press(here)
        hand.move((24, -18))
        hand.release()
        hand.press(here)
        hand.move((-20, 10))
        released.set()
        until(lambda: hand.file.read_bytes() != before)
        hand.release()
        assert [grab for grab, _ in asked][:2] == [1, 1]
        assert asked[1] != asked[0]
