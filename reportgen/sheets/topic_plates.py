"""Additions of a topic to the drawing sheets of a machine."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from reportgen.base.records import Record
from reportgen.base.topics import HookModule
from reportgen.sheets.plate_sources import Drawn, Sources

DrawPlates = Callable[[Sources], Iterator[Drawn]]
"""Draws the plates of one sort."""


class PlateHooks(Record):
    """Plates of a topic: among those of the forces, and in a separate set with the topic's name."""

    before_bodies: tuple[DrawPlates, ...] = ()
    """Plates in the set of forces before the separated links."""
    after_bodies: tuple[DrawPlates, ...] = ()
    """Plates in the set of forces after the separated links."""
    curves: tuple[DrawPlates, ...] = ()
    """Plates in the set of forces after the curves."""
    own_set: tuple[DrawPlates, ...] = ()
    further: frozenset[DrawPlates] = frozenset()
    """Plates that appear only if every plate is requested."""


PLATES = HookModule("plates", PlateHooks)
