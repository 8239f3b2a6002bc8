"""Vocabulary of quantities: for each family of ids its letter, kind, chapter, plan and comparison of values.

Each family of `ids` has a row. It provides the symbol of a quantity, its chapter, the scale of a length on paper
and the distance of two values (for marking), and the name under which `words.yaml` has its phrase.

A *kind* fixes the printed unit, the value of this unit in SI, and the number of printed figures or decimals.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from enum import StrEnum
from functools import cache, lru_cache
from importlib import import_module

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.base.topics import PACKAGE, topics
from reportgen.formula import Symbol, ids
from reportgen.formula.constructions import Value
from reportgen.formula.ids import Name


class QuantityKind(Record):
    """Printing rules of a kind of quantity: SI value = printed value × `scale`.

    `digits` are the significant figures of the largest computed value; `decimals`, if given, are used instead.
    """

    unit: str
    scale: float = 1.0
    digits: int = 5
    decimals: int | None = None


class _Kinds(dict[str, QuantityKind]):
    """The kinds by name; a missing one is looked up in the id modules of all assignment kinds, else `KeyError`."""

    def __missing__(self, name: str) -> QuantityKind:
        for head in heads():
            rows_of(head)
        if name not in self:
            raise KeyError(name)
        return self[name]


KINDS = _Kinds(
    {
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
        "length on paper": QuantityKind("mm/mm", digits=6),
        "follower velocity": QuantityKind("mm/s", 1e-3),
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
        "stiffness": QuantityKind("N/m"),
        "torsional stiffness": QuantityKind("N·m/rad"),
        "work": QuantityKind("J"),
        "power": QuantityKind("W"),
    }
)

OWN_IDS = "_ids"
"""Suffix of the names of modules that contain the ids of an assignment kind."""
MAX_DIGITS = max(kind.digits for kind in KINDS.values())
"""Largest number of significant figures of any computed value."""


def point(name: str) -> Symbol:
    """Return the symbol of a point called e.g. "A", "S2", "O1": letter and lowered number."""
    letters = name.rstrip("0123456789")
    return Symbol(letters, sub=name[len(letters) :])


def on_plan(name: str, prime: bool = False) -> Symbol:
    """Return the image of a point on a velocity plan (b, s2) or, primed, on an acceleration plan (b′, s2′)."""
    symbol = point(name)
    return Symbol(symbol.base.lower(), symbol.sub, "′" if prime else "")


def vector(symbol: Symbol) -> Symbol:
    """Return the same symbol as a vector."""
    return Symbol(symbol.base, symbol.sub, symbol.sup, "vector")


def in_language(symbol: Symbol, names: Mapping[str, str]) -> Symbol:
    """Return the symbol in a language: with cb → bal, M_cb is M_bal; h_Pqt5 has the qt of P_qt5.

    A name with a letter before the index replaces the whole symbol, with # for each digit: Pqt → F_и makes P_qt5
    F_и5, and R## → F_R makes R_12 F_R12. A name behind ^ replaces a superscript only.
    """
    (above, behind), (word, digits, rest) = _ABOVE.findall(symbol.sup)[0], _INDEX.findall(symbol.sub)[0]
    sup = names.get(f"^{above}", names.get(above, above)) + behind
    whole = (f"{symbol.base}{word}{'#' * len(digits)}", f"{symbol.base}{word}" if word else "")
    for key in whole if word or digits else ("" if rest else symbol.base,):
        if key in names and not _WORD.fullmatch(key):
            base, _, below = names[key].partition("_")
            return replace(symbol, base=base, sub=f"{below}{digits}{_index(rest, names)}", sup=sup)
    return replace(symbol, sub=_index(symbol.sub, names), sup=sup)


def _index(index: str, names: Mapping[str, str]) -> str:
    """Return the index of a symbol in a language: words, and names of other quantities."""

    def said(match: re.Match[str]) -> str:
        letter, word, digits = match.groups()
        for key in (f"{letter}{word}{'#' * len(digits)}", f"{letter}{word}"):
            if letter and key in names:
                return names[key].replace("_", "") + digits
        return letter + names.get(word, word) + digits

    return _NAMES.sub(said, index)


_WORD, _INDEX, _ABOVE = map(re.compile, ("[a-z]+", r"([a-z]*)(\d*)(.*)", r"([^(]*)(.*)"))
_NAMES = re.compile(r"([^\W\d_a-z]?)([a-z]*)(\d*)")


def lowered(text: str) -> str:
    """Return the digits of point names as lowered digits: B3 → B₃."""
    return text.translate(_LOWERED)


def raised(text: str) -> str:
    """Return lowered digits as digits: B₃ → B3."""
    return text.translate(_RAISED)


_DIGITS, _BELOW = "0123456789", "₀₁₂₃₄₅₆₇₈₉"
_LOWERED, _RAISED = str.maketrans(_DIGITS, _BELOW), str.maketrans(_BELOW, _DIGITS)
_RUN = re.compile(f"([^{_BELOW}]*)([{_BELOW}]*)")
_NUMBERED = re.compile(r"([A-Z])([a-z]*\d+)")


def runs(text: str) -> list[tuple[str, str]]:
    """Return runs of letters with their lowered digits: O₁A is O with 1, then A."""
    return [(letters, digits.translate(_RAISED)) for letters, digits in _RUN.findall(text) if letters or digits]


def numbered(index: str) -> list[tuple[str, str]]:
    """Split an index into names with numbers and the text between: O1A is O with 1, then A; h_Pqt5 has P with qt5."""
    between, *named = _NUMBERED.split(index)
    pieces = [(between, "")]
    for letter, number, after in zip(named[::3], named[1::3], named[2::3], strict=True):
        pieces += [(letter, number), (after, "")]
    return [piece for piece in pieces if piece[0]]


def segment(first: Symbol | str, second: Symbol | str) -> Symbol:
    """Return a length between two points of a drawing: a bar over both letters, e.g. over p b or O₁A."""
    start = first if isinstance(first, Symbol) else Symbol(first)
    two = second if isinstance(second, Symbol) else Symbol(second)
    return Symbol(start.base + lowered(start.sub) + start.sup + two.base, two.sub, two.sup, "segment")


def drawn_length(first: str, second: str) -> Symbol:
    """Return the symbol of a length between two points on a drawing, e.g. AS₂ under a bar."""
    return segment(point(first), point(second))


class KeyChapter(StrEnum):
    """The chapters of a key in order, the topics' chapters last; the words have the headings under `parts`."""

    data = "data"
    geometry = "geometry"
    velocity = "velocity"
    acceleration = "acceleration"
    formulas = "formulas"
    loads = "loads"
    forces = "forces"
    torque = "torque"
    cycle = "cycle"
    vars().update({name: name for name in topics()})


class VocabularyRow(Record):
    """A family of ids, or a single one.

    The index below the `letter` is the text `below`, else the word in the last place. Above it is the text `above`,
    else the `part`. `plan` is the id of the scale that lengths on paper are measured with. A word in braces is
    replaced by that place of the id. Values that go `around` the circle are directions. `words.yaml` uses the `name`.
    """

    ids: Name
    letter: str = ""
    kind: str = ""
    chapter: KeyChapter | None = None
    plan: str = ""
    below: str = ""
    above: str = ""
    around: bool = False
    name: str = ""

    def index(self, words: Mapping[str, str]) -> str:
        """Return the text printed below the letter."""
        named = [word for place, word in words.items() if place not in _NOT_BELOW]
        return self.below.format(**words) if self.below else next(reversed(named), "")


_NOT_BELOW = frozenset({"to", "axis", "part", "about", "letter"})
"""Places whose words are not printed below a letter."""

_G, _V, _A = KeyChapter.geometry, KeyChapter.velocity, KeyChapter.acceleration
_LOADS, _FORCES, _TORQUE, _CYCLE = KeyChapter.loads, KeyChapter.forces, KeyChapter.torque, KeyChapter.cycle

ROWS: tuple[VocabularyRow, ...] = (
    # geometry
    VocabularyRow(ids.percussion, "l", "length", _LOADS, below="{point}K{link}", name="percussion"),
    VocabularyRow(ids.length, "l", "length", _G, name="length"),
    VocabularyRow(ids.drawn, "", "segment", _G, "mu.l", name="drawn length"),
    VocabularyRow(ids.scale.only(plan="l"), "μ", "length scale", _G, below="l"),
    VocabularyRow(ids.along_link, "ξ", "length", name="point along link"),
    VocabularyRow(ids.across_link, "η", "length", name="point across link"),
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
    VocabularyRow(ids.applied_force, "P", "force", _LOADS, below="{link}{letter}", name="applied force"),
    VocabularyRow(ids.applied_torque, "M", "torque", below="{link}{letter}", name="applied torque"),
    VocabularyRow(ids.given_force, name="given force"),
    VocabularyRow(ids.spring_rate, "c", "stiffness", name="spring rate"),
    VocabularyRow(ids.spring_free, "l", "length", below="0{number}", name="spring free"),
    VocabularyRow(ids.spring_length, "l", "length", _LOADS, below="sp{number}", name="spring length"),
    VocabularyRow(ids.spring_on_paper, "s", "segment", _LOADS, "mu.l", below="sp{number}", name="spring on paper"),
    VocabularyRow(ids.spring_turn, "θ", "angle", _LOADS, below="{number}", name="spring turn"),
    VocabularyRow(ids.spring_anchor, "", "length"),
    # the balance of the driver
    VocabularyRow(ids.lever_arm, "h", "segment", _TORQUE, "mu.v", name="lever arm"),
    VocabularyRow(ids.lever_moment, "M", "torque", _TORQUE, name="lever moment"),
    VocabularyRow(ids.lone_moment, "M", "torque", _TORQUE),
    VocabularyRow(ids.balance, "M", "torque", _TORQUE, name="balance"),
    # reactions
    VocabularyRow(ids.reaction, "R", "force", _FORCES, name="reaction"),
    VocabularyRow(ids.reaction_couple, "M", "torque", _FORCES, name="reaction couple"),
    VocabularyRow(ids.application, "x", "length", _FORCES, name="application"),
    VocabularyRow(ids.face_from, "x", "length", below="{link},1", name="face end"),
    VocabularyRow(ids.face_to, "x", "length", below="{link},2", name="face end"),
    VocabularyRow(ids.face_below, "y", "length", name="face below"),
    VocabularyRow(ids.normal_reaction, "N", "force", _FORCES, name="normal reaction"),
    VocabularyRow(ids.normal_place, "x", "length", _FORCES, below="N{joint}", name="normal place"),
    VocabularyRow(ids.face_reaction, "N", "force", _FORCES, below="{joint},{number}", name="face reaction"),
    VocabularyRow(ids.arm, "h", "segment", _FORCES, "mu.l", name="arm"),
    VocabularyRow(ids.force_scale, "μ", "force scale", _FORCES, name="force scale"),
    VocabularyRow(ids.force_direction, "α", "direction", _FORCES, around=True, name="direction"),
    VocabularyRow(ids.force_segment, "", "segment", _FORCES, "mu.R{group}", name="segment"),
    # given data of a linkage
    VocabularyRow(ids.frame_coordinate, name="coordinate"),
    # the cycle
    VocabularyRow(ids.figure_of_balance, "M", "torque", name="balance over the cycle"),
    VocabularyRow(Name("W"), "W", "work"),
    VocabularyRow(Name("power"), "N", "power"),
)
_PRINTED = {"t": "τ"}
_NO_ROW = VocabularyRow(Name(""))


# --- ids of a single assignment kind ----------------------------------------------------------------
# The ids of a kind begin with one word, as cam.r0. They are in the kind's package with their ROWS and KINDS, in a
# module named after that word, `cam_ids.py`. Any process imports it when it first needs such an id.


@cache
def heads() -> Mapping[str, str]:
    """Return the dotted names of the id modules of assignment kinds, by the word with which their ids begin."""
    modules = sorted(PACKAGE.glob(f"*/*{OWN_IDS}.py"))
    return {path.stem.removesuffix(OWN_IDS): f"{PACKAGE.name}.{path.parent.name}.{path.stem}" for path in modules}


@cache
def rows_of(head: str) -> tuple[VocabularyRow, ...]:
    """Return the rows of the ids that begin with a word: those of an assignment kind, else of the common ones."""
    if head not in heads():
        return tuple(row for row in ROWS if row.ids.may_begin(head))
    module = import_module(heads()[head])
    KINDS.update(module.KINDS)
    rows: tuple[VocabularyRow, ...] = module.ROWS
    return rows


@lru_cache(maxsize=4096)
def _row_and_words(id: str) -> tuple[VocabularyRow, dict[str, str]]:
    for row in rows_of(id.partition(".")[0]):
        if (words := row.ids.read(id)) is not None:
            return row, words
    return _NO_ROW, {}


def row(id: str) -> VocabularyRow:
    """Return the row of an id; an empty row for an id without one, which belongs to a single machine."""
    return _row_and_words(id)[0]


def symbol(id: str) -> Symbol:
    """Return the symbol of a quantity: the letter of its row, with the index that the id gives.

    Raises `KeyError` for an id whose row has no letter.
    """
    family, words = _row_and_words(id)
    if not family.letter:
        raise KeyError(f"no letter for {id}")
    part = words.get("part", "")
    return Symbol(family.letter.format(**words), family.index(words), family.above or _PRINTED.get(part, part))


_OF_POINTS = frozenset({"velocity", "acceleration", "coordinate"})


def vector_of(id: str) -> str:
    """Return the id of the vector whose length, direction, arm or moment a quantity is; "" for any other quantity.

    seg.v.pb → v.B, seg.v.ab → v.BA, seg.a.n.BA → a.BA.n, dir.R12.n → R.12.n, h.Pqt2.B → Pqt2.
    """
    if names := ids.segment.read(id):
        base = "" if names["start"] == ids.POLE else names["start"]
        return ids.POINT_RATE[names["what"]](f"{names['end']}{base}".upper())
    if names := ids.relative_segment.read(id):
        return ids.acceleration(names["relative"], names["part"])
    if names := ids.direction.read(id):
        return ids.POINT_RATE[names["what"]](names["point"])
    for of_force in (ids.force_segment, ids.force_direction, ids.arm, ids.lever_arm, ids.lever_moment):
        if names := of_force.read(id):
            return ids.of_force(names["force"])
    return ""


def wording(id: str, symbol: Symbol) -> tuple[str, dict[str, str]]:
    """Return the key of an id's phrase under `quantities` in `words.yaml`, and the words that are put into it.

    `symbol` is the quantity's symbol, whose points may say more than the id's (B₃B₂ for B3B).
    """
    family, parts = _row_and_words(id)
    index = family.index(parts)
    points = ids.points(symbol.sub if family.kind in ("velocity", "acceleration") else index)
    own = parts.get("link", parts.get("wheel", index))
    link, acted_on = ids.linked(parts["joint"]) if "joint" in parts else (own, "")
    words = {
        "line": lowered(index),
        "link": link,
        "other": acted_on,
        "number": parts.get("number", parts.get("cylinder", parts.get("order", ""))),
        "nth": f" ({parts['letter']})" if parts.get("letter") else "",
        "axis": parts.get("axis", ""),
        "about": lowered(parts.get("about", "")),
        "plan": symbol.sub.removeprefix("R"),
        **dict(zip(("point", "base"), map(lowered, points), strict=False)),
    }
    name = f"{family.name}.{parts['part']}" if family.letter and parts.get("part") else family.name.format(**parts)
    if family.name == "acceleration" and parts.get("part") in ("n", "t") and len(points) == 1:
        name = f"{name}.own"  # of a point itself, for example of the crank's pin
    return (f"{name}.relative" if name in _OF_POINTS and len(points) > 1 else name), words


def words_of(table: Mapping[str, str], id: str, kind: str, symbol: Symbol) -> Iterator[str]:
    """Yield the texts that a table of `words.yaml` has for a quantity, nearest first: for its id, its family, its kind.

    A key names one or several quantities, separated by commas. A kind behind a colon limits it to quantities of
    that kind (`balance:force`); `:force` alone matches all of them. If two keys name the same, the first counts.
    """
    keys = _keys_by_name(tuple(table))
    family, parts = _row_and_words(id)
    named = id, f"{family.name}.{parts.get('axis', '')}", wording(id, symbol)[0]
    nearest = (*(one for name in named if name for one in (f"{name}:{kind}", name)), f":{kind}")
    return (table[keys[one]] for one in nearest if one in keys)


@lru_cache(maxsize=64)
def _keys_by_name(keys: tuple[str, ...]) -> Mapping[str, str]:
    return {name: key for key in reversed(keys) for name in key.split(", ")}  # the first one counts


@lru_cache(maxsize=4096)
def plan(id: str) -> str:
    """Return the id of the scale that a length on paper is measured with; "" for anything else."""
    family, parts = _row_and_words(id)
    return family.plan.format(**parts)


def is_laid(id: str) -> bool:
    """Return True if it is a length or vector laid off on paper."""
    return any(id in family for family in (ids.laid_line, ids.laid, ids.laid_force))


def distance(id: str, value: Value, reference: Value) -> Value:
    """Return |value − reference| (SI, broadcast shape); directions (rad) are compared around the circle, up to π."""
    apart = np.abs(value - reference)
    return np.abs(np.mod(value - reference + np.pi, 2 * np.pi) - np.pi) if row(id).around else apart
