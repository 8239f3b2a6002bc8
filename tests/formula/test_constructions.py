"""Constructions say the same of numbers, of arrays and of symbols."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from reportgen.exercise import algebra
from reportgen.exercise.algebra import Plane
from reportgen.formula import constructions
from reportgen.formula.constructions import circle_circle, circle_line, foot, meet

AT = {"r": 0.5, "s": 0.35, "d": 0.6}
ALONG = complex(np.cos(np.pi / 6), np.sin(np.pi / 6))

Found = Callable[[Any, Any, Any, Callable[[Any, Any], Any], Any, Any], Any]
"""Of three lengths r, s, d, the making of a vector, the unit vector at 30°, and the square root."""

CASES: dict[str, Found] = {
    "foot": lambda r, s, d, at, u, root: foot(at(r, s), at(d, 0), u),
    "meet": lambda r, s, d, at, u, root: meet(at(r, s), u, at(d, 0), at(s, r)),
    "circle and line, far": lambda r, s, d, at, u, root: circle_line(at(0, s), d, at(r, 0), u, 1, root),
    "circle and line, near": lambda r, s, d, at, u, root: circle_line(at(0, s), d, at(r, 0), u, -1, root),
    "two circles, left": lambda r, s, d, at, u, root: circle_circle(at(0, 0), r, at(d, s), s, 1, root),
    "two circles, right": lambda r, s, d, at, u, root: circle_circle(at(0, 0), r, at(d, s), s, -1, root),
}


def root(of: Any) -> Plane:
    return Plane.of(algebra.root(of))


@pytest.mark.parametrize("name", CASES)
def test_numbers_and_symbols_agree(name: str) -> None:
    found = CASES[name]
    number = found(*AT.values(), complex, ALONG, constructions.real_root)
    literal = found(*map(algebra.symbol, AT), Plane, algebra.exact_unit(30.0), root)
    assert complex(*(algebra.value(part, AT) for part in (literal.real, literal.imag))) == pytest.approx(number)


@pytest.mark.parametrize("name", CASES)
def test_arrays_are_their_numbers(name: str) -> None:
    lengths = np.array([[*AT.values()], [0.4, 0.3, 0.5]])

    def at(x: Any, y: Any) -> Any:
        return np.asarray(x + 1j * y)

    found = CASES[name](*lengths.T, at, np.array([ALONG, ALONG]), constructions.real_root)
    each = [CASES[name](*row, complex, ALONG, constructions.real_root) for row in lengths]
    assert found == pytest.approx(np.array(each), rel=1e-14)


def test_circles_meet_at_their_distances() -> None:
    p, q = 0.2 + 0.1j, 0.7 - 0.3j
    for sign in (1, -1):
        at = circle_circle(p, 0.5, q, 0.4, sign)
        assert (abs(at - p), abs(at - q)) == pytest.approx((0.5, 0.4))
        assert np.sign(constructions.cross(q - p, at - p)) == sign
