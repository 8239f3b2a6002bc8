"""The steps of a student and an instructor in the browser, as they press and type."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from tests.page.browser import Browser

PATIENCE = 30.0
"""Seconds to wait for a page, on a machine that does much else."""
CONTROL = "\ue009"
"""The key as a driver of browsers sends it."""


class Walk:
    """A browser on a screen of a width, with a language, that notes what is wrong with every page that it sees."""

    def __init__(self, browser: Browser, axe: str, width: int, language: str) -> None:
        self.browser, self.axe, self.width, self.language = browser, axe, width, language
        self.seen: dict[str, list[str]] = {}

    def open(self, address: str) -> None:
        self.browser.show(address, self.width, 844 if self.width < 500 else 800, still=True)
        self.speak()

    def speak(self) -> None:
        """Choose the language by its button."""
        chosen = f".languages button[value={self.language}]"
        if self.value(f"document.querySelector('{chosen}:not([aria-current])') !== null"):
            self.press(chosen)
            self.until(f"document.documentElement.lang === '{self.language}'")

    def connect(self, connected: bool) -> None:
        """Give the page a network, or take it away."""
        self.browser.command("Network.enable")
        self.browser.command(
            "Network.emulateNetworkConditions",
            offline=not connected,
            latency=0,
            downloadThroughput=-1,
            uploadThroughput=-1,
        )

    def value(self, expression: str) -> Any:
        return self.browser.run(f"return {expression}")

    def until(self, condition: str) -> None:
        """Wait until an expression is true on the page."""
        self.wait(lambda: bool(self.value(f"document.readyState === 'complete' && ({condition})")), condition)

    def wait(self, test: Callable[[], bool], what: str) -> None:
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if test():
                return
            time.sleep(0.05)
        raise AssertionError(f"{what}\n{self.value('document.body.innerText')}")

    def press(self, selector: str) -> None:
        self.value(f"document.querySelector(\"{selector}\").scrollIntoView({{block: 'center'}})")
        self.browser.driver.find_element("css selector", selector).click()

    def type(self, selector: str, text: str) -> None:
        self.browser.driver.find_element("css selector", selector).send_keys(text)

    def fill(self, values: Mapping[tuple[str, int], str]) -> None:
        """Type values into the cells of the sheet, each where the Enter key leads."""
        for (id, position), text in values.items():
            self.type(f"input[data-id='{id}'][data-position='{position}']", f"{text}\n")

    def replace(self, selector: str, text: str) -> None:
        """Type over what a field has."""
        self.type(selector, f"{CONTROL}a{CONTROL}{text}")

    def choose(self, selector: str, file: Path) -> None:
        self.browser.driver.find_element("css selector", selector).send_keys(str(file))

    def text(self, selector: str) -> str:
        return str(self.value(f'document.querySelector("{selector}").innerText'))

    def look(self, name: str) -> None:
        """Note faults of the page: by axe-core, in the console, what is wider than the screen, other hosts."""
        faults = [one for one in self.browser.messages() if "favicon" not in one]
        faults += self.browser.violations(self.axe)
        # What axe-core says to the frame of the machine, which is alone in its sandbox, is not the page's.
        self.browser.messages()
        wide = self.value("document.documentElement.scrollWidth")
        faults += [f"{wide} px wide"] if wide > self.width else []
        faults += [
            one for one in self.browser.requests() if not one.startswith(("http://127.0.0.1:", "data:", "about:"))
        ]
        self.seen[name] = faults
