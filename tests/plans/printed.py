"""How far what is printed lies from what is unrounded: computed quantities, lengths on paper, directions."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from reportgen.formula import Product, Ref, ids, vocabulary
from reportgen.formula.ledger import Ledger
from reportgen.formula.sheet import ZERO, Family
from reportgen.plans.sides import image

SHARE, MEDIAN = 2e-3, 2e-4
"""Of the largest value of a computed quantity: at most, and by the median."""
ON_PAPER, OF_LONGEST = 0.05, 1e-3
"""A length on paper (mm), and besides by what share of the longest of its plan."""
DIRECTION, TOLD = 0.5, 3.0
"""A direction (°) of a vector that is so long on paper (mm) at least."""
ANGLE = 0.02
"""An angle (°): two units of its last digit, whatever its size."""


@dataclass(frozen=True, slots=True)
class Off:
    """The largest difference of one quantity over its positions, as a share of what is allowed."""

    id: str
    what: str
    share: float
    position: int


def differences(unrounded: Ledger, printed: Ledger) -> Iterator[Off]:
    """Every printed quantity that is no given data; a residue and the arm of a load that is nothing are left out."""
    longest = _longest(unrounded)
    for id, family in unrounded.families.items():
        if family.hidden or family.is_plane or family.definition is None or family.residue:
            continue
        apart = np.abs(printed[id].values - family.values)
        if family.how.unit == "°":
            apart = np.minimum(apart, np.abs(2 * np.pi - apart))
        match family.kind:
            case "segment":
                scale = vocabulary.scale_on_paper(id)
                allowed = np.maximum(_read(longest, scale), _laid_off(unrounded, id, longest))
                # An arm is measured to the line of a force, which is off by itself.
                allowed = 2 * allowed if family.arm else allowed
                told = _is_loaded(unrounded, family)
                what = "on paper"
            case "direction":
                drawn = _on_paper(unrounded, id)
                scale = vocabulary.scale_on_paper(_side(unrounded, id))
                with np.errstate(divide="ignore"):
                    off = np.maximum(_read(longest, scale), _laid_off(unrounded, _side(unrounded, id), longest))
                    allowed = np.maximum(np.radians(DIRECTION), off / drawn)
                told = drawn >= TOLD * 1e-3
                what = "direction"
            case _:
                # The mean of positions is that of torques as they are printed.
                whole = unrounded["M.eq"] if id == "M.mean.positions" else family
                allowed = np.maximum(SHARE * largest(whole), _measured(unrounded, family, longest))
                if family.kind == "angle":
                    allowed = np.maximum(allowed, np.radians(ANGLE))
                told = _has_direction(unrounded, family)
                what = "computed"
        apart, allowed = np.broadcast_arrays(np.where(told, apart, 0.0), allowed)
        if np.all(allowed > 0):
            at = int(np.nanargmax(apart / allowed))
            yield Off(id, what, float(apart[at] / allowed[at]), at + 1)


def _read(longest: dict[str, float], scale: str) -> float:
    """What a length (m) of the plans to a scale may be off."""
    return ON_PAPER * 1e-3 + OF_LONGEST * longest[scale]


def _measured(ledger: Ledger, family: Family, longest: dict[str, float]) -> np.ndarray:
    """What a quantity μ · length may be off for the length."""
    match family.definition:
        case Product((Ref(scale), Ref(length))) if ledger[length].kind == "segment":
            return ledger[scale].values * _read(longest, scale)
    return np.zeros(1)


def _laid_off(ledger: Ledger, segment: str, longest: dict[str, float]) -> np.ndarray:
    """What the side of a force plan may be longer or shorter for the force that is laid off there."""
    found = ids.force_segment.read(segment)
    if found is None or (force := ids.of_force(found["force"])) not in ledger:
        return np.zeros(1)
    plan = ids.scale(f"R{found['group']}")
    taken = {ids.of_force(found["force"]), ids.of_force(found["force"][:1] + found["force"][:0:-1])}
    # A reaction on the driver was read from the plan of another group, to a coarser scale.
    coarse = [_measured(ledger, ledger[one], longest) for one in taken if one in ledger]
    off = SHARE * largest(ledger[force]) + sum(coarse, np.zeros(1))
    return np.asarray(off / ledger[plan].values)


def largest(family: Family) -> float:
    """Its largest size (SI); 0 where it is nothing at all positions."""
    sizes = np.abs(family.values[np.isfinite(family.values)])
    return float(np.max(sizes, initial=0.0, where=sizes >= ZERO * family.scale))


def _has_direction(ledger: Ledger, family: Family) -> np.ndarray:
    """Where the velocity is something whose angle to a link is measured; any other quantity is told everywhere."""
    angle = ids.rod_angle.read(family.id)
    if angle is None:
        return np.isfinite(family.values)
    return np.abs(ledger[ids.plan_point("v", image(angle["point"]))].values) >= TOLD * 1e-3


def _longest(ledger: Ledger) -> dict[str, float]:
    """The longest length on paper of each plan, by its scale."""
    found: dict[str, float] = defaultdict(float)
    for id, family in ledger.families.items():
        if family.kind == "segment" and not family.hidden:
            scale = vocabulary.scale_on_paper(id)
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
    of = vocabulary.vector_of(direction)
    return next((id for id, f in ledger.families.items() if f.kind == "segment" and vocabulary.vector_of(id) == of), "")


def _on_paper(ledger: Ledger, direction: str) -> np.ndarray:
    """How long the vector of a direction is in its plan (m); 0 where it is not drawn."""
    of = vocabulary.vector_of(direction)
    drawn = [f.values for id, f in ledger.families.items() if f.kind == "segment" and vocabulary.vector_of(id) == of]
    return np.abs(drawn[0]) if drawn else np.zeros_like(ledger[direction].values)
