"""A synthesis with all its solutions, its ledger, and common mistakes in its numbers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from reportgen.case import Misconceptions
from reportgen.case.design_case import DesignCase
from reportgen.catalogue import extreme_formulas as formulas
from reportgen.catalogue.extreme_faults import Selection
from reportgen.catalogue.extreme_formulas import STRAIGHT
from reportgen.catalogue.extreme_positions import BEYOND, CrankRocker, ExtremePositions, PivotPlace, SliderCrank
from reportgen.formula import Expression, Number, Ref, Symbol, acos, call, cos, sin, tan, total
from reportgen.formula.calculation import Calculation
from reportgen.formula.ledger import MistakenValues
from reportgen.structure import synthesis_ids as names
from reportgen.structure.synthesis_file import CRANK_ROCKER, Parameters


def wanted(given: Parameters) -> ExtremePositions:
    """Return the extreme positions that a file asks for; its required keys are there."""
    assert given.K is not None
    if given.task == CRANK_ROCKER:
        assert given.psi is not None
        assert given.c is not None
        return CrankRocker(given.K.si, given.psi.si, given.c.si)
    assert given.H is not None
    return SliderCrank(given.K.si, given.H.si)


def selection(given: Parameters) -> Selection:
    """Return what selects the place of A: a length of the file, or the best transmission."""
    lengths = {key: getattr(given, key) for key in ("a", "d", "e")}
    key = next((key for key, length in lengths.items() if length is not None and given.best is None), "")
    return Selection(key, lengths.get(key), key == "a", given.A)


def places(given: Parameters) -> list[PivotPlace]:
    """Return the places of A that give a mechanism which works, each on its side of the chord; [] without any."""
    return selection(given).places(wanted(given))


def number_of(place: PivotPlace) -> int:
    """Return the number of a solution: 1 with A beyond the chord, 2 with A before it."""
    return 1 if place.side == BEYOND else 2


@dataclass(frozen=True)
class SolvedSynthesis(DesignCase):
    """An assignment of a synthesis with its solutions and its ledger."""

    @property
    def given(self) -> Parameters:
        parameters: Parameters = self.assignment.parameters
        return parameters

    @cached_property
    def wanted(self) -> ExtremePositions:
        return wanted(self.given)

    @property
    def has_rocker(self) -> bool:
        return isinstance(self.wanted, CrankRocker)

    @cached_property
    def solved(self) -> list[PivotPlace]:
        """The places of A, one for each solution."""
        return places(self.given)

    @property
    def numbers(self) -> list[int]:
        """The numbers of the solutions."""
        return list(map(number_of, self.solved))

    def transmission_of(self, place: PivotPlace) -> float:
        """Return the least transmission angle of a solution (rad)."""
        return self.wanted.least_transmission(place)

    @cached_property
    def chosen(self) -> PivotPlace:
        """The solution with the greatest least transmission angle; of equal ones, the first."""
        return self.wanted.chosen(self.solved)

    @property
    def is_poor(self) -> bool:
        """True if the chosen solution has a smaller transmission angle than permitted."""
        return self.transmission_of(self.chosen) < self.given.gamma.si

    @cached_property
    def best_place(self) -> PivotPlace:
        """The place of A with the greatest least transmission angle, on the side that the file requires."""
        return max(places(self.given.model_copy(update={"best": "transmission"})), key=self.transmission_of)

    @property
    def shares_crank(self) -> bool:
        """True if all solutions have one crank and coupler, because the crank is given."""
        return self.given.a is not None

    def mark(self, number: int) -> str:
        """Return the prime of the symbols of the second of two solutions; else ""."""
        return "′" if len(self.solved) > 1 and number == 2 else ""

    def number_of_crank(self, number: int) -> int:
        """Return the number under which a solution has its crank and coupler."""
        return self.numbers[0] if self.shares_crank else number

    @property
    def lengths(self) -> dict[str, str]:
        """The ids of the lengths of the chosen solution, by their letters."""
        n = number_of(self.chosen)
        crank, coupler = names.CRANK if self.shares_crank else names.crank(n), names.coupler(self.number_of_crank(n))
        if not self.has_rocker:
            return {"r": crank, "l": coupler, "e": names.OFFSET}
        frame = names.frame(n) if self.given.d is None else names.FRAME
        return {"a": crank, "b": coupler, "c": names.ROCKER, "d": frame}

    # --- ledger

    @cached_property
    def calculation(self) -> Calculation:
        q, given = Calculation(), self.given
        q.give(names.SCAN, 1.0, hidden=True)
        assert given.K is not None
        q.give(names.K, given.K.si)
        data = {names.SWING: given.psi, names.ROCKER: given.c, names.STROKE: given.H}
        data |= {names.CRANK: given.a, names.FRAME: given.d, names.OFFSET: given.e, names.PERMITTED: given.gamma}
        for id, datum in data.items():
            if datum is not None:
                q.give(id, datum.si)
        θ = q.define(names.ANGLE, formulas.angle_of_sight(q[names.K]))
        if self.has_rocker:
            ρ = formulas.radius_by_swing(q[names.ROCKER], q[names.SWING], θ)
        else:
            ρ = formulas.radius_by_stroke(q[names.STROKE], θ)
        q.set_out("circle", θ, q.define(names.RADIUS, ρ))
        for place in self.solved:
            if self.has_rocker:
                self._enter_rocker(q, place)
            else:
                self._enter_slider(q, place)
        if len(self.solved) > 1:
            every = [q[names.transmission(number)] for number in self.numbers]
            q.set_out("choice", q.define(names.BEST, call("max", *every)))
        return q

    def _enter_links(self, q: Calculation, place: PivotPlace, along: Expression | None) -> tuple[Ref, Ref, Ref]:
        """Enter β, from its formula or as the search gives it, and with it crank and coupler; return all three."""
        n, of_crank = number_of(place), self.number_of_crank(number_of(place))
        prime = "" if self.shares_crank else self.mark(n)
        θ, ρ = q[names.ANGLE], q[names.RADIUS]
        if (β := q.find(names.along(of_crank))) is None:
            symbol = Symbol("β", "", prime)
            if along is None:
                β = q.define(names.along(of_crank), q[names.SCAN] * place.along, symbol, written=Number(place.along))
            else:
                q.set_out(f"place{n}", β := q.define(names.along(of_crank), along, symbol))
            far = q.define(names.far(of_crank), formulas.far_distance(ρ, β, θ), Symbol("l", "AC1", prime))
            near = q.define(names.near(of_crank), formulas.near_distance(ρ, β, θ), Symbol("l", "AC2", prime))
            q.set_out(f"place{n}", far, near)
            letters = ("a", "b") if self.has_rocker else ("r", "l")
            if not self.shares_crank:
                a = q.define(names.crank(n), formulas.crank_between(far, near), Symbol(letters[0], "", prime))
                q.set_out(f"links{n}", a)
            b = q.define(names.coupler(of_crank), formulas.coupler_between(far, near), Symbol(letters[1], "", prime))
            q.set_out(f"links{n}", b)
        a = q[names.CRANK] if self.shares_crank else q[names.crank(n)]
        return β, a, q[names.coupler(of_crank)]

    def _enter_rocker(self, q: Calculation, place: PivotPlace) -> None:
        """Enter a crank-rocker: the circle's centre, the place of A, the links, and what shows that it works."""
        n = number_of(place)
        prime, side = self.mark(n), place.side
        θ, ρ, c, ψ = (q[id] for id in (names.ANGLE, names.RADIUS, names.ROCKER, names.SWING))
        y = q.define(names.centre(n), formulas.height_of_centre(c, ψ, ρ, θ, side), Symbol("y", "O", prime))
        q.set_out(f"centre{n}", y)
        along: Expression | None = None
        if self.given.d is not None:
            along = formulas.place_by_frame(q[names.FRAME], y, ρ, side)
        elif self.given.a is not None:
            along = formulas.place_by_crank(q[names.CRANK], ρ, θ)
        β, a, b = self._enter_links(q, place, along)
        if self.given.d is None:
            d = q.define(names.frame(n), formulas.frame_at(y, ρ, β, side), Symbol("d", "", prime))
            q.set_out(f"links{n}", d)
        else:
            d = q[names.FRAME]
        across = ρ * cos(β)
        height = y + across if side == BEYOND else y - across
        δ = q.define(names.pivot_angle(n), acos(height / d), Symbol("δ", "", prime), optional=True)
        q.set_out(f"branch{n}", δ)
        first, *middle, last = sorted((a, b, c, d), key=q.si)
        sums = (names.ends(n), "1", (first, last)), (names.others(n), "2", tuple(middle))
        for id, index, links in sums:
            q.set_out(f"grashof{n}", q.define(id, total(links), Symbol("s", index, prime), optional=True))
        γ1 = q.define(names.near_angle(n), formulas.angle_between(b, c, d - a), Symbol("γ", "1", prime))
        γ2 = q.define(names.far_angle(n), formulas.angle_between(b, c, d + a), Symbol("γ", "2", prime))
        γ = q.define(names.transmission(n), call("min", γ1, STRAIGHT - γ2), Symbol("γ", "min", prime))
        q.set_out(f"transmission{n}", γ1, γ2, γ)

    def _enter_slider(self, q: Calculation, place: PivotPlace) -> None:
        """Enter a slider-crank: the place of A, the links, and what shows that it works."""
        n = number_of(place)
        θ, ρ = q[names.ANGLE], q[names.RADIUS]
        along = None if self.given.e is None else formulas.place_by_offset(q[names.OFFSET], ρ, θ)
        β, r, l = self._enter_links(q, place, along)  # noqa: E741
        if self.given.e is None:
            e = q.define(names.OFFSET, formulas.offset_at(ρ, β, θ))
            q.set_out(f"links{n}", e)
        else:
            e = q[names.OFFSET]
        limit = q.define(names.FARTHEST, q[names.STROKE] / tan(θ), optional=True)
        q.set_out(f"branch{n}", limit)
        q.set_out(f"grashof{n}", q.define(names.others(n), r + e, Symbol("s"), optional=True))
        γ = q.define(names.transmission(n), formulas.transmission_of_slider(r, l, e), Symbol("γ", "min"))
        q.set_out(f"transmission{n}", γ)

    # --- what is often taken for something else

    @cached_property
    def misconceptions(self) -> Misconceptions:
        """Common mistakes: a wrong angle θ or circle, the whole swing, crank and coupler not halved, the
        transmission angle of the other position.
        """
        changed: dict[str, list[tuple[str, Expression]]] = {}
        for id, name, formula in (*self._of_circle(), *self._of_links(), *self._of_transmission()):
            if id in self.ledger:
                changed.setdefault(id, []).append((name, formula))
        return Misconceptions(changed=changed)

    def _of_circle(self) -> MistakenValues:
        K, θ = Ref(names.K), Ref(names.ANGLE)
        yield names.ANGLE, "synthesis-whole-turn", 2 * STRAIGHT * (K - 1) / (K + 1)
        yield names.ANGLE, "synthesis-one-stroke", STRAIGHT * (K - 1) / K
        if self.has_rocker:
            c, ψ = Ref(names.ROCKER), Ref(names.SWING)
            chord = 2 * c * sin(ψ / 2)
            yield names.RADIUS, "synthesis-whole-swing", c * sin(ψ) / sin(θ)
        else:
            chord = 1 * Ref(names.STROKE)
        yield names.RADIUS, "synthesis-diameter", chord / sin(θ)
        yield names.RADIUS, "synthesis-central-angle", chord / 2 / sin(θ / 2)

    def _of_links(self) -> MistakenValues:
        for n in self.numbers:
            far, near = Ref(names.far(n)), Ref(names.near(n))
            yield names.crank(n), "synthesis-not-halved", far - near
            yield names.coupler(n), "synthesis-not-halved", far + near
            if self.has_rocker:
                c, ψ = Ref(names.ROCKER), Ref(names.SWING)
                to_centre = Ref(names.RADIUS) * cos(Ref(names.ANGLE))
                yield (
                    names.centre(n),
                    "synthesis-other-side",
                    c * cos(ψ / 2) - to_centre if n == 1 else c * cos(ψ / 2) + to_centre,
                )

    def _of_transmission(self) -> MistakenValues:
        for n in self.numbers:
            if self.has_rocker:
                yield names.transmission(n), "synthesis-not-least", call("max", *self._angles(n))
            else:
                crank, rod = Ref(names.crank(n)), Ref(names.coupler(n))
                yield names.transmission(n), "synthesis-without-offset", acos(crank / rod)
        if len(self.solved) > 1:
            every = [Ref(names.transmission(number)) for number in self.numbers]
            yield names.BEST, "synthesis-worse-solution", call("min", *every)

    def _angles(self, n: int) -> Iterator[Expression]:
        yield Ref(names.near_angle(n))
        yield STRAIGHT - Ref(names.far_angle(n))
