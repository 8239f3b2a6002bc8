"""Typing at the form in a browser: nothing typed is lost, nothing is written that nobody typed."""

from __future__ import annotations

import random
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Event
from typing import Any

import pytest

from reportgen import catalogue
from reportgen.base.errors import Where
from reportgen.base.yaml_source import MappingNode, Scalar, read_text
from reportgen.page.edit_session import EditSession
from tests.lanes import matrix, proof
from tests.page.browser import Browser, opened
from tests.page.typist import PATIENCE, SHIFT, Model, Typist, edit_beside, form_alone, play, until, value

KIND = "slider-crank"
KEYS = ["r", "l", "n"]
BATCHES, SEQUENCES, PERSONS = 4, 50, 4
"""Two hundred sequences of things done at the form, by so many persons at a time."""
NOTE = "return document.querySelector('.conflict')?.firstChild.textContent || ''"
ORPHANS = "return document.getElementById('orphans').textContent"
SETTLE = "document.querySelector(`[data-settle=${arguments[0]}]`).click()"
EVENTS = """
window.unasked = [];
for (const name of ["change", "input"]) {
  addEventListener(name, (event) => { if (!event.isTrusted) window.unasked.push(name); }, true);
}
window.before = document.getElementById("f:parameters.l");
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (made := tmp_path / "mine.yaml").write_text(catalogue.sample(KIND, "en"), encoding="utf-8")
    return made


def texts(file: Path) -> dict[Where, str]:
    """All single values of a file by their places."""

    def below(node: object, where: Where) -> Iterator[tuple[Where, str]]:
        if isinstance(node, MappingNode):
            for key, held in node.entries:
                yield from below(held, (*where, key.text))
        elif isinstance(node, Scalar):
            yield where, "" if node.null else node.text

    return dict(below(read_text(file.read_text(encoding="utf-8")).top, ()))


@pytest.mark.parametrize("run", matrix(range(6), [0]))
def test_values_typed_along_are_written_as_typed(browser: Browser, file: Path, run: int) -> None:
    """From field to field with Tab at ordinary speed, while answers come at once or up to two seconds later."""
    chance = random.Random(run)
    with form_alone(file, lambda: chance.uniform(0, run / 5)) as server:
        browser.show(server.address, still=True)
        browser.run(EVENTS)
        typist = Typist(browser, 0.01 if run == 0 else 0.08)
        typist.replace("r", "145 mm")
        # The last but one has no unit: a button that mends it appears where Tab goes next.
        given = {"r": "145 mm", "l": "525 mm", "n": "85", "s": "0.4"}
        for key in ("l", "n", "s"):
            typist.press("Tab")
            typist.to_a_field()
            assert typist.focused() == ("parameters", key)
            typist.type(given[key])
        typist.press("Tab", SHIFT)
        typist.to_a_field(SHIFT)
        assert typist.focused() == ("parameters", "n")
        typist.type(given.setdefault("n", ""))
        typist.press("Enter")
        typist.idle()
        assert {key: value(file, ("parameters", key)) for key in given} == given
        assert browser.run("return window.unasked") == []
        assert browser.run("return window.before.isConnected"), "no field was replaced"


def test_what_was_typed_for_a_key_that_is_gone_is_kept_until_discarded(browser: Browser, file: Path) -> None:
    """It is shown with a button; when the key is back, it is written."""
    old = file.read_text(encoding="utf-8")
    (line,) = (line for line in old.splitlines() if line.strip().startswith("n:"))
    new = old.replace(line, "  omega1: 9 rad/s")
    with form_alone(file, lambda: 0.2) as server:
        browser.show(server.address, still=True)
        typist = Typist(browser)
        for back in (False, True):
            typist.replace("n", "85 rpm")
            file.write_text(new, encoding="utf-8")
            typist.shows("omega1", "9 rad/s")
            typist.click("f:parameters.r")
            until(lambda: "“85 rpm” for parameters.n" in browser.run(ORPHANS))
            if not back:
                browser.run("document.querySelector('#orphans button').click()")
                typist.idle()
                assert file.read_text(encoding="utf-8") == new
            file.write_text(old, encoding="utf-8")
            until(lambda: browser.run("return document.getElementById('f:parameters.n') !== null"))
            typist.idle()
            assert not browser.run(ORPHANS)
            assert (value(file, ("parameters", "n")) == "85 rpm") == back


def test_an_editor_changes_what_is_being_typed(browser: Browser, file: Path) -> None:
    """Both values are shown, either can be chosen, and the field in which one types is never changed."""
    where = "parameters", "l"
    with form_alone(file) as server:
        browser.show(server.address, still=True)
        typist = Typist(browser)
        for chosen in ("mine", "theirs"):
            typist.replace("l", "170")
            edit_beside(file, where, "15" + str(len(chosen) - 3) + " mm")
            until(lambda: browser.run(NOTE))
            typist.type(" mm")
            assert browser.run("return document.activeElement.value") == "170 mm"
            typist.press("Tab")
            time.sleep(0.2)
            there = value(file, where)
            assert there in ("151 mm", "153 mm"), "nothing is overwritten"
            assert {"170 mm", there} <= set(browser.run(NOTE).replace(": ", " · ").replace(" (", " · ").split(" · "))
            browser.run(SETTLE, chosen)
            typist.idle()
            assert value(file, where) == (there if chosen == "theirs" else "170 mm")
            assert browser.run("return document.getElementById('f:parameters.l').value") == value(file, where)
            assert not browser.run(NOTE)


def test_what_is_typed_outlives_a_file_that_cannot_be_read(browser: Browser, file: Path) -> None:
    """An editor leaves half a line: the field stays, its value is written when the file is mended."""
    with form_alone(file) as server:
        browser.show(server.address, still=True)
        typist = Typist(browser)
        typist.replace("l", "170")
        whole = file.read_text(encoding="utf-8")
        file.write_text(whole.replace("positions:", "positions: ["), encoding="utf-8")
        until(lambda: browser.run("return document.querySelector('#problems li') !== null"))
        typist.type(" mm")
        assert browser.run("return document.activeElement.value") == "170 mm"
        typist.press("Enter")
        until(lambda: browser.run("return document.getElementById('refused').textContent"))
        assert "170" not in file.read_text(encoding="utf-8")
        file.write_text(whole, encoding="utf-8")
        typist.idle()
        assert value(file, ("parameters", "l")) == "170 mm"


def test_a_key_removed_beside_leaves_its_field_while_one_types(browser: Browser, file: Path) -> None:
    with form_alone(file) as server:
        browser.show(server.address, still=True)
        typist = Typist(browser)
        typist.replace("s", "0.3")
        text = file.read_text(encoding="utf-8")
        file.write_text(text.replace("  s: 0.5", "  # s: 0.5"), encoding="utf-8")
        until(lambda: browser.run(NOTE))
        typist.type("5")
        assert browser.run("return document.activeElement.value") == "0.35"
        browser.run(SETTLE, "mine")
        typist.idle()
        assert value(file, ("parameters", "s")) == "0.35"


def test_what_is_sent_in_a_pause_is_undone_with_the_rest(tmp_path: Path) -> None:
    """Half a value, the whole value: one step back leads to what was there before the typing."""
    (file := tmp_path / "mine.yaml").write_text(catalogue.sample(KIND, "en"), encoding="utf-8")
    begun, edited = file.read_bytes(), EditSession(lambda: pytest.fail("not opened"), "en", path=file)
    for was, text, typing in (("600 mm", "17", "a.1"), ("17", "170 mm", "a.1"), ("170 mm", "180 mm", "a.2")):
        edited.edit({"op": "set", "where": ["parameters", "l"], "value": text, "was": was, "typing": typing})
    undone = []
    for _ in range(3):
        edited.edit({"op": "undo"})
        undone.append(value(file, ("parameters", "l")))
    assert undone == ["170 mm", "600 mm", "600 mm"]
    assert file.read_bytes() == begun
    edited.edit({"op": "redo"})
    assert value(file, ("parameters", "l")) == "170 mm"


def test_answers_are_numbered(tmp_path: Path) -> None:
    """A page that is told of an older form than it shows can know it."""
    (file := tmp_path / "mine.yaml").write_text(catalogue.sample(KIND, "en"), encoding="utf-8")
    edited = EditSession(lambda: pytest.fail("not opened"), "en", path=file)
    first = edited.numbered_form()["revision"]
    answer = edited.edit({"op": "set", "where": ["parameters", "l"], "value": "170 mm"})
    assert (answer["revision"], answer["written"]) == (first + 1, "170 mm")
    assert edited.numbered_form()["revision"] == first + 1


def typed_at_random(browser: Browser, file: Path, seed: int) -> None:
    """Do anything at the form in any order, answers late, an editor beside it: the file is that of the model."""
    chance = random.Random(seed)
    longest = chance.choice([0.0, 0.05, 0.3]) if seed < 20 else chance.choice([0.0, 0.1, 0.5, 1.5])
    with form_alone(file, lambda: chance.uniform(0, longest)) as server:
        browser.show(server.address, still=True)
        model, log = Model(texts(file)), list[str]()
        play(Typist(browser), server, model, KEYS, seed, log)
        assert {where: text for where, text in texts(file).items() if text} == {
            where: text for where, text in model.values.items() if text
        }, log


def test_half_a_text_behind_a_slow_answer_is_not_written_once_it_is_typed_on(browser: Browser, file: Path) -> None:
    """The half that rested while another change was on its way is never sent."""
    gate, asked = Event(), []
    with form_alone(file, lambda: 0.0 if gate.wait(PATIENCE) else 1.0) as server:
        assert isinstance(server.session, EditSession)
        late = server.session.edit

        def recorded(change: Any) -> Any:
            asked.append((change["where"][-1], change["value"]))
            return late(change)

        server.session.edit = recorded  # type: ignore[method-assign]
        browser.show(server.address, still=True)
        typist = Typist(browser)
        typist.replace("l", "525 mm")
        typist.replace("r", "1")
        until(lambda: browser.run("return drafts.due().length"))
        typist.type("45 mm")
        gate.set()
        typist.idle()
    assert (value(file, ("parameters", "r")), asked) == ("145 mm", [("l", "525 mm"), ("r", "145 mm")])


@pytest.mark.parametrize("seed", range(5))
def test_the_file_has_what_was_typed(browser: Browser, file: Path, seed: int) -> None:
    typed_at_random(browser, file, seed)


@proof
@pytest.mark.parametrize("batch", range(BATCHES))
def test_the_files_have_what_many_typed(batch: int, tmp_path: Path) -> None:
    """Persons at browsers of their own, as most of the time each of them waits."""

    def sit(person: int) -> None:
        with opened() as browser:
            for seed in range(batch * SEQUENCES + person, (batch + 1) * SEQUENCES, PERSONS):
                (file := tmp_path / f"{seed}.yaml").write_text(catalogue.sample(KIND, "en"), encoding="utf-8")
                typed_at_random(browser, file, seed)
                browser.rest()

    with ThreadPoolExecutor(PERSONS) as room:
        for _ in room.map(sit, range(PERSONS)):
            pass
