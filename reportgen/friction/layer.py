"""Page layer of friction on a moving machine: friction circles about pins, and the reactions tangent to them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from reportgen.drawing import Circle, Pen, style
from reportgen.drawing.animation import MovingBody, MovingItem, MovingVector, Track
from reportgen.formula import Symbol, vocabulary
from reportgen.friction.joints import with_friction
from reportgen.friction.views import rubbing
from reportgen.machine.analysis import Analysis
from reportgen.machine.force_analysis import reaction_name
from reportgen.page.topic_layers import LayerHooks
from reportgen.report.context import ReportContext

LAYER = "friction"
CIRCLE = Pen(0.2, style.RED)


def friction_items(
    report: ReportContext, analysis: Analysis, scale: float, per: float, turn: int
) -> Iterator[MovingItem]:
    """Yield the circles and reactions at the samples of an analysis, `scale` in mm/m and `per` in N/mm.

    The first `turn` samples are one turn of the driver, in which the circles follow their pins.
    """
    solved = with_friction(analysis)
    if not per:
        return
    loads = {(load.name, load.link): load for load in solved.loads}
    circles: set[str] = set()
    for each in rubbing(report):
        joint = each.of.joint
        name = reaction_name(*joint.links)
        reaction, rubs = solved.forces.reactions[name], loads[name, joint.links[1]]
        force, at = reaction.force + rubs.force, analysis.motion.points[joint.point].p
        if each.of.is_pin:
            if joint.point not in circles:
                circles.add(joint.point)
                radius = float(report.ledger[each.of.share].values[0]) * scale
                yield MovingBody((Circle(0j, radius, CIRCLE),), Track(at[:turn] * scale), layer=LAYER)
            with np.errstate(divide="ignore", invalid="ignore"):
                at = at - 1j * force * rubs.couple / np.abs(force) ** 2
        else:
            at = np.where(np.isfinite(reaction.point), reaction.point, at)
        symbol = report.named(vocabulary.vector(Symbol("R", each.digits, "fr")))
        start = Track(at * scale)
        yield MovingVector(
            start, Track(at * scale + force / per), style.REACTION, label=symbol, name=f"{name}.fr", layer=LAYER
        )


HOOKS = LayerHooks(layers=(LAYER,), force_layers=(LAYER,), with_forces=friction_items)
