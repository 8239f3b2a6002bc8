"""A small key made by hand, for the tests of what marking reads and writes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from reportgen.base.units import Language, rounded
from reportgen.case.answer_key import Key, KeyRow, Role
from reportgen.formula import Symbol
from reportgen.formula.vocabulary import KeyChapter
from reportgen.marking.answer_sheet import HEAD, answer_book

LABELS = ("1", "2", "3", "4")


def row(
    id: str,
    part: KeyChapter,
    symbol: Symbol,
    kind: str,
    unit: str,
    values: Sequence[float],
    role: Role = Role.asked,
    positions: tuple[int, ...] | None = None,
    decimals: int | None = 2,
    sense: tuple[str, ...] = (),
) -> KeyRow:
    """A row asked at all its positions unless said otherwise."""
    numbers = np.array(values, dtype=float)
    everywhere = (0,) if len(numbers) == 1 else tuple(range(1, len(numbers) + 1))
    asked = () if role is Role.given else everywhere if positions is None else positions
    return KeyRow(
        id,
        part,
        role,
        symbol,
        kind,
        unit,
        decimals,
        numbers,
        numbers if decimals is None else rounded(numbers, decimals),
        np.full(len(numbers), 0.5),
        np.full(len(numbers), 0.05),
        asked,
        sense or ("",) * len(numbers),
    )


def small_key(language: Language = "vi", id: str = "crank-07", student: str = "Nguyễn Văn A") -> Key:
    """A crank of 0.15 m at 300 rpm: one given value, a scale, single values and values at four positions."""
    rows = (
        row("l.AB", KeyChapter.data, Symbol("l", "AB"), "length", "m", [0.15], Role.given, decimals=None),
        row("n", KeyChapter.data, Symbol("n"), "speed of rotation", "vg/ph", [300.0], Role.given, decimals=None),
        row("mu.l", KeyChapter.geometry, Symbol("μ", "l"), "length scale", "m/mm", [0.003], Role.scale, decimals=4),
        row("omega.1", KeyChapter.velocity, Symbol("ω", "1"), "angular velocity", "rad/s", [10 * math.pi]),
        row("v.B", KeyChapter.velocity, Symbol("v", "B"), "velocity", "m/s", [4.71, 2.36, -1.2, 0.0]),
        row(
            "dir.v.B",
            KeyChapter.velocity,
            Symbol("α", "vB"),
            "angle",
            "°",
            [90, 180, 270, math.nan],
            positions=(1, 2, 3),
        ),
        row(
            "M.eq",
            KeyChapter.torque,
            Symbol("M", "cb"),
            "torque",
            "N·m",
            [12.5, -1234.5, 60.0, 7.0],
            positions=(2,),
            sense=("a", "b", "a", "a"),
        ),
    )
    return Key(id, "slider-crank", "7", language, {"name": student, "id": "K7"} if student else {}, LABELS, rows)


def csv_rows(key: Key) -> list[list[str | float | None]]:
    """The empty sheet as rows of CSV: what names it, a blank line, then the answers from their head on."""
    answers, info = ([[entry.value for entry in row] for row in sheet.rows] for sheet in answer_book(key).sheets)
    return [*info, [], *answers[HEAD - 1 :]]
