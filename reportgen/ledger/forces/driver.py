"""The driver's equilibrium, and the balance by virtual work on Zhukovsky's lever."""

from __future__ import annotations

from reportgen.ledger.forces.loads import LoadOn, Statics, lone_couple, moments
from reportgen.ledger.forces.polygon import Path, Polygon, Side, drawn_sides, force_plan, read
from reportgen.mechanism.structure import DRIVER, Crank
from reportgen.notation.expressions import (
    Expression,
    Ref,
    Symbol,
    add,
    call,
    divide,
    multiply,
    negative,
)


def driver(statics: Statics) -> Polygon:
    """The driver under the groups' reactions and its own loads: R01, and what balances it (`M.eq`)."""
    machine = statics.scheme.linkage.driver
    return crank(statics, machine.centre) if isinstance(machine, Crank) else slide(statics, machine.pin)


def _own(statics: Statics) -> tuple[LoadOn, ...]:
    """The driver's loads, reactions of the groups first."""
    return tuple(sorted(statics.on(DRIVER), key=lambda load: load.name[0] != "R"))


def crank(statics: Statics, centre: str) -> Polygon:
    """R01 closes the polygon; moments about the centre give M_cb = −Σ R h μ_l."""
    own = _own(statics)
    total = moments(statics, own, centre)
    balance: Expression | float = 0.0 if total is None else negative(total)
    statics.b.define("M.eq", Symbol("M", "cb"), "torque", balance, scale=statics.torque)
    path = _laid(own)
    force_plan(statics, "1", "R(1)", path.corners)
    drawn_sides(statics, "1", path.sides)
    read(statics, "1", "R01", Symbol("R", "01"), "R.01", path.last, path.first)
    return Polygon("1", (*path.sides, Side("R01", path.last, path.first, True, DRIVER)))


def slide(statics: Statics, pin: str) -> Polygon:
    """R01 across the guide and the balancing force P_cb along it close the polygon."""
    b, own = statics.b, _own(statics)
    path = _laid(own)
    b.construct("closing.1", call("meet", path.corners[path.last], call("turned", "guide.1"), 0.0, "guide.1"))
    force_plan(statics, "1", "R(1)", {**path.corners, "n": add("closing.1")})
    drawn_sides(statics, "1", path.sides)
    read(statics, "1", "R01", Symbol("R", "01"), "R.01", path.last, "n")
    read(statics, "1", "Rcb", Symbol("P", "cb"), "R.cb", "n", path.first)
    along = call("sign", call("dot", "F.Rcb", "guide.1"))
    b.define("M.eq", Symbol("P", "cb"), "force", multiply("R.cb", along), scale=statics.force)
    turned = moments(statics, own, pin)
    if turned is not None:
        b.define("M.01", Symbol("M", "01"), "torque", turned, scale=statics.torque)
    unknown = (Side("R01", path.last, "n", True, DRIVER), Side("Rcb", "n", path.first, True, DRIVER))
    return Polygon("1", (*path.sides, *unknown))


def _laid(own: tuple[LoadOn, ...]) -> Path:
    path = Path()
    for load in own:
        if load.point:
            path.lay(load.name, DRIVER)
    return path


def lever(statics: Statics, loads: tuple[LoadOn, ...]) -> None:
    """Zhukovsky's lever: the velocity plan turned 90° against ω₁, every load at its image, balanced by M_cb.

    Σ F v cos α + M_cb ω₁ = 0 with v = μ_v · (segment) and μ_v = ω₁ μ_l gives M_cb = −Σ F h′ μ_l; h′ is the
    signed arm of a load about the pole.  For a sliding driver P_cb = −Σ F h′ μ_v/v_A.  Enters the arms
    `h.X.p`, what each load contributes, `M.X.p`, and `M.vw`.
    """
    b, turning = statics.b, isinstance(statics.scheme.linkage.driver, Crank)
    rate = "omega.1" if turning else f"v.{statics.scheme.linkage.driver.pin}"
    kind, scale = ("torque", statics.torque) if turning else ("force", statics.force)
    per: Expression = Ref("mu.l") if turning else divide("mu.v", rate)
    base = "M" if turning else "P"
    parts: list[str] = []

    def contribute(name: str, amount: Expression, optional: bool = False) -> None:
        id = f"M.{name}.p"
        b.define(id, Symbol(base, name), kind, amount, scale=scale, optional=optional)
        parts.append(id)

    for load in loads:
        spin = _spin(statics, load.link)
        if not load.point:
            if spin is not None:
                given = multiply(load.size, spin)
                contribute(load.name, divide(given if statics.turn > 0 else negative(given), rate))
            continue
        work: Expression = call("dot", f"F.{load.name}", statics.image("v", load.point))
        couple = spin if statics.has_couple(load) else None
        if couple is not None:
            work = add(work, divide(multiply(f"couple.{load.name}", couple), "mu.v"))
        id = f"h.{load.name}.p"
        b.define(
            id,
            Symbol("h", load.name, "′"),
            "segment",
            multiply(statics.turn, call("quotient", work, load.size)),
            arm=True,
            scale=statics.span,
        )
        contribute(load.name, multiply(load.size, id, per))
        if couple is not None:
            lone = multiply(statics.turn, lone_couple(statics, load), couple)
            contribute(f"{load.name}.lone", divide(lone, rate), optional=True)
    total: Expression | float = negative(add(*parts)) if parts else 0.0
    b.define("M.vw", Symbol(base, "cb"), kind, total, scale=scale)


def _spin(statics: Statics, link: int) -> Expression | None:
    """A link's signed angular velocity, None if it does not turn."""
    if f"turn.omega.{link}" in statics.b:
        return Ref(f"turn.omega.{link}")
    if link == DRIVER and statics.scheme.spins[DRIVER]:
        return Ref("omega.1") if statics.turn > 0 else negative("omega.1")
    return None
