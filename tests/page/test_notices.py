"""Notices of the form: they cover no field, can be closed, and go with the revision to which they belong."""

from __future__ import annotations

from pathlib import Path
from threading import Event
from typing import Any

import pytest

from reportgen import catalogue
from reportgen.case import Case
from reportgen.cases import open_case, opener
from reportgen.page.edit_session import EditSession
from reportgen.page.file_watch import edited
from tests.lanes import proof
from tests.page.browser import Browser, axe
from tests.page.typist import PATIENCE, Typist, edit_beside, form_alone, until

MADE = {"product": "pdf", "state": "done", "files": [["report.pdf", "out/mine/report.pdf"]], "complaint": ""}
OPEN = "return [...document.querySelectorAll('#making, #refused')].map((one) => one.textContent.trim()).join('')"
COVERED = """
const notices = document.getElementById("notices").getBoundingClientRect();
const strip = document.querySelector(".kept .held")?.getBoundingClientRect().bottom ?? 0;
const column = document.getElementById("fields"), clips = getComputedStyle(column).overflowY !== "visible";
const lower = clips ? column.getBoundingClientRect().bottom : innerHeight;
const boxes = [...column.querySelectorAll("input, select, button")].map((one) => one.getBoundingClientRect());
const seen = boxes.filter(({ top, bottom, height }) => height && bottom > strip && top < lower);
const { top: above, bottom: below } = notices;
return seen.filter(({ top, bottom }) => Math.max(top, strip) < below && Math.min(bottom, lower) > above).length;
"""
"""The number of fields and buttons in sight that a notice covers."""
FOCUSED = """
const { left, top, width, height } = document.activeElement.getBoundingClientRect();
return document.elementFromPoint(left + width / 2, top + height / 2) === document.activeElement;
"""
"""True if the field with the focus is in sight."""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (made := tmp_path / "mine.yaml").write_text(catalogue.sample("slider-crank", "en"), encoding="utf-8")
    return made


def test_what_was_made_of_an_older_file_is_not_reported_any_more(file: Path) -> None:
    """What is still being made is."""
    session = EditSession(lambda: open_case(file), "en", path=file)
    for making, kept in ((MADE, False), ({**MADE, "state": "running"}, True)):
        session._publish(making=making)
        assert session.revision.news["making"] == making
        session.renew()
        assert ("making" in session.revision.news) == kept


@proof
@pytest.mark.parametrize(("width", "height"), [(390, 844), (1280, 800)])
def test_a_notice_covers_no_field_and_can_be_closed(browser: Browser, file: Path, width: int, height: int) -> None:
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.keys import Keys

    def say(**making: Any) -> None:
        server.session._publish(making={**MADE, **making})

    def closed_by(*keys: str) -> None:
        ActionChains(browser.driver).send_keys(*keys).perform()
        until(lambda: not browser.run(OPEN))

    with edited(file, opener()) as server:
        browser.show(server.address, width=width, height=height, still=True)
        until(lambda: browser.run("return document.body.dataset.moving") == "1")
        assert browser.run("return scrollY") == 0
        field = "const field = document.getElementById('f:parameters.n');"
        browser.run(f"{field} field.scrollIntoView({{ block: 'end' }}); field.focus({{ preventScroll: true }});")
        say(files=[[f"{number}.pdf", f"out/mine/{number}.pdf"] for number in range(9)])
        until(lambda: "PDF: made:" in browser.run(OPEN))
        assert browser.run("return document.querySelector('#making[role=status] a[href=\"made/8.pdf\"]') !== null")
        assert browser.run(COVERED) == 0
        assert browser.run(FOCUSED)
        assert browser.run("return document.activeElement.id") == "f:parameters.n"
        assert browser.violations(axe(), "#form") == []
        closed_by(Keys.ESCAPE)
        say(product="docx")
        until(lambda: "Word: made:" in browser.run(OPEN))
        browser.run("document.querySelector('.notice.open [data-close]').focus()")
        closed_by(Keys.ENTER)
        assert browser.run("return document.activeElement.id") == "f:parameters.n"
        # What is closed stays closed; what belongs to an older file goes, and does not come back with the page.
        server.session._publish(busy=False)
        say(product="html")
        until(lambda: "Page: made:" in browser.run(OPEN))
        browser.show(server.address, width=width, height=height, still=True)
        until(lambda: browser.run("return document.getElementById('state').textContent"))
        assert not browser.run(OPEN)
        say(product="sheet")
        until(lambda: "made:" in browser.run(OPEN))
        file.write_text(file.read_text(encoding="utf-8").replace("r: 150 mm", "r: 160 mm"), encoding="utf-8")
        until(lambda: not browser.run(OPEN))
        assert browser.messages() == []


@proof
def test_a_refusal_outlives_the_news_of_an_earlier_change(browser: Browser, file: Path) -> None:
    """The machine is made anew after the change before; no value has changed since."""
    with edited(file, opener()) as server:
        session, shown = server.session, Event()
        assert isinstance(session, EditSession)
        edit, show = session.edit, session.show

        def no_removal(body: Any) -> Any:
            return {**session.numbered_form(), "refused": "not now"} if body["op"] == "remove" else edit(body)

        def later(number: int, case: Case) -> None:
            assert shown.wait(PATIENCE)
            show(number, case)

        session.edit = no_removal  # type: ignore[method-assign, assignment]
        browser.show(server.address, still=True)
        until(lambda: browser.run("return document.body.dataset.moving") == "1")
        session.show = later  # type: ignore[method-assign]
        typist = Typist(browser)
        typist.replace("r", "160 mm")
        typist.press("Enter")
        typist.idle()
        browser.run("document.querySelector('[data-remove]').click()")
        until(lambda: "not now" in browser.run(OPEN))
        browser.run("window.news = 0; document.addEventListener('redrawn', () => { window.news += 1; });")
        shown.set()
        until(lambda: browser.run("return window.news"))
        assert "not now" in browser.run(OPEN)


@proof
def test_a_closed_notice_of_what_the_file_lacks_stays_closed(browser: Browser, file: Path) -> None:
    """Text typed for a key that is gone is reported once, however often the file changes."""
    old = file.read_text(encoding="utf-8")
    (line,) = (line for line in old.splitlines() if line.strip().startswith("n:"))
    with form_alone(file) as server:
        browser.show(server.address, still=True)
        typist = Typist(browser)
        typist.replace("n", "85 rpm")
        file.write_text(old.replace(line, "  omega1: 9 rad/s"), encoding="utf-8")
        typist.shows("omega1", "9 rad/s")
        typist.click("f:parameters.r")
        until(lambda: browser.run("return document.querySelector('#orphans button') !== null"))
        browser.run("document.getElementById('orphans').closest('.notice').querySelector('[data-close]').click()")
        edit_beside(file, ("parameters", "r"), "155 mm")
        typist.shows("r", "155 mm")
        assert not browser.run("return document.getElementById('orphans').textContent")
