"""The program of the closed formulas runs alone and prints the results of `solve --json`, unrounded."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reportgen import api
from reportgen.base.errors import NotOfferedError
from reportgen.document import Listing
from tests.lanes import matrix

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
AGREE = 1e-9
"""Of the largest value over the turn."""

Results = list[dict[str, Any]]


def tabulated(folder: Path, program: Path) -> dict[str, np.ndarray]:
    """What a program prints in an empty folder, by its names."""
    alone = folder / "alone"
    alone.mkdir()
    (alone / "program.py").write_bytes(program.read_bytes())
    ran = subprocess.run(
        [sys.executable, "-I", "program.py"], cwd=alone, capture_output=True, text=True, timeout=60, check=True
    )
    found: dict[str, list[float]] = {}
    names: list[str] = []
    for line in ran.stdout.splitlines():
        head, *cells = line.split()
        if head == "position":
            names = cells
            found |= {name: [] for name in names}
        else:
            for name, cell in zip(names, cells, strict=True):
                found[name].append(float(cell))
    return {name: np.array(values) for name, values in found.items()}


def test_no_word_of_others_is_run(tmp_path: Path) -> None:
    """What a school says in several lines is a comment in one."""
    ours = tmp_path / "ours" / "en.md"
    ours.parent.mkdir()
    ours.write_text(
        '%% words\nlisting: ["a {machine}\\nraise SystemExit(1)", b, c, d, e]\n'
        'given: {l.AB: "e\\nraise SystemExit(2)"}\n',
        encoding="utf-8",
    )
    text = (ASSIGNMENTS / "slider-crank-01.yaml").read_text(encoding="utf-8")
    file = tmp_path / "mine.yaml"
    file.write_text(text.replace("  language: vi", "  language: en\n  templates: ours"), encoding="utf-8")
    (listing,) = [one for one in api.document(api.load(file).with_listing()).blocks if isinstance(one, Listing)]
    program = tmp_path / "report.py"
    program.write_text("\n".join(listing.lines), encoding="utf-8")
    assert listing.lines[0] == "# a Slider-crank mechanism raise SystemExit(1)"
    assert tabulated(tmp_path, program)


def of_link(number: int, rate: str) -> Callable[[Results], list[float]]:
    return lambda positions: [one["links"][str(number)][rate] for one in positions]


def of_point(name: str, what: str, axis: int) -> Callable[[Results], list[float]]:
    return lambda positions: [one["points"][name][what][axis] for one in positions]


def size(name: str, what: str) -> Callable[[Results], list[float]]:
    return lambda positions: [float(np.hypot(*one["points"][name][what])) for one in positions]


RAM: Mapping[str, Callable[[Results], list[float]]] = {
    "x_E": of_point("E", "p", 0),
    "v_E": of_point("E", "v", 0),
    "a_E": of_point("E", "a", 0),
    "omega_3": of_link(3, "omega"),
    "omega_4": of_link(4, "omega"),
    "eps_3": of_link(3, "epsilon"),
    "eps_4": of_link(4, "epsilon"),
    "M": lambda positions: [one["balancing_torque"]["equilibrium"] for one in positions],
}
LEVER: Mapping[str, Callable[[Results], list[float]]] = {
    **{f"omega_{link}": of_link(link, "omega") for link in (2, 3, 4)},
    **{f"eps_{link}": of_link(link, "epsilon") for link in (2, 3, 4)},
    **{f"{what}_{name}": size(name, what) for name in ("C", "E", "S2", "S3", "S4") for what in "va"},
    "v_F": of_point("F", "v", 0),
    "a_F": of_point("F", "a", 0),
    "x_C": of_point("C", "p", 0),
    "y_E": of_point("E", "p", 1),
}
EIGHT = {f"omega_{link}": of_link(link, "omega") for link in range(2, 7)} | {"v_K": of_point("K", "v", 0)}
TERNARY = {f"omega_{link}": of_link(link, "omega") for link in range(2, 6)} | {
    **{f"eps_{link}": of_link(link, "epsilon") for link in range(2, 6)},
    **{f"{what}_{name}": size(name, what) for name in "DEF" for what in "va"},
}


CASES = [
    *(("shaper-01", RAM), ("shaper-02", RAM), ("lever-six-bar-01", LEVER), ("linkage-8", EIGHT)),
    ("linkage/class-iii", TERNARY),
]


@pytest.mark.parametrize(("name", "told"), matrix(CASES, CASES[:1]))
def test_it_prints_what_solve_says(tmp_path: Path, name: str, told: Mapping[str, Callable[[Results], Any]]) -> None:
    file = ASSIGNMENTS / f"{name}.yaml"
    api.build(file, tmp_path, listing=True, formats=("html",))
    table = tabulated(tmp_path, tmp_path / file.stem / "report.py")
    # It draws them, too, without a window.
    assert (tmp_path / "alone" / "curves.png").read_bytes().startswith(b"\x89PNG")
    positions = api.solve(api.load(file))["positions"]
    for quantity, of in told.items():
        expected = np.array(of(positions))
        assert np.abs(table[quantity] - expected).max() <= AGREE * np.abs(expected).max(), quantity


def test_the_shapers_program_is_short() -> None:
    """About sixty lines and those that draw its curves, none longer than a page is wide."""
    tree = api.document(api.load(ASSIGNMENTS / "shaper-01.yaml").with_listing())
    (program,) = (block for block in tree.blocks if type(block).__name__ == "Listing")
    assert len(program.lines) <= 80
    assert max(map(len, program.lines)) <= 100


def test_no_program_of_an_exercise(tmp_path: Path) -> None:
    exercise = next((ASSIGNMENTS / "plane-motion").glob("*.yaml"))
    with pytest.raises(NotOfferedError):
        api.build(exercise, tmp_path, listing=True, formats=("html",))


def test_its_curves_are_those_of_displacement_velocity_acceleration_and_torque() -> None:
    """Over the crank's angle from position 1, in degrees, a diagram a unit."""
    tree = api.document(api.load(ASSIGNMENTS / "shaper-01.yaml").with_listing())
    (program,) = (block for block in tree.blocks if type(block).__name__ == "Listing")
    names: dict[str, Any] = {}
    text = "\n".join(program.lines)
    exec(text[: text.index("import sys")].replace("print(", "str("), names)
    assert names["driver"] == pytest.approx(30.0 * np.arange(12))
    assert names["curves"] == {"m": ["s_E"], "m/s": ["v_E"], "m/s2": ["a_E"], "N m": ["M"]}
