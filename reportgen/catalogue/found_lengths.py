"""Lengths of a four-bar or a slider-crank that are found from its extreme positions, with `find` in the file.

The construction is that of `extreme_positions`; its lines are those of the kind `synthesis`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Length, SpeedRatio, SwingAngle
from reportgen.base.errors import Finding
from reportgen.base.records import Record
from reportgen.base.units import Given
from reportgen.catalogue import extreme_formulas as formulas
from reportgen.catalogue.extreme_faults import Selection, faults_without_place
from reportgen.catalogue.extreme_positions import BEYOND, SIDES, CrankRocker, ExtremePositions, PivotPlace, SliderCrank
from reportgen.catalogue.given_data import GivenData
from reportgen.formula import Expression, Ref, Symbol, call

TOP = ("parameters",)
OF_SLIDER = {"synthesis-none": "find-none"}
OF_ROCKER = {"synthesis-none": "find-in-line", "synthesis-every-place": "find-every-place"}
"""Hints for a length with which there is no mechanism, by the code of the fault."""


class WantedSwing(Part):
    """Requested motion of a rocker: its angle of swing ψ and the time ratio K of its two strokes.

    The crank's centre A lies `beyond` the chord of the ends of the pin's path, seen from D, or `before` it; without a
    side the greater least transmission angle selects it.
    """

    K: SpeedRatio
    psi: SwingAngle
    A: Literal["beyond", "before"] | None = None


class WantedStroke(Part):
    """Requested motion of a slider: its stroke H and the time ratio K of both ways."""

    K: SpeedRatio
    H: Length


class LengthSearch(Record):
    """The search for lengths: the group of keys with the `wanted` motion, and the lengths of the file by their keys.

    A length is None if it is to be found. Without a wanted motion nothing can be found. `driven` is the key of a rocker
    that is to be found, which only a part of a coursework can do; else "".
    """

    group: str
    wanted: ExtremePositions | None
    crank: tuple[str, Given | None]
    coupler: tuple[str, Given | None]
    frame: tuple[str, Given | None]
    side: str | None
    hints: Mapping[str, str]
    driven: str = ""

    @property
    def selected_by(self) -> str:
        """What selects the place of A: the `crank`, the `frame`, or a search for the best `transmission`."""
        if self.crank[1] is not None:
            return "crank"
        return "transmission" if self.frame[1] is None else "frame"

    @property
    def selection(self) -> Selection:
        """What selects the place of A, with the key of its length."""
        if self.selected_by == "transmission":
            return Selection(side=self.side)
        return Selection(
            *(self.crank if self.selected_by == "crank" else self.frame), self.selected_by == "crank", self.side
        )

    @property
    def place(self) -> PivotPlace:
        """The place of A, of several the one with the greatest least transmission angle."""
        assert self.wanted is not None, "a motion is wanted"
        return self.wanted.chosen(self.selection.places(self.wanted))

    @property
    def pivot(self) -> str:
        """The side of the chord on which A lies, as files name it; `beyond` if no motion is wanted."""
        side = BEYOND if self.wanted is None else self.place.side
        return next(name for name, value in SIDES.items() if value == side)

    def findings(self) -> Iterator[Finding]:
        """Yield faults of the keys; without any, why there is no mechanism."""
        lengths = (self.crank, self.coupler, self.frame)
        if self.driven:
            yield Finding("find-by-part", (*TOP, self.driven), {"key": self.driven})
            return
        if self.wanted is None:
            for key, given in lengths:
                if given is None:
                    yield Finding("find-without-motion", (*TOP, key), {"key": key, "group": self.group})
            return
        (coupler, length), (crank, _) = self.coupler, self.crank
        known = [] if length is None else [coupler]
        if self.crank[1] is not None and self.frame[1] is not None:
            known.append(crank)
        for key in known:
            yield Finding("find-known", (*TOP, key), {"key": key, "group": self.group})
        if not known:
            yield from faults_without_place(self.wanted, self.selection, TOP, (*TOP, self.group), self.hints)


def rocker_search(
    swing: WantedSwing | None, AB: Given | None, BC: Given | None, AD: Given | None, CD: Given | None
) -> LengthSearch:
    """Return the search for lengths of a four-bar with the rocker CD."""
    wanted = None if swing is None or CD is None else CrankRocker(swing.K.si, swing.psi.si, CD.si)
    side, driven = None if swing is None else swing.A, "CD" if CD is None else ""
    return LengthSearch("swing", wanted, ("AB", AB), ("BC", BC), ("AD", AD), side=side, hints=OF_ROCKER, driven=driven)


def slider_search(stroke: WantedStroke | None, crank: Given | None, rod: Given | None, e: Given | None) -> LengthSearch:
    """Return the search for lengths of a slider-crank."""
    wanted = None if stroke is None else SliderCrank(stroke.K.si, stroke.H.si)
    return LengthSearch("stroke", wanted, ("r", crank), ("l", rod), ("e", e), side=None, hints=OF_SLIDER)


def find_four_bar(q: GivenData, swing: WantedSwing, search: LengthSearch) -> None:
    """Enter the construction and the lengths found, with the least transmission angle; uses `l.DC`, the given lengths.

    Ids: `theta`, `rho`, `l.DO`, `arc`, `l.AC1`, `l.AC2`, `l.AB`, `l.BC`, `l.AD`, `gamma.near`, `gamma.far`,
    `gamma.least`.
    """
    ψ, K, c = q.datum("swing", swing.psi, "ψ", "angle"), q.datum("K", swing.K), q["l.DC"]
    place = search.place
    θ = q.define("theta", formulas.angle_of_sight(K))
    ρ = q.define("rho", formulas.radius_by_swing(c, ψ, θ), "ρ", "length")
    y = q.define("l.DO", formulas.height_of_centre(c, ψ, ρ, θ, place.side), Symbol("y", "O"))
    q.set_out("circle", θ, ρ, y)
    along: Expression | None = None
    if search.selected_by == "crank":
        along = formulas.place_by_crank(q["l.AB"], ρ, θ)
    elif search.selected_by == "frame":
        along = formulas.place_by_frame(q["l.AD"], y, ρ, place.side)
    β = _enter_links(q, along, place, ρ, θ)
    a, b, d = q["l.AB"], q["l.BC"], q.find("l.AD")
    if d is None:
        q.set_out("links", d := q.define("l.AD", formulas.frame_at(y, ρ, β, place.side)))
    γ1 = q.define("gamma.near", formulas.angle_between(b, c, d - a), Symbol("γ", "1"), "angle")
    γ2 = q.define("gamma.far", formulas.angle_between(b, c, d + a), Symbol("γ", "2"), "angle")
    least = q.define("gamma.least", call("min", γ1, formulas.STRAIGHT - γ2), Symbol("γ", "min"), "angle")
    q.set_out("transmission", γ1, γ2, least)


def find_slider_crank(q: GivenData, stroke: WantedStroke, search: LengthSearch) -> None:
    """Enter the construction and the lengths found, with the least transmission angle; uses the given lengths.

    Ids: `theta`, `rho`, `arc`, `l.AC1`, `l.AC2`, `l.AB`, `l.BC`, `e`, `gamma.least`.
    """
    H, K = q.datum("H", stroke.H, "H", "length"), q.datum("K", stroke.K)
    θ = q.define("theta", formulas.angle_of_sight(K))
    ρ = q.define("rho", formulas.radius_by_stroke(H, θ), "ρ", "length")
    q.set_out("circle", θ, ρ)
    along: Expression | None = None
    if search.selected_by == "crank":
        along = formulas.place_by_crank(q["l.AB"], ρ, θ)
    elif search.selected_by == "frame":
        along = formulas.place_by_offset(_size(q, "e"), ρ, θ)
    β = _enter_links(q, along, search.place, ρ, θ)
    if q.find("e") is None:
        q.set_out("links", q.define("e", formulas.offset_at(ρ, β, θ)))
    least = formulas.transmission_of_slider(q["l.AB"], q["l.BC"], _size(q, "e"))
    q.set_out("transmission", q.define("gamma.least", least, Symbol("γ", "min"), "angle"))


def _size(q: GivenData, id: str) -> Expression:
    """Return the absolute value of a quantity, as an expression whose sign is known."""
    return q[id] if q.si(id) >= 0 else -q[id]


def _enter_links(q: GivenData, along: Expression | None, place: PivotPlace, ρ: Ref, θ: Ref) -> Ref:
    """Enter β by its formula, or as the search gives it, and with it the crank, unless it is given, and the coupler."""
    symbol = Symbol("β", "A")
    if along is None:
        q.set_out("search", β := q.give("arc", place.along, symbol, "angle", exact=False))
    else:
        q.set_out("place", β := q.define("arc", along, symbol, "angle"))
    far = q.define("l.AC1", formulas.far_distance(ρ, β, θ))
    near = q.define("l.AC2", formulas.near_distance(ρ, β, θ))
    q.set_out("place", far, near)
    if q.find("l.AB") is None:
        q.set_out("links", q.define("l.AB", formulas.crank_between(far, near)))
    q.set_out("links", q.define("l.BC", formulas.coupler_between(far, near)))
    return β
