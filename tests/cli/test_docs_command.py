"""`reportgen docs`: the list of pages, a page as text or in the browser, in both languages."""

from __future__ import annotations

import re
import sys
import webbrowser
from pathlib import Path
from urllib.parse import unquote

import pytest

from reportgen.base import documentation
from reportgen.base.documentation_html import file_name, write_pages
from reportgen.base.documentation_text import WIDEST, as_text
from reportgen.cli import documentation as command
from tests.commands import reportgen


def test_without_a_page_all_are_listed_by_kind_with_a_title_and_a_line() -> None:
    lines = reportgen("docs", "--lang", "en").stdout.splitlines()
    rows = [re.fullmatch(r"  ([\w-]+)  +(\S.*)", line) for line in lines]
    named = {row[1] for row in rows if row}
    assert named == set(documentation.pages("en")) - {"README", "index"}
    assert "Reference" in lines
    assert lines.index("Reference") < lines.index("Explanation") < lines.index("Developers")
    assert re.search(r"^  class +A whole class: \S", "\n".join(lines), re.MULTILINE)


def test_the_list_in_vietnamese_keeps_the_order() -> None:
    english, vietnamese = (documentation.entries(language) for language in ("en", "vi"))
    assert [entry.name for entry in vietnamese] == [entry.name for entry in english]
    assert {entry.group for entry in vietnamese} & {entry.group for entry in english} == set()
    assert re.search(r"^Tra cứu$", reportgen("docs", "--lang", "vi").stdout, re.MULTILINE)


def test_a_pipe_gets_readable_text() -> None:
    shown = reportgen("docs", "machines", "--lang", "en").stdout
    assert shown.startswith("# The machines\n")
    assert max(map(len, shown.splitlines())) <= WIDEST
    assert not re.search(r"\]\(|<[a-z]|\|---|\.png|\.gif|\.md\b", shown)
    assert re.search(r"^ `?shaper`? +Scheme of the shaper", shown, re.MULTILINE)
    assert "Scheme of the shaper" in shown


def test_a_link_is_shown_by_the_name_of_the_page(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(
        "See [the form](../reference/edit.md#fields), 1 step:\n\n1. Type\n\n   ```sh\n   [a](b.md)\n   ```\n", "utf-8"
    )
    shown = as_text(page)
    assert "See the form (→ edit)" in shown
    assert "[a](b.md)" in shown


@pytest.mark.parametrize(
    ("typed", "near"), [("clas", "class"), ("FLYWHEEL", "add-a-flywheel"), ("planetary", "planetary-train")]
)
def test_an_unknown_page_is_reported_with_the_nearest(typed: str, near: str) -> None:
    done = reportgen("docs", typed, "--lang", "en")
    assert done.returncode == 2
    assert done.stderr.startswith(f"reportgen: PAGE: there is no page “{typed.lower()}”: did you mean “{near}”?")


def test_a_page_that_is_only_in_english_is_shown_with_a_notice() -> None:
    done = reportgen("docs", "developers/extending.md".partition("/")[2], "--lang", "vi")
    assert done.returncode == 0
    assert done.stdout.startswith("# Extending")
    assert done.stderr == "reportgen: trang này chưa có bản tiếng Việt, đây là bản tiếng Anh\n"
    assert reportgen("docs", "README", "--lang", "vi").stderr == ""
    assert reportgen("docs", "extending", "--lang", "en").stderr == ""


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[str]:
    """The addresses that are opened in a browser, which takes all of them."""
    addresses: list[str] = []
    monkeypatch.setattr(webbrowser, "open", lambda address: not addresses.append(address))
    monkeypatch.setattr("reportgen.base.files.folder", lambda: tmp_path)
    return addresses


def test_a_terminal_with_a_browser_opens_the_page(opened: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command, "_has_browser", lambda: True)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    command.docs("class", False, False, "en")
    command.docs("class", False, True, "en")
    assert [address.rpartition("/")[2] for address in opened] == ["class.html"]


def test_open_opens_the_index_or_a_page_also_from_a_pipe(opened: list[str]) -> None:
    assert reportgen("docs", "--open", "--lang", "vi").stdout.endswith("index.vi.html\n")
    assert reportgen("docs", "class", "--open", "--lang", "en").stdout.endswith("class.html\n")
    assert len(opened) == 2


def test_a_page_that_no_browser_takes_is_printed(opened: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(webbrowser, "open", lambda address: False)
    assert "# A whole class" in reportgen("docs", "class", "--open", "--lang", "en").stdout


@pytest.mark.parametrize("screen", ["", ":0"])
def test_a_browser_needs_a_screen(screen: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr(webbrowser, "get", lambda: None)
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"):
        monkeypatch.setenv(name, screen)
    assert command._has_browser() is bool(screen)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("pages")
    write_pages(place)
    return place


def test_the_pages_for_a_browser_link_to_each_other_and_to_their_pictures(folder: Path) -> None:
    for page in folder.glob("*.html"):
        text = page.read_text(encoding="utf-8")
        for address in re.findall(r'(?:href|src)="([^"]+)"', text):
            if not re.match(r"https?:", address):
                name, _, anchor = unquote(address).partition("#")
                target = folder / name if name else page
                assert target.is_file(), (page.name, address)
                if anchor:
                    assert f'id="{anchor}"' in target.read_text(encoding="utf-8"), (page.name, address)


def test_every_page_has_its_file_in_each_language_it_is_written_in(folder: Path) -> None:
    for language in ("en", "vi"):
        assert {file_name(page) for page in documentation.pages(language).values()} <= {*map(_name, folder.iterdir())}
    assert '<a href="index.vi.html" lang="vi">' in (folder / "index.html").read_text(encoding="utf-8")
    assert '<html lang="vi">' in (folder / "index.vi.html").read_text(encoding="utf-8")


def _name(path: Path) -> str:
    return path.name


def test_pages_are_written_anew_only_if_something_changed(folder: Path) -> None:
    page = folder / "class.html"
    page.write_text("seen", encoding="utf-8")
    write_pages(folder)
    assert page.read_text(encoding="utf-8") == "seen"
    (folder / ".made-of").write_text("of another version", encoding="utf-8")
    write_pages(folder)
    assert page.read_text(encoding="utf-8") != "seen"
