"""A browser for tests, and what it shows of a page: places of what is drawn, messages, requests."""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import pytest

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
LACKING = "no browser here: chromium and chromedriver are not installed"
AXE = "axe-core"

DRAWN = """
moving.pause();
const items = JSON.parse(document.getElementById("samples").textContent).items;
const corner = /[ML]([-\\d.e]+) ([-\\d.e]+)/g;
const parts = (path) => [...path.matchAll(corner)].map((found) => [Number(found[1]), Number(found[2])]);
const found = [];
for (const angle of arguments[0]) {
  moving.seek(angle);
  const stages = {};
  for (const stage of document.querySelectorAll("[data-stage]")) {
    const vectors = {}, carried = [];
    for (const one of stage.querySelectorAll("[data-i]")) {
      if (one.getAttribute("display") === "none" || one.hasAttribute("hidden")) continue;
      const item = items[one.dataset.i];
      if (item.from !== undefined && item.name) {
        const shaft = parts(one.children[0].getAttribute("d")), head = parts(one.children[1].getAttribute("d"));
        (vectors[item.name] ??= []).push([...shaft[0], ...head[0]]);
      } else if (item.at !== undefined) {
        const svg = one.ownerSVGElement, matrix = svg.getScreenCTM().inverse().multiply(one.getScreenCTM());
        const circle = one.querySelector("circle");
        if (circle) {
          const at = new DOMPoint(circle.cx.baseVal.value, circle.cy.baseVal.value).matrixTransform(matrix);
          carried.push([at.x, at.y]);
        }
        for (const path of one.querySelectorAll("path")) {
          for (const [x, y] of parts(path.getAttribute("d"))) {
            const at = new DOMPoint(x, y).matrixTransform(matrix);
            carried.push([at.x, at.y]);
          }
        }
      }
    }
    stages[stage.dataset.stage] = { vectors, carried };
  }
  found.push(stages);
}
return found;
"""
"""What is drawn at each angle of the argument, by stages: vectors by name as [x1, y1, x2, y2], corners of links."""

LABELS = """
moving.pause();
const canvas = document.createElement("canvas").getContext("2d");
const union = (boxes) => [0, 1, 2, 3].map((edge) => Math[edge < 2 ? "min" : "max"](...boxes.map((box) => box[edge])));
const inked = (text) => {
  const matrix = text.getScreenCTM(), boxes = [];
  let at = 0;
  for (const run of text.childNodes) {
    const look = getComputedStyle(run.nodeType === 3 ? text : run);
    canvas.font = `${look.fontStyle} ${100 * parseFloat(look.fontSize)}px ${look.fontFamily}`;
    for (const letter of run.textContent) {
      const ink = canvas.measureText(letter), start = text.getStartPositionOfChar(at);
      const place = (x, y) => new DOMPoint(start.x + x / 100, start.y + y / 100).matrixTransform(matrix);
      const low = place(-ink.actualBoundingBoxLeft, -ink.actualBoundingBoxAscent);
      const high = place(ink.actualBoundingBoxRight, ink.actualBoundingBoxDescent);
      boxes.push([low.x, low.y, high.x, high.y]);
      at += letter.length;
    }
  }
  return union(boxes);
};
const edges = (box) => [box.left, box.top, box.right, box.bottom];
const labelled = (text) => {
  const over = [...text.parentElement.children].filter((one) => one !== text);
  return [...union([inked(text), ...over.map((one) => edges(one.getBoundingClientRect()))]), text.textContent];
};
return arguments[0].map((angle) => {
  moving.seek(angle);
  return Object.fromEntries([...document.querySelectorAll("[data-stage]")].map((stage) => {
    const shown = [...stage.querySelectorAll("text")].filter((text) => text.getBoundingClientRect().width);
    return [stage.dataset.stage, shown.map(labelled)];
  }));
});
"""
"""The labels at each angle of the argument, by stages: left, upper, right, lower edge of their ink (px), the text."""


@contextmanager
def opened() -> Iterator[Browser]:
    """A browser without a window; skips the test where there is none."""
    if CHROMIUM is None or DRIVER is None:
        pytest.skip(LACKING)
    webdriver = pytest.importorskip("selenium.webdriver")
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    for argument in ("headless=new", "no-sandbox", "disable-gpu", "hide-scrollbars", "disable-dev-shm-usage"):
        options.add_argument(f"--{argument}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(DRIVER))
    try:
        yield Browser(driver)
    finally:
        driver.quit()


class Browser:
    """What tests ask of a browser."""

    def __init__(self, driver: Any) -> None:
        self.driver = driver
        self.shown: Path | str = ""
        """The page that is open on the usual screen."""

    def show(
        self, page: Path | str, width: int = 1440, height: int = 900, dark: bool = False, still: bool = False
    ) -> None:
        """Open a page, alone, on a screen of so many pixels."""
        self.command(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 500
        )
        features = [
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"},
            {"name": "prefers-reduced-motion", "value": "reduce" if still else "no-preference"},
        ]
        self.command("Emulation.setEmulatedMedia", features=features)
        self.leave()
        for log in ("browser", "performance"):
            self.driver.get_log(log)
        self.driver.get(page.as_uri() if isinstance(page, Path) else page)
        self.shown = page if (width, height, dark, still) == (1440, 900, False, False) else ""

    def keep(self, page: Path) -> None:
        """Open a page unless it is open, as the test before has left it: to lay out a large one takes a second."""
        if page != self.shown:
            self.show(page)

    def leave(self) -> None:
        """Show nothing."""
        self.driver.get("about:blank")
        self.shown = ""

    def rest(self) -> None:
        """Let nothing move on a page that the next test may look at; leave any other."""
        if isinstance(self.shown, Path):
            self.run("if (typeof moving !== 'undefined') moving.pause()")
        else:
            self.leave()

    def run(self, script: str, *arguments: Any) -> Any:
        return self.driver.execute_script(script, *arguments)

    def command(self, name: str, **arguments: Any) -> Any:
        return self.driver.execute_cdp_cmd(name, arguments)

    def messages(self) -> list[str]:
        """What the console says since the last time."""
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def requests(self) -> list[str]:
        """The addresses asked for since the page was opened."""
        entries = (json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance"))
        return [
            entry["params"]["request"]["url"] for entry in entries if entry["method"] == "Network.requestWillBeSent"
        ]

    def drawn(self, angles: Sequence[float]) -> list[Mapping[str, Any]]:
        """What is drawn at these cycle angles (degrees), see `DRAWN`; y is downwards."""
        found: list[Mapping[str, Any]] = self.run(DRAWN, list(map(float, angles)))
        return found

    def labels(self, angles: Sequence[float]) -> list[Mapping[str, list[Any]]]:
        """The labels at these cycle angles (degrees), see `LABELS`."""
        found: list[Mapping[str, list[Any]]] = self.run(LABELS, list(map(float, angles)))
        return found

    def violations(self, source: str, within: str = "html") -> list[str]:
        """What axe-core finds on the page, or in what is chosen of it."""
        self.command("Runtime.evaluate", expression=source)
        self.driver.set_script_timeout(120)
        run = f"axe.run({json.dumps(within)}, {{resultTypes: ['violations']}})"
        found = self.driver.execute_async_script(f"{run}.then((found) => arguments[0](found.violations))")
        return [f"{one['id']}: {node['html'][:120]}" for one in found for node in one["nodes"]]

    def printed(self) -> bytes:
        """The page as a PDF at 100 %, each sheet of its own size."""
        done = self.command("Page.printToPDF", preferCSSPageSize=True, printBackground=True, scale=1)
        return base64.b64decode(done["data"])


@cache
def axe() -> str:
    """The source of axe-core, by npm; skips the test where it cannot be had."""
    npm = shutil.which("npm")
    if npm is None:
        pytest.skip("no npm here: axe-core cannot be had")
    with tempfile.TemporaryDirectory(prefix="axe-") as folder:
        command = [npm, "install", "--silent", "--no-audit", "--no-fund", "--prefix", folder, AXE]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
        script = Path(folder) / "node_modules" / "axe-core" / "axe.min.js"
        if done.returncode or not script.is_file():
            pytest.skip(f"npm has no axe-core for us: {' '.join(done.stderr.split())[:200]}")
        return script.read_text(encoding="utf-8")
