"""Tolerance bands: how far a value may be off if it was measured on a drawing or computed with three figures.

`drawn_bands` and `computed_bands` return them. Bands are errors of drawing and of rounding, propagated through the
ledger. Each error is a small change of one quantity. The ledger evaluates all errors at once, [errors, positions], and
returns how far each later quantity moves. An error spread evenly over ±e has the standard deviation e/√3. Independent
errors add by their squares, and the band covers three standard deviations of their sum. A quantity's own error is added
in full, because nothing averages it out:

band = e_own + 3 √(Σᵢ (∂f/∂xᵢ eᵢ/√3)²)
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reportgen.base.topics import topics
from reportgen.formula import Call, Ref, ids, refs, vocabulary
from reportgen.formula.calculation import DUST, ZERO, Family
from reportgen.formula.ledger import Ledger
from reportgen.marking.topic_marking import MARKS

PAPER_ERROR = 0.5e-3
"""Largest error (m on paper) of a drawn point, at each end of a measured length."""

DIGITS = 3
"""Number of significant figures that a value is computed with."""

WHOLE_DEGREE = np.pi / 180

REACH = 3 / np.sqrt(3)
"""Three standard deviations of an error that is spread evenly over ±1."""

ON_DRAWING = frozenset({"abs", "re", "im"})
"""Functions that define a length on the drawing of the mechanism: the size or a component of a vector."""

DIAGRAM = 0.1
"""Height (m on paper) at which an indicator diagram is plotted."""

SMALL = 0.05
"""Largest error of a pressure read from such a diagram, as a share of the pressure."""

SHARE = 1e-4
"""Share of an error that is used as the step when its slope is computed."""


def drawn_bands(
    ledger: Ledger, error: float = PAPER_ERROR, scales: Mapping[str, np.ndarray] | None = None
) -> dict[str, np.ndarray]:
    """Return the half widths (SI) [N] of the bands if each end of every length on paper is off by `error` (m).

    `scales` gives, by id, the scales of plans drawn larger or smaller than in the report, as multiples of the report's
    scales: a larger drawing is read more finely. Values read or computed from the drawing are also rounded to a limited
    number of figures.
    """
    bands = _carried_through(ledger, measuring_errors(ledger, error, scales))
    for id, band in bands.items():
        # A direction is written in whole degrees.
        last = WHOLE_DEGREE / 2 if is_direction(id) else half_unit(ledger[id].values, DIGITS)
        greatest = np.nanmax(np.abs(ledger[id].values), initial=0.0)
        bands[id] = band + np.where(band > ZERO * greatest, last, 0.0)
    return bands


def computed_bands(ledger: Ledger, digits: int = DIGITS) -> dict[str, np.ndarray]:
    """Return the half widths (SI) [N] of the bands if every value that is not given is rounded to `digits` figures.

    Values that depend on integrals over the cycle are computed by the trapezoid rule.
    """
    errors = {
        id: half_unit(family.values, digits)
        for id, family in ledger.families.items()
        if not (family.hidden or family.is_plane or family.exact or family.definition is None)
    }
    bands = _carried_through(ledger, errors)
    return bands | {id: bands[id] + error for id, error in trapezoid_errors(ledger).items()}


def measuring_errors(
    ledger: Ledger, error: float = PAPER_ERROR, scales: Mapping[str, np.ndarray] | None = None
) -> dict[str, np.ndarray]:
    """Return the own errors (SI) [N] of measured quantities by id.

    `error` (m) is that of each end of a length on paper, `scales` are as in `drawn_bands`. A length has the error of
    its two ends, 2 e; a direction has 2 e divided by its length, at most π. Other angles are measured between lines as
    long as the drawn crank.
    """
    errors: dict[str, np.ndarray] = {}
    drawn_at = scales or {}
    lengths = (float(one.values[0]) for one in ledger.families.values() if is_chosen_length(ledger, one))
    crank = min(lengths, default=np.inf)
    for id, family in ledger.families.items():
        if family.hidden or family.is_plane or not (family.constructed or _may_be_measured(family)):
            continue
        if family.kind == "segment":
            errors[id] = np.full(len(family.values), 2 * error * drawn_at.get(vocabulary.plan(id), 1.0))
        elif is_direction(id):
            if not _is_drawn(family):
                continue
            side = _on_paper(ledger, id)
            length = np.abs(side.values) / drawn_at.get(vocabulary.plan(side.id), 1.0)
            with np.errstate(all="ignore"):
                errors[id] = np.minimum(np.where(length > 0, 2 * error / length, np.pi), np.pi)
        elif family.kind == "angle":
            errors[id] = np.full(len(family.values), 2 * error * drawn_at.get("mu.l", 1.0) / crank)
        elif family.kind == "length" and isinstance(family.definition, Call) and family.definition.name in ON_DRAWING:
            # Measured on the drawing of the mechanism, for example a slider's displacement or a coordinate.
            scale = ledger["mu.l"].values * drawn_at.get("mu.l", 1.0)
            errors[id] = np.full(len(family.values), 2 * error * scale)
    for link, slope in _pressure_slopes(ledger).items():
        pressure = np.abs(ledger[ids.pressure(link)].values)
        # The student reads this from a diagram that he has plotted; small values are in the table.
        height = np.minimum(error / DIAGRAM * np.nanmax(pressure), SMALL * pressure)
        errors[ids.pressure(link)] = slope * 2 * error * ledger["mu.l"].values * drawn_at.get("mu.l", 1.0) + height
    return errors


def plans_read(ledger: Ledger) -> dict[str, frozenset[str]]:
    """Return, for each quantity, the ids of the scales of the plans and of the drawing that it is read from.

    A quantity is read from a plan if it is measured there or depends on a measured one.
    """
    measured = measuring_errors(ledger)
    read: dict[str, list[str]] = {}
    for size, vector in ledger.vectors.items():
        read.setdefault(vector, []).append(size)
    scales_of: dict[str, frozenset[str]] = {}
    for id in ledger.families:
        before = [size for name in ledger.inputs[id] for size in (name, *read.get(name, ())) if size in scales_of]
        own = {_measured_on(ledger, id)} if id in measured else set()
        scales_of[id] = frozenset(own).union(*(scales_of[name] for name in before))
    return scales_of


def _measured_on(ledger: Ledger, id: str) -> str:
    """Return the scale of the plan that a quantity is measured on, or that of the drawing if it is on no plan."""
    if is_direction(id):
        id = _on_paper(ledger, id).id
    return vocabulary.plan(id) or "mu.l"


def _may_be_measured(family: Family) -> bool:
    """Return True if a length from a plan's pole, computed by similarity, can also be measured on the plan."""
    plan, lengths = vocabulary.plan(family.id), ids.segment.read(family.id)
    from_pole = lengths is not None and lengths["start"] == ids.POLE
    return bool(from_pole and family.definition and any(vocabulary.plan(id) == plan for id in refs(family.definition)))


def _pressure_slopes(ledger: Ledger) -> dict[str, np.ndarray]:
    """Return the slope of the pressure over each piston's displacement [N], from the flatter side of a position."""
    slopes: dict[str, np.ndarray] = {}
    for id, family in ledger.families.items():
        names = ids.pressure.read(id)
        if names and (displacement := ids.displacement(link := names["link"])) in ledger:
            displacements = ledger[displacement].values
            with np.errstate(all="ignore"):
                sides = [
                    np.abs((np.roll(family.values, k) - family.values) / (np.roll(displacements, k) - displacements))
                    for k in (1, -1)
                ]
            slopes[link] = np.nan_to_num(np.min(np.where(np.isfinite(sides), sides, np.inf), axis=0), posinf=0.0)
    return slopes


def is_direction(id: str) -> bool:
    """Return True if a quantity is the direction of a vector."""
    return vocabulary.row(id).around


def is_chosen_length(ledger: Ledger, family: Family) -> bool:
    """Return True if a length on paper was chosen, like the drawn crank: either itself or by a round scale."""
    if family.kind != "segment":
        return False
    return family.definition is None or any(is_round_scale(ledger[id]) for id in refs(family.definition))


def is_round_scale(family: Family) -> bool:
    """Return True for a scale that the crank is drawn to; the scale of the drawing, `mu.l`, repeats it."""
    return family.kind == "length scale" and family.id != "mu.l"


def half_unit(values: np.ndarray, digits: int) -> np.ndarray:
    """Return half a unit of the last of `digits` significant figures of values [N], in their own unit; 0 for 0."""
    sizes = np.abs(values)
    with np.errstate(all="ignore"):
        unit = 10.0 ** (np.floor(np.log10(sizes) + DUST) - digits + 1)
    return np.where(np.isfinite(unit) & (sizes > 0), unit / 2, 0.0)


def _or_nothing(values: np.ndarray) -> np.ndarray:
    """Return the values with NaN replaced by 0. numpy's own `nan_to_num` takes several times as long."""
    return np.where(np.isnan(values), 0.0, values)


def _carried_through(ledger: Ledger, errors: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the half widths (SI) [N] of every printed quantity, from the own errors of some quantities."""
    rows = {id: row for row, id in enumerate(errors)}
    visible = [id for id, family in ledger.families.items() if not (family.hidden or family.is_plane)]
    if not rows:
        return {id: np.zeros(len(ledger[id].values)) for id in visible}

    def moved(id: str) -> object:
        def move(value: np.ndarray, _: Mapping[str, np.ndarray]) -> np.ndarray:
            step = np.zeros((len(rows), errors[id].shape[-1]))
            step[rows[id]] = SHARE * _or_nothing(errors[id])
            return value + step

        return move

    values = ledger.evaluate({id: moved(id) for id in errors})
    bands: dict[str, np.ndarray] = {}
    for id in visible:
        family = ledger[id]
        change = np.atleast_2d(values[id] - family.values)
        if family.how.unit == "°":
            change = np.mod(change + np.pi, 2 * np.pi) - np.pi
        own = _or_nothing(np.broadcast_to(errors.get(id, 0.0), family.values.shape))
        if id in rows:
            change[rows[id]] = 0.0
        inherited = REACH * np.sqrt((_or_nothing(change) ** 2).sum(axis=0)) / SHARE
        # A single value depends on the errors at all positions.
        band = own + (inherited.max(keepdims=True) if len(own) == 1 else inherited)
        band = np.where(band > ZERO * family.scale, band, 0.0)
        # Near a dead centre, a very short vector may have any direction.
        bands[id] = np.minimum(band, np.pi) if family.how.unit == "°" else band
    return bands


def _is_drawn(direction: Family) -> bool:
    """Return True if a direction is that of a vector on paper, False if it is computed from components."""
    return isinstance(direction.definition, Call) and isinstance(direction.definition.arguments[0], Ref)


def _on_paper(ledger: Ledger, id: str) -> Family:
    """Return the drawn length (m) of the vector whose direction `dir.…` is measured, or the vector itself on paper."""
    definition = ledger[id].definition
    assert isinstance(definition, Call), f"{id} is no direction of a vector"
    (vector,) = definition.arguments
    assert isinstance(vector, Ref), f"{id} is no direction of a vector"
    # On a force plan, find the side drawn for the force; on other plans, the vector itself is on paper.
    measured = Call("abs", (vector,))
    sides = (family for family in ledger.families.values() if family.kind == "segment")
    return next((side for side in sides if side.of == vector.id or side.definition == measured), ledger[vector.id])


# --- integrals as they are worked out on paper -----------------------------------------------------
# Integrals over the cycle by the trapezoid rule, from the positions alone.
# The report integrates continuously. A student with about ten positions cannot, so the difference is part of the
# tolerance. If it is large, the quantity cannot be computed from the positions and is not asked for.

LARGE = 0.1
"""Largest error of the rule, as a share of a quantity's largest value."""


def trapezoid_errors(ledger: Ledger) -> Mapping[str, np.ndarray]:
    """Return, by id, how far values (SI) [N] found from the positions alone are from those of the ledger.

    Each topic computes these errors for its own quantities.
    """
    return {id: error for hooks in MARKS.among(topics()) for id, error in hooks.errors_of_positions(ledger).items()}


def is_workable(ledger: Ledger, id: str, errors: Mapping[str, np.ndarray]) -> bool:
    """Return True if a quantity can be computed from the positions alone.

    `errors` (SI) [N] are the resulting errors.
    """
    for hooks in MARKS.among(topics()):
        id = hooks.integral_of(ledger, id)
    return id not in errors or bool(np.nanmax(errors[id]) <= LARGE * np.nanmax(np.abs(ledger[id].values)))
