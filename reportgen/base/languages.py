"""Settings of a language besides its words: numbers, page and fonts, from `language.yaml` in its folder.

Every folder of templates with such a file is a language; nothing else in the program lists them.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache, lru_cache
from pathlib import Path
from typing import Any, Literal

from reportgen.base.errors import TemplateError
from reportgen.base.records import Record, field
from reportgen.base.template_folders import LANGUAGE_FILE, Language, languages, templates
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, read_own, text_in

DecimalMark = Literal[".", ","]
_LETTERS = re.compile("[^\\W\\d_¹²³⁰-⁹]+")


class TypstSetting(Record):
    """Settings of Typst for the language: its code, perhaps a region, hyphens, and fonts for missing letters.

    `strong` are the fonts for missing letters in headings and bold text, if they differ.
    """

    lang: str = ""
    region: str = ""
    hyphenate: bool = False
    fonts: tuple[str, ...] = ()
    strong: tuple[str, ...] = ()


class WordSetting(Record):
    """Fonts of a Word file: size in points, font, and font for East Asian characters."""

    size: float = 12.0
    font: str = "Times New Roman"
    east_asian: str = ""


class DrawingSetting(Record):
    """Fonts of DXF files: `style` is a stroke font in LibreCAD, `font` the font in all other programs."""

    style: str = "lc_opengost-ar"
    font: str = "arial.ttf"


class PageMargins(Record):
    """Margins around the text of a page (mm)."""

    left: float = 30.0
    right: float = 20.0
    top: float = 22.0
    bottom: float = 20.0

    @property
    def narrow(self) -> bool:
        """True if an A4 page leaves less room than figures and tables are made for."""
        return self.left + self.right > 50 or self.top + self.bottom > 42 or min(self.left, self.right) < 5


class MobilityNotation(Record):
    """Notation of the degree of freedom: 3n − (2t + c) + r − s; or `apart`, 3n − 2t − c, with r and s unless zero.

    The letters are for the freedom, moving links, lower and higher pairs, passive constraints, redundant freedoms.
    """

    letters: tuple[str, ...] = ("W", "n", "t", "c", "r", "s")
    apart: bool = False


class ReadingWords(Record):
    """Words by which a reader of students' reports recognises the meaning of a text.

    In a word, `*` matches any ending; `#` is the place of the number, which otherwise follows the word.
    """

    position: tuple[str, ...] = ()
    """The position that a number belongs to."""
    number: tuple[str, ...] = ()
    """Between that word and the number."""
    joins: tuple[str, ...] = ()
    """Between the numbers of several positions."""
    dead_centre: tuple[str, ...] = ()
    """A position without a number."""
    this_position: tuple[str, ...] = ()
    """Words for the position that the text deals with, or a name that belongs to none, as “position plan”."""
    compared: tuple[str, ...] = ()
    """The text compares with another position."""
    extreme: tuple[str, ...] = ()
    """A value of all positions together."""
    supposed: tuple[str, ...] = ()
    """Before a symbol: its value is an assumption."""
    withdrawn: tuple[str, ...] = ()
    """Behind a number: it is taken back, or another one is as good."""
    clockwise: tuple[str, ...] = ()
    anticlockwise: tuple[str, ...] = ()
    hence: tuple[str, ...] = ()
    """A new clause begins."""
    equals: tuple[str, ...] = ()
    """In place of a sign of equality."""
    prose: tuple[str, ...] = ()
    """Words in Latin letters that may follow a number without a unit and are not units."""
    chapter: tuple[str, ...] = ()
    """A line in bold with one of these names a chapter about the same position."""
    reason: tuple[str, ...] = ()
    """Words at the beginning of a remark in parentheses that explains a number."""
    head: tuple[str, ...] = ()
    """Heads of a table over the names of positions, besides `position`."""


class LanguageSetting(Record):
    """Content of `language.yaml`, with the defaults of the keys that it leaves out.

    `latex` are the font encodings that pdflatex needs, empty if only Typst can set the language. `block` is the
    title block of its drawing sheets. `units` are letters of units, or whole units, as the language writes them,
    and `typed` are other spellings that people type. `reading` has the words of students' reports. `spaced` is True
    if words are separated by blanks. `draft` are the kinds of work whose words no native speaker has read, or True
    for all of them.
    """

    name: str
    code: str
    decimal: DecimalMark
    typst: TypstSetting = TypstSetting()
    latex: tuple[str, ...] = ()
    word: WordSetting = WordSetting()
    drawing: DrawingSetting = DrawingSetting()
    page: PageMargins = PageMargins()
    block: str = "iso"
    units: Mapping[str, str] = field(default_factory=dict)
    typed: Mapping[str, str] = field(default_factory=dict)
    mobility: MobilityNotation = MobilityNotation()
    reading: ReadingWords = ReadingWords()
    spaced: bool = True
    draft: bool | tuple[str, ...] = False

    @property
    def separator(self) -> str:
        """Separator of the arguments of a function and of the items of a list of numbers."""
        return ";" if self.decimal == "," else ","

    @property
    def colon(self) -> str:
        """Separator between a label and the labelled text."""
        return ": " if self.spaced else "："

    @property
    def stop(self) -> str:
        """Mark behind the number of a caption, before its words."""
        return "." if self.spaced else ""

    def aside(self, text: str) -> str:
        """Return a remark in parentheses as it follows a word."""
        return f" ({text})" if self.spaced else f"（{text}）"

    def is_draft(self, kind: str = "") -> bool:
        """Return True if no native speaker has read the words, or those of a kind of work if one is named."""
        return kind in self.draft if isinstance(self.draft, tuple) else self.draft


@cache
def setting_of(language: Language) -> LanguageSetting:
    """Return the settings from the language's file. Raises `TemplateError` with file and line."""
    return read_setting(templates() / language / LANGUAGE_FILE)


def decimal_mark(language: Language) -> DecimalMark:
    """Return the mark before the decimals of a number."""
    return setting_of(language).decimal


class UnitNames(dict[str, str]):
    """Units as a language prints them: some as a whole, others letter by letter, m/s as м/с."""

    def __init__(self, names: Mapping[str, str]) -> None:
        super().__init__(names)
        # A report has thousands of numbers, but few units.
        self._known = dict(names)

    def get(self, unit: str, default: object = None) -> str:
        """Return the printed form of a unit; a unit without another form stays unchanged."""
        if unit not in self._known:
            self._known[unit] = _LETTERS.sub(lambda found: dict.get(self, found[0], found[0]), unit)
        return self._known[unit]


@cache
def unit_names(language: Language) -> UnitNames:
    """Return the units as the language prints them."""
    return UnitNames(setting_of(language).units)


@lru_cache(maxsize=1024)
def common_unit(text: str) -> str:
    """Return a unit typed in any language in the common spelling: м/с as m/s."""
    if text.isascii():
        return text
    names = _typed_names()
    whole = names.get(text, text)
    return _LETTERS.sub(lambda letters: _in_letters(letters[0], names), whole)


@cache
def _typed_names() -> Mapping[str, str]:
    """Return the units by their spellings in any language."""
    settings = [setting_of(language) for language in languages()]
    names = {shown: unit for setting in settings for unit, shown in setting.units.items()}
    return names | {typed: unit for setting in settings for typed, unit in setting.typed.items()}


def typed_units() -> tuple[str, ...]:
    """Return all national spellings of units: non-Latin letters, whole units, and products without a sign, Нм."""
    single = [name for name in _typed_names() if name.isalpha() and not name.isascii()]
    whole = [name for name in _typed_names() if not name.isalpha()]
    products = [force + length for force in single for length in single if _is_moment(force, length)]
    return (*single, *whole, *products)


def _is_moment(force: str, length: str) -> bool:
    names = _typed_names()
    return names[force] in ("N", "kN") and names[length] in ("m", "mm")


def _in_letters(word: str, names: Mapping[str, str]) -> str:
    """Return a word of a unit in Latin letters; of two units without a sign between them, Нм, the product."""
    if word in names:
        return names[word]
    halves = ((word[:n], word[n:]) for n in range(1, len(word)))
    both = next(((first, last) for first, last in halves if first in names and last in names), None)
    return f"{names[both[0]]}·{names[both[1]]}" if both else word


def read_setting(file: Path) -> LanguageSetting:
    """Return the content of a file `language.yaml`. Raises `TemplateError` with file and line for unknown content."""
    text = text_in(file)
    if not isinstance(text, str):
        raise TemplateError(f"{file}: {text.wordless}")
    source = read_own(text, str(file))
    if source.faults:
        raise TemplateError("\n".join(f"{fault.location}: {fault.wordless}" for fault in source.faults))
    setting: LanguageSetting = _table(LanguageSetting, source.top, str(file))
    return setting


_PARTS: Mapping[str, type[Any]] = {
    "typst": TypstSetting,
    "word": WordSetting,
    "drawing": DrawingSetting,
    "page": PageMargins,
    "mobility": MobilityNotation,
    "reading": ReadingWords,
}


def _table(form: type[Any], node: Node | None, place: str) -> Any:
    if not isinstance(node, MappingNode):
        raise TemplateError(f"{node.location if node else place}: a table is wanted here")
    known: Mapping[str, str] = form.__annotations__
    values: dict[str, Any] = {}
    for key, value in node.entries:
        if key.text not in known:
            raise TemplateError(f"{key.location}: {key.text} is no key here; those are {', '.join(known)}")
        part = _PARTS.get(key.text) if form is LanguageSetting else None
        values[key.text] = _table(part, value, place) if part else _value(known[key.text], value)
        if isinstance(values[key.text], PageMargins) and values[key.text].narrow:
            raise TemplateError(f"{value.location}: figures and tables need a page with 160 mm across and 255 mm down")
    try:
        return form(**values)
    except TypeError:
        missing = ", ".join(name for name in ("name", "code", "decimal") if name in known and name not in values)
        raise TemplateError(f"{node.location}: missing: {missing}") from None


def _value(kind: str, node: Node) -> Any:
    """Return a value of the type that a field has."""
    if kind.endswith("tuple[str, ...]") and isinstance(node, SequenceNode):
        if all(isinstance(item, Scalar) for item in node.items):
            return tuple(item.text for item in node.items if isinstance(item, Scalar))
    elif kind.startswith("Mapping") and isinstance(node, MappingNode):
        if all(isinstance(value, Scalar) for _, value in node.entries):
            return {key.text: value.text for key, value in node.entries if isinstance(value, Scalar)}
    elif isinstance(node, Scalar):
        match kind:
            case "str":
                return node.text
            case "float":
                try:
                    return float(node.text)
                except ValueError:
                    pass
            case "DecimalMark":
                if node.text in (".", ","):
                    return node.text
            case "tuple[str, ...]":
                if node.text == "none":
                    return ()
            case _:
                if node.text in ("true", "false"):
                    return node.text == "true"
    wanted = {
        "str": "a text",
        "float": "a number",
        "DecimalMark": "a point or a comma in quotation marks",
        "bool": "true or false",
        "tuple[str, ...]": "a list, or none",
        "Mapping[str, str]": "a table of texts",
    }
    raise TemplateError(f"{node.location}: {wanted.get(kind, 'true, false or a list')} is wanted here")


__all__ = ["DecimalMark", "Language", "LanguageSetting", "decimal_mark", "languages", "read_setting", "setting_of"]
