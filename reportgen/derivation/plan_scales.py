"""Choose round scales of plans: worked plans fill their space, and the largest of all positions still fits a sheet.

Sizes are widths and heights of plans in the unit of the represented quantity; boxes are in metres of paper.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from reportgen.base.units import nice_down, nice_up

TEXT_BOX = (0.145, 0.190)
"""Width and height of a plan on a page of text (m), without its labels."""
SHEET_BOXES = (0.360, 0.210), (0.235, 0.335)
"""Width and height of a plan on an A3 sheet (m), landscape or portrait."""
LARGEST_BOXES = (1.08, 0.70), (0.70, 1.08)
"""Width and height of the largest plan of motion (m): it fits a sheet A0, landscape or portrait, with its labels."""
LEAST_MOTION, LEAST_FORCES = 0.060, 0.100
"""Least width or height (m) of a worked plan of velocities or accelerations, and of one of forces."""
DIAGRAM = 0.110, 0.090
"""Largest width and height of the energy–mass diagram (m)."""
UNLOADED = 1e-6
"""A position whose plan is below this share of the largest one counts as unloaded."""
PER_MM = 1e3
"""Scales are SI values per metre of paper; divided by this factor they are per mm, as printed, and round."""


Scaling = Callable[[np.ndarray, float, Iterable[np.ndarray]], np.ndarray]
"""The scale [N] of the force plan of each position, from all sizes [2, N], the least length, other scales [N]."""


def extents(points: Iterable[np.ndarray], positions: int) -> np.ndarray:
    """Return width and height [2, N] of the boxes around points [N] or [1] of a plan, in their unit.

    They are nan where the mechanism has no position.
    """
    places = np.array([np.broadcast_to(point, (positions,)) for point in points])
    return np.array([np.ptp(places.real, axis=0), np.ptp(places.imag, axis=0)])


def fitting(sizes: np.ndarray, box: tuple[float, float]) -> float:
    """Return the smallest round scale (SI per m) at which all plans of the `sizes` [2, K] (SI) fit the box (m).

    It is 0 without plans.
    """
    needed = float(np.max(sizes / np.array(box)[:, None], initial=0.0))
    return nice_up(needed / PER_MM) * PER_MM if needed > 0 else 0.0


def fitting_axis(length: float, room: float) -> float:
    """Return the smallest round scale (SI per m) at which a length (SI) fits an axis of `room` (m of paper)."""
    return nice_up(length / room / PER_MM) * PER_MM


def drawable(sizes: np.ndarray) -> bool:
    """Return True if every plan of the `sizes` [2, K] (m of paper) fits a sheet A0; plans that are nan do not count."""
    known = sizes[:, np.isfinite(sizes).all(axis=0)]
    return any(bool((known <= np.array(box)[:, None]).all()) for box in LARGEST_BOXES)


def filling(sizes: np.ndarray, least: float) -> float:
    """Return the largest round scale (SI per m) at which each plan of the `sizes` [2, K] (SI) has at least the length
    `least` (m).

    It is 0 without plans.
    """
    smallest = float(np.min(sizes.max(axis=0, initial=0.0), initial=np.inf))
    return nice_down(smallest / least / PER_MM) * PER_MM if 0 < smallest < np.inf else 0.0


def common_scale(sizes: np.ndarray, worked: Sequence[int], least: float) -> float:
    """Return one scale (SI per m) for the plans of all positions, of `sizes` [2, N] (SI).

    The `worked` plans, counted from 1 (all if none is named), have at least the length `least` (m) if they then fit
    their page; all plans fit a drawing sheet.
    """
    chosen = sizes[:, [k - 1 for k in worked]] if worked else sizes
    printed, every = (part[:, np.isfinite(part).all(axis=0) & (part.max(axis=0) > 0)] for part in (chosen, sizes))
    on_sheet = min(fitting(every, box) for box in SHEET_BOXES)
    return max(filling(printed, least), fitting(printed, TEXT_BOX), on_sheet) or PER_MM


def own_scales(sizes: np.ndarray, least: float, read_at: Iterable[np.ndarray] = ()) -> np.ndarray:
    """Return a scale (SI per m) for the plan of each position [N], of `sizes` [2, N] (SI).

    The plan has at least the length `least` (m), or just fits a page of text. A position without forces takes the
    largest of the scales, which suits all plans. Forces that were read at other scales `read_at` [N] are not drawn at a
    finer one, which would enlarge the errors of reading.
    """
    known = np.isfinite(sizes).all(axis=0) & (sizes.max(axis=0) > UNLOADED * np.nanmax(sizes, initial=0.0))
    scales = [
        max(filling(sizes_here[:, None], least), fitting(sizes_here[:, None], TEXT_BOX)) if there else 0.0
        for sizes_here, there in zip(sizes.T, known, strict=True)
    ]
    own = np.array([scale or max(scales) or PER_MM for scale in scales])
    coarsest: np.ndarray = np.max([own, *read_at], axis=0)
    return coarsest


def no_scales(sizes: np.ndarray, least: float, read_at: Iterable[np.ndarray] = ()) -> np.ndarray:
    """Return one arbitrary scale (SI per m) for all positions [N], for plans that are drawn elsewhere."""
    return np.full(sizes.shape[1], PER_MM)
