"""An assignment opened once with its words, and a machine with all that is computed of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, get_args

from reportgen import catalogue
from reportgen.assignment import Assignment
from reportgen.errors import NotOfferedError
from reportgen.kinds import title as kind_title
from reportgen.notation.numbers import Language
from reportgen.words import load_words, search_path, word

if TYPE_CHECKING:
    import numpy as np

    from reportgen.analysis import Analysis
    from reportgen.flywheel import Flywheel
    from reportgen.ledger.core import Ledger
    from reportgen.ledger.forces.polygon import Polygon
    from reportgen.ledger.report import Written


@dataclass(frozen=True)
class Opened:
    """An assignment with its words; each part is computed when it is first asked for."""

    assignment: Assignment

    @property
    def places(self) -> tuple[Path, ...]:
        """Where the words of this language, machine and school are looked for."""
        assignment = self.assignment
        return search_path(assignment.language, assignment.kind, assignment.report.school or "")

    @cached_property
    def words(self) -> Mapping[str, Any]:
        """The short words of `words.yaml`.  Raises `TemplateError`."""
        return load_words(self.places)

    @property
    def course(self) -> str:
        """The course as the assignment names it; by its standard name, whatever the language, in the case's own."""
        standard: str = self.words["cover"]["course"]
        names = {load_words(search_path(language))["cover"]["course"] for language in get_args(Language)}
        given = self.assignment.report.course
        return given if given and given not in names else standard

    @property
    def title(self) -> str:
        """The machine's name in the assignment's language."""
        return kind_title(self.assignment.kind, self.assignment.language)

    @property
    def variant_line(self) -> str:
        """The variant as headers name it."""
        variant = self.assignment.variant
        return str(self.words["variant"].format(variant=variant)) if variant else ""


@dataclass(frozen=True)
class Calculation(Opened):
    """A machine: its assignment with all that is computed of it."""

    found: tuple[Analysis, Written] | None = field(default=None, compare=False, repr=False)
    """What is known already of a calculation whose drawings alone are others."""

    @cached_property
    def analysis(self) -> Analysis:
        """Everything computed, as arrays over the positions.

        Raises `NotOfferedError` for a kind that is no machine.
        """
        from reportgen.analysis import analyse

        if self.found is not None:
            return self.found[0]
        kind, language = self.assignment.kind, self.assignment.language
        machine = getattr(catalogue.module(kind), "machine", None)
        if machine is None:
            raise NotOfferedError(word("no_machine", language, kind=kind))
        return analyse(machine(self.assignment))

    @cached_property
    def written(self) -> Written:
        """Every number with the force plans, in the symbols and units of the assignment's language."""
        return self._write(printed=True) if self.found is None else self.found[1]

    def _write(self, printed: bool) -> Written:
        from reportgen.ledger.report import write_ledger

        written = write_ledger(self.analysis, self.words["units"], self.assignment.worked_positions, printed)
        return replace(written, ledger=written.ledger.in_language(self.words["symbols"]))

    @property
    def ledger(self) -> Ledger:
        """Every number by its id."""
        return self.written.ledger

    @property
    def polygons(self) -> tuple[Polygon, ...]:
        """The force plans: one for each group, the driver's last; none without loads."""
        return self.written.polygons

    @property
    def flywheel(self) -> Flywheel | None:
        """The flywheel, if the assignment asks for one."""
        return self.written.flywheel

    @cached_property
    def drawn(self) -> Self:
        """The same for drawings alone: sooner there, as no decimals are chosen for its numbers."""
        if "written" in vars(self):
            return self
        return replace(self, found=(self.analysis, self._write(printed=False)))

    def redrawn(self, scales: Mapping[str, float | np.ndarray]) -> Self:
        """The same with drawings to other scales (SI, by id), one or [N]."""
        written = replace(self.written, ledger=self.ledger.redrawn(scales))
        return replace(self, found=(self.analysis, written))
