"""A person at the form for tests: keys, clicks and an editor beside it, and a model of what the file should then have.

The server of the form does everything but make the machine: its file is never opened as a case, so that thousands of
changes take no time.  Answers can be delayed.
"""

from __future__ import annotations

import json
import random
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from reportgen.base.errors import ReportgenError, Where
from reportgen.base.yaml_source import Scalar, read_text
from reportgen.base.yaml_values import at
from reportgen.case import Case
from reportgen.page.edit_session import EditSession
from reportgen.page.file_watch import edited
from reportgen.page.form_fields import written_at
from reportgen.page.local_server import Server
from tests.page.browser import Browser

PATIENCE = 120.0
"""A page that has not come to rest after this time (s) hangs, however busy the processors are."""
REST = 2.0
"""The form writes what is typed after this time without a key (s)."""
FOCUSED = """
const field = document.activeElement;
return field.matches("#fields input:not([type=range], [data-list])") && field.dataset.was !== undefined
  ? field.dataset.w : null;
"""
"""The place of the text field that has the focus."""
IDLE = """
const words = JSON.parse(document.getElementById("live").textContent).words;
return document.getElementById("saved").textContent === words.saved && !drafts.places().length;
"""
STATE = """
const text = (name) => document.getElementById(name).textContent;
return [text("saved"), text("refused"), JSON.stringify(drafts.kept()), document.activeElement.outerHTML.slice(0, 200)];
"""
"""What a page that does not come to rest is at."""
SENT = """
const words = JSON.parse(document.getElementById("live").textContent).words;
return document.getElementById("saved").textContent !== words.saving && drafts.places().every(drafts.isOpen);
"""
"""Whether all that was typed is in the file, but for what is being typed."""
SHOWN = "return document.getElementById(arguments[0])?.dataset.was === arguments[1]"
CENTRE = """
const field = document.getElementById(arguments[0]);
field.scrollIntoView({ block: "center" });
const { left, top, width, height } = field.getBoundingClientRect();
return [left + width / 2, top + height / 2];
"""
CODES = {"Tab": 9, "Enter": 13, "Escape": 27, "End": 35, "ArrowRight": 39, "a": 65, "y": 89, "z": 90}
CONTROL, SHIFT = 2, 8


def until(condition: Callable[[], object], told: Callable[[], object] = lambda: "") -> None:
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end, told()
        time.sleep(0.02)


@contextmanager
def form_alone(file: Path, delay: Callable[[], float] = lambda: 0.0) -> Iterator[Server]:
    """The form of a file without its machine, whose answers to changes come so much later (s)."""

    def no_case(*_: Any, **__: Any) -> Case:
        raise ReportgenError("no machine here")

    with edited(file, no_case, "en") as server:
        session = server.session
        assert isinstance(session, EditSession)
        edit = session.edit

        def late(asked: Any) -> Any:
            time.sleep(delay())
            answer = edit(asked)
            time.sleep(delay())
            return answer

        session.edit = late  # type: ignore[method-assign]
        yield server


@dataclass
class Typist:
    """Presses keys and the mouse in a browser that shows a form."""

    browser: Browser
    gap: float = 0.0
    """From key to key (s)."""
    halves: set[str] = field(default_factory=set)
    """Beginnings of texts that were followed by a rest. On a busy computer, any two keys can be that far apart."""

    def type(self, text: str) -> None:
        last = time.monotonic()
        for count, letter in enumerate(text):
            begun = time.monotonic()
            self.browser.command("Input.dispatchKeyEvent", type="keyDown", key=letter, text=letter)
            self.browser.command("Input.dispatchKeyEvent", type="keyUp", key=letter)
            if time.monotonic() - last >= REST:
                self.halves.add(text[:count])
            last = begun
            time.sleep(self.gap)

    def press(self, key: str, modifiers: int = 0) -> None:
        pressed: dict[str, Any] = {"key": key, "code": key, "windowsVirtualKeyCode": CODES[key], "modifiers": modifiers}
        if key == "Enter":
            pressed["text"] = "\r"
        if (key, modifiers) == ("a", CONTROL):
            pressed["commands"] = ["selectAll"]
        self.browser.command("Input.dispatchKeyEvent", type="keyDown" if "text" in pressed else "rawKeyDown", **pressed)
        self.browser.command("Input.dispatchKeyEvent", type="keyUp", **pressed)
        time.sleep(self.gap)

    def click(self, name: str) -> None:
        """Click on the field with an id; who has missed it, as it moved meanwhile, clicks again."""

        def clicked() -> object:
            x, y = self.browser.run(CENTRE, name)
            for kind in ("mousePressed", "mouseReleased"):
                self.browser.command("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
            return self.browser.run("return document.activeElement.id === arguments[0]", name)

        until(clicked)

    def idle(self) -> None:
        """Wait until everything typed is in the file and the page knows."""
        until(lambda: self.browser.run(IDLE), lambda: self.browser.run(STATE))

    def shows(self, key: str, text: str) -> None:
        """Wait until the page knows what a parameter is in the file."""
        until(lambda: self.browser.run(SHOWN, f"f:parameters.{key}", text))

    def focused(self) -> Where | None:
        """The place of the text field that has the focus."""
        found = self.browser.run(FOCUSED)
        return None if found is None else tuple(json.loads(found))

    def enter(self) -> None:
        """Press Enter in a text field; on a button it would be a click."""
        if self.focused() is not None:
            self.press("Enter")

    def to_a_field(self, modifiers: int = 0) -> None:
        """Go on with Tab, past sliders and buttons, until a text field has the focus."""
        for _ in range(8):
            if self.focused() is not None:
                return
            self.press("Tab", modifiers)
        raise AssertionError("no text field")

    def replace(self, key: str, text: str) -> None:
        """Click on a parameter and type over it."""
        self.click(f"f:parameters.{key}")
        self.press("a", CONTROL)
        self.type(text)


def value(file: Path, where: Where) -> str:
    """What a file has at a place, as it is typed there."""
    return written_at(at(read_text(file.read_text(encoding="utf-8")).top, where))


def edit_beside(file: Path, where: Where, text: str) -> None:
    """Change a value of the file as an editor does."""
    old = file.read_text(encoding="utf-8")
    node = at(read_text(old).top, where)
    assert isinstance(node, Scalar)
    file.write_text(old[: node.span[0]] + text + old[node.span[1] :], encoding="utf-8")


@dataclass
class Model:
    """What should be in the file: a text by its place, and the states to which undo and redo lead."""

    values: dict[Where, str]
    typing: tuple[Where, str] | None = None
    done: list[tuple[dict[Where, str], dict[Where, str]]] = field(default_factory=list)
    undone: list[tuple[dict[Where, str], dict[Where, str]]] = field(default_factory=list)

    def commit(self) -> None:
        """What is typed is in the file after Enter, Tab or a click elsewhere."""
        if self.typing is not None:
            where, text = self.typing
            if self.values.get(where, "") != text:
                before = dict(self.values)
                self.values[where] = text
                self.done.append((before, dict(self.values)))
                self.undone.clear()
        self.typing = None

    def pause(self, there: str, halves: Collection[str]) -> None:
        """Enter that the form has written the typed text, or an earlier one of the same field, after a rest.

        Of a text that was typed on, only those `halves` are written that had a rest after them.
        """
        typing = self.typing
        if typing is not None and self.values.get(typing[0], "") != there:
            assert there in TEXTS or there in halves, "half a text is never written between two keys"
            self.typing = typing[0], there
            self.commit()
            self.typing = None if typing[1] == there else typing

    def step(self, back: bool) -> None:
        """Undo or redo, unless another program has written since."""
        steps, others = (self.done, self.undone) if back else (self.undone, self.done)
        if not steps:
            return
        before, after = steps[-1]
        if self.values != (after if back else before):
            steps.clear()
            return
        others.append(steps.pop())
        self.values = dict(before if back else after)


TEXTS = "145 mm", "525 mm", "85", "0.25", "60 rpm", "1/3.6", "1e3 N", "abc", "x: y # z"


def play(typist: Typist, server: Server, model: Model, keys: list[str], seed: int, log: list[str]) -> None:
    """Do ten things at random at the form and in the model, and log what was done, for a failure to show."""
    session = server.session
    assert isinstance(session, EditSession)
    file, lock = session.path, session.lock
    chance = random.Random(seed)
    for _ in range(10):
        act = chance.choice(["field", "field", "tab", "tab", "back", "enter", "undo", "redo", "pause", "editor"])
        text = chance.choice(TEXTS)
        log.append(act)
        match act:
            case "field":
                key = chance.choice(keys)
                typist.click(f"f:parameters.{key}")
                typist.press("a", CONTROL)
                _typed(typist, model, text)
            case "tab" | "back":
                typist.press("Tab", SHIFT if act == "back" else 0)
                model.commit()
                for _ in range(chance.randrange(3)):
                    typist.press("Tab", SHIFT if act == "back" else 0)
                # Tab selects all of a text field, so that what is typed takes its place.
                if typist.focused() is not None:
                    _typed(typist, model, text)
            case "enter":
                typist.enter()
                model.commit()
            case "undo" | "redo":
                typist.enter()
                model.commit()
                typist.press("z" if act == "undo" else "y", CONTROL)
                model.step(act == "undo")
            case "pause":
                time.sleep(chance.uniform(0, 0.8))
            case "editor":
                key = chance.choice(keys)
                where = ("parameters", key)
                if model.typing is not None and model.typing[0] == where:
                    continue
                # Which of two programs writes first is theirs to say; here the form has written what it was sent.
                until(lambda: typist.browser.run(SENT))
                text = chance.choice(["31 mm", "32 mm", "33 mm"])
                with lock:
                    # With a change beside it, what was written after a rest is a step of its own.
                    if model.typing is not None and model.values.get(where) != text:
                        model.pause(value(file, model.typing[0]), typist.halves)
                    edit_beside(file, where, text)
                model.values[where] = text
                typist.shows(key, text)
        log[-1] += f" {typist.focused()} {text}"
    typist.enter()
    model.commit()
    typist.idle()


def _typed(typist: Typist, model: Model, text: str) -> None:
    where = typist.focused()
    assert where is not None
    if model.typing is not None and model.typing[0] != where:
        model.commit()
    typist.type(text)
    model.typing = where, text
