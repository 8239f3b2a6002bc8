"""Equilibrium of one Assur group: the reactions in its joints under the loads on its links, at all positions at once.

Every joint transmits two unknowns: the two components of a force in a revolute joint, the force across the guide and a
couple in a prismatic one. Three equations for each link find them: six for the two links and three joints of a group of
class II, twelve for the four links and six joints of a group of class III.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from reportgen.base.arrays import Complexes, Flags, Floats
from reportgen.base.records import Record
from reportgen.machine import Dyad, Group, Joint, Triad
from reportgen.machine.kinematics import Motion
from reportgen.machine.rigid_motion import cross

NO_FORCE = 1e-12
"""A force across a guide below this share of the group's largest force counts as a rounding error."""


class Wrench(NamedTuple):
    """A force (N) [N] at a point (m) with a couple (N·m)."""

    force: Complexes
    point: Complexes
    couple: Floats | float

    def moment(self, about: Complexes) -> Floats:
        """Return the moment about a point (N·m) [N]."""
        return cross(self.point - about, self.force) + self.couple


Carried = Mapping[int, Sequence[Wrench]]
"""The loads on each link."""


def equilibrium_of(group: Group, own: tuple[Joint, ...], motion: Motion) -> DyadEquilibrium | TriadEquilibrium:
    """Return the equations of a group with its joints in the order of assembly."""
    return (
        DyadEquilibrium.of(group, own, motion) if isinstance(group, Dyad) else TriadEquilibrium.of(group, own, motion)
    )


def _reach(joints: Iterable[Joint], pole: Complexes, motion: Motion) -> float:
    """Return the length (m) that brings forces and moments about the `pole` to one size.

    The joints may coincide except for rounding errors; then the size of the mechanism replaces their distance.
    """

    def farthest(points: Iterable[str]) -> float:
        apart = (np.abs(motion.points[name].p - pole) for name in points)
        return max(float(np.max(each, initial=0.0, where=motion.reachable)) for each in apart)

    reach, whole = farthest({joint.point for joint in joints}), farthest(motion.points)
    return reach if reach > NO_FORCE * whole else whole or 1.0


# --- groups of class II ---------------------------------------------------------------------------


class _Inner(Record):
    """The inner joint of a dyad, at the `pole` of its moments.

    It divides a wrench in two: the `free` component, which it cannot transmit, and the two components that it holds,
    as a complex number. A revolute joint lets the moment about it through and holds the force; a slide lets the force
    along the guide's unit `direction` through.  The length (m) brings forces and moments to one size.
    """

    pole: Complexes
    length: float
    direction: Complexes | None

    def divided(self, force: Complexes, moment: Floats) -> tuple[Floats, Complexes]:
        """Return the free component of a force (N) [N] with its moment about the pole (N·m) [N], and the held ones."""
        if self.direction is None:
            return moment / self.length, force
        turned = force * self.direction.conj()
        return turned.real, turned.imag + 1j * (moment / self.length)


class _Outer(Record):
    """An outer joint of a dyad, whose two unknowns x and y are one complex number x + iy [N].

    In a revolute joint it is the force (N); in a guide, x is the force across it (N) and y·l the couple (N·m).
    The free component of the inner joint is x Re z + y Im z. So z/|z|² gives it the size 1, and `across` = iz/|z| gives
    it nothing.
    """

    joint: Joint
    at: Complexes
    direction: Complexes | None
    """The unit vector along the guide [N]; None for a revolute joint."""
    length: float
    unit: Complexes
    across: Complexes

    def wrench(self, unknowns: Complexes) -> Wrench:
        """Return the wrench on the joint's second link."""
        if self.direction is None:
            return Wrench(unknowns, self.at, 0.0)
        return Wrench(1j * self.direction * unknowns.real, self.at, self.length * unknowns.imag)

    @classmethod
    def of(cls, joint: Joint, inner: _Inner, motion: Motion) -> _Outer:
        at = motion.points[joint.point].p
        direction = None if joint.kind == "R" else motion.slides[joint.links].direction
        arm, still = at - inner.pole, np.zeros_like(at)
        units: tuple[tuple[Complexes, Floats], tuple[Complexes, Floats]]
        if direction is None:
            units = (still + 1, -arm.imag), (still + 1j, arm.real)
        else:
            across = 1j * direction
            units = (across, cross(arm, across)), (still, np.full(at.shape, inner.length))
        first, second = (inner.divided(force, moment)[0] for force, moment in units)
        z = first + 1j * second
        with np.errstate(divide="ignore", invalid="ignore"):
            size = np.abs(np.where(motion.reachable, z, np.nan))
            return cls(joint, at, direction, inner.length, z / size**2, 1j * z / size)


class DyadEquilibrium(Record):
    """The equations of a group of class II of any kind.

    The component that the inner joint lets through gives one unknown of each outer joint from the loads on its link.
    The other unknowns x and y keep the whole group in equilibrium: x u + y w = −r, with the components that the inner
    joint holds. Then the inner joint balances the first link.
    """

    links: tuple[int, int]
    joints: tuple[Joint, ...]
    inner: _Inner
    outer: tuple[_Outer, _Outer]
    held: tuple[Complexes, Complexes]
    """Components that the inner joint holds, of the first unknowns that give the free one the size 1 [N]."""
    along: tuple[Complexes, Complexes]
    """Those of the other unknowns: u and w [N]."""

    @classmethod
    def of(cls, dyad: Dyad, own: tuple[Joint, ...], motion: Motion) -> DyadEquilibrium:
        """Return the equations of a dyad with its joints: start, inner, end."""
        start, middle, end = own
        pole = motion.points[middle.point].p
        direction = None if middle.kind == "R" else motion.slides[middle.links].direction
        inner = _Inner(pole, _reach(own, pole, motion), direction)
        outer = _Outer.of(start, inner, motion), _Outer.of(end, inner, motion)

        def holds(joint: _Outer, unknowns: Complexes) -> Complexes:
            wrench = joint.wrench(unknowns)
            return inner.divided(wrench.force, wrench.moment(pole))[1]

        a, b = outer
        return cls(
            links=dyad.links,
            joints=own,
            inner=inner,
            outer=outer,
            held=(holds(a, a.unit), holds(b, b.unit)),
            along=(holds(a, a.across), holds(b, b.across)),
        )

    def balance(self, carried: Carried) -> list[Wrench]:
        """Return the wrenches of the joints on their second links, for the loads `carried` by the links."""
        pole, (a, b), (u, w) = self.inner.pole, self.outer, self.along
        first, second = (_resultant(carried[link], pole) for link in self.links)
        (free_a, held_a), (free_b, held_b) = self.inner.divided(*first), self.inner.divided(*second)
        rest = free_a * self.held[0] + free_b * self.held[1] - held_a - held_b
        with np.errstate(divide="ignore", invalid="ignore"):
            area = cross(u, w)
            start = a.wrench(cross(rest, w) / area * a.across - free_a * a.unit)
            end = b.wrench(cross(u, rest) / area * b.across - free_b * b.unit)
        force, moment = first[0] + start.force, first[1] + start.moment(pole)
        # What balances the first link acts on it; in a joint from it to the second, the opposite is listed.
        sense = -1.0 if self.joints[1].links[1] == self.links[0] else 1.0
        if self.inner.direction is None:
            return [start, Wrench(sense * force, pole, 0.0), end]
        across = 1j * self.inner.direction
        return [start, Wrench(across * cross(self.inner.direction, sense * force), pole, sense * moment), end]


def _resultant(wrenches: Sequence[Wrench], pole: Complexes) -> tuple[Complexes, Floats]:
    """Return the sum of forces (N) [N] and that of moments about the pole (N·m) [N]."""
    force, moment = np.zeros_like(pole), np.zeros(pole.shape)
    for wrench in wrenches:
        force += wrench.force
        moment += wrench.moment(pole)
    return force, moment


# --- groups of class III --------------------------------------------------------------------------


class TriadEquilibrium(Record):
    """The twelve equations of a group of class III, solved in one batch.

    Rows: ΣF_x, ΣF_y, ΣM/l about the first inner joint, link by link; columns: two unknowns of each joint.  The length l
    only brings forces and moments to one size.
    """

    links: tuple[int, ...]
    joints: tuple[Joint, ...]
    pole: Complexes
    length: float
    reachable: Flags
    columns: tuple[Wrench, ...]
    matrix: Floats
    """Coefficients [N, 12, 12]; the unit matrix where the position is unreachable."""

    @classmethod
    def of(cls, triad: Triad, own: tuple[Joint, ...], motion: Motion) -> TriadEquilibrium:
        """Return the equations of a triad with its joints, all of them revolute."""
        pole, valid = motion.points[triad.legs[0].inner].p, motion.reachable
        size, length = 3 * len(triad.links), _reach(own, pole, motion)
        matrix = np.zeros((size, size, pole.size))
        columns = tuple(column for joint in own for column in _unit_forces(motion.points[joint.point].p))
        for row, link in zip(range(0, size, 3), triad.links, strict=True):
            for column, wrench in enumerate(columns):
                joint = own[column // 2]
                if link in joint.links:
                    sense = 1.0 if link == joint.links[1] else -1.0
                    matrix[row : row + 3, column] = _components(wrench, pole, length, sense)
        matrix[:, :, ~valid] = np.eye(size)[:, :, None]
        return cls(
            links=triad.links,
            joints=own,
            pole=pole,
            length=length,
            reachable=valid,
            columns=columns,
            matrix=np.ascontiguousarray(np.moveaxis(matrix, 2, 0)),
        )

    def balance(self, carried: Carried) -> list[Wrench]:
        """Return the wrenches of the joints on their second links, for the loads `carried` by the links."""
        size = 3 * len(self.links)
        known = np.zeros((size, self.pole.size))
        for row, link in zip(range(0, size, 3), self.links, strict=True):
            for wrench in carried[link]:
                known[row : row + 3] += _components(wrench, self.pole, self.length, -1.0)
        known[:, ~self.reachable] = np.nan
        shares = np.linalg.solve(self.matrix, known.T[:, :, None])[:, :, 0].T
        return [
            Wrench(first.force * shares[2 * k] + second.force * shares[2 * k + 1], first.point, 0.0)
            for k, (first, second) in enumerate(zip(self.columns[::2], self.columns[1::2], strict=True))
        ]


def _unit_forces(at: Complexes) -> tuple[Wrench, Wrench]:
    """Return the two unit forces that a revolute joint can transmit."""
    still = np.zeros_like(at)
    return Wrench(still + 1, at, 0.0), Wrench(still + 1j, at, 0.0)


def _components(wrench: Wrench, pole: Complexes, length: float, sense: float) -> Floats:
    """Return ΣF_x, ΣF_y and ΣM/l of one wrench, [3, N]."""
    force = sense * wrench.force
    return np.array((force.real, force.imag, sense * wrench.moment(pole) / length))
