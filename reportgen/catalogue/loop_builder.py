"""The lines and equations of closed vector loops, entered group by group in the order of assembly."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from reportgen.base.records import replace
from reportgen.catalogue.given_data import natural_sizes
from reportgen.catalogue.loop_bodies import FRAME, LoopBody, LoopIteration, LoopLine, LoopRail, Moving
from reportgen.catalogue.vector_components import STILL, VectorComponents, add, along, degrees, scaled, typed
from reportgen.formula import (
    NOTHING,
    Chain,
    Expression,
    Matrix,
    Number,
    Ref,
    Symbol,
    column,
    ids,
    minus,
    plus,
    signed,
    sqrt,
    square,
    vocabulary,
)
from reportgen.formula.calculation import Calculation
from reportgen.machine import DRIVER, GROUND, Crank, Guide, Linkage, LinkPoint, owners, under

Sides = tuple[Expression, Expression, VectorComponents]
"""Both unknown rates and the right-hand side of their equations."""
RATES = {"v": "velocity", "a": "acceleration"}


@dataclass
class LoopBuilder:
    """Loops of a linkage during their construction, group by group in the order of assembly, the driver first.

    `equations` are by name and group `closure-23`, `velocity-23`, `acceleration-23`; `place-1`, … are those of the
    driver.  `compared` are plan quantities and the formulas that must give their sizes.  `fixed` are the coordinates of
    the fixed points, `guides` those of a point of each fixed guide, by its slider.  `accelerates` is > 0 if the driver
    accelerates in the sense of its speed, < 0 against it, 0 if it does not.
    """

    linkage: Linkage
    turn: int
    fixed: Mapping[str, VectorComponents]
    guides: Mapping[int, VectorComponents] = field(default_factory=dict)
    accelerates: float = 0.0
    lines: list[LoopLine | LoopIteration] = field(default_factory=list)
    equations: dict[str, tuple[Chain, ...]] = field(default_factory=dict)
    compared: list[tuple[str, str]] = field(default_factory=list)
    points: dict[str, Moving] = field(default_factory=dict)
    links: dict[int, LoopBody] = field(default_factory=lambda: {GROUND: FRAME})
    group: str = str(DRIVER)

    def __post_init__(self) -> None:
        self.owner = owners(self.linkage)
        self.points |= {name: Moving(self.fixed[name]) for name in self.linkage.ground}
        self._drive()

    def write(self, q: Calculation) -> None:
        """Enter everything in a calculation that has the given data and the plans."""
        driver = self.linkage.driver
        if isinstance(driver, Crank):
            q.angle(ids.formula_angle(DRIVER), q.value(ids.angle(DRIVER)))
            sizes = natural_sizes(driver.length, q.si("omega.1"))
        else:
            sizes = natural_sizes(1.0, q.si(ids.velocity(driver.pin)))
        for group in (str(DRIVER), *(ids.members(group.links) for group in self.linkage.groups)):
            for part in ("place", *RATES.values()):
                q.set_out(f"{part}-{group}")
        for line in self.lines:
            if not isinstance(line, LoopLine):
                q.set_out(line.part, *line.enter(q))
                continue
            scale = sizes.get(line.kind or vocabulary.row(line.id).kind, 1.0)
            q.set_out(line.part, q.define(line.id, line.formula, line.symbol, line.kind, scale=scale))

    # --- lines

    def line(self, part: str, id: str, formula: Expression, symbol: Symbol | str = "", kind: str = "") -> Ref:
        """Add a quantity to the places, velocities or accelerations of the group."""
        self.lines.append(LoopLine(id, formula, symbol, kind, f"{part}-{self.group}"))
        return Ref(id)

    def point(self, name: str, moving: Moving, plan: bool = True) -> Moving:
        """Add a point: coordinates, velocity and acceleration, with their sizes if a `plan` has them."""
        at = self.coordinates(name, moving.p)
        v, a = (self.components(what, name, of, plan) for what, of in (("v", moving.v), ("a", moving.a)))
        self.points[name] = Moving(at, v, a)
        return self.points[name]

    def coordinates(self, name: str, at: VectorComponents) -> VectorComponents:
        x, y = (
            part if isinstance(part, Ref | Number) else self.line("place", ids.formula_coordinate(axis, name), part)
            for axis, part in zip("xy", at, strict=True)
        )
        return x, y

    def components(self, what: str, name: str, of: VectorComponents, plan: bool) -> VectorComponents:
        kind = RATES[what]
        x, y = (
            part
            if isinstance(part, Ref | Number)
            else self.line(kind, ids.formula_component(axis, name, what), part, Symbol(what, f"{name}{axis}"), kind)
            for axis, part in zip("xy", of, strict=True)
        )
        if plan and (x, y) != STILL:
            whole = sqrt(plus(square(x), square(y))) if NOTHING not in (x, y) else plus(x, y)
            self.known(kind, ids.POINT_RATE[what](name), whole)
        return x, y

    def known(self, part: str, plan: str, formula: Expression) -> Ref:
        """Enter a formula of a quantity that a plan also gives, and list it for comparison."""
        written = self.line(part, ids.formula(plan), formula)
        self.compared.append((plan, written.id))
        return written

    def omega(self, link: int, formula: Expression) -> Ref:
        return self.known("velocity", ids.angular_velocity(link), formula)

    def eps(self, link: int, formula: Expression) -> Ref:
        return self.known("acceleration", ids.angular_acceleration(link), formula)

    def enter_matrix_form(self, u: VectorComponents, w: VectorComponents, velocity: Sides, acceleration: Sides) -> None:
        """Enter the equations in matrix form: both unknowns and the right-hand side of each."""
        A = Matrix(((u[0], w[0]), (u[1], w[1])))
        for what, sides in {"velocity": velocity, "acceleration": acceleration}.items():
            first, second, right = sides
            self.equations[f"{what}-{self.group}"] = (Chain((A * column(first, second), column(*right))),)

    def closure(self, outward: VectorComponents, back: VectorComponents) -> None:
        self.equations[f"closure-{self.group}"] = tuple(Chain(sides) for sides in zip(outward, back, strict=True))

    # --- ends of a group

    def rail(self, slider: int, end: str | Guide) -> LoopRail:
        """Return a guide with its motion."""
        assert isinstance(end, Guide)
        body = self.links[end.link]
        if end.link == GROUND:
            return LoopRail(self.guides.get(slider) or typed(end.at), degrees(end.angle), body, GROUND)
        angle = plus(body.angle, *((degrees(end.angle),) if end.angle else ()))
        turned_angle = angle if isinstance(angle, Ref) else self.line("place", ids.formula_angle(slider), angle)
        return LoopRail(body.place(end.at), turned_angle, body, end.link)

    def beneath(self, name: str, rail: LoopRail, at: VectorComponents, plan: bool = True) -> Moving:
        """Return the point of a guide's link that lies under a point."""
        if rail.link == GROUND:
            return Moving(at)
        point_beneath = under(name, rail.link, self.owner)
        return self.points.get(point_beneath) or self.point(point_beneath, rail.carrier.carried(at), plan)

    def put(self, link: int, body: LoopBody) -> None:
        """Place a link and its points."""
        self.links[link] = body
        for point in self.linkage.points:
            if point.link == link:
                self.point(point.name, body.carried(self.coordinates(point.name, self._place_of(point, body))))

    def _place_of(self, point: LinkPoint, body: LoopBody) -> VectorComponents:
        """Return the place of a point: by its length on the line of its link, elsewhere by its two typed distances."""
        if point.local.imag or not point.local:
            return body.place(point.local)
        length = Ref(ids.length(body.start, point.name))
        return add(body.origin.p, scaled(length if point.local.real > 0 else minus(length), along(body.angle)))

    # --- the driver

    def _drive(self) -> None:
        driver = self.linkage.driver
        if isinstance(driver, Crank):
            centre, ω1 = self.points[driver.centre], signed(self.turn, Ref("omega.1"))
            ε1 = signed(self.turn * self.accelerates, Ref("eps.1")) if self.accelerates else NOTHING
            body = LoopBody(driver.centre, centre, Ref(ids.formula_angle(DRIVER)), ω1, ε1)
            reach = scaled(Ref(ids.length(driver.centre, driver.pin)), along(body.angle))
            self.point(driver.pin, body.carried(self.coordinates(driver.pin, add(body.origin.p, reach))))
        else:
            direction = along(degrees(driver.guide.angle))
            at = self.coordinates(driver.pin, add(typed(driver.guide.at), scaled(Ref("s.1"), direction)))
            speed = scaled(signed(self.turn, Ref(ids.velocity(driver.pin))), direction)
            moving = Moving(at, self.components("v", driver.pin, speed, plan=False))
            if self.accelerates:
                rate2 = signed(self.turn * self.accelerates, Ref(ids.acceleration(driver.pin)))
                moving = replace(moving, a=self.components("a", driver.pin, scaled(rate2, direction), plan=False))
            self.points[driver.pin] = moving
            body = LoopBody(driver.pin, self.points[driver.pin], degrees(driver.guide.angle))
        self.put(DRIVER, body)
