"""Gears and belts between discs that one arm carries: Willis' formula, for velocities and for accelerations.

Seen from the arm both discs turn about fixed points, and their rims move equally fast at any time.  So the rotations
against that of the arm are to each other as the radii are inversely, and so are their derivatives.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import permutations

from reportgen.catalogue import plane_motion_file as file
from reportgen.catalogue.plane_motion_centres import Layout
from reportgen.ledger.instant.board import Board, Step
from reportgen.notation import vocabulary
from reportgen.notation.expressions import Chain, Expression, Negative, Product, Ref, Sum, Symbol, signed, total
from reportgen.plane_motion.conditions import GROUND


@dataclass(frozen=True, slots=True)
class Pair:
    """Two discs on an arm, each with its centre and the point of its rim that meets the other one or the belt."""

    arm: int
    discs: tuple[int, int]
    centres: tuple[str, str]
    rims: tuple[str, str]
    alike: bool
    """Whether both turn in one sense against the arm, as in an inner meshing or by an open belt."""


def pairs(layout: Layout) -> Iterator[Pair]:
    """The pairs of discs whose centres one moving body carries."""
    for index, joint in enumerate(layout.given.joints):
        if not isinstance(joint, file.Gears | file.RollingOnCircle | file.Belt):
            continue
        found = [layout.given.disc(body) for body in joint.discs]
        centres = tuple(disc.centre for disc in found if disc is not None)
        arms = (body for body in layout.members if body not in joint.discs)
        arm = next((body for body in arms if {*centres} <= {*layout.own(body), *_pivot(layout, body)}), None)
        if arm is None or len(centres) != 2:
            continue
        if isinstance(joint, file.Belt):
            rims, alike = layout.belts[index], not joint.crossed
        else:
            rims = (layout.contacts[index],) * 2
            first, second = (layout.points[rims[0]] - layout.points[name] for name in centres)
            alike = (first.conjugate() * second).real > 0
        yield Pair(arm, (joint.discs[0], joint.discs[1]), (centres[0], centres[1]), rims, alike)


def _pivot(layout: Layout, body: int) -> list[str]:
    centre = layout.centres.get(body)
    return [centre.name] if centre is not None and centre.rule == "pivot" else []


def by_train(board: Board, what: str = "omega") -> bool:
    """The rotation, `omega` or `eps`, of one more disc from that of another one and of their arm."""
    for pair in pairs(board.layout):
        for one, other in permutations(range(2)):
            known, new = pair.discs[one], pair.discs[other]
            told = known == GROUND or board.knows(f"{what}.{known}")
            if told and new != GROUND and board.knows(f"{what}.{pair.arm}") and not board.knows(f"{what}.{new}"):
                _enter(board, what, pair, one)
                return True
    return False


def _enter(board: Board, what: str, pair: Pair, one: int) -> None:
    """ω₂ = (ω_c (r₂ + r₁) − ω₁ r₁)/r₂ with the senses that the rotations have."""
    q, known, new = board.q, pair.discs[one], pair.discs[1 - one]
    radii = [board.length(centre, rim) for centre, rim in zip(pair.centres, pair.rims, strict=True)]
    first, second = radii[one], radii[1 - one]
    sense = math.copysign(1.0, _rate(board, what, new))
    terms: list[Expression] = []
    if arm := _rate(board, what, pair.arm):
        apart = q.si(second.id) - q.si(first.id) if pair.alike else 1.0
        reach = second + first if not pair.alike else second - first if apart > 0 else first - second
        if abs(apart) > 1e-9:
            terms.append(signed(sense * arm * apart, q[f"{what}.{pair.arm}"] * reach))
    if rate := _rate(board, what, known):
        terms.append(signed(sense * rate * (1 if pair.alike else -1), q[f"{what}.{known}"] * first))
    terms.sort(key=lambda term: isinstance(term, Negative))
    if terms:
        q.define(f"{what}.{new}", total(terms) / second)
    else:
        q.give(f"{what}.{new}", 0.0)
    ids = (first.id, second.id, f"{what}.{new}")
    relation = _relation(what, pair, radii)
    board.steps.append(Step(f"train-{what}", ids, new, pair.rims[1 - one], frame=pair.arm, system=(relation,)))


def _rate(board: Board, what: str, body: int) -> float:
    if body == GROUND:
        return 0.0
    return board.motion.omega(body) if what == "omega" else board.motion.epsilon(body)


def _relation(what: str, pair: Pair, radii: list[Ref]) -> Chain:
    """(ω₁ − ω_c) r₁ = −(ω₂ − ω_c) r₂."""
    sides: list[Expression] = []
    for body, radius in zip(pair.discs, radii, strict=True):
        arm, r = _symbol(what, pair.arm), vocabulary.symbol(radius.id)
        against = Sum((_symbol(what, body), Negative(arm)))
        sides.append(Negative(Product((arm, r))) if body == GROUND else Product((against, r)))
    first, second = sides
    if not pair.alike:
        second = second.of if isinstance(second, Negative) else Negative(second)
    return Chain((first, second))


def _symbol(what: str, body: int) -> Symbol:
    return vocabulary.symbol(f"{what}.{body}")
