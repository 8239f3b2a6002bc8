"""Instant centres that are asked: where they are, and how one is found of a body whose rotation is known already."""

from __future__ import annotations

from reportgen.catalogue.plane_motion_centres import NEAR, Centre, name_of_centre
from reportgen.ledger.instant.board import Board, Step
from reportgen.notation.expressions import Symbol


def enter_centre(board: Board, body: int) -> bool:
    """Enters the coordinates of a body's instant centre; whether it is known, which one infinitely far is, too."""
    if body not in board.layout.centres:
        _from_rate(board, body)
    centre = board.layout.centres.get(body)
    if centre is None:
        return False
    if centre.rule != "translation":
        for axis, value in (("x", centre.at.real), ("y", centre.at.imag)):
            size = board.motion.size
            board.q.give(f"centre.{body}.{axis}", value, Symbol(axis, centre.name), "length", exact=False, scale=size)
    return True


def _from_rate(board: Board, body: int) -> None:
    """The centre on the normal to a known velocity, at the distance v/ω; infinitely far in translation."""
    layout, q = board.layout, board.q
    known = [name for name in layout.members[body] if board.knows(f"v.{name}")]
    if not board.knows(f"omega.{body}") or not known:
        return
    at = board.motion.centre(body)
    if at is None:
        layout.centres[body] = Centre(body, "translation")
        return
    name = name_of_centre(layout, body, at)
    away = next((one for one in known if abs(layout.points[one] - at) > NEAR), "")
    layout.centres[body] = Centre(body, "rate", name, at, (away,) if away else ())
    if away:
        length = q.define(f"l.{name}{away}", q[f"v.{away}"] / q[f"omega.{body}"])
        board.steps.append(Step("centre-rate", (length.id,), body, away, name))
