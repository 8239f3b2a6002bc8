"""Ids of the true motion of a machine, which begin with `run`, with their vocabulary."""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import KeyChapter, QuantityKind, VocabularyRow

along_velocity = Name("run.a.{point}")  # component of an acceleration along the velocity
slope = Name("run.dJ[.{link}]")  # J′ of the machine, or the part of a link
WHEEL = "wheel"
with_wheel = Name("run.{quantity}.wheel")
quantity = Name("run.{quantity}[.{state}]")  # quantity of the machine without, or with its flywheel


def in_state(name: str, state: str) -> str:
    """Return the id of a quantity of the machine without its flywheel (state ""), or with it ("wheel")."""
    return quantity(name, *([state] if state else []))


KINDS: Mapping[str, QuantityKind] = {"damping": QuantityKind("N·m·s")}

ROWS = (
    VocabularyRow(along_velocity, "a", "acceleration", KeyChapter.cycle, name="along velocity"),
    VocabularyRow(slope, "J", "moment of inertia", KeyChapter.cycle, name="inertia slope"),
    VocabularyRow(with_wheel, chapter=KeyChapter.cycle, name="run {quantity} wheel"),
    VocabularyRow(quantity, chapter=KeyChapter.cycle, name="run {quantity}"),
)
