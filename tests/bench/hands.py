"""How safely a class is marked, by students who work by hand: `python -m tests.bench.hands [SHEETS]`.

Their chains are independent of the ledger and of marking (`tests.marking.hand`).  Each mistake
is made in one value of one sheet; the table says, for each kind of machine and over all, how many are located, named
and charged, and how many honest sheets lose or are flagged.  3,000 sheets with no flag bound its rate to 1 in 1,000.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Iterable, Sequence
from statistics import median

import numpy as np

from reportgen.marking.judging import mark
from tests.marking import hands, students
from tests.marking.machines import MACHINES
from tests.marking.rates import WORKED, Tally, injected, lost, misread, share
from tests.marking.test_guard import COPIES, Room
from tests.marking.test_losses import SCALES

CLASS = 40
NAMEABLE = {"omega.1", "R", "F", "m.2", "n", "H", "G2", "D", "s", "M.eq", "R.12.t"} | {
    *("l.AD", "turn.omega.3", "R.03.t", "M3")
}
"""Mistakes of `hands.MISTAKES` that marking has a name for."""


def honest(name: str, sheets: int) -> list[tuple[str, str]]:
    """Sheets without a mistake at every scale and bluntness: how many lose a mark."""
    scheme, losing, worked = hands.asked(students.scheme(name, WORKED)), 0, 0
    scales = ({}, *SCALES) if scheme.key.kind in hands.DRAWING else ({},)
    for seed in range(sheets * (len(SCALES) + 1) // len(scales)):
        for scale in scales:
            for blunt in (0.3e-3, 0.5e-3):
                worked += 1
                losing += lost(mark(scheme, hands.work(scheme, WORKED, blunt=blunt, seed=seed, **scale))) > 0
    return [(f"honest sheets that lose a mark (± 0.3, ± 0.5 mm, {len(scales)} scales)", share(losing, worked))]


def class_of(name: str, sheets: int) -> list[tuple[str, str]]:
    """A class of 40: honest sheets that are flagged, copies that are not, names and costs of usual mistakes."""
    rng = np.random.default_rng(CLASS)
    schemes = hands.variants(CLASS, rng, name)
    room = Room(schemes, [hands.honest(scheme, rng) for scheme in schemes])
    classmates = room.classmates
    usual = hands.possible(schemes[0])
    wrongly: list[tuple[int, str, tuple[str, ...]]] = []
    costs: list[float] = []
    named: list[bool] = []
    for number in range(sheets):
        scheme = schemes[number % CLASS]
        mistake = "" if number // CLASS % 2 else str(rng.choice(usual))
        marking = mark(scheme, hands.honest(scheme, rng, mistake), classmates)
        if marking.flags:
            wrongly.append((number, mistake, marking.warnings))
            print("flagged:", *wrongly[-1], flush=True)
        if (number + 1) % 500 == 0:
            print(f"{number + 1} marked, {len(wrongly)} flagged", file=sys.stderr, flush=True)
        if mistake:
            costs.append(lost(marking))
            named += [any(cell.mistake for cell in marking.first_errors)] if mistake in NAMEABLE else []
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
    scheme, source = room.schemes[number], number + CLASS // 2
    key = room.schemes[source]
    theirs = room.sheets[source] if number % 2 else students.sheet(key, lambda row, k, value: students.figures(value))
    copied = hands.with_cells(room.sheets[number], theirs, lambda id, k: COPIES[what](scheme, id, k))
    return bool(mark(scheme, copied, room.classmates).flags)


def show(rows: Iterable[tuple[str, str]]) -> None:
    print(*("| {} | {} |".format(*row) for row in rows), sep="\n", flush=True)


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench.hands", description=__doc__)
    parser.add_argument("sheets", nargs="?", type=int, default=400, help="honest sheets of each class")
    parser.add_argument("--machine", action="append", choices=MACHINES, help="only this assignment (repeatable)")
    parser.add_argument("--flags-only", action="store_true", help="only the classes")
    chosen = parser.parse_args(arguments)
    whole, losses = Tally(), []
    for name in chosen.machine or MACHINES:
        print(f"\n{name}", flush=True)
        if not chosen.flags_only:
            tally, misreading = injected(name, np.random.default_rng(1)), misread(name)
            whole.add(tally)
            losses += misreading
            show((*tally.rows, marks_for(misreading), *honest(name, max(1, chosen.sheets // 100))))
        if name in hands.DRAWN:
            show(class_of(name, chosen.sheets))
    if not chosen.flags_only:
        print("\nover all", flush=True)
        show((*whole.rows, marks_for(losses)))


def marks_for(misreading: Sequence[float]) -> tuple[str, str]:
    what = f"marks lost for one of {len(misreading)} data misread: median, most"
    return what, f"{median(misreading):.0f}, {max(misreading):.0f}"


if __name__ == "__main__":
    main()
