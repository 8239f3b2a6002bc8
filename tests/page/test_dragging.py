"""What moves while a value is drawn: the samples of a whole animation of the changed machine at the same scales."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from reportgen import catalogue
from reportgen.assignment import Assignment
from reportgen.base.yaml_source import MappingNode, Scalar, Source, read_source
from reportgen.base.yaml_values import at, put
from reportgen.case import MachineAnalysis
from reportgen.cases import open_case, opened
from reportgen.page.animation_panel import PanelWriter
from reportgen.page.controlled_parts import ControlledParts, owners, variations
from reportgen.page.drag_samples import FINER, SPOTS, Resident, grouped
from reportgen.page.motion_samples import Samples
from tests.lanes import matrix

FOLDER = Path(__file__).parents[2] / "assignments"
CHANGES = (
    ("slider-crank-01.yaml", ("parameters", "r"), "101 %"),
    ("engine-twin-05.yaml", ("parameters", "H"), "101 %"),
    ("shaper-01.yaml", ("parameters", "l3"), "555 mm"),
    ("linkage-8.yaml", ("parameters", "driver", "length"), "101 %"),
    ("linkage-8.yaml", ("parameters", "masses", 0, "G"), "101 N"),
    ("coursework/shaper-whole.yaml", ("parameters", "a"), "101 %"),
)
MOST = {"engine-twin-05.yaml": 596, "shaper-01.yaml": 209, "linkage-8.yaml": 385, "coursework/shaper-whole.yaml": 279}
"""The kilobytes of all samples of these: no more is sent of a change, new shapes of bodies among it."""


def changed(file: Path, where: tuple[str | int, ...], value: str) -> Assignment:
    source = read_source(file)
    old = at(source.top, where)
    assert source.top is not None
    assert isinstance(old, Scalar)
    if value.endswith("%"):
        number, _, unit = old.text.partition(" ")
        value = f"{float(number) * float(value[:-1]) / 100:g} {unit}"
    top = put(source.top, where, Scalar(value, old.location))
    assignment, faults = catalogue.understood(Source(str(file), top=top), file)
    assert not faults
    assert assignment is not None
    return assignment


def unpacked(answer: bytes, known: np.ndarray) -> tuple[dict[str, str], np.ndarray]:
    """Bodies by their places, and all samples: those that are `known` but for what the answer changes of them."""
    length = int.from_bytes(answer[:4], "little")
    changes, sent = json.loads(answer[4 : 4 + length]), np.frombuffer(answer[4 + length :], "<f4")
    values, taken = known.copy(), 0
    for place, number in changes["runs"]:
        values[place : place + number] = sent[taken : taken + number]
        taken += number
    assert taken == sent.size
    return changes["bodies"], values


@pytest.mark.parametrize(("name", "where", "value"), matrix(CHANGES, [CHANGES[0]]))
def test_samples_are_those_of_a_whole_animation(name: str, where: tuple[str | int, ...], value: str) -> None:
    """Track by track, to what numbers of four bytes hold; of the machine as it is, nothing changes."""
    file = FOLDER / name
    case = open_case(file)
    resident = Resident.of(case)
    assert resident is not None
    bodies, same = unpacked(resident.sampled(case.assignment), np.zeros_like(resident.values))
    assert (bodies, same.any()) == ({}, False)
    assignment = changed(file, where, value)
    answer = resident.sampled(assignment)
    assert len(answer) < min(resident.values.nbytes, 1000 * MOST.get(name, np.inf))
    bodies, samples = unpacked(answer, resident.values)
    whole = opened(assignment)
    other = getattr(whole, "machine", whole)
    assert isinstance(other, MachineAnalysis)
    animation = Samples(other, resident.samples.kept).animation()
    writer = PanelWriter(animation, "en", other.words)
    writer.panel()
    starts = np.concatenate(([0], np.cumsum(writer.tracks.lengths)))
    moved = grouped(animation.panes, animation.values)
    assert moved.keys() == resident.numbers.keys()
    pairs = [pair for group in moved for pair in zip(resident.numbers[group], moved[group], strict=True)]
    for number, track in pairs:
        own = writer.tracks.number(track)
        for part in range(1 + np.iscomplexobj(track.values)):
            expected = writer.tracks.values[slice(*starts[own + part : own + part + 2])]
            here = samples[slice(*resident.starts[number + part : number + part + 2])]
            greatest = np.nanmax(np.abs(expected), initial=0.0)
            np.testing.assert_allclose(here, expected, rtol=0, atol=1e-6 * max(greatest, 1e-30))
    if where[-1] == "r":
        assert bodies, "a longer crank is drawn longer"


@pytest.mark.parametrize("layers", [("paths",), ("centres", "loads"), ("velocities", "reactions")])
@pytest.mark.parametrize(("name", "where", "value"), matrix(CHANGES, [CHANGES[0]]))
def test_what_is_in_sight_has_the_samples_of_all(
    name: str, where: tuple[str | int, ...], value: str, layers: tuple[str, ...]
) -> None:
    """The machine with some layers, and the plan of accelerations: sample for sample; all others stay as they are."""
    file = FOLDER / name
    resident = Resident.of(open_case(file))
    assert resident is not None
    assignment = changed(file, where, value)
    bodies, whole = unpacked(resident.sampled(assignment), resident.values)
    reshaped, samples = unpacked(resident.sampled(assignment, frozenset(("machine", "a", *layers))), resident.values)
    in_sight = np.zeros(samples.size, dtype=bool)
    animation = resident.samples.animation()
    for (pane, layer), tracks in grouped(animation.panes, animation.values).items():
        if pane in ("machine", "a") and layer in ("", SPOTS, FINER, *layers):
            for number, track in zip(resident.numbers[pane, layer], tracks, strict=True):
                in_sight[slice(*resident.starts[[number, number + 1 + np.iscomplexobj(track.values)]])] = True
    assert in_sight.any()
    np.testing.assert_array_equal(samples, np.where(in_sight, whole, resident.values))
    own = {str(place) for layer in ("", *layers) for place in resident.places.get(layer, ())}
    assert reshaped == {place: body for place, body in bodies.items() if place in own}


def test_each_value_leads_to_what_it_moves() -> None:
    """The shaper's lengths and loads, by its drawing: A over C, rocker CD, link DE, ram E; the crank is a H/(2 l3)."""
    file = FOLDER / "shaper-01.yaml"
    source = read_source(file)
    case = open_case(file)
    assert isinstance(case, MachineAnalysis)
    assert isinstance(source.top, MappingNode)
    owned = {where[-1]: own for where, own in owners(case.analysis.machine, source.top, source)}
    assert owned["l4"] == ControlledParts(bars=(("D", "E"),))
    assert owned["H"] == ControlledParts(bars=(("A", "B"),))
    assert "D" in owned["l3"].points
    assert owned["b"] == owned["F"] == ControlledParts(points=("E",))
    assert [next(variations(text), None) for text in ("1/3.6", "0 mm", "50 mm", "left")] == [
        *("1.01/3.6", "0.5 mm", "50.5 mm"),
        None,
    ]
