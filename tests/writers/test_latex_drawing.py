"""Scenes in the PDF that LaTeX makes: arrow tips, labels at their anchors, pens."""

from __future__ import annotations

import pymupdf
import pytest

from reportgen.base.records import replace
from reportgen.document import Figure
from reportgen.drawing import Arc, Arrow, Circle, Hatch, Label, Line, Pen, Polyline, Scene
from reportgen.writers.latex_math import LatexFormulas
from reportgen.writers.scene_source import paint_latex
from tests.writers import sample
from tests.writers.pages import MM, by_latex, needs_tex


def drawn(scene: Scene) -> tuple[pymupdf.Page, complex]:
    """The page with one scene alone, and the scene's origin on it in points (y up)."""
    frame = Polyline(
        (0j, complex(scene.width), complex(scene.width, scene.height), 1j * scene.height),
        Pen(0.1, "#00ff00"),
        closed=True,
    )
    page = by_latex(Figure((replace(scene, items=(frame, *scene.items)),)))[0]
    (box,) = (path["rect"] for path in page.get_drawings() if path.get("color") == (0, 1, 0))
    return page, complex(box.x0, page.rect.height - box.y1)


@needs_tex
def test_arrow_tips_lie_where_the_scene_says() -> None:
    scene = sample.star()
    page, origin = drawn(scene)
    heads = [path for path in page.get_drawings() if path["type"] == "f"]
    arrows = [item for item in scene.items if isinstance(item, Arrow)]
    assert len(heads) == len(arrows)
    for arrow, head in zip(arrows, heads, strict=True):
        tip = head["items"][0][1]
        at = (complex(tip.x, page.rect.height - tip.y) - origin) / MM
        # 0.1 mm is what a ruler shows; the operators carry 0.001 mm.
        assert abs(at - arrow.end) < 0.1, arrow.name


@needs_tex
def test_labels_stand_at_their_anchors() -> None:
    anchors = ("left", "right", "center", "top", "bottom")
    items = tuple(Label(complex(30, 15 * row), "HHH", anchor) for row, anchor in enumerate(anchors, 1))
    page, origin = drawn(Scene(60, 90, (*items, Label(50 + 40j, "TTT", turn=90))))
    spans = [
        span
        for block in page.get_text("dict")["blocks"]
        for line in block["lines"]
        for span in line["spans"]
        if span["text"] == "HHH"
    ]
    found = {}
    for span in spans:
        x0, _, x1, _ = ((x - origin.real) / MM for x in span["bbox"])
        base = (page.rect.height - span["origin"][1] - origin.imag) / MM
        found[round(base / 15)] = (x0, x1, base)
    left, right, centre, top, bottom = (found[row] for row in range(1, 6))
    # The boxes are those of TeX; a PDF's widths are rounded to a thousandth of the size, here 0.01 mm.
    assert left[0] == pytest.approx(30, abs=0.02)
    assert right[1] == pytest.approx(30, abs=0.02)
    for x0, x1, _ in (centre, top, bottom):
        assert (x0 + x1) / 2 == pytest.approx(30, abs=0.02)
    # Capitals of Latin Modern are 0.683 of the size high and have no depth; TeX's metrics hold
    # only 16 heights for a font, so that of a letter may be 0.05 mm off.
    height = 0.683 * 9 / 72.27 * 25.4
    for row, share in enumerate((0.5, 0.5, 0.5, 1, 0), 1):
        assert found[row][2] == pytest.approx(15 * row - share * height, abs=0.06)
    (turned,) = (word for word in page.get_text("words") if word[4] == "TTT")
    assert turned[3] - turned[1] > turned[2] - turned[0]
    height = page.rect.height - (turned[1] + turned[3]) / 2 - origin.imag
    assert height / MM == pytest.approx(40, abs=0.05)


@needs_tex
def test_pens_are_as_wide_and_coloured_as_said() -> None:
    items = (
        Line(5 + 5j, 55 + 5j, Pen(0.5, "#ff0000", (2.0, 1.0))),
        Circle(30 + 20j, 8, None, "#0000ff"),
        Arc(30 + 20j, 10, 0.0, 3.0, Pen(0.35, "#800000"), head=2.0),
        Hatch((5 + 35j, 25 + 35j, 25 + 45j, 5 + 45j), 2.0),
    )
    page, origin = drawn(Scene(60, 60, items))
    paths = page.get_drawings()
    (line,) = (path for path in paths if path.get("color") == (1, 0, 0))
    assert line["width"] == pytest.approx(0.5 * MM, abs=0.01)
    assert line["dashes"].startswith("[")
    (disc,) = (path for path in paths if path.get("fill") == (0, 0, 1))
    centre = (disc["rect"].tl + disc["rect"].br) / 2
    at = (complex(centre.x, page.rect.height - centre.y) - origin) / MM
    assert abs(at - (30 + 20j)) < 0.02
    assert disc["rect"].width == pytest.approx(16 * MM, abs=0.05)


def test_a_painted_scene_is_ascii_operators_and_labels() -> None:
    scene = Scene(10, 10, (Line(0j, 10 + 10j), Label(5 + 5j, "a_b", background=True)))
    source = paint_latex(scene, LatexFormulas("vi"))
    assert source.startswith(r"\scene{10}{10}{")
    assert "0 0 m 10 10 l S" in source
    assert r"\lb{5}{5}{.5}{.5}{\lbpaper{a\_b}}" in source
