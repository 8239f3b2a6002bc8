"""The kind `synthesis`: a crank-rocker or slider-crank from its extreme positions, and the checks of its data."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from reportgen.assignment.checks import of_parameters, one_of
from reportgen.base.errors import Finding
from reportgen.structure import synthesis_file
from reportgen.structure.synthesis_file import CRANK_ROCKER, OF_TASK, REQUIRED, SLIDER_CRANK

if TYPE_CHECKING:
    from reportgen.assignment import Assignment
    from reportgen.structure.synthesis_case import SynthesisCase

Parameters = synthesis_file.Parameters
TURNS = 1
PART = "synthesis"
"""Prefix of its ids, in a coursework too."""
HAS_POSITIONS = False
TOP = ("parameters",)
SYMBOLS: Mapping[str, Mapping[str, str]] = {
    CRANK_ROCKER: {"crank": "a", "coupler": "b", "rocker": "c", "frame": "d"},
    SLIDER_CRANK: {"crank": "r", "coupler": "l", "offset": "e"},
}
"""Symbols of the lengths that `solve` prints, by their names in the results."""


def case(assignment: Assignment) -> SynthesisCase:
    """Return the case of an assignment."""
    from reportgen.structure.synthesis_case import SynthesisCase

    return SynthesisCase(assignment)


def table_rows(position: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Return the rows of results that `solve` prints: the circle, lengths (m) and angles (°) of each solution."""
    circle, solutions = position["circle"], position["solutions"]
    task = CRANK_ROCKER if "rocker" in next(iter(solutions.values())) else SLIDER_CRANK
    rows = {"circle": {"θ": math.degrees(circle["theta"]), "ρ": circle["radius"]}}
    for number, solution in solutions.items():
        lengths = {symbol: solution[name] for name, symbol in SYMBOLS[task].items()}
        rows[f"solution{number}"] = lengths | {"γ_min": math.degrees(solution["transmission"])}
    return rows


# --- checks ---------------------------------------------------------------------------------------


def check(given: Parameters) -> Iterator[Finding]:
    """Yield the faults of the keys. If there are none, yield the reason why no mechanism exists."""
    yield from [*_of_keys(given)] or _of_solutions(given)


def _of_keys(given: Parameters) -> Iterator[Finding]:
    """Require the keys of the task, and no keys of another one."""
    for key in REQUIRED[given.task]:
        if getattr(given, key) is None:
            yield Finding("missing-key", (*TOP, key), {"key": key})
    for task, keys in OF_TASK.items():
        for key in keys if task != given.task else ():
            if getattr(given, key) is not None:
                yield Finding("synthesis-other-task", (*TOP, key), {"key": key, "task": given.task}, at="key")


def _of_solutions(given: Parameters) -> Iterator[Finding]:
    """Require a solution; else name the lengths with which there is one, or the ratio that no mechanism has."""
    from reportgen.structure.synthesis_solution import places, wanted

    if places(given):
        return
    task = wanted(given)
    selecting = next((key for key in ("a", "d", "e", "best") if getattr(given, key) is not None), None)
    extent = task.cranks() if selecting == "a" else task.frames()
    if extent is None:
        # Only of a slider-crank: before the chord of a rocker, near C₂, some place of A always works.
        yield Finding("synthesis-ratio", (*TOP, "K"), {"text": given.K.text})
        return
    if selecting is None:
        return
    if given.A is not None and places(given.model_copy(update={"A": None})):
        yield Finding("synthesis-side", (*TOP, "A"), {"A": given.A})
    else:
        # 0 is added because rounding may leave −0.
        low, high = (f"{round(end * 1e3, 4) + 0:.5g} mm" for end in extent)
        about = {"key": selecting, "text": getattr(given, selecting).text, "low": low, "high": high}
        if given.task == CRANK_ROCKER:
            about["hint"] = "synthesis-in-line"
        yield Finding("synthesis-none", (*TOP, selecting), about)


CHECKS = (
    one_of("parameters", "a", "d", "best", form=("task", CRANK_ROCKER)),
    one_of("parameters", "e", "best", form=("task", SLIDER_CRANK)),
    of_parameters(check),
)


# --- warnings -------------------------------------------------------------------------------------


def _poor(assignment: Assignment) -> Iterator[Finding]:
    """Warn about a least transmission angle below the permitted one, with the greatest on the required side."""
    from reportgen.structure.synthesis_case import SynthesisCase

    case = SynthesisCase(assignment)
    if case.is_poor:
        angle, best = (f"{math.degrees(case.transmission_of(one)):.4g}" for one in (case.chosen, case.best_place))
        about = {"angle": angle, "best": best}
        if case.given.best is not None:
            about["hint"] = "synthesis-ratio"
        yield Finding("synthesis-poor" if case.given.A is None else "synthesis-poor-side", (*TOP, "gamma"), about)


WARNINGS = (_poor,)
