"""Ids of a structure exercise, which begin with `structure`, with their vocabulary.

A group is named by the lowest number of its links, so that its name does not depend on the order of assembly.
"""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import KeyChapter, QuantityKind, VocabularyRow

group = Name("structure.group.{link}")
group_class = Name("structure.class.{link}")
class_by = Name("structure.by.{link}")

TABLE = "structure.table"
"""1; the numbers that are counted in the table of pairs depend on it."""
LINKS, LOWER, HIGHER, MOBILITY = "structure.n", "structure.p5", "structure.p4", "structure.W"
EQUIVALENT_LINKS, EQUIVALENT_PAIRS = "structure.n.lower", "structure.p5.lower"
EQUIVALENT_MOBILITY = "structure.W.lower"
GROUPS, MECHANISM_CLASS = "structure.groups", "structure.mechanism"

KINDS: Mapping[str, QuantityKind] = {}

_G, _L = KeyChapter.geometry, KeyChapter.loads

ROWS: tuple[VocabularyRow, ...] = (
    VocabularyRow(Name(TABLE), "T", "count"),
    VocabularyRow(Name(LINKS), "n", "count", _G),
    VocabularyRow(Name(LOWER), "p", "count", _G, below="5"),
    VocabularyRow(Name(HIGHER), "p", "count", _G, below="4"),
    VocabularyRow(Name(MOBILITY), "W", "count", _G),
    VocabularyRow(Name(EQUIVALENT_LINKS), "n", "count", _G, above="′"),
    VocabularyRow(Name(EQUIVALENT_PAIRS), "p", "count", _G, below="5", above="′"),
    VocabularyRow(Name(EQUIVALENT_MOBILITY), "W", "count", _G, above="′"),
    VocabularyRow(Name(GROUPS), "k", "count", _L),
    VocabularyRow(group, "g", "count", _L, below="{link}", name="structure group"),
    VocabularyRow(group_class, "C", "count", _L, below="{link}", name="structure class"),
    VocabularyRow(Name(MECHANISM_CLASS), "C", "count", _L),
    VocabularyRow(class_by, "D", "count", KeyChapter.cycle, below="{link}", name="structure class by driver"),
)
