"""Friction in the results of a machine."""

from __future__ import annotations

from typing import Any

from reportgen.case.result_entries import load_entries
from reportgen.case.topic_results import ResultHooks
from reportgen.friction.joints import with_friction
from reportgen.machine import Crank
from reportgen.machine.analysis import Analysis


def at_position(analysis: Analysis, k: int, entry: dict[str, Any]) -> None:
    """Add reactions without the force along a guide, the friction on the links, the torque and the efficiency.

    They are None where the mechanism locks.
    """
    solved = with_friction(analysis)
    balance = "torque" if isinstance(analysis.machine.linkage.driver, Crank) else "force"
    if not solved.in_equilibrium[k]:
        locked: dict[str, None] = dict.fromkeys(solved.forces.reactions)
        entry["friction"] = {"reactions": locked, "loads": {}, balance: None, "efficiency": None}
        return
    torque = float(solved.torque[k])
    drives = analysis.machine.turn * analysis.torque[k] > 0
    entry["friction"] = {
        "reactions": {name: reaction.force[k] for name, reaction in solved.forces.reactions.items()},
        "loads": load_entries(solved.loads, k),
        balance: torque,
        "efficiency": analysis.torque[k] / torque if drives else None,
    }


HOOKS = ResultHooks(at_position=at_position)
