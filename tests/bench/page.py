"""How smoothly a page moves, and how soon it is ready: measured in a browser slowed down to a fourth.

`make bench` runs this; without a browser it says so and ends.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from reportgen import api

ROOT = Path(__file__).resolve().parents[2]
FILES = ("engine-twin-05", "linkage-8")
"""The sample, and the machine with the most links."""
SLOWED = 4
SECONDS = 4
AIMS = "≥ 30 frames a second", "≤ 1 s", "≤ 3 MB"
FRAMES = """
const done = arguments[arguments.length - 1], begun = performance.now(), until = begun + 1000 * arguments[0];
let count = 0;
const next = (time) => {
  count += 1;
  if (time < until) requestAnimationFrame(next); else done(count * 1000 / (time - begun));
};
moving.play();
requestAnimationFrame(next);
"""


@dataclass(frozen=True, slots=True)
class Page:
    """What was measured of a page."""

    name: str
    megabytes: float
    ready: float
    """Until all is loaded and drawn once, at the machine's own speed (s)."""
    frames: float
    """A second, the browser slowed down, the page as it opens."""


def browser() -> Any:
    """A browser without a window, or None where there is none."""
    chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if chromium is None or driver is None:
        return None
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    for argument in ("headless=new", "no-sandbox", "disable-gpu", "disable-dev-shm-usage", "window-size=1440,900"):
        options.add_argument(f"--{argument}")
    return webdriver.Chrome(options=options, service=Service(driver))


def measure(driver: Any, name: str, folder: Path) -> Page:
    """The page of an assignment file of the repository."""
    path = api.build(ROOT / "assignments" / f"{name}.yaml", folder, formats=["html"])
    ready = []
    for _ in range(3):
        driver.get(path.as_uri())
        ready.append(driver.execute_script("return performance.getEntriesByType('navigation')[0].loadEventEnd"))
    driver.execute_cdp_cmd("Emulation.setCPUThrottlingRate", {"rate": SLOWED})
    frames = driver.execute_async_script(FRAMES, SECONDS)
    driver.execute_cdp_cmd("Emulation.setCPUThrottlingRate", {"rate": 1})
    return Page(name, path.stat().st_size / 1e6, sorted(ready)[1] / 1000, frames)


def table(pages: Sequence[Page]) -> Iterator[str]:
    """The measurements in Markdown, as `docs/explanation/speed.md` has them."""
    yield f"| page | frames a second, {SLOWED}× slowed ({AIMS[0]}) | ready ({AIMS[1]}) | size ({AIMS[2]}) |"
    yield "| --- | --- | --- | --- |"
    for page in pages:
        yield f"| `{page.name}` | {page.frames:.0f} | {page.ready:.2f} s | {page.megabytes:.2f} MB |"


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and print; 0 also where there is no browser to measure in."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench.page", description="Measure pages in a browser.")
    parser.add_argument("names", nargs="*", default=FILES, help="Assignment files of the repository, by their stems.")
    names = parser.parse_args(arguments).names
    driver = browser()
    if driver is None:
        print("no browser here: chromium and chromedriver are not installed", file=sys.stderr)
        return 0
    driver.set_script_timeout(60)
    try:
        with tempfile.TemporaryDirectory(prefix="bench-") as folder:
            pages = [measure(driver, name, Path(folder)) for name in names]
    finally:
        driver.quit()
    print(*table(pages), sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
