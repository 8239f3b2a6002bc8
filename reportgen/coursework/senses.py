"""Senses of rotation of a coursework's shafts (machine, trains, gears, cams) in the drawing of the machine."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from reportgen.base.records import Record
from reportgen.case.answer_key import capitalised
from reportgen.case.quantity_wording import sentence
from reportgen.case.shafts import Shaft
from reportgen.document import Block, Cell, Column, Inlines, Paragraph, Reference, Table, Text, Value
from reportgen.formula import Number

KEY = "tab.shafts"
WIDTHS = (76.0, 26.0, 58.0)
"""Widths of the columns (mm)."""
SAME = 1e-6
"""Speeds that differ by a smaller share are equal."""
RPM = 30 / math.pi


class PartShafts(Record):
    """The shafts of a part, and the keys of its data that equal the machine's, with the machine's keys."""

    title: str
    shafts: Sequence[Shaft]
    taken: Mapping[str, str]


class TurningShaft(Record):
    """A shaft with its sense: 1 anticlockwise, −1 clockwise, 0 if it is known only relative to the `first` one of its
    part.

    `driving` is True for the driver's own shaft.
    """

    shaft: Shaft
    sense: int
    first: Shaft
    driving: bool = False


def turning(part: PartShafts, driver: Shaft) -> Iterator[TurningShaft]:
    """Yield the shafts of a part with their senses; a shaft with the speed of the driver's is considered the same
    shaft.
    """
    first = part.shafts[0]
    driving = next((one for one in part.shafts if _is_driver(one, part.taken, driver)), None)
    for shaft in part.shafts:
        seen = driver.turn * driving.turn * shaft.turn if driving else 0
        yield TurningShaft(shaft, shaft.turn if shaft.fixed else seen, first, shaft is driving)


def _is_driver(shaft: Shaft, taken: Mapping[str, str], driver: Shaft) -> bool:
    """Return True if a shaft is the driver's, according to the source of its speed, or else to that speed."""
    if shaft.datum in taken:
        return taken[shaft.datum] == driver.datum
    if shaft.speed is None or driver.speed is None or shaft.fixed:
        return False
    return math.isclose(shaft.speed, driver.speed, rel_tol=max(shaft.share, SAME))


def senses_of_shafts(
    driver: Shaft, parts: Sequence[PartShafts], words: Mapping[str, Any], unit: str
) -> Iterator[Block]:
    """Yield a sentence and a table of all shafts, and a note if a part's own report has a speed with another sign."""
    own = words["coursework"]["shafts"]
    rows: list[tuple[Inlines, Inlines, Inlines]] = [_row(TurningShaft(driver, driver.turn, driver), words)]
    names = Counter(shaft.name for part in parts for shaft in part.shafts)
    signs: list[Block] = []
    for part in parts:
        for turning_shaft in turning(part, driver) if part.shafts else ():
            # The titles of their parts distinguish two cams.
            rows.append(_row(turning_shaft, words, part.title if names[turning_shaft.shaft.name] > 1 else ""))
            if (
                turning_shaft.driving
                and not turning_shaft.shaft.fixed
                and turning_shaft.shaft is not turning_shaft.first
            ):
                name = "same" if turning_shaft.shaft.turn > 0 else "against"
                named = {
                    "shaft": turning_shaft.shaft.name,
                    "Shaft": capitalised(turning_shaft.shaft.name),
                    "first": turning_shaft.first.name,
                    "title": part.title,
                }
                signs.append(Paragraph(sentence(own[name], **named, table=Reference(KEY))))
    head = tuple(Cell((Text(text.format(unit=unit)),)) for text in own["head"])
    columns = (Column(WIDTHS[0], "left"), *(Column(width) for width in WIDTHS[1:]))
    yield Paragraph(sentence(own["lead"], table=Reference(KEY)))
    yield Table(columns, (head,), tuple(tuple(map(Cell, row)) for row in rows), (Text(own["caption"]),), KEY)
    yield from signs


def _row(turning_shaft: TurningShaft, words: Mapping[str, Any], title: str = "") -> tuple[Inlines, Inlines, Inlines]:
    shaft, own = turning_shaft.shaft, words["coursework"]["shafts"]
    name = f"{shaft.name}, {own['of'].format(title=title)}" if title else shaft.name
    name = own["driving"].format(shaft=name) if turning_shaft.driving else name
    speed: Inlines = (Text("–"),)
    if shaft.speed is not None:
        speed = (Value(Number(float(f"{shaft.speed * RPM:.5g}"))),)
    if turning_shaft.sense:
        sense = words["sense"]["anticlockwise" if turning_shaft.sense > 0 else "clockwise"]
    elif shaft is turning_shaft.first:
        sense = "–"
    else:
        sense = own["with" if shaft.turn == turning_shaft.first.turn else "opposite"].format(
            first=turning_shaft.first.name
        )
    return (Text(capitalised(name)),), speed, (Text(sense),)
