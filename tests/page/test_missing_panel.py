"""The list of what is missing, in a browser: each button leads to the field of its key."""

from __future__ import annotations

from pathlib import Path

from reportgen import catalogue
from reportgen.cases import opener
from reportgen.page.file_watch import edited
from tests.lanes import proof
from tests.page.browser import Browser, axe
from tests.page.test_missing import smallest
from tests.page.typist import until

WANT = """
const panel = document.querySelector("details.missing");
panel.open = true;
const button = panel.querySelector(`[data-want='${arguments[0]}']`);
button.focus();
button.click();
"""
FOCUSED = "return document.activeElement.id"
LISTED = "return [...document.querySelectorAll('.missing strong')].map((title) => title.textContent)"
TYPE = """
const field = document.activeElement;
field.value = arguments[0];
for (const name of ["input", "change"]) field.dispatchEvent(new Event(name, { bubbles: true }));
"""


@proof
def test_the_buttons_lead_to_the_fields(browser: Browser, tmp_path: Path) -> None:
    """A flywheel and its load by their fields, a spring as a new item, a pin with friction by its name."""
    file = tmp_path / "lever.yaml"
    file.write_text(smallest("slotted-lever"), encoding="utf-8")
    with edited(file, opener(), "en") as server:
        browser.show(server.address, still=True)
        assert "Flywheel" in browser.run(LISTED)
        browser.run(WANT, '["parameters", "flywheel"]')
        assert browser.run(FOCUSED) == "f:parameters.flywheel.delta"
        browser.run(TYPE, "1/40")
        until(lambda: '"flywheel"' not in browser.run("return document.querySelector('.missing').innerHTML"))
        browser.run(WANT, '["parameters", "G3"]')
        assert browser.run(FOCUSED) == "f:parameters.G3"
        browser.run(TYPE, "40 N")
        until(lambda: "Flywheel" not in browser.run(LISTED) and browser.run(LISTED))
        assert catalogue.check(file) == []
        browser.run(WANT, '["parameters", "springs"]')
        until(lambda: browser.run(FOCUSED) == "f:parameters.springs.0.link")
        browser.run("document.getElementById('undo').click()")
        until(lambda: "springs" not in file.read_text(encoding="utf-8"))
        browser.run(WANT, '["parameters", "friction"]')
        browser.run(TYPE, "B")
        browser.run("document.activeElement.parentElement.querySelector('button').click()")
        until(lambda: browser.run(FOCUSED).startswith("f:parameters.friction.pins.B."))
        assert browser.violations(axe(), "#form") == []
        assert browser.messages() == []
