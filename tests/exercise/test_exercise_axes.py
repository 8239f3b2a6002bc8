"""The axes in an exercise's figures are those that its equations are projected on: each line is checked along them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from reportgen import api
from reportgen.drawing import Arrow
from reportgen.exercise.case import ExerciseCase
from reportgen.exercise.derivation import Axis, Step, Vector
from reportgen.exercise.figures import FIGURES
from reportgen.exercise.ledger import Worked
from reportgen.exercise.views import COORDINATES, Axes, Solution
from reportgen.formula import refs
from reportgen.formula.evaluation import evaluate

FOLDER = Path(__file__).parents[2] / "assignments" / "plane-motion"
FILES = sorted(FOLDER.glob("*.yaml"))
BY_NAME = {"ξ": "along", "η": "across"}


def drawn(case: ExerciseCase, what: str) -> dict[str, complex]:
    """The directions of the axes in a figure by the letters that stand at them."""
    figure = FIGURES[what](case)
    assert figure is not None
    arrows = [item for item in figure[0].items if isinstance(item, Arrow) and item.name]
    assert len({arrow.name for arrow in arrows}) == len(arrows)
    return {arrow.name: (arrow.end - arrow.start) / abs(arrow.end - arrow.start) for arrow in arrows}


def projections(case: ExerciseCase) -> Iterator[tuple[Worked, Step, int, Axis]]:
    for worked in (case.worked, *case.further):
        for step in worked.steps:
            yield from ((worked, step, index, axis) for index, axis in enumerate(step.axes))


def sides(worked: Worked, step: Step) -> tuple[list[Vector], list[Vector]]:
    """The vectors of the step's equation; by the theorem of projections the velocity of one point equals another's."""
    if step.equation is not None:
        return [*step.equation.left], [*step.equation.right]
    motion = worked.layout.motion
    whole, base = (Vector(f"v.{one}", motion.v(one) / abs(motion.v(one))) for one in (step.point, step.base))
    return [whole], [base]


def projected(worked: Worked, step: Step, index: int, axis: Axis) -> str:
    """The id of what the step finds along an axis."""
    if axis.letter in ("x", "y"):
        return f"{'a' if step.of_accelerations else 'v'}.{step.point}.{axis.letter}"
    return step.equation.unknown[index] if step.equation is not None else f"v.{step.point}"


def factors(worked: Worked, step: Step, id: str, n: complex) -> dict[str, float]:
    """What each vector's size is multiplied by in the equation along n, solved for a quantity."""
    left, right = sides(worked, step)
    found = next((one for one in (*left, *right) if one.id == id), None)
    if found is None:
        # A component of the sum of all vectors of the right side.
        return {one.id: (n.conjugate() * one.direction).real for one in right}
    own, other = (left, right) if found in left else (right, left)
    parts = [*((one, -1) for one in own if one is not found), *((one, 1) for one in other)]
    return {
        one.id: sign * (n.conjugate() * one.direction).real / (n.conjugate() * found.direction).real
        for one, sign in parts
    }


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_line_is_its_equation_along_the_drawn_axis(path: Path) -> None:
    """A line is linear in the sizes of vectors, each with the factor that the drawn axis gives it."""
    case = ExerciseCase(api.load(path, "en"))
    axes = Axes((case.worked, *case.further))
    for worked, step, index, axis in projections(case):
        symbol = axes.symbol(step, axis.letter)
        n = drawn(case, "acceleration" if step.of_accelerations else "velocity")[symbol.base + symbol.sub]
        id = projected(worked, step, index, axis)
        definition = worked.ledger[id].definition
        assert definition is not None
        angles = {one: float(worked.ledger[one].values[0]) for one in refs(definition) if one.startswith("alpha.")}
        used, expected = {*refs(definition)} - {*angles}, factors(worked, step, id, n)
        assert used <= {*expected}
        for one, factor in expected.items():
            if one in used:
                sizes = {**dict.fromkeys(used, 0.0), one: 1.0}
                assert float(evaluate(definition, {**angles, **sizes})) == pytest.approx(factor, abs=1e-7)
            elif one in worked.ledger:
                assert abs(factor * float(worked.ledger[one].values[0])) < 1e-9


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_the_words_name_the_drawn_axes(path: Path) -> None:
    """ξ is one axis a line, and the words of a step call an axis as the figure does."""
    case = ExerciseCase(api.load(path, "en"))
    axes, names = Axes((case.worked, *case.further)), set()
    for worked, step, _, axis in projections(case):
        view = Solution(case, worked).steps[worked.steps.index(step)]
        if axis.letter in BY_NAME:
            symbol = getattr(view, BY_NAME[axis.letter])
            assert symbol == axes.symbol(step, axis.letter)
            names.add((step.of_accelerations, symbol.base + symbol.sub))
        assert view.on_coordinates if axis.letter in COORDINATES else axis.letter != "ξ" or view.on_line
    for accelerations, name in names:
        assert name in drawn(case, "acceleration" if accelerations else "velocity")
