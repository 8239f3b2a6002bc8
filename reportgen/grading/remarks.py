"""Right values that the student's own do not give: nothing is taken for them, but both sides should know.

The drawing's tolerance is wide: a reaction may be right within ± 180 N, and yet not be the student's own length times
the own scale.  What is worked out from values that all stand on the sheet can be held against them more closely, and
so can what is measured on a force plan of which all forces do.
"""

from __future__ import annotations

import numpy as np

from reportgen.grading.marks import Cells, Marked, Place, Verdict
from reportgen.grading.working import Working, last_half_unit
from reportgen.notation import vocabulary
from reportgen.notation.evaluation import evaluate

ROOM = 2.0
"""So many times the rounding of all that is written down may part a value from what the others give."""


CLOSES = 1.5
"""So many times the error of a measured length may part it from the one with which the own forces close the plan."""


def not_from_own(working: Working, cells: Cells) -> frozenset[Place]:
    """The places of right values that differ from what the student's own values beside them give."""
    return frozenset(
        place for place, cell in cells.items() if cell.verdict is Verdict.right and _differs(working, cell)
    )


def _differs(working: Working, cell: Marked) -> bool:
    ledger, world = working.guide.ledger, working.world
    id = ledger.size_of(cell.id)
    definition = ledger[id].definition
    assert cell.given is not None, "only a given value is right"
    kind = ledger[id].kind
    if kind == "segment":
        return _differs_on_plan(working, cell)
    if definition is None or id in ledger.constructed or kind.endswith("scale"):
        return False
    index = working.guide.rows[cell.id].at(cell.position)

    def at(name: str) -> float:
        values = world[name]
        return float(values[index if len(values) > 1 else 0].real)

    inputs = {name: at(name) for name in ledger.inputs[id]}
    rounding = {name: _rounding(working, name, cell.position) for name in inputs}
    if not inputs or any(share is None for share in rounding.values()) or not any(rounding.values()):
        return False

    # The first row as the values stand on the sheet, each further one with another of them moved.
    moved = {name: share for name, share in rounding.items() if share}
    values = {name: np.full((len(moved) + 1, 1), value) for name, value in inputs.items()}
    for row, (name, share) in enumerate(moved.items(), start=1):
        values[name][row] *= 1 + share
    with np.errstate(all="ignore"):
        own, *others = (abs(float(one.real)) for one in np.asarray(evaluate(definition, values))[:, 0])
        moves = [abs(one - own) for one in others]
    value = abs(float(working.values[cell.id][index]))
    last = last_half_unit(cell.given) * float(working.unit(cell.id)[index])
    return bool(np.isfinite(own) and abs(value - own) > ROOM * (sum(moves) + last))


def _differs_on_plan(working: Working, cell: Marked) -> bool:
    """Whether a length on a force plan is not that of the own forces, all of which stand on the sheet."""
    guide, plan = working.guide, vocabulary.plan(cell.id)
    if guide.ledger[plan].kind != "force scale" or not _stands(working, plan, cell.position):
        return False
    known = (guide.ledger[one.of].of for id, one in guide.ledger.families.items() if vocabulary.plan(id) == plan)
    laid = [id for id in known if id in guide.rows and plan not in guide.before[id]]
    assert cell.given is not None, "only a given value is right"
    if not all(_stands(working, id, cell.position) for id in laid):
        return False
    apart = abs(abs(cell.given) - abs(cell.own))
    # What is rounded in the forces shows as well where the plan is large.
    forces = (working.submission.values[id, guide.place(guide.rows[id], cell.position)].value for id in laid)
    scale = working.submission.values[plan, guide.place(guide.rows[plan], cell.position)].value
    rounding = sum(map(last_half_unit, forces)) / abs(scale) if scale else np.inf
    error = 2 * guide.policy.paper / guide.ledger[cell.id].how.scale
    return bool(apart > CLOSES * error + rounding)


def _stands(working: Working, id: str, position: int) -> bool:
    """Whether a value that is asked for was filled in."""
    row = working.guide.rows.get(id)
    return row is not None and (id, working.guide.place(row, position)) in working.submission.values


def _rounding(working: Working, id: str, position: int) -> float | None:
    """The share by which a value that was gone on from may be rounded: 0 if it was given; None if it is not known."""
    guide = working.guide
    row = guide.key.find(id)
    if row is None or row.id not in guide.rows:
        family = guide.ledger[id]
        given = not guide.ledger.inputs[id]
        return 0.0 if given and not (family.hidden or family.is_plane) and row is not None else None
    answer = working.submission.values.get((row.id, guide.place(row, position)))
    if answer is None:
        return None
    return last_half_unit(answer.value) / abs(answer.value) if answer.value else 0.0
