"""Whoever integrates over the positions by the trapezoid rule is right, or is not asked for it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from reportgen.document import Paragraph, plain
from reportgen.formula.vocabulary import KeyChapter
from reportgen.marking.key_files import key_document
from tests.lanes import matrix
from tests.marking import students

FILES = sorted(path.stem for path in Path("assignments").glob("*.yaml"))
WITH_FLYWHEEL = [name for name in FILES if "flywheel:" in Path("assignments", f"{name}.yaml").read_text("utf-8")]


TELLING = ("engine-single-III", "shaper-04", "toggle-press-01", "slotted-lever-02")
"""Gas, loads over the stroke, and one that jumps between the positions."""


@pytest.mark.parametrize("name", matrix(WITH_FLYWHEEL, TELLING))
def test_the_rule_over_the_positions_gives_what_is_right_or_not_asked(name: str) -> None:
    scheme = students.scheme(name)
    rows = {row.id: np.array(row.values) for row in scheme.key.rows}
    count, turns = len(rows["M.r"]), len(rows["M.r"]) // scheme.count
    # By hand: the works of the intervals, the last one closing the cycle, less those of the mean torque.
    torque, step = rows["M.r"], 2 * np.pi * turns / count
    work = [0.0]
    for one, other in zip(torque, [*torque[1:], torque[0]], strict=True):
        work.append(work[-1] + (one + other) / 2 * step)
    excess = np.array(work[:-1]) - work[-1] * np.arange(count) / count
    J, ω, δ = rows.get("J.r", np.zeros(count)), float(rows["omega.1"][0]), float(rows["unevenness"][0])
    high = max(excess - (ω * (1 + δ / 2)) ** 2 * J / 2)
    low = min(excess - (ω * (1 - δ / 2)) ** 2 * J / 2)
    asked = {row.id for row in scheme.key.asked}
    # A load that jumps between the positions, or a tall narrow one, is not for the rule.
    assert ("J.d" in asked) or name in {"slotted-lever-02", "slider-crank-03", "toggle-press-02"}
    for id, values in (("J.d", np.array([(high - low) / (δ * ω**2)])), ("A.excess", excess)):
        if id in asked:
            assert (np.abs(values - rows[id]) <= scheme.bands[id] / scheme.ledger[id].how.scale).all()


def test_some_positions_make_no_flywheel() -> None:
    scheme = students.scheme("engine-single-III", (2, 4))
    assert not {"J.d", "A.excess", "omega.of", "J.r"} & {row.id for row in scheme.key.asked}
    assert scheme.key.row("J.d").part is KeyChapter.cycle


@pytest.mark.parametrize(("name", "told"), [("engine-single-III", True), ("four-bar-01", False)])
def test_the_key_says_why_the_bands_are_wide(name: str, told: bool) -> None:
    key = students.scheme(name).key
    blocks = key_document(key, "").blocks
    text = " ".join(plain(block.inlines, key.language) for block in blocks if isinstance(block, Paragraph))
    assert ("quy tắc hình thang" in text) is told
    assert ("J.d" in {row.id for row in key.rows}) is told
