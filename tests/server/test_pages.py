"""The pages as HTML: in every language, without anything inline, with a word for all that the server may say."""

from __future__ import annotations

import re
from collections.abc import Mapping
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
        "refused": {"code": "unknown", "message": pages.explained(language, "unknown")},
        "enter": {"home": "/me"},
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


def test_a_symbol_has_its_indices_where_a_book_has_them() -> None:
    assert _symbol("a_CB^n") == ("a", "CB", "n")
    assert _symbol("pb") == ("pb", "", "")
