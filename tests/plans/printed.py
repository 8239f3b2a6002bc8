"""How far what is printed lies from what is unrounded: computed quantities, lengths on paper, directions."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from reportgen.formula import ids, vocabulary
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
                allowed = ON_PAPER * 1e-3 + OF_LONGEST * longest[vocabulary.scale_on_paper(id)]
                told = _is_loaded(unrounded, family)
                what = "on paper"
            case "direction":
                allowed, told = np.radians(DIRECTION), _on_paper(unrounded, id) >= TOLD * 1e-3
                what = "direction"
            case _:
                allowed = SHARE * largest(family)
                if family.kind == "angle":
                    allowed = max(allowed, np.radians(ANGLE))
                told = _has_direction(unrounded, family)
                what = "computed"
        apart = np.where(told, apart, 0.0)
        if allowed > 0:
            at = int(np.nanargmax(apart))
            yield Off(id, what, float(apart[at] / allowed), at + 1)


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


def _on_paper(ledger: Ledger, direction: str) -> np.ndarray:
    """How long the vector of a direction is in its plan (m); 0 where it is not drawn."""
    of = vocabulary.vector_of(direction)
    drawn = [f.values for id, f in ledger.families.items() if f.kind == "segment" and vocabulary.vector_of(id) == of]
    return np.abs(drawn[0]) if drawn else np.zeros_like(ledger[direction].values)
