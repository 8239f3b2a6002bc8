"""`reportgen edit` in a browser: what is drawn follows a slider, what is typed goes to the file, a fault is told."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pytest

from reportgen import catalogue
from reportgen.base.units import Language
from reportgen.base.yaml_source import read_text
from reportgen.base.yaml_values import at
from reportgen.cases import opener
from reportgen.page.file_watch import edited
from tests.lanes import proof
from tests.page.browser import Browser, axe

PATIENCE = 30.0
AT_REST = 40
"""So many looks (2 s) at a page on which nothing changes."""
TYPE = """
const field = document.getElementById(arguments[0]);
field.focus();
field.value = arguments[1];
for (const name of ["input", "change"]) field.dispatchEvent(new Event(name, { bubbles: true }));
"""
SLIDE = """
const bar = document.getElementById(arguments[0]).closest(".field").querySelector("[type=range]");
bar.value = arguments[1];
bar.dispatchEvent(new Event("input", { bubbles: true }));
"""
PRESS = """
const field = document.getElementById(arguments[0]);
field.focus();
for (const key of arguments[1]) field.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
"""
PASTE = """
const clipboardData = new DataTransfer();
clipboardData.setData("text", arguments[1]);
const cell = document.querySelector(`.tabled [data-row="${arguments[0]}"][data-column="1"]`);
cell.dispatchEvent(new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true }));
"""
POINTED = """
const spot = (name) => extended.get(moving.root).spotAt(name) ?? [0, 0];
const [a, b] = [spot(arguments[0]), spot(arguments[1])];
const drawing = document.querySelector("[data-stage=machine] svg");
const { x, y } = new DOMPoint((a[0] + b[0]) / 2, (a[1] + b[1]) / 2).matrixTransform(drawing.getScreenCTM());
drawing.dispatchEvent(new PointerEvent("pointermove", { clientX: x, clientY: y, bubbles: true }));
return [...document.querySelectorAll(".field.own [data-w]")].map((one) => one.id);
"""
HOLD = """
const fetched = window.fetch;
window.fetch = (name, ...more) => name === "drag.json" ? fetched(name, ...more) : new Promise(() => {});
"""
"""Nothing is answered any more but what a machine with another value looks like."""
REFUSED = "return document.getElementById('refused').textContent"
IN_SIGHT = """
const { left, top } = document.getElementById("refused").getBoundingClientRect();
return document.elementFromPoint(left + 5, top + 5)?.id === "refused";
"""
PLACE = "return document.querySelector('[data-stage=machine] svg').innerHTML"

SHAPE = """
const told = ["d", "points", "x1", "y1", "x2", "y2", "cx", "cy", "transform"];
const parts = [...document.querySelectorAll("[data-stage=machine] svg *")];
return parts.map((part) => told.map((name) => part.getAttribute(name) ?? "").join(" "));
"""
"""Where everything of the machine stands; what is highlighted on it comes last."""


def until(condition: Callable[[], object]) -> None:
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


def settled(browser: Browser) -> list[str]:
    """The machine as it stands when its page has been made and nothing moves any more."""
    seen: list[list[str]] = []

    def stands() -> bool:
        seen.append(list(browser.run(SHAPE)))
        return len(seen) > AT_REST and all(one == seen[-1] for one in seen[-AT_REST:])

    until(stands)
    return seen[-1]


@contextmanager
def editing(*arguments: object, folder: Path | None = None) -> Iterator[str]:
    """The command: the address that it prints, until Ctrl-C."""
    command = [sys.executable, "-m", "reportgen.cli", "edit", *map(str, arguments), "--no-open"]
    # It hears of Ctrl-C also where the tests run in the background.
    heard = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, preexec_fn=heard, cwd=folder)
    assert process.stdout is not None
    try:
        yield process.stdout.readline().strip()
    finally:
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE) == 0


def written(file: Path, *where: str) -> str:
    node = at(read_text(file.read_text(encoding="utf-8")).top, ("parameters", *where))
    return getattr(node, "text", "")


@proof
def test_a_file_is_begun_changed_and_put_right(browser: Browser, tmp_path: Path) -> None:
    """From a kind to a machine with another crank: slider, typed values, a fault with its remedy, undo, an editor."""
    file = tmp_path / "mine.yaml"
    with editing("slider-crank", "-o", file, "--lang", "en", "--out", tmp_path / "out") as address:
        begun = file.read_text(encoding="utf-8")
        assert begun == catalogue.sample("slider-crank", "en")
        browser.show(address, still=True)
        here = browser.run(PLACE)
        browser.run(SLIDE, "f:parameters.r", 160)
        until(lambda: browser.run(PLACE) != here)
        assert file.read_text(encoding="utf-8") == begun, "nothing is written while a value is drawn"
        browser.run(PRESS, "f:parameters.r", ["Escape"])
        until(lambda: browser.run("return document.getElementById('f:parameters.r').value") == "150 mm")
        until(lambda: "f:parameters.r" in browser.run(POINTED, "A", "B"))
        browser.run(TYPE, "f:parameters.l", "650")
        until(lambda: written(file, "l") == "650")
        until(lambda: browser.run("return document.querySelector('#problems li')?.textContent || ''"))
        assert browser.run("return document.body.classList.contains('stale')")
        browser.run("document.querySelector('[data-goto]').click()")
        assert browser.run("return document.activeElement.id") == "f:parameters.l"
        browser.run("document.querySelector('[data-remedy]').click()")
        until(lambda: written(file, "l") == "650 mm")
        browser.run("document.getElementById('undo').click()")
        browser.run("document.getElementById('undo').click()")
        until(lambda: file.read_text(encoding="utf-8") == begun)
        browser.run("document.querySelector('[data-make=pdf]').click()")
        # What an editor writes meanwhile is in the form.
        file.write_text(begun.replace("r: 150 mm", "r: 160 mm"), encoding="utf-8")
        until(lambda: browser.run("return document.getElementById('f:parameters.r')?.value") == "160 mm")
        until(lambda: browser.run("return document.querySelector('#making a')?.textContent || ''"))
        assert (tmp_path / "out" / "mine" / "report.pdf").read_bytes().startswith(b"%PDF-")
        assert not [message for message in browser.messages() if "favicon" not in message]


@proof
def test_a_typed_value_moves_the_machine_before_anything_is_made_anew(browser: Browser, tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    with editing("slider-crank", "-o", file, "--lang", "en") as address:
        begun = file.read_text(encoding="utf-8")
        browser.show(address, still=True)
        here = settled(browser)
        browser.run(HOLD)
        browser.run(TYPE, "f:parameters.r", "160 mm")
        until(lambda: browser.run(SHAPE)[: len(here)] != here)
        assert file.read_text(encoding="utf-8") == begun


@proof
@pytest.mark.parametrize(
    ("kind", "key", "language", "width", "dark"),
    [("engine-twin", "H", "vi", 360, True), ("shaper", "a", "en", 1440, False)],
)
def test_the_form_can_be_used_by_all(
    browser: Browser, tmp_path: Path, kind: str, key: str, language: Language, width: int, dark: bool
) -> None:
    """axe finds nothing, nothing is scrolled sideways, a key alone changes a value, cells of a workbook are taken."""
    (file := tmp_path / "mine.yaml").write_text(catalogue.sample(kind, language), encoding="utf-8")
    with edited(file, opener()) as server:
        before = written(file, key)
        browser.show(server.address, width=width, height=800, dark=dark, still=True)
        assert browser.run("return document.documentElement.scrollWidth <= innerWidth")
        browser.run(PRESS, f"f:parameters.{key}", ["ArrowUp", "Enter"])
        until(lambda: re.fullmatch(r"\d+ mm", written(file, key)) and written(file, key) != before)
        if kind == "engine-twin":
            text = file.read_text(encoding="utf-8")
            browser.run(PASTE, 1, "-2,4\t24\n")
            changed = text.replace("1.0, -2.5, -2.5", "1.0, -2.4, -2.5", 1).replace("[28,  23.2, ", "[28,  24, ")
            assert changed != text
            until(lambda: file.read_text(encoding="utf-8") == changed)
            browser.run("document.querySelector('.tabled').scrollIntoView()")
            browser.run(PASTE, 1, "0\t0\n" * 3000)
            until(lambda: re.findall(r"\d+", browser.run(REFUSED)) == ["3001", "2000"])
            assert browser.run(IN_SIGHT), "where the table is"
            assert file.read_text(encoding="utf-8") == changed
            # Of a ratio it is the lower number that is changed: 1/3.6.
            browser.run(PRESS, "f:parameters.lambda", ["ArrowUp", "ArrowUp", "Enter"])
            until(lambda: written(file, "lambda") == "1/3.8")
        # What stands beside the form is looked at by itself.
        assert browser.violations(axe(), "#form") == []


@proof
def test_the_form_of_a_chosen_kind_begins_at_its_top(browser: Browser, tmp_path: Path) -> None:
    """The button of the last kind is far down; its form is seen from the first field, with the machine."""
    with editing("--lang", "en", folder=tmp_path) as address:
        browser.show(address, still=True)
        browser.run("document.querySelector('[data-kind=toggle-press]').scrollIntoView()")
        browser.run("scrollTo(0, document.body.scrollHeight)")
        assert browser.run("return scrollY") > 0
        browser.run("document.querySelector('[data-kind=toggle-press]').click()")
        until(lambda: browser.run("return document.getElementById('saved') !== null"))
        assert browser.run("return scrollY") == 0
    assert (tmp_path / "toggle-press.yaml").is_file()
