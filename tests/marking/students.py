"""Students of the tests: sheets worked out from a ledger, rightly, by a drawing, or with one mistake in it."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from reportgen import api
from reportgen.assignment import Assignment
from reportgen.base.errors import AssignmentError, Location
from reportgen.base.records import replace
from reportgen.case.answer_key import Key, KeyRow
from reportgen.cases import opened
from reportgen.formula.ledger import follow
from reportgen.marking.answer_sheet import asked_positions, grid, info_page, page, sheet_rows
from reportgen.marking.marking_data import Answer, Submission
from reportgen.marking.marking_scheme import MarkingScheme, marking_scheme
from reportgen.marking.mistakes import Mistake
from reportgen.marking.tolerance_bands import PAPER_ERROR, measuring_errors
from reportgen.marking.toleranced_key import words_of
from reportgen.workbook import Book, Entry

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"

QUANTITY = re.compile(r"([0-9.]+) ([A-Za-z][\w/^ ]*)")
KEPT = ("deg", "m/s2")
"""Angles decide the strokes of an engine, and g is the same for all."""

OF_FURTHER_KEYS = {
    *("no-tangential", "no-couple-of-driver", "no-free-length"),
    *("radius-for-circle", "coefficient-for-angle", "links-turned-alike", "one-link", "efficiency-inverted"),
}
"""The mistakes with what few files give: an acceleration of the driving link, springs, friction."""

OF_TRIADS = {*("special-point-fixed", "rotation-from-special-point", "special-point-even")}
"""The mistakes about the special point of a group of class III."""

OF_BALANCING = {*("omega-not-squared", "counterweight-on-pin-side", "share-of-turning-part", "order-with-single-angle")}
"""The mistakes about the force on the frame."""
OF_TRUE_MOTION = {
    *("half-forgotten", "slope-left-out", "speed-not-squared", "half-of-slope", "load-sign"),
    *("motor-constant", "two-pi-forgotten", "bounds-of-table"),
}
"""Those of the motion under a drive."""

NAMES = {
    "stroke-for-radius",
    "ratio-inverted",
    "rpm-for-radians",
    "minute-for-second",
    "weight-for-mass",
    "diameter-for-radius",
    "degrees-for-radians",
    "radians-for-degrees",
    "direction-reversed",
    "sign-reversed",
    "counted-backwards",
    "shifted-forward",
    "shifted-back",
    "other-piston",
    "wrong-stroke",
    "no-coriolis",
    "wrong-end",
    "scale-forgotten",
    "scale-twice",
    "thousands-mark",
}
"""The mistakes of working that marking knows by name."""

World = Mapping[str, np.ndarray]
"""All values (SI) by id, [N] or [1]."""

Cell = Callable[[KeyRow, int, float], float | None]
"""What a student writes for a row at a position, given the right value in its printed unit."""


def assignment(name: str, worked: tuple[int, ...] | None = None, **parameters: str) -> Assignment:
    """An assignment of the repository with other parameters; `worked` positions, None for all."""
    content = yaml.load((ASSIGNMENTS / f"{name}.yaml").read_text(encoding="utf-8"), Loader=yaml.BaseLoader)
    content["parameters"] |= parameters
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"{name}.yaml")
        path.write_text(yaml.safe_dump(content, allow_unicode=True), encoding="utf-8")
        loaded = api.load(path)
    return replace(loaded, report=loaded.report.model_copy(update={"worked_positions": worked}))


@cache
def scheme(name: str, worked: tuple[int, ...] | None = None) -> MarkingScheme:
    return marking_scheme(opened(assignment(name, worked)))


def sheet(scheme: MarkingScheme, cell: Cell) -> Submission:
    """A sheet with what `cell` says in every place that is asked for."""
    values = {}
    for row in scheme.key.asked:
        for position in row.positions:
            value = cell(row, position, float(row.values[row.at(position)]))
            if value is not None:
                values[(row.id, position)] = Answer(value, str(value), Location("sheet.csv"))
    return Submission(scheme.key.id, "sheet.csv", values, {})


def right(row: KeyRow, position: int, value: float) -> float:
    return value


def figures(value: float, digits: int = 3) -> float:
    """A value written down with so many significant figures."""
    return float(f"{value:.{digits - 1}e}")


def written(scheme: MarkingScheme, world: World) -> Submission:
    """The sheet of a student for whom everything came out as in `world`, written with three figures."""

    def cell(row: KeyRow, position: int, _: float) -> float | None:
        family = scheme.ledger[row.id]
        value = float(world[row.id][row.at(position)].real) / family.how.scale
        if not np.isfinite(value):
            return None
        if row.id.startswith("dir."):
            return float(round(value % 360))
        return figures(abs(value) if family.arm else value)

    return sheet(scheme, cell)


def worked_out(
    scheme: MarkingScheme, mistake: Mistake | None = None, drawn: np.random.Generator | None = None
) -> World:
    """The ledger run through with a mistake, and with lengths measured off by up to 0.5 mm at each end."""
    errors = measuring_errors(scheme.ledger, PAPER_ERROR) if drawn is not None else {}
    changes: dict[str, Any] = {}
    made = mistake.changes if mistake else {}
    for id in (*errors, *made):
        changes[id] = _change(errors.get(id), made.get(id), drawn)
    values = follow(scheme.ledger, changes)
    return {id: np.broadcast_to(values[id], family.values.shape) for id, family in scheme.ledger.families.items()}


def _change(error: np.ndarray | None, mistake: Any, drawn: np.random.Generator | None) -> Any:
    def change(value: np.ndarray, values: Mapping[str, np.ndarray]) -> np.ndarray:
        if error is not None and drawn is not None:
            ends = drawn.uniform(-0.5, 0.5, (2, *np.shape(error))).sum(axis=0)
            value = value + ends * np.nan_to_num(error)
        return value if mistake is None else mistake(value, values)

    return change


@dataclass(frozen=True)
class Effect:
    """Where a mistake shows: the first judged row that it moves by two bands, and the positions."""

    id: str
    positions: tuple[int, ...]


def effect(scheme: MarkingScheme, world: World) -> Effect | None:
    """The first row that a mistake moves, None if it moves nothing that is asked for."""
    for row in scheme.judged:
        moved = tuple(position for position in row.positions if off(scheme, row, world, position) > 2)
        if moved:
            return Effect(row.id, moved)
    return None


def off(scheme: MarkingScheme, row: KeyRow, world: World, position: int, other: World | None = None) -> float:
    """How far a value lies from the key's, or another world's, in bands."""
    family, index = scheme.ledger[row.id], row.at(position)
    one = float(world[row.id][index].real)
    two = float((family.values if other is None else other[row.id])[index].real)
    band = float(np.broadcast_to(scheme.bands[row.id], family.values.shape)[index])
    if family.arm:
        one, two = abs(one), abs(two)
    distance = abs((one - two + np.pi) % (2 * np.pi) - np.pi) if row.id.startswith("dir.") else abs(one - two)
    return distance / band if np.isfinite(distance) and band else 0.0


def filled_book(key: Key, submission: Submission) -> Book:
    """The answer sheet as a workbook with a student's values as typed, numbers where they are numbers."""

    def filling(row: KeyRow, position: int) -> Entry | None:
        given = submission.values.get((row.id, position))
        if given is None:
            return Entry(None, "input", unlocked=True) if position in row.positions else None
        plain = given.text == str(given.value)
        return Entry(given.value if plain else given.text, "input", unlocked=True)

    words = words_of(key)["answer_sheet"]
    rows = grid(key, words["title"], words["note"], filling, sheet_rows(key), asked_positions(key))
    return Book((page(words["answers"], rows), info_page(key)), words["title"])


def varied(name: str, rng: np.random.Generator, worked: tuple[int, ...] | None = None) -> Assignment:
    """A random variant: every single quantity of an assignment within a tenth of what it was, as a student types it."""
    content = yaml.load((ASSIGNMENTS / f"{name}.yaml").read_text(encoding="utf-8"), Loader=yaml.BaseLoader)
    while True:
        drawn = {
            id: f"{figures(float(match[1]) * rng.uniform(0.9, 1.1)):g} {match[2]}"
            for id, text in content["parameters"].items()
            if isinstance(text, str) and (match := QUANTITY.fullmatch(text)) and match[2] not in KEPT
        }
        with suppress(AssignmentError):
            return assignment(name, worked, **drawn)
