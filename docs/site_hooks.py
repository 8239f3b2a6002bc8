"""Hooks of the MkDocs site: the navigation follows `docs/index.md`, and links out of `docs/` become plain text."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

from reportgen.base import documentation

_ITEM = re.compile(r"(?:[-*]|\d+\.) +")
HOME = {"en": "Home", "vi": "Trang đầu"}


def on_config(config: Any) -> Any:
    """Set the navigation: the home page, then the kinds of pages with their subjects, in English and Vietnamese."""
    english, vietnamese = documentation.entries("en"), documentation.entries("vi")
    nav: list[Any] = [{HOME["en"]: f"{documentation.INDEX}.md"}]
    for group, of_group in groupby(english, lambda entry: entry.group):
        inner: list[Any] = []
        for section, of_section in groupby(of_group, lambda entry: entry.section):
            links = [entry.link for entry in of_section]
            inner += [{section: links}] if section else links
        nav.append({group: inner})
    config.nav = nav
    titles = {HOME["en"]: HOME["vi"]}
    for entry, translated in zip(english, vietnamese, strict=True):
        titles |= {entry.group: translated.group, entry.section: translated.section}
    (language,) = (each for each in config.plugins["i18n"].config.languages if each.locale == "vi")
    language.nav_translations = titles
    return config


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    """Adapt a page to the site, and mark the English pages of the Vietnamese site.

    Links to files that are not part of the site become their text.  The pages are CommonMark: MkDocs needs four blanks
    before what belongs to an item of a list, and no stroke before a bar in the code of a table.
    """
    for link in reversed(list(documentation.outside_links(Path(page.file.abs_src_path), markdown))):
        markdown = markdown[: link.start()] + link["text"] + markdown[link.end() :]
    markdown = re.sub(r"^\|.*$", lambda row: re.sub(r"`[^`]+`", _without_strokes, row[0]), markdown, flags=re.MULTILINE)
    markdown = "\n".join(_indented(markdown.splitlines()))
    if page.file.locale_alternate_of != page.file.locale:
        head, newline, rest = markdown.partition("\n")
        return f"{head}{newline}\n*{config.extra['only_english']}*\n{rest}"
    return markdown


def _without_strokes(code: re.Match[str]) -> str:
    return code[0].replace("\\|", "|")


def _indented(lines: Sequence[str]) -> Iterator[str]:
    """Yield lines with what belongs to an item of a list indented by four blanks, also in lists within it."""
    at = 0
    fence = False
    while at < len(lines):
        line = lines[at]
        at += 1
        fence ^= line.startswith("```")
        yield line
        marker = _ITEM.match(line)
        if marker is None or fence:
            continue
        blanks = " " * len(marker[0])
        end = at
        while end < len(lines) and (lines[end].startswith(blanks) or not lines[end].strip()):
            end += 1
        within = [part.removeprefix(blanks) for part in lines[at:end]]
        yield from (f"    {part}" if part else "" for part in _indented(within))
        at = end
