"""The motion section of a file: the drive on the machine's shaft, a start from rest, a stop under a brake."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Annotated, Any

from pydantic import Field

from reportgen.assignment.common import Draft, Part
from reportgen.assignment.fields import (
    CycleAngle,
    Flag,
    Interval,
    MomentOfInertia,
    Nodes,
    OneLine,
    Quantity,
    Ratio,
    Reader,
    RotationalSpeed,
    fault,
    quantity,
)
from reportgen.base.errors import Finding
from reportgen.base.records import replace
from reportgen.base.units import Given
from reportgen.catalogue.topic_sections import (
    Opening,
    TopicData,
    TopicParameters,
    TopicSection,
    of_whole_turns,
    on_whole_turns,
)
from reportgen.formula import Symbol
from reportgen.machine.analysis import Machine
from reportgen.machine.shared_results import LOST_TORQUE, REGULATED_CYCLE
from reportgen.motion.drives import (
    ConstantDrive,
    Drive,
    Geared,
    KlossDrive,
    LinearDrive,
    MotionAsked,
    Motor,
    TableDrive,
)
from reportgen.motion.steady_running import NoMotionError
from reportgen.motion.true_motion import OFF_SPEED, true_motion_of

FIND = "find"
"""The constant torque that balances the mean of the loads."""
Torque = Annotated[Given, quantity("N m", least=-1e9, most=1e9, tiny=1e-9)]
PositiveTorque = Annotated[Given, quantity("N m", least=1e-9, most=1e9)]
Damping = Annotated[Given, quantity("N m s", least=1e-9, most=1e9)]
Power = Annotated[Given, quantity("kW", least=1e-6, most=1e6)]
MOST_MOTORS = 60
Slip = Annotated[Given, Ratio(Interval(least=1e-3, most=1))]
GearRatio = Annotated[Given, Ratio(Interval(least=1e-4, most=1e4))]
START = Given(0.0, 0.0, "deg", "0 deg")


class FoundTorque(Reader):
    """A torque, or `find`."""

    of: Quantity

    def read(self, value: object) -> Given | None:
        return None if value == FIND else self.of.read(value)

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [{"const": FIND}, self.of.schema()]}


class Always(Reader):
    """`true`: a value that is always present and may be written."""

    def read(self, value: object) -> bool:
        if value != "true":
            raise fault("choice", allowed="true")
        return True

    def schema(self) -> dict[str, Any]:
        return {"type": "boolean", "enum": [True]}


class Kloss(Part):
    """An induction motor: breakdown torque, slip there, synchronous speed."""

    Mk: PositiveTorque
    sk: Slip
    n0: RotationalSpeed


class DriveTable(Part):
    """Torques of a motor at speeds that rise from 0."""

    n: Annotated[tuple[Annotated[Given, quantity("rpm", least=0, most=1e5)], ...], Nodes]
    M: Annotated[tuple[Torque, ...], Nodes]


class MotorSection(Part):
    """A motor to choose from: its name, rated power and speed, starting and breakdown torque."""

    name: OneLine
    power: Power
    n: RotationalSpeed
    start: PositiveTorque
    breakdown: PositiveTorque

    @property
    def motor(self) -> Motor:
        return Motor(self.name, self.power.si, self.n.si, self.start.si, self.breakdown.si)


class DriveSection(Part):
    """The characteristic of the motor, the gear between it and the crank, the inertia that turns with the motor."""

    M0: Torque | None = None
    k: Damping | None = None
    kloss: Kloss | None = None
    table: DriveTable | None = None
    constant: Annotated[Given | None, FoundTorque(quantity("N m", least=-1e9, most=1e9, tiny=1e-9))] = None
    ratio: GearRatio | None = None
    J: MomentOfInertia | None = None
    motors: Annotated[tuple[MotorSection, ...], Field(max_length=MOST_MOTORS)] = ()

    @property
    def i(self) -> float:
        """Transmission ratio i: the crank's speed over the motor's."""
        return 1.0 if self.ratio is None else self.ratio.si

    @property
    def motor(self) -> Drive | None:
        """The characteristic; None where a constant torque is to be found."""
        if self.M0 is not None and self.k is not None:
            return LinearDrive(self.M0.si, self.k.si)
        if self.kloss is not None:
            return KlossDrive(self.kloss.Mk.si, self.kloss.sk.si, self.kloss.n0.si)
        if self.table is not None:
            return TableDrive(tuple(n.si for n in self.table.n), tuple(M.si for M in self.table.M))
        return None if self.constant is None else ConstantDrive(self.constant.si)

    @property
    def on_crank(self) -> Drive | None:
        """The characteristic reduced to the crank; None if a constant torque is to be found."""
        motor = self.motor
        if motor is None or self.ratio is None:
            return motor
        if isinstance(motor, ConstantDrive):
            return ConstantDrive(motor.size / self.i)
        return Geared(motor, self.i)


class StartSection(Part):
    """The crank angle from the first position at which the machine starts from rest."""

    from_: CycleAngle = Field(default=START, alias="from")


class StopSection(Part):
    """The torque of the brake on the crank, and the crank angle at which the motor is switched off."""

    brake: PositiveTorque
    from_: CycleAngle = Field(default=START, alias="from")


class MotionSection(Part):
    """Request for the true motion: always steady running, start and stop if they are named.

    Start and stop include the `flywheel` if it is requested; `forces` requests the forces at the true speeds.
    """

    drive: DriveSection
    steady: Annotated[bool, Always()] = True
    start: StartSection | None = None
    stop: StopSection | None = None
    flywheel: Annotated[bool, Flag()] = False
    forces: Annotated[bool, Flag()] = False

    @property
    def asked(self) -> MotionAsked:
        drive, start, stop = self.drive, self.start, self.stop
        return MotionAsked(
            drive=drive.on_crank,
            inertia=0.0 if drive.J is None else drive.J.si / drive.i**2,
            start_from=None if start is None else start.from_.si,
            stop_from=None if stop is None else stop.from_.si,
            brake=0.0 if stop is None else stop.brake.si,
            wheeled=self.flywheel,
            forces=self.forces,
            motors=tuple(motor.motor for motor in drive.motors),
            ratio=drive.i,
        )


# --- entries on the sheet -----------------------------------------------------------------------------


def enter(opening: Opening) -> TopicData:
    """Enter the data of the drive as typed, by ids that begin with `run`."""
    motion, datum = opening.given.section("motion", MotionSection), opening.datum
    assert motion is not None, "the file asks for the true motion"
    drive = motion.drive
    rows: list[tuple[str, Given | None, Symbol, str]] = [
        ("run.M0", drive.M0 or drive.constant, Symbol("M", "0"), "torque"),
        ("run.k", drive.k, Symbol("k", "dc"), "damping"),
        ("run.i", drive.ratio, Symbol("i"), "ratio"),
        ("run.J0", drive.J, Symbol("J", "0"), "moment of inertia"),
    ]
    if drive.kloss is not None:
        n0 = drive.kloss.n0
        rpm = replace(n0, si=n0.value if n0.unit == "rpm" else n0.si * 30 / math.pi)
        rows += [
            ("run.Mk", drive.kloss.Mk, Symbol("M", "th"), "torque"),
            ("run.sk", drive.kloss.sk, Symbol("s", "th"), "ratio"),
            ("run.n0", rpm, Symbol("n", "0"), "speed of rotation"),
        ]
    if motion.stop is not None:
        rows.append(("run.brake", motion.stop.brake, Symbol("M", "ph"), "torque"))
    for id, given, symbol, kind in rows:
        if given is not None:
            datum(id, given, symbol, kind)
    return TopicData(motion.asked)


# --- checks -------------------------------------------------------------------------------------------

FORMS = ("M0", "kloss", "table", "constant")


def check(draft: Draft) -> Iterator[Finding]:
    """Yield faults unless a drive has exactly one characteristic, a linear one both of its values, and a table rises
    from 0.
    """
    drive, where = draft.at("parameters", "motion", "drive"), ("parameters", "motion", "drive")
    if not isinstance(drive, dict):
        return
    given = [form for form in FORMS if drive.get(form) is not None]
    if len(given) > 1:
        yield Finding("both-given", (*where, given[1]), {"first": given[0], "second": given[1]}, at="key")
    elif not given:
        yield Finding("missing-key", where, {"key": " | ".join(FORMS)})
    for key, partner in (("M0", "k"), ("k", "M0")):
        if drive.get(key) is not None and drive.get(partner) is None and given in (["M0"], []):
            yield Finding("missing-key", where, {"key": partner})
    parameters = draft.sections.get("parameters")
    section = parameters.section("motion", MotionSection) if isinstance(parameters, TopicParameters) else None
    if section is not None and section.drive.table is not None:
        yield from _table(section.drive.table, (*where, "table"))


def _table(table: DriveTable, where: tuple[str, ...]) -> Iterator[Finding]:
    if len(table.M) != len(table.n):
        counts = {"key": "M", "given": str(len(table.M)), "other": "n", "wanted": str(len(table.n))}
        yield Finding("row-length", (*where, "M"), counts)
    falls = [k for k in range(1, len(table.n)) if table.n[k].si <= table.n[k - 1].si]
    if falls:
        yield Finding("not-increasing", (*where, "n", falls[0]), {"key": "n"})
    elif table.n[0].si:
        yield Finding("table-end", (*where, "n", 0), {"key": "n", "end": "0 rpm"})


def failures(machine: Machine, worked: Sequence[int]) -> Iterator[Finding]:
    """Yield the findings that explain why the requested motion is impossible, at the keys that request it."""
    if not (machine.linkage.inertias or machine.loads):
        yield Finding("motion-without-loads", ("parameters", "motion"), at="key")
        return
    try:
        true_motion_of(machine)
    except NoMotionError as error:
        yield _finding(error)


def warnings(machine: Machine) -> Iterator[Finding]:
    """Warn about a drive under which the machine runs at another speed than that of its calculation."""
    motion = true_motion_of(machine)
    if motion is not None and motion.off_speed(machine) > OFF_SPEED:
        words = {"speed": f"{motion.states[motion.main_state].mean:.4g}", "planned": f"{machine.speed:.4g}"}
        yield Finding("motion-off-speed", ("parameters", "motion", "drive"), words, at="key")


def _finding(error: NoMotionError) -> Finding:
    motion = ("parameters", "motion")
    where = {
        "no-inertia": motion,
        "does-not-start": (*motion, "start"),
        "starts-nowhere": (*motion, "drive"),
        "start-stalls": (*motion, "start"),
        "starts-too-slowly": (*motion, "start"),
        "does-not-stop": (*motion, "stop"),
    }.get(error.code, (*motion, "drive"))
    ranges = "; ".join(f"{math.degrees(low):.0f}° … {math.degrees(high):.0f}°" for low, high in error.ranges)
    words = {
        "angle": f"{math.degrees(error.angle):.1f}",
        "missing": f"{abs(error.missing):.4g}",
        "ranges": ranges or "–",
        "speed": f"{error.speed:.4g}",
    }
    return Finding(f"motion-{error.code}", where, words, at="key")


HOOKS = TopicSection(
    annotation=MotionSection | None,
    order=60,
    chapter="true-motion",
    uses=(LOST_TORQUE, REGULATED_CYCLE),
    checks=lambda parameters: (*on_whole_turns("motion")(parameters), check),
    fits=of_whole_turns,
    enter=enter,
    failures=failures,
    warnings=warnings,
    not_in_short=frozenset(
        (
            *("motion-reduced", "motion-acceleration", "motion-diagrams", "motion-by-steps"),
            *("motion-worked", "motion-wheel"),
        )
    ),
)
