"""Faults of data that give no mechanism with the wanted extreme positions."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from reportgen.base.errors import Finding, Where
from reportgen.base.records import Record
from reportgen.base.units import Given
from reportgen.catalogue.extreme_positions import ON_CHORD, SIDES, CrankRocker, ExtremePositions, PivotPlace


class Selection(Record):
    """What selects the place of A: a length of the file by its key, of the crank or of the frame (or offset).

    Without a length, the best transmission selects it. `side` is the required side of the chord, if there is one.
    """

    key: str = ""
    length: Given | None = None
    is_crank: bool = False
    side: str | None = None

    def places(self, wanted: ExtremePositions) -> list[PivotPlace]:
        """Return the places of A that give a mechanism which works; [] without any."""
        length = None if self.length is None else abs(self.length.si)
        crank, frame = (length, None) if self.is_crank else (None, length)
        return wanted.places(crank, frame, None if self.side is None else SIDES[self.side])


def faults_without_place(
    wanted: ExtremePositions, selection: Selection, top: Where, group: Where, hints: Mapping[str, str]
) -> Iterator[Finding]:
    """Yield the fault of a selection without any place of A; nothing if it has one.

    `top` is the path of the length's key, `group` that of `K` and `A`. The fault names the lengths with which there is
    a mechanism. `hints` are those of the kind by the code of their fault.
    """
    if selection.places(wanted):
        return
    extent = wanted.cranks() if selection.is_crank else wanted.frames()
    if extent is None:
        # Only of a slider-crank: before the chord of a rocker, near C₂, some place of A always works.
        yield Finding("synthesis-ratio", (*group, "K"), {"text": f"{wanted.K:g}"})
        return
    if selection.side is not None and Selection(selection.key, selection.length, selection.is_crank).places(wanted):
        yield Finding("synthesis-side", (*group, "A"), {"A": selection.side})
        return
    given = selection.length
    assert given is not None, "the best transmission selects a place on each side"
    code, about = "synthesis-none", {"key": selection.key, "text": given.text}
    if not selection.is_crank and selection.side != "beyond" and _is_about_pivot(wanted, given.si):
        code = "synthesis-every-place"
    else:
        # 0 is added because rounding may leave −0.
        about |= {name: f"{round(end * 1e3, 4) + 0:.5g} mm" for name, end in zip(("low", "high"), extent, strict=True)}
    if code in hints:
        about["hint"] = hints[code]
    yield Finding(code, (*top, selection.key), about)


def _is_about_pivot(wanted: ExtremePositions, frame: float) -> bool:
    """Return True if A is at this distance from D (m) all along its arc before the chord: ψ = 2θ and d = c."""
    return (
        isinstance(wanted, CrankRocker)
        and math.isclose(wanted.swing, 2 * wanted.angle, rel_tol=ON_CHORD)
        and math.isclose(frame, wanted.rocker, rel_tol=ON_CHORD)
    )
