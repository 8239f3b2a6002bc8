"""Work out an exercise: the ledger with the numbers of all steps that lead to the requested quantities (`work_out`).

Each velocity method is the set of steps that belong to it, tried in a fixed order.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property

from reportgen.base.records import Record, replace
from reportgen.exercise.acceleration_steps import Parts, about_points, by_slots, enter_accelerations
from reportgen.exercise.derivation import Derivation, Quantities, Step
from reportgen.exercise.drive_trains import by_rack, by_rims, by_train
from reportgen.exercise.file import Asked, Method
from reportgen.exercise.functions_of_angle import by_equations
from reportgen.exercise.instant_centres import SAME_PLACE, InstantCentre, Layout, lay_out, name_of_centre
from reportgen.exercise.loop_rates import enter_proportion, solve_accelerations_together, solve_velocities_together
from reportgen.exercise.point_positions import Exercise
from reportgen.exercise.velocity_steps import (
    about_joints,
    by_base_point,
    by_centre,
    by_guided_frame,
    by_moving_frame,
    by_projection,
    derive,
    enter_blocks,
    enter_given,
    from_base_point,
)
from reportgen.formula import Symbol, ids, refs
from reportgen.formula.calculation import DUST, Calculation
from reportgen.formula.ledger import Ledger
from reportgen.formula.printed_decimals import carried

BELOW_A_TURN = 1e-9
"""An angle less than this below a whole turn (degrees) counts as 0."""
SAME_SHARE, SAME_SI = 1e-6, 1e-9
"""Values that differ by less than this share, or by less than this in SI units, are equal."""
POSITIONS = 1
"""The position index of the only instant."""


class Worked(Record, dict=True):
    """The ledger of an exercise, its layout, and its steps in order; `missing` are requested ids that no step
    computes.
    """

    ledger: Ledger
    layout: Layout
    steps: tuple[Step, ...]
    missing: tuple[str, ...]
    method: Method | None = None
    named: frozenset[str] = frozenset()
    """The ids of quantities whose value is that of a symbol of the file."""

    @cached_property
    def printed(self) -> Ledger:
        """Return the ledger with printed decimals; a quantity that equals a symbol of the file is printed as in the
        file.
        """
        families = self.ledger.families
        named = {id: replace(families[id], definition=None, exact=True) for id in self.named}
        rounded = carried(replace(self.ledger, families={**families, **named}))
        values = {id: replace(family, values=rounded[id].values) for id, family in families.items()}
        return replace(rounded, families=values)

    @property
    def by_method(self) -> bool:
        """Return True if at least one step belongs to the method."""
        return self.method is None or any(belongs(step, self.method) for step in self.steps)


def work_out(
    exercise: Exercise,
    units: Mapping[str, str],
    names: Mapping[str, str],
    method: Method | None = None,
    velocities_alone: bool = False,
) -> Worked:
    """Work out an exercise step by step; steps that no requested quantity needs are omitted.

    `units` and `names` are units and indices of symbols in a language.  If a `method` is given, it finds the
    velocities; with `velocities_alone`, no other method may help.
    """
    derivation = Derivation(Quantities(POSITIONS, exercise.motion), lay_out(exercise.given, exercise.motion))
    enter_given(derivation)
    find_velocities(derivation, method, alone=velocities_alone)
    if not velocities_alone:
        enter_accelerations(derivation, ACCELERATIONS)
    missing = [one.id for one in exercise.asked if one.what != "centre" and not _leads_to(derivation, one)]
    for asked in exercise.asked:
        if asked.what == "centre":
            missing += [] if enter_centre(derivation, asked.body) else [asked.id]
    for asked in exercise.asked:
        if asked.what in ids.LINK_RATE:
            _signed(derivation, asked)
        elif asked.what in ids.POINT_RATE:
            _directed(derivation, asked)
    wanted = [one.id for one in exercise.asked] + _among(derivation, ids.centre_coordinate, ids.signed, ids.direction)
    wanted += [id for step in derivation.steps if step.kind == "centre-rate" for id in step.ids]
    if velocities_alone and not any(one.what in ("v", "omega") for one in exercise.asked):
        wanted += _among(derivation, ids.velocity, ids.velocity_component, ids.sliding_velocity, ids.angular_velocity)
    needed = _with_ancestors(derivation, wanted)
    steps = tuple(step for step in derivation.steps if _leads_on(step, needed))
    # A step that is used at all is written out completely.
    needed |= _with_ancestors(derivation, [id for step in steps for id in (*step.ids, *step.read)])
    steps = _without_repeated_readings(step for step in derivation.steps if _leads_on(step, needed))
    q = Calculation(POSITIONS)
    for id, family in derivation.q.families.items():
        if id in needed:
            q.enter(family)
    ledger = Ledger(q.families, POSITIONS, units=units).in_language(names)
    return Worked(ledger, derivation.layout, steps, tuple(missing), method, _named(exercise, ledger))


def _named(exercise: Exercise, ledger: Ledger) -> frozenset[str]:
    """Return the ids of computed quantities whose value equals that of a symbol."""
    values = [symbol.given.si for symbol in exercise.given.symbols.values()]
    return frozenset(
        id
        for id, family in ledger.families.items()
        if family.definition is not None and not family.is_plane
        if any(math.isclose(abs(family.at(None)), abs(value), rel_tol=DUST) for value in values)
    )


def _leads_to(derivation: Derivation, asked: Asked) -> bool:
    """Return True if the steps lead to the requested value and it equals that of the whole system."""
    if asked.id not in derivation.q:
        return False
    value = derivation.motion.turn(asked.what, asked.body) if asked.of_body else abs(_vector(derivation, asked))
    return math.isclose(derivation.q.si(asked.id), abs(value), rel_tol=SAME_SHARE, abs_tol=SAME_SI)


def _is_worked_out(derivation: Derivation, id: str) -> bool:
    return id in derivation.q and derivation.q.families[id].definition is not None


def _signed(derivation: Derivation, asked: Asked) -> None:
    """Enter a rotation with its sign, positive anticlockwise, beside its magnitude, if the data determine the sense."""
    if _is_worked_out(derivation, asked.id) and derivation.motion.knows_sense(asked.what, asked.body):
        size = derivation.q[asked.id]
        turn = size if derivation.motion.turn(asked.what, asked.body) >= 0 else -size
        derivation.q.define(ids.signed(asked.what, asked.of), turn, of=size.id)


def _directed(derivation: Derivation, asked: Asked) -> None:
    """Enter the direction of a requested vector as its angle from +x in [0, 2π); a zero vector has none."""
    vector, what, point = _vector(derivation, asked), asked.what, asked.of
    if vector and _is_worked_out(derivation, asked.id):
        angle = (math.degrees(cmath.phase(vector)) + BELOW_A_TURN) % 360.0 - BELOW_A_TURN
        turned = derivation.q.give(ids.heading(what, point), math.radians(angle), Symbol("α"), "angle", hidden=True)
        derivation.q.define(ids.direction(what, point), turned, scale=1.0, of=asked.id)


def _vector(derivation: Derivation, asked: Asked) -> complex:
    """Return the requested velocity (m/s) or acceleration (m/s²)."""
    return derivation.motion.v(asked.of) if asked.what == "v" else derivation.motion.a(asked.of)


def _among(derivation: Derivation, *families: ids.Name) -> list[str]:
    """Return the ids in the derivation that belong to these families."""
    return [id for id in derivation.q.families if any(id in family for family in families)]


def _with_ancestors(derivation: Derivation, some: Sequence[str]) -> set[str]:
    """Return those of some ids that are in the derivation, with all quantities that they depend on."""
    families = derivation.q.families
    waiting = [id for id in some if id in families]
    leading: set[str] = set()
    while waiting:
        id = waiting.pop()
        if id not in leading:
            leading.add(id)
            definition = families[id].definition
            waiting += () if definition is None else refs(definition)
    return leading


def _without_repeated_readings(steps: Iterable[Step]) -> tuple[Step, ...]:
    """Return steps without readings that an earlier step has printed."""
    known, kept = set[str](), list[Step]()
    for step in steps:
        kept.append(replace(step, read=tuple(id for id in step.read if id not in {*known, *step.ids})))
        known |= {*step.ids, *step.read}
    return tuple(kept)


def _leads_on(step: Step, needed: set[str]) -> bool:
    """Return True if a step computes anything needed, or explains why something needed is zero."""
    worked = [id for id in step.ids if id not in ids.length]
    return any(id in needed for id in worked or [ids.velocity(step.point)])


# --- methods: the steps of each, in the order in which they are tried ----------------------------------


VelocityStep = Callable[[Derivation], bool]
"""A step that enters one more velocity, or those of one more body; returns False if it cannot."""

CHOSEN: tuple[VelocityStep, ...] = (derive, by_base_point, enter_proportion, by_train, solve_velocities_together)
"""The default choice for each step: the instant centre if there is one, and last all remaining rates together."""

ACCELERATIONS: tuple[Callable[[Parts], bool], ...] = (
    about_points,
    by_rims,
    lambda parts: by_train(parts.derivation, "eps"),
    by_rack,
    by_slots,
    lambda parts: enter_blocks(parts.derivation, "eps"),
    solve_accelerations_together,
)
"""Steps by base points, by radii, and along the lines of moving bodies; last all remaining rates together."""

OWN: Mapping[Method, tuple[VelocityStep, ...]] = {
    "instant centre": (by_centre, enter_proportion),
    "base point": (from_base_point, by_base_point),
    "projection": (by_projection,),
    "moving frame": (by_guided_frame,),
    "equations": (by_equations,),
}

_KINDS: Mapping[Method, tuple[str, ...]] = {
    "instant centre": (
        "rate-contact",
        "rate-normals",
        "rate-parallel",
        "speed-",
        "translation",
        "at-rest",
        "proportion",
    ),
    "base point": ("base-", "two-bases"),
    "projection": ("projection",),
    "moving frame": ("slot-",),
    "equations": ("equations",),
}


def belongs(step: Step, method: Method) -> bool:
    """Return True if a step is one of the method's own."""
    return step.kind != "speed-pivot" and step.kind.startswith(_KINDS[method])


def find_velocities(derivation: Derivation, method: Method | None, alone: bool = False) -> None:
    """Enter all velocities that the method finds and, unless it must work alone, those that other methods then find.

    Bodies that a joint makes rotate about a fixed point or move in translation belong to every method.  So does motion
    along the line of a moving body, for which there is no alternative; a moving frame may be carried by bodies of any
    motion.  Only instant centres give the direction of a point that no joint guides.
    """
    finders = CHOSEN
    if method is not None:
        joints = (by_equations, about_joints) if method == "equations" else (about_joints, *OWN[method])
        own = (*joints, by_moving_frame if method == "instant centre" else by_guided_frame)
        finders = own if alone and method != "moving frame" else (*own, *CHOSEN)
    while any(find(derivation) for find in finders):
        pass


# --- instant centres that are asked ---------------------------------------------------------------


def enter_centre(derivation: Derivation, body: int) -> bool:
    """Enter the coordinates of a body's instant centre; return True if it is known, even if it is infinitely far."""
    if body not in derivation.layout.centres:
        _from_rate(derivation, body)
    centre = derivation.layout.centres.get(body)
    if centre is None:
        return False
    if centre.rule != "translation":
        for axis, value in (("x", centre.at.real), ("y", centre.at.imag)):
            size = derivation.motion.size
            id = ids.centre_coordinate(body, axis)
            derivation.q.give(id, value, Symbol(axis, centre.name), exact=False, scale=size)
    return True


def _from_rate(derivation: Derivation, body: int) -> None:
    """Enter the centre on the normal to a known velocity, at the distance v/ω; it is infinitely far in translation."""
    layout, q = derivation.layout, derivation.q
    known = [name for name in layout.members[body] if derivation.knows_velocity(name)]
    if not derivation.knows_omega(body) or not known:
        return
    at = derivation.motion.centre(body)
    if at is None:
        layout.centres[body] = InstantCentre(body, "translation")
        return
    name = name_of_centre(layout, body, at)
    away = next((one for one in known if abs(layout.points[one] - at) > SAME_PLACE), "")
    layout.centres[body] = InstantCentre(body, "rate", name, at, (away,) if away else ())
    if away:
        length = q.define(ids.length(name, away), q[ids.velocity(away)] / q[ids.angular_velocity(body)])
        derivation.steps.append(Step("centre-rate", (length.id,), body, away, name))
