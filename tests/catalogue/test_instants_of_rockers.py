"""A linkage at single instants whose crank does not turn fully: nothing depends on places that it does not reach.

The angular velocities follow here from the closed loop of the links, differentiated by hand.
"""

from __future__ import annotations

import cmath
import math
from pathlib import Path

import pytest
import yaml

from reportgen import api
from reportgen.api.figures import plot_files
from reportgen.base.errors import AssignmentError, NotOfferedError
from reportgen.cases import opened
from reportgen.catalogue import sample
from reportgen.document import text_of
from tests.lanes import proof

HEAD = """
kind: linkage
report: {language: en}
positions: {at: [60 deg]}
parameters:
  frame: {A: [0 mm, 0 mm], D: [160 mm, -40 mm], G: [250 mm, 120 mm]}
  driver: {type: crank, centre: A, pin: B, length: 150 mm, omega1: 10 rad/s}
"""
FOUR_BAR = """
  groups:
    - {type: RRR, links: [2, 3], joints: [B, C, D], lengths: [170 mm, 110 mm], side: left}
"""
SLOTTED = """
  groups:
    - {type: RPR, links: [2, 3], joints: [B, B3, D], offset: 180 mm}
  points:
    E: {link: 3, at: [100 mm, 0 mm]}
"""
SIX_BAR = f"""{FOUR_BAR.rstrip()}
    - {{type: RRR, links: [4, 5], joints: [E, F, G], lengths: [130 mm, 120 mm], side: left}}
  points:
    E: {{link: 2, at: [110 mm, 60 mm]}}
"""

B, D, ω1 = 0.15 * cmath.exp(1j * math.radians(60)), 0.16 - 0.04j, 10.0
v_B = 1j * ω1 * B


def four_bar() -> float:
    """ω₃ from v_C·BC = v_B·BC, v_C = iω₃ DC, with C to the left of the way from B to D."""
    way = abs(D - B)
    along = (0.17**2 - 0.11**2 + way**2) / (2 * way)
    C = B + (D - B) / way * complex(along, math.sqrt(0.17**2 - along**2))
    rod = C - B
    return float((v_B * rod.conjugate()).real / (1j * (C - D) * rod.conjugate()).real)


def slotted() -> float:
    """ω₃ = (v_B × u)/(iDB × u), u the direction of the slot, which passes D at 180 mm."""
    DB = B - D
    along = math.sqrt(abs(DB) ** 2 - 0.18**2)
    u = DB / complex(along, 0.18)
    return float((u.conjugate() * v_B).imag / (u.conjugate() * 1j * DB).imag)


@pytest.mark.parametrize(
    ("groups", "ω3"),
    [(FOUR_BAR, four_bar()), (SLOTTED, slotted()), pytest.param(SIX_BAR, four_bar(), marks=proof)],
    ids=["RRR", "RPR", "six-bar"],
)
def test_a_crank_that_does_not_get_round(tmp_path: Path, groups: str, ω3: float) -> None:
    """It is checked, solved and written; the drawing has a scale."""
    path = tmp_path / "rocker.yaml"
    path.write_text(HEAD + groups, encoding="utf-8")
    assignment = api.load(path)
    (instant,) = api.solve(assignment)["positions"]
    assert instant["links"]["3"]["omega"] == pytest.approx(ω3, rel=1e-12)
    assert "nan" not in text_of(api.document(assignment))


def test_curves_and_variants(tmp_path: Path) -> None:
    """There is no curve over a turn that is not made, and a variant at instants is sound without one."""
    path = tmp_path / "rocker.yaml"
    path.write_text(HEAD + FOUR_BAR + "  masses: [{link: 3, at: C, G: 10 N}]\n", encoding="utf-8")
    assert opened(api.load(path)).fault() == ""
    with pytest.raises(NotOfferedError):
        plot_files([path], ["v.C"], "phi", None)


def test_a_lever_mechanism_whose_rocker_has_no_extreme_positions(tmp_path: Path) -> None:
    """With a coupler of 1.5 times the length the crank does not get round, and the chapter of its swing is left out."""
    file = yaml.load(sample("lever-six-bar", "en"), yaml.BaseLoader)
    file["parameters"]["AC"] = "135 mm"
    file |= {"positions": {"at": ["50 deg", "310 deg"]}, "report": {"language": "en"}}
    path = tmp_path / "lever.yaml"
    path.write_text(yaml.safe_dump(file, sort_keys=False), encoding="utf-8")
    assert "Extreme positions of the rocker" not in text_of(api.document(api.load(path)))


def test_a_load_by_the_stroke_needs_a_whole_turn(tmp_path: Path) -> None:
    """A slider has a stroke only if the crank gets round: the group that does not follow it is named."""
    slider = """
    - {type: RRP, links: [4, 5], joints: [C, E], length: 300 mm, guide: {at: [0 mm, 300 mm], angle: 0 deg}}
  loads:
    - {by: stroke, link: 5, unit: N, s: [0, 1], inward: [50, 50], outward: [0, 0]}
"""
    path = tmp_path / "rocker.yaml"
    path.write_text(HEAD + FOUR_BAR.rstrip() + slider, encoding="utf-8")
    with pytest.raises(AssignmentError, match="no-assembly"):
        api.load(path)
