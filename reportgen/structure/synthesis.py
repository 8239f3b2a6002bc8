"""The kind `synthesis`: a mechanism from its extreme positions, or through three points; the checks of its data."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from reportgen.assignment.checks import of_parameters, one_of
from reportgen.assignment.common import SolvedLength
from reportgen.base.errors import Finding
from reportgen.structure import synthesis_file
from reportgen.structure.synthesis_file import (
    CRANK_ROCKER,
    KEYS,
    OF_ANGLES,
    OF_FUNCTION,
    REQUIRED,
    SLIDER_CRANK,
    THREE_POINTS,
)

if TYPE_CHECKING:
    from reportgen.assignment import Assignment
    from reportgen.formula.ledger import Ledger
    from reportgen.structure.synthesis_case import SynthesisCase
    from reportgen.structure.three_point_case import ThreePointCase

Parameters = synthesis_file.Parameters
TURNS = 1
PART = "synthesis"
"""Prefix of its ids, in a coursework too."""
HAS_POSITIONS = False
TOP = ("parameters",)
SAME = 1e-12
"""Relative difference below which two values of a function are equal: sin 180° is not exactly 0 in floats."""
SYMBOLS: Mapping[str, Mapping[str, str]] = {
    CRANK_ROCKER: {"crank": "a", "coupler": "b", "rocker": "c", "frame": "d"},
    SLIDER_CRANK: {"crank": "r", "coupler": "l", "offset": "e"},
}
"""Symbols of the lengths that `solve` prints, by their names in the results."""


def case(assignment: Assignment) -> SynthesisCase | ThreePointCase:
    """Return the case of an assignment."""
    if assignment.parameters.task == THREE_POINTS:
        from reportgen.structure.three_point_case import ThreePointCase

        return ThreePointCase(assignment)
    from reportgen.structure.synthesis_case import SynthesisCase

    return SynthesisCase(assignment)


def table_rows(position: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Return the rows of results that `solve` prints: the circle, lengths (m) and angles (°) of each solution.

    Through three points there are the links, the pairs of angles, and the structural errors of a function.
    """
    if "lengths" in position:
        from reportgen.structure.three_point_case import solve_rows

        return solve_rows(position)
    circle, solutions = position["circle"], position["solutions"]
    task = CRANK_ROCKER if "rocker" in next(iter(solutions.values())) else SLIDER_CRANK
    rows = {"circle": {"θ": math.degrees(circle["theta"]), "ρ": circle["radius"]}}
    for number, solution in solutions.items():
        lengths = {symbol: solution[name] for name, symbol in SYMBOLS[task].items()}
        rows[f"solution{number}"] = lengths | {"γ_min": math.degrees(solution["transmission"])}
    return rows


def lengths(assignment: Assignment) -> Mapping[str, SolvedLength]:
    """Return the lengths of the mechanism, of several solutions the chosen one, by their letters."""
    solved = case(assignment)
    printed = solved.printed
    return {letter: SolvedLength(id, _as_printed(printed, id)) for letter, id in solved.lengths.items()}


def _as_printed(ledger: Ledger, id: str) -> str:
    """Return a length as it is printed, with its unit; one of a link that points the other way without its sign."""
    quantity = ledger.quantity(id)
    size = f"{quantity.value:.12g}" if quantity.decimals is None else f"{quantity.value:.{quantity.decimals}f}"
    return f"{size.removeprefix('-')} {ledger[id].how.unit}"


# --- checks ---------------------------------------------------------------------------------------


def check(given: Parameters) -> Iterator[Finding]:
    """Yield the faults of the keys. If there are none, yield the reason why no mechanism exists."""
    yield from [*_of_keys(given)] or (_of_points(given) if given.task == THREE_POINTS else _of_solutions(given))


def _of_keys(given: Parameters) -> Iterator[Finding]:
    """Require the keys of the task, and no keys of another one."""
    required = [*REQUIRED[given.task]]
    if given.function is not None and given.task == THREE_POINTS:
        required += [*OF_FUNCTION, *(["exponent"] if given.function == "power" else [])]
    for key in required:
        if getattr(given, key) is None:
            yield Finding("missing-key", (*TOP, key), {"key": key})
    for key in {key: None for keys in KEYS.values() for key in keys}:
        if getattr(given, key) is not None and key not in KEYS[given.task]:
            yield Finding("synthesis-other-task", (*TOP, key), {"key": key, "task": given.task}, at="key")


def _of_solutions(given: Parameters) -> Iterator[Finding]:
    """Require a solution; else name the lengths with which there is one, or the ratio that no mechanism has."""
    from reportgen.catalogue.extreme_faults import faults_without_place
    from reportgen.structure.synthesis_solution import selection, wanted

    hints = {"synthesis-none": "synthesis-in-line"} if given.task == CRANK_ROCKER else {}
    yield from faults_without_place(wanted(given), selection(given), TOP, TOP, hints)


def _of_points(given: Parameters) -> Iterator[Finding]:
    """Require three different pairs of angles that a linkage goes through without being taken apart."""
    from reportgen.structure.three_point_solution import pairs_of, value_of

    if given.pairs is None and given.function is None:
        return
    if given.pairs is None:
        ends = {"x": given.x, "driver": given.driver, "follower": given.follower}
        for key, both in ends.items():
            if both is not None and both[0].si == both[1].si:
                yield Finding("synthesis-no-range", (*TOP, key), {"key": key})
                return
        assert given.x is not None
        for number, end in enumerate(given.x):
            if bool(end.unit) != (given.function in OF_ANGLES):
                code = "unexpected-unit" if end.unit else "missing-unit"
                yield Finding(code, (*TOP, "x", number), {"text": end.text, "unit": "deg"})
                return
        first, last = sorted(given.x, key=lambda end: end.si)
        low, high, about = first.si, last.si, {"low": first.text, "high": last.text}
        values = [value_of(given, x) for x in (low, (low + high) / 2, high)]
        if _has_pole(given, low, high) or not all(map(math.isfinite, values)):
            yield Finding("synthesis-undefined", (*TOP, "x"), about)
            return
        if math.isclose(values[0], values[2], rel_tol=SAME, abs_tol=SAME * max(map(abs, values))):
            yield Finding("synthesis-equal-values", (*TOP, "x"), about)
            return
    pairs, where = pairs_of(given), "pairs" if given.pairs is not None else "driver"
    if pairs.lengths is None:
        yield Finding("synthesis-no-linkage", (*TOP, where))
    elif pairs.side is None:
        yield Finding("synthesis-branch", (*TOP, where))
    elif given.driver is not None and not pairs.moves_between(given.driver[0].si, given.driver[1].si):
        yield Finding("synthesis-short-range", (*TOP, "driver"))


def _has_pole(given: Parameters, low: float, high: float) -> bool:
    """Return True if the function is infinite somewhere in a range of x (rad for an angle)."""
    if given.function == "tan":
        # The poles are odd multiples of 90°; between two of them the count of half turns is the same.
        return math.floor(low / math.pi + 0.5) != math.floor(high / math.pi + 0.5)
    return given.exponent is not None and given.exponent < 0 and low <= 0 <= high


CHECKS = (
    one_of("parameters", "a", "d", "best", form=("task", CRANK_ROCKER)),
    one_of("parameters", "e", "best", form=("task", SLIDER_CRANK)),
    one_of("parameters", "function", "pairs", form=("task", THREE_POINTS)),
    of_parameters(check),
)


# --- warnings -------------------------------------------------------------------------------------


def _poor(assignment: Assignment) -> Iterator[Finding]:
    """Warn about a least transmission angle below the permitted one, with the greatest on the required side."""
    if assignment.parameters.task == THREE_POINTS:
        return
    from reportgen.structure.synthesis_case import SynthesisCase

    case = SynthesisCase(assignment)
    if case.is_poor:
        angle, best = (f"{math.degrees(case.transmission_of(one)):.4g}" for one in (case.chosen, case.best_place))
        about = {"angle": angle, "best": best}
        if case.given.best is not None:
            about["hint"] = "synthesis-ratio"
        yield Finding("synthesis-poor" if case.given.A is None else "synthesis-poor-side", (*TOP, "gamma"), about)


WARNINGS = (_poor,)
