"""Drawing sheets of assignment files, each laid out once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from reportgen.base.languages import setting_of
from reportgen.drawing.drawing_sheet import DrawingSheet, PlacedScene
from reportgen.sheets import drawing_sheets
from reportgen.sheets.title_block import TitleBlock, blocks, read_block
from tests.report import built

ROOT = Path(__file__).parents[2]
MACHINES = sorted(path.stem for path in (ROOT / "assignments").glob("*.yaml"))
EXERCISES = ("01", "16")
"""One with velocities alone, one with accelerations, too."""
EVERY = (*MACHINES, *EXERCISES)


@dataclass(frozen=True)
class Laid:
    """A case with its sheets."""

    case: Any
    sheets: list[DrawingSheet]


def opened(name: str) -> Any:
    folder = ROOT / "assignments" / ("plane-motion" if name in EXERCISES else "")
    return built.case(folder / f"{name}.yaml")


@cache
def laid(name: str, size: str, every: bool = False) -> Laid:
    """The sheets of an assignment."""
    return Laid(opened(name), drawing_sheets(opened(name), size, every=every))


@cache
def block_of(name: str) -> TitleBlock:
    return read_block(blocks()[setting_of(opened(name).assignment.language).block])


def plates(sheet: DrawingSheet) -> list[PlacedScene]:
    """What a sheet shows, without frame and title block: heads, called by the numbers of plates, and scenes."""
    return [part for part in sheet.parts if part.layer != "frame"]


def numbers(sheet: DrawingSheet) -> list[int]:
    """The numbers of its plates, as they stand."""
    return [int(part.name) for part in plates(sheet) if "." not in part.name]
