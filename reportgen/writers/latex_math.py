"""Convert words and formulas into LaTeX source that prints them exactly as typed.

T5 fonts have the Vietnamese letters, T1 fonts the other Latin ones; symbols and Greek letters come from the
mathematical fonts. A character that none of them has is rejected before TeX runs.
"""

from __future__ import annotations

import json
import re
import unicodedata
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import ClassVar, Literal

from reportgen.base.errors import TypesetterError
from reportgen.base.units import MINUS
from reportgen.document.layout import fits
from reportgen.formula import Expression, Symbol, VectorEquation
from reportgen.formula.formula_layout import (
    NAMED,
    Fence,
    Parenthesis,
    Role,
    Sign,
    TermColumn,
    Written,
    columns,
    is_tall,
    parted,
    short_end,
    sides,
)
from reportgen.formula.formula_setter import TextSetter
from reportgen.formula.vocabulary import numbered, runs

NARROW_TERMS = 5
"""Largest number of terms of a vector equation that fits any line."""

_CHARACTERS = json.loads(Path(__file__).with_name("characters.json").read_text(encoding="utf-8"))
SPECIAL: dict[str, str] = _CHARACTERS["special"]
"""ASCII characters that TeX would interpret as commands or as other signs."""

_LIGATURES = re.compile(r"([-,])(?=\1)")
"""Characters that fonts would join into one sign: -- ,,"""

MATHEMATICAL: dict[str, str] = _CHARACTERS["mathematical"]
"""Characters that the frame declares with this mathematics, in text and in formulas alike."""

TEXTUAL: dict[str, str] = _CHARACTERS["textual"]
"""Characters that the frame declares with these text commands, in text and in formulas alike."""

_VIETNAMESE = frozenset(
    "ÀÁÂÃÈÉÊÌÍÒÓÔÕÙÚÝàáâãèéêìíòóôõùúýĂăĐđĨĩŨũƠơƯưẠạẢảẤấẦầẨẩẪẫẬậẮắẰằẲẳẴẵẶặẸẹẺẻẼẽẾếỀềỂểỄễỆệỈỉỊịỌọỎỏỐốỒồỔổỖỗỘộ"
    "ỚớỜờỞởỠỡỢợỤụỦủỨứỪừỬửỮữỰựỲỳỴỵỶỷỸỹ–—‘’‚“”„‹›«»"
)
_OTHER_LATIN = frozenset("ÄÅÆÇËÎÏÐÑÖØÛÜÞßäåæçëîïðñöøûüþÿĄąĆćČčĎďĘęĚěĞğİıĹĺĽľŁłŃńŇňŐőŒœŔŕŘřŚśŞşŠšŤťŮůŰűŸŹźŻżŽžȘșȚț¡¿")
_DECLARED = frozenset(MATHEMATICAL) | frozenset(TEXTUAL)


def declarations() -> tuple[tuple[str, str], ...]:
    """Return code point (hexadecimal) and definition of every character that the frame declares."""
    mathematics = ((char, rf"\ensuremath{{{code}}}") for char, code in MATHEMATICAL.items())
    words = ((char, rf"\reporttextual{{{code}}}") for char, code in TEXTUAL.items())
    return tuple((f"{ord(char):04X}", code) for char, code in (*mathematics, *words))


def escape(text: str) -> str:
    """Return the LaTeX source that prints `text` as typed.

    Raises `TypesetterError` naming the first character that the fonts do not have.
    """
    source = unicodedata.normalize("NFC", text).translate(_SOURCES)
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


class _Sources(dict[int, str]):
    """Cache of the source of each character, by code point."""

    def __missing__(self, number: int) -> str:
        self[number] = _character(chr(number))
        return self[number]


_SOURCES = _Sources()


def hexadecimal(text: str) -> str:
    """Return the content of a PDF string in UTF-16, in hexadecimal digits."""
    return "FEFF" + unicodedata.normalize("NFC", text).encode("utf-16-be").hex().upper()


# --- formulas -------------------------------------------------------------------------------------


class LatexFormulas(TextSetter):
    r"""Writer of formulas with possible line breaks: \relbreak, \binbreak, \dotbreak."""

    BELOW = r"%s_{\scriptstyle{%s}}"
    RAISED = POWER = "%s^{%s}"
    QUOTIENT, RADICAL = r"\frac{%s}{%s}", r"\sqrt{%s}"
    FENCES: ClassVar = {"": "%s", "(": "(%s)", "|": r"\lvert %s\rvert "}
    ENTRY, LINE = " & ", r" \\ "
    APPLIED = "%s %s"
    NOTE = r" \relbreak\quad\text{%s}"
    SIGNS: ClassVar = {"·": r"\cdot", "×": r"\times", "−": "-"}
    BREAKS: ClassVar[Mapping[Role, str]] = {"sum": r"\binbreak", "product": r"\dotbreak", "relation": r"\relbreak"}
    AHEAD: ClassVar[Mapping[Role, str]] = {"prefix": "", "slash": "", "separator": ""}
    """Text before a sign that has no space on its left."""
    BEHIND: ClassVar[Mapping[Role, str]] = {"prefix": "", "slash": "", "first": r"\nobreak "}

    def text(self, text: str) -> str:
        return escape(text)

    def upright(self, letters: str) -> str:
        return _word(letters)

    def inline(self, mathematics: str) -> str:
        return f"${mathematics}$"

    def sign(self, sign: Sign) -> str:
        text = self.BREAKS.get(sign.role, "") + self.SIGNS.get(sign.of, sign.of)
        return self.AHEAD.get(sign.role, " ") + text + self.BEHIND.get(sign.role, " ")

    def fence(self, fence: Fence) -> str:
        if fence.left == "[":
            return _bracketed(rf"\begin{{matrix}}{self.part(fence.of)}\end{{matrix}}")
        if fence.left == "(" and is_tall(fence.of):
            return rf"\mathopen{{}}\left({self.part(fence.of)}\right)"
        return super().fence(fence)

    def mark(self, mark: Parenthesis) -> str:
        return {"(": r"\Bigl(", ")": r"\Bigr)"}[mark.of] if mark.tall else mark.of

    def function(self, name: str) -> str:
        return rf"\{name}" if name in NAMED else rf"\operatorname{{{escape(name)}}}"

    def number(self, number: Written) -> str:
        """Return digits without a gap after the decimal comma and with a true minus sign, and the unit."""
        if any(char.isdigit() for char in number.digits):
            digits = number.digits.replace(",", "{,}").replace(MINUS, "-")
        else:
            digits = rf"\text{{{escape(number.digits)}}}"
        gap = r"\," if number.spaced else ""
        return digits + (rf"{gap}\text{{{escape(number.unit)}}}" if number.unit else "")

    def symbol(self, node: Symbol) -> str:
        letters, above = parted(node)
        single = len(letters) == 1 and _is_mathematical(letters)
        base = letters if single else self.lowered(runs(letters), lambda part: _word(part, "it"))
        if node.over == "vector":
            base = rf"\vec{{{base}}}" if len(letters) == 1 else rf"\overrightarrow{{{base}}}"
        below = f"_{{{self.lowered(numbered(node.sub), self.upright)}}}" if node.sub else ""
        marked = base + below + (f"^{{{_word(above)}}}" if above else "")
        return rf"\overline{{{marked}}}" if node.over == "segment" else marked

    def aligned(self, node: Expression) -> tuple[str, str]:
        """Return a displayed line split at its first relation: the left side, and the rest.

        A vector equation is a grid and is not split.
        """
        if isinstance(node, VectorEquation):
            return "", self._vector_equation(columns(node), node.rows)
        first, *others = map(self.part, sides(node, self.language, fits))
        rest = [r" \relbreak= " + side for side in others]
        if rest and short_end(node):
            rest[-1] = f" = {others[-1]}"
        return (first, "".join(rest)) if others else ("", first)

    # --- vector equations -------------------------------------------------------------------------

    def _vector_equation(self, terms: Sequence[TermColumn], rows: Sequence[str]) -> str:
        """Return a grid; if it is too wide for the line, two grids of half the terms, one below the other."""
        whole = self._grid(terms, rows)
        if len(terms) <= NARROW_TERMS:
            return whole
        half = (len(terms) + 1) // 2
        upper, lower = (self._vector_equation(part, rows) for part in (terms[:half], terms[half:]))
        return rf"\fitting{{{whole}}}{{\storeys{{{upper}}}{{{lower}}}}}"

    def _grid(self, terms: Sequence[TermColumn], rows: Sequence[str]) -> str:
        """Return terms on top, with the known data of each below; "?" marks an unknown."""
        signs = ("".join(self.SIGNS.get(sign.of, sign.of) for sign in term.signs) for term in terms)
        lines = ["&" + "&".join(f"{sign}&{self.part(one.term)}" for sign, one in zip(signs, terms, strict=True))]
        for row, name in enumerate(rows):
            known = "&".join(rf"&\known{{{self.known(term.known[row])}}}" for term in terms)
            lines.append(rf"\rowname{{{escape(name)}}}&{known}")
        if rows:
            lines[1] = rf"\cline{{2-{2 * len(terms) + 1}}}{lines[1]}"
        body = r"\\".join(lines)
        return rf"\begin{{vectorgrid}}{{{len(terms)}}}{body}\end{{vectorgrid}}"


def _bracketed(inner: str) -> str:
    """Return square brackets as tall as their content; copied from the page, they are single characters."""
    strut = rf"\vphantom{{{inner}}}"
    opening = rf"\mathopen{{\reportactual{{005B}}{{\left[{strut}\right.\kern-\nulldelimiterspace}}}}"
    closing = rf"\mathclose{{\reportactual{{005D}}{{\kern-\nulldelimiterspace\left.{strut}\right]}}}}"
    return opening + inner + closing


def _is_mathematical(text: str) -> bool:
    return all(char in MATHEMATICAL or (char.isascii() and char.isalnum()) for char in text)


def _word(text: str, shape: Literal["rm", "it"] = "rm") -> str:
    """Return a run of letters in one alphabet of TeX; other characters are set as text."""
    if text.isdigit() and text.isascii():
        return text
    primes = {"′": r"\prime", "″": r"\prime\prime"}
    if text and all(char in primes for char in text):
        return "".join(primes[char] for char in text)
    if _is_mathematical(text):
        return rf"\math{shape}{{{text}}}"
    return rf"\text{{\text{'it' if shape == 'it' else 'up'}{{{escape(text)}}}}}"
