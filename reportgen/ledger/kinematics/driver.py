"""The driver: a crank at constant ω₁, or a slide at constant speed; scales of the plans."""

from __future__ import annotations

import cmath

import numpy as np

from reportgen.ledger.core import Builder
from reportgen.ledger.kinematics.names import image, length_symbol, segment_symbol
from reportgen.ledger.kinematics.sides import Scheme
from reportgen.ledger.kinematics.site import Site, longest, sizes
from reportgen.mechanism.structure import DRIVER, Crank, SlidingDriver
from reportgen.notation.expressions import (
    Symbol,
    add,
    call,
    divide,
    multiply,
    negative,
    power,
    subtract,
)
from reportgen.notation.numbers import nice_up
from reportgen.notation.symbols import on_plan

DRAWN = 0.05
"""Drawn length of the crank (m on paper) when the machine does not say."""
LONGEST_DRAWN = 0.08
"""A sliding driver's mechanism is drawn with its longest length no longer than this (m on paper)."""
PLAN_BOX = (0.120, 0.160)
"""Plans of a sliding driver fit into this box on paper (m)."""


def crank(b: Builder, scheme: Scheme, driver: Crank, turn: int) -> Site:
    """v_A = ω₁ l, a_A = ω₁² l; μ_v = ω₁ μ_l and μ_a = ω₁² μ_l, so that pa and πa′ equal the drawn crank."""
    centre, pin = driver.centre, driver.pin
    length, drawn = f"l.{centre}{pin}", f"drawn.{centre}{pin}"
    site = Site(b, scheme, turn, sizes(b, scheme.linkage))
    site.length(centre, pin, driver.length)
    if drawn not in b:
        b.give(drawn, length_symbol(centre, pin), "segment", DRAWN)
    b.define("mu.l", Symbol("μ", "l"), "length scale", divide(length, drawn))
    b.construct(f"p.{pin}", add(f"p.{centre}", multiply(length, call("cis", "phi.1"))))
    on_link = [place for place in scheme.linkage.points if place.link == DRIVER]
    for place in on_link:
        turned = add("phi.1", cmath.phase(place.local))
        other = site.length(centre, place.name, abs(place.local))
        b.construct(f"p.{place.name}", add(f"p.{centre}", multiply(other, call("cis", turned))))
        site.drawn(centre, place.name)

    b.define(f"v.{pin}", Symbol("v", pin), "velocity", multiply("omega.1", length))
    exact = b[drawn].exact
    b.define(f"seg.v.p{image(pin)}", segment_symbol("p", on_plan(pin)), "segment", drawn, exact=exact)
    b.define("mu.v", Symbol("μ", "v"), "velocity scale", multiply("omega.1", "mu.l"))
    b.define(f"a.{pin}", Symbol("a", pin), "acceleration", multiply(power("omega.1", 2), length))
    b.define(f"seg.a.p{image(pin)}", segment_symbol("π", on_plan(pin, True)), "segment", drawn, exact=exact)
    b.define("mu.a", Symbol("μ", "a"), "acceleration scale", multiply(power("omega.1", 2), "mu.l"))

    for name in (pin, *(place.name for place in on_link)):
        arm = divide(subtract(f"p.{name}", f"p.{centre}"), "mu.l")
        b.construct(f"plan.v.{image(name)}", multiply(turn, call("turned", arm)))
        b.construct(f"plan.a.{image(name)}", negative(arm))
        if name != pin:
            _further_pin(b, centre, name)
    axis = "axis.1"
    if any(getattr(end, "link", None) == DRIVER for dyad in scheme.linkage.dyads for end in (dyad.start, dyad.end)):
        b.construct(axis, call("cis", "phi.1"))
    site.body(DRIVER, centre, axis)
    return site


def _further_pin(b: Builder, centre: str, name: str) -> None:
    length = f"l.{centre}{name}"
    b.define(f"v.{name}", Symbol("v", name), "velocity", multiply("omega.1", length))
    b.define(f"a.{name}", Symbol("a", name), "acceleration", multiply(power("omega.1", 2), length))
    for plan, pole, prime in (("v", "p", False), ("a", "π", True)):
        b.define(
            f"seg.{plan}.p{image(name)}",
            segment_symbol(pole, on_plan(name, prime)),
            "segment",
            divide(f"{plan}.{name}", f"mu.{plan}"),
        )


def slide(
    b: Builder, scheme: Scheme, driver: SlidingDriver, turn: int, scales: tuple[float, float] | None
) -> Site:
    """The pin moves along its guide at constant v_A, a_A = 0; `scales` are μ_v and μ_a, None for a trial.

    Expects the driver's coordinate `s.1` and the size of its speed, `v.` and the pin's name.
    """
    pin, size = driver.pin, longest(scheme.linkage)
    site = Site(b, scheme, turn, sizes(b, scheme.linkage))
    if "mu.l" not in b:
        b.give("mu.l", Symbol("μ", "l"), "length scale", nice_up(size / LONGEST_DRAWN / 1e3) * 1e3)
    along = site.plane("guide.1", cmath.exp(1j * driver.guide.angle))
    at = site.plane("guide.1.at", driver.guide.at)
    b.construct(f"p.{pin}", add(at, multiply("s.1", along)))
    mu_v, mu_a = scales or (1e3, 1e3)
    b.give("mu.v", Symbol("μ", "v"), "velocity scale", mu_v)
    b.give("mu.a", Symbol("μ", "a"), "acceleration scale", mu_a)
    segment = f"seg.v.p{image(pin)}"
    b.define(segment, segment_symbol("p", on_plan(pin)), "segment", divide(f"v.{pin}", "mu.v"))
    b.construct(f"plan.v.{image(pin)}", multiply(turn, segment, along))
    b.give(f"a.{pin}", Symbol("a", pin), "acceleration", 0.0)
    b.define(f"seg.a.p{image(pin)}", segment_symbol("π", on_plan(pin, True)), "segment", 0.0)
    b.construct(f"plan.a.{image(pin)}", multiply(0.0, along))
    site.body(DRIVER, pin, along)
    return site


def fitting(b: Builder, what: str) -> float:
    """The smallest scale of the series with which the trial's plans, drawn at 10³ a metre, fit their box."""
    plans = [b.value(id) for id in b.families if id.startswith(f"plan.{what}.")]
    points = np.array([np.broadcast_to(plan, (b.positions,)) for plan in plans] + [np.zeros(b.positions)])
    points = points[:, np.isfinite(points).all(axis=0)]
    if not points.size:
        return 1e3
    needed = max(np.ptp(points.real, axis=0).max() / PLAN_BOX[0], np.ptp(points.imag, axis=0).max() / PLAN_BOX[1])
    return nice_up(needed) * 1e3 if needed > 0 else 1e3


