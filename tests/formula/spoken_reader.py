"""Words that are heard → the formula that a listener draws; it knows the tables of words and nothing of who speaks.

A formula is a tuple: ("+", …), ("*", …), ("/", top, bottom), ("^", base, exponent), ("neg", of), ("minus", of) as a
later term of a sum, ("=", …), ("root", of), ("abs", of), ("call", name, …), ("matrix", row, …), ("n", value, unit),
("s", over, letters with those below and primes, what else stands above).
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from typing import Any

Heard = tuple[Any, ...]
HAN = "\u3400-\u9fff"
SINGLE = {"ratio": "/", "squared": "^", "cubed": "^", "power": "^", "root": "root", "absolute": "abs"}
WHOLE = {"fraction": "/", "long_power": "^", "long_root": "root", "long_absolute": "abs"}
ORDER = {"/": ("top", "bottom"), "^": ("base", "exponent"), "root": ("of",), "abs": ("of",)}
PRIMES_AND_STAR = "′″*"


def pieces(pattern: str) -> list[str]:
    """A pattern in its gaps and what is said between them."""
    return [piece.strip() for piece in re.split(r"(\{\w+\})", pattern) if piece.strip()]


class Misheard(Exception):
    """What is no formula."""


class Listener:
    """Draws formulas from words; `point` is the decimal mark of the language."""

    def __init__(self, words: Mapping[str, Any], point: str) -> None:
        self.words, self.point = words, point
        self.meanings: defaultdict[str, set[tuple[str, str]]] = defaultdict(set)
        for name in ("signs", "marks", "letters", "functions"):
            for key, said in words[name].items():
                self.meanings[said].add((name, key))
        for unit, forms in words["units"].items():
            for form in forms.split(" | "):
                self.meanings[form].add(("units", unit))
        for name in ("negative", "separator", "row", "entry", "unknown"):
            self.meanings[words[name]].add((name, ""))
        self.patterns = {name: pieces(said) for name, said in words.items() if isinstance(said, str) and "{" in said}
        for name, pattern in self.patterns.items():
            for literal in pattern:
                if not literal.startswith("{"):
                    self.meanings[literal].add(("pattern", name))
        known = "|".join(map(re.escape, sorted(self.meanings, key=len, reverse=True)))
        word = rf"[^\W\d_{HAN}]+"
        # Chinese ends a word without a blank; any other goes on to the last of its letters.
        ends = rf"(?:(?<=[{HAN}])|(?![^\W{HAN}]))"
        self.token = re.compile(rf"({known}){ends}|({word})|(\d+(?:[.,]\d+)*)|(,)|\s+|(\S)")

    # --- words ------------------------------------------------------------------------------------

    def read(self, said: str) -> tuple[Heard, str]:
        """A line, and the reason in parentheses behind it.  Raises `Misheard`."""
        self.said, self.at = said, 0
        self.tokens = list(self._tokens())
        formula = self._chain()
        note = ""
        if self._is("marks", "("):
            end = self.words["marks"][")"]
            start = self.tokens[self.at][2]
            if not said.endswith(end):
                raise Misheard(f"a reason without an end: {said}")
            note = said[start:].removesuffix(end).strip()
            self.at = len(self.tokens)
        if self.at != len(self.tokens):
            raise Misheard(f"{self.tokens[self.at :]} is left of {said!r}")
        return formula, note

    def _tokens(self) -> Iterator[tuple[str, str, int]]:
        at = 0
        while at < len(self.said):
            match = self.token.match(self.said, at)
            assert match
            at = match.end()
            # Anything else may stand in a reason.
            for kind, text in zip(("known", "word", "digits", "comma", "else"), match.groups(), strict=True):
                if text is not None:
                    yield kind, text, at

    def _is(self, kind: str, *keys: str) -> str | None:
        """The key by which the next words are known as of a kind, if they are."""
        if self.at < len(self.tokens) and self.tokens[self.at][0] == "known":
            for sort, key in self.meanings[self.tokens[self.at][1]]:
                if sort == kind and (not keys or key in keys):
                    return key or kind
        return None

    def _raw(self, kind: str) -> str | None:
        if self.at < len(self.tokens) and self.tokens[self.at][0] == kind:
            return self.tokens[self.at][1]
        return None

    def _says(self, literal: str) -> bool:
        said = self.at < len(self.tokens) and self.tokens[self.at][1] == literal
        self.at += said
        return said

    def _took(self, kind: str, *keys: str) -> str | None:
        key = self._is(kind, *keys)
        self.at += key is not None
        return key

    def _expect(self, literal: str) -> None:
        if not self._says(literal):
            raise Misheard(f"no {literal!r} before {self.tokens[self.at :]} in {self.said!r}")

    # --- formulas -----------------------------------------------------------------------------------

    def _chain(self) -> Heard:
        sides = [self._sum()]
        while self._took("signs", "="):
            sides.append(self._sum())
        return ("=", *sides) if len(sides) > 1 else sides[0]

    def _sum(self) -> Heard:
        terms = [self._term()]
        while sign := self._took("signs", "+", "−"):
            terms.append(self._term() if sign == "+" else ("minus", self._term()))
        return ("+", *terms) if len(terms) > 1 else terms[0]

    def _term(self) -> Heard:
        if self._took("negative"):
            return ("neg", self._term())
        factors = [self._factor()]
        while sign := self._took("signs", "·", "×", "/"):
            factor = self._factor()
            if sign == "/":
                factors = [("/", product(factors), factor)]
            else:
                factors.append(factor)
        if unit := self._took("units"):
            factors.append(("unit", unit))
        return product(factors)

    def _factor(self) -> Heard:
        """Something with the patterns that go on behind it: a power, a fraction of two single ones."""
        formula = self._opening() or self._number() or self._function() or self._symbol()
        while name := self._going_on({**SINGLE, **WHOLE}):
            formula = self._filled(name, formula)
        return formula

    def _going_on(self, names: Mapping[str, str]) -> str | None:
        """The pattern of which the first gap has been read and the next words stand now."""
        for name in names:
            first, then, *_ = self.patterns[name]
            if first.startswith("{") and self._says(then):
                return name
        return None

    def _filled(self, name: str, first: Heard | None = None) -> Heard:
        """A pattern whose first gap, if it begins with one, and first words have been read."""
        what = SINGLE.get(name) or WHOLE[name]
        pattern = self.patterns[name]
        gaps = {pattern[0].strip("{}"): first} if first is not None else {}
        rest = pattern[2 if first is not None else 1 :]
        for index, piece in enumerate(rest):
            if not piece.startswith("{"):
                self._expect(piece)
            else:
                gaps[piece.strip("{}")] = self._single() if index == len(rest) - 1 else self._sum()
        if name in ("squared", "cubed"):
            gaps["exponent"] = ("n", 2.0 if name == "squared" else 3.0, "")
        return (what, *(gaps[gap] for gap in ORDER[what]))

    def _single(self) -> Heard:
        """What stands at the open end of a pattern: one symbol or number, what says its own end, a function."""
        if self._took("negative"):
            return ("neg", self._single())
        if not (formula := self._opening() or self._function() or self._symbol(required=False)):
            digits = self._raw("digits")
            if digits is None:
                raise Misheard(f"nothing behind {self.tokens[: self.at]} in {self.said!r}")
            self.at += 1
            formula = ("n", self._value(digits), "")
        return formula

    def _opening(self) -> Heard | None:
        """What begins with words of its own: a fraction, a root, a parenthesis, a matrix."""
        if self._took("marks", "("):
            formula = self._sum()
            self._expect(self.words["marks"][")"])
            return formula
        begin, _, end = self.patterns["matrix"]
        if self._says(begin):
            rows = [self._entries()]
            while self._took("row"):
                rows.append(self._entries())
            self._expect(end)
            return ("matrix", *rows)
        for name in (*SINGLE, *WHOLE):
            if not self.patterns[name][0].startswith("{") and self._says(self.patterns[name][0]):
                return self._filled(name)
        return None

    def _entries(self) -> Heard:
        entries = [self._sum()]
        while self._took("entry"):
            entries.append(self._sum())
        return tuple(entries)

    def _number(self) -> Heard | None:
        digits = self._raw("digits")
        if digits is None:
            return None
        self.at += 1
        return ("n", self._value(digits), self._took("units") or "")

    def _value(self, digits: str) -> float:
        if "," in digits.replace(self.point, "") or "." in digits.replace(self.point, ""):
            raise Misheard(f"no number: {digits}")
        return float(digits.replace(self.point, "."))

    def _function(self) -> Heard | None:
        name = self._took("functions")
        if name is None:
            return None
        exponents: Heard = ()
        if pattern := self._going_on({"squared": "", "cubed": "", "power": "", "long_power": ""}):
            exponents = self._filled(pattern, ("name",))[2:]
        for piece in self.patterns["function"]:
            if not piece.startswith("{"):
                self._expect(piece)
        if self._took("marks", "("):
            arguments = [self._sum()]
            while self._took("separator"):
                arguments.append(self._sum())
            self._expect(self.words["marks"][")"])
        else:
            digits = self._number()
            arguments = [digits or self._single()]
        call = ("call", name, *arguments)
        return ("^", call, *exponents) if exponents else call

    # --- symbols ------------------------------------------------------------------------------------

    def _symbol(self, required: bool = True) -> Heard | None:
        for over in ("vector", "segment"):
            begin, *_ = self.patterns[over]
            if self._says(begin):
                if digits := self._raw("digits"):
                    self.at += 1
                    return ("s", over, digits, "")
                heard = self._symbol()
                assert heard
                return ("s", over, *heard[2:])
        letters, above, lowered = "", "", False
        while True:
            if letters and self._going_on({"above": ""}):
                above = self._letter(any_mark=True) or ""
                while more := self._letter():
                    above += more
                break
            if letters and self._going_on({"below": ""}):
                letters += self._letter(any_mark=True) or ""
                lowered = True
            elif letters and (digits := self._raw("digits")) is not None:
                self.at += 1
                letters += digits
            elif letters and self._raw("comma"):
                self.at += 1
                letters += ","
            elif letter := self._letter(any_mark=lowered and self._is("marks", "(") is not None):
                letters += letter
            else:
                break
        if letters:
            return ("s", "", letters, above)
        if required:
            raise Misheard(f"nothing at {self.tokens[self.at :]} in {self.said!r}")
        return None

    def _letter(self, any_mark: bool = False) -> str | None:
        """A letter, a word of an index, a digit or a sign among letters; all of what stands in brackets."""
        begins, capital = self.patterns["capital"][0], False
        if not begins.startswith("{"):
            capital = self._says(begins)
        if any_mark and not self._is("marks", *"([") and (mark := self._took("marks")):
            return mark
        for opening, closing in ("()", "[]") if any_mark else ("[]",):
            if self._took("marks", opening):
                inside = opening
                while not self._took("marks", closing):
                    inside += self._letter(any_mark=True) or self._other()
                return inside + closing
        if mark := self._took("marks", *PRIMES_AND_STAR):
            return mark
        letter = self._took("letters")
        if letter is None:
            letter = self._raw("word")
            self.at += letter is not None
        if letter is None:
            return None
        if begins.startswith("{"):
            capital = self._says(self.patterns["capital"][1])
        if capital and not letter.isupper():
            raise Misheard(f"{letter} is said to be a capital in {self.said!r}")
        return letter + "\N{COMBINING DOT ABOVE}" if self._going_on({"dotted": ""}) else letter

    def _other(self) -> str:
        kind, text, _ = self.tokens[self.at]
        if kind not in ("digits", "comma"):
            raise Misheard(f"{text!r} among letters in {self.said!r}")
        self.at += 1
        return text


def product(factors: list[Heard]) -> Heard:
    """Factors in one product; one by itself is no product."""
    if len(factors) == 1:
        return factors[0]
    flat = [inner for factor in factors for inner in (factor[1:] if factor[0] == "*" else (factor,))]
    return ("*", *flat)
