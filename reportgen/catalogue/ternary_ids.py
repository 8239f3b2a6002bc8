"""Ids of the closed formulas of a group of class III, which begin with `ternary`, with their vocabulary."""

from __future__ import annotations

import math
from collections.abc import Mapping

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import QuantityKind, VocabularyRow

across = Name("ternary.k.{joint}")  # arm across a leg, velocity along it for ω = 1: joint 42 is link 2 on leg 4
along = Name("ternary.h.{joint}")  # arm along the leg, the velocity across it for ω = 1 of the link
side = Name("ternary.b.{what}.{link}")  # right-hand side of the equation of a leg

# --- steps of the iteration for both angles; `number` steps precede them

trial_angle = Name("ternary.trial.{number}.phi.{link}")
trial_x = Name("ternary.trial.{number}.x.{link}")  # from the outer joint of a leg to its trial inner joint
trial_y = Name("ternary.trial.{number}.y.{link}")
trial_gap = Name("ternary.trial.{number}.gap.{link}")  # excess of that distance over the leg's length
trial_arm = Name("ternary.trial.{number}.k.{joint}")
trial_step = Name("ternary.trial.{number}.step.{link}")  # correction of an angle

KINDS: Mapping[str, QuantityKind] = {
    # Two figures more than those of results, so that the iteration does not end in their rounding.
    "trial angle": QuantityKind("°", math.pi / 180, decimals=4),
    "trial length": QuantityKind("m", decimals=7),
}

ROWS: tuple[VocabularyRow, ...] = (
    VocabularyRow(across, "k", "length", name="arm across"),
    VocabularyRow(along, "h", "length", name="arm along"),
    VocabularyRow(side.only(what="v"), "b", "velocity", name="leg side"),
    VocabularyRow(side.only(what="a"), "b", "acceleration", above="′", name="leg side"),
    VocabularyRow(trial_angle, "φ", "trial angle"),
    VocabularyRow(trial_x, "x", "trial length"),
    VocabularyRow(trial_y, "y", "trial length"),
    VocabularyRow(trial_gap, "Δl", "trial length"),
    VocabularyRow(trial_arm, "k", "trial length"),
    VocabularyRow(trial_step, "Δφ", "trial angle"),
)
