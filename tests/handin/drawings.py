"""Students' drawings made up: plans of a machine as somebody draws them in a CAD program, and what is what in them.

Shares no code with the reader: corners come of the ledger by their ids, files of ezdxf.
"""

from __future__ import annotations

import cmath
import io
import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import ezdxf
import numpy as np

from reportgen.case import MachineAnalysis
from reportgen.formula import ids

Place = tuple[str, int]
Line = tuple[complex, complex]

SHORTEST = 3.0
"""What is drawn shorter (mm) is not counted: a line of arrowheads and of the reader's own least length."""
HEADED = 5.0
"""A vector that is shorter (mm) has no arrowhead."""
SAME = 0.5
"""Ends nearer than this (mm) are one point to whoever draws."""
NICE = tuple(step * 10.0**power for power in range(-3, 7) for step in (1, 2, 2.5, 4, 5))
RELEASES = ("R12", "R2000", "R2004", "R2007", "R2010", "R2013", "R2018")


@dataclass(frozen=True)
class TruePlan:
    """A plan: corners by name (mm at the report's scale), vectors by the ids of their lengths; what a mm stands for."""

    scale: str
    position: int
    unit: float
    corners: Mapping[str, complex]
    vectors: Mapping[str, tuple[str, str]]

    @property
    def extent(self) -> float:
        points = np.array(list(self.corners.values()))
        return float(max(np.ptp(points.real), np.ptp(points.imag)))


@dataclass
class Truth:
    """What was drawn: the line of each place, places left out, places drawn wrongly with their own line.

    `alike` are for each place those of its plan whose ends lie within half a millimetre of its own: lines that nobody
    tells apart by eye.
    """

    lines: dict[Place, Line] = field(default_factory=dict)
    left_out: set[Place] = field(default_factory=set)
    wrong: dict[Place, Line] = field(default_factory=dict)
    alike: dict[Place, set[Place]] = field(default_factory=dict)
    factors: dict[tuple[str, int], float] = field(default_factory=dict)

    def is_right(self, place: Place, line: Line) -> bool:
        """Whether a line is that of a place, or of one that looks the same."""
        return any(other in self.lines and same_line(line, self.lines[other]) for other in self.alike[place])


@dataclass(frozen=True)
class Manner:
    """How somebody draws: noise (mm), vectors left out and drawn wrongly, letters, clutter, blocks, release."""

    noise: float = 0.3
    left_out: float = 0.05
    wrong: float = 0.0
    letters: bool = False
    clutter: int = 60
    heads: bool = True
    blocks: bool = True
    release: str = "R2010"
    unit: float = 1.0
    """Millimetres of a unit of the drawing."""


def true_plans(case: MachineAnalysis, values: Mapping[str, np.ndarray] | None = None) -> list[TruePlan]:
    """All plans of a machine with three corners or more; `values` (SI) instead of the key's."""
    families = case.ledger.families
    known = values or {id: family.values for id, family in families.items()}
    plans = []
    for what in ("v", "a"):
        vectors = dict(_of_motion(families, what))
        for k in range(case.span.count):
            plans.append(_plan(known, f"mu.{what}", k, vectors))
    for polygon in case.polygons:
        group = polygon.name
        vectors = {
            ids.force_segment(group, edge.name): (f"plan.R{group}.{edge.start}", f"plan.R{group}.{edge.end}")
            for edge in (*polygon.edges, *polygon.reads)
        }
        plans += [_plan(known, f"mu.R{group}", k, vectors) for k in range(len(case.span.labels))]
    return [plan for plan in plans if plan is not None]


def _of_motion(families, what):
    for id in families:
        _, kind, *rest = id.split(".") if id.startswith("seg.") else ("", "")
        if kind != what:
            continue
        if len(rest) == 1:
            names = ids.segment.read(id)
            ends = [corner if corner == "p" else f"plan.{what}.{corner}" for corner in (names["start"], names["end"])]
            yield id, tuple(ends)
        else:
            part, relative = rest
            if part in "nk":
                # From the image of the base on, or from the pole about what stands still.
                points = ids.points(relative)
                base = f"plan.{what}.{points[1].lower()}" if len(points) > 1 else "p"
                yield id, (base if base in families else "p", f"plan.{what}.{part}.{relative}")
            else:
                corner = f"plan.{what}.{'n' if part == 't' else 'k'}.{relative}"
                points = ids.points(relative)
                yield id, (corner, f"plan.{what}.{points[0].lower()}")


def _plan(known, scale, k, vectors):
    def at(id):
        if id == "p":
            return 0j
        values = np.atleast_1d(known[id])
        return 1e3 * complex(values[k if len(values) > 1 else 0])

    if any(id != "p" and id not in known for ends in vectors.values() for id in ends):
        vectors = {id: ends for id, ends in vectors.items() if all(one == "p" or one in known for one in ends)}
    corners = {id: at(id) for ends in vectors.values() for id in ends}
    if not corners or not np.isfinite(list(corners.values())).all():
        return None
    vectors = {id: ends for id, ends in vectors.items() if abs(corners[ends[1]] - corners[ends[0]]) > 0.05}
    apart = []
    for ends in vectors.values():
        for id in ends:
            if all(abs(corners[id] - one) > 0.5 for one in apart):
                apart.append(corners[id])
    mu = np.atleast_1d(known[scale])
    unit = float(mu[k if len(mu) > 1 else 0]) / 1e3
    return TruePlan(scale, k + 1, unit, corners, vectors) if len(apart) > 2 else None


def draw(plans: Sequence[TruePlan], manner: Manner, seed: int) -> tuple[bytes, Truth]:
    """A drawing of some plans, and the truth about it (mm)."""
    rng = random.Random(seed)
    document = ezdxf.new(manner.release)
    document.header["$INSUNITS"] = 4
    model = document.modelspace()
    truth = Truth()
    factors = _factors(plans, rng)
    x, y, high = 0.0, 0.0, 0.0
    for number in rng.sample(range(len(plans)), len(plans)):
        plan, factor = plans[number], factors[number]
        truth.factors[plan.scale, plan.position] = factor
        points = np.array(list(plan.corners.values())) * factor
        low, width, height = complex(points.real.min(), points.imag.min()), np.ptp(points.real), np.ptp(points.imag)
        if x + width > 1200:
            x, y, high = 0.0, y + high + 30, 0.0
        corner = complex(x, y) + complex(rng.uniform(0, 10), rng.uniform(0, 10))
        x, high = x + width + 35, max(high, height)
        _draw_plan(document, model, plan, factor, corner - low, manner, rng, truth, number)
    for _ in range(manner.clutter):
        start = complex(rng.uniform(0, 1200), rng.uniform(0, y + high))
        _line(model, start, start + complex(rng.uniform(-60, 60), rng.uniform(-60, 60)), manner)
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode(document.output_encoding, "dxfreplace"), truth


def _factors(plans, rng):
    own = {what: rng.choice([0.5, 0.6, 0.8, 1, 1.25, 1.5, 2]) for what in ("mu.v", "mu.a")}
    one_scale = rng.random() < 0.5
    largest = {}
    for plan in plans:
        largest[plan.scale] = max(largest.get(plan.scale, 0.0), plan.extent * plan.unit)
    factors = []
    for plan in plans:
        if plan.scale in own:
            factors.append(own[plan.scale])
        else:
            size = largest[plan.scale] if one_scale else plan.extent * plan.unit
            room = 250 if one_scale else rng.choice([120, 150, 180])
            mu = next(nice for nice in NICE if size / nice <= room)
            factors.append(plan.unit / mu)
    return factors


def _draw_plan(document, model, plan, factor, shift, manner, rng, truth, number):
    noise = manner.noise

    def off():
        return complex(rng.uniform(-noise, noise), rng.uniform(-noise, noise))

    space, back = model, lambda z: z
    if manner.blocks and rng.random() < 0.3:
        space, ratio = document.blocks.new(f"PLAN{number}"), rng.choice([1.0, 2.0, 0.5])
        at = complex(rng.uniform(0, 50), rng.uniform(0, 50))
        model.add_blockref(
            f"PLAN{number}",
            (at.real / manner.unit, at.imag / manner.unit),
            dxfattribs={"xscale": ratio, "yscale": ratio},
        )
        back = lambda z: (z - at) / ratio  # noqa: E731
    drawn = {id: (factor * plan.corners[a], factor * plan.corners[b]) for id, (a, b) in plan.vectors.items()}
    for id in drawn:
        near = {other for other in drawn if same_line(drawn[id], drawn[other], SAME)}
        truth.alike[id, plan.position] = {(other, plan.position) for other in near}
    # What has the same ends is one line on paper.
    lines: dict[frozenset, list[str]] = {}
    for id, ends in plan.vectors.items():
        places = [complex(round(plan.corners[end].real, 1), round(plan.corners[end].imag, 1)) for end in ends]
        lines.setdefault(frozenset(places), []).append(id)
    telling = sorted((key for key, names in lines.items() if _length(drawn[names[0]]) >= HEADED), key=str)
    bad = rng.choice(telling) if len(lines) >= 4 and telling and rng.random() < manner.wrong else None
    kind = rng.choice(["length", "reversed", "turned"])
    for key, names in lines.items():
        places = [(id, plan.position) for id in names]
        if key != bad and rng.random() < manner.left_out:
            truth.left_out |= set(places)
            continue
        a, b = (factor * plan.corners[end] + shift for end in plan.vectors[names[0]])
        if key == bad:
            way = b - a
            turns = {
                "length": rng.choice([0.75, 1.3]),
                "reversed": -1,
                "turned": cmath.rect(1, rng.choice([0.25, -0.25])),
            }
            b = a + way * turns[kind]
        a, b = a + off(), b + off()
        for place in places:
            (truth.wrong if key == bad else truth.lines)[place] = (a, b)
        _vector(space, back(a), back(b), manner, rng, abs(back(1) - back(0)))
        if manner.letters:
            _letter(space, back((a + b) / 2), _name(names[0]), manner)
        if manner.clutter and rng.random() < 0.2:
            across = 1j * (b - a) / (abs(b - a) or 1)
            _line(space, back(b - 30 * across), back(b + 30 * across), manner)
    if manner.letters:
        points = np.array([factor * corner + shift for corner in plan.corners.values()])
        group = plan.scale.removeprefix("mu.R")
        title = f"Vị trí {plan.position}" if plan.scale in ("mu.v", "mu.a") else f"Nhóm {group}, vị trí {plan.position}"
        _letter(space, back(complex(points.real.mean(), points.imag.min() - 8)), title, manner, 5.0)
        done = set()
        for id, corner in plan.corners.items():
            letter = "π" if id == "p" and plan.scale == "mu.a" else id.rpartition(".")[2]
            place = complex(round(corner.real), round(corner.imag))
            if place not in done:
                done.add(place)
                _letter(space, back(factor * corner + shift + 1.5 + 1.5j), letter, manner)


def _length(line):
    return abs(line[1] - line[0])


def _name(id):
    """What a student writes beside a vector: R12t, P3, aCBn, or the letters of its ends."""
    _, of, *rest = id.split(".")
    if of in ("v", "a"):
        return rest[0] if len(rest) == 1 else f"a{rest[1]}{rest[0]}"
    return "".join(rest)


def _vector(space, a, b, manner, rng, per):
    """A line with an arrowhead by hand, or a polyline that tapers off."""
    unit = manner.unit
    if manner.heads and rng.random() < 0.3 and space.doc.dxfversion > "AC1009":
        head = b - 3.0 * per * (b - a) / (abs(b - a) or 1)
        corners = [(a, 0, 0), (head, per, 0), (b, 0, 0)]
        space.add_lwpolyline([(z.real / unit, z.imag / unit, s / unit, e / unit) for z, s, e in corners], format="xyse")
        return
    first, second = (a, b) if rng.random() < 0.5 else (b, a)
    if rng.random() < 0.3:
        space.add_polyline2d([(first.real / unit, first.imag / unit), (second.real / unit, second.imag / unit)])
    else:
        _line(space, first, second, manner)
    if manner.heads and abs(b - a) > 4 * per:
        for side in (0.25, -0.25):
            _line(space, b, b - 2.5 * per * cmath.rect(1, cmath.phase(b - a) + side), manner)


def _line(space, a, b, manner):
    unit = manner.unit
    space.add_line((a.real / unit, a.imag / unit), (b.real / unit, b.imag / unit))


def _letter(space, at, text, manner, height=3.0):
    entity = space.add_text(text, height=height / manner.unit)
    entity.dxf.insert = (at.real / manner.unit, at.imag / manner.unit)


def at(point) -> complex:
    """A point of ezdxf in the plane."""
    return complex(point.x, point.y)


def same_line(first: Line, second: Line, within: float = 1e-3) -> bool:
    """Whether two lines have the same ends, whichever comes first."""
    (a, b), (c, d) = first, second
    return min(max(abs(a - c), abs(b - d)), max(abs(a - d), abs(b - c))) < within


def seen(truth: Truth, places: Mapping[Place, Line]) -> set[Place]:
    """The places with a line long enough to be seen."""
    return {place for place, (a, b) in places.items() if abs(b - a) >= SHORTEST}
