"""Words and formulas → LaTeX source, so that they appear on the page exactly as typed.

T5 fonts hold the Vietnamese letters, T1 the other Latin ones; symbols and Greek letters come from the
mathematical fonts.  A character that none of them has is refused before TeX runs.
"""

from __future__ import annotations

import json
import re
import unicodedata
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from reportgen.errors import TypesetterError
from reportgen.notation.expressions import Chain, Expression, Fraction, Number, Root, Symbol, VectorEquation, walk
from reportgen.notation.numbers import MINUS, write
from reportgen.writers.layout import NAMED, PRIMES, UNSPACED, Column, Formulas, short_end

NARROW_TERMS = 5
"""A vector equation of at most so many terms fits any line."""

_CHARACTERS = json.loads(Path(__file__).with_name("characters.json").read_text(encoding="utf-8"))
SPECIAL: dict[str, str] = _CHARACTERS["special"]
"""ASCII marks that TeX would take for commands or for other signs."""

_LIGATURES = re.compile(r"([-,])(?=\1)")
"""Marks that fonts would join into one sign: -- ,,"""

MATHEMATICAL: dict[str, str] = _CHARACTERS["mathematical"]
"""Characters that the frame declares as this mathematics, in text and in formulas alike."""

TEXTUAL: dict[str, str] = _CHARACTERS["textual"]
"""Characters that the frame declares as these text commands, in text and in formulas alike."""

_VIETNAMESE = frozenset(
    "ÀÁÂÃÈÉÊÌÍÒÓÔÕÙÚÝàáâãèéêìíòóôõùúýĂăĐđĨĩŨũƠơƯưẠạẢảẤấẦầẨẩẪẫẬậẮắẰằẲẳẴẵẶặẸẹẺẻẼẽẾếỀềỂểỄễỆệỈỉỊịỌọỎỏỐốỒồỔổỖỗỘộ"
    "ỚớỜờỞởỠỡỢợỤụỦủỨứỪừỬửỮữỰựỲỳỴỵỶỷỸỹ–—‘’‚“”„‹›«»"
)
_OTHER_LATIN = frozenset("ÄÅÆÇËÎÏÐÑÖØÛÜÞßäåæçëîïðñöøûüþÿĄąĆćČčĎďĘęĚěĞğİıĹĺĽľŁłŃńŇňŐőŒœŔŕŘřŚśŞşŠšŤťŮůŰűŸŹźŻżŽžȘșȚț¡¿")
_DECLARED = frozenset(MATHEMATICAL) | frozenset(TEXTUAL)


def declarations() -> tuple[tuple[str, str], ...]:
    """(code point in hex, definition) of every character that the frame declares."""
    mathematics = ((char, rf"\ensuremath{{{code}}}") for char, code in MATHEMATICAL.items())
    words = ((char, rf"\reporttextual{{{code}}}") for char, code in TEXTUAL.items())
    return tuple((f"{ord(char):04X}", code) for char, code in (*mathematics, *words))


def escape(text: str) -> str:
    """The LaTeX source that prints `text` as typed.

    Raises `TypesetterError` naming the first character that the fonts do not have.
    """
    source = "".join(map(_character, unicodedata.normalize("NFC", text)))
    return _LIGATURES.sub(r"\1{}", source)


def _character(char: str) -> str:
    if char in SPECIAL:
        return SPECIAL[char]
    if char.isspace() and char not in TEXTUAL:
        return " "
    if " " < char <= "~" or char in _DECLARED or char in _VIETNAMESE:
        return char
    if char in _OTHER_LATIN:
        return rf"\reportlatin{{{char}}}"
    raise TypesetterError(
        f"the LaTeX engine has no character {char!r} (U+{ord(char):04X}, "
        f"{unicodedata.name(char, 'without a name')}); use the engine typst, or write it otherwise"
    )


def hexadecimal(text: str) -> str:
    """A text as a PDF string's content in UTF-16, in hexadecimal digits."""
    return "FEFF" + unicodedata.normalize("NFC", text).encode("utf-16-be").hex().upper()


# --- formulas -------------------------------------------------------------------------------------


class LatexFormulas(Formulas):
    r"""Formulas with the places where a line may break: \relbreak, \binbreak, \dotbreak."""

    PLUS, MINUS, NEGATIVE = r"\binbreak+", r"\binbreak-", "-"
    TIMES, DOT, CROSS = r"\dotbreak\cdot", r"\cdot", r"\times"
    SLASH = "/"
    FRACTION, RAISED, ROOT, ABSOLUTE = r"\frac{%s}{%s}", "^{%s}", r"\sqrt{%s}", r"\lvert %s\rvert "

    def text(self, text: str) -> str:
        return escape(text)

    def number(self, node: Number) -> str:
        """Digits without a gap after the decimal comma and with a true minus sign, and the unit."""
        digits = write(node.value, node.decimals, self.language)
        if any(char.isdigit() for char in digits):
            digits = digits.replace(",", "{,}").replace(MINUS, "-")
        else:
            digits = rf"\text{{{escape(digits)}}}"
        gap = "" if node.unit in UNSPACED else r"\,"
        return digits + (rf"{gap}\text{{{escape(node.unit)}}}" if node.unit else "")

    def symbol(self, node: Symbol) -> str:
        letters = node.base.rstrip("".join(PRIMES))
        above = node.base[len(letters) :] + node.sup
        base = letters if len(letters) == 1 and _is_mathematical(letters) else self.lettered(letters)
        if node.over == "vector":
            base = rf"\vec{{{base}}}" if len(letters) == 1 else rf"\overrightarrow{{{base}}}"
        below = f"_{{{self.index(node.sub)}}}" if node.sub else ""
        marked = base + below + (self.RAISED % _word(above) if above else "")
        return rf"\overline{{{marked}}}" if node.over == "segment" else marked

    def italic(self, text: str) -> str:
        return _word(text, "it")

    def upright(self, text: str) -> str:
        return _word(text)

    def lowered(self, text: str) -> str:
        return rf"_{{\scriptstyle{{{_word(text)}}}}}"

    def parentheses(self, node: Expression) -> str:
        inner = self.math(node)
        if any(isinstance(part, (Fraction, Root)) for part in walk(node)):
            return rf"\mathopen{{}}\left({inner}\right)"
        return f"({inner})"

    def function(self, name: str) -> str:
        return rf"\{name}" if name in NAMED else rf"\operatorname{{{escape(name)}}}"

    def arguments(self, nodes: Sequence[Expression]) -> str:
        if len(nodes) == 1:
            return self.parentheses(nodes[0])
        # A comma is the decimal mark in Vietnamese.
        return f"({('; ' if self.language == 'vi' else ', ').join(map(self.math, nodes))})"

    def matrix(self, rows: Sequence[Sequence[str]]) -> str:
        """Square brackets as tall as what they hold; copied from the page they are single characters."""
        inner = r"\begin{matrix}" + r" \\ ".join(map(" & ".join, rows)) + r"\end{matrix}"
        strut = rf"\vphantom{{{inner}}}"
        opening = rf"\mathopen{{\reportactual{{005B}}{{\left[{strut}\right.\kern-\nulldelimiterspace}}}}"
        closing = rf"\mathclose{{\reportactual{{005D}}{{\kern-\nulldelimiterspace\left.{strut}\right]}}}}"
        return opening + inner + closing

    def chain(self, node: Chain) -> str:
        """In a line it may break before a second "=", not before the first."""
        left, rest = self.aligned(node)
        return left + rest.replace(r" \relbreak= ", " = ", 1)

    def aligned(self, node: Expression) -> tuple[str, str]:
        """A displayed line cut at its first relation: what stands left of it, and the rest.

        A vector equation is a grid and not cut.
        """
        match node:
            case VectorEquation(rows=rows):
                return "", self._vector_equation(self.columns(node), rows)
            case Chain((first, *others), note):
                rest = [r" \relbreak= " + self.math(part) for part in others]
                if rest and short_end(node):
                    rest[-1] = f" = {self.math(others[-1])}"
                if note:
                    rest.append(rf" \relbreak\quad\text{{({escape(note)})}}")
                return (self.math(first), "".join(rest)) if others else ("", self.math(first) + "".join(rest))
        return "", self.math(node)

    # --- vector equations -------------------------------------------------------------------------

    def _vector_equation(self, terms: Sequence[Column], rows: Sequence[str]) -> str:
        """A grid; if it is too wide for the line, two grids of half the terms, one below the other."""
        whole = self._grid(terms, rows)
        if len(terms) <= NARROW_TERMS:
            return whole
        half = (len(terms) + 1) // 2
        upper, lower = (self._vector_equation(part, rows) for part in (terms[:half], terms[half:]))
        return rf"\fitting{{{whole}}}{{\storeys{{{upper}}}{{{lower}}}}}"

    def _grid(self, terms: Sequence[Column], rows: Sequence[str]) -> str:
        """Terms on top, below each what is known of it; "?" marks an unknown."""
        lines = ["&" + "&".join(f"{sign}&{shown}" for sign, shown, _ in terms)]
        for row, name in enumerate(rows):
            entries = (known[row] if row < len(known) else "" for _, _, known in terms)
            known = "&".join(rf"&\known{{{self.known(e)}}}" for e in entries)
            lines.append(rf"\rowname{{{escape(name)}}}&{known}")
        if rows:
            lines[1] = rf"\cline{{2-{2 * len(terms) + 1}}}{lines[1]}"
        body = r"\\".join(lines)
        return rf"\begin{{vectorgrid}}{{{len(terms)}}}{body}\end{{vectorgrid}}"


def _is_mathematical(text: str) -> bool:
    return all(char in MATHEMATICAL or (char.isascii() and char.isalnum()) for char in text)


def _word(text: str, shape: Literal["rm", "it"] = "rm") -> str:
    """A run of letters in one alphabet of TeX; whatever else a writer put there is set as text."""
    if text.isdigit() and text.isascii():
        return text
    primes = {"′": r"\prime", "″": r"\prime\prime"}
    if text and all(char in primes for char in text):
        return "".join(primes[char] for char in text)
    if _is_mathematical(text):
        return rf"\math{shape}{{{text}}}"
    return rf"\text{{\text{'it' if shape == 'it' else 'up'}{{{escape(text)}}}}}"
