"""A ruler on the print and a distance query in CAD give value/μ; both files draw the same."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from reportgen.drawing import Arrow
from reportgen.drawing.sheet import DrawingSheet
from reportgen.sheets import dxf
from reportgen.writers import typst
from tests.lanes import matrix, proof
from tests.sheets.laid import MACHINES, ROOT, Laid, laid, plates

ezdxf = pytest.importorskip("ezdxf")
pymupdf = pytest.importorskip("pymupdf")
pages = pytest.importorskip("tests.report.pages")

TELLING = ("shaper-02", "linkage-slide")
"""A crank with a sliding block and a rod, and a sliding driver; the drawings of the others are for `make proof`."""
FORCED = tuple(name for name in MACHINES if name != "slotted-lever-01")
"""Machines that forces act on."""
WRITTEN, SHARE = 0.05, 1e-3
"""Lengths are measured to 0.01 mm (half of that in each of some steps), and what is laid off has five figures."""
CAD = 1e-4
"""Places in a DXF file are written to a millionth of a millimetre."""
RULER = 0.02
"""Millimetres: places in the PDF are written to a thousandth, its heads to the angle of the arrow."""


@cache
def in_cad(name: str, number: int) -> Any:
    return ezdxf.read(io.StringIO(dxf.write_sheet(laid(name, "A1").sheets[number], "vi").decode()))


def lengths(name: str) -> Iterator[tuple[str, str, float, list[float]]]:
    """(plate, place, μ as printed, the lengths of its lines in CAD) of the plates of all sheets."""
    for number in range(len(laid(name, "A1").sheets)):
        for plate, group in in_cad(name, number).groups:
            texts = [entity.text for entity in group if entity.dxftype() == "MTEXT"]
            lines = [entity for entity in group if entity.dxftype() == "LINE"]
            scale = next((found for text in texts if (found := re.search(r"^μ.*? = ([\d,]+) ", text))), None)
            if scale:
                found = [line.dxf.start.distance(line.dxf.end) for line in lines]
                word = laid(name, "A1").case.words["table"]["position"]
                place = next((text for text in texts if re.search(rf"\b{word} \w+$", text, re.IGNORECASE)), "")
                yield plate, place, float(scale[1].replace(",", ".")), found


@pytest.mark.parametrize("name", matrix(MACHINES, TELLING))
def test_every_velocity_and_acceleration_measures_its_value_over_the_scale(name: str) -> None:
    motion, measured = laid(name, "A1").case.analysis.motion, 0
    heads = {"v": "velocity", "a": "acceleration"}
    named = titles(laid(name, "A1"))
    for plate, place, scale, found in lengths(name):
        for what, title in heads.items():
            if named[plate] != laid(name, "A1").case.words["plates"][title]:
                continue
            k = position(laid(name, "A1"), place)
            for point, rates in motion.points.items():
                length = abs(complex(getattr(rates, what)[k])) / scale
                if length > 1.0 and point in drawn(laid(name, "A1"), plate):
                    assert min(abs(one - length) for one in found) < WRITTEN + SHARE * length, (plate, point)
                    measured += 1
    assert measured > 8


@pytest.mark.parametrize("name", matrix(FORCED, TELLING))
def test_every_reaction_measures_its_value_over_the_scale(name: str) -> None:
    of = laid(name, "A1")
    words, analysis, measured = of.case.words, of.case.analysis, 0
    named = titles(of)
    groups = {words["figure"]["group"].format(i=one.name[0], j=one.name[1]): one for one in of.case.polygons[:-1]}
    for plate, place, scale, found in lengths(name):
        polygon = groups.get(place.partition(", ")[0])
        if named[plate] != words["plates"]["forces"] or polygon is None:
            continue
        k = position(of, place)
        for edge in (*polygon.edges, *polygon.reads):
            force = analysis.forces.reactions.get(edge.name)
            if force is not None and (length := abs(complex(force.force[k])) / scale) > 1.0:
                assert min(abs(one - length) for one in found) < WRITTEN + SHARE * length, (plate, edge.name)
                measured += 1
    assert measured > 4


# One has a sliding driver, the cranks of the other are drawn as one line from pin to pin.
@pytest.mark.parametrize(
    "name", matrix([name for name in MACHINES if name not in ("linkage-slide", "engine-twin-05")], TELLING[:1])
)
def test_the_crank_is_drawn_to_scale_at_every_position(name: str) -> None:
    of = laid(name, "A1")
    named, driver = titles(of), of.case.analysis.machine.linkage.driver
    (plan,) = [one for one in lengths(name) if named[one[0]] == of.case.words["plates"]["positions"]]
    _, _, scale, found = plan
    drawn = [one for one in found if abs(one - driver.length / scale) < CAD * one]
    assert len(drawn) >= of.case.analysis.machine.count


def titles(of: Laid) -> dict[str, str]:
    """The name of each plate, as its heading has it."""
    found = {}
    for sheet in of.sheets:
        for part in plates(sheet):
            heads = [str(getattr(item, "content", "")) for item in part.scene.items]
            found[part.name] = next(head for head in heads if head.startswith(f"{part.name}. ")).split(". ", 1)[1]
    return found


def position(of: Laid, place: str) -> int:
    """The index of a position by its label."""
    label = place.rpartition(" ")[2]
    machine = of.case.analysis.machine
    return next(k for k in range(machine.positions) if str(machine.position(k + 1)) == label)


def drawn(of: Laid, plate: str) -> set[str]:
    """The names of the arrows of a plate: those of points, whose own velocities or accelerations they are."""
    part = next(part for sheet in of.sheets for part in plates(sheet) if part.name == plate)
    return {item.name for item in part.scene.items if isinstance(item, Arrow)}


@pytest.mark.parametrize("name", matrix(MACHINES, TELLING))
def test_all_arrows_are_as_long_on_paper_as_in_cad(name: str) -> None:
    found = laid(name, "A1")
    for number, sheet in enumerate(found.sheets):
        with pymupdf.open(stream=typst.compile(typst.write_sheet(sheet, "", "vi")), filetype="pdf") as pdf:
            assert pdf.page_count == 1
            size = pdf[0].rect
            assert abs(size.width / pages.MM - sheet.width) < 0.1
            assert abs(size.height / pages.MM - sheet.height) < 0.1
            on_paper = list(pages.arrows(pages.Page(pdf[0])))
        expected = [abs(item.end - item.start) for item in arrows(sheet)]
        assert len(on_paper) == len(expected)
        assert all(abs(one - other) < RULER for one, other in zip(on_paper, expected, strict=True))
        in_file = cad_arrows(in_cad(name, number))
        assert len(in_file) == len(expected)
        assert all(abs(one - other) < CAD for one, other in zip(in_file, expected, strict=True))


def arrows(sheet: DrawingSheet) -> Iterator[Arrow]:
    for part in sheet.parts:
        for item in part.scene.items:
            if isinstance(item, Arrow) and abs(item.end - item.start) > 0:
                yield item


def cad_arrows(document: Any) -> list[float]:
    """Lengths of the lines that end in an arrowhead, in the order of the file."""
    found, before = [], None
    for entity in document.modelspace():
        if entity.dxftype() == "INSERT" and entity.dxf.name == "ARROWHEAD" and before.dxftype() == "LINE":
            assert entity.dxf.insert.distance(before.dxf.end) < CAD
            found.append(before.dxf.start.distance(before.dxf.end))
        before = entity
    return found


@pytest.mark.parametrize("name", matrix(MACHINES[:4], ["four-bar-01"]))
def test_the_file_is_sound_and_shows_the_whole_sheet(name: str) -> None:
    from ezdxf.addons.drawing import Frontend, RenderContext
    from ezdxf.addons.drawing.recorder import Recorder

    document, sheet = in_cad(name, 0), laid(name, "A1").sheets[0]
    audit = document.audit()
    assert (audit.errors, audit.fixes) == ([], [])
    assert document.header["$INSUNITS"] == 4
    assert {group for group, _ in document.groups} == {part.name for part in sheet.parts}
    # Drawn again by the library's own renderer it has the size of the paper.
    recorder = Recorder()
    Frontend(RenderContext(document), recorder).draw_layout(document.modelspace())
    box = recorder.player().bbox()
    assert abs(box.size.x - sheet.width) < 0.01
    assert abs(box.size.y - sheet.height) < 0.01
    # The paper-space page shows all of model space, 1:1.
    (window,) = document.layout("Layout1").query("VIEWPORT[id>1]")
    assert window.dxf.view_height == window.dxf.height == sheet.height


@proof
def test_the_same_sheet_gives_the_same_bytes() -> None:
    sheet = laid("four-bar-01", "A1").sheets[0]
    assert dxf.write_sheet(sheet, "vi") == dxf.write_sheet(sheet, "vi")
    assert typst.compile(typst.write_sheet(sheet, "", "vi")) == typst.compile(typst.write_sheet(sheet, "", "vi"))


@proof
def test_each_process_writes_the_same_file(tmp_path: Path) -> None:
    """The order of a set is another one in each process."""
    file, written = ROOT / "assignments" / "slider-crank-01.yaml", set()
    for seed in ("1", "2"):
        command = (sys.executable, "-m", "reportgen.cli", "sheet", str(file), "--format", "dxf", "--out", seed)
        subprocess.run(command, cwd=tmp_path, env={**os.environ, "PYTHONHASHSEED": seed}, check=True)
        written.add((tmp_path / seed / file.stem / "sheet-1.dxf").read_bytes())
    assert len(written) == 1
