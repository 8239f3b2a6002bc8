"""The printed task alone is enough: the assignment that it states has the results of the one it was printed from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml

from reportgen import api
from reportgen.base.units import Language
from reportgen.cases import open_case
from reportgen.marking.task_paper import task_of
from reportgen.marking.toleranced_key import key_of
from tests.lanes import matrix
from tests.report import built, exercise_reader
from tests.report.task_reader import file_of
from tests.told import told

SHORT = 1e-9
"""Of the largest value: a printed quantity is in other units than the typed one."""
LONG = 1e-4
"""Where a length was typed with more figures than a task prints, which are five."""

ROUNDED = 2e-5
"""Coordinates of exercises are printed with six figures; a system may magnify what that leaves out."""
EXERCISES = sorted((built.ROOT / "assignments" / "plane-motion").glob("*.yaml"))

CHANGES: tuple[tuple[str, Mapping[str, Any]], ...] = (
    *(
        ("slider-crank-02", {"parameters": {"force": {"by": "constant", "F": size, "stroke": stroke}}})
        for size in ("50 N", "-50 N")
        for stroke in ("inward", "outward", "both")
    ),
    ("slider-crank-01", {"positions": {"direction": "clockwise"}, "parameters": {"guide": "30 deg", "e": "40 mm"}}),
    (
        "slider-crank-01",
        {
            "positions": {"start": "12.5 deg"},
            "parameters": {
                "force": {
                    "by": "crank_angle",
                    "unit": "N",
                    "angle": ["0 deg", "90 deg", "360 deg"],
                    "F": ["0", "60", "0"],
                }
            },
        },
    ),
    ("scotch-yoke-01", {"parameters": {"force": {"by": "constant", "F": "-900 N", "stroke": "outward"}}}),
    ("scotch-yoke-01", {"parameters": {"guide": "25 deg", "force": {"by": "constant", "F": "90 N", "stroke": "both"}}}),
    ("engine-v-02", {"parameters": {"second_top": "1"}, "positions": {"start": "20 deg"}}),
    ("engine-twin-05", {"positions": {"direction": "clockwise"}, "indicator": {"firing": ["intake", "exhaust"]}}),
    ("engine-single-V", {"positions": {"start": "60 deg", "direction": "anticlockwise"}}),
    ("four-bar-01", {"parameters": {"branch": "crossed", "torque": {"M": "40 N m", "sense": "clockwise"}}}),
    ("four-bar-01", {"parameters": {"frame": "10 deg", "force": {"P": "80 N", "angle": "-60 deg"}}}),
    ("lever-six-bar-01", {"parameters": {"force": {"P": "400 N", "sense": "left"}}}),
    ("slotted-lever-02", {"parameters": {"axis": "75 deg", "torque": {"M": "24 N m", "sense": "anticlockwise"}}}),
    ("shaper-02", {"positions": {"start": "45 deg", "direction": "clockwise"}}),
    (
        "linkage-slide",
        {"parameters": {"loads": [{"by": "constant", "link": "5", "at": "F", "F": "70 N", "direction": "90 deg"}]}},
    ),
    (
        "linkage-slide",
        {
            "positions": {"count": None, "at": ["40 mm", "100 mm"]},
            "report": {"worked_positions": None},
            "parameters": {"driver": {"start": "10 mm", "end": "130 mm", "acceleration": "-2 m/s2"}},
        },
    ),
    (
        "four-bar-01",
        {
            "parameters": {
                "springs": [
                    {"link": "3", "about": "D", "c": "5 N m/rad", "free": "100 deg"},
                    {"link": "2", "at": "E", "to": "D", "c": "1 N/mm", "free": "20 mm"},
                    {"link": "3", "at": "C", "to": ["300 mm", "-20 mm"], "c": "4 N/mm", "free": "90 mm"},
                    {"link": "2", "at": "F", "to": {"link": "1", "at": "B"}, "c": "2 N/mm"},
                ]
            }
        },
    ),
    (
        "linkage-8",
        {
            "positions": {"count": None, "at": ["50 deg", "230 deg"]},
            "report": {"worked_positions": None},
            "parameters": {
                "driver": {"epsilon1": "-15 rad/s2"},
                "plane": "horizontal",
                "masses": [{"link": "2", "at": "E", "m": "3 kg", "J": "0.012 kg m2"}],
                "springs": [{"link": "2", "at": "E", "to": {"link": "7", "at": "K"}, "c": "2 N/mm", "free": "30 mm"}],
                "faces": {"7": {"from": "-20 mm", "to": "30 mm", "below": "12 mm"}},
            },
        },
    ),
)


def _with(content: dict[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """A file's content with other values; a load is replaced as a whole."""
    result = dict(content)
    for key, value in changes.items():
        whole = key in ("force", "torque") or not isinstance(value, Mapping)
        result[key] = value if whole else _with(result.get(key, {}), value)
    return result


def numbers(of: Any) -> Iterator[float]:
    """All numbers of results, in the order of their names."""
    match of:
        case bool() | str() | None:
            return
        case int() | float():
            yield float(of)
        case dict():
            for key in sorted(of):
                yield from numbers(of[key])
        case list():
            for one in of:
                yield from numbers(one)


def shape(of: Any) -> Any:
    """What results are like but for their numbers."""
    match of:
        case dict():
            return {key: shape(value) for key, value in of.items() if key != "variant"}
        case list():
            return [shape(value) for value in of]
        case int() | float():
            return 0.0
    return of


def assert_same(one: Any, other: Any, tolerance: float) -> None:
    """Both have the same entries, and each quantity the same values beside its largest one over the positions."""
    assert shape(one) == shape(other)
    for name in one["positions"][0]:
        first, second = ([list(numbers(k[name])) for k in results["positions"]] for results in (one, other))
        largest = max((abs(value) for row in first for value in row), default=0.0)
        for row, twin in zip(first, second, strict=True):
            assert twin == pytest.approx(row, abs=tolerance * max(largest, 1e-12)), name


@pytest.mark.parametrize("path", matrix(built.FILES, built.TELLING), ids=lambda path: path.stem)
def test_the_printed_task_gives_the_same_results(path: Path, tmp_path: Path) -> None:
    compare(path, tmp_path)


@pytest.mark.parametrize(("stem", "changes"), matrix(CHANGES, CHANGES[::3]))
def test_so_does_a_task_with_other_choices(stem: str, changes: Mapping[str, Any], tmp_path: Path) -> None:
    content = yaml.load((built.ROOT / "assignments" / f"{stem}.yaml").read_text(encoding="utf-8"), yaml.BaseLoader)
    path = tmp_path / f"{stem}.yaml"
    path.write_text(yaml.safe_dump(_with(content, changes), allow_unicode=True, sort_keys=False), encoding="utf-8")
    compare(path, tmp_path)


@pytest.mark.parametrize("path", matrix(EXERCISES, EXERCISES[3::4]), ids=lambda path: path.stem)
def test_the_printed_exercise_gives_the_same_results(path: Path, tmp_path: Path) -> None:
    compare(path, tmp_path, ROUNDED)


def compare(path: Path, folder: Path, tolerance: float = SHORT) -> None:
    """The results of a file, and of the one that its English task states."""
    case = open_case(path, "en")
    text = told(task_of(case, key_of(case)))
    kind = case.assignment.kind
    stated = exercise_reader.file_of(text) if kind == "plane-motion" else file_of(kind, text)
    written = folder / "stated.yaml"
    written.write_text(yaml.safe_dump(stated, allow_unicode=True, sort_keys=False), encoding="utf-8")
    exact = "0.565685424949238" not in path.read_text(encoding="utf-8")
    assert_same(api.solve(api.load(path)), api.solve(api.load(written)), tolerance if exact else LONG)


@pytest.mark.parametrize(
    ("language", "words"),
    [
        ("en", "acts only on the way inward (towards the crank) and opposes the motion there"),
        ("vi", "ngược chiều chuyển động"),
    ],
)
def test_task_data_and_section_tell_of_a_constant_force(language: Language, words: str) -> None:
    """50 N along the guide, away from the crank, on the way inward: against the motion."""
    case = open_case(built.ROOT / "assignments" / "slider-crank-02.yaml", language)
    assert told(task_of(case, key_of(case))).count(words) == 1
    # In the assignment and in section 2.1.
    assert told(case.document()).count(words) == 2
