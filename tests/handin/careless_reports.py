"""Manners of students who are careless: what stands in such reports is hard to tell, and must not be told wrongly."""

from __future__ import annotations

from collections.abc import Callable

from reportgen.case.answer_key import KeyRow
from tests.handin import wml
from tests.handin.made_reports import POSITIONS, Report, given


def many_in_a_line(report: Report) -> None:
    """Several statements in a line, some without units, positions in bold lines."""
    report.look = report.chance.choice(("runs", "linear"))
    given(report, lambda row: report.put(report.line(row, 0)))
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
    given(report, lambda row: report.put(report.line(row, 0)))
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
    given(report, lambda row: report.put(report.line(row, 0)))
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
    given(report, lambda row: report.put(report.line(row, 0)))
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
    given(report, lambda row: report.put(report.line(row, 0)))
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
