"""Write formulas in Typst's mathematical notation.

Names and numbers are string literals, so that nothing in them can become markup. Every operator is surrounded by
spaces, because Typst identifiers may contain a hyphen.
"""

from __future__ import annotations

from typing import ClassVar

from reportgen.formula import Symbol
from reportgen.formula.formula_layout import NAMED, PRIMES, Parenthesis, Sign, Written, parted
from reportgen.formula.formula_setter import TextSetter
from reportgen.formula.vocabulary import numbered, runs


def literal(text: str) -> str:
    """Return a Typst string literal whose value is `text`."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + escaped.replace("\n", "\\n").replace("\r", "\\r").replace("\t", "\\t") + '"'


class TypstFormulas(TextSetter):
    """Writer of expressions in Typst's mathematical notation, in one language."""

    BELOW = "%s_(script(%s))"
    RAISED = POWER = "%s^(%s)"
    QUOTIENT, RADICAL = "frac(%s, %s)", "sqrt(%s)"
    FENCES: ClassVar = {"": "%s", "(": "(%s)", "|": "abs(%s)", "[": 'mat(delim: "[", %s)'}
    ENTRY, LINE = ", ", "; "
    APPLIED = CALL = "%s %s"
    NOTE = " quad %s"
    SIGNS: ClassVar = {"·": "dot.c", "×": "times"}

    def text(self, text: str) -> str:
        return literal(text)

    def inline(self, mathematics: str) -> str:
        return f"${mathematics}$"

    def number(self, number: Written) -> str:
        return f"{literal(number.digits)} thin {literal(number.unit)}" if number.spaced else literal(number.text(""))

    def sign(self, sign: Sign) -> str:
        match sign.role:
            case "prefix":
                return sign.of
            case "slash":
                return literal(sign.of)
            case "separator":
                return f' class("punctuation", "{sign.of}") '
            case _:
                return f" {self.SIGNS.get(sign.of, sign.of)} "

    def function(self, name: str) -> str:
        return name if name in NAMED else f"op({literal(name)})"

    def mark(self, mark: Parenthesis) -> str:
        role = "opening" if mark.of == "(" else "closing"
        return f' class("{role}", lr(size: #{200 if mark.tall else 100}%, \\{mark.of})) '

    def symbol(self, node: Symbol) -> str:
        """Return a symbol with its marks: base in italics, sub- and superscript upright, a bar over all of it."""
        letters, above = parted(node)
        single = len(letters) == 1 and letters.isalpha()
        base = letters if single else self.lowered(runs(letters), lambda part: f"italic({literal(part)})")
        # Marks need a base even if there are no letters.
        base = base or literal("")
        if node.over == "vector":
            base = f"arrow({base})"
        below = f"_({self.lowered(numbered(node.sub), literal)})" if node.sub else ""
        marked = base + below + (f"^({_superscript(above)})" if above else "")
        return f"overline({marked})" if node.over == "segment" else marked


def _superscript(text: str) -> str:
    """Return primes as Typst's own symbol, which has the right size, and everything else upright."""
    letters = text.lstrip(PRIMES)
    primes = {"′": "prime", "″": "prime.double"}
    names = [primes[char] for char in text[: len(text) - len(letters)]]
    return " ".join([*names, literal(letters)] if letters else names)
