"""Balancing on the drawing sheets: a set of its own."""

from __future__ import annotations

from collections.abc import Iterator

from reportgen.balancing import views as balancing
from reportgen.balancing.balance import balanced_in
from reportgen.sheets.drawn import Drawn, Sources, table_of
from reportgen.sheets.topic_plates import PlateHooks


def _balancing(sources: Sources) -> Iterator[Drawn]:
    """The hodographs of the force on the frame, and what the crank sees of it."""
    small = sources.small
    turn = balanced_in(small.analysis)
    yield Drawn("hodograph", "curves", balancing.hodograph(small).scenes)
    if turn.products:
        yield Drawn("seen", "curves", balancing.seen_curve(small).scenes)
    if turn.weights:
        yield Drawn("counterweights", "scheme", balancing.discs(small).scenes)
    if turn.products and turn.weights:
        yield Drawn("balanced", "curves", balancing.balanced_hodograph(small).scenes)


def _balancing_table(sources: Sources) -> Iterator[Drawn]:
    yield from table_of(sources, "balancing", (balancing.shaking_lines, balancing.balanced_table), cycle=True)


HOOKS = PlateHooks(own_set=(_balancing, _balancing_table))
