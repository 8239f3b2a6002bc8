"""The driver's equilibrium, and the balance by virtual work on Zhukovsky's lever."""

from __future__ import annotations

from reportgen.ledger.forces.loads import LoadOn, Origin, Statics, lone_couple, moments
from reportgen.ledger.forces.polygon import Path, Polygon, Side, drawn_sides, force_plan, read
from reportgen.mechanism.structure import DRIVER, Crank
from reportgen.notation.expressions import Expression, Sum, Symbol, dot, meet, quotient, sign, turned


def driver(statics: Statics) -> Polygon:
    """The driver under the groups' reactions and its own loads: R01, and what balances it (`M.eq`)."""
    machine = statics.scheme.linkage.driver
    own = tuple(sorted(statics.on(DRIVER), key=lambda load: load.origin is not Origin.reaction))
    return _crank(statics, machine.centre, own) if isinstance(machine, Crank) else _slide(statics, machine.pin, own)


def _crank(statics: Statics, centre: str, own: tuple[LoadOn, ...]) -> Polygon:
    """R01 closes the polygon; moments about the centre give M_cb = −Σ R h μ_l."""
    total = moments(statics, own, centre)
    balance = 0.0 if total is None else -total
    statics.q.define("M.eq", balance, Symbol("M", "cb"), scale=statics.torque)
    path = _laid(statics, own)
    force_plan(statics, "1", "R(1)", path.corners)
    drawn_sides(statics, "1", path.sides)
    read(statics, "1", "R01", Symbol("R", "01"), "R.01", path.last, path.first)
    return Polygon("1", (*path.sides, Side("R01", path.last, path.first, True, DRIVER)))


def _slide(statics: Statics, pin: str, own: tuple[LoadOn, ...]) -> Polygon:
    """R01 across the guide and the balancing force P_cb along it close the polygon."""
    q, path = statics.q, _laid(statics, own)
    guide = q["guide.1"]
    closing = q.construct("closing.1", meet(path.corners[path.last], turned(guide), 0.0, guide))
    force_plan(statics, "1", "R(1)", {**path.corners, "n": closing})
    drawn_sides(statics, "1", path.sides)
    read(statics, "1", "R01", Symbol("R", "01"), "R.01", path.last, "n")
    read(statics, "1", "Rcb", Symbol("P", "cb"), "R.cb", "n", path.first)
    along = sign(dot(q["F.Rcb"], guide))
    q.define("M.eq", q["R.cb"] * along, Symbol("P", "cb"), "force", scale=statics.force)
    total = moments(statics, own, pin)
    if total is not None:
        q.define("M.01", total, scale=statics.torque)
    unknown = (Side("R01", path.last, "n", True, DRIVER), Side("Rcb", "n", path.first, True, DRIVER))
    return Polygon("1", (*path.sides, *unknown))


def _laid(statics: Statics, own: tuple[LoadOn, ...]) -> Path:
    path = Path(statics.q)
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
    q, turning = statics.q, isinstance(statics.scheme.linkage.driver, Crank)
    rate = q["omega.1"] if turning else q[f"v.{statics.scheme.linkage.driver.pin}"]
    per = q["mu.l"] if turning else q["mu.v"] / rate
    letter, kind, scale = ("M", "torque", statics.torque) if turning else ("P", "force", statics.force)
    parts: list[Expression] = []

    def contribute(name: str, amount: Expression, optional: bool = False) -> None:
        id, symbol = f"M.{name}.p", Symbol(letter, name)
        parts.append(q.define(id, amount, symbol, kind, scale=scale, optional=optional))

    for load in loads:
        omega, couple = _omega(statics, load.link), statics.couple(load)
        if not load.point:
            if omega is not None:
                power = load.size * omega
                contribute(load.name, (power if statics.turn > 0 else -power) / rate)
            continue
        work: Expression = dot(statics.vector(load), statics.image("v", load.point))
        if couple is not None and omega is not None:
            work = work + couple * omega / q["mu.v"]
        arm = q.define(
            f"h.{load.name}.p",
            statics.turn * quotient(work, load.size),
            Symbol("h", load.name, "′"),
            arm=True,
            of=load.name,
            about="p",
            scale=statics.span,
        )
        contribute(load.name, load.size * arm * per)
        if couple is not None and omega is not None:
            alone = statics.turn * lone_couple(statics, load) * omega
            contribute(f"{load.name}.lone", alone / rate, optional=True)
    balance = -Sum(tuple(parts)) if parts else 0.0
    q.define("M.vw", balance, Symbol(letter, "cb"), kind, scale=scale)


def _omega(statics: Statics, link: int) -> Expression | None:
    """A link's signed angular velocity, None if it does not turn."""
    q = statics.q
    if f"turn.omega.{link}" in q:
        return q[f"turn.omega.{link}"]
    if link == DRIVER and statics.scheme.spins[DRIVER]:
        return q["omega.1"] if statics.turn > 0 else -q["omega.1"]
    return None
