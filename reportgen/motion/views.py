"""The chapter on the true motion of a machine: the values that templates name, its curves and tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from reportgen.base.units import rounded, significant_decimals
from reportgen.document import Equation, InlineMath, Inlines, Paragraph, Table, Text, Value, listed
from reportgen.document.tables import list_table
from reportgen.formula import NOTHING, Chain, Expression, Number, Symbol, plus
from reportgen.machine.shared_results import REGULATED_CYCLE
from reportgen.motion import motor_choice, run_ids
from reportgen.motion.curves import FIGURES, motion_of
from reportgen.motion.drives import ConstantDrive, Geared, TableDrive
from reportgen.motion.motor_choice import chosen_motor
from reportgen.motion.steady_running import MotionRun
from reportgen.motion.true_forces import asks_forces, forces_table
from reportgen.motion.true_motion import OFF_SPEED, motion_in
from reportgen.report.context import ReportContext
from reportgen.report.quantity_tables import tables
from reportgen.report.topic_views import ViewHooks, always

RPM = 30 / math.pi
"""Revolutions per minute of one radian per second."""
MOST_CYCLES = 12
"""Largest number of ends of cycles in the table of a start, the last one included."""


# --- values for templates -----------------------------------------------------------------------------


def drive_form(report: ReportContext) -> str:
    """Return the form of the drive: "linear", a "load", "kloss", "table", a "constant" torque, or one that is
    "found".
    """
    motion = motion_in(report.analysis)
    if not isinstance(motion.drive, ConstantDrive):
        if "run.k" in report.ledger:
            return "linear" if report.case.ledger["run.M0"].values[0] > 0 else "load"
        return "kloss" if "run.Mk" in report.ledger else "table"
    return "found" if motion.asked.drive is None else "constant"


def governed(report: ReportContext) -> bool:
    """Return True if the torque of the drive depends on the speed."""
    return motion_in(report.analysis).drive.governs


def inertia_slopes(report: ReportContext) -> list[str]:
    """Return the ids of the accelerations' components along the velocities, of the links' shares in J′, and of J′."""
    points = (run_ids.along_velocity(body.centre) for body in report.machine.linkage.inertias)
    shares = (run_ids.slope(link) for link in report.machine.linkage.links)
    return report.known([*points, *shares, run_ids.slope()])


def characteristic_lines(report: ReportContext) -> list[str]:
    """Return the ids of the values that the formula of the characteristic gives at a speed."""
    return report.known(["run.slip", "run.Mc"])


def steady_lines(report: ReportContext, k: int | None = None) -> list[str]:
    """Return the ids of energy, speed and acceleration at a position."""
    return report.known(["run.T", "run.omega", "run.eps"])


def bound_lines(report: ReportContext, state: str = "") -> list[str]:
    """Return the ids of the results of the cycle: mean speed, unevenness, period, work, power."""
    names = ("mean", "delta", "period", "work", "power")
    return report.known(run_ids.quantity(name, *([state] if state else [])) for name in names)


def has_wheeled(report: ReportContext) -> bool:
    return motion_in(report.analysis).wheeled is not None


def _permitted(report: ReportContext) -> float | None:
    """Return the permitted unevenness; None if the file does not give one."""
    regulated = REGULATED_CYCLE.of(report.machine)
    return None if regulated is None else regulated.unevenness


def verdict(report: ReportContext) -> str:
    """Return "kept" or "exceeded" for the true unevenness against the permitted one; "" if there is no limit."""
    if _permitted(report) is None:
        return ""
    return "exceeded" if _excess(report) > 0 else "kept"


def _excess(report: ReportContext) -> float:
    """Return the share by which the printed true unevenness exceeds the permitted one; negative if it is less."""
    motion, permitted = motion_in(report.analysis), _permitted(report)
    assert permitted is not None, "a verdict names what is permitted"
    printed = report.ledger.number(run_ids.in_state("delta", list(motion.states)[-1]))
    allowed = permitted if printed.decimals is None else rounded(permitted, printed.decimals)
    return float((printed.printed - allowed) / permitted)


def exceeded_by(report: ReportContext) -> Inlines:
    """Return the percentage by which the true unevenness exceeds the permitted one; () if it does not."""
    return (_percent(_excess(report)),) if verdict(report) == "exceeded" else ()


def off_speed(report: ReportContext) -> Inlines:
    """Return the deviation of the mean speed from the planned one, in percent; () if it is small."""
    share = motion_in(report.analysis).off_speed(report.machine)
    return (_percent(share),) if share > OFF_SPEED else ()


def _percent(share: float) -> Value:
    return Value(Number(float(f"{100 * share:.2g}"), max(significant_decimals(100 * share, 2), 0), "%"))


def with_wheel_or_alone(report: ReportContext) -> str:
    """Return the steady motion that the verdict refers to, "wheel" or "alone"."""
    return "wheel" if has_wheeled(report) else "alone"


def starts(report: ReportContext) -> bool:
    return motion_in(report.analysis).started is not None


def stops(report: ReportContext) -> bool:
    return motion_in(report.analysis).stopped is not None


def drive_takes(report: ReportContext) -> bool:
    """Return True if the machine drives the machine on its shaft, as an engine does."""
    return motion_in(report.analysis).alone.work < 0


def starts_with(report: ReportContext) -> str:
    """Return "wheel" if start and stop include the flywheel, else "alone"."""
    motion = motion_in(report.analysis)
    return "wheel" if motion.main_state else "alone"


def swings(report: ReportContext) -> Inlines:
    """Return the angles at which the loads push the crank back as it starts; () if there are none."""
    motion = motion_in(report.analysis)
    if motion.started is None:
        return ()
    return listed(Value(_degrees(angle)) for angle in motion.started.turns_back)


def cycles(report: ReportContext) -> str:
    """Return the number of cycles that the start takes; "" without a start."""
    motion = motion_in(report.analysis)
    return "" if motion.started is None else str(len(motion.started.ends))


def start_angle(report: ReportContext) -> Inlines:
    """Return the crank angle at which the machine starts; () without a start."""
    return _angle_of(motion_in(report.analysis).asked.start_from)


def stop_angle(report: ReportContext) -> Inlines:
    """Return the crank angle at which the motor is switched off; () without a stop."""
    return _angle_of(motion_in(report.analysis).asked.stop_from)


def _angle_of(angle: float | None) -> Inlines:
    return () if angle is None else (Value(_degrees(angle)),)


def _degrees(angle: float) -> Number:
    return Number(math.degrees(angle), 1, "°")


def extreme_places(report: ReportContext, state: str = "") -> Mapping[str, Inlines]:
    """Return the crank angles from the first position at which the crank is fastest and slowest."""
    motion = motion_of(report)
    steady = motion.states["wheel" if state else ""]
    return {"fastest": _angle_of(steady.fastest.angle), "slowest": _angle_of(steady.slowest.angle)}


def motion_equations(report: ReportContext) -> Equation:
    """Return the equation of motion, the equation of energy and its solution, in symbols."""
    ledger = report.ledger
    parts = [ledger.symbol(id) for id in ("J.r", "run.J") if id in ledger]
    J = plus(*parts)
    ω, ε = ledger.symbol("run.omega"), ledger.symbol("run.eps")
    M = ledger.symbol("M.r") + ledger.symbol("run.Md")
    T = ledger.symbol("run.T")
    slope: Expression = ledger.symbol("run.dJ") if "run.dJ" in ledger else NOTHING
    turning = ε * J if len(parts) > 1 else J * ε
    left = turning if slope == NOTHING else turning + ω**2 * slope / 2
    rate = Symbol("d" + T.base, T.sub) / Symbol("dφ")
    half = ω**2 * J / 2 if len(parts) > 1 else J * ω**2 / 2
    time = Symbol("dt") / Symbol("dφ")
    return Equation((Chain((left, M)), Chain((T, half)), Chain((rate, M)), Chain((time, 1 / ω))))


def drive_equations(report: ReportContext) -> Equation:
    """Return the characteristic of the drive, reduced to the crank, in symbols."""
    ledger = report.ledger
    M, ω = ledger.symbol("run.Md"), Symbol("ω")
    i = ledger.symbol("run.i") if "run.i" in ledger else None
    if "run.k" in ledger:
        falling = ledger.symbol("run.M0") - ledger.symbol("run.k") * (ω if i is None else ω / i)
        return Equation((Chain((M, falling if i is None else falling / i)),))
    s, s_k = ledger.symbol("run.slip"), ledger.symbol("run.sk")
    shares, ω0 = s / s_k + s_k / s, ledger.symbol("run.omega0")
    kloss = 2 * ledger.symbol("run.Mk") / (shares if i is None else i * shares)
    return Equation((Chain((M, kloss)), Chain((s, 1 - ω / (ω0 if i is None else i * ω0)))))


def drive_formula(report: ReportContext) -> Inlines:
    """Return the characteristic for use in a sentence; () for a drive without a formula."""
    if drive_form(report) not in ("linear", "load", "kloss"):
        return ()
    chains = (InlineMath(chain, slashed=True) for chain in drive_equations(report).rows if isinstance(chain, Chain))
    return listed(chains)


def drive_points(report: ReportContext) -> Inlines:
    """Return the torques and speeds of a tabled characteristic; () for any other one."""
    motion = motion_in(report.analysis)
    drive = motion.drive
    motor = drive.motor if isinstance(drive, Geared) else drive
    if not isinstance(motor, TableDrive):
        return ()
    pairs = zip(motor.speeds, motor.torques, strict=True)
    rpm = report.ledger.units.get("rpm", "rpm")
    points = (
        (
            Value(_short(torque, report.ledger.printed_unit("N·m"))),
            Text(f" {report.words['figure']['at_speed']} "),
            Value(_short(speed * RPM, rpm)),
        )
        for speed, torque in pairs
    )
    return tuple(part for number, point in enumerate(points) for part in (*((Text("; "),) if number else ()), *point))


def _short(value: float, unit: str) -> Number:
    return Number(float(f"{value:.9g}"), None, unit)


def step_equation(report: ReportContext) -> Equation:
    """Return the equation for the speed at the next position, in symbols."""
    ω, J, M = Symbol("ω", "b"), Symbol("J"), Symbol("M")
    after = M * Symbol("Δφ") / (J * ω) + (3 * J - Symbol("J", "", "+")) * ω / (2 * J)
    return Equation((Chain((Symbol("ω", "b", "+"), after)),))


def inertia_apart(report: ReportContext) -> bool:
    """Return True if no earlier chapter has calculated the reduced moment of inertia."""
    return report.has_reduced_inertia and reduced_here(report)


def reduced_here(report: ReportContext) -> bool:
    """Return True unless an earlier chapter has reduced torque and inertia to the crank."""
    return REGULATED_CYCLE.of(report.machine) is None


def inertia_form(report: ReportContext) -> str:
    """Return the form of the reduced moment of inertia: it "varies", is "even", or there is "none" but the motor's."""
    if not report.has_reduced_inertia:
        return "none"
    return "varies" if inertia_slopes(report) else "even"


def residuals(report: ReportContext) -> dict[str, float]:
    """Return the differences of the drive from its characteristic, and of a steady cycle's end from its start, as
    shares.
    """
    motion, families = motion_in(report.analysis), report.case.ledger.families
    closing = [abs(steady.run.energy[-1] / steady.run.energy[0] - 1) for steady in motion.states.values()]
    readings = [
        families[id].values[0]
        for id in (run_ids.in_state("reading", state) for state in motion.states)
        if id in families
    ]
    result = {"run_energy": float(max(closing))}
    return {"drive": float(max(readings)), **result} if readings else result


def _in_main_state(name: str) -> Callable[[ReportContext], str]:
    """Return a function that returns the id of a quantity in the state that starts and stops, whose forces the report
    has.
    """

    def of(report: ReportContext) -> str:
        motion = motion_in(report.analysis)
        return run_ids.in_state(name, motion.main_state)

    return of


VALUES: Mapping[str, Callable[[ReportContext], Any]] = {
    "forces_omega": _in_main_state("omega"),
    "forces_eps": _in_main_state("eps"),
    "inertia_apart": inertia_apart,
    "reduced_here": reduced_here,
    "inertia_form": inertia_form,
    "drive_form": drive_form,
    "governed": governed,
    "inertia_slopes": inertia_slopes,
    "characteristic_lines": characteristic_lines,
    "motion_verdict": verdict,
    "verdict_of": with_wheel_or_alone,
    "exceeded_by": exceeded_by,
    "off_speed": off_speed,
    "has_wheeled": has_wheeled,
    "starts": starts,
    "stops": stops,
    "drive_takes": drive_takes,
    "starts_with": starts_with,
    "swings": swings,
    "start_cycles": cycles,
    "start_angle": start_angle,
    "stop_angle": stop_angle,
    "drive_formula": drive_formula,
    "drive_points": drive_points,
    **motor_choice.VALUES,
    "asks_forces": asks_forces,
}
FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    "bound_lines": bound_lines,
    "steady_lines": steady_lines,
    "extreme_places": extreme_places,
    "motion_equations": motion_equations,
    "drive_equations": drive_equations,
    "step_equation": step_equation,
}

# --- tables -----------------------------------------------------------------------------------------------

Head = Sequence[str]


def steady_table(report: ReportContext, key: str, caption: str, head: Head) -> tuple[Table | Paragraph, ...]:
    """Return a table of the steady motion at the positions."""
    shared = ["J.r", "run.dJ", "M.r"]
    own = [run_ids.in_state(name, "") for name in ("Md", "T", "omega", "eps", "t")]
    varying = [id for id in report.known([*shared, *own]) if len(report.ledger[id].values) > 1]
    return tables(report, key, caption, varying, report.all_positions)


def wheel_table(report: ReportContext, key: str, caption: str, head: Head) -> tuple[Table | Paragraph, ...]:
    """Return a table of the steady motion with the flywheel at the positions."""
    own = report.known(run_ids.in_state(name, "wheel") for name in ("Md", "T", "omega", "eps", "t"))
    return tables(report, key, caption, own, report.all_positions)


def steps_table(report: ReportContext, key: str, caption: str, head: Head) -> tuple[Table | Paragraph, ...]:
    """Return a table of the speed computed in steps and the true speed."""
    return tables(report, key, caption, ["run.omega", "run.step"], report.all_positions)


def start_table(report: ReportContext, key: str, caption: str, head: Head) -> Table:
    """Return a table of the start: positions of its first cycle, and the ends of the other cycles."""
    started = motion_of(report).started
    assert started is not None, "a start has a table where it is asked for"
    run, begin = started.run, float(started.run.angle[0])
    whole = report.machine.turns * 2 * math.pi
    places = sorted(begin + np.mod(angle - begin, whole) for angle in report.machine.cycle_angles)
    # If a crank swings back, its last pass of a place counts.
    first = [_last_at(run, at, started.ends[0]) for at in places if not np.isclose(at, begin)]
    ends = list(started.ends)
    step = -(-len(ends) // MOST_CYCLES)
    indices = [0, *first, *dict.fromkeys([*ends[::step], ends[-1]])]
    return list_table(report.prose, key, caption, head, _rows(report, run, indices), (40.0, 40.0, 40.0, 40.0))


def _last_at(run: MotionRun, angle: float, end: int) -> int:
    near = np.flatnonzero(np.abs(run.angle[: end + 1] - angle) < 1e-8)
    return int(near[-1]) if near.size else int(np.abs(run.angle[: end + 1] - angle).argmin())


def stop_table(report: ReportContext, key: str, caption: str, head: Head) -> Table:
    """Return a table of the run-down: the positions that it passes, and its end."""
    run = motion_of(report).stopped
    assert run is not None, "a stop has a table where it is asked for"
    whole = report.machine.turns * 2 * math.pi
    turns = math.ceil(float(run.angle[-1]) / whole)
    every = (angle + turn * whole for turn in range(turns) for angle in report.machine.cycle_angles)
    passed = [angle for angle in every if run.angle[0] < angle < run.angle[-1]]
    step = -(-len(passed) // MOST_CYCLES) if passed else 1
    indices = [0, *(run.place(angle) for angle in passed[::step]), len(run.angle) - 1]
    return list_table(report.prose, key, caption, head, _rows(report, run, indices), (40.0, 40.0, 40.0, 40.0))


def _rows(report: ReportContext, run: MotionRun, places: Sequence[int]) -> Iterator[Sequence[object]]:
    decimals = report.ledger.decimals
    speeds, times, rates = (decimals[id] for id in ("run.omega", "run.t", "run.eps"))
    for place in dict.fromkeys(places):
        yield (
            Number(math.degrees(float(run.angle[place])), 2),
            Number(float(run.time[place]), times),
            Number(float(run.speed[place]), speeds),
            Number(float(run.acceleration[place]), rates),
        )


TABLES: Mapping[str, Callable[..., Any]] = {
    "run": steady_table,
    "run.wheel": wheel_table,
    "run.steps": steps_table,
    "run.start": start_table,
    "run.stop": stop_table,
    "run.forces": forces_table,
    **motor_choice.TABLES,
}


def _overview(report: ReportContext) -> Sequence[str]:
    motor = ("motion-overview-motor",) if chosen_motor(report) else ()
    return (*motor, "motion-overview-verdict") if verdict(report) else motor


HOOKS = ViewHooks(
    values=VALUES,
    functions=FUNCTIONS,
    figures=FIGURES,
    tables=TABLES,
    passages={"overview": _overview, "conclusion": always("motion-conclusion"), "task": always("motion-task")},
    residuals=residuals,
)
