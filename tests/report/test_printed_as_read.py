"""No report shows a reader what only the program uses: doubles as they are, internal ids, noise as a power of ten."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.languages import setting_of
from reportgen.base.template_folders import languages
from reportgen.base.units import Language
from reportgen.cases import opened
from reportgen.document import text_of
from reportgen.formula import Symbol
from reportgen.marking.key_files import key_document
from reportgen.marking.toleranced_key import key_of
from tests.lanes import matrix
from tests.report import built

RAW = re.compile(r"\d+[.,]\d+")
FIGURES = 8
"""A computed number with so many significant figures was not rounded."""
NOISE = re.compile(r"\d[eE][-−]\d|10\^\(−1\d\)|10⁻¹\d")
ID = re.compile(r"(?<![\w./])(?:turn|friction|spring|seg|mu|dir|ic|lone|run|balance|laid|plan)\.[\w.]+")

FOURBAR = """
kind: four-bar
report: {language: vi}
parameters:
  AB: 90 mm
  BC: 260 mm
  CD: 220 mm
  AD: 300 mm
  n: 150 rpm
  m1: 2 kg
  m3: 2.5 kg
  torque: {M: 20 N m}
  motion: {drive: {M0: 150 N m, k: 8 N m s}, forces: true}
"""
YOKE = """
kind: scotch-yoke
parameters:
  r: 75 mm
  n: 180 rpm
  J1: 0.4 kg m2
  m3: 8 kg
  force: {by: constant, F: 700 N, stroke: inward}
  plane: horizontal
  motion: {drive: {M0: 200 N m, k: 9.5 N m s}, forces: true}
"""
LONE = """
kind: slider-crank
positions: {at: [40 deg]}
parameters:
  r: 90 mm
  l: 330 mm
  n: 150 rpm
  epsilon1: 20 rad/s2
  J1: 0.5 kg m2
  m3: 6 kg
"""
SPRING = """
kind: shaper
parameters:
  a: 270 mm
  b: 520 mm
  l3: 550 mm
  l4: 100 mm
  H: 300 mm
  n: 52 rpm
  cutting: {F: 1000 N}
  m5: 110 lb
  flywheel: {delta: 1/30}
  springs:
    - {link: 5, at: E, to: [-400 mm, 520 mm], c: 1 N/mm, free: 200 mm}
  friction: {sliders: {5: 0.1}}
"""
CASES = {"fourbar": FOURBAR, "yoke": YOKE, "lone": LONE, "spring": SPRING}


def _case(name: str, folder: Path, language: str, extent: str = "full") -> object:
    path = folder / f"{name}.yaml"
    path.write_text(CASES[name], encoding="utf-8")
    return opened(api.load(path, language).with_extent(extent))


def faults(text: str) -> list[str]:
    """What of a text no reader should see."""
    found = [one for one in RAW.findall(text) if len(one.replace(",", ".").replace(".", "").strip("0")) >= FIGURES]
    return [*found, *NOISE.findall(text), *ID.findall(text)]


@pytest.mark.parametrize(
    ("name", "language"),
    matrix([*((name, "vi") for name in CASES), ("yoke", "en")], [("yoke", "en"), ("spring", "vi")]),
)
def test_a_report_is_free_of_doubles_and_ids(name: str, language: str, tmp_path: Path) -> None:
    assert faults(text_of(_case(name, tmp_path, language).document())) == []


@pytest.mark.parametrize(
    ("path", "language"),
    matrix(
        [
            pytest.param(path, language, id=f"{path.stem}-{language}")
            for path in built.ALL
            for language in languages()
            if path in built.OF_EACH_KIND or not setting_of(language).is_draft()
        ],
        (),
    ),
)
def test_every_report_is_free_of_doubles_and_ids(path: Path, language: Language) -> None:
    """But for what its file has so."""
    typed = path.read_text(encoding="utf-8")
    for extent in ("full", "short"):
        text = text_of(built.document(path, language, extent))
        assert [one for one in faults(text) if one.replace(",", ".") not in typed] == []


def test_a_key_names_rows_by_words() -> None:
    key = key_of(opened(api.load(built.ROOT / "assignments" / "slider-crank-friction.yaml", "vi")))
    text = text_of(key_document(key, "Tay quay con trượt"))
    assert faults(text) == []
    assert "Hệ số ma sát của con trượt 3" in text


@pytest.mark.parametrize("name", ["spring", "lone"])
def test_one_symbol_names_one_quantity(name: str, tmp_path: Path) -> None:
    """The pairs that once shared a symbol have one each."""
    case = _case(name, tmp_path, "vi")
    named: dict[Symbol, list[str]] = {}
    for id, family in case.ledger.families.items():
        if not (family.hidden or family.is_plane):
            named.setdefault(family.symbol, []).append(id)
    for first, second in SEVERAL:
        for symbol, members in named.items():
            assert not ({first, second} <= set(members)), symbol


SEVERAL = (
    ("s.1", "spring.drawn.1"),
    ("l.AB", "spring.l.1"),
    ("a", "A.upper"),
    ("b", "A.lower"),
    ("M.eq", "friction.round.1"),
    ("M.vw", "friction.round.2"),
)


def test_a_foreign_unit_is_printed_with_what_it_comes_to(tmp_path: Path) -> None:
    """110 lb = 110 · 0.45359237 kg = 49.8951607 kg, which nobody would type."""
    text = text_of(_case("spring", tmp_path, "en").document())
    assert "110 lb = 49.895 kg" in text
    assert "49.8951607" not in text
