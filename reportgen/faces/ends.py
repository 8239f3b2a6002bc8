"""The forces at both ends of a wide slider that tilts in its guide."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reportgen.machine.analysis import Analysis, Machine
from reportgen.machine.force_analysis import reaction_name
from reportgen.machine.loads import carriers
from reportgen.machine.rigid_motion import cross
from reportgen.machine.slider_faces import Faces


def faces_of(machine: Machine) -> Mapping[int, Faces]:
    """Return the faces of a machine's sliders, by their links; {} if all sliders are narrow."""
    return machine.topic("faces", dict) or {}


def at_ends(analysis: Analysis, link: int) -> tuple[str, np.ndarray, np.ndarray, np.ndarray]:
    """Return, for a slider with faces, the name of its reaction, flags where it tilts [N], and N₁ and N₂ (N) [N], nan
    where it does not.
    """
    machine = analysis.machine
    faces, carrier = faces_of(machine)[link], carriers(machine.linkage)[link]
    name = reaction_name(carrier, link)
    reaction = analysis.forces.reactions[name]
    normal = cross(analysis.motion.slides[carrier, link].direction, reaction.force)
    tilts = faces.tilts(normal, reaction.moment)
    first, last = faces.ends(normal, reaction.moment)
    return name, tilts, np.where(tilts, first, np.nan), np.where(tilts, last, np.nan)
