"""How far what is printed lies from what is unrounded: computed quantities, lengths on paper, directions."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from reportgen.formula import Product, Ref, ids, vocabulary
from reportgen.formula.calculation import ZERO, Family
from reportgen.formula.ledger import Ledger

SHARE, MEDIAN = 2e-3, 2e-4
"""Of the largest value of a computed quantity: at most, and by the median."""
ON_PAPER, OF_LONGEST = 0.05, 1e-3
"""A length on paper (mm), and besides by what share of the longest of its plan."""
DIRECTION, TOLD = 0.5, 3.0
"""A direction (°) of a vector that is so long on paper (mm) at least."""
ANGLE = 0.01
"""An angle (°): half a unit of the last digit of each of the two that it is the difference of, whatever its size."""
FORMULAS = "f."
"""What ids of closed formulas begin with."""
LAST_DIGIT = 0.005
"""Half a unit of the last digit of an angle (°), which a closed formula takes as it is printed."""


@dataclass(frozen=True, slots=True)
class Off:
    """The largest difference of one quantity over its positions, as a share of what is allowed."""

    id: str
    what: str
    share: float
    position: int


def differences(unrounded: Ledger, printed: Ledger) -> Iterator[Off]:
    """Every printed quantity that is no given data; a residue and the arm of a load that is nothing are left out."""
    longest, by_angles = _longest(unrounded), _by_angles(unrounded)
    loads = _loads_on_paper(unrounded, printed)
    for id, family in unrounded.families.items():
        if family.hidden or family.is_plane or family.definition is None or family.residue:
            continue
        apart = np.abs(printed[id].values - family.values)
        if family.how.unit == "°":
            apart = np.minimum(apart, np.abs(2 * np.pi - apart))
        if family.kind == "segment":
            read = _read(longest, id) + loads[scale_on_paper(id)]
            what, allowed, told = "on paper", read, _is_loaded(unrounded, family)
        elif family.kind == "direction" or id in ids.rod_angle:
            side = _side(unrounded, id)
            drawn = np.abs(unrounded[side].values) if side else np.zeros(1)
            # A direction is no better than the ends of its vector, which may each lie off as a length may.
            read = _read(longest, side) + loads[scale_on_paper(side)]
            off = read / np.maximum(drawn, TOLD * 1e-3)
            what, allowed, told = "direction", np.maximum(np.radians(DIRECTION), off), drawn >= TOLD * 1e-3
        else:
            # The mean of positions is that of torques as they are printed.
            whole = unrounded["M.eq"] if id == "M.mean.positions" else family
            allowed = np.maximum(SHARE * largest(whole), _measured(unrounded, family))
            if id.startswith(FORMULAS):
                allowed = allowed + by_angles[id]
            if id == "friction.eta":
                # A quotient of torques is no better than they are, where both are small.
                allowed = allowed * largest(unrounded["friction.M"]) / np.abs(unrounded["friction.M"].values)
            if family.kind == "angle":
                allowed = np.maximum(allowed, np.radians(ANGLE))
            what, told = "computed", np.isfinite(family.values)
        apart, allowed = np.broadcast_arrays(np.where(told, apart, 0.0), allowed)
        if np.all(allowed > 0):
            at = int(np.nanargmax(apart / allowed))
            yield Off(id, what, float(apart[at] / allowed[at]), at + 1)


def _read(longest: dict[str, float], id: str) -> float:
    """What a length on paper (m) may be off."""
    return ON_PAPER * 1e-3 + OF_LONGEST * longest[scale_on_paper(id)]


def _loads_on_paper(unrounded: Ledger, printed: Ledger) -> dict[str, np.ndarray]:
    """What the loads lie off as they are printed (m on paper), by the scale of each force plan.

    Plans are laid off from printed loads and from reactions that follow from them.  How far loads may be off is counted
    by themselves; where a plan has a scale of its own because its forces are small, it shows on paper.
    """
    scales = {scale_on_paper(id) for id in unrounded.families if id in ids.force_segment}
    loads = {vocabulary.vector_of(id) for id in unrounded.families if id in ids.force_segment}
    off = np.zeros(1)
    for load in (load for load in loads if load.startswith("P") and load in unrounded):
        off = off + np.abs(np.abs(printed[load].values) - np.abs(unrounded[load].values))
    return defaultdict(lambda: np.zeros(1), {scale: off / unrounded[scale].values for scale in scales})


def _measured(ledger: Ledger, family: Family) -> np.ndarray:
    """What a quantity μ · length may be off for the length, which is short where others of its plan are long."""
    match family.definition:
        case Product((Ref(scale), Ref(length))) if ledger[length].kind == "segment":
            return ledger[scale].values * ON_PAPER * 1e-3
    return np.zeros(1)


def _by_angles(ledger: Ledger) -> dict[str, np.ndarray]:
    """What closed formulas may be off besides for each angle that is half a unit of its last digit off."""
    half = np.radians(LAST_DIGIT)
    off: dict[str, np.ndarray] = defaultdict(lambda: np.zeros(1))
    for angle, family in ledger.families.items():
        if angle.startswith(FORMULAS) and family.kind == "angle" and family.how.unit == "°":
            moved = ledger.evaluate({angle: family.values + half})
            for id, values in moved.items():
                if id.startswith(FORMULAS):
                    off[id] = off[id] + np.nan_to_num(np.abs(values - ledger[id].values))
    return off


def largest(family: Family) -> float:
    """Its largest size (SI); 0 where it is nothing at all positions."""
    sizes = np.abs(family.values[np.isfinite(family.values)])
    return float(np.max(sizes, initial=0.0, where=sizes >= ZERO * family.scale))


def _longest(ledger: Ledger) -> dict[str, float]:
    """The longest length on paper of each plan, by its scale."""
    found: dict[str, float] = defaultdict(float)
    for id, family in ledger.families.items():
        if family.kind == "segment" and not family.hidden:
            scale = scale_on_paper(id)
            found[scale] = max(found[scale], float(np.nanmax(np.abs(family.values), initial=0.0)))
    return found


def _is_loaded(ledger: Ledger, family: Family) -> np.ndarray:
    """Where the load of an arm is something; any other length is told everywhere."""
    if not family.arm or family.of not in ledger:
        return np.isfinite(family.values)
    load = ledger[family.of]
    return np.broadcast_to(np.abs(load.values) > ZERO * load.scale, family.values.shape)


def _side(ledger: Ledger, direction: str) -> str:
    """The id of the length on paper of the vector whose direction it is; "" for one that is not drawn."""
    angle = ids.rod_angle.read(direction)
    of = ids.velocity(angle["point"]) if angle else vocabulary.vector_of(direction)
    return next((id for id, f in ledger.families.items() if f.kind == "segment" and vocabulary.vector_of(id) == of), "")


def scale_on_paper(id: str) -> str:
    """The id of the scale of a length or a point on paper; "" for anything else."""
    if vocabulary.is_laid(id):
        return "mu.l"
    if found := ids.plan_point.read(id):
        return ids.scale(found["what"])
    if found := ids.force_corner.read(id):
        return ids.force_scale(found["group"])
    return vocabulary.plan(id)
