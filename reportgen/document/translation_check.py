"""Check that a language translates everything in the reference language: files, sections and short words.

Sections are compared by everything that does not depend on a language: the names that they call and print, the figures
and sections that they refer to, their formulas, the levels of their headings. Words are compared by their keys and
placeholders. Each difference is a fault with its file and line.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from pathlib import Path
from typing import Any

from jinja2 import Environment, nodes

from reportgen.base.errors import Fault, Location, TemplateError
from reportgen.base.field_words import CHOICES
from reportgen.base.field_words import SECTION as FIELDS
from reportgen.base.kinds import SAMPLE
from reportgen.base.languages import MobilityNotation, read_setting
from reportgen.base.placeholders import gaps
from reportgen.base.records import Record, replace
from reportgen.base.template_folders import LANGUAGE_FILE, MACHINES, REFERENCE, TOPICS, templates
from reportgen.base.words import MESSAGES_SECTION, SECTION, Passage, sections
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, Source, plain, read_own, text_in

GLOSSARY = "glossary.yaml"
TABLES = frozenset({SECTION, FIELDS, CHOICES, MESSAGES_SECTION})
"""Sections that are tables of words: short words, names of keys and of choices, messages."""
MESSAGES = frozenset({"messages.yaml", "help.yaml", "fields.yaml"})
"""Files whose missing words are taken from the reference language."""
MOBILITY = "mobility_line()"
"""Call that prints the formula of mobility, whose letters depend on the language."""
LETTERED = frozenset({"symbol()", "letters()"})
"""Calls that print the letter of a quantity in the language, where the reference has a formula."""
GRAMMAR = frozenset({"loop", "lowered", "turn_words", "words"})
"""Names that only fit a word into a sentence."""
FREE_LISTS = frozenset({"columns", "dates", "judgements", "counted", "hidden_names"})
"""Keys whose lists may have any number of words: accepted forms, singular and plural."""
ONE_SIDED = frozenset({("cover", "months"), ("units",), ("symbols",), ("frame", "pieces"), ("texts",)})
"""Tables whose keys a language may choose freely, for example for dates that count the month."""
_REFERENCE = re.compile(r"@((?:fig|tab|sec|eq)\.[\w.-]*\w)", re.ASCII)
_FORMULA = re.compile(r"\$([^$\n]+)\$")
_HEADING = re.compile(r"(?m)^(#+) ")
_LETTERS = re.compile(r"[^\W\d_]{2}")
_IN_BRACES = re.compile(r"\{[{%#].*?[%}#]\}", re.DOTALL)
ENDINGS = (0, 0, 0, 0, 1, 1, 2, 2, 3, 3, 3, 4, 4, 5)
"""Number of letters of a word that may be an ending, by the word's length."""

MissingLetters = Callable[[str], str]
"""Function that returns the given letters that no font has."""


def faults(folder: Path, lacking: MissingLetters | None = None) -> Iterator[Fault]:
    """Yield the differences between a language's folder and the reference language.

    Files of kinds and topics that are not begun are not a fault; one that is begun is compared completely. Raise
    `TemplateError` for files that cannot be read.
    """
    letters = frozenset((*read_setting(folder / LANGUAGE_FILE).mobility.letters, *MobilityNotation().letters))
    reference = templates() / REFERENCE
    own, wanted = _files(folder), _files(reference)
    needed = {name for name in wanted if not name.startswith((f"{MACHINES}/", f"{TOPICS}/"))} - MESSAGES
    yield from _differences("file", own, needed | own & wanted, Location(str(folder)))
    terms = _terms(folder.name)
    for name in sorted(own & wanted - {LANGUAGE_FILE}):
        file = folder / name
        if file.suffix == ".md":
            yield from _sections(file, reference / name, terms, letters)
        else:
            differences = _tables(_read(file), _read(reference / name))
            yield from map(_untranslated, differences) if name in MESSAGES else differences
        if lacking is not None:
            yield from _lines_of(file, lacking)


def _untranslated(fault: Fault) -> Fault:
    """Return the fault with the code for a missing message, which appears in the reference language."""
    return replace(fault, code="words-untranslated") if fault.code == "words-missing" else fault


def _files(folder: Path) -> set[str]:
    paths = (path for path in folder.rglob("*") if path.is_file() and path.suffix in (".md", ".yaml"))
    return {path.relative_to(folder).as_posix() for path in paths}


def _differences(what: str, own: Set[str], wanted: Set[str], location: Location) -> Iterator[Fault]:
    """Yield faults for names that are missing here, and for names that the reference language does not have."""
    for code, names in (("words-missing", wanted - own), ("words-beyond", own - wanted)):
        if names:
            yield Fault(code, location, {"expected": f"{what} of words", "place": ", ".join(sorted(names))})


# --- sections ---------------------------------------------------------------------------------------


def _sections(file: Path, model: Path, terms: Terms, free: Set[str]) -> Iterator[Fault]:
    """Yield the differences between two files of sections; `free` letters are those of the formula of mobility."""
    own, wanted = sections(file), sections(model)
    yield from _differences("section", own.keys(), wanted.keys(), Location(str(file)))
    for name in (name for name in wanted if name in own):
        here, there = own[name], wanted[name]
        if name in TABLES:
            differences = _tables(_read_in(here), _read_in(there), here.line)
            yield from map(_untranslated, differences) if name == MESSAGES_SECTION else differences
        elif name != SAMPLE:
            yield from _compared(here, there, free)
            yield from terms.faults(here, there)


def _compared(here: Passage, there: Passage, free: Set[str]) -> Iterator[Fault]:
    """Yield the differences between a section and the same section of the reference."""
    location, own, wanted = Location(str(here.file), here.line), SectionContents.of(here), SectionContents.of(there)
    if MOBILITY not in wanted.calls:
        free = frozenset()
    # Where the letter of a quantity is the language's own, a template asks for it.
    asked = LETTERED & own.calls - wanted.calls
    free |= asked | {call.removesuffix("()") for call in asked} | (wanted.formulas if asked else frozenset())
    for what in ("call", "name", "reference", "formula"):
        of_own, of_reference = (frozenset(getattr(one, f"{what}s")) - free for one in (own, wanted))
        yield from _differences(what, of_own, of_reference, location)
    if own.headings != wanted.headings:
        yield Fault("words-headings", location, {"place": _marks(own.headings), "known": _marks(wanted.headings)})
    for line, text in own.in_braces:
        yield Fault("words-in-braces", Location(str(here.file), here.line + line), {"text": text})


def _marks(levels: Iterable[int]) -> str:
    return " ".join("#" * level for level in levels) or "–"


class SectionContents(Record):
    """Language-independent contents of a section, and the words inside its braces, by their lines."""

    calls: frozenset[str]
    names: frozenset[str]
    references: frozenset[str]
    formulas: frozenset[str]
    headings: tuple[int, ...]
    in_braces: tuple[tuple[int, str], ...]

    @staticmethod
    def of(section: Passage) -> SectionContents:
        """Return the contents of a section; raise `TemplateError` for syntax that Jinja cannot read."""
        tree = parsed(section)
        text = "".join(data.data for data in tree.find_all(nodes.TemplateData))
        calls: set[str] = set()
        names: set[str] = set()
        for node in tree.find_all(nodes.Node):
            match node:
                case nodes.Call(node=nodes.Name(name=name)) if name not in GRAMMAR:
                    calls.add(f"{name}()")
                case nodes.Const(value=str(value)) if re.fullmatch(r"[a-z]+\.[\w.]*", value):
                    calls.add(value)
                case nodes.For():
                    calls.add("for")
                case nodes.Include():
                    calls.add("include")
                case nodes.Output(nodes=parts):
                    names |= {name.name for part in parts for name in _names(part)}
        return SectionContents(
            frozenset(calls),
            frozenset(names - GRAMMAR),
            frozenset(_REFERENCE.findall(text)),
            frozenset(_FORMULA.findall(text)),
            tuple(len(marks) for marks in _HEADING.findall(text)),
            tuple((leaf.lineno, leaf.value) for leaf in _words_in_braces(tree)),
        )


def parsed(section: Passage) -> nodes.Template:
    """Return a section as Jinja parses it; raise `TemplateError` with its line for a syntax error."""
    from jinja2 import TemplateSyntaxError

    try:
        # It is read and never rendered.
        return Environment(autoescape=True).parse(section.text)
    except TemplateSyntaxError as error:
        raise TemplateError(f"{section.file}:{section.line + error.lineno}: {error.message}") from error


def _names(part: nodes.Node) -> Iterator[nodes.Name]:
    """Yield the names that are printed, without those of conditions: a language may distinguish other cases."""
    if isinstance(part, nodes.Name):
        yield part
    visible = (part.expr1, part.expr2) if isinstance(part, nodes.CondExpr) else part.iter_child_nodes()
    for inner in visible:
        if inner is not None:
            yield from _names(inner)


def _words_in_braces(tree: nodes.Template) -> Iterator[nodes.Const]:
    """Yield texts with words that a template prints from inside its braces, where they cannot be translated."""
    for node in tree.find_all((nodes.Output, nodes.Assign)):
        parts = node.nodes if isinstance(node, nodes.Output) else [*node.find_all(nodes.Expr)][1:2]
        yield from (leaf for part in parts for leaf in _printed(part))


def _printed(part: nodes.Node) -> Iterator[nodes.Const]:
    match part:
        case nodes.Const(value=str(value)):
            # An option of the command line is a name.
            if _LETTERS.search(value) and not value.startswith("--"):
                yield part
        case nodes.TemplateData() | nodes.Call() | nodes.Compare() | nodes.Getitem() | nodes.Test():
            return
        case _:
            for inner in part.iter_child_nodes():
                yield from _printed(inner)


# --- tables of words --------------------------------------------------------------------------------


def _read(file: Path) -> Source:
    text = text_in(file)
    if isinstance(text, Fault):
        raise TemplateError(f"{file}: {text.wordless}")
    return _sound(read_own(text, str(file)), 0)


def _read_in(section: Passage) -> Source:
    return _sound(read_own(section.text, str(section.file)), section.line)


def _sound(source: Source, above: int) -> Source:
    if source.faults:
        first = source.faults[0]
        raise TemplateError(f"{source.file}:{first.location.line + above}: {first.wordless}")
    return source


def read_table(file: Path) -> Mapping[str, Any]:
    """Return a file of words; raise `TemplateError` if it is not a table."""
    return _plain(_read(file))


def read_words_in(section: Passage) -> Mapping[str, Any]:
    """Return the words in a section; raise `TemplateError` if it is not a table of words."""
    return _plain(_read_in(section))


def _plain(source: Source) -> Mapping[str, Any]:
    table: Mapping[str, Any] = plain(source.top) if isinstance(source.top, MappingNode) else {}
    return table


def _tables(own: Source, wanted: Source, above: int = 0) -> Iterator[Fault]:
    """Yield the differences between two tables of words; the first begins below line `above` of its file."""
    if own.top is not None and wanted.top is not None:
        yield from _node(own.top, wanted.top, (), above)


def _node(
    own: Node,
    wanted: Node,
    where: tuple[str, ...],
    above: int,
    around: tuple[Set[str], ...] = (frozenset(), frozenset()),
) -> Iterator[Fault]:
    """Yield the differences at a place of two tables; `around` are the gaps of the surrounding texts in each of
    them.
    """
    location = Location(own.location.file, own.location.line + above, own.location.column)
    match own, wanted:
        case MappingNode(), MappingNode():
            if where in ONE_SIDED:
                return
            here, there = ({key.text: value for key, value in table.entries} for table in (own, wanted))
            optional = {one[-1] for one in ONE_SIDED if one[:-1] == where}
            yield from _differences("key", here.keys() & there.keys() - optional, there.keys() - optional, location)
            if idle := here.keys() - there.keys() - optional:
                yield Fault("words-idle", location, {"place": ", ".join(sorted(idle))})
            near = (around[-1], frozenset(_all_gaps(wanted)) if where else frozenset())
            for key in (key for key in there if key in here):
                yield from _node(here[key], there[key], (*where, key), above, near)
        case SequenceNode(), SequenceNode():
            if not FREE_LISTS & {*where} and len(own.items) != len(wanted.items):
                yield Fault("words-list", location, {"count": str(len(own.items)), "known": str(len(wanted.items))})
            for here_item, there_item in zip(own.items, wanted.items, strict=False):
                yield from _node(here_item, there_item, where, above, around)
        case Scalar(), Scalar():
            if not FREE_LISTS & {*where}:
                here_gaps, there_gaps = _gaps(own, location), _gaps(wanted, wanted.location)
                # A language may name again what its neighbours name.
                known = here_gaps & frozenset().union(*around)
                yield from _differences("gap", here_gaps - (known - there_gaps), there_gaps, location)
        case _ if not FREE_LISTS & {*where}:
            yield Fault("words-form", location, {"place": ".".join(where)})


def _all_gaps(node: Node) -> Iterator[str]:
    match node:
        case MappingNode(entries):
            for _, value in entries:
                yield from _all_gaps(value)
        case SequenceNode(items):
            for item in items:
                yield from _all_gaps(item)
        case Scalar():
            yield from _gaps(node, node.location)


def _gaps(said: Scalar, location: Location) -> frozenset[str]:
    """Return the placeholders of a word, in whatever form: {Shaft} as {shaft}, {month_name} as {month}."""
    try:
        return frozenset(gap.casefold().removesuffix("_name") or gap for gap in gaps(said.text))
    except ValueError as error:
        raise TemplateError(f"{location}: {error}") from error


# --- letters ----------------------------------------------------------------------------------------


MOST_LETTERS = 12
"""Largest number of letters without a font that are reported singly; with more, a font is missing: reported once."""


def _lines_of(file: Path, lacking: MissingLetters) -> Iterator[Fault]:
    """Yield the lines of a file with letters that no font has, or its first line alone."""
    text = file.read_text(encoding="utf-8")
    letters = "".join({letter: None for letter in text if unicodedata.category(letter)[0] in "LNPS"})
    missing = frozenset(lacking(letters))
    for number, line in enumerate(text.splitlines() if missing else (), start=1):
        if strange := [letter for letter in dict.fromkeys(line) if letter in missing]:
            yield Fault("words-letters", Location(str(file), number), {"text": " ".join(strange)})
            if len(missing) > MOST_LETTERS:
                return


# --- terms ------------------------------------------------------------------------------------------


class Terms(Record):
    """Terms of the glossary in a language: for each, its name in the language of reference, as it is found in a
    text, and the language's names, any of which will do.
    """

    names: Mapping[str, tuple[re.Pattern[str], Mapping[str, re.Pattern[str]]]]

    def faults(self, here: Passage, there: Passage) -> Iterator[Fault]:
        """Yield a fault for each glossary term of a reference section that this section translates differently."""
        wanted, text = (_IN_BRACES.sub(" ", section.text) for section in (there, here))
        for term, (in_reference, own) in self.names.items():
            if in_reference.search(wanted) and not any(pattern.search(text) for pattern in own.values()):
                location = Location(str(here.file), here.line)
                yield Fault("words-term", location, {"text": term, "known": ", ".join(own)})


def _terms(language: str) -> Terms:
    """Return the terms of the glossary in a language; none for the reference language."""
    top = _read(templates() / GLOSSARY).top
    table = plain(top)["terms"] if isinstance(top, MappingNode) else {}
    names_of: dict[str, tuple[re.Pattern[str], Mapping[str, re.Pattern[str]]]] = {}
    for term, names in table.items():
        own = names.get(language, ())
        if listed := [own] if isinstance(own, str) else own:
            in_reference = re.compile(rf"\b{re.escape(term)}(s|es)?\b", re.IGNORECASE)
            names_of[term] = in_reference, {name: _inflected(name) for name in listed}
    return Terms(names_of)


def _inflected(name: str) -> re.Pattern[str]:
    """Return a pattern for any form of a name.

    Long words may have other endings, and up to three words may lie between two.
    """
    stems = [re.escape(word[: len(word) - ENDINGS[min(len(word), len(ENDINGS) - 1)]]) for word in name.split()]
    begins = r"\b" if name[:1] < "\u2e80" else ""
    return re.compile(begins + r"\w*\W+(?:\w+\W+){0,3}?".join(stems), re.IGNORECASE)
