"""Cases and finished reports of the repository's assignment files, each made once in a process for all tests.

What is kept is frozen. A test that changes a file or the program opens a case of its own.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from pathlib import Path
from typing import Any
from unittest import mock

import pytest

from reportgen import api
from reportgen.assignment import Assignment
from reportgen.assignment.common import Extent
from reportgen.base.kinds import program_kinds
from reportgen.base.units import Language
from reportgen.base.words import language_of
from reportgen.base.yaml_source import Source
from reportgen.case import Case
from reportgen.cases import MachineCase, opened
from reportgen.document import Block, Document, Figure, List, Plate
from reportgen.drawing import Scene
from reportgen.formula import Chain
from reportgen.formula.ledger import Ledger
from tests.lanes import matrix
from tests.report.pages import Glyph, Page

ROOT = Path(__file__).parents[2]
FILES = sorted((ROOT / "assignments").glob("*.yaml"))
LANGUAGES: tuple[Language, ...] = ("vi", "en")
ENGINES: tuple[api.Engine, ...] = ("typst", "latex")

MOST = 64
"""Cases that are kept at once: those of a few files in all languages and extents."""

needs_tex = pytest.mark.skipif(shutil.which("pdflatex") is None, reason="pdflatex is not installed")
MARKS = {"typst": (), "latex": (needs_tex,)}


@cache
def assignment(path: Path) -> Assignment:
    """A file of the repository in its own language."""
    return api.load(path)


@cache
def own_language(path: Path) -> Language:
    return language_of(Source(str(path), path.read_text(encoding="utf-8")))


def _first_of_each_kind(files: Iterable[Path]) -> list[Path]:
    """By the text alone: every process of the tests asks this before its first test."""
    found: dict[str, Path] = {}
    for path in files:
        kind = re.search(r"^kind: *([\w-]+)", path.read_text(encoding="utf-8"), re.MULTILINE)
        assert kind, path
        found.setdefault(kind[1], path)
    return list(found.values())


TYPESET = _first_of_each_kind(FILES)
"""One file a kind is made by both writers."""
OF_EACH_KIND = {next(iter(api.examples(kind).values())).resolve() for kind in program_kinds()}
"""The first file of every kind; the words of a draft are proved with them."""
SAMPLE = ROOT / "assignments" / "engine-twin-05.yaml"
SIBLINGS = _first_of_each_kind(path for path in FILES if path not in TYPESET)
"""Where a kind has further files, one of them is made by one writer; the others differ in numbers only."""

SLIDE = ROOT / "assignments" / "linkage-slide.yaml"
"""A machine of the user's own, which a slider drives; its file is in English."""
CLASS_III = sorted((ROOT / "assignments" / "linkage").glob("*class-iii.yaml"))
"""Machines with a group of class III."""
ALL = [*FILES, *CLASS_III]

ENGINE_CASES = [pytest.param(engine, marks=MARKS[engine], id=engine) for engine in ENGINES]
PRINTED = [
    (path, language) for path in TYPESET for language in (LANGUAGES if path == SAMPLE else (own_language(path),))
]
"""The sample is printed in both languages, other kinds in their file's own; trees are compared in both."""
BY_BOTH = [(SAMPLE, "en"), (ROOT / "assignments" / "shaper-01.yaml", "vi")]
BY_ONE = [(ROOT / "assignments" / f"{name}-01.yaml", "vi") for name in ("lever-six-bar", "scotch-yoke")]
TELLING = [path for path, _ in (*BY_BOTH, *BY_ONE)]
"""What `make test` prints, by both writers and by typst alone: both languages, a sliding block, groups of all kinds."""
WRITTEN = matrix(
    [
        pytest.param((path, language), id=f"{path.stem}-{language}")
        for path in FILES
        for language in (LANGUAGES if path in TYPESET else (own_language(path),))
    ],
    telling=[(SAMPLE, "vi"), (SLIDE, own_language(SLIDE)), *BY_BOTH, *BY_ONE],
)
"""Groups of all kinds, the sample in both languages, a sliding driver; all other reports are for `make proof`."""
CASES = matrix(
    [
        pytest.param((path, engine, language), marks=MARKS[engine], id=f"{path.stem}-{engine}-{language}")
        for path, language in PRINTED
        for engine in ENGINES
    ],
    telling=[
        *((path, engine, language) for path, language in BY_BOTH for engine in ENGINES),
        *((path, "typst", language) for path, language in BY_ONE),
    ],
)
PAIRS = matrix(
    [pytest.param((path, language), marks=(needs_tex,), id=f"{path.stem}-{language}") for path, language in PRINTED],
    telling=BY_BOTH,
)


@dataclass(frozen=True)
class Written:
    """A report below the typesetter: what it was made of, and its tree."""

    case: Any
    """For a machine a `MachineCase`."""
    document: Document
    lines: frozenset[tuple[str, int | None]]
    """The quantities that have a worked line, with its position."""

    @property
    def language(self) -> Language:
        return self.document.language


@dataclass(frozen=True)
class Report:
    """A report on paper."""

    written: Written
    engine: api.Engine
    source: str
    pdf: bytes
    overfull: tuple[str, ...]

    @property
    def document(self) -> Document:
        return self.written.document

    @property
    def language(self) -> Language:
        return self.written.language

    @cached_property
    def opened(self) -> Any:
        """The open PDF."""
        return pytest.importorskip("pymupdf").open(stream=self.pdf, filetype="pdf")

    @cached_property
    def pages(self) -> list[Page]:
        return [Page(sheet) for sheet in self.opened]

    @cached_property
    def bodies(self) -> list[list[Glyph]]:
        """The glyphs of each page without header and footer."""
        return [page.body for page in self.pages]


def compose(assignment: Assignment) -> Written:
    """The tree of an assignment with all it stands on."""
    return _composed(MachineCase(assignment))


def _composed(case: Case) -> Written:
    lines: set[tuple[str, int | None]] = set()
    chain = Ledger.chain

    def watched(ledger: Ledger, id: str, position: int | None = None, note: str = "") -> Chain:
        lines.add((id, None if position is None else int(position)))
        return chain(ledger, id, position, note)

    with mock.patch.object(Ledger, "chain", watched):
        document = case.document()
    return Written(case, document, frozenset(lines))


def case(path: Path, language: Language | None = None, extent: Extent | None = None) -> Any:
    """A file of the repository as a `Case`, in its own language and extent where none is given."""
    return _case(*_as_asked(path, language, extent))


def written(path: Path, language: Language | None = None, extent: Extent | None = None) -> Written:
    """The tree of a file of the repository."""
    return _written(*_as_asked(path, language, extent))


def document(path: Path, language: Language | None = None, extent: Extent | None = None) -> Document:
    return written(path, language, extent).document


def _as_asked(path: Path, language: Language | None, extent: Extent | None) -> tuple[Path, Language, Extent]:
    path = path.resolve()
    return path, language or own_language(path), extent or assignment(path).report.extent


@lru_cache(MOST)
def _case(path: Path, language: Language, extent: Extent) -> Case:
    loaded = assignment(path) if language == own_language(path) else api.load(path, language)
    return opened(loaded.with_extent(extent))


@lru_cache(MOST)
def _written(path: Path, language: Language, extent: Extent) -> Written:
    return _composed(_case(path, language, extent))


def typeset(tree: Written, engine: api.Engine) -> Report:
    """A tree on paper; for LaTeX with what its log says of boxes that are too large."""
    if engine == "latex":
        from reportgen.writers import latex, pdflatex

        source = latex.write(tree.document)
        done = pdflatex.compile(source)
        return Report(tree, engine, source, done.pdf, done.overfull)
    return Report(tree, engine, *api.typeset(tree.document, engine), ())


@cache
def report(path: Path, engine: api.Engine, language: Language) -> Report:
    return typeset(written(path, language), engine)


def walk(blocks: tuple[Block, ...]) -> Iterator[Block]:
    """All blocks in order, those inside lists too."""
    for block in blocks:
        yield block
        if isinstance(block, List):
            for item in block.items:
                yield from walk(item)


def scenes(document: Document) -> Iterator[tuple[str, Scene]]:
    """(figure's key, scene) of every drawing, in printed order; plates that continue a figure have its key."""
    key = ""
    for block in walk(document.blocks):
        if isinstance(block, Figure):
            yield from ((block.key, scene) for scene in block.scenes)
        elif isinstance(block, Plate):
            key = key if block.continues else block.key
            yield key, block.scene
