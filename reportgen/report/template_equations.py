"""Functions for templates that print symbols, values and worked lines.

Templates call all functions here by their own names, without `report`; the values come from the ledger.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from reportgen.base.languages import setting_of
from reportgen.base.placeholders import NO_LETTER
from reportgen.derivation.equation_sides import Side
from reportgen.derivation.kinematic_entries import What
from reportgen.derivation.load_entries import Polygon
from reportgen.document import Equation, Inline, InlineMath, Inlines, Text, Value, listed
from reportgen.document.template_rendering import subscripted
from reportgen.formula import (
    Chain,
    Expression,
    Number,
    Ref,
    Symbol,
    Term,
    VectorEquation,
    ids,
    rebuild,
    refs,
    sqrt,
    substitute,
    tan,
    vocabulary,
)
from reportgen.formula.vocabulary import on_plan, segment
from reportgen.machine import mobility
from reportgen.report.assur_view import AssurView
from reportgen.report.context import ReportContext
from reportgen.report.link_views import Contact

# --- numbers and symbols


def symbol(report: ReportContext, id: str) -> Symbol:
    """Return the symbol of a quantity."""
    return report.ledger.symbol(id)


def math(report: ReportContext, text: str) -> Symbol:
    """Return the symbol that a template writes as `$…$`: that of a quantity by its id, else letters with their index.

    Raises `LookupError` if the text does not begin with a letter, since then it has no base for an index.
    """
    if text in report.ledger:
        return report.ledger.symbol(text)
    base = re.match(r"[^\W\d_]+", text)
    if base is None or not re.fullmatch(r"[\w.]+", text):
        raise LookupError(text)
    return report.named(Symbol(base[0], text[base.end() :].removeprefix("_")))


def value(report: ReportContext, id: str, position: int | None = None, size: bool = False) -> Value:
    """Return a quantity's number with its unit; `size` removes its sign."""
    return Value(report.ledger.number(id, position, size=size))


def typed(report: ReportContext, id: str) -> Inline:
    """Return a datum as its file has it; a ratio such as 1/30 stays a ratio."""
    ratio = report.ledger[id].definition
    return value(report, id) if ratio is None else InlineMath(ratio, slashed=True)


def quantity(report: ReportContext, id: str, position: int | None = None) -> Inlines:
    """Return a quantity as "symbol = number" for running text."""
    return InlineMath(symbol(report, id)), Text(" = "), value(report, id, position)


def directions(report: ReportContext, what: What, position: int) -> Inlines:
    """Return "symbol = angle" for the directions of all points on a plan ("v", "a"); a point at rest has none."""
    moving = [
        id
        for id, family in report.ledger.families.items()
        if (names := ids.direction.read(id)) and names["what"] == what and np.isfinite(family.at(position))
    ]
    return tuple(part for id in moving for part in (Text("; "), *quantity(report, id, position)))[1:]


def known(report: ReportContext, id: str) -> bool:
    """Return True if the ledger has a quantity."""
    return id in report.ledger


def point(report: ReportContext, name: str) -> Symbol:
    """Return the symbol of a point, e.g. S with a subscript 2."""
    return vocabulary.point(name)


def points(report: ReportContext, names: Iterable[object]) -> Inlines:
    """Return the symbols of points, separated by commas."""
    return listed(InlineMath(vocabulary.point(str(name))) for name in names)


def image(report: ReportContext, name: str, prime: bool = False) -> Symbol:
    """Return the symbol of a point's image on a plan."""
    return vocabulary.on_plan(name, prime)


def letters(report: ReportContext, base: str, sub: str | int = "", sup: str = "") -> Symbol:
    """Return a symbol of any letters."""
    return Symbol(base, str(sub), sup)


def vector(report: ReportContext, base: str, sub: str | int = "", sup: str = "") -> Symbol:
    """Return a symbol of any letters with an arrow."""
    return report.named(Symbol(base, str(sub), sup, "vector"))


def v(report: ReportContext, of: str | Side) -> Symbol:
    """Return the velocity vector of a point; of a side, the relative one."""
    return Symbol("v", of if isinstance(of, str) else of.pair, over="vector")


def a(report: ReportContext, of: str | Side, part: str = "") -> Symbol:
    """Return the acceleration vector of a point, or a component of it; of a side, the relative one."""
    return report.named(Symbol("a", of if isinstance(of, str) else of.pair, part, "vector"))


def R(report: ReportContext, digits: str, part: str = "") -> Symbol:
    """Return the reaction vector in a joint, or a component of it."""
    return Symbol("R", digits, part, "vector")


def lowered(report: ReportContext, text: str) -> str:
    """Return point names with their digits as subscripts: O1A → O₁A."""
    return subscripted(text)


def group_kind(report: ReportContext, group: AssurView) -> str:
    """Return the name of a group's kind."""
    return str(report.words["groups"][group.kind])


def stroke_name(report: ReportContext, link: int, position: int) -> str:
    """Return the name of the stroke that a piston is on at a position."""
    return str(report.words["strokes"][int(report.analysis.gas[ids.applied_force(link)].stroke[position - 1])])


def force_list(report: ReportContext, group: AssurView, position: int) -> Inlines:
    """Return the known edges of a force plan with their drawn lengths: ef = 40.30 mm for P_qt5, h ≡ i for a
    zero force.
    """
    assert group.polygon is not None
    inlines: list[Inline] = []
    for edge in group.polygon.edges:
        if not edge.unknown:
            drawn = ids.force_segment(group.name, edge.name)
            force: Inlines = (InlineMath(report.force_symbol(edge.name)),)
            length = quantity(report, drawn, position)
            if report.is_zero(drawn, position):
                length = InlineMath(Symbol(edge.start)), Text(" ≡ "), InlineMath(Symbol(edge.end))
                force += (Text(" = 0"),)
            inlines += [*((Text(", "),) if inlines else ()), *length, Text(" ("), *force, Text(")")]
    return tuple(inlines)


# --- the sense of forces


def by_moments(report: ReportContext, group: AssurView, position: int) -> Inlines:
    """Return the symbols of the reactions of a group that moments give; zero ones are left out."""
    sought = (id for id in group.by_moments if not report.is_zero(id, position))
    return listed(InlineMath(report.ledger.symbol(id)) for id in sought)


def senses(report: ReportContext, joints: Iterable[str], position: int) -> Inlines:
    """Return the directions of the reactions of some joints, in words and as angles; zero reactions are left out."""
    inlines: list[Inline] = []
    for digits in joints:
        if not report.is_zero(ids.reaction(digits), position):
            force = ids.reaction_force(digits)
            vector, angle = report.force_vector(force), report.ledger.number(ids.force_direction(force), position)
            inlines += [*((Text("; "),) if inlines else ()), InlineMath(vector), *_pointing(report, angle)]
    return tuple(inlines)


def slider_ways(report: ReportContext) -> Inlines:
    """Return the positive direction of each slider's velocity and acceleration, in words and with its angle from +x."""
    inlines: list[Inline] = []
    for pin, along in report.slider_senses.items():
        degrees = round(float(np.degrees(np.angle(along))), 2) % 360.0
        symbols = InlineMath(Symbol("v", pin)), Text(", "), InlineMath(Symbol("a", pin))
        inlines += [*((Text("; "),) if inlines else ()), *symbols, *_pointing(report, Number(degrees, unit="°"))]
    return tuple(inlines)


def _pointing(report: ReportContext, angle: Number) -> Inlines:
    """Return the direction of a vector in words, and its angle from +x."""
    heading = heading_words(report, angle.printed)
    before, _, after = report.words["pointing"].format(heading=heading, angle=NO_LETTER).partition(NO_LETTER)
    return Text(f" {before}"), Value(angle), Text(after)


def heading_words(report: ReportContext, degrees: float) -> str:
    """Return the direction of an angle (degrees from +x) in words: to the right, to the right and up, …."""
    return heading_of(report.words, degrees)


def heading_of(words: Mapping[str, Any], degrees: float) -> str:
    """Return the same as `heading_words` for an angle (degrees from +x), from the short words alone."""
    quadrant, within = divmod(round(degrees, 2) % 360.0, 90.0)
    return str(words["headings"][int(2 * quadrant) + (within > 0)])


def opposites(report: ReportContext, polygon: Polygon, position: int) -> Equation:
    """Return the reactions that groups solved before exert on a plan's links: R42 = −R24 as vectors, then their
    sizes.
    """
    rows: list[Expression] = []
    for edge in polygon.carried:
        size = report.force_symbol(edge.name)
        (source,) = refs(report.ledger[ids.force_vector(edge.name)].definition or Number(0.0))
        vectors = vocabulary.vector(size), -vocabulary.vector(report.ledger.symbol(report.ledger[source].of))
        rows += [Chain(vectors), report.ledger.chain(ids.of_force(edge.name), position)]
    return Equation(tuple(rows))


def through_pin(report: ReportContext, contact: Contact, position: int) -> Equation:
    """Return ΣM about the pin of a slide without any other moment: R x = 0, hence x = 0."""
    reaction, place = report.ledger.symbol(contact.reaction), report.ledger.symbol(contact.place)
    moments = Chain((Symbol("ΣM", str(contact.pin)), reaction * place, Number(0.0)))
    return Equation((moments, Chain((place, Number(0.0)))))


# --- lines


def line(report: ReportContext, id: str, position: int | None = None, note: str = "", key: str = "") -> Equation:
    """Return one worked line: symbol = formula = numbers = result; `note` and `key` as for `lines`."""
    return lines(report, [id], position, note, key)


def lines(
    report: ReportContext, quantities: Sequence[str], position: int | None = None, note: str = "", key: str = ""
) -> Equation:
    """Return several worked lines, aligned, at a position, or without one for constants.

    `note` follows each line; without it, a line whose result is zero gives its reason there. The `key` numbers the
    equation, so that text can refer to it.
    """
    return Equation(tuple(_worked(report, id, position, note) for id in quantities), key)


def _worked(report: ReportContext, id: str, position: int | None, note: str) -> Chain:
    """Return a worked line; if the result is zero, the line gives the reason instead of its numbers."""
    chain = report.ledger.chain(id, position, note)
    result = chain.parts[-1]
    if not note and isinstance(result, Number) and result.value == 0 and report.ledger[id].definition:
        family = report.ledger[id]
        reasons = vocabulary.words_of(report.words["zero"], id, family.kind, family.symbol)
        return Chain((chain.parts[0], result), next(reasons, ""))
    return chain


def equations(report: ReportContext, name: str, position: int | None = None) -> Equation:
    """Return equations of the machine's kind; quantities are printed by symbols, or at a position by numbers."""

    def printed(ref: Ref) -> Expression:
        if position is None:
            return report.ledger.symbol(ref.id)
        number = report.ledger.number(ref.id, position)
        return Number(number.value, number.decimals, "°" if number.unit == "°" else "")

    def in_words(node: Expression) -> Expression:
        return report.named(node) if isinstance(node, Symbol) else rebuild(node, in_words)

    return Equation(tuple(in_words(substitute(row, printed)) for row in report.machine.closed_formulas.equations[name]))


ω, ε = Symbol("ω"), Symbol("ε")
THEORY: Mapping[str, tuple[Expression, ...]] = {
    "inclination": (Chain((tan(Symbol("α")), Symbol("a", "A", "τ") / Symbol("a", "A", "n"), ε / ω**2)),),
    "two-equations": (
        VectorEquation(
            tuple(
                tuple(Term(Symbol("v", of, over="vector")) for of in side) for side in ("E", ("B", "EB"), ("C", "EC"))
            )
        ),
    ),
    "similarity": (
        Chain(
            (
                Symbol("a", "CB"),
                sqrt(Symbol("a", "CB", "n") ** 2 + Symbol("a", "CB", "τ") ** 2),
                Symbol("l", "BC") * sqrt(ω**4 + ε**2),
            )
        ),
        Chain(
            (
                *(segment(on_plan(p, True), on_plan(q, True)) / Symbol("l", p + q) for p, q in ("BC", "BE", "CE")),
                sqrt(ω**4 + ε**2) / Symbol("μ", "a"),
            )
        ),
    ),
}
"""General equations that the chapters on the plans print."""


def theory(report: ReportContext, name: str) -> Equation:
    """Return a general equation on which the plans are based."""
    return Equation(tuple(report.named(row) if isinstance(row, Symbol) else row for row in THEORY[name]))


def functions(report: ReportContext, quantities: Sequence[str]) -> Equation:
    """Return quantities as functions of the driver's position: constants by their numbers, variables by their
    symbols.
    """

    def printed(ref: Ref) -> Expression:
        family = report.ledger[ref.id]
        if len(family.values) > 1:
            return family.symbol
        number = report.ledger.number(ref.id)
        return Number(number.value, number.decimals, "°" if number.unit == "°" else "")

    lines = ((id, report.ledger[id].definition) for id in quantities)
    return Equation(
        tuple(Chain((report.ledger.symbol(id), substitute(formula, printed))) for id, formula in lines if formula)
    )


def mobility_line(report: ReportContext) -> Equation:
    """Return W = 3n − (2t + c) + r − s, or the form of the language, with the numbers inserted."""
    counted = mobility(report.machine.linkage)
    sizes = counted.n, counted.lower_pairs, counted.higher_pairs, counted.passive, counted.redundant

    notation = setting_of(report.assignment.language).mobility

    def freedom(n: Expression, t: Expression, c: Expression, r: Expression, s: Expression) -> Expression:
        if not notation.apart:
            return 3 * n - (2 * t + c) + r - s
        line = 3 * n - 2 * t - c
        line = line + r if counted.passive else line
        return line - s if counted.redundant else line

    W, *letters = (Symbol(*letter.partition("_")[::2]) for letter in notation.letters)
    formula, numbers = freedom(*letters), freedom(*map(Number, sizes))
    # A chain within a chain stays on one line: it is not broken at its equals signs.
    return Equation((Chain((Chain((W, formula, numbers, Number(counted.W))),)),))
