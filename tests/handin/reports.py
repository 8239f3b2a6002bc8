"""Made-up reports as students write them, in many manners, with the values that a person finds in each.

Nothing here is the reader's: what stands where is known because it was put there.  The values are not those of the key
but drawn at random beside them, so that a number laid to a wrong place is seen.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence

from reportgen.case.answer_key import KeyRow
from tests.handin import wml
from tests.handin.careless_reports import loose_letters, many_in_a_line, mixed, traps, unsaid
from tests.handin.made_reports import MACHINES, POSITIONS, Report, given, key_for


def built_by_position(report: Report) -> None:
    """Headings by position, every line a built formula."""
    report.look = "built"
    given(report, lambda row: report.put(report.built(row, 0)))
    for k in POSITIONS:
        report.heading(report.say(f"Phân tích {report.position(k)}", f"Analysis at {report.position(k)}"), 1)
        for row in report.at(k):
            report.put(report.built(row, k))


def runs_by_chapter(report: Report) -> None:
    """Chapters, under them the positions; indices as Word sets them."""
    given(report, lambda row: report.put(report.line(row, 0)))
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
    given(report, lambda row: report.put(wml.run(report.say("Tính được ", "This gives ")) + report.line(row, 0)))
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
    given(report, lambda row: report.put(report.line(row, 0)))
    for k in POSITIONS:
        report.put(wml.run(report.position(k).capitalize() + ":", wml.BOLD))
        for row in report.at(k):
            report.put(wml.run(report.chance.choice(("- ", "+ ", "", "a) "))) + report.line(row, k))


def tables_across(report: Report) -> None:
    """Results in tables, the positions across, the unit in the head or in a column, comma and merged heads."""
    given(report, lambda row: report.put(report.line(row, 0)))
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
    given(report, lambda row: report.put(report.line(row, 0)))
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
    given(report, lambda row: report.put(report.built(row, 0)))
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
    given(report, lambda row: report.put(report.line(row, 0)))
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
    given(report, lambda row: report.put(report.line(row, 0)))
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
