"""Document → one page for a browser, which needs no other file and loads none.

The frame `templates/frames/html/` holds the looks and the few scripts; this module puts the parts together and
states, by their hashes, which styles and scripts the page may use: nothing else runs on it, whatever it says.
"""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from reportgen.document import tree
from reportgen.errors import TypesetterError
from reportgen.words import templates
from reportgen.writers.html_blocks import Blocks
from reportgen.writers.svg import Pens

if TYPE_CHECKING:
    from jinja2 import Environment, Template

STYLES, SCRIPTS = ("page.css",), ("page.js",)
"""Files of the frame that every page has."""


@dataclass(frozen=True)
class Report:
    """The report as elements, with the style sheet's rules for its pens and papers."""

    body: str
    rules: str


@dataclass(frozen=True)
class Panel:
    """What moves on a page: its elements, their rules, the samples as JSON; the frame's files that serve it."""

    body: str
    rules: str
    data: str
    styles: Sequence[str] = ("moving.css",)
    scripts: Sequence[str] = ("moving.js",)


@dataclass(frozen=True)
class Live:
    """What a page has that is renewed while it is read: words of its own (`live` in `words.yaml`), its editions."""

    words: Mapping[str, str]
    moving: int
    report: int
    scripts: Sequence[str] = ("live.js",)
    styles: Sequence[str] = ("live.css",)


def report(document: tree.Document) -> Report:
    """The elements of a document; raises `TypesetterError` for a formula that cannot be set."""
    pens = Pens()
    blocks = Blocks(document, pens)
    body = blocks.write(document.blocks)
    papers = (
        f"@page {name}{{size:{width:g}mm {height:g}mm;margin:12mm}}.{name}{{page:{name}}}"
        for name, (width, height) in blocks.papers.items()
    )
    return Report(body, "\n".join((pens.rules(), *papers)))


def write(
    document: tree.Document,
    words: Mapping[str, Any],
    panel: Panel | None = None,
    live: Live | None = None,
    written: Report | None = None,
) -> str:
    """The whole page; `words` are those of its buttons (`page` in `words.yaml`).

    Raises `TypesetterError` if a file of the frame is missing.
    """
    written = written or report(document)
    parts = [part for part in (panel, live) if part is not None]
    styles = [read(name) for name in (*STYLES, *(name for part in parts for name in part.styles))]
    rules = {"moving": panel.rules if panel else "", "report": written.rules}
    # Rules that change while the page is read are the script's to put in.
    styles += [] if live else rules.values()
    scripts = [read(name) for name in (*SCRIPTS, *(name for part in parts for name in part.scripts))]
    style, script = "\n".join(styles), "\n".join(scripts)
    policy = [
        "default-src 'none'",
        f"script-src {_hash(script)}",
        f"style-src {_hash(style)}",
        "img-src data:",
        *(["connect-src 'self'"] if live else []),
        "base-uri 'none'",
        "form-action 'none'",
    ]
    return template("page.html.j2").render(
        language=document.language,
        title=document.title,
        author=document.author,
        policy="; ".join(policy),
        style=style,
        script=script,
        words=words,
        panel=panel,
        samples=panel.data if panel else "",
        live=live,
        editions=data(
            {"moving": live.moving, "report": live.report, "rules": rules, "words": live.words} if live else {}
        ),
        body=written.body,
    )


def template(name: str) -> Template:
    """A template of the frame; raises `TypesetterError` if it is missing."""
    read(name)
    return _environment().get_template(name)


@cache
def _environment() -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    return Environment(
        loader=FileSystemLoader(templates() / "frames" / "html"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )


def read(name: str) -> str:
    """A file of the frame: from the installed package, or beside it in a checkout."""
    path = templates() / "frames" / "html" / name
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise TypesetterError(f"{path}: {error.strerror}") from error


def data(content: Mapping[str, Any]) -> str:
    """Data as the content of a script element, which no text in it can end."""
    return json.dumps(content, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


def _hash(text: str) -> str:
    """A source expression of a security policy that allows this text alone."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
