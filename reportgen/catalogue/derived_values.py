"""Worked lines of the values that a machine of the atlas calculates from its parameters: l = 0.75·L = 525 mm.

`derived_lines` returns them for the report's given data, and `free_parameters` the parameters in them that no table of
the linkage has. A line has the unit of its parameters as typed if they have one, else the SI units of all of them.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence

from reportgen.assignment.parameter_formulas import ANGLE
from reportgen.base.errors import Where
from reportgen.base.units import Given, scale
from reportgen.catalogue import linkage_file
from reportgen.catalogue.atlas_file import FIGURES, CompiledMachine, PlacedFormula
from reportgen.catalogue.linkage_words import link_axes, rods
from reportgen.catalogue.typed_quantities import UNITS, as_typed
from reportgen.formula import Call, Chain, Expression, Number, Symbol, call, ids, size, sqrt, vocabulary
from reportgen.formula.calculation import Calculation

EXACT = 12
"""Significant figures of a converted number, which drop the last bits of floats."""
_COHERENT = ("m", "kg", "N", "kg m2", "rad/s", "rad/s2", "m/s", "m/s2", "N m", "Pa", "s")
"""SI units of the quantities of a linkage; angles are in degrees."""
_GREEK = {
    "alpha": "α",
    "beta": "β",
    "gamma": "γ",
    "delta": "δ",
    "epsilon": "ε",
    "eta": "η",
    "theta": "θ",
    "lambda": "λ",
    "mu": "μ",
    "xi": "ξ",
    "rho": "ρ",
    "sigma": "σ",
    "tau": "τ",
    "phi": "φ",
    "psi": "ψ",
    "omega": "ω",
}
_CALLS = {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}
PLACES = frozenset("ξη")
"""Letters of the coordinates of a point of a link, which the report explains."""
Leaf = Callable[[str], Expression]


def derived_lines(
    machine: CompiledMachine, given: Mapping[str, Given], linkage: linkage_file.Parameters, entered: Calculation
) -> tuple[Chain, ...]:
    """Return a line for each calculated value: its symbol, its formula, its numbers, its result.

    `given` are the parameters by name, `linkage` is the machine with them, and `entered` its quantities. A value at a
    place without a symbol begins with its formula.
    """
    symbols, places = _symbols(machine, linkage, entered), dict(_places(linkage, entered))
    lines: dict[tuple[Symbol | None, str], Chain] = {}
    for at in machine.formulas:
        if not isinstance(at.formula.tree, ast.Name):
            symbol = places.get(at.where)
            lines.setdefault((symbol, at.formula.text), _line(at, given, symbols, symbol))
    return tuple(lines.values())


def free_parameters(
    machine: CompiledMachine, given: Mapping[str, Given], linkage: linkage_file.Parameters, entered: Calculation
) -> tuple[tuple[str, Symbol, Number], ...]:
    """Return the parameters in calculated values that are not themselves given data of the linkage.

    Each has its name, its symbol and its value as typed.
    """
    used = dict.fromkeys(
        name for at in machine.formulas if not isinstance(at.formula.tree, ast.Name) for name in at.formula.names
    )
    known = {name for name, _ in _given_data(machine, linkage, entered)}
    return tuple((name, own_symbol(name), as_typed(given[name])) for name in used if name not in known)


def own_symbol(name: str) -> Symbol:
    """Return the symbol of a parameter: m2 is m with the index 2, AB the length l of AB, beta is β."""
    if re.fullmatch(r"([A-Z]\d*){2}", name):
        return vocabulary.symbol(ids.length(name))
    word = name.rstrip("0123456789")
    number = name.removeprefix(word)
    if word in _GREEK:
        return Symbol(_GREEK[word], number)
    return Symbol(word[0], word[1:] + number) if word[:1].isupper() else Symbol(word, number)


# --- places and their symbols ---------------------------------------------------------------------


def ids_by_place(given: linkage_file.Parameters) -> Iterator[tuple[Where, str]]:
    """Yield the places of given data in a `linkage` file with their ids."""
    driver = given.driver
    if isinstance(driver, linkage_file.CrankDriver):
        yield ("driver", "length"), ids.length(driver.centre, driver.pin)
        yield from ((("driver", key), id) for key, id in (("n", "n"), ("omega1", "omega.1"), ("epsilon1", "eps.1")))
    else:
        yield ("driver", "speed"), ids.velocity(driver.pin)
        yield ("driver", "acceleration"), ids.acceleration(driver.pin)
    for index, group in enumerate(given.groups):
        lengths = [ids.length(rod) for rod in rods(group)]
        yield ("groups", index, "length"), lengths[0] if lengths else ""
        yield from ((("groups", index, "lengths", number), id) for number, id in enumerate(lengths))
        yield from ((("groups", index, "legs", number, "length"), id) for number, id in enumerate(lengths))
    for index, body in enumerate(given.masses):
        for key, id in (("G", ids.weight(body.link)), ("m", ids.mass(body.link)), ("J", ids.inertia(body.link))):
            yield ("masses", index, key), id


def _given_data(
    machine: CompiledMachine, linkage: linkage_file.Parameters, entered: Calculation
) -> Iterator[tuple[str, Symbol]]:
    """Yield the parameters that are given data of the linkage as typed, with the symbols there."""
    bare = {at.where: at.formula.bare for at in machine.formulas if at.formula.bare}
    for where, id in ids_by_place(linkage):
        if where in bare and id in entered:
            yield bare[where], entered.families[id].symbol


def _symbols(machine: CompiledMachine, linkage: linkage_file.Parameters, entered: Calculation) -> Mapping[str, Symbol]:
    """Return the symbols of all parameters: those of the given data that they are, else of their own."""
    there: dict[str, Symbol] = {}
    for name, symbol in _given_data(machine, linkage, entered):
        there.setdefault(name, symbol)
    return {name: there.get(name) or own_symbol(name) for name in machine.parameters}


def _places(linkage: linkage_file.Parameters, entered: Calculation) -> Iterator[tuple[Where, Symbol]]:
    """Yield the places of a `linkage` file at which a value has a symbol; the values of a load's table have none."""
    yield from ((where, entered.families[id].symbol) for where, id in ids_by_place(linkage) if id in entered)
    for name in linkage.frame:
        yield from ((("frame", name, number), Symbol(axis, name)) for number, axis in enumerate("xy"))
    axes = link_axes(linkage)
    for name, point in linkage.points.items():
        along, across = point.at
        if along.si > 0 and not across.si:
            yield ("points", name, "at", 0), vocabulary.symbol(ids.length(f"{axes[point.link][0]}{name}"))
        else:
            yield from _of_point(("points", name, "at"), name)
    for index, group in enumerate(linkage.groups):
        at: Where = ("groups", index)
        if isinstance(group, linkage_file.TernaryGroup):
            for name in group.at:
                yield from _of_point((*at, "at", name), name)
            continue
        first, last = map(str, group.links)
        yield (*at, "offset"), Symbol("e", last)
        yield (*at, "across"), Symbol("δ", last)
        guides = {("guide",): last, ("guides", 0): first, ("guides", 1): last}
        for where, link in guides.items():
            yield from _of_guide((*at, *where), link)
    driver = linkage.driver
    if isinstance(driver, linkage_file.SlideDriver):
        yield from _of_guide(("driver", "guide"), "1")
    yield from _of_loads(linkage.loads)


def _of_loads(loads: Sequence[linkage_file.Loading]) -> Iterator[tuple[Where, Symbol]]:
    """Yield the places of the sizes and directions of loads; a second one on a link is P3a, as among its forces."""
    counts = Counter[tuple[str, int]]()
    for index, load in enumerate(loads):
        letter = "M" if getattr(load, "torque_unit", None) or getattr(load, "M", None) else "P"
        before = counts[letter, load.link]
        counts[letter, load.link] += 1
        name = f"{load.link}{chr(ord('a') + before - 1) if before else ''}"
        symbol = Symbol("D" if isinstance(load, linkage_file.Gas) else letter, name)
        yield from ((("loads", index, key), symbol) for key in "FMD")
        yield ("loads", index, "direction"), Symbol("α", f"P{name}")


def _of_point(where: Where, name: str) -> Iterator[tuple[Where, Symbol]]:
    for number, id in enumerate((ids.along_link, ids.across_link)):
        yield (*where, number), vocabulary.symbol(id(name))


def _of_guide(where: Where, link: str) -> Iterator[tuple[Where, Symbol]]:
    yield from (((*where, "at", number), Symbol(axis, link)) for number, axis in enumerate("xy"))
    yield (*where, "angle"), Symbol("α", link)


# --- lines ----------------------------------------------------------------------------------------


def _line(at: PlacedFormula, given: Mapping[str, Given], symbols: Mapping[str, Symbol], symbol: Symbol | None) -> Chain:
    formula, quantities = at.formula, {**given, **at.formula.constants}
    typed = at.result_unit(given)
    unit = _common_unit(typed, [quantities[name] for name in (*formula.names, *formula.constants)])

    def named(name: str) -> Expression:
        return as_typed(formula.constants[name]) if name in formula.constants else symbols[name]

    def number(name: str) -> Expression:
        return _number(quantities[name], unit)

    result = _unit_of(typed, unit)
    value = at.value(given).si / (scale(result)[0] if result else 1.0)
    result_number = Number(float(f"{value:.{FIGURES}g}"), unit=UNITS.get(result, result))
    # With the numbers, a parameter with a changed sign is the result already.
    substituted = () if _is_opposite(formula.tree) else (_built(formula.tree, number),)
    parts = (_built(formula.tree, named), *substituted, result_number)
    return Chain(parts if symbol is None else (symbol, *parts))


def _is_opposite(node: ast.expr) -> bool:
    return isinstance(node, ast.UnaryOp) and isinstance(node.operand, ast.Name)


def _common_unit(result: str, quantities: list[Given]) -> str:
    """Return the unit that all quantities of a formula have as typed, angles apart; "" if they or the result differ."""
    units = {one.unit for one in quantities if one.unit and scale(one.unit)[1] != ANGLE}
    fits = not result or scale(result)[1] == ANGLE or units == {result}
    return units.pop() if len(units) == 1 and fits else ""


def _unit_of(unit: str, common: str) -> str:
    """Return the unit in which a value with some unit is printed, "" for a pure number.

    Quantities that no linkage has, as a stiffness or a density, are printed without a unit, in the SI.
    """
    if not unit or unit == common:
        return unit
    dimension = scale(unit)[1]
    if dimension == ANGLE:
        return "deg"
    return next((name for name in _COHERENT if scale(name)[1] == dimension), "")


def _number(given: Given, common: str) -> Expression:
    """Return a quantity as the substitution shows it: in degrees or without its unit, a typed ratio as a fraction."""
    top, slash, bottom = given.text.partition("/")
    if slash and not given.unit:
        return Number(float(top)) / Number(float(bottom))
    if not given.unit:
        return Number(given.value)
    is_angle = scale(given.unit)[1] == ANGLE
    coherent = _unit_of(given.unit, common)
    factor = scale(coherent)[0] if coherent else 1.0
    value = given.value if given.unit in (common, "deg") else float(f"{given.si / factor:.{EXACT}g}")
    return Number(value, unit="°" if is_angle else "")


def _built(node: ast.expr, leaf: Leaf) -> Expression:
    """Return a formula as an expression with `leaf` for each name; a repeated name becomes a square."""
    match node:
        case ast.Constant(value=int(number) | float(number)):
            return Number(float(number))
        case ast.Name(id=name):
            return leaf(name)
        case ast.UnaryOp(op=op, operand=inner):
            value = _built(inner, leaf)
            return -value if isinstance(op, ast.USub) else value
        case ast.Call(func=ast.Name(id=name), args=[argument]):
            return _called(name, _built(argument, leaf))
        case ast.BinOp(left=base, op=ast.Pow(), right=ast.Constant(value=int(power))):
            return _built(base, leaf) ** power
        case ast.BinOp(
            left=ast.BinOp(left=first, op=ast.Mult(), right=ast.Name(id=factor)),
            op=ast.Mult(),
            right=ast.Name(id=again),
        ) if factor == again:
            return _built(first, leaf) * leaf(factor) ** 2
        case ast.BinOp(left=left, op=op, right=right):
            return _combined(op, _built(left, leaf), _built(right, leaf))
    raise AssertionError("a formula is checked when it is parsed")


def _called(name: str, of: Expression) -> Expression:
    if name == "sqrt":
        return sqrt(of)
    called: Call = size(of) if name == "abs" else call(_CALLS.get(name, name), of)
    return called


def _combined(op: ast.operator, left: Expression, right: Expression) -> Expression:
    match op:
        case ast.Add():
            return left + right
        case ast.Sub():
            return left - right
        case ast.Mult():
            return left * right
    return left / right
