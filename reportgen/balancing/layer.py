"""Page layer of the force on the frame: an arrow at the crank's centre with its trace, without and with
counterweights.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from reportgen.balancing import balance_ids
from reportgen.balancing.counterweights import Counterweight
from reportgen.balancing.shaking_force import BalancedTurn, balanced_in, shaking_force, shaking_moment
from reportgen.base.arrays import Complexes, Floats
from reportgen.drawing import Circle, Pen, Polyline, style
from reportgen.drawing.animation import BarScale, MovingBody, MovingItem, MovingVector, Still, Track
from reportgen.formula import Symbol, vocabulary
from reportgen.machine.kinematics import Motion
from reportgen.machine.rigid_motion import unit
from reportgen.page.topic_layers import LayerHooks
from reportgen.report.context import ReportContext

LAYERS = ("shaking", "balanced")
"""Without counterweights and with them."""
NOTHING = 1e-9
"""A force below this share of the one without counterweights is not drawn."""
DISC = 2.4
"""Radius of a counterweight as it is drawn (mm)."""


def forces(turn: BalancedTurn, motion: Motion) -> list[tuple[str, str, Complexes]]:
    """Return the layer, id and values (N) [N] of F without counterweights, and of F with the counterweight on the
    crank.
    """
    before = shaking_force(turn.machine.linkage, motion)
    layers = [(LAYERS[0], balance_ids.FORCE, before)]
    if turn.products and turn.weights:
        (weight,) = turn.weights
        after = before + weight.product * turn.machine.speed**2 * unit(motion.driver)
        layers.append((LAYERS[1], balance_ids.AFTER_FORCE, after))
    return layers


def shaking_items(
    report: ReportContext, motion: Motion, scale: float, longest: float, chosen: Callable[[str, Callable[[], Any]], Any]
) -> tuple[list[MovingItem], list[BarScale]]:
    """Return the shaking forces and their scale, on a drawing of `scale` mm per metre; empty if they are not requested.

    The greatest force is an arrow of `longest` mm, at a scale that is `chosen` once.
    """
    turn = balanced_in(report.analysis)
    greatest = max(float(np.abs(force).max()) for *_, force in forces(turn, motion))
    per = float(chosen("arrows of shaking", lambda: greatest / longest))
    return list(_items(report, turn, motion, scale, per)), [BarScale(per, "force", LAYERS)]


def _items(report: ReportContext, turn: BalancedTurn, motion: Motion, scale: float, per: float) -> Iterator[MovingItem]:
    """Yield the arrows, traces and counterweights, at `per` N/mm."""
    centre = motion.points[report.driver.centre].p * scale
    arrows = forces(turn, motion)
    greatest = float(np.abs(arrows[0][2]).max())
    for layer, id, force in arrows:
        if np.abs(force).max() <= NOTHING * greatest:
            continue
        end = centre + force / per
        symbol = vocabulary.vector(report.ledger.symbol(id))
        yield Still((Polyline(tuple(map(complex, end)), style.PATH),), layer)
        yield MovingVector(Track(centre), Track(end), style.ACTIVE, label=symbol, name=id, layer=layer)
    for weight in turn.weights:
        at = Track(_place(weight, motion) * scale)
        yield MovingBody((Circle(0j, DISC, Pen(0.35), style.TINT),), at, layer=LAYERS[1])


def _place(weight: Counterweight, motion: Motion) -> Complexes:
    """Return the places of a counterweight (m) [N]."""
    return motion.origins[weight.link].p + weight.place * unit(motion.links[weight.link].angle)


def with_room(
    report: ReportContext, motion: Motion, scale: float, box: tuple[complex, complex]
) -> tuple[complex, complex]:
    """Return the corners of a drawing (mm) extended by the counterweights."""
    turn = balanced_in(report.analysis)
    places = [_place(weight, motion) * scale for weight in turn.weights]
    if not places:
        return box
    low, high = box
    x = np.concatenate([place.real for place in places])
    y = np.concatenate([place.imag for place in places])
    room = 2 * DISC
    return (
        complex(min(low.real, x.min() - room), min(low.imag, y.min() - room)),
        complex(max(high.real, x.max() + room), max(high.imag, y.max() + room)),
    )


def values(report: ReportContext, motion: Motion) -> Iterator[tuple[Symbol, str, Floats]]:
    """Yield the sizes of these forces and the moment on the frame: symbol, kind, values (N, N·m) [N]; nothing if not
    requested.
    """
    turn, ledger = balanced_in(report.analysis), report.ledger
    for _, id, force in forces(turn, motion):
        yield ledger.symbol(id), "force", np.abs(force)
    yield ledger.symbol(balance_ids.MOMENT), "torque", shaking_moment(turn.machine.linkage, motion)


HOOKS = LayerHooks(layers=LAYERS, with_bars=shaking_items, room=with_room, values=values)
