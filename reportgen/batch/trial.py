"""Whether an assignment of given values is usable: it passes `check`, turns fully and every number is finite."""

from __future__ import annotations

import numpy as np

from reportgen import api, catalogue
from reportgen.analysis import Analysis, motion_at
from reportgen.assignment import Assignment, Fault
from reportgen.assignment.reading import assess
from reportgen.batch.draw import Trial
from reportgen.batch.spec import Settings, Spec
from reportgen.catalogue.machine import Machine
from reportgen.errors import Mark

STEPS = 720
"""Places in a turn, half a degree apart, that the mechanism must reach."""


def trial(spec: Spec) -> Trial:
    """The judge of a spec's variants."""
    section = spec.top.find("parameters")
    mark = section[0].mark if section else spec.top.mark

    def judge(settings: Settings) -> tuple[Fault, ...]:
        assignment, faults = assess(spec.source(settings), spec.path, catalogue.known())
        return tuple(faults) if assignment is None else _works(assignment, mark)

    return judge


def _works(assignment: Assignment, mark: Mark) -> tuple[Fault, ...]:
    try:
        analysis = api.analyse(assignment)
        if not turns(analysis.machine):
            return (Fault("not-turning", mark),)
        return () if finite(analysis) else (Fault("not-finite-results", mark),)
    except np.linalg.LinAlgError:
        return (Fault("not-finite-results", mark),)


def turns(machine: Machine) -> bool:
    """Whether the mechanism assembles all the way round (or along, for a sliding driver)."""
    return bool(motion_at(machine, np.linspace(0.0, 2 * np.pi, STEPS, endpoint=bool(machine.span))).reachable.all())


def finite(analysis: Analysis) -> bool:
    """Whether motion, reactions and both torques are finite at every position."""
    motion = analysis.motion
    arrays = [part for one in motion.links.values() for part in (one.angle, one.omega, one.epsilon)]
    if analysis.loads:
        arrays += [analysis.torque, analysis.torque_by_work]
        arrays += [np.abs(reaction.force) for reaction in analysis.forces.reactions.values()]
    return bool(motion.reachable.all()) and all(bool(np.isfinite(array).all()) for array in arrays)
