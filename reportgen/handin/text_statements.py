"""Statements of a running text: a symbol, “=”, its value, and the position that it applies to.

A statement begins at a symbol before “=” that no operator precedes. It continues over “⇒”, commas and paragraphs that
begin with “=”. Its value is the number after its last “=”. The key determines which symbols exist, never what a number
means.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from reportgen.base.records import Record
from reportgen.handin.symbol_matching import Symbols, bare
from reportgen.handin.text_numbers import NUMBER, UNIT
from reportgen.handin.word_patterns import HAN, any_of, label_of, labelled_position
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
"""Words before a symbol of an assumed value, or of one without a position, such as a maximum."""
_WITHDRAWN = re.compile(any_of("withdrawn", "extreme"), re.IGNORECASE)
"""Words after a number that withdraw it, or leave another one open."""
_REASON = re.compile(rf"\(\s*{any_of('reason')}[^()]*\)", re.IGNORECASE)
CLOCKWISE = re.compile(f"{any_of('clockwise')}|↻", re.IGNORECASE)
ANTICLOCKWISE = re.compile(f"{any_of('anticlockwise')}|↺", re.IGNORECASE)

BEHIND = 80
"""Number of characters before a symbol that decide if a statement begins at it."""
_LETTERS = rf"(?:[^\W_{HAN}]|′)"
_SYMBOL = (
    rf"[^\W\d_{HAN}]{_LETTERS}{{0,24}}+"
    rf"(?:[_^]\{{(?:[^{{}}]{{1,24}}+|\{{[^{{}}]{{0,24}}\}}){{0,4}}+\}}|\^\([^()\s]{{1,3}}\)|[_^]{_LETTERS}{{1,24}}+){{0,4}}+′{{0,3}}"
)
"""The length of a symbol is limited, so that a line is scanned only once."""
_APART_FROM = rf"(?<![^\W{HAN}])(?<![′_^{{}}])"
"""No letter of another symbol precedes."""
_HEAD = re.compile(
    rf"{_APART_FROM}(\|\s*)?({_SYMBOL})(\s*\|)?\s*(\([0-9]{{1,3}}[a-z]?′*\))?\s*(?:[\[(]\s*({UNIT})\s*[\])])?\s*(?=[=≈])"
)
_OPERATORS = frozenset("+-–·*/×(√^_=≈{∑÷|[")
_FUNCTION = re.compile(
    r"(?<![^\W\d_])(?:sin|cos|tan|tg|cot|cotg|arcsin|arccos|arctan|arctg|log|ln|exp)\s*$", re.IGNORECASE
)
_LOOSE_NUMBER = re.compile(r"(?:[\d})²³]|(?<![^\W\d_])[^\W\d_])$")
"""A number or a letter alone, which may be a factor of the following symbol."""
_COLON = re.compile(rf"{_APART_FROM}({_SYMBOL}(?:\(\d\))?)\s*(?::|{any_of('equals')})\s*({NUMBER})(?![\w′]*\s*[=≈])")
_SEPARATORS = frozenset(".,;:⇒→<>≤≥!?")
_BULLET = re.compile(r"\s*(?:[-–+•*▪►✓]|\(?\w{1,3}[.)]|\(?\d{1,2}(?:\.\d{1,2})*[.)])\s+")
_WORD = re.compile(rf"(?:[^\W\d_]{{2,}}|[{HAN}])$")
_COMPLETE = re.compile(rf"{NUMBER}\s*(?:{UNIT}|[(\[]\s*{UNIT}\s*[)\]])[.,]?$")
_APART = re.compile(
    rf"(?:;|\n|⇒|=>|→|(?<!\(){any_of('hence')}|,\s+(?=[^\d\s])|\.\s+(?=[^\W\d]))(?!\s*[=≈])", re.IGNORECASE
)
_OF_SEVERAL = re.compile(r"(?<![^\W\d_])(?:min|max)\s*\((?:[^()]++|\([^()]*+\))*+\)", re.IGNORECASE)
"""The least or greatest of several values, between which no clause ends."""
_TAIL = re.compile(
    rf"\s*({NUMBER})\s*(?:[(\[]\s*({UNIT})\s*[)\]]|({UNIT}))?\s*[.,;:]?\s*((?:\([^()=\d][^()=]*\)|[^()=\d]*)\s*[.,;:]?)"
    r"(?:(?<=\s)\s*[(\[]\d{1,2}(?:[.-]\d{1,3})*[a-z]?[)\]][.,;]?)?\s*"
)
_LISTED = re.compile(r"\s*[;→\n]\s*[-+–]?\s*\d")
_PROSE = re.compile(rf"\s*(?:$|[.,;:(]|[^\W\d_]*[^\x00-\x7f\W\d_][^\W\d_]*\b|{any_of('prose')})", re.IGNORECASE)
"""Beginnings of words after a number without a unit that are not a unit themselves."""
_NAMES = re.compile(
    r"[^\W\d_](?:[^\W_]|′)*+(?:[_^]\{[^{}]{0,40}\}|_++(?:[^\W_]|′)*+|\^(?:[^\W_]|′)++)*+|[_^]\{[^{}]{0,40}\}"
)
_GIVEN = re.compile(rf"\s*{NUMBER}\s*(?:{UNIT}(?![\w/])|[;÷±…]|\s[^\W\d_]{{2,}})")
"""A number that was meant as a value, whatever follows it."""
_FUNCTIONS = frozenset({"sin", "cos", "tan", "tg", "cotg", "arctan", "arcsin", "arccos", "arctg", "ln", "π", "pi", "x"})


class Statement(Record):
    """A symbol and the text up to the next one.

    `lead` is the text before it from the end of the previous clause, `front` that from the last “=”. `text` is the text
    after the symbol, from index `at` of the line. `barred` is True for a magnitude, |v_B|. `doubt` is True if the
    statement may be part of another one, or the next one part of it.
    """

    symbol: str
    lead: str
    front: str
    text: str
    at: int
    barred: bool = False
    doubt: bool = False
    label: str = ""
    """Label of the position directly after the symbol, v_B(3)."""
    unit: str = ""
    """Unit given there, v_B (m/s)."""

    @property
    def clauses(self) -> list[str]:
        """Its text in clauses, of which the first is its own."""
        return list(_clauses(self.text))


class StatedValue(Record):
    """The number of a statement: its text and unit as written, its index in the line, the words after it."""

    number: str
    unit: str
    at: int
    words: str

    @property
    def withdrawn(self) -> bool:
        """True if the words after the number withdraw it, or leave open whether it is the value."""
        if not self.unit and not _PROSE.match(self.words):
            return True
        words = _REASON.sub("", self.words)
        compares = SAYS_POSITION.search(words) and _COMPARED.search(words)
        return bool(_WITHDRAWN.search(words) or compares)

    @property
    def text(self) -> str:
        """The number and its unit as written."""
        return f"{self.number.strip()} {self.unit}".strip()


def _clauses(text: str) -> Iterator[str]:
    """Yield the clauses of a text."""
    whole = [match.span() for match in _OF_SEVERAL.finditer(text)]
    start = 0
    for match in _APART.finditer(text):
        if not any(first < match.start() < last for first, last in whole):
            yield text[start : match.start()]
            start = match.end()
    yield text[start:]


def statements(text: str, symbols: Symbols) -> list[Statement]:
    """Return the statements of a line in order, including those of unknown symbols, which end the preceding ones."""
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
            # M_cb(1) is one symbol; v_B(3) is a value at position 3.
            symbol += match[4]
        elif match[4]:
            label = match[4].strip("()")
        unit = match[5] or ""
        own = Statement(symbol, lead, front, body, match.end(), barred=barred, doubt=run_on, label=label, unit=unit)
        made.append(own)
    return made


def _begins(text: str, match: re.Match[str], symbols: Symbols, before: re.Match[str] | None) -> str:
    """Return `yes` if a statement begins at a symbol, `doubt` if it may be part of another one, "" if it is."""
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
    """Return the number after the last “=” of a statement; None if it does not end in a number."""
    own = statement.clauses[0]
    relation = list(RELATION.finditer(own))
    if not relation:
        return None
    start = relation[-1].end()
    match = _TAIL.fullmatch(own[start:])
    # A list of values is not a value for one position.
    if match is None or _LISTED.match(statement.text, len(own)):
        return None
    at = statement.at + start + match.start(1)
    return StatedValue(match[1], match[2] or match[3] or statement.unit, at, match[4] or "")


def is_worked(statement: Statement) -> bool:
    """Return True if the text after the last “=” has numbers and no symbols, so that it should give a value."""
    tail = RELATION.split(statement.clauses[0])[-1]
    if OBJECT in tail or _GIVEN.match(tail):
        return True
    names = [one for one in _NAMES.findall(tail) if one.casefold() not in _FUNCTIONS]
    left = _NAMES.sub("", tail)
    letters = [one for one in names if not re.fullmatch(UNIT, one)]
    return any(map(str.isdecimal, left)) and not letters


def labels_in(text: str) -> list[str]:
    """Return the labels of the positions that a text names."""
    return list(dict.fromkeys(label_of(match).casefold() for match in POSITION.finditer(text)))


def names_several(text: str) -> bool:
    """Return True if a text names several positions."""
    return bool(_SEVERAL.search(text)) or len(labels_in(text)) > 1


def begins_with(text: str, label: str | None) -> bool:
    """Return True if a text that does not list positions first names the one with a label: “Position 14 is as 4.”"""
    return labels_in(text)[:1] == [label] and not _SEVERAL.search(text)


def is_compared(text: str) -> bool:
    """Return True if a text names a position only for comparison."""
    return bool(_COMPARED.search(text))


def is_supposed(statement: Statement) -> bool:
    """Return True if a statement is only an assumption."""
    return bool(_SUPPOSED.search(statement.front))


def names_another(text: str) -> bool:
    """Return True if a text mentions a position without a label, other than the current one."""
    return bool(SAYS_POSITION.search(text)) and not labels_in(text) and not _THIS.search(text)


def goes_on(text: str) -> bool:
    """Return True if a line continues the statement before it."""
    return bool(re.match(r"\s*[=≈]", text))


_CHAPTER = re.compile(any_of("chapter", whole=False), re.IGNORECASE)


def names_chapter(text: str) -> bool:
    """Return True if a line in bold names a chapter of the work at one position, not another position."""
    return bool(_CHAPTER.search(text))


def has_number(statement: Statement) -> bool:
    """Return True if a statement has a value, readable or not."""
    return value_of(statement) is not None or is_worked(statement)


def is_broken(text: str) -> bool:
    """Return True if a clause ends between two statements, so that the position of the first does not carry over."""
    return bool(re.search(r"[;\n]|\.\s+(?=[^\W\d])", text))


def is_operator(text: str) -> bool:
    """Return True if a text ends with an operator, so that a sum or a product continues after it."""
    return text.rstrip()[-1:] in _OPERATORS


def without_equality_sign(text: str) -> list[tuple[str, str, int]]:
    """Return symbols followed by a number without a sign of equality, each with the number and its index."""
    return [(match[1], match[0], match.start(2)) for match in _COLON.finditer(text)]
