"""From a report to its drawing sheets: plates at scales that fill them, frame and title block."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import combinations, islice
from pathlib import Path

from reportgen.base.errors import SheetError
from reportgen.base.units import nice_down, nice_up
from reportgen.base.words import word
from reportgen.drawing import Scene
from reportgen.drawing.sheet import (
    ENLARGED,
    GAP,
    ROW,
    DrawingSheet,
    Form,
    PlacedScene,
    Room,
    TooLargeError,
    headed,
    stretched,
)
from reportgen.plans.scales import PER_MM
from reportgen.report.case import Calculation
from reportgen.report.report import Report
from reportgen.sheets.frame import DEFAULT, SIZES, TitleBlock, blocks, fields_of, frame_scene, read_block, room
from reportgen.sheets.packing import NEVER, Dividing, Laid, spread, too_large
from reportgen.sheets.plates import CURVE, Estimates, Plates, Series

USUAL_SIZES = ("A1", "A0")


def drawing_sheets(
    case: Calculation, size: str = "", sets: Collection[str] = (), block: Path | None = None
) -> list[DrawingSheet]:
    """The finished drawing sheets of a case: of one `size`, else as the file says, else A1, or A0 if a plate needs it.

    `sets` are some of `SETS`, all if none is named; the title `block` is a file, else that of the language.  Raises
    `SheetError` where there is nothing to draw or a plate is too large, `AssignmentError` for a faulty block.
    """
    report, language = Report(case), case.assignment.language
    plates = Plates.of(report)
    chosen = plates.of_sets(sets)
    if not chosen:
        raise SheetError(word("no_plates", language, sets=", ".join(sets)))
    frame_block = read_block(block or blocks(case.assignment.report.school or "")[DEFAULT[language]], language)
    size = size or case.assignment.report.sheets or ""
    for paper in (size,) if size else USUAL_SIZES:
        try:
            return sheets_of(plates, chosen, paper, frame_block)
        except TooLargeError as error:
            scene, number = error.part.scene, error.part.name.partition(".")[0]
            name = report.words["plates"][plates.series[chosen[int(number) - 1]].name]
    raise SheetError(
        word("plate_too_large", language, name=name, width=round(scene.width), height=round(scene.height), size=paper)
    )


def sheets_of(plates: Plates, chosen: Sequence[int], size: str, block: TitleBlock) -> list[DrawingSheet]:
    """Sheets of a size with some series; raises `TooLargeError` for a plate that fits none."""
    space = room(size, block.margins, block.size)
    found = Search(plates, chosen, space).sheets()
    report = plates.report
    words, width, height = report.words["plates"], *SIZES[size]
    sets = {str(number): plates.series[index].belongs for number, index in enumerate(chosen, start=1)}
    result = []
    for number, parts in enumerate(found, start=1):
        shown = {sets[part.name.partition(".")[0]] for part in parts}
        fields = fields_of(report.case) | {
            "title": words["sets"][shown.pop() if len(shown) == 1 else "all"],
            "sheet": str(number),
            "sheets": str(len(found)),
            "format": size,
        }
        corner = complex(space.high.real - block.size[0], space.low.imag)
        own = (
            PlacedScene("frame", "frame", frame_scene(size, block.margins, block.note(fields))),
            PlacedScene("title block", "frame", block.scene(fields), corner),
        )
        result.append(DrawingSheet(size, width, height, (*own, *parts), fields))
    return result


# --- the search for scales of plates --------------------------------------------------------------
# Shapes of curves and forms of tables that fill drawing sheets.
# Scales are round, and plates of a series share one. Beginning with a usual size of plans, one scale or form after
# the other is changed while that leaves less white; the sizes of plates are estimated meanwhile from plates drawn
# before, and the best estimate is drawn.

USUAL = 0.16
"""The largest side of a plan, as a share of the height that a sheet has for plates."""
LEAST = 60.0
"""Plans are usually not smaller than this (mm), whatever the sheet."""
LARGER_PLATES = {"positions": 2.2, "indicator": 2.2, "scheme": 1.2, "polar": 1.5}
"""How many times larger plates are that show the whole machine, or so much that they need it."""
SMALLER, LARGER = 0.6, 1.7
"""How many times as large as usual the largest plate of a series may become."""
READABLE, LARGEST = 38.0, 160.0
"""Nor is it drawn smaller than the first (mm) unless it has no room else; up to the second it may grow on any sheet."""
ENOUGH = 0.6
"""A sheet is filled to this share at least."""
SPARE = 0.008
"""What estimates may be off."""
BEGINNINGS = (1.0, 0.85, 1.15, 0.7, 1.3, 0.6, 1.5)
"""With plates so many times as large as usual the search begins."""
ATTEMPTS = 25
"""How often sheets are drawn and, where they came out emptier than estimated, estimated anew."""
ATTEMPTS_IN_ROWS = 8
TRIES_IN_ROWS, TRIES = 800, 2500
"""So many scales are tried at most."""
LARGE = 300.0
"""A sheet with more height than this (mm) for plates takes some rows of them."""
LESS = 1e-3
"""Less white than this (hundredths of a sheet) is no improvement."""
PAIRED = 16
"""So many changes are tried together with one another."""
HEADING = 16.0
"""What the heading of a table takes above it, mm."""
HEAD_ROWS = 2
WIDEST = 180.0
"""A table is so wide (mm) if it is to stand beside the title block of any sheet."""
SHAPES = (1.0, 1.4, 2.8, 4.0)
"""Width over height of curves, beside the usual one."""
STEPS = 3
"""So many steps finer or coarser are tried at once."""
TINY = 20.0
"""No plate's geometry is made smaller than this (mm)."""

Key = tuple[str, str]


@dataclass(frozen=True, slots=True)
class Arrangement:
    """Scales (SI per mm) of plates and, by the number of their series, forms of tables."""

    scales: Mapping[Key, float]
    forms: Mapping[int, Form]

    @property
    def key(self) -> tuple[object, ...]:
        return *self.scales.values(), *self.forms.values()


class Search:
    """Scales and forms with which some series fill sheets of a size."""

    def __init__(self, plates: Plates, chosen: Sequence[int], space: Room) -> None:
        self.plates, self.chosen, self.space = plates, chosen, space
        self.estimates = Estimates(plates)
        self.series = [plates.series[index] for index in chosen]
        self.tried: dict[tuple[object, ...], tuple[float, list[Laid]]] = {}
        self.named: dict[tuple[int, float, Form], list[PlacedScene]] = {}
        size = space.high - space.low
        usual = max(USUAL * size.imag, LEAST)
        self.largest: dict[Key, Series] = {}
        for one in self.series:
            if one.scale and one.size > (self.largest[one.scaled].size if one.scaled in self.largest else 0.0):
                self.largest[one.scaled] = one
        self.usual = {key: usual * LARGER_PLATES.get(one.name, 1.0) for key, one in self.largest.items()}
        usual_form, *others = (
            Form(wide, int((size.imag - 2 * GAP - HEADING) / (ENLARGED * ROW)) - HEAD_ROWS, parts)
            for wide in (WIDEST, size.real - 2 * GAP)
            for parts in (1, 2, 3)
        )
        self.usual_form = usual_form
        self.forms: dict[int, list[Form]] = {}
        for index, one in zip(chosen, self.series, strict=True):
            if one.layer == "tables" and one.name != "dimensions":
                self.forms[index] = [usual_form, *others]
            elif one.scale == CURVE:
                self.forms[index] = [usual_form, *(replace(usual_form, shape=shape) for shape in SHAPES)]

    def sheets(self) -> list[tuple[PlacedScene, ...]]:
        """The plates on sheets; raises `TooLargeError` for one that fits none.

        They stand in rows or columns throughout if that is found to fill the sheets.  On a small sheet few plates stand
        in a row: there it is not tried, and plates may change places.
        """
        large = too_large(self._estimated(self._fitting(self._beginning(1.0))), self.space)
        if large:
            raise TooLargeError(replace(large, name=str(self.chosen.index(int(large.name)) + 1)))
        found: list[tuple[float, list[Laid]]] = []
        for in_rows, attempts in ((True, ATTEMPTS_IN_ROWS if self.is_large else 0), (False, ATTEMPTS)):
            self.estimating = Dividing(self.space, ENOUGH + SPARE, in_rows, not self.is_large)
            drawing = Dividing(self.space, ENOUGH, in_rows, not self.is_large)
            self.tried.clear()
            self.tries = TRIES_IN_ROWS if in_rows else TRIES
            for choice in islice(self._promising(), attempts):
                if in_rows and self._missing(choice):
                    continue
                parts = self._drawn(choice)
                found.append(drawing.of(parts))
                if found[-1][0] == 0.0:
                    return self._spread(found[-1][1])
        missing, sheets = min(found, key=lambda one: one[0])
        if missing >= NEVER:
            raise TooLargeError(too_large(parts, self.space) or parts[0])
        return self._spread(sheets)

    def _spread(self, sheets: Iterable[Laid]) -> list[tuple[PlacedScene, ...]]:
        """The sheets with tables stretched and the white shared out."""
        return [
            spread(one.with_parts(_stretched(part, one.stretch) for part in one.parts), self.space) for one in sheets
        ]

    @property
    def is_large(self) -> bool:
        return (self.space.high - self.space.low).imag > LARGE

    def _promising(self) -> Iterator[Arrangement]:
        """What may fill sheets enough, searched from plates of usual size, else from smaller or larger ones.

        Between two of them plates have been drawn, so that estimates are better.
        """
        drawn: set[tuple[object, ...]] = set()
        begun = [self._fitting(self._beginning(share)) for share in BEGINNINGS]
        for choice in sorted(begun, key=self._missing):
            improved = self._improved(choice)
            while improved.key not in drawn:
                drawn.add(improved.key)
                yield improved
                self.tried.clear()
                self.named.clear()
                improved = self._improved(self._fitting(improved))

    def _beginning(self, share: float) -> Arrangement:
        """Plates so many times as large as usual."""
        scales = {}
        for key, one in self.largest.items():
            scale = nice_up(one.size / (share * self.usual[key]), one.steps)
            # A round scale may leave a plan much smaller than meant.
            least = self._at_least(key, SMALLER, READABLE)
            scales[key] = scale if one.size / scale >= least else nice_down(one.size / least, one.steps)
        return Arrangement(scales, dict.fromkeys(self.forms, self.usual_form))

    def _fitting(self, choice: Arrangement) -> Arrangement:
        """Scales made coarser for plates that are larger than the sheet."""
        while large := too_large(self._estimated(choice), self.space):
            one = self.plates.series[int(large.name)]
            scale = choice.scales.get(one.scaled, 0.0)
            if not scale or self.largest[one.scaled].size / scale < TINY:
                break
            choice = Arrangement({**choice.scales, one.scaled: nice_up(1.01 * scale, one.steps)}, choice.forms)
        return choice

    def _improved(self, choice: Arrangement) -> Arrangement:
        """One scale or form after the other changed as long as that leaves less white; where none does, two at once."""
        while self._missing(choice) > 0.0:
            better = self._first_better(choice, self._neighbours(choice)) or self._first_better(
                choice, self._next_but_one(choice)
            )
            if better is None:
                break
            choice = better
        return choice

    def _first_better(self, choice: Arrangement, others: Iterable[Arrangement]) -> Arrangement | None:
        least = self._missing(choice) - LESS
        for other in islice(others, max(self.tries, 0)):
            self.tries -= 1
            if self._missing(other) < least:
                return other
        return None

    def _next_but_one(self, choice: Arrangement) -> Iterator[Arrangement]:
        """Two changes at once of what is on sheets that are too empty, or before them."""
        some = list(islice(self._neighbours(choice), PAIRED))
        for one, other in combinations(some, 2):
            scales = {key: at for key, at in other.scales.items() if at != choice.scales[key]}
            forms = {index: form for index, form in other.forms.items() if form != choice.forms[index]}
            yield Arrangement({**one.scales, **scales}, {**one.forms, **forms})

    def _neighbours(self, choice: Arrangement) -> Iterator[Arrangement]:
        """Each scale finer and coarser and each table in other forms, those on sheets that are too empty first.

        Then come those on the sheets before them, which may leave them more or less.
        """
        self._missing(choice)
        sheets = self.tried[choice.key][1]
        names = [{int(part.name) for part in one.parts} for one in sheets]
        empty = [one.share < ENOUGH + SPARE for one in sheets]
        here = {index for n, some in enumerate(names) if empty[n] for index in some}
        before = {index for n, some in enumerate(names[:-1]) if empty[n + 1] for index in some}
        near = dict.fromkeys(self.plates.series[index].scaled for some in (here, before) for index in some)
        yield from self._rescaled(choice, near)
        for index, form in choice.forms.items():
            if index in here | before:
                for changed in self.forms[index]:
                    if changed != form:
                        yield Arrangement(choice.scales, {**choice.forms, index: changed})
        yield from self._rescaled(choice, [key for key in choice.scales if key not in near])

    def _rescaled(self, choice: Arrangement, keys: Iterable[Key]) -> Iterator[Arrangement]:
        for key in keys:
            if key in choice.scales:
                for other in self._steps(key, choice.scales[key]):
                    yield Arrangement({**choice.scales, key: other}, choice.forms)

    def _steps(self, key: Key, scale: float) -> Iterator[float]:
        """Some finer scales and some coarser ones at which plates are still of usual size."""
        one = self.largest[key]
        finer = coarser = scale
        for _ in range(STEPS):
            finer, coarser = nice_down(0.99 * finer, one.steps), nice_up(1.01 * coarser, one.steps)
            for other in (finer, coarser):
                if self._at_least(key, SMALLER, READABLE) <= one.size / other <= self._at_least(key, LARGER, LARGEST):
                    yield other

    def _at_least(self, key: Key, times: float, least: float) -> float:
        """So many times the usual size of the largest plate at a scale, or the `least` size of plans (mm)."""
        return max(times * self.usual[key], least * LARGER_PLATES.get(self.largest[key].name, 1.0))

    def _missing(self, choice: Arrangement) -> float:
        """What sheets miss of being full, as far as can be told without drawing them."""
        key = choice.key
        if key not in self.tried:
            self.tried[key] = self.estimating.of(self._estimated(choice))
        return self.tried[key][0]

    def _estimated(self, choice: Arrangement) -> list[PlacedScene]:
        """All plates in order, about as large as they will be, named by their series."""
        parts: list[PlacedScene] = []
        for number, index in enumerate(self.chosen, start=1):
            scale = choice.scales.get(self.plates.series[index].scaled, 0.0)
            form = choice.forms.get(index, self.usual_form)
            key = index, scale, form
            if key not in self.named:
                some = self.estimates.estimate(index, scale * PER_MM, form)
                self.named[key] = list(self._with_headings(number, index, some))
            parts += self.named[key]
        return parts

    def _with_headings(self, number: int, index: int, plates: Sequence[tuple[str, Scene]]) -> Iterator[PlacedScene]:
        one = self.plates.series[index]
        title = self.plates.report.words["plates"][one.name]
        for name, place, scene in _numbered(number, plates):
            width, height = _head(f"{name}. {title}", place)
            yield PlacedScene(
                str(index), one.layer, Scene(max(scene.width, width), scene.height + height), table=_table(one, scene)
            )

    def _drawn(self, choice: Arrangement) -> list[PlacedScene]:
        """All plates in order, numbered."""
        parts = []
        for number, index in enumerate(self.chosen, start=1):
            one = self.plates.series[index]
            scale = choice.scales.get(one.scaled, 0.0) * PER_MM
            drawn = self.estimates.draw(index, scale, choice.forms.get(index, self.usual_form))
            title = self.plates.report.words["plates"][one.name]
            for name, place, scene in _numbered(number, [(plate.place, plate.scene) for plate in drawn]):
                whole = headed(scene, f"{name}. {title}", place)
                parts.append(PlacedScene(name, one.layer, whole, table=_table(one, scene)))
        return parts


def _numbered(series: int, plates: Sequence[tuple[str, Scene]]) -> Iterator[tuple[str, str, Scene]]:
    """Plates with their numbers."""
    for number, (place, scene) in enumerate(plates, start=1):
        yield f"{series}.{number}" if len(plates) > 1 else f"{series}", place, scene


def _stretched(part: PlacedScene, stretch: complex) -> PlacedScene:
    return replace(part, scene=stretched(part.scene, part.table, stretch)) if part.table else part


def _table(one: Series, scene: Scene) -> complex:
    """What of a plate may be stretched."""
    return complex(scene.width, scene.height) if one.layer == "tables" else 0j


@lru_cache(maxsize=4096)
def _head(name: str, place: str) -> tuple[float, float]:
    """The width and height of a heading."""
    empty = headed(Scene(0.0, 0.0), name, place)
    return empty.width, empty.height
