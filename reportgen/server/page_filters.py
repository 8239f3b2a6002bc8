"""Filters of the page templates: times, sizes, numbers and symbols as a reader of the page's language writes them."""

from __future__ import annotations

import datetime
from typing import TYPE_CHECKING

from jinja2 import pass_context

from reportgen.base.languages import decimal_mark

if TYPE_CHECKING:
    from jinja2 import Environment
    from jinja2.runtime import Context


def add_filters(environment: Environment) -> None:
    """Give the filters to the templates of an environment."""
    environment.filters |= {"moment": _moment, "size": _size, "number": _number, "symbol": _symbol}


@pass_context
def _moment(context: Context, text: str) -> str:
    """Return a time in ISO 8601 as the page's language writes it, at the server's own offset."""
    time = datetime.datetime.fromisoformat(text)
    return time.strftime("%H:%M, %d/%m/%Y" if context["language"] == "vi" else "%Y-%m-%d, %H:%M")


@pass_context
def _number(context: Context, value: float | str | None) -> str:
    """Return a number with the decimal mark of the page's language; a dash for none."""
    if value is None:
        return "–"
    text = value if isinstance(value, str) else f"{value:.6g}"
    return text.replace(".", decimal_mark(context["language"]))


def _size(count: int) -> str:
    """Return a number of bytes in MB or kB."""
    return f"{count / 1e6:.1f} MB" if count >= 1e6 else f"{max(count / 1e3, 0.1):.1f} kB"


def _symbol(text: str) -> tuple[str, str, str]:
    """Return a symbol in plain text, such as a_BA^n, as its letter, its subscript and its superscript."""
    rest, _, above = text.partition("^")
    letter, _, below = rest.partition("_")
    return letter, below, above
