"""Work and power: the balancing torque by virtual work, and means by continuous quadrature."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from reportgen.mechanism.loads import Load
from reportgen.mechanism.motion import Motion
from reportgen.mechanism.plane import Floats, dot
from reportgen.mechanism.structure import Linkage

CONVERGED = 1e-12
ORDER = 16
MOST_PARTS = 4096


def virtual_work_torque(linkage: Linkage, motion: Motion, loads: Sequence[Load]) -> Floats:
    """The driver's balancing torque M = −(ΣF·v + ΣMω)/ω₁ (N·m); with a sliding driver the force (N).

    Loads on links of `linkage` include inertia forces, so that this is D'Alembert's principle.
    Raises `ValueError` when the driver stands still.
    """
    if motion.rate == 0:
        raise ValueError("virtual work needs a moving driver")
    power = np.where(motion.reachable, 0.0, np.nan)
    for load in loads:
        moved = motion.of(load.link, load.point).v
        power = power + dot(load.force, moved) + load.couple * motion.links[load.link].omega
    return -power / motion.rate


def mean_over(
    function: Callable[[Floats], Floats], breaks: Iterable[float], start: float, stop: float
) -> float:
    """∫ f dx / (stop − start) by composite Gauss–Legendre quadrature, split at `breaks`.

    Every part between breaks must be smooth; parts are halved until the mean settles to 1e-12 of the
    mean of |f|.  Raises `ValueError` on an empty interval or when it does not settle.
    """
    if not stop > start:
        raise ValueError("the interval is empty")
    inside = sorted({start, stop, *(float(x) for x in breaks if start < x < stop)})
    edges = np.array(inside)
    previous = np.nan
    while edges.size <= MOST_PARTS + len(inside):
        mean, size = _gauss(function, edges, stop - start)
        if abs(mean - previous) <= CONVERGED * size:
            return mean
        previous = mean
        edges = np.sort(np.concatenate((edges, (edges[1:] + edges[:-1]) / 2)))
    raise ValueError("the quadrature does not settle")


def _gauss(function: Callable[[Floats], Floats], edges: Floats, span: float) -> tuple[float, float]:
    """Means of f and |f| over all parts, from one call of the function at all nodes in order."""
    nodes, factors = np.polynomial.legendre.leggauss(ORDER)
    half = np.diff(edges)[:, None] / 2
    x = edges[:-1, None] + half * (nodes + 1)
    values = np.asarray(function(x.ravel()), dtype=np.float64).reshape(x.shape)
    parts = half * factors
    return float(np.sum(parts * values) / span), float(np.sum(parts * np.abs(values)) / span)
