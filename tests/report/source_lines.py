"""Worked lines read from a typesetter's source, as text in the plain notation of the calculator.

Each reader finds the formulas of its source and writes them in one line; what is no number, sign or function becomes
`?`, so that only substitutions and results are read as numbers.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from tests.report.calculator import RESULT, Line, is_calculation

KNOWN = frozenset({"sin", "cos", "tan", "arcsin", "arccos", "arctan", "arctan2", "sqrt", "abs"})


@dataclass(frozen=True, slots=True)
class Formula:
    """What "=" joins: the first part as it stands in the source, all in plain notation."""

    symbol: str
    parts: tuple[str, ...]

    @property
    def steps(self) -> Iterator[Line]:
        """Every calculation that a result follows; a number in another unit is one, too."""
        for left, right in pairwise(self.parts):
            number = RESULT.fullmatch(left)
            if RESULT.fullmatch(right) and (number or is_calculation(left)):
                yield Line(self.symbol, number["number"] if number and number["unit"] != "°" else left, right)

    @property
    def result(self) -> str:
        """The number that it ends in, without its unit; "" for none."""
        found = RESULT.fullmatch(self.parts[-1]) if len(self.parts) > 1 else None
        return found["number"] if found else ""


def worked_lines(formulas: Iterable[Formula]) -> list[Line]:
    return [line for formula in formulas for line in formula.steps]


def _formula(source: str, line: str) -> Formula:
    # A reason stands behind the result.
    parts = (part.partition("|")[0].strip() for part in line.split("="))
    return Formula(source.partition("=")[0].strip(), tuple(parts))


def plain(text: str) -> str:
    """Digits with a decimal point and a plain minus; of a name or a unit its letters."""
    return re.sub(r"(?<=\d),(?=\d)", ".", text).replace("−", "-")


# --- Typst ----------------------------------------------------------------------------------------

STRING = r'"(?:[^"\\]|\\.)*"'
_JOINED = (
    (re.compile(r"\$,\),\(\$"), " = "),
    (re.compile(rf"\$,\$|\$\)\) #box\(M\({STRING},\$"), " "),
    (re.compile(r'class\("punctuation", "[,;]"\)'), ";"),
    (re.compile(r'class\("(?:opening|closing)", lr\(size: #\d+%, \\([()])\)\)'), r"\1"),
)
"""The sides of a displayed row; the pieces of a side, or the boxes of a line of text; two arguments; a sum's ends."""
_TYPST_FORMULA = re.compile(rf'\$((?:{STRING}|[^"$])*)\$')
_TYPST_TOKEN = re.compile(rf"{STRING}|[a-zA-Z]+(?:\.[a-z]+)*|.", re.DOTALL)
_TYPST_SIGNS = {"dot.c": "·", "−": "-", "quad": "|", "thin": ""}


def typst_formulas(source: str) -> list[Formula]:
    """The formulas of a Typst source, in their order."""
    return [typst_formula(match[1]) for match in _TYPST_FORMULA.finditer(joined(source))]


def joined(source: str) -> str:
    """A Typst source with each formula in one piece."""
    for pattern, between in _JOINED:
        source = pattern.sub(between, source)
    return source


def typst_formula(source: str) -> Formula:
    tokens = [token for token in _TYPST_TOKEN.findall(joined(source)) if not token.isspace()]
    return _formula(source, "".join(_plain_typst(tokens)))


def _plain_typst(tokens: Sequence[str]) -> Iterator[str]:
    at = 0
    while at < len(tokens):
        token = tokens[at]
        if token in ("frac", "op"):
            comma, close = _typst_end(tokens, at + 2, ",)"), _typst_end(tokens, at + 2, ")")
            if token == "frac":
                top, bottom = (_plain_typst(part) for part in (tokens[at + 2 : comma], tokens[comma + 1 : close]))
                yield f"(({''.join(top)})/({''.join(bottom)}))"
            else:
                yield tokens[at + 2].strip('"')
            at = close
        elif token.startswith('"'):
            yield plain(token[1:-1])
        elif token in _TYPST_SIGNS:
            yield _TYPST_SIGNS[token]
        else:
            yield token if token in KNOWN or token in "+-/^();=π" else "?"
        at += 1


def _typst_end(tokens: Sequence[str], start: int, ends: str) -> int:
    """Where an argument that begins at a place ends."""
    depth = 0
    for at in range(start, len(tokens)):
        if depth == 0 and tokens[at] in ends:
            return at
        depth += (tokens[at] == "(") - (tokens[at] == ")")
    raise ValueError("".join(tokens))


# --- LaTeX ----------------------------------------------------------------------------------------

_LATEX_START = re.compile(r"\\[RL](?=\{)|(?<!\\)\$")
_LATEX_TOKEN = re.compile(r"\\[a-zA-Z]+|\\.|\d[\d.]*(?:\{,\}\d+)?|.", re.DOTALL)
_LATEX_SIGNS = {r"\cdot": "·", r"\quad": "|", r"\lvert": "abs(", r"\rvert": ")", ",": ";"}
_LATEX_WHITE = frozenset(
    {
        r"\left",
        r"\right",
        r"\Bigl",
        r"\Bigr",
        r"\mathopen",
        r"\,",
        r"\nobreak",
        r"\relbreak",
        r"\binbreak",
        r"\dotbreak",
        "{",
        "}",
    }
)


def latex_formulas(source: str) -> list[Formula]:
    """The formulas of a LaTeX source, in their order: rows in two groups, and mathematics within words."""
    found: list[Formula] = []
    at = source.index(r"\begin{document}")
    while match := _LATEX_START.search(source, at):
        if match[0] == "$":
            end = source.index("$", match.end())
            formula, at = source[match.end() : end], end + 1
        else:
            left, at = _group(source, match.end())
            right, at = _group(source, at) if source.startswith("{", at) else ("", at)
            formula = left + right
        found.append(_formula(formula, plain_latex(formula)))
    return found


def _group(text: str, at: int) -> tuple[str, int]:
    """What stands in the braces that open at a place, and the place behind them."""
    depth = 0
    for match in re.finditer(r"\\.|[{}]", text[at:]):
        depth += (match[0] == "{") - (match[0] == "}")
        if depth == 0:
            return text[at + 1 : at + match.start()], at + match.end()
    raise ValueError(text[at : at + 80])


def plain_latex(formula: str) -> str:
    """A formula of LaTeX in plain notation."""
    text, at = "", 0
    while match := _LATEX_TOKEN.match(formula, at):
        token, at = match[0], match.end()
        name = token.removeprefix("\\")
        if name in ("frac", "sqrt", "text", "operatorname") or formula.startswith("^{", match.start()):
            inner, at = _group(formula, at)
            match name:
                case "frac":
                    bottom, at = _group(formula, at)
                    text += f"(({plain_latex(inner)})/({plain_latex(bottom)}))"
                case "text" | "operatorname":
                    text += plain(inner.replace("\\", ""))
                case _:
                    text += f"{name}({plain_latex(inner)})"
        elif token in _LATEX_SIGNS:
            text += _LATEX_SIGNS[token]
        elif token[0].isdigit():
            text += token.replace("{,}", ".")
        elif name in KNOWN or token in "+-/^();=π":
            text += name
        elif not token.isspace() and token not in _LATEX_WHITE:
            text += "?"
    return text
