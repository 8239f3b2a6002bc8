"""Ids of a planetary train, which begin with `train`, and their meaning; `train_ledger` names some more."""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import QuantityKind, VocabularyRow

factor = Name("train.factor.{factor}")
teeth = Name("train.z.{wheel}")
row_ratio = Name("train.u.row.{number}")
omega = Name("train.omega.{wheel}")
velocity = Name("train.v.{place}")
efficiency = Name("train.eta.{of}")
least_shift = Name("train.x.{wheel}")
torque = Name("train.M.{of}")
power = Name("train.P.{of}")
line = Name("train.line.{place}")  # on paper
segment = Name("train.seg.{wheel}")  # of the plan of angular velocities
read = Name("train.read.{wheel}")
scale = Name("train.mu.{of}")

KINDS: Mapping[str, QuantityKind] = {
    "velocity on paper": QuantityKind("mm/(s·mm)", digits=6),
    "rotation on paper": QuantityKind("rad/(s·mm)", 1e3, digits=6),
}

ROWS: tuple[VocabularyRow, ...] = (
    VocabularyRow(teeth, "z", "count", below="{wheel}", name="train teeth"),
    VocabularyRow(row_ratio, "u", "ratio", below="{number}", name="train row ratio"),
    VocabularyRow(omega, "ω", "angular velocity", below="{wheel}", name="train omega"),
    VocabularyRow(velocity, "v", "follower velocity", below="{place}", name="train velocity"),
    VocabularyRow(least_shift, "x", "ratio", below="{wheel}", name="train least shift"),
    VocabularyRow(torque, "M", "torque", below="{of}", name="train torque"),
    VocabularyRow(power, "P", "power", below="{of}", name="train power"),
    VocabularyRow(efficiency, "η", "ratio", below="{of}", name="train efficiency"),
)
