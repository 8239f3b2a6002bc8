"""The chapter on balancing of every kind with a crank: it is written, recomputes, and its figures can be drawn."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from reportgen.balancing import balance_ids
from reportgen.balancing.shaking_force import shaking_force
from reportgen.cases import MachineCase, open_case
from reportgen.document import Section
from tests.lanes import matrix

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
FILES = (
    *("engine-single-VII", "slider-crank-01", "engine-twin-05", "engine-v-01", "engine-v-02", "four-bar-02"),
    *("slotted-lever-02", "shaper-02", "lever-six-bar-01", "toggle-press-01", "scotch-yoke-01", "linkage-8"),
)
"""Of every kind with a crank, with an offset cylinder and an articulated rod among them."""
MASSLESS = {"engine-v-01": (2, 3, 4, 5), "four-bar-02": (2,)}
"""Files that get masses for it."""
RULES = "  balancing: {counterweight: {rules: [rms, max], radius: 60 mm}}\n"


def with_balancing(name: str, path: Path) -> MachineCase:
    text = (ASSIGNMENTS / f"{name}.yaml").read_text(encoding="utf-8")
    own = "".join(f"\n  m{link}: {link} kg" for link in MASSLESS.get(name, ()) if f"G{link}:" not in text)
    path.write_text(re.sub(r"^parameters:$", f"parameters:{own}\n{RULES}".rstrip("\n"), text, flags=re.M), "utf-8")
    case = open_case(path, "en")
    assert isinstance(case, MachineCase)
    return case


@pytest.mark.parametrize("name", matrix(FILES, ("shaper-02",)))
def test_every_kind_has_the_chapter(name: str, tmp_path: Path) -> None:
    case = with_balancing(name, tmp_path / f"{name}.yaml")
    titles = ["".join(str(getattr(part, "text", "")) for part in one.title) for one in sections(case)]
    assert any(title.startswith("Balancing") for title in titles)
    linkage, motion, ledger = case.analysis.machine.linkage, case.analysis.motion, case.ledger
    force = shaking_force(linkage, motion)
    x, y = (ledger[balance_ids.component(axis)].values for axis in "xy")
    # Directions near those of nothing are the least certain; twelve figures of the greatest remain.
    assert np.abs(x + 1j * y - force).max() <= 1e-10 * np.abs(force).max()
    assert case.plates()["balancing"]


def sections(case: MachineCase) -> list[Section]:
    return [block for block in case.document().blocks if isinstance(block, Section)]
