"""What is missing for a chapter: the list of the form leads from the smallest file to every chapter of the report."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from reportgen import catalogue
from reportgen.base.errors import Where
from reportgen.base.yaml_edit import without
from reportgen.base.yaml_source import MappingNode, read_source, read_text
from reportgen.base.yaml_values import at
from reportgen.case import Case, MachineAnalysis
from reportgen.case.missing_chapters import heading_of
from reportgen.cases import open_case
from reportgen.catalogue.declared_loads import pins
from reportgen.document import Section, plain
from reportgen.machine import Crank, Linkage, joints
from reportgen.machine.loads import carriers
from reportgen.page.drag_samples import Resident
from reportgen.page.form_fields import Form
from reportgen.page.missing_values import MissingRow, missing_rows
from reportgen.page.text_changes import changed_text
from reportgen.report.context import ReportContext
from tests.kinds import KINDS
from tests.lanes import matrix

VALUES = {
    r".*\bG\d?": "40 N",
    r".*\bm\d?": "4 kg",
    r".*\.drive\.J": "50 kg m2",
    r".*\bJ\d?": "0.1 kg m2",
    "parameters.planes.B": "400 mm",
    "parameters.other_drivers": "all",
    "parameters.flywheel.delta": "1/40",
    "report.listing": "true",
    "parameters.motion.drive.M0": "300 N m",
    "parameters.motion.drive.k": "10 N m s",
    "parameters.springs.0.c": "0.001 N/mm",
    "parameters.before": "[20, 40]",
    r"parameters.faces.\d.from": "-90 mm",
    r"parameters.faces.\d.to": "90 mm",
    "parameters.grade": "6.3 mm/s",
    "parameters.friction.pins.*rho": "0.1 mm",
    "parameters.balancing.counterweight.radius": "50 mm",
    "parameters.balancing.counterweight.rules": "max",
    "parameters.efficiency.outer": "0.97",
    "parameters.torque.M": "100 N m",
    "parameters.at": "45 deg",
    "parameters.n": "600 rpm",
    "parameters.bearings": "-100 mm, 500 mm",
    "parameters.mass": "50 kg",
    "parameters.limits.rise": "35 deg",
    "parameters.limits.return": "70 deg",
}
"""Sample values, by patterns of the places of their keys."""
LISTS = "parameters.bearings", "parameters.before", "parameters.balancing.counterweight.rules"
MOST_STEPS = 40
NO_LINKAGE = Linkage({}, Crank("A", "B", 1.0), ())


def smallest(kind: str) -> str:
    """The starter file of a kind without remarks, and without any key that it can do without."""
    text = bare(catalogue.sample(kind, "en"))
    for section in ("positions", "drawing", "parameters", "indicator"):
        top = read_text(text).top
        table = top.find(section) if isinstance(top, MappingNode) else None
        keys = [key.text for key, _ in table[1].entries] if table and isinstance(table[1], MappingNode) else []
        for where in ((section,), *((section, key) for key in keys)):
            less = bare(without(text, where)) if at(read_text(text).top, where) else text
            source = read_text(less, f"{kind}.yaml")
            assignment, faults = catalogue.assess(source, Path(f"{kind}.yaml"))
            if assignment is not None and not faults:
                text = less
    return text


def bare(text: str) -> str:
    return "".join(line for line in text.splitlines(keepends=True) if not line.lstrip().startswith("#"))


class Reader:
    """A file that is changed as by the buttons and fields of its form, with the case of its last valid state."""

    def __init__(self, folder: Path, text: str, kind: str) -> None:
        self.path, self.kind = folder / f"{Path(kind).name}.yaml", catalogue.kind(kind)
        self.case: Case | None = None
        self.path.write_text(text, encoding="utf-8")

    def rows(self) -> list[MissingRow]:
        """The rows of the list after the last change."""
        problems = catalogue.examine(self.path)
        if not any(problem.level == "error" for problem in problems):
            self.case = open_case(self.path)
        source = read_source(self.path)
        assert isinstance(source.top, MappingNode)
        chapters = self.case.missing_chapters if self.case else ()
        return missing_rows(chapters, problems, Form(self.kind, "en", source.top), source)

    def edit(self, asked: dict[str, Any]) -> None:
        text = self.path.read_text(encoding="utf-8")
        self.path.write_text(changed_text(text, asked["op"], tuple(asked["where"]), asked), encoding="utf-8")

    def set(self, where: Where, value: str) -> None:
        self.edit({"op": "set", "where": where, "value": value})


def followed(reader: Reader, row: MissingRow) -> None:
    """Follow the buttons of a row until the row is gone, as a reader would who types the sample values."""
    for _ in range(MOST_STEPS):
        now = next((now for now in reader.rows() if not now.chapters or set(now.chapters) & set(row.chapters)), None)
        if now is None:
            return
        for group in now.groups:
            fill(reader, min((key.where for key in group), key=lambda where: value_of(where) is None))
    raise AssertionError(reader.rows())


def value_of(where: Where) -> str | None:
    path = ".".join(map(str, where))
    return next((value for pattern, value in VALUES.items() if re.fullmatch(pattern, path)), None)


def fill(reader: Reader, where: Where) -> None:
    """Type a sample value at a place, or begin the table or list that is there, with names that the machine has."""
    case, path = reader.case, ".".join(map(str, where))
    asked: dict[str, Any] = {"op": "set", "where": list(where), "value": value_of(where)}
    linkage = case.analysis.machine.linkage if isinstance(case, MachineAnalysis) else NO_LINKAGE
    match path:
        case "parameters.faces":
            asked = {"op": "add", "where": list(where), "name": str(min(carriers(linkage))), "table": True}
        case "parameters.friction":
            pin = next(joint.point for joint in joints(linkage) if joint.kind == "R")
            asked = {"op": "add", "where": [*where, "pins"], "name": pin, "table": True}
        case "parameters.springs.0.link" | "parameters.masses.0.link":
            asked["value"] = "3"
        case "parameters.springs.0.at" | "parameters.masses.0.at":
            asked["value"] = min(pins(linkage)[3])
        case "parameters.springs.0.to":
            asked["value"] = min(linkage.ground)
        case "parameters.motion":
            # The starter files have too little inertia for any motion.
            fill(reader, (*where, "drive", "J"))
            fill(reader, (*where, "drive", "M0"))
            return
        case "parameters.efficiency" | "parameters.torque":
            fill(reader, (*where, "outer" if where[-1] == "efficiency" else "M"))
            return
        case "parameters.flywheel" | "parameters.balancing" | "parameters.limits":
            first = {"flywheel": "delta", "balancing": "counterweight.rules"}
            fill(reader, (*where, *first.get(str(where[-1]), "rise").split(".")))
            return
        case "parameters.springs" | "parameters.masses":
            asked = {"op": "add", "where": list(where)}
        case _ if path in LISTS:
            asked["list"] = True
    assert asked.get("value", "") is not None, path
    reader.edit(asked)


def headings(case: Case) -> list[str]:
    """The headings of a report; of a machine those of the sections that it is composed of, which takes less time."""
    if isinstance(case, MachineAnalysis) and case.assignment.kind != "slotted-lever":
        return [heading_of(section, case.places) for section in ReportContext(case).sections]
    document = case.document()
    return [plain(block.title, document.language) for block in document.blocks if isinstance(block, Section)]


@pytest.mark.parametrize("kind", matrix(sorted(KINDS), ("rotor",)))
def test_the_list_leads_to_every_chapter(kind: str, tmp_path: Path) -> None:
    """A machine that has a new load or topic is not drawn as the machine without it while its value is dragged."""
    least = smallest(kind)
    before = Reader(tmp_path, least, kind)
    rows = before.rows()
    drawn = Resident.of(before.case) if before.case else None
    for row in rows:
        reader = Reader(tmp_path, least, kind)
        followed(reader, row)
        assert catalogue.check(reader.path) == []
        case = open_case(reader.path)
        assert set(row.chapters) <= set(headings(case))
        is_of_machine = any(key.where[0] != "report" for group in row.groups for key in group)
        assert drawn is None or is_of_machine == (not drawn.sampled(case.assignment))


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_nothing_is_missing_in_a_starter_file(kind: str, tmp_path: Path) -> None:
    assert all(row.chapters and row.groups for row in Reader(tmp_path, catalogue.sample(kind, "en"), kind).rows())


def test_a_file_without_a_speed_misses_it_for_the_whole_report(tmp_path: Path) -> None:
    text = catalogue.sample("slotted-lever", "en")
    reader = Reader(tmp_path, without(text, ("parameters", "omega1")), "slotted-lever")
    row, *_ = reader.rows()
    assert not row.chapters
    assert [key.where for group in row.groups for key in group] == [("parameters", "n")]


def test_a_button_that_wants_a_flywheel_leads_to_the_keys_inside(tmp_path: Path) -> None:
    reader = Reader(tmp_path, smallest("slotted-lever"), "slotted-lever")
    (row,) = (row for row in reader.rows() if "Flywheel" in row.chapters)
    assert [key.where for key in row.groups[0]] == [("parameters", "flywheel")]
    assert ("parameters", "torque") in [key.where for key in row.groups[1]]
    reader.edit({"op": "add", "where": ["parameters"], "name": "flywheel", "table": True})
    reader.set(("parameters", "G3"), "40 N")
    (row,) = (row for row in reader.rows() if "Flywheel" in row.chapters)
    assert [[key.where for key in group] for group in row.groups] == [[("parameters", "flywheel", "delta")]]
    reader.set(("parameters", "flywheel", "delta"), "1/40")
    assert not any("Flywheel" in row.chapters for row in reader.rows())
