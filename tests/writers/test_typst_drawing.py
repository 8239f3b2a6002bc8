"""Scenes in the PDF that Typst makes: true lengths, arrow heads, labels at their anchors."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import pymupdf
import pytest

from reportgen.base.records import replace
from reportgen.document import Figure
from reportgen.drawing import Arc, Arrow, Label, Line, Pen, Polyline, Scene
from tests.writers import sample
from tests.writers.pages import MM, by_typst


def drawn(scene: Scene) -> tuple[complex, list[dict[str, Any]]]:
    """(PDF position of the scene's lower left corner, its drawings), found by a red frame around it."""
    w, h = scene.width, scene.height
    frame = Polyline((0j, complex(w, 0), complex(w, h), complex(0, h)), Pen(0.1, "#ff0000"), closed=True)
    page = by_typst(Figure((replace(scene, items=(frame, *scene.items)),)))[0]
    drawings = [drawing for drawing in page.get_drawings() if drawing["rect"].y0 > 21 * MM]
    (red,) = (drawing for drawing in drawings if drawing["color"] == (1.0, 0.0, 0.0))
    return complex(red["rect"].x0, red["rect"].y1), [drawing for drawing in drawings if drawing is not red]


def on_sheet(point: Any, corner: complex) -> complex:
    """A PDF point as a point of the scene, mm."""
    return complex(point.x - corner.real, corner.imag - point.y) / MM


def vertices(drawing: dict[str, Any], corner: complex) -> list[complex]:
    return [on_sheet(point, corner) for item in drawing["items"] for point in item[1:] if hasattr(point, "x")]


def heads(drawings: list[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    return (drawing for drawing in drawings if drawing["type"] == "f" and drawing["fill"] == (0.0, 0.0, 0.0))


def test_arrows_are_true_in_the_pdf() -> None:
    """Coordinates are written to 0.001 mm; 0.02 mm leaves room for the PDF's own rounding."""
    scene = sample.star(100, 24)
    arrows = [item for item in scene.items if isinstance(item, Arrow)]
    corner, drawings = drawn(scene)
    tips = [vertices(drawing, corner)[0] for drawing in heads(drawings)]
    starts = [vertices(drawing, corner)[0] for drawing in drawings if drawing["type"] == "s"]
    assert len(tips) == len(starts) == len(arrows)
    for arrow, tip, start in zip(arrows, tips, starts, strict=True):
        assert abs(tip - arrow.end) < 0.02
        assert abs(start - arrow.start) < 0.02


def test_a_short_arrow_keeps_its_tip_and_its_head_within() -> None:
    arrow = Arrow(10 + 10j, 11 + 10j)
    corner, drawings = drawn(Scene(20, 20, (arrow,)))
    (head,) = heads(drawings)
    points = vertices(head, corner)
    assert abs(max(points, key=lambda point: point.real) - arrow.end) < 0.02
    assert min(point.real for point in points) >= arrow.start.real


def test_arc_keeps_its_radius_and_ends_at_its_stop() -> None:
    arc = Arc(30 + 30j, 20, 0.3, 4.0, head=2.5)
    corner, drawings = drawn(Scene(60, 60, (arc,)))
    (head,) = heads(drawings)
    tip = arc.centre + 20 * complex(math.cos(4.0), math.sin(4.0))
    assert min(abs(point - tip) for point in vertices(head, corner)) < 0.02
    (curve,) = (drawing for drawing in drawings if drawing["type"] == "s")
    ends = [on_sheet(item[4], corner) for item in curve["items"] if item[0] == "c"]
    assert all(abs(abs(end - arc.centre) - arc.radius) < 0.02 for end in ends)


@pytest.mark.parametrize(
    ("anchor", "inside"),
    [("bottom-left", 1 + 1j), ("top-right", -1 - 1j), ("top-left", 1 - 1j), ("bottom-right", -1 + 1j)],
)
@pytest.mark.parametrize("turn", [0, 90])
def test_a_label_stands_on_the_named_corner_of_its_ink(anchor: Any, inside: complex, turn: int) -> None:
    """Ink measured on a picture of the page at 20 dots a mm; a letter without side bearings to speak of."""
    scene = Scene(60, 60, (Label(30 + 30j, "HHHH", anchor, 12.0, turn), Line(0j, 60 + 0j)))
    page = by_typst(Figure((scene,)))[0]
    (axis,) = (drawing["rect"] for drawing in page.get_drawings() if abs(drawing["rect"].width - 60 * MM) < 1)
    corner = complex(axis.x0, (axis.y0 + axis.y1) / 2)
    # Ten millimetres of paper on each side of the point.
    middle = corner + (30 - 30j) * MM
    clip = pymupdf.Rect(middle.real - 40, middle.imag - 40, middle.real + 40, middle.imag + 40)
    picture = page.get_pixmap(dpi=508, clip=clip, colorspace="gray")
    width = picture.width
    dark = [divmod(index, picture.stride) for index, value in enumerate(picture.samples) if value < 128]
    rows, columns = [row for row, _ in dark], [column for _, column in dark]
    near_x = min(columns) if inside.real > 0 else max(columns) + 1
    near_y = max(rows) + 1 if inside.imag > 0 else min(rows)
    # The side bearing of H is 0.03 em, 0.13 mm here, at its ends only; across it the ink is exact.
    assert abs(near_x - width / 2) / 20 < 0.25
    assert abs(near_y - picture.height / 2) / 20 < 0.25
