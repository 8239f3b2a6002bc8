"""Loads as the ledger knows them: weights, inertia, applied forces and couples, reactions of later groups.

For a load X: `F.X` is its vector, the size has the id X itself (`P3`, `G2`, `Pqt2`; `R.42` for a reaction
R42), `couple.X` its couple if it has one, `h.X.D` its signed arm about a point D in metres on paper.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from reportgen.ledger.core import Builder
from reportgen.ledger.kinematics.names import image
from reportgen.ledger.kinematics.sides import Scheme
from reportgen.ledger.kinematics.site import NOWHERE, Sizes, longest
from reportgen.mechanism.structure import DRIVER, GROUND, Crank, Guide, Inertia
from reportgen.notation.expressions import (
    Expression,
    Ref,
    Symbol,
    add,
    call,
    divide,
    multiply,
    negative,
    subtract,
)

FAINT = 1e-12
"""A reaction below this share of the loads is rounding and has no line of action."""
RANKS = {"R": 0, "Pqt": 1, "G": 3}
"""Order of a link's loads in its plan; applied forces come between inertia and weight."""

Applied = Mapping[str, tuple[int, str, complex]]
"""Applied forces: id → (link, point, unit vector of the positive sense, constant or per position)."""


def joint(one: int, other: int) -> str:
    """The digits of the force of one link on another: 12, or 1,12 with long numbers."""
    return f"{one}{other}" if max(one, other) < 10 else f"{one},{other}"


@dataclass(frozen=True, slots=True)
class LoadOn:
    """A load: its name, its link, the point it acts at ("" for a couple alone) and the id of its size."""

    name: str
    link: int
    point: str
    size: str

    @property
    def rank(self) -> int:
        return RANKS.get(self.name.rstrip("0123456789,"), 2)


@dataclass(frozen=True, slots=True)
class Statics:
    """Builder, linkage and loads while reactions are entered group by group."""

    b: Builder
    scheme: Scheme
    turn: int
    sizes: Sizes
    loads: tuple[LoadOn, ...] = ()

    @property
    def force(self) -> float:
        """The largest load (N): a billionth of it is nothing."""
        sizes = (np.abs(self.b.value(load.size)) for load in self.loads if load.point)
        return max((float(size[np.isfinite(size)].max(initial=0.0)) for size in sizes), default=0.0)

    @property
    def span(self) -> float:
        """The size on paper of what arms are compared with: the drawn crank."""
        driver = self.scheme.linkage.driver
        if isinstance(driver, Crank):
            return float(self.b.value(f"drawn.{driver.centre}{driver.pin}")[0])
        return longest(self.scheme.linkage) / float(self.b.value("mu.l")[0])

    @property
    def torque(self) -> float:
        """The moment of the largest load at the crank (N·m)."""
        driver = self.scheme.linkage.driver
        return self.force * (driver.length if isinstance(driver, Crank) else longest(self.scheme.linkage))

    def on(self, link: int) -> tuple[LoadOn, ...]:
        """The loads of a link."""
        return tuple(load for load in self.loads if load.link == link)

    def image(self, what: str, name: str) -> Expression:
        """A point's image on a plan, 0 for a fixed one."""
        return NOWHERE if self.scheme.still(name) else Ref(f"plan.{what}.{image(name)}")

    def has_couple(self, load: LoadOn) -> bool:
        return f"couple.{load.name}" in self.b


def enter_loads(statics: Statics, applied: Applied, torques: Mapping[str, int]) -> tuple[LoadOn, ...]:
    """Enter vectors of weights, inertia forces and applied forces; ids `G2`, `m.2` and those of `applied` exist.

    Inertia forces and couples follow from `m.k`, `J.k` and the acceleration plan: F = −m a_S, couple −J ε;
    both together are one force at arm h = M/F.  Loads of a link without mass are absent.  `torques` maps
    the id of a signed torque to its link.
    """
    b, loads = statics.b, []
    linkage = statics.scheme.linkage
    for body in linkage.inertias:
        link, centre = body.link, body.centre
        if body.mass > 0:
            down = linkage.gravity / abs(linkage.gravity) if linkage.gravity else -1j
            b.give(f"down.{link}", Symbol("g"), "ratio", complex(down))
            b.construct(f"F.G{link}", multiply(f"G{link}", f"down.{link}"))
            loads.append(LoadOn(f"G{link}", link, centre, f"G{link}"))
        still_driver = link == DRIVER and isinstance(linkage.driver, Crank) and centre == linkage.driver.centre
        if (body.mass > 0 or body.moment > 0) and not still_driver:
            loads.append(_inertia(statics, body))
    for name, (link, place, sense) in applied.items():
        b.give(f"sense.{name}", Symbol(name), "ratio", np.asarray(sense, dtype=complex))
        b.construct(f"F.{name}", multiply(name, f"sense.{name}"))
        loads.append(LoadOn(name, link, place, name))
    loads += [LoadOn(name, link, "", name) for name, link in torques.items()]
    return tuple(sorted(loads, key=lambda load: (load.link, load.rank)))


def _inertia(statics: Statics, body: Inertia) -> LoadOn:
    """P_qt = m a_S against a_S, and M_qt = J ε against ε."""
    b, link, centre = statics.b, body.link, body.centre
    name = f"Pqt{link}"
    still = statics.scheme.still(centre)
    nothing = still or body.mass <= 0
    size = 0.0 if nothing else multiply(f"m.{link}", f"a.{centre}")
    b.define(name, Symbol("P", f"qt{link}"), "force", size, scale=body.mass * statics.sizes.acceleration)
    vector = multiply(0.0) if nothing else negative(multiply(f"m.{link}", "mu.a", statics.image("a", centre)))
    b.construct(f"F.{name}", vector)
    if f"turn.eps.{link}" in b and body.moment > 0:
        b.define(
            f"M.{name}",
            Symbol("M", f"qt{link}"),
            "torque",
            multiply(f"J.{link}", f"eps.{link}"),
            scale=body.moment * statics.sizes.rotation**2,
        )
        b.construct(f"couple.{name}", negative(multiply(f"J.{link}", f"turn.eps.{link}")))
        if not nothing:
            _line_of_action(statics, link, centre)
    return LoadOn(name, link, centre, name)


def _line_of_action(statics: Statics, link: int, centre: str) -> None:
    """How far the one inertia force passes from S, e = M/P, and the centre of percussion, l_SK = J/(m l_AS)."""
    b, name = statics.b, f"Pqt{link}"
    b.define(f"e.{name}", Symbol("e", f"qt{link}"), "length", divide(f"M.{name}", name), scale=1e-3)
    ends = {dyad.links[0]: dyad.start for dyad in statics.scheme.linkage.dyads}
    ends |= {dyad.links[1]: dyad.end for dyad in statics.scheme.linkage.dyads}
    start = ends.get(link)
    arm = f"l.{start}{centre}"
    if isinstance(start, str) and arm in b and float(b.value(arm)[0]) > 0:
        b.define(
            f"l.{centre}K{link}",
            Symbol("l", f"{centre}K{link}"),
            "length",
            divide(f"J.{link}", multiply(f"m.{link}", arm)),
        )


def carried_reactions(statics: Statics, links: tuple[int, ...]) -> tuple[LoadOn, ...]:
    """Enter the reactions of later groups on these links as loads, R42 = −R24, in the order of assembly."""
    b, loads = statics.b, []
    for dyad in statics.scheme.linkage.dyads:
        for link, outer in zip(dyad.links, (dyad.start, dyad.end), strict=True):
            carrier = outer.link if isinstance(outer, Guide) else statics.scheme.owner[outer]
            if carrier == GROUND or carrier not in links:
                continue
            here, there = joint(link, carrier), joint(carrier, link)
            b.define(f"R.{here}", Symbol("R", here), "force", f"R.{there}")
            b.construct(f"F.R{here}", negative(f"F.R{there}"))
            if f"M.{there}" in b:
                b.construct(f"couple.R{here}", add(f"M.{there}"))
            loads.append(LoadOn(f"R{here}", carrier, outer if isinstance(outer, str) else dyad.middle, f"R.{here}"))
    return tuple(loads)


# --- moments --------------------------------------------------------------------------------------


def moment_about(statics: Statics, load: LoadOn, centre: str) -> Expression:
    """The moment of a load about a point, its couple included."""
    lever: Expression = call("cross", subtract(f"p.{load.point}", f"p.{centre}"), f"F.{load.name}")
    return add(lever, f"couple.{load.name}") if statics.has_couple(load) else lever


def _divisor(statics: Statics, load: LoadOn) -> Expression:
    """A load's size; that of a reaction is 0 where it is but rounding."""
    if not load.name.startswith("R") or not statics.has_couple(load):
        return Ref(load.size)
    return above(load.size, FAINT * statics.force)


def above(id: str, floor: float) -> Expression:
    """A size, 0 where it does not exceed `floor`."""
    return multiply(id, call("sign", call("max", 0.0, subtract(id, floor))))


def arm(statics: Statics, load: LoadOn, centre: str) -> str:
    """The signed arm, measured on the drawing, of a load about a point: h = M/(F μ_l)."""
    id = f"h.{load.name}.{centre}"
    moment = moment_about(statics, load, centre)
    statics.b.define(
        id,
        Symbol("h", load.name.removeprefix("R")),
        "segment",
        divide(call("quotient", moment, _divisor(statics, load)), "mu.l"),
        arm=True,
        scale=statics.span,
    )
    return id


def moments(statics: Statics, loads: tuple[LoadOn, ...], centre: str) -> Expression | None:
    """Moments about a point as printed: (ΣF·h)·μ_l, and couples; None if there are none."""
    terms: list[Expression] = []
    couples: list[Expression] = []
    for load in loads:
        if not load.point:
            couples.append(Ref(load.size))
            continue
        if load.point == centre and not statics.has_couple(load):
            continue
        terms.append(multiply(load.size, arm(statics, load, centre)))
        if statics.has_couple(load):
            couples.append(lone_couple(statics, load))
    if not terms:
        return add(*couples) if couples else None
    turned = multiply(add(*terms), "mu.l")
    return add(turned, *couples) if couples else turned


def lone_couple(statics: Statics, load: LoadOn) -> Expression:
    """The couple of a load at positions where its force is nothing; left out of a line elsewhere."""
    id = f"lone.{load.name}"
    if id not in statics.b:
        statics.b.define(
            id,
            Symbol("M", load.name.removeprefix("P").removeprefix("R")),
            "torque",
            call("if_zero", _divisor(statics, load), f"couple.{load.name}"),
            optional=True,
        )
    return add(id)
