"""The mistakes of working that are known by name: each is a change of the ledger, which is evaluated with it.

A `Mistake` says in which quantity it is made, which quantities of the ledger change with it, and what they
become, given what they come to and all values before them (SI).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import takewhile

import numpy as np

from reportgen.answers.bands import is_direction
from reportgen.grading.guide import Guide, Values
from reportgen.grading.working import Change
from reportgen.notation import ids
from reportgen.notation.evaluation import evaluate
from reportgen.notation.expressions import Call, Expression, Negative, Sum, rebuild, refs, walk
from reportgen.notation.sheet import Family

WRONG_DATUM = "wrong-datum"
"""The name of a given datum taken wrongly."""

NO_CORIOLIS = "no-coriolis"
"""The name of a Coriolis acceleration left out."""

OF_POSITION = frozenset({"counted-backwards", "shifted-forward", "shifted-back"})
"""Mistakes about where a position lies: one value alone may meet another position's by chance."""

DECIMAL_PLACES = (1, 2, 3, 4, 5)
"""Decimals that a mark read as that of thousands takes along."""

TRIGONOMETRIC = {"sin", "cos", "tan"}
INVERSE = {"arcsin", "arccos", "arctan", "arctan2"}


@dataclass(frozen=True, slots=True)
class Mistake:
    """One mistake that can be made in one quantity.

    `name` is a key of `mistakes` in `words.yaml`, `where` the id of the quantity in which it is made.
    """

    name: str
    where: str
    changes: Mapping[str, Change]


def mistakes_in(guide: Guide, id: str, scales: Values) -> Iterator[Mistake]:
    """All mistakes that can be made in working out one quantity; `scales` are the student's own, in SI.

    What stands printed for every position (the crank's angle) can only be taken at another one.
    """
    family = guide.ledger[id]
    if family.exact and len(family.values) > 1:
        return
    for name, change in _changes_of(guide, family, scales):
        yield Mistake(name, id, {id: change})


def general_mistakes(guide: Guide) -> Iterator[Mistake]:
    """Mistakes about the positions as such, and a Coriolis acceleration that is left out."""
    ledger = guide.ledger
    read = [id for id, family in ledger.families.items() if family.definition is None and len(family.values) > 1]
    if read:
        count = len(ledger[read[0]].values)
        order = np.arange(count)
        for name, taken in (
            ("counted-backwards", -order % count),
            ("shifted-forward", np.roll(order, -1)),
            ("shifted-back", np.roll(order, 1)),
        ):
            yield Mistake(name, read[0], {id: _replaced_by(ledger[id].values[taken]) for id in read})
    for id, family in ledger.families.items():
        if family.kind == "acceleration" and family.symbol.sup == "k":
            yield Mistake(NO_CORIOLIS, id, {id: _times(0)})


def _changes_of(guide: Guide, family: Family, scales: Values) -> Iterator[tuple[str, Change]]:
    """What one quantity becomes with each mistake, by name."""
    id = family.id
    if family.definition is not None:
        yield from _in_a_definition(guide, family, family.definition, scales)
    elif family.kind == "pressure":
        yield from _in_reading_a_pressure(guide, id)
    if (rod := _whole_rod(guide, id)) is not None:
        yield "wrong-end", lambda value, values: values[rod] - value
    if is_direction(id):
        yield "direction-reversed", lambda value, _: value + np.pi
        return
    if family.is_signed_rotation:
        yield "direction-reversed", lambda value, _: -value
    elif not family.arm and family.kind != "segment" and (family.definition is not None or not family.exact):
        yield "sign-reversed", lambda value, _: -value
    for places in DECIMAL_PLACES:
        yield "thousands-mark", _times(10.0**places)


def _in_a_definition(
    guide: Guide, family: Family, definition: Expression, scales: Values
) -> Iterator[tuple[str, Change]]:
    used = [guide.ledger[ref] for ref in dict.fromkeys(refs(definition))]
    for given in used:
        yield from _with_a_wrong_input(guide, family, definition, given, scales)
    if family.kind == "angle" and _calls(definition, INVERSE):
        yield "radians-for-degrees", _times(np.pi / 180)
    if _calls(definition, TRIGONOMETRIC):
        angles = [given.id for given in used if given.kind == "angle"]
        yield "degrees-for-radians", _with(definition, {id: _degrees(id) for id in angles})
    if not family.constructed:
        for other in _other_signs(definition):
            yield "sign-reversed", _with(other, {})


def _with_a_wrong_input(
    guide: Guide, family: Family, definition: Expression, given: Family, scales: Values
) -> Iterator[tuple[str, Change]]:
    """Mistakes about one input of a definition."""
    ledger, id = guide.ledger, given.id

    def as_printed(_: np.ndarray, values: Values) -> np.ndarray:
        """The input's printed number taken for the result's."""
        return values[id] / given.how.scale * family.how.scale

    def instead(other: Callable[[Values], np.ndarray]) -> Change:
        return _with(definition, {id: other})

    if id == "H" and family.kind == "length":
        yield "stroke-for-radius", lambda _, values: values[id]
    elif given.kind == "ratio" and not given.hidden and not given.is_plane:
        yield "ratio-inverted", instead(lambda values: 1 / values[id])
    elif given.kind == "diameter":
        yield "diameter-for-radius", instead(lambda values: 2 * values[id])
    elif given.kind == "speed of rotation":
        yield "rpm-for-radians", as_printed
        # 2πn without the 60.
        yield "minute-for-second", _times(60.0)
    elif id == "omega.1" and "n" in ledger:
        yield "rpm-for-radians", instead(lambda values: values["n"])
    elif given.kind == "weight" and family.kind == "mass":
        yield "weight-for-mass", as_printed
    elif given.kind == "mass" and (weight := _weight(guide, given)):
        yield "weight-for-mass", instead(lambda values: values[weight])
    elif given.kind.endswith("scale") and not family.constructed and (power := _power(guide, definition, id)):
        number = scales.get(id, given.values) / given.how.scale
        # v = seg and v = μ²·seg instead of v = μ·seg.
        yield "scale-forgotten", _times(number**-power)
        yield "scale-twice", _times(number**power)


def _weight(guide: Guide, mass: Family) -> str:
    """The weight of the link that a mass is of, "" if it has none."""
    weights = (one for one in guide.ledger.families.values() if one.kind == "weight")
    return next((one.id for one in weights if one.symbol.sub == mass.symbol.sub), "")


def _power(guide: Guide, definition: Expression, scale: str) -> int:
    """The power (±1) in which a scale stands in a definition as a whole; 0 if it does not."""
    values = {id: guide.ledger[id].values for id in refs(definition)}
    with np.errstate(all="ignore"):
        once = np.atleast_1d(evaluate(definition, values))
        twice = np.atleast_1d(evaluate(definition, values | {scale: 2 * values[scale]}))
        ratio = (twice / once)[np.isfinite(twice / once)]
    for power in (1, -1):
        if ratio.size and np.allclose(ratio, 2.0**power):
            return power
    return 0


def _in_reading_a_pressure(guide: Guide, id: str) -> Iterator[tuple[str, Change]]:
    """The pressure of another piston, or of another stroke at the piston's own place."""
    gas = guide.analysis.gas if guide.analysis else {}
    here = next((state for state in gas.values() if ids.pressure(state.piston.link) == id), None)
    if here is None:
        return
    for state in gas.values():
        if state is not here:
            yield "other-piston", _replaced_by(state.pressure)
    piston = here.piston
    for angle in (here.angle + 2 * np.pi, -here.angle, 2 * np.pi - here.angle):
        pressure = piston.law.table.pressure(angle, here.fraction, piston.dead_centres)
        yield "wrong-stroke", _replaced_by(pressure)


def _whole_rod(guide: Guide, id: str) -> str | None:
    """The length of the rod on which `l.AS2` places a mass centre."""
    if guide.analysis is None:
        return None
    linkage = guide.analysis.machine.linkage
    centres = {body.centre for body in linkage.inertias}
    for dyad in linkage.dyads:
        ends = [end for end in (dyad.start, dyad.end) if id in {ids.length(end, centre) for centre in centres}]
        for end in ends:
            names = {ids.length(end, dyad.middle), ids.length(dyad.middle, end)}
            earlier = takewhile(lambda name: name != id, guide.ledger.families)
            return next((name for name in earlier if name in names), None)
    return None


# --- changes ----------------------------------------------------------------------------------------


def _times(factor: float | np.ndarray) -> Change:
    return lambda value, _: value * factor


def _replaced_by(other: np.ndarray) -> Change:
    return lambda _, __: other


def _degrees(id: str) -> Callable[[Values], np.ndarray]:
    return lambda values: np.degrees(values[id])


def _with(definition: Expression, others: Mapping[str, Callable[[Values], np.ndarray]]) -> Change:
    """The definition worked out with other values of some of its inputs."""

    names = refs(definition)

    def change(_: np.ndarray, values: Values) -> np.ndarray:
        inputs = {id: others[id](values) if id in others else values[id] for id in names}
        return np.atleast_1d(evaluate(definition, inputs))

    return change


def _calls(definition: Expression, names: set[str]) -> bool:
    return any(isinstance(part, Call) and part.name in names for part in walk(definition))


def _other_signs(definition: Expression) -> Iterator[Expression]:
    """The definition with the sign of one term turned, for every term of its sums."""
    for part in walk(definition):
        if isinstance(part, Sum) and len(part.terms) > 1:
            for index, term in enumerate(part.terms):
                turned = term.of if isinstance(term, Negative) else Negative(term)
                changed = Sum((*part.terms[:index], turned, *part.terms[index + 1 :]))
                yield _put(definition, part, changed)


def _put(node: Expression, old: Expression, new: Expression) -> Expression:
    return new if node is old else rebuild(node, lambda child: _put(child, old, new))
