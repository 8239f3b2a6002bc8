"""`CamSolution`: a cam as a ledger, with every number under its id as the report prints it.

A quantity with different formulas in each phase is a `branch` selected by its interval's number, so the line of a
position prints the formula of its own phase.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property

import numpy as np

from reportgen.base.arrays import Floats
from reportgen.base.records import Record
from reportgen.base.units import MM, Given, nice_up
from reportgen.cam import cam_ids, formulas
from reportgen.cam.file import Designed, Parameters, designed, positions_of
from reportgen.cam.formulas import enter_lengths, enter_lowest, enter_profile, factor
from reportgen.cam.inverse_design import NoCamError, Touch
from reportgen.cam.motion_laws import FollowerMotion, LawInterval
from reportgen.cam.profile import Cam, CamProfile
from reportgen.case import Misconceptions, with_another
from reportgen.formula import PI, Expression, Number, Operand, Ref, Symbol, acos, as_expression, branch, tan
from reportgen.formula.calculation import Calculation
from reportgen.formula.vocabulary import KeyChapter

LINES: Mapping[str, tuple[str, ...]] = {
    "arcs": ("cam.arc.rise", "cam.arc.return", "cam.arc.swing"),
    "begin": ("cam.start.return",),
    "speed": ("cam.omega",),
    "motion": (
        *("cam.x", "cam.z", "cam.s", "cam.ds", "cam.dds", "cam.psi", "cam.dpsi", "cam.ddpsi"),
        *("cam.v", "cam.acceleration", "cam.omega.f", "cam.epsilon.f"),
    ),
    "scales": ("cam.mu.phi", "cam.mu.ds", "cam.mu.s", "cam.mu.dpsi", "cam.mu.psi"),
    "intercepts": ("cam.c.1", "cam.c.2"),
    "apex": ("cam.apex.s0", "cam.apex.e"),
    "least": ("cam.least.e", "cam.least.s0", "cam.least.psi0", "cam.least.r0"),
    "lowest": ("cam.s0", "cam.psi0"),
    "pressure": ("cam.q", "cam.k", "cam.alpha"),
    "points": ("cam.contact", "cam.pitch.x", "cam.pitch.y", "cam.profile.x", "cam.profile.y"),
    "curvature": ("cam.u", "cam.w", "cam.m.1", "cam.m.2", "cam.rho", "cam.rho.working"),
}
"""Quantities that the report prints together."""
MOVING = {"rise": 1, "return": 2}
"""The indices of quantities of the two phases with motion."""
STILL = Number(0.0)
TURN_ON_PAPER, HEIGHT = 0.120, 0.042
"""The length of a turn in the motion diagrams, and the approximate height of each (m on paper)."""
LEAST_POLE, MOST_POLE = 5, 30
"""Pole distances (mm)."""
KINDS_ON_PAPER = ("length on paper", "reduced velocity on paper", "reduced acceleration on paper")


class CamSolution(Record, dict=True):
    """The cam of a file at its positions [N], and its ledger."""

    given: Parameters

    @cached_property
    def designed(self) -> Designed:
        return designed(self.given)

    @property
    def cam(self) -> Cam:
        return self.designed.cam

    @property
    def motion(self) -> FollowerMotion:
        return self.cam.motion

    @cached_property
    def degrees(self) -> tuple[float, ...]:
        """The angles of the positions [N] in degrees."""
        return positions_of(self.given)

    @cached_property
    def φ(self) -> Floats:
        """Return the angles of the positions [N] (rad)."""
        return np.radians(self.degrees)

    @cached_property
    def profile(self) -> CamProfile:
        """Return the cam at its positions."""
        return self.cam.profile_at(self.φ)

    @cached_property
    def intervals(self) -> tuple[LawInterval, ...]:
        """Return the interval of each position."""
        return tuple(self.motion.intervals[number] for number in self.motion.of(self.φ))

    @cached_property
    def calculation(self) -> Calculation:
        q = CamCalculation(self)
        q.enter_given()
        q.enter_motion()
        q.enter_scales()
        q.enter_least()
        enter_profile(q.q, self.cam.kind)
        if self.cam.flat:
            q.q.set_out("points", "cam.q", "cam.k")
        for name, lines in LINES.items():
            q.q.set_out(name, *lines)
        return q.q

    @cached_property
    def misconceptions(self) -> Misconceptions:
        stroke = "cam.h" if self.cam.translating else "cam.swing"
        return Misconceptions(readings=self._exchanged, changed=self._changed, designs={stroke: self._with_stroke})

    def _with_stroke(self, stroke: float) -> Sequence[Mapping[str, np.ndarray]]:
        """Return the values read off the diagrams with another stroke (m, rad); the same with the lengths found
        anew.
        """
        key, own = "h" if self.cam.translating else "psi_max", self.calculation.families
        try:
            changed = CamSolution(self.given.model_copy(update={key: Given(stroke, stroke)})).calculation.families
        except NoCamError:
            return ()
        read = {
            id: changed[id].values
            for id, family in own.items()
            if family.definition is None and not family.exact and id in changed and changed[id].definition is None
        }
        return read, read | {id: changed[id].values for id in self.cam.kind.lengths}

    @property
    def _exchanged(self) -> Mapping[str, list[tuple[str, np.ndarray]]]:
        """Return the motion with the angles and laws of rise and return exchanged."""
        first, far, back, near = self.motion.phases
        exchanged = FollowerMotion(self.motion.stroke, (back, far, first, near), self.motion.back, self.motion.rise)
        return {id: [("cam-exchanged", values)] for id, values in zip(self.moved, exchanged(self.φ), strict=True)}

    @property
    def _changed(self) -> Mapping[str, list[tuple[str, Expression]]]:
        """Return the mistaken definitions that students often use, by id."""
        definitions: dict[str, list[tuple[str, Expression]]] = {}
        families = self.calculation.families

        def also(name: str, among: Iterable[tuple[str, Expression]]) -> None:
            for id, definition in among:
                definitions.setdefault(id, []).append((name, definition))

        for id, power in (("cam.ds", 1), ("cam.dds", 2), ("cam.dpsi", 1), ("cam.ddpsi", 2)):
            if id in families and (definition := families[id].definition) is not None:
                also("cam-degrees", [(id, definition * (math.pi / 180) ** power)])
        begun = {id: one for id, one in families.items() if id in ("cam.x", "cam.start.return")}
        also("cam-phase-sum", with_another({"cam.x": begun["cam.x"]}, {"cam.start.return": Ref(cam_ids.phase("rise"))}))
        also("cam-phase-sum", with_another(begun, {cam_ids.phase("far"): 0.0}))
        also("cam-offset-side", with_another(families, {"cam.e": -Ref("cam.e")}))
        if "cam.k" in families:
            turned = -Ref(self.moved[1])
            also("cam-wrong-sense", with_another({"cam.k": families["cam.k"]}, {self.moved[1]: turned}))
        if "cam.limit.return" in families:
            limits = {"cam.limit.rise": Ref("cam.limit.return"), "cam.limit.return": Ref("cam.limit.rise")}
            also("cam-limits-exchanged", with_another(families, limits))
        also("cam-roller-outward", with_another(families, {"cam.roller": -Ref("cam.roller")}))
        return definitions

    @property
    def moved(self) -> tuple[str, str, str]:
        """Return the names of s, s′ and s″ in the ledger."""
        return self.cam.kind.moved


class CamCalculation:
    """The calculation of a cam while it is filled."""

    def __init__(self, of: CamSolution) -> None:
        self.of, self.cam, self.given = of, of.cam, of.given
        self.q = Calculation(len(of.degrees))
        self.σ = of.cam.opposite

    # --- given and chosen values

    def enter_given(self) -> None:
        q, given, cam = self.q, self.given, self.cam
        with q.within(KeyChapter.data):
            self.stroke = q.give("cam.h" if cam.translating else "cam.swing", cam.motion.stroke)
            for phase, degrees in zip(("rise", "far", "return", "near"), given.phase_degrees, strict=True):
                q.give(cam_ids.phase(phase), math.radians(degrees))
            limits = self.of.designed.limits
            for phase, limit in (("rise", limits.rise), ("return", limits.back)):
                if limit is not None and not cam.flat:
                    q.give(cam_ids.limit(phase), limit)
            q.give("cam.limit.rho", limits.rho)
            if given.n is not None:
                n = q.give("cam.n", given.n.value)
                q.define("cam.omega", 2 * PI * n / 60)
            enter_lengths(q, cam.kind, cam.lengths)

    # --- the law of motion

    def enter_motion(self) -> None:
        q, motion = self.q, self.cam.motion
        for phase in MOVING:
            q.define(cam_ids.arc(phase), q[cam_ids.phase(phase)])
        self.arc = self.stroke if self.cam.translating else q.define(cam_ids.arc("swing"), self.stroke)
        q.define("cam.start.return", q[cam_ids.phase("rise")] + q[cam_ids.phase("far")])
        laws = {"rise": motion.rise, "return": motion.back}
        for phase, law in laws.items():
            if law.table is not None:
                self._enter_nodes(MOVING[phase], law.table.nodes[0], law.table.x)
        φ = q.give("cam.phi", self.of.φ)
        intervals = motion.intervals
        number = q.give("cam.stretch", motion.of(self.of.φ), "stretch", "count", hidden=True)
        places = {
            "rise": φ / q[cam_ids.phase("rise")],
            "return": (φ - q["cam.start.return"]) / q[cam_ids.phase("return")],
        }
        x = q.define("cam.x", branch(number, *(places.get(one.phase, STILL) for one in intervals)), scale=1.0)
        if any(law.table is not None for law in laws.values()):
            begun = [self._beyond(one, x) for one in intervals]
            q.define("cam.z", branch(number, *begun), scale=1.0)
        written = [self._formulas(one, x) for one in intervals]
        for id, branches in zip(self.of.moved, zip(*written, strict=True), strict=True):
            q.define(id, branch(number, *map(as_expression, branches)), scale=motion.stroke)
        _, ds, dds = (q[id] for id in self.of.moved)
        if omega := q.find("cam.omega"):
            rate, acceleration = (
                ("cam.v", "cam.acceleration") if self.cam.translating else ("cam.omega.f", "cam.epsilon.f")
            )
            q.define(rate, omega * ds, scale=motion.stroke)
            q.define(acceleration, omega**2 * dds, scale=motion.stroke)

    def enter_scales(self) -> None:
        """Enter the scales of the motion diagrams: μ_s″ is round; the others follow with whole pole distances K."""
        q, turned = self.q, not self.cam.translating
        names = ("psi", "dpsi", "ddpsi") if turned else ("s", "ds", "dds")
        symbols = ("ψ", "ψ′", "ψ″") if turned else ("s", "s′", "s″")
        kinds = ("angle on paper", "rate on paper", "rate on paper") if turned else KINDS_ON_PAPER
        profile = self.cam.sampled()
        first, second, third = (float(np.ptp(part)) for part in (profile.s, profile.ds, profile.dds))
        L = q.give(cam_ids.diagram("L"), TURN_ON_PAPER, optional=True)
        μ_φ = q.define(cam_ids.scale("phi"), 2 * PI / L, Symbol("μ", "φ"), "angle on paper", optional=True)
        chosen = nice_up(third / HEIGHT) if third else nice_up(second / HEIGHT / q.si(μ_φ) / HEIGHT)
        above = q.give(cam_ids.scale(names[2]), chosen, Symbol("μ", symbols[2]), kinds[2], optional=True)
        for number, (name, index, kind, range_) in enumerate(
            ((names[1], symbols[1], kinds[1], second), (names[0], symbols[0], kinds[0], first)), start=1
        ):
            wanted = range_ / HEIGHT / (q.si(above) * q.si(μ_φ)) * MM
            pole = min(max(round(wanted), LEAST_POLE), MOST_POLE) / MM
            K = q.give(cam_ids.diagram(number), pole, Symbol("K", str(number)), optional=True)
            above = q.define(cam_ids.scale(name), above * μ_φ * K, Symbol("μ", index), kind, optional=True)

    def _formulas(self, interval: LawInterval, x: Ref) -> tuple[Operand, ...]:
        if interval.piece is None:
            return interval.formulas(x, 1.0, self.stroke, self.stroke)
        arc = self.q[cam_ids.arc(interval.phase)]
        piece = interval.piece
        if piece.node >= 0:
            z = self.q["cam.z"]
            table = {"rise": self.cam.motion.rise, "return": self.cam.motion.back}[interval.phase].table
            assert table is not None
            named = {
                cubic.node: cubic
                for cubic in table.pieces(lambda what, i: self._node(MOVING[interval.phase], i, what), lambda *_: z)
            }
            piece = named[piece.node]
        return LawInterval(
            interval.phase, interval.start, interval.stop, interval.begin, interval.angle, piece
        ).formulas(x, arc, self.stroke, self.arc)

    def _beyond(self, interval: LawInterval, x: Ref) -> Expression:
        """Return the distance of x from the node at the beginning of an interval."""
        if interval.piece is None or interval.piece.node < 0:
            return STILL
        return x - self._node(MOVING[interval.phase], interval.piece.node, "x")

    def _node(self, phase: int, number: int, what: str) -> Ref:
        return self.q[cam_ids.node(phase, number, what)]

    def _enter_nodes(self, phase: int, A: Floats, x: Floats) -> None:
        """Enter the graph of the acceleration, integrated from node to node."""
        q = self.q
        for i, (at, value) in enumerate(zip(x, A, strict=True)):
            here = q.give(cam_ids.node(phase, i, "x"), float(at))
            now = q.give(cam_ids.node(phase, i, "A"), float(value), exact=False)
            if not i:
                q.give(cam_ids.node(phase, i, "V"), 0.0)
                q.give(cam_ids.node(phase, i, "S"), 0.0)
                continue
            last, before, V, S = (self._node(phase, i - 1, what) for what in ("x", "A", "V", "S"))
            if abs(at - x[i - 1]) == 0:
                q.define(cam_ids.node(phase, i, "V"), V)
                q.define(cam_ids.node(phase, i, "S"), S)
                continue
            Δ = here - last
            q.define(cam_ids.node(phase, i - 1, "J"), (now - before) / Δ, scale=1.0)
            if i == len(x) - 1:
                # The follower comes to rest at the end of its stroke.
                q.give(cam_ids.node(phase, i, "V"), 0.0)
                q.give(cam_ids.node(phase, i, "S"), 1.0)
                continue
            q.define(cam_ids.node(phase, i, "V"), V + (before + now) * Δ / 2, scale=1.0)
            q.define(cam_ids.node(phase, i, "S"), S + V * Δ + (2 * before + now) * Δ**2 / 6, scale=1.0)

    # --- the least cam

    def enter_least(self) -> None:
        q, least = self.q, self.of.designed.least
        if self.cam.flat:
            if self.cam.translating:
                valley = q.give("cam.valley", self.given_rho - self.of.designed.least_r0, exact=False)
                q.define("cam.least.r0", q["cam.limit.rho"] - valley)
            else:
                q.give("cam.least.r0", self.of.designed.least_r0, exact=False)
            return
        if self.cam.translating:
            if least is not None:
                self._translating()
            enter_lowest(q, self.cam.kind)
            return
        if least is not None:
            self._oscillating()

    @property
    def given_rho(self) -> float:
        """Return the requested least radius of curvature (m)."""
        return self.of.designed.limits.rho

    def _touch(self, phase: str, touch: Touch) -> tuple[Ref, Ref]:
        """Enter the point where a limit line touches, as read off the diagram; return its coordinates."""
        q, number = self.q, MOVING[phase]
        names = ("s", "ds") if self.cam.translating else ("psi", "dpsi")
        q.give(cam_ids.touch(number, "phi"), touch.phi, exact=False)
        s = q.give(cam_ids.touch(number, names[0]), touch.s, exact=False)
        return s, q.give(cam_ids.touch(number, names[1]), touch.ds, exact=False)

    def _translating(self) -> None:
        q, least = self.q, self.of.designed.least
        assert least is not None
        assert least.rise is not None
        s, ds = self._touch("rise", least.rise)
        α1 = q["cam.limit.rise"]
        c1 = q.define(cam_ids.intercept(1), formulas.rise_intercept(s, ds, α1))
        c2, α2 = None, None
        if least.back is not None:
            s, ds = self._touch("return", least.back)
            α2 = q["cam.limit.return"]
            c2 = q.define(cam_ids.intercept(2), formulas.return_intercept(s, ds, α2))
        if not self.given.seeks("e"):
            top = c1 if least.rule == "rise" else c2
            assert top is not None
            limit = α1 if least.rule == "rise" else α2
            assert limit is not None
            if not self.cam.e:
                q.define("cam.least.r0", top / tan(limit))
                return
            height = formulas.height_by_rise if least.rule == "rise" else formulas.height_by_return
            s0 = q.define("cam.least.s0", height(top, q["cam.e"], limit))
            q.define("cam.least.r0", formulas.base_radius(s0, q["cam.e"]))
            return
        if c2 is not None and α2 is not None:
            high = q.define("cam.apex.s0", formulas.apex_height(c1, c2, α1, α2))
            across = q.define("cam.apex.e", formulas.apex_offset(c1, high, α1))
        if least.rule == "apex":
            s0, e = q.define("cam.least.s0", high), q.define("cam.least.e", across)
        elif least.rule == "rise":
            e = q.define("cam.least.e", formulas.foot_of_rise(c1, α1))
            s0 = q.define("cam.least.s0", formulas.height_on_rise(e, α1))
        else:
            assert c2 is not None
            assert α2 is not None
            e = q.define("cam.least.e", formulas.foot_of_return(c2, α2))
            s0 = q.define("cam.least.s0", formulas.height_on_return(e, α2))
        q.define("cam.least.r0", formulas.base_radius(s0, e))

    def _oscillating(self) -> None:
        """Enter the lowest ψ₀ that each limit allows, and the larger one as the result."""
        q, least = self.q, self.of.designed.least
        assert least is not None
        a, arm = q["cam.a"], q["cam.l"]
        lowest_pivot: dict[str, Expression] = {}
        for phase, touch, side in (("rise", least.rise, self.σ), ("return", least.back, -self.σ)):
            if touch is None:
                continue
            ψ, dψ = self._touch(phase, touch)
            limit = q[cam_ids.limit(phase)]
            aside = acos(formulas.cosine_aside(arm, factor(dψ, self.σ), limit, a))
            lowest = formulas.lowest_against if side > 0 else formulas.lowest_with
            lowest_pivot[phase] = lowest(limit, aside, ψ)
        ψ0 = q.define("cam.least.psi0", lowest_pivot[least.rule])
        q.define("cam.least.r0", formulas.base_radius_of_arm(a, arm, ψ0))
