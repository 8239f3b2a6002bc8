"""What no line of the page comes out at, entered so that it still follows the quantities that it depends on."""

from __future__ import annotations

import numpy as np

from reportgen.formula import Expression, Ref, Symbol, call, ids
from reportgen.formula.sheet import Sheet


def with_rest(
    q: Sheet,
    id: str,
    values: np.ndarray | float,
    by_rule: Expression,
    symbol: Symbol | str,
    kind: str = "",
    scale: float = 0.0,
    optional: bool = False,
) -> Ref:
    """Enter what is integrated: it follows what stands in a rule for the positions, by which it is nearly found."""
    by_rule_alone = q.construct(ids.rule(id), by_rule)
    rest = q.give(ids.rest(id), np.asarray(values) - q.value(by_rule_alone), Symbol(id), "ratio", hidden=True)
    return q.define(id, call("re", by_rule_alone + rest), symbol, kind, scale=scale, optional=optional)
