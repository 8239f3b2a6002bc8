"""Ledger entries for the true motion of a machine.

A value integrated over the cycle is the trapezoid rule over the positions plus the remainder of the integral; the
torque of the drive is read from its characteristic at the computed speed.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from reportgen.derivation.equation_sides import image
from reportgen.derivation.reduction_entries import TERMS, enter_reduced
from reportgen.derivation.topic_ledger import LedgerHooks
from reportgen.derivation.unprinted_values import with_rest
from reportgen.formula import NOTHING, PI, Expression, Ref, Symbol, call, ids, plus, sqrt, total
from reportgen.formula.calculation import Calculation
from reportgen.machine import DRIVER
from reportgen.machine.analysis import Analysis
from reportgen.motion import run_ids
from reportgen.motion.drives import ConstantDrive
from reportgen.motion.mistakes import mistakes
from reportgen.motion.true_motion import TrueMotion, WheelState, at_positions, motion_in

GIVEN = ("M0", "k", "Mk", "sk", "n0", "i", "J0", "brake")
"""Data of the drive given in a file, as quantities of `run`."""


def enter(q: Calculation, analysis: Analysis) -> None:
    """Enter the true motion; torque and inertia reduced to the crank are used again if they have been entered.

    Ids: `run.a.S2`, the slope of the reduced inertia `run.dJ`; for the machine alone, and with the suffix `.wheel` for
    the machine with its flywheel, `run.Md` the torque of the drive, `run.Mc` the same by its formula, `run.A` its work
    and that of the loads, `run.T`, `run.omega`, `run.eps`, `run.t`; the bounds `run.max`, `run.min` of the speed,
    `run.mean`, `run.delta`, `run.period`, `run.work`, `run.power`; `run.step`, `run.apart` by steps.  For start and
    stop `run.t.start`, `run.t.stop`, `run.phi.start`, `run.phi.stop`; for the choice of a motor `run.Mmean`,
    `run.Meff`, `run.Mmost`, `run.Mres`.
    """
    motion = motion_in(analysis)
    at = at_positions(analysis.machine, motion.alone)
    if "M.r" not in q:
        torque = motion.alone.run.torque
        enter_reduced(q, analysis, torque[at], float(np.abs(torque).max()))
    slope = _slope(q, analysis)
    if "run.J0" in q:
        i = q.find("run.i")
        J0 = q["run.J0"]
        q.define("run.J", J0 if i is None else J0 / i**2, Symbol("J", "dc"), "moment of inertia")
    for state in motion.states:
        _Steady(q, analysis, motion, state).enter(slope)
    _start_and_stop(q, motion)
    if motion.asked.motors:
        demand = motion.demand(analysis.machine)
        for name, value, index in (
            ("Mmean", demand.mean, "dc,tb"),
            ("Meff", demand.effective, "dc,hd"),
            ("Mmost", demand.most, "dc,max"),
            ("Mres", demand.resistance, "tt,max"),
        ):
            q.give(run_ids.quantity(name), value, Symbol("M", index), "torque", exact=False)


def _slope(q: Calculation, analysis: Analysis) -> Expression:
    """Enter J′ = 2 Σ(m v_S a_S^v + J ω ε)/ω₁³; if that is too long for a line, each link's part is a separate entry."""
    ω1 = q["omega.1"]
    parts: dict[int, list[Expression]] = {}
    for body in analysis.machine.linkage.inertias:
        link, centre = body.link, body.centre
        own: list[Expression] = []
        velocity, plans = ids.velocity(centre), [ids.plan_point(what, image(centre)) for what in "va"]
        # The crank turns evenly: its own energy does not change.
        moves = link != DRIVER and velocity in q and all(id in q for id in plans)
        if body.mass > 0 and moves:
            v, a = (q[id] for id in plans)
            most = float(np.abs(q.value(ids.acceleration(centre))).max())
            along = q["mu.a"] * call("along", a, v)
            # Links whose masses are in one pin share its acceleration.
            id = run_ids.along_velocity(centre)
            a_v = q.find(id) or q.define(id, along, Symbol("a", centre, "v"), scale=most)
            own.append(q[ids.mass(link)] * q[velocity] * a_v)
        ω, ε = (q.find(ids.signed(rate, link)) for rate in ("omega", "eps"))
        if body.moment > 0 and link != DRIVER and ω is not None and ε is not None:
            own.append(q[ids.inertia(link)] * ω * ε)
        if own:
            parts[link] = own
    terms = [term for own in parts.values() for term in own]
    if not terms:
        return NOTHING
    scale = float(q.value("J.r").max())

    def share(id: str, own: Iterable[Expression], sub: str) -> Ref:
        return q.define(id, 2 * total(own) / ω1**3, Symbol("J", sub, "′"), scale=scale)

    if len(terms) <= TERMS or len(parts) == 1:
        return share(run_ids.slope(), terms, "tt")
    each = [share(run_ids.slope(link), own, f"tt{link}") for link, own in parts.items()]
    return q.define(run_ids.slope(), total(each), Symbol("J", "tt", "′"), scale=scale)


class _Steady:
    """The entries of one steady motion."""

    def __init__(self, q: Calculation, analysis: Analysis, motion: TrueMotion, state: WheelState) -> None:
        self.q, self.machine, self.motion, self.state = q, analysis.machine, motion, state
        self.steady = motion.states[state]
        self.at = at_positions(self.machine, self.steady)

    def id(self, quantity: str) -> str:
        return run_ids.in_state(quantity, self.state)

    def symbol(self, letter: str, *index: str, sup: str = "") -> Symbol:
        """Return a letter with its indices, the last of them for the flywheel if there is one."""
        return Symbol(letter, ",".join((*index, *(("d",) if self.state else ()))), sup)

    def enter(self, slope: Expression) -> None:
        q, run, steady = self.q, self.steady.run, self.steady
        M_r, steps = q["M.r"], q["steps"]
        J = plus(*(q.find(id) or NOTHING for id in ("J.r", "run.J", *(("J.d",) if self.state else ()))))
        M_d = self._drive()
        T = run.energy[self.at]
        moved = T - run.energy[0]
        A = with_rest(
            q,
            self.id("A"),
            moved,
            call("excess", M_r + M_d, steps),
            self.symbol("A", "t"),
            "work",
            scale=float(np.abs(run.energy - run.energy[0]).max()),
        )
        T1 = q.give(self.id("T1"), run.energy[0], self.symbol("T", "t1"), "work", exact=False)
        energy = q.define(self.id("T"), T1 + A, self.symbol("T", "t"), "work")
        ω = q.define(self.id("omega"), sqrt(2 * energy / J), self.symbol("ω", "t"), "angular velocity")
        change = NOTHING if slope == NOTHING else ω**2 * slope / 2
        most = float(np.abs(run.acceleration).max())
        over = (M_r + M_d) if change == NOTHING else (M_r + M_d - change)
        q.define(self.id("eps"), over / J, self.symbol("ε", "t"), "angular acceleration", scale=most)
        time = run.time[self.at]
        by_rule = call("summed", 1 / ω, steps)
        with_rest(q, self.id("t"), time, by_rule, self.symbol("t", "t"), "time", scale=steady.period)
        self._bounds(ω)
        whole = 2.0 * self.machine.turns * PI
        period = with_rest(
            q, self.id("period"), steady.period, call("level", 1 / ω, steps) * whole, self.symbol("t", "ck"), "time"
        )
        work = with_rest(
            q,
            self.id("work"),
            steady.work,
            call("level", M_d, steps) * whole,
            self.symbol("W", "dc"),
            "work",
            scale=float(np.abs(run.energy).max()),
        )
        q.define(self.id("power"), work / period, self.symbol("N", "dc"), "power", scale=abs(steady.power))
        self._characteristic(ω)
        if not self.state:
            by_steps = q.define(
                "run.step", call("stepped", ω, M_r + M_d, J, steps), Symbol("ω", "b"), "angular velocity"
            )
            apart = call("highest", call("abs", by_steps - ω) / ω)
            q.define("run.apart", apart, Symbol("δ", "b"), "share", scale=1.0, residue=True)

    def _bounds(self, ω: Ref) -> None:
        q, steady = self.q, self.steady
        most, least = (
            with_rest(q, self.id(name), extreme.speed, call(of, ω), self.symbol("ω", "t", name), "angular velocity")
            for name, of, extreme in (("max", "highest", steady.fastest), ("min", "lowest", steady.slowest))
        )
        mean = q.define(self.id("mean"), (most + least) / 2, self.symbol("ω", "t", "tb"), "angular velocity")
        q.define(self.id("delta"), (most - least) / mean, self.symbol("δ", "t"), "ratio")

    def _drive(self) -> Expression:
        """Return the torque of the drive on the crank: constant, or read at the speed of each position."""
        q, drive = self.q, self.motion.drive
        if not isinstance(drive, ConstantDrive):
            read = self.steady.run.drive
            scale = float(np.abs(read).max())
            return q.give(self.id("Md"), read[self.at], self.symbol("M", "dc"), "torque", exact=False, scale=scale)
        if "run.Md" in q:
            return q["run.Md"]
        if (given := q.find("run.M0")) is not None:
            i = q.find("run.i")
            return q.define("run.Md", given if i is None else given / i, Symbol("M", "dc"), "torque")
        level = -call("level", q["M.r"], q["steps"])
        return with_rest(q, "run.Md", drive.size, level, Symbol("M", "dc"), "torque")

    def _characteristic(self, ω: Ref) -> None:
        """Enter the torque by the formula of the characteristic, if it has one, and the difference of the reading
        from it.
        """
        q, i = self.q, self.q.find("run.i")
        if isinstance(self.motion.drive, ConstantDrive):
            return
        if (k := q.find("run.k")) is not None:
            falling = q["run.M0"] - k * (ω if i is None else ω / i)
            torque: Expression = falling if i is None else falling / i
        elif (breakdown := q.find("run.Mk")) is not None:
            if "run.omega0" not in q:
                q.define("run.omega0", 2 * PI * q["run.n0"] / 60, Symbol("ω", "0"), "angular velocity")
            ω0 = q["run.omega0"] if i is None else i * q["run.omega0"]
            s = q.define(self.id("slip"), 1 - ω / ω0, self.symbol("s", "t"), "ratio", scale=1.0)
            shares = s / q["run.sk"] + q["run.sk"] / s
            torque = 2 * breakdown / (shares if i is None else i * shares)
        else:
            return
        read = q[self.id("Md")]
        formula = q.define(self.id("Mc"), torque, self.symbol("M", "dc", sup="′"), "torque")
        most = call("highest", call("abs", read))
        q.define(
            self.id("reading"),
            call("highest", call("abs", read - formula)) / most,
            self.symbol("δ", "dc"),
            "share",
            scale=1.0,
            residue=True,
        )


def _start_and_stop(q: Calculation, motion: TrueMotion) -> None:
    """Enter the time and the angle from rest to the steady motion, and from there to rest."""
    if motion.started is not None:
        run = motion.started.run
        q.give("run.t.start", motion.started.time, Symbol("t", "md"), "time", exact=False)
        q.give("run.phi.start", run.angle[-1] - run.angle[0], Symbol("φ", "md"), "angle", exact=False)
    if motion.stopped is not None:
        run = motion.stopped
        q.give("run.t.stop", run.time[-1], Symbol("t", "dm"), "time", exact=False)
        q.give("run.phi.stop", run.angle[-1] - run.angle[0], Symbol("φ", "dm"), "angle", exact=False)


HOOKS = LedgerHooks(enter_cycle=enter, mistakes=mistakes)
