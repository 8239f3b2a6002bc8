"""Which way the shafts of a coursework turn: machine, trains, gears and cams, all as the machine is drawn."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from reportgen.formula import Number
from reportgen.report import Block, Cell, Column, Inlines, Paragraph, Reference, Table, Text, Value
from reportgen.report.key import capitalised
from reportgen.report.shafts import Shaft
from reportgen.report.wording import sentence

KEY = "tab.shafts"
WIDTHS = (76.0, 26.0, 58.0)
"""Widths of the columns (mm)."""
SAME = 1e-6
"""Speeds that differ by a smaller share are one."""
RPM = 30 / math.pi


@dataclass(frozen=True)
class PartShafts:
    """The shafts of a part, and which of their data are just the machine's, by key."""

    title: str
    shafts: Sequence[Shaft]
    taken: Mapping[str, str]


@dataclass(frozen=True)
class TurningShaft:
    """A shaft with its sense: 1 anticlockwise, −1 clockwise, 0 where it is known against the `first` of its part only.

    `driving` says that it is the driver's own.
    """

    shaft: Shaft
    sense: int
    first: Shaft
    driving: bool = False


def turning(part: PartShafts, driver: Shaft) -> Iterator[TurningShaft]:
    """The shafts of a part with their senses: one with the speed of the driver's shaft is taken for the same shaft."""
    first = part.shafts[0]
    driving = next((one for one in part.shafts if _is_driver(one, part.taken, driver)), None)
    for one in part.shafts:
        seen = driver.turn * driving.turn * one.turn if driving else 0
        yield TurningShaft(one, one.turn if one.fixed else seen, first, one is driving)


def _is_driver(shaft: Shaft, taken: Mapping[str, str], driver: Shaft) -> bool:
    """Whether a shaft is the driver's: by what its speed is taken from, else by that speed."""
    if shaft.datum in taken:
        return taken[shaft.datum] == driver.datum
    if shaft.speed is None or driver.speed is None or shaft.fixed:
        return False
    return math.isclose(shaft.speed, driver.speed, rel_tol=max(shaft.share, SAME))


def told(driver: Shaft, parts: Sequence[PartShafts], words: Mapping[str, Any], unit: str) -> Iterator[Block]:
    """A sentence and a table of all shafts, and why a speed may have another sign in its own part."""
    own = words["coursework"]["shafts"]
    rows: list[tuple[Inlines, Inlines, Inlines]] = [_row(TurningShaft(driver, driver.turn, driver), words)]
    names = Counter(shaft.name for part in parts for shaft in part.shafts)
    signs: list[Block] = []
    for part in parts:
        for one in turning(part, driver) if part.shafts else ():
            # Two cams are told apart by the titles of their parts.
            rows.append(_row(one, words, part.title if names[one.shaft.name] > 1 else ""))
            if one.driving and not one.shaft.fixed and one.shaft is not one.first:
                name = "same" if one.shaft.turn > 0 else "against"
                named = {
                    "shaft": one.shaft.name,
                    "Shaft": capitalised(one.shaft.name),
                    "first": one.first.name,
                    "title": part.title,
                }
                signs.append(Paragraph(sentence(own[name], **named, table=Reference(KEY))))
    head = tuple(Cell((Text(text.format(unit=unit)),)) for text in own["head"])
    columns = (Column(WIDTHS[0], "left"), *(Column(width) for width in WIDTHS[1:]))
    yield Paragraph(sentence(own["lead"], table=Reference(KEY)))
    yield Table(columns, (head,), tuple(tuple(map(Cell, row)) for row in rows), (Text(own["caption"]),), KEY)
    yield from signs


def _row(one: TurningShaft, words: Mapping[str, Any], title: str = "") -> tuple[Inlines, Inlines, Inlines]:
    shaft, own = one.shaft, words["coursework"]["shafts"]
    name = f"{shaft.name}, {own['of'].format(title=title)}" if title else shaft.name
    name = own["driving"].format(shaft=name) if one.driving else name
    speed: Inlines = (Text("–"),)
    if shaft.speed is not None:
        speed = (Value(Number(float(f"{shaft.speed * RPM:.5g}"))),)
    if one.sense:
        sense = words["sense"]["anticlockwise" if one.sense > 0 else "clockwise"]
    elif shaft is one.first:
        sense = "–"
    else:
        sense = own["with" if shaft.turn == one.first.turn else "opposite"].format(first=one.first.name)
    return (Text(capitalised(name)),), speed, (Text(sense),)
