"""Descriptions of drawings as data, for screen readers: keys of phrases and their values.

Each drawing function also yields its description; the phrases are in the language's words, and the report joins them.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reportgen.base.records import Record, replace
from reportgen.base.stable_digits import first_greatest, first_least, significant
from reportgen.base.units import rounded
from reportgen.drawing.chart_data import Content, Diagram, PlottedCurve
from reportgen.formula import Number

SAME = 1e-6
"""A value below this share of the curve's greatest cannot be seen on paper; it is described as 0."""
FIGURES = 4
"""Digits of values that are read from a curve."""
MOST_ZEROS = 6
"""The zeros of a curve are listed only if it has at most this many."""


class PaperLength(Record):
    """A length on the paper of the drawing (mm)."""

    value: float


Told = Content | PaperLength | tuple[Content, ...]


class Fact(Record):
    """One statement about a drawing: the key of a phrase, and the values of its placeholders in order.

    A value that is a tuple of contents is read as a list.
    """

    phrase: str
    values: tuple[Told, ...] = ()


Description = tuple[Fact, ...]


def fact(phrase: str, *values: Told) -> Fact:
    """Return a fact with its values in order."""
    return Fact(phrase, values)


def enlarged(description: Description, by: float) -> Description:
    """Return the description of a drawing that is enlarged by a factor: only its paper lengths change."""
    return tuple(
        replace(fact, values=tuple(PaperLength(v.value * by) if isinstance(v, PaperLength) else v for v in fact.values))
        for fact in description
    )


def direction(vector: complex) -> Number:
    """Return the direction of a vector, in degrees from the x-axis anticlockwise: from 0 to below 360, to a tenth."""
    tenths = round(10 * rounded(math.degrees(cmath.phase(vector)), 1)) % 3600
    return Number(tenths / 10, 1 if tenths % 10 else 0, "°")


def alignment(along: complex) -> Number:
    """Return the direction of an undirected line, in degrees from the x-axis: from 0 to below 180, to a tenth."""
    degrees = direction(along)
    return replace(degrees, value=rounded(degrees.value % 180, 1))


def arrow(name: Told, vector: complex) -> Fact:
    """Return the fact of an arrow true to scale (mm): its name, length and direction."""
    return Fact("arrow", (name, PaperLength(abs(vector)), direction(vector)))


def pointing(name: Told, vector: complex) -> Fact:
    """Return the fact of an arrow whose length is not to scale: its name and direction."""
    return Fact("pointing", (name, direction(vector)))


def turning(name: Told, sense: float) -> Fact:
    """Return the fact of a rotation, anticlockwise if its sense is positive."""
    return Fact("anticlockwise" if sense > 0 else "clockwise", (name,))


def angle(name: Told, size: float) -> Fact:
    """Return the fact of a named angle of the `size` (rad); its sign is ignored."""
    return Fact("angle", (name, direction(cmath.rect(1.0, abs(size)))))


# --- charts ---------------------------------------------------------------------------------------


def of_chart(diagram: Diagram, x: tuple[float, float], y: tuple[float, float]) -> Iterator[Fact]:
    """Yield the facts of a chart: its axes with their ranges `x` and `y`, its curves (`of_curve`) and its levels."""
    unit = "°" if diagram.turn else ""
    for phrase, name, ends, of in (("across", diagram.x, x, unit), ("up", diagram.y, y, "")):
        yield fact(phrase, name, *(_read(end, of) for end in ends))
    for curve in diagram.curves:
        yield from of_curve(curve, unit)
    for level, name in diagram.levels:
        yield fact("level", name, _read(level))


def of_hodograph(diagram: Diagram, x: tuple[float, float], y: tuple[float, float]) -> Iterator[Fact]:
    """Yield the facts of curves of vectors about a pole: the axes with their ranges, and the longest and shortest
    vector of each curve.
    """
    for phrase, name, ends in (("across", diagram.x, x), ("up", diagram.y, y)):
        yield fact(phrase, name, *map(_read, ends))
    for curve in diagram.curves:
        vectors = np.asarray(curve.x, dtype=np.float64) + 1j * np.asarray(curve.y, dtype=np.float64)
        vectors = vectors[np.isfinite(vectors)]
        if vectors.size:
            longest, shortest = (complex(vectors[of(np.abs(vectors))]) for of in (first_greatest, first_least))
            phrase = "hodograph" if curve.label else "only-hodograph"
            read = (one for vector in (longest, shortest) for one in (_read(abs(vector)), direction(vector)))
            yield Fact(phrase, (*_label(curve), *read))


def of_curve(curve: PlottedCurve, unit: str = "") -> Iterator[Fact]:
    """Yield the facts of a curve over an axis with the `unit`: its extremes, their places, and a few zeros.

    A constant curve has one value instead; one of `dots` has their number and no zeros.  A curve without finite points
    has no facts.
    """
    x, y = np.asarray(curve.x, dtype=np.float64), np.asarray(curve.y, dtype=np.float64)
    # Across a gap, such as a radius that becomes infinite, a curve has no zero.
    zeros = [] if curve.dots else crossings(x, y)
    kept = np.isfinite(x) & np.isfinite(y)
    x, y = x[kept], y[kept]
    if not y.size:
        return
    y = np.where(np.abs(y) <= SAME * np.abs(y).max(), 0.0, y)
    name = _label(curve)
    if curve.dots:
        yield Fact("dots" if name else "only-dots", (*name, Number(y.size)))
    high, low = first_greatest(y), first_least(y)
    if np.ptp(y) <= SAME * np.abs(y).max():
        yield Fact("constant" if name else "only-constant", (*name, _read(float(y[0]))))
        return
    ends = (_read(float(y[high])), _read(float(x[high]), unit), _read(float(y[low])), _read(float(x[low]), unit))
    yield Fact("curve" if name else "only-curve", (*name, *ends))
    if 0 < len(zeros) <= MOST_ZEROS:
        yield fact("zeros", tuple(_read(zero, unit) for zero in zeros))


def _label(curve: PlottedCurve) -> tuple[Content, ...]:
    return (curve.label,) if curve.label else ()


def crossings(x: ArrayLike, y: ArrayLike) -> list[float]:
    """Return the x at which the broken line through points x, y [K] meets zero, rising and each once.

    A point whose y is nan is a gap in the line.
    """
    x, y = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    greatest = float(np.abs(y[np.isfinite(y)]).max(initial=0.0))
    places: NDArray[np.float64] = np.where(np.abs(y) <= SAME * greatest, 0.0, y)
    places_of_zero = [float(at) for at, value in zip(x, places, strict=True) if value == 0.0]
    signs = places[:-1] * places[1:]
    for n in np.flatnonzero(signs < 0.0):
        share = places[n] / (places[n] - places[n + 1])
        places_of_zero.append(float(x[n] + share * (x[n + 1] - x[n])))
    return sorted(set(places_of_zero))


def _read(value: float, unit: str = "") -> Number:
    """Return a value with the digits that can be read from a curve."""
    if unit == "°":
        tenths = rounded(value, 1)
        return Number(tenths, 0 if tenths == round(tenths) else 1, unit)
    return Number(significant(value, FIGURES), unit=unit)


# --- lists ----------------------------------------------------------------------------------------


def listed(contents: Iterable[Content]) -> tuple[Content, ...]:
    """Return the contents in order, each once."""
    return tuple(dict.fromkeys(contents))


def names_of(contents: Sequence[Content]) -> Told:
    """Return a single content as it is, several as a tuple."""
    return contents[0] if len(contents) == 1 else tuple(contents)
