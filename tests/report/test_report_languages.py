"""Both languages say the same, piece by piece; nothing is said of what is not shown, nor shown unsaid."""

from __future__ import annotations

import errno
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, get_args

import pytest

from reportgen.base.kinds import SAMPLE, program_kinds
from reportgen.base.records import field_names
from reportgen.base.template_folders import kind_file, search_path
from reportgen.base.units import Language
from reportgen.base.words import SECTION, Passage, load_words, sections
from reportgen.document import (
    Block,
    Cover,
    Emph,
    Equation,
    Figure,
    InlineMath,
    Inlines,
    List,
    Paragraph,
    Reference,
    Section,
    Strong,
    Table,
    Value,
    Words,
    plain,
)
from reportgen.document.numbering import unreferenced
from reportgen.document.translation_check import FREE_LISTS, SectionContents
from reportgen.formula import vocabulary
from reportgen.formula.plain_text import formula
from reportgen.machine import DyadKind
from reportgen.page.kind_cards import REST, cards
from tests.lanes import matrix
from tests.report import built
from tests.report.built import Written

TEMPLATES = built.ROOT / "templates"
KINDS = pytest.mark.parametrize("path", matrix(built.TYPESET, built.TELLING), ids=lambda path: path.stem)


# --- the tree -------------------------------------------------------------------------------------


def said(inlines: Inlines) -> set[object]:
    """The formulas, numbers and references of a line; how often and in which order is the language's."""
    result: set[object] = set()
    for inline in inlines:
        match inline:
            case InlineMath(expression):
                result.add(re.sub(r"[,.]|vg/ph|rpm", "", in_english(formula(expression, "en"))))
            case Value(number):
                result.add(number.printed)
            case Reference(key):
                result.add(key)
            case Emph(of) | Strong(of):
                result |= said(of)
    return result


INDICES = [load_words(search_path(language))["symbols"] for language in built.LANGUAGES]
IN_ENGLISH = dict(zip(INDICES[0].values(), (INDICES[1][name] for name in INDICES[0]), strict=True))


def in_english(formula: str) -> str:
    """A formula with its indices in English: J_tt2 as J_r2."""
    return re.sub(
        r"(?<=[_^])[\w,]+",
        lambda index: re.sub("[^\\W\\d_A-Z]+", lambda w: IN_ENGLISH.get(w[0], w[0]), index[0]),
        formula,
    )


def shape(block: Block) -> tuple[Any, ...]:
    """What of a block must be the same in every language."""
    name = type(block).__name__
    match block:
        case Section(level, title, key, numbered, number):
            return (name, level, key, numbered, number, said(title))
        case Paragraph(inlines):
            return (name, said(inlines), bool(plain(inlines, "en")))
        case List(items, ordered):
            return (name, ordered, [len(item) for item in items])
        case Equation(rows, key, number):
            return (name, key, number, [type(row).__name__ for row in rows])
        case Table(columns, head, rows, _, key, number):
            cells = [[cell.span for cell in row] for row in (*head, *rows)]
            return (name, key, number, len(columns), cells, [said(c.inlines) for row in rows for c in row])
        case Figure(scenes, _, key, number):
            return (name, key, number, len(scenes))
        case Cover(fields=entries, institution=institution):
            return (name, len(entries), len(institution))
        case _:
            return (name, getattr(block, "key", ""), getattr(block, "number", ""))


@KINDS
def test_both_languages_have_the_same_blocks(path: Path) -> None:
    vi, en = (built.written(path, language).document for language in ("vi", "en"))
    for first, second in zip(built.walk(vi.blocks), built.walk(en.blocks), strict=True):
        assert shape(first) == shape(second)


def sentences(text: str) -> int:
    """Ends of sentences; the English abbreviations Fig., Figs. and Eq. are none."""
    return len(re.findall(r"(?<!\bFig)(?<!\bFigs)(?<!\bEq)[.?!](?=\s|$)", text))


@KINDS
def test_both_languages_have_the_same_sentences(path: Path) -> None:
    """As many in every paragraph, and neither language twice as long as the other."""
    vi, en = (
        [
            plain(block.inlines, language)
            for block in built.walk(built.written(path, language).document.blocks)
            if isinstance(block, Paragraph)
        ]
        for language in built.LANGUAGES
    )
    assert [(a, b) for a, b in zip(vi, en, strict=True) if sentences(a) != sentences(b)] == []
    assert [(a, b) for a, b in zip(vi, en, strict=True) if len(a) > 60 and not 0.5 < len(b) / len(a) < 2] == []


def test_every_figure_and_table_is_referred_to(written: Written) -> None:
    """But for the further sheets of a figure or table, whose key is that of the first with its number."""
    assert [key for key in unreferenced(written.document) if not re.search(r"\.[2-9]\d*$", key)] == []


# --- templates ------------------------------------------------------------------------------------


def templates(language: str) -> dict[str, Path]:
    folder = TEMPLATES / language
    return {str(path.relative_to(folder)): path for path in folder.rglob("*") if path.is_file()}


def test_every_template_has_its_twin() -> None:
    assert templates("vi").keys() == templates("en").keys()


FILES = sorted(name for name in templates("vi") if name.endswith(".md"))


@pytest.mark.parametrize("name", FILES)
def test_twins_have_the_same_sections_in_the_same_order(name: str) -> None:
    vi, en = (list(sections(templates(language)[name])) for language in ("vi", "en"))
    assert vi == en


def called_sections(file: Path) -> dict[str, Passage]:
    """The sections of a file that are templates."""
    return {name: each for name, each in sections(file).items() if name not in {SECTION, SAMPLE}}


@pytest.mark.parametrize("name", FILES)
def test_twins_call_the_same(name: str) -> None:
    vi, en = (called_sections(templates(language)[name]) for language in ("vi", "en"))
    assert [
        section for section in vi if SectionContents.of(vi[section]).calls != SectionContents.of(en[section]).calls
    ] == []


def leaves(words: Mapping[str, Any], above: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    for key, value in words.items():
        if isinstance(value, Mapping):
            yield from leaves(value, (*above, key))
        else:
            yield (*above, key), value


def shape_of_words(words: Mapping[str, Any]) -> set[tuple[Any, ...]]:
    """Each word by its keys, a list by its length; in how many ways something may be read is its own affair."""
    counted = (keys[0] not in FREE_LISTS for keys, _ in leaves(words))
    return {
        (*keys, len(value) if isinstance(value, list) and same else "")
        for same, (keys, value) in zip(counted, leaves(words), strict=True)
    }


ONE_SIDED = {("cover", "months")}
"""English dates name the month; Vietnamese ones count it."""


SHOWN_WHOLE = {("server", table) for table in ("downloads", "errors", "file_names", "filters", "student_fields")}
"""Tables whose entries a page of the server lists, or looks up by the name of a file or an error."""


@pytest.mark.parametrize("name", ["words.yaml", "messages.yaml", *program_kinds()])
def test_both_languages_have_the_same_words(name: str) -> None:
    vi, en = (shape_of_words(built_words(language, name)) for language in ("vi", "en"))
    assert {keys for keys in vi ^ en if keys[:-1] not in ONE_SIDED} == set()


def built_words(language: Language, name: str) -> Mapping[str, Any]:
    """The words of a file, or of the section of a kind."""
    import yaml

    file = TEMPLATES / language / name
    text = file.read_text(encoding="utf-8") if file.suffix else sections(kind_file(language, name))[SECTION].text
    words: Mapping[str, Any] = yaml.safe_load(text)
    return words


def test_every_word_is_used() -> None:
    """Where the code reads a table by a computed key, the table's keys are those that can be computed."""
    frames = [path for name in ("html", "server") for path in (TEMPLATES / "frames" / name).iterdir()]
    sources = [*(built.ROOT / "reportgen").rglob("*.py"), *frames]
    called = [section.text for file in TEMPLATES.rglob("*.md") for section in called_sections(file).values()]
    code = "\n".join([*(path.read_text(encoding="utf-8") for path in sources), *called])
    words = load_words(search_path("en"))
    assert words["document"].keys() | {"speech", "phrases"} == {*field_names(Words)}
    assert words["groups"].keys() == {*get_args(DyadKind), "3RRR"}
    assert words["joints"].keys() == {"R", "P"}
    computed = {"document", "groups", "joints", "zero", "meanings", "main_figures", "symbols", "quantities", "positive"}
    computed |= {"acting_loads", "given_of_crank", "given_of_topics", "speech"}
    # A direction along or across a slide, which is a slot or a guide.
    slides = {("vector", f"{how}_{slide}") for how in ("along", "across") for slide in ("slot", "guide")}
    assert slides <= {keys for keys, _ in leaves(words)}
    # Reasons of the system go by the names of its errors, groups of kinds by the words of the kinds.
    groups = {REST, *cards("en")}
    unused = [
        keys
        for keys, _ in leaves(words)
        if keys[0] not in computed
        and keys not in slides
        and not (keys[:2] == ("edit", "groups") and keys[2] in groups)
        and not (keys[:2] == ("edit", "reasons") and hasattr(errno, keys[2]))
        and keys[:2] not in SHOWN_WHOLE
        and not re.search(rf"[\"'.]{keys[-1]}\b", code)
    ]
    assert unused == []


@pytest.mark.parametrize("table", matrix(["meanings", "zero", "positive"], []))
def test_every_name_of_quantities_is_that_of_one(table: str) -> None:
    """Each name in a key of these tables, common or a machine's own, is that of a quantity that the words are for."""
    names: dict[str, set[bool]] = {}
    # No example has a linkage with each kind of group, nor joints that rub in a machine in true motion.
    rare = [*(built.ROOT / "tests" / "broken" / "files").glob("dyad*.yaml"), built.ROOT / "tests/friction/motion.yaml"]
    samples = built.ROOT / "assignments"
    for path in (*samples.glob("*.yaml"), *samples.glob("balancing/*.yaml"), *samples.glob("linkage/*.yaml"), *rare):
        case = built.case(path, "en")
        for kind in ("", case.assignment.kind):
            for name in (name for key in _own(table, kind) for name in key.split(", ")):
                fits = (
                    any(vocabulary.words_of({name: "said"}, one.id, one.kind, one.symbol))
                    for one in case.ledger.families.values()
                )
                names.setdefault(f"{kind} {name}", set()).add(any(fits))
    assert [name for name, fits in names.items() if True not in fits] == []


def _own(table: str, kind: str) -> Mapping[str, str]:
    """A table of the common words or of a machine's own."""
    import yaml

    path = TEMPLATES / "en" / kind / "words.yaml"
    words = yaml.safe_load(path.read_text(encoding="utf-8")) if path.is_file() else {}
    own: Mapping[str, str] = words.get(table, {})
    return own
