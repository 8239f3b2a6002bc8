"""The command: without its packages it says what is lacking, and the other commands do without them."""

from __future__ import annotations

import shutil
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner

from reportgen.base.files import held
from reportgen.base.template_folders import ATLAS_VARIABLE, templates
from reportgen.cli import app
from reportgen.cli import serving as command
from reportgen.server import protocol, serving
from tests.lanes import proof
from tests.server.running import HOST, free_port, running

CHECK = ["check", "assignments/engine-single-I.yaml"]
WEB = ("starlette", "uvicorn", "sqlalchemy", "alembic", "itsdangerous", "multipart", "python_multipart")


def serve(*arguments: object) -> tuple[int, str]:
    made = CliRunner().invoke(app, ["serve", *map(str, arguments)])
    return made.exit_code, made.output


def test_without_its_packages_it_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command, "find_spec", lambda name: None)
    code, said = serve(tmp_path)
    assert code == 3
    assert said.splitlines() == [said.strip()]
    assert "pip install 'reportgen[server]'" in said


@pytest.mark.parametrize("arguments", [["--help"], ["serve", "--help"], ["kinds"], CHECK])
def test_other_commands_load_nothing_of_it(arguments: list[str]) -> None:
    code = (
        "import sys; from reportgen.cli import main\n"
        f"sys.argv = ['reportgen', *{arguments!r}]\n"
        "try: main()\n"
        f"except SystemExit: pass\n"
        f"print([name for name in {WEB!r} if name in sys.modules], file=sys.stderr)"
    )
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ended.stderr.strip().endswith("[]")


def test_it_says_that_there_is_no_class_and_that_there_is_one(made_class: Path, tmp_path: Path) -> None:
    code, said = serve(tmp_path)
    assert (code, "[serve-no-class]" in said) == (1, True)
    beside = made_class.with_name("class-files")
    code, said = serve(made_class, beside / "roster.csv", "--init", "--spec", beside / "spec.yaml")
    assert (code, "[serve-class-there]" in said) == (1, True)
    code, said = serve(tmp_path / "new", "--init")
    assert code == 2


def test_a_class_is_not_served_without_the_file_of_its_machine(
    made_class: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each student would be told that there is no such machine; the instructor is, at once."""
    folder, machines = tmp_path / "class", tmp_path / "machines"
    shutil.copytree(made_class, folder)
    machines.mkdir()
    for file in folder.joinpath("variants").glob("*.yaml"):
        file.write_text("kind: atlas/lost\nreport: {language: en}\nparameters: {}\n", "utf-8")
    served: list[object] = []
    monkeypatch.setattr(serving, "_serve", lambda *arguments: served.append(arguments))
    monkeypatch.setenv(ATLAS_VARIABLE, "")
    code, said = serve(folder, "--atlas", machines)
    assert (code, "[unknown-machine]" in said, "--atlas" in said) == (1, True, True), said
    right = (templates() / "atlas" / "wiper.yaml").read_text("utf-8")
    (machines / "lost.yaml").write_text(right.replace("driver:", "drivers:"), "utf-8")
    code, said = serve(folder, "--atlas", machines)
    assert (code, "lost.yaml:" in said, served) == (1, True, [])
    (machines / "lost.yaml").write_text(right, "utf-8")
    assert serve(folder, "--atlas", machines)[0] == 0
    assert len(served) == 1


def test_two_servers_do_not_share_a_class(made_class: Path) -> None:
    with held(made_class / "server"):
        code, said = serve(made_class)
    assert (code, "[serve-running]" in said) == (1, True)


def test_a_new_class_prints_the_link_of_its_instructor(made_class: Path, tmp_path: Path) -> None:
    beside = made_class.with_name("class-files")
    folder = tmp_path / "class"
    arguments = (folder, beside / "roster.csv", "--init", "--spec", beside / "spec.yaml")
    code, said = serve(*arguments, "--base-url", "https://school.example/")
    assert code == 0, said
    assert said.splitlines()[-1].startswith("https://school.example/in/")
    code, said = serve(folder, "--backup", tmp_path / "copies")
    assert code == 0
    assert (Path(said.strip()) / "server" / "class.db").is_file()
    # What cannot be undone is asked for.
    assert CliRunner().invoke(app, ["serve", str(folder), "--forget"], input="n\n").exit_code == 1
    assert folder.joinpath("roster.csv").exists()
    assert CliRunner().invoke(app, ["serve", str(folder), "--forget"], input="y\n").exit_code == 0
    assert [path.name for path in folder.iterdir()] == ["spec.yaml"]


@proof
def test_a_silent_connection_is_closed_and_keeps_nobody_waiting(made_class: Path) -> None:
    with running(made_class, port := free_port()):
        silent = socket.create_connection((HOST, port))
        slow = socket.create_connection((HOST, port))
        slow.sendall(b"GET / HTTP/1.1\r\nHost:")
        begun = time.monotonic()
        with socket.create_connection((HOST, port)) as other:
            other.sendall(f"GET / HTTP/1.1\r\nHost: {HOST}:{port}\r\nConnection: close\r\n\r\n".encode())
            other.settimeout(10)
            assert other.recv(100).startswith(b"HTTP/1.1 200")
        for connection in (silent, slow):
            connection.settimeout(protocol.SILENCE + 15)
            assert connection.recv(100) == b""
            connection.close()
        assert time.monotonic() - begun < protocol.SILENCE + 15
