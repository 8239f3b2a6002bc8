"""Drawings of an engine to scale: cranks and banks, shaft, the stars of all orders, the drawing sheet."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from itertools import pairwise

from reportgen.balancing import orders_ids
from reportgen.balancing.engine_calculation import ORDERS
from reportgen.balancing.engine_solution import SolvedEngine
from reportgen.balancing.rotor_drawings import BEYOND, SHAFT, ruler
from reportgen.base.units import MM, nice_up
from reportgen.drawing import Circle, Content, Item, Line, Polyline, Scene, style
from reportgen.drawing.canvas import Canvas, finish, settle
from reportgen.drawing.drawing_description import direction, fact
from reportgen.drawing.drawing_sheet import lettered
from reportgen.drawing.figure_scale import IN_REPORT, FigureSize
from reportgen.drawing.geometry import bounds, corners_of
from reportgen.drawing.labels import Request, joined, label
from reportgen.drawing.plates import DrawingPlate, enlargeable
from reportgen.drawing.vector_plan import Plan, PlanPoint, PlanVector, plan
from reportgen.formula import Chain, Number, Symbol
from reportgen.sheets.plates import on_sheet

UP = 1j
"""The axis x of an engine points upwards."""
LONG, SIDE, HIGH = 130.0, 50.0, 84.0
"""Largest length and height of the side view of the crankshaft, and of the end view of the engine, on a page (mm)."""
WEB = 0.16
"""Half the width of a throw, as a share of the least distance of two cylinders."""
APART, OUT = 6.0, 7.0
"""Space between both views, and the length of axes beyond them (mm)."""


def piston_at(case: SolvedEngine, place: str, φ: float = 0.0) -> complex:
    """Return the place of a piston's pin (m, x + iy) with the crank at φ (rad)."""
    given = case.given
    cylinder = given.cylinders[int(place) - 1]
    turned = φ + cylinder.crank.si - cylinder.bank.si
    r, l = case.given.of_cylinder(place, "r"), case.given.l.si  # noqa: E741
    return (r * math.cos(turned) + math.sqrt(l**2 - (r * math.sin(turned)) ** 2)) * cmath.rect(1, cylinder.bank.si)


def crank_at(case: SolvedEngine, place: str, φ: float = 0.0) -> complex:
    """Return the place of a crank's pin (m, x + iy) with the crank at φ (rad)."""
    return cmath.rect(case.given.of_cylinder(place, "r"), φ + case.given.cylinders[int(place) - 1].crank.si)


def banks(case: SolvedEngine) -> dict[float, str]:
    """Return the first cylinder of each bank, by the bank's angle (rad)."""
    return {one.bank.si: place for place, one in reversed([*zip(case.cylinders, case.given.cylinders, strict=True)])}


def extent_of(case: SolvedEngine) -> tuple[float, float]:
    """Return the width and height (m) of cranks and pistons in the end view."""
    r = case.given.radius
    ends = [*(UP * piston_at(case, place) for place in banks(case).values()), complex(-r, -r), complex(r, r)]
    low, high = corners_of(ends)
    return (high - low).real, (high - low).imag


# --- the scheme --------------------------------------------------------------------------------------------


def scheme(case: SolvedEngine, size: FigureSize = IN_REPORT) -> Scene:
    """Draw the engine from the end of its shaft and, if its cylinders are at several places along the shaft, from the
    side.
    """
    front, μ_r = _from_the_end(case, size)
    if not case.given.has_length:
        return finish(front, notes=(μ_r,))
    side, μ_l = _shaft(case, size)
    (low, high), (left, top) = bounds(side.items), bounds(front.items)
    below = complex((low.real + high.real - left.real - top.real) / 2, low.imag - APART - top.imag)
    return finish(side + front.moved(below), notes=(μ_l, μ_r))


def _from_the_end(case: SolvedEngine, size: FigureSize) -> tuple[Canvas, Chain]:
    """Draw the cranks with the numbers of their cylinders, the axes of the banks, and a rod and a piston for
    each bank.
    """
    given = case.given
    usual = nice_up(max(extent_of(case)) * MM / HIGH)
    per = MM * size.per_unit(usual)
    reach = (given.radius + given.l.si) * per + OUT
    pins = _pins(case).items()
    circles = (Circle(0j, r * per, style.THIN) for r in sorted({r for (_, r), _ in pins}))
    items: list[Item] = [*circles, Line(-reach / 3 + 0j, reach / 3 + 0j, style.AXIS)]
    requests: list[Request] = []
    for bank, place in banks(case).items():
        along = UP * cmath.rect(1, bank)
        pin, crank = UP * piston_at(case, place) * per, UP * crank_at(case, place) * per
        items += [Line(0j, reach * along, style.AXIS), Line(crank, pin, style.VISIBLE)]
        items += [style.block(pin, cmath.phase(along), style.BLOCK), style.joint(pin)]
        number = [one for one in case.cylinders if given.cylinders[int(one) - 1].bank.si == bank]
        requests.append(label(pin, *joined(number), gap=5.0, prefer=(cmath.phase(along) - math.pi / 2,)))
    if 0.0 not in banks(case):
        items.append(Line(0j, reach * UP / 2, style.AXIS))
    requests.append(label(reach * UP if 0.0 in banks(case) else reach * UP / 2, Symbol("x"), gap=0.8))
    for (angle, r), names in pins:
        pin = UP * cmath.rect(r * per, angle)
        items += [Line(0j, pin, style.HEAVY), style.joint(pin)]
        requests.append(label(pin, *joined(names), gap=1.6, prefer=(cmath.phase(pin),)))
    items += style.pivot(0j)
    facts = [fact("crank", tuple(names), direction(UP * cmath.rect(1, turn))) for (turn, _), names in pins]
    facts += (fact("bank", direction(UP * cmath.rect(1, bank))) for bank in banks(case))
    return settle(Canvas(tuple(items), tuple(requests), tuple(facts))), size.note(Symbol("μ", "r"), usual)


def _pins(case: SolvedEngine) -> dict[tuple[float, float], list[Content]]:
    """Return the numbers of the cylinders on each pin, by the pin's angle within a turn (rad) and its radius (m)."""
    pins: dict[tuple[float, float], list[Content]] = {}
    for place, cylinder in zip(case.cylinders, case.given.cylinders, strict=True):
        angle = round(cylinder.crank.si % math.tau, 9) % math.tau
        pins.setdefault((angle, case.given.of_cylinder(place, "r")), []).append(place)
    return pins


def _shaft(case: SolvedEngine, size: FigureSize) -> tuple[Canvas, Chain]:
    """Draw the crankshaft from the side, z to the right, with its throws at their actual heights."""
    places = {place: one.at.si for place, one in zip(case.cylinders, case.given.cylinders, strict=True)}
    start, span = min(places.values()), max(places.values()) - min(places.values())
    usual = nice_up(max(span / LONG, 2 * case.given.radius / SIDE) * MM)
    per = MM * size.per_unit(usual)
    along = sorted({round(place, 12) for place in places.values()})
    web = WEB * min(after - before for before, after in pairwise(along)) * per
    end, high = span * per, case.given.radius * per
    # The shaft reaches beyond the webs of its first and last throws.
    beyond = BEYOND + web
    items: list[Item] = [Line(-beyond - 5 + 0j, end + beyond + 5 + 0j, style.AXIS)]
    requests: list[Request] = []
    throws = [-beyond + 0j]
    for place in sorted(places, key=lambda one: places[one]):
        x, up = (places[place] - start) * per, (UP * crank_at(case, place)).imag * per
        corners = [complex(x - web, 0), complex(x - web, up), complex(x + web, up), complex(x + web, 0)]
        # Cylinders in one place have one throw.
        throws += corners if corners[0].real > throws[-1].real - 1e-9 else []
        requests.append(label(complex(x, up), place, gap=1.0, prefer=(math.copysign(math.pi / 2, up),)))
    items.append(Polyline((*throws, end + beyond + 0j), SHAFT))
    marks, numbers = ruler([*places.values()], per, -high - 8, case.ledger.printed_unit("mm"))
    facts = tuple(fact("station", name, Number(float(f"{at * MM:.9g}"), unit="mm")) for name, at in places.items())
    return settle(Canvas((*items, *marks), (*requests, *numbers), facts)), size.note(Symbol("μ", "l"), usual)


# --- stars ---------------------------------------------------------------------------------------------------


def star(case: SolvedEngine, letter: str, order: int, size: FigureSize = IN_REPORT) -> Scene:
    """Draw the vectors of all cylinders one after another with the crank at 0, and the vector that closes them."""
    ledger = case.printed
    scale = orders_ids.scale(letter)
    μ = ledger.number(scale)
    on_paper = MM * μ.value / size.scale(μ.value) / size.enlarged / float(ledger[scale].values[0])
    vectors, at = [], 0j
    for place in case.cylinders:
        weight = case.length_of(letter, order, place)
        angle = float(ledger[orders_ids.angle(letter, order, place)].values[0])
        end = at + UP * weight * on_paper * cmath.rect(1, angle)
        vectors.append(PlanVector(f"{letter}{order}.{place}", at, end, "known", place))
        at = end
    name = ledger.symbol(orders_ids.resultant(letter, order))
    if ledger[orders_ids.resultant(letter, order)].at(1):
        vectors.append(PlanVector(f"{letter}{order}", 0j, at, "found", name))
    drawing = Plan(
        tuple(vectors), (PlanPoint(Symbol("O"), 0j),), scale=size.note(ledger.symbol(scale), μ.value, μ.unit)
    )
    return plan(drawing, title=case.words["orders"]["star"].format(letter=letter, order=order), margin=4.0)


def stars(case: SolvedEngine, letters: str, size: FigureSize = IN_REPORT) -> tuple[Scene, ...]:
    """Draw the stars of all orders, those that turn with the crank first."""
    return tuple(star(case, letter, order, size) for letter in letters for order in ORDERS)


DrawEngine = Callable[[SolvedEngine, FigureSize], tuple[Scene, ...]]
FIGURES: Mapping[str, tuple[str, DrawEngine]] = {
    "scheme": ("scheme", lambda case, size: (scheme(case, size),)),
    "forces": ("plans", lambda case, size: stars(case, case.stars["forces"], size)),
    "couples": ("plans", lambda case, size: stars(case, case.stars["couples"], size)),
}
"""Layer of each figure on a drawing sheet, and the function that draws it."""


def plates(case: SolvedEngine) -> Iterator[DrawingPlate]:
    """Yield the scheme and the stars, at standard scales."""
    captions = case.words["orders"]["captions"]

    def plate(name: str, layer: str, steps: int) -> DrawingPlate:
        _, draw = FIGURES[name]
        scenes = tuple(map(lettered, draw(case, on_sheet(case, steps))))
        return DrawingPlate(captions[f"figure-{name}"], (), layer, scenes)

    for name, (layer, _) in FIGURES.items():
        if name != "couples" or name in case.stars:
            yield enlargeable(partial(plate, name, layer))
