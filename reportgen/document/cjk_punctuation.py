"""Punctuation of languages that write no spaces between words, such as Chinese: `set_out` adapts a line.

Code writes blanks, commas and parentheses between inlines as in English. In a line with letters of such a language,
punctuation becomes full-width, and spaces beside it or beside such letters are removed. Only a formula or a value keeps
a space beside a letter, because typesetters leave a gap between two scripts; between plain letters they add it
themselves.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from reportgen.base.languages import Language, setting_of
from reportgen.document import inlines as tree
from reportgen.formula import Symbol

_NARROW, _FORMULAS, _WIDE = 0xF0000, 0xF8000, 0x100000
"""First private characters that represent inlines other than text, by how the inlines begin and end."""
# Patterns are texts, which `re` compiles at their first use: sets of so many letters take it long, and only such
# languages need them.
_W = "\u2e80-\u303f\u3400-\u4dbf\u4e00-\u9fff\uf900-\ufaff\uff01-\uff5e\U00100000-\U0010fffd"
"""Han letters, and marks as wide as these."""
_HELD = "\U000f0000-\U000fffef"
_HAN = "\u3400-\u4dbf\u4e00-\u9fff"
_MATH = "\U000f8000-\U000fffef"
_WIDE_LETTER = f"[{_W}]"
_MARKS: Mapping[str, str] = {",": "，", ";": "；", ":": "：", ".": "。", "?": "？", "!": "！"}
_PARENTHESES = re.compile(r" *\(([^()]*)\)")
_TERMS = re.compile("[+−·]|cos|sin")
_AFTER = f"(?<=[{_W}]) *[,;:?!] *|(?<=[{_W}]) *\\.(?= |$) *"
_MARK = f"{_AFTER}|[,;:.?!] +(?=[{_W}])|(?<=[^\\W_]|[{_HELD})°%])[.;:]$"
_BETWEEN = f"(?<=[^ {_W}])([,;:]) (?=[^ {_W}])"
_FORMULA = f"(?<=[{_HAN}])(?=[{_MATH}])|(?<=[{_MATH}])(?=[{_HAN}])"
_BLANK = f"(?<=[{_W}]) +(?![=<>≥≤≈±×·→≡−+–])|(?<![=<>≥≤≈±×·→≡−+–]) +(?=[{_W}])"


def unspaced(inlines: tree.Inlines) -> tree.Inlines:
    """Return a line with Chinese punctuation; a line without a Chinese letter is returned unchanged."""
    held: list[tree.Inline] = []
    line = "".join(_letters(inline, held) for inline in inlines)
    if not re.search(_WIDE_LETTER, line):
        return inlines
    symbols = {chr(_FORMULAS + n) for n, one in enumerate(held) if _is_symbol(one)}
    return tuple(_inlines(_set(line, symbols), held))


def set_out(inlines: tree.Inlines, language: Language) -> tree.Inlines:
    """Return a line with the punctuation of its language."""
    return inlines if setting_of(language).spaced else unspaced(inlines)


def _set(line: str, symbols: set[str]) -> str:
    """Return the text of a line with its marks; private characters represent the inlines that are not text."""

    def parenthesis(match: re.Match[str]) -> str:
        around = line[: match.start()][-1:] + match[1] + line[match.end() :][:1]
        # A blank before it makes it a remark; with a sum or a product in it, it is part of a formula.
        remark = match[0][0] == " " or re.search(_WIDE_LETTER, around)
        formula = _TERMS.search(match[1]) and not re.search(_WIDE_LETTER, match[1])
        return f"（{match[1]}）" if remark and not formula else match[0]

    def between(match: re.Match[str]) -> str:
        if match[1] != ",":
            return _MARKS[match[1]]
        sides = match.string[match.start() - 1], match.string[match.end()]
        return "、" if all(side.isalnum() or side in symbols for side in sides) else "，"

    line = _PARENTHESES.sub(parenthesis, line)
    line = re.sub(_MARK, lambda match: _MARKS[match[0].strip()[0]], line)
    return re.sub(_FORMULA, " ", re.sub(_BLANK, "", re.sub(_BETWEEN, between, line)))


def _letters(inline: tree.Inline, held: list[tree.Inline]) -> str:
    """Return the text for an inline in its line: its letters, or one private character."""
    if isinstance(inline, tree.Text):
        return inline.text
    begins = _FORMULAS if isinstance(inline, (tree.InlineMath, tree.Value)) else _NARROW
    if isinstance(inline, (tree.Emph, tree.Strong)):
        inner = "".join(one.text for one in inline.of if isinstance(one, tree.Text))
        begins = _WIDE if re.search(_WIDE_LETTER, inner) else _NARROW
        inline = type(inline)(unspaced(inline.of))
    held.append(inline)
    return chr(begins + len(held) - 1)


def _is_symbol(inline: tree.Inline) -> bool:
    return isinstance(inline, tree.InlineMath) and isinstance(inline.expression, Symbol)


def _inlines(line: str, held: list[tree.Inline]) -> list[tree.Inline]:
    """Return the inlines of a line from its text, in which private characters represent those in `held`."""
    parts: list[tree.Inline] = []
    for piece in re.split(f"([{_HELD}\U00100000-\U0010fffd])", line):
        if len(piece) == 1 and ord(piece) >= _NARROW:
            parts.append(held[ord(piece) - max(one for one in (_NARROW, _FORMULAS, _WIDE) if one <= ord(piece))])
        elif piece:
            parts.append(tree.Text(piece))
    return parts
