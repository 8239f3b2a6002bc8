"""Machines of which only some links have mass: every subset of what a file may leave out has a report."""

from __future__ import annotations

import math
import re
from importlib import import_module
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest
import yaml

from reportgen import api
from reportgen.base.kinds import kinds
from reportgen.cases import opened
from reportgen.catalogue import sample
from reportgen.document import text_of
from reportgen.formula import ids
from reportgen.marking.toleranced_key import key_of
from tests.lanes import matrix
from tests.report import built

CRANK: dict[str, Any] = {"r": "90 mm", "l": "330 mm", "n": "150 rpm", "m1": "8 kg", "s1": "0.4"}


def written(
    folder: Path, kind: str, parameters: dict[str, Any], language: str = "en", new: dict[str, Any] | None = None
) -> Path:
    """A file of a kind with these parameters; `new` has its other sections."""
    path = folder / "massless.yaml"
    file = {**(new or {"kind": kind}), "parameters": parameters}
    file |= {"report": {"language": language}, "positions": {"count": "6"}}
    path.write_text(yaml.safe_dump(file, sort_keys=False), encoding="utf-8")
    return path


@pytest.mark.parametrize("language", ["vi", "en"])
def test_a_crank_and_a_slider_without_a_rod_between(tmp_path: Path, language: str) -> None:
    """P_in1 = m₁ω₁² s₁r; the place that is worked out is that of the crank's mass centre, and there is no S₂."""
    assignment = api.load(written(tmp_path, "slider-crank", CRANK | {"m3": "6 kg"}, language))
    case = opened(assignment)
    text = text_of(case.document())
    arm = 0.4 * 0.09
    assert abs(case.ledger["l.AS1"].values[0] - arm) < 1e-15
    assert abs(case.ledger["Pqt1"].values[0]) == pytest.approx(8 * (2 * math.pi * 150 / 60) ** 2 * arm)
    assert "S_2" not in text
    assert "S2" not in text
    assert {"vi": "trọng tâm của thanh truyền", "en": "mass centre of the connecting rod"}[language] not in text


def test_a_load_without_torque(tmp_path: Path) -> None:
    """A mass on the crank alone needs no torque at a constant speed in a horizontal plane: what is left is rounding."""
    assignment = api.load(written(tmp_path, "slider-crank", CRANK | {"J1": "0.02 kg m2", "plane": "horizontal"}))
    assert opened(assignment).ledger["M.mean"].values == 0


KINDS = sorted(name for name in kinds() if name != "linkage" and "# plane: horizontal" in sample(name, "en"))


def subsets(kind: str) -> list[tuple[str, ...]]:
    """Choices of masses of a kind beside those that it must give, the crank's with and without its place.

    One mass, all but one, and all: a fault of a report lies in one link without mass, or in how two meet.  So any two
    have all four combinations.
    """
    Parameters = import_module(kinds()[kind]).Parameters
    links = Parameters.links["m"]
    needed = tuple(f"m{link}" for link in Parameters.required)
    free = [(f"m{link}",) for link in links if link not in Parameters.required]
    free += [("m1", "s1")]
    counts = {0, 1, len(free) - 1, len(free)}
    chosen = (sum(some, ()) for count in sorted(counts) for some in combinations(free, count))
    return sorted({tuple(sorted({*needed, *some})) for some in chosen} - {()})


TELLING = [("slotted-lever", ("m1",)), ("four-bar", ("m1", "m3", "s1"))]
CASES = [(kind, given) for kind in KINDS for given in subsets(kind)]


@pytest.mark.parametrize(("kind", "given"), matrix(CASES, TELLING))
def test_any_subset_of_the_masses(tmp_path: Path, kind: str, given: tuple[str, ...]) -> None:
    """It has a report and a key."""
    new = yaml.load(sample(kind, "en"), yaml.BaseLoader)
    kept = {key: value for key, value in new["parameters"].items() if key[0] not in "GmJs" or not key[1:].isdigit()}
    masses = {key: "0.4" if key[0] == "s" else "3 kg" for key in given}
    case = opened(api.load(written(tmp_path, kind, kept | masses, new=new)))
    assert case.document().blocks
    assert key_of(case)


@pytest.mark.parametrize("extent", matrix(["full", "short"], ["short"]))
@pytest.mark.parametrize("kind", matrix(KINDS, ("slider-crank", "shaper", "engine-twin")))
def test_every_place_of_a_mass_centre_has_its_line(tmp_path: Path, kind: str, extent: str) -> None:
    """l_AS = s·l is worked out before it stands in the table of real dimensions; so is the crank's."""
    Parameters = import_module(kinds()[kind]).Parameters
    new = yaml.load(sample(kind, "en"), yaml.BaseLoader)
    kept = {key: value for key, value in new["parameters"].items() if key[0] not in "GmJs" or not key[1:].isdigit()}
    heavy = {f"m{link}": "3 kg" for link in (1, *Parameters.links["m"])} | {"s1": "0.4"}
    path = written(tmp_path, kind, kept | heavy, new=new)
    path.write_text(path.read_text("utf-8").replace("report:\n", f"report:\n  extent: {extent}\n"), encoding="utf-8")
    report = built.compose(api.load(path))
    families = report.case.ledger.families
    places = {id for id, family in families.items() if ids.length.read(id) and re.search(r"S\d$", id)}
    worked = {id for id in places if families[id].definition is not None}
    assert any(id.endswith("S1") for id in worked)
    assert {id for id, _ in report.lines} >= worked


def test_a_component_that_is_zero_by_definition_is_not_given(tmp_path: Path) -> None:
    """The rod without loads turns no moment into a reaction: the key has this zero among the forces, not the data."""
    key = key_of(opened(api.load(written(tmp_path, "slider-crank", CRANK | {"m3": "6 kg"}))))
    zero = key.row("R.12.t")
    assert not zero.values.any()
    assert (zero.role, zero.part, zero.positions) == ("asked", "forces", ())
