"""What balancing comes to besides the ledger: at each position, and over the turn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from reportgen.machine.analysis import Analysis, analyse
from reportgen.machine.balance import BalancedTurn, shaking_force, shaking_moment

Entries = Mapping[str, Any]


def shaken_entries(analysis: Analysis, turn: BalancedTurn) -> Iterator[Entries]:
    """Force and moment on the frame at each position; with counterweights, what these change."""
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
    for k in range(len(analysis.cycle_angle)):
        yield {name: {what: values[k] for what, values in of.items()} for name, of in arrays.items()}


def balancing_summary(turn: BalancedTurn) -> Entries:
    """The force over the turn without a counterweight and by each rule, and the counterweights that are carried out."""
    speed2 = turn.machine.speed**2

    def over_the_turn(product: complex) -> Entries:
        greatest, angle = turn.curve.greatest(product)
        return {"greatest": greatest * speed2, "cycle_angle": angle, "rms": turn.curve.rms(product) * speed2}

    return {
        "unbalanced": over_the_turn(0j),
        "rules": {rule: {"product": product, **over_the_turn(product)} for rule, product in turn.products.items()},
        "counterweights": {
            str(weight.link): {"product": weight.product, "radius": weight.radius, "mass": weight.mass}
            for weight in turn.weights
        },
    }
