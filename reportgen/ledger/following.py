"""The ledger evaluated as a student's own working goes on: from values read, not from the drawing behind them.

A plan's point and the length measured to it are two families; a definition further on uses the one or
the other.  Whoever measured (or computed) another length goes on from a vector of that length, in the
drawing's direction: `carried` pairs each vector with the sizes that stand for it, and `follow`
stretches the vector whenever one of them is not what the drawing gave.
"""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import Any

import numpy as np

from reportgen.ledger.core import Ledger
from reportgen.notation.expressions import Call, Expression, Product, Ref, refs


def carried(ledger: Ledger) -> dict[str, str]:
    """Ids of vectors by the ids of the sizes that are read from them: seg.v.pb and v.B → plan.v.b, Pqt2 → F.Pqt2."""
    vectors: dict[str, str] = {}
    for id, family in ledger.families.items():
        match _measured(family.definition):
            case Ref(vector):
                vectors[id] = vector
            case Product(factors):
                read = [vectors[ref.id] for ref in factors if isinstance(ref, Ref) and ref.id in vectors]
                scales = [ref for ref in factors if isinstance(ref, Ref) and ledger[ref.id].kind.endswith("scale")]
                if len(factors) == 2 and len(read) == len(scales) == 1:
                    vectors[id] = read[0]
        # A vector that is computed from its size follows it by itself.
        size = family.of if family.is_plane else ""
        if size in ledger and family.definition is not None and size not in refs(family.definition):
            vectors[size] = id
    return vectors


def _measured(definition: Expression | None) -> Expression | None:
    """What the length |…| is measured of; any other definition as it is."""
    while isinstance(definition, Call) and definition.name == "abs":
        definition = definition.arguments[0]
        if isinstance(definition, Ref):
            return definition
    return None if isinstance(definition, Ref) else definition


def follow(
    ledger: Ledger, changes: Mapping[str, Any], *, only: Container[str] | None = None
) -> dict[str, np.ndarray]:
    """As `Ledger.evaluate`, with each vector as long as the sizes say that were read from it."""
    vectors = {size: one for size, one in carried(ledger).items() if only is None or size in only}
    sizes: dict[str, list[str]] = {}
    for size, vector in vectors.items():
        sizes.setdefault(vector, []).append(size)

    def stretch(size: str, values: dict[str, np.ndarray]) -> None:
        vector = vectors[size]
        one, other = np.abs(ledger[size].values), np.abs(ledger[vector].values)
        wanted = np.abs(values[size]) * other / one
        factor = wanted / np.abs(values[vector])
        values[vector] = values[vector] * np.where(np.isfinite(factor), factor, 1.0)

    def entered(id: str, values: dict[str, np.ndarray]) -> None:
        if id in vectors and vectors[id] in values:
            stretch(id, values)
        for size in sizes.get(id, ()):
            if size in values:
                stretch(size, values)

    return ledger.evaluate(changes, entered=entered, only=only)


def standing_on(ledger: Ledger, id: str, vectors: Mapping[str, str]) -> tuple[str, ...]:
    """Every quantity that one stands on, nearest first: its `ancestors` and what was read from their vectors.

    `vectors` is what `carried` says of the ledger.
    """
    read: dict[str, list[str]] = {}
    order = {name: index for index, name in enumerate(ledger.families)}
    for size, vector in vectors.items():
        read.setdefault(vector, []).append(size)
    found: dict[str, None] = {}
    waiting = [id]
    while waiting:
        current = waiting.pop(0)
        definition = ledger[current].definition
        nearer = [*(() if definition is None else refs(definition))]
        nearer += [size for size in read.get(current, ()) if order[size] < order[id]]
        for name in nearer:
            if name not in found and name != id:
                found[name] = None
                waiting.append(name)
    return tuple(found)
