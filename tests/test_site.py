"""The site of the documentation: it builds without a warning, in two languages, and needs no other host."""

from __future__ import annotations

import importlib.util
import json
import os
import re
import subprocess
import sys
import tomllib
from html.parser import HTMLParser
from pathlib import Path
from types import ModuleType

import pytest
from markdown_it import MarkdownIt

from tests.documents import PAGES, ROOT
from tests.lanes import proof

LOADED = {"img": "src", "script": "src", "source": "src", "iframe": "src", "link": "href"}
"""What a browser loads by itself, and the attribute with its address."""


class _Loads(HTMLParser):
    """The addresses that a page makes a browser load."""

    def __init__(self) -> None:
        super().__init__()
        self.addresses: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.addresses += [value or "" for name, value in attrs if LOADED.get(tag) == name]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("mkdocs")
    place = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--quiet", "--strict", "--site-dir", place],
        cwd=ROOT,
        env={**os.environ, "NO_MKDOCS_2_WARNING": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return place


@proof
def test_every_page_is_on_the_site_in_both_languages(site: Path) -> None:
    for page in PAGES:
        if page.startswith("docs/") and not page.endswith(".vi.md"):
            name = Path(page).relative_to("docs").with_suffix(".html")
            assert (site / name).is_file()
            assert (site / "vi" / name).is_file()
    assert not list(site.rglob("*.py"))


@proof
def test_the_site_makes_no_request_to_another_host(site: Path) -> None:
    for file in site.rglob("*.html"):
        loads = _Loads()
        loads.feed(file.read_text(encoding="utf-8"))
        assert loads.addresses
        assert not [address for address in loads.addresses if re.match(r"(https?:)?//", address)], file
    for file in site.rglob("*.css"):
        assert not re.search(r"(url\(|@import)[\"' ]*(https?:)?//", file.read_text(encoding="utf-8")), file


SHAPES = ("li", "ol", "ul", "table", "tr", "pre", "h2", "h3", "img", "strong", "em")
"""Elements that both writers of HTML make of the same Markdown."""


@proof
def test_the_site_reads_each_page_as_commonmark(site: Path) -> None:
    for page in PAGES:
        if page.startswith("docs/"):
            name = Path(page.replace(".vi.md", ".md")).relative_to("docs").with_suffix(".html")
            html = (site / ("vi" if page.endswith(".vi.md") else "") / name).read_text(encoding="utf-8")
            article = html[html.index("<article") : html.index("</article>")]
            plain = MarkdownIt("commonmark").enable("table").render((ROOT / page).read_text(encoding="utf-8"))
            assert _counts(article) == _counts(plain), page


def _counts(html: str) -> dict[str, int]:
    return {shape: len(re.findall(rf"<{shape}[ >]", html)) for shape in SHAPES}


@proof
def test_the_search_knows_both_languages(site: Path) -> None:
    index = json.loads((site / "search" / "search_index.json").read_text(encoding="utf-8"))
    assert {"en", "vi"} <= set(index["config"]["lang"])
    titles = {entry["title"] for entry in index["docs"]}
    assert {"The documentation of reportgen", "Tài liệu reportgen"} <= titles


def hooks() -> ModuleType:
    spec = importlib.util.spec_from_file_location("site_hooks", ROOT / "docs" / "site_hooks.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_lists_of_commonmark_are_indented_as_the_site_needs_them() -> None:
    lines = ["1. One", "", "   ```sh", "   - a", "   ```", "", "- two", "  - three", "    four", "", "Five", "   six"]
    assert list(hooks()._indented(lines)) == [
        *("1. One", "", "    ```sh", "    - a", "    ```", "", "- two", "    - three", "        four", ""),
        *("Five", "   six"),
    ]


def test_every_folder_of_pages_is_installed() -> None:
    wheel = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["hatch"]["build"]["targets"]
    included = wheel["wheel"]["force-include"]
    for page in (*PAGES, "docs/pictures/page.png"):
        top = "/".join(page.split("/")[:2])
        assert included[top] == ("reportgen/" if page.startswith("docs/") else "reportgen/docs/") + top
    assert "docs" not in included, "the scripts of docs/ are not installed"
