"""Make an assignment file for each student from spec and roster, and a table that compares the variants' difficulty.

A student's file is kept once somebody has edited it. Its head names the version, the spec with its SHA-256, the salt
and the student. The head's last line is the SHA-256 of the following text and of the files of the student's parts.
Files that still have that hash have not been edited since they were made. The files of a student are made and kept
together.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from itertools import chain
from pathlib import Path
from statistics import fmean, median
from typing import Any, Literal, NamedTuple

import numpy as np

from reportgen import catalogue
from reportgen.assignment import Assignment, parts
from reportgen.assignment.common import PARTS
from reportgen.assignment.reading import doubtful, words_beside
from reportgen.base.errors import Fault, Location, Where
from reportgen.base.files import contents, overwritten, put_file, put_set, version
from reportgen.base.process_limits import Limits
from reportgen.base.records import Record
from reportgen.base.units import Language
from reportgen.base.words import as_error, as_problem, word
from reportgen.base.yaml_source import MappingNode, Node, Scalar, Source, read_source
from reportgen.base.yaml_values import at, path_text, put, quoted, text_of, without
from reportgen.cases import opened
from reportgen.classes.earlier_draw import DROPPED, MARKED, REDRAWN, read_earlier, students_named
from reportgen.classes.roster import comparable, read_roster
from reportgen.classes.variant_draw import Draw, DrawnVariant, fault_finder, shared
from reportgen.classes.variant_spec import Spec, assembled, read_spec
from reportgen.classes.worker_pool import each_within
from reportgen.workbook import write_csv

TABLE = "variants.csv"
HEAD_LINES = 3
_HASH = re.compile(r"#.*\b([0-9a-f]{64})")
_HERE = Location("")

MOST_TIMES = 2.0
"""Factor from the median beyond which a count is an outlier."""
MOST_DEVIATIONS = 3.5
"""Number of robust standard deviations from the median beyond which a size is an outlier …

Source: B. Iglewicz, D. C. Hoaglin, How to Detect and Handle Outliers, 1993.
"""
OF_MEDIAN, OF_MEAN = 1.4826, 1.2533
"""Standard deviation of a normal distribution divided by its median and by its mean absolute deviation."""
LEAST_SHARE = 0.25
"""… if it also exceeds this share of the median: a class of nearly equal variants has no outlier."""

ONE_PROCESS = 200
"""Class size below which the figures are computed in this process, because starting others takes longer."""
LIMITS = Limits(seconds=60.0, megabytes=1000)
"""Limits for computing the figures of one file."""

ShowProgress = Callable[[Iterable[Any], int], Iterable[Any]]
"""Passes on an iterable of known length and shows the progress."""

FileState = Literal["new", "changed", "same", "kept"]
"""State of a file: made, made again, unchanged, or kept because it was edited by hand."""


class StudentFile(Record, dict=True):
    """A student's assignment file: its student, path, state, and its text as drawn.

    `top` has the parts in place; `parts` are the files in which those are written.
    """

    drawn: DrawnVariant
    path: Path
    state: FileState
    text: str
    top: MappingNode
    parts: Mapping[Path, str]

    @cached_property
    def source(self) -> Source:
        """The file's content after it is made; parts that are not made yet are inline."""
        return read_source(self.path) if self.state == "kept" else Source(str(self.path), self.text, self.top)

    @property
    def whole(self) -> Node | None:
        """The whole content, with the parts in place."""
        top = self.source.top
        return parts.in_place(top, self.path)[0] if isinstance(top, MappingNode) else top

    @property
    def files(self) -> Mapping[Path, bytes]:
        """The files to write."""
        return {path: text.encode() for path, text in {self.path: self.text, **self.parts}.items()}


class Effort(NamedTuple):
    """Figures for the effort of a variant, in the order of the columns of `variants.csv`.

    `worked` counts the printed values that are derived at the positions, over all of these. `largest` is the largest
    balancing torque (N·m) or force (N) of the positions, `speed` that of the driver (rad/s or m/s), `positive` the
    share of positions with a positive balance. `largest` and `positive` are None without loads, `speed` without a
    driver. `zeros` counts the values that are zero beside their scale.
    """

    worked: int
    largest: float | None
    speed: float | None
    positive: float | None
    zeros: int


class Spread(Record):
    """One figure over the class; `outliers` are the indices of variants out of proportion."""

    name: str
    least: float
    median: float
    greatest: float
    outliers: tuple[int, ...]


class Variants(Record):
    """The result: the files in the order of the roster, remarks, and a summary of the variants' difficulty, as text."""

    files: tuple[StudentFile, ...]
    remarks: tuple[str, ...]
    summary: tuple[str, ...]


def make_variants(
    spec_path: Path,
    roster_path: Path,
    out: Path,
    force: bool = False,
    language: Language | None = None,
    show_progress: ShowProgress = lambda files, _: files,
    shared: Sequence[Path] = (),
    redraw: Sequence[str] = (),
    drop: Sequence[str] = (),
) -> Variants:
    """Draw for the class of a roster and write each student's assignment file into `out`.

    The spec's table may also be below a `shared` folder. Files are written whole; one that was edited since it was made
    is kept unless `force`. A school's words that the spec names are copied with them. Also write `out`/variants.csv,
    which is for the instructor alone. Students to `redraw`, by id, e-mail or name, get another variant than before.
    Those to `drop` lose theirs, and their files. The table records this for later runs, and all others keep their
    variants. Raises `AssignmentError` with the faults of spec and roster, before anything is written, and
    `UnknownNameError` for an unknown student.
    """
    spec = read_spec(spec_path, language, shared)
    listed = read_roster(roster_path, spec.language)
    earlier = read_earlier(out / TABLE, spec.language).with_dropped(drop, listed, spec.language)
    anew = students_named(redraw, listed, spec.language)
    roster = earlier.whole(listed)
    _refuse(spec.column_faults(roster.columns), spec)
    stems = [student.folder for student in roster.students]
    names = (
        (f"{stem}.yaml" for stem in stems),
        (parts.frozen(stem, name) for stem in stems for name in spec.frozen.values()),
    )
    outputs = (out / name for name in (*chain(*names), TABLE))
    _refuse(list(overwritten(outputs, (*spec.files, roster_path))), spec)
    # A draw is checked in its target folder, with the words beside it.
    for name, content in words_beside(spec_path).items():
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        put_file(out / name, content)
    draw, files, everyone = Draw(spec, fault_finder(spec)), list[StudentFile](), list[StudentFile]()

    def each() -> Iterator[StudentFile]:
        for drawn in draw.each(roster, earlier.redrawn, anew):
            file = _student_file(spec, drawn, out, force)
            everyone.append(file)
            if comparable(drawn.student.id) not in earlier.dropped:
                files.append(file)
                yield file

    count = len(roster.students) - len(earlier.dropped & {comparable(one.id) for one in roster.students})
    # While some variants are drawn, other processes compute the figures of earlier ones.
    efforts = tuple(show_progress(_efforts(each(), count), count))
    _refuse(draw.faults, spec)
    out.mkdir(parents=True, exist_ok=True)
    made = [file.files for file in files if file.state in ("new", "changed")]
    known = {file.drawn.student.id: one for file, one in zip(files, efforts, strict=True) if one is not None}
    table = _csv(spec, everyone, known, anew | earlier.redrawn.keys(), earlier.dropped)
    dropped = [file for file in everyone if file not in files]
    left = [file for file in dropped if file.state == "kept"]
    gone = [path for file in dropped if file not in left for path in file.files if path.exists()]
    put_set({**{path: content for one in made for path, content in one.items()}, out / TABLE: table}, gone)
    remarks = (
        *map(str, roster.notes),
        *(word("variants_dropped", spec.language, id=file.drawn.student.id) for file in dropped),
        *(word("variants_kept", spec.language, path=file.path) for file in left),
        *_doubts(spec),
        *_remarks(files, efforts, spec.language),
        *_sharing(draw, files, spec),
    )
    return Variants(tuple(files), remarks, tuple(_summary(known, spec.language)))


def _doubts(spec: Spec) -> Iterator[str]:
    """Yield warnings about numbers in the spec and its parts that may be meant as thousands."""
    for file in spec.files:
        if file.suffix.lower() in (".yaml", ".yml"):
            yield from (str(as_problem(one, spec.language, "warning")) for one in doubtful(read_source(file)))


def _refuse(faults: Sequence[Fault], spec: Spec) -> None:
    if faults:
        raise as_error(faults, spec.language)


# --- a student's file -------------------------------------------------------------------------------


def _student_file(spec: Spec, drawn: DrawnVariant, folder: Path, force: bool) -> StudentFile:
    """Return the assignment file of a student in `folder`; an edited one there is kept unless `force`."""
    top = _table(spec, drawn)
    stem = drawn.student.folder
    named: Node = top
    frozen: dict[Path, str] = {}
    for index, name in spec.frozen.items():
        file = parts.frozen(stem, name)
        named = put(named, (PARTS, index), _named_part(top, index, file))
        frozen[folder / file] = _part_text(spec, drawn, top, index)
    assert isinstance(named, MappingNode), "parts are put into a table"
    body = text_of(named, spec.text, spec.whole)
    path = folder / f"{stem}.yaml"
    text = _head(spec, drawn, (body, *frozen.values())) + body
    return StudentFile(drawn, path, _state(path, body, frozen, force), text, top, frozen)


def _named_part(top: MappingNode, index: int, file: str) -> MappingNode:
    """Return a part as a reference to its file, with the keys about the part."""
    item = at(top, (PARTS, index))
    assert isinstance(item, MappingNode), "a part is a table"
    about = (entry for entry in item.entries if entry[0].text in parts.ABOUT)
    return MappingNode(((_scalar("file"), _scalar(file)), *about), item.location)


def _part_text(spec: Spec, drawn: DrawnVariant, top: MappingNode, index: int) -> str:
    """Return the file of a part, headed by its student."""
    item, source = at(top, (PARTS, index)), spec.parts[index]
    assert isinstance(item, MappingNode), "a part is a table"
    assert isinstance(source.top, MappingNode), "the spec of a part is a table"
    whose = word("variants_part", spec.language, id=quoted(drawn.student.id), file=f"{drawn.student.folder}.yaml")
    return f"# {whose}\n{text_of(without(item, parts.ABOUT), source.text, source.top)}"


def _state(path: Path, body: str, frozen: Mapping[Path, str], force: bool) -> FileState:
    try:
        *head, present = _present(path).split("\n", HEAD_LINES)
    except FileNotFoundError:
        return "new"
    standing: dict[Path, str] = {}
    for part in frozen:
        with suppress(FileNotFoundError):
            standing[part] = _present(part)
    stated = _HASH.fullmatch(head[-1]) if len(head) == HEAD_LINES else None
    # A missing part is made again; nobody can have edited it, so it counts as new.
    untouched = stated is not None and stated[1] == _digest(present, *{**frozen, **standing}.values())
    if untouched and (present, standing) == (body, frozen):
        return "same"
    return "changed" if untouched or force else "kept"


def _present(path: Path) -> str:
    return contents(path).decode("utf-8", "replace").replace("\r\n", "\n")


def _digest(*texts: str) -> str:
    """Return the SHA-256 of the concatenated texts."""
    return hashlib.sha256("".join(texts).encode()).hexdigest()


def _head(spec: Spec, drawn: DrawnVariant, texts: Sequence[str]) -> str:
    """Return the head as comments; user text is quoted, so that no line can end in it."""
    origin = {"version": version(), "spec": quoted(spec.path.name), "digest": spec.digest, "salt": quoted(spec.salt)}
    lines = (
        word("variants_for", spec.language, id=quoted(drawn.student.id)),
        word("variants_made", spec.language, **origin),
        word("variants_body" if len(texts) == 1 else "variants_bodies", spec.language, digest=_digest(*texts)),
    )
    return "".join(f"# {line}\n" for line in lines)


def _table(spec: Spec, drawn: DrawnVariant) -> MappingNode:
    """Return the content of the file: the spec with the student's card and the drawn values."""
    card = MappingNode(tuple((_scalar(key), _scalar(text)) for key, text in drawn.student.card.items()), _HERE)
    top: Node = put(assembled(spec.top, drawn.settings), ("report", "student"), card)
    if at(top, ("report", "language")) is None:
        top = put(top, ("report", "language"), _scalar(spec.language))
    if spec.axes:
        top = put(top, ("variant",), _scalar(spec.label(drawn.combination)))
    assert isinstance(top, MappingNode), "keys are put into a table"
    # The kind and the variant come first.
    first = {"kind": 0, "variant": 1}
    entries = sorted(top.entries, key=lambda entry: first.get(entry[0].text, 2))
    return MappingNode(tuple(entries), top.location)


def _scalar(text: str) -> Scalar:
    return Scalar(text, _HERE)


# --- how equal the variants are ---------------------------------------------------------------------


def _efforts(files: Iterable[StudentFile], count: int) -> Iterator[Effort | None]:
    """Yield the figures of each file; None for an invalid one that was edited by hand."""
    if count < ONE_PROCESS:
        yield from map(_effort_of, files)
    else:
        yield from (found for _, found in each_within(LIMITS, _effort_of, files, __name__))


def _effort_of(file: StudentFile) -> Effort | None:
    # Drawn files have been checked, files edited by hand have not.
    judge = catalogue.assess if file.state == "kept" else catalogue.understood
    assignment, _ = judge(file.source, file.path)
    return None if assignment is None else effort(assignment)


def effort(assignment: Assignment) -> Effort:
    """Return the figures of an assignment, from the values derived at its positions."""
    case = opened(assignment)
    balance = case.balance
    derived = [
        family
        for family in case.families.values()
        if family.definition is not None and not family.hidden and not family.is_plane
    ]
    zeros = sum(
        family.at(position) == 0 for family in derived if family.scale for position in range(1, len(family.values) + 1)
    )
    return Effort(
        worked=sum(len(family.values) for family in derived),
        largest=None if balance is None else float(np.max(np.abs(balance))),
        speed=case.speed,
        positive=None if balance is None else float(np.mean(balance > 0)),
        zeros=int(zeros),
    )


def compare(efforts: Sequence[Effort]) -> list[Spread]:
    """Return each figure's spread over the class; figures that no variant has are left out."""
    spreads = []
    for name, values in zip(Effort._fields, zip(*efforts, strict=True), strict=False):
        known = [value for value in values if value is not None]
        if known:
            middle = median(known)
            outliers = _outliers(name, values, middle)
            spreads.append(Spread(name, min(known), middle, max(known), outliers))
    return spreads


def _outliers(name: str, values: Sequence[float | None], middle: float) -> tuple[int, ...]:
    """Return the indices of outliers: counts by a factor, sizes by the median absolute deviation.

    If most variants have the median, so that deviation is zero, the mean absolute deviation replaces it.
    """
    known = {k: value for k, value in enumerate(values) if value is not None}
    if name == "worked":
        least, most = middle / MOST_TIMES, middle * MOST_TIMES
        return tuple(k for k, value in known.items() if value and not least <= value <= most)
    deviations = [abs(value - middle) for value in known.values()]
    spread = OF_MEDIAN * median(deviations) or OF_MEAN * fmean(deviations)
    limit = max(MOST_DEVIATIONS * spread, LEAST_SHARE * abs(middle))
    return tuple(k for k, value in known.items() if abs(value - middle) > limit)


def _lines(spreads: Sequence[Spread], language: Language) -> list[str]:
    """Return the spreads as lines of text: a figure with its smallest, median and largest value."""
    rows = [["", *(word(name, language) for name in ("least", "median", "greatest"))]]
    rows += [[word(one.name, language), *map(_rounded, (one.least, one.median, one.greatest))] for one in spreads]
    first, *others = (max(map(len, cells)) for cells in zip(*rows, strict=True))
    return [
        "  ".join([name.ljust(first), *(cell.rjust(width) for cell, width in zip(cells, others, strict=True))])
        for name, *cells in rows
    ]


def _rounded(value: float) -> str:
    """Return a figure with four digits, a count with all."""
    return f"{value:.0f}" if float(value).is_integer() and abs(value) < 1e9 else f"{value:.4g}"


# --- what the instructor sees -----------------------------------------------------------------------


def _remarks(files: Sequence[StudentFile], efforts: Sequence[Effort | None], language: Language) -> Iterator[str]:
    """Yield remarks about the files that were kept."""
    for file, effort in zip(files, efforts, strict=True):
        if file.state == "kept":
            yield word("variants_kept", language, path=file.path)
        if effort is None:
            yield word("variants_unchecked", language, id=file.drawn.student.id)


def _sharing(draw: Draw, files: Sequence[StudentFile], spec: Spec) -> Iterator[str]:
    """Yield the students with the same variant, if there are any."""
    groups = shared(file.drawn for file in files)
    if groups:
        yield word("variants_shared", spec.language, size=draw.usable, students=len(files))
    for group in groups:
        ids = ", ".join(one.student.id for one in group)
        yield word("variants_same", spec.language, variant=spec.label(group[0].combination), ids=ids)


def _summary(efforts: Mapping[str, Effort], language: Language) -> Iterator[str]:
    """Yield a comparison of the variants, by the figures of each student's file."""
    if len(efforts) < 2:
        return
    spreads, students = compare(list(efforts.values())), list(efforts.items())
    yield word("variants_table", language, count=len(efforts))
    yield from _lines(spreads, language)
    for spread in spreads:
        apart = [f"{id} ({_rounded(getattr(one, spread.name))})" for id, one in (students[k] for k in spread.outliers)]
        if apart:
            about = {"name": word(spread.name, language), "median": _rounded(spread.median)}
            yield word("variants_apart", language, ids=", ".join(apart), **about)


def _csv(
    spec: Spec,
    files: Sequence[StudentFile],
    efforts: Mapping[str, Effort],
    redrawn: Collection[str],
    dropped: Collection[str],
) -> bytes:
    """Return a row per student: id, name, file, variant, drawn or set values as the file now has them, and figures.

    The last columns have the number of a redrawn variant, and a mark for a student who has left the class and has no
    file. The rows are in the order of the draw.
    """
    present = [file for file in files if comparable(file.drawn.student.id) not in dropped]
    places: list[Where] = list(dict.fromkeys(where for file in present for where in file.drawn.settings))
    head = ["id", "name", "file", "variant", *map(path_text, places), *Effort._fields, REDRAWN, DROPPED]
    rows: list[list[str | float | None]] = [[*head]]
    for file in files:
        student = file.drawn.student
        key = comparable(student.id)
        number = spec.number(file.drawn.combination) + 1 if key in redrawn else None
        if key in dropped:
            rows.append([student.id, student.card.get("name"), *(None for _ in head[4:]), number, MARKED])
            continue
        top = file.whole
        nodes = (at(top, where) for where in (("variant",), *places))
        values = [node.text if isinstance(node, Scalar) else None for node in nodes]
        tail = efforts.get(student.id) or (None,) * len(Effort._fields)
        rounded = [None if value is None else float(f"{value:.6g}") for value in tail]
        rows.append([student.id, student.card.get("name"), file.path.name, *values, *rounded, number, None])
    return write_csv(rows)
