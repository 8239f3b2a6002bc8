"""Detect common YAML typing mistakes and report them at the right line.

`a:0.255 m` and `a = 0.255 m` are texts to YAML, not keys with values; “95 mm” in typographic quotes is not a
number; and a blank copied from a web page (U+00A0) does not separate anything.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator

from reportgen.base.errors import Fault, Location

_NAME = r"[^\W\d]\w*(?:\.\w+)*"
_UNPARTED = re.compile(rf"(?P<lead>[ ]*(?:- )?)(?P<key>{_NAME})(?::(?![\s/])|[ ]*=[ ]*)(?P<value>\S.*?)\s*")
_NEXT = re.compile(rf"\s+{_NAME}\s*[:=].*")
"""Pattern of a text that continues over the lines of further keys."""
_ODD_BLANK = re.compile("[\u00a0\u1680\u2000-\u200b\u202f\u205f\u3000\ufeff]")
_QUOTES = {"“": "”", "”": "”", "„": "“”", "«": "»", "‘": "’", "’": "’", "‚": "‘’"}
"""Typographic quotation marks with their closing marks."""


_OPEN_QUOTE = re.compile(r"""\s*(?:- )?(?:[\w.-]+:)?\s+(?P<mark>["'])(?:(?!(?P=mark)).)*$""")
"""Pattern of a line with a value that begins with a quotation mark and has no second one."""


def in_quotes(text: str) -> str | None:
    """Return the text inside typographic quotation marks, None for a text without them."""
    inner = text.strip()
    return inner[1:-1] if len(inner) > 1 and inner[-1] in _QUOTES.get(inner[0], "") else None


def meant(key: str) -> str:
    """Return the key that a text was probably meant to be; the text itself if it has no typing mistake."""
    unparted = _UNPARTED.fullmatch(key)
    return unparted["key"] if unparted else in_quotes(key) or _ODD_BLANK.sub("", key)


def slip(text: str, location: Location) -> Fault | None:
    """Return the typing mistake in a text that was meant to be a key, a value or a section; None if there is none."""
    if odd := _ODD_BLANK.search(text):
        return _odd_blank(odd, location)
    if in_quotes(text) is not None:
        return Fault("typographic-quotes", location, {"text": text, "fixed": in_quotes(text) or ""})
    return _unparted(text, location)


def slips_above(lines: list[str], line: int, file: str) -> list[Fault]:
    """Return the typing mistakes in the line (from 1) at which YAML fails, or else in the lines directly above it."""
    faults: list[Fault] = []
    for number in range(min(line, len(lines)), 0, -1):
        if not _bare(lines[number - 1]).strip():
            continue
        slips = list(_slips_in(lines[number - 1], number, file))
        if not slips and (faults or number < line):
            break
        faults[:0] = slips
    return faults


def open_quote(lines: list[str], file: str) -> Location | None:
    """Return the location of the first quotation mark that begins a value and is not closed in its line."""
    for number, line in enumerate(lines, 1):
        if match := _OPEN_QUOTE.match(line):
            return Location(file, number, match.start("mark") + 1)
    return None


def misplaced(lines: list[str], location: Location) -> Location:
    """Return the location of a line or of the one above it, whichever has an unusual indentation for this file."""
    indents = {number: len(line) - len(line.lstrip(" ")) for number, line in enumerate(lines, 1) if _bare(line).strip()}
    usual = Counter(filter(None, indents.values())).most_common(1)
    above = max((number for number in indents if number < location.line), default=0)
    if above and usual and indents[above] % usual[0][0] and indents.get(location.line, 0) % usual[0][0] == 0:
        return Location(location.file, above, indents[above] + 1)
    return location


def _bare(line: str) -> str:
    """Return a line without its comment."""
    return re.sub(r"(^|\s)#.*", "", line)


def _slips_in(line: str, number: int, file: str) -> Iterator[Fault]:
    if odd := _ODD_BLANK.search(_bare(line)):
        yield _odd_blank(odd, Location(file, number))
    else:
        indent = len(line) - len(line.lstrip(" "))
        fault = _unparted(_bare(line).strip(), Location(file, number, indent + 1))
        yield from [fault] if fault else []


def _odd_blank(blank: re.Match[str], location: Location) -> Fault:
    about = {"text": f"U+{ord(blank[0]):04X}"}
    return Fault("odd-blank", Location(location.file, location.line, location.column + blank.start()), about)


def _unparted(text: str, location: Location) -> Fault | None:
    """Return a fault for a key and its value without a separator, or with an equals sign."""
    match = _UNPARTED.fullmatch(text)
    if match is None:
        return None
    value = _NEXT.sub("", match["value"])
    end = match.start("value")
    code = "equals-sign" if "=" in text[len(match["key"]) : end] else "no-blank"
    column = location.column + len(match["lead"])
    fixed = f"{match['key']}: {value}"
    return Fault(
        code, Location(location.file, location.line, column), {"text": text[:end].lstrip() + value, "line": fixed}
    )
