"""Balancing in the results of a machine: at each position, and over the turn."""

from __future__ import annotations

from typing import Any

from reportgen.balancing.shaking_force import balanced_in, shaking_force, shaking_moment
from reportgen.case.topic_results import Entries, ResultHooks
from reportgen.machine.analysis import Analysis, analyse


def _at_positions(analysis: Analysis) -> list[Entries]:
    """Return force and moment on the frame at each position; with counterweights, the results that these change."""
    turn = balanced_in(analysis)
    states = {"shaking": analysis} | ({"balanced": analyse(turn.balanced)} if turn.weights else {})
    arrays = {
        name: {
            "force": shaking_force(state.machine.linkage, state.motion),
            "moment": shaking_moment(state.machine.linkage, state.motion),
            **(
                {}
                if name == "shaking"
                else {"R01": state.forces.reactions["R01"].force, "balancing_torque": state.torque}
            ),
        }
        for name, state in states.items()
    }
    return [
        {name: {what: values[k] for what, values in of.items()} for name, of in arrays.items()}
        for k in range(len(analysis.cycle_angle))
    ]


def at_position(analysis: Analysis, k: int, entry: dict[str, Any]) -> None:
    """Add force and moment on the frame at a position."""
    entry |= analysis.derived(_at_positions)[k]


def besides(analysis: Analysis) -> Entries:
    """Return the force over the turn without a counterweight and by each rule, and the applied counterweights."""
    turn = balanced_in(analysis)
    speed2 = turn.machine.speed**2

    def over_the_turn(product: complex) -> Entries:
        greatest, angle = turn.curve.greatest(product)
        return {"greatest": greatest * speed2, "cycle_angle": angle, "rms": turn.curve.rms(product) * speed2}

    entries = {
        "unbalanced": over_the_turn(0j),
        "rules": {rule: {"product": product, **over_the_turn(product)} for rule, product in turn.products.items()},
        "counterweights": {
            str(weight.link): {"product": weight.product, "radius": weight.radius, "mass": weight.mass}
            for weight in turn.weights
        },
    }
    return {"balancing": entries}


HOOKS = ResultHooks(at_position=at_position, besides=besides)
