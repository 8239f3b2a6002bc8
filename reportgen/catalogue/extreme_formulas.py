"""Formulas of a synthesis from extreme positions, as a report writes them out.

They are the constructions of `extreme_positions` with quantities in place of numbers: θ is the angle under which A sees
both extreme places C₁, C₂ of the driven pin, ρ the radius of the circle of A, y the height of its centre O above D, β
the angle at O from the middle of the arc to A.
"""

from __future__ import annotations

from reportgen.catalogue.extreme_positions import BEYOND
from reportgen.formula import Expression, Number, acos, asin, cos, sin, sqrt

STRAIGHT = Number(180.0, None, "°")


def angle_of_sight(K: Expression) -> Expression:
    """Return θ = 180° (K − 1)/(K + 1)."""
    return STRAIGHT * (K - 1) / (K + 1)


def radius_by_swing(rocker: Expression, ψ: Expression, θ: Expression) -> Expression:
    """Return ρ for a rocker that swings through ψ."""
    return rocker * sin(ψ / 2) / sin(θ)


def radius_by_stroke(H: Expression, θ: Expression) -> Expression:
    """Return ρ for a slider with the stroke H."""
    return H / (2 * sin(θ))


def height_of_centre(rocker: Expression, ψ: Expression, ρ: Expression, θ: Expression, side: int) -> Expression:
    """Return y, for A on a side of the chord (`BEYOND` or `BEFORE`)."""
    to_centre = ρ * cos(θ)
    return rocker * cos(ψ / 2) + (to_centre if side == BEYOND else -to_centre)


def place_by_frame(frame: Expression, y: Expression, ρ: Expression, side: int) -> Expression:
    """Return β of A at the distance `frame` from D, by the law of cosines."""
    squares = frame**2 - y**2 - ρ**2 if side == BEYOND else y**2 + ρ**2 - frame**2
    return acos(squares / (2 * y * ρ))


def place_by_crank(crank: Expression, ρ: Expression, θ: Expression) -> Expression:
    """Return β of A for a length of the crank."""
    return 2 * asin(crank / (2 * ρ * sin(θ / 2)))


def place_by_offset(e: Expression, ρ: Expression, θ: Expression) -> Expression:
    """Return β of A at the distance e from the guide."""
    return acos(e / ρ - cos(θ))


def far_distance(ρ: Expression, β: Expression, θ: Expression) -> Expression:
    """Return AC₁, where crank and coupler are stretched."""
    return 2 * ρ * cos((β - θ) / 2)


def near_distance(ρ: Expression, β: Expression, θ: Expression) -> Expression:
    """Return AC₂, where crank and coupler are folded."""
    return 2 * ρ * cos((β + θ) / 2)


def crank_between(far: Expression, near: Expression) -> Expression:
    """Return the crank: half the difference of AC₁ and AC₂."""
    return (far - near) / 2


def coupler_between(far: Expression, near: Expression) -> Expression:
    """Return the coupler: half the sum of AC₁ and AC₂."""
    return (far + near) / 2


def frame_at(y: Expression, ρ: Expression, β: Expression, side: int) -> Expression:
    """Return the distance of A from D."""
    product = 2 * y * ρ * cos(β)
    return sqrt(y**2 + ρ**2 + (product if side == BEYOND else -product))


def offset_at(ρ: Expression, β: Expression, θ: Expression) -> Expression:
    """Return the distance of A from the guide."""
    return ρ * (cos(β) + cos(θ))


def angle_between(coupler: Expression, rocker: Expression, opposite: Expression) -> Expression:
    """Return the angle between coupler and rocker, opposite the distance from the pin of the crank to D."""
    return acos((coupler**2 + rocker**2 - opposite**2) / (2 * coupler * rocker))


def transmission_of_slider(crank: Expression, rod: Expression, e: Expression) -> Expression:
    """Return the least transmission angle of a slider-crank, whose pin of the crank is then farthest from the guide."""
    return acos((e + crank) / rod)
