"""Which values follow a point that is pulled, for each kind of linkage, and what is written when it is released."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from unittest.mock import Mock

import numpy as np
import pytest

from reportgen import catalogue
from reportgen.base.errors import Location, Where
from reportgen.base.yaml_source import Scalar, Source, read_source, read_text
from reportgen.base.yaml_values import at, put
from reportgen.cases import open_case
from reportgen.machine import Linkage, load_laws
from reportgen.page import animation_panel
from reportgen.page.drag_samples import Resident
from reportgen.page.edit_session import EditSession
from reportgen.page.pulled_values import PlacingValue, Pull, TypedNumber, place_of, placing_values
from reportgen.page.pulls import PulledPoint, Pulls
from tests.lanes import matrix

FOLDER = Path(__file__).parents[2] / "assignments"
FOLLOWING = (
    ("four-bar-01", "C", (), ("BC", "CD")),
    ("four-bar-01", "C", ("BC",), ("CD",)),
    ("four-bar-01", "C", ("BC", "CD"), ()),
    ("four-bar-01", "B", (), ("AB",)),
    ("four-bar-01", "S2", (), ("s2",)),
    ("four-bar-01", "D", (), ("AD",)),
    ("four-bar-01", "E", (), ("E.along", "E.across")),
    ("shaper-01", "B", (), ("H",)),
    ("shaper-01", "B", ("H",), ("l3",)),
    ("shaper-01", "D", (), ("l3",)),
    ("shaper-01", "E", (), ("b", "l4")),
    ("slider-crank-01", "C", (), ("l",)),
    ("slider-crank-01", "S2", (), ("s",)),
    ("engine-twin-05", "B", (), ("lambda",)),
    ("engine-v-02", "S4", (), ("s4",)),
    ("scotch-yoke-01", "A", (), ("r",)),
    ("slotted-lever-01", "C", (), ("AC",)),
    ("toggle-press-01", "D", (), ("D.x", "D.y")),
    ("lever-six-bar-01", "F", (), ("EF", "guide")),
    ("linkage-8", "C", (), ("groups.0.lengths.0", "groups.0.lengths.1")),
    ("linkage-8", "C", ("groups.0.lengths.0",), ("groups.0.lengths.1",)),
    ("linkage-8", "C", ("groups.0.lengths",), ()),
    ("linkage-8", "H", (), ("points.H.at.0", "points.H.at.1")),
    ("linkage-slide", "D", (), ("frame.D.0", "frame.D.1")),
)
DRIVER = {"linkage-slide": 0.05}
"""The driver's coordinate at which a point is pulled, if it is not a crank."""


def place(path: str) -> Where:
    return ("parameters", *(int(step) if step.isdigit() else step for step in path.split(".")))


def known(name: str) -> tuple[Source, Linkage, tuple[PlacingValue, ...]]:
    source = read_source(FOLDER / f"{name}.yaml")
    linkage, values = placing_values(source, FOLDER / f"{name}.yaml")
    assert linkage is not None
    return source, linkage, values


@pytest.mark.parametrize(
    ("name", "point", "locked", "following"),
    matrix(FOLLOWING, [case for case in FOLLOWING if case[0] in ("shaper-01", "linkage-8")]),
)
def test_a_point_changes_the_values_that_place_it(
    name: str, point: str, locked: tuple[str, ...], following: tuple[str, ...]
) -> None:
    """With as many values as it has ways to go, it comes to the pointer; the file gives the same place."""
    source, linkage, values = known(name)
    driver = DRIVER.get(name, 1.0)
    pull = Pull.of(linkage, values, point, driver, list(map(place, locked)))
    assert [value.where for value in pull.values] == list(map(place, following))
    if not following:
        return
    begin, none = place_of(linkage, point, driver), np.zeros(len(following))
    reach = 0.02 * max(abs(p) for p in (begin, *linkage.ground.values()))
    wanted = begin + reach * np.exp(0.7j)
    offsets = pull.to(wanted, none)
    reached = pull.at(offsets)
    assert abs(reached - wanted) < abs(begin - wanted)
    if len(following) == 2:
        assert reached == pytest.approx(wanted, abs=1e-4 * reach)
    top = source.top
    assert top is not None
    for where, text in pull.texts(offsets):
        old = at(top, where)
        assert isinstance(old, Scalar) or where[-1] == "s2", "only a mass centre may be left out"
        top = put(top, where, Scalar(text, Location("")))
    made = catalogue.linkage_of(Source("", top=top), Path(source.file))
    assert made is not None
    assert place_of(made, point, driver) == pytest.approx(pull.at(pull.rounded(offsets)), abs=1e-3 * reach)


@pytest.mark.parametrize(
    ("text", "to", "written"),
    [
        ("340 mm", 352.4, "350 mm"),
        ("34 mm", 35.6, "36 mm"),
        ("0.35", 0.4199, "0.42"),
        ("1/3.6", 4.14, "1/4.1"),
        ("1 m", 1.234, "1.23 m"),
        ("0 mm", 3.7, "4 mm"),
        ("0.546358894", 0.61234567, "0.6123"),
    ],
)
def test_values_follow_in_the_steps_of_their_fields(text: str, to: float, written: str) -> None:
    typed = TypedNumber.of(text)
    assert typed is not None
    assert typed.text(typed.stepped(to, -1e9, 1e9)) == written
    assert typed.stepped(1e12, -1e9, 500.0) <= 500.0


@pytest.mark.parametrize("far", [0.4, 20.0])
def test_a_value_that_is_pulled_back_is_written_as_it_was_typed(tmp_path: Path, far: float) -> None:
    """Also from so far that the linkage was made anew on the way."""
    file = tmp_path / "mine.yaml"
    text = (FOLDER / "four-bar-01.yaml").read_text(encoding="utf-8")
    file.write_text(text.replace("BC: 340 mm", "BC: 340.125 mm"), encoding="utf-8")
    edited = EditSession(partial(open_case, file), "en", path=file)
    try:
        edited.renew()
        resident = edited.pulls.resident()
        assert resident is not None
        spot = place_of(resident.samples.machine.linkage, "C", np.radians(30.0)) * resident.samples.scale
        asked, top = {"grab": 1, "point": "C", "angle": 30.0}, edited.pulls.read()
        for by in (far, 0.0):
            edited.pull({**asked, "to": [spot.real + by, -spot.imag - by]})
        grabbed = edited.pulls.grabbed(asked, resident, top)
        assert isinstance(grabbed, PulledPoint)
        assert (grabbed.pull is not grabbed.begun) == (far > 1.0)
        assert dict(grabbed.pull.texts(grabbed.offsets))[place("BC")] == "340.125 mm"
    finally:
        edited.close()


def test_a_pull_begins_anew_when_the_file_changes_meanwhile() -> None:
    file = FOLDER / "four-bar-01.yaml"
    case, asked = open_case(file), {"grab": 1, "point": "C", "angle": 30.0}
    first, later = (Resident.of(case, number) for number in (1, 2))
    assert first is not None
    assert later is not None
    pulls = Pulls(file, lambda: later, lambda: None)
    top = read_source(file).top
    grabbed = pulls.grabbed(asked, first, top)
    assert grabbed is not None
    assert pulls.grabbed(asked, first, top) is grabbed
    assert pulls.grabbed(asked, later, top) is not grabbed


def test_a_released_point_is_one_change(tmp_path: Path) -> None:
    """Nothing is written while it is pulled; then both lengths are, all or none, and undone together."""
    (file := tmp_path / "mine.yaml").write_bytes((FOLDER / "four-bar-01.yaml").read_bytes())
    before = file.read_bytes()
    edited = EditSession(partial(open_case, file), "en", path=file)
    try:
        edited.renew()
        grips = edited.grips()
        assert grips["driver"] == {"centre": "A", "pin": "B", "turn": 1, "instants": False}
        assert grips["points"]["C"] == [["parameters", "BC"], ["parameters", "CD"]]
        asked = {"grab": 1, "point": "C", "angle": 30.0, "to": [0, 0]}
        resident = edited.pulls.resident()
        assert resident is not None
        spot = resident.samples.machine.linkage, "C", np.radians(30.0)
        here = place_of(*spot) * resident.samples.scale
        answer = edited.pull({**asked, "to": [here.real + 4, -here.imag - 6]})
        assert isinstance(answer, bytes)
        told = json.loads(answer[4 : 4 + int.from_bytes(answer[:4], "little")])
        assert told["at"] == pytest.approx([here.real + 4, -here.imag - 6], abs=2.0)
        assert [where for where, _ in told["values"]] == grips["points"]["C"]
        assert file.read_bytes() == before
        far = edited.pull({**asked, "to": [4000, 0]})
        assert far == {"values": []}, "no machine reaches so far"
        texts = {"BC": "365 mm", "CD": "320 mm"}
        changes = [
            {"where": ["parameters", key], "value": text, "was": was}
            for (key, text), was in zip(texts.items(), ("340 mm", "280 mm"), strict=True)
        ]
        late = [changes[0], {**changes[1], "was": "281 mm"}]
        assert "meanwhile" in edited.edit({"op": "set all", "changes": late, "typing": "a"})
        assert file.read_bytes() == before
        assert edited.edit({"op": "set all", "changes": changes, "typing": "a"})["written"] == list(texts.values())
        top = read_text(file.read_text(encoding="utf-8")).top
        for key, text in texts.items():
            node = at(top, ("parameters", key))
            assert isinstance(node, Scalar)
            assert node.text == text
        edited.edit({"op": "undo"})
        assert file.read_bytes() == before
    finally:
        edited.close()


def test_a_frame_of_a_pull_computes_nothing_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only loads search for turning points, not the checks; tracks that are repeated are sampled once."""
    resident = Resident.of(open_case(FOLDER / "linkage-8.yaml"))
    assert resident is not None
    searches, sampled = Mock(wraps=load_laws.zeros_between), Mock(wraps=animation_panel.samples)
    monkeypatch.setattr(load_laws, "zeros_between", searches)
    monkeypatch.setattr("reportgen.page.drag_samples.samples", sampled)
    assignment, faults = catalogue.understood(read_source(FOLDER / "linkage-8.yaml"), FOLDER / "linkage-8.yaml")
    assert assignment is not None
    assert not faults
    assert not searches.called
    assert resident.sampled(assignment)
    assert searches.call_count == 2, "two loads follow a sense of motion"
    assert sampled.call_count < sum(map(len, resident.numbers.values())) / 2, "most tracks are repeated"
