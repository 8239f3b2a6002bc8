"""Lines and texts of DXF files against what ezdxf makes of them; what is no drawing, and what is too much."""

from __future__ import annotations

import io
import math

import ezdxf
import numpy as np
import pytest
from ezdxf import disassemble

from reportgen.handin.dxf_lines import read_lines
from reportgen.handin.dxf_tags import LARGEST
from reportgen.workbook.zip_package import RefusedError
from tests.handin.drawings import RELEASES, at
from tests.lanes import matrix


def written(document) -> bytes:
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode(document.output_encoding, "dxfreplace")


def a_drawing(release: str):
    """Lines, polylines, blocks in blocks, mirrored, turned, in rows; texts with letters of Vietnamese."""
    document = ezdxf.new(release)
    model = document.modelspace()
    inner = document.blocks.new("INNER", base_point=(1, 2))
    inner.add_line((0, 0), (3, 1))
    inner.add_polyline2d([(0, 0), (4, 0), (4, 3)])
    outer = document.blocks.new("OUTER")
    outer.add_blockref("INNER", (5, 5), dxfattribs={"rotation": 30, "xscale": 2, "yscale": 0.5})
    outer.add_line((0, 0), (0, 7))
    model.add_line((1, 1), (9, 4), dxfattribs={"layer": "any"})
    model.add_polyline2d([(0, 0), (10, 0), (10, 5)], close=True)
    if release != "R12":
        model.add_lwpolyline([(20, 0), (25, 5), (30, 5)])
        model.add_lwpolyline([(40, 0), (45, 1)], dxfattribs={"extrusion": (0, 0, -1)})
    model.add_blockref("OUTER", (100, 50), dxfattribs={"xscale": -1, "rotation": 10})
    model.add_blockref(
        "INNER", (7, 7), dxfattribs={"row_count": 2, "column_count": 3, "row_spacing": 20, "column_spacing": 30}
    )
    model.add_text("Vị trí 3", height=5).dxf.insert = (3, 4)
    return document


def lines_by_ezdxf(document) -> list[tuple[complex, complex]]:
    """The straight lines of a drawing as another program unfolds it."""
    lines = []
    for entity in disassemble.recursive_decompose(document.modelspace()):
        if entity.dxftype() == "LINE":
            lines.append((at(entity.dxf.start), at(entity.dxf.end)))
        elif entity.dxftype() in ("LWPOLYLINE", "POLYLINE"):
            for part in entity.virtual_entities():
                lines.append((at(part.dxf.start), at(part.dxf.end)))
    return lines


@pytest.mark.parametrize("release", matrix(RELEASES, {"R12", "R2018"}))
def test_lines_are_those_that_another_program_unfolds(release: str) -> None:
    document = a_drawing(release)
    drawn = read_lines(written(document), "a.dxf")
    expected = np.array(lines_by_ezdxf(document))
    middle = lambda ends: sorted((round(z.real, 6), round(z.imag, 6)) for z in ends.sum(axis=1))  # noqa: E731
    length = lambda ends: sorted(np.round(np.abs(ends[:, 1] - ends[:, 0]), 6))  # noqa: E731
    assert middle(drawn.ends) == middle(expected)
    assert length(drawn.ends) == length(expected)
    (text,) = drawn.texts
    assert (text.text, text.at, text.height) == ("Vị trí 3", 3 + 4j, 5)


def test_a_polyline_that_tapers_off_is_a_line_with_an_arrowhead() -> None:
    document = ezdxf.new("R2010")
    document.modelspace().add_lwpolyline([(0, 0, 0, 0), (17, 0, 1, 0), (20, 0, 0, 0)], format="xyse")
    ends = read_lines(written(document), "a.dxf").ends
    assert abs(ends[0, 1] - ends[0, 0]) == pytest.approx(20)
    assert [round(math.degrees(np.angle(a / 1)), 3) for a in ends[1:, 1] - ends[1:, 0]] == [-170.538, 170.538]


def test_pictures_and_other_drawings_are_left_alone_and_told() -> None:
    document = ezdxf.new("R2010")
    document.add_xref_def("../secret.dxf", "SECRET")
    document.modelspace().add_blockref("SECRET", (0, 0))
    picture = document.add_image_def("/etc/passwd", size_in_pixel=(1, 1))
    document.modelspace().add_image(picture, insert=(0, 0), size_in_units=(1, 1))
    drawn = read_lines(written(document), "a.dxf")
    assert not len(drawn.ends)
    assert [note.code for note in drawn.notes] == ["drawing-pictures", "drawing-external"]


def blocks_of_blocks(levels: int) -> bytes:
    """Ten lines, set in ten times on each of some levels."""
    document = ezdxf.new("R12")
    first = document.blocks.new("L0")
    for n in range(10):
        first.add_line((0, n), (1, n))
    for level in range(1, levels):
        block = document.blocks.new(f"L{level}")
        for n in range(10):
            block.add_blockref(f"L{level - 1}", (n, 0))
    document.modelspace().add_blockref(f"L{levels - 1}", (0, 0))
    return written(document)


def code_of(data: bytes) -> str:
    with pytest.raises(RefusedError) as refused:
        read_lines(data, "a.dxf")
    return refused.value.fault.code


def test_blocks_are_counted_before_they_are_unfolded() -> None:
    """Twelve levels of ten are 10¹² lines in some 20 kB."""
    assert len(read_lines(blocks_of_blocks(3), "a.dxf").ends) == 1000
    assert code_of(blocks_of_blocks(12)) == "drawing-elements"
    assert code_of(blocks_of_blocks(40)) == "drawing-deep"


def test_a_block_within_itself_is_not_unfolded() -> None:
    document = ezdxf.new("R12")
    block = document.blocks.new("A")
    block.add_line((0, 0), (1, 0))
    block.add_blockref("A", (1, 1))
    document.modelspace().add_blockref("A", (0, 0))
    assert len(read_lines(written(document), "a.dxf").ends) == 1


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"AC1032\0\0\0", "drawing-dwg"),
        (b"AutoCAD Binary DXF\r\n\x1a\0", "drawing-binary"),
        (b"", "drawing-none"),
        (b"%PDF-1.7\nnothing\n", "drawing-damaged"),
        (b"  0\nSECTION\n  2\nENTITIES\n  0\nLINE\n 10\nnowhere\n", "drawing-damaged"),
        (b"  0\nSECTION\n  2\nENTITIES\n  0\nLINE\n 10\nnan\n", "drawing-damaged"),
        (b" " * (LARGEST + 1), "drawing-large"),
    ],
)
def test_what_is_no_drawing_is_told(data: bytes, code: str) -> None:
    assert code_of(data) == code
