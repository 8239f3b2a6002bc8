"""`reportgen watch` as a user meets it: the page follows the file, a fault is shown and goes, Ctrl-C ends it."""

from __future__ import annotations

import errno
import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from reportgen.base import words, yaml_source
from reportgen.base.errors import TemplateError
from reportgen.base.template_folders import languages, search_path
from reportgen.case import Case
from reportgen.cases import open_case
from reportgen.cli import app
from reportgen.page import live_view, local_server
from reportgen.page.file_watch import edited
from reportgen.page.html import Panel
from reportgen.page.live_view import LiveSession
from reportgen.page.local_server import Server
from tests.lanes import matrix, proof
from tests.page.browser import Browser
from tests.report import built

FILE = built.ROOT / "assignments" / "slider-crank-02.yaml"
PATIENCE = 20.0


def until(condition: Callable[[], object], patience: float = PATIENCE) -> None:
    end = time.monotonic() + patience
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    copy = tmp_path / "given.yaml"
    copy.write_text(FILE.read_text(encoding="utf-8"), encoding="utf-8")
    return copy


@contextmanager
def watching(file: Path, *options: str) -> Iterator[tuple[str, subprocess.Popen[str]]]:
    """The command on a file: the address that it prints, its process."""
    process = subprocess.Popen(
        [sys.executable, "-m", "reportgen.cli", "watch", str(file), "--no-open", *options],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # Tests that run in the background hear no Ctrl-C, and neither would what they start.
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),
    )
    try:
        assert process.stdout is not None
        yield process.stdout.readline().strip(), process
    finally:
        process.kill()
        process.wait()


@proof
def test_the_page_follows_the_file(file: Path, browser: Browser) -> None:
    given = FILE.read_text(encoding="utf-8")
    typed = "  r: 0.2 m"
    with watching(file) as (address, process):
        browser.show(address, still=True)
        report = "return document.getElementById('report').textContent"
        until(lambda: "30" in browser.run(report) and len(browser.run(report)) > 5000)
        browser.run("moving.seek(77); document.querySelector('[data-panel=values]').open = false; scrollTo(0, 6000);")
        place, drawn = (
            browser.run("return scrollY"),
            "return document.querySelectorAll('[data-spot]')[1].getAttribute('transform')",
        )
        before = browser.run(drawn)
        # Another number: the moving part first, then the report; what the reader chose stays.
        file.write_text(given.replace(typed, "  r: 0.21 m"), encoding="utf-8")
        until(lambda: browser.run(drawn) != before)
        state = "return document.getElementById('state').textContent"
        until(lambda: browser.run(state) and "…" not in browser.run(state))
        assert browser.run("return [moving.angle(), document.querySelector('[data-panel=values]').open]") == [77, False]
        assert browser.run("return scrollY") == pytest.approx(place, abs=300)
        # A fault: line, column and hint over the last good page, until it is mended.
        file.write_text(given.replace(typed, "  r: 0.2 kg"), encoding="utf-8")
        until(lambda: not browser.run("return document.getElementById('fault').hidden"))
        line = 1 + given.splitlines().index(typed)
        shown = browser.run("return document.getElementById('fault').textContent")
        assert f"given.yaml:{line}:" in shown
        assert "error[wrong-unit]" in shown
        assert "hint" in shown
        assert len(browser.run(report)) > 5000
        file.write_text(given, encoding="utf-8")
        until(lambda: browser.run("return document.getElementById('fault').hidden"))
        until(lambda: browser.run(drawn) == before)
        assert browser.messages() == []
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE) == 0
        assert process.stderr is not None
        assert process.stderr.read() == ""


@proof
def test_a_faulty_file_has_a_page_that_comes_when_it_is_mended(file: Path, browser: Browser) -> None:
    given = file.read_text(encoding="utf-8")
    file.write_text("kind: slider-crank\nnonsense: 1\n", encoding="utf-8")
    with watching(file) as (address, _):
        browser.show(address, still=True)
        until(lambda: "given.yaml:2:" in browser.run("return document.getElementById('fault').textContent"))
        # There is no last good report that it could show.
        lead = browser.run("return document.querySelector('#fault strong').textContent")
        assert lead in {words.load_words(search_path(language))["live"]["never"] for language in languages()}
        file.write_text(given, encoding="utf-8")
        until(lambda: browser.run("return document.getElementById('moving') !== null"))
        assert browser.run("return document.getElementById('fault').hidden")


def test_a_name_of_no_file_is_told_at_once(tmp_path: Path) -> None:
    result = CliRunner().invoke(app, ["watch", str(tmp_path / "mistyped.yaml"), "--no-open"])
    assert result.exit_code == 1
    assert "mistyped.yaml:1:1: " in result.stderr


@proof
def test_the_pdf_is_renewed_too(file: Path, tmp_path: Path) -> None:
    with watching(file, "--pdf", "--out", str(tmp_path / "out")) as (_, process):
        target = tmp_path / "out" / "given" / "report.pdf"
        until(target.exists)
        first = target.read_bytes()
        assert process.stdout is not None
        assert process.stdout.readline().strip() == str(target)
        file.write_text(file.read_text(encoding="utf-8").replace("variant:", "variant: 9 #"), encoding="utf-8")
        assert process.stdout.readline().strip() == str(target)
        assert target.read_bytes() != first
        assert [path.name for path in target.parent.glob("[!.]*")] == ["report.pdf"]


def news(address: str) -> dict[str, Any]:
    """What a page is told that asks now."""
    with urllib.request.urlopen(address + "news") as told:
        found: dict[str, Any] = json.loads(told.readline().decode().removeprefix("data: "))
    return found


def moved_away(folder: Path) -> None:
    folder.rename(folder.with_name("before"))
    folder.mkdir()


def pipe(folder: Path) -> None:
    (folder / "given.yaml").unlink()
    os.mkfifo(folder / "given.yaml")


@pytest.mark.parametrize("lose", matrix([moved_away, pipe], [pipe]))
def test_a_file_that_was_lost_is_told_and_goes_on_when_it_is_back(
    file: Path, tmp_path: Path, lose: Callable[[Path], None]
) -> None:
    folder = tmp_path / "work"
    folder.mkdir()
    file = file.rename(folder / file.name)
    given = file.read_text(encoding="utf-8")
    with watching(file) as (address, _):
        until(lambda: news(address)["moving"] == 1)
        lose(folder)
        until(lambda: "given.yaml:1:1: error[unreadable]" in news(address)["fault"])
        file.unlink(missing_ok=True)
        file.write_text(given, encoding="utf-8")
        until(lambda: not news(address)["fault"])
        moving = news(address)["moving"]
        file.write_text(given.replace("  r: 0.2 m", "  r: 0.21 m"), encoding="utf-8")
        until(lambda: news(address)["moving"] > moving)


def test_a_file_behind_a_link_is_followed(file: Path, tmp_path: Path) -> None:
    (tmp_path / "shared").mkdir()
    target = file.rename(tmp_path / "shared" / "given.yaml")
    file.symlink_to(target)
    with watching(file) as (address, _):
        until(lambda: news(address)["moving"] == 1)
        target.write_text(target.read_text(encoding="utf-8").replace("  r: 0.2 m", "  r: 0.21 m"), encoding="utf-8")
        until(lambda: news(address)["moving"] == 2)
        other = target.with_name("other.yaml")
        other.write_bytes(target.read_bytes())
        file.unlink()
        file.symlink_to(other)
        until(lambda: news(address)["moving"] > 2)


# --- the server -----------------------------------------------------------------------------------


@pytest.fixture
def served(file: Path) -> Iterator[Server]:
    session = LiveSession(partial(open_case, file))
    server = Server(session)
    threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True).start()
    session.open()
    yield server
    session.close()
    server.shutdown()
    server.server_close()


def status(address: str, **headers: str) -> int:
    try:
        with urllib.request.urlopen(urllib.request.Request(address, headers=headers)) as answer:
            return int(answer.status)
    except urllib.error.HTTPError as error:
        return int(error.code)


def test_only_this_machine_and_only_its_own_page_are_served(served: Server) -> None:
    assert served.server_address[0] == "127.0.0.1"
    address, root = served.address, f"http://127.0.0.1:{served.server_port}"
    assert status(address) == 200
    assert status(address + "moving.json") == 200
    # No token, a wrong one, a path outside, another name of this machine, another site's page.
    for path in ("/", "/x/", f"/{served.token}x/", "/../etc/passwd", "/%2e%2e/etc/passwd", "/favicon.ico"):
        assert status(root + path) == 404, path
    for path in ("../given.yaml", "given.yaml", "..%2f..%2fetc%2fpasswd", "news/../x"):
        assert status(address + path) == 404, path
    assert status(address, Host="evil.example") == 403
    assert status(address, Origin="https://evil.example") == 403
    assert status(address, Host=f"localhost:{served.server_port}", Origin=root) == 200


@proof
def test_each_edition_is_told_and_a_late_one_dropped(file: Path, served: Server) -> None:
    session = served.session
    until(lambda: session.revision.reports == 1)
    given = file.read_text(encoding="utf-8")
    for number in range(3):
        file.write_text(given.replace("variant:", f"variant: {number} #"), encoding="utf-8")
        session.renew()
    until(lambda: not session.revision.busy)
    # Of three changes in a moment each has its moving part, but only the last its report.
    assert (session.revision.moving, session.revision.reports) == (4, 2)
    assert news(served.address) == {
        "moving": 4,
        "reads": 4,
        "report": 2,
        "fault": "",
        "busy": False,
        "language": "en",
        "moves": [""],
    }
    file.unlink()
    session.renew()
    assert "given.yaml" in session.revision.fault
    assert session.revision.panels


def test_a_fault_is_told_while_an_older_animation_is_made(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It waits for nothing that takes longer than to check the file; what was being made is shown below it."""
    begun, going_on = threading.Event(), threading.Event()

    def slow(case: Case) -> tuple[Panel, ...]:
        begun.set()
        assert going_on.wait(PATIENCE)
        return ()

    given = file.read_text(encoding="utf-8")
    with edited(file, open_case) as server:
        monkeypatch.setattr(live_view, "panels", slow)
        file.write_text(given.replace("  r: 0.2 m", "  r: 0.21 m"), encoding="utf-8")
        assert begun.wait(PATIENCE)
        file.write_text(given.replace("  r: 0.2 m", "  r: 0.2 kg"), encoding="utf-8")
        until(lambda: "wrong-unit" in server.session.revision.fault)
        assert not going_on.is_set()
        moving = server.session.revision.moving
        going_on.set()
        until(lambda: server.session.revision.moving > moving)
        assert "wrong-unit" in server.session.revision.fault


# --- connections that say nothing, or too little ----------------------------------------------------


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch) -> Iterator[Server]:
    """A server whose patience is short, with a page that has no news."""
    monkeypatch.setattr(local_server, "REQUEST", 0.4)
    monkeypatch.setattr(local_server, "BEAT", 0.1)
    session = LiveSession(partial(open_case, FILE, None))
    server = Server(session)
    thread = threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True)
    thread.start()
    yield server
    session.close()
    server.shutdown()
    server.server_close()
    thread.join()


def ended(connection: socket.socket, patience: float = PATIENCE) -> bool:
    """Whether the other side hangs up."""
    connection.settimeout(patience)
    with suppress(ConnectionResetError):
        return connection.recv(1000) == b""
    return True


@pytest.mark.parametrize("sent", [b"", b"GET / HTTP/1.1\r\nHost:"], ids=["nothing", "half a request"])
def test_a_connection_without_a_whole_request_ends(server: Server, sent: bytes) -> None:
    with socket.create_connection(server.server_address[:2]) as connection:
        connection.sendall(sent)
        assert ended(connection)


def test_a_request_that_comes_letter_by_letter_ends(server: Server) -> None:
    """Each letter is soon enough; all of them are not."""
    with socket.create_connection(server.server_address[:2]) as connection:
        begun = time.monotonic()
        with suppress(ConnectionError):
            while time.monotonic() - begun < PATIENCE:
                connection.sendall(b"G")
                time.sleep(0.1)
        assert time.monotonic() - begun < PATIENCE


def test_a_page_that_waits_for_news_stays(server: Server) -> None:
    """Its stream is idle by nature: it hears that the server is there, long after a request would have ended."""
    with socket.create_connection(server.server_address[:2]) as connection:
        host = f"{local_server.HOST}:{server.server_port}"
        connection.sendall(f"GET /{server.token}/news HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
        connection.settimeout(PATIENCE)
        heard, end = b"", time.monotonic() + 4 * local_server.REQUEST
        while time.monotonic() < end:
            more = connection.recv(1000)
            assert more
            heard += more
        assert heard.count(b":\n\n") > 3


def test_at_the_limit_of_open_files_it_waits(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    """A connection that cannot be accepted is asked for again after a while, not at once and again and again."""
    asked: list[float] = []
    accept = socket.socket.accept

    def full(self: socket.socket) -> tuple[socket.socket, Any]:
        asked.append(time.monotonic())
        raise OSError(errno.EMFILE, os.strerror(errno.EMFILE))

    monkeypatch.setattr(socket.socket, "accept", full)
    with socket.create_connection(server.server_address[:2]) as connection:
        until(lambda: len(asked) > 3)
        assert (asked[-1] - asked[0]) / (len(asked) - 1) >= local_server.RESPITE
        # And where there is room again, it is served.
        monkeypatch.setattr(socket.socket, "accept", accept)
        connection.sendall(b"GET / HTTP/1.1\r\nHost: elsewhere\r\n\r\n")
        connection.settimeout(PATIENCE)
        assert connection.recv(1000).startswith(b"HTTP/1.1 403")


def test_words_that_cannot_be_opened_name_the_cause(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "words.yaml").touch()

    def full(path: Path, most: int = -1) -> bytes:
        raise OSError(errno.EMFILE, os.strerror(errno.EMFILE), str(path))

    monkeypatch.setattr(yaml_source, "contents", full)
    with pytest.raises(TemplateError, match=os.strerror(errno.EMFILE)):
        words.load_words((tmp_path,))
