"""What a topic adds to the drawing sheets of a machine."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from reportgen.base.topics import HookModule
from reportgen.sheets.drawn import Drawn, Sources

Draw = Callable[[Sources], Iterator[Drawn]]
"""Draws the plates of one sort."""


@dataclass(frozen=True)
class PlateHooks:
    """The plates of a topic: among those of the forces, and in a set of its own that is called like the topic."""

    before_bodies: tuple[Draw, ...] = ()
    """Stand in the set of forces before the separated links."""
    after_bodies: tuple[Draw, ...] = ()
    """Stand in the set of forces behind the separated links."""
    curves: tuple[Draw, ...] = ()
    """Stand in the set of forces behind the curves."""
    own_set: tuple[Draw, ...] = ()
    further: frozenset[Draw] = frozenset()
    """Those that are shown only where every plate is asked for."""


PLATES = HookModule("plates", PlateHooks)
