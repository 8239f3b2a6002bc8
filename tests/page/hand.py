"""A hand on the moving machine of a form, for tests: the mouse and fingers at points of the drawing."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from reportgen.cases import opener
from reportgen.page.file_watch import edited
from tests.page.browser import Browser
from tests.page.typist import until

FOLDER = Path(__file__).parents[2] / "assignments"
PLACE = """
const place = pulls.at(arguments[0]);
if (!place) return null;
const { x, y } = new DOMPoint(...place).matrixTransform(pulls.svg().getScreenCTM());
return [x, y];
"""
"""Where a point is on the screen (px)."""
READY = "return typeof pulls !== 'undefined' && document.querySelectorAll('.grip').length > 0"
VALUES = "return [...document.querySelectorAll('#fields [data-was]')].map(({ id, value }) => [id, value])"
TOLD = "return document.querySelector('.pull-values')?.textContent || ''"
Place = tuple[float, float]


@dataclass
class Hand:
    """The pointer in a browser that shows a form with a machine at rest."""

    browser: Browser
    file: Path
    session: Any
    finger: bool = False
    where: Place = (0.0, 0.0)

    def at(self, point: str) -> Place:
        x, y = self.browser.run(PLACE, point)
        return float(x), float(y)

    def values(self) -> dict[str, str]:
        """The texts of all fields, by their ids."""
        return dict(self.browser.run(VALUES))

    def press(self, place: Place) -> None:
        self.where = place
        self._mouse("mouseMoved", buttons=0)
        self._point("touchStart", "mousePressed")

    def move(self, by: Place) -> None:
        """Move in steps, as a hand does."""
        x, y = self.where
        for part in range(1, 5):
            self.where = x + by[0] * part / 4, y + by[1] * part / 4
            self._point("touchMove", "mouseMoved")

    def release(self) -> None:
        self._point("touchEnd", "mouseReleased")

    def second_finger(self, place: Place) -> None:
        points = [self._finger(self.where, 0), self._finger(place, 1)]
        self.browser.command("Input.dispatchTouchEvent", type="touchStart", touchPoints=points)

    def _point(self, touch: str, mouse: str) -> None:
        if self.finger:
            points = [] if touch == "touchEnd" else [self._finger(self.where, 0)]
            self.browser.command("Input.dispatchTouchEvent", type=touch, touchPoints=points)
        else:
            self._mouse(mouse, buttons=int(mouse != "mouseReleased"))

    def _finger(self, place: Place, number: int) -> dict[str, Any]:
        return {"x": place[0], "y": place[1], "id": number}

    def _mouse(self, kind: str, buttons: int) -> None:
        if self.finger:
            return
        x, y = self.where
        button = "left" if buttons or kind == "mouseReleased" else "none"
        command = {"type": kind, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": 1}
        self.browser.command("Input.dispatchMouseEvent", **command)


@contextmanager
def hand_on(browser: Browser, name: str, folder: Path, finger: bool = False) -> Iterator[Hand]:
    """The form of a copy of an example, on a screen for a mouse or for fingers."""
    file = Path(shutil.copy(FOLDER / name, folder / name))
    width, height = (390, 844) if finger else (1280, 800)
    with edited(file, opener(), "en") as server:
        browser.show(server.address, width=width, height=height, still=True)
        browser.command("Emulation.setTouchEmulationEnabled", enabled=finger)
        try:
            until(lambda: browser.run(READY))
            yield Hand(browser, file, server.session, finger)
        finally:
            browser.command("Emulation.setTouchEmulationEnabled", enabled=False)
            browser.leave()
