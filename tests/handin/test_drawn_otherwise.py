"""The same plans drawn in other ways: lines twice, in pieces, on sheets of paper, as multilines and splines."""

from __future__ import annotations

import io
import random
from collections.abc import Callable

import ezdxf
import numpy as np
import pytest

from reportgen.handin import FileReading
from reportgen.handin.dxf_corrections import LAYER, RedVector, with_corrections
from reportgen.handin.dxf_lines import read_lines
from reportgen.handin.line_repair import COVERED, MOST_PIECES, distinct, goes_on, meant
from reportgen.handin.line_set import Lines
from tests.handin.drawings import Manner, at
from tests.handin.test_drawing_lines import written
from tests.handin.test_plans_in_drawings import MACHINES, counts, drawn, opened_at_all, read_as
from tests.lanes import matrix

PLAIN = Manner(noise=0.3, blocks=False, heads=False, clutter=20)
Redraw = Callable[[object, complex, complex, random.Random], None]


def line(space, a: complex, b: complex) -> None:
    space.add_line((a.real, a.imag), (b.real, b.imag))


def twice(space, a: complex, b: complex, rng: random.Random) -> None:
    line(space, a, b)
    line(space, *((a, b) if rng.random() < 0.5 else (b, a)))


def in_pieces(space, a: complex, b: complex, rng: random.Random, gap: float = 0.0) -> None:
    """Two or three pieces one behind the other, as BREAK leaves them."""
    cuts = sorted(rng.uniform(0.2, 0.8) for _ in range(rng.choice([1, 2])))
    half = gap / 2 / abs(b - a)
    places = [0.0, *(place for cut in cuts for place in (cut - half, cut + half)), 1.0]
    for first, last in zip(places[::2], places[1::2], strict=True):
        if last > first:
            line(space, a + (b - a) * first, a + (b - a) * last)


def with_gaps(space, a: complex, b: complex, rng: random.Random) -> None:
    in_pieces(space, a, b, rng, gap=1.0)


def as_multiline(space, a: complex, b: complex, rng: random.Random) -> None:
    space.add_mline([(a.real, a.imag), (b.real, b.imag)])


def as_spline(space, a: complex, b: complex, rng: random.Random) -> None:
    points = [a + (b - a) * share for share in (0.0, 0.3, 0.7, 1.0)]
    space.add_open_spline([(z.real, z.imag, 0.0) for z in points])


def on_paper(space, a: complex, b: complex, rng: random.Random) -> None:
    line(space.doc.paperspace(), a, b)


def on_another_sheet(space, a: complex, b: complex, rng: random.Random) -> None:
    document = space.doc
    line(document.layouts.get("A1") if "A1" in document.layouts else document.layouts.new("A1"), a, b)


WAYS: dict[str, Redraw] = {
    way.__name__: way for way in (twice, in_pieces, with_gaps, as_multiline, as_spline, on_paper, on_another_sheet)
}


def redrawn(data: bytes, way: Redraw, seed: int = 1) -> bytes:
    """A drawing with each longer line drawn in another way; onto a sheet go all of them."""
    shortest = 0.0 if way in (on_paper, on_another_sheet) else 5.0
    rng = random.Random(seed)
    document = ezdxf.read(io.StringIO(data.decode("utf-8", "surrogateescape")))
    space = document.modelspace()
    for entity in list(space):
        ends = lines_of(entity)
        if ends and abs(ends[1] - ends[0]) > shortest:
            space.delete_entity(entity)
            way(space, *ends, rng)
    return written(document)


def lines_of(entity) -> tuple[complex, complex] | None:
    if entity.dxftype() == "LINE":
        return at(entity.dxf.start), at(entity.dxf.end)
    if entity.dxftype() == "POLYLINE":
        first, last = entity.vertices[0].dxf.location, entity.vertices[-1].dxf.location
        return at(first), at(last)
    return None


@pytest.mark.parametrize("name", matrix(MACHINES, {"four-bar-02"}))
@pytest.mark.parametrize("way", matrix(WAYS, [*WAYS][::3]))
def test_vectors_are_read_however_they_are_drawn(name: str, way: str) -> None:
    """As many as of plain lines where nothing is cut; of pieces two thirds, and none at a wrong length."""
    data, truth = drawn(name, PLAIN, 7)
    plain = counts(name, read_as(name, data), truth)["right"]
    reading = read_as(name, redrawn(data, WAYS[way]))
    counted = counts(name, reading, truth)
    assert counted["wrong"] == 0
    assert not any(answer.location.wrong for answer in reading.values.values())
    share = 2 / 3 if way in ("in_pieces", "with_gaps") else 1.0
    assert counted["right"] >= share * plain > 50 * share


@pytest.mark.parametrize("name", matrix(MACHINES, {"four-bar-02"}))
@pytest.mark.parametrize("way", matrix([in_pieces, with_gaps], [in_pieces]))
def test_wrong_vectors_in_pieces_are_read_whole_or_not_at_all(name: str, way: Redraw) -> None:
    """Letters stand beside them, which say which vector a first piece is of: its end is not the vector's."""
    for seed in range(1, 7):
        data, truth = drawn(name, Manner(noise=0.3, wrong=0.6, letters=True, blocks=False), seed)
        reading = read_as(name, redrawn(data, way, seed))
        for place, length in told_lengths(reading).items():
            own = [lines[one] for lines in (truth.lines, truth.wrong) for one in truth.alike[place] if one in lines]
            # Nobody tells lines apart whose ends lie within half a millimetre, nor a right vector from a wrong one
            # that is cut where the right one ends.
            lengths = [*(abs(b - a) for a, b in own), right_length(name, place)]
            assert any(length == pytest.approx(of, abs=0.5) for of in lengths), place


def right_length(name: str, place: tuple[str, int]) -> float:
    """The length (mm) of a vector as the key has it."""
    _, scheme = opened_at_all(name)
    row = scheme.key.row(place[0])
    return float(row.printed[row.at(place[1])])


def told_lengths(reading: FileReading) -> dict[tuple[str, int], float]:
    return {
        place: float(answer.text.split()[0])
        for place, answer in reading.values.items()
        if place[0].startswith("seg.") and place[1]
    }


def test_lines_that_another_one_covers_are_dropped() -> None:
    ends = np.array([[0, 30], [30, 0], [0, 30.05j + 30], [COVERED / 2, 30], [0, 20]], dtype=complex)
    assert distinct(ends).tolist() == [[0, 30], [0, 30 + 30.05j], [0, 20]]


def test_a_run_of_pieces_is_a_line_beside_them() -> None:
    """Weights that are laid one behind the other look the same: both readings stay open."""
    lines = Lines(np.array([[0, 10], [30, 10], [10, 10 + 9j]], dtype=complex), 0.5)
    whole, heads = meant(lines)
    assert whole.ends.tolist() == [[0, 10], [30, 10], [10, 10 + 9j], [0, 30]]
    assert whole.pieces[3] == {0, 1}
    assert not heads.any()


def test_no_run_goes_over_an_arrowhead() -> None:
    strokes = [[10, 7.5 + 0.7j], [10, 7.5 - 0.7j]]
    lines = Lines(np.array([[0, 10], [10, 30], *strokes], dtype=complex), 0.5)
    whole, heads = meant(lines)
    assert whole.ends.tolist() == [[0, 10], [10, 30]]
    assert heads.tolist() == [[False, True], [False, False]]


def test_a_dashed_line_is_no_vector() -> None:
    lines = Lines(np.array([[4 * n, 4 * n + 3] for n in range(40)], dtype=complex), 0.5)
    whole, _ = meant(lines)
    assert max(abs(b - a) for a, b in whole.ends) <= 4 * MOST_PIECES
    assert goes_on(lines, 0j, 3 + 0j)
    assert not goes_on(lines, 80j, 80j + 3)


def test_a_spline_that_bends_and_a_closed_one_are_no_line() -> None:
    document = ezdxf.new("R2010")
    model = document.modelspace()
    model.add_open_spline([(0, 0, 0), (10, 1, 0), (20, 1, 0), (30, 0, 0)])
    model.add_open_spline([(0, 0, 0), (20, 0, 0), (10, 0, 0), (30, 0, 0)])
    model.add_spline([(0, 5), (30, 5)])
    assert read_lines(written(document), "a.dxf").ends.tolist() == [[5j, 30 + 5j]]


@pytest.mark.parametrize(("flags", "count"), [({"color": -7}, 1), ({"flags": 1}, 0)])
def test_layers_that_are_off_or_frozen_are_not_read_and_told(flags: dict[str, int], count: int) -> None:
    """A layer that is off hides no other layer of a block that was set in on it; a frozen one does."""
    document = ezdxf.new("R2010")
    document.layers.add("HIDDEN")
    for name, value in flags.items():
        document.layers.get("HIDDEN").dxf.set(name, value)
    block = document.blocks.new("A")
    block.add_line((0, 0), (30, 0))
    model = document.modelspace()
    model.add_line((0, 0), (0, 30), dxfattribs={"layer": "HIDDEN"})
    model.add_blockref("A", (5, 5), dxfattribs={"layer": "HIDDEN"})
    read = read_lines(written(document), "a.dxf")
    assert len(read.ends) == count
    (note,) = read.notes
    assert (note.code, note.arguments["count"]) == ("drawing-hidden", str(2 - count))


@pytest.mark.parametrize("release", ["R12", "R2010"])
def test_corrections_go_onto_the_sheet_that_the_vector_stands_on(release: str) -> None:
    document = ezdxf.new(release)
    line(document.modelspace(), 0j, 50j)
    line(document.paperspace(), 0j, 40j)
    spaces = [b"*PAPER_SPACE"]
    if release != "R12":
        line(document.layouts.new("A1"), 0j, 30j)
        spaces.append(b"*PAPER_SPACE0")
    data = written(document)
    assert [sheet.space for sheet in read_lines(data, "a.dxf").sheets] == spaces
    vectors = [RedVector(0j, 10 + 0j, (), space) for space in spaces]
    changed = ezdxf.read(io.StringIO(with_corrections(data, vectors, 1.0).decode()))
    auditor = changed.audit()
    assert not auditor.errors
    assert not auditor.fixes
    for layout in changed.layouts:
        red = [entity for entity in layout if entity.dxf.layer == LAYER]
        assert len(red) == (0 if layout.name == "Model" else 3)


def test_a_polyline_on_paper_keeps_its_corners() -> None:
    document = ezdxf.new("R12")
    document.paperspace().add_polyline2d([(0, 0), (10, 0), (10, 5)])
    drawn_lines = read_lines(written(document), "a.dxf")
    assert not len(drawn_lines.ends)
    assert drawn_lines.sheets[0].ends.tolist() == [[0, 10], [10, 10 + 5j]]
