"""Formulas of a planetary train, each written once: evaluated over all tooth numbers, and printed in its report."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from reportgen.base.records import Record
from reportgen.formula import Expression, Number, Product, Ref, Symbol, signed
from reportgen.formula.evaluation import evaluate

OTHER = "2′"
"""Name of the second wheel of a double satellite."""
WHEELS = ("1", "2", OTHER, "3")
"""Wheels in the order of their numbers of teeth."""


class TrainScheme(Record):
    """Scheme of a train: flags of the inner wheels that mesh with satellites; a `single` satellite meshes with both."""

    inner: tuple[bool, bool]
    single: bool = False

    @property
    def signs(self) -> tuple[int, int]:
        """Return, for each mesh, +1 if its wheel is inner, so that the satellite turns in its sense relative to the
        carrier, else −1.
        """
        first, second = self.inner
        return 1 if first else -1, 1 if second else -1

    @property
    def sign(self) -> int:
        """Return the sign of z₂z₃/(z₁z₂′) in u₁H = 1 ± z₂z₃/(z₁z₂′)."""
        first, second = self.signs
        return -first * second


def term_of(scheme: TrainScheme, z: Mapping[str, Ref | Symbol]) -> Expression:
    """Return z₂z₃/(z₁z₂′), for a single satellite z₃/z₁."""
    return z["3"] / z["1"] if scheme.single else Product((z["2"], z["3"])) / Product((z["1"], z[OTHER]))


def ratio(scheme: TrainScheme, z: Mapping[str, Ref]) -> Expression:
    """Return u₁H = 1 ± z₂z₃/(z₁z₂′), with wheel 3 at rest (Willis)."""
    return 1 + signed(scheme.sign, term_of(scheme, z))


def first_axes(scheme: TrainScheme, z: Mapping[str, Ref]) -> Expression:
    """Return z₁ ± z₂, twice the distance between the axes of wheel 1 and satellite 2, in modules m."""
    return z["1"] + signed(-scheme.signs[0], z["2"])


def second_axes(scheme: TrainScheme, z: Mapping[str, Ref]) -> Expression:
    """Return z₃ ± z₂′, twice the distance between the axes of wheel 3 and satellite 2′, in modules m₂."""
    return z["3"] + signed(-scheme.signs[1], z[OTHER])


def tip_diameter(module: Expression, z: Expression) -> Expression:
    """Return d_a = m (z + 2) of an outer wheel without profile shift."""
    return module * (z + 2)


def reference_radius(module: Expression, z: Expression) -> Expression:
    """Return r = m z/2."""
    return module * z / 2


TrainFormula = Callable[[TrainScheme, Mapping[str, Ref]], Expression]


def over_teeth(formula: TrainFormula, scheme: TrainScheme, z: NDArray[np.int64]) -> NDArray[np.float64]:
    """Evaluate a formula of a scheme over the tooth numbers of many trains, z [4, N]; returns [N]."""
    return np.asarray(evaluate(_written(formula, scheme), dict(zip(WHEELS, z, strict=True))), dtype=np.float64)


@lru_cache(maxsize=32)
def _written(formula: TrainFormula, scheme: TrainScheme) -> Expression:
    return formula(scheme, {wheel: Ref(wheel) for wheel in WHEELS})


def tip_of_satellite(scheme: TrainScheme, z: Mapping[str, Ref]) -> Expression:
    """Return the tip diameter of satellite 2, in modules m."""
    return tip_diameter(Number(1.0), z["2"])


def tip_of_other_satellite(scheme: TrainScheme, z: Mapping[str, Ref]) -> Expression:
    """Return the tip diameter of satellite 2′, in modules m₂."""
    return tip_diameter(Number(1.0), z[OTHER])
