"""A text spoilt at random, as hands spoil it: numbers, units, letters, lines, switches, positions."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

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
    """The text with one to three changes."""
    for _ in range(chance.choice((1, 1, 1, 2, 3))):
        text = chance.choice(CHANGES)(text, chance)
    return text


def scaled(text: str, chance: random.Random) -> str:
    """A number is somewhat larger or smaller: the one change that often leaves a file right."""
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
    """All numbers of a line are 0."""
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
