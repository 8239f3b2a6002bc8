"""How safely a class is marked, by students who work by hand: `python -m tests.bench.hands [SHEETS]`.

Their chain is independent of the ledger and of marking (`tests.grading.hand`).  Each mistake is made in one value of
one sheet; the table says how many are located, named and charged, and how many honest sheets lose or are flagged.
"""

from __future__ import annotations

import argparse
import math
import operator
from collections import Counter
from collections.abc import Sequence
from functools import partial
from statistics import median

import numpy as np

from reportgen.grading.marking import mark
from reportgen.grading.mistakes import WRONG_DATUM
from tests.grading import hands, students
from tests.grading.hand import Hand
from tests.grading.test_guard import COPIES, Room
from tests.grading.test_losses import SCALES, lost

CLASS = 40
NAMEABLE = {"omega.1", "R", "F", "m.2", "n", "H", "G2", "D", "s", "M.eq", "R.12.t"}
"""Mistakes of `hands.MISTAKES` that marking has a name for."""


def share(part: float, whole: float) -> str:
    return f"{part:.0f} of {whole:.0f} ({part / whole:.1%})" if whole else "–"


def injected(name: str, rng: np.random.Generator) -> list[tuple[str, str]]:
    """One change of each computed quantity, one after the other, beside a sheet without it."""
    guide = students.guide(name, (4,))
    task = hands.task(guide, 4)
    counted: Counter[str] = Counter()
    marks: list[float] = []
    paper = float(guide.ledger[f"drawn.{task.crank}"].values[0])
    for id in [id for id in Hand(task, paper=paper).written if id in guide.rows and not id.startswith(("mu.R", "dir"))]:
        factor = float(rng.choice([0.7, 1.35, 1.6]))
        sheet = hands.work(guide, (4,), changes={id: partial(operator.mul, factor)}, blunt=0.3e-3, seed=1, paper=paper)
        place = (id, 0 if guide.rows[id].single else 4)
        cells = {(cell.id, cell.position): cell for cell in mark(guide, sheet).cells}
        cell = cells.get(place)
        if cell is None or cell.given is None or abs(cell.given - cell.expected) <= 2 * cell.band:
            continue
        firsts = [one for one in cells.values() if one.first]
        counted["made"] += 1
        counted["located"] += cell.first
        counted["exactly"] += [(one.id, one.position) for one in firsts] == [place]
        counted["false name"] += any(one.mistake and one.mistake not in ("other-scale", WRONG_DATUM) for one in firsts)
        filled = [one for one in cells.values() if one.given is not None]
        others = [one for one in filled if (one.id, one.position) != place]
        counted["others"] += len(others)
        counted["kept"] += sum(one.points == one.worth for one in others)
        marks.append(sum(one.worth - one.points for one in filled))
    made = counted["made"]
    return [
        ("located", share(counted["located"], made)),
        ("exactly this one told as a first error", share(counted["exactly"], made)),
        ("told under a name of another mistake", share(counted["false name"], made)),
        ("marks of the other cells kept", share(counted["kept"], counted["others"])),
        ("marks lost: median, most", f"{median(marks):.0f}, {max(marks):.0f}"),
    ]


def honest(name: str, sheets: int) -> list[tuple[str, str]]:
    """Sheets without a mistake at every scale and bluntness: how many lose a mark."""
    guide, losing, worked = students.guide(name, (4,)), 0, 0
    for seed in range(sheets):
        for scale in ({}, *SCALES):
            for blunt in (0.3e-3, 0.5e-3):
                worked += 1
                losing += lost(mark(guide, hands.work(guide, (4,), blunt=blunt, seed=seed, **scale))) > 0
    return [(f"honest sheets that lose a mark (± 0.3, ± 0.5 mm, {len(SCALES) + 1} scales)", share(losing, worked))]


def class_of(name: str, sheets: int) -> list[tuple[str, str]]:
    """A class of 40: honest sheets that are flagged, copies that are not, names and costs of usual mistakes."""
    rng = np.random.default_rng(CLASS)
    guides = hands.variants(CLASS, rng, name)
    room = Room(guides, [hands.honest(guide, rng) for guide in guides])
    classmates = room.classmates
    usual = hands.possible(guides[0])
    wrongly: list[tuple[int, str, tuple[str, ...]]] = []
    costs: list[float] = []
    named: list[bool] = []
    for number in range(sheets):
        guide = guides[number % CLASS]
        mistake = "" if number // CLASS % 2 else str(rng.choice(usual))
        marking = mark(guide, hands.honest(guide, rng, mistake), classmates)
        if marking.flags:
            wrongly.append((number, mistake, marking.warnings))
        if mistake:
            costs.append(lost(marking))
            named += [any(cell.mistake for cell in marking.first_errors)] if mistake in NAMEABLE else []
    for one in wrongly:
        print("flagged:", *one, flush=True)
    of = f"honest sheets flagged in a class of {CLASS}, half of them with one mistake"
    rows = [
        (of, f"{share(len(wrongly), sheets)}, at most {at_most(len(wrongly), sheets):.2%}"),
        ("usual mistakes that have a name: a name is told", share(sum(named), len(named))),
        ("marks lost for one usual mistake at three positions: median, most", f"{median(costs):.0f}, {max(costs):.0f}"),
    ]
    for what in COPIES:
        missed = [number for number in range(CLASS // 2) if not _told(room, number, what)]
        rows.append((f"copied from a classmate and told: {what}", share(CLASS // 2 - len(missed), CLASS // 2)))
        for number in missed:
            print(f"not told: {what}, sheet {number}", flush=True)
    return rows


def at_most(met: int, tried: int, certainty: float = 0.95) -> float:
    """The rate above which so few would be met with less than the rest of the certainty."""
    low, high = met / tried, 1.0
    for _ in range(60):
        rate = (low + high) / 2
        few = sum(math.comb(tried, k) * rate**k * (1 - rate) ** (tried - k) for k in range(met + 1))
        low, high = (rate, high) if few > 1 - certainty else (low, rate)
    return high


def _told(room: Room, number: int, what: str) -> bool:
    guide, source = room.guides[number], number + CLASS // 2
    key = room.guides[source]
    theirs = room.sheets[source] if number % 2 else students.sheet(key, lambda row, k, value: students.figures(value))
    copied = hands.with_cells(room.sheets[number], theirs, lambda id, k: COPIES[what](guide, id, k))
    return bool(mark(guide, copied, room.classmates).flags)


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench.hands", description=__doc__)
    parser.add_argument("sheets", nargs="?", type=int, default=400, help="honest sheets of each class")
    parser.add_argument("--machine", action="append", choices=(*hands.DRAWN,), help="only this one (repeatable)")
    parser.add_argument("--flags-only", action="store_true", help="only the classes")
    chosen = parser.parse_args(arguments)
    for name in chosen.machine or hands.DRAWN:
        print(f"\n{name}", flush=True)
        if not chosen.flags_only:
            rows = (*injected(name, np.random.default_rng(1)), *honest(name, max(1, chosen.sheets // 40)))
            print(*("| {} | {} |".format(*row) for row in rows), sep="\n", flush=True)
        print(*("| {} | {} |".format(*row) for row in class_of(name, chosen.sheets)), sep="\n", flush=True)


if __name__ == "__main__":
    main()
