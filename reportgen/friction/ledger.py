"""Ledger entries for friction in the joints: circles, couples and forces, rounds, torque and efficiency.

The entries of a joint with friction are: `friction.omega.12`, the rate at which the second link turns against the
first; `friction.R.12`, the reaction with friction; `friction.M.12` = ρ R, the couple of a pin; `friction.F.03` = f R,
the force of a guide; `friction.part.12`, the torque that overcomes it. The reactions are read from the force plans of
their rounds; those of a round give the next torque by the balance of power,

    M = M₀ + Σ ρ R ω_rel/ω₁ + Σ f R v_rel/ω₁.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reportgen.base.records import Record
from reportgen.base.units import rounded, significant_decimals
from reportgen.derivation.equation_sides import scheme, sides
from reportgen.derivation.kinematic_entries import natural_sizes
from reportgen.derivation.topic_ledger import Changed, LedgerHooks
from reportgen.derivation.unprinted_values import with_rest
from reportgen.formula import Call, Expression, Ref, Sum, Symbol, atan, call, ids, signed, total
from reportgen.formula import size as size_of
from reportgen.formula.calculation import ZERO, Calculation
from reportgen.formula.ledger import Ledger
from reportgen.formula.vocabulary import KINDS
from reportgen.friction import friction_ids
from reportgen.friction.cycle_effects import dead_zones, mean_torque
from reportgen.friction.joints import Friction, FrictionForces, friction_of, pressing, relative_sense, with_friction
from reportgen.machine import DRIVER, GROUND, Crank, Joint, Linkage
from reportgen.machine.analysis import Analysis, Machine

MOST_ROUNDS = 12
"""Largest number of rounds that are entered; only positions close to locking need more."""


class RubbingJoint(Record):
    """A joint with friction, the digits of its reaction and the id of ρ or f."""

    joint: Joint
    digits: str
    share: str

    @property
    def is_pin(self) -> bool:
        """True if friction is a couple about a pin."""
        return self.joint.kind == "R"

    @property
    def ends(self) -> tuple[int, int]:
        """The acting link and the one it acts on, in the order of the reaction's name."""
        first, second = self.joint.links
        return (first, second) if self.digits == ids.joint(first, second) else (second, first)

    @property
    def lost(self) -> str:
        """The id of the couple or force of friction."""
        return (friction_ids.couple if self.is_pin else friction_ids.force)(self.digits)


def rubbing_joints(
    q: Calculation | Mapping[str, object], linkage: Linkage, friction: Friction
) -> tuple[RubbingJoint, ...]:
    """Return the joints with friction, in the order of assembly, with the digits that the ledger uses for their
    reactions.
    """
    solved = []
    for joint in friction.joints(linkage):
        first, second = joint.links
        digits = next(
            digits for digits in (ids.joint(first, second), ids.joint(second, first)) if ids.reaction(digits) in q
        )
        share = friction_ids.circle(joint.point) if joint.kind == "R" else friction_ids.coefficient_of_slider(second)
        solved.append(RubbingJoint(joint, digits, share))
    return tuple(solved)


def enter_forces(q: Calculation, analysis: Analysis, worked: Sequence[int]) -> None:
    """Enter the friction at each position, in rounds until the printed values at the `worked` positions no longer
    change.
    """
    machine, friction, solved = analysis.machine, friction_of(analysis.machine), with_friction(analysis)
    assert friction is not None
    for point in friction.circles:
        id, f, r = (name(point) for name in (friction_ids.circle, friction_ids.coefficient, friction_ids.pin_radius))
        if id not in q and r in q:
            q.define(id, q[f] * q[r])
    for link in friction.coefficients:
        if (of := q.find(friction_ids.coefficient_of_slider(link))) is not None:
            q.define(friction_ids.angle(link), atan(of))
    rates = {
        each: rate
        for each in rubbing_joints(q, machine.linkage, friction)
        if relative_sense(each.joint, analysis.motion).any() and (rate := _rate(q, machine, each))
    }
    letter, kind, driver = _balanced(q, machine.linkage)
    size = float(np.nanmax(np.abs(solved.rounds[0].torque)))

    def reactions(number: int, name: str) -> dict[RubbingJoint, Ref]:
        """Return the reactions of a round, which follow those without friction."""
        forces = solved.rounds[number]
        largest = max(float(np.nanmax(np.abs(reaction.force))) for reaction in forces.reactions.values())
        return {
            each: with_rest(
                q,
                friction_ids.reaction.of({"joint": each.digits, "round": name}),
                values=pressing(friction, each.joint, analysis.motion, forces),
                by_rule=q[ids.reaction(each.digits)],
                symbol="",
                scale=largest,
                optional=bool(name),
            )
            for each in rates
        }

    def overcome(parts: Sequence[Expression]) -> Expression:
        """Return M_cb with the torques against friction, which are in the sense of ω₁."""
        return q["M.eq"] + signed(machine.turn, total(parts)) if parts else q["M.eq"]

    R = {each: q[ids.reaction(each.digits)] for each in rates}
    for number in range(1, _rounds(solved, worked) + 1):
        parts = [q[each.share] * R[each] * rates[each] / driver for each in rates]
        symbol = Symbol(letter, "cb", f"fr({number})")
        q.define(friction_ids.torque_of_round(number), overcome(parts), symbol, kind, scale=size, optional=True)
        R = reactions(number, str(number))
    R, parts = reactions(-1, ""), []
    for each in rates:
        lost = q.define(each.lost, q[each.share] * R[each])
        power = lost * rates[each] / driver
        symbol = Symbol(f"Δ{letter}", each.digits)
        parts.append(q.define(friction_ids.part(each.digits), power, symbol, kind, scale=size))
    M = q.define(friction_ids.torque, overcome(parts), Symbol(letter, "cb", "fr"), kind, scale=size)
    # A torque that is negligible beside the greatest drives nothing.
    drives = signed(machine.turn, q["M.eq"]) - ZERO * size
    q.define(friction_ids.efficiency, call("where_positive", q["M.eq"] / M, drives))


def _balanced(q: Calculation, linkage: Linkage) -> tuple[str, str, Ref]:
    """Return the letter and the kind of the driver's balancing torque or force, and the driver's rate."""
    if isinstance(linkage.driver, Crank):
        return "M", "torque", q["omega.1"]
    return "P", "force", q[ids.velocity(linkage.driver.pin)]


def _rounds(solved: FrictionForces, worked: Sequence[int]) -> int:
    """Return the first round whose torque is printed like that of the last round at the worked positions."""
    torques = np.array([forces.torque for forces in solved.rounds])
    compared = torques[:, [k - 1 for k in worked]] if worked else torques
    compared = compared[:, np.isfinite(compared).all(axis=0)]
    decimals = significant_decimals(float(np.nanmax(np.abs(torques[-1]))), KINDS["torque"].digits)
    printed = rounded(compared, decimals)
    settled = (printed == printed[-1]).all(axis=1)
    return min(int(settled.argmax()), MOST_ROUNDS)


# --- relative motion of the links of a joint --------------------------------------------------------


def _rate(q: Calculation, machine: Machine, each: RubbingJoint) -> Ref | None:
    """Return the relative rate in a joint: ω of a pin's links against each other, v of a slide.

    None if the links never move against each other.
    """
    if not each.is_pin:
        return q[_sliding(q, machine.linkage, each.joint)]
    turns = [(link, ω) for link in each.ends if (ω := _omega(q, machine, link)) is not None]
    match turns:
        case []:
            return None
        case [(link, _)]:
            return q[ids.angular_velocity(link)]
        case [(first, ω1), (second, ω2)]:
            if q.value(ids.angular_velocity(first)) is q.value(ids.angular_velocity(second)):
                return None
            size = natural_sizes(q, machine.linkage).rotation
            symbol = Symbol("ω", ids.joint(second, first))
            return q.define(friction_ids.turning(each.digits), size_of(ω2 - ω1), symbol, scale=size)
    return None


def _omega(q: Calculation, machine: Machine, link: int) -> Expression | None:
    """Return the signed angular velocity of a link, anticlockwise positive; None if it does not turn."""
    if link == DRIVER and isinstance(machine.linkage.driver, Crank):
        return signed(machine.turn, q["omega.1"])
    return q.find(ids.signed("omega", link)) if link != GROUND else None


def _sliding(q: Calculation, linkage: Linkage, joint: Joint) -> str:
    """Return the id of the velocity of a slider relative to its guide."""
    plan = scheme(linkage)
    guide, slider = joint.links
    if slider == DRIVER:
        return ids.velocity(linkage.driver.pin)
    dyad = next(dyad for dyad in linkage.dyads if dyad.links == joint.group)
    slides = {ids.slot(guide), ids.guide(slider)}
    side = next(side for side in sides(plan, dyad) if side.along in slides)
    return side.velocity if side.velocity in q else ids.velocity(side.point)


# --- the cycle ------------------------------------------------------------------------------------


def enter_cycle(q: Calculation, analysis: Analysis) -> None:
    """Enter the mean torque with friction, the efficiency from the works of the cycle, the dead zones of sliders."""
    machine, friction = analysis.machine, friction_of(analysis.machine)
    if friction is None or not machine.cyclic:
        return
    letter, kind, _ = _balanced(q, machine.linkage)
    mean = mean_torque(machine)
    if np.isfinite(mean):
        by_rule = call("mean", q[friction_ids.torque], q["even"])
        M = with_rest(q, friction_ids.mean, mean, by_rule, Symbol(letter, "m", "fr"), kind)
        bare = q.si("M.mean") * machine.turn
        if bare > 0:
            q.define(friction_ids.cycle_efficiency, q["M.mean"] / M, Symbol("η", "m"))
        elif bare < 0 and mean * machine.turn < 0:
            q.define(friction_ids.cycle_efficiency, M / q["M.mean"], Symbol("η", "m"))
    for course in machine.sliders:
        for number, zone in enumerate(dead_zones(machine, friction, course), 1):
            for side, reach in (("before", zone.before), ("behind", zone.behind)):
                if np.isfinite(reach):
                    q.give(
                        friction_ids.dead(course.link, number, side), reach, Symbol("Δφ", str(course.link)), exact=False
                    )


def reduced(q: Calculation, largest: float) -> Ref | None:
    """Enter the torque (N·m) that friction takes from the driver; None without friction.  `largest` is its reference
    size.
    """
    lost = [q[id] for id in q.families if id in friction_ids.part]
    if not lost:
        return None
    return q.define(friction_ids.reduced, -total(lost), Symbol("M", "tt", "fr"), "torque", scale=largest)


# --- common mistakes --------------------------------------------------------------------------------


def mistakes(ledger: Ledger, machine: Machine) -> Changed:
    """Return mistaken definitions of friction quantities, by id, with the names of the mistakes."""
    families = ledger.families
    solved: dict[str, list[tuple[str, Expression]]] = {}
    for id, family in families.items():
        if names := friction_ids.circle.read(id):
            if (r := friction_ids.pin_radius(names["point"])) in families:
                solved[id] = [("radius-for-circle", Ref(r))]
        elif names := friction_ids.angle.read(id):
            solved[id] = [("coefficient-for-angle", Ref(friction_ids.coefficient_of_slider(names["link"])))]
        elif id in friction_ids.turning:
            assert isinstance(family.definition, Call)
            (difference,) = family.definition.arguments
            assert isinstance(difference, Sum)
            second, first = difference.terms
            solved[id] = [("links-turned-alike", size_of(second - first)), ("one-link", size_of(second))]
        elif id == friction_ids.efficiency:
            M0, M = Ref("M.eq"), Ref(friction_ids.torque)
            solved[id] = [("efficiency-inverted", M / M0)]
    return solved


HOOKS = LedgerHooks(enter_forces=enter_forces, enter_cycle=enter_cycle, reduced=reduced, mistakes=mistakes)
