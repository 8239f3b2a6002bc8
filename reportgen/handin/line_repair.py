"""Reconstruct the intended lines of a drawing: duplicate lines count once, and a broken line is one line.

CAD programs break a line at a crossing, and leave collinear pieces. Such pieces may be one vector, or several such as
weights laid end to end; only the plan can tell. So each run of pieces is a candidate in addition to the pieces
themselves, and a plan uses either (`plan_fit.py`).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from reportgen.base.records import Record
from reportgen.handin.arrowheads import arrowheads
from reportgen.handin.line_set import Lines, close_pairs

COVERED = 0.1
"""Largest distance (mm) between the ends of two lines that count as one line."""
EXACT = 0.02
"""Largest distance (mm) of pieces from their common line; pieces drawn separately are less exact."""
GAP = 3.0
"""Largest width (mm) of a gap in a broken line."""
MOST_PIECES = 4
"""Largest number of pieces of a line; a longer chain is a dashed line."""


def distinct(ends: np.ndarray) -> np.ndarray:
    """Return the lines [M, 2] (mm) without those that an earlier line covers, in either direction."""
    if not len(ends):
        return ends
    middle = ends.sum(axis=1) / 2
    first, second = close_pairs(middle, COVERED)
    a, b = ends[first], ends[second]
    straight = np.abs(a - b).max(axis=1)
    turned = np.abs(a - b[:, ::-1]).max(axis=1)
    same = np.minimum(straight, turned) <= COVERED
    kept = np.ones(len(ends), dtype=bool)
    for earlier, later in sorted(zip(*(np.sort([first[same], second[same]], axis=0)), strict=True)):
        if kept[earlier]:
            kept[later] = False
    return ends[kept]


class _Run(Record):
    """Pieces in sequence: the first and the last end (mm), and the inner ends as (piece, end)."""

    first: complex
    last: complex
    pieces: tuple[int, ...]
    inner: tuple[tuple[int, int], ...]


def meant(lines: Lines) -> tuple[Lines, np.ndarray]:
    """Return the possible intended lines [M, 2] (mm), and a mask of their ends [M, 2] that have an arrowhead.

    These are the lines as drawn, without the strokes of arrowheads, and each run of pieces as a further line. No run
    crosses an arrowhead, and none repeats a drawn line.
    """
    runs = _unlike(lines, list(_runs(lines)))
    count = len(lines.ends)
    ends = np.concatenate((lines.ends, np.array([(run.first, run.last) for run in runs]).reshape(-1, 2)))
    every = Lines(ends, lines.error, (*lines.pieces, *(frozenset(run.pieces) for run in runs)))
    # The last piece of a line may be shorter than its arrowhead; the whole line shows it.
    marked = arrowheads(every)
    strokes = frozenset(np.flatnonzero(marked.strokes[:count]).tolist())
    kept = [n for n in range(count) if n not in strokes]
    for number, run in enumerate(runs, start=count):
        if not every.pieces[number] & strokes and not any(marked.heads[place] for place in run.inner):
            kept.append(number)
    index = np.array(kept, dtype=int)
    return every.only(index), marked.heads[index]


def _unlike(lines: Lines, runs: list[_Run]) -> list[_Run]:
    """Return the runs that no line and no earlier run covers."""
    if not runs:
        return runs
    ends = np.concatenate((lines.ends, np.array([(run.first, run.last) for run in runs])))
    left = {(complex(a), complex(b)) for a, b in distinct(ends)}
    return [run for run in runs if (run.first, run.last) in left]


def _runs(lines: Lines) -> Iterator[_Run]:
    """Yield the runs of two or more pieces, each once."""
    count = len(lines.ends)
    following: dict[tuple[int, int], list[tuple[int, int]]] = {}
    first, second = close_pairs(lines.points, GAP)
    for this_end, next_end in (*zip(first, second, strict=True), *zip(second, first, strict=True)):
        piece, end = int(this_end % count), int(this_end // count)
        beside, its_end = int(next_end % count), int(next_end // count)
        if piece != beside and _in_line(lines.ends[piece], end, lines.ends[beside], its_end):
            following.setdefault((piece, end), []).append((beside, its_end))
    pending = [_Run(complex(lines.ends[piece, 1 - end]), 0j, (piece,), ((piece, end),)) for piece, end in following]
    while pending:
        run = pending.pop()
        for piece, end in following.get(run.inner[-1], ()):
            pieces = (*run.pieces, piece)
            if piece in run.pieces or len(pieces) > MOST_PIECES:
                continue
            last = complex(lines.ends[piece, 1 - end])
            if not _are_straight(lines, run.first, last, (*run.inner, (piece, end))):
                continue
            # Each run is found from both of its ends.
            if pieces[0] < pieces[-1]:
                yield _Run(run.first, last, pieces, (*run.inner, (piece, end)))
            pending.append(_Run(run.first, 0j, pieces, (*run.inner, (piece, end), (piece, 1 - end))))


def _in_line(piece: np.ndarray, end: int, beside: np.ndarray, its_end: int) -> bool:
    """Return True if a line [2] (mm) continues another one at its end, over a gap of limited width."""
    start, last = complex(piece[1 - end]), complex(beside[1 - its_end])
    whole = last - start
    if not whole:
        return False
    along = [((complex(z) - start) / whole * abs(whole)) for z in (piece[end], beside[its_end])]
    return (
        all(abs(z.imag) <= EXACT for z in along)
        and -EXACT <= along[1].real - along[0].real <= GAP
        and 0 < along[0].real < abs(whole)
        and 0 < along[1].real < abs(whole)
    )


def _are_straight(lines: Lines, first: complex, last: complex, inner: tuple[tuple[int, int], ...]) -> bool:
    """Return True if all inner ends are on the line from `first` to `last` (mm)."""
    span = last - first
    if not span:
        return False
    return all(abs(((complex(lines.ends[at]) - first) / span).imag) * abs(span) <= EXACT for at in inner)


def goes_on(lines: Lines, start: complex, end: complex) -> bool:
    """Return True if a line in the same direction begins at or after the `end` of the line from `start` (mm).

    It begins at most the length of that line after it; the two may then be pieces of one line.
    """
    direction = (end - start) / abs(end - start)
    along = (lines.ends - end) / direction
    on_it = (np.abs(along.imag) <= EXACT).all(axis=1) & (along.real >= -EXACT).all(axis=1)
    return bool((on_it & (along.real.min(axis=1) <= abs(end - start))).any())
