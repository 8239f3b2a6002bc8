"""Find what switches on the chapters that the report of a machine lacks: `lacking`.

The switches are masses, loads and topics. No chapter is listed by hand: the machine's own outline is made again with
more switches on, and the fewest that bring a chapter are what it needs.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import combinations

from reportgen.base.errors import Where
from reportgen.base.topics import topics
from reportgen.catalogue.topic_sections import TopicParameters, in_order, section_of
from reportgen.machine.analysis import Machine

MASSES, LOADS = "masses", "loads"
MOST_SWITCHES = 2
"""Largest number of switches that a chapter needs: a topic, and something that loads the machine."""
Wanted = tuple[tuple[Where, ...], ...]
"""Groups of keys; one key of each group is needed."""


def lacking(machine: Machine, given: TopicParameters) -> Iterator[tuple[str, Wanted]]:
    """Yield the sections that the report of a machine lacks, in order, each with the keys that it needs."""
    fitting = [topic for topic in in_order(topics()) if section_of(topic).fits(machine)]
    given_now = {MASSES} if machine.linkage.inertias else set()
    given_now |= {LOADS} if machine.loads else set()
    now = frozenset(given_now | machine.topics.keys())
    off = [switch for switch in (MASSES, LOADS, *fitting) if switch not in now]
    present = _outline(machine, now)
    for section in _outline(machine, now | {*off}):
        if section not in present and (sets := _fewest(machine, now, off, section)):
            groups = tuple(_groups(sets, given))
            # A machine of the atlas may have no parameter for a mass or a load.
            if all(groups):
                yield section, groups


def _outline(machine: Machine, switches: Collection[str]) -> tuple[str, ...]:
    """Return the outline of the machine with some switches on."""
    asked = [topic for topic in topics() if topic in switches]
    acts = LOADS in switches or any(section_of(topic).acts for topic in asked)
    return machine.outlined(MASSES in switches, acts, asked) if machine.outlined else machine.outline


def _fewest(machine: Machine, now: frozenset[str], off: Sequence[str], section: str) -> list[tuple[str, ...]]:
    """Return the smallest sets of further switches that bring a section."""

    def brings(more: Sequence[str]) -> bool:
        on = now.union(more)
        massless = MASSES not in on and any(section_of(topic).of_masses for topic in more if topic in topics())
        return not massless and section in _outline(machine, on)

    for size in range(1, MOST_SWITCHES + 1):
        if sets := [more for more in combinations(off, size) if brings(more)]:
            return sets
    return []


def _groups(sets: Sequence[tuple[str, ...]], given: TopicParameters) -> Iterator[tuple[Where, ...]]:
    """Yield the keys of each switch that all sets have, then those of the switches that differ."""
    own_loads = tuple(key for key in given.load_keys if key not in given.mass_keys)
    of_masses = any(section_of(topic).of_masses for topic in sets[0] if topic in topics())
    masses = tuple(key for key in given.mass_keys if not (of_masses and key in given.moment_keys))
    keys = {MASSES: masses, LOADS: own_loads}

    def places(switches: Collection[str]) -> tuple[Where, ...]:
        return tuple(("parameters", key) for switch in switches for key in keys.get(switch, (switch,)))

    common = [switch for switch in sets[0] if all(switch in more for more in sets)]
    for switch in sorted(common, key=lambda switch: switch in keys):
        yield places((switch,))
    if rest := dict.fromkeys(switch for more in sets for switch in more if switch not in common):
        yield places(rest)
