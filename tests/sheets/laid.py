"""Drawing sheets of assignment files, each laid out once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from reportgen.case import Case, open_case
from reportgen.document.drawing_sheets import drawing_sheets
from reportgen.figures.sheet import Part, Sheet

ROOT = Path(__file__).parents[2]
MACHINES = (
    *("engine-twin-05", "engine-single-V", "engine-v-01", "four-bar-01", "lever-six-bar-01", "linkage-8"),
    *("linkage-slide", "scotch-yoke-01", "shaper-02", "slider-crank-01", "slotted-lever-01", "toggle-press-01"),
)
"""One of each kind, and a linkage with a sliding driver."""
SIZES = (*((name, "A1") for name in MACHINES), ("four-bar-02", "A0"), ("slider-crank-02", "A2"), ("four-bar-02", "A3"))


@dataclass(frozen=True)
class Laid:
    """A case with its sheets."""

    case: Case
    sheets: list[Sheet]


@cache
def laid(name: str, size: str) -> Laid:
    case = open_case(ROOT / "assignments" / f"{name}.yaml")
    return Laid(case, drawing_sheets(case, size))


def plates(sheet: Sheet) -> list[Part]:
    """What a sheet shows, without frame and title block."""
    return [part for part in sheet.parts if part.layer != "frame"]
