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

import cmath
from collections.abc import Callable, Mapping, Sequence

from reportgen.derivation.equation_sides import Side, image, scheme, sides
from reportgen.derivation.kinematic_entries import Kinematics, What, chosen_scale, crank, enter_centres, slide
from reportgen.derivation.link_points import enter_rod, images, places
from reportgen.derivation.side_motion import acceleration, velocity
from reportgen.derivation.triad_motion import enter_triad
from reportgen.formula import Expression, call, circle_circle, circle_line, ids, meet, sqrt, turned, vocabulary
from reportgen.formula.calculation import Calculation
from reportgen.formula.vocabulary import drawn_length
from reportgen.machine import DRIVER, Crank, Dyad, DyadKind, Guide, Linkage, Triad, under


def enter_kinematics(
    q: Calculation, linkage: Linkage, turn: int, worked: Sequence[int] = (), sense: int = 1, scaled: bool = True
) -> None:
    """Enter every kinematic quantity of a linkage, link by link in order of assembly.

    An accelerated driver runs faster with the `sense` +1, slower with −1; then `eps.1` or `a.A` is already entered.

    The plans are first solved on trial to find the scales at which those of the `worked` positions, counted from 1,
    fill their paper (those of all positions if none is named). If they are not `scaled`, the trial is skipped.
    """
    if not scaled:
        _enter(q, linkage, turn, sense)
        return
    trial = _enter(q.copy(), linkage, turn, sense)
    _enter(q, linkage, turn, sense, {what: chosen_scale(trial, what, worked) for what in ("v", "a")})


def _enter(
    q: Calculation, linkage: Linkage, turn: int, sense: int, scales: Mapping[str, float | None] | None = None
) -> Kinematics:
    for name, at in linkage.ground.items():
        # The machine has already placed the points that follow from given lengths.
        if ids.place(name) not in q:
            q.give(ids.place(name), complex(at), vocabulary.point(name), "length")
    plan = scheme(linkage)
    if isinstance(linkage.driver, Crank):
        k = crank(q, plan, linkage.driver, turn, sense, scales or {})
    else:
        k = slide(q, plan, linkage.driver, turn, sense, scales or {})
        places(k, DRIVER, None)
        for what in ("v", "a"):
            images(k, what, DRIVER, None)
    for member in linkage.groups:
        if isinstance(member, Triad):
            enter_triad(k, member)
        else:
            group(k, member)
    enter_centres(k)
    return k


# --- a group's kinematics, kind by kind -----------------------------------------------------------
# Where its links lie, velocities and accelerations, the points of its links.
# Both follow from two vector equations for the point where the group's two sides meet (`sides`).


def group(k: Kinematics, dyad: Dyad) -> None:
    """Enter the places, velocities and accelerations of a group and of the points of its links."""
    both = sides(k.scheme, dyad)
    PLACES[dyad.kind](k, dyad)
    turns = {link: _turn_of(link, both) for link in dyad.links}
    for link, turn in turns.items():
        places(k, link, turn)
    _motion(k, dyad, "v", turns, lambda: velocity(k, *both))
    _motion(k, dyad, "a", turns, lambda: acceleration(k, *both))


def _motion(k: Kinematics, dyad: Dyad, what: What, turns: Mapping[int, Side | None], solve: Callable[[], None]) -> None:
    solve()
    for link in dyad.links:
        k.share_rotation(what, link)
    if dyad.kind == "RPP":
        _middle_of_rpp(k, dyad, what)
    for link, turn in turns.items():
        images(k, what, link, turn)


def _turn_of(link: int, sides: tuple[Side, Side]) -> Side | None:
    """Return the side that a link turns on, None for one that slides."""
    return next((side for side in sides if side.turns and side.link == link), None)


def _pin(end: str | Guide) -> str:
    assert isinstance(end, str)
    return end


def _guide(end: str | Guide) -> Guide:
    assert isinstance(end, Guide)
    return end


def _rrr(k: Kinematics, dyad: Dyad) -> None:
    start, end, middle = _pin(dyad.start), _pin(dyad.end), dyad.middle
    k.length(start, middle, dyad.lengths[0])
    k.length(end, middle, dyad.lengths[1])
    first, second = k.drawn(start, middle), k.drawn(end, middle)
    k.q.construct(ids.place(middle), circle_circle(k.place(start), first, k.place(end), second, float(dyad.sign)))
    enter_rod(k, dyad.links[0], start, middle)
    enter_rod(k, dyad.links[1], end, middle)


def _rrp(k: Kinematics, dyad: Dyad) -> None:
    start, middle = _pin(dyad.start), dyad.middle
    i, j = dyad.links
    at, along = k.guide(j, _guide(dyad.end))
    k.length(start, middle, dyad.lengths[0])
    length = k.drawn(start, middle)
    k.q.construct(ids.place(middle), circle_line(k.place(start), length, at, along, float(dyad.sign)))
    enter_rod(k, i, start, middle)
    k.put(j, middle, along)


def _rpr(k: Kinematics, dyad: Dyad) -> None:
    """Place the slot's line as a tangent from P to the circle of radius e about T: u = TP/(s + i e)."""
    start, end, middle = _pin(dyad.start), _pin(dyad.end), dyad.middle
    i, j = dyad.links
    q, offset, mu = k.q, dyad.lengths[1], k.q["mu.l"]
    q.construct(ids.place(middle), k.place(start))
    rod = q.construct(ids.rod(j), k.place(start) - k.place(end))
    drawn = q.define(ids.drawn(end, middle), abs(rod) / q["drawing"], drawn_length(end, middle), scale=k.span())
    q.define(ids.length(end, middle), mu * drawn)
    along: Expression = float(dyad.sign) * abs(rod)
    if offset:
        e = k.length(end, f"H{j}", abs(offset))
        reach = sqrt(call("max", 0.0, abs(rod) ** 2 - e**2))
        along = float(dyad.sign) * reach + (1.0 if offset > 0 else -1.0) * turned(e)
    slot = q.construct(ids.slot(j), rod / along)
    k.put(i, start, slot)
    k.put(j, end, slot, middle)


def _prp(k: Kinematics, dyad: Dyad) -> None:
    (at1, along1), (at2, along2) = (
        k.guide(link, _guide(end)) for link, end in zip(dyad.links, (dyad.start, dyad.end), strict=True)
    )
    k.q.construct(ids.place(dyad.middle), meet(at1, along1, at2, along2))
    for link, along in zip(dyad.links, (along1, along2), strict=True):
        k.put(link, dyad.middle, along)


def _rpp(k: Kinematics, dyad: Dyad) -> None:
    start, middle = _pin(dyad.start), dyad.middle
    i, j = dyad.links
    at, along = k.guide(j, _guide(dyad.end))
    slot = k.q.construct(ids.slot(j), along * k.constant(ids.slot_on_link(j), cmath.exp(1j * dyad.slide_angle)))
    k.q.construct(ids.place(middle), meet(at, along, k.place(start), slot))
    k.q.construct(ids.place(under(start, j, k.scheme.owner)), k.place(start))
    k.put(i, start, along)
    k.put(j, middle, along)


def _middle_of_rpp(k: Kinematics, dyad: Dyad, what: What) -> None:
    """Enter the guided point Q of link j, from the point of j under P: they differ by j's rotation only."""
    middle, (_, j) = dyad.middle, dyad.links
    known = under(_pin(dyad.start), j, k.scheme.owner)
    arm = k.place(middle) - k.place(known)
    placed = k.links[j]
    k.put(j, known, placed.axis)
    k.vertex(what, image(middle), k.image_at(what, j, arm))
    k.links[j] = placed
    k.absolute(what, middle)


PLACES: Mapping[DyadKind, Callable[[Kinematics, Dyad], None]] = {
    "RRR": _rrr,
    "RRP": _rrp,
    "RPR": _rpr,
    "PRP": _prp,
    "RPP": _rpp,
}
