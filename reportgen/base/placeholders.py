"""Fill `{placeholders}` in message strings with plain values only, texts and numbers."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from numbers import Real
from string import Formatter
from typing import Any

from reportgen.base.errors import Location

FILLS = (str, Real)
"""Types of the values that a placeholder accepts."""
NO_LETTER = "\0"
"""Character that marks a placeholder whose place is searched for; it does not occur in any text."""
_ENTRY = re.compile(r"\{[^{}]*[.\[!]")
"""Pattern of a placeholder that requests more than a plain value."""


def gaps(template: str) -> set[str]:
    """Return the names of the placeholders in a text."""
    return {name for _, name, _, _ in Formatter().parse(template) if name}


def plain_gaps(text: str) -> bool:
    """Return True if all placeholders name plain values: no items, widths, conversions or private names."""
    try:
        named = [(name, how, turned) for _, name, how, turned in Formatter().parse(text) if name is not None]
    except ValueError:
        return False
    return not any(
        turned or re.search(r"\[|(^|\.)_", name) or re.search(r"[{\d]", how or "") for name, how, turned in named
    )


def filled(text: str, values: Sequence[Any], named: Mapping[str, Any]) -> str:
    """Return a text with its placeholders filled.

    Raises `LookupError`, `TypeError` or `ValueError` for a placeholder without a value, or with a value that is
    neither text nor number.
    """
    if _ENTRY.search(text) or not all(isinstance(value, FILLS) for value in (*values, *named.values())):
        return _Filling().vformat(text, values, named)
    return str.format(text, *values, **named)


def place_of(text: str, words: Any) -> Location | None:
    """Return the location of a text among words that know their locations; None if it is not among them."""
    if isinstance(words, str):
        return getattr(words, "mark", None) if words == text else None
    inner = words.values() if isinstance(words, Mapping) else words if isinstance(words, list) else ()
    return next(filter(None, (place_of(text, one) for one in inner)), None)


class _Filling(Formatter):
    """Formatter that fills placeholders with texts and numbers; a name after a point is an entry of a mapping."""

    def get_field(self, field_name: str, args: Sequence[Any], kwargs: Mapping[str, Any]) -> tuple[Any, str]:
        first, *entries = field_name.split(".")
        value = self.get_value(int(first) if first.isdigit() else first, args, kwargs)
        for entry in entries:
            if not isinstance(value, Mapping):
                raise LookupError(field_name)
            value = value[entry]
        return value, first

    def format_field(self, value: Any, format_spec: str) -> str:
        if not isinstance(value, FILLS):
            raise TypeError(type(value).__name__)
        return format(value, format_spec)
