"""Every formula of every sample is heard, and drawn from what is heard it is the same formula again."""

from __future__ import annotations

import re
import warnings
from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import cache
from itertools import cycle
from pathlib import Path
from typing import Any
from unittest import mock

import pytest

from reportgen.base.errors import OutputWarning
from reportgen.base.template_folders import languages, search_path
from reportgen.base.units import Language, by_power_of_ten, write
from reportgen.base.words import load_words
from reportgen.document import (
    Block,
    Document,
    Emph,
    Equation,
    Figure,
    Inline,
    InlineMath,
    List,
    Paragraph,
    Plate,
    Section,
    Strong,
    Table,
    Value,
    Words,
    spoken_formulas,
)
from reportgen.formula import Chain, Expression, Symbol, VectorEquation, children
from reportgen.formula.formula_layout import known_of
from reportgen.marking.key_files import key_document
from reportgen.marking.task_paper import task_of
from reportgen.marking.toleranced_key import Ask, key_of
from reportgen.writers import typst, typst_compiler
from reportgen.writers.typst_math import TypstFormulas
from tests.formula.drawn import DIGITS, drawn, in_units, opened
from tests.formula.spoken_reader import Listener
from tests.lanes import matrix
from tests.report import built

SAMPLES = [
    path
    for path in sorted((built.ROOT / "assignments").rglob("*.yaml"))
    if path.parent.name != "atlas"
    and re.search("^(kind|parts):", text := path.read_text(encoding="utf-8"), re.MULTILINE)
    and "\nsalt:" not in text
]
LANGUAGES: tuple[Language, ...] = languages()
TURNS = dict(zip(SAMPLES, cycle(LANGUAGES), strict=False))
"""Every file in one of the languages, by turns; the first of each kind is in all of them."""
PROVED = [turn for turn in TURNS.items() if turn[0] in built.OF_EACH_KIND or turn[0].parent.name == "coursework"]
"""Other files of a kind differ in numbers only."""
STRING = r'"((?:[^"\\]|\\.)*)"'
HEARD = re.compile(rf"\bM\({STRING},\$|#[FAJEV]\({STRING},")


def by_name(name: str) -> Path:
    return built.ROOT / "assignments" / f"{name}.yaml"


def named(path: Path, language: Language) -> Any:
    return pytest.param(
        (path, language), id=f"{path.relative_to(built.ROOT / 'assignments').with_suffix('')}-{language}"
    )


TELLING: list[tuple[Path, Language]] = [
    (by_name("four-bar-01"), "vi"),
    (by_name("cam/knife-01"), "en"),
    (by_name("plane-motion/05"), "vi"),
    (by_name("gears/train-motor"), "en"),
    (by_name("plane-motion/18"), "zh"),
]
"""What is known of vectors, letters that differ in size, a matrix, indices with signs, words without blanks."""


@pytest.fixture(
    scope="module",
    params=matrix(
        [
            named(path, language)
            for path in SAMPLES
            for language in LANGUAGES
            if language == TURNS[path] or path in built.OF_EACH_KIND or (path, language) in TELLING
        ],
        telling=TELLING,
    ),
)
def sample(request: pytest.FixtureRequest) -> tuple[Language, tuple[Document, ...]]:
    """The report of an assignment in a language, its task and its key."""
    path, language = request.param
    return language, documents(path, language)


@cache
def words(language: Language) -> Any:
    return Words.among(load_words(search_path(language)), language).speech


@cache
def listener(language: Language) -> Listener:
    return Listener(words(language), write(0.5, 1, language)[1])


def documents(path: Path, language: Language) -> tuple[Document, ...]:
    case, ask = built.case(path, language), Ask()
    key = key_of(case)
    return (
        built.document(path, language),
        task_of(case, ask.on_paper(key), False, True),
        key_document(ask.of(key), case.title),
    )


@cache
def drawn_from(said: str, language: Language) -> tuple[Any, str]:
    formula, reason = listener(language).read(said)
    return opened(formula), reason


# --- what is printed ------------------------------------------------------------------------------

Printed = tuple[Expression, bool | None]
"""A formula in a line, perhaps with slashed fractions; None for a displayed row."""


def printed(blocks: Iterable[Block]) -> Iterator[list[Printed]]:
    """The formulas of a document in their order, those of one displayed equation together."""
    for block in blocks:
        match block:
            case Equation(rows):
                yield [(row, None) for row in rows]
            case Plate(continues=True):
                pass
            case Section(title=inlines) | Paragraph(inlines) | Figure(caption=inlines) | Plate(caption=inlines):
                yield from in_line(inlines)
            case List(items):
                for item in items:
                    yield from printed(item)
            case Table(head=head, rows=rows, caption=caption):
                for line in (caption, *(cell.inlines for row in (*head, *rows) for cell in row)):
                    yield from in_line(line)


def in_line(inlines: Iterable[Inline]) -> Iterator[list[Printed]]:
    for inline in inlines:
        match inline:
            case InlineMath(expression, slashed):
                yield [(expression, slashed)]
            case Value(number) if by_power_of_ten(number.value, number.decimals):
                yield [(number, False)]
            case Emph(of) | Strong(of):
                yield from in_line(of)


def sides(node: Expression) -> int:
    return len(node.parts) if isinstance(node, Chain) else 1


def heard_in(document: Document) -> list[str]:
    """What is heard of the formulas in the source of a document, in their order."""
    source = typst.write(document)
    return [unescaped(next(filter(None, match.groups()))) for match in HEARD.finditer(source)]


def unescaped(text: str) -> str:
    return re.sub(r"\\(.)", r"\1", text)


def test_what_is_heard_is_drawn_as_it_is_printed(sample: tuple[Language, tuple[Document, ...]]) -> None:
    """Each formula of report, task and key has words of its own in the source, in its place."""
    language, written = sample
    for document in written:
        heard = iter(heard_in(document))
        for formulas in printed(document.blocks):
            if formulas[0][1] is None:
                rows: list[str] = []
                while len(rows) < len(formulas):
                    rows += without_number(next(heard), language).split("; ")
                for (row, _), said in zip(formulas, rows, strict=True):
                    same(row, said, language)
            else:
                ((expression, slashed),) = formulas
                said = next(heard)
                # A chain is heard in the pieces between which its line may break.
                while sides(expression) > 1 and len(drawn_from(said, language)[0]) - 1 < sides(expression):
                    said = f"{said} {next(heard)}"
                same(expression, said, language, bool(slashed))
        assert list(heard) == []


def without_number(said: str, language: Language) -> str:
    """What is heard of an equation, without the number that is heard before it."""
    before, between, _ = re.split(r"\{number\}|\{formula\}", words(language)["numbered"])
    return re.sub(rf"^{re.escape(before)}[\d.]+{re.escape(between)}", "", said)


def same(expression: Expression, said: str, language: Language, slashed: bool = False) -> None:
    if isinstance(expression, VectorEquation):
        same_vectors(expression, said, language)
        return
    formula, reason = drawn_from(said, language)
    assert formula == opened(in_units(drawn(expression, slashed), language)), said
    note = expression.note if isinstance(expression, Chain) else ""
    assert in_signs(reason, language) == in_signs(note, language)


def same_vectors(equation: VectorEquation, said: str, language: Language) -> None:
    """The line first, then of each term of which something is known all that is known, by the names of the rows."""
    line, *facts = said.split(". ")
    assert drawn_from(line, language)[0] == drawn(equation)
    described = [
        term for side in equation.sides for term in side if any(entry != "" for entry in known_of(term, equation))
    ]
    names = "|".join(map(re.escape, sorted(equation.rows, key=len, reverse=True)))
    for term, told in zip(described, facts, strict=True):
        symbol, entries = told.split(": ")
        assert drawn_from(symbol, language)[0] == drawn(term.symbol)
        expected = [
            (row, entry) for row, entry in zip(equation.rows, known_of(term, equation), strict=True) if entry != ""
        ]
        _, *found = re.split(rf"(?:^|, )({names}) ", entries)
        assert found[::2] == [row for row, _ in expected]
        for (_, entry), text in zip(expected, found[1::2], strict=True):
            if entry is None:
                assert text == words(language)["unknown"]
            elif isinstance(entry, str):
                assert in_signs(text, language) == in_signs(entry, language)
            else:
                same(entry, text, language, slashed=True)


def in_signs(text: str, language: Language) -> str:
    """A text with signs for their words and without blanks, as much of it as sounds like signs."""
    table = words(language)
    signs = {said: sign for name in ("letters", "signs") for sign, said in table[name].items()}
    pattern = "|".join(map(re.escape, sorted(signs, key=len, reverse=True)))
    text = re.sub(rf"(?<!\w)({pattern})(?!\w)", lambda match: signs[match[0]], text.translate(DIGITS))
    return re.sub(r"\s", "", text)


# --- symbols --------------------------------------------------------------------------------------


def symbols(node: Expression) -> Iterator[Symbol]:
    if isinstance(node, Symbol):
        yield node
    for child in children(node):
        yield from symbols(child)
    if isinstance(node, VectorEquation):
        known = (entry for side in node.sides for term in side for entry in term.known if entry is not None)
        for entry in known:
            if not isinstance(entry, str):
                yield from symbols(entry)


def test_no_two_symbols_of_a_report_sound_alike(sample: tuple[Language, tuple[Document, ...]]) -> None:
    """What is heard, without capitals, blanks and pauses, belongs to one symbol as it is printed."""
    language, written = sample
    print_of = TypstFormulas(language).symbol
    for document in written:
        speech = spoken_formulas.speech(document)
        prints: defaultdict[str, set[str]] = defaultdict(set)
        for symbol in {
            symbol for formulas in printed(document.blocks) for row, _ in formulas for symbol in symbols(row)
        }:
            prints[re.sub(r"[\s,-]", "", speech.symbol(symbol)).casefold()].add(print_of(symbol))
        assert {said: marks for said, marks in prints.items() if len(marks) > 1} == {}


SHORT = by_name("plane-motion/01")


@pytest.mark.parametrize("of", matrix([named(*turn) for turn in PROVED], telling=[(SHORT, TURNS[SHORT])]))
def test_no_formula_is_without_words(of: tuple[Path, Language]) -> None:
    """The typesetter itself refuses one in a document that all can read; drawings are told elsewhere."""
    pytest.importorskip("typst")
    for document in documents(*of):
        with mock.patch.object(typst, "paint_typst", return_value="box()"):
            source = typst.write(document)
        with warnings.catch_warnings():
            warnings.simplefilter("error", OutputWarning)
            assert typst_compiler.compile(source, standards=("ua-1",)).startswith(b"%PDF")
