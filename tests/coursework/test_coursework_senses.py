"""What a coursework says of its parts as a whole: which way each shaft turns, what each comes to, its symbols."""

from __future__ import annotations

import math
import re
from functools import cache
from pathlib import Path

import pytest

from reportgen.case.shafts import Shaft
from reportgen.cases import open_case
from reportgen.coursework.booklet import groups, topic
from reportgen.coursework.case import Coursework
from reportgen.coursework.senses import PartShafts, turning
from reportgen.document import Block, Inlines, Section, Table, plain, text_of
from reportgen.document.used_symbols import explained, is_explained, used_symbols
from tests.report import built

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
FOLDER = ASSIGNMENTS / "coursework"
MACHINE = """kind: slider-crank
report: {{language: en, worked_positions: [2], extent: {extent}}}
positions: {{direction: {direction}}}
parameters: {{r: 60 mm, l: 210 mm, n: 160 rpm}}
parts:
  - title: Reduction
    kind: planetary-train
    parameters: {{scheme: {scheme}, u: {u}, k: 3, z: {{from: 17, to: 90}}, m: 3 mm, n_in: {n_in} rpm}}
  - title: First cam
    from: {{n: {{of: n}}}}
    kind: cam
    parameters: &cam
      follower: translating
      end: knife
      h: 30 mm
      phases: {{rise: 120 deg, far: 60 deg, return: 120 deg, near: 60 deg}}
      laws: {{rise: parabolic, return: sine}}
      r0: 60 mm
      e: 0 mm
      positions: 8
  - title: Second cam
    from: {{n: {{of: n, times: 1/2}}}}
    kind: cam
    parameters:
      follower: translating
      end: flat
      h: 12 mm
      phases: {{rise: 90 deg, far: 20 deg, return: 80 deg}}
      laws: {{rise: sine, return: cosine}}
      r0: 40 mm
      positions: 8
""".replace(" &cam", "")


def said(inlines: Inlines) -> str:
    return plain(inlines, "vi")


@cache
def whole() -> Coursework:
    case = built.case(FOLDER / "shaper-whole.yaml")
    assert isinstance(case, Coursework)
    return case


def coursework(folder: Path, direction: str, scheme: str = "double", u: float = 9, extent: str = "full") -> Coursework:
    file = folder / "whole.yaml"
    text = MACHINE.format(direction=direction, scheme=scheme, u=u, n_in=abs(u) * 160, extent=extent)
    file.write_text(text, encoding="utf-8")
    case = open_case(file)
    assert isinstance(case, Coursework)
    return case


def section(blocks: tuple[Block, ...], name: str) -> tuple[Block, ...]:
    return next((group for group in groups(blocks) if topic(group[0]) == name), ())


def senses(blocks: tuple[Block, ...]) -> dict[str, tuple[str, str]]:
    """Of each shaft its speed and its sense, as the table has them."""
    table = next(one for one in blocks if isinstance(one, Table) and one.key == "tab.shafts")
    rows = [[said(cell.inlines) for cell in row] for row in table.rows]
    return {name: (speed, sense) for name, speed, sense in rows}


def test_the_train_turns_the_crank_as_the_machine_says() -> None:
    """The train has −80 rpm against its driving shaft, the machine +80: the motor turns clockwise (−12 = 6·(−2))."""
    found = senses(section(built.document(FOLDER / "shaper-whole.yaml").blocks, "overview"))
    speeds = [(speed, sense.split()[0]) for speed, sense in found.values()]
    assert speeds[0] == ("80", "ngược")
    assert speeds[1] == ("960", "theo")
    assert speeds[2] == ("80", "ngược")
    assert speeds[-1] == ("80", "ngược")
    text = " ".join(text_of(built.document(FOLDER / "shaper-whole.yaml")).split())
    assert "n_r = −80" in text or "−80" in text
    assert "dấu trừ chỉ cho biết hai trục này quay ngược chiều nhau" in text


@pytest.mark.parametrize("direction", ["anticlockwise", "clockwise"])
def test_a_train_that_keeps_the_sense_and_a_cam_on_the_crank_turn_as_the_crank(direction: str, tmp_path: Path) -> None:
    """u = 9 > 0: motor and crank turn alike; the cam on the crank's shaft takes its sense, the other keeps its own."""
    case = coursework(tmp_path, direction)
    found = list(senses(section(case.document().blocks, "overview")).values())
    assert [sense for _, sense in found[:4]] == [direction] * 4
    assert [speed for speed, _ in found] == ["160", "1440", "160", "160", "80"]
    assert found[4][1] == "anticlockwise"
    cam = case.members[1].case.assignment.parameters
    assert cam.direction == direction


def test_a_train_of_another_speed_is_not_taken_for_the_crank_s_shaft() -> None:
    """Nothing says that it drives the machine: its shafts are told against each other."""
    driver = Shaft("driver", 10.0, -1, fixed=True, datum="n")
    train = Shaft("in", 90.0, 1, datum="n_in"), Shaft("out", 10.2, -1, share=0.01)
    loose = [one.sense for one in turning(PartShafts("T", train, {}), driver)]
    assert loose == [0, 0]
    within = [train[0], Shaft("out", 10.05, -1, share=0.01)]
    assert [one.sense for one in turning(PartShafts("T", within, {}), driver)] == [1, -1]
    # A driving shaft whose speed is the machine's own is the crank's.
    assert [one.sense for one in turning(PartShafts("T", train, {"n_in": "n"}), driver)] == [-1, 1]


def test_foreword_and_summary_know_all_parts() -> None:
    """With the numbers of the parts' own ledgers."""
    case, document = whole(), built.document(FOLDER / "shaper-whole.yaml")
    foreword, summary = (
        " ".join(
            " ".join(
                said(block.inlines) for block in section(document.blocks, name) if hasattr(block, "inlines")
            ).split()
        )
        for name in ("foreword", "overview")
    )
    for member in case.members:
        assert f"“{member.title}”" in foreword
        assert any(
            said(block.title) == f"{member.title}."
            for block in section(document.blocks, "overview")
            if isinstance(block, Section)
        )
    train, pair, cam = (member.case for member in case.members)
    ratio = float(train.ledger["train.total"].values[0])
    assert f"= −{abs(ratio):g}" in summary
    for ledger, id in ((pair.printed, "gears.x.1"), (pair.printed, "gears.x.2"), (pair.printed, "gears.a_w")):
        number = ledger.number(id)
        assert f"= {number.value:.{number.decimals or 0}f}".replace(".", ",").rstrip("0") in summary, id
    # 360 angles a degree: the greatest lies between two of them, flat.
    α = cam.solution.cam.sampled(36_000).alpha  # type: ignore[attr-defined]
    for extreme in (α.max(), -α.min()):
        assert f"{math.degrees(extreme):.2f}°".replace(".", ",") in summary


def test_symbols_that_are_explained_where_they_stand_are_not_listed_again() -> None:
    """Each symbol of a part is explained in its chapter or in the one table, which is less than a page and a half."""
    case, document = whole(), built.document(FOLDER / "shaper-whole.yaml")
    (table,) = [one for one in document.blocks if isinstance(one, Table) and one.key == "tab.symbols.parts"]
    assert len(table.rows) < 45
    listed = {symbol for row in table.rows for symbol in used_symbols([_alone(row)])}
    for member in case.members:
        letters, blocks = case.letters[member.name], member.document.blocks
        known, used = explained(blocks), used_symbols(blocks)
        for family in member.case.printed.families.values():
            if family.symbol in used and not family.hidden and not is_explained(family.symbol, known):
                shown = letters.get(family.symbol, family.symbol)
                assert shown in listed or not _has_words(member.case, family.id), family.id
            assert letters.get(family.symbol, family.symbol) not in listed or not is_explained(family.symbol, known)
    # Both wheels in one row.
    assert any(re.search(r"λ_1, λ_2", said(row[0].inlines)) for row in table.rows)


def _alone(row: tuple[object, ...]) -> Table:
    return Table((), (), (row,), (), "")  # type: ignore[arg-type]


def _has_words(case: object, id: str) -> bool:
    from reportgen.case.quantity_wording import phrase

    return bool(phrase(id, case.printed, case.words))  # type: ignore[attr-defined]


def test_a_short_report_says_the_senses_in_its_conclusion(tmp_path: Path) -> None:
    document = coursework(tmp_path, "clockwise", extent="short").document()
    assert not section(document.blocks, "overview")
    assert len(senses(section(document.blocks, "conclusion"))) == 5
