"""The friction exercises as cases: report and task of each, its key, its results, its drawing sheet.

`CASES` maps the key of a task to its case.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from reportgen.base.records import Record
from reportgen.case import Misconceptions
from reportgen.case.design_case import DesignCase, DesignPage
from reportgen.case.result_entries import ResultEntries
from reportgen.document import Figure
from reportgen.document.template_rendering import Prose
from reportgen.drawing import Scene
from reportgen.drawing.drawing_sheet import ENLARGED, lettered
from reportgen.drawing.figure_scale import IN_REPORT, FigureSize
from reportgen.drawing.plates import DrawingPlate, enlargeable
from reportgen.formula.calculation import Calculation
from reportgen.friction import brake_drawings, exercise_calculations, exercise_drawings, exercise_mistakes


class FrictionTask(Record):
    """Functions that make the calculation and the drawings of a task: its scheme, and its force plans if it has any."""

    name: str
    calculate: Callable[[Any], Calculation]
    scheme: Callable[[FrictionCase], Scene]
    plans: Callable[[FrictionCase, FigureSize], tuple[Scene, ...]] | None = None


@dataclass(frozen=True)
class FrictionPage(DesignPage["FrictionCase"]):
    """A friction exercise for its templates."""

    NAME = "friction"

    def names(self) -> dict[str, Any]:
        case, written = self.case, self.case.printed
        return {
            **self.shared_names,
            "data": self.data,
            "sheet": {name: written.known(quantities) for name, quantities in written.lines.items()},
            "holds": case.holds,
        }

    def figure(self, name: str) -> Figure:
        caption = Prose(self.case.places).inlines(self.words["figures"][self.case.TASK.name][name])
        return Figure(tuple(self.scenes(name)), caption, f"fig.{name}")

    def scenes(self, name: str) -> Iterable[Scene]:
        if name == "scheme":
            return (self.case.TASK.scheme(self.case),)
        draw = self.case.TASK.plans
        return draw(self.case, IN_REPORT) if draw else super().scenes(name)


@dataclass(frozen=True)
class FrictionCase(DesignCase):
    """A friction exercise, as a `Case`."""

    TASK: ClassVar[FrictionTask]

    @property
    def given(self) -> Any:
        """The data of the task."""
        return getattr(self.assignment.parameters, self.TASK.name)

    @cached_property
    def calculation(self) -> Calculation:
        return self.TASK.calculate(self.given)

    @property
    @abstractmethod
    def holds(self) -> Mapping[str, bool]:
        """Conditions that the templates use, with their truth values."""

    @property
    @abstractmethod
    def locks(self) -> bool | None:
        """True if it is self-locking; None for a task that cannot lock."""

    def at(self, name: str) -> float:
        """Return a result (SI) by the end of its id; 0 if the task does not have it."""
        id = f"friction.{self.TASK.name}.{name}"
        return float(self.ledger[id].at(1)) if id in self.ledger else 0.0

    @cached_property
    def entries(self) -> ResultEntries:
        """All results by the ends of their ids, and whether the task is self-locking if it can be."""
        head = f"friction.{self.TASK.name}."
        results: dict[str, Any] = {
            id.removeprefix(head): family.at(1)
            for id, family in self.ledger.families.items()
            if family.definition is not None and not family.hidden
        }
        if self.locks is not None:
            results["self_locking"] = self.locks
        return ResultEntries([{"number": 1, self.TASK.name: results}])

    @cached_property
    def misconceptions(self) -> Misconceptions:
        return Misconceptions(changed=exercise_mistakes.changed(self.TASK.name, self.calculation))

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return its scheme and its force plans; `sets` is ignored, since there is only one."""
        return {"friction": [*self._plates()]}

    def _plates(self) -> Iterator[DrawingPlate]:
        titles = self.words["friction"]["figures"][self.TASK.name]
        scheme = lettered(self.TASK.scheme(self))
        yield DrawingPlate(titles["scheme"], (), "scheme", (scheme,))
        if (draw := self.TASK.plans) is not None:

            def plate(steps: int) -> DrawingPlate:
                size = FigureSize(steps, ENLARGED, self.words["plates"]["report"], self.assignment.language)
                return DrawingPlate(titles["plan"], (), "plans", tuple(map(lettered, draw(self, size))))

            yield enlargeable(plate)


# --- the exercises ----------------------------------------------------------------------------------


@dataclass(frozen=True)
class InclinePage(FrictionPage):
    TASK, SUMMARY = "incline-task", "incline-summary"
    SECTIONS = (
        *("incline-given", "incline-scheme", "incline-raising", "incline-lowering", "incline-efficiency"),
        "incline-conclusion",
    )


@dataclass(frozen=True)
class InclineCase(FrictionCase):
    """A body on an inclined plane."""

    PAGE = InclinePage
    TASK = FrictionTask(
        "incline",
        exercise_calculations.incline_calculation,
        exercise_drawings.incline_scheme,
        exercise_drawings.incline_plans,
    )

    @property
    def locks(self) -> bool:
        return self.at("alpha") <= self.at("phi")

    @property
    def holds(self) -> Mapping[str, bool]:
        return {"locks": self.locks, "is_along": not self.at("beta"), "is_horizontal": self.given.beta is None}


@dataclass(frozen=True)
class WedgePage(FrictionPage):
    TASK, SUMMARY = "wedge-task", "wedge-summary"
    SECTIONS = (
        *("wedge-given", "wedge-scheme", "wedge-raising", "wedge-lowering", "wedge-efficiency"),
        "wedge-conclusion",
    )


@dataclass(frozen=True)
class WedgeCase(FrictionCase):
    """A wedge under a load."""

    PAGE = WedgePage
    TASK = FrictionTask(
        "wedge", exercise_calculations.wedge_calculation, exercise_drawings.wedge_scheme, exercise_drawings.wedge_plans
    )

    @property
    def locks(self) -> bool:
        return self.at("alpha") <= self.at("phi1") + self.at("phi2")

    @property
    def holds(self) -> Mapping[str, bool]:
        leans_back = self.at("alpha") < self.at("phi1")
        return {"locks": self.locks, "rough_guide": bool(self.at("phi3")), "leans_back": leans_back}


@dataclass(frozen=True)
class ScrewPage(FrictionPage):
    TASK, SUMMARY = "screw-task", "screw-summary"
    SECTIONS = (
        *("screw-given", "screw-scheme", "screw-raising", "screw-lowering", "screw-efficiency"),
        "screw-conclusion",
    )


@dataclass(frozen=True)
class ScrewCase(FrictionCase):
    """A screw under a load."""

    PAGE = ScrewPage
    TASK = FrictionTask("screw", exercise_calculations.screw_calculation, exercise_drawings.screw_scheme)

    @property
    def locks(self) -> bool:
        return self.at("lowering.M") >= 0

    @property
    def holds(self) -> Mapping[str, bool]:
        thread = self.at("gamma") <= self.at("phi")
        return {
            "thread_locks": thread,
            "collar_holds": self.locks and not thread,
            "has_collar": self.given.collar is not None,
            "has_profile": bool(self.given.beta.si),
        }


@dataclass(frozen=True)
class BeltPage(FrictionPage):
    TASK, SUMMARY = "belt-task", "belt-summary"
    SECTIONS = ("belt-given", "belt-scheme", "belt-tensions", "belt-axle", "belt-conclusion")


@dataclass(frozen=True)
class BeltCase(FrictionCase):
    """A belt on a drum."""

    PAGE = BeltPage
    TASK = FrictionTask("belt", exercise_calculations.belt_calculation, brake_drawings.belt_scheme)

    @property
    def locks(self) -> None:
        """None: a belt slips as soon as the torque is larger."""

    @property
    def holds(self) -> Mapping[str, bool]:
        return {"has_width": self.given.b is not None, "torque_given": self.given.M is not None}


@dataclass(frozen=True)
class BandPage(FrictionPage):
    TASK, SUMMARY = "band-task", "band-summary"
    SECTIONS = ("band-given", "band-scheme", "band-tensions", "band-lever", "band-conclusion")


@dataclass(frozen=True)
class BandCase(FrictionCase):
    """A band brake."""

    PAGE = BandPage
    TASK = FrictionTask("band", exercise_calculations.band_calculation, brake_drawings.band_scheme)

    @property
    def locks(self) -> bool:
        return min(self.at("P"), self.at("backward.P")) <= 0

    @property
    def holds(self) -> Mapping[str, bool]:
        return {"locks_forward": self.at("P") <= 0, "locks_backward": self.at("backward.P") <= 0}


@dataclass(frozen=True)
class ShoePage(FrictionPage):
    TASK, SUMMARY = "shoe-task", "shoe-summary"
    SECTIONS = ("shoe-given", "shoe-scheme", "shoe-forces", "shoe-lever", "shoe-conclusion")


@dataclass(frozen=True)
class ShoeCase(FrictionCase):
    """A brake with one shoe."""

    PAGE = ShoePage
    TASK = FrictionTask("shoe", exercise_calculations.shoe_calculation, brake_drawings.shoe_scheme)

    @property
    def locks(self) -> bool:
        return self.at("P") <= 0

    @property
    def holds(self) -> Mapping[str, bool]:
        return {"locks": self.locks}


CASES: Mapping[str, type[FrictionCase]] = {
    case.TASK.name: case for case in (InclineCase, WedgeCase, ScrewCase, BeltCase, BandCase, ShoeCase)
}
"""The cases by the keys of their tasks."""
