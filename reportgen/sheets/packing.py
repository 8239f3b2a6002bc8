"""Where plates stand on drawing sheets: as many as have room, in the order of the work, then spread over the paper.

Plates stand in rows, or in columns where rows do not fill a sheet.  Where neither does, each plate goes as high up as
it can and there as far to the left, as one lays cards on a table.  Boxes here have half the white around them at each
side; a spot is (to the right, down) from where the first one stands.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import accumulate, chain, islice
from typing import NamedTuple

from reportgen.drawing.sheet import GAP, PlacedScene, Room

Spot = tuple[float, float]

DUST = 1e-6
"""Rounding of places, mm."""
AHEAD = 8
"""So many plates more than stand in order are tried in another order."""
SWEEPS = 12
"""How often plates are moved to the middle between their neighbours."""
NEVER = 1e6
"""How bad it is that a plate has no place on any sheet."""

UNSTRETCHED = 1 + 1j
STRETCHES = (
    1 + 1.2j,
    1.2 + 1j,
    1.15 + 1.15j,
    1.3 + 1j,
    1 + 1.4j,
    1.2 + 1.4j,
    1.5 + 1j,
    1.4 + 1.2j,
    1.4 + 1.5j,
    1.6 + 1.6j,
)
"""How much wider and higher than usual the tables of a sheet may be."""
LEAVING = 8
"""So many plates fewer than a sheet has room for are tried with tables stretched."""
MOST = 0.9
"""No sheet can be filled more than this."""


class Size(NamedTuple):
    """Of a part, and of the table in it, mm."""

    width: float
    height: float
    wide: float = 0.0
    tall: float = 0.0

    @classmethod
    def of(cls, part: PlacedScene) -> Size:
        return cls(part.scene.width, part.scene.height, part.table.real, part.table.imag)

    def stretched(self, stretch: complex) -> Size:
        """With the table so many times as wide and as high; what stands above it stays."""
        return Size(max(self.width, self.wide * stretch.real), self.height + self.tall * (stretch.imag - 1))


ORDERS: tuple[Callable[[Size], float], ...] = (
    lambda size: -size.height,
    lambda size: -size.width,
    lambda size: -size.width * size.height,
)
"""Orders that leave less white than that of the work."""


@dataclass(frozen=True, slots=True)
class _Paper:
    """What a room offers to boxes: `wide` × `high`, and below `above` no further to the right than `beside`."""

    wide: float
    high: float
    beside: float
    above: float

    @classmethod
    def of(cls, room: Room) -> _Paper:
        size = room.high - room.low
        wide, high = size.real - GAP, size.imag - GAP
        return cls(wide, high, wide - room.block.real, high - room.block.imag)

    def floor(self, right: float) -> float:
        """How far down a box may reach whose right edge is there."""
        return self.high if right <= self.beside + DUST else self.above


def _spots(sizes: Sequence[Size], paper: _Paper) -> list[Spot]:
    """The places of plates of some sizes, up to the first that has none."""
    # What stands already ends in steps: from lefts[n] to the next left it reaches down to lows[n].
    lefts, lows = [0.0], [0.0]
    spots: list[Spot] = []
    for width, height in ((width + GAP, height + GAP) for width, height, *_ in sizes):
        best: tuple[float, int, int] | None = None
        for step, left in enumerate(lefts):
            right = left + width
            if right > paper.wide + DUST:
                break
            top, after = lows[step], step + 1
            while after < len(lefts) and lefts[after] < right - DUST:
                top = max(top, lows[after])
                after += 1
            if top + height <= paper.floor(right) + DUST and (best is None or top < best[0] - DUST):
                best = top, step, after
        if best is None:
            break
        top, step, after = best
        left, right = lefts[step], lefts[step] + width
        end = lefts[after] if after < len(lefts) else paper.wide
        rest = [(right, lows[after - 1])] if right < end - DUST else []
        lefts[step:after], lows[step:after] = [left, *(x for x, _ in rest)], [top + height, *(y for _, y in rest)]
        spots.append((left, top))
    return spots


def _rows(sizes: Sequence[Size], paper: _Paper) -> list[Spot]:
    """The places of plates in rows, up to the first that has none; below a low one may stand another in its row."""
    spots: list[Spot] = []
    top = height = 0.0
    left = right = low = 0.0
    """Of the last column in the row."""
    for width, tall in ((width + GAP, height + GAP) for width, height, *_ in sizes):
        if right > 0.0 and low + tall <= top + height + DUST and _fits(left, low, width, tall, paper):
            spots.append((left, low))
            right, low = max(right, left + width), low + tall
            continue
        if not _fits(right, top, width, max(tall, height), paper):
            top, height, right = top + height, 0.0, 0.0
            if not _fits(0.0, top, width, tall, paper):
                break
        spots.append((right, top))
        left, right, low, height = right, right + width, top + tall, max(height, tall)
    return spots


def _columns(sizes: Sequence[Size], paper: _Paper) -> list[Spot]:
    """The places of plates below one another in columns, up to the first that has none."""
    spots: list[Spot] = []
    left = right = low = 0.0
    for width, tall in ((width + GAP, height + GAP) for width, height, *_ in sizes):
        if not _fits(left, low, width, tall, paper):
            left, low = right, 0.0
            if not _fits(left, low, width, tall, paper):
                break
        spots.append((left, low))
        right, low = max(right, left + width), low + tall
    return spots


def _fits(left: float, top: float, width: float, tall: float, paper: _Paper) -> bool:
    right = left + width
    return right <= paper.wide + DUST and top + tall <= paper.floor(right) + DUST


# --- parts on one sheet after another -------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Laid:
    """The parts of one sheet with their spots and the share they fill, if its tables are stretched."""

    parts: tuple[PlacedScene, ...]
    spots: tuple[Spot, ...]
    share: float
    stretch: complex = UNSTRETCHED

    def with_parts(self, parts: Iterable[PlacedScene]) -> Laid:
        return replace(self, parts=tuple(parts))


@dataclass(slots=True)
class Dividing:
    """How parts in the order of the work are divided over sheets, each filled to a share that is `enough`.

    What is found is kept: the next parts often end as these do, and often have runs of the same sizes.
    """

    room: Room
    enough: float
    in_rows: bool = False
    """Whether plates stand in rows or columns only; else they do where that fills a sheet."""
    in_any_order: bool = False
    """Whether plates may change places on their sheet where that fills it."""
    paper: _Paper = field(init=False)
    area: float = field(init=False)
    _endings: dict[tuple[Size, int], int] = field(default_factory=dict)
    """The number of each ending of parts that was seen, by its first size and the number of what follows."""
    _found: dict[int, Best] = field(default_factory=lambda: {0: (0.0, ())})
    """The sheets of each ending, by its number."""
    _kept: dict[tuple[Size, ...], _Remembered] = field(default_factory=dict)
    _placed: dict[tuple[Size, ...], list[Spot]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.paper, self.area = _Paper.of(self.room), self.room.area

    def of(self, parts: Sequence[PlacedScene]) -> tuple[float, list[Laid]]:
        """The parts on sheets, and what these miss of being full enough, in hundredths.

        What misses `NEVER` and more has a part that fits no sheet.
        """
        sizes = [Size.of(part) for part in parts]
        endings = [0]
        for size in reversed(sizes):
            endings.append(self._endings.setdefault((size, endings[-1]), len(self._endings) + 1))
        endings.reverse()
        missing, sheets = self._best(sizes, endings, 0)
        laid, start = [], 0
        for order, spots, share, stretch in sheets:
            laid.append(Laid(tuple(parts[start + index] for index in order), spots, share, stretch))
            start += len(order)
        return missing, laid

    def _best(self, sizes: Sequence[Size], endings: Sequence[int], start: int) -> Best:
        """The sheets of what begins at `start`, and what they miss."""
        if endings[start] not in self._found:
            best: Best = NEVER, ()
            run = self._run(sizes, start)
            for filling in self._fillings(run):
                missing, rest = self._best(sizes, endings, start + len(filling[0]))
                missing += 100 * max(self.enough - filling[2], 0.0)
                if missing < best[0]:
                    best = missing, (filling, *rest)
                if missing == 0.0:
                    break
            self._found[endings[start]] = best
        return self._found[endings[start]]

    def _run(self, sizes: Sequence[Size], start: int) -> tuple[Size, ...]:
        """What could stand on one sheet from `start` on, were there no white."""
        share, end = 0.0, start
        while end < len(sizes) and (share := share + self._share(sizes[end])) <= 1.0:
            end += 1
        return tuple(sizes[start:end])

    def _share(self, size: Size) -> float:
        return size.width * size.height / self.area

    def _spots(self, run: tuple[Size, ...]) -> list[Spot]:
        if run not in self._placed:
            self._placed[run] = _spots(run, self.paper)
        return self._placed[run]

    def _fillings(self, run: tuple[Size, ...]) -> Iterable[Filling]:
        """What a sheet may take of a run, the best first; mostly no more of it is asked for."""
        if run not in self._kept:
            self._kept[run] = _Remembered(chain(self._in_order(run), self._in_other_orders(run)))
        return self._kept[run]

    def _in_order(self, run: tuple[Size, ...]) -> Iterator[Filling]:
        """All that a sheet can take in this order, then fewer if these still fill it."""
        shares = list(accumulate(map(self._share, run)))
        rows = _rows(run, self.paper)
        yield from self._fewer(tuple(rows), shares, self.in_rows)
        yield from self._fewer(tuple(_columns(run, self.paper)), shares, False)
        if not self.in_rows:
            yield from self._fewer(tuple(self._spots(run)), shares, True)
            rows = max(rows, self._spots(run), key=len)
        yield from self._stretched(run[: len(rows)])

    def _stretched(self, run: tuple[Size, ...]) -> Iterator[Filling]:
        """Plates that do not fill the sheet, its tables wider or higher so that they do."""
        place = _rows if self.in_rows else _spots
        found: dict[complex, tuple[list[float], list[Spot]]] = {}
        """Of all plates with their tables stretched, shares and spots: fewer of them have the same ones."""
        for count in range(len(run), max(len(run) - LEAVING, 0), -1):
            for stretch in STRETCHES if any(size.tall for size in run[:count]) else ():
                if stretch not in found:
                    sizes = [size.stretched(stretch) if size.tall else size for size in run]
                    areas = accumulate(size.width * size.height for size in sizes)
                    found[stretch] = [area / self.area for area in areas], place(sizes, self.paper)
                shares, spots = found[stretch]
                if self.enough <= shares[count - 1] <= MOST and len(spots) >= count:
                    yield tuple(range(count)), tuple(spots[:count]), shares[count - 1], stretch
                    break

    def _fewer(self, spots: tuple[Spot, ...], shares: Sequence[float], at_least_all: bool) -> Iterator[Filling]:
        """All plates that have spots, then fewer of them, as long as they fill the sheet."""
        for count in range(len(spots), 0, -1):
            if shares[count - 1] < self.enough and not (at_least_all and count == len(spots)):
                break
            yield tuple(range(count)), spots[:count], shares[count - 1], UNSTRETCHED

    def _in_other_orders(self, run: tuple[Size, ...]) -> Iterator[Filling]:
        """More parts than stand in their order; they need not stand in rows."""
        if self.in_rows or not self.in_any_order:
            return
        count = len(self._spots(run))
        shares = list(accumulate(map(self._share, run)))
        for more in range(min(count + AHEAD, len(run)), count, -1):
            if not self.enough <= shares[more - 1] <= MOST:
                continue
            for order in ORDERS:
                turned = tuple(sorted(range(more), key=lambda index: order(run[index])))
                spots = tuple(_spots([run[index] for index in turned], self.paper))
                if len(spots) == more:
                    yield turned, spots, shares[more - 1], UNSTRETCHED
                    break


Filling = tuple[tuple[int, ...], tuple[Spot, ...], float, complex]
"""Which parts one sheet takes, counted from the first, their spots, the share they fill, and how tables stretch."""
Best = tuple[float, tuple[Filling, ...]]
"""What sheets miss of being full, and what each takes."""


class _Remembered:
    """What is found one after the other, each once, for all who ask."""

    def __init__(self, found: Iterator[Filling]) -> None:
        self._known: list[Filling] = []
        self._more = found

    def __iter__(self) -> Iterator[Filling]:
        number = 0
        while number < len(self._known) or self._goes_on():
            yield self._known[number]
            number += 1

    def _goes_on(self) -> bool:
        """Whether there is one more."""
        so_far = len(self._known)
        self._known.extend(islice(self._more, 1))
        return len(self._known) > so_far


def too_large(parts: Sequence[PlacedScene], room: Room) -> PlacedScene | None:
    """The first part that has no place on an empty sheet."""
    paper = _Paper.of(room)
    return next((part for part in parts if not _spots([Size.of(part)], paper)), None)


# --- white shared out -----------------------------------------------------------------------------


def spread(laid: Laid, room: Room) -> tuple[PlacedScene, ...]:
    """The parts in their places, the white of the sheet shared out between them.

    Rows, which are the parts that begin at one height, move together; then each part moves between its neighbours.
    """
    paper = _Paper.of(room)
    sizes = [(part.scene.width + GAP, part.scene.height + GAP) for part in laid.parts]
    lefts, tops = [x for x, _ in laid.spots], [y for _, y in laid.spots]
    everyone = range(len(sizes))
    rows = [[n for n in everyone if abs(tops[n] - top) < DUST] for top in sorted(set(tops))]
    above = [[m for m in everyone if tops[m] + sizes[m][1] <= tops[n] + DUST and _abreast(lefts, sizes, 0, m, n)]
             for n in everyone]  # fmt: skip
    below = [[m for m in everyone if n in above[m]] for n in everyone]
    for _ in range(SWEEPS):
        for row in rows:
            least = max((tops[m] + sizes[m][1] for n in row for m in above[n]), default=0.0)
            most = min(
                min([tops[m] for m in below[n]] + [paper.floor(lefts[n] + sizes[n][0])]) - sizes[n][1] for n in row
            )
            place = (least + most) / 2 if least else least
            for n in row:
                tops[n] = place
    before = [[m for m in everyone if lefts[m] + sizes[m][0] <= lefts[n] + DUST and _abreast(tops, sizes, 1, m, n)]
              for n in everyone]  # fmt: skip
    behind = [[m for m in everyone if n in before[m]] for n in everyone]
    for _ in range(SWEEPS):
        for n in sorted(everyone, key=lefts.__getitem__):
            least = max((lefts[m] + sizes[m][0] for m in before[n]), default=0.0)
            end = paper.wide if tops[n] + sizes[n][1] <= paper.above + DUST else paper.beside
            most = min([lefts[m] for m in behind[n]] + [end]) - sizes[n][0]
            lefts[n] = (least + most) / 2
    corner = complex(room.low.real + GAP, room.high.imag - GAP)
    return tuple(
        replace(part, at=corner + complex(left, -top - part.scene.height))
        for part, left, top in zip(laid.parts, lefts, tops, strict=True)
    )


def _abreast(starts: Sequence[float], sizes: Sequence[tuple[float, float]], way: int, one: int, other: int) -> bool:
    """Whether two boxes overlap across (0) or upwards (1), so that neither may pass the other."""
    return (
        starts[one] < starts[other] + sizes[other][way] - DUST and starts[other] < starts[one] + sizes[one][way] - DUST
    )
