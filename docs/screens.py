"""Walk through the form as the tutorials describe it, and take the pictures that they show.

`docs/pictures.py` saves the pictures, and `tests/test_tutorials.py` takes the same steps. A step raises an error if the
screen does not show what the tutorial promises.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
PATIENCE = 60.0
"""Longest time that a screen may take to show something (s)."""
WINDOW = (1180, 900)
"""Size of the browser's window (pixels)."""
DRAWN = """
return [...document.querySelectorAll("button[data-kind] .scheme")].every((one) => one.childElementCount > 0);
"""
"""True if the page shows the scheme of every kind."""

Save = Callable[[str, bytes], None]
"""Stores a screenshot (PNG) as the picture with this name."""


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """Start `reportgen edit --lang en` in an empty folder; yield the address of its page."""
    command = [sys.executable, "-m", "reportgen.cli", "edit", "--lang", "en", "--no-open"]
    path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    server = subprocess.Popen(
        command, cwd=folder, env={**os.environ, "PYTHONPATH": path}, stdout=subprocess.PIPE, text=True
    )
    assert server.stdout is not None
    try:
        yield server.stdout.readline().strip()
    finally:
        server.send_signal(signal.SIGINT)
        server.communicate()


class Screen:
    """A page of the form in a browser, used by what it shows: the words of buttons and fields."""

    def __init__(self, driver: Any) -> None:
        self.driver = driver
        driver.set_window_size(*WINDOW)
        self.used: set[str] = set()
        """The words of buttons and fields that were used, and other words that were looked for."""

    def wait(self, what: str, shown: Callable[[], object]) -> None:
        """Wait until `shown` returns a true value; raise an error that names what is missing."""
        from selenium.common.exceptions import StaleElementReferenceException

        end = time.monotonic() + PATIENCE
        while True:
            try:
                if shown():
                    return
            except StaleElementReferenceException:
                pass
            if time.monotonic() > end:
                raise AssertionError(f"the screen does not show {what}")
            time.sleep(0.05)

    def button(self, words: str) -> Any:
        """Return the visible button that shows these words as its text, or as a line of it."""
        found = self.driver.find_elements("css selector", "button")
        return next((one for one in found if one.is_displayed() and words in one.text.split("\n")), None)

    def press(self, words: str) -> None:
        self.used.add(words)
        self.wait(f"a button “{words}”", lambda: self.button(words))
        self.button(words).click()

    def field(self, label: str) -> Any:
        """Return the first field whose label begins with these words."""
        self.used.add(label)
        self.wait(f"a field “{label}”", lambda: self._labels(label))
        return self.driver.find_element("id", self._labels(label)[0].get_attribute("for"))

    def _labels(self, label: str) -> list[Any]:
        labels = self.driver.find_elements("css selector", "#fields label")
        return [one for one in labels if one.text.split("\n")[0].startswith(label)]

    def type(self, label: str, text: str) -> None:
        """Replace the text of a field and press Tab."""
        from selenium.webdriver.common.keys import Keys

        self.field(label).click()
        self.field(label).send_keys(Keys.CONTROL, "a")
        self.field(label).send_keys(text, Keys.TAB)

    def says(self, words: str, place: str = "body") -> None:
        """Wait until these words are on the screen."""
        self.used.add(words)
        self.wait(f"“{words}”", lambda: words in self.driver.find_element("css selector", place).text)

    def at_rest(self) -> None:
        """Wait until the file is saved and the machine and the report follow it."""
        self.says("saved", "#saved")
        self.says("The report is up to date.")
        self.driver.execute_script("moving.pause(); scrollTo(0, 0); document.activeElement.blur();")
        time.sleep(0.3)

    def picture(self) -> bytes:
        png: bytes = self.driver.get_screenshot_as_png()
        return png


def first_report(screen: Screen, folder: Path, save: Save) -> Path:
    """Take the steps of docs/tutorials/first-report.md in the form; return the report."""
    driver = screen.driver
    with served(folder) as address:
        driver.get(address)
        screen.says("Which machine?")
        screen.wait("the pictures of the kinds", lambda: driver.execute_script(DRAWN))
        save("first-report-kinds", screen.picture())
        screen.press("Four-bar linkage")
        screen.says("The machine in motion")
        screen.at_rest()
        save("first-report-form", screen.picture())
        assert (folder / "four-bar.yaml").is_file()
        screen.press("Play")
        screen.press("Pause")
        screen.type("Crank AB", "95")
        screen.says("This is not right yet")
        screen.says("“95” has no unit")
        driver.execute_script("moving.seek(45);")
        save("first-report-error", screen.picture())
        screen.press("Use 95 mm")
        screen.at_rest()
        assert screen.field("Crank AB").get_attribute("value") == "95 mm"
        screen.type("Coupler BC", "320 mm")
        screen.says("Student")
        screen.type("Name", "Lan Pham")
        screen.at_rest()
        screen.press("PDF")
        screen.says("PDF: made: out/four-bar/report.pdf")
        driver.execute_script("moving.seek(45); document.getElementById('undo').scrollIntoView({block: 'end'});")
        save("first-report-made", screen.picture())
    text = (folder / "four-bar.yaml").read_text(encoding="utf-8")
    assert all(line in text for line in ("AB: 95 mm", "BC: 320 mm", "name: Lan Pham"))
    return folder / "out" / "four-bar" / "report.pdf"
