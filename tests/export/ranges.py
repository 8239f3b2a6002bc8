"""Random ranges of parameters of the samples, studied together and each value by a file of its own."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import reportgen
from reportgen.base.errors import AssignmentError
from reportgen.base.units import Given
from reportgen.case import Case
from reportgen.cases import opened
from reportgen.export.study import Study
from reportgen.notebook import Model

WIDE = 0.08
"""Half a range at most, as a share of the sample's own value."""
VALUES, LOOKED_AT = 8, (2, 6)
"""Values of a range, and those that are compared with a file of their own: none that a study looks at beforehand."""
COMPARED = 8
"""So many quantities of a range are compared with a file of its own."""


@dataclass(frozen=True)
class Deviation:
    """By how much a quantity of a study is off at a value: the share of its own maximum over the turn."""

    file: str
    parameter: str
    id: str
    together: bool
    off: float


def _numbers(prefix: str, section: Any) -> Iterator[tuple[str, float]]:
    """The quantities of a section by the ways to them, in SI units."""
    for name, field in type(section).model_fields.items():
        value, key = getattr(section, name), f"{prefix}{field.alias or name}"
        if isinstance(value, Given) and value.unit and value.si:
            yield key, value.si
        elif hasattr(type(value), "model_fields"):
            yield from _numbers(f"{key}.", value)


def deviations(path: Path, seed: int) -> Iterator[Deviation]:
    """Those of one random range of one random parameter of a sample."""
    chance = random.Random(seed)
    model = reportgen.open(path)
    known = list(_numbers("", model.assignment.parameters))
    if not known or not model.ids:
        return
    name, value = chance.choice(known)
    low, high = sorted(value * (1 + chance.uniform(-WIDE, WIDE)) for _ in range(2))
    variants = [_variant(model, name, float(one)) for one in np.linspace(low, high, VALUES)]
    if not any(variants):
        return
    study = Study([None if one is None else one.assignment for one in variants], opened)
    wanted = chance.sample(model.ids, min(COMPARED, len(model.ids)))
    found = study.values(wanted)
    for k in LOOKED_AT:
        alone = variants[k]
        if alone is None:
            assert all(np.isnan(found[id][k]).all() for id in wanted)
            continue
        for id in wanted:
            own, of_study = np.asarray(alone[id]), np.asarray(found[id][k])
            assert (np.isnan(own) == np.isnan(of_study)).all()
            scale = np.nanmax(np.abs(own), initial=1e-300)
            together = study.is_determined(id)
            off = (
                float(np.nanmax(np.abs(own - of_study), initial=0.0) / scale)
                if scale > _nothing(alone.case, id)
                else 0.0
            )
            yield Deviation(path.stem, name, id, together, off)


def _variant(model: Model, name: str, value: float) -> Model | None:
    try:
        return model.with_parameters(**{name: value})
    except AssignmentError:
        return None


def _nothing(case: Case, id: str) -> float:
    """Below this a quantity is nothing beside its own scale, and what is left of it is rounding."""
    return 1e-9 * max(case.ledger[id].scale, 0.0) if id in case.ledger else 0.0
