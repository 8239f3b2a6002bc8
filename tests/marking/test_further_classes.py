"""Classes with what few files give: single instants, friction, a machine of the atlas, class III, found lengths.

They are drawn, set as tasks, filled in and marked; mistakes are named.
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest

from reportgen.base.records import replace
from reportgen.cases import open_case
from reportgen.classes import class_marking
from reportgen.classes.batch_run import Order, run_batch
from reportgen.classes.class_marking import Graded
from reportgen.classes.variants import make_variants
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.toleranced_key import Ask
from reportgen.workbook import read, write_xlsx
from tests.lanes import proof
from tests.marking import students
from tests.marking.test_mistakes import possible_mistakes

FOUR_BAR = """
kind: four-bar
variant: 2026-B
salt: springs
report: {language: vi, extent: short}
positions: {at: [{from: 40 deg, to: 80 deg, step: 10 deg}]}
parameters:
  {AB: {from: 100 mm, to: 120 mm, step: 10 mm}, BC: [340 mm, 350 mm], CD: 300 mm, AD: 400 mm, omega1: 12 rad/s,
   epsilon1: {from: 40 rad/s2, to: 80 rad/s2, step: 20 rad/s2}, g: 0 m/s2, m1: 3 kg, m2: 5 kg, m3: 4 kg,
   loads: [{by: constant, link: 3, M: 200 N m, against: motion}],
   springs: [{link: 3, at: C, to: [300 mm, 420 mm], c: {from: 2 N/mm, to: 5 N/mm, step: 1 N/mm}, free: 90 mm},
             {link: 3, about: D, c: 20 N m/rad, free: [80 deg, 100 deg]}]}
"""
SHAPER = """
kind: shaper
variant: 2026-C
salt: faces
report: {language: en, extent: short}
positions: {at: [60 deg, 120 deg]}
parameters:
  {a: 270 mm, b: 520 mm, l3: 550 mm, l4: 100 mm, H: {from: 300 mm, to: 420 mm, step: 20 mm}, n: [60 rpm, 75 rpm],
   cutting: {F: {from: 800 N, to: 1200 N, step: 100 N}, free: 0.05}, G3: 200 N, G5: 600 N,
   loads: [{by: constant, link: 5, M: -42 N m}], faces: {5: {from: -90 mm, to: [20 mm, 30 mm, 40 mm], below: 60 mm}}}
"""
FRICTION = """
kind: slider-crank
variant: 2026-D
salt: friction
report: {language: vi, extent: short, worked_positions: [2]}
positions: {count: 8}
parameters:
  {r: 100 mm, l: {from: 350 mm, to: 450 mm, step: 10 mm}, omega1: 10 rad/s, m2: 4 kg, J2: 0.08 kg m2, m3: 6 kg,
   force: {by: stroke, unit: N, s: [0, 1], inward: [1000, 1000], outward: [-500, -500]},
   friction: {pins: {A: {rho: 2.5 mm}, B: {f: [0.08, 0.1, 0.12], r: 20 mm}}, sliders: {3: [0.25, 0.3]}}}
"""
SLOTTER = """
kind: atlas/slotter-lever
variant: 2026-E
salt: slotter
report: {language: vi, extent: short, worked_positions: [2]}
positions: {count: 6}
parameters:
  {O1A: {from: 60 mm, to: 80 mm, step: 5 mm}, O1O2: [150 mm, 160 mm], n: {from: 40 rpm, to: 80 rpm, step: 10 rpm},
   F: {from: 800 N, to: 1200 N, step: 100 N}}
"""
PRESS = """
kind: linkage
variant: 2026-F
salt: press
report: {language: vi, extent: short, worked_positions: [4]}
positions: {count: 6}
parameters:
  frame: {O: [0 mm, 0 mm], B: [300 mm, -30 mm], C: [70 mm, 300 mm]}
  driver: {type: crank, centre: O, pin: A, length: 50 mm, n: {from: 60 rpm, to: 90 rpm, step: 5 rpm}}
  groups:
    - type: 3RRR
      plate: 3
      legs:
        - {link: 2, joints: [A, D], length: 130 mm}
        - {link: 4, joints: [B, E], length: {from: 186 mm, to: 194 mm, step: 2 mm}}
        - {link: 5, joints: [C, F], length: 150 mm}
      at: {E: [100 mm, 0 mm], F: [60 mm, 140 mm]}
      near: {D: [83 mm, 160 mm]}
      near_at: 60 deg
    - {type: RRP, links: [6, 7], joints: [F, H], length: 200 mm, guide: {at: [300 mm, 210 mm], angle: 0 deg}, end: far}
  masses: [{link: 7, at: H, G: [70 N, 80 N, 90 N]}]
  loads: [{by: constant, link: 7, at: H, F: 400 N, direction: 0 deg, against: motion}]
"""
FOUND = """
kind: four-bar
variant: 2026-G
salt: strokes
report: {language: vi, extent: short, worked_positions: [2]}
positions: {count: 6}
parameters:
  {AB: find, BC: find, CD: {from: 90 mm, to: 110 mm, step: 5 mm}, AD: 130 mm,
   swing: {K: [1.15, 1.2, 1.25, 1.3], psi: {from: 50 deg, to: 65 deg, step: 5 deg}}, omega1: 20 rad/s,
   G2: 12 N, G3: 15 N, torque: {M: 20 N m, sense: opposing}}
"""
SPECIAL = (
    ("v.S24", "special-point-fixed"),
    ("omega.3", "rotation-from-special-point"),
    ("a.S24", "special-point-even"),
)
SLIDING = (("a.A3A.k", "no-coriolis"), ("m.3", "weight-for-mass"), ("omega.1", "rpm-for-radians"))
RUBBING = (
    *(("friction.rho.B", "radius-for-circle"), ("friction.omega.12", "one-link")),
    ("friction.phi.3", "coefficient-for-angle"),
    *(("friction.omega.12", "links-turned-alike"), ("friction.eta", "efficiency-inverted")),
)
STROKES = (("gamma.far", "radians-for-degrees"), ("gamma.near", "radians-for-degrees"), ("l.BS2", "ratio-inverted"))
"""After a mistake in θ or ρ no crank turns, so that a student could not go on."""
MISTAKES = (("a.B.t", "no-tangential"), ("P3", "no-free-length"), ("M.Pqt1", "no-couple-of-driver"))
REVERSED = (*MISTAKES, ("turn.eps.1", "direction-reversed"))


def drawn(spec: str, count: int, folder: Path) -> tuple[Path, Path]:
    """The roster of a class and the folder of its assignments."""
    (folder / "spec.yaml").write_text(spec, encoding="utf-8")
    roster = folder / "roster.csv"
    roster.write_text("id,name\n" + "".join(f"S{n:02},Student {n}\n" for n in range(count)), encoding="utf-8")
    make_variants(folder / "spec.yaml", roster, folder / "given")
    return roster, folder / "given"


def handed_in(given: Path, into: Path, made: Sequence[tuple[str, str]]) -> Mapping[str, tuple[str, str]]:
    """Sheets filled in from first to last cell, those of the first students each with one of the mistakes `made`."""
    into.mkdir()
    slips = {}
    for number, file in enumerate(sorted(given.glob("S*.yaml"))):
        scheme = marking_scheme(open_case(file))
        scheme = replace(scheme, key=Ask().of(scheme.key))
        mistake = None
        if number < len(made):
            mistake = next(one for one in possible_mistakes(scheme) if (one.where, one.name) == made[number])
            slips[file.stem] = made[number]
        sheet = students.written(scheme, students.worked_out(scheme, mistake))
        (into / f"{file.stem}.xlsx").write_bytes(write_xlsx(students.filled_book(scheme.key, sheet)))
    return slips


def told(graded: Graded) -> dict[str, list[tuple[str, str]]]:
    """The first mistakes of each student, by the places where they are made."""
    assert graded.problems == ()
    return {one.key.id: [(cell.where, cell.mistake) for cell in one.first_errors] for one in graded.markings}


def test_mistakes_of_a_class_at_its_instants_are_told(tmp_path: Path) -> None:
    """One mistake costs one mark, whatever follows from it."""
    _, given = drawn(FOUR_BAR, 2, tmp_path)
    slips = handed_in(given, tmp_path / "in", MISTAKES[:2])
    graded = class_marking.grade([tmp_path / "in"], given, Policy())
    assert told(graded) == {id: [slip] for id, slip in slips.items()}
    assert [one.out_of - one.points for one in graded.markings] == [1, 1]


@proof
@pytest.mark.parametrize(
    ("spec", "count", "made", "asked"),
    [
        (FOUR_BAR, 6, REVERSED, "spring.l.1"),
        (SHAPER, 3, (), "face.05.1"),
        (FRICTION, 6, RUBBING, "friction.M.12"),
        (SLOTTER, 6, SLIDING, "a.A3A.k"),
        (PRESS, 12, SPECIAL, "v.S24"),
        (FOUND, 12, STROKES, "l.AB"),
    ],
)
def test_a_class_goes_from_its_variants_to_its_marks(
    tmp_path: Path, spec: str, count: int, made: Sequence[tuple[str, str]], asked: str
) -> None:
    roster, given = drawn(spec, count, tmp_path)
    order = Order(roster, None, given, tmp_path / "out", ("task",), language="vi", jobs=1)
    done = run_batch(order, io.StringIO())
    assert (done.made, done.exit_code) == (count, 0)
    paper = read(tmp_path / "out" / "S00" / "answers.xlsx", "vi")[0]
    assert asked in {str(row[0].value) for row in paper.rows if row}
    slips = handed_in(given, tmp_path / "in", made)
    graded = class_marking.grade([tmp_path / "in"], given, Policy(), roster=roster)
    assert told(graded) == {f"S{n:02}": [slips[f"S{n:02}"]] if n < len(made) else [] for n in range(count)}
    assert [one.out_of - one.points for one in graded.markings] == [1] * len(made) + [0] * (count - len(made))
