"""A ruler on the print and a distance query in CAD give the millimetres that the report prints."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import chain, combinations
from pathlib import Path
from typing import Any

import pytest

from reportgen.base.languages import DrawingSetting
from reportgen.base.template_folders import search_path
from reportgen.base.words import load_words
from reportgen.derivation.equation_sides import image
from reportgen.drawing import Arrow
from reportgen.drawing.drawing_sheet import DrawingSheet
from reportgen.formula import ids
from reportgen.report.context import ReportContext
from reportgen.report.plan_figures import motion_construction
from reportgen.sheets import dxf
from reportgen.writers import typst, typst_compiler
from tests.lanes import matrix, proof
from tests.report import built
from tests.sheets.laid import MACHINES, ROOT, laid, plates

ezdxf = pytest.importorskip("ezdxf")
pymupdf = pytest.importorskip("pymupdf")
pages = pytest.importorskip("tests.report.pages")

FIRST = [path.stem for path in built.TYPESET]
"""The first file of each kind."""
TELLING = ("shaper-02", "linkage-slide")
"""A crank with a sliding block and a rod, and a sliding driver; the others are for `make proof`."""
FORCED = tuple(name for name in MACHINES if name not in ("slotted-lever-01", "four-bar-02"))
"""Machines that forces act on."""
PHRASES = load_words(search_path("vi"))["told"]
PRINTED = 0.01
"""What is measured differs from what is printed by less, mm."""
CAD = 1e-4
"""Places in a DXF file are written to a millionth of a millimetre."""
RULER = 0.02
"""Millimetres: places in the PDF are written to a thousandth, its heads to the angle of the arrow."""
BY_RATIO = {
    ("engine-single-I", "drawn.BC"): 0.01,
    ("engine-friction", "drawn.BC"): 0.01,
    ("engine-single-V", "drawn.BC"): 0.03,
    ("engine-single-VI", "drawn.BC"): 0.1,
}
"""What rounding makes of a rod (mm) that follows from R/λ of four digits, half a thousandth of 159 mm at most, or
from an angle: θ = 6.923° of variant V prints as 6.92°, which makes 136.49 mm of 136.465."""
DRAWN = 1.0
"""A shorter arm (mm) is hidden by the point that it is taken about."""


@dataclass(frozen=True)
class Group:
    """A plate or one of its scenes in CAD: its texts, its lines, and its named vectors, as measured there."""

    texts: tuple[str, ...]
    lines: tuple[float, ...]
    places: tuple[complex, ...]
    vectors: Mapping[str, complex]


@cache
def in_cad(name: str, number: int, every: bool = False) -> Any:
    return ezdxf.read(io.StringIO(dxf.write_sheet(laid(name, "A1", every).sheets[number], "vi").decode()))


@cache
def groups(name: str, every: bool) -> Mapping[str, Group]:
    """The groups of all sheets of an assignment, called by the numbers of their plates and scenes."""
    found: dict[str, Group] = {}
    for number in range(len(laid(name, "A1", every).sheets)):
        listed = dict(in_cad(name, number, every).groups)
        for called, entities in listed.items():
            lines = [entity for entity in entities if entity.dxftype() == "LINE"]
            ends = [complex(place.x, place.y) for line in lines for place in (line.dxf.start, line.dxf.end)]
            corners = [
                complex(*place[:2]) for one in entities if one.dxftype() == "LWPOLYLINE" for place in one.get_points()
            ]
            middles = [complex(one.dxf.center.x, one.dxf.center.y) for one in entities if one.dxftype() == "CIRCLE"]
            own = {vector: of for vector, of in listed.items() if vector.startswith(f"{called} ")}
            found[called] = Group(
                tuple(entity.plain_text() for entity in entities if entity.dxftype() == "MTEXT"),
                tuple(abs(end - start) for start, end in zip(ends[::2], ends[1::2], strict=True)),
                (*ends, *corners, *middles),
                {vector.removeprefix(f"{called} "): drawn_vector(of) for vector, of in own.items()},
            )
    return found


def drawn_vector(group: Any) -> complex:
    """The shaft of an arrow from its start to its tip."""
    line = next(entity for entity in group if entity.dxftype() == "LINE")
    way = line.dxf.end - line.dxf.start
    return complex(way.x, way.y)


def scenes(name: str, every: bool, title: str) -> Iterator[tuple[Group, Group]]:
    """The scenes of all plates of a title, each with its plate's head."""
    found = groups(name, every)
    wanted = laid(name, "A1").case.words["plates"][title]
    for number, head in found.items():
        if any(re.fullmatch(rf"\d+\. {re.escape(wanted)}", text) for text in head.texts):
            yield from ((head, one) for part, one in found.items() if re.fullmatch(rf"{number}\.\d+", part))


def position(name: str, *told: Group) -> int:
    """The number of the position that a head or a caption names."""
    machine, word = laid(name, "A1").case.analysis.machine, laid(name, "A1").case.words["table"]["position"]
    texts = chain.from_iterable(one.texts for one in told)
    label = next(found[1] for text in texts if (found := re.search(rf"{word} (\w+)$", text, re.IGNORECASE)))
    return next(k for k in range(1, machine.positions + 1) if str(machine.position(k)) == label)


@pytest.mark.parametrize(("name", "every"), matrix(
    [(name, every) for name in MACHINES for every in ((False, True) if name in FIRST else (True,))],
    [("linkage-slide", True)],
))  # fmt: skip
def test_segments_of_velocities_and_accelerations_are_those_printed(name: str, every: bool) -> None:
    """On the worked plans, and where there is every plan at all positions; a segment goes from point to point."""
    case, measured = laid(name, "A1").case, 0
    ledger = case.printed
    for what, title in (("v", "velocity"), ("a", "acceleration")):
        shown = [*scenes(name, every, title), *(scenes(name, every, f"{title}-plates") if every else ())]
        assert shown
        # The report computes the segments of some points that it does not draw, as of the crank's mass centre.
        drawn = {
            found["corner"]
            for id in motion_construction(ReportContext(case), what).corners
            if (found := ids.plan_point.read(id))
        }
        for head, plan in shown:
            k = position(name, plan, head)
            points = {"p": 0j, **{image(point): vector for point, vector in plan.vectors.items()}}
            for id in ledger.families:
                if (
                    (ends := ids.segment.read(id))
                    and ends["what"] == what
                    and {ends["start"], ends["end"]} <= {"p", *drawn}
                ):
                    start, end = (points.get(ends[one], 0j) for one in ("start", "end"))
                    vectors, found = 1 if ends["start"] == "p" else 2, abs(end - start)
                elif what == "a" and (part := ids.relative_segment.read(id)):
                    letter = {"t": "τ"}.get(part["part"], part["part"])
                    vectors, found = 1, abs(plan.vectors.get(f"{letter}{part['relative']}", 0j))
                else:
                    continue
                # From one vector's end to another's both are rounded.
                assert abs(found - ledger.number(id, k).value) < vectors * PRINTED + CAD, (id, k)
                measured += 1
    assert measured > 4


@pytest.mark.parametrize("name", matrix(FORCED, TELLING))
def test_segments_of_force_plans_are_those_printed(name: str) -> None:
    """Of each group at the worked positions; a plan of forces on one line is not drawn."""
    case = laid(name, "A1").case
    ledger, words, measured = case.printed, case.words["figure"], 0
    for head, plan in scenes(name, False, "forces"):
        k = position(name, head)
        names = [polygon.name for polygon in case.polygons[:-1]]
        called = {words["group"].format(links=words["between_links"].join(name)): name for name in names}
        group = next((one for place, one in called.items() if any(place in text for text in head.texts)), "1")
        for id, family in ledger.families.items():
            if (found := ids.force_segment.read(id)) and found["group"] == group:
                segment = abs(plan.vectors.get(family.symbol.base, plan.vectors.get(family.symbol.base[::-1], 0j)))
                assert abs(segment - ledger.number(id, k).value) < PRINTED + CAD, (id, k)
                measured += 1
    assert measured > 4


@pytest.mark.parametrize("name", matrix(FORCED, TELLING))
def test_arms_are_those_printed(name: str) -> None:
    """About pins on the separated links, about the pole on the lever."""
    case = laid(name, "A1").case
    ledger, found = case.printed, {}
    for title in ("bodies", "lever"):
        for head, scene in scenes(name, False, title):
            for called, vector in scene.vectors.items():
                if called.startswith("h "):
                    for force in called.split()[1:]:
                        found.setdefault((title, force, position(name, head)), []).append(abs(vector))
    arms = 0
    for id in ledger.families:
        lever = ids.lever_arm.read(id)
        arm = lever or ids.arm.read(id)
        for k in ReportContext(case).worked_forces if arm else ():
            size = abs(ledger.number(id, k).value)
            if size > DRAWN:
                drawn = found.get(("lever" if lever else "bodies", ledger[id].of, int(k)), [])
                assert any(abs(one - size) < PRINTED + CAD for one in drawn), (id, k, size, drawn)
                arms += 1
    assert arms


@pytest.mark.parametrize("name", matrix(MACHINES, TELLING))
def test_links_are_drawn_as_long_as_printed(name: str) -> None:
    """From joint to joint on the position plan, to mass centres on the scheme or the separated links.

    The mechanism is drawn as it is given; a rod that is printed as R/λ has the digits of a printed λ.
    """
    ledger = laid(name, "A1").case.printed
    shown = [*scenes(name, False, "positions"), *scenes(name, False, "bodies"), *scenes(name, False, "scheme")]
    lengths = [abs(one - other) for _, scene in shown for one, other in combinations(dict.fromkeys(scene.places), 2)]
    for id, family in ledger.families.items():
        if ids.drawn.read(id) and len(family.values) == 1:
            size, rounding = ledger.number(id).value, BY_RATIO.get((name, id), 0.0)
            assert any(abs(one - size) < PRINTED + CAD + rounding for one in lengths), (id, size)


@proof
@pytest.mark.parametrize("name", MACHINES)
def test_distances_of_instant_centres_are_those_printed(name: str) -> None:
    ledger = laid(name, "A1").case.printed
    for head, scene in scenes(name, True, "centres"):
        places = [*dict.fromkeys(scene.places)]
        lengths = [abs(one - other) for one, other in combinations(places, 2)]
        assert lengths
        k = position(name, head)
        for id in ledger.families:
            if ids.centre_distance.read(id) and (size := ledger.number(id, k).value) > 0:
                assert any(abs(one - size) < PRINTED + CAD for one in lengths), (id, size)


@pytest.mark.parametrize("name", matrix([*FIRST, *TELLING], TELLING[:1]))
def test_all_arrows_are_as_long_on_paper_as_in_cad(name: str) -> None:
    for number, sheet in enumerate(laid(name, "A1").sheets):
        source = typst.write_sheet(sheet, "", "vi", PHRASES)
        with pymupdf.open(stream=typst_compiler.compile(source), filetype="pdf") as pdf:
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


@pytest.mark.parametrize("name", matrix([*MACHINES[:11], "four-bar-01"], ["four-bar-01"]))
def test_the_file_is_sound_and_shows_the_whole_sheet(name: str) -> None:
    from ezdxf.addons.drawing import Frontend, RenderContext
    from ezdxf.addons.drawing.recorder import Recorder

    document, sheet = in_cad(name, 0), laid(name, "A1").sheets[0]
    audit = document.audit()
    assert (audit.errors, audit.fixes) == ([], [])
    assert document.header["$INSUNITS"] == 4
    assert {group for group, _ in document.groups} >= {part.name for part in plates(sheet)}
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
    assert typst_compiler.compile(typst.write_sheet(sheet, "", "vi", PHRASES)) == typst_compiler.compile(
        typst.write_sheet(sheet, "", "vi", PHRASES)
    )


@proof
def test_each_process_writes_the_same_file(tmp_path: Path) -> None:
    """The order of a set is another one in each process."""
    file, written = ROOT / "assignments" / "slider-crank-01.yaml", set()
    for seed in ("1", "2"):
        command = (sys.executable, "-m", "reportgen.cli", "sheet", str(file), "--format", "dxf", "--out", seed)
        subprocess.run(command, cwd=tmp_path, env={**os.environ, "PYTHONHASHSEED": seed}, check=True)
        written.add((tmp_path / seed / file.stem / "sheet-1.dxf").read_bytes())
    assert len(written) == 1


def test_the_letters_for_librecad_are_there() -> None:
    """The shipped font has all of Vietnamese and the Greek and signs of formulas; LibreCAD draws nothing for others."""
    text = (ROOT / "templates" / "frames" / "letters" / f"{DrawingSetting().style}.lff").read_text(encoding="utf-8")
    has = {chr(int(code, 16)) for code in re.findall(r"^\[([0-9a-f]{4,5})\]", text, re.MULTILINE)}
    vowels = [
        unicodedata.normalize("NFC", base + tone)
        for base in "aăâeêioôơuưy"
        for tone in ("", *"\u0300\u0301\u0303\u0309\u0323")
    ]
    letters = "".join([*vowels, "đ", "αβγδεηθλμνξπρστφψω"])
    assert set(letters + letters.upper() + "′−·°≡–×²³") <= has | set("\u039c")
