"""Loops in which nothing is known of either end: all velocities in proportion to one angular velocity.

A lever whose two ends are driven from one shaft, and whose middle has a known velocity, has no end to begin at.  The
velocities of both ends are written as v = k ω of the shaft, with k made of lengths alone; the known velocity divides
them as its point divides the lever, which gives ω.
"""

from __future__ import annotations

from itertools import combinations

from reportgen.ledger.instant.board import Board, Step
from reportgen.ledger.instant.speeds import derive, is_across
from reportgen.notation.expressions import Expression, Fraction, Product, Ref, Symbol, signed
from reportgen.notation.sheet import Sheet

Ratio = tuple[tuple[Ref, ...], tuple[Ref, ...]]
"""The lengths above and below the line of a fraction."""


def enter_proportion(board: Board) -> bool:
    """Finds the angular velocity of one more body through a lever; whether there was one."""
    for body, centre in board.layout.centres.items():
        if centre.rule != "pivot" or board.knows(f"omega.{body}") or not board.motion.omega(body):
            continue
        trial = Board(Sheet(board.q.positions), board.layout)
        trial.given(f"omega.{body}", board.motion.omega(body))
        while derive(trial):
            pass
        for lever, names in board.layout.members.items():
            if lever not in board.layout.centres and _through_lever(board, trial, body, lever, names):
                return True
    return False


def _through_lever(board: Board, trial: Board, body: int, lever: int, names: list[str]) -> bool:
    """ω of a body from a lever with a point M known, whose points P and Q move in proportion to ω."""
    driven = [name for name in names if trial.knows(f"v.{name}")]
    known = [name for name in names if board.knows(f"v.{name}") and board.q.si(f"v.{name}")]
    for p, q in combinations(driven, 2):
        for m in known:
            if m not in (p, q) and is_across(board, p, q, m):
                _enter(board, trial, body, lever, (p, q, m))
                return True
    return False


def _enter(board: Board, trial: Board, body: int, lever: int, names: tuple[str, str, str]) -> None:
    """v_M PQ = v_P MQ + v_Q PM, each with its sense, and M between P and Q or beyond them."""
    p, q, m = names
    way = board.layout.points[q] - board.layout.points[p]
    share = ((board.layout.points[m] - board.layout.points[p]) / way).real
    sense = board.at(m)
    ids = [_factor(board, trial, name, f"omega.{body}") for name in (p, q)]
    parts: list[Expression] = []
    for id, name, far, part in zip(ids, (p, q), (q, p), (1 - share, share), strict=True):
        along = (sense.conjugate() * board.at(name)).real
        parts.append(signed(along * part, board.q[id] * board.length(m, far)))
    parts.sort(key=lambda part: not isinstance(part, Product))
    whole = board.q[f"v.{m}"] * board.length(p, q)
    board.q.define(f"omega.{body}", whole / (parts[0] + parts[1]))
    board.steps.append(Step("proportion", (*ids, f"omega.{body}"), lever, m, p))


def _factor(board: Board, trial: Board, name: str, shaft: str) -> str:
    """Enters k of a point, v = k ω, as a product of lengths; gives its id."""
    above, below = _ratio(trial, f"v.{name}", shaft)
    for length in (*above, *below):
        if length.id not in board.q:
            board.q.enter(trial.q.families[length.id])
    top = above[0] if len(above) == 1 else Product(above)
    bottom = below[0] if len(below) == 1 else Product(below)
    board.q.define(f"k.{name}", Fraction(top, bottom) if below else top, Symbol("k", name), "length")
    return f"k.{name}"


def _ratio(trial: Board, id: str, shaft: str) -> Ratio:
    """The lengths that a rate has over the shaft's; every step from body to body multiplies or divides by one."""
    if id == shaft:
        return (), ()
    match trial.q.families[id].definition:
        case Ref(other):
            return _ratio(trial, other, shaft)
        case Product((Ref(rate), Ref() as length)):
            above, below = _ratio(trial, rate, shaft)
            return (*above, length), below
        case Fraction(Ref(speed), Ref() as length):
            above, below = _ratio(trial, speed, shaft)
            return above, (*below, length)
        case other:
            raise ValueError(f"{id} is no multiple of {shaft}: {other}")
