"""The pages of the documentation, which are installed with the program: Markdown, some of them in several languages."""

from __future__ import annotations

import html
import re
import tempfile
from collections.abc import Mapping
from pathlib import Path

from reportgen.base.template_folders import REFERENCE, documentation, languages
from reportgen.base.units import Language
from reportgen.base.words import spoken

FIRST = "README"
"""First page; in a checkout it is in the folder above the others."""
SUFFIX = ".md"
LOOK = (
    "body{max-width:50em;margin:2em auto;padding:0 1em;font:1rem/1.5 sans-serif}"
    "pre{overflow:auto;background:#f4f4f4;padding:.6em}table{border-collapse:collapse}"
    "td,th{border:1px solid #ccc;padding:.2em .5em;vertical-align:top}img{max-width:100%}"
)


def pages(language: Language | None = None) -> Mapping[str, Path]:
    """Return the file of each page by its name, the first one first; of a page in several languages that of the one
    spoken.
    """
    folder = documentation()
    first = folder if (folder / f"{FIRST}{SUFFIX}").is_file() else folder.parent
    places = sorted(folder.rglob(f"*{SUFFIX}"), key=lambda path: path.name)
    asked = language or spoken()
    files = {}
    for page in (first / f"{FIRST}{SUFFIX}", *(path for path in places if "." not in path.stem and path.stem != FIRST)):
        own = page.with_suffix(f".{asked}{SUFFIX}")
        files[page.stem] = own if own.is_file() else page
    return files


def heading(page: Path) -> str:
    """Return the title of a page."""
    lines = page.read_text(encoding="utf-8").splitlines()
    return next((line.removeprefix("# ") for line in lines if line.startswith("# ")), page.stem)


def as_html(page: Path) -> Path:
    """Return a page as a file for a browser, in the folder of temporary files; its links lead to the Markdown beside
    it.
    """
    from markdown_it import MarkdownIt

    body = MarkdownIt("commonmark").enable("table").render(page.read_text(encoding="utf-8"))
    base = page.resolve().parent.as_uri() + "/"
    named = page.name.split(".")
    tongue = named[1] if len(named) > 2 and named[1] in languages() else REFERENCE
    text = (
        f'<!doctype html><html lang="{tongue}"><meta charset="utf-8"><base href="{base}">'
        f"<title>{html.escape(heading(page))}</title><style>{LOOK}</style>{_with_anchors(body)}</html>"
    )
    made = Path(tempfile.gettempdir()) / f"reportgen-{page.stem}.html"
    made.write_text(text, encoding="utf-8")
    return made


def _with_anchors(body: str) -> str:
    """Return the headings with the ids that links name: small letters, blanks as strokes."""

    def anchored(match: re.Match[str]) -> str:
        plain = html.unescape(re.sub(r"<[^>]*>", "", match[2]))
        anchor = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        return f'<h{match[1]} id="{html.escape(anchor)}">{match[2]}</h{match[1]}>'

    return re.sub(r"<h(\d)>(.*?)</h\1>", anchored, body)
