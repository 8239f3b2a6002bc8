"""Specs of classes, rosters of students, and the places of faults in both."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from reportgen.base.errors import AssignmentError, Fault, Location
from reportgen.classes.roster import Roster, RosterEntry
from reportgen.classes.variant_draw import Draw, DrawnVariant, FindFaults
from reportgen.classes.variant_spec import Spec

ROOT = Path(__file__).parents[2]
DEMO = ROOT / "assignments" / "class-demo"
BARS = """\
kind: four-bar
salt: "2011"
report: {language: en}
parameters:
  AB: {from: 100 mm, to: 130 mm, step: 5 mm}   # the crank
  BC: [340 mm, 350 mm]
  CD: 280 mm
  AD: 400 mm
  omega1: 20 rad/s
  E:
    along: {from: 0.1 mm, to: 0.4 mm, step: 0.1 mm}
    across: 110 mm
  torque: {M: 40 N m, sense: [opposing, clockwise]}
"""
Put = Callable[..., Path]


def classes(*ids: str) -> Roster:
    return Roster(tuple(RosterEntry({"id": id}, {}, Location("r", k)) for k, id in enumerate(ids, start=2)))


class Result(NamedTuple):
    """What a draw for a whole class came to."""

    drawn: tuple[DrawnVariant, ...]
    faults: tuple[Fault, ...]
    usable: int | None


def draw(spec: Spec, roster: Roster, judge: FindFaults) -> Result:
    under_way = Draw(spec, judge)
    drawn = tuple(under_way.each(roster))
    return Result(drawn, tuple(under_way.faults), under_way.usable)


def ids(count: int) -> tuple[str, ...]:
    return tuple(f"K{number:03}" for number in range(count))


def located(error: AssignmentError, path: Path) -> list[str]:
    lines = [str(problem).splitlines()[0].replace(str(path), "FILE") for problem in error.problems]
    return [re.sub(r": error\[(.*?)\].*", r" \1", line) for line in lines]
