"""Separated links with all that acts on them: loads, reactions, couples, and the arms of moments."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from reportgen.figures.actions import ArmOf, Couple, Force, couples, forces
from reportgen.figures.draft import Draft, finish
from reportgen.figures.labels import Content
from reportgen.figures.scene import Scene
from reportgen.figures.scheme import Looks, mechanism
from reportgen.figures.skeleton import skeleton
from reportgen.mechanism.motion import Motion
from reportgen.mechanism.structure import Linkage


def bodies(
    linkage: Linkage,
    motion: Motion,
    index: int,
    scale: float,
    links: Sequence[int],
    acting: Sequence[Force] = (),
    *,
    arms: Sequence[ArmOf] = (),
    turning: Sequence[Couple] = (),
    extra: Draft | None = None,
    looks: Looks | None = None,
    notes: Sequence[Content] = (),
    title: str = "",
) -> Scene:
    """The chosen links at position `index`, true to `scale` (mm per m), with forces of schematic length.

    `extra` is drawn with them.  Points of forces, couples and moments are in mm of the plan: metres times
    `scale`, about the mechanism's origin.
    """
    looks = looks or Looks()
    bones = skeleton(linkage, motion, index, scale)
    ends = {link: [bones.points[name] for name in bones.bars.get(link, ())] for link in links}
    bars = [(a, b) for joints in ends.values() for a, b in combinations(joints, 2)]
    draft = mechanism(bones, links, looks) + forces(acting, arms, bars) + couples(turning)
    draft += extra or Draft()
    written = (*notes, *((looks.scale,) if looks.scale is not None else ()))
    return finish(draft, notes=written, title=title)
