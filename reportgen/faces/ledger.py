"""Ledger entries for the place of the reaction in the guide of a wide slider."""

from __future__ import annotations

import numpy as np

from reportgen.derivation.load_entries import Statics
from reportgen.derivation.topic_ledger import LedgerHooks
from reportgen.formula import Expression, Number, call, dot, ids, sign, turned


def enter_guide(statics: Statics, digits: str, link: int) -> None:
    """Enter N and x for a slider whose face is given, and the reactions at both ends where it tilts.

    The reaction balances M, the moment of all other loads about the pin: x = −M/N.
    """
    q = statics.q
    first, last = q.find(ids.face_from(link)), q.find(ids.face_to(link))
    if first is None or last is None:
        return
    R, M = q[ids.reaction(digits)], q.find(ids.reaction_couple(digits))
    side = sign(dot(q[ids.force_vector(ids.reaction_force(digits))], turned(q[ids.guide(link)])))
    N = q.define(ids.normal_reaction(digits), R * side, scale=statics.force)
    place = -(q[ids.application(digits)] * side)
    x = q.define(ids.normal_place(digits), place, scale=statics.span, written=None if M is None else -M / N)
    if np.all((q.value(x) >= q.si(first)) & (q.value(x) <= q.si(last))):
        return
    moment: Expression = Number(0.0) if M is None else M
    ends = (N * last + moment) / (last - first), -((N * first + moment) / (last - first))
    for number, line in enumerate(ends, 1):
        # There is no such reaction where the slider lies on one side.
        q.define(ids.face_reaction(digits, number), call("beyond", line, x, first, last), scale=statics.force)


HOOKS = LedgerHooks(enter_guide=enter_guide)
