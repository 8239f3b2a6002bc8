"""A formula's parentheses: the layout puts them, and every look shows these and no others."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.cases import open_case
from reportgen.formula import Chain, Expression, Number, Symbol, call, cos, rebuild, sin, sqrt
from reportgen.formula.formula_layout import Part, laid
from reportgen.formula.plain_text import Plain
from reportgen.page.svg_elements import MathmlFormulas, Runs
from reportgen.sheets.dxf import MText
from reportgen.writers.latex_math import LatexFormulas
from reportgen.writers.typst_math import TypstFormulas
from reportgen.writers.word_math import OmmlFormulas
from tests.writers import sample

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
FILES = [ASSIGNMENTS / f"{name}.yaml" for name in ("shaper-01", "engine-v-01", "linkage-8", "plane-motion/12")]
R, PHI, A, B = Symbol("R"), Symbol("φ"), Symbol("a"), Symbol("b")


def in_letters(text: str) -> str:
    return "".join(re.findall(r"[()|]", text))


def in_typst(source: str) -> str:
    """A parenthesis behind a name, ^ or _ belongs to Typst's own syntax."""
    source = re.sub(r'"(\\.|[^"\\])*"', "·", source)
    found: list[str] = []
    closing: list[str] = []
    for match in re.finditer(r"(abs|[a-z^_])?\(|\)", source):
        if match[0] == ")":
            found.append(closing.pop())
            continue
        opening = {None: "(", "abs": "|"}.get(match[1], "")
        closing.append({"(": ")"}.get(opening, opening))
        found.append(opening)
    return "".join(found)


def in_latex(source: str) -> str:
    return "".join(re.findall(r"[()|]", source.replace(r"\lvert", "|").replace(r"\rvert", "|")))


def in_mathml(source: str) -> str:
    return "".join(re.findall(r"<mo[^>]*>([()|])</mo>", source))


def fences(part: Part, language: Language) -> dict[str, str]:
    """The parentheses and bars that each typesetter shows of a formula."""
    return {
        "typst": in_typst(TypstFormulas(language).part(part)),
        "latex": in_latex(LatexFormulas(language).part(part)),
        "mathml": in_mathml(MathmlFormulas(language).part(part)),
    }


def fences_of_text(part: Part, language: Language) -> dict[str, str]:
    """The same of each look that sets letters in a line."""
    return {
        "plain": in_letters(Plain(language).part(part)),
        "dxf": in_letters(MText(language).part(part)),
        "svg": in_letters("".join(run.text for run in Runs(language).part(part))),
    }


def bare(node: Expression) -> Expression:
    """The expression without parentheses in names, units and notes, which are no part of its structure."""
    match node:
        case Symbol(sub=sub, sup=sup):
            return replace(node, sub=re.sub(r"[()]", "", sub), sup=re.sub(r"[()]", "", sup))
        case Number(unit=unit):
            return replace(node, unit=re.sub(r"[()]", "", unit))
        case Chain():
            return rebuild(replace(node, note=""), bare)
    return rebuild(node, bare)


def of_ledger(path: Path) -> list[Expression]:
    """Every worked line of a report at its first position."""
    ledger = open_case(path).ledger
    return [ledger.chain(id, 0) for id, family in ledger.families.items() if family.line is not None]


def differing(nodes: list[Expression], language: Language, text: bool, slashed: bool = False) -> list[str]:
    found = []
    for node in map(bare, nodes):
        part = laid(node, language, slashed, linear=text)
        shown = fences(part, language) | (fences_of_text(part, language) if text else {})
        if len(set(shown.values())) > 1:
            found.append(f"{Plain(language).math(node)}: {shown}")
    return found


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_look_shows_the_same_parentheses(path: Path) -> None:
    lines = of_ledger(path)
    assert any("(" in in_letters(Plain("vi").math(line)) for line in lines)
    assert not differing(lines, "vi", text=True)
    assert not differing(lines, "vi", text=False)
    assert not differing(lines, "vi", text=False, slashed=True)


def test_every_look_shows_the_same_parentheses_in_every_case() -> None:
    nodes = [*sample.expressions(), sin(PHI) ** 2, A / (B / R), sqrt(A + B) / R, abs(A - B) * R]
    for language in ("vi", "en"):
        assert not differing(nodes, language, text=True)
        assert not differing(nodes, language, text=False)
        assert not differing(nodes, language, text=False, slashed=True)


@pytest.mark.parametrize("look", [Plain("en"), MText("en")], ids=["plain", "dxf"])
def test_text_in_a_line_has_parentheses_where_a_page_has_a_bar_or_a_raised_letter(look: Plain) -> None:
    shown = look.math(R * sqrt(A / (B + R)) * cos(PHI))
    assert shown == "R·√(a/(b + R))·cos(φ)"


@pytest.mark.parametrize(
    ("node", "text"),
    [
        (R * (1.0 - cos(PHI)), "R·(1 − cos(φ))"),
        (R * -A, "R·(−a)"),
        (A / (B * R), "a/(b·R)"),
        ((A * B) ** 2, "(a·b)2"),
        (sqrt(A * B), "√(a·b)"),
        (A - (B + R), "a − (b + R)"),
    ],
)
def test_labels_of_drawings_in_a_page_keep_their_parentheses(node: Expression, text: str) -> None:
    assert "".join(run.text for run in Runs("en").math(node)) == text


def test_a_missing_parenthesis_would_be_seen() -> None:
    assert fences(laid(R * (A + B), "en"), "en") == dict.fromkeys(("typst", "latex", "mathml"), "()")
    assert fences(laid(R * A, "en"), "en") == dict.fromkeys(("typst", "latex", "mathml"), "")


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        (Number(7.16e16, -14, "N"), "7,16·10^16 N"),
        (A * Number(7.16e16, -14), "a·7,16·10^16"),
        (A / Number(7.16e16, -14), "a/(7,16·10^16)"),
        (Number(-4.4e9, -8) ** 2, "(−4,4·10^9)^2"),
        (Number(2.0944e-7, 11), "2,0944·10^(−7)"),
        (Number(5e9, 0), "5·10^9"),
        (Number(9_999_999.6, 0), "10000000"),
        (Number(0.0, -14), "0"),
        (Number(0.00001234, 8), "0,00001234"),
    ],
)
def test_an_extreme_number_has_a_power_of_ten(expression: Expression, text: str) -> None:
    """It is a product, and has parentheses where a product has them."""
    assert Plain("vi").math(expression) == text


def test_inv_stands_upright_in_every_look() -> None:
    """A function's name in a symbol, inv α_w, is set as that of a function that is applied, arcinv(inv α_w)."""
    involute = Symbol("inv α", "w")
    line = Chain((Symbol("α", "w"), call("arcinv", involute)))
    assert TypstFormulas("en").math(line).count('op("inv")') == 1
    assert TypstFormulas("en").math(line).count('op("arcinv")') == 1
    assert r"\operatorname{arcinv}(\operatorname{inv} α" in LatexFormulas("en").math(line)
    assert '<mi mathvariant="normal">inv</mi>' in MathmlFormulas("en").math(line)
    named = OmmlFormulas("en").math(involute)
    assert re.search(r"<m:fName><m:r><m:rPr>.*<m:nor/>.*inv.*</m:fName>", named)
    label = Runs("en").math(involute)
    assert "".join(run.text for run in label) == "inv αw"
    assert [run.italic for run in label if run.text in ("inv", "α")] == [False, True]
    assert MText("en").math(involute).startswith("inv α")
    assert Plain("en").math(line) == "α_w = arcinv(inv α_w)"
