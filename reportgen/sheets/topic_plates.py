"""What a topic adds to the drawing sheets of a machine."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from reportgen.base.topics import HookModule
from reportgen.sheets.drawn import Drawn, Sources

DrawPlates = Callable[[Sources], Iterator[Drawn]]
"""Draws the plates of one sort."""


@dataclass(frozen=True)
class PlateHooks:
    """The plates of a topic: among those of the forces, and in a set of its own that is called like the topic."""

    before_bodies: tuple[DrawPlates, ...] = ()
    """Stand in the set of forces before the separated links."""
    after_bodies: tuple[DrawPlates, ...] = ()
    """Stand in the set of forces behind the separated links."""
    curves: tuple[DrawPlates, ...] = ()
    """Stand in the set of forces behind the curves."""
    own_set: tuple[DrawPlates, ...] = ()
    further: frozenset[DrawPlates] = frozenset()
    """Those that are shown only where every plate is asked for."""


PLATES = HookModule("plates", PlateHooks)
