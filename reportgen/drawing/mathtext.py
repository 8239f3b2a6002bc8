"""Convert formulas to mathtext, which matplotlib sets between dollar signs in labels and legends."""

from __future__ import annotations

import re
from typing import ClassVar

from reportgen.base.records import replace
from reportgen.formula import Chain, Expression, Symbol
from reportgen.formula.formula_layout import NAMED, Fence, Sign, Written, is_tall, parted
from reportgen.formula.formula_setter import TextSetter
from reportgen.formula.vocabulary import numbered, runs

MEANT = {sign: f"\\{sign}" for sign in "$%_#&{}"} | {"\\": r"\backslash ", "^": r"\hat{}", " ": r"\ ", ",": "{,}"}
"""Escapes of letters that have a meaning in mathtext."""

_EXPONENT = re.compile("([⁺⁻⁰¹²³⁴-⁹]+)")
_LEVEL = str.maketrans("⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "+-0123456789")


def _upright(letters: str) -> str:
    return r"\mathrm{" + "".join(MEANT.get(one, one) for one in letters) + "}" if letters else ""


class MathText(TextSetter):
    """Setter of formulas as mathtext."""

    BELOW = "{%s}_{%s}"
    RAISED = POWER = "{%s}^{%s}"
    QUOTIENT, RADICAL = r"\frac{%s}{%s}", r"\sqrt{%s}"
    SIGNS: ClassVar = {"·": r"\cdot ", "×": r"\times ", "−": "-"}

    def label(self, content: Expression | str) -> str:
        """Return a label of matplotlib: plain text, or mathematics, followed by a note as text."""
        if isinstance(content, str):
            return content.replace("$", r"\$")
        if isinstance(content, Chain) and content.note:
            return f"{self.label(replace(content, note=''))} ({self.label(content.note)})"
        return f"${self.math(content)}$"

    def text(self, text: str) -> str:
        """Return upright letters; exponents of units are raised, since not every font has all of them."""
        pieces = _EXPONENT.split(text)
        return "".join(
            f"^{{{piece.translate(_LEVEL)}}}" if index % 2 else _upright(piece) for index, piece in enumerate(pieces)
        )

    def fence(self, fence: Fence) -> str:
        inner = self.part(fence.of)
        match fence.left:
            case "(" if is_tall(fence.of):
                return rf"\left({inner}\right)"
            case "|":
                return rf"\left|{inner}\right|"
        return self.FENCES[fence.left] % inner

    def sign(self, sign: Sign) -> str:
        return self.SIGNS.get(sign.of, sign.of)

    def function(self, name: str) -> str:
        return rf"\{name} " if name in NAMED else self.text(name)

    def number(self, number: Written) -> str:
        return self.text(number.text(" "))

    def symbol(self, node: Symbol) -> str:
        """Return a symbol with its marks: base in italics, sub- and superscript upright, a bar over all of it."""
        letters, above = parted(node)
        base = self.lowered(runs(letters), lambda part: rf"\mathit{{{part}}}" if part.isalpha() else self.text(part))
        if node.over == "vector":
            base = rf"\vec{{{base}}}"
        below = f"_{{{self.lowered(numbered(node.sub), self.upright)}}}" if node.sub else ""
        marked = f"{{{base}}}{below}" + (f"^{{{self.text(above)}}}" if above else "")
        return rf"\overline{{{marked}}}" if node.over == "segment" else marked
