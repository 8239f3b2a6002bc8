"""The page of one assignment file a kind, each made once a run."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reportgen.base.units import Language
from reportgen.cases import MachineCase
from reportgen.drawing.film import Film, Stage, Track
from reportgen.machine.analysis import Analysis, analyse
from reportgen.page import page
from reportgen.page.sampling import film
from reportgen.report.report import Report
from tests.lanes import matrix
from tests.report import built

MACHINES = [*built.PRINTED, (built.SLIDE, built.own_language(built.SLIDE))]
"""Every kind in its file's language, the sample in both, and a machine that a slider drives."""
CASES = matrix(
    [pytest.param((path, language), id=f"{path.stem}-{language}") for path, language in MACHINES],
    telling=[(built.SAMPLE, "vi")],
)
"""In `make test` one page is looked at: all kinds of figures are on that of the sample."""
MM = 1e3


@dataclass(frozen=True)
class Made:
    """A page with what it was made of."""

    case: MachineCase
    text: str
    file: Path

    @cached_property
    def report(self) -> Report:
        return Report(self.case)

    @cached_property
    def film(self) -> Film:
        return film(self.case)

    @property
    def scale(self) -> float:
        """mm of paper for a metre."""
        return MM / float(self.case.ledger["mu.l"].values[0])

    @property
    def crank(self) -> float:
        """The drawn crank, or way of a sliding driver (mm)."""
        return self.film.errors.crank

    def stage(self, key: str) -> Stage:
        return next(stage for stage in self.film.stages if stage.key == key)

    def per(self, key: str, degrees: float) -> float:
        """What a millimetre of a plan stands for at a cycle angle, in SI units."""
        stage, cycle = self.stage(key), np.append(self.film.knots[:-1], self.film.knots[:-1] + 360.0)
        if stage.finer is None:
            return stage.scales[0].per
        at = int(np.abs(cycle - degrees).argmin())
        return stage.scales[int(stage.finer.values[at % stage.finer.values.size])].per

    def solved(self, degrees: Any) -> Analysis:
        """The solver's own answer at cycle angles."""
        return analyse(self.case.analysis.machine, np.radians(degrees))

    def between(self, track: Track, degrees: np.ndarray) -> np.ndarray:
        """What a page draws of a track at angles of a turn: straight lines between the samples."""
        values = track.values
        if values.size == 1:
            return np.full(degrees.shape, values[0])
        return np.interp(degrees, self.film.knots, values.real) + 1j * np.interp(degrees, self.film.knots, values.imag)


@cache
def folder() -> Path:
    return Path(tempfile.mkdtemp(prefix="pages-"))


@cache
def made(path: Path, language: Language) -> Made:
    """The page of a file of the repository."""
    written = built.written(path, language)
    text = page(written.case, written.document)
    file = folder() / f"{path.stem}-{language}.html"
    file.write_text(text, encoding="utf-8")
    return Made(written.case, text, file)
