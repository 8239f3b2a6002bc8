"""The pages of the documentation, which are installed with the program: where they are and how the index sorts them.

A page is a Markdown file of `docs/`, match by its stem in any folder; `NAME.vi.md` is the Vietnamese page of `NAME.md`.
`docs/index.md` lists all pages by kind, one a line; the list that `reportgen docs` prints and the navigation of the
site follow it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from reportgen.base.records import Record, replace
from reportgen.base.template_folders import REFERENCE, documentation, languages
from reportgen.base.units import Language
from reportgen.base.words import spoken

FIRST = "README"
"""The page to begin with; in a checkout it is in the folder above the others."""
INDEX = "index"
SUFFIX = ".md"

_HEADING = re.compile(r"(?P<marks>##|###) (?P<title>.+)")
_ENTRY = re.compile(r"- \[(?P<title>[^\]]+)\]\((?P<link>[^)]+)\)(?:: (?P<summary>.+))?")


class IndexEntry(Record):
    """A page in the index: the kind of page (`group`), the subject within it or "", and one line of what it says."""

    group: str
    section: str
    name: str
    link: str
    title: str
    summary: str


def pages(language: Language | None = None) -> Mapping[str, Path]:
    """Return the file of each page by its name, README first, in `language` or the current one.

    A page that is not written in this language has its English file.
    """
    folder = documentation()
    first = folder if (folder / f"{FIRST}{SUFFIX}").is_file() else folder.parent
    places = sorted(folder.rglob(f"*{SUFFIX}"), key=lambda path: path.name)
    asked = language or spoken()
    files = {}
    for page in (first / f"{FIRST}{SUFFIX}", *(path for path in places if "." not in path.stem and path.stem != FIRST)):
        translated = page.with_suffix(f".{asked}{SUFFIX}")
        files[page.stem] = translated if translated.is_file() else page
    return files


def name_of(page: Path) -> str:
    """Return the name of a page, the same in each language: `class` of `class.vi.md`."""
    return page.name.partition(".")[0]


def language_of(page: Path) -> Language:
    """Return the language that a page is written in."""
    code = page.stem.rpartition(".")[2]
    return next((language for language in languages() if language == code and "." in page.stem), REFERENCE)


def heading(page: Path) -> str:
    """Return the title of a page."""
    lines = page.read_text(encoding="utf-8").splitlines()
    return next((line.removeprefix("# ") for line in lines if line.startswith("# ")), page.stem)


def entries(language: Language | None = None) -> tuple[IndexEntry, ...]:
    """Return the pages in the order of the English index, with titles in `language` or the current one.

    What the index of this language does not list has its English title.
    """
    english = _listed(pages(REFERENCE)[INDEX])
    localized = {entry.name: entry for entry in _listed(pages(language)[INDEX])}
    groups = dict(zip(_kinds(pages(REFERENCE)[INDEX]), _kinds(pages(language)[INDEX]), strict=False))
    sections = {entry.section: localized[entry.name].section for entry in english if entry.name in localized}
    return tuple(
        replace(
            localized.get(entry.name, entry),
            group=groups.get(entry.group, entry.group),
            section=sections.get(entry.section, entry.section),
            link=entry.link,
        )
        for entry in english
    )


def _kinds(index: Path) -> list[str]:
    """Return the titles of the kinds of pages, which are the same in the index of each language."""
    return [line.removeprefix("## ") for line in index.read_text("utf-8").splitlines() if line.startswith("## ")]


def _listed(index: Path) -> list[IndexEntry]:
    """Return the pages that an index lists; links to files outside the documentation are left out."""
    group = section = ""
    made = []
    for line in index.read_text(encoding="utf-8").splitlines():
        if match := _HEADING.fullmatch(line):
            group, section = (match["title"], "") if match["marks"] == "##" else (group, match["title"])
        elif (match := _ENTRY.fullmatch(line)) and within(index, match["link"]):
            name = name_of(Path(match["link"]))
            made.append(IndexEntry(group, section, name, match["link"], match["title"], match["summary"] or ""))
    return made


def within(page: Path, link: str) -> bool:
    """Return True if a relative link of a page leads to a file of the documentation."""
    target = Path(os.path.normpath(page.parent / link.partition("#")[0]))
    return target.is_relative_to(documentation())


def is_relative(link: str) -> bool:
    """Return True if a link leads to a file, and not to another host or a place of the same page."""
    return not re.match(r"[a-z]+:|#", link)


def outside_links(page: Path, text: str) -> Iterator[re.Match[str]]:
    """Yield the links of a page's text, as matches, that lead to files of the project outside the documentation."""
    for match in re.finditer(r"(?<!!)\[(?P<text>[^\]]+)\]\((?P<link>[^)\s]+)\)", text):
        if is_relative(match["link"]) and not within(page, match["link"]):
            yield match
