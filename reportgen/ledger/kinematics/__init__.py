"""Positions, velocities and accelerations as a plan solves them: definitions from the dyad kinds alone.

Ids: `p.B` a point; `drawn.AB` its drawn length; `seg.v.pb`, `seg.v.ab` segments of the velocity plan;
`v.B`, `v.BA`, `omega.2`; likewise `seg.a…`, `a.B`, `a.BA.n`, `a.BA.t`, `a.BA.k`, `a.BA.r`, `eps.2`.  Sizes
are positive; a signed angular velocity is `turn.omega.2` (anticlockwise positive).  Plan points `plan.v.b`,
`plan.a.b` are metres on paper.  Directions of guides and slots are `guide.3`, `slot.3`.  Ids of `centres` begin
with its `PREFIX`.

Expected from the machine: lengths `l.AB` (else entered as given), and of a crank its angle `phi.1`, its
angular velocity `omega.1` and its drawn length `drawn.O1A`; of a sliding driver its coordinate `s.1` and the
speed `v.A` of its pin.
"""

from __future__ import annotations

from reportgen.ledger.core import Builder
from reportgen.ledger.kinematics import centres, driver, points
from reportgen.ledger.kinematics.centres import PREFIX, centre_symbol, centred
from reportgen.ledger.kinematics.groups import group
from reportgen.ledger.kinematics.names import difference, image, segment_symbol
from reportgen.ledger.kinematics.sides import Side, Slide, Turn, scheme, sides
from reportgen.mechanism.structure import DRIVER, Crank, Linkage
from reportgen.notation.symbols import point

__all__ = [
    "PREFIX",
    "Side",
    "Slide",
    "Turn",
    "centre_symbol",
    "centred",
    "describe",
    "difference",
    "image",
    "scheme",
    "segment_symbol",
    "sides",
]


def describe(b: Builder, linkage: Linkage, turn: int) -> None:
    """Enter every kinematic quantity of a linkage, link by link in order of assembly.

    With a sliding driver the plans are solved once on trial, to find the scales that fit the paper.
    """
    if isinstance(linkage.driver, Crank):
        _enter(b, linkage, turn)
        return
    trial = b.copy()
    _enter(trial, linkage, turn)
    _enter(b, linkage, turn, (driver.fitting(trial, "v"), driver.fitting(trial, "a")))


def _enter(b: Builder, linkage: Linkage, turn: int, scales: tuple[float, float] | None = None) -> None:
    for name, place in linkage.ground.items():
        b.give(f"p.{name}", point(name), "length", complex(place))
    plan = scheme(linkage)
    if isinstance(linkage.driver, Crank):
        site = driver.crank(b, plan, linkage.driver, turn)
    else:
        site = driver.slide(b, plan, linkage.driver, turn, scales)
        points.place(site, DRIVER, None)
        for what in ("v", "a"):
            points.images(site, what, DRIVER, None)
    for dyad in linkage.dyads:
        group(site, dyad)
    centres.describe(site)
