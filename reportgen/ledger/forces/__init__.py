"""Forces group by group, as the textbook solves them: definitions from the dyad kinds alone.

Ids: `R.12.t`, `R.12.n`, `R.12` sizes of reactions and `F.R12` their vectors; `assumed.R12.t` the unit vector of
the sense in which a signed component counts as positive, and is drawn on its link; `M.03`, `x.03` the moment about
the pin that a slide's reaction balances and its distance from the pin.  A group's force plan has vertices
`plan.R23.e`, … (metres on paper) and a scale `mu.R23`.  Arms are signed, anticlockwise moments positive, in
metres on paper (lengths drawn at μ_l).  `M.eq` and `M.vw` balance the driver.  A plan is laid out in `Polygon`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from reportgen.ledger.forces.groups import driver, group, lever
from reportgen.ledger.forces.loads import Applied, Statics, carried_reactions, enter_loads
from reportgen.ledger.forces.polygon import Polygon
from reportgen.ledger.kinematics.linkage import natural_sizes
from reportgen.ledger.kinematics.sides import scheme
from reportgen.mechanism.structure import DRIVER, Linkage
from reportgen.notation.sheet import Sheet


def enter_forces(
    q: Sheet, linkage: Linkage, turn: int, applied: Applied, torques: Mapping[str, int] | None = None
) -> tuple[Polygon, ...]:
    """Enter all force quantities, the outermost group first; returns the force plans in that order.

    `applied` maps a force's id to (link, point, unit vector of its positive sense), `torques` a signed
    torque's id to its link.
    """
    statics = Statics(q, scheme(linkage), turn, natural_sizes(q, linkage))
    loads = enter_loads(statics, applied, torques or {})
    statics = replace(statics, loads=loads)
    polygons = []
    for dyad in reversed(linkage.dyads):
        carried = carried_reactions(statics, dyad.links)
        polygons.append(group(replace(statics, loads=(*carried, *loads)), dyad))
    carried = carried_reactions(statics, (DRIVER,))
    polygons.append(driver(replace(statics, loads=(*carried, *loads))))
    lever(statics, loads)
    return tuple(polygons)
