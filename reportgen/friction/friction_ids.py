"""Ids of friction, in the joints of machines and in exercises, with their vocabulary."""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import KeyChapter, QuantityKind, VocabularyRow
from reportgen.friction import exercise_rows

coefficient = Name("friction.f.{point}")  # coefficient of a pin
coefficient_of_slider = Name("friction.f.{link}")
pin_radius = Name("friction.r.{point}")
circle = Name("friction.rho.{point}")
angle = Name("friction.phi.{link}")
turning = Name("friction.omega.{joint}")  # size of the rate of the link acted on against the other
reaction = Name("friction.R.{joint}[.{round}]")
"""Reaction of a pin, or across a guide; with a round, the reaction before convergence."""
couple = Name("friction.M.{joint}")
force = Name("friction.F.{joint}")
part = Name("friction.part.{joint}")
"""Part of the driver's torque that overcomes the friction of a joint."""
torque = "friction.M"
reduced = "friction.reduced"
"""Torque that friction takes from the crank, reduced to it like that of the loads."""
torque_of_round = Name("friction.round.{round}")
efficiency = "friction.eta"
mean = "friction.mean"
cycle_efficiency = "friction.eta.cycle"
dead = Name("friction.dead.{link}.{number}.{side}")
"""Angle before or behind a dead centre within which a slider cannot move its crank."""
dead_before = Name("friction.dead.{link}.{number}.before")
dead_behind = Name("friction.dead.{link}.{number}.behind")

KINDS: Mapping[str, QuantityKind] = exercise_rows.KINDS
ROWS = (
    VocabularyRow(coefficient, "f", "ratio", name="friction coefficient"),
    VocabularyRow(coefficient_of_slider, "f", "ratio", name="slider friction"),
    VocabularyRow(pin_radius, "r", "length", name="pin radius"),
    VocabularyRow(circle, "ρ", "length", KeyChapter.forces, name="friction circle"),
    VocabularyRow(angle, "φ", "angle", KeyChapter.forces, name="friction angle"),
    VocabularyRow(turning, "ω", "angular velocity", KeyChapter.torque, name="turning in a joint"),
    VocabularyRow(
        reaction, "R", "force", KeyChapter.torque, below="{joint}", above="fr", name="reaction with friction"
    ),
    VocabularyRow(couple, "M", "torque", KeyChapter.torque, below="fr{joint}", name="friction couple"),
    VocabularyRow(force, "F", "force", KeyChapter.torque, below="fr{joint}", name="friction force"),
    VocabularyRow(part, "ΔM", "torque", KeyChapter.torque, name="torque against friction"),
    VocabularyRow(Name(torque), "M", "torque", KeyChapter.torque, below="cb", above="fr", name="torque with friction"),
    VocabularyRow(
        torque_of_round, "M", "torque", KeyChapter.torque, below="cb", above="({round})", name="torque with friction"
    ),
    VocabularyRow(
        Name(reduced), "M", "torque", KeyChapter.cycle, below="tt", above="fr", name="reduced friction torque"
    ),
    VocabularyRow(Name(efficiency), "η", "ratio", KeyChapter.torque, name="efficiency"),
    VocabularyRow(Name(mean), "M", "torque", KeyChapter.cycle, below="m", above="fr", name="mean torque with friction"),
    VocabularyRow(Name(cycle_efficiency), "η", "ratio", KeyChapter.cycle, below="m", name="efficiency over the cycle"),
    VocabularyRow(dead_before, "Δφ", "angle", KeyChapter.cycle, below="{link}", name="dead zone before"),
    VocabularyRow(dead_behind, "Δφ", "angle", KeyChapter.cycle, below="{link}", name="dead zone behind"),
    *exercise_rows.ROWS,
)
