"""The program's own Word reports, handed in: each value that the sheet asks stands there and is read rightly."""

from __future__ import annotations

from fnmatch import fnmatchcase
from pathlib import Path

import pytest

from reportgen.assignment.common import Extent
from reportgen.base.languages import languages
from reportgen.handin.word_file import open_word
from reportgen.handin.word_reader import read_report
from reportgen.marking.toleranced_key import Ask, key_of
from reportgen.writers import word
from tests.handin.made_reports import ROOT
from tests.lanes import matrix
from tests.report import built

SAMPLES = sorted(
    path.relative_to(ROOT).with_suffix("").as_posix()
    for path in ROOT.rglob("*.yaml")
    if path.parent.name not in ("class-demo", "atlas")
)
EXTENTS: tuple[Extent, ...] = ("full", "short")
FIRST = [
    ("slider-crank-friction", "ru", "full"),
    ("scotch-yoke-01", "zh", "full"),
    ("cam/flat-01", "vi", "short"),
    ("engine-balance/inline-four", "ru", "full"),
    ("gears/train-single", "zh", "full"),
    ("plane-motion/06", "ru", "full"),
    ("four-bar-01", "en", "full"),
]
LONGEST = ("engine-twin-05", "en", "full")
LEFT: dict[tuple[Extent, str], str] = {
    ("short", "cam.[uwm]*"): "the chapter that works out the curvature is left out",
    ("short", "train.[rv].*"): "the triangles of velocities are left out",
    ("full", "structure.mechanism"): "its symbol C is also the letter of a point",
    ("short", "structure.mechanism"): "its symbol C is also the letter of a point",
    ("full", "turning.M.mean"): "a fraction with a long sum is not read back",
    ("short", "turning.M.mean"): "a fraction with a long sum is not read back",
    ("full", "turning.A.2"): "a side of its line is broken before a sign, and is not read on",
    ("short", "turning.A.2"): "a side of its line is broken before a sign, and is not read on",
}
LEFT |= {
    (extent, f"synthesis.{name}"): reason
    for extent in EXTENTS
    for names, reason in {
        ("phi.*", "follower.*"): "it is last in a difference of cosines, whose value could be its own",
        ("direction.*", "mu", "error"): "a line with several arguments is not read back",
        ("factor.3",): "a side of its line is broken before a sign, and is not read on",
    }.items()
    for name in names
}
LEFT |= {
    ("short", f"synthesis.{name}.[234]"): "a short report works out the first place" for name in ("actual", "opening")
}
"""Why a report goes without a quantity that is asked for: the reason by the extent and a pattern of ids."""


FIRST_OF_KIND = {path.relative_to(ROOT).with_suffix("").as_posix() for path in built.OF_EACH_KIND}
TURNS = [
    (name, languages()[(number + turn) % len(languages())], extent)
    for number, name in enumerate(SAMPLES)
    for turn, extent in enumerate(EXTENTS)
    if name in FIRST_OF_KIND or turn == number // len(languages()) % len(EXTENTS)
]
"""The first sample of each kind in both extents, the others in one; the languages and extents take turns."""


@pytest.mark.parametrize(("name", "language", "extent"), matrix(dict.fromkeys([*FIRST, LONGEST, *TURNS]), FIRST))
def test_each_value_that_the_sheet_asks_is_read_in_our_own_report(name: str, language: str, extent: Extent) -> None:
    path = ROOT / f"{name}.yaml"
    key = Ask().of(key_of(built.case(path, language, extent)))
    content = word.write(built.document(path, language, extent), lambda scenes: [(b"", b"") for _ in scenes])
    reading = read_report(open_word(Path("report.docx"), content).blocks, key, "report.docx")
    asked = {(row.id, position) for row in key.asked for position in row.positions}
    left = [pattern for of, pattern in LEFT if of == extent]
    unread = asked - reading.values.keys()
    assert {place for place in unread if not any(fnmatchcase(place[0].split("/")[-1], one) for one in left)} == set()
    for (id, position), answer in reading.values.items():
        row = key.row(id)
        printed = row.printed[row.at(position)]
        assert answer.value == pytest.approx(printed, rel=5e-3, abs=1e-9), (id, position, answer)
