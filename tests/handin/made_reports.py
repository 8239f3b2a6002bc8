"""A made-up report under way, and what a person would say stands in it."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np

from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.case.answer_key import Key, KeyRow
from reportgen.cases import open_case
from reportgen.marking.toleranced_key import Ask, key_of
from tests.handin import wml

ROOT = Path(__file__).parents[2] / "assignments"
MACHINES = ("four-bar-01", "slider-crank-01", "shaper-02", "lever-six-bar-01", "engine-v-01", "slotted-lever-01")
POSITIONS = (2, 5, 7)
Place = tuple[str, int]


@cache
def key_for(name: str, language: Language) -> Key:
    """What a sheet asks of a machine, at three positions."""
    key = Ask().of(key_of(open_case(ROOT / f"{name}.yaml", language)))

    def at(row: KeyRow) -> tuple[int, ...]:
        if not row.positions or row.single:
            return row.positions
        return tuple(k for k in POSITIONS if k <= len(row.values) and np.isfinite(row.values[k - 1]))

    return replace(key, rows=tuple(replace(row, positions=at(row)) for row in key.rows))


@dataclass
class Report:
    """A report under way: its blocks, and what a person would say stands in it."""

    key: Key
    chance: random.Random
    comma: bool
    look: str = "runs"
    blocks: list[str] = field(default_factory=list)
    truth: dict[Place, float] = field(default_factory=dict)
    texts: dict[Place, str] = field(default_factory=dict)

    @property
    def vi(self) -> bool:
        return self.key.language == "vi"

    # --- numbers ----------------------------------------------------------------------------------

    def written(self, value: float) -> str:
        """A number with four figures."""
        if value == 0:
            return "0"
        decimals = max(3 - int(np.floor(np.log10(abs(value)))), 0)
        text = f"{value:.{decimals}f}".replace("-", self.chance.choice("-−"))
        return text.replace(".", ",") if self.comma else text

    def draw(self, row: KeyRow, position: int) -> str:
        """A value for a place, as it is written; it is known from here on what stands there."""
        known = float(row.values[row.at(position)])
        size = abs(known) if np.isfinite(known) and abs(known) > 1e-6 else 1.0
        value = float(f"{size * self.chance.uniform(0.6, 1.6):.4g}")
        if np.nanmin(row.values) < 0 and not row.size:
            value = float(np.copysign(value, known))
        self.truth[row.id, position] = value
        self.texts[row.id, position] = self.written(value)
        return self.texts[row.id, position]

    def any_number(self) -> str:
        return self.written(self.chance.uniform(0.2, 400))

    def unit(self, row: KeyRow) -> str:
        return f" {row.unit}" if row.unit and row.unit != "°" else row.unit

    # --- words ------------------------------------------------------------------------------------

    def position(self, k: int) -> str:
        return f"{'vị trí' if self.vi else 'position'} {self.key.labels[k - 1]}"

    def say(self, vi: str, en: str) -> str:
        return vi if self.vi else en

    # --- symbols ----------------------------------------------------------------------------------

    def symbol(self, row: KeyRow, look: str = "") -> str:
        base, sub, sup = row.symbol.base, row.symbol.sub, row.symbol.sup
        match look or self.look:
            case "built":
                return wml.formula(wml.scripts(base, sub, sup))
            case "linear":
                return wml.run(base + (f"_{sub}" if sub else "") + (f"^{sup}" if sup else ""))
            case "lost":
                return wml.run(base + sub + sup)
            case "loose":
                letters = {"ω": "w", "ε": "ε", "v": "V", "a": "a"}
                return wml.run(letters.get(base, base) + (f"_{sub}" if sub else "") + (f"^{sup}" if sup else ""))
            case _:
                low = wml.run(sub, wml.LOW) if sub else ""
                return wml.run(base) + low + (wml.run(sup, wml.HIGH) if sup else "")

    def put(self, inner: str, style: str = "") -> None:
        self.blocks.append(wml.paragraph(inner, style))

    def heading(self, text: str, level: int) -> None:
        self.put(wml.run(text), f"u{level}")

    def built(self, row: KeyRow, position: int) -> str:
        """A whole line as one built formula, with a product on the way."""
        base, sub, sup = row.symbol.base, row.symbol.sub, row.symbol.sup
        inner = wml.scripts(base, sub, sup) + wml.math_run("=")
        if self.chance.random() < 0.5:
            top = wml.scripts("v", "x1") + wml.math_run("·") + wml.scripts("l", "x2")
            inner += wml.fraction(top, wml.math_run("2")) + wml.math_run("=")
            inner += wml.fraction(wml.math_run(f"{self.any_number()}·{self.any_number()}"), wml.math_run("2"))
            inner += wml.math_run("=")
        return wml.formula(inner + wml.math_run(self.draw(row, position) + self.unit(row)))

    def line(self, row: KeyRow, position: int, unit: bool = True) -> str:
        """A statement in running text, with a step on the way now and then."""
        step = self.chance.random()
        middle = ""
        if step < 0.3:
            middle = f" = {self.any_number()}·{self.any_number()}"
        elif step < 0.5:
            factor, length = self.chance.choice("μωk"), self.chance.choice(("pb", "xy", "l"))
            middle = f" = {factor}·{length} = {self.any_number()}.{self.any_number()}"
        shown = self.draw(row, position) + (self.unit(row) if unit else "")
        return self.symbol(row) + wml.run(f"{middle} = {shown}")

    def rows(self) -> list[KeyRow]:
        return [row for row in self.key.asked if row.positions]

    def singles(self) -> list[KeyRow]:
        return [row for row in self.rows() if row.single]

    def at(self, k: int) -> list[KeyRow]:
        return [row for row in self.rows() if k in row.positions and not row.single]

    def file(self) -> bytes:
        return wml.package("".join(self.blocks))


def given(report: Report, write: Callable[[KeyRow], None]) -> None:
    """The chapter of what is given: each single quantity by `write`."""
    report.heading(report.say("Số liệu và kích thước", "Data and dimensions"), 1)
    for row in report.singles():
        write(row)
