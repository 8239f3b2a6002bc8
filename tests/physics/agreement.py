"""An analysis beside the independent answer of `newton_euler`, quantity by quantity."""

from __future__ import annotations

from collections.abc import Sequence

import newton_euler as ne

from reportgen.analysis import Analysis

Pairs = dict[str, list[tuple[complex, complex]]]
"""Ours and theirs, by kind of quantity."""


def collect(pairs: Pairs, analysis: Analysis, keys: Sequence[str], answer: ne.Answer, k: int) -> None:
    """Add velocities, accelerations, reactions and both balances at position index k."""
    motion = analysis.motion
    for link in analysis.machine.linkage.links:
        pairs.setdefault("v", []).append((motion.origins[link].v[k], answer.velocity[link][0]))
        pairs.setdefault("a", []).append((motion.origins[link].a[k], answer.acceleration[link][0]))
        pairs.setdefault("ω", []).append((motion.links[link].omega[k], answer.velocity[link][1]))
        pairs.setdefault("ε", []).append((motion.links[link].epsilon[k], answer.acceleration[link][1]))
    for key, (force, _) in zip(keys, answer.wrenches, strict=True):
        pairs.setdefault("R", []).append((analysis.forces.reactions[key].force[k], force))
    for balance in (analysis.torque, analysis.torque_by_work):
        pairs.setdefault("balance", []).append((balance[k], answer.effort))


def agree(pairs: Pairs, agreement: float) -> None:
    """Assert that each kind agrees, relative to its own greatest value."""
    for name, found in pairs.items():
        greatest = max(abs(theirs) for _, theirs in found)
        assert max(abs(ours - theirs) for ours, theirs in found) <= agreement * greatest, name
