"""Wrong files of exercises of plane motion: every fault where it stands, and what is not determined by its bodies."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import api
from reportgen.catalogue import check, load
from reportgen.errors import NotOfferedError

BASE = """\
kind: plane-motion
parameters:
  points:
    O: {at: [0 m, 0 m]}
    A: {from: O, distance: 0.2 m, angle: 45 deg}
    B: {from: A, distance: 1 m, angle: -45 deg}
  bodies:
    1: {points: [O, A]}
    2: {points: [A, B]}
  joints:
    - {type: pin, at: O, bodies: [0, 1]}
    - {type: pin, at: A, bodies: [1, 2]}
    - {type: slot, point: B, body: 2, angle: 0 deg}
  given:
    - {type: omega, body: 1, value: 10 rad/s}
    - {type: epsilon, body: 1, value: 0 rad/s2}
  find: [v.A, omega.2, a.B, eps.2]
"""
WHEELS = """\
kind: plane-motion
parameters:
  points:
    D: {at: [0 m, 0 m]}
    C: {at: [0 m, 1 m]}
    E: {at: [0 m, 3 m]}
  bodies:
    1: {points: [D], disc: {centre: C, radius: 1 m}}
    2: {disc: {centre: E, radius: 1 m}}
  joints:
    - {type: rolling on line, disc: 1, through: D, angle: 0 deg}
    - {type: pin, at: E, bodies: [0, 2]}
    - {type: gears, discs: [1, 2]}
  given:
    - {type: velocity, point: C, size: 2 m/s, direction: 0 deg}
  find: [omega.1, omega.2]
"""

THREE_RODS = """\
kind: plane-motion
parameters:
  points:
    O: {at: [0 m, 0 m]}
    A: {at: [0.1 m, 0.2 m]}
    D: {at: [0.4 m, 0.7 m]}
    B: {at: [1.1 m, 0.2 m]}
    E: {at: [0.8 m, 0.6 m]}
    C: {at: [0.9 m, 1.5 m]}
    F: {at: [0.5 m, 1.1 m]}
  bodies:
    1: {points: [O, A, B]}
    2: {points: [A, D]}
    3: {points: [B, E]}
    4: {points: [D, E, F]}
    5: {points: [C, F]}
  joints:
    - {type: pin, at: O, bodies: [0, 1]}
    - {type: pin, at: A, bodies: [1, 2]}
    - {type: pin, at: D, bodies: [2, 4]}
    - {type: pin, at: B, bodies: [1, 3]}
    - {type: pin, at: E, bodies: [3, 4]}
    - {type: pin, at: F, bodies: [4, 5]}
    - {type: slot, point: C, body: 5, angle: 20 deg}
  given:
    - {type: omega, body: 1, value: 2 rad/s}
    - {type: omega, body: 5, value: 1 rad/s}
  find: [v.D]
"""

ON_A_PLATE = """\
kind: plane-motion
parameters:
  points:
    O: {at: [0 m, 0 m]}
    K: {at: [0.3 m, 0 m]}
    C: {at: [0.3 m, 0.1 m]}
    M: {at: [0.4 m, 0.1 m]}
  bodies:
    1: {points: [O, K]}
    2: {points: [M], disc: {centre: C, radius: 0.1 m}}
  joints:
    - {type: pin, at: O, bodies: [0, 1]}
    - {type: rolling on line, disc: 2, on: 1, through: K, angle: 0 deg}
  given:
    - {type: omega, body: 1, value: 2 rad/s}
    - {type: epsilon, body: 1, value: 1 rad/s2}
    - {type: omega, body: 2, value: -3 rad/s}
    - {type: epsilon, body: 2, value: 0 rad/s2}
  find: [v.M, a.M]
"""
"""A disc that rolls along a plate that turns."""

# (name, the file, what is replaced in it, by what, the faults expected)
EDITS = [
    ("point without a place", BASE, "{at: [0 m, 0 m]}", "{}", ["4:8 missing-key"]),
    ("two places", BASE, "O: {at: [0 m, 0 m]}", "O: {at: [0 m, 0 m], from: A}", ["4:25 both-given"]),
    ("distance without a way", BASE, ", angle: 45 deg", "", ["5:8 missing-key"]),
    ("later point", BASE, "from: O", "from: B", ["5:15 no-such-point"]),
    ("unknown point of a body", BASE, "2: {points: [A, B]}", "2: {points: [A, X, B]}", ["9:21 no-such-point"]),
    (
        "body without points",
        BASE,
        "2: {points: [A, B]}",
        "2: {points: []}",
        ["9:8 missing-key", "12:38 not-on-body", "13:36 not-on-body", "17:24 point-at-rest"],
    ),
    ("kind of joint", BASE, "type: pin, at: O", "type: screw, at: O", ["11:14 choice"]),
    ("unknown body", BASE, "bodies: [1, 2]}", "bodies: [1, 7]}", ["12:38 no-such-body"]),
    ("body joined to itself", BASE, "bodies: [1, 2]}", "bodies: [1, 1]}", ["12:38 same-body"]),
    ("pin beside its body", BASE, "at: A, bodies", "at: O, bodies", ["12:38 not-on-body"]),
    ("line without direction", BASE, "body: 2, angle: 0 deg}", "body: 2}", ["13:7 missing-key"]),
    ("line of one point", BASE, "angle: 0 deg}\n", "along: [A, A]}\n", ["13:50 same-point"]),
    (
        "rate of a fixed point",
        BASE,
        "{type: omega, body: 1, value: 10 rad/s}",
        "{type: velocity, point: Z, direction: 0 deg}",
        ["15:31 no-such-point"],
    ),
    ("wrong unit", BASE, "10 rad/s}", "10 m/s}", ["15:37 wrong-unit"]),
    ("no such quantity", BASE, "find: [v.A", "find: [w.A", ["17:10 no-asked-quantity"]),
    ("velocity of a body", BASE, "find: [v.A", "find: [v.2", ["17:10 no-asked-quantity"]),
    ("positions of an exercise", BASE, "parameters:\n", "positions: {count: 8}\nparameters:\n", ["2:1 unknown-key"]),
    (
        "ε not given",
        BASE,
        "    - {type: epsilon, body: 1, value: 0 rad/s2}\n",
        "",
        ["16:24 undetermined", "16:29 undetermined"],
    ),
    (
        "guide missing",
        BASE,
        "    - {type: slot, point: B, body: 2, angle: 0 deg}\n",
        "",
        ["16:15 undetermined", "16:24 undetermined", "16:29 undetermined"],
    ),
    (
        "two speeds",
        BASE,
        "    - {type: epsilon",
        "    - {type: velocity, point: B, size: 1 m/s, direction: 0 deg}\n    - {type: epsilon",
        ["16:7 contradiction"],
    ),
    ("method of no name", BASE, "find: [v.A", "methods: [guessing]\n  find: [v.A", ["17:13 choice"]),
    (
        "method named twice",
        BASE,
        "find: [v.A",
        "methods: [projection, projection]\n  find: [v.A",
        ["17:25 method-repeated"],
    ),
    ("no moving frame", BASE, "find: [v.A", "methods: [moving frame]\n  find: [v.A", ["17:13 no-moving-frame"]),
    ("no component", WHEELS, "find: [omega.1", "methods: [projection]\n  find: [omega.1", ["16:13 no-projection"]),
    ("disc above its line", WHEELS, "[0 m, 1 m]", "[0 m, 1.1 m]", ["11:7 no-contact"]),
    (
        "circles apart",
        BASE,
        "{from: A, distance: 1 m, angle: -45 deg}",
        "{distances: [{from: O, distance: 1 m}, {from: A, distance: 0.7 m}]}",
        ["6:20 circles-apart"],
    ),
    (
        "belt about discs in each other",
        WHEELS,
        "gears, discs: [1, 2]",
        "belt, crossed: true, discs: [1, 2]",
        ["13:7 belt-too-short"],
    ),
    ("gears apart", WHEELS, "[0 m, 3 m]", "[0 m, 4 m]", ["13:7 no-contact-of-discs"]),
    (
        "no disc",
        WHEELS,
        "1: {points: [D], disc: {centre: C, radius: 1 m}}",
        "1: {points: [D, C]}",
        ["11:37 no-disc", "13:29 no-disc"],
    ),
]


SYMBOLS = BASE.replace("parameters:\n", "parameters:\n  symbols: {r: 0.2 m, l: 1 m, omega: 10 rad/s}\n")
EDITS += [
    ("no such symbol", SYMBOLS, "distance: 0.2 m", "distance: 2*r + q", ["6:28 no-such-symbol"]),
    ("no formula", SYMBOLS, "distance: 0.2 m", "distance: r l", ["6:28 no-formula"]),
    ("no call", SYMBOLS, "distance: 0.2 m", "distance: exp(r)", ["6:28 no-formula"]),
    ("unlike terms", SYMBOLS, "distance: 0.2 m", "distance: r + omega", ["6:28 unlike-terms"]),
    ("formula of another kind", SYMBOLS, "value: 10 rad/s", "value: r*omega", ["16:37 wrong-unit"]),
    ("formula out of range", SYMBOLS, "distance: 0.2 m", "distance: r - l", ["6:28 out-of-range"]),
    ("symbol without unit", SYMBOLS, "r: 0.2 m", "r: 2", ["3:16 missing-unit"]),
    ("symbol of no length", SYMBOLS, "r: 0.2 m", "r: -0.2 m", ["3:16 out-of-range"]),
    ("symbol of another body", SYMBOLS, "omega: 10", "omega2: 10", ["3:31 symbol-of-body"]),
    ("symbol of no rotation", SYMBOLS, "omega: 10 rad/s", "omega1: 10 rad/s", ["3:31 symbol-of-body"]),
    ("name of a symbol", SYMBOLS, "{r: 0.2 m", "{r_1: 0.2 m", ["3:13 symbol-name"]),
    (
        "moves at these values alone",
        WHEELS.replace("parameters:\n", "parameters:\n  symbols: {r: 1 m}\n"),
        "2: {disc: {centre: E, radius: 1 m}}",
        "2: {disc: {centre: E, radius: r}}",
        ["3:12 only-at-values"],
    ),
]


@pytest.mark.parametrize(("name", "base", "old", "new", "expected"), EDITS, ids=[edit[0] for edit in EDITS])
@pytest.mark.parametrize("language", ["vi", "en"])
def test_fault(name: str, base: str, old: str, new: str, expected: list[str], language: str, tmp_path: Path) -> None:
    assert base.count(old) == 1
    path = tmp_path / "file.yaml"
    path.write_text(base.replace(old, new), encoding="utf-8")
    found = check(path, "vi" if language == "vi" else "en")
    assert [f"{p.mark.line}:{p.mark.column} {p.code}" for p in found] == expected


def told(tmp_path: Path, content: str) -> str:
    path = tmp_path / "file.yaml"
    path.write_text(content, encoding="utf-8")
    return "\n".join(str(problem) for problem in check(path, "en"))


@pytest.mark.parametrize(
    ("size", "expected"), [("-3", []), ("1", []), ("2.001", ["12 points-part"]), ("3", ["12 points-part"])]
)
def test_points_of_a_rigid_body_have_no_accelerations_away_from_each_other(
    tmp_path: Path, size: str, expected: list[str]
) -> None:
    """Along AB, which is x, a_B − a_A = −ω² l cannot be positive."""
    content = f"""kind: plane-motion
parameters:
  points:
    A: {{at: [0 mm, 0 mm]}}
    B: {{at: [200 mm, 0 mm]}}
  bodies:
    1: {{points: [A, B]}}
  find: [omega.1]

  given:
    - {{type: acceleration, point: A, size: 2 m/s2, direction: 0 deg}}
    - {{type: acceleration, point: B, size: {size} m/s2, direction: 0 deg}}
"""
    path = tmp_path / "file.yaml"
    path.write_text(content, encoding="utf-8")
    assert [f"{problem.mark.line} {problem.code}" for problem in check(path, "en")] == expected


def test_a_contradiction_names_both_sides(tmp_path: Path) -> None:
    second = "    - {type: velocity, point: B, size: 1 m/s, direction: 0 deg}\n    - {type: epsilon"
    message = told(tmp_path, BASE.replace("    - {type: epsilon", second))
    assert "velocity B contradicts pin O, pin A, slot B, omega 1" in message


def test_accelerations_may_contradict_where_velocities_do_not(tmp_path: Path) -> None:
    """The crank says what the acceleration of B is; another one is refused beside what it stands against."""
    second = "    - {type: acceleration, point: B, size: 1 m/s2, direction: 0 deg}\n    - {type: epsilon"
    message = told(tmp_path, BASE.replace("    - {type: epsilon", second))
    assert "contradicts" in message
    assert "accelerations" in message
    assert all(name in message for name in ("pin O", "pin A", "slot B", "acceleration B"))


def test_a_direction_may_contradict_a_guide(tmp_path: Path) -> None:
    second = "    - {type: velocity, point: B, direction: 90 deg}\n    - {type: epsilon"
    message = told(tmp_path, BASE.replace("    - {type: epsilon", second))
    assert "velocity B contradicts" in message


def test_what_is_said_twice_is_no_fault(tmp_path: Path) -> None:
    """A second guide along the first, and a rate that follows from the others, are passive."""
    again = "    - {type: slot, point: B, body: 2, angle: 180 deg}\n  given:\n"
    text = BASE.replace("  given:\n", again)
    text = text.replace(
        "    - {type: epsilon",
        "    - {type: velocity, point: A, size: 2 m/s, direction: 135 deg}\n    - {type: epsilon",
    )
    assert told(tmp_path, text) == ""


def test_two_discs_on_one_line_turn_alike_or_contradict(tmp_path: Path) -> None:
    """Two wheels on the ground with a rod between their centres: a second velocity for one is too much."""
    text = WHEELS.replace("{at: [0 m, 3 m]}", "{at: [3 m, 1 m]}").replace(
        "    - {type: pin, at: E, bodies: [0, 2]}\n    - {type: gears, discs: [1, 2]}\n",
        "    - {type: rolling on line, disc: 2, through: D, angle: 0 deg}\n    - {type: cord, points: [C, E]}\n",
    )
    assert told(tmp_path, text) == ""
    more = "    - {type: velocity, point: E, size: 1 m/s, direction: 0 deg}\n  find"
    message = told(tmp_path, text.replace("  find", more))
    assert "velocity E contradicts" in message
    assert "cord C E" in message


def test_what_stays_open_is_named(tmp_path: Path) -> None:
    message = told(tmp_path, BASE.replace("    - {type: slot, point: B, body: 2, angle: 0 deg}\n", ""))
    assert "omega.2 does not follow" in message
    assert "stays open: 2" in message


def test_distances_of_what_does_not_touch_are_told(tmp_path: Path) -> None:
    message = told(tmp_path, WHEELS.replace("[0 m, 1 m]", "[0 m, 1.1 m]"))
    assert "1100 mm" in message
    assert "1000 mm" in message


LEVER = """\
kind: plane-motion
parameters:
  points:
    O: {at: [0 m, 0 m]}
    A: {at: [1 m, 0 m]}
  bodies:
    1: {points: [O, A]}
  joints:
    - {type: pin, at: O, bodies: [0, 1]}
  given:
    - {type: omega, body: 1, value: 2 rad/s}
  find: [v.A]
  methods: [base point]
"""


def test_what_turns_about_a_fixed_point_needs_no_method(tmp_path: Path) -> None:
    assert ":13:13: " in told(tmp_path, LEVER)
    assert "no body is in plane motion" in told(tmp_path, LEVER)


@pytest.mark.parametrize(
    ("method", "why"),
    [
        ("instant centre", "whose directions of motion are known"),
        ("base point", "two points that move along known lines"),
    ],
)
def test_a_method_that_cannot_apply_says_why(method: str, why: str, tmp_path: Path) -> None:
    """The rods of THREE_RODS have no two guided points."""
    assert why in told(tmp_path, THREE_RODS + f"  methods: [{method}]\n")


@pytest.mark.parametrize("base", [BASE, WHEELS])
def test_the_bases_are_in_order(base: str, tmp_path: Path) -> None:
    assert told(tmp_path, base) == ""


def test_what_is_not_offered_is_told_in_one_line(tmp_path: Path) -> None:
    """Drawing sheets need a machine; a solution needs steps that are known."""
    path = tmp_path / "file.yaml"
    path.write_text(BASE, encoding="utf-8")
    with pytest.raises(NotOfferedError, match="--positions"):
        api.solve(load(path, "en"), 12)
    with pytest.raises(NotOfferedError, match="plane-motion"):
        api.sheet_files(path, "typst", "en")
    path.write_text(ON_A_PLATE, encoding="utf-8")
    with pytest.raises(NotOfferedError, match=r"a\.M"):
        api.document(load(path, "en"))
    assert api.solve(load(path))["positions"][0]["points"]["M"]["a"] is not None
