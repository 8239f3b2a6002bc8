"""Made-up reports as students write them, in many manners, with the values that a person finds in each.

Nothing here is the reader's: what stands where is known because it was put there.  The values are not those of the key
but drawn at random beside them, so that a number laid to a wrong place is seen.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path

import numpy as np

from reportgen.cases import open_case
from reportgen.marking.key import Ask, key_of
from reportgen.report.key import Key, KeyRow
from tests.handin import wml

ROOT = Path(__file__).parents[2] / "assignments"
MACHINES = ("four-bar-01", "slider-crank-01", "shaper-02", "lever-six-bar-01", "engine-v-01", "slotted-lever-01")
POSITIONS = (2, 5, 7)
Place = tuple[str, int]


@cache
def key_for(name: str, language: str) -> Key:
    """What a sheet asks of a machine, at three positions."""
    key = Ask().of(key_of(open_case(ROOT / f"{name}.yaml", language)))  # type: ignore[arg-type]

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


# --- manners: well kept ---------------------------------------------------------------------------


def _given(report: Report, write: Callable[[KeyRow], None]) -> None:
    report.heading(report.say("Số liệu và kích thước", "Data and dimensions"), 1)
    for row in report.singles():
        write(row)


def built_by_position(report: Report) -> None:
    """Headings by position, every line a built formula."""
    report.look = "built"
    _given(report, lambda row: report.put(report.built(row, 0)))
    for k in POSITIONS:
        report.heading(report.say(f"Phân tích {report.position(k)}", f"Analysis at {report.position(k)}"), 1)
        for row in report.at(k):
            report.put(report.built(row, k))


def runs_by_chapter(report: Report) -> None:
    """Chapters, under them the positions; indices as Word sets them."""
    _given(report, lambda row: report.put(report.line(row, 0)))
    chapters: dict[str, list[KeyRow]] = {}
    for row in report.rows():
        if not row.single:
            chapters.setdefault(row.part, []).append(row)
    for chapter, rows in chapters.items():
        report.heading(report.say(f"Chương {chapter}", f"Chapter {chapter}"), 1)
        for k in POSITIONS:
            report.heading(report.position(k).capitalize(), 2)
            for row in rows:
                if k in row.positions:
                    report.put(report.line(row, k) + wml.run(report.chance.choice(("", ".", ";"))))


def in_sentences(report: Report) -> None:
    """The position stands in each sentence."""
    report.look = report.chance.choice(("runs", "built", "linear"))
    _given(report, lambda row: report.put(wml.run(report.say("Tính được ", "This gives ")) + report.line(row, 0)))
    order = [(row, k) for k in POSITIONS for row in report.at(k)]
    report.chance.shuffle(order)
    for row, k in order:
        lead = report.say(f"Tại {report.position(k)}, ta có ", f"At {report.position(k)} we have ")
        if report.chance.random() < 0.3:
            report.put(report.line(row, k) + wml.run(f" ({report.position(k)})."))
        else:
            report.put(wml.run(lead) + report.line(row, k) + wml.run("."))


def scripts_lost(report: Report) -> None:
    """Plain text, as pasted from elsewhere: indices are gone."""
    report.look = "lost"
    _given(report, lambda row: report.put(report.line(row, 0)))
    for k in POSITIONS:
        report.put(wml.run(report.position(k).capitalize() + ":", wml.BOLD))
        for row in report.at(k):
            report.put(wml.run(report.chance.choice(("- ", "+ ", "", "a) "))) + report.line(row, k))


def tables_across(report: Report) -> None:
    """Results in tables, the positions across, the unit in the head or in a column, comma and merged heads."""
    _given(report, lambda row: report.put(report.line(row, 0)))
    report.heading(report.say("Kết quả", "Results"), 1)
    rows = [row for row in report.rows() if not row.single]
    for start in range(0, len(rows), 8):
        part = rows[start : start + 8]
        own_unit = report.chance.random() < 0.5
        head = [wml.cell(wml.run(report.say("Đại lượng", "Quantity")), merged="first")]
        head += [wml.cell(wml.run(report.say("Đơn vị", "Unit")), merged="first")] if own_unit else []
        head.append(wml.cell(wml.run(report.say("Vị trí", "Position")), span=len(POSITIONS)))
        second = [wml.cell("", merged="more") for _ in head[:-1]]
        second += [wml.cell(wml.run(report.key.labels[k - 1])) for k in POSITIONS]
        lines = [head, second]
        for row in part:
            unit = row.unit.replace("°", "độ" if report.vi else "°")
            beside = wml.run(f" ({unit})") if unit and not own_unit else ""
            line = [wml.cell(report.symbol(row) + beside)]
            line += [wml.cell(wml.run(unit))] if own_unit else []
            line += [wml.cell(wml.run(report.draw(row, k) if k in row.positions else "–")) for k in POSITIONS]
            lines.append(line)
        report.blocks.append(wml.table(lines, len(POSITIONS) + 1 + own_unit))


def tables_down(report: Report) -> None:
    """The positions down the first column, quantities with their units across."""
    report.look = report.chance.choice(("runs", "built"))
    _given(report, lambda row: report.put(report.line(row, 0)))
    report.heading(report.say("Bảng kết quả", "Table of results"), 1)
    rows = [row for row in report.rows() if not row.single]
    for start in range(0, len(rows), 5):
        part = rows[start : start + 5]
        head = [wml.cell(wml.run(report.say("Vị trí", "Position")))]
        head += [wml.cell(report.symbol(row) + wml.run(f", {row.unit}" if row.unit else "")) for row in part]
        lines = [head]
        for k in POSITIONS:
            line = [wml.cell(wml.run(report.key.labels[k - 1]))]
            line += [wml.cell(wml.run(report.draw(row, k) if k in row.positions else "")) for row in part]
            lines.append(line)
        report.blocks.append(wml.table(lines, len(part) + 1))


def long_chains(report: Report) -> None:
    """Vector equations, statements over several lines, what follows behind an arrow, numbers of equations."""
    number = 0
    _given(report, lambda row: report.put(report.built(row, 0)))
    for k in POSITIONS:
        report.heading(f"{k}. {report.position(k).capitalize()}", 2)
        for row in report.at(k):
            number += 1
            report.put(
                wml.formula(
                    wml.scripts("v", "X")
                    + wml.math_run("=")
                    + wml.scripts("v", "Y")
                    + wml.math_run("+")
                    + wml.scripts("v", "XY")
                )
                + wml.run(f"   (2.{number})")
            )
            way = report.chance.random()
            if way < 0.35:
                report.put(report.symbol(row) + wml.run(f" = {report.any_number()}·{report.any_number()}"))
                report.put(wml.run(f"= {report.draw(row, k)}{report.unit(row)}"))
            elif way < 0.6:
                report.put(
                    report.symbol(row)
                    + wml.run(" = k·x ⇒ ")
                    + report.symbol(row)
                    + wml.run(f" = {report.draw(row, k)}{report.unit(row)}")
                )
            else:
                report.put(report.line(row, k))


def corrected(report: Report) -> None:
    """First tries struck out, deleted or hidden, and what is only supposed."""
    _given(report, lambda row: report.put(report.line(row, 0)))
    for k in POSITIONS:
        report.heading(report.position(k).capitalize(), 2)
        for row in report.at(k):
            way = report.chance.random()
            wrong = f" = {report.any_number()}{report.unit(row)}"
            if way < 0.2:
                report.put(
                    report.symbol(row)
                    + wml.run(" = ")
                    + wml.run(report.any_number(), wml.STRUCK)
                    + wml.run(f"{report.draw(row, k)}{report.unit(row)}")
                )
                continue
            if way < 0.35:
                deleted = wml.run(report.any_number()).replace("w:t ", "w:delText ").replace("/w:t>", "/w:delText>")
                report.put(
                    report.symbol(row)
                    + wml.run(" = ")
                    + f'<w:del w:id="1" w:author="x">{deleted}</w:del>'
                    + f'<w:ins w:id="2" w:author="x">{wml.run(report.draw(row, k) + report.unit(row))}</w:ins>'
                )
                continue
            if way < 0.5:
                report.put(wml.run(report.say("Giả sử ", "Suppose ")) + report.symbol(row) + wml.run(wrong + "."))
            report.put(report.line(row, k))


def furniture(report: Report) -> None:
    """Captions, notes, contents, empty lines, text in many runs with letters that nobody sees."""
    report.put(wml.run(report.say("MỤC LỤC", "CONTENTS"), wml.BOLD))
    for k in POSITIONS:
        report.put(wml.run(f"2.{k} {report.position(k).capitalize()}\t{k + 3}"))
    _given(report, lambda row: report.put(report.line(row, 0)))
    for k in POSITIONS:
        report.heading(f"2.{k}. {report.position(k).capitalize()}", 2)
        for index, row in enumerate(report.at(k)):
            if index % 4 == 0:
                report.put(
                    wml.run(report.say(f"Hình 2.{index}. Họa đồ vận tốc, μ = 0,02", f"Figure 2.{index}. Velocity plan"))
                )
            text = f" = {report.draw(row, k)}{report.unit(row)}"
            cut = report.chance.randrange(1, len(text))
            pieces = wml.run(text[:cut]) + wml.run("\u200b") + wml.run(text[cut:])
            report.put(
                report.symbol(row)
                + pieces
                + (
                    wml.run(report.say(" (theo hình trên).", " (from the plan)."))
                    if report.chance.random() < 0.3
                    else ""
                )
            )


# --- manners: careless ----------------------------------------------------------------------------


def many_in_a_line(report: Report) -> None:
    """Several statements in a line, some without units, positions in bold lines."""
    report.look = report.chance.choice(("runs", "linear"))
    _given(report, lambda row: report.put(report.line(row, 0)))
    for k in POSITIONS:
        report.put(wml.run(report.position(k).capitalize(), wml.BOLD))
        rows = report.at(k)
        for start in range(0, len(rows), 3):
            joint = report.chance.choice((", ", "; ", report.say(" và ", " and "), ". "))
            worded = joint.strip().isalpha()
            parts = [
                report.line(row, k, unit=worded or report.chance.random() < 0.8) for row in rows[start : start + 3]
            ]
            report.put(wml.run(joint).join(parts) + wml.run("."))


def loose_letters(report: Report) -> None:
    """Other letters, remarks behind the numbers, comparisons with other positions."""
    report.look = "loose"
    _given(report, lambda row: report.put(report.line(row, 0)))
    for k in POSITIONS:
        report.put(wml.run(report.say(f"Xét {report.position(k)}:", f"Consider {report.position(k)}:")))
        for index, row in enumerate(report.at(k)):
            if index % 7 == 3:
                another = report.chance.choice([one for one in POSITIONS if one != k])
                report.put(
                    wml.run(
                        report.say(
                            f"Lớn hơn so với {report.position(another)}.",
                            f"This is larger than at {report.position(another)}.",
                        )
                    )
                )
            remark = report.chance.choice(
                (
                    "",
                    report.say(" hướng sang trái", " to the left"),
                    report.say(", chiều như hình vẽ", ", as drawn"),
                    report.say(" (theo chiều dương)", " (positive)"),
                )
            )
            report.put(report.line(row, k) + wml.run(remark))


def unsaid(report: Report) -> None:
    """A part of the numbers has no position that anybody could tell, or two; these are no values of anything."""
    _given(report, lambda row: report.put(report.line(row, 0)))
    for k in POSITIONS:
        report.heading(report.position(k).capitalize(), 2)
        for row in report.at(k):
            report.put(report.line(row, k))
        report.heading(report.say("Nhận xét", "Remarks"), 2)
        for row in report.chance.sample(report.at(k), 3):
            lead = report.chance.choice(
                (
                    report.say("Nói chung ", "In general "),
                    report.say(f"Từ {report.position(2)} đến 5, ", f"From {report.position(2)} to 5, "),
                )
            )
            report.put(wml.run(lead) + report.symbol(row) + wml.run(f" = {report.any_number()}{report.unit(row)}"))


def _traps(report: Report, row: KeyRow, other: KeyRow, k: int) -> list[Callable[[], str]]:
    """Lines with a number that is no value of the row at the position, whatever it looks like."""
    number, unit, symbol = report.any_number, report.unit(row), report.symbol
    away = report.chance.choice([one for one in POSITIONS if one != k])
    text = wml.run
    say = report.say

    return [
        lambda: symbol(row) + text(f" = {report.draw(row, k)}{unit} > ") + symbol(other) + text(" = x"),
        lambda: text("sin ") + symbol(row) + text(f" = {number()}"),
        lambda: text("2 ") + symbol(row) + text(f" = {number()}{unit}"),
        lambda: symbol(row) + text(" : ") + symbol(other) + text(" = 3 : 2"),
        lambda: (
            text(say("Giá trị lớn nhất của ", "The largest value of ")) + symbol(row) + text(f" = {number()}{unit}")
        ),
        lambda: (
            symbol(row) + text(f" = {number()}; {number()}; {number()}{unit} ({say('vị trí', 'positions')} 2, 5, 7)")
        ),
        lambda: (
            text(say(f"Ở {report.position(away)} và 9, ", f"At {report.position(away)} and 9, "))
            + symbol(row)
            + text(f" = {number()}{unit}")
        ),
        lambda: symbol(row) + text(f" = {number()} ÷ {number()}{unit}"),
        lambda: symbol(row) + text(f" = {number()}{unit} {say('hoặc', 'or')} {number()}{unit}"),
        lambda: symbol(row) + text(f" = {number()}{unit} ({say('sai', 'wrong')})"),
        lambda: symbol(row) + wml.run("2", wml.HIGH) + text(f" = {number()}"),
        lambda: (
            text(say("Nếu ", "If ")) + symbol(row) + text(f" = {number()}{unit} {say('thì', 'then')} x = {number()}")
        ),
        lambda: text("k = ") + symbol(row) + text("/") + symbol(other) + text(f" = {number()}"),
        lambda: text("F = x + ") + symbol(row) + text(f" = {number()}"),
        lambda: symbol(row) + text(" + ") + symbol(other) + text(f" = {number()}{unit}"),
        lambda: symbol(row) + text(f" = {number()} kWh"),
        lambda: (
            symbol(row)
            + text(
                f" = {report.chance.randrange(2, 9)}.{report.chance.randrange(100, 999)}"
                f",{report.chance.randrange(10, 99)}{unit}"
            )
        ),
        lambda: text("X ") + symbol(row) + text(f" = {number()}{unit}"),
        lambda: text("z = k ") + symbol(row) + text(f" = {number()}{unit}"),
        lambda: (
            text(say("Theo sách, tại điểm chết ", "By the book, at the dead centre "))
            + symbol(row)
            + text(f" = {number()}{unit}")
        ),
        lambda: text("Δ") + symbol(row, "linear") + text(f" = {number()}{unit}"),
        lambda: wml.formula(
            wml.math_run("|")
            + wml.scripts(row.symbol.base, row.symbol.sub, row.symbol.sup)
            + wml.math_run("|")
            + wml.math_run("·k = 3")
        ),
    ]


def traps(report: Report) -> None:
    """Between the values lines that only look like values; where such a line stands, its row has no other."""
    report.look = report.chance.choice(("runs", "linear", "lost", "built"))
    _given(report, lambda row: report.put(report.line(row, 0)))
    for k in POSITIONS:
        report.heading(report.position(k).capitalize(), 2)
        rows = report.at(k)
        for row in rows:
            other = report.chance.choice([one for one in rows if one is not row])
            if report.chance.random() < 0.4:
                report.put(report.chance.choice(_traps(report, row, other, k))())
            else:
                report.put(report.line(row, k))


def mixed(report: Report) -> None:
    """Everything at once: lines, formulas, sentences, traps, other letters, remarks, in any order."""
    _given(report, lambda row: report.put(report.line(row, 0)))
    for k in POSITIONS:
        report.chance.choice(
            (
                lambda k=k: report.heading(report.position(k).capitalize(), 2),
                lambda k=k: report.put(wml.run(report.position(k).capitalize() + ":", wml.BOLD)),
            )
        )()
        rows = report.at(k)
        report.chance.shuffle(rows)
        while rows:
            row = rows.pop()
            report.look = report.chance.choice(("runs", "runs", "built", "linear", "lost", "loose"))
            way = report.chance.randrange(8)
            if way == 0 and rows:
                other = report.chance.choice(rows)
                report.put(report.chance.choice(_traps(report, row, other, k))())
            elif way == 1 and rows:
                other = rows.pop()
                joint = report.chance.choice(("; ", ", ", "\t", report.say(" còn ", " and ")))
                report.put(report.line(row, k) + wml.run(joint) + report.line(other, k))
            elif way == 2:
                report.put(
                    wml.run(report.say(f"Ở {report.position(k)}: ", f"In {report.position(k)}: ")) + report.line(row, k)
                )
            elif way == 3:
                # A product without a sign between its factors.
                report.put(report.symbol(row) + wml.run(" = ω l = ") + wml.run(report.draw(row, k) + report.unit(row)))
            elif way == 4:
                report.put(
                    report.symbol(row)
                    + wml.run(f" [{row.unit}] = " if row.unit else " = ")
                    + wml.run(report.draw(row, k))
                )
            elif way == 5:
                report.put(report.line(row, k) + wml.run(f"\t(2.{len(rows)})"))
            elif way == 6:
                report.put(report.symbol(row) + wml.run(f": {report.draw(row, k)}{report.unit(row)}"))
            else:
                report.put(report.line(row, k))


WELL_KEPT: Sequence[Callable[[Report], None]] = (
    built_by_position,
    runs_by_chapter,
    in_sentences,
    scripts_lost,
    tables_across,
    tables_down,
    long_chains,
    corrected,
    furniture,
)
CARELESS: Sequence[Callable[[Report], None]] = (many_in_a_line, loose_letters, unsaid, traps, mixed)
MANNERS = {manner.__name__: manner for manner in (*WELL_KEPT, *CARELESS)}


def report(manner: str, machine: str, seed: int) -> Report:
    """A made-up report, the same for the same seed."""
    chance = random.Random(f"{manner}/{machine}/{seed}")
    language = chance.choice(("vi", "en"))
    comma = chance.random() < (0.8 if language == "vi" else 0.1)
    made = Report(key_for(machine, language), chance, comma)
    MANNERS[manner](made)
    return made


def each(seeds: Sequence[int]) -> Iterator[tuple[str, str, int]]:
    """Every manner with every machine and seed."""
    for seed in seeds:
        for manner in MANNERS:
            for machine in MACHINES:
                yield manner, machine, seed
