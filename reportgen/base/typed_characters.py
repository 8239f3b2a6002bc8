"""Normalise characters in numbers as people type and paste them: variants of minus, dot and blank, invisible letters.

This table is used for everything that students hand in: sheets, CSV, Word reports, drawings, corrections.
"""

from __future__ import annotations

UNSEEN = frozenset("\u200b\u200c\u200d\u2060\u2061\u2062\u2063\u2064\ufeff\xad\u200e\u200f")
"""Letters without width."""
MINUSES = frozenset("\u2010\u2011\u2012\u2212\ufe63\uff0d")
"""Characters read as a minus; a dash may also separate two numbers."""
DASHES = frozenset("\u2013\u2014")
RAISED_MINUS = "\u207b"
DOTS = frozenset("\u2219\u22c5\u2022\u30fb")
"""Characters read as a multiplication dot."""
SPACES = "\u00a0\u2002-\u200a\u202f\u205f\u3000"
"""Blanks of any width, as a class of a regular expression."""

_PLAIN = str.maketrans({**dict.fromkeys(UNSEEN, ""), **dict.fromkeys(MINUSES, "-"), **dict.fromkeys(DOTS, "·")})


def plain_signs(text: str) -> str:
    """Return the text with one kind of minus and dot, and without invisible letters."""
    return text.translate(_PLAIN)
