"""What an id says: for each family of ids its letter, its kind, its chapter, its plan and how values compare.

A row for each family of `ids`, which reads the id.  A quantity asks here for its symbol, a key for its chapter,
marking for the scale of a length on paper and for the distance of two values, the words for what they call it.

A *kind* fixes the printed unit, what one such unit is in SI, and with how many figures or decimals it is printed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import lru_cache

import numpy as np

from reportgen.formula import Symbol, ids
from reportgen.formula.constructions import Value
from reportgen.formula.ids import Name


@dataclass(frozen=True, slots=True)
class QuantityKind:
    """How a kind of quantity is printed: SI value = printed value × `scale`.

    `digits` are the significant figures of the largest value of what is computed; `decimals`, if given, is what the
    kind is usually given with instead (0.01 mm for a length on paper).
    """

    unit: str
    scale: float = 1.0
    digits: int = 5
    decimals: int | None = None


KINDS: dict[str, QuantityKind] = {
    "ratio": QuantityKind(""),
    "count": QuantityKind("", decimals=0),
    "sign": QuantityKind("", decimals=0),
    "share": QuantityKind("%", 1e-2, decimals=3),
    "angle": QuantityKind("°", math.pi / 180, decimals=2),
    "direction": QuantityKind("°", math.pi / 180, decimals=1),
    "speed of rotation": QuantityKind("rpm"),
    "time": QuantityKind("s"),
    "length": QuantityKind("m"),
    "diameter": QuantityKind("cm", 1e-2),
    "area": QuantityKind("cm²", 1e-4),
    "product of lengths": QuantityKind("m²"),
    "segment": QuantityKind("mm", 1e-3, decimals=2),
    "cam length": QuantityKind("mm", 1e-3, decimals=3),
    "radius of curvature": QuantityKind("mm", 1e-3),
    "reduced velocity": QuantityKind("mm/rad", 1e-3, decimals=3),
    "reduced acceleration": QuantityKind("mm/rad²", 1e-3, decimals=3),
    "angle on paper": QuantityKind("rad/mm", 1e3, digits=6),
    "length on paper": QuantityKind("mm/mm", digits=6),
    "reduced velocity on paper": QuantityKind("mm/(rad·mm)", digits=6),
    "reduced acceleration on paper": QuantityKind("mm/(rad²·mm)", digits=6),
    "rate on paper": QuantityKind("mm⁻¹", 1e3, digits=6),
    "phase share": QuantityKind("", decimals=5),
    "follower velocity": QuantityKind("mm/s", 1e-3),
    "follower acceleration": QuantityKind("mm/s²", 1e-3),
    "graph value": QuantityKind("", decimals=5),
    "swing": QuantityKind("°", math.pi / 180, decimals=4),
    "arc": QuantityKind("rad", digits=6),
    "gear length": QuantityKind("mm", 1e-3, decimals=3),
    "gear number": QuantityKind("", decimals=4),
    "gear angle": QuantityKind("°", math.pi / 180, decimals=4),
    "gear figure": QuantityKind("", digits=4),
    "involute": QuantityKind("", decimals=6),
    "velocity on paper": QuantityKind("mm/(s·mm)", digits=6),
    "rotation on paper": QuantityKind("rad/(s·mm)", 1e3, digits=6),
    "length scale": QuantityKind("m/mm", 1e3, digits=6),
    "velocity scale": QuantityKind("m/(s·mm)", 1e3, digits=6),
    "acceleration scale": QuantityKind("m/(s²·mm)", 1e3, digits=6),
    "force scale": QuantityKind("N/mm", 1e3, digits=6),
    "inertia scale": QuantityKind("kg·m²/mm", 1e3, digits=6),
    "work scale": QuantityKind("J/mm", 1e3, digits=6),
    "pressure scale": QuantityKind("N/(cm²·mm)", 1e7, digits=6),
    "velocity": QuantityKind("m/s"),
    "acceleration": QuantityKind("m/s²"),
    "angular velocity": QuantityKind("rad/s"),
    "angular acceleration": QuantityKind("rad/s²"),
    "weight": QuantityKind("N"),
    "gravity": QuantityKind("m/s²"),
    "mass": QuantityKind("kg"),
    "moment of inertia": QuantityKind("kg·m²"),
    "pressure": QuantityKind("N/cm²", 1e4),
    "force": QuantityKind("N"),
    "torque": QuantityKind("N·m"),
    "work": QuantityKind("J"),
    "power": QuantityKind("W"),
}

MAX_DIGITS = max(kind.digits for kind in KINDS.values())
"""Significant figures of the largest value of what is computed, at most."""


def point(name: str) -> Symbol:
    """The symbol of a point called e.g. "A", "S2", "O1": letter and lowered number."""
    letters = name.rstrip("0123456789")
    return Symbol(letters, sub=name[len(letters) :])


def on_plan(name: str, prime: bool = False) -> Symbol:
    """The image of a point on a velocity plan (b, s2) or, primed, on an acceleration plan (b′, s2′)."""
    symbol = point(name)
    return Symbol(symbol.base.lower(), symbol.sub, "′" if prime else "")


def vector(symbol: Symbol) -> Symbol:
    """The same symbol as a vector."""
    return Symbol(symbol.base, symbol.sub, symbol.sup, "vector")


def in_language(symbol: Symbol, names: Mapping[str, str]) -> Symbol:
    """The symbol with its indices as a language has them: with cb → bal, M_cb is M_bal; h_Pqt5 has the qt of P_qt5."""
    sub = _WORDS.sub(lambda found: names.get(found[0], found[0]), symbol.sub)
    return replace(symbol, sub=sub, sup=names.get(symbol.sup, symbol.sup))


_WORDS = re.compile("[a-z]+")


def lowered(text: str) -> str:
    """Digits of point names as lowered digits: B3 → B₃."""
    return text.translate(_LOWERED)


_DIGITS, _BELOW = "0123456789", "₀₁₂₃₄₅₆₇₈₉"
_LOWERED, _RAISED = str.maketrans(_DIGITS, _BELOW), str.maketrans(_BELOW, _DIGITS)
_RUN = re.compile(f"([^{_BELOW}]*)([{_BELOW}]*)")
_NUMBERED = re.compile(r"([A-Z])([a-z]*\d+)")


def runs(text: str) -> list[tuple[str, str]]:
    """Letters with the digits that stand below them: O₁A is O with 1, then A."""
    return [(letters, digits.translate(_RAISED)) for letters, digits in _RUN.findall(text) if letters or digits]


def numbered(index: str) -> list[tuple[str, str]]:
    """An index in names with their numbers and what stands between: O1A is O with 1, then A; h_Pqt5 has P with qt5."""
    between, *named = _NUMBERED.split(index)
    pieces = [(between, "")]
    for letter, number, after in zip(named[::3], named[1::3], named[2::3], strict=True):
        pieces += [(letter, number), (after, "")]
    return [piece for piece in pieces if piece[0]]


def segment(first: Symbol | str, second: Symbol | str) -> Symbol:
    """A length between two points of a drawing: a bar over both letters, e.g. over p b or O₁A."""
    one = first if isinstance(first, Symbol) else Symbol(first)
    two = second if isinstance(second, Symbol) else Symbol(second)
    return Symbol(one.base + lowered(one.sub) + one.sup + two.base, two.sub, two.sup, "segment")


def drawn_length(first: str, second: str) -> Symbol:
    """The symbol of a length between two points on a drawing, e.g. AS₂ under a bar."""
    return segment(point(first), point(second))


class Chapter(StrEnum):
    """The chapters of a key, in their order; `words.yaml` has their headings under `parts`."""

    data = "data"
    geometry = "geometry"
    velocity = "velocity"
    acceleration = "acceleration"
    formulas = "formulas"
    loads = "loads"
    forces = "forces"
    torque = "torque"
    cycle = "cycle"


@dataclass(frozen=True)
class VocabularyRow:
    """A family of ids, or a single one.

    Under the `letter` stands the text `below`, else the word in the last place, above it the `part`.  `plan` is the id
    of the scale that lengths on paper are measured with.  What is in braces is a word that stands in that place of the
    id.  Values that go `around` the circle are directions.  `name` is what `words.yaml` calls the family.
    """

    ids: Name
    letter: str = ""
    kind: str = ""
    chapter: Chapter | None = None
    plan: str = ""
    below: str = ""
    around: bool = False
    name: str = ""

    def index(self, words: Mapping[str, str]) -> str:
        """What is printed below the letter."""
        named = [word for place, word in words.items() if place not in _NOT_BELOW]
        return self.below.format(**words) if self.below else next(reversed(named), "")


_NOT_BELOW = frozenset({"to", "axis", "part", "about", "letter"})
"""Places whose words are not printed below a letter."""

_G, _V, _A = Chapter.geometry, Chapter.velocity, Chapter.acceleration
_LOADS, _FORCES, _TORQUE, _CYCLE = Chapter.loads, Chapter.forces, Chapter.torque, Chapter.cycle

ROWS: tuple[VocabularyRow, ...] = (
    # geometry
    VocabularyRow(ids.percussion, "l", "length", _LOADS, below="{point}K{link}", name="percussion"),
    VocabularyRow(ids.length, "l", "length", _G, name="length"),
    VocabularyRow(ids.drawn, "", "segment", _G, "mu.l", name="drawn length"),
    VocabularyRow(ids.scale.only(plan="l"), "μ", "length scale", _G, below="l"),
    VocabularyRow(Name("R"), "R", "length", _G),
    VocabularyRow(Name("L"), "L", "length", _G),
    VocabularyRow(Name("H"), "H", "length"),
    VocabularyRow(Name("e"), "e", "length"),
    VocabularyRow(Name("D"), "D", "diameter"),
    VocabularyRow(Name("F"), "F", "area", _G),
    VocabularyRow(Name("lambda"), "λ", "ratio", _G),
    VocabularyRow(Name("theta"), "θ", "angle"),
    VocabularyRow(Name("K"), "K", "ratio"),
    VocabularyRow(Name("s"), "s", "ratio"),
    # masses
    VocabularyRow(Name("g"), "g", "gravity"),
    VocabularyRow(ids.weight, "G", "weight", _LOADS, name="weight"),
    VocabularyRow(ids.mass, "m", "mass", _G, name="mass"),
    VocabularyRow(ids.inertia, "J", "moment of inertia", _G, below="S{link}", name="inertia"),
    VocabularyRow(ids.reduced_inertia, "J", "moment of inertia", _CYCLE, name="reduced inertia"),
    VocabularyRow(Name("J.r"), "J", "moment of inertia", _CYCLE, below="r"),
    VocabularyRow(Name("J.d"), "J", "moment of inertia", _CYCLE, below="d"),
    VocabularyRow(Name("J.I"), "J", "moment of inertia", _CYCLE, below="I"),
    VocabularyRow(Name("T.I"), "T", "work", _CYCLE, below="I"),
    VocabularyRow(ids.scale.only(plan="J"), "μ", "inertia scale", _CYCLE, below="J"),
    VocabularyRow(ids.scale.only(plan="A"), "μ", "work scale", _CYCLE, below="A"),
    VocabularyRow(ids.tangent, "ψ", "angle", _CYCLE),
    # rotation
    VocabularyRow(Name("n"), "n", "speed of rotation"),
    VocabularyRow(Name("omega.of"), "ω", "angular velocity", _CYCLE),
    VocabularyRow(ids.bound_of_speed, "ω", "angular velocity", _V),
    VocabularyRow(ids.angular_velocity, "ω", "angular velocity", _V, name="angular velocity"),
    VocabularyRow(ids.signed.only(rate="omega"), "ω", "angular velocity", _V, name="signed angular velocity"),
    VocabularyRow(ids.angular_acceleration, "ε", "angular acceleration", _A, name="angular acceleration"),
    VocabularyRow(ids.signed.only(rate="eps"), "ε", "angular acceleration", _A, name="signed angular acceleration"),
    # plans of velocities and accelerations
    VocabularyRow(ids.scale.only(plan="v"), "μ", "velocity scale", _V, below="v"),
    VocabularyRow(ids.scale.only(plan="a"), "μ", "acceleration scale", _A, below="a"),
    VocabularyRow(ids.segment.only(what="v"), "", "segment", _V, "mu.v", name="segment"),
    VocabularyRow(ids.segment.only(what="a"), "", "segment", _A, "mu.a", name="segment"),
    VocabularyRow(ids.relative_segment, "", "segment", _A, "mu.a", name="segment"),
    VocabularyRow(ids.velocity, "v", "velocity", _V, name="velocity"),
    VocabularyRow(ids.stroke_velocity, "v", "velocity", _V),
    VocabularyRow(ids.acceleration, "a", "acceleration", _A, name="acceleration"),
    VocabularyRow(ids.direction.only(what="v"), "α", "direction", _V, below="v{point}", around=True, name="direction"),
    VocabularyRow(ids.direction.only(what="a"), "α", "direction", _A, below="a{point}", around=True, name="direction"),
    # exercises of plane motion: components, the velocity along a moving line, instant centres, angles of projection
    VocabularyRow(ids.velocity_component, "v", "velocity", _V, name="velocity component"),
    VocabularyRow(ids.velocity_projection, "p", "velocity", _V, below="{line}", name="velocity projection"),
    VocabularyRow(ids.acceleration_component, "a", "acceleration", _A, name="acceleration component"),
    VocabularyRow(ids.sliding_velocity, "v", "velocity", _V, name="sliding velocity"),
    VocabularyRow(ids.centre_coordinate, "x", "length", _V, name="centre coordinate"),
    VocabularyRow(ids.velocity_factor, "k", "length", _V, name="velocity factor"),
    VocabularyRow(ids.inner_angle, "α", "angle", name="projection angle"),
    VocabularyRow(Name("t"), "t", "time", name="time"),
    # instant centres
    VocabularyRow(ids.centre_distance, "", "segment", _V, "mu.l", name="centre distance"),
    VocabularyRow(ids.centre_omega, "ω", "angular velocity", _V, name="centre rotation"),
    VocabularyRow(ids.centre_velocity, "v", "velocity", _V, name="centre velocity"),
    VocabularyRow(ids.rod_angle, "ψ", "angle", _V, name="rod angle"),
    VocabularyRow(ids.projection, "u", "velocity", _V, name="projection"),
    # closed formulas
    VocabularyRow(ids.angle, "φ", "angle", name="angle"),
    VocabularyRow(ids.formula_angle, "φ", "angle", name="angle"),
    VocabularyRow(ids.inclination, "β", "angle", name="inclination"),
    VocabularyRow(ids.loop_distance, "d", "length", name="loop distance"),
    VocabularyRow(ids.slide_way, "s", "length", name="slide way"),
    VocabularyRow(ids.slide_velocity, "v", "velocity", name="slide velocity"),
    VocabularyRow(ids.slide_acceleration, "a", "acceleration", name="slide acceleration"),
    VocabularyRow(ids.right_side.only(what="v"), "b", "velocity", name="right side"),
    VocabularyRow(ids.right_side.only(what="a"), "b", "acceleration", name="right side"),
    VocabularyRow(ids.formula_velocity, "v", "velocity", name="formula velocity"),
    VocabularyRow(ids.formula_acceleration, "a", "acceleration", name="formula acceleration"),
    VocabularyRow(ids.formula_sliding.only(what="v"), "v", "velocity"),
    VocabularyRow(ids.formula_sliding.only(what="a"), "a", "acceleration"),
    VocabularyRow(ids.formula_angular_velocity, "ω", "angular velocity", name="formula angular velocity"),
    VocabularyRow(ids.formula_angular_acceleration, "ε", "angular acceleration", name="formula angular acceleration"),
    VocabularyRow(ids.formula_coordinate, "{axis}", "length", name="coordinate"),
    VocabularyRow(ids.formula_component.only(what="v"), "v", "velocity", name="velocity component"),
    VocabularyRow(ids.formula_component.only(what="a"), "a", "acceleration", name="acceleration component"),
    VocabularyRow(ids.slider_way, name="way of a slider"),
    VocabularyRow(ids.matrix_entry, name="matrix entry"),
    VocabularyRow(ids.numerator, name="numerator"),
    VocabularyRow(ids.slope, name="slope"),
    # loads
    VocabularyRow(ids.displacement, "s", "length", _LOADS, name="displacement"),
    VocabularyRow(ids.pressure, "p", "pressure", _LOADS, name="pressure"),
    VocabularyRow(ids.inertia_force, "P", "force", _LOADS, below="qt{link}", name="inertia force"),
    VocabularyRow(ids.inertia_couple, "M", "torque", _LOADS, below="qt{link}", name="inertia couple"),
    VocabularyRow(ids.inertia_offset, "e", "length", _LOADS, below="qt{link}", name="inertia offset"),
    VocabularyRow(ids.applied_force, "P", "force", _LOADS, name="applied force"),
    VocabularyRow(ids.applied_torque, "M", "torque", name="applied torque"),
    VocabularyRow(ids.given_force, name="given force"),
    # the balance of the driver
    VocabularyRow(ids.lever_arm, "h", "segment", _TORQUE, "mu.v", name="lever arm"),
    VocabularyRow(ids.lever_moment, "M", "torque", _TORQUE, name="lever moment"),
    VocabularyRow(ids.lone_moment, "M", "torque", _TORQUE),
    VocabularyRow(ids.balance, "M", "torque", _TORQUE, name="balance"),
    # reactions
    VocabularyRow(ids.reaction, "R", "force", _FORCES, name="reaction"),
    VocabularyRow(ids.reaction_couple, "M", "torque", _FORCES, name="reaction couple"),
    VocabularyRow(ids.application, "x", "length", _FORCES, name="application"),
    VocabularyRow(ids.arm, "h", "segment", _FORCES, "mu.l", name="arm"),
    VocabularyRow(ids.force_scale, "μ", "force scale", _FORCES, name="force scale"),
    VocabularyRow(ids.force_direction, "α", "direction", _FORCES, around=True, name="direction"),
    VocabularyRow(ids.force_segment, "", "segment", _FORCES, "mu.R{group}", name="segment"),
    # given data of a linkage
    VocabularyRow(ids.frame_coordinate, name="coordinate"),
    # cams: what is given and chosen, the limits of the pressure angle, the law of motion, the profile
    VocabularyRow(Name("cam.h"), "h", "cam length"),
    VocabularyRow(Name("cam.swing"), "ψ", "swing", below="max"),
    VocabularyRow(ids.cam_phase, "Φ", "angle", below="{phase}", name="cam phase"),
    VocabularyRow(ids.cam_arc.only(phase="swing"), "ψ", "arc", _V, below="max"),
    VocabularyRow(ids.cam_arc, "Φ", "arc", _V, below="{phase}", name="cam arc"),
    VocabularyRow(Name("cam.start.return"), "φ", "angle", _V, below="0"),
    VocabularyRow(Name("cam.limit.rise"), "[α]", "angle"),
    VocabularyRow(Name("cam.limit.return"), "[α′]", "angle"),
    VocabularyRow(Name("cam.limit.rho"), "[ρ]", "cam length"),
    VocabularyRow(Name("cam.n"), "n", "speed of rotation"),
    VocabularyRow(Name("cam.omega"), "ω", "angular velocity", _V),
    VocabularyRow(Name("cam.r0"), "r", "cam length", below="0"),
    VocabularyRow(Name("cam.e"), "e", "cam length"),
    VocabularyRow(Name("cam.a"), "a", "cam length"),
    VocabularyRow(Name("cam.l"), "l", "cam length"),
    VocabularyRow(Name("cam.roller"), "r", "cam length", below="rol"),
    VocabularyRow(Name("cam.s0"), "s", "cam length", _G, below="0"),
    VocabularyRow(Name("cam.psi0"), "ψ", "swing", _G, below="0"),
    VocabularyRow(ids.cam_touch.only(quantity="s"), "s", "cam length", _G, below="{phase}", name="cam touch"),
    VocabularyRow(ids.cam_touch.only(quantity="ds"), "s′", "reduced velocity", _G, below="{phase}", name="cam touch"),
    VocabularyRow(ids.cam_touch.only(quantity="psi"), "ψ", "swing", _G, below="{phase}", name="cam touch"),
    VocabularyRow(ids.cam_touch.only(quantity="dpsi"), "ψ′", "ratio", _G, below="{phase}", name="cam touch"),
    VocabularyRow(ids.cam_touch.only(quantity="phi"), "φ", "angle", _G, below="{phase}", name="cam touch"),
    VocabularyRow(ids.cam_intercept, "c", "cam length", _G, below="{phase}", name="cam intercept"),
    VocabularyRow(Name("cam.apex.s0"), "s", "cam length", _G, below="A"),
    VocabularyRow(Name("cam.apex.e"), "e", "cam length", _G, below="A"),
    VocabularyRow(Name("cam.least.e"), "e", "cam length", _G, below="lim"),
    VocabularyRow(Name("cam.least.s0"), "s", "cam length", _G, below="0lim"),
    VocabularyRow(Name("cam.least.psi0"), "ψ", "swing", _G, below="0lim"),
    VocabularyRow(Name("cam.least.r0"), "r", "cam length", _G, below="0min"),
    VocabularyRow(Name("cam.valley"), "m", "cam length", _G),
    VocabularyRow(ids.cam_node, "{quantity}", "graph value", _V, below="{phase},{number}", name="cam node {quantity}"),
    VocabularyRow(Name("cam.phi"), "φ", "angle", _V),
    VocabularyRow(Name("cam.x"), "x", "phase share", _V),
    VocabularyRow(Name("cam.z"), "z", "phase share", _V),
    VocabularyRow(Name("cam.s"), "s", "cam length", _V),
    VocabularyRow(Name("cam.ds"), "s′", "reduced velocity", _V),
    VocabularyRow(Name("cam.dds"), "s″", "reduced acceleration", _V),
    VocabularyRow(Name("cam.psi"), "ψ", "swing", _V),
    VocabularyRow(Name("cam.dpsi"), "ψ′", "ratio", _V),
    VocabularyRow(Name("cam.ddpsi"), "ψ″", "ratio", _V),
    VocabularyRow(Name("cam.v"), "v", "follower velocity", _V),
    VocabularyRow(Name("cam.acceleration"), "a", "follower acceleration", _V, below="f"),
    VocabularyRow(Name("cam.omega.f"), "ω", "angular velocity", _V, below="f"),
    VocabularyRow(Name("cam.epsilon.f"), "ε", "angular acceleration", _V, below="f"),
    VocabularyRow(ids.cam_diagram.only(quantity="L"), "L", "cam length", _V),
    VocabularyRow(ids.cam_diagram, "K", "cam length", _V),
    VocabularyRow(ids.cam_scale, "μ", "ratio", _V),
    VocabularyRow(Name("cam.q"), "q", "swing", _A),
    VocabularyRow(Name("cam.k"), "k", "ratio", _A),
    VocabularyRow(Name("cam.alpha"), "α", "angle", _A),
    VocabularyRow(ids.cam_pitch, "{axis}", "cam length", _A, below="B", name="cam pitch"),
    VocabularyRow(ids.cam_profile, "{axis}", "cam length", _A, below="K", name="cam profile"),
    VocabularyRow(Name("cam.contact"), "L", "cam length", _A),
    VocabularyRow(Name("cam.u"), "u", "cam length", _A),
    VocabularyRow(Name("cam.w"), "w", "cam length", _A),
    VocabularyRow(ids.cam_bend, "m", "cam length", _A, name="cam bend"),
    VocabularyRow(Name("cam.rho"), "ρ", "radius of curvature", _A),
    VocabularyRow(Name("cam.rho.working"), "ρ", "radius of curvature", _A, below="K"),
    # gears: all are named on their sheet
    VocabularyRow(ids.gear, name="gear {quantity}"),
    # planetary trains: tooth numbers, ratios, rates; all others are named on their sheet
    VocabularyRow(ids.train_teeth, "z", "count", below="{wheel}", name="train teeth"),
    VocabularyRow(ids.train_row_ratio, "u", "ratio", below="{number}", name="train row ratio"),
    VocabularyRow(ids.train_omega, "ω", "angular velocity", below="{wheel}", name="train omega"),
    VocabularyRow(ids.train_velocity, "v", "follower velocity", below="{place}", name="train velocity"),
    VocabularyRow(ids.train_efficiency, "η", "ratio", below="{of}", name="train efficiency"),
    # the cycle
    VocabularyRow(ids.figure_of_balance, "M", "torque", name="balance over the cycle"),
    VocabularyRow(Name("W"), "W", "work"),
    VocabularyRow(Name("power"), "N", "power"),
)
_PRINTED = {"t": "τ"}
_NO_ROW = VocabularyRow(Name(""))


@lru_cache(maxsize=4096)
def _found(id: str) -> tuple[VocabularyRow, dict[str, str]]:
    for row in ROWS:
        if (words := row.ids.read(id)) is not None:
            return row, words
    return _NO_ROW, {}


def row(id: str) -> VocabularyRow:
    """The row of an id; an empty one for a quantity that a machine has for itself."""
    return _found(id)[0]


def symbol(id: str) -> Symbol:
    """The symbol of a quantity: the letter of its row, below it what the id names.

    Raises `KeyError` for an id that no row gives a letter.
    """
    found, words = _found(id)
    if not found.letter:
        raise KeyError(f"no letter for {id}")
    part = words.get("part", "")
    return Symbol(found.letter.format(**words), found.index(words), _PRINTED.get(part, part))


_OF_POINTS = frozenset({"velocity", "acceleration", "coordinate"})


def vector_of(id: str) -> str:
    """The id of the vector whose length, direction, arm or moment a quantity is; "" for any other quantity.

    seg.v.pb → v.B, seg.v.ab → v.BA, seg.a.n.BA → a.BA.n, dir.R12.n → R.12.n, h.Pqt2.B → Pqt2.
    """
    if found := ids.segment.read(id):
        base = "" if found["start"] == ids.POLE else found["start"]
        return ids.POINT_RATE[found["what"]](f"{found['end']}{base}".upper())
    if found := ids.relative_segment.read(id):
        return ids.acceleration(found["relative"], found["part"])
    if found := ids.direction.read(id):
        return ids.POINT_RATE[found["what"]](found["point"])
    for of_force in (ids.force_segment, ids.force_direction, ids.arm, ids.lever_arm, ids.lever_moment):
        if found := of_force.read(id):
            return ids.of_force(found["force"])
    return ""


def wording(id: str, shown: Symbol) -> tuple[str, dict[str, str]]:
    """The key of an id's phrase under `quantities` in `words.yaml`, and the words that are put into it.

    `shown` is the quantity's symbol, whose points may say more than the id's (B₃B₂ for B3B).
    """
    found, parts = _found(id)
    index = found.index(parts)
    points = ids.points(shown.sub if found.kind in ("velocity", "acceleration") else index)
    link, other = ids.linked(parts["joint"]) if "joint" in parts else (parts.get("link", index), "")
    words = {
        "line": lowered(index),
        "link": link,
        "other": other,
        "axis": parts.get("axis", ""),
        "about": lowered(parts.get("about", "")),
        "plan": shown.sub.removeprefix("R"),
        **dict(zip(("point", "base"), map(lowered, points), strict=False)),
    }
    name = f"{found.name}.{parts['part']}" if found.letter and parts.get("part") else found.name.format(**parts)
    return (f"{name}.relative" if name in _OF_POINTS and len(points) > 1 else name), words


def words_of(table: Mapping[str, str], id: str, kind: str, shown: Symbol) -> Iterator[str]:
    """What a table of `words.yaml` says of a quantity, the nearest first: of its id, its family, its kind.

    A key of the table names one or several of them, with commas between; with a kind behind it, as in `balance:force`,
    it means only quantities of that kind, and all of them by `:force`.  Where two keys name the same, the first counts.
    """
    said: dict[str, str] = {}
    for key, text in table.items():
        for name in key.split(", "):
            said.setdefault(name, text)
    found, parts = _found(id)
    named = id, f"{found.name}.{parts.get('axis', '')}", wording(id, shown)[0]
    nearest = (*(one for name in named if name for one in (f"{name}:{kind}", name)), f":{kind}")
    return (said[one] for one in nearest if one in said)


@lru_cache(maxsize=4096)
def plan(id: str) -> str:
    """The id of the scale that a length on paper is measured with; "" for anything else."""
    found, parts = _found(id)
    return found.plan.format(**parts)


def is_laid(id: str) -> bool:
    """Whether it is a length or vector as it is laid off on paper."""
    return any(id in family for family in (ids.laid_line, ids.laid, ids.laid_force))


def distance(id: str, one: Value, other: Value) -> Value:
    """How far two values (SI) of a quantity lie apart: of directions, around the circle."""
    apart = np.abs(one - other)
    return np.abs(np.mod(one - other + np.pi, 2 * np.pi) - np.pi) if row(id).around else apart
