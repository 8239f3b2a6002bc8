"""The form opens at its top with the machine in sight, and nothing moves under the reader."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from reportgen import catalogue
from reportgen.cases import opener
from reportgen.page.file_watch import edited
from tests.lanes import proof
from tests.page.browser import Browser
from tests.page.test_notices import FOCUSED
from tests.page.typist import until

LIMIT = 0.1
"""Largest layout shift that Web Vitals call good."""
OBSERVE = """
window.shifts = [];
new PerformanceObserver((list) => window.shifts.push(...list.getEntries().filter((one) => !one.hadRecentInput)))
  .observe({ type: "layout-shift", buffered: true });
"""
SHIFT = "return window.shifts.splice(0).reduce((sum, one) => sum + one.value, 0)"
"""The layout shift since the page was opened, or since the last time."""
PLACES = """
const inside = (name) => {
  const { top, bottom } = document.querySelector(name).getBoundingClientRect();
  return top >= 0 && bottom <= innerHeight;
};
return [scrollY, inside("#fields h1"), inside("[data-stage=machine] svg")];
"""
TYPE = """
const field = document.querySelector("#fields input[data-unit]");
field.scrollIntoView({ block: "end" });
field.focus({ preventScroll: true });
field.value = "95";
for (const name of ["input", "change"]) field.dispatchEvent(new Event(name, { bubbles: true }));
"""
FAULTS = "return document.querySelector('#problems li') !== null"


@proof
@pytest.mark.parametrize(("name", "width", "height"), [("engine-twin", 1280, 800), ("linkage-8", 390, 844)])
def test_nothing_moves_when_the_form_opens_or_shows_a_fault(
    browser: Browser, tmp_path: Path, name: str, width: int, height: int
) -> None:
    file = tmp_path / "mine.yaml"
    if name == "engine-twin":
        file.write_text(catalogue.sample(name, "en"), encoding="utf-8")
    else:
        shutil.copy(catalogue.examples("linkage")[name], file)
    with edited(file, opener()) as server:
        session = server.session
        browser.show(server.address, width=width, height=height, still=True)
        browser.run(OBSERVE)
        until(lambda: session.revision.report is not None and not session.revision.busy)
        until(lambda: browser.run("return document.body.dataset.moving") == str(session.revision.moving))
        assert browser.run(PLACES) == [0, True, True]
        assert browser.run(SHIFT) < LIMIT
        browser.run(TYPE)
        until(lambda: browser.run(FAULTS))
        assert browser.run(FOCUSED)
        browser.run("document.getElementById('undo').click()")
        until(lambda: not browser.run(FAULTS))
        assert browser.run(SHIFT) < LIMIT
