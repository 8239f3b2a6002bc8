"""Walk through the form as the tutorials describe it, and take the pictures that they show.

`docs/pictures.py` saves the pictures, and `tests/test_tutorials.py` takes the same steps. A step raises an error if the
screen does not show what the tutorial promises.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
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

LABELS: Mapping[str, Mapping[str, str]] = {
    "en": {
        "which machine": "Which machine?",
        "machine": "Four-bar linkage",
        "moving": "The machine in motion",
        "play": "Play",
        "pause": "Pause",
        "crank": "Crank AB",
        "coupler": "Coupler BC",
        "not right": "Errors and missing values",
        "no unit": "“95” has no unit",
        "use": "Use 95 mm",
        "student": "Student",
        "name": "Name",
        "Lan": "Lan Pham",
        "saved": "saved",
        "ready": "The report is up to date.",
        "made": "PDF: made: out/four-bar/report.pdf",
    },
    "vi": {
        "which machine": "Chọn máy",
        "machine": "Cơ cấu bốn khâu bản lề",
        "moving": "Cơ cấu chuyển động",
        "play": "Chạy",
        "pause": "Dừng",
        "crank": "Tay quay AB",
        "coupler": "Thanh truyền BC",
        "not right": "Tệp chưa đúng",
        "no unit": "“95” thiếu đơn vị",
        "use": "Dùng 95 mm",
        "student": "Sinh viên",
        "name": "Họ và tên",
        "Lan": "Phạm Thị Lan",
        "saved": "đã lưu",
        "ready": "Bản thuyết minh đã được cập nhật.",
        "made": "PDF: đã tạo: out/four-bar/report.pdf",
    },
}
"""What the screens of the first report show, by language."""

Save = Callable[[str, bytes], None]
"""Stores a screenshot (PNG) as the picture with this name."""


@contextmanager
def served(folder: Path, language: str) -> Iterator[str]:
    """Start `reportgen edit --lang LANGUAGE` in an empty folder; yield the address of its page."""
    command = [sys.executable, "-m", "reportgen.cli", "edit", "--lang", language, "--no-open"]
    path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    server = subprocess.Popen(
        command, cwd=folder, env={**os.environ, "PYTHONPATH": path}, stdout=subprocess.PIPE, text=True
    )
    assert server.stdout is not None
    try:
        yield server.stdout.readline().strip()
    finally:
        server.terminate()
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

    def at_rest(self, labels: Mapping[str, str] = LABELS["en"]) -> None:
        """Wait until the file is saved and the machine and the report follow it."""
        self.says(labels["saved"], "#saved")
        self.says(labels["ready"])
        self.driver.execute_script("moving.pause(); scrollTo(0, 0); document.activeElement.blur();")
        time.sleep(0.3)

    def picture(self) -> bytes:
        png: bytes = self.driver.get_screenshot_as_png()
        return png


def first_report(screen: Screen, folder: Path, save: Save, language: str = "en") -> Path:
    """Take the steps of docs/tutorials/first-report.md in the form; return the report."""
    driver, labels = screen.driver, LABELS[language]
    with served(folder, language) as address:
        driver.get(address)
        screen.says(labels["which machine"])
        screen.wait("the pictures of the kinds", lambda: driver.execute_script(DRAWN))
        save("first-report-kinds", screen.picture())
        screen.press(labels["machine"])
        screen.says(labels["moving"])
        screen.at_rest(labels)
        save("first-report-form", screen.picture())
        assert (folder / "four-bar.yaml").is_file()
        screen.press(labels["play"])
        screen.press(labels["pause"])
        screen.type(labels["crank"], "95")
        screen.says(labels["not right"])
        screen.says(labels["no unit"])
        driver.execute_script("moving.seek(45);")
        save("first-report-error", screen.picture())
        screen.press(labels["use"])
        screen.at_rest(labels)
        assert screen.field(labels["crank"]).get_attribute("value") == "95 mm"
        screen.type(labels["coupler"], "320 mm")
        screen.says(labels["student"])
        screen.type(labels["name"], labels["Lan"])
        screen.at_rest(labels)
        screen.press("PDF")
        screen.says(labels["made"])
        driver.execute_script("moving.seek(45); document.getElementById('undo').scrollIntoView({block: 'end'});")
        save("first-report-made", screen.picture())
    text = (folder / "four-bar.yaml").read_text(encoding="utf-8")
    assert all(line in text for line in ("AB: 95 mm", "BC: 320 mm", f"name: {labels['Lan']}"))
    return folder / "out" / "four-bar" / "report.pdf"
