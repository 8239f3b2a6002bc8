"""What an id says: for each family of ids its letter, its kind, its chapter, its plan and how values compare.

This is the one place where the text of an id is read.  A quantity asks here for its symbol, a key for its
chapter, marking for the scale of a length on paper and for the distance of two values.

A *kind* fixes the printed unit, what one such unit is in SI, and the preferred number of significant
figures; `ledger.decimals` then raises or lowers decimals so that printed lines recompute.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property, lru_cache

import numpy as np

from reportgen.notation.constructions import Value
from reportgen.notation.expressions import Symbol


@dataclass(frozen=True, slots=True)
class Kind:
    """How a kind of quantity is printed: SI value = printed value × `scale`.

    `digits` are the significant figures aimed at for the largest value of a family, and `most` those that
    it may have where a line needs them; `decimals`, if given, fixes the aim instead.  No value is printed
    finer than to `finest` decimals (a segment is measured to 0.01 mm whatever its length).
    """

    unit: str
    scale: float = 1.0
    digits: int = 4
    most: int = 6
    decimals: int | None = None
    finest: int | None = None


KINDS: dict[str, Kind] = {
    "ratio": Kind("", digits=5),
    "count": Kind("", decimals=0),
    "sign": Kind("", decimals=0),
    "angle": Kind("°", math.pi / 180, decimals=2),
    "speed of rotation": Kind("rpm", digits=5),
    "time": Kind("s", digits=4),
    "length": Kind("m", digits=4),
    "diameter": Kind("cm", 1e-2, digits=4),
    "area": Kind("cm²", 1e-4, digits=5),
    "product of lengths": Kind("m²", digits=4),
    "segment": Kind("mm", 1e-3, decimals=2, finest=2),
    "length scale": Kind("m/mm", 1e3, digits=4),
    "velocity scale": Kind("m/(s·mm)", 1e3, digits=6),
    "acceleration scale": Kind("m/(s²·mm)", 1e3, digits=5),
    "force scale": Kind("N/mm", 1e3, digits=4),
    "pressure scale": Kind("N/(cm²·mm)", 1e7, digits=4),
    "velocity": Kind("m/s", most=5),
    "acceleration": Kind("m/s²", most=5),
    "angular velocity": Kind("rad/s"),
    "angular acceleration": Kind("rad/s²", most=5),
    "weight": Kind("N", digits=4),
    "gravity": Kind("m/s²", digits=3),
    "mass": Kind("kg", digits=5),
    "moment of inertia": Kind("kg·m²", digits=4),
    "pressure": Kind("N/cm²", 1e4, digits=4),
    "force": Kind("N", most=5),
    "torque": Kind("N·m", most=5),
    "work": Kind("J", most=5),
    "power": Kind("W", most=5),
}

MAX_DIGITS = max(kind.most for kind in KINDS.values())
"""No printed number has more significant figures (on the family's largest value)."""


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
class Row:
    """A family of ids, as a regular expression.

    Its groups `sub`, after the text `before`, and `sup` are printed below and above the `letter`.  `plan` is the id
    of the scale that lengths on paper are measured with.  Values that go `around` the circle are directions.
    `name` is the family's key under `quantities` in `words.yaml`; the groups `link`, `axis` and `about` are words of
    its phrase only.
    """

    ids: str
    letter: str = ""
    kind: str = ""
    chapter: Chapter | None = None
    plan: str = ""
    before: str = ""
    around: bool = False
    name: str = ""

    @cached_property
    def pattern(self) -> re.Pattern[str]:
        return re.compile(self.ids)


_NAME = r"(?P<sub>[^.]+)"
_PART = r"(\.(?P<sup>[ntkrs]))?"

ROWS: tuple[Row, ...] = (
    # geometry
    Row(rf"l\.{_NAME}(?<=K\d)", "l", "length", Chapter.loads, name="percussion"),  # the centre of percussion K
    Row(rf"l\.{_NAME}", "l", "length", Chapter.geometry, name="length"),
    Row(r"drawn\.(?P<sub>.+)", "", "segment", Chapter.geometry, "mu.l", name="drawn length"),
    Row(r"mu\.(?P<sub>l)", "μ", "length scale", Chapter.geometry),
    Row(r"R", "R", "length", Chapter.geometry),
    Row(r"L", "L", "length", Chapter.geometry),
    Row(r"H", "H", "length"),
    Row(r"e", "e", "length"),
    Row(r"D", "D", "diameter"),
    Row(r"F", "F", "area", Chapter.geometry),
    Row(r"lambda", "λ", "ratio", Chapter.geometry),
    Row(r"theta", "θ", "angle"),
    Row(r"K", "K", "ratio"),
    Row(r"s", "s", "ratio"),
    # masses
    Row(r"g", "g", "gravity"),
    Row(r"G(?P<sub>\d+)", "G", "weight", Chapter.loads, name="weight"),
    Row(rf"m\.{_NAME}", "m", "mass", Chapter.geometry, name="mass"),
    Row(r"J\.(?P<sub>\d+)", "J", "moment of inertia", Chapter.geometry, before="S", name="inertia"),
    Row(rf"J\.{_NAME}(\.(?P<link>.+))?", "J", "moment of inertia", Chapter.cycle, name="reduced inertia"),
    # rotation
    Row(r"n", "n", "speed of rotation"),
    Row(r"omega\.of", "ω", "angular velocity", Chapter.cycle),
    Row(rf"(turn\.)?omega\.{_NAME}", "ω", "angular velocity", Chapter.velocity, name="angular velocity"),
    Row(rf"(turn\.)?eps\.{_NAME}", "ε", "angular acceleration", Chapter.acceleration, name="angular acceleration"),
    # plans of velocities and accelerations
    Row(r"mu\.(?P<sub>v)", "μ", "velocity scale", Chapter.velocity),
    Row(r"mu\.(?P<sub>a)", "μ", "acceleration scale", Chapter.acceleration),
    Row(r"seg\.v\..+", "", "segment", Chapter.velocity, "mu.v", name="segment"),
    Row(r"seg\.a\..+", "", "segment", Chapter.acceleration, "mu.a", name="segment"),
    Row(rf"v\.{_NAME}", "v", "velocity", Chapter.velocity, name="velocity"),
    # exercises of plane motion: components, the velocity along a moving line, instant centres, angles of projection
    Row(r"v\.(?P<sub>[^.]+)\.(?P<axis>[xy])", "v", "velocity", Chapter.velocity, name="velocity component"),
    Row(r"a\.(?P<sub>[^.]+)\.(?P<axis>[xy])", "a", "acceleration", Chapter.acceleration, name="acceleration component"),
    Row(r"v\.(?P<sub>[^.]+)\.r", "v", "velocity", Chapter.velocity, name="sliding velocity"),
    Row(r"centre\.(?P<link>\d+)\.(?P<axis>[xy])", "x", "length", Chapter.velocity, name="centre coordinate"),
    Row(rf"k\.{_NAME}", "k", "length", Chapter.velocity, name="velocity factor"),
    Row(r"alpha\.(?P<sub>\d+)", "α", "angle", name="projection angle"),
    Row(r"t", "t", "time", name="time"),
    Row(rf"a\.{_NAME}{_PART}", "a", "acceleration", Chapter.acceleration, name="acceleration"),
    Row(rf"dir\.v\.{_NAME}", "α", "angle", Chapter.velocity, before="v", around=True, name="direction"),
    Row(rf"dir\.a\.{_NAME}", "α", "angle", Chapter.acceleration, before="a", around=True, name="direction"),
    # instant centres
    Row(r"ic\.seg\.(?P<link>\d+)\.(?P<sub>.+)", "", "segment", Chapter.velocity, "mu.l", name="centre distance"),
    Row(rf"ic\.omega\.{_NAME}", "ω", "angular velocity", Chapter.velocity, name="centre rotation"),
    Row(r"ic\.v\..+", "v", "velocity", Chapter.velocity, name="centre velocity"),
    Row(rf"ic\.angle\.(?P<link>\d+)\.{_NAME}", "ψ", "angle", Chapter.velocity, name="rod angle"),
    Row(rf"ic\.along\.(?P<link>\d+)\.{_NAME}", "u", "velocity", Chapter.velocity, name="projection"),
    # closed formulas
    Row(rf"(f\.)?phi\.{_NAME}", "φ", "angle", name="angle"),
    Row(rf"beta\.{_NAME}", "β", "angle", name="inclination"),
    Row(rf"f\.v\.{_NAME}", "v", "velocity", name="formula velocity"),
    Row(rf"f\.a\.{_NAME}{_PART}", "a", "acceleration", name="formula acceleration"),
    Row(rf"f\.omega\.{_NAME}", "ω", "angular velocity", name="formula angular velocity"),
    Row(rf"f\.eps\.{_NAME}", "ε", "angular acceleration", name="formula angular acceleration"),
    Row(rf"f\.(?P<axis>x)\.{_NAME}", "x", "length", name="coordinate"),
    Row(rf"f\.(?P<axis>y)\.{_NAME}", "y", "length", name="coordinate"),
    Row(r"f\.(?P<axis>[xy])\.(?P<sub>.+)\.v", "v", "velocity", name="velocity component"),
    Row(r"f\.(?P<axis>[xy])\.(?P<sub>.+)\.a", "a", "acceleration", name="acceleration component"),
    # loads
    Row(r"s\.(?P<sub>\d+)", "s", "length", Chapter.loads, name="displacement"),
    Row(r"p\.(?P<sub>\d+)", "p", "pressure", Chapter.loads, name="pressure"),
    Row(r"Pqt(?P<sub>\d+)", "P", "force", Chapter.loads, before="qt", name="inertia force"),
    Row(r"M\.Pqt(?P<sub>\d+)", "M", "torque", Chapter.loads, before="qt", name="inertia couple"),
    Row(r"e\.Pqt(?P<sub>\d+)", "e", "length", Chapter.loads, before="qt", name="inertia offset"),
    Row(r"P(?P<sub>\d*)\w*", "P", "force", Chapter.loads, name="applied force"),
    Row(r"M(?P<sub>\d+)\w*", "M", "torque", name="applied torque"),
    # the balance of the driver
    Row(r"h\.(?P<sub>.+)\.p", "h", "segment", Chapter.torque, "mu.v", name="lever arm"),
    Row(r"M\.(?P<sub>.+)\.p", "M", "torque", Chapter.torque, name="lever moment"),
    Row(r"M\.(eq|vw)", "M", "torque", Chapter.torque),
    # reactions
    Row(rf"R\.{_NAME}{_PART}", "R", "force", Chapter.forces, name="reaction"),
    Row(r"M\.(?P<sub>[\d,]+)", "M", "torque", Chapter.forces, name="reaction couple"),
    Row(r"x\.(?P<sub>\d[\d,]+)", "x", "length", Chapter.forces, name="application"),
    Row(r"h\.R?(?P<sub>[^.]+)\.(?P<about>.+)", "h", "segment", Chapter.forces, "mu.l", name="arm"),
    Row(r"mu\.R.+", "μ", "force scale", Chapter.forces, name="force scale"),
    Row(r"dir\.R(?P<sub>[^.]+)(\..+)?", "α", "angle", Chapter.forces, around=True, name="direction"),
    Row(r"seg\.(?P<group>[^.]+)\..+", "", "segment", Chapter.forces, "mu.R{group}", name="segment"),
    # given data of a linkage
    Row(r"frame\.(?P<axis>[xy])\.(?P<sub>.+)", name="coordinate"),
    # the cycle
    Row(rf"M\.{_NAME}(\..+)?", "M", "torque"),
    Row(r"W", "W", "work"),
    Row(r"power", "N", "power"),
)
_PRINTED = {"t": "τ"}
_NO_ROW = Row("")


@lru_cache(maxsize=4096)
def _found(id: str) -> tuple[Row, dict[str, str]]:
    for row in ROWS:
        if match := row.pattern.fullmatch(id):
            return row, {name: text or "" for name, text in match.groupdict().items()}
    return _NO_ROW, {}


def row(id: str) -> Row:
    """The row of an id; an empty one for a quantity that a machine has for itself."""
    return _found(id)[0]


def symbol(id: str) -> Symbol:
    """The symbol of a quantity: the letter of its row, below it what the id names.

    Raises `KeyError` for an id that no row gives a letter.
    """
    found, parts = _found(id)
    if not found.letter:
        raise KeyError(f"no letter for {id}")
    sup = parts.get("sup", "")
    return Symbol(found.letter, found.before + parts.get("sub", ""), _PRINTED.get(sup, sup))


_POINT = re.compile(r"[A-Z]\d*")
_OF_POINTS = frozenset({"velocity", "acceleration", "coordinate"})
_BETWEEN_LINKS = frozenset({"reaction", "reaction couple", "application"})
_VECTORS: tuple[tuple[re.Pattern[str], str], ...] = tuple(
    (re.compile(ids), vector)
    for ids, vector in (
        (r"dir\.([va]\..+)", r"\1"),
        (r"seg\.a\.([ntkr])\.(.+)", r"a.\2.\1"),
        (r"(?:dir\.|seg\.[^.]+\.|h\.)R([^.]+)(\.[ntkrs])?(?:\..+)?", r"R.\1\2"),
        (r"seg\.\d[^.]*\.([^.]+)", r"\1"),
        (r"h\.([^.]+)\..+", r"\1"),
        (r"M\.([^.]+)\.p", r"\1"),
    )
)
_ON_PLAN = re.compile(r"seg\.([va])\.([a-z]\d*)([a-z]\d*)")


def vector_of(id: str) -> str:
    """The id of the vector whose length, direction, arm or moment a quantity is; "" for any other quantity.

    seg.v.pb → v.B, seg.v.ab → v.BA, seg.a.n.BA → a.BA.n, dir.R12.n → R.12.n, h.Pqt2.B → Pqt2.
    """
    if match := _ON_PLAN.fullmatch(id):
        what, base, tip = match.groups()
        return f"{what}.{tip.upper()}{'' if base == 'p' else base.upper()}"
    found = ((pattern.fullmatch(id), vector) for pattern, vector in _VECTORS)
    return next((match.expand(vector) for match, vector in found if match), "")


def wording(id: str, shown: Symbol) -> tuple[str, dict[str, str]]:
    """The key of an id's phrase under `quantities` in `words.yaml`, and the words that are put into it.

    `shown` is the quantity's symbol, whose points may say more than the id's (B₃B₂ for B3B).
    """
    found, parts = _found(id)
    sub = parts.get("sub", "")
    points = _POINT.findall(shown.sub) if found.kind in ("velocity", "acceleration") else _POINT.findall(sub)
    links = sub.split(",") if "," in sub else list(sub) if found.name in _BETWEEN_LINKS else [sub]
    words = {
        "line": lowered(sub),
        "link": parts.get("link") or links[0],
        "other": links[-1],
        "axis": parts.get("axis", ""),
        "about": lowered(parts.get("about", "")),
        "plan": shown.sub.removeprefix("R"),
        **dict(zip(("point", "base"), map(lowered, points), strict=False)),
    }
    name = f"{found.name}.{parts['sup']}" if parts.get("sup") else found.name
    return (f"{name}.relative" if name in _OF_POINTS and len(points) > 1 else name), words


@lru_cache(maxsize=4096)
def plan(id: str) -> str:
    """The id of the scale that a length on paper is measured with; "" for anything else."""
    found, parts = _found(id)
    return found.plan.format(**parts)


_PLAN = re.compile(r"plan\.([^.]+)\..+")


def scale_on_paper(id: str) -> str:
    """The id of the scale of a length or a point on paper; "" for anything else."""
    if is_laid(id):
        return "mu.l"
    point_of = _PLAN.fullmatch(id)
    return f"mu.{point_of[1]}" if point_of else plan(id)


def is_laid(id: str) -> bool:
    """Whether it is a length or vector as it is laid off on paper."""
    return id.startswith("laid.")


def distance(id: str, one: Value, other: Value) -> Value:
    """How far two values (SI) of a quantity lie apart: of directions, around the circle."""
    apart = np.abs(one - other)
    return np.abs(np.mod(one - other + np.pi, 2 * np.pi) - np.pi) if row(id).around else apart
