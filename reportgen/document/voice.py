"""What templates may say: lines, numbers, equations and tables, all taken from the ledger.

A `Voice` is bound to one report; its public methods are the functions that templates call.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from reportgen.document.prose import Prose
from reportgen.document.tree import (
    Cell,
    Column,
    Equation,
    Inline,
    InlineMath,
    Inlines,
    Table,
    Text,
    Value,
)
from reportgen.document.views import GroupView, sought_part
from reportgen.ledger.core import Ledger
from reportgen.ledger.forces.polygon import Side as PolygonSide
from reportgen.ledger.kinematics.sides import Side, Slide, Turn
from reportgen.notation import symbols
from reportgen.notation.expressions import (
    Chain,
    Expression,
    Number,
    Symbol,
    Term,
    VectorEquation,
    refs,
)
from reportgen.notation.expressions import Fraction as FractionOf

TEXT_WIDTH = 160.0
FIRST_COLUMN = 16.0
WIDEST_COLUMN = 26.0
LONG_WORDS = 10
"""A column with a text this long is one of words and set flush left."""


@dataclass(frozen=True)
class Voice:
    """The functions of one report's templates."""

    ledger: Ledger
    prose: Prose
    words: Mapping[str, Any]

    # --- numbers and symbols

    def symbol(self, id: str) -> Symbol:
        """The symbol of a quantity."""
        return self.ledger.symbol(id)

    def value(self, id: str, position: int | None = None, size: bool = False) -> Value:
        """A quantity's number with its unit; `size` leaves its sign away."""
        return Value(self.ledger.number(id, position, size=size))

    def point(self, name: str) -> Symbol:
        """The symbol of a point, e.g. S with a lowered 2."""
        return symbols.point(name)

    def points(self, names: Iterable[str]) -> tuple[Inline, ...]:
        """Symbols of points, side by side with commas."""
        result: list[Inline] = []
        for name in names:
            result += [Text(", ")] if result else []
            result.append(InlineMath(symbols.point(name)))
        return tuple(result)

    def image(self, name: str, prime: bool = False) -> Symbol:
        """The image of a point on a plan."""
        return symbols.on_plan(name, prime)

    def letters(self, base: str, sub: str | int = "", sup: str = "") -> Symbol:
        """Any symbol."""
        return Symbol(base, str(sub), sup)

    def vector(self, base: str, sub: str | int = "", sup: str = "") -> Symbol:
        """Any symbol under an arrow."""
        return Symbol(base, str(sub), sup, "vector")

    # --- lines

    def line(self, id: str, position: int | None = None, note: str = "", key: str = "") -> Equation:
        """One worked line: symbol = formula = numbers = result."""
        return self.lines([id], position, note, key)

    def lines(
        self, ids: Sequence[str], position: int | None = None, note: str = "", key: str = ""
    ) -> Equation:
        """Several worked lines, aligned."""
        return Equation(tuple(self.chain(id, position, note) for id in ids), key)

    def chain(self, id: str, position: int | None = None, note: str = "") -> Chain:
        """A worked line as an expression; a nothing gets its reason."""
        chain = self.ledger.chain(id, position, note)
        result = chain.parts[-1]
        if not note and isinstance(result, Number) and result.value == 0 and self.ledger[id].definition:
            return Chain((chain.parts[0], result), self.reason(id))
        return chain

    def reason(self, id: str) -> str:
        """Why a quantity is nothing, in words, by the pattern its id fits; "" where none fits."""
        return next(
            (str(reason) for pattern, reason in self.words["zero"].items() if re.fullmatch(str(pattern), id)), ""
        )

    def equal(self, *parts: Expression | str, key: str = "") -> Equation:
        """Expressions joined by "="; a string names a quantity by its symbol."""
        shown = tuple(self.symbol(part) if isinstance(part, str) else part for part in parts)
        return Equation((Chain(shown),), key)

    def ratio(self, top: Expression | str, bottom: Expression | str) -> Expression:
        """A fraction; strings name quantities by their symbols."""
        return FractionOf(
            self.symbol(top) if isinstance(top, str) else top,
            self.symbol(bottom) if isinstance(bottom, str) else bottom,
        )

    # --- vector equations

    def velocity_equation(self, group: GroupView, key: str = "") -> Equation:
        """v_M = v_P + v_MP = v_T + v_MT with what is known of each vector; a fixed base leaves v_M's direction."""
        still = next((side for side in group.sides if side.still), None)
        direction = None if still is None else self._direction(still)
        sides: list[tuple[Term, ...]] = [(self._term("v", group.M, "", direction, None, None),)]
        for side in group.moving:
            relative = f"{side.point}{side.shown}"
            sides.append(
                (self._known(side, "v"), self._term("v", relative, "", self._direction(side), None, None))
            )
        return self._vectors(sides, "rows", key)

    def acceleration_equation(self, group: GroupView, key: str = "") -> Equation:
        """a_M = a_P + aⁿ_MP + aᵗ_MP = a_G + aᵏ_MG + aʳ_MG with what is known of each vector."""
        fixed = next((side for side in group.sides if not sought_part(side)), None)
        direction = None if fixed is None else self._direction(fixed)
        sides: list[tuple[Term, ...]] = [(self._term("a", group.M, "", direction, None, None),)]
        for side in group.sides:
            if side is fixed:
                continue
            terms = () if side.still else (self._known(side, "a"),)
            sides.append((*terms, *self._relative(side)))
        return self._vectors(sides, "rows", key)

    def force_equation(self, group: GroupView, key: str = "") -> Equation:
        """The equilibrium of a group's two links; only the two reactions that close the plan are unknown."""
        assert group.polygon is not None
        terms = [self._force_term(group, side) for side in group.polygon.sides]
        return self._balance(terms, key)

    def link_equation(self, group: GroupView, link: int, key: str = "") -> Equation:
        """The equilibrium of one link of a group with a slide between its links, R_ij or R_ji included."""
        assert group.polygon is not None
        words = self.words["vector"]
        own = [side for side in group.polygon.sides if side.link == link]
        terms = [self._force_term(group, side) for side in own if not side.unknown]
        # Across the slot; its size is computed before the plan, or read from the plan of link j.
        first = group.kind == "RPP" and link == group.j
        inner = Symbol("R", group.across if link == group.j else group.inner, over="vector")
        terms.append(Term(inner, (words["across_slot"], None if first else words["computed"])))
        terms += [self._force_term(group, side) for side in own if side.unknown]
        return self._balance(terms, key)

    def _force_term(self, group: GroupView, side: PolygonSide) -> Term:
        words = self.words["vector"]
        way = group.one if side.link == group.i else group.two
        symbol = symbols.vector(self.force_symbol(side.name))
        direction: str | None
        if side.name.endswith((".n", ".t")) and isinstance(way, Turn):
            normal = side.name.endswith(".n")
            direction = f"{'∥' if normal else '⊥'} {_lowered(way.rod)}"
            return Term(symbol, (direction, None if normal else words["computed"]))
        if side.unknown:
            on_guide = isinstance(way, Slide) and way.carrier is not None
            return Term(symbol, (words["across_guide"] if on_guide else None, None))
        return Term(symbol, (words["given"], words["given"]))

    def _balance(self, terms: Sequence[Term], key: str) -> Equation:
        zero = Term(Symbol("0", over="vector"), ("", ""))
        return self._vectors([tuple(terms), (zero,)], "force_rows", key)

    def _vectors(self, sides: Sequence[tuple[Term, ...]], rows: str, key: str) -> Equation:
        return Equation((VectorEquation(tuple(sides), tuple(self.words["vector"][rows])),), key)

    def _direction(self, side: Side) -> str:
        """The direction of what is sought on a side."""
        words = self.words["vector"]
        if isinstance(side, Turn):
            return f"⊥ {_lowered(side.rod)}"
        return str(words["along_slot"] if side.carrier is None else words["along_guide"])

    def _relative(self, side: Side) -> tuple[Term, ...]:
        """aⁿ and aᵗ of a turning side, aᵏ and aʳ of a sliding one."""
        words, relative, name = self.words["vector"], side.relative, f"{side.point}{side.shown}"
        sought = self._term("a", name, "τ" if isinstance(side, Turn) else "r", self._direction(side), None, None)
        if isinstance(side, Turn):
            square = self.symbol(f"v.{relative}") ** 2
            size: Expression = square / self.symbol(f"l.{side.rod}")
            way = f"{_lowered(side.point)} → {_lowered(side.base)}"
            return self._term("a", name, "n", f"∥ {_lowered(side.rod)}", way, size), sought
        if not side.turning:
            return (sought,)
        twice = 2 * self.symbol(f"omega.{side.turning}") * self.symbol(f"v.{relative}")
        across = words["across_slot" if side.carrier is None else "across_guide"]
        return self._term("a", name, "k", across, words["turned"], twice), sought

    def driver_equation(self, polygon: Any, key: str = "") -> Equation:
        """The equilibrium of forces on the driver; of a sliding one the directions by its guide are known."""
        words = self.words["vector"]
        slides = any(side.name == "Rcb" for side in polygon.sides)
        unknown = {"R01": words["across_guide"], "Rcb": words["along_guide"]} if slides else {}
        terms = [
            Term(
                symbols.vector(self.force_symbol(side.name)),
                (unknown.get(side.name), None) if side.unknown else (words["given"], words["given"]),
            )
            for side in polygon.sides
        ]
        return self._balance(terms, key)

    def force_symbol(self, name: str) -> Symbol:
        """The symbol of a force of a plan: of a load by its own id, of a reaction R12, R12.t by its joint."""
        if name in self.ledger:
            return self.symbol(name)
        return self.symbol(f"R.{name.removeprefix('R')}")

    def _term(
        self, base: str, sub: str, sup: str, *known: Expression | str | None
    ) -> Term:
        return Term(Symbol(base, sub, sup, "vector"), known)

    def _known(self, side: Side, what: str) -> Term:
        """The vector of a side's base: on the crank with its direction and size, else known from before."""
        words = self.words["vector"]
        name = side.shown
        centre = next((id for id in self.ledger.families if id.startswith("drawn.")), "drawn.A")
        arm = f"{_centre(centre.removeprefix('drawn.'))}{side.base}"
        if "omega.1" not in self.ledger or f"l.{arm}" not in self.ledger or not self._on_crank(side.base):
            return self._term(what, name, "", words["given"], words["given"], words["given"])
        length = self.symbol(f"l.{arm}")
        omega = self.symbol("omega.1")
        if what == "v":
            size: Expression = omega * length
            return self._term("v", name, "", f"⊥ {arm}", words["with_crank"], size)
        size = omega**2 * length
        return self._term("a", name, "", f"∥ {arm}", f"{side.base} → {_centre(arm)}", size)

    def _on_crank(self, name: str) -> bool:
        """Whether a point's velocity is computed as that of a point of the crank."""
        definition = self.ledger[f"v.{name}"].definition
        return definition is not None and "omega.1" in refs(definition)

    # --- tables

    def cell(self, content: object) -> Cell:
        """A table cell from text, a symbol, a number or inlines."""
        return Cell(_inlines(content))

    def table(
        self,
        key: str,
        caption: str,
        ids: Sequence[str],
        positions: Iterable[int],
        first: str | None = None,
    ) -> Table:
        """A table of quantities (columns) at positions (rows); the head shows symbol and unit."""
        width = min((TEXT_WIDTH - FIRST_COLUMN) / len(ids), WIDEST_COLUMN)
        columns = (Column(FIRST_COLUMN), *(Column(width) for _ in ids))
        title = self.words["table"]["position"] if first is None else first
        head = (
            (self.cell(title), *(self.cell(self.symbol(id)) for id in ids)),
            (Cell(), *(self.cell(self.unit(id)) for id in ids)),
        )
        rows = tuple(
            (self.cell(str(k)), *(self.cell(self.bare(id, k)) for id in ids)) for k in positions
        )
        return Table(columns, head, rows, self.prose.inlines(caption), key)

    def list_table(
        self, key: str, caption: str, head: Sequence[object], rows: Iterable[Sequence[object]], widths: Sequence[float]
    ) -> Table:
        """A free table: cells are texts, symbols, numbers or inlines; widths in mm; columns of words flush left."""
        body = [tuple(row) for row in rows]
        words = [any(_is_wordy(row[i]) for row in body) for i in range(len(widths))]
        return Table(
            tuple(Column(width, "left" if wordy else "center") for width, wordy in zip(widths, words, strict=True)),
            (tuple(self.cell(content) for content in head),),
            tuple(tuple(self.cell(content) for content in row) for row in body),
            self.prose.inlines(caption),
            key,
        )

    def quantity_table(
        self, key: str, caption: str, ids: Sequence[str], names: Mapping[str, str], position: int | None = None
    ) -> Table:
        """A table with one quantity a row: what it is, its symbol, its value."""
        heads = self.words["table"]
        return self.list_table(
            key,
            caption,
            (heads["quantity"], heads["symbol"], heads["value"]),
            ((names[id], self.symbol(id), self.value(id, position)) for id in ids),
            (92.0, 28.0, 40.0),
        )

    def unit(self, id: str) -> str:
        """A quantity's printed unit."""
        unit = self.ledger[id].how.unit
        return self.ledger.units.get(unit, unit)

    def bare(self, id: str, position: int | None) -> Inlines:
        """A number without its unit, a dash for what does not exist."""
        number = self.ledger.number(id, position, size=self.ledger[id].arm)
        if number.value != number.value or self._is_direction_of_nothing(id, position):
            return (Text("–"),)
        return (Value(Number(number.value, number.decimals, "")),)

    def _is_direction_of_nothing(self, id: str, position: int | None) -> bool:
        """Whether an angle `dir.R05`, `dir.v.B` is that of a vector which is nothing."""
        if not id.startswith("dir."):
            return False
        name = id.removeprefix("dir.")
        size = f"R.{name[1:]}" if name.startswith("R") else name
        return size in self.ledger and self.ledger.number(size, position).value == 0

    def direction(self, id: str, position: int | None) -> str:
        """The sense of a rotation in words; a dash where there is none."""
        value = self.ledger.number(id, position).value
        words = self.words["sense"]
        return str(words["none"] if value == 0 else words["anticlockwise"] if value > 0 else words["clockwise"])

    def functions(self) -> dict[str, Callable[..., Any]]:
        """The names under which templates call this voice."""
        names = (
            "symbol value point points image letters vector line lines reason equal ratio velocity_equation "
            "acceleration_equation force_equation link_equation driver_equation force_symbol table list_table "
            "quantity_table unit direction chain bare"
        )
        return {name: getattr(self, name) for name in names.split()}


def _lowered(text: str) -> str:
    """Digits of point names as lowered digits: B3 → B₃."""
    return text.translate(str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉"))


def _centre(arm: str) -> str:
    """The first point of a length's name: O1 of O1A, A of AB."""
    match = re.match(r"[A-Z]\d*", arm)
    assert match is not None
    return match.group()


def _is_wordy(content: object) -> bool:
    return isinstance(content, str) and len(content) >= LONG_WORDS


def _inlines(content: object) -> Inlines:
    match content:
        case str():
            return (Text(content),) if content else ()
        case Number():
            return (Value(content),)
        case Symbol() | Chain():
            return (InlineMath(content),)
        case tuple():
            return tuple(inline for part in content for inline in _inlines(part))
        case Text() | Value() | InlineMath():
            return (content,)
    if isinstance(content, Expression):
        return (InlineMath(content),)
    raise TypeError(f"a {type(content).__name__} has no place in a table")
