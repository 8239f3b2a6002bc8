"""What follows from another value is what all definitions give again; `test_kinds` has what a hand comes to."""

from __future__ import annotations

import numpy as np
import pytest

from reportgen.formula import Ref, refs
from reportgen.formula.ledger import follow
from reportgen.marking.marking_scheme import MarkingScheme
from reportgen.marking.tolerance_bands import is_direction
from tests.lanes import matrix
from tests.marking import hands, students

AT = 4
TELLING = ("slider-crank-01", "four-bar-01", "slotted-lever-02")
"""A slider, rods, a sliding block with a flywheel; the others are for `make proof`."""
KINDS = (
    "engine-twin-05",
    "engine-single-III",
    "engine-v-01",
    "slider-crank-01",
    "four-bar-01",
    "lever-six-bar-01",
    "slotted-lever-01",
    "slotted-lever-02",
    "shaper-02",
    "toggle-press-01",
    "scotch-yoke-01",
    "linkage-8",
    "linkage-slide",
)
CLOSE = 1e-7
"""A share of the quantity's size: far above rounding of 16 figures in some 30 steps, far below any formula's error."""


def computed(scheme: MarkingScheme) -> list[str]:
    """What is given or worked out by a formula, and what is laid off on paper; not what is measured or chosen."""
    laid = {family.of for family in scheme.ledger.families.values() if family.hidden}
    return [
        id
        for id, family in scheme.ledger.families.items()
        if not (family.hidden or family.is_plane or is_direction(id) or id.startswith(("ic.angle", "M.difference")))
        and (not family.constructed or id in laid)
        and not (is_on_paper(family.kind) and isinstance(family.definition, Ref | None))
    ]


def is_on_paper(kind: str) -> bool:
    return kind == "segment" or kind.endswith("scale")


def size(scheme: MarkingScheme, id: str) -> float:
    """What a quantity is compared with: its largest value, or what is natural to it where all are nothing."""
    return max(scheme.size(id), scheme.ledger[id].scale)


@pytest.mark.parametrize("name", matrix(KINDS, TELLING))
def test_a_datum_taken_otherwise_stretches_nothing(name: str) -> None:
    """Only what is measured or laid off moves a plan; what stands on other data is what all definitions give again."""
    scheme = students.scheme(name)
    ledger = scheme.ledger
    plans = {id for id, family in ledger.families.items() if family.kind == "segment" and family.constructed}
    tried = 0
    for id, family in ledger.families.items():
        given = family.definition is None or not refs(family.definition)
        if (given and not (family.hidden or family.is_plane)) or id == "omega.1":
            tried += 1
            change = {id: lambda value, _: 1.05 * value}
            again, followed = ledger.evaluate(change), follow(ledger, change)
            # A vector of no length has any direction.
            for other in {*plans, *scheme.rows} - {one for one in scheme.rows if is_direction(one)}:
                one, two = again[other], followed[other]
                assert np.allclose(one, two, rtol=CLOSE, atol=CLOSE * size(scheme, other), equal_nan=True), (id, other)
    assert tried >= 5


def test_another_speed_leaves_the_plan_as_it_is() -> None:
    """ω1 = n for 2πn/60: the arm of an inertia force on the lever follows from the definitions, not from a stretch."""
    ledger = students.scheme(hands.TWIN).ledger
    arm = follow(ledger, {"omega.1": 2200.0})["h.Pqt2.p"]
    assert np.allclose(arm, ledger.evaluate({"omega.1": 2200.0})["h.Pqt2.p"])
