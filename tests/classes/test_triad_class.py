"""A class of presses with a group of class III: each variant passes check, and its right sheet scores full."""

from __future__ import annotations

import pytest

from reportgen.cases import open_case
from reportgen.classes.roster import read_roster
from reportgen.classes.variant_draw import fault_finder
from reportgen.classes.variant_spec import read_spec
from reportgen.classes.variants import make_variants
from reportgen.marking.judging import mark
from reportgen.marking.marking_scheme import marking_scheme
from tests.classes.specs import ROOT, Put, draw, ids
from tests.marking import students

PRESS = ROOT / "assignments" / "linkage" / "press-class-iii.yaml"
DRAWN = {
    "variant: 6": "salt: press",
    "n: 90 rpm": "n: {from: 60 rpm, to: 90 rpm, step: 5 rpm}",
    "length: 190 mm": "length: {from: 186 mm, to: 194 mm, step: 2 mm}",
}


@pytest.mark.proof
def test_a_class_of_presses_from_variants_to_marks(put_file: Put) -> None:
    text = PRESS.read_text(encoding="utf-8")
    for old, new in DRAWN.items():
        assert old in text
        text = text.replace(old, new)
    path, roster = put_file(text), put_file("id\n" + "".join(f"{id}\n" for id in ids(12)), "r.csv")
    spec = read_spec(path)
    result = draw(spec, read_roster(roster), fault_finder(spec))
    assert (len(result.drawn), result.faults) == (12, ())
    made = make_variants(path, roster, path.parent / "out").files
    assert len({file.text for file in made}) == 12
    scheme = marking_scheme(open_case(made[7].path, "vi"))
    marking = mark(scheme, students.sheet(scheme, lambda row, k, value: students.figures(value, 3)))
    assert (marking.points, marking.warnings) == (marking.out_of, ())
