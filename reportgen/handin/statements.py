"""Statements of a running text: a symbol, “=”, and what it comes to, with the position that it holds for.

A statement begins at a symbol before “=” where no operator stands in front, and goes on over “⇒”, commas and
paragraphs that begin with “=”.  Its value is the number behind its last “=”.  The key decides which symbols there are,
never what a number is.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from reportgen.handin.numbers import NUMBER, UNIT
from reportgen.handin.reading_words import HAN, any_of, label_of, labelled_position
from reportgen.handin.symbols import Symbols, bare
from reportgen.handin.word_text import OBJECT

RELATION = re.compile("[=≈]")
POSITION = labelled_position()
_SEVERAL = re.compile(
    rf"{any_of('position')}[\s(]*(?:{any_of('number', whole=False)}\s*)?\d+′*"
    rf"\s*(?:[,;&–÷…-]|{any_of('joins', whole=False)}|\.\.\.)\s*\d",
    re.IGNORECASE,
)
_COMPARED = re.compile(any_of("compared"), re.IGNORECASE)
SAYS_POSITION = re.compile(any_of("position", "dead_centre"), re.IGNORECASE)
_THIS = re.compile(any_of("this_position"), re.IGNORECASE)
_SUPPOSED = re.compile(any_of("supposed", "extreme"), re.IGNORECASE)
"""Words before a symbol: what is tried, or is of no position, as a greatest value."""
_WITHDRAWN = re.compile(any_of("withdrawn", "extreme"), re.IGNORECASE)
"""Words behind a number that take it back, or leave another one open."""
_REASON = re.compile(rf"\(\s*{any_of('reason')}[^()]*\)", re.IGNORECASE)
CLOCKWISE = re.compile(f"{any_of('clockwise')}|↻", re.IGNORECASE)
ANTICLOCKWISE = re.compile(f"{any_of('anticlockwise')}|↺", re.IGNORECASE)

BEHIND = 80
"""Characters in front of a symbol that tell whether a statement begins at it."""
_LETTERS = rf"(?:[^\W_{HAN}]|′)"
_SYMBOL = (
    rf"[^\W\d_{HAN}]{_LETTERS}{{0,24}}+"
    rf"(?:[_^]\{{(?:[^{{}}]{{1,24}}+|\{{[^{{}}]{{0,24}}\}}){{0,4}}+\}}|\^\([^()\s]{{1,3}}\)|[_^]{_LETTERS}{{1,24}}+){{0,4}}+′{{0,3}}"
)
"""No symbol is longer, so that a line is looked through once."""
_APART_FROM = rf"(?<![^\W{HAN}])(?<![′_^{{}}])"
"""No letter of another symbol stands in front."""
_HEAD = re.compile(
    rf"{_APART_FROM}(\|\s*)?({_SYMBOL})(\s*\|)?\s*(\([0-9]{{1,3}}[a-z]?′*\))?\s*(?:[\[(]\s*({UNIT})\s*[\])])?\s*(?=[=≈])"
)
_OPERATORS = frozenset("+-–·*/×(√^_=≈{∑÷|[")
_FUNCTION = re.compile(
    r"(?<![^\W\d_])(?:sin|cos|tan|tg|cot|cotg|arcsin|arccos|arctan|arctg|log|ln|exp)\s*$", re.IGNORECASE
)
_LOOSE_NUMBER = re.compile(r"(?:[\d})²³]|(?<![^\W\d_])[^\W\d_])$")
"""A number or a letter alone, which may be a factor of the symbol behind it."""
_COLON = re.compile(rf"{_APART_FROM}({_SYMBOL}(?:\(\d\))?)\s*(?::|{any_of('equals')})\s*({NUMBER})(?![\w′]*\s*[=≈])")
_SEPARATORS = frozenset(".,;:⇒→<>≤≥!?")
_BULLET = re.compile(r"\s*(?:[-–+•*▪►✓]|\(?\w{1,3}[.)]|\(?\d{1,2}(?:\.\d{1,2})*[.)])\s+")
_WORD = re.compile(rf"(?:[^\W\d_]{{2,}}|[{HAN}])$")
_COMPLETE = re.compile(rf"{NUMBER}\s*(?:{UNIT}|[(\[]\s*{UNIT}\s*[)\]])[.,]?$")
_APART = re.compile(
    rf"(?:;|\n|⇒|=>|→|(?<!\(){any_of('hence')}|,\s+(?=[^\d\s])|\.\s+(?=[^\W\d]))(?!\s*[=≈])", re.IGNORECASE
)
_TAIL = re.compile(
    rf"\s*({NUMBER})\s*(?:[(\[]\s*({UNIT})\s*[)\]]|({UNIT}))?\s*[.,;:]?\s*((?:\([^()=\d][^()=]*\)|[^()=\d]*)\s*[.,;:]?)"
    r"(?:(?<=\s)\s*[(\[]\d{1,2}(?:[.-]\d{1,3})*[a-z]?[)\]][.,;]?)?\s*"
)
_LISTED = re.compile(r"\s*[;→\n]\s*[-+–]?\s*\d")
_PROSE = re.compile(rf"\s*(?:$|[.,;:(]|[^\W\d_]*[^\x00-\x7f\W\d_][^\W\d_]*\b|{any_of('prose')})", re.IGNORECASE)
"""How words begin behind a number without a unit that are no unit themselves."""
_NAMES = re.compile(
    r"[^\W\d_](?:[^\W_]|′)*+(?:[_^]\{[^{}]{0,40}\}|_++(?:[^\W_]|′)*+|\^(?:[^\W_]|′)++)*+|[_^]\{[^{}]{0,40}\}"
)
_GIVEN = re.compile(rf"\s*{NUMBER}\s*(?:{UNIT}(?![\w/])|[;÷±…]|\s[^\W\d_]{{2,}})")
"""A number that was meant as a value, whatever stands behind it."""
_FUNCTIONS = frozenset({"sin", "cos", "tan", "tg", "cotg", "arctan", "arcsin", "arccos", "arctg", "π", "pi", "x"})


@dataclass(frozen=True, slots=True)
class Statement:
    """A symbol and all up to the next one.

    `lead` stands in front of it, from the end of the clause before it, `front` from the last “=” on; `text` stands
    behind it, from index `at` on.  `doubt` says that it runs together with another one.
    """

    symbol: str
    lead: str
    front: str
    text: str
    at: int
    barred: bool = False
    doubt: bool = False
    label: str = ""
    """Of the position that stands right behind the symbol, v_B(3)."""
    unit: str = ""
    """What stands there as well, v_B (m/s)."""

    @property
    def clauses(self) -> list[str]:
        """Its text in pieces, of which the first is its own."""
        return _APART.split(self.text)


@dataclass(frozen=True, slots=True)
class StatedValue:
    """The number of a statement: its text and unit as written, its index in the line, the words behind it."""

    number: str
    unit: str
    at: int
    words: str

    @property
    def withdrawn(self) -> bool:
        if not self.unit and not _PROSE.match(self.words):
            return True
        words = _REASON.sub("", self.words)
        compares = SAYS_POSITION.search(words) and _COMPARED.search(words)
        return bool(_WITHDRAWN.search(words) or compares)

    @property
    def text(self) -> str:
        return f"{self.number.strip()} {self.unit}".strip()


def statements(text: str, symbols: Symbols) -> list[Statement]:
    """The statements of a line in their order, those of unknown symbols too: they end what stands before them."""
    heads: list[tuple[re.Match[str], bool]] = []
    for match in _HEAD.finditer(text):
        kind = _begins(text, match, symbols, heads[-1][0] if heads else None)
        if kind:
            heads.append((match, kind == "doubt"))
    made: list[Statement] = []
    for index, (match, doubt) in enumerate(heads):
        end = heads[index + 1][0].start() if index + 1 < len(heads) else len(text)
        run_on = doubt or (index + 1 < len(heads) and heads[index + 1][1])
        front = RELATION.split(made[-1].text)[-1] if made else text[: match.start()]
        lead = "".join(_APART.split(made[-1].text, maxsplit=1)[1:]) if made else front
        body = text[match.end() : end]
        barred, symbol, label = bool(match[1] and match[3]), match[2], ""
        if match[4] and symbols.rows_of(symbol + match[4]):
            # M_cb(1) is one symbol, v_B(3) a value at position 3.
            symbol += match[4]
        elif match[4]:
            label = match[4].strip("()")
        unit = match[5] or ""
        own = Statement(symbol, lead, front, body, match.end(), barred=barred, doubt=run_on, label=label, unit=unit)
        made.append(own)
    return made


def _begins(text: str, match: re.Match[str], symbols: Symbols, before: re.Match[str] | None) -> str:
    """`yes` where a statement begins at a symbol, `doubt` where it may stand in another one, "" where it does."""
    start = match.start()
    front = text[:start]
    if (start <= BEHIND and (not front.strip() or _BULLET.fullmatch(front))) or front.isspace():
        return "yes"
    ahead = front.rstrip()[-BEHIND:]
    last, glued = ahead[-1], not front[-1].isspace()
    if last in _OPERATORS or (last == "," and glued) or _FUNCTION.search(ahead):
        return ""
    if last in _SEPARATORS or "\n" in front[len(front.rstrip()) :]:
        return "yes"
    if before is not None and _COMPLETE.search(front[before.end() :][-BEHIND:].rstrip()):
        return "yes"
    word = _WORD.search(ahead)
    if word and not symbols.rows_of(word[0]) and bare(word[0]) not in symbols.every:
        return "yes"
    if any(one.end() == len(ahead) for one in POSITION.finditer(ahead)):
        return "yes"
    if before is None:
        return "doubt" if _LOOSE_NUMBER.search(ahead) else "yes"
    # Two symbols side by side are a product.
    return "doubt" if symbols.rows_of(match[2]) else ""


def value_of(statement: Statement) -> StatedValue | None:
    """The number behind the last “=” of a statement; None where no number ends it."""
    own = statement.clauses[0]
    relation = list(RELATION.finditer(own))
    if not relation:
        return None
    start = relation[-1].end()
    match = _TAIL.fullmatch(own[start:])
    # A list of values is none for one position.
    if match is None or _LISTED.match(statement.text, len(own)):
        return None
    at = statement.at + start + match.start(1)
    return StatedValue(match[1], match[2] or match[3] or statement.unit, at, match[4] or "")


def is_worked(statement: Statement) -> bool:
    """Whether numbers stand behind the last “=” that no symbol is left among: they were to come to something."""
    tail = RELATION.split(statement.clauses[0])[-1]
    if OBJECT in tail or _GIVEN.match(tail):
        return True
    names = [one for one in _NAMES.findall(tail) if one.casefold() not in _FUNCTIONS]
    left = _NAMES.sub("", tail)
    letters = [one for one in names if not re.fullmatch(UNIT, one)]
    return any(map(str.isdecimal, left)) and not letters


def labels_in(text: str) -> list[str]:
    """The labels of the positions that a text names."""
    return list(dict.fromkeys(label_of(match).casefold() for match in POSITION.finditer(text)))


def names_several(text: str) -> bool:
    """Whether a text is of several positions, or only compares with one."""
    return bool(_SEVERAL.search(text)) or len(labels_in(text)) > 1


def begins_with(text: str, label: str | None) -> bool:
    """Whether a text that names several positions, but no list of them, begins with one: “Position 14 is as 4.”"""
    return labels_in(text)[:1] == [label] and not _SEVERAL.search(text)


def is_compared(text: str) -> bool:
    """Whether a text names a position to compare with it."""
    return bool(_COMPARED.search(text))


def is_supposed(statement: Statement) -> bool:
    """Whether a statement is none, but what is tried."""
    return bool(_SUPPOSED.search(statement.front))


def names_another(text: str) -> bool:
    """Whether a text is of a position without saying which, unless it is that in hand."""
    return bool(SAYS_POSITION.search(text)) and not labels_in(text) and not _THIS.search(text)


def goes_on(text: str) -> bool:
    """Whether a line goes on with the statement before it."""
    return bool(re.match(r"\s*[=≈]", text))


_CHAPTER = re.compile(any_of("chapter", whole=False), re.IGNORECASE)


def names_chapter(text: str) -> bool:
    """Whether a line in bold is the name of a chapter of the work at one position, and not of another one."""
    return bool(_CHAPTER.search(text))


def has_number(statement: Statement) -> bool:
    """Whether a statement comes to anything that would be its value."""
    return value_of(statement) is not None or is_worked(statement)


def is_broken(text: str) -> bool:
    """Whether something ends between two statements, so that the position of the first is not that of the second."""
    return bool(re.search(r"[;\n]|\.\s+(?=[^\W\d])", text))


def is_operator(text: str) -> bool:
    """Whether a text ends with an operator, so that a sum or a product goes on behind it."""
    return text.rstrip()[-1:] in _OPERATORS


def said_otherwise(text: str) -> list[tuple[str, str, int]]:
    """Symbols that a number follows without a sign of equality, each with the number and its index."""
    return [(match[1], match[0], match.start(2)) for match in _COLON.finditer(text)]
