"""A reader who does not see a figure is told what it shows: from data, the same in every format."""

from __future__ import annotations

import cmath
import io
import math
import re
import zipfile
from collections.abc import Iterator
from html import unescape
from itertools import combinations
from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.languages import unit_names
from reportgen.base.template_folders import languages, search_path
from reportgen.base.units import Language
from reportgen.base.words import load_words
from reportgen.cases import open_case
from reportgen.document import Document, Figure, Plate
from reportgen.document.alt_text import MOST, figure_text, sentences
from reportgen.drawing import Arc, Arrow, Circle, Line, Pen, Polyline, Scene
from reportgen.drawing.charts import PENS
from reportgen.drawing.count_charts import bars, histogram
from reportgen.drawing.drawing_description import PaperLength, crossings
from reportgen.drawing.statistics_charts import intervals, scatter
from reportgen.sheets import drawing_sheets
from reportgen.writers import typst, typst_compiler
from tests.lanes import matrix
from tests.report import built

ROOT = Path(__file__).parents[2] / "assignments"
FILES = sorted(
    str(path.relative_to(ROOT)) for path in ROOT.rglob("*.yaml") if path.parent.name not in ("class-demo", "atlas")
)
LANGUAGES: tuple[Language, ...] = languages()
TELLING = [
    ("engine-twin-05.yaml", "vi"),
    ("four-bar-01.yaml", "en"),
    ("cam/roller-01.yaml", "en"),
    ("gears/pair-least-shift.yaml", "vi"),
    ("gears/train-double.yaml", "en"),
    ("rotor/rotor-two-planes.yaml", "vi"),
    ("engine-balance/inline-four.yaml", "en"),
    ("plane-motion/02.yaml", "vi"),
    ("friction/wedge.yaml", "en"),
    ("shaper-02.yaml", "zh"),
]
"""One of each kind of drawings; the others are for `make proof`."""
CASES = [
    (name, language)
    for number, name in enumerate(FILES)
    for turn, language in enumerate(LANGUAGES)
    if ROOT / name in built.OF_EACH_KIND or turn == number % 2 or (name, language) in TELLING
]
"""The first file of each kind in every language, all others alternately in Vietnamese and English."""
TWIN = "engine-twin-05.yaml"
GREY = 0.3
"""Strokes whose greys differ by more, of 0 to 1, are told apart in print."""
WIDER = 1.3
"""So many times as wide a stroke looks wider."""
LARGE = 2.0
"""Smaller circles (mm) are marks of points, no strokes."""


def document(name: str, language: Language) -> Document:
    return built.document(ROOT / name, language)


def drawings(name: str, language: Language) -> Iterator[tuple[Figure | Plate, Scene, str]]:
    """Each drawing of a report in its figure, with its text."""
    made = document(name, language)
    for block in made.blocks:
        if isinstance(block, Figure | Plate):
            for scene in block.scenes if isinstance(block, Figure) else (block.scene,):
                yield block, scene, figure_text(block, scene, made.words, language)


@pytest.mark.parametrize(("name", "language"), matrix(CASES, TELLING))
def test_every_drawing_tells_what_it_shows(name: str, language: Language) -> None:
    """More than its scale, in at most 600 characters, without the marks of plain formulas or of unfilled places."""
    told = list(drawings(name, language))
    assert told
    for block, scene, text in told:
        assert {fact.phrase for fact in scene.description} - {"scale"}, block.key
        assert 10 < len(text) <= MOST, block.key
        assert not re.search(r"[_^{}\n]|\d\.\d{9}|nan", text), text
        if block.number:
            assert block.number in text


@pytest.mark.parametrize(("name", "language"), matrix(CASES, TELLING))
def test_numbers_of_plans_are_those_of_their_arrows(name: str, language: Language) -> None:
    """The lengths (mm) and directions told are those of the named arrows on paper, one after the other.

    A step of a construction tells the arrows that it adds.
    """
    phrase, mm = re.escape(load_words(search_path(language))["told"]["arrow"]), unit_names(language).get("mm")
    for place, pattern in enumerate(("[^;:；：]+", rf"([\d.,]+) {mm}", r"([\d.,]+)°")):
        phrase = phrase.replace(rf"\{{{place}\}}", pattern)
    for block, scene, text in drawings(name, language):
        if not re.search(r"\bfig\.([vaR]|moments|unbalances)\b", block.key):
            continue
        drawn = [item for item in scene.items if isinstance(item, Arrow) and item.name and "×" not in item.name]
        measured = [(abs(way), math.degrees(cmath.phase(way))) for way in (item.end - item.start for item in drawn)]
        told = [tuple(float(part.replace(",", ".")) for part in pair) for pair in re.findall(phrase, text)]
        assert told or not drawn or "stages" in block.key, block.key
        if "stages" in block.key:
            measured = [next((arrow for arrow in measured if same(arrow, pair)), (math.nan, 0.0)) for pair in told]
        whole = len(text) < MOST - 100
        assert len(told) == len(measured) if whole else len(told) <= len(measured), block.key
        for pair, arrow in zip(told, measured, strict=False):
            assert same(arrow, pair), (block.key, pair, arrow)


def same(arrow: tuple[float, float], pair: tuple[float, ...]) -> bool:
    """Whether a length and a direction are told to their last digits: hundredths of a mm, tenths of a degree."""
    turned = math.remainder(arrow[1] - pair[1], 360)
    return abs(arrow[0] - pair[0]) <= 0.005 + 1e-9 and abs(turned) <= 0.05 + 1e-9


def test_the_plan_of_the_reference_engine_is_told() -> None:
    """b stands 28.27 mm below the pole at position 4, as the report prints it."""
    block, _, text = next(one for one in drawings(TWIN, "en") if one[0].key == "fig.v.4")
    assert text.startswith(f"Figure {block.number}. Velocity plan at position 4: ")
    assert "v B 28.27 mm at 270°" in text


def test_extremes_of_a_chart_are_those_of_its_curve() -> None:
    """The highest point of the line on paper, read at the frame between the ends of the axes, is the value told."""
    _, scene, text = next(one for one in drawings(TWIN, "en") if one[0].key == "fig.M")
    ends = re.search(r"across .* from (\S+)° to (\S+)°; upwards .* from (\S+) to (\S+); ", text)
    told = re.search(r"greatest (\S+) at (\S+)°, least (\S+) at (\S+)°", text)
    assert ends is not None
    assert told is not None
    x0, x1, y0, y1 = (float(part.replace("−", "-")) for part in ends.groups())
    frame = next(item for item in scene.items if isinstance(item, Polyline) and item.closed)
    low, high = frame.points[0], frame.points[2]
    curve = [at for item in scene.items if isinstance(item, Polyline) and item.stroke == PENS[0] for at in item.points]
    for at, value, place in (
        (max(curve, key=lambda p: p.imag), told[1], told[2]),
        (min(curve, key=lambda p: p.imag), told[3], told[4]),
    ):
        y = y0 + (y1 - y0) * (at - low).imag / (high - low).imag
        x = x0 + (x1 - x0) * (at - low).real / (high - low).real
        # A thousandth of the axis is a twentieth of a millimetre on paper.
        assert y == pytest.approx(float(value.replace("−", "-")), abs=(y1 - y0) / 1000)
        assert x == pytest.approx(float(place), abs=(x1 - x0) / 200)


def test_zeros_lie_between_points() -> None:
    """The chord of y = x² − 2 from 1 to 2 meets zero at 4/3; y = x does so at one of its points."""
    assert crossings([-2, -1, 0, 1, 2], [2, -1, -2, -1, 2]) == pytest.approx([-4 / 3, 4 / 3])
    assert crossings([-1, 0, 1], [-1, 0, 1]) == [0.0]
    assert crossings([0, 1], [1, 2]) == []
    # A radius of curvature that goes through infinity changes its sign, but is never nothing.
    assert crossings([0, 1, 2], [1, math.nan, -1]) == []


def test_what_has_no_room_is_told_by_the_table() -> None:
    """A text that would be too long ends between two facts, with the number of the table of its name."""
    block, _, text = next(one for one in drawings(TWIN, "vi") if one[0].key == "fig.lever.4")
    assert text.endswith(f"; phần còn lại ở Bảng {block.rest}")
    tables = [one.number for one in document(TWIN, "vi").blocks if getattr(one, "key", "") == "tab.lever.4"]
    assert [block.rest] == tables


def test_pdf_page_and_word_tell_the_same() -> None:
    """The PDF has a Figure with this Alt for each drawing, the page an image, the Word file a picture."""
    pymupdf = pytest.importorskip("pymupdf")
    name, language = "slider-crank-01.yaml", "en"
    texts = [text for _, _, text in drawings(name, language)]
    with pymupdf.open(stream=typst_compiler.compile(typst.write(document(name, language)))) as pdf:
        assert alternatives(pdf) == texts
    page = api.page_files(ROOT / name, "typst", language)
    html = next(iter(page.values())).decode()
    assert [unescape(one) for one in re.findall(r'<svg class="scene" role="img" aria-label="([^"]*)"', html)] == texts
    graphs = [unescape(one) for one in re.findall(r'<svg role="img" aria-label="([^"]*)"', html)]
    assert graphs
    for text in graphs:
        assert re.search(r": across φ .*greatest .* at ", text)
        assert not re.search(r"[_^]", text)
    (word,) = api.word_files(ROOT / name, "typst", language).values()
    with zipfile.ZipFile(io.BytesIO(word)) as package:
        body = package.read("word/document.xml").decode()
    assert [unescape(one) for one in re.findall(r'<wp:docPr [^>]*descr="([^"]*)"', body)] == texts


def alternatives(pdf: object) -> list[str]:
    """The Alt of each Figure of a PDF in the order of its structure."""
    found: list[str] = []

    def kids(xref: int) -> list[int]:
        kind, value = pdf.xref_get_key(xref, "K")  # type: ignore[attr-defined]
        return [int(one) for one in re.findall(r"(\d+) 0 R", value)] if kind in ("array", "xref") else []

    def walk(xref: int) -> None:
        if pdf.xref_get_key(xref, "S")[1] == "/Figure":  # type: ignore[attr-defined]
            kind, value = pdf.xref_get_key(xref, "Alt")  # type: ignore[attr-defined]
            assert kind == "string", xref
            assert not kids(xref), "labels of a told figure have no tags of their own"
            found.append(value)
            return
        for inner in kids(xref):
            walk(inner)

    root = int(pdf.xref_get_key(pdf.pdf_catalog(), "StructTreeRoot")[1].split()[0])  # type: ignore[attr-defined]
    walk(root)
    return found


def test_each_plate_of_a_sheet_is_told() -> None:
    """A figure a plate, which begins with its name; frame and title block say what is written in them."""
    pymupdf = pytest.importorskip("pymupdf")
    case = open_case(ROOT / "rotor" / "rotor-two-planes.yaml", "en")
    for sheet in drawing_sheets(case):
        names = {part.name.partition(".")[0] for part in sheet.parts}
        with pymupdf.open(stream=api.typeset_sheet(sheet, case.title, case.assignment, case.words["told"])) as pdf:
            told = alternatives(pdf)
        silent = [part for part in sheet.parts if not part.scene.description]
        assert len(told) == len(names) - len({part.name for part in silent})
        assert all(told)
        for part in sheet.parts:
            lengths = [fact.values[1] for fact in part.scene.description if fact.phrase == "arrow"]
            drawn = [abs(item.end - item.start) for item in part.scene.items if isinstance(item, Arrow) and item.name]
            assert [one.value for one in lengths if isinstance(one, PaperLength)] == pytest.approx(drawn)


def test_every_phrase_has_words() -> None:
    """What any drawing may say, in samples or not, has a phrase in each language, with as many places."""
    source = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT.parent / "reportgen").rglob("*.py"))
    said = set(re.findall(r'\b[fF]act\(\s*"([a-z-]+)"', source))
    en = load_words(search_path("en"))["told"]
    assert len(said) > 50
    assert said <= en.keys()
    for language in LANGUAGES:
        own = load_words(search_path(language))["told"]
        assert own.keys() == en.keys()
        for name in en:
            assert sorted(re.findall(r"\{\d\}", own[name])) == sorted(re.findall(r"\{\d\}", en[name])), name


def test_diagrams_of_a_class_are_told() -> None:
    """Counts, means and points as they are given, with the names of the axes."""
    words = load_words(search_path("en"))["told"]

    def told(scene: Scene) -> list[str]:
        return list(sentences(scene.description, words, "en"))

    assert told(bars(["signs", "scale"], [3, 1], "errors")) == ["errors:", "signs 3", "scale 1"]
    assert told(histogram([2, 0, 5], [0, 5, 8, 10], "mark", "students")) == [
        "students by mark:",
        "from 0 to 5: 2",
        "from 8 to 10: 5",
    ]
    assert told(intervals(["a"], [7.25], [0.5], [0, 5, 10], "mark"))[1:] == ["a 7.25 ± 0.5"]
    assert told(scatter([1], [0.5], [0, 1], [0, 1], "x", "y"))[2:] == ["points: 1", "(1; 0.5)"]


# --- print without colour ---------------------------------------------------------------------------


@pytest.mark.parametrize("name", matrix(FILES, [name for name, _ in TELLING]))
def test_strokes_differ_without_colour(name: str) -> None:
    """Of two strokes of one kind in a drawing whose colours become one grey, width or dashes differ."""
    for block, scene, _ in drawings(name, api.load(ROOT / name).language):
        pens = dict.fromkeys(stroke for item in scene.items if (stroke := stroke_of(item)) is not None)
        for (kind, pen), (another, other) in combinations(pens, 2):
            if kind == another and pen.colour != other.colour and (coloured(pen) or coloured(other)):
                widths = sorted((pen.width, other.width))
                grey = abs(lightness(pen) - lightness(other)) > GREY
                assert grey or pen.dash != other.dash or widths[1] >= WIDER * widths[0], (block.key, kind, pen, other)


def stroke_of(item: object) -> tuple[str, Pen] | None:
    """What kind of stroke an item is, and its pen."""
    match item:
        case Arrow(stroke=pen):
            return "arrow", pen
        case Arc(stroke=pen, head=head):
            return ("turning arrow" if head else "curve"), pen
        case Line(stroke=pen):
            return "line", pen
        case Circle(radius=radius, stroke=Pen() as pen) if radius > LARGE:
            return "curve", pen
        case Polyline(stroke=Pen() as pen, closed=closed):
            return ("outline" if closed else "curve"), pen
    return None


def parts_of(pen: Pen) -> list[float]:
    return [int(pen.colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]


def lightness(pen: Pen) -> float:
    """The grey (0 to 1) that a colour is printed as (ITU-R BT.601)."""
    return sum(share * part for share, part in zip((0.299, 0.587, 0.114), parts_of(pen), strict=True))


def coloured(pen: Pen) -> bool:
    return max(parts_of(pen)) - min(parts_of(pen)) > 0.03
