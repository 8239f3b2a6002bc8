"""The driver: a crank at constant ω₁, or a slide at constant speed; scales of the plans."""

from __future__ import annotations

import cmath

import numpy as np

from reportgen.ledger.kinematics.linkage import Kinematics, What, longest, natural_sizes
from reportgen.ledger.kinematics.sides import Scheme, image
from reportgen.mechanism.structure import DRIVER, Crank, SlidingDriver
from reportgen.notation.expressions import Number, cis, turned
from reportgen.notation.numbers import nice_up
from reportgen.notation.sheet import Sheet
from reportgen.notation.symbols import drawn_length, on_plan, segment

DRAWN = 0.05
"""Drawn length of the crank (m on paper) when the machine does not say."""
LONGEST_DRAWN = 0.08
"""A sliding driver's mechanism is drawn with its longest length no longer than this (m on paper)."""
PLAN_BOX = (0.120, 0.160)
"""Plans of a sliding driver fit into this box on paper (m)."""


def crank(q: Sheet, scheme: Scheme, driver: Crank, turn: int) -> Kinematics:
    """v_A = ω₁ l, a_A = ω₁² l; μ_v = ω₁ μ_l and μ_a = ω₁² μ_l, so that pa and πa′ equal the drawn crank."""
    centre, pin = driver.centre, driver.pin
    k = Kinematics(q, scheme, turn, natural_sizes(q, scheme.linkage))
    φ1, ω1, length = q["phi.1"], q["omega.1"], k.length(centre, pin, driver.length)
    if f"drawn.{centre}{pin}" not in q:
        q.give(f"drawn.{centre}{pin}", DRAWN, drawn_length(centre, pin))
    drawn = q[f"drawn.{centre}{pin}"]
    exact = q.families[drawn.id].exact
    μ_l = q.define("mu.l", length / drawn)
    q.construct(f"p.{pin}", k.place(centre) + length * cis(φ1))
    further = [place for place in scheme.linkage.points if place.link == DRIVER]
    for place in further:
        other = k.length(centre, place.name, abs(place.local))
        q.construct(f"p.{place.name}", k.place(centre) + other * cis(φ1 + cmath.phase(place.local)))
        k.drawn(centre, place.name)

    q.define(f"v.{pin}", ω1 * length)
    q.define(f"seg.v.p{image(pin)}", drawn, segment("p", on_plan(pin)), exact=exact)
    μ_v = q.define("mu.v", ω1 * μ_l)
    q.define(f"a.{pin}", ω1**2 * length)
    q.define(f"seg.a.p{image(pin)}", drawn, segment("π", on_plan(pin, True)), exact=exact)
    μ_a = q.define("mu.a", ω1**2 * μ_l)

    for name in (pin, *(place.name for place in further)):
        arm = (k.place(name) - k.place(centre)) / μ_l
        k.vertex("v", image(name), turn * turned(arm))
        k.vertex("a", image(name), -arm)
        if name != pin:
            own = q[f"l.{centre}{name}"]
            v, a = q.define(f"v.{name}", ω1 * own), q.define(f"a.{name}", ω1**2 * own)
            q.define(f"seg.v.p{image(name)}", v / μ_v, segment("p", on_plan(name)))
            q.define(f"seg.a.p{image(name)}", a / μ_a, segment("π", on_plan(name, True)))
    ends = (end for dyad in scheme.linkage.dyads for end in (dyad.start, dyad.end))
    carries = any(getattr(end, "link", None) == DRIVER for end in ends)
    k.put(DRIVER, centre, q.construct("axis.1", cis(φ1)) if carries else None)
    return k


def slide(
    q: Sheet, scheme: Scheme, driver: SlidingDriver, turn: int, scales: tuple[float, float] | None
) -> Kinematics:
    """The pin moves along its guide at constant v_A, a_A = 0; `scales` are μ_v and μ_a, None for a trial.

    Expects the driver's coordinate `s.1` and the size of its speed, `v.` and the pin's name.
    """
    pin, size = driver.pin, longest(scheme.linkage)
    k = Kinematics(q, scheme, turn, natural_sizes(q, scheme.linkage))
    if "mu.l" not in q:
        q.give("mu.l", nice_up(size / LONGEST_DRAWN / 1e3) * 1e3)
    along = k.constant("guide.1", cmath.exp(1j * driver.guide.angle))
    at = k.constant("guide.1.at", driver.guide.at)
    q.construct(f"p.{pin}", at + q["s.1"] * along)
    mu_v, mu_a = scales or (1e3, 1e3)
    μ_v = q.give("mu.v", mu_v)
    q.give("mu.a", mu_a)
    drawn = q.define(f"seg.v.p{image(pin)}", q[f"v.{pin}"] / μ_v, segment("p", on_plan(pin)))
    k.vertex("v", image(pin), turn * drawn * along)
    q.give(f"a.{pin}", 0.0)
    q.define(f"seg.a.p{image(pin)}", 0.0, segment("π", on_plan(pin, True)))
    k.vertex("a", image(pin), Number(0.0) * along)
    k.put(DRIVER, pin, along)
    return k


def fitting_scale(k: Kinematics, what: What) -> float:
    """The smallest scale of the series with which the trial's plans, drawn at 10³ a metre, fit their box."""
    plans = [np.zeros(1), *(k.q.value(vertex) for vertex in k.vertices[what])]
    points = np.array([np.broadcast_to(plan, (k.q.positions,)) for plan in plans])
    points = points[:, np.isfinite(points).all(axis=0)]
    if not points.size:
        return 1e3
    needed = max(np.ptp(points.real, axis=0).max() / PLAN_BOX[0], np.ptp(points.imag, axis=0).max() / PLAN_BOX[1])
    return nice_up(needed) * 1e3 if needed > 0 else 1e3
