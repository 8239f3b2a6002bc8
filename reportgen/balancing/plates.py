"""The drawing sheets of balancing, a separate set: `HOOKS` registers their plates, and no other module calls them."""

from __future__ import annotations

from collections.abc import Iterator

from reportgen.balancing import views
from reportgen.balancing.shaking_force import balanced_in
from reportgen.sheets.plate_sources import Drawn, Sources, table_of
from reportgen.sheets.topic_plates import PlateHooks


def _balancing(sources: Sources) -> Iterator[Drawn]:
    """Yield the hodograph of the force on the frame, and the figures of the requested counterweights.

    With a rule for the crank, its curve as seen from the crank follows; with counterweights that are not zero, their
    scheme; with both, the hodograph without and with the counterweight.
    """
    small = sources.small
    turn = balanced_in(small.analysis)
    yield Drawn("hodograph", "curves", views.hodograph(small).scenes)
    if turn.products:
        yield Drawn("seen", "curves", views.seen_curve(small).scenes)
    if turn.weights:
        yield Drawn("counterweights", "scheme", views.discs(small).scenes)
    if turn.products and turn.weights:
        yield Drawn("balanced", "curves", views.balanced_hodograph(small).scenes)


def _balancing_table(sources: Sources) -> Iterator[Drawn]:
    """Yield the table of the force on the frame at each position, with the values that counterweights change."""
    yield from table_of(sources, "balancing", (views.shaking_lines, views.balanced_table), cycle=True)


HOOKS = PlateHooks(own_set=(_balancing, _balancing_table))
