"""Pages of the documentation as files for a browser: every page in every language it has, with links between them.

The files need no server, no other host and nothing besides their folder.  They are rendered by the Markdown library
that reports use, so that an ordinary installation has them; the site of `make docs` needs MkDocs.
"""

from __future__ import annotations

import html
import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from hashlib import sha256
from itertools import groupby
from pathlib import Path

from reportgen.base import documentation, template_folders
from reportgen.base.documentation import IndexEntry
from reportgen.base.files import version
from reportgen.base.units import Language

PICTURES = "pictures"
LOOK = """
:root { color-scheme: light dark; --line: #8884; --soft: #8881; }
body { margin: 0; font: 1rem/1.55 system-ui, sans-serif; }
header { display: flex; gap: 1em; align-items: baseline; padding: .6em 1em; border-bottom: 1px solid var(--line); }
header a + a { margin-left: auto; }
.columns { display: flex; max-width: 76rem; margin: 0 auto; }
nav summary { font-weight: bold; cursor: pointer; }
nav { flex: 0 0 15rem; padding: 1em; font-size: .9rem; }
nav a, header a { text-decoration: none; }
nav ul { list-style: none; margin: .2em 0 1em; padding: 0; }
nav [aria-current] { font-weight: bold; }
main { flex: 1; min-width: 0; padding: 0 1em 4em; max-width: 52rem; }
pre { overflow: auto; background: var(--soft); padding: .6em .8em; }
code { background: var(--soft); padding: 0 .2em; overflow-wrap: break-word; }
pre code { background: none; padding: 0; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: .9rem; }
td, th { border: 1px solid var(--line); padding: .3em .6em; vertical-align: top; text-align: left; }
img { max-width: 100%; background: white; }
@media (max-width: 50rem) {
  .columns { flex-direction: column; }
  nav { flex: none; }
  main { order: -1; padding-bottom: 1em; }
}
"""

_LINK = re.compile(r'(?P<head><a href=")(?P<link>[^"]+)(?P<tail>">)(?P<text>.*?)</a>', re.DOTALL)
_IMAGE = re.compile(r'(<img src=")([^"]+)"')


LANGUAGES: tuple[tuple[Language, str], ...] = (("en", "English"), ("vi", "Tiếng Việt"))
STAMP = ".made-of"
"""Name of the file that says what the folder was made of."""

PageFiles = Mapping[str, Path]
"""The file of each page by its name, in one language."""


def write_pages(folder: Path) -> None:
    """Write all pages with their pictures into a folder, unless it has those of the same files already."""
    sources = sorted(path for path in template_folders.documentation().rglob("*") if path.is_file())
    digest = sha256(repr([(str(path), path.stat().st_mtime_ns, version()) for path in sources]).encode()).hexdigest()
    stamp = folder / STAMP
    if stamp.is_file() and stamp.read_text(encoding="utf-8") == digest:
        return
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copytree(template_folders.documentation() / PICTURES, folder / PICTURES, dirs_exist_ok=True)
    known = {language: documentation.pages(language) for language, _ in LANGUAGES}
    for language, files in known.items():
        entries = documentation.entries(language)
        for page in files.values():
            if documentation.language_of(page) == language:
                text = _html(page, language, known, entries)
                (folder / file_name(page)).write_text(text, encoding="utf-8")
    stamp.write_text(digest, encoding="utf-8")


def file_name(page: Path) -> str:
    """Return the name of the HTML file of a page: `class.html` or `class.vi.html`."""
    return f"{page.stem}.html"


def _html(page: Path, language: Language, known: Mapping[Language, PageFiles], entries: Sequence[IndexEntry]) -> str:
    from markdown_it import MarkdownIt

    body = MarkdownIt("commonmark").enable("table").render(page.read_text(encoding="utf-8"))
    body = _IMAGE.sub(lambda match: f'{match[1]}{PICTURES}/{Path(match[2]).name}"', body)
    body = _LINK.sub(lambda match: _linked(known[language], match), body)
    body = body.replace("<table>", '<div class="wide"><table>').replace("</table>", "</table></div>")
    return (
        f'<!doctype html>\n<html lang="{language}">\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{html.escape(documentation.heading(page))} – reportgen</title>\n<style>{LOOK}</style>\n"
        f'<header>{"".join(_head(page, language, known))}</header>\n<div class="columns">\n'
        f"<nav>{''.join(_navigation(page, known[language], entries))}</nav>\n"
        f"<main>\n{_with_anchors(body)}</main>\n</div>\n</html>\n"
    )


def _head(page: Path, language: Language, known: Mapping[Language, PageFiles]) -> Iterator[str]:
    """Yield the link to the index, and that to the same page in the other language."""
    yield f'<a href="{file_name(known[language][documentation.INDEX])}">reportgen</a>'
    for code, title in LANGUAGES:
        there = known[code][documentation.name_of(page)]
        if code != language and documentation.language_of(there) == code:
            yield f'<a href="{file_name(there)}" lang="{code}">{title}</a>'


def _navigation(page: Path, files: PageFiles, entries: Sequence[IndexEntry]) -> Iterator[str]:
    """Yield the list of all pages by kind; only the kind of this page is open."""
    for group, of_group in groupby(entries, lambda entry: entry.group):
        rows = [(files[entry.name], entry.title) for entry in of_group]
        is_open = " open" if any(file == page for file, _ in rows) else ""
        yield f"<details{is_open}><summary>{html.escape(group)}</summary><ul>"
        for file, title in rows:
            here = ' aria-current="page"' if file == page else ""
            yield f'<li><a href="{file_name(file)}"{here}>{html.escape(title)}</a>'
        yield "</ul></details>"


def _linked(files: PageFiles, match: re.Match[str]) -> str:
    """Return a link as the folder needs it: to the page's file, or only its text if the target is not in it."""
    link = html.unescape(match["link"])
    if not documentation.is_relative(link):
        return match[0]
    target, _, anchor = link.partition("#")
    file = files.get(documentation.name_of(Path(target)))
    if not target.endswith(documentation.SUFFIX) or file is None:
        return match["text"]
    address = file_name(file) + (f"#{anchor}" if anchor else "")
    return f"{match['head']}{html.escape(address)}{match['tail']}{match['text']}</a>"


def _with_anchors(body: str) -> str:
    """Return the headings with the ids that links name: lower case, blanks as hyphens."""

    def anchored(match: re.Match[str]) -> str:
        plain = html.unescape(re.sub(r"<[^>]*>", "", match[2]))
        anchor = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        return f'<h{match[1]} id="{html.escape(anchor)}">{match[2]}</h{match[1]}>'

    return re.sub(r"<h(\d)>(.*?)</h\1>", anchored, body)
