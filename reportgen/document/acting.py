"""Figures of forces: separated links, the driver, Zhukovsky's lever."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from reportgen.document.facts import BodyView
from reportgen.document.pictured import (
    HALF,
    MM,
    Drawn,
    Pictured,
    beside_one_another,
    on_paper,
)
from reportgen.document.views import GroupView
from reportgen.figures.draft import Draft
from reportgen.figures.forces import ArmOf, Couple, Force, bodies, lever
from reportgen.figures.labels import label
from reportgen.figures.scene import Circle, Item, Line, Scene
from reportgen.figures.scheme import Looks
from reportgen.figures.style import CONSTRUCTION, PAPER, VISIBLE
from reportgen.ledger.forces.polygon import Polygon
from reportgen.mechanism.loads import Load, as_single_force, percussion_meeting
from reportgen.mechanism.structure import DRIVER
from reportgen.notation import symbols
from reportgen.notation.expressions import Chain, Symbol


class ForcePictures(Pictured):
    """What acts on the links at a worked position."""

    @property
    def figures(self) -> dict[str, Callable[..., Drawn]]:
        return {
            "bodies": self.bodies,
            "lever": self.lever,
        }

    def bodies(self, k: int, group: GroupView) -> Drawn:
        """The group with all its forces, at half size; then each link that moments are taken of, with the arms."""
        names = self.words["figure"]
        half = self.scale * HALF
        whole = self._bodies(
            k,
            half,
            (group.i, group.j),
            [
                *self._loads((group.i, group.j), k, half),
                *self._carried(group.polygon, (group.i, group.j), k, half),
                *self._outer(group, group.i, k, half),
                *self._outer(group, group.j, k, half),
            ],
            turning=self._couples((group.i, group.j), k, half),
            looks=self._bare_looks(HALF),
            title=names["group"].format(i=group.i, j=group.j),
        )
        return beside_one_another(
            whole, *(self._alone(k, group, link, pin) for link, pin in _moments_of(group))
        )

    def _alone(self, k: int, group: GroupView, link: int, pin: str) -> Scene:
        """One link of a group with all that acts on it and the arms about a pin."""
        scale = self.scale
        about = complex(self.analysis.motion.points[pin].p[k - 1]) * scale
        return self._bodies(
            k,
            scale,
            (link,),
            [
                *self._loads((link,), k, scale),
                *self._carried(group.polygon, (link,), k, scale),
                *self._outer(group, link, k, scale),
                self._inner(group, link, k, scale),
            ],
            arms=[
                ArmOf(self.ledger.symbol(id), about, id.split(".")[1])
                for id in self.facts.arm_ids(group, pin, link)
                if not self.facts.zero(id, k)
            ],
            turning=self._couples((link,), k, scale),
            extra=self._percussion(link, k),
            looks=self._bare_looks(1.0),
            title=f"{self.words['figure']['link']} {link}",
        )

    def _bodies(
        self, k: int, scale: float, links: Sequence[int], acting: Sequence[Force], **more: Any
    ) -> Scene:
        return bodies(
            self.analysis.machine.linkage, self.analysis.motion, k - 1, scale, links, acting, **more
        )

    def _bare_looks(self, factor: float) -> Looks:
        return self.looks(self.scale * factor, factor)

    def _outer(self, group: GroupView, link: int, k: int, scale: float) -> list[Force]:
        """The reaction in the outer joint of a group's link, by components where moments gave one of them."""
        first = link == group.i
        digits = group.outer if first else group.guide
        pin = group.P if first else group.T or group.Q
        parts = (".t", ".n") if f"R.{digits}.t" in self.ledger else ("",)
        return [self._reaction(f"R{digits}{part}", f"R.{digits}{part}", pin, k, scale) for part in parts]

    def _inner(self, group: GroupView, link: int, k: int, scale: float) -> Force:
        """The reaction in the inner joint on one link of the group, as it is read from the plan."""
        read = self._reaction(f"R{group.inner}", f"R.{group.inner}", group.Q, k, scale)
        if link == group.i:
            return read
        name = f"R{group.across}"
        return Force(Symbol("R", group.across, over="vector"), read.at, -read.direction, "reaction", name)

    def _carried(self, polygon: Polygon | None, links: Sequence[int], k: int, scale: float) -> list[Force]:
        """Reactions of other groups, found before, on some links of a force plan."""
        assert polygon is not None
        result = []
        for side in polygon.sides:
            if side.unknown or side.link not in links or side.name.endswith(".t") or side.name[0] != "R":
                continue
            at = complex(self.analysis.forces.reactions[side.name].point[k - 1]) * scale
            known = np.isfinite(at) and not self.facts.zero(f"R.{side.name[1:]}", k)
            direction = complex(self.ledger[f"F.{side.name}"].at(k)) if known else 0j
            symbol = symbols.vector(self.ledger.symbol(f"R.{side.name[1:]}"))
            result.append(Force(symbol, at if known else 0j, direction, "reaction", side.name))
        return result

    def crank(self, k: int) -> Scene:
        """The driver with the reactions on it and their arms about its centre."""
        motion, scale = self.analysis.motion, self.scale
        centre = self.facts.driver.centre
        about = complex(motion.points[centre].p[k - 1]) * scale
        acting = self._loads((DRIVER,), k, scale)
        acting += self._carried(self.facts.driver_polygon, (DRIVER,), k, scale)
        acting.append(self._reaction("R01", "R.01", centre, k, scale))
        arms = [
            ArmOf(self.ledger.symbol(id), about, id.split(".")[1])
            for id in self.facts.crank_lines[:-1]
            if not self.facts.zero(id, k)
        ]
        turning = (
            Couple(self.ledger.symbol("M.eq"), about, float(np.sign(self.ledger.number("M.eq", k).value))),
        )
        return self._bodies(
            k, scale, (DRIVER,), acting, arms=arms, turning=turning, looks=self.looks(scale)
        )

    def slider(self, k: int) -> Scene:
        """A sliding driver with the reactions on it and the force that balances it."""
        scale, pin = self.scale, self.facts.driver.pin
        acting = self._loads((DRIVER,), k, scale)
        acting += self._carried(self.facts.driver_polygon, (DRIVER,), k, scale)
        acting += [self._reaction(f"R{digits}", f"R.{digits}", pin, k, scale) for digits in ("01", "cb")]
        return self._bodies(k, scale, (DRIVER,), acting, looks=self.looks(scale))

    def _reaction(self, name: str, id: str, place: str, k: int, scale: float) -> Force:
        at = complex(self.analysis.motion.points[place].p[k - 1]) * scale
        symbol = symbols.vector(self.ledger.symbol(id))
        direction = 0j if self.facts.zero(id, k) else complex(self.ledger[f"F.{name}"].at(k))
        return Force(symbol, at, direction, "reaction", name)

    def _loads(self, links: Sequence[int], k: int, scale: float) -> list[Force]:
        """Loads on links; a force with a couple acts at the one point where it alone does both."""
        result = []
        for load in self.analysis.loads:
            if load.link not in links or not self._has_force(load, k):
                continue
            symbol = symbols.vector(self.ledger.symbol(load.name))
            at, force = self._acts_at(load, k) * scale, complex(load.force[k - 1])
            result.append(Force(symbol, at, force, "load", load.name))
        return result

    def _acts_at(self, load: Load, k: int) -> complex:
        """Where a load is drawn: an inertia force at the constructed point Q, else where it acts alone."""
        for body in self.facts.couples:
            if load.name == f"Pqt{body.link}" and (points := self._percussion_points(body, k)):
                return points[1]
        single = complex(as_single_force(load)[k - 1])
        return single if np.isfinite(single) else complex(load.point[k - 1])

    def _percussion_points(self, body: BodyView, k: int) -> tuple[complex, complex] | None:
        """The centre of percussion K and the point Q (m); None where their lines do not meet near the link."""
        start, centre = (self.analysis.motion.points[name] for name in (body.start, body.centre))
        l_sk = float(self.ledger.families[body.ids[-1]].values[0])
        s, a = complex(centre.p[k - 1]), complex(start.p[k - 1])
        q = complex(percussion_meeting(start.p, centre.p, start.a, centre.a, l_sk)[k - 1])
        near = abs(s - a) + 2 * l_sk
        return (s + (s - a) / abs(s - a) * l_sk, q) if np.isfinite(q) and abs(q - s) < near else None

    def _percussion(self, link: int, k: int) -> Draft:
        """K on a link, and the two lines of construction that meet in Q."""
        body = next((body for body in self.facts.couples if body.link == link), None)
        points = body and self._percussion_points(body, k)
        if not body or not points or self.facts.zero(f"M.Pqt{body.link}", k):
            return Draft()
        known, meeting = (point * self.scale for point in points)
        centre = complex(self.analysis.motion.points[body.centre].p[k - 1]) * self.scale
        marks: tuple[Item, ...] = (
            Line(centre, meeting, CONSTRUCTION),
            Line(known, meeting, CONSTRUCTION),
            Circle(known, 0.6, VISIBLE, PAPER),
            Circle(meeting, 0.6, VISIBLE, PAPER),
        )
        number = str(link)
        return Draft(
            marks, (label(known, Symbol("K", number), gap=1.2), label(meeting, Symbol("Q", number), gap=1.2))
        )

    def _couples(self, links: Sequence[int], k: int, scale: float) -> list[Couple]:
        """Torques, and couples whose force is nothing."""
        result = []
        for load in self.analysis.loads:
            if load.link not in links or load.couple[k - 1] == 0:
                continue
            torque = load.name in self._torques
            if torque or self.facts.zero(load.name, k):
                symbol = self.ledger.symbol(load.name if torque else f"M.{load.name}")
                at = complex(load.point[k - 1]) * scale
                result.append(Couple(symbol, at, float(load.couple[k - 1])))
        return result

    @property
    def _torques(self) -> frozenset[str]:
        """Loads that have no force by their nature."""
        return frozenset(torque.name for torque in self.analysis.machine.torques)

    def _has_force(self, load: Load, k: int) -> bool:
        return (
            load.name in self.ledger and load.name not in self._torques and not self.facts.zero(load.name, k)
        )

    def lever(self, k: int) -> Drawn:
        """The velocity plan turned by 90° against ω1, every load at its image, arms about the pole."""
        motion, index = self.analysis.motion, k - 1
        turn = self.analysis.machine.turn
        per = -1j * turn * MM / float(self.ledger.families["mu.v"].values[0])
        acting, arms = [], []
        for load in self.analysis.loads:
            if not self._has_force(load, k):
                continue
            at = np.full(motion.driver.shape, self._acts_at(load, k))
            image = complex(motion.of(load.link, at).v[index]) * per
            symbol = symbols.vector(self.ledger.symbol(load.name))
            acting.append(Force(symbol, image, complex(load.force[index]), "load", load.name))
            if not self.facts.zero(f"h.{load.name}.p", k):
                arms.append(ArmOf(self.ledger.symbol(f"h.{load.name}.p"), 0j, load.name))
        if self.analysis.machine.span and not self.facts.zero("R.cb", k):
            # The force that balances a sliding driver acts on the lever too; that of a crank is a torque.
            image = complex(motion.points[self.facts.driver.pin].v[index]) * per
            symbol = symbols.vector(self.ledger.symbol("M.eq"))
            acting.append(Force(symbol, image, complex(self.ledger["F.Rcb"].at(k)), "reaction", "Rcb"))
            arms.append(ArmOf(self.ledger.symbol(f"seg.v.p{self.facts.driver.image}"), 0j, "Rcb"))
        drawing = self.velocity_plan(k)
        scale = Chain((self.ledger.symbol("mu.v"), self.ledger.number("mu.v")))
        return on_paper(lever(drawing, acting, arms, sense=-turn, notes=(scale,)))


def _moments_of(group: GroupView) -> tuple[tuple[int, str], ...]:
    """The links of a group that the force analysis takes moments of, with the pin it takes them about."""
    if group.kind == "RRR":
        return (group.i, group.Q), (group.j, group.Q)
    if group.kind == "RPR":
        return ((group.j, group.T),)
    return ((group.i, group.Q),) if group.kind == "RRP" else ()
