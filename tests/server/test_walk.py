"""A class from the empty folder to the released mark, in a browser: on a desktop and a phone, in both languages."""

from __future__ import annotations

import csv
import json
import socket
import sqlite3
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import pytest

from reportgen.cases import open_case
from reportgen.marking.toleranced_key import Ask, key_of
from tests.page.browser import Browser, axe, opened
from tests.server.walk import Walk

SPEC = """
kind: slider-crank
salt: walk
report: {language: vi, worked_positions: [2]}
positions: {count: 8}
parameters:
  r: {from: 130 mm, to: 170 mm, step: 5 mm}
  l: 600 mm
  n: 300 rpm
"""
ROSTER = "id,name,class\nK01,Nguyễn Hoàng An,K58\nK02,Trần <b>Ánh</b>,K58\nK03,Lê Chi,K58\n"
POLICY = "ask: [velocity]\nbrowser: {closes: 2099-11-20 23:59, checks: 5, uploads: 3}\n"


CELL = "input[data-id='{id}']"


@dataclass(frozen=True)
class Class:
    """A class that is being served."""

    folder: Path
    desk: str
    """The link of the instructor."""

    @property
    def address(self) -> str:
        return self.desk.partition("/in/")[0]

    def right(self, id: str, scales: bool) -> dict[tuple[str, int], str]:
        """The right values of a student's sheet, as typed in Vietnamese."""
        key = Ask(("velocity",)).of(key_of(open_case(self.folder / "variants" / f"{id}.yaml", "vi")))
        return {
            (row.id, position): f"{row.printed[row.at(position)]:.6g}".replace(".", ",")
            for row in key.asked
            for position in row.positions
            if scales or row.role == "asked"
        }


def command(*arguments: str | Path) -> list[str]:
    return [sys.executable, "-m", "reportgen.cli", "serve", *map(str, arguments)]


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Class]:
    """A class made by the command in a folder that did not exist."""
    pytest.importorskip("starlette")
    home = tmp_path_factory.mktemp("walk")
    for name, text in (("spec.yaml", SPEC), ("roster.csv", ROSTER), ("policy.yaml", POLICY)):
        (home / name).write_text(text, encoding="utf-8")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = str(free.getsockname()[1])
    folder = home / "class"
    made = subprocess.run(
        command(
            folder,
            home / "roster.csv",
            "--init",
            "--spec",
            home / "spec.yaml",
            "--policy",
            home / "policy.yaml",
            "--port",
            port,
        ),
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    with subprocess.Popen(
        command(folder, "--port", port), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as server:
        for _ in range(300):
            try:
                urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=5).close()
                break
            except OSError:
                time.sleep(0.1)
        try:
            yield Class(folder, made.stdout.split()[-1])
        finally:
            server.terminate()


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with opened() as one:
        yield one


def hands_in(student: Walk, served: Class, id: str, link: str, tmp_path: Path, scales: bool) -> None:
    """A student's way: the link, the machine, the sheet with a wrong value, a check, a file, the hand-in."""
    student.open(link)
    student.until("location.pathname === '/me'")
    student.speak()
    student.press("#moving summary")
    student.until("document.querySelector('#moving iframe').src.endsWith('machine.html')")
    values = served.right(id, scales)
    (first, right), *others = values.items()
    student.fill({first: "12345", **dict(others)})
    student.until("document.getElementById('saving').dataset.state === 'saved'")
    student.press("[data-check=velocity]")
    student.until("document.querySelector('.cell.wrong') !== null")
    left = student.text("#left")
    assert "4" in left
    box = f"input[data-id='{first[0]}'][data-position='{first[1]}']"
    student.value(f'document.querySelector("{box}").select()')
    student.type(box, right)
    student.until(
        "document.getElementById('saving').dataset.state === 'saved' && !document.querySelector('.cell.wrong')"
    )
    file = tmp_path / "bản vẽ <i>.pdf"
    file.write_bytes(b"%PDF-1.4\n% a scan")
    student.choose("#file", file)
    student.press("#upload button")
    student.until("document.querySelector('#receipts .digest') !== null")
    assert student.value("document.querySelector('#receipts i') === null")
    student.look(f"student {id}")
    student.press("#hand-in")
    # With empty cells, such as that of the scale of the machine, the button asks once more.
    student.until("document.getElementById('hand-in').dataset.sure === 'yes'")
    student.press("#hand-in")
    student.until("document.getElementById('handed').innerText !== ''")


def link_of(desk: Walk, served: Class, id: str) -> tuple[str, str]:
    """The personal link and the code of a student, as an instructor sees them."""
    desk.open(f"{served.address}/desk/students/{id}")
    desk.press("[data-act=link]")
    desk.until("document.querySelector('#link input') !== null")
    return str(desk.value("document.querySelector('#link input').value")), desk.text("#link").split()[-1]


def marks(desk: Walk, served: Class) -> None:
    """An instructor's way: the table, one hand-in beside the key, the marking, the release."""
    desk.open(served.desk)
    desk.until("document.querySelectorAll('#students tbody tr').length === 3")
    desk.press("#mark")
    desk.until("!document.getElementById('mark').disabled && !document.getElementById('release').disabled")
    desk.look("desk")
    desk.press("#students tbody a")
    desk.until("document.querySelector('#cells .verdict') !== null")
    desk.look("hand-in")
    desk.value("history.back()")
    desk.until("document.querySelectorAll('#students tbody tr').length === 3")
    desk.press("#release")


def notice(served: Class, id: str, classmate: str) -> None:
    """Let the last marking have noticed that a student has values of another's sheet."""
    with closing(sqlite3.connect(served.folder / "server" / "class.db")) as database:
        ((content,),) = database.execute("SELECT content FROM marks WHERE folder = ?", (id,)).fetchall()
        about = {**json.loads(content), "notices": [{"kind": "a run of values", "classmate": classmate, "count": 12}]}
        database.execute("UPDATE marks SET content = ? WHERE folder = ?", (json.dumps(about), id))
        database.commit()


def end(desk: Walk, page: str) -> None:
    """Let the time of a student be over."""
    desk.open(page)
    desk.value("document.getElementById('new-deadline').value = '2026-01-01T00:00'")
    desk.press("#deadline button")
    desk.until("/01.01/.test(document.getElementById('closes').innerText)")


@pytest.mark.proof
def test_a_class_from_the_empty_folder_to_the_released_mark(served: Class, browser: Browser, tmp_path: Path) -> None:
    source = axe()
    an, anh = (Walk(browser, source, *screen) for screen in ((390, "vi"), (1280, "en")))
    desks = [Walk(browser, source, *screen) for screen in ((1280, "vi"), (390, "en"))]
    desks[0].open(served.desk)
    desks[0].until("location.pathname === '/desk'")
    link, _ = link_of(desks[0], served, "K01")
    _, code = link_of(desks[0], served, "K02")
    # A link on a page of another site, such as a mail, leads in.
    browser.driver.get(f"data:text/html,<a href={link}>link</a>")
    browser.driver.find_element("tag name", "a").click()
    an.until("location.pathname === '/me'")
    hands_in(an, served, "K01", f"{served.address}/me", tmp_path, scales=True)
    an.press("form[action='/out'] button")
    an.until("location.pathname === '/'")
    an.look("sign-in")

    # The second student types the number and the code.
    anh.open(f"{served.address}/")
    anh.type("#id", "k02")
    anh.type("#code", f"{code}\n")
    anh.until("location.pathname === '/me'")
    hands_in(anh, served, "K02", f"{served.address}/me", tmp_path, scales=False)
    anh.press("form[action='/out'] button")

    marks(desks[0], served)
    notice(served, "K02", "K01")
    desks[0].open(f"{served.address}/desk")
    desks[0].until("document.querySelector('#notices summary') !== null")
    desks[0].press("#notices summary")
    desks[0].until("document.querySelector('#notices tbody tr') !== null")
    desks[0].look("signs of copying")
    desks[0].until("document.getElementById('release').innerText !== ''")
    desks[1].open(f"{served.address}/desk")
    desks[1].until("document.querySelectorAll('#students tbody tr').length === 3")
    desks[1].look("desk on a phone")

    # Whoever can still hand in does not see the marks.
    end(desks[1], f"{served.address}/desk/students/K01")
    an.open(link)
    an.until("document.querySelector('#marked .mark') !== null")
    an.look("result")
    mark = an.text("#marked .mark strong")
    faults = {name: found for walk in (an, anh, *desks) for name, found in walk.seen.items() if found}
    assert faults == {}
    with (served.folder / "marked" / "grades.csv").open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.reader(file))
    marks_of_all = [float(row[rows[0].index("điểm số")].replace(",", ".")) for row in rows[1:] if row[0] < "K03"]
    assert (mark, marks_of_all) == ("10", [10, 9.4])


@pytest.mark.proof
def test_cells_outlive_a_lost_connection_and_are_the_same_in_two_tabs(served: Class, browser: Browser) -> None:
    student = Walk(browser, "", 390, "vi")
    student.open(served.desk)
    student.until("location.pathname === '/desk'")
    link, _ = link_of(student, served, "K03")
    student.open(link)
    student.until("location.pathname === '/me'")
    # One cell can be checked alone, by its own button.
    student.fill({("v.B", 0): "1,5"})
    student.press(CELL.format(id="v.B"))
    student.press(".single")
    student.until("document.querySelector('.cell.wrong') !== null")
    student.connect(False)
    student.type(CELL.format(id="v.C"), "2,5")
    student.until("document.getElementById('saving').dataset.state === 'unsaved'")
    student.value("location.replace('about:blank')")
    student.connect(True)
    student.open(f"{served.address}/me")
    student.until("document.getElementById('saving').dataset.state === 'saved'")
    assert student.value(f'document.querySelector("{CELL.format(id="v.C")}").value') == "2,5"
    student.open(f"{served.address}/me")
    assert student.value(f'document.querySelector("{CELL.format(id="v.C")}").value') == "2,5"
    first = browser.driver.current_window_handle
    browser.driver.switch_to.new_window("tab")
    browser.driver.get(f"{served.address}/me")
    student.type(CELL.format(id="v.CB"), "7")
    student.until("document.getElementById('saving').dataset.state === 'saved'")
    browser.driver.close()
    browser.driver.switch_to.window(first)
    student.until(f"document.querySelector(\"{CELL.format(id='v.CB')}\").value === '7'")

    # What did not come in time can still be seen.
    student.connect(False)
    student.replace(CELL.format(id="v.C"), "4,4")
    student.until("document.getElementById('saving').dataset.state === 'unsaved'")
    student.value("location.replace('about:blank')")
    student.connect(True)
    student.open(served.desk)
    student.until("location.pathname === '/desk'")
    end(student, f"{served.address}/desk/students/K03")
    student.open(link)
    student.until("location.pathname === '/me'")
    student.until("document.querySelector('.cell[data-state=refused]') !== null")
    assert "4,4" in student.text(".cell[data-state=refused] .state")
    assert student.value("document.querySelector('#hand-in, #upload') === null")
