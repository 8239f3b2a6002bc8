"""A sheet as a model: the crank and slider over arrays, from a sheet that is entered with single numbers."""

from __future__ import annotations

import numpy as np
import pytest

from reportgen.formula import asin, cos, sin, sqrt
from reportgen.formula.array_evaluation import model
from reportgen.formula.calculation import Calculation

R, L, PHI, UP, X, BETA = "l.O1A", "l.AB", "cam.phi", "cam.u", "cam.s", "cam.alpha"
"""Ids that the vocabulary has: for crank, rod, angle of the crank, height of the pin, way of the slider, rod."""


def slider() -> Calculation:
    """x = r cos φ + √(l² − r² sin² φ), sin β = r sin φ/l."""
    q = Calculation(2)
    r, length, φ = q.give(R, 0.05), q.give(L, 0.2), q.give(PHI, np.array([0.0, 1.0]))
    up = q.define(UP, r * sin(φ))
    q.define(X, r * cos(φ) + sqrt(length**2 - up**2))
    q.define(BETA, asin(up / length))
    return q


def test_arrays_of_any_shape_stand_for_single_values() -> None:
    sheet = slider()
    φ, r = np.linspace(0, 6, 7)[:, None], np.array([0.01, 0.05, 0.1])
    found = model(sheet, [X, BETA], **{PHI: φ, R: r})
    # The same operations in another order leave the dust of floats.
    assert found[X] == pytest.approx(r * np.cos(φ) + np.sqrt(0.04 - (r * np.sin(φ)) ** 2), rel=1e-14)
    assert found[BETA] == pytest.approx(np.arcsin(r * np.sin(φ) / 0.2), rel=1e-14, abs=1e-16)
    # Its own values where nothing is known.
    assert model(sheet, [X])[X].tolist() == sheet.value(X).tolist()


def test_what_is_known_hides_what_it_stands_on() -> None:
    """A defined quantity may be known, too: then nothing above it counts, and nothing else is evaluated."""
    found = model(slider(), [BETA], **{UP: np.array([0.1]), R: np.nan})
    assert found[BETA] == pytest.approx(np.pi / 6)


def test_what_is_not_defined_is_nan() -> None:
    """A crank longer than the rod: no fault and no warning, but no value either."""
    assert np.isnan(model(slider(), [X], **{R: 0.5, PHI: 1.5})[X])
    with pytest.raises(KeyError):
        model(slider(), ["l.BC"])
