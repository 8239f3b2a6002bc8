"""Model of the file of a friction exercise: the data of each of the small mechanisms."""

from __future__ import annotations

from typing import Annotated, Any

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Coordinate, Decimal, Interval, Length, Offset, Quantity, Reader, Whole, quantity
from reportgen.base.units import Given

TASKS = ("incline", "wedge", "screw", "belt", "band", "shoe")
HORIZONTAL = "horizontal"
TOWARDS = quantity("deg", least=-89, most=89, tiny=1e-6)


class Towards(Reader):
    """The angle of a force from the plane, or `horizontal` (None)."""

    given: Quantity = TOWARDS

    def read(self, value: object) -> Given | None:
        return None if value == HORIZONTAL else self.given.read(value)

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [{"const": HORIZONTAL}, self.given.schema()]}


NONE = Given(0.0, 0.0, "deg", "0 deg")
Load = Annotated[Given, quantity("N", least=1e-3, most=1e9)]
Moment = Annotated[Given, quantity("N m", least=1e-3, most=1e9)]
Slope = Annotated[Given, quantity("deg", least=0.1, most=88)]
Wrap = Annotated[Given, quantity("deg", least=1, most=3600)]
FrictionCoefficient = Annotated[float, Decimal(Interval(least=0.001, most=2))]
Smooth = Annotated[float, Decimal(Interval(least=0, most=2))]


class Incline(Part):
    """A body on an inclined plane: its weight, the slope, the coefficient, the angle of the force from the plane."""

    Q: Load
    alpha: Slope
    f: FrictionCoefficient
    beta: Annotated[Given | None, Towards()] = NONE


class Wedge(Part):
    """A wedge under a load in a guide: 1 where both touch, 2 between wedge and base, 3 in the guide of the load."""

    Q: Load
    alpha: Slope
    f1: FrictionCoefficient
    f2: FrictionCoefficient
    f3: Smooth = 0.0


class Collar(Part):
    """The face that bears the load of a screw: its coefficient and its mean diameter."""

    f: FrictionCoefficient
    d: Length


class Screw(Part):
    """A screw under a load: mean diameter, pitch and starts of its thread, half the angle of its profile."""

    Q: Load
    d: Length
    p: Length
    n: Annotated[int, Whole(1, 12)] = 1
    beta: Annotated[Given, quantity("deg", least=0, most=45, tiny=1e-6)] = NONE
    f: FrictionCoefficient
    collar: Collar | None = None


class BeltOnDrum(Part):
    """A belt on a drum: diameter, angle of wrap, coefficient; one of both tensions and the torque; its width."""

    d: Length
    theta: Wrap
    f: FrictionCoefficient
    S1: Load | None = None
    S2: Load | None = None
    M: Moment | None = None
    b: Length | None = None


class Band(Part):
    """A band brake: the torque, drum and band; the arms of the tight and of the slack end, the lever."""

    M: Moment
    d: Length
    theta: Wrap
    f: FrictionCoefficient
    l: Length  # noqa: E741
    a: Coordinate
    b: Coordinate


class Shoe(Part):
    """A brake with one shoe on a lever: the torque, drum, lever, and where its pivot is."""

    M: Moment
    d: Length
    f: FrictionCoefficient
    l: Length  # noqa: E741
    a: Length
    c: Offset


class Parameters(Part):
    """One of the tasks, with its data."""

    incline: Incline | None = None
    wedge: Wedge | None = None
    screw: Screw | None = None
    belt: BeltOnDrum | None = None
    band: Band | None = None
    shoe: Shoe | None = None

    @property
    def task(self) -> str:
        """Name of the given task."""
        return next(task for task in TASKS if getattr(self, task) is not None)
