"""Pages of the documentation as text for a terminal or a pipe: tables in columns, no pictures, no addresses."""

from __future__ import annotations

import re
from io import StringIO
from pathlib import Path

from reportgen.base import documentation

WIDEST = 100
"""Largest width of a line (characters)."""

_FENCE = re.compile(r"(^ *```.*?^ *```$)", re.MULTILINE | re.DOTALL)
_PICTURE = re.compile(r"!\[(?P<text>[^\]]*)\]\([^)\s]+\)")
_LINK = re.compile(r"(?<!!)\[(?P<text>[^\]]+)\]\((?P<link>[^)\s]+)\)")
_CODE = re.compile(r"(?<!`)`([^`\n]+)`(?!`)")
_HEADING = re.compile(r"^(#+ )", re.MULTILINE)


def as_text(page: Path, width: int = WIDEST, *, styled: bool = False) -> str:
    """Return a page as text of at most `width` columns.

    `styled` shows headings and code by the terminal's bold and colours; otherwise they keep their marks, `#` and
    backticks.  A picture is replaced by its description, a link to another page by the link's text and the page's name.
    """
    from rich.console import Console
    from rich.markdown import Markdown

    stream = StringIO()
    console = Console(file=stream, width=min(width, WIDEST), force_terminal=styled, no_color=not styled)
    console.print(Markdown(_prepared(page, styled), hyperlinks=False))
    lines = (line.rstrip() for line in stream.getvalue().splitlines())
    return "\n".join(lines).strip("\n") + "\n"


def _prepared(page: Path, styled: bool) -> str:
    """Return the Markdown of a page without addresses; blocks of code stay as they are."""
    pieces = _FENCE.split(page.read_text(encoding="utf-8"))
    for at in range(0, len(pieces), 2):
        text = _PICTURE.sub(r"*\g<text>*", pieces[at])
        text = _LINK.sub(lambda match: _link_text(match["text"], match["link"]), text)
        if not styled:
            text = _HEADING.sub(r"\\\1", _CODE.sub(r"`` `\1` ``", text))
        pieces[at] = text
    return "".join(pieces)


def _link_text(text: str, link: str) -> str:
    """Return what stands for a link: its text, and in brackets where it leads unless the text says so."""
    if not documentation.is_relative(link):
        return text if link.startswith("#") else f"{text} ({link})"
    name = documentation.name_of(Path(link.partition("#")[0]))
    if name not in documentation.pages() or text.strip("`").casefold() in (name, f"reportgen docs {name}"):
        return text
    return f"{text} (→ {name})"
