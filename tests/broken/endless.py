"""Files made to keep the reader busy, each of any size: something right, then the same again and again."""

from __future__ import annotations

from tests.broken.rows import base

ENDLESS = {
    "aliases": ("variant: [", "*a,", "]"),
    "anchors": ("variant: [", "&a 1,", "]"),
    "tags": ("variant: [", "!a 1,", "]"),
    "keys of a row": ("variant: {", "a,", "}"),
    "values": ("variant: [", "1,", "]"),
    "values below each other": ("variant:\n", "- 1\n", ""),
    "lists in lists": ("variant: ", "- ", ""),
    "tabs": ("", "\t", ""),
    "lines of tabs": ("", "\t\n", ""),
    "empty lines": ("", "\n", ""),
    "comments": ("", "#\n", ""),
    "directives": ("", "%a b\n", ""),
    "documents": ("", "---\n", ""),
    "lines of a text": ("variant: |\n", "  x\n", ""),
    "words": ("variant: x", " x", ""),
    "escapes": ('variant: "', "\\n", '"'),
    "a key": ("", "x", ": 1"),
    "positions": ("kind: engine-twin\nreport: {worked_positions: [", "1,", "]}"),
    "pressures": (base("engine-twin").split("  exhaust")[0] + "  exhaust: [", "1,", "]"),
}


def endless(name: str, size: int) -> str:
    """The file of this name with almost so many characters."""
    before, again, after = ENDLESS[name]
    return before + again * ((size - len(before) - len(after)) // len(again)) + after
