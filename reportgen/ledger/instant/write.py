"""Exercise → Ledger: the numbers of all steps that lead to what is asked, with their definitions and decimals."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from reportgen.catalogue.plane_motion import Exercise
from reportgen.catalogue.plane_motion_centres import Layout, lay_out
from reportgen.catalogue.plane_motion_file import Asked, Method
from reportgen.ledger.core import Ledger
from reportgen.ledger.decimals import choose_decimals
from reportgen.ledger.instant.accelerations import enter_accelerations
from reportgen.ledger.instant.board import Board, Quantities, Step
from reportgen.ledger.instant.centres import enter_centre
from reportgen.ledger.instant.methods import belongs, find_velocities
from reportgen.ledger.instant.speeds import enter_given
from reportgen.ledger.instant.systems import solve_accelerations_together
from reportgen.notation.expressions import Symbol, refs
from reportgen.notation.sheet import Sheet

ROUND = 1e-9
"""An angle this little below a whole turn (degrees) is none."""
SAME, NOTHING = 1e-6, 1e-9
"""Values that differ by this share, or in SI units by this much, are one."""
POSITIONS = 1
"""The instant."""


@dataclass(frozen=True)
class Worked:
    """The ledger of an exercise, its layout, and the steps in their order.

    `missing` are the ids of what is asked and no step leads to.
    """

    ledger: Ledger
    layout: Layout
    steps: tuple[Step, ...]
    missing: tuple[str, ...]
    method: Method | None = None

    @property
    def by_method(self) -> bool:
        """Whether a step of it is its method's own."""
        return self.method is None or any(belongs(step, self.method) for step in self.steps)


def work_out(
    exercise: Exercise,
    units: Mapping[str, str],
    names: Mapping[str, str],
    method: Method | None = None,
    velocities_alone: bool = False,
) -> Worked:
    """The exercise worked out step by step; what nothing asked stands on is left out.

    `units` and `names` are the units and the indices of symbols as a language has them.  Velocities are found by the
    `method` if one is named; where they alone are wanted, by no other.
    """
    board = Board(Quantities(POSITIONS, exercise.motion), lay_out(exercise.given, exercise.motion))
    enter_given(board)
    find_velocities(board, method, alone=velocities_alone)
    if not velocities_alone:
        enter_accelerations(board, solve_accelerations_together)
    missing = [one.id for one in exercise.asked if one.what != "centre" and not _leads_to(board, one)]
    for asked in exercise.asked:
        if asked.what == "centre":
            missing += [] if enter_centre(board, asked.body) else [asked.id]
    for asked in exercise.asked:
        _signed(board, asked.id)
        if asked.what in ("v", "a"):
            _directed(board, asked)
    wanted = [one.id for one in exercise.asked]
    wanted += [id for id in board.q.families if id.startswith(("centre.", "turn.", "dir."))]
    wanted += [id for step in board.steps if step.kind == "centre-rate" for id in step.ids]
    if velocities_alone and not any(one.what in ("v", "omega") for one in exercise.asked):
        wanted += [id for id in board.q.families if id.startswith(("v.", "omega."))]
    needed = _with_ancestors(board, wanted)
    steps = tuple(step for step in board.steps if _leads_on(step, needed))
    # A step that is taken is written out whole.
    needed |= _with_ancestors(board, [id for step in steps for id in step.ids])
    steps = tuple(step for step in board.steps if _leads_on(step, needed))
    q = Sheet(POSITIONS)
    for id, family in board.q.families.items():
        if id in needed:
            q.enter(family)
    decimals, cancellations = choose_decimals(q.families, (), set(), (1,))
    ledger = Ledger(q.families, decimals, POSITIONS, cancellations, units).in_language(names)
    return Worked(ledger, board.layout, steps, tuple(missing), method)


def _leads_to(board: Board, asked: Asked) -> bool:
    """Whether the steps lead to what is asked: to the value that the whole system gives, and to no other."""
    motion = board.motion
    if asked.id not in board.q:
        return False
    match asked.what:
        case "omega":
            value: complex = motion.omega(asked.body)
        case "eps":
            value = motion.epsilon(asked.body)
        case what:
            value = motion.v(asked.of) if what == "v" else motion.a(asked.of)
    return math.isclose(board.q.si(asked.id), abs(value), rel_tol=SAME, abs_tol=NOTHING)


def _signed(board: Board, id: str) -> None:
    """A rotation with its sign, positive anticlockwise, beside its size that is worked out."""
    what, _, body = id.partition(".")
    if what in ("omega", "eps") and id in board.q and board.q.families[id].definition is not None:
        motion = board.motion
        rate = motion.omega(int(body)) if what == "omega" else motion.epsilon(int(body))
        board.q.define(f"turn.{id}", board.q[id] if rate >= 0 else -board.q[id], of=id)


def _directed(board: Board, asked: Asked) -> None:
    """Where an asked vector goes, as its angle from +x in [0, 2π), beside its size; a vector of no length has none."""
    motion = board.motion
    vector = motion.v(asked.of) if asked.what == "v" else motion.a(asked.of)
    if vector and asked.id in board.q and board.q.families[asked.id].definition is not None:
        angle = (math.degrees(cmath.phase(vector)) + ROUND) % 360.0 - ROUND
        way = board.q.give(f"way.{asked.id}", math.radians(angle), Symbol("α"), "angle", hidden=True)
        board.q.define(f"dir.{asked.id}", way, scale=1.0, of=asked.id)


def _with_ancestors(board: Board, ids: Sequence[str]) -> set[str]:
    """Those of the ids that are on the board, and everything that they stand on."""
    families = board.q.families
    waiting = [id for id in ids if id in families]
    found: set[str] = set()
    while waiting:
        id = waiting.pop()
        if id not in found:
            found.add(id)
            definition = families[id].definition
            waiting += () if definition is None else refs(definition)
    return found


def _leads_on(step: Step, needed: set[str]) -> bool:
    """Whether a step works out anything that is needed, or says why something needed is nothing."""
    worked = [id for id in step.ids if not id.startswith("l.")]
    return any(id in needed for id in worked or [f"v.{step.point}"])
