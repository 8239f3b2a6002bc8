"""From a report to its drawing sheets: plates at scales that fill them, frame and title block."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

from reportgen.case import Calculation
from reportgen.document.drawn_plates import Plates
from reportgen.document.report import Report
from reportgen.document.sheet_search import Search
from reportgen.document.title_block import DEFAULT, TitleBlock, blocks, fields_of, read_block
from reportgen.errors import SheetError
from reportgen.figures.frame import SIZES, frame, room
from reportgen.figures.sheet import Part, Sheet, TooLargeError
from reportgen.words import word

USUAL_SIZES = ("A1", "A0")


def drawing_sheets(
    case: Calculation, size: str = "", sets: Collection[str] = (), block: Path | None = None
) -> list[Sheet]:
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


def sheets_of(plates: Plates, chosen: Sequence[int], size: str, block: TitleBlock) -> list[Sheet]:
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
            Part("frame", "frame", frame(size, block.margins, block.note(fields))),
            Part("title block", "frame", block.scene(fields), corner),
        )
        result.append(Sheet(size, width, height, (*own, *parts)))
    return result
