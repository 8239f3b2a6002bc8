"""The true motion in the results of a machine."""

from __future__ import annotations

from typing import Any

from reportgen.case.topic_results import Entries, ResultHooks
from reportgen.machine.analysis import Analysis
from reportgen.motion.true_motion import at_positions, at_true_speeds, motion_in

STATES = {"": "alone", "wheel": "with_flywheel"}


def _at_positions(analysis: Analysis) -> list[Entries]:
    """Return the results at each position of the steady motion, without and with the flywheel; its reactions if
    requested.
    """
    machine, motion = analysis.machine, motion_in(analysis)
    at = {state: at_positions(machine, steady) for state, steady in motion.states.items()}
    true = at_true_speeds(analysis, motion.states[motion.main_state]) if motion.asked.forces else None
    alone = motion.alone.run
    return [
        {
            "reduced_inertia": alone.inertia[at[""][k]] - motion.asked.inertia,
            "inertia_slope": alone.slope[at[""][k]],
            "reduced_torque": alone.torque[at[""][k]],
            **{
                STATES[state]: {
                    "drive": steady.run.drive[at[state][k]],
                    "energy": steady.run.energy[at[state][k]],
                    "omega": steady.run.speed[at[state][k]],
                    "epsilon": steady.run.acceleration[at[state][k]],
                    "time": steady.run.time[at[state][k]],
                }
                for state, steady in motion.states.items()
            },
            **({} if true is None else {"reactions": _reactions(true, k)}),
        }
        for k in range(machine.positions)
    ]


def _reactions(analysis: Analysis, k: int) -> Entries:
    return {name: reaction.force[k] for name, reaction in analysis.forces.reactions.items()}


def besides(analysis: Analysis) -> Entries:
    """Return the results of the cycle, start and stop, and the choice of a motor."""
    machine, motion = analysis.machine, motion_in(analysis)
    entries: dict[str, Any] = {
        STATES[state]: {
            "fastest": {"omega": steady.fastest.speed, "cycle_angle": steady.fastest.angle},
            "slowest": {"omega": steady.slowest.speed, "cycle_angle": steady.slowest.angle},
            "mean": steady.mean,
            "unevenness": steady.unevenness,
            "period": steady.period,
            "work": steady.work,
            "power": steady.power,
        }
        for state, steady in motion.states.items()
    }
    if motion.started is not None:
        run, cycles = motion.started.run, len(motion.started.ends)
        entries["start"] = {"time": run.time[-1], "angle": run.angle[-1] - run.angle[0], "cycles": cycles}
    if motion.stopped is not None:
        run = motion.stopped
        entries["stop"] = {"time": run.time[-1], "angle": run.angle[-1] - run.angle[0]}
    if motors := motion.motors(machine):
        demand = motion.demand(machine)
        entries["motor"] = {
            "chosen": next((each.motor.name for each in motors if each.fits), None),
            "mean": demand.mean,
            "effective": demand.effective,
            "greatest": demand.most,
            "resistance": demand.resistance,
        }
    return {"true_motion": entries}


def at_position(analysis: Analysis, k: int, entry: dict[str, Any]) -> None:
    """Add the speeds, torques and energies at a position."""
    entry["true_motion"] = analysis.derived(_at_positions)[k]


HOOKS = ResultHooks(at_position=at_position, besides=besides)
