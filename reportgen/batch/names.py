"""A student's id as the name of a file or folder, harmless on any system."""

from __future__ import annotations

import hashlib
import re
import unicodedata

LONGEST = 64
KEPT = 32
"""Characters of an id that is changed; the hash after them tells it from all others."""
HASHED = 12

_ORDINARY = re.compile(rf"[A-Z0-9][A-Z0-9_-]{{0,{LONGEST - 1}}}")
_RESERVED = re.compile(r"(CON|PRN|AUX|NUL|CLOCK|CONIN|CONOUT|COM[0-9]|LPT[0-9])")
_LIKE_HASHED = re.compile(rf".*-[0-9A-F]{{{HASHED}}}")


def folder_name(id: str) -> str:
    """One path component that stands for an id and for no other, whatever the id holds.

    An id of capital letters, digits, - and _ stays as it is.  Any other is reduced to letters and digits and
    gets "-" and the first 12 hexadecimal digits of the SHA-256 of its composed form (NFC, UTF-8); so does one
    in small letters, since some systems do not tell them from capitals.
    """
    composed = unicodedata.normalize("NFC", id)
    if _ORDINARY.fullmatch(composed) and not _RESERVED.fullmatch(composed) and not _LIKE_HASHED.fullmatch(composed):
        return composed
    digest = hashlib.sha256(composed.encode("utf-8", "surrogatepass")).hexdigest()[:HASHED]
    bare = unicodedata.normalize("NFD", composed.replace("đ", "d").replace("Đ", "D"))
    letters = "".join(one for one in bare if not unicodedata.combining(one))
    kept = re.sub(r"[^A-Za-z0-9]+", "_", letters).strip("_")[:KEPT]
    return f"{kept or 'id'}-{digest}"
