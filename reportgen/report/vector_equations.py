"""Vector equations of motion and of equilibrium for templates, with the known facts printed below each vector.

Templates call the public functions by their own names; the values come from the ledger.
"""

from __future__ import annotations

from collections.abc import Sequence

from reportgen.derivation.equation_sides import Side
from reportgen.derivation.kinematic_entries import What
from reportgen.derivation.load_entries import Edge
from reportgen.document import Equation
from reportgen.document.template_rendering import subscripted
from reportgen.formula import Chain, Expression, Symbol, Term, VectorEquation, ids, refs
from reportgen.report.context import ReportContext
from reportgen.report.link_views import GroupView
from reportgen.report.template_equations import R
from reportgen.report.triad_views import TriadView

# --- vector equations of motion


def velocity_equation(report: ReportContext, group: GroupView, position: int) -> Equation:
    """Return v_M = v_P + v_MP = v_T + v_MT with the known facts of each vector; with a fixed base only v_M's direction
    remains.
    """
    still = next((side for side in group.sides if side.still), None)
    sides: list[tuple[Term, ...]] = [(_unknown(report, "v", group.M, "", still),)]
    for side in group.moving:
        relative = _unknown(report, "v", side.pair, "", side)
        sides.append((_base(report, side, "v"), relative))
    return _equation(report, sides, "rows", f"eq.v.{group}.{position}")


def acceleration_equation(report: ReportContext, group: GroupView, position: int) -> Equation:
    """Return a_M = a_P + aⁿ_MP + aᵗ_MP = a_G + aᵏ_MG + aʳ_MG with the known facts of each vector."""
    fixed = next((side for side in group.sides if not side.sought), None)
    sides: list[tuple[Term, ...]] = [(_unknown(report, "a", group.M, "", fixed),)]
    for side in group.sides:
        if side is not fixed:
            base = () if side.still else (_base(report, side, "a"),)
            sides.append((*base, *_relative(report, side)))
    return _equation(report, sides, "rows", f"eq.a.{group}.{position}")


def special_equation(report: ReportContext, what: What, group: TriadView, position: int) -> Equation:
    """Return the motion of the special point as a point of the plate on the lines of both legs."""
    still = next((leg for leg in group.pair if leg.side.still), None) if what == "v" else None
    known = None if still is None else f"⊥ {subscripted(still.rod)}"
    sides: list[tuple[Term, ...]] = [(_term(report, what, group.S, "", direction=known),)]
    for leg in group.pair:
        across = f"⊥ {subscripted(leg.rod)}"
        base = () if leg.side.still else (_base(report, leg.side, what),)
        if what == "a":
            normals = (_relative(report, side, side is leg.across)[0] for side in (leg.side, leg.across))
            unknown = (_term(report, "a", side.pair, "τ", direction=across) for side in (leg.side, leg.across))
            sides.append((*base, *normals, *unknown))
        elif leg is not still:
            sides.append((*base, _term(report, "v", leg.special.pair, "", direction=across)))
    return _equation(report, sides, "rows", f"eq.{what}.{group}.S.{position}")


def third_equation(report: ReportContext, what: What, group: TriadView, position: int) -> Equation:
    """Return the motion of the third leg's joint from the special point and from the leg's outer joint."""
    third = group.third
    fixed = third.side if what == "v" and third.side.still else None
    given = report.words["vector"]["given"]
    special = _term(report, what, group.S, "", direction=given, sense=given, size=given)
    sides: list[tuple[Term, ...]] = [(_unknown(report, what, third.Q, "", fixed),)]
    for side, base in ((group.about, special), (third.side, _base(report, third.side, what))):
        start = () if side.still else (base,)
        if what == "a":
            sides.append((*start, *_relative(report, side, side is group.about)))
        elif side is not fixed:
            sides.append((*start, _unknown(report, "v", side.pair, "", side)))
    return _equation(report, sides, "rows", f"eq.{what}.{group}.{position}")


def _equation(report: ReportContext, sides: Sequence[tuple[Term, ...]], rows: str, key: str = "") -> Equation:
    return Equation((VectorEquation(tuple(sides), tuple(report.words["vector"][rows])),), key)


Known = Expression | str | None
"""Text below a vector; None marks an unknown."""


def _term(
    report: ReportContext,
    base: str,
    sub: str,
    sup: str,
    *,
    direction: Known = None,
    sense: Known = None,
    size: Known = None,
) -> Term:
    return Term(report.named(Symbol(base, sub, sup, "vector")), (direction, sense, size))


def _unknown(report: ReportContext, base: str, sub: str, sup: str, side: Side | None) -> Term:
    """Return the unknown vector on a side, of which only the direction is known."""
    return _term(report, base, sub, sup, direction=None if side is None else _direction(report, side))


def _direction(report: ReportContext, side: Side) -> str:
    """Return the direction of the unknown on a side."""
    if side.turns:
        return f"⊥ {subscripted(side.rod)}"
    return _slide(report, "along", side)


def _slide(report: ReportContext, how: str, side: Side) -> str:
    """Return the phrase for "along" or "across" the slide of a side; with two guides it includes the slider's
    number.
    """
    phrase = str(report.words["vector"][f"{how}_{side.way}"])
    return f"{phrase} {side.slide}" if side.alike else phrase


def _relative(report: ReportContext, side: Side, omega: bool = False) -> tuple[Term, ...]:
    """Return aⁿ and aᵗ of a turning side, aᵏ and aʳ of a sliding one; aⁿ = v²/l, or ω² l if `omega`."""
    words, ledger = report.words["vector"], report.ledger
    sought = _unknown(report, "a", side.pair, "τ" if side.turns else "r", side)
    if side.turns:
        if omega:
            (length,) = ledger.known((ids.length(side.rod), ids.length(side.relative)))
            size: Expression = ledger.symbol(ids.angular_velocity(side.link)) ** 2 * ledger.symbol(length)
        else:
            size = ledger.symbol(side.velocity) ** 2 / ledger.symbol(ids.length(side.rod))
        inwards = f"{subscripted(side.point)} → {subscripted(side.base)}"
        direction = f"∥ {subscripted(side.rod)}"
        return _term(report, "a", side.pair, "n", direction=direction, sense=inwards, size=size), sought
    if not side.turning:
        return (sought,)
    twice = 2 * ledger.symbol(side.omega) * ledger.symbol(side.velocity)
    across = _slide(report, "across", side)
    turned = words["turned"].format(link=subscripted(str(side.turning)))
    sense = Chain((ledger.symbol(side.velocity),), turned)
    return _term(report, "a", side.pair, "k", direction=across, sense=sense, size=twice), sought


def _base(report: ReportContext, side: Side, what: str) -> Term:
    """Return the vector of a side's base: with direction and size if it is on the crank, else as known from before."""
    words, ledger = report.words["vector"], report.ledger
    arm = f"{report.driver.centre}{side.base}"
    if not report.driver.centre or ids.length(arm) not in ledger or not _on_crank(report, side.base):
        given = words["given"]
        return _term(report, what, side.shown, "", direction=given, sense=given, size=given)
    if what == "a" and report.accelerated:
        # Both its components are laid off already.
        given = words["given"]
        return _term(report, what, side.shown, "", direction=given, sense=given, size=given)
    length, omega = ledger.symbol(ids.length(arm)), ledger.symbol("omega.1")
    if what == "v":
        direction, sense = f"⊥ {subscripted(arm)}", words["with_crank"]
        return _term(report, "v", side.shown, "", direction=direction, sense=sense, size=omega * length)
    size = omega**2 * length
    inwards = subscripted(f"{side.base} → {report.driver.centre}")
    return _term(report, "a", side.shown, "", direction=f"∥ {subscripted(arm)}", sense=inwards, size=size)


def _on_crank(report: ReportContext, name: str) -> bool:
    """Return True if a point's velocity is computed as that of a point of the crank."""
    definition = report.ledger[ids.velocity(name)].definition
    return definition is not None and "omega.1" in refs(definition)


# --- equations of equilibrium


def force_equation(report: ReportContext, group: GroupView | TriadView, position: int) -> Equation:
    """Return the equilibrium of a group's links; only the two reactions that close the plan are unknown."""
    assert group.polygon is not None
    terms = [_force(report, group, edge) for edge in group.polygon.edges]
    return _balance(report, terms, f"eq.R.{group}.{position}")


def link_equation(report: ReportContext, group: GroupView, link: int, position: int | None = None) -> Equation:
    """Return the equilibrium of one link of a group with a slide between its links, including R_ij or R_ji.

    The equation has a number for references only if `position` is given.
    """
    assert group.polygon is not None
    words = report.words["vector"]
    own = [edge for edge in group.polygon.edges if edge.link == link]
    terms = [_force(report, group, edge) for edge in own if not edge.unknown]
    # Across the slot; its size is computed before the plan, or read from the plan of link j.
    first = group.kind == "RPP" and link == group.j
    inner = R(report, group.across if link == group.j else group.inner)
    terms.append(Term(inner, (words["across_slot"], None if first else words["computed"])))
    terms += [_force(report, group, edge) for edge in own if edge.unknown]
    return _balance(report, terms, "" if position is None else f"eq.R.{group}.{position}")


def driver_equation(report: ReportContext) -> Equation:
    """Return the equilibrium of forces on the driver; a sliding driver has the known directions of its guide."""
    assert report.driver_polygon is not None
    words = report.words["vector"]
    slides = "Rcb" in report.on_crank
    unknown = {"R01": words["across_guide"], "Rcb": words["along_guide"]} if slides else {}
    terms = [
        Term(
            report.force_vector(edge.name),
            (unknown.get(edge.name), None) if edge.unknown else (words["given"], words["given"]),
        )
        for edge in report.driver_polygon.edges
    ]
    return _balance(report, terms)


def _force(report: ReportContext, group: GroupView | TriadView, edge: Edge) -> Term:
    """Return a force of a group's plan with the known facts of it."""
    words = report.words["vector"]
    if isinstance(group, TriadView):
        side = next(side for side in group.turns if side.link == edge.link)
    else:
        side = group.one if edge.link == group.i else group.two
    vector = report.force_vector(edge.name)
    if edge.part and side.turns:
        along = f"{'∥' if edge.part == 'n' else '⊥'} {subscripted(side.rod)}"
        return Term(vector, (along, None if edge.unknown else words["computed"]))
    if edge.unknown:
        return Term(vector, (_slide(report, "across", side) if side.guided else None, None))
    return Term(vector, (words["given"], words["given"]))


def _balance(report: ReportContext, terms: Sequence[Term], key: str = "") -> Equation:
    zero_vector = Term(Symbol("0", over="vector"), ("", ""))
    return _equation(report, [tuple(terms), (zero_vector,)], "force_rows", key)
