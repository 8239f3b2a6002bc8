"""What reports of random cams print: right to a unit of its last decimal, and every line follows from what it names."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from reportgen.base.errors import AssignmentError
from reportgen.cam.case import CamCase
from reportgen.cam.motion_laws import LAWS
from reportgen.cases import open_case
from reportgen.formula.vocabulary import distance
from tests.cam.test_cam_envelope import carried, lifting
from tests.cam.test_cam_reports import recomputes
from tests.lanes import matrix

GRAPH = "{x: [0, 0.35, 0.5, 1], a: [2, 2, -1.5, -1.2]}"
UNIT = 1 + 1e-6
"""Units of the last decimal, and the dust of floats."""


def drawn(rng: np.random.Generator) -> str:
    """The file of a cam whose numbers nobody has chosen to be round."""

    def of(low: float, high: float, decimals: int = 2) -> str:
        return f"{rng.uniform(low, high):.{decimals}f}"

    end, translating = rng.choice(["roller", "knife", "flat"]), bool(rng.integers(2))
    rise, far, back = of(70, 120), rng.choice(["0", of(5, 40)]), of(70, 120)
    rows = [f"end: {end}", f"phases: {{rise: {rise} deg, far: {far} deg, return: {back} deg}}", "n: 137 rpm"]
    laws = [one for one in LAWS if one != "uniform"]
    rows.append(f"laws: {{rise: {rng.choice([*laws, GRAPH])}, return: {rng.choice(laws)}}}")
    if end != "flat":
        rows.append(f"limits: {{rise: {of(30, 45)} deg, return: {of(45, 70)} deg}}")
    if translating:
        rows += ["follower: translating", f"h: {of(8, 60)} mm"]
        rows += [f"e: {rng.choice(['0 mm', 'find', of(-8, 8) + ' mm'])}"] if end != "flat" else []
    else:
        arm = rng.uniform(80, 150)
        rows += ["follower: oscillating", f"psi_max: {of(6, 16)} deg", f"lifts: {rng.choice(['with', 'against'])}"]
        rows += [f"a: {arm * rng.uniform(1.1, 1.5):.1f} mm"] + ([f"arm: {arm:.1f} mm"] if end != "flat" else [])
    rows += [f"direction: {rng.choice(['anticlockwise', 'clockwise'])}", "r0: find", "positions: 16"]
    return "\n".join(["kind: cam", "report: {language: en}", "parameters:", *(f"  {row}" for row in rows)]) + "\n"


def random_cases(folder: Path, seed: int, count: int) -> list[CamCase]:
    """So many cams that there are."""
    rng, found = np.random.default_rng(seed), list[CamCase]()
    while len(found) < count:
        file = folder / f"{len(found)}.yaml"
        file.write_text(drawn(rng), encoding="utf-8")
        try:
            case = open_case(file, "en")
        except AssignmentError:
            continue
        assert isinstance(case, CamCase)
        found.append(case)
    return found


@pytest.mark.parametrize("seed", matrix(range(12), [0]))
def test_what_is_printed_is_right_to_a_unit(tmp_path: Path, seed: int) -> None:
    for case in random_cases(tmp_path, seed, 6):
        printed, exact = case.printed, case.ledger.evaluate()
        for id, family in printed.families.items():
            decimals = printed.decimals[id]
            if family.hidden or decimals is None:
                continue
            off = np.nan_to_num(distance(id, np.real(family.values), np.real(exact[id])))
            assert np.max(off) <= UNIT * 10.0**-decimals * family.how.scale, (id, case.assignment.parameters)
            for k in range(1, len(family.values) + 1):
                assert recomputes(printed.chain(id, k)) is not False, (id, k)
        of_its_path(case)


def of_its_path(case: CamCase) -> None:
    """Points and pressure angles as the follower's path has them, from its lift alone, to what is printed of them."""
    cam, printed = case.solution.cam, case.printed
    body = carried(cam)
    if cam.flat:
        return
    index = np.round(case.solution.φ / (2 * math.pi) * body.φ.size).astype(int) % body.φ.size
    # Where a position of the report is one of the path, away from corners at which neighbours show a mean.
    ends = np.array([edge for one in cam.motion.intervals for edge in (one.start, one.stop)])
    met = np.abs(body.φ[index] - case.solution.φ) < 1e-9
    met &= np.abs(case.solution.φ[:, None] - ends).min(axis=1) > 1e-3
    x, y = (printed[f"cam.pitch.{axis}"].values[met] for axis in "xy")
    assert np.abs(x + 1j * y - body.points[index][met]).max(initial=0) <= 1.5 * UNIT * 1e-6
    chord = body.points[(index + 1) % body.φ.size] - body.points[index - 1]
    outward = 1j * cam.turn * chord
    α = np.degrees(cam.turn * np.angle(outward / lifting(cam, case.solution.φ)))[met]
    # A hundredth of a degree as printed, and what neighbours 1e-4 rad apart miss.
    assert np.abs(np.degrees(printed["cam.alpha"].values[met]) - α).max(initial=0) <= 0.011
