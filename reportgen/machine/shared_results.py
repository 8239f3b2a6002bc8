"""Results that one topic of a machine provides and others use, such as the torque that friction takes from the crank.

A topic that provides results names them in its module `physics`. Other topics ask for a result by its name and need
not know which topic provides it; if no topic does, they get None.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Generic, TypeVar, cast

from reportgen.base.records import Record
from reportgen.base.topics import HookModule

if TYPE_CHECKING:
    from reportgen.machine.analysis import Machine
    from reportgen.machine.cycle_torque import CycleTorque
    from reportgen.machine.regulated_cycle import RegulatedCycle
    from reportgen.machine.slider_faces import Faces

Result = TypeVar("Result", covariant=True)


class SharedResult(Record, Generic[Result]):
    """A result by its name."""

    name: str

    def of(self, machine: Machine) -> Result | None:
        """Return the result for a machine; None if no topic of the machine provides it."""
        if self.name not in machine.results:
            machine.results[self.name] = self._computed(machine)
        return cast("Result | None", machine.results[self.name])

    def _computed(self, machine: Machine) -> object:
        for hooks in PHYSICS.among(machine.topics):
            for provision in hooks.provides:
                if provision.result.name == self.name:
                    return provision.compute(machine)
        return None


class Provision(Record, Generic[Result]):
    """A result that a topic provides, and the function that computes it for a machine."""

    result: SharedResult[Result]
    compute: Callable[[Machine], Result | None]


class PhysicsHooks(Record):
    """The results that a topic provides."""

    provides: tuple[Provision[object], ...] = ()


PHYSICS = HookModule("physics", PhysicsHooks)

LOST_TORQUE: SharedResult[CycleTorque] = SharedResult("torque lost in the joints")
"""The torque that friction takes from the driver over the cycle."""
FACES: SharedResult[Mapping[int, Faces]] = SharedResult("faces of sliders")
"""Faces along which wide sliders touch their guides, by their links."""
REGULATED_CYCLE: SharedResult[RegulatedCycle] = SharedResult("regulated cycle")
"""The cycle whose speed a further moment of inertia keeps within bounds."""
