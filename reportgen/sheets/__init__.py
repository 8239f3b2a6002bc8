"""Make the drawing sheets of a case: plates on paper, with frame and title block. `drawing_sheets` makes them all."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path

from reportgen.assignment.reading import placed
from reportgen.base.errors import AssignmentError, Finding, SheetError
from reportgen.base.languages import setting_of
from reportgen.base.words import as_error, word
from reportgen.base.yaml_source import read_source
from reportgen.case import Case, CaseOfParts, MachineAnalysis
from reportgen.drawing.drawing_sheet import DrawingSheet, PlacedScene, TooLargeError
from reportgen.drawing.plates import DrawingPlate
from reportgen.sheets.packing import Packing
from reportgen.sheets.plate_sources import Sources
from reportgen.sheets.plates import plates_of, sets_of
from reportgen.sheets.title_block import TitleBlock, blocks, fields_of, framed, numbered, read_block, room

Plates = Mapping[str, Sequence[DrawingPlate]]
"""The plates of each set, by the set's name."""
Laid = tuple[str, tuple[PlacedScene, ...]]
"""The set that a sheet shows, and its placed scenes."""
BY_SIZE = ("A3", "A2", "A1", "A0")
USUAL = ("A1", "A0")
"""Paper sizes, in order of preference, of sets that no single sheet holds."""
STEPS = 20
"""If a plate does not fit, shorter cranks are tried in steps of such a part of its length."""


def drawing_sheets(
    case: Case, size: str = "", sets: Collection[str] = (), block: Path | None = None, every: bool = False
) -> list[DrawingSheet]:
    """Return the drawing sheets of a case, followed by those of its parts.

    `sets` are some of the `Set` names of a machine, all if empty; `every` adds the plates that are not usually handed
    in. The parts that follow a machine are on sheets of the machine's size, but not larger than A1 if that is enough.
    Raise `SheetError` if there is nothing to draw, and the errors of `on_sheets`.
    """
    plates = case.plates(sets, every)
    if not plates:
        raise SheetError(word("no_plates", case.assignment.language, sets=", ".join(sets)))
    crank = None
    if case.redrawn is not None:
        length, redraw = case.redrawn
        crank = length, lambda length: redraw(length).plates(sets, every)
    sheets = on_sheets(case, plates, size, block, crank)
    if isinstance(case, CaseOfParts):
        assignment = case.assignment
        least = min(sheets[0].name, USUAL[0], key=BY_SIZE.index)
        sheets += on_sheets(case, case.joined_plates(), size, block, least=least)
        form = read_block(
            block or blocks(assignment.school or "", assignment.language)[setting_of(assignment.language).block],
            assignment.language,
        )
        sheets = numbered(sheets, form, assignment.sheet.designation or "")
    return [*sheets, *case.true_sizes()]


def plates_by_set(case: MachineAnalysis, sets: Collection[str] = (), every: bool = False) -> Plates:
    """Return the plates of some sets, all if none is named; sets without plates are left out."""
    sources = Sources.of(case, every)
    return {name: list(plates_of(sources, name)) for name in sets_of(sources) if not sets or name in sets}


def on_sheets(
    case: Case,
    plates: Plates,
    size: str = "",
    block: Path | None = None,
    redrawn: tuple[float, Callable[[float], Plates]] | None = None,
    least: str = BY_SIZE[0],
) -> list[DrawingSheet]:
    """Return the sheets of some sets; each set begins a new sheet.

    `size` is the paper size; without it, each set gets the smallest size, not below `least`, that holds it on one
    sheet. Plates that may be larger are enlarged as far as their sheets have room. `block` is a title block file, by
    default the one of the language. `redrawn` is the length of the drawn crank (mm) with a function that returns the
    plates for another length. Raise `AssignmentError` for an invalid block and for a plate that is too large; the error
    names a length of the crank that fits.
    """
    language = case.assignment.language
    form = read_block(block or blocks(case.assignment.school or "", language)[setting_of(language).block], language)
    wanted = size or case.assignment.report.sheets or ""
    try:
        paper, laid_out = _chosen(plates, form, wanted, least)
    except TooLargeError as error:
        raise _fault(case, error, plates, form, wanted or USUAL[-1], redrawn) from error
    if any(plate.larger for some in plates.values() for plate in some):
        laid_out = laid({name: enlarged(some, paper, form) for name, some in plates.items()}, paper, form)
    return [_sheet(case, form, paper, number, laid_out) for number in range(1, len(laid_out) + 1)]


def enlarged(plates: Sequence[DrawingPlate], paper: str, form: TitleBlock) -> list[DrawingPlate]:
    """Return the plates of a set, each at the largest standard scale that needs no further sheet.

    The plate that has been enlarged least grows next, with those of the same axis. Optional plates fill the remaining
    room.
    """

    def sheets(some: Sequence[DrawingPlate]) -> float:
        try:
            return len(list(_packing(paper, form).sheets([plate for plate in some if not plate.spare])))
        except TooLargeError:
            return math.inf

    def larger(members: Sequence[int]) -> list[DrawingPlate]:
        """Return larger versions of some plates, [] if one of them cannot be larger."""
        versions = [best[member].larger for member in members]
        made = [version() for version in versions if version is not None]
        grown = [plate for plate in made if plate is not None]
        return grown if len(grown) == len(members) else []

    best, most = list(plates), sheets(plates)
    units: dict[str | int, list[int]] = {}
    for number, plate in enumerate(plates):
        units.setdefault(plate.axis or number, []).append(number)
    growing = {members[0]: (members, grown) for members in units.values() if (grown := larger(members))}
    while growing:
        number = min(growing, key=lambda one: (growing[one][1][0].area / plates[one].area, one))
        members, tried = growing.pop(number)
        with_them = [*best]
        for member, plate in zip(members, tried, strict=True):
            with_them[member] = plate
        if sheets(with_them) <= most:
            best = with_them
            if after := larger(members):
                growing[number] = members, after
    return best


def _fault(
    case: Case,
    error: TooLargeError,
    plates: Plates,
    form: TitleBlock,
    size: str,
    redrawn: tuple[float, Callable[[float], Plates]] | None,
) -> AssignmentError:
    """Return the error about a plate that is too large.

    It names the smallest size that holds all plates, and the longest crank with which they fit.
    """
    arguments = {"name": error.name, "width": f"{error.width:.0f}", "height": f"{error.height:.0f}", "size": size}
    larger = [paper for paper in BY_SIZE[BY_SIZE.index(size) + 1 :] if _holds(plates, paper, form)]
    if larger:
        arguments |= {"larger": larger[0], "hint": "larger-sheet"}
    if redrawn is not None:
        length, remake = redrawn
        shorter = [crank for step in range(1, STEPS) if (crank := math.floor(length * (1 - step / STEPS))) > 0]
        # Plates grow with the crank, so the longest that fits is found by halving.
        longest = bisect_left(shorter, True, key=lambda crank: _holds(remake(crank), size, form))
        if longest < len(shorter):
            hint = "larger-sheet-or-crank" if larger else "shorter-crank"
            arguments |= {"crank": str(shorter[longest]), "hint": hint}
    findings = [Finding("plate-too-large", ("drawing", "crank"), arguments)]
    return as_error(placed(read_source(case.assignment.source), findings), case.assignment.language)


def _holds(plates: Plates, paper: str, form: TitleBlock) -> bool:
    try:
        laid(plates, paper, form)
    except TooLargeError:
        return False
    return True


def laid(plates: Plates, paper: str, form: TitleBlock) -> list[Laid]:
    """Return the plates laid out on sheets of a size; raise `TooLargeError` for a plate that does not fit."""
    packing = _packing(paper, form)
    return [(name, parts) for name, some in plates.items() for parts in packing.sheets(some)]


def _packing(paper: str, form: TitleBlock) -> Packing:
    return Packing(room(paper, form), room(paper, form.following or form))


def _chosen(plates: Plates, form: TitleBlock, wanted: str, least: str) -> tuple[str, list[Laid]]:
    """Return a paper size and the layout of its sheets; raise `TooLargeError` if no size holds a plate.

    Without a `wanted` size it is the smallest from `least` on that holds each set on one sheet, else the first of
    `USUAL` that holds the plates.
    """
    sizes = [(wanted, False)] if wanted else [(paper, True) for paper in BY_SIZE[BY_SIZE.index(least) :]]
    sizes += [] if wanted else [(paper, False) for paper in USUAL]
    too_large: TooLargeError | None = None
    for paper, whole in sizes:
        try:
            laid_out = laid(plates, paper, form)
        except TooLargeError as error:
            too_large = error
        else:
            if len(laid_out) == len(plates) or not whole:
                return paper, laid_out
    assert too_large is not None
    raise too_large


def _sheet(case: Case, form: TitleBlock, paper: str, number: int, laid_out: Sequence[Laid]) -> DrawingSheet:
    """Return one of the sheets with its frame and its title block; `number` counts from 1."""
    kind, parts = laid_out[number - 1]
    fields = fields_of(case, form, number) | {
        # A set of several works is called by its title itself.
        "title": case.words["plates"]["sets"].get(kind, kind),
        "sheet": str(number),
        "sheets": str(len(laid_out)),
        "format": paper,
    }
    return framed(parts, form, fields)
