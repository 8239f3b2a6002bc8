"""A variant drawn anew, and a student who leaves: nobody else's file changes, now or at a later run."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from reportgen.base.errors import AssignmentError, UnknownNameError
from reportgen.classes.variants import Variants, make_variants

CLASS = 8


SPEC = """\
kind: four-bar
report: {language: en}
parameters:
  AB: 100 mm
  BC: 340 mm
  CD: 280 mm
  AD: 400 mm
  omega1: {from: 20 rad/s, to: 28 rad/s, step: 1 rad/s}
"""
"""Nine variants, so that many of the class meet what others have taken."""


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    path = tmp_path / "spec.yaml"
    path.write_text(SPEC, encoding="utf-8")
    return path


def roster(folder: Path, ids: list[str]) -> Path:
    path = folder / "roster.csv"
    path.write_text("id,name,email\n" + "".join(f"{id},SV {id},{id.lower()}@x.vn\n" for id in ids), encoding="utf-8")
    return path


def made(spec: Path, ids: list[str], **options: list[str]) -> Variants:
    return make_variants(spec, roster(spec.parent, ids), spec.parent / "out", language="en", **options)


def files(spec: Path) -> dict[str, str]:
    return {path.stem: path.read_text(encoding="utf-8") for path in sorted((spec.parent / "out").glob("*.yaml"))}


def body(text: str) -> str:
    """What a file says, without the comments that name its student."""
    return "\n".join(line for line in text.splitlines() if line.strip().startswith("omega1:"))


IDS = [f"K{number}" for number in range(1, CLASS + 1)]


def test_a_redrawn_variant_is_another_one_and_the_others_keep_theirs(spec: Path) -> None:
    made(spec, IDS)
    before = files(spec)
    made(spec, IDS, redraw=["K3"])
    after = files(spec)
    assert {id for id in IDS if before[id] != after[id]} == {"K3"}
    # Nine variants, eight students: the one that nobody had.
    assert body(after["K3"]) not in {body(text) for text in before.values()}
    # A later run, and a student more, change nothing of it; the newcomer does not get it.
    made(spec, [*IDS, "K9"])
    later = files(spec)
    assert {id: later[id] for id in IDS} == after
    assert body(later["K9"]) != body(after["K3"])


def test_a_student_who_leaves_keeps_the_place_in_the_draw(spec: Path) -> None:
    made(spec, IDS)
    before = files(spec)
    variants = made(spec, IDS, drop=["k2@x.vn"])
    assert files(spec) == {id: text for id, text in before.items() if id != "K2"}
    assert any("K2" in remark for remark in variants.remarks)
    # Taken out of the roster, later on: the place is kept by the table.
    rest = [id for id in IDS if id != "K2"]
    made(spec, rest)
    made(spec, rest)
    assert files(spec) == {id: text for id, text in before.items() if id != "K2"}
    with (spec.parent / "out" / "variants.csv").open(encoding="utf-8-sig", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [(row["id"], row["dropped"]) for row in rows] == [(id, "x" if id == "K2" else "") for id in IDS]


def test_an_edited_file_of_a_student_who_leaves_stays(spec: Path) -> None:
    made(spec, IDS[:3])
    file = spec.parent / "out" / "K2.yaml"
    file.write_text(file.read_text(encoding="utf-8") + "# mine\n", encoding="utf-8")
    made(spec, IDS[:3], drop=["K2"])
    assert file.exists()


def test_who_is_unknown_and_what_cannot_be_drawn_are_faults(spec: Path) -> None:
    with pytest.raises(UnknownNameError, match="no student “K77”"):
        made(spec, IDS, redraw=["K77"])
    with pytest.raises(UnknownNameError, match="no student “K77”"):
        made(spec, IDS, drop=["K77"])
    alone = spec.with_name("alone.yaml")
    alone.write_text(SPEC.replace("{from: 20 rad/s, to: 28 rad/s, step: 1 rad/s}", "[20 rad/s]"), encoding="utf-8")
    with pytest.raises(AssignmentError, match="no-other-variant"):
        make_variants(alone, roster(spec.parent, ["K1"]), spec.parent / "alone", language="en", redraw=["K1"])
