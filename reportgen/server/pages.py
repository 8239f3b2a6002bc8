"""The pages: templates of `templates/frames/server/` with the words of a language, and the files that they load."""

from __future__ import annotations

import hashlib
import mimetypes
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from reportgen.base.template_folders import languages, templates
from reportgen.base.units import Language
from reportgen.base.words import common_words

if TYPE_CHECKING:
    from jinja2 import Environment

STATIC = frozenset({".css", ".js", ".svg", ".woff2"})


def words_of(language: Language) -> Mapping[str, Any]:
    """Return the words of the pages."""
    words: Mapping[str, Any] = common_words(language).get("server", {})
    return words


def explained(language: Language, code: str) -> str:
    """Return the sentence for the code of a refusal."""
    return str(words_of(language).get("errors", {}).get(code, code))


def page(name: str, language: Language, **content: Any) -> str:
    """Return a page as HTML; every value in it is escaped."""
    made = _environment().get_template(f"{name}.html.j2")
    offered = [(one, str(common_words(one).get("server", {}).get("language_name", one))) for one in languages()]
    return made.render(language=language, languages=offered, words=words_of(language), static=address, **content)


def address(name: str) -> str:
    """Return the address of a style sheet or script; it changes with the content."""
    content = static(name)
    assert content is not None, f"{name} is a file of the pages"
    return f"/static/{name}?{hashlib.sha256(content[0]).hexdigest()[:12]}"


def static(name: str) -> tuple[bytes, str] | None:
    """Return a file that pages load, with its type; None for any other name."""
    return _static_files().get(name)


@cache
def _static_files() -> Mapping[str, tuple[bytes, str]]:
    """Return all files that pages load: what strangers ask for is looked up, and never kept."""
    return {
        file.name: (file.read_bytes(), mimetypes.guess_type(file.name)[0] or "application/octet-stream")
        for file in _folder().iterdir()
        if file.suffix in STATIC and file.is_file()
    }


def _folder() -> Path:
    return templates() / "frames" / "server"


@cache
def _environment() -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    from reportgen.server.page_filters import add_filters

    environment = Environment(
        loader=FileSystemLoader(_folder()),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )
    add_filters(environment)
    return environment
