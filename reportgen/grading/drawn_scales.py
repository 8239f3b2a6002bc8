"""At which scale a student drew a plan: what was read from it tells, a scale written down, or the report's.

A length stands for a quantity at a scale that is the student's own choice; only sizes over lengths can be judged.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reportgen.grading.guide import Guide, Values
from reportgen.notation import vocabulary

LARGEST_SCALE = 1e6
"""A student's own scale that differs more than this from the report's is no scale."""

MANY = 3
"""So many forces over their lengths show the scale that a plan was drawn at."""

READ_TO = 0.05e-3
"""Half of the last figure of a length on paper (m), which is read to a tenth of a millimetre."""

CONFIRMED = 0.02
"""Two scales nearer than this are one: a millimetre in the length of a drawn crank."""


def in_use(guide: Guide, values: Values, scale: str, place: slice, stated: float) -> float | None:
    """The scale (SI) that a plan was drawn at by what was read from it: most sizes over their lengths, if these agree.

    Only a scale that is chosen freely shows so; `place` is the part of the columns that is drawn at it.  Where they
    agree with the one that is `stated`, few are enough: the plan of a crank has two lengths.
    """
    if guide.ledger[scale].definition is not None or scale == "mu.l":
        return None
    found: list[np.ndarray] = []
    for length in (id for id in values if vocabulary.plan(id) == scale):
        for size in guide.sizes[length] & values.keys():
            with np.errstate(all="ignore"):
                # A short length may be rounded by more than scales differ.
                rounding = READ_TO / np.abs(values[length])
                found.append(np.array([np.abs(values[size] / values[length]), rounding])[:, place])
    ratios, rounding = np.concatenate(found, axis=1) if found else np.zeros((2, 0))
    known = np.isfinite(ratios) & (ratios > 0)
    ratios, rounding = ratios[known], rounding[known]
    if not ratios.size:
        return None
    middle = float(np.median(ratios))
    if (np.abs(ratios / stated - 1) < CONFIRMED + rounding).mean() > 1 / 2:
        return stated
    agree = np.abs(ratios / middle - 1) < CONFIRMED
    return middle if agree.sum() >= MANY and agree.mean() > 1 / 2 else None


def drawn_at(
    guide: Guide, values: Values, plan: Sequence[str], tried: Sequence[float], place: slice
) -> tuple[float, bool]:
    """The scale of a plan over the report's: of those `tried` the first that another confirms, else the best.

    Only the lengths of the plan at a `place` of their columns count.  The second is whether the scale is shown: by
    another, or by half of the lengths.
    """

    def right(factor: float) -> int:
        """How many lengths of the plan are right at that scale."""
        return sum(
            int((np.abs(np.abs(values[id]) * factor - np.abs(guide.ledger[id].values)) <= guide.bands[id])[place].sum())
            for id in plan
        )

    possible = [one for one in tried if np.isfinite(one) and 1 / LARGEST_SCALE < one < LARGEST_SCALE]
    first, *others = possible
    if any(abs(first / other - 1) < CONFIRMED for other in others):
        return first, True
    best = max(possible, key=right)
    return best, 2 * right(best) >= sum(int(np.isfinite(values[id][place]).sum()) for id in plan)
