"""The pages as HTML: in every language, without anything inline, with a word for all that the server may say."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from reportgen.base.template_folders import languages
from reportgen.server import downloads, guards, pages
from reportgen.server.page_filters import _symbol
from tests.server.served import Served


@pytest.mark.parametrize("language", languages())
def test_a_page_is_whole_in_every_language(language: str) -> None:
    about: Mapping[str, Mapping[str, Any]] = {
        "sign_in": {"failed": True, "number": '"><script>'},
        "refused": {"code": "unknown", "message": pages.explained(language, "unknown"), "lines": ["a <b>"]},
        "enter": {"home": "/me"},
        "preparing": {"file": "tasks.pdf", "queue": 3},
    }
    for name, content in about.items():
        html = pages.page(name, language, csrf="token", person=None, **content)
        assert f'<html lang="{language}">' in html
        assert '"><script>' not in html


def test_everything_that_the_server_refuses_has_a_sentence() -> None:
    for language in languages():
        assert pages.words_of(language)["errors"].keys() == guards.STATUS.keys()


def test_the_desk_offers_every_download() -> None:
    offered = {*downloads.PAPERS, *downloads.MARKED, *downloads.ZIPS, "links.csv", "corrections.csv"}
    assert set(pages.words_of("en")["downloads"]) == offered


def test_the_pages_of_a_class_have_nothing_inline(served: Served) -> None:
    desk, student = served.desk, served.person("S1")
    shown = {path: desk.open(path).text for path in ("/desk", "/desk/students/S1")}
    shown["/me"] = student.open("/me").text
    for path, html in shown.items():
        scripts = re.findall(r"<script(.*?)>", html)
        assert scripts, path
        assert all('src="/static/' in one or 'type="application/json"' in one for one in scripts), path
        assert not re.search(r"<style|\sstyle=|\son\w+=|javascript:", html), path
        for address in re.findall(r'(?:src|href)="(/static/[^"]+)"', html):
            assert student.get(address).status_code == 200


def test_the_sheet_shows_what_was_saved(served: Served) -> None:
    student = served.person("S1")
    (id, position), *_ = student.places
    student.save({(id, position): '3,5"<b>'})
    html = student.open("/me").text
    assert f'data-id="{id}" data-position="{position}" value="3,5&#34;&lt;b&gt;"' in html


def test_the_scripts_import_files_that_are_there() -> None:
    for name in ("sheet.js", "student.js", "desk.js", "hand_in.js"):
        content = pages.static(name)
        assert content is not None
        for imported in re.findall(r'from "\./(.+?)"', content[0].decode()):
            assert pages.static(imported) is not None


UNANSWERED = """
const kept = new Map();
globalThis.localStorage = {
  getItem: (key) => kept.get(key) ?? null,
  setItem: (key, text) => kept.set(key, text),
  removeItem: (key) => kept.delete(key),
};
const { Unanswered } = await import("./outbox.mjs");
let count = 0;
const page = () => new Unanswered("S1:1", () => `id-${++count}`);
const first = page(), a = first.ask("A", "cells"), b = first.ask("B", "cells");
first.end("A");
const again = page();
console.log([again.ask("B", "cells") === b, again.ask("A", "cells") !== a, again.ask("B", "others") !== b].join());
"""


@pytest.mark.skipif(shutil.which("node") is None, reason="runs a script of the pages")
def test_a_check_without_an_answer_has_the_same_id_after_a_reload(tmp_path: Path) -> None:
    content = pages.static("outbox.js")
    assert content is not None
    (tmp_path / "outbox.mjs").write_bytes(content[0])
    (tmp_path / "test.mjs").write_text(UNANSWERED, encoding="utf-8")
    ended = subprocess.run(["node", "test.mjs"], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert ended.stdout.strip() == "true,true,true"


def test_a_symbol_has_its_indices_where_a_book_has_them() -> None:
    assert _symbol("a_CB^n") == ("a", "CB", "n")
    assert _symbol("pb") == ("pb", "", "")
