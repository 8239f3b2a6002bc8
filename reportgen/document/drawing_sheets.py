"""From a report to its drawing sheets: scales that fill them, plates in rows, frame and title block.

Scales are round, and plates of a series share one.  Beginning with a usual size of plans, one scale after the other is
made finer or coarser while that leaves fewer white places; the sizes of plates are estimated meanwhile from plates
drawn once, and the best estimates are drawn.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from reportgen.case import Case
from reportgen.document.outline import open_report
from reportgen.document.plates import Series, all_series
from reportgen.document.report import Report
from reportgen.document.title_block import DEFAULT, TitleBlock, blocks, fields_of, read_block
from reportgen.errors import SheetError
from reportgen.figures.frame import SIZES, frame, room
from reportgen.figures.geometry import bounds
from reportgen.figures.lettering import headed, lettered
from reportgen.figures.scene import Label, Scene
from reportgen.figures.sheet import Part, Room, Row, Sheet, TooLargeError, filled, packed, spread
from reportgen.ledger.scales import PER_MM
from reportgen.notation.numbers import nice_down, nice_up
from reportgen.words import word

USUAL_SIZES = ("A1", "A0")
USUAL = 0.16
"""The largest side of a plan, as a share of the height that a sheet has for plates."""
LEAST = 60.0
"""Plans are usually not smaller than this (mm), whatever the sheet."""
WHOLE_MACHINE = 2.2
"""How many times larger plates of the whole machine are."""
SMALLER, LARGER = 0.55, 2.2
"""How many times as large as usual plates may become."""
ENOUGH = 0.6
"""A sheet is filled to this share at least."""
SHARES = (1.0, 0.75, 0.7, 0.65)
"""A sheet is filled to one of these shares, whichever leaves the last sheet full enough."""
SPARE = 0.03
"""What estimates may be off."""
FULL = 0.3
"""Less than this, in hundredths of a sheet and all sheets together, is no white too much."""
BEGINNINGS = (1.0, 0.8, 1.25, 0.65, 1.5)
"""With plates so many times as large as usual the search begins, as long as sheets are left too empty."""
ATTEMPTS = 3
"""How often sheets are drawn and, where they came out emptier than estimated, estimated anew."""

Key = tuple[str, str]
Scales = Mapping[Key, float]


@dataclass(frozen=True, slots=True)
class _Plate:
    """A plate as it was drawn at the scale `at`: what of it is geometry grows with a finer scale, letters do not."""

    scene: Scene
    geometry: complex
    at: float

    def estimated(self, scale: float) -> Scene:
        grown = self.geometry * (self.at / scale - 1) if scale else 0j
        return Scene(self.scene.width + grown.real, self.scene.height + grown.imag)


@dataclass
class _Plates:
    """The plates of a report, each drawn once at each scale that is asked for."""

    report: Report
    series: Sequence[Series]
    _drawn: dict[tuple[int, float], list[_Plate]] = field(default_factory=dict)
    _last: dict[int, float] = field(default_factory=dict)

    def draw(self, scales: Scales) -> list[Part]:
        """All plates at these scales, numbered."""
        plates = [self._at(index, scales.get(one.scaled, 0.0)) for index, one in enumerate(self.series)]
        return list(self._parts(plates))

    def estimated(self, scales: Scales) -> list[Part]:
        """All plates about as large as they will be, from those drawn last."""
        return [
            Part("", one.layer, plate.estimated(scales.get(one.scaled, 0.0)))
            for index, one in enumerate(self.series)
            for plate in self._drawn[index, self._last[index]]
        ]

    def _parts(self, plates: Sequence[Sequence[_Plate]]) -> Iterator[Part]:
        for number, (one, some) in enumerate(zip(self.series, plates, strict=True), start=1):
            for index, plate in enumerate(some, start=1):
                yield Part(_number(number, index, len(some)), one.layer, plate.scene)

    def _at(self, index: int, scale: float) -> list[_Plate]:
        self._last[index] = scale
        if (index, scale) not in self._drawn:
            one = self.series[index]
            drawings = list(one.draw(one.to_scale(self.report, scale)))
            title = self.report.words["plates"][one.name]
            found = []
            for number, (place, scene) in enumerate(drawings, start=1):
                heading = f"{_number(index + 1, number, len(drawings))}. {title}"
                drawing = headed(lettered(scene), heading, place)
                low, high = bounds(item for item in drawing.items if not isinstance(item, Label))
                found.append(_Plate(drawing, high - low if one.size else 0j, scale))
            self._drawn[index, scale] = found
        return self._drawn[index, scale]


def _number(series: int, plate: int, count: int) -> str:
    return f"{series}.{plate}" if count > 1 else f"{series}"


# --- scales and places ----------------------------------------------------------------------------


def _boxes(series: Sequence[Series], usual: float) -> dict[Key, tuple[Series, float]]:
    """For each scale the largest of its series, and the size (m) that is usual for it."""
    largest: dict[Key, Series] = {}
    for one in series:
        if one.scale and one.size > (largest[one.scaled].size if one.scaled in largest else 0.0):
            largest[one.scaled] = one
    return {key: (one, usual * (WHOLE_MACHINE if one.is_whole_machine else 1.0)) for key, one in largest.items()}


def layout(report: Report, series: Sequence[Series], space: Room) -> list[tuple[Part, ...]]:
    """Plates on sheets that are filled as far as round scales can.

    Raises `TooLargeError` for a plate that fits no sheet at any of them.
    """
    plates = _Plates(report, series)
    usual = max(USUAL * (space.high.imag - space.low.imag), LEAST)
    best: tuple[float, list[list[Row]]] = math.inf, []
    for share in BEGINNINGS:
        boxes = _boxes(series, share * usual / PER_MM)
        scales = {key: nice_up(one.size / box / PER_MM, one.steps) * PER_MM for key, (one, box) in boxes.items()}
        plates.draw(scales)
        for _ in range(ATTEMPTS):
            scales = _improved(plates, boxes, scales, space)
            best = min(best, _fullest(plates.draw(scales), space, 0.0), key=_white)
            if _white(best) < FULL:
                break
        if _white(best) < FULL:
            break
    # Where no scale helped, this says which plate it is that has no place.
    sheets = best[1] or packed(plates.draw(scales), space)
    return [spread(rows, space) for rows in sheets]


def _white(found: tuple[float, list[list[Row]]]) -> float:
    return found[0]


def _fullest(parts: Sequence[Part], space: Room, spare: float = SPARE) -> tuple[float, list[list[Row]]]:
    """The parts on sheets, and how far these are from being full enough: in hundredths, a little for each sheet.

    A sheet that takes all it can may leave too little for the last one.
    """
    found: list[tuple[float, list[list[Row]]]] = []
    for enough in SHARES:
        try:
            sheets = packed(parts, space, enough)
        except TooLargeError:
            return math.inf, []
        missing = sum(max(ENOUGH + spare - filled(one, space), 0.0) for one in sheets)
        found.append((100 * missing + 0.01 * len(sheets), sheets))
        if missing == 0:
            break
    return min(found, key=_white)


def _improved(
    plates: _Plates, boxes: Mapping[Key, tuple[Series, float]], scales: dict[Key, float], space: Room
) -> dict[Key, float]:
    """Scales, each the next finer or coarser one as long as that leaves less white."""
    least = _fullest(plates.estimated(scales), space)[0]
    improved = True
    while improved and least >= FULL:
        improved = False
        tried = [
            (_fullest(plates.estimated(other), space)[0], number, other)
            for number, other in enumerate(_neighbours(boxes, scales))
        ]
        white, _, other = min(tried, default=(least, 0, scales))
        if white < least:
            least, scales, improved = white, other, True
    return scales


def _neighbours(boxes: Mapping[Key, tuple[Series, float]], scales: dict[Key, float]) -> Iterator[dict[Key, float]]:
    for key, (one, box) in boxes.items():
        mm = scales[key] / PER_MM
        for scale in (nice_up(1.01 * mm, one.steps), nice_down(0.99 * mm, one.steps)):
            if SMALLER * box <= one.size / (scale * PER_MM) <= LARGER * box:
                yield {**scales, key: scale * PER_MM}


# --- finished sheets ------------------------------------------------------------------------------


def drawing_sheets(case: Case, size: str = "", sets: Collection[str] = (), block: Path | None = None) -> list[Sheet]:
    """The finished drawing sheets of a case: of one `size`, else as the file says, else A1, or A0 if a plate needs it.

    `sets` are some of `SETS`, all if none is named; the title `block` is a file, else that of the language.  Raises
    `SheetError` for a plate that is larger than the size, `AssignmentError` for a faulty block.
    """
    report, language = open_report(case), case.assignment.language
    series = [one for one in all_series(report) if not sets or one.belongs in sets]
    frame_block = read_block(block or blocks(case.assignment.report.school or "")[DEFAULT[language]], language)
    size = size or case.assignment.report.sheets or ""
    for chosen in (size,) if size else USUAL_SIZES:
        try:
            return _sheets_of(report, series, chosen, frame_block)
        except TooLargeError as error:
            scene, number = error.part.scene, error.part.name.partition(".")[0]
            name = report.words["plates"][series[int(number) - 1].name]
    raise SheetError(
        word("plate_too_large", language, name=name, width=round(scene.width), height=round(scene.height), size=chosen)
    )


def _sheets_of(report: Report, series: Sequence[Series], size: str, block: TitleBlock) -> list[Sheet]:
    """The sheets of a size; raises `TooLargeError` for a plate that fits none."""
    space = room(size, block.margins, block.size)
    found = layout(report, series, space)
    words, width, height = report.words["plates"], *SIZES[size]
    sets = {str(number): one.belongs for number, one in enumerate(series, start=1)}
    result = []
    for number, parts in enumerate(found, start=1):
        shown = dict.fromkeys(sets[part.name.partition(".")[0]] for part in parts)
        fields = fields_of(report.case) | {
            "title": "; ".join(words["sets"][one] for one in shown),
            "sheet": str(number),
            "sheets": str(len(found)),
            "format": size,
        }
        corner = complex(space.high.real - block.size[0], space.low.imag)
        own = (
            Part("frame", "frame", frame(size, block.margins, block.note(fields))),
            Part("title block", "frame", block.scene(fields), corner),
        )
        result.append(Sheet(size, width, height, (*own, *parts)))
    return result
