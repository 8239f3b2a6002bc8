"""Positions, velocities and accelerations as a plan solves them: definitions from the dyad kinds alone.

Ids: `p.B` a point; `drawn.AB` its drawn length; `seg.v.pb`, `seg.v.ab` segments of the velocity plan;
`v.B`, `v.BA`, `omega.2`; likewise `seg.a…`, `a.B`, `a.BA.n`, `a.BA.t`, `a.BA.k`, `a.BA.r`, `eps.2`.  Sizes
are positive; a signed angular velocity is `turn.omega.2` (anticlockwise positive).  Plan points `plan.v.b`,
`plan.a.b` are metres on paper.  Directions of guides and slots are `guide.3`, `slot.3`.  Ids of `centres` begin
with `ic.`.

Expected from the machine: lengths `l.AB` (else entered as given), and of a crank its angle `phi.1`, its
angular velocity `omega.1` and its drawn length `drawn.O1A`; of a sliding driver its coordinate `s.1` and the
speed `v.A` of its pin.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reportgen.ledger.kinematics.centres import enter_centres
from reportgen.ledger.kinematics.groups import group, images, places
from reportgen.ledger.kinematics.linkage import Kinematics, chosen_scale, crank, slide
from reportgen.ledger.kinematics.sides import scheme
from reportgen.mechanism.structure import DRIVER, Crank, Linkage
from reportgen.notation import ids
from reportgen.notation.sheet import Sheet
from reportgen.notation.vocabulary import point


def enter_kinematics(q: Sheet, linkage: Linkage, turn: int, worked: Sequence[int] = ()) -> None:
    """Enter every kinematic quantity of a linkage, link by link in order of assembly.

    The plans are solved once on trial, to find the scales with which those of the `worked` positions (all of
    them if none is named) fill their paper.
    """
    trial = _enter(q.copy(), linkage, turn)
    _enter(q, linkage, turn, {what: chosen_scale(trial, what, worked) for what in ("v", "a")})


def _enter(q: Sheet, linkage: Linkage, turn: int, scales: Mapping[str, float | None] | None = None) -> Kinematics:
    for name, at in linkage.ground.items():
        # The machine has placed what follows from given lengths.
        if ids.place(name) not in q:
            q.give(ids.place(name), complex(at), point(name), "length")
    plan = scheme(linkage)
    if isinstance(linkage.driver, Crank):
        k = crank(q, plan, linkage.driver, turn, scales or {})
    else:
        k = slide(q, plan, linkage.driver, turn, scales or {})
        places(k, DRIVER, None)
        for what in ("v", "a"):
            images(k, what, DRIVER, None)
    for dyad in linkage.dyads:
        group(k, dyad)
    enter_centres(k)
    return k
