"""Bodies moved on by a finite small time, by the geometry of their joints alone.

An exercise of plane motion is read from its YAML as plain data; each body has a pose, a shift and an angle, and each
joint says what of the poses does not change: nothing here comes from the package.  The poses at small times are found
by Newton's method, and rates are differences of them.
"""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import yaml

UNITS = {
    "mm": 1e-3, "cm": 1e-2, "m": 1.0, "deg": math.pi / 180, "s": 1.0, "rpm": math.pi / 30,
    "cm/s": 1e-2, "mm/s2": 1e-3, "m/s": 1.0, "m/s2": 1.0, "rad/s": 1.0, "rad/s2": 1.0,
}  # fmt: skip
Poses = Mapping[int, tuple[complex, float]]
Residual = Callable[[Poses, float], list[float]]


def si(text: str) -> float:
    number, unit = text.split()
    return float(number) * UNITS[unit]


def with_numbers(content: Any, symbols: Mapping[str, float]) -> Any:
    """What is stated by symbols with their values, all of them SI, put in."""
    if isinstance(content, list):
        return [with_numbers(one, symbols) for one in content]
    names = re.findall(r"[A-Za-z]+[0-9]*", content)
    if not names or not {*names} <= {*symbols, "sqrt"}:
        return content
    return f"{eval(content, {'sqrt': math.sqrt}, dict(symbols))!r} m"


def _put_in(content: Any, symbols: Mapping[str, float], keys: tuple[str, ...]) -> Any:
    if isinstance(content, dict):
        return {
            key: with_numbers(one, symbols) if key in keys else _put_in(one, symbols, keys)
            for key, one in content.items()
        }
    return [_put_in(one, symbols, keys) for one in content] if isinstance(content, list) else content


def dot(a: complex, b: complex) -> float:
    return (a.conjugate() * b).real


class Displaced:
    """An exercise with the poses of its bodies over time."""

    def __init__(self, path: Path) -> None:
        # Every value stays text: to YAML itself the key `on` would be a truth value.
        given = yaml.load(path.read_text(encoding="utf-8"), yaml.BaseLoader)["parameters"]
        told = given.get("symbols", {}).items()
        symbols = {name: si(one["drawn"] if isinstance(one, dict) else one) for name, one in told}
        stated = ("at", "distance", "radius", "value", "size", "acceleration")
        for section in ("points", "bodies", "given"):
            given[section] = _put_in(given[section], symbols, stated)
        self.points: dict[str, complex] = {}
        for name, point in given["points"].items():
            self.points[name] = self._place(point)
        self.bodies: dict[int, Any] = {int(number): body for number, body in given["bodies"].items()}
        self.moving = [number for number in self.bodies if number]
        self.accelerated = False
        self.residuals: list[Residual] = [self._joint(joint) for joint in given.get("joints", ())]
        self.residuals += self._drives(given["given"])
        self._known: dict[float, Poses] = {0.0: dict.fromkeys((0, *self.moving), (0j, 0.0))}

    def _place(self, point: dict[str, Any]) -> complex:
        if "at" in point:
            return complex(*map(si, point["at"]))
        if "from" in point:
            return self.points[point["from"]] + si(point["distance"]) * cmath.exp(1j * si(point["angle"]))
        (p, u), (q, w) = ((self.points[one["through"]], cmath.exp(1j * si(one["angle"]))) for one in point["lines"])
        shares = np.linalg.solve([[u.real, -w.real], [u.imag, -w.imag]], [(q - p).real, (q - p).imag])
        return p + u * shares[0]

    def owner(self, point: str) -> int:
        disc = {number: body.get("disc", {}).get("centre") for number, body in self.bodies.items()}
        return next((n for n in self.moving if point in self.bodies[n].get("points", ()) or disc[n] == point), 0)

    def at(self, poses: Poses, body: int, place: complex) -> complex:
        shift, angle = poses[body]
        return shift + cmath.exp(1j * angle) * place

    # --- what does not change

    def _line(self, joint: dict[str, Any]) -> complex:
        if "angle" in joint:
            return cmath.exp(1j * si(joint["angle"]))
        one, other = (self.points[name] for name in joint["along"])
        return (other - one) / abs(other - one)

    def _disc(self, body: int) -> tuple[complex, float]:
        disc = self.bodies[body]["disc"]
        return self.points[disc["centre"]], si(disc["radius"])

    def _joint(self, joint: dict[str, Any]) -> Residual:
        kind, on = joint["type"], int(joint.get("on", 0))
        if kind == "pin":
            (i, j), p = map(int, joint["bodies"]), self.points[joint["at"]]

            def pin(poses: Poses, _: float) -> list[float]:
                gap = self.at(poses, i, p) - self.at(poses, j, p)
                return [gap.real, gap.imag]

            return pin
        if kind in ("slot", "slider"):
            body, u = int(joint["body"]), self._line(joint)
            p = self.points[joint["point"] if kind == "slot" else self.bodies[body]["points"][0]]

            def slot(poses: Poses, _: float) -> list[float]:
                way = self.at(poses, body, p) - self.at(poses, on, p)
                off = [dot(1j * u * cmath.exp(1j * poses[on][1]), way)]
                return off if kind == "slot" else [*off, poses[body][1] - poses[on][1]]

            return slot
        if kind == "rolling on line":
            return self._on_line(int(joint["disc"]), on, self.points[joint["through"]], self._line(joint))
        return self._on_circle(*map(int, joint["discs"]), stays=kind == "rolling on circle")

    def _on_line(self, body: int, on: int, q: complex, u: complex) -> Residual:
        centre, radius = self._disc(body)
        side = math.copysign(1.0, dot(1j * u, centre - q))

        def roll(poses: Poses, _: float) -> list[float]:
            turned = u * cmath.exp(1j * poses[on][1])
            way = self.at(poses, body, centre) - self.at(poses, on, q)
            gone = dot(turned, way) - dot(u, centre - q)
            return [dot(1j * turned, way) - side * radius, gone + side * radius * (poses[body][1] - poses[on][1])]

        return roll

    def _on_circle(self, one: int, other: int, stays: bool) -> Residual:
        (a, first), (b, second) = self._disc(one), self._disc(other)
        outside = abs(abs(a - b) - first - second) < 1e-9

        def roll(poses: Poses, _: float) -> list[float]:
            way = self.at(poses, one, a) - self.at(poses, other, b)
            swung = cmath.phase(way / (a - b))
            arc, arc_of_other = first * (swung - poses[one][1]), second * (swung - poses[other][1])
            rolled = [arc_of_other + arc if outside else arc_of_other - arc]
            return [*rolled, abs(way) - abs(a - b)] if stays else rolled

        return roll

    def _drives(self, given: list[dict[str, Any]]) -> list[Residual]:
        """Angles and ways that grow with time as is given; of a point also across the line where it goes."""
        rates: dict[tuple[str, object], list[float]] = {}
        ways: dict[str, complex] = {}
        for one in given:
            if one["type"] in ("omega", "epsilon"):
                rate = rates.setdefault(("turn", int(one["body"])), [0.0, 0.0])
                rate[one["type"] == "epsilon"] = si(one["value"])
                self.accelerated |= one["type"] == "epsilon"
                continue
            rate = rates.setdefault(("way", one["point"]), [0.0, 0.0])
            ways[one["point"]] = cmath.exp(1j * si(one["direction"]))
            if one["type"] == "from rest":
                rate[:] = si(one["acceleration"]) * si(one["time"]), si(one["acceleration"])
            else:
                rate[one["type"] == "acceleration"] = si(one["size"])
            self.accelerated |= one["type"] != "velocity"
        return [self._drive(what, of, rate, ways) for (what, of), rate in rates.items()]

    def _drive(self, what: str, of: Any, rate: list[float], ways: dict[str, complex]) -> Residual:
        def drive(poses: Poses, time: float) -> list[float]:
            gone = rate[0] * time + rate[1] * time**2 / 2
            if what == "turn":
                return [poses[of][1] - gone]
            place = self.points[of]
            return [dot(ways[of], self.at(poses, self.owner(of), place) - place) - gone]

        return drive

    # --- where the bodies are, and how fast that changes

    def poses(self, time: float) -> Poses:
        """The poses after a small time, by Newton's method from those at the instant."""
        if time in self._known:
            return self._known[time]
        unknowns = np.zeros(3 * len(self.moving))

        def unpacked(x: np.ndarray) -> Poses:
            moving = {n: (complex(x[3 * k], x[3 * k + 1]), float(x[3 * k + 2])) for k, n in enumerate(self.moving)}
            return {0: (0j, 0.0), **moving}

        def off(x: np.ndarray) -> np.ndarray:
            poses = unpacked(x)
            return np.array([value for residual in self.residuals for value in residual(poses, time)])

        for _ in range(8):
            here, step = off(unknowns), 1e-6
            slopes = np.array(
                [
                    (off(unknowns + step * one) - off(unknowns - step * one)) / (2 * step)
                    for one in np.eye(len(unknowns))
                ]
            )
            change = np.linalg.lstsq(slopes.T, -here, rcond=1e-9)[0]
            unknowns = unknowns + change
        assert np.abs(off(unknowns)).max() < 1e-13, "the bodies cannot move on so"
        self._known[time] = unpacked(unknowns)
        return self._known[time]

    def rates(self, of: Callable[[Poses], complex], step: float) -> tuple[complex, complex]:
        """First and second derivative over time, from five positions."""
        m2, m1, z, p1, p2 = (of(self.poses(k * step)) for k in (-2, -1, 0, 1, 2))
        first = (8 * (p1 - m1) - (p2 - m2)) / (12 * step)
        return first, (16 * (p1 + m1) - (p2 + m2) - 30 * z) / (12 * step**2)

    def point(self, name: str, step: float) -> tuple[complex, complex]:
        """Velocity and acceleration of a point, as it moves with the first body that carries it."""
        return self.rates(lambda poses: self.at(poses, self.owner(name), self.points[name]), step)

    def turn(self, body: int, step: float) -> tuple[float, float]:
        """ω and ε of a body."""
        first, second = self.rates(lambda poses: complex(poses[body][1]), step)
        return first.real, second.real
