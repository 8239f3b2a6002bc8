"""Detect Russian text files in the Windows code page cp1251, saved by older programs without a byte-order mark."""

from __future__ import annotations

import re

CODEC = "cp1251"
_LETTER = "[\u0410-\u044fЁё]"
_WORD = re.compile(f"{_LETTER}+")
_CASED = re.compile("[\u0410-\u042fЁ]?[\u0430-\u044fё]+|[\u0410-\u042fЁ]+")
_MIXED = re.compile(f"[A-Za-z]{_LETTER}|{_LETTER}[A-Za-z]")
_SIGNS = frozenset("«»№–—…“”„’‘°\u00a0")
"""Other signs beyond ASCII that a Russian text may contain."""
_LONG = 0.9
"""Smallest share of letters in words of two letters or more."""


def is_cp1251(data: bytes) -> bool:
    """Return True if bytes that are not UTF-8 are Russian in the Windows code page cp1251.

    Bytes of other code pages decode to words of mixed case (KOI8-R), signs that no text has, or single Cyrillic
    letters between Latin ones.
    """
    try:
        text = data.decode(CODEC)
    except UnicodeError:
        return False
    words = _WORD.findall(text)
    letters = sum(map(len, words))
    strange = any(not letter.isascii() and letter not in _SIGNS for letter in _WORD.sub("", text))
    long_words = sum(len(word) for word in words if len(word) > 1)
    cased = all(_CASED.fullmatch(word) for word in words)
    return bool(letters) and not strange and cased and not _MIXED.search(text) and long_words >= _LONG * letters
