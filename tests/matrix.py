"""Run every command on every kind of assignment and every sample coursework; new ones are included automatically.

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
from reportgen.base.languages import setting_of
from reportgen.base.template_folders import DEFAULT_LANGUAGE, atlas_files, languages, samples
from reportgen.base.units import Language
from reportgen.case import Case
from reportgen.case.answer_key import Key
from reportgen.cases import open_case
from reportgen.cli import app
from reportgen.document.named_figures import named_figures
from reportgen.marking.toleranced_key import Ask, key_of
from reportgen.page.edit_session import EditSession
from reportgen.page.live_view import LiveSession
from tests.kinds import ATLAS_MACHINE, KINDS
from tests.marking.filled import filled

OWN: Language | Literal[""] = ""
"""Language; "" for that of the file."""
CONTENT = {".pdf": b"%PDF-", ".xlsx": b"PK", ".docx": b"PK", ".html": b"<!DOCTYPE html>", ".dxf": b"  0\nSECTION"} | {
    ".svg": b"<",
    ".png": b"\x89PNG",
    ".eps": b"%!PS-Adobe-3.0 EPSF-3.0",
}
"""First bytes of each type of file."""
LONGEST_FORM = 70_000
"""Largest size (bytes) of a form, of which 4 kB are keys by which a newer form finds unchanged elements.

A letter of the Russian one has two bytes.
"""
MOST = 8
"""Number of cached cases: those of one coursework and its parts."""


@cache
def subjects() -> dict[str, Path]:
    """Return the shortest example of each kind that can be used alone, and each coursework, by name.

    One machine of the atlas stands for all (`tests/kinds.py`), in one language: its words are those of a `linkage`,
    which is here in every combination. The others share the commands and languages (`spread`).
    """
    examples = {Path(kind).name: catalogue.examples(kind) for kind in KINDS}
    examples = {kind: [path for path in paths.values() if not _has_parts(path)] for kind, paths in examples.items()}
    alone = {kind: min(paths, key=lambda path: path.stat().st_size) for kind, paths in examples.items()}
    whole = {f"whole-{path.stem}": path for path in sorted(samples().rglob("*.yaml")) if _has_parts(path)}
    return alone | whole


@cache
def machines() -> dict[str, Path]:
    """Return the shortest example of each machine of the atlas but the one among the subjects, by name."""
    kinds = [kind for kind in sorted(atlas_files()) if kind != ATLAS_MACHINE]
    return {
        Path(kind).name: min(catalogue.examples(kind).values(), key=lambda path: path.stat().st_size) for kind in kinds
    }


def _has_parts(path: Path) -> bool:
    text = path.read_text(encoding="utf-8")
    return "\nparts:" in text and "\nsalt:" not in text


@dataclass(frozen=True)
class Desk:
    """An assignment file in its own folder, with the user's settings."""

    file: Path
    capture: pytest.CaptureFixture[str]
    language: Language | Literal[""] = OWN
    engine: api.Engine = "typst"
    extent: Extent = "short"
    turn: int | None = None
    """Number that differs by one from the next language and the next subject; None for one that has a single case."""

    @property
    def brief(self) -> bool:
        """True if one format of each command is enough: in the first lane, in the language of the file."""
        return self.language == OWN

    def formats(self, known: Sequence[str], enough: str) -> str:
        """Return the formats of a command to make."""
        return enough if self.brief else ",".join(known)

    def in_turn(self, known: Sequence[str], enough: str) -> str:
        """Return the format that has its turn: the languages of a subject make all, and so do the subjects of one."""
        if self.turn is None or self.brief:
            return self.formats(known, enough)
        return known[self.turn % len(known)]

    @property
    def out(self) -> Path:
        """A separate folder for each combination of settings, so that no file counts as stale."""
        return self.file.parent / f"out-{self.language}-{self.engine}-{self.extent}"

    @property
    def spoken(self) -> Language:
        return self.language or api.load(self.file).language

    @property
    def key(self) -> Key:
        return Ask().of(_key(self.file, self.spoken))

    def run(self, command: str, *arguments: object) -> str:
        """Run a command and return its output; it must succeed without messages or library warnings."""
        lang = ("--lang", self.language) if self.language else ()
        with warnings.catch_warnings(category=RuntimeWarning, action="error"), pytest.raises(SystemExit) as end:
            app([command, *map(str, (*arguments, *lang))], prog_name="reportgen")
        printed = self.capture.readouterr()
        assert (end.value.code or 0, printed.err) == (0, ""), printed.err
        return printed.out

    def made(self, command: str, *arguments: object) -> list[Path]:
        """Return the files that a command names, after checking that each exists and has the type of its suffix."""
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
    """Cache what one command computes of an assignment for the next ones."""
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
    """Return a case that composes its report and its moving figures only once."""
    for name in ("document", "animations"):
        object.__setattr__(case, name, cache(getattr(case, name)))
    return case


def desk(subject: str, folder: Path, capture: pytest.CaptureFixture[str], **wanted: object) -> Desk:
    """Return a subject's file with the files of its parts, copied into a folder."""
    source = (subjects() | machines())[subject]
    content, beside = inputs(source)
    for name, data in {**beside, source.name: content}.items():
        (folder / name).write_bytes(data)
    language = wanted.get("language")
    if language and subject != ATLAS:
        wanted["turn"] = _turn(subject, language)
    return Desk(folder / source.name, capture, **wanted)  # type: ignore[arg-type]


def _turn(subject: str, language: object) -> int:
    return [*subjects(), *machines()].index(subject) + [*languages()].index(language)  # type: ignore[arg-type]


# --- the commands ---------------------------------------------------------------------------------


def check(at: Desk) -> None:
    """Check that a sample is valid; it may have warnings and notes."""
    with pytest.raises(SystemExit) as end:
        app(["check", str(at.file)])
    assert (end.value.code or 0, at.capture.readouterr().out) == (0, "")


def solve(at: Desk) -> None:
    """Check the tables with numbers in every column, for every part of a coursework."""
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
    """Check the tables of a turn (with few positions): a row per position in each of the formats."""
    counted = catalogue.kind(api.load(at.file).kind).counts_positions
    paths = at.made("solve", "--format", ",".join(api.RESULT_FORMATS), *(("--positions", 8) if counted else ()))
    found = {path.name: path for path in paths}
    positions = json.loads(found["results.json"].read_bytes())["positions"]
    assert len(list(csv.reader(found["results.csv"].read_text("utf-8-sig").splitlines()))) == 1 + len(positions)


def build(at: Desk) -> None:
    """Check the report: as PDF, the full one by typst in every other format too, the short one in one of them."""
    formats = at.formats(api.FORMATS, "pdf")
    if at.engine == "latex":
        formats = "pdf"
    elif at.extent == "short":
        further = at.in_turn([format for format in api.FORMATS if format != "pdf"], "")
        formats = f"pdf,{further}".rstrip(",")
    paths = at.made("build", "--extent", at.extent, "--engine", at.engine, "--format", formats)
    assert ",".join(path.suffix[1:] for path in paths) == formats
    for path in paths:
        if path.suffix == ".docx":
            with zipfile.ZipFile(path) as word:
                assert word.testzip() is None


def sheet(at: Desk) -> None:
    formats = at.in_turn(api.SHEET_FORMATS, "dxf")
    paths = at.made("sheet", "--format", formats)
    assert {path.suffix[1:] for path in paths} == set(formats.split(","))
    assert paths[0].stem == "sheet-1"


def figure(at: Desk) -> None:
    """Check the first figure of the report; the list also has every moving figure."""
    from reportgen.export.figures import MOVING, STILL

    case = open_case(at.file, at.language or None)
    name = named_figures(case.document())[0].name
    if at.brief:
        lines = at.run("figure", at.file, "--list").splitlines()
        assert lines[0].split()[0] == name
        assert sum("/".join(MOVING) in line for line in lines) == sum(len(one.panes) for one in case.animations())
    formats = at.in_turn(STILL, "svg")
    paths = at.made("figure", name, "--format", formats)
    assert {path.suffix[1:] for path in paths} == set(formats.split(","))
    assert paths[0].stem.startswith(name)


def plot(at: Desk) -> None:
    """Check the first quantity that is a curve; a kind without curves reports it."""
    from reportgen.export.quantities import visible_ids

    case = open_case(at.file, at.language or None)
    id = next(visible_ids(case), None)
    if id is None:
        with pytest.raises(SystemExit) as end:
            app(["plot", str(at.file), "--of", next(iter(case.ledger.families)), "--out", str(at.out)])
        assert (end.value.code, at.capture.readouterr().out) == (1, "")
        return
    formats = at.in_turn(PLOT_FORMATS, "svg")
    paths = at.made("plot", "--of", id, "--format", formats)
    assert [path.name for path in paths] == [f"{id}.{format}" for format in formats.split(",")]


def key(at: Desk) -> None:
    formats = at.formats(api.KEY_FORMATS, "csv,json")
    paths = at.made("key", "--format", formats, "--engine", at.engine)
    assert ",".join(path.suffix[1:] for path in paths) == formats


def task(at: Desk) -> None:
    """Check task and answer sheet as a batch makes them, with the data in one file."""
    files = dict(api.task_files(at.file, at.engine, at.language or None))
    assert b"#" not in files.pop("assignment.yaml")
    starts = {name: data[:2] for name, data in files.items()}
    assert starts == {"task.pdf": b"%P", "answers.xlsx": b"PK"}


def compare(at: Desk) -> None:
    """Check that the sheet of a student with all values right agrees."""
    (at.file.parent / "mine.xlsx").write_bytes(filled(at.key))
    assert at.run("compare", at.file, at.file.parent / "mine.xlsx")


def grade(at: Desk) -> None:
    """Check that the same student gets all points."""
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
    """Check the first page, before there is a report: moving figures and no fault."""
    watched = LiveSession(partial(open_case, at.file, at.language or None))
    watched.renew()
    assert watched.revision.fault == ""
    assert watched.revision.language == at.spoken
    assert watched.page().startswith("<!DOCTYPE html>")
    assert len(watched.revision.panels) >= len(open_case(at.file).animations())


def edit(at: Desk) -> None:
    """Check the form of the file, its size, and that changing and undoing its first value restores every byte."""
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
BY_ENGINE, BY_EXTENT, BY_FILE = {build, key, task, grade}, {build}, {check}
"""Commands that typeset their output, the one that makes it in two extents, and the one that takes no language."""
ATLAS = Path(ATLAS_MACHINE).name
EVERY = 5
"""Each further machine of the atlas has a command of so many; a number without a factor of that of the languages."""


def cases() -> Iterator[tuple[str, str, Language | Literal[""], api.Engine, Extent]]:
    """Yield subject, command, language, engine, extent: first briefly in the file's language, then by the languages.

    Each subject runs each command in the default language and in one more. The second language changes from command to
    command and from subject to subject, so that every subject and every command has all of them; reports are also made
    in every language that is not a draft. Drafts have typst and the short extent only. All cases of a language follow
    each other, because few calculations are cached.
    """
    for subject in subjects():
        for command in COMMANDS:
            yield subject, command.__name__, OWN, "typst", "short"
        for language in languages():
            for command in COMMANDS:
                if language in _spoken(command, subject):
                    for engine, extent in _settings(command, subject, language):
                        yield subject, command.__name__, language, engine, extent


def _spoken(command: Callable[[Desk], None], subject: str) -> set[Language]:
    """Return the languages of a command for a subject."""
    if command in BY_FILE or subject == ATLAS:
        return {DEFAULT_LANGUAGE}
    others = [language for language in languages() if language != DEFAULT_LANGUAGE]
    turn = COMMANDS.index(command) + [*subjects()].index(subject)
    native = {language for language in languages() if not setting_of(language).is_draft()}
    return {DEFAULT_LANGUAGE, others[turn % len(others)], *(native if command in BY_EXTENT else ())}


def _settings(command: Callable[[Desk], None], subject: str, language: Language) -> Iterator[tuple[api.Engine, Extent]]:
    """Yield the engines and extents of a language; its engine is another one with the next language and subject."""
    engines: tuple[api.Engine, ...] = get_args(api.Engine)
    if command not in BY_ENGINE or subject == ATLAS or setting_of(language).is_draft():
        yield "typst", "short"
        return
    engine = engines[_turn(subject, language) % len(engines)]
    if command not in BY_EXTENT:
        yield engine, "short"
        return
    yield engine, "full"
    if engine == "typst":
        yield "latex", "short"


def spread() -> Iterator[tuple[str, str, Language, api.Engine, Extent]]:
    """Yield cases of the further machines: each has every fifth command, beginning with the next one, in its language.

    With 20 machines, each command has every language.
    """
    spoken, engines = [*languages()], get_args(api.Engine)
    for number, machine in enumerate(machines()):
        language = spoken[number % len(spoken)]
        is_draft, turn = setting_of(language).is_draft(), number // len(spoken)
        for command in COMMANDS[number % EVERY :: EVERY]:
            engine = "typst" if is_draft or command not in BY_ENGINE else engines[turn % len(engines)]
            extent: Extent = "full" if command in BY_EXTENT and not is_draft else "short"
            yield machine, command.__name__, language, engine, extent


def do(command: str, at: Desk) -> None:
    """Run a command by its name."""
    next(one for one in COMMANDS if one.__name__ == command)(at)
