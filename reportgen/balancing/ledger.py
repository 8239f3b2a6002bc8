"""Ledger entries for balancing: the shaking force and moment at each position, the counterweights and their effects.

The components of each link's inertia force follow from its size and the direction of its mass centre's acceleration;
those of a counterweight from U and its angle ψ, which is measured from its link, anticlockwise positive.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property

import numpy as np

from reportgen.balancing import balance_ids
from reportgen.balancing.counterweights import CounterweightRule, CrankRod, crank_rods, four_bar, place_on_link
from reportgen.balancing.mistakes import mistakes
from reportgen.balancing.orders_ledger import enter_orders
from reportgen.balancing.shaking_force import BalancedTurn, balanced_in, shaking_moment
from reportgen.base.records import Record
from reportgen.derivation.equation_sides import image
from reportgen.derivation.topic_ledger import LedgerHooks
from reportgen.derivation.unprinted_values import with_rest
from reportgen.formula import (
    NOTHING,
    ONE,
    Expression,
    Operand,
    Ref,
    Symbol,
    call,
    cis,
    cos,
    cross,
    heading,
    ids,
    meet,
    minus,
    over,
    plus,
    signed,
    sin,
    size,
    sqrt,
    times,
    total,
    turned,
    unit,
)
from reportgen.formula.calculation import Calculation, is_short
from reportgen.formula.vocabulary import KeyChapter
from reportgen.machine import DRIVER, Crank, Inertia
from reportgen.machine.analysis import Analysis
from reportgen.machine.rigid_motion import unit as unit_vector

AXES = ("x", "y")
BEFORE, AFTER = "before", "after"
LETTERS: Mapping[str, str] = {"rms": "rms", "max": "max", "rotating": "quay", "share": "tl"}
"""Indices of the symbols of a rule."""
ON_ITS_LINK = 1e-12
"""A component below this share of a length is zero."""


def enter(q: Calculation, analysis: Analysis) -> None:
    """Enter force and moment on the frame, and the requested counterweights with their effects."""
    turn = balanced_in(analysis)
    entry = _Entry(q, analysis, turn)
    with q.within(KeyChapter("balancing")):
        entry.shaking()
        if turn.products:
            entry.rules()
        elif turn.weights:
            entry.whole_balance()
        if turn.weights:
            entry.carried_out()
        enter_orders(q, analysis, turn.curve, entry.force, entry.point_masses)
        entry.over_the_turn()


class _Entry(Record, dict=True):
    """An analysis with its calculation while its balancing is entered."""

    q: Calculation
    analysis: Analysis
    turn: BalancedTurn

    @cached_property
    def crank(self) -> Crank:
        driver = self.analysis.machine.linkage.driver
        assert isinstance(driver, Crank), "a slide is refused by the checks"
        return driver

    @cached_property
    def unbalance(self) -> float:
        """Reference size of a product (kg·m): all masses at the crank's pin."""
        return self.crank.length * sum(body.mass for body in self.analysis.machine.linkage.inertias)

    @property
    def force(self) -> float:
        """Reference size of a force (N): this unbalance, turning with the crank."""
        return self.unbalance * self.analysis.machine.speed**2

    @property
    def torque(self) -> float:
        """Reference size of a torque (N·m): this force at the crank's length."""
        return self.force * self.crank.length

    # --- at the positions

    def shaking(self) -> None:
        """Enter F with its direction and M, each as the sum over the links."""
        q = self.q
        across: list[Ref] = []
        up: list[Ref] = []
        moments: list[Ref] = []
        for body in self.analysis.machine.linkage.inertias:
            parts: list[Expression] = []
            if body.mass > 0 and ids.acceleration(body.centre) in q:
                F_x, F_y = self._force_of(body)
                across.append(F_x)
                up.append(F_y)
                x, y = self._arms(body.centre, q[ids.place(body.centre)] - q[ids.place(self.crank.centre)])
                parts += [x * F_y, -(y * F_x)]
            if body.moment > 0 and ids.signed("eps", body.link) in q:
                parts.append(-(q[ids.inertia(body.link)] * q[ids.signed("eps", body.link)]))
            if parts:
                moments.append(q.define(balance_ids.moment_of_link(body.link), total(parts), scale=self.torque))
        x, y = (
            q.define(balance_ids.component(axis), total(terms), scale=self.force)
            for axis, terms in zip(AXES, (across, up), strict=True)
        )
        F = q.define(balance_ids.FORCE, sqrt(x**2 + y**2), scale=self.force)
        q.define(balance_ids.DIRECTION, heading(x + turned(y)), scale=1.0, of=F.id)
        q.define(balance_ids.MOMENT, total(moments), scale=self.torque)

    def _force_of(self, body: Inertia) -> tuple[Ref, Ref]:
        """Return the components of a link's inertia force, opposite to the acceleration of its mass centre."""
        q, direction = self.q, ids.direction("a", body.centre)
        if direction not in q:
            q.define(
                direction,
                heading(q[ids.plan_point("a", image(body.centre))]),
                scale=1.0,
                of=ids.acceleration(body.centre),
            )
        P, α = q[ids.inertia_force(body.link)], q[direction]
        along, up = (
            q.define(balance_ids.force_of_link(body.link, axis), -(P * of(α)), scale=self.force)
            for axis, of in zip(AXES, (cos, sin), strict=True)
        )
        return along, up

    def _arms(self, name: str, arm: Expression) -> tuple[Ref, Ref]:
        """Return the coordinates of a point from a centre, as measured on the drawing of the mechanism."""
        x, y = (
            self.q.find(id) or self.q.define(id, call(part, arm), scale=self.crank.length)
            for id, part in (
                (balance_ids.place(name, axis), part) for axis, part in zip(AXES, ("re", "im"), strict=True)
            )
        )
        return x, y

    # --- a counterweight on the crank

    def rules(self) -> None:
        """Enter U and its angle by each rule, and F as seen from the crank at the positions."""
        q, φ, ω = self.q, self.q["phi.1"], self.q["omega.1"]
        F_x, F_y = (q[balance_ids.component(axis)] for axis in AXES)
        q.define(balance_ids.seen("x"), (F_x * cos(φ) + F_y * sin(φ)) / ω**2, scale=self.unbalance)
        q.define(balance_ids.seen("y"), (F_y * cos(φ) - F_x * sin(φ)) / ω**2, scale=self.unbalance)
        enter: Mapping[CounterweightRule, Callable[[], Sequence[Expression]]] = {
            "rms": self._mean,
            "max": self._circle,
            "rotating": lambda: self._shares(0.0),
            "share": lambda: self._shares(q[balance_ids.SHARE]),
        }
        for rule in self.turn.products:
            self._product(rule, LETTERS[rule], enter[rule]())

    def _product(self, name: str, letters: str, parts: Sequence[Expression]) -> None:
        """Enter U and its angle from its components; a single component that is `NOTHING` gets no entry."""
        q = self.q
        entered = [
            NOTHING
            if part == NOTHING
            else q.define(
                balance_ids.rule_component(name, axis), part, Symbol("U", f"{letters},{axis}"), scale=self.unbalance
            )
            for axis, part in zip(AXES, parts, strict=True)
        ]
        x, y = entered
        U = q.define(
            balance_ids.rule_product(name),
            size(x) if y == NOTHING else sqrt(plus(times(x, x), times(y, y)) if x == NOTHING else x**2 + y**2),
            Symbol("U", letters),
            scale=self.unbalance,
        )
        # The rocker of a four-bar has a ψ₁ already.
        symbol = Symbol("ψ", f"U{letters}" if letters.isdigit() else letters)
        q.define(balance_ids.rule_angle(name), heading(x + turned(y)), symbol, "angle", scale=1.0, of=U.id)

    def _mean(self) -> Sequence[Expression]:
        """Return minus the mean of F as seen from the crank: its value from the positions plus a remainder."""
        q, mean = self.q, self.turn.curve.mean
        values = zip(AXES, (mean.real, mean.imag), strict=True)
        means = [
            with_rest(
                q,
                balance_ids.mean(axis),
                values=value,
                by_rule=call("mean", q[balance_ids.seen(axis)], q["even"]),
                symbol="",
                kind="counterweight product",
                scale=self.unbalance,
            )
            for axis, value in values
        ]
        return [-mean for mean in means]

    def _circle(self) -> Sequence[Expression]:
        """Return minus the centre of the circle through the two or three points at which it touches the curve.

        Each of these points follows the position next to it.
        """
        q, curve, own = self.q, self.turn.curve, self.analysis.machine.cycle_angles
        points = []
        for number, angle in enumerate(curve.circle.touching, 1):
            place = complex(curve.at(angle))
            nearest = np.abs(unit_vector(own) - unit_vector(angle)).argmin()
            beside = q.give(
                balance_ids.beside(number), np.arange(own.size) == nearest, Symbol("T"), "ratio", hidden=True
            )
            x, y = (
                with_rest(
                    q,
                    balance_ids.touching(number, axis),
                    values=value,
                    by_rule=call("mean", q[balance_ids.seen(axis)], beside),
                    symbol=Symbol("u", f"{axis},{number}"),
                    kind="counterweight product",
                    scale=self.unbalance,
                )
                for axis, value in zip(AXES, (place.real, place.imag), strict=True)
            )
            points.append((x, y))
        if len(points) < 3:
            return [-(total(same_axis) / len(points)) for same_axis in zip(*points, strict=True)]
        first, second, third = (x + turned(y) for x, y in points)
        centre = meet((first + second) / 2, turned(second - first), (first + third) / 2, turned(third - first))
        return [-call("re", centre), -call("im", centre)]

    def _shares(self, share: Operand) -> Sequence[Expression]:
        """Return the terms opposite to the masses that turn with the crank and to a share of the reciprocating ones at
        its pins.
        """
        q = self.q
        terms: tuple[list[Expression], list[Expression]] = ([], [])

        def lay(amount: Expression, length: Expression, angle: Expression) -> None:
            for axis, of in zip(terms, (cos, sin), strict=True):
                if angle != NOTHING:
                    axis.append(amount * length * of(angle))
                elif of is cos:
                    axis.append(amount * length)

        for body in self.analysis.machine.linkage.inertias:
            arm = place_on_link(self.analysis.machine.linkage, DRIVER, body.centre) if body.link == DRIVER else 0j
            if body.mass > 0 and arm:
                lay(q[ids.mass(DRIVER)], *self._arm(DRIVER, body.centre, arm))
        for rod in crank_rods(self.analysis.machine.linkage):
            turning, reciprocating = self.point_masses(rod)
            balanced = turning if share == 0.0 else plus(turning, share * reciprocating)
            if balanced != NOTHING:
                lay(balanced, *self._arm(rod.rod, rod.crank_pin, rod.pin))
        return [minus(plus(*axis)) for axis in terms]

    def _arm(self, link: int, name: str, place: complex) -> tuple[Expression, Expression]:
        """Return the distance of a point of the crank from its centre, and its angle from the pin."""
        q, length = self.q, ids.length(self.crank.centre, name)
        arm = q.find(length) or q.give(length, abs(place))
        if abs(place.imag) <= ON_ITS_LINK * abs(place) and place.real > 0:
            return arm, NOTHING
        id = balance_ids.pin_turn(link)
        return arm, q.find(id) or q.give(id, float(np.angle(place)))

    def point_masses(self, rod: CrankRod) -> tuple[Expression, Expression]:
        """Return m_A and the reciprocating mass, m_B and the slider's mass; each is entered once."""
        q, m, slider = self.q, self.q.find(ids.mass(rod.rod)), self.q.find(ids.mass(rod.slider)) or NOTHING
        if m is None:
            return NOTHING, slider
        at_pin, at_end = (balance_ids.point_mass(rod.rod, name) for name in (rod.crank_pin, rod.end))
        if at_pin not in q:
            whole = q[ids.length(rod.crank_pin, rod.end)]
            part = q.find(ids.length(rod.crank_pin, rod.centre)) or (whole if rod.centre == rod.end else NOTHING)
            q.define(at_end, m * part / whole if part != NOTHING else 0.0)
            q.define(at_pin, m - q[at_end])
        return q[at_pin], plus(q[at_end], slider)

    # --- the whole balance of a four-bar

    def whole_balance(self) -> None:
        """Enter U of both counterweights by their components, along and across their links.

        The coupler's mass m₂ is distributed to its pins by the shares 1 − (ξ + iη)/b and (ξ + iη)/b.
        """
        q, linkage = self.q, self.analysis.machine.linkage
        dyad = four_bar(linkage)
        assert dyad is not None, "another linkage is refused by the checks"
        rods = ((self.crank.centre, self.crank.pin), (dyad.start, dyad.middle), (dyad.end, dyad.middle))
        a, b, c = (q[ids.length(*map(str, ends))] for ends in rods)
        bodies = {body.link: body for body in linkage.inertias if body.mass > 0}
        at_pins: Mapping[int, tuple[Expression, Expression]] = {}
        if (coupler := bodies.get(dyad.links[0])) is not None:
            m, (ξ, η) = q[ids.mass(coupler.link)], self._on_link(coupler)
            at_pins = {
                DRIVER: (m * a * plus(ONE, minus(over(ξ, b))), minus(over(times(m, a, η), b))),
                dyad.links[1]: (over(times(m, c, ξ), b), over(times(m, c, η), b)),
            }
        for link in self.links:
            own: tuple[Expression, Expression] = (NOTHING, NOTHING)
            if (body := bodies.get(link)) is not None:
                ξ, η = self._on_link(body)
                own = times(q[ids.mass(link)], ξ), times(q[ids.mass(link)], η)
            taken = at_pins.get(link, (NOTHING, NOTHING))
            self._product(str(link), str(link), [minus(plus(*both)) for both in zip(own, taken, strict=True)])

    def _on_link(self, body: Inertia) -> tuple[Expression, Expression]:
        """Return the place of a mass centre in its link's frame, from the first joint: along the link and across it."""
        q, place = self.q, place_on_link(self.analysis.machine.linkage, body.link, body.centre)
        parts: list[Expression] = []
        for axis, value in zip(AXES, (place.real, place.imag), strict=True):
            nothing = abs(value) <= ON_ITS_LINK * max(abs(place), self.crank.length)
            parts.append(
                NOTHING if nothing else q.give(balance_ids.on_link(body.link, axis), value, exact=is_short(value))
            )
        return parts[0], parts[1]

    # --- what is carried out

    @property
    def links(self) -> tuple[int, ...]:
        """The links with counterweights."""
        return tuple(weight.link for weight in self.turn.weights)

    def carried_out(self) -> None:
        """Enter U, mass and weight of each counterweight, and at the positions the remaining force, R₀₁ and M_cb."""
        q, φ = self.q, self.q["phi.1"]
        radius = q[balance_ids.RADIUS]
        heavy = self.unbalance / q.si(radius)
        for rule in list(self.turn.products)[:1]:
            U = q.define(balance_ids.product(DRIVER), q[balance_ids.rule_product(rule)], scale=self.unbalance)
            q.define(balance_ids.angle(DRIVER), q[balance_ids.rule_angle(rule)], scale=1.0, of=U.id)
        for link in self.links:
            m = q.define(balance_ids.mass(link), q[balance_ids.product(link)] / radius, scale=heavy)
            if "g" in q:
                q.define(balance_ids.weight(link), m * q["g"], scale=heavy * q.si("g"))
            along = cis(φ) if link == DRIVER else unit(q[ids.rod(link)])
            q.construct(balance_ids.outward(link), along * cis(q[balance_ids.angle(link)]))
        if self.turn.products:
            self._force_after()
        self._torque_after(radius)

    def _force_after(self) -> None:
        """Enter the remaining force with a counterweight on the crank, and R₀₁, the only reaction that its force and
        weight change.
        """
        q, φ, ψ = self.q, self.q["phi.1"], self.q[balance_ids.angle(DRIVER)]
        P = q.define(
            balance_ids.centrifugal(DRIVER), q[balance_ids.product(DRIVER)] * q["omega.1"] ** 2, scale=self.force
        )
        x, y = (
            q.define(
                balance_ids.after_component(axis), q[balance_ids.component(axis)] + P * of(φ + ψ), scale=self.force
            )
            for axis, of in zip(AXES, (cos, sin), strict=True)
        )
        q.define(balance_ids.AFTER_FORCE, sqrt(x**2 + y**2), scale=self.force)
        held, G = q["F.R01"] - P * q[balance_ids.outward(DRIVER)], q.find(balance_ids.weight(DRIVER))
        q.define(balance_ids.AFTER_REACTION, abs(held if G is None else held + turned(G)), scale=self.force)

    def _torque_after(self, radius: Ref) -> None:
        """Enter M_cb with the counterweights: their weights have moments, and one that turns unevenly has inertia.

        A counterweight on another link needs M_c = m r² ε + G x, which the crank provides by M_c ω/ω₁.
        """
        q, machine = self.q, self.analysis.machine
        torque: list[Expression] = [q["M.eq"]]
        moment: list[Expression] = [q[balance_ids.MOMENT]]
        for link in self.links:
            direction, G, m = q[balance_ids.outward(link)], q.find(balance_ids.weight(link)), q[balance_ids.mass(link)]
            hold: list[Expression] = []
            if link != DRIVER:
                ω, ε = (q[ids.signed(rate, link)] for rate in ("omega", "eps"))
                hold.append(m * radius**2 * ε)
                force = -(m * radius * direction * (turned(ε) - ω**2))
                pivot = next(dyad.end for dyad in machine.linkage.dyads if dyad.links[1] == link)
                arm = q[ids.place(str(pivot))] - q[ids.place(self.crank.centre)] + radius * direction
                moment.append(cross(arm, force))
            if G is not None:
                x = q.define(
                    balance_ids.place(f"W{link}", "x"), call("re", radius * direction), scale=self.crank.length
                )
                hold.append(G * x)
            if link == DRIVER:
                torque += hold
                continue
            M = q.define(balance_ids.hold(link), total(hold), scale=self.torque)
            torque.append(M * ω / signed(machine.turn, q["omega.1"]))
        if len(torque) > 1:
            q.define(balance_ids.AFTER_TORQUE, total(torque), scale=self.torque)
        if len(moment) > 1:
            q.define(balance_ids.AFTER_MOMENT, total(moment), scale=self.torque)

    # --- over the turn

    def over_the_turn(self) -> None:
        """Enter the greatest and the root mean square F of the turn without a counterweight and by each rule, and the
        other effects.
        """
        q, curve, ω2 = self.q, self.turn.curve, self.analysis.machine.speed**2
        F = q[balance_ids.component("x")] + turned(q[balance_ids.component("y")])
        self._of_force(BEFORE, F, curve.greatest()[0] * ω2, curve.rms() * ω2)
        for rule, U in self.turn.products.items():
            own = q[balance_ids.rule_product(rule)] * cis(q["phi.1"] + q[balance_ids.rule_angle(rule)])
            left = F + own * q["omega.1"] ** 2
            self._of_force(rule, left, curve.greatest(U)[0] * ω2, curve.rms(U) * ω2)
        if self.turn.weights:
            self._costs()
        if self.turn.weights and not self.turn.products:
            q.give(
                balance_ids.greatest("F", AFTER), self.turn.left, Symbol("F", "max", "′"), exact=False, scale=self.force
            )

    def _of_force(self, state: str, force: Expression, greatest: float, rms: float) -> None:
        letters = LETTERS.get(state, "0")
        size_of = abs(force)
        with_rest(
            self.q,
            balance_ids.greatest("F", state),
            values=greatest,
            by_rule=call("highest", size_of),
            symbol=Symbol("F", f"max,{letters}"),
            kind="force",
            scale=self.force,
        )
        with_rest(
            self.q,
            balance_ids.rms(state),
            values=rms,
            by_rule=sqrt(call("mean", size_of**2, self.q["even"])),
            symbol=Symbol("F", f"hd,{letters}"),
            kind="force",
            scale=self.force,
        )

    def _costs(self) -> None:
        """Enter the greatest |M| and |M_cb| and the masses, without and with the applied counterweights."""
        q, cycles = self.q, self.turn.cycles
        entered = {"M": (balance_ids.MOMENT, balance_ids.AFTER_MOMENT), "cb": ("M.eq", balance_ids.AFTER_TORQUE)}
        for quantity, pair in entered.items():
            if pair[1] not in q:
                continue
            for state, id, cycle in zip((BEFORE, AFTER), pair, cycles, strict=True):
                curve = cycle.torque
                if quantity == "M":
                    curve = shaking_moment(cycle.machine.linkage, cycle.motion)
                highest = max(float(np.abs(curve).max()), float(np.abs(q.value(id)).max()))
                with_rest(
                    q,
                    balance_ids.greatest(quantity, state),
                    values=highest,
                    by_rule=call("highest", abs(q[id])),
                    symbol=Symbol("M", f"{'qt' if quantity == 'M' else 'cb'},max", "′" if state == AFTER else ""),
                    kind="torque",
                    scale=self.torque,
                )
        masses = [q[ids.mass(body.link)] for body in self.analysis.machine.linkage.inertias if body.mass > 0]
        before = q.define(balance_ids.whole_mass(BEFORE), total(masses), Symbol("m"))
        added = [q[balance_ids.mass(link)] for link in self.links]
        q.define(balance_ids.whole_mass(AFTER), total([before, *added]), Symbol("m", "", "′"))


HOOKS = LedgerHooks(enter_last=enter, mistakes=mistakes)
