"""The `parameters` of a `plane-motion` file: points, bodies, joints, given quantities at one instant, and questions."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

from pydantic import Field, TypeAdapter, ValidationError, model_validator

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Angle, Flag, Reader, Whole, fault, quantity
from reportgen.base.records import Record
from reportgen.base.units import Given
from reportgen.catalogue.declared_loads import Name
from reportgen.catalogue.linkage_file import MOST_NAMES
from reportgen.exercise.literal_symbols import MOST_SYMBOLS, Substitution, SymbolName, SymbolValue, Told, stated

LAST_BODY = 40
_ASKED = re.compile(r"(?P<what>v|a|omega|eps|centre)\.(?P<of>[A-Z][0-9]{0,2}|[0-9]{1,2})")

Number = Annotated[int, Whole(1, LAST_BODY)]
NumberOrGround = Annotated[int, Whole(0, LAST_BODY)]
Bodies = Annotated[tuple[NumberOrGround, ...], Field(min_length=2, max_length=2)]
TwoNames = Annotated[tuple[Name, ...], Field(min_length=2, max_length=2)]
ExerciseLength = Annotated[Given, Told(quantity("mm", least=0.1, below=1e5))]
ExerciseCoordinate = Annotated[Given, Told(quantity("mm", above=-1e5, below=1e5, tiny=1e-4))]
ExercisePoint = Annotated[tuple[ExerciseCoordinate, ...], Field(min_length=2, max_length=2)]
ExerciseSpeed = Annotated[Given, Told(quantity("m/s", least=-1e4, most=1e4, tiny=1e-9))]
ExerciseAcceleration = Annotated[Given, Told(quantity("m/s2", least=-1e6, most=1e6, tiny=1e-9))]
Omega = Annotated[Given, Told(quantity("rad/s", least=-1e5, most=1e5, tiny=1e-9))]
Epsilon = Annotated[Given, Told(quantity("rad/s2", least=-1e7, most=1e7, tiny=1e-9))]
STATED = frozenset({"at", "distance", "radius", "size", "value", "acceleration"})
"""Keys whose values may contain symbols."""
Time = Annotated[Given, quantity("s", above=0, most=1e5, tiny=1e-6)]


# --- points and bodies ----------------------------------------------------------------------------


class Through(Part):
    """A straight line through a point that is placed already, at an angle from +x."""

    through: Name
    angle: Angle


class Away(Part):
    """A distance from a point that is placed already."""

    from_: Name = Field(alias="from")
    distance: ExerciseLength


class PointAt(Part):
    """Position of a point: coordinates, a distance and an angle from another point, or the intersection of two lines.

    With `on` instead of the angle, the point lies on a line at that distance, at its far or near end; with `distances`,
    it has two distances from two points, left or right of the direction from the first to the second.
    """

    at: ExercisePoint | None = None
    from_: Name | None = Field(default=None, alias="from")
    distance: ExerciseLength | None = None
    angle: Angle | None = None
    on: Through | None = None
    end: Literal["far", "near"] = "far"
    distances: Annotated[tuple[Away, ...] | None, Field(min_length=2, max_length=2)] = None
    side: Literal["left", "right"] = "left"
    lines: Annotated[tuple[Through, ...] | None, Field(min_length=2, max_length=2)] = None


class Disc(Part):
    """A disc, a wheel or a gear's pitch circle."""

    centre: Name
    radius: ExerciseLength


class BodyOf(Part):
    """The points that move with a body, and its disc if it is a disc."""

    points: Annotated[tuple[Name, ...], Field(max_length=MOST_NAMES)] = ()
    disc: Disc | None = None

    @property
    def carried(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys((*self.points, *((self.disc.centre,) if self.disc else ()))))


# Messages call a joint or a given quantity by its `called`.


# --- joints ---------------------------------------------------------------------------------------


class Pin(Part):
    """Two bodies that turn about a common point; body 0 is the ground."""

    type: Literal["pin"]
    at: Name
    bodies: Bodies

    @property
    def called(self) -> tuple[object, ...]:
        return ("pin", self.at)


class Directed(Part):
    """A direction: an angle from +x, or along the line of two points."""

    angle: Angle | None = None
    along: TwoNames | None = None


class SlotJoint(Directed):
    """A point of a body that moves along a straight line of another body or of the ground; the body may rotate."""

    type: Literal["slot"]
    point: Name
    body: Number
    on: NumberOrGround = 0

    @property
    def called(self) -> tuple[object, ...]:
        return ("slot", self.point)


class Slider(Directed):
    """A body that moves along a straight guide of another body or of the ground without rotating relative to it."""

    type: Literal["slider"]
    body: Number
    on: NumberOrGround = 0

    @property
    def called(self) -> tuple[object, ...]:
        return ("slider", self.body)


class Translation(Part):
    """A body that does not turn."""

    type: Literal["translation"]
    body: Number

    @property
    def called(self) -> tuple[object, ...]:
        return ("translation", self.body)


class RollingOnLine(Directed):
    """A disc that rolls without slip on a straight line through a point, of another body or of the ground."""

    type: Literal["rolling on line"]
    disc: Number
    on: NumberOrGround = 0
    through: Name

    @property
    def called(self) -> tuple[object, ...]:
        return ("disc", self.disc)


class RollingOnCircle(Part):
    """Two discs that roll on each other without slip, externally or internally, and stay in contact."""

    type: Literal["rolling on circle"]
    discs: Bodies

    @property
    def called(self) -> tuple[object, ...]:
        return ("discs", *self.discs)


class Gears(Part):
    """Two discs that roll on each other without slip, whose centres other joints hold."""

    type: Literal["gears"]
    discs: Bodies

    @property
    def called(self) -> tuple[object, ...]:
        return ("gears", *self.discs)


class Belt(Part):
    """A belt about two discs, without slip; a crossed belt turns them in opposite senses.

    Other joints hold the distance of the discs' centres.
    """

    type: Literal["belt"]
    discs: Bodies
    crossed: Annotated[bool, Flag()] = False

    @property
    def called(self) -> tuple[object, ...]:
        return ("belt", *self.discs)


class Cord(Part):
    """Two points at a constant distance: a taut cord, or a rod about which nothing is asked."""

    type: Literal["cord"]
    points: TwoNames

    @property
    def called(self) -> tuple[object, ...]:
        return ("cord", *self.points)


Joint = Annotated[
    Pin | SlotJoint | Slider | Translation | RollingOnLine | RollingOnCircle | Gears | Belt | Cord,
    Field(discriminator="type"),
]


# --- given quantities -----------------------------------------------------------------------------


class VelocityOf(Part):
    """The velocity of a point, by size and direction; without a size only its line of action is known."""

    type: Literal["velocity"]
    point: Name
    size: ExerciseSpeed | None = None
    direction: Angle

    @property
    def called(self) -> tuple[object, ...]:
        return ("velocity", self.point)


class AccelerationOf(Part):
    """The acceleration of a point, by size and direction; without a size only its line of action is known."""

    type: Literal["acceleration"]
    point: Name
    size: ExerciseAcceleration | None = None
    direction: Angle

    @property
    def called(self) -> tuple[object, ...]:
        return ("acceleration", self.point)


class OmegaOf(Part):
    """The angular velocity of a body, anticlockwise positive."""

    type: Literal["omega"]
    body: Number
    value: Omega

    @property
    def called(self) -> tuple[object, ...]:
        return ("omega", self.body)


class EpsilonOf(Part):
    """The angular acceleration of a body, anticlockwise positive."""

    type: Literal["epsilon"]
    body: Number
    value: Epsilon

    @property
    def called(self) -> tuple[object, ...]:
        return ("epsilon", self.body)


class FromRest(Part):
    """A point that has moved along a straight line from rest, with constant acceleration, for a given time."""

    type: Literal["from rest"]
    point: Name
    acceleration: ExerciseAcceleration
    time: Time
    direction: Angle

    @property
    def called(self) -> tuple[object, ...]:
        return ("from rest", self.point)


GivenRate = Annotated[VelocityOf | AccelerationOf | OmegaOf | EpsilonOf | FromRest, Field(discriminator="type")]


class Asked(Record):
    """A quantity to be found: `v`, `a` of a point; `omega`, `eps`, `centre` of a body."""

    what: str
    of: str

    @property
    def id(self) -> str:
        """Return the id as the file writes it; for a rate it is the id of the rate."""
        return f"{self.what}.{self.of}"

    @property
    def of_body(self) -> bool:
        return self.what in ("omega", "eps", "centre")

    @property
    def body(self) -> int:
        return int(self.of)


class AskedId(Reader):
    """Text of a requested quantity: v.B, a.B of a point; omega.2, eps.2, centre.2 of a body."""

    def read(self, value: object) -> Asked:
        matched = _ASKED.fullmatch(value) if isinstance(value, str) else None
        asked = Asked(matched["what"], matched["of"]) if matched else None
        if asked is None or asked.of_body != asked.of.isdigit():
            raise fault("no-asked-quantity", text=str(value))
        return asked

    def schema(self) -> dict[str, Any]:
        return {"type": "string", "pattern": f"^{_ASKED.pattern.replace('?P<what>', '').replace('?P<of>', '')}$"}


Method = Literal["instant centre", "base point", "projection", "moving frame", "equations"]


SymbolTable = Annotated[
    dict[Annotated[str, SymbolName()], Annotated[Substitution, SymbolValue()]], Field(max_length=MOST_SYMBOLS)
]


class Parameters(Part):
    """One instant of a system of bodies in plane motion."""

    symbols: SymbolTable = Field(default_factory=dict)
    points: Annotated[dict[Name, PointAt], Field(min_length=1, max_length=MOST_NAMES)]
    bodies: Annotated[dict[NumberOrGround, BodyOf], Field(min_length=1, max_length=LAST_BODY)]
    joints: Annotated[tuple[Joint, ...], Field(max_length=MOST_NAMES)] = ()
    given: Annotated[tuple[GivenRate, ...], Field(min_length=1, max_length=MOST_NAMES)]
    find: Annotated[tuple[Annotated[Asked, AskedId()], ...], Field(min_length=1, max_length=MOST_NAMES)]
    methods: Annotated[tuple[Method, ...], Field(max_length=5)] = ()

    @model_validator(mode="before")
    @classmethod
    def _with_symbols(cls, content: Any) -> Any:
        """Attach the symbols to every value that may be stated by symbols."""
        table = content.get("symbols") if isinstance(content, dict) else None
        if not isinstance(table, dict):
            return content
        try:
            symbols = TypeAdapter(SymbolTable).validate_python(table)
        except ValidationError:
            # Reading the symbols themselves reports this fault.
            symbols = {}
        return {
            key: stated(section, symbols, STATED) if key in {"points", "bodies", "given"} else section
            for key, section in content.items()
        }

    @property
    def literal(self) -> bool:
        """Return True if the solution uses symbols."""
        return bool(self.symbols)

    @property
    def slots(self) -> tuple[SlotJoint, ...]:
        """Return the points that slide along lines of moving bodies; a slider is represented by the first point of its
        body.
        """
        slots = []
        for joint in self.joints:
            if isinstance(joint, SlotJoint) and joint.on:
                slots.append(joint)
            elif isinstance(joint, Slider) and joint.on:
                point = self.bodies[joint.body].carried[0]
                slot = SlotJoint.model_construct(type="slot", point=point, body=joint.body, on=joint.on)
                slots.append(slot.model_copy(update={"angle": joint.angle, "along": joint.along}))
        return tuple(slots)

    def disc(self, body: int) -> Disc | None:
        return self.bodies[body].disc if body in self.bodies else None
