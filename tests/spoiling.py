"""Spoil files at random as hands and disks do: texts, parts of a package, lines of a drawing, bytes."""

from __future__ import annotations

import io
import random
import re
import zipfile
from collections.abc import Callable, Sequence

NUMBER = re.compile(r"(?<![\w.])[-+]?[0-9]+(?:\.[0-9]+)?(?![\w.])")
EXTREMES = ("0", "-0", "1e-300", "1e300", "1e-9", "1e9", "-1", "0.5", "1", "1.0000001", "359.999999", "999999999", "٣")
UNITS = ("mm", "m", "km", "deg", "rad", "rpm", "rad/s", "N", "kN", "kg", "N m", "kg m2", "m/s", "N/cm2", "MPa", "")
HOSTILE = (
    "\t",
    "\0",
    "&a ",
    "*a",
    "!!x ",
    "{",
    "[",
    "]",
    "'",
    '"',
    ": ",
    "- ",
    "#",
    "\u202e",
    "🙂",
    "=1+1",
    ",",
    ";",
    "\n",
)
SWITCHES = (
    ("direction: anticlockwise", "direction: clockwise"),
    ("branch: open", "branch: crossed"),
    ("side: left", "side: right"),
    ("end: far", "end: near"),
    ("sense: opposing", "sense: clockwise"),
)


def spoilt(text: str, chance: random.Random) -> str:
    """Return the text with one to three changes."""
    for _ in range(chance.choice((1, 1, 1, 2, 3))):
        text = chance.choice(CHANGES)(text, chance)
    return text


def scaled(text: str, chance: random.Random) -> str:
    """Make a number somewhat larger or smaller: the one change that often leaves a file valid."""
    return _at_a_number(text, chance, lambda old: f"{float(old) * chance.choice((0.5, 0.9, 0.99, 1.01, 1.1, 2)):.10g}")


def extreme(text: str, chance: random.Random) -> str:
    return _at_a_number(text, chance, lambda old: chance.choice(EXTREMES))


def _at_a_number(text: str, chance: random.Random, new: Callable[[str], str]) -> str:
    found = list(NUMBER.finditer(text))
    if not found:
        return text
    one = chance.choice(found)
    return text[: one.start()] + new(one[0]) + text[one.end() :]


def _zeros(text: str, chance: random.Random) -> str:
    """Replace all numbers of a line by 0."""
    return _at_a_line(text, chance, lambda line: [NUMBER.sub("0", line)])


def _unit(text: str, chance: random.Random) -> str:
    found = list(re.finditer(r"(?<=[0-9] )[A-Za-z][\w/ ]*", text))
    if not found:
        return text
    one = chance.choice(found)
    return text[: one.start()] + chance.choice(UNITS) + text[one.end() :]


def letter(text: str, chance: random.Random) -> str:
    at = chance.randrange(len(text) + 1)
    return text[:at] + chance.choice(HOSTILE) + text[at + chance.choice((0, 1)) :]


def _at_a_line(text: str, chance: random.Random, new: Callable[[str], list[str]]) -> str:
    lines = text.splitlines()
    if not lines:
        return text
    at = chance.randrange(len(lines))
    return "\n".join((*lines[:at], *new(lines[at]), *lines[at + 1 :], ""))


def _line(text: str, chance: random.Random) -> str:
    return _at_a_line(
        text, chance, chance.choice((lambda line: [], lambda line: [line, line], lambda line: [line[1:]]))
    )


def _switch(text: str, chance: random.Random) -> str:
    there = [pair for pair in SWITCHES if pair[0] in text]
    return text.replace(*chance.choice(there), 1) if there else text


def _positions(text: str, chance: random.Random) -> str:
    count, start = chance.choice((4, 5, 7, 13, 24)), chance.uniform(-360, 360)
    sense = chance.choice(("anticlockwise", "clockwise"))
    section = f"positions: {{count: {count}, direction: {sense}, start: {start:.3f} deg}}"
    return re.sub(r"^positions:.*$", section, text, count=1, flags=re.MULTILINE)


CHANGES = (scaled, scaled, scaled, extreme, extreme, _zeros, _unit, letter, _line, _switch, _positions)


# --- files of programs ----------------------------------------------------------------------------

Change = Callable[[str, random.Random], str]


def element(text: str, chance: random.Random) -> str:
    """Omit, duplicate or rename a tag."""
    tags = list(re.finditer(r"<(/?)([\w:]+)([^<>]*)>", text))
    if not tags:
        return text
    one, other = (chance.choice(tags) for _ in range(2))
    new = chance.choice(("", one[0] * 2, f"<{one[1]}{other[2]}{one[3]}>", one[0] + other[0]))
    return text[: one.start()] + new + text[one.end() :]


def value(text: str, chance: random.Random) -> str:
    """Change the value of an attribute."""
    values = list(re.finditer(r'(?<==")[^"]*', text))
    if not values:
        return text
    one = chance.choice(values)
    return text[: one.start()] + chance.choice((*EXTREMES, "", "16000", "Normal", "true")) + text[one.end() :]


def spoilt_package(
    data: bytes, parts: str, changes: Sequence[Change], chance: random.Random, times: Sequence[int] = (1, 1, 3)
) -> bytes:
    """Return a zip package in which one part whose name matches a pattern is changed several times."""
    made = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as new:
        changed = chance.choice([name for name in old.namelist() if re.search(parts, name)])
        for name in old.namelist():
            content = old.read(name)
            if name == changed:
                text = content.decode()
                for _ in range(chance.choice(times)):
                    text = chance.choice(changes)(text, chance)
                content = text.encode("utf-8", "surrogatepass")
            new.writestr(name, content)
    return made.getvalue()


def spoilt_lines(data: bytes, chance: random.Random) -> bytes:
    """Return a drawing with some lines of its text replaced."""
    lines = data.splitlines(keepends=True)
    for _ in range(chance.choice((1, 3, 20))):
        at = chance.randrange(len(lines))
        lines[at : at + chance.randrange(3)] = chance.choices((b"0\n", b"1e999\n", b"nan\n", b"INSERT\n"), k=2)
    return b"".join(lines)


def spoilt_bytes(data: bytes, chance: random.Random, times: Sequence[int] = (1, 3, 20)) -> bytes:
    """Return a file with some bytes changed."""
    content = bytearray(data)
    for _ in range(chance.choice(times)):
        content[chance.randrange(len(content))] = chance.randrange(256)
    return bytes(content)
