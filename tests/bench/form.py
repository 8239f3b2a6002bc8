"""How soon a form follows what is drawn and typed: new samples, frames, the file, the moving part.

`make bench` runs this; without a browser it measures the samples alone.  The program's own work is told as processor
time, which other work on the computer does not change, the rest as it is felt.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import process_time, sleep
from typing import Any

import numpy as np

from reportgen import catalogue
from reportgen.base.records import replace
from reportgen.base.yaml_source import MappingNode, Scalar, Source, read_source
from reportgen.base.yaml_values import at, path_text, put
from reportgen.cases import open_case, opener
from reportgen.page.controlled_parts import variations
from reportgen.page.drag_samples import Resident
from reportgen.page.file_watch import edited
from tests.bench.page import ROOT, browser

DRAWN = {
    "engine-twin-05.yaml": (("parameters", "H"), 40, 596),
    "shaper-01.yaml": (("parameters", "l3"), 25, 209),
    "linkage-8.yaml": (("parameters", "driver", "length"), 60, 385),
    "coursework/shaper-whole.yaml": (("parameters", "a"), 35, 279),
}
"""The value that is drawn in a file; no more than so many ms for all its samples, and so many kB."""
SIGHT = frozenset(("machine", "paths", "v", "a"))
"""The drawings that a window of 1440 × 900 shows when a form opens."""
TIMES = 60
KEYSTROKES = 100
SETTLED = 3.0
"""A user looks at the page for so long (s) before the next change."""
FRAMES = """
const done = arguments[arguments.length - 1], input = document.getElementById(arguments[0]), times = [];
const panel = extended.get(moving.root), feed = panel.feed;
let fed;
panel.feed = (...what) => { feed(...what); requestAnimationFrame(() => setTimeout(() => fed(performance.now()))); };
moving.pause();
input.focus();
const act = (index) => { %s };
(async () => {
  for (let index = 0; index < arguments[1]; index += 1) {
    const begun = performance.now(), drawn = new Promise((resolve) => { fed = resolve; });
    act(index);
    times.push(await drawn - begun);
  }
  panel.feed = feed;
  done(times);
})();
"""
DRAG = """
const done = arguments[arguments.length - 1], input = document.getElementById(arguments[0]), frames = arguments[1];
const bar = input.closest(".field").querySelector("[type=range]"), low = Number(bar.min), high = Number(bar.max);
const panel = extended.get(moving.root), feed = panel.feed, seen = [];
panel.feed = (...what) => {
  feed(...what);
  requestAnimationFrame(() => setTimeout(() => seen.push(performance.now())));
};
moving.pause();
input.focus();
const draw = (moved) => {
  if (seen.length > frames) {
    panel.feed = feed;
    done(seen.slice(1).map((time, index) => time - seen[index]));
    return;
  }
  bar.value = low + (high - low) * (0.5 + 0.03 * Math.sin(moved / 20));
  bar.dispatchEvent(new Event("input", { bubbles: true }));
  requestAnimationFrame(() => draw(moved + 1));
};
draw(0);
"""
"""The times (ms) from frame to frame while a value is drawn as the hand goes, for so many frames."""
KEYS = (
    FRAMES
    % """
  const key = index % 8 < 4 ? "ArrowUp" : "ArrowDown";
  input.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
"""
)
"""The times (ms) from a key that changes the last digit of a value to the frame that shows it, for so many keys."""
SEEN = """
const done = arguments[arguments.length - 1], shifts = [];
new PerformanceObserver((list) => shifts.push(...list.getEntries().filter((one) => !one.hadRecentInput)))
  .observe({ type: "layout-shift", buffered: true });
const [{ startTime }] = performance.getEntriesByName("first-contentful-paint");
setTimeout(() => done([startTime, shifts.reduce((sum, one) => sum + one.value, 0)]), 100);
"""
"""The time (ms) of the first paint with content, and the layout shift since the page was opened."""
TYPE = """
const done = arguments[arguments.length - 1], field = document.getElementById(arguments[0]);
const now = () => performance.timeOrigin + performance.now(), begun = now();
new MutationObserver((_, observer) => {
  observer.disconnect();
  requestAnimationFrame(() => setTimeout(() => done([begun, now()])));
}).observe(document.body, { attributes: true, attributeFilter: ["data-moving", "data-drawn"] });
field.value = arguments[1];
for (const name of ["input", "change"]) field.dispatchEvent(new Event(name, { bubbles: true }));
"""
"""When a value was typed, and when the machine that has it was drawn (ms)."""


@dataclass(frozen=True, slots=True)
class Drawn:
    """What samples of a value that is drawn cost: processor time (ms), kilobytes."""

    milliseconds: float
    kilobytes: float


@dataclass(frozen=True, slots=True)
class Felt:
    """What is felt of a form: first view (s), frames after a value drawn and after a key (ms, the middle one and 19 of
    20), file and machine (ms).
    """

    paint: float
    """First paint with content (s)."""
    view: float
    shift: float
    """Layout shift while it is used."""
    key: float
    slow_key: float
    frame: float
    slow_frame: float
    own: float
    """Of a frame, the processor time of the program (ms)."""
    page: float
    """Of a frame, the processor time of the page's main thread (ms)."""
    file: float
    machine: float


def drawn(file: Path, where: tuple[str, ...], seen: frozenset[str] | None, times: int = TIMES) -> Drawn:
    """The samples of what is seen of a machine, or of all, of which a value is a hundredth larger."""
    source, resident = read_source(file), Resident.of(open_case(file))
    old = at(source.top, where)
    assert resident is not None
    assert isinstance(source.top, MappingNode)
    assert isinstance(old, Scalar)
    top = put(source.top, where, replace(old, text=next(variations(old.text))))
    taken, sent = [], b""
    for _ in range(times):
        begun = process_time()
        assignment, _ = catalogue.understood(Source(str(file), top=top), file)
        assert assignment is not None
        sent = resident.sampled(assignment, seen)
        taken.append(1e3 * (process_time() - begun))
    return Drawn(float(np.median(taken)), len(sent) / 1e3)


@contextmanager
def copied(name: str) -> Iterator[Path]:
    """A file of the repository, with those beside it, where it can be written."""
    original = ROOT / "assignments" / name
    with tempfile.TemporaryDirectory(prefix="bench-") as folder:
        for file in original.parent.glob("*.yaml"):
            shutil.copy(file, folder)
        yield Path(folder) / original.name


def page_time(driver: Any) -> float:
    """The processor time (s) that the main thread of the page has taken."""
    driver.execute_cdp_cmd("Performance.enable", {"timeDomain": "threadTicks"})
    metrics = driver.execute_cdp_cmd("Performance.getMetrics", {})["metrics"]
    return float(next(one["value"] for one in metrics if one["name"] == "TaskDuration"))


def felt(driver: Any, name: str, where: tuple[str, ...], times: int = TIMES) -> Felt:
    """What a browser feels of the form of a file."""
    field = f"f:{path_text(where)}"
    with copied(name) as file, edited(file, opener()) as server:
        driver.get(server.address)
        view = driver.execute_script("return performance.getEntriesByType('navigation')[0].loadEventEnd") / 1e3
        # The report is there, and what belongs to which link.
        sleep(SETTLED)
        driver.execute_async_script(DRAG, field, 3)
        begun, busy = process_time(), page_time(driver)
        frames = driver.execute_async_script(DRAG, field, times)
        own, page = 1e3 * (process_time() - begun) / times, 1e3 * (page_time(driver) - busy) / times
        keys = driver.execute_async_script(KEYS, field, KEYSTROKES)
        files, machines = [], []
        for _ in range(5):
            sleep(SETTLED)
            old = driver.execute_script("return document.getElementById(arguments[0]).dataset.was", field)
            before = file.stat().st_ctime_ns
            typed, shown = driver.execute_async_script(TYPE, field, next(variations(old)))
            # The machine may be drawn before the file is written.
            while (written := file.stat().st_ctime_ns) == before:
                sleep(0.001)
            files.append(written / 1e6 - typed)
            machines.append(shown - typed)
        paint, shift = driver.execute_async_script(SEEN)
        middles = [*np.quantile(keys, (0.5, 0.95)), *np.quantile(frames, (0.5, 0.95))]
        return Felt(paint / 1e3, view, shift, *middles, own, page, float(np.median(files)), float(np.median(machines)))


def table(samples: dict[str, tuple[Drawn, Drawn]], feelings: dict[str, Felt]) -> Iterator[str]:
    """The measurements in Markdown, as `docs/explanation/speed.md` has them."""
    yield "| file | all samples of a changed value | sent | share of the time in sight | sent in sight |"
    yield "| --- | --- | --- | --- | --- |"
    for name, (part, cost) in samples.items():
        _, milliseconds, kilobytes = DRAWN[name]
        whole = f"{cost.milliseconds:.0f} ms (≤ {milliseconds}) | {cost.kilobytes:.0f} kB (≤ {kilobytes})"
        in_sight = f"{100 * part.milliseconds / cost.milliseconds:.0f} % | {part.kilobytes:.0f} kB"
        yield f"| `{Path(name).stem}` | {whole} | {in_sight} |"
    if not feelings:
        return
    yield ""
    aims = (
        "first paint, first view (≤ 1 s)",
        "layout shift (≤ 0.1)",
        "frame after a key (≤ 100 ms, 95 % ≤ 150 ms)",
        "from frame to frame of a value drawn (≤ 50 ms)",
        "file (≤ 50 ms)",
        "machine (≤ 0.3 s)",
    )
    yield f"| form | {' | '.join(aims)} |"
    yield "| --- |" + " --- |" * len(aims)
    for name, cost in feelings.items():
        own = f"of which {cost.own:.0f} the program's, {cost.page:.0f} the page's"
        frame = f"{cost.frame:.0f}, {cost.slow_frame:.0f} ms, {own}"
        seen = f"{cost.paint:.2f}, {cost.view:.2f} s | {cost.shift:.3f}"
        key = f"{cost.key:.0f}, {cost.slow_key:.0f} ms"
        after = f"{cost.file:.0f} ms | {cost.machine / 1e3:.2f} s"
        yield f"| `{Path(name).stem}` | {seen} | {key} | {frame} | {after} |"


def main() -> int:
    """Measure and print; 0 also where there is no browser to measure in."""
    samples = {}
    for name, (where, _, _) in DRAWN.items():
        file = ROOT / "assignments" / name
        samples[name] = drawn(file, where, SIGHT), drawn(file, where, None)
    feelings: dict[str, Felt] = {}
    driver = browser()
    if driver is None:
        print("no browser here: chromium and chromedriver are not installed", file=sys.stderr)
    else:
        driver.set_script_timeout(120)
        try:
            feelings = {name: felt(driver, name, where) for name, (where, _, _) in DRAWN.items()}
        finally:
            driver.quit()
    print(*table(samples, feelings), sep="\n")
    print(f"\n{os.cpu_count()} processors, {os.getloadavg()[0]:.1f} busy")
    return 0


if __name__ == "__main__":
    sys.exit(main())
