"""The words of groups that no assignment of the repository has: slides on moving links, loads off the pins."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.units import Language
from reportgen.document import text_of

SLOTTED = """
kind: linkage
report: {worked_positions: [2]}
positions: {count: 4, direction: clockwise}
parameters:
  frame: {A: [0 mm, 0 mm], C: [0 mm, -200 mm]}
  driver: {type: crank, centre: A, pin: B, length: 60 mm, n: 90 rpm}
  groups:
    - {type: RPR, links: [2, 3], joints: [B, D, C], offset: 20 mm}
    - type: PRP
      links: [4, 5]
      joints: [E]
      guides: [{on: 3, at: [0 mm, 0 mm], angle: 0 deg}, {at: [0 mm, 150 mm], angle: 0 deg}]
  points:
    S2: {link: 2, at: [0 mm, 25 mm]}
    S3: {link: 3, at: [120 mm, 0 mm]}
    S5: {link: 5, at: [60 mm, 20 mm]}
  masses:
    - {link: 2, at: S2, G: 10 N, J: 0.002 kg m2}
    - {link: 3, at: S3, G: 40 N, J: 0.03 kg m2}
    - {link: 5, at: S5, G: 50 N}
  loads:
    - {by: constant, link: 5, at: S5, F: 100 N, direction: 180 deg}
"""
"""A slotted lever with an offset, a pin between its slot and a fixed guide, mass centres off the pins."""

TRANSLATED = """
kind: linkage
report: {worked_positions: [2]}
positions: {count: 4, direction: anticlockwise}
parameters:
  frame: {A: [0 mm, 0 mm], K: [-40 mm, -220 mm]}
  driver: {type: crank, centre: A, pin: B, length: 60 mm, n: 90 rpm}
  groups:
    - {type: RPP, links: [2, 3], joints: [B, D], guide: {at: [0 mm, 0 mm], angle: 0 deg}}
    - type: RRP
      links: [4, 5]
      joints: [K, H]
      length: 250 mm
      guide: {on: 3, at: [0 mm, 0 mm], angle: 60 deg}
      end: far
  points:
    S3: {link: 3, at: [100 mm, 30 mm]}
  masses:
    - {link: 3, at: S3, G: 40 N}
    - {link: 5, at: H, G: 10 N}
  loads:
    - {by: constant, link: 3, at: S3, F: 80 N, direction: 180 deg}
"""
"""A yoke in translation under a pin; a rod from the frame drives a slider along a guide on the yoke."""


def words(text: str, folder: Path, language: Language) -> str:
    file = folder / "linkage.yaml"
    file.write_text(text.strip() + "\n", encoding="utf-8")
    return text_of(api.document(api.load(file, language)))


@pytest.fixture(scope="module")
def english(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    folder = tmp_path_factory.mktemp("en")
    return {text: words(text, folder, "en") for text in (SLOTTED, TRANSLATED)}


@pytest.mark.parametrize("text", [SLOTTED, TRANSLATED], ids=["slotted", "translated"])
def test_vietnamese_has_the_same_sections(text: str, tmp_path: Path, english: dict[str, str]) -> None:
    written = words(text, tmp_path, "vi")
    assert written.count("\n") == english[text].count("\n")


def test_a_block_with_mass_has_its_centre_of_percussion_from_its_pin(english: dict[str, str]) -> None:
    assert "centre of percussion K_2 on the extension of BS₂" in english[SLOTTED]


def test_a_guide_reaction_off_the_pin_is_said_to_be_off_it(english: dict[str, str]) -> None:
    assert "on the side on which its moment about E opposes M_05" in english[SLOTTED]
    assert "have a moment about this pin" in english[SLOTTED]


def test_what_slides_on_a_link_in_translation_does_not_turn(english: dict[str, str]) -> None:
    assert "Link 5 is in translation." in english[TRANSLATED]
    assert "Link 4 is in general plane motion." in english[SLOTTED]


def test_only_what_the_equation_shows_is_called_unknown(english: dict[str, str]) -> None:
    assert "the magnitudes of v_H and v_HH3" in english[TRANSLATED]


def test_the_remark_on_translation_is_no_part_of_the_last_step(english: dict[str, str]) -> None:
    assert "\nLink 3 is in translation, so that" in english[TRANSLATED]


def test_no_length_rule_is_claimed_for_a_rod_from_the_frame(english: dict[str, str]) -> None:
    assert "is the square of the segment" not in english[TRANSLATED]


def test_a_point_of_the_block_is_constructed_before_it_is_measured(english: dict[str, str]) -> None:
    text = english[SLOTTED]
    step, measured = text.index("Its end is s_2."), text.index("\nv_S2 = ")
    assert step < measured
    assert text.index("The end is s_2^′.") < text.index("\na_S2 = ")


def test_no_line_uses_an_angular_velocity_before_its_own(english: dict[str, str]) -> None:
    lines = english[SLOTTED].splitlines()
    own = next(index for index, line in enumerate(lines) if line.startswith("ω_3 ="))
    block = next(index for index, line in enumerate(lines) if line.startswith("ω_2 = ω_3"))
    point = next(index for index, line in enumerate(lines) if line.startswith("v_S2B ="))
    assert own < block < point
