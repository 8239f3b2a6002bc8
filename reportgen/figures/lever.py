"""Zhukovsky's lever: the velocity plan turned 90° as a rigid lever about its pole, loaded by all forces.

The forces act at the images of their points; Σ F h = 0 with the balancing force at the crank pin's image
gives the torque on the driver.
"""

from __future__ import annotations

from collections.abc import Sequence

from reportgen.figures.actions import ArmOf, Force, forces
from reportgen.figures.draft import Draft, finish
from reportgen.figures.geometry import clusters
from reportgen.figures.labels import Content, Request, label
from reportgen.figures.plan import CROWDED, Plan, PlanPoint, joined
from reportgen.figures.scale import NOTHING
from reportgen.figures.scene import Circle, Item, Line, Scene
from reportgen.figures.style import PAPER, VISIBLE


def turned(plan: Plan, sense: int = 1) -> Plan:
    """The plan turned by 90° about its pole; anticlockwise for `sense` = +1."""
    return plan.scaled(1j * sense)


def lever(
    plan: Plan,
    acting: Sequence[Force],
    arms: Sequence[ArmOf] = (),
    *,
    sense: int = 1,
    notes: Sequence[Content] = (),
    title: str = "",
) -> Scene:
    """The scene of the lever; `acting` forces and `arms` are given in the *turned* plan's coordinates.

    The plan's vectors become the lever's bars; the pole is drawn as its fixed pivot.
    """
    rigid = turned(plan, sense)
    size = rigid.size
    bars: list[Item] = [
        Line(v.start, v.end, VISIBLE) for v in rigid.vectors if abs(v.end - v.start) > NOTHING * size
    ]
    knots: list[Item] = [Circle(p.at, 0.7, VISIBLE, PAPER) for p in rigid.points[1:]]
    pivot: list[Item] = [Circle(rigid.points[0].at, 1.1, VISIBLE, PAPER)] if rigid.points else []
    draft = Draft((*bars, *knots, *pivot), names(rigid.points)) + forces(acting, arms)
    return finish(draft, notes=notes, title=title)


def names(points: Sequence[PlanPoint]) -> tuple[Request, ...]:
    """One label for points that coincide or nearly do."""
    requests = []
    for group in clusters([p.at for p in points], CROWDED):
        members = [points[i] for i in group]
        requests.append(label(members[0].at, *joined(members), gap=1.3))
    return tuple(requests)
