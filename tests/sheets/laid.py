"""Drawing sheets of assignment files, each laid out once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from reportgen.cases import MachineCase, open_case
from reportgen.drawing.sheet import DrawingSheet, PlacedScene, Room
from reportgen.report.report import Report
from reportgen.sheets import sheets_of
from reportgen.sheets.frame import DEFAULT, TitleBlock, blocks, read_block, room
from reportgen.sheets.plates import Plates

ROOT = Path(__file__).parents[2]
EVERY = sorted(path.stem for path in (ROOT / "assignments").glob("*.yaml"))
MACHINES = (
    *("engine-twin-05", "engine-single-V", "engine-v-01", "four-bar-01", "lever-six-bar-01", "linkage-8"),
    *("linkage-slide", "scotch-yoke-01", "shaper-02", "slider-crank-01", "slotted-lever-01", "toggle-press-01"),
)
"""One of each kind, and a linkage with a sliding driver."""


@dataclass(frozen=True)
class Laid:
    """A case with its sheets."""

    case: MachineCase
    sheets: list[DrawingSheet]


@cache
def drawn(name: str) -> Plates:
    """The plates of an assignment, which sheets of all sizes share."""
    return Plates.of(Report(open_case(ROOT / "assignments" / f"{name}.yaml")))


@cache
def laid(name: str, size: str, only: str = "") -> Laid:
    """The sheets of an assignment, or `only` those of a set."""
    found, sets = drawn(name), [only] if only else []
    return Laid(found.report.case, sheets_of(found, found.of_sets(sets), size, block_of(name)))


@cache
def block_of(name: str) -> TitleBlock:
    return read_block(blocks()[DEFAULT[drawn(name).report.case.assignment.language]])


def space(name: str, size: str) -> Room:
    """What frame and title block leave free."""
    block = block_of(name)
    return room(size, block.margins, block.size)


def plates(sheet: DrawingSheet) -> list[PlacedScene]:
    """What a sheet shows, without frame and title block."""
    return [part for part in sheet.parts if part.layer != "frame"]
