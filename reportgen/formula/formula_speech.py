"""Spoken text of formulas, for screen readers: the laid-out parts in words of the report's language.

Parts that are printed side by side follow each other in speech. The end of a fraction, a root or a parenthesis is
spoken unless its content is one symbol or number, so that a listener can write the formula down. The words are the
section `speech` of a language's words.
"""

from __future__ import annotations

import re
import unicodedata
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from typing import Any

from reportgen.base.errors import TemplateError
from reportgen.base.units import MINUS, Language
from reportgen.formula import Expression, Symbol, VectorEquation
from reportgen.formula.formula_layout import (
    PRIMES,
    Fence,
    Function,
    Grid,
    MathRow,
    Note,
    Parenthesis,
    Part,
    Quotient,
    Radical,
    Raised,
    Sign,
    Written,
    known_of,
    parted,
    terms,
)
from reportgen.formula.formula_setter import Setter
from reportgen.formula.vocabulary import raised

PLAINLY, CAPITALS, INDICES = range(3)
"""Level of detail of a spoken symbol: its letters; also the capitals among them; also the lowered ones."""
KEPT_UNITS = 256
SHORTEST_WORD = 3
"""Smallest number of small letters in an index that form a word (max); fewer are spelled one by one (cb)."""
DOT = "\N{COMBINING DOT ABOVE}"

_RUN = re.compile(r"\d+|[^\W\d_]+|.")
_PLAIN_INDEX = re.compile(r"[\w,′″]*")
"""An index without signs."""
_IN_TEXT = re.compile(r"[A-Z][A-Z₀-₉]+|[Α-Ωα-ω][₀-₉]*|(?<=\w)[₀-₉]+|[^\w\s.,:;()°%-]")
"""Pieces of a text that are spoken differently: names of several points, Greek letters, lowered digits, signs."""


class Speech(Setter[str]):
    """Formulas in words; no two of `symbols`, the symbols of one report, sound alike.

    `words` has the spoken word of each part, and `units` by the printed signs. Raises `TemplateError` for counts that
    are not patterns.
    """

    def __init__(self, language: Language, words: Mapping[str, Any], symbols: Iterable[Symbol] = ()) -> None:
        super().__init__(language)
        self.words = words
        self.unit = lru_cache(KEPT_UNITS)(self._unit)
        self._counts = list(map(_pattern, words["counts"].split()))
        self._spoken = {node: self._symbol(node, detail) for node, detail in self._apart(symbols).items()}

    # --- parts ------------------------------------------------------------------------------------

    def part(self, part: Part) -> str:
        of, words = self.part, self.words
        match part:
            case Symbol():
                return self.symbol(part)
            case Written():
                return self.number(part)
            case Sign():
                return self.sign(part)
            case MathRow(parts):
                return " ".join(map(of, parts))
            case Quotient(top, bottom):
                pattern = words["ratio" if _is_single(top) and _is_single(bottom) else "fraction"]
                return _filled(pattern, top=of(top), bottom=of(bottom))
            case Raised(base, exponent):
                return self.power(of(base), exponent)
            case Radical(inner):
                return _filled(words["root" if _is_single(inner) else "long_root"], of=of(inner))
            case Fence():
                return self.fence(part)
            case Function(name, exponent, to):
                function = words["functions"].get(name, name)
                return _filled(
                    words["function"], name=self.power(function, exponent) if exponent else function, of=of(to)
                )
            case Grid(rows):
                return f" {words['row']} ".join(f" {words['entry']} ".join(map(of, row)) for row in rows)
            case Note(text):
                return f"{words['marks']['(']} {self.text(text)} {words['marks'][')']}"
            case Parenthesis(mark):
                return str(words["marks"][mark])

    def text(self, text: str) -> str:
        """Return a text with its signs in words."""
        return " ".join(_IN_TEXT.sub(self._in_text, text).split())

    def _in_text(self, match: re.Match[str]) -> str:
        said = self.words["signs"].get(match[0])
        return f" {self.letters(match[0], PLAINLY) if said is None else said} "

    def number(self, number: Written) -> str:
        """Return a number in words with its unit; digits are kept as digits."""
        digits = number.digits
        said = f"{self.words['negative']} {digits[1:]}" if digits.startswith(MINUS) else digits
        unit = self.unit(number.unit, digits.removeprefix(MINUS)) if number.unit else ""
        return f"{said} {unit}" if said and unit else said or unit

    def _unit(self, unit: str, digits: str) -> str:
        """Return a unit in words, in the form that agrees with the count."""
        forms = self.words["units"].get(unit, unit).split(" | ")
        fitting = (form for count, form in zip(self._counts, forms, strict=False) if count.fullmatch(digits))
        return str(next(fitting, forms[-1]))

    def sign(self, sign: Sign) -> str:
        if sign.role in ("prefix", "separator"):
            return str(self.words["negative" if sign.role == "prefix" else "separator"])
        return str(self.words["signs"][sign.of])

    def power(self, base: str, exponent: Part) -> str:
        """Return a power in words; `base` is spoken already."""
        match exponent:
            case Written("2" | "3" as digits):
                return _filled(self.words["squared" if digits == "2" else "cubed"], base=base)
            case Written():
                pattern = self.words["power"]
            case _:
                pattern = self.words["power" if _is_single(exponent) else "long_power"]
        return _filled(pattern, base=base, exponent=self.part(exponent))

    def fence(self, fence: Fence) -> str:
        """Return a group in words, with its parentheses unless its content is one symbol or number."""
        inner, words = self.part(fence.of), self.words
        match fence.left:
            case "":
                return inner
            case "[":
                return _filled(words["matrix"], rows=inner)
            case "|":
                return _filled(words["absolute" if _is_single(fence.of) else "long_absolute"], of=inner)
            case "(" if _is_single(fence.of, bare=True):
                return inner
        return f"{words['marks']['(']} {inner} {words['marks'][')']}"

    # --- symbols ----------------------------------------------------------------------------------

    def symbol(self, node: Symbol) -> str:
        """Return a symbol in words, as unambiguous as the report's symbols require."""
        if (said := self._spoken.get(node)) is None:
            said = self._spoken[node] = self._symbol(node, PLAINLY)
        return said

    def _symbol(self, node: Symbol, detail: int) -> str:
        """Return the letters, index, primes and marks above in words; an accent over the whole symbol comes first."""
        words = self.words
        letters, above = parted(node)
        said = self.letters(letters, detail)
        if node.sub:
            index = self.letters(node.sub, detail, index=True)
            below = detail >= INDICES or not _PLAIN_INDEX.fullmatch(node.sub)
            said = _filled(words["below"], symbol=said, index=index) if below else f"{said} {index}"
        marks = above.lstrip(PRIMES)
        if primes := above.removesuffix(marks):
            said = f"{said} {self.letters(primes, detail)}"
        if marks:
            said = _filled(words["above"], symbol=said, index=self.letters(marks, detail, index=True))
        return _filled(words[node.over], symbol=said) if node.over else said

    def letters(self, text: str, detail: int, index: bool = False) -> str:
        """Return letters one by one, unchanged or by their names; small letters of an index may be a word."""
        said: list[str] = []
        for run in _RUN.findall(raised(text.replace("′′", "″"))):
            known = self.words["letters"]
            if run.isdigit() or (
                index and len(run) >= SHORTEST_WORD and run.islower() and known.keys().isdisjoint(run)
            ):
                said.append(run)
            else:
                said += (self.letter(letter, detail) for letter in run)
        return " ".join(said).replace(" ,", ",")

    def letter(self, letter: str, detail: int) -> str:
        """Return a letter by its name; from the level `CAPITALS`, a capital is spoken as one."""
        words = self.words
        plain = unicodedata.normalize("NFD", letter)
        if plain[1:] == DOT:
            return _filled(words["dotted"], letter=self.letter(plain[0], detail))
        said = str(words["letters"].get(letter) or words["marks"].get(letter, letter))
        return _filled(words["capital"], letter=said) if detail >= CAPITALS and letter.isupper() else said

    def _apart(self, symbols: Iterable[Symbol]) -> Mapping[Symbol, int]:
        """Return the level of detail for each symbol, so that no two of them sound alike."""
        details = dict.fromkeys(symbols, PLAINLY)
        for more in (CAPITALS, INDICES):
            alike: defaultdict[str, list[Symbol]] = defaultdict(list)
            for symbol, detail in details.items():
                alike[sound(self._symbol(symbol, detail))].append(symbol)
            for group in alike.values():
                if len({(*parted(symbol), symbol.sub, symbol.over) for symbol in group}) > 1:
                    details |= dict.fromkeys(group, more)
        return details

    # --- whole formulas ---------------------------------------------------------------------------

    def row(self, sides: Sequence[Sequence[Part]]) -> str:
        """Return a displayed row: its sides, each in pieces."""
        return f" {self.words['signs']['=']} ".join(" ".join(map(self.part, side)) for side in sides)

    def equation(self, rows: Iterable[str], number: str) -> str:
        """Return the rows one after another, with the equation's number if it has one."""
        said = "; ".join(rows)
        return _filled(self.words["numbered"], number=number, formula=said) if number else said

    def vector_equation(self, equation: VectorEquation) -> str:
        """Return the line, followed by the known facts of each term."""
        said = [self.math(equation)]
        for _, term in terms(equation):
            entries = zip(equation.rows, known_of(term, equation), strict=True)
            facts = ", ".join(f"{self.text(row)} {self.known(entry)}" for row, entry in entries if entry != "")
            said += [f"{self.symbol(term.symbol)}: {facts}"] if facts else []
        return ". ".join(said)

    def known(self, entry: Expression | str | None) -> str:
        return str(self.words["unknown"]) if entry is None else super().known(entry)


def sound(said: str) -> str:
    """Return the sound of words: without capitals, spaces and pauses."""
    return re.sub(r"[\s,-]", "", said).casefold()


def _pattern(count: str) -> re.Pattern[str]:
    try:
        return re.compile(count)
    except re.error as error:
        raise TemplateError(f"counts: {count}: {error}") from error


def _filled(pattern: str, **parts: str) -> str:
    return pattern.format(**parts)


def _is_single(part: Part, bare: bool = False) -> bool:
    """Return True if a part is one symbol, or one number without sign and unit; a `bare` symbol has no marks above."""
    match part:
        case MathRow((inner,)) | Fence("", inner):
            return _is_single(inner, bare)
        case Symbol():
            return not (bare and parted(part)[1])
        case Written(digits, unit):
            return not (unit or digits.startswith(MINUS))
    return False
