"""The filled sheets of `assignments/class-demo/`: `python -m tests.marking.demo` writes them anew.

Each invented student works the variant that the class's roster and spec give, by hand as it were: lengths
off by up to half a millimetre at each end, three figures, and the slip that the story tells.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from reportgen.base.records import replace
from reportgen.case.answer_key import Key
from reportgen.cases import open_case
from reportgen.classes.variants import make_variants
from reportgen.formula.vocabulary import KeyChapter
from reportgen.marking.answer_sheet import NAMES, asked_positions
from reportgen.marking.marking_data import Answer, Place, Submission
from reportgen.marking.marking_scheme import MarkingScheme, marking_scheme
from reportgen.marking.mistakes import mistakes_in
from reportgen.workbook import write_csv, write_xlsx
from tests.marking import students
from tests.marking.keys import csv_rows

DEMO = students.ASSIGNMENTS / "class-demo"
SHEETS = DEMO / "sheets"

Story = Callable[[MarkingScheme, Submission], Submission]


def as_told(scheme: MarkingScheme, sheet: Submission) -> Submission:
    return sheet


def half_done(scheme: MarkingScheme, sheet: Submission) -> Submission:
    """Velocities and accelerations only."""
    kept = {KeyChapter.geometry, KeyChapter.velocity, KeyChapter.acceleration}
    values = {place: given for place, given in sheet.values.items() if scheme.rows[place[0]].part in kept}
    return replace(sheet, values=values)


def with_units(scheme: MarkingScheme, sheet: Submission) -> Submission:
    """Units typed into the cells, centimetres where the sheet asks for millimetres, decimal commas."""

    def typed(place: Place, given: Answer) -> Answer:
        unit = scheme.rows[place[0]].unit
        factor, shown = (0.1, "cm") if unit == "mm" else (1.0, unit)
        return replace(given, text=f"{given.value * factor:.6g} {shown}".replace(".", ",").strip())

    return replace(sheet, values={place: typed(place, given) for place, given in sheet.values.items()})


def nothing_but_zeros(scheme: MarkingScheme, sheet: Submission) -> Submission:
    return replace(sheet, values={place: replace(given, value=0.0, text="0") for place, given in sheet.values.items()})


def careless(scheme: MarkingScheme, sheet: Submission) -> Submission:
    """Words instead of numbers."""
    values = dict(sheet.values)
    for place, text in zip(list(values)[5:40:17], ("khoảng 30", "xem bản vẽ"), strict=False):
        values[place] = replace(values[place], text=text)
    return replace(sheet, values=values)


SLIPS: Mapping[str, tuple[str, str, Story]] = {
    "K225520103001": ("", "", as_told),
    "K225520103004": ("omega.1", "rpm-for-radians", as_told),
    "K225520103007": ("v.CB", "scale-forgotten", as_told),
    "K225520103012": ("m.3", "weight-for-mass", as_told),
    "K225520103015": ("turn.omega.2", "direction-reversed", as_told),
    "K225520103019": ("", "", half_done),
    "K225520103028": ("M.eq", "sign-reversed", with_units),
    "K225520103031": ("a.CB.n", "thousands-mark", as_told),
    "K225520103036": ("", "", nothing_but_zeros),
    "K225520103040": ("", "", careless),
}
"""Where each student slips, by the name of the mistake, and what else happens to the sheet."""

COPIED = {"K225520103023": "K225520103001"}
"""Who handed in whose values."""


def filled(scheme: MarkingScheme, id: str, name: str, story: Story, seed: int) -> Submission:
    """A student's sheet as it was worked out and written down."""
    mistake = next(one for one in mistakes_in(scheme, id, {}) if one.name == name) if name else None
    world = students.worked_out(scheme, mistake, np.random.default_rng(seed))
    return story(scheme, students.written(scheme, world))


def csv(key: Key, sheet: Submission) -> bytes:
    """The sheet as CSV, as a student types it."""
    rows = csv_rows(key)
    columns = _columns(key)
    for row in rows:
        for column, position in columns.items():
            given = sheet.values.get((str(row[0]), position)) if row else None
            if given is not None:
                row[column] = given.text
    return write_csv(rows)


def workbook(key: Key, sheet: Submission) -> bytes:
    """The sheet as a workbook, filled in."""
    return write_xlsx(students.filled_book(key, sheet))


def _columns(key: Key) -> dict[int, int]:
    """Columns of the sheet by number: of single values, then of the positions."""
    return {NAMES - 1: 0, **{NAMES + index: position for index, position in enumerate(asked_positions(key))}}


def write() -> None:
    """Write all sheets, every other one as CSV."""
    shutil.rmtree(SHEETS, ignore_errors=True)
    SHEETS.mkdir()
    with tempfile.TemporaryDirectory() as folder:
        make_variants(DEMO / "spec.yaml", DEMO / "roster.csv", Path(folder), False, None)
        schemes = {path.stem: marking_scheme(open_case(path)) for path in sorted(Path(folder).glob("*.yaml"))}
        sheets = {id: filled(schemes[id], *slip, seed) for seed, (id, slip) in enumerate(sorted(SLIPS.items()))}
        sheets |= {id: sheets[source] for id, source in COPIED.items()}
        for number, (id, sheet) in enumerate(sorted(sheets.items())):
            make, suffix = ((workbook, "xlsx"), (csv, "csv"))[number % 2]
            (SHEETS / f"{id}.{suffix}").write_bytes(make(schemes[id].key, sheet))


if __name__ == "__main__":
    write()
