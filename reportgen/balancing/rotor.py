"""The kind `rotor`, the checks of its data and warnings about unlikely data."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from reportgen.assignment.checks import of_parameters, one_of
from reportgen.balancing import rotor_file
from reportgen.balancing.rotor_file import LEFT, RIGHT
from reportgen.balancing.rotor_unknowns import unknown_masses, unknown_plane
from reportgen.base.errors import Finding
from reportgen.base.units import Given

if TYPE_CHECKING:
    from reportgen.assignment import Assignment
    from reportgen.balancing.rotor_case import RotorCase

Parameters = rotor_file.Parameters
TURNS = 1
PART = "rotor"
"""Prefix of its ids, in a coursework too."""
HAS_POSITIONS = False
TOP = ("parameters",)
NEEDS: Mapping[str, tuple[str, ...]] = {"bearings": ("n",), "grade": ("mass", "n", "bearings")}
"""Other keys that a key requires."""
BALANCED = 1e-9
"""An unbalance below this share of the sum of all is zero."""


def case(assignment: Assignment) -> RotorCase:
    """Return the case of an assignment."""
    from reportgen.balancing.rotor_case import RotorCase

    return RotorCase(assignment)


def table_rows(position: Mapping[str, Any]) -> dict[str, dict[str, float | None]]:
    """Return the rows of results that `solve` prints: corrections (kg·mm, °, kg, mm) and forces on bearings (N)."""
    corrections: dict[str, float | None] = {}
    radii: dict[str, float | None] = {}
    places: dict[str, float | None] = {}
    for plane, entry in position["corrections"].items():
        corrections[f"U_{plane}"] = entry["unbalance"] * 1e3
        corrections[f"α_{plane}"] = None if entry["angle"] is None else entry["angle"] * 180 / math.pi
        if "mass" in entry:
            corrections[f"m_{plane}"], radii[f"r_{plane}"] = entry["mass"], entry["radius"] * 1e3
        if "place" in entry:
            places[f"z_{plane}"] = entry["place"] * 1e3
    rows = {"corrections": corrections, "radii": radii, "places": places}
    if "masses" in position:
        rows["masses"] = {f"m_{place}": mass for place, mass in position["masses"].items()}
    if "bearings" in position:
        rows["bearings"] = {
            f"N{'′' if when == 'after' else ''}_{place}": math.hypot(*force)
            for place, forces in position["bearings"].items()
            for when, force in forces.items()
        }
    return rows


# --- checks ---------------------------------------------------------------------------------------


def check(given: Parameters) -> Iterator[Finding]:
    """Yield faults unless planes and bearings go from left to right, required keys exist, and there is something to
    balance.
    """
    planes, bearings = given.planes, given.bearings
    if planes.B is not None and not given.finds_plane and planes.B.si <= planes.A.si:
        yield Finding("rotor-places", (*TOP, "planes", "B"), {"left": planes.A.text, "right": planes.B.text})
    if bearings is not None and bearings[1].si <= bearings[0].si:
        places = {"left": bearings[0].text, "right": bearings[1].text}
        yield Finding("rotor-places", (*TOP, "bearings", 1), places)
    for key, others in NEEDS.items():
        for further in others if getattr(given, key) is not None else ():
            if getattr(given, further) is None:
                yield Finding("needs-besides", (*TOP, key), {"key": key, "other": further}, at="key")
    if given.mass is not None and given.grade is None:
        yield Finding("needs-besides", (*TOP, "mass"), {"key": "mass", "other": "grade"}, at="key")
    own = [plane for plane in (LEFT, RIGHT) if given.correction and getattr(given.correction, plane)]
    if own and own != [*given.planes_by_name]:
        yield Finding("rotor-corrections", (*TOP, "correction"), {"planes": ", ".join(given.planes_by_name)}, at="key")
    yield from check_unknowns(given)
    if given.sought_masses:
        return
    if is_balanced(given):
        yield Finding("rotor-balanced", (*TOP, "masses"), at="key")
    elif planes.B is not None and not any(mass.z.si - planes.A.si for mass in given.masses):
        yield Finding("rotor-one-plane", (*TOP, "planes", "B"), at="key")


def check_unknowns(given: Parameters) -> Iterator[Finding]:
    """Yield faults unless the place of plane B, or two masses, can be found, and correct with positive masses."""
    angle, where = given.known_angle, (*TOP, "correction", LEFT, "angle")
    if given.sought_masses:
        yield from check_sought_masses(given)
    if not given.finds_plane:
        if angle is not None:
            yield Finding("rotor-angle-known", where, at="key")
    elif angle is None:
        yield Finding("needs-besides", (*TOP, "planes", "B"), {"key": "B: find", "other": "correction.A.angle"})
    elif not given.sought_masses:
        solution = unknown_plane(given)
        if solution is None:
            yield Finding("rotor-no-plane", where)
        elif solution.near == 0:
            yield Finding("rotor-one-suffices", where, {"at": f"{(given.planes.A.si + solution.distance) * 1e3:.4g}"})
        elif solution.near < 0:
            yield Finding("rotor-other-side", where, turned(angle))


def check_sought_masses(given: Parameters) -> Iterator[Finding]:
    """Yield faults unless exactly two masses outside plane A are sought, and A is the only plane."""
    sought = given.sought_masses
    first = int(next(iter(sought))) - 1
    in_plane = any(mass.z.si == given.planes.A.si for mass in sought.values())
    if len(sought) != 2 or in_plane or given.planes.B is not None or given.bearings is not None:
        yield Finding("rotor-sought", (*TOP, "masses", first, "m"))
        return
    unbalances = unknown_masses(given)
    if unbalances is None or not all(unbalances.values()):
        code = "rotor-sought-parallel" if unbalances is None else "rotor-sought-none"
        yield Finding(code, (*TOP, "masses", int(list(sought)[1]) - 1, "angle"))
        return
    for place, U in unbalances.items():
        if U < 0:
            yield Finding("rotor-other-side", (*TOP, "masses", int(place) - 1, "angle"), turned(sought[place].angle))


def turned(angle: Given) -> dict[str, str]:
    """Return the text of the opposite angle, from 0° to 360°."""
    return {"angle": f"{round(math.degrees(angle.si) + 180, 6) % 360:g} deg"}


def is_balanced(given: Parameters) -> bool:
    """Return True if the masses need no correction: neither force nor couple, which a single plane cannot correct."""
    unbalances = [(one.m.si * cmath.rect(one.r.si, one.angle.si), one.z.si - given.planes.A.si) for one in given.masses]
    force, couple = sum(U for U, _ in unbalances), sum(U * z for U, z in unbalances)
    if abs(force) > BALANCED * sum(abs(U) for U, _ in unbalances):
        return False
    return abs(couple) <= BALANCED * sum(abs(U * z) for U, z in unbalances)


CHECKS = (
    of_parameters(check),
    one_of("parameters.correction", "r", "m", LEFT),
    *(one_of(f"parameters.correction.{plane}", "r", "m") for plane in (LEFT, RIGHT)),
)
