"""Remarks after a table: positions at which a quantity is greatest or zero, and the reasons.

Everything is read from the printed numbers, so that a sentence and its table cannot disagree.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from reportgen.base.records import Record, replace
from reportgen.base.template_access import view
from reportgen.document import InlineMath, Inlines, Text, Value, listed
from reportgen.formula import ids
from reportgen.machine import DRIVER, GROUND
from reportgen.machine.analysis import Position
from reportgen.report.context import ReportContext
from reportgen.report.phrases import at_positions, say

RUN = 3
"""Number of consecutive positions from which on they are listed as a range, from – to."""
AT_REST = 1e-9
"""A velocity below this share of its greatest value is zero."""


@view("place")
class Peak(Record):
    """Quantities with equal values over positions: their greatest size, its positions, and the positions of zeros.

    `at` and `zero` are labels of positions, "" if there are none; `many` and `zeros` are their numbers, `where` and
    `zero_where` phrases for them.  `level` is True if the size is the same everywhere, `turns` if the sign changes at
    every zero.
    """

    ids: tuple[str, ...]
    symbols: Inlines
    value: Value
    at: str
    many: int
    zero: str
    zeros: int
    level: bool
    turns: bool
    places: tuple[int, ...]
    where: str
    zero_where: str

    @property
    def place(self) -> str:
        """The phrase for the positions of the greatest size, with a leading space; "" if the size is the same
        everywhere.
        """
        return "" if self.level else f" {self.where}"


def worked_at(report: ReportContext) -> str:
    """Return the phrase for the positions that the report calculates in full."""
    return where(report, report.assignment.worked_positions)


def reactions_at(report: ReportContext) -> str | Inlines:
    """Return the phrase for the positions at which the report determines the reactions: the cycle, the instants, or the
    worked positions.
    """
    if report.instants:
        return at_positions(report)
    everywhere = str(report.words["reactions_at"]).format(count=report.cycle_count)
    return everywhere if report.parts("reactions") else worked_at(report)


def printed_values(report: ReportContext, id: str, positions: Iterable[int]) -> np.ndarray:
    """Return the values of a quantity as printed [N], nan where it does not exist."""
    return np.array([report.ledger.number(id, k).printed for k in positions])


def labels(report: ReportContext, positions: Sequence[int]) -> str:
    """Return positions as a sentence lists them: 2, 4 and 6–8."""
    runs: list[list[int]] = []
    for k in positions:
        if runs and k == runs[-1][-1] + 1:
            runs[-1].append(k)
        else:
            runs.append([k])
    name, parts = report.machine.position, []
    for run in runs:
        parts += [f"{name(run[0])}–{name(run[-1])}"] if len(run) >= RUN else [str(name(k)) for k in run]
    *others, last = parts or [""]
    return f"{', '.join(others)} {report.words['and']} {last}" if others else last


def where(report: ReportContext, positions: Sequence[int]) -> str:
    """Return the phrase for one position or several: at positions 2, 4 and 6–8."""
    single, many = report.words["at"]
    return str(single if len(positions) == 1 else many).format(labels(report, positions))


def peak(report: ReportContext, id: str, positions: Sequence[int]) -> Peak | None:
    """Return the peak and the zeros of a quantity over positions; None if it is zero at all of them."""
    values = printed_values(report, id, positions)
    sizes = np.abs(values)
    if not np.nanmax(sizes, initial=0.0) > 0:
        return None
    top = np.nanmax(sizes)
    greatest = [k for k, size in zip(positions, sizes, strict=True) if size == top]
    nothing = [index for index, size in enumerate(sizes) if size == 0]
    zeros = [positions[index] for index in nothing]
    around = [(values[index - 1], values[(index + 1) % len(values)]) for index in nothing]
    return Peak(
        ids=(id,),
        symbols=(InlineMath(report.ledger.symbol(id)),),
        value=Value(report.ledger.number(id, greatest[0], size=True)),
        at=labels(report, greatest),
        many=len(greatest),
        zero=labels(report, zeros),
        zeros=len(zeros),
        level=len(greatest) == len(positions),
        turns=all(before * after < 0 for before, after in around),
        places=tuple(greatest),
        where=where(report, greatest),
        zero_where=where(report, zeros),
    )


def peaks(report: ReportContext, quantities: Iterable[str], cycle: bool = False) -> list[Peak]:
    """Return the peaks of quantities over one turn, or over the cycle; equal ones are joined, zero ones left out."""
    positions = report.all_positions if cycle else report.positions
    alike: dict[tuple[object, ...], list[Peak]] = {}
    for extreme in each_peak(report, quantities, positions):
        alike.setdefault((extreme.value.number.printed, extreme.at, extreme.zero, extreme.turns), []).append(extreme)
    return [_joined(report, some) for some in alike.values()]


def each_peak(report: ReportContext, quantities: Iterable[str], positions: Sequence[int]) -> list[Peak]:
    """Return the peak of each quantity over positions; quantities that are zero everywhere are left out."""
    peaks_found = (peak(report, id, positions) for id in report.known(quantities))
    return [one for one in peaks_found if one is not None]


def _joined(report: ReportContext, alike: Sequence[Peak]) -> Peak:
    """Return equal peaks as one, with the symbols of all."""
    symbols = [one.symbols[0] for one in alike]
    names: Inlines = listed(symbols[:-1])
    if names:
        names = (*names, Text(f" {report.words['and']} "))
    return replace(alike[0], ids=tuple(id for one in alike for id in one.ids), symbols=(*names, symbols[-1]))


# --- motion


class GuidedLink(Record):
    """A link that slides along a fixed guide, and the pin that moves with it."""

    link: int
    pin: str


def sliders(report: ReportContext) -> tuple[GuidedLink, ...]:
    """Return the links that slide along fixed guides, except a sliding driver."""
    slides = report.analysis.motion.slides
    both = ((link, group.Q) for group in report.dyads for link in group.links)
    return tuple(GuidedLink(link, pin) for link, pin in both if (GROUND, link) in slides)


def slider_rates(report: ReportContext, what: str) -> list[str]:
    """Return the ids of the velocities ("v") or accelerations ("a") of the sliders on fixed guides."""
    return report.known(ids.POINT_RATE[what](slider.pin) for slider in sliders(report))


def turning_rates(report: ReportContext, what: str) -> list[str]:
    """Return the ids of the angular velocities ("omega") or accelerations ("eps") of links, each motion once.

    Of links that turn together, such as a block and its lever, the last is named.
    """
    seen: dict[tuple[float, ...], str] = {}
    for link in report.machine.linkage.links:
        id = ids.signed(what, link)
        if link != DRIVER and id in report.ledger:
            seen[tuple(report.ledger[id].values)] = id
    return list(seen.values())


def reverses(report: ReportContext, rate: Peak) -> bool:
    """Return True if a slider reverses after each position at which its velocity is zero."""
    return all(_reverses(report, slider.link) for slider in sliders(report) if ids.velocity(slider.pin) in rate.ids)


def _reverses(report: ReportContext, link: int) -> bool:
    along = report.analysis.motion.slides[GROUND, link].v[: report.count]
    still = np.abs(along) < AT_REST * np.abs(along).max()
    return all(along[k - 1] * along[(k + 1) % len(along)] < 0 for k in np.flatnonzero(still))


def at_rest(report: ReportContext, rate: Peak) -> bool:
    """Return True if the point with this acceleration is at rest at every position of its greatest acceleration."""
    velocities = [ids.velocity(found["point"]) for id in rate.ids if (found := ids.acceleration.read(id))]
    return all(bool(np.all(printed_values(report, id, rate.places) == 0)) for id in velocities)


# --- loads and forces


def load_ids(report: ReportContext) -> list[str]:
    """Return the ids of the forces and torques applied to the machine, gas forces included."""
    return report.known(load.name for load in report.loads)


def inertia_forces(report: ReportContext) -> list[str]:
    """Return the ids of the inertia forces of all links."""
    return report.known(ids.inertia_force(link) for link in report.bodies)


def reaction_ids(report: ReportContext) -> list[str]:
    """Return the ids of the reactions in all joints, each pair once."""
    names = [name for group in reversed(report.groups) for name in group.reaction_joints]
    ends = (ids.face_reaction(name, number) for name in names for number in (1, 2))
    return report.known((*(ids.reaction(name) for name in (*names, "01")), *ends))


def greatest(report: ReportContext, quantities: Iterable[str]) -> list[Peak]:
    """Return the peaks of the quantities that reach the greatest value over the cycle."""
    every = peaks(report, quantities, True)
    top = max((one.value.number.printed for one in every), default=0.0)
    return [one for one in every if one.value.number.printed == top]


def cause(report: ReportContext, top: Peak) -> Inlines:
    """Return the phrase for the largest force on the links at the positions of the greatest reaction; () if there is
    none.
    """
    chief = chief_load(report, top)
    if chief is None:
        return ()
    single, many = report.words["remarks"]["cause"]
    return say(report, single if top.many == 1 else many, chief)


def chief_load(report: ReportContext, at: Peak) -> Peak | None:
    """Return the peak of the largest force on the links, inertia included, at the positions of another peak."""
    forces = [id for id in load_ids(report) if report.ledger[id].kind == "force"]
    bodies = [name(body) for body in report.bodies for name in (ids.inertia_force, ids.weight)]
    place = at.places[:1]
    forces_there = (peak(report, id, place) for id in report.known([*forces, *bodies]))
    return max((one for one in forces_there if one is not None), key=lambda one: one.value.number.value, default=None)


class TorqueSigns(Record):
    """Numbers of the positions at which the balancing torque acts `along` the motion, `against` it, or is zero
    (`none`).
    """

    along: tuple[int, ...]
    against: tuple[int, ...]
    none: tuple[int, ...]
    mean: str
    """Direction of the machine's mean energy over the cycle: "taken", "given", or "even"."""


def balance_course(report: ReportContext) -> TorqueSigns:
    """Return the senses of the balancing torque or force, as printed, at all positions."""
    with_motion = report.machine.turn if not report.machine.span else np.sign(report.machine.speed)
    values = printed_values(report, "M.eq", report.all_positions) * with_motion
    mean = float(report.ledger.number("M.mean").value) * with_motion if report.cyclic else 0.0
    every = np.array(report.all_positions)
    along, against, none = (tuple(map(int, every[chosen])) for chosen in (values > 0, values < 0, values == 0))
    return TorqueSigns(along, against, none, "taken" if mean > 0 else "given" if mean < 0 else "even")


def balance_senses(report: ReportContext) -> list[Inlines]:
    """Return a sentence for each effect of the balancing torque on the motion, with its positions."""
    course, words = balance_course(report), report.words["remarks"]["balance"]
    positions_by_sense = {"against": course.against, "along": course.along, "none": course.none}
    motion = report.words["driven"][report.driver.kind]["motion_of"]
    return [
        say(report, words[sense], where=where(report, there), motion=motion)
        for sense, there in positions_by_sense.items()
        if there
    ]


def balance_gaps(report: ReportContext, *positions: Position) -> list[Peak]:
    """Return the peak of the difference between the balancing torques of both methods; [] if they agree as printed.

    Without `positions` it covers the whole table.
    """
    return each_peak(report, ("M.difference",), positions or report.all_positions)


def balance_mean(report: ReportContext) -> Inlines:
    """Return the conclusion from the mean balancing torque: the machine takes in energy, or gives it out."""
    if not report.cyclic:
        return ()
    words = report.words["remarks"]["mean"]
    driven = report.words["driven"][report.driver.kind]
    return say(report, words[balance_course(report).mean], driven, motion=driven["motion_of"])


# --- remarks


@view()
class Remark(Record):
    """A sentence about one quantity or several equal ones: symbols, course, and reason."""

    symbols: Inlines
    course: Inlines
    why: Inlines


class Subject(Record):
    """Subject of remarks, one of `SUBJECTS`: ids, over one turn or the whole cycle, with or without a remark on zeros.

    `why` selects the peaks for which the phrases give a reason.
    """

    ids: Callable[[ReportContext], Iterable[str]]
    cycle: bool = False
    zeros: bool = True
    why: Callable[[ReportContext, Peak], bool] = lambda report, one: False


SUBJECTS = {
    "v": Subject(
        lambda report: slider_rates(report, "v"), why=lambda report, one: one.zeros > 0 and reverses(report, one)
    ),
    "a": Subject(
        lambda report: slider_rates(report, "a"),
        zeros=False,
        why=lambda report, one: not one.level and at_rest(report, one),
    ),
    "omega": Subject(
        lambda report: turning_rates(report, "omega"), why=lambda report, one: one.zeros > 0 and one.turns
    ),
    "eps": Subject(lambda report: turning_rates(report, "eps"), why=lambda report, one: one.zeros > 0 and one.turns),
    "inertia": Subject(lambda report: inertia_forces(report), cycle=True, why=lambda report, one: not one.level),
    "loads": Subject(lambda report: load_ids(report), cycle=True),
    "torque": Subject(lambda report: ["M.eq"], cycle=True, zeros=False),
}


def remarks(report: ReportContext, *subjects: str) -> list[Remark]:
    """Return remarks on the quantities of some `SUBJECTS`, by key; equal ones are joined, zero ones left out."""
    return [_remark(report, name, one) for name in subjects for one in _peaks_of(report, SUBJECTS[name])]


def _peaks_of(report: ReportContext, subject: Subject) -> list[Peak]:
    return peaks(report, subject.ids(report), subject.cycle)


def _remark(report: ReportContext, name: str, top: Peak) -> Remark:
    subject, words = SUBJECTS[name], report.words["remarks"]
    phrases = words["course"] | words.get(name, {})
    course = "level" if top.level else "zeros" if top.zeros and subject.zeros else "greatest"
    why = say(report, phrases["why"], slider=report.words["names"]["slider"]) if subject.why(report, top) else ()
    return Remark(top.symbols, say(report, phrases[course], top), why)


def main_peaks(report: ReportContext) -> list[Peak]:
    """Return the peaks of the greatest velocities and accelerations: of sliders, or else of links that turn."""
    pairs = ((SUBJECTS["v"], SUBJECTS["omega"]), (SUBJECTS["a"], SUBJECTS["eps"]))
    return [one for first, other in pairs for one in _peaks_of(report, first) or _peaks_of(report, other)]


def top_reactions(report: ReportContext) -> list[Peak]:
    """Return the peaks of the joint reactions that reach the greatest value over the cycle."""
    return greatest(report, reaction_ids(report))
