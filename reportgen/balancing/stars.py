"""Drawing of the star of an order of an engine: a vector of equal length for each cylinder, and their sum, to scale."""

from __future__ import annotations

from collections.abc import Sequence

from reportgen.drawing import Arrow, Circle, Content, Item, Line, Scene, style
from reportgen.drawing.canvas import Canvas, finish
from reportgen.drawing.drawing_description import arrow, fact, pointing
from reportgen.drawing.geometry import clusters
from reportgen.drawing.labels import Request, joined, label

RAY = 14.0
"""Length of a cylinder's vector (mm)."""
SAME = 0.4
"""Vector ends closer than this (mm) are drawn as one."""
CLOSED = 1e-9
"""A sum below this share of a vector is zero."""
BEYOND = 3.0
"""Length of the axes beyond the circle (mm)."""


def star(vectors: Sequence[complex], names: Sequence[Content], total: Content, title: str = "") -> Scene:
    """Draw dimensionless unit vectors (x + iy) from one pole with their labels, and their sum, labelled `total`."""
    reach = RAY + BEYOND
    items: list[Item] = [Line(-reach + 0j, reach + 0j, style.AXIS), Line(-1j * reach, 1j * reach, style.AXIS)]
    items.append(Circle(0j, RAY, style.THIN))
    items += [Arrow(0j, RAY * vector, style.ACTIVE) for vector in vectors]
    ends = [(RAY * vector, name) for vector, name in zip(vectors, names, strict=True)]
    requests: list[Request] = [
        label(group[0][0], *joined(name for _, name in group), size=style.SMALL)
        for group in clusters(ends, SAME, lambda end: end[0])
    ]
    whole = sum(vectors)
    facts = [pointing(name, vector) for name, vector in zip(names, vectors, strict=True)]
    facts.append(arrow(total, RAY * whole) if abs(whole) > CLOSED else fact("closed", total))
    if abs(whole) > CLOSED:
        items.append(Arrow(0j, RAY * whole, style.FOUND))
        requests.append(label([RAY * whole, RAY * whole / 2], total, size=style.SMALL))
    items.append(Circle(0j, 0.6, style.KNOWN, style.PAPER))
    return finish(Canvas(tuple(items), tuple(requests), tuple(facts)), title=title, margin=2.0)
