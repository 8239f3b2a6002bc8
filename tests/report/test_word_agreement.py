"""The Word file says what the PDF says: every number, word and equation in order."""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from unittest import mock

import pytest

from reportgen import document as tree
from reportgen.base.template_folders import search_path
from reportgen.base.units import Language
from reportgen.base.words import load_words
from reportgen.document import Block, Document, Equation, List, Plate, Section, lines_of, plain
from reportgen.document.layout import fits
from reportgen.drawing import Label
from reportgen.formula import Expression, VectorEquation
from reportgen.formula import plain_text as plain_notation
from reportgen.formula.formula_layout import sides
from reportgen.formula.plain_text import Plain
from reportgen.writers import word
from tests.lanes import matrix
from tests.report import built
from tests.report.built import Written
from tests.report.test_report_agreement import compared, numbers
from tests.writers.word_file import WordFile, squash

_STRUCTURE = re.compile(r"[()\[\]|/^_√;:•–]+")
"""What the plain notation of a formula writes where a page has a bar, a fence or a raised letter."""


def bare(text: str) -> str:
    return _STRUCTURE.sub("", squash(text.replace("…", "")))


class Flat(Plain):
    """Formulas as they are set in two dimensions, without the marks of a line."""

    linear = False
    POWER = "%s%s"


def flat(node: Expression, language: Language) -> str:
    if not isinstance(node, VectorEquation):
        # What is wider than its line is opened there.
        return "=".join(map(Flat(language).part, sides(node, language, fits)))
    with mock.patch.object(plain_notation, "Plain", Flat):
        text = plain_notation.formula(node, language)
    # The names of a vector equation's rows stand in each of its storeys.
    return "\n".join(
        [line.removeprefix(f"{name}: ") for line, name in zip(text.split("\n"), ("", *node.rows), strict=True)]
    )


def no_pictures(scenes: Sequence[object]) -> list[tuple[bytes, bytes]]:
    """Pictures of nothing: what they show is no text."""
    return [(b"", b"")] * len(scenes)


@cache
def word_file(path: Path, language: Language) -> WordFile:
    return WordFile(word.write(built.written(path, language).document, no_pictures))


def of(written: Written) -> WordFile:
    return word_file(written.case.assignment.source, written.language)


CONTINUED = re.compile(r"^\S+ [\d.]+ \((tiếp theo|continued|part \d|phần \d)\)$")


def said(file: WordFile) -> str:
    """The text in order but for what only figures have: titles of their parts, captions of what goes on."""
    return "".join(bare(text) for style, text in file.lines if not is_apart(style, text))


def is_apart(style: str, text: str) -> bool:
    match style:
        case "FigureTitle":
            return True
        case "Caption":
            return bool(CONTINUED.match(text))
        case "Known":
            return text in ROW_NAMES
    return False


ROW_NAMES = frozenset(
    name
    for language in built.LANGUAGES
    for table in [load_words(search_path(language))["vector"]]
    for key in ("rows", "force_rows")
    for name in table[key]
)


def expected(document: Document) -> Iterator[tuple[Block, str]]:
    for block in document.blocks:
        if isinstance(block, Plate) and block.continues:
            continue
        with mock.patch.object(tree, "formula", flat):
            yield block, bare("".join(lines_of(block, document)))


def test_the_tree_is_in_the_file_in_order(written: Written) -> None:
    assert_in_order(written.document, of(written))


EXERCISES = sorted((built.ROOT / "assignments" / "plane-motion").glob("*.yaml"))


@pytest.mark.parametrize("language", built.LANGUAGES)
@pytest.mark.parametrize("path", matrix(EXERCISES, EXERCISES[:2]), ids=lambda path: path.stem)
def test_an_exercise_is_in_the_file_in_order(path: Path, language: Language) -> None:
    document = built.document(path, language)
    assert_in_order(document, WordFile(word.write(document, no_pictures)))


SHORT = [(path, language) for path in built.TYPESET for language in built.LANGUAGES]


@pytest.mark.parametrize(
    ("path", "language"), matrix(SHORT, [(built.SAMPLE, "vi")]), ids=lambda one: getattr(one, "stem", one)
)
def test_a_short_report_is_in_the_file_in_order(path: Path, language: Language) -> None:
    document = built.document(path, language, "short")
    assert_in_order(document, WordFile(word.write(document, no_pictures)))


def assert_in_order(document: Document, file: WordFile) -> None:
    """Letter by letter; of a vector equation, whose storeys may be parted, as many of each letter."""
    text, at = said(file), 0
    for block, words in expected(document):
        found = text[at : at + len(words)]
        if has_vectors(block):
            assert Counter(found) == Counter(words), (words, found)
        else:
            assert found == words
        at += len(words)
    assert text[at:] == ""


def has_vectors(block: Block) -> bool:
    match block:
        case Equation(rows):
            return any(isinstance(row, VectorEquation) for row in rows)
        case List(items):
            return any(has_vectors(inner) for item in items for inner in item)
    return False


# --- what python-docx makes of it -----------------------------------------------------------------


def test_headings_are_headings_with_their_numbers(written: Written) -> None:
    headings = [
        (int(style[-1]), squash(text)) for style, text in of(written).lines if re.fullmatch("Heading[123]", style)
    ]
    assert headings == [
        (block.level, squash(f"{block.number}{plain(block.title, written.language)}").replace("_", ""))
        for block in written.document.blocks
        if isinstance(block, Section) and block.level <= 3
    ]


# --- on paper -------------------------------------------------------------------------------------

NUMBER = re.compile(r"\d+(?:[.,]\d+)*")
COVER = frozenset({"Institution", "Title", "Subtitle", "CoverField"})
"""The styles of the cover, which is not compared on paper."""


def counted(texts: Iterable[str]) -> Counter[str]:
    return Counter(number for text in texts for number in NUMBER.findall(unicodedata.normalize("NFKC", text)))


def labels(written: Written) -> Iterator[str]:
    """The texts of drawings, which are pictures in the file."""
    for _, scene in built.scenes(written.document):
        for item in scene.items:
            if isinstance(item, Label):
                content = item.content
                yield content if isinstance(content, str) else plain_notation.formula(content, written.language)


@pytest.mark.parametrize(
    ("path", "language"),
    matrix(built.PRINTED, [*built.BY_BOTH, *built.BY_ONE]),
    ids=lambda one: getattr(one, "stem", one),
)
def test_every_number_of_the_pdf_is_in_the_file_and_no_other(path: Path, language: Language) -> None:
    pytest.importorskip("pymupdf")
    report = built.report(path, "typst", language)
    on_paper = numbers(compared(report))
    in_file = counted(text for style, text in word_file(path, language).lines if style not in COVER)
    assert on_paper.total() > 500
    assert on_paper - in_file - counted(labels(report.written)) == Counter()
    assert in_file - on_paper == Counter()
