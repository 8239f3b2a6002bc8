"""Every kind of assignment and every sample coursework × every command: a new one of either enters by being there.

Kinds are the program's own list, each with its shortest example; courseworks are the samples with parts.  A command is
a function of `COMMANDS`: it does with a `Desk` what a user types, and looks at what came of it.
"""

from __future__ import annotations

import csv
import json
import re
import warnings
import zipfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache, partial
from html import unescape
from pathlib import Path
from typing import Literal, get_args

import pytest

from reportgen import api, catalogue
from reportgen import cases as cases_module
from reportgen.api.figures import PLOT_FORMATS
from reportgen.assignment import Assignment
from reportgen.assignment.common import Extent
from reportgen.assignment.reading import inputs
from reportgen.base.kinds import kinds
from reportgen.base.languages import setting_of
from reportgen.base.template_folders import languages, samples
from reportgen.base.units import Language
from reportgen.case import Case
from reportgen.case.key import Key
from reportgen.cases import open_case
from reportgen.cli import app
from reportgen.document.named_figures import named_figures
from reportgen.marking.key import Ask, key_of
from reportgen.page.editing import EditSession
from reportgen.page.live import LiveSession
from tests.marking.filled import filled

OWN: Language | Literal[""] = ""
"""The language of the file."""
CONTENT = {".pdf": b"%PDF-", ".xlsx": b"PK", ".docx": b"PK", ".html": b"<!DOCTYPE html>", ".dxf": b"  0\nSECTION"} | {
    ".svg": b"<",
    ".png": b"\x89PNG",
    ".eps": b"%!PS-Adobe-3.0 EPSF-3.0",
}
"""What files begin with."""
LONGEST_FORM = 64_000
"""Bytes of a form; 4 kB of them are the keys by which a newer form finds the elements that it leaves in place."""
MOST = 8
"""Cases that are kept at once: those of one coursework and its parts."""


@cache
def subjects() -> dict[str, Path]:
    """The shortest example of each kind that is one alone, and each coursework, by name."""
    examples = {kind: [path for path in catalogue.examples(kind).values() if not _has_parts(path)] for kind in kinds()}
    alone = {kind: min(paths, key=lambda path: path.stat().st_size) for kind, paths in examples.items()}
    whole = {f"whole-{path.stem}": path for path in sorted(samples().rglob("*.yaml")) if _has_parts(path)}
    return alone | whole


def _has_parts(path: Path) -> bool:
    text = path.read_text(encoding="utf-8")
    return "\nparts:" in text and "\nsalt:" not in text


@dataclass(frozen=True)
class Desk:
    """An assignment file in a folder of its own, and how its user wants it."""

    file: Path
    capture: pytest.CaptureFixture[str]
    language: Language | Literal[""] = OWN
    engine: api.Engine = "typst"
    extent: Extent = "short"

    @property
    def brief(self) -> bool:
        """Whether one format of each command has to do: in the first lane, in the language of the file."""
        return self.language == OWN

    def formats(self, known: Sequence[str], enough: str) -> str:
        """Of the formats of a command those to be made: what no typesetter makes does not change with the engine."""
        return enough if self.brief else ",".join(known) if self.engine == "typst" else "pdf"

    @property
    def out(self) -> Path:
        """A folder for each way of making: what was made otherwise is stale there, and would be told."""
        return self.file.parent / f"out-{self.language}-{self.engine}-{self.extent}"

    @property
    def spoken(self) -> Language:
        return self.language or api.load(self.file).language

    @property
    def key(self) -> Key:
        return Ask().of(_key(self.file, self.spoken))

    def run(self, command: str, *arguments: object) -> str:
        """What a command prints that ends well and says nothing else; no library may warn of anything on its way."""
        lang = ("--lang", self.language) if self.language else ()
        with warnings.catch_warnings(category=RuntimeWarning, action="error"), pytest.raises(SystemExit) as end:
            app([command, *map(str, (*arguments, *lang))], prog_name="reportgen")
        printed = self.capture.readouterr()
        assert (end.value.code or 0, printed.err) == (0, ""), printed.err
        return printed.out

    def made(self, command: str, *arguments: object) -> list[Path]:
        """The files that a command names; each is there and is what its ending says."""
        paths = [Path(line) for line in self.run(command, self.file, *arguments, "--out", self.out).splitlines()]
        assert paths
        for path in paths:
            assert path.read_bytes().startswith(CONTENT.get(path.suffix, b"")), path
            assert path.stat().st_size > 100
        return paths


@cache
def _key(file: Path, language: Language) -> Key:
    return key_of(open_case(file, language))


@contextmanager
def shared() -> Iterator[None]:
    """Meanwhile what one command has worked out of an assignment need not be worked out again for the next."""
    plain, made = cases_module.opened, dict[str, Case]()

    def opened(assignment: Assignment) -> Case:
        name = repr(assignment)
        if name not in made:
            if len(made) == MOST:
                made.pop(next(iter(made)))
            made[name] = _remembering(plain(assignment))
        return made[name]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cases_module, "opened", opened)
        yield


def _remembering(case: Case) -> Case:
    """A case whose report is composed once, and what moves of it."""
    for name in ("document", "animations"):
        object.__setattr__(case, name, cache(getattr(case, name)))
    return case


def desk(subject: str, folder: Path, capture: pytest.CaptureFixture[str], **wanted: object) -> Desk:
    """A subject's file with the files of its parts, copied into a folder."""
    source = subjects()[subject]
    content, beside = inputs(source)
    for name, data in {**beside, source.name: content}.items():
        (folder / name).write_bytes(data)
    return Desk(folder / source.name, capture, **wanted)  # type: ignore[arg-type]


# --- the commands ---------------------------------------------------------------------------------


def check(at: Desk) -> None:
    """A sample is in order; it may have warnings and notes."""
    with pytest.raises(SystemExit) as end:
        app(["check", str(at.file)])
    assert (end.value.code or 0, at.capture.readouterr().out) == (0, "")


def solve(at: Desk) -> None:
    """Tables with numbers in every column, for every part of a coursework."""
    printed = at.run("solve", at.file)
    assert printed.count("┏") >= 1 + len(api.load(at.file).parts)
    rows = [[cell.strip() for cell in line.split("│")[1:-1]] for line in printed.splitlines() if line.startswith("│")]
    assert rows
    assert all(re.fullmatch(r"–|[−+]?[0-9][0-9.,]*(·10[⁻⁰¹²³⁴-⁹]+)?", cell) for row in rows for cell in row[1:]), rows


def solve_json(at: Desk) -> None:
    found = json.loads(at.run("solve", at.file, "--json", "-"))
    assert (found["format"], found["kind"]) == ("reportgen-results/1", api.load(at.file).kind)
    assert found["positions"]
    assert found["printed"]


def solve_format(at: Desk) -> None:
    """Tables of a turn, here of few positions: a row a position in each of the formats."""
    counted = catalogue.kind(api.load(at.file).kind).counts_positions
    paths = at.made("solve", "--format", ",".join(api.RESULT_FORMATS), *(("--positions", 8) if counted else ()))
    found = {path.name: path for path in paths}
    positions = json.loads(found["results.json"].read_bytes())["positions"]
    assert len(list(csv.reader(found["results.csv"].read_text("utf-8-sig").splitlines()))) == 1 + len(positions)


def build(at: Desk) -> None:
    """The report in every format."""
    formats = at.formats(api.FORMATS, "pdf")
    paths = at.made("build", "--extent", at.extent, "--engine", at.engine, "--format", formats)
    assert ",".join(path.suffix[1:] for path in paths) == formats
    for path in paths:
        if path.suffix == ".docx":
            with zipfile.ZipFile(path) as word:
                assert word.testzip() is None


def sheet(at: Desk) -> None:
    formats = at.formats(api.SHEET_FORMATS, "dxf")
    paths = at.made("sheet", "--format", formats)
    assert {path.suffix[1:] for path in paths} == set(formats.split(","))
    assert paths[0].stem == "sheet-1"


def figure(at: Desk) -> None:
    """The first figure of its report; every one of what moves stands in the list, too."""
    from reportgen.export.figures import MOVING, STILL

    case = open_case(at.file, at.language or None)
    name = named_figures(case.document())[0].name
    if at.brief:
        lines = at.run("figure", at.file, "--list").splitlines()
        assert lines[0].split()[0] == name
        assert sum("/".join(MOVING) in line for line in lines) == sum(len(one.panes) for one in case.animations())
    formats = at.formats(STILL, "svg")
    paths = at.made("figure", name, "--format", formats)
    assert {path.suffix[1:] for path in paths} == set(formats.split(","))
    assert paths[0].stem.startswith(name)


def plot(at: Desk) -> None:
    """The first quantity that is a curve; what has none is told."""
    from reportgen.export.quantities import shown

    case = open_case(at.file, at.language or None)
    id = next(shown(case), None)
    if id is None:
        with pytest.raises(SystemExit) as end:
            app(["plot", str(at.file), "--of", next(iter(case.ledger.families)), "--out", str(at.out)])
        assert (end.value.code, at.capture.readouterr().out) == (1, "")
        return
    formats = at.formats(PLOT_FORMATS, "svg")
    paths = at.made("plot", "--of", id, "--format", formats)
    assert [path.name for path in paths] == [f"{id}.{format}" for format in formats.split(",")]


def key(at: Desk) -> None:
    formats = at.formats(api.KEY_FORMATS, "csv,json")
    paths = at.made("key", "--format", formats, "--engine", at.engine)
    assert ",".join(path.suffix[1:] for path in paths) == formats


def task(at: Desk) -> None:
    """Task and answer sheet as a batch makes them, and the data beside them, in one file."""
    files = dict(api.task_files(at.file, at.engine, at.language or None))
    assert b"#" not in files.pop("assignment.yaml")
    starts = {name: data[:2] for name, data in files.items()}
    assert starts == {"task.pdf": b"%P", "answers.xlsx": b"PK"}


def compare(at: Desk) -> None:
    """The sheet of a student who has everything right agrees."""
    (at.file.parent / "mine.xlsx").write_bytes(filled(at.key))
    assert at.run("compare", at.file, at.file.parent / "mine.xlsx")


def grade(at: Desk) -> None:
    """The same student has all points."""
    handed = at.file.parent / "handed"
    handed.mkdir(exist_ok=True)
    (handed / f"{at.file.stem}.xlsx").write_bytes(filled(at.key))
    arguments = (handed, "--assignments", at.file.parent, "--out", at.out, "--engine", at.engine)
    lines = at.run("grade", *arguments).splitlines()
    points = next(
        match for line in lines if (match := re.match(rf"{at.file.stem}[:：] ?([\d.,]*\d)\D+([\d.,]*\d)", line))
    )
    assert points[1] == points[2], lines
    assert (at.out / at.file.stem / "feedback.pdf").read_bytes().startswith(b"%PDF-")


def watch(at: Desk) -> None:
    """The first page, before there is a report: what moves, and no fault."""
    watched = LiveSession(partial(open_case, at.file, at.language or None))
    watched.renew()
    assert watched.revision.fault == ""
    assert watched.revision.language == at.spoken
    assert watched.page().startswith("<!DOCTYPE html>")
    assert len(watched.revision.panels) >= len(open_case(at.file).animations())


def edit(at: Desk) -> None:
    """The form of the file, without a fault and not too long; its first value changed and undone, byte for byte."""
    session = EditSession(partial(open_case, at.file, at.spoken), at.spoken, path=at.file)
    before, form = at.file.read_bytes(), session.form()
    assert "data-goto" not in form
    assert len(form.encode()) <= LONGEST_FORM
    field = re.search(r"data-w='([^']*)' data-was=\"([^\"]+)\"", form)
    assert field
    where, was = json.loads(unescape(field[1])), unescape(field[2])
    assert "refused" not in session.edit({"op": "set", "where": where, "value": "new", "was": was})
    assert at.file.read_bytes() != before
    assert 'aria-invalid="true"' in session.form()
    session.edit({"op": "undo"})
    assert at.file.read_bytes() == before


COMMANDS: tuple[Callable[[Desk], None], ...] = (
    *(check, solve, solve_json, solve_format, build, sheet, figure, plot, key, task, compare, grade, watch, edit),
)
BY_ENGINE, BY_EXTENT = {build, key, task, grade}, {build}
"""Commands that typeset what they make, and that which makes it in two extents."""


def cases() -> Iterator[tuple[str, str, Language | Literal[""], api.Engine, Extent]]:
    """Subject, command, language, engine, extent: each briefly in its file's language, then whatever there is.

    A language that no native speaker has read has the engine and extent that are the usual ones alone.
    """
    for subject in subjects():
        for command in COMMANDS:
            engines = get_args(api.Engine) if command in BY_ENGINE else ("typst",)
            extents = ("short", "full") if command in BY_EXTENT else ("short",)
            yield subject, command.__name__, OWN, "typst", "short"
            yield from (
                (subject, command.__name__, language, engine, extent)
                for language in languages()
                for engine in engines
                for extent in extents
                if not setting_of(language).is_draft() or (engine, extent) == ("typst", "short")
            )


def do(command: str, at: Desk) -> None:
    """Run a command by its name."""
    next(one for one in COMMANDS if one.__name__ == command)(at)
