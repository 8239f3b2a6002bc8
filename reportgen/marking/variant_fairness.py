"""Compare the marks of a class by the values of the drawn data (`groups`), to find variants that were harder.

Students of one variant, or with one value of a datum, are a group. A group is reported as different by a permutation
test, because marks are not normally distributed. With Bonferroni's bound, the comparison of all groups errs once in 20.
Source: R. A. Fisher, The Design of Experiments, 1935, § 21.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from statistics import fmean, stdev

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.base.template_folders import search_path
from reportgen.base.units import Language, write
from reportgen.base.words import load_words
from reportgen.case.answer_key import Role
from reportgen.formula import Symbol
from reportgen.formula.plain_text import formula
from reportgen.marking.class_marks import DECIMALS, CellValue
from reportgen.marking.marking_data import Marking
from reportgen.marking.marking_policy import Policy

LEAST = 2
"""Smallest number of students in a group; a single one has no spread."""
MOST = 12
"""Largest number of groups of a datum; more are too small to show anything."""
ERRING = 0.05
"""Probability with which chance alone may make some group of a class look different."""
LOTS = 20_000
"""Number of random permutations of a class, the same each time.

With 50 groups, the smallest probability that counts is 1 in 1000, or 20 permutations.
"""


class VariantGroup(Record):
    """Students who share one value: its symbol (None: the variant), the value, their number, mean and spread of marks.

    `chance` is the probability of a mean as far from the class's for a random group.
    """

    symbol: Symbol | None
    value: str
    count: int
    mean: float
    spread: float
    chance: float = 1.0
    differs: bool = False


def groups(markings: Sequence[Marking], policy: Policy, language: Language) -> list[VariantGroup]:
    """Return the groups of a class by variant and by each drawn datum; late submissions have no deduction here."""
    marks = {marking.key.id: policy.mark(marking.share) for marking in markings}
    means = _means_by_lot(list(marks.values()))
    compared: list[VariantGroup] = []
    partitions: set[frozenset[frozenset[str]]] = set()
    for symbol, members in _divisions(markings, language):
        large = {value: ids for value, ids in members.items() if len(ids) >= LEAST}
        partition = frozenset(map(frozenset, members.values()))
        # Data that were drawn together divide a class in the same way; only the first of them is shown.
        if len(large) >= 2 and len(members) <= MOST and partition not in partitions:
            partitions.add(partition)
            for value, ids in large.items():
                own = [marks[id] for id in ids]
                compared.append(VariantGroup(symbol, value, len(own), fmean(own), stdev(own), _chance(own, means)))
    return [replace(group, differs=group.chance * len(compared) < ERRING) for group in compared]


def _divisions(
    markings: Sequence[Marking], language: Language
) -> Iterator[tuple[Symbol | None, Mapping[str, list[str]]]]:
    """Yield the divisions of the class: students by variant, then students by the value of each datum."""
    yield None, _sorted({marking.key.id: (0.0, marking.key.variant) for marking in markings if marking.key.variant})
    first = markings[0].key
    for row in (row for row in first.rows if row.role is Role.given and row.single):
        of_student = {}
        for marking in markings:
            own = marking.key.find(row.id)
            if own is not None and own.role is Role.given and own.single:
                value = float(own.values[0])
                printed = write(float(f"{value:.6g}"), None, language)
                of_student[marking.key.id] = (value, f"{printed} {own.unit}".strip())
        yield row.symbol, _sorted(of_student)


def _sorted(of_student: Mapping[str, tuple[float, str]]) -> Mapping[str, list[str]]:
    """Return the students of each value, the smallest value first."""
    members: dict[str, list[str]] = {}
    for id, (_, value) in sorted(of_student.items(), key=lambda item: item[1]):
        members.setdefault(value, []).append(id)
    return members


def _means_by_lot(marks: Sequence[float]) -> np.ndarray:
    """Return the means [LOTS, N] of the first 1 … N marks of random permutations of a class."""
    lots = np.random.default_rng(0).permuted(np.tile(marks, (LOTS, 1)), axis=1)
    return np.cumsum(lots, axis=1) / np.arange(1, len(marks) + 1)


def _chance(own: Sequence[float], means: np.ndarray) -> float:
    """Return the probability that a random group of that size has a mean as far from that of the class."""
    whole = means[0, -1]
    # 1e-9: means of the same marks in another order differ by floating-point noise.
    as_far = np.abs(means[:, len(own) - 1] - whole) >= abs(fmean(own) - whole) - 1e-9
    return float((1 + np.count_nonzero(as_far)) / (1 + LOTS))


def variant_rows(compared: Sequence[VariantGroup], language: Language) -> tuple[tuple[CellValue, ...], ...]:
    """Return the head and the rows of `by-variant.csv`."""
    words = load_words(search_path(language))
    names, page = words["variant_columns"], words["class_page"]
    rows: list[tuple[CellValue, ...]] = [tuple(names.values())]
    rows += [
        (
            page["variant"] if group.symbol is None else formula(group.symbol, language),
            group.value,
            group.count,
            *(round(value, DECIMALS) for value in (group.mean, group.spread, group.chance)),
            page["differs"] if group.differs else "",
        )
        for group in compared
    ]
    return tuple(rows)
