"""Ledger entries for values that no printed line computes, kept dependent on their inputs."""

from __future__ import annotations

import numpy as np

from reportgen.formula import Expression, Ref, Symbol, call, ids
from reportgen.formula.calculation import Calculation


def with_rest(
    q: Calculation,
    id: str,
    values: np.ndarray | float,
    by_rule: Expression,
    symbol: Symbol | str,
    kind: str = "",
    scale: float = 0.0,
    optional: bool = False,
) -> Ref:
    """Enter integrated `values` (SI) [N] or one value as a rule plus a constant rest, and return the quantity.

    It thus follows the inputs of the rule, which is nearly exact.
    """
    by_rule_alone = q.construct(ids.rule(id), by_rule)
    rest = q.give(ids.rest(id), np.asarray(values) - q.value(by_rule_alone), Symbol(id), "ratio", hidden=True)
    return q.define(id, call("re", by_rule_alone + rest), symbol, kind, scale=scale, optional=optional)
