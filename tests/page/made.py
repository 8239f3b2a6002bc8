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
from reportgen.drawing.animation import Animation, Pane, Track
from reportgen.machine.analysis import Analysis, analyse
from reportgen.page import page
from reportgen.page.motion_samples import animation
from reportgen.report.context import ReportContext
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
    def report(self) -> ReportContext:
        return ReportContext(self.case)

    @cached_property
    def animation(self) -> Animation:
        return animation(self.case)

    @property
    def scale(self) -> float:
        """mm of paper for a metre."""
        return MM / float(self.case.ledger["mu.l"].values[0])

    @property
    def crank(self) -> float:
        """The drawn crank, or way of a sliding driver (mm)."""
        return self.animation.errors.crank

    def pane(self, key: str) -> Pane:
        return next(pane for pane in self.animation.panes if pane.key == key)

    def per(self, key: str, degrees: float) -> float:
        """What a millimetre of a plan stands for at a cycle angle, in SI units."""
        pane, cycle = self.pane(key), np.append(self.animation.knots[:-1], self.animation.knots[:-1] + 360.0)
        if pane.finer is None:
            return pane.scales[0].per
        at = int(np.abs(cycle - degrees).argmin())
        return pane.scales[int(pane.finer.values[at % pane.finer.values.size])].per

    def solved(self, degrees: Any) -> Analysis:
        """The solver's own answer at cycle angles."""
        return analyse(self.case.analysis.machine, np.radians(degrees))

    def between(self, track: Track, degrees: np.ndarray) -> np.ndarray:
        """What a page draws of a track at angles of a turn: straight lines between the samples."""
        values = track.values
        if values.size == 1:
            return np.full(degrees.shape, values[0])
        return np.interp(degrees, self.animation.knots, values.real) + 1j * np.interp(
            degrees, self.animation.knots, values.imag
        )


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
