"""The tilting of wide sliders and the reactions at both ends, in the results of a machine."""

from __future__ import annotations

from typing import Any

from reportgen.case.topic_results import ResultHooks
from reportgen.faces.ends import at_ends, faces_of
from reportgen.machine.analysis import Analysis


def at_position(analysis: Analysis, k: int, entry: dict[str, Any]) -> None:
    """Add to each reaction in a guide whether the slider tilts, and the reactions (N) at both ends if it does."""
    for link in faces_of(analysis.machine):
        name, tilts, first, last = at_ends(analysis, link)
        entry["reactions_in_guides"][name] |= {"tilts": bool(tilts[k]), "ends": [first[k], last[k]] if tilts[k] else []}


HOOKS = ResultHooks(at_position=at_position)
