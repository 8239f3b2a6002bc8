"""The chapter on balancing: views, ids of lines, tables and figures for its templates."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from reportgen.balancing import balance_ids, order_views
from reportgen.balancing.counterweight_drawings import CounterweightDisc, with_discs
from reportgen.balancing.ledger import AFTER, AXES, BEFORE, LETTERS
from reportgen.balancing.order_views import factors_table
from reportgen.balancing.shaking_force import BalancedTurn, balanced_in, frame_reactions, shaking_force
from reportgen.base.records import Record
from reportgen.base.template_access import view
from reportgen.document import Value
from reportgen.document.figure_placement import FigureScenes
from reportgen.drawing import Diagram, PlottedCurve, Scene, charts
from reportgen.formula import Chain, Symbol, ids
from reportgen.formula.vocabulary import KINDS
from reportgen.machine import DRIVER
from reportgen.machine.load_laws import FULL_TURN
from reportgen.machine.rigid_motion import unit
from reportgen.report.context import ReportContext
from reportgen.report.mechanism_figures import drawing_scale, looks, reduction, shown_at
from reportgen.report.quantity_tables import QuantityTable, RowTable, bare
from reportgen.report.topic_views import ViewHooks, always

__all__ = ["FIGURES", "FUNCTIONS", "VALUES", "factors_table"]

ROUND = 181
"""Number of points of a circle that is drawn as a curve."""


def _turn(report: ReportContext) -> BalancedTurn:
    return balanced_in(report.analysis)


# --- views and lines ----------------------------------------------------------------------------------


@view("link", "parts", "lines")
class ShakenLink(Record):
    """A link whose inertia shakes the frame.

    `parts` are the ids of the components of its force; `lines` those of the arms of the force and of its moment.
    """

    link: int
    parts: list[str]
    lines: list[str]


@view("name", "lines", "masses")
class BalancingRule(Record):
    """A rule for the counterweight on the crank: "rms", "max", "rotating" or "share".

    `lines` are the ids of the inputs of U, of U and of its angle. `masses` are the ids of the point masses of rods at
    their pins, if the rule is the first that uses them.
    """

    name: str
    masses: list[str]
    lines: list[str]

    def __str__(self) -> str:
        return self.name


def shaken(report: ReportContext) -> tuple[ShakenLink, ...]:
    """Return the links that contribute to the force or moment on the frame, in the order of the file."""
    entered = []
    for body in report.machine.linkage.inertias:
        parts = report.known(balance_ids.force_of_link(body.link, axis) for axis in AXES)
        arms = report.known(balance_ids.place(body.centre, axis) for axis in AXES)
        moment = report.known([balance_ids.moment_of_link(body.link)])
        if parts or moment:
            entered.append(ShakenLink(body.link, parts, [*arms, *moment]))
    return tuple(entered)


def shaking_lines(report: ReportContext) -> list[str]:
    """Return the ids of F by its components, its direction, and M."""
    components = (balance_ids.component(axis) for axis in AXES)
    return report.known([*components, balance_ids.FORCE, balance_ids.DIRECTION, balance_ids.MOMENT])


def seen_lines(report: ReportContext) -> list[str]:
    """Return the ids of F as seen from the crank."""
    return report.known(balance_ids.seen(axis) for axis in AXES)


def balance_rules(report: ReportContext) -> tuple[BalancingRule, ...]:
    """Return the requested rules, in their order; the first one is applied."""
    printed_before: set[str] = set()
    rules = []
    for rule in _turn(report).products:
        masses = [id for id in report.ledger.families if id in balance_ids.point_mass] if rule in RODS else []
        own = [id for id in masses if id not in printed_before]
        printed_before.update(own)
        before = {
            "rms": [balance_ids.mean(axis) for axis in AXES],
            "max": [id for id in report.ledger.families if id in balance_ids.touching],
        }.get(rule, [])
        lines = [
            *before,
            *(balance_ids.rule_component(rule, axis) for axis in AXES),
            balance_ids.rule_product(rule),
            balance_ids.rule_angle(rule),
        ]
        rules.append(BalancingRule(rule, own, report.known(lines)))
    return tuple(rules)


RODS = ("rotating", "share")


def balancing_state(report: ReportContext) -> str:
    """Return the request: "none", the shaking force on the "frame", a counterweight on the "crank", "vain" if it is
    zero, or "links" for counterweights that balance all force of a four-bar.
    """
    turn = balanced_in(report.analysis)
    if turn.products:
        return "crank" if turn.weights else "vain"
    return "links" if turn.weights else "frame"


def counterweight_lines(report: ReportContext) -> list[str]:
    """Return the ids of U of each applied counterweight with its angle, its mass and its weight."""
    turn = _turn(report)
    lines: list[str] = []
    for weight in turn.weights:
        if not turn.products:
            lines += [balance_ids.rule_component(str(weight.link), axis) for axis in AXES]
        lines += [balance_ids.product(weight.link), balance_ids.angle(weight.link)]
    masses = [name(weight.link) for weight in turn.weights for name in (balance_ids.mass, balance_ids.weight)]
    return report.known([*lines, *masses, balance_ids.centrifugal(DRIVER)])


def after_lines(report: ReportContext) -> list[str]:
    """Return the ids of the remaining values at a position with the counterweights: force, reaction, moments."""
    weights = balanced_in(report.analysis).weights
    arms = [balance_ids.place(f"W{weight.link}", "x") for weight in weights]
    components = [balance_ids.after_component(axis) for axis in AXES]
    holds = [balance_ids.hold(weight.link) for weight in weights]
    rest = (balance_ids.AFTER_REACTION, balance_ids.AFTER_MOMENT, *arms, *holds, balance_ids.AFTER_TORQUE)
    return report.known([*components, balance_ids.AFTER_FORCE, *rest])


def on_link_lines(report: ReportContext) -> list[str]:
    """Return the ids of the places of a four-bar's mass centres on their links."""
    return [id for id in report.ledger.families if id in balance_ids.on_link]


def main_rule(report: ReportContext) -> str:
    """Return the name of the rule that is applied, for use in a sentence."""
    return str(report.words["balancing"]["chosen"][next(iter(_turn(report).products))])


def other_rules(report: ReportContext) -> list[str]:
    """Return the rules that are compared with the applied one, in words."""
    _, *others = _turn(report).products
    return [report.words["balancing"]["told"][rule] for rule in others]


def greatest_left(report: ReportContext) -> Value:
    """Return the greatest force (N) that remains with the applied counterweight."""
    return Value(report.ledger.number(balance_ids.greatest("F", next(iter(_turn(report).products)))))


# --- tables -------------------------------------------------------------------------------------------


def balanced_table(report: ReportContext) -> list[str]:
    """Return the ids of the values that the counterweights change, each next to its original."""
    pairs = (
        (balance_ids.FORCE, balance_ids.AFTER_FORCE),
        ("R.01", balance_ids.AFTER_REACTION),
        (balance_ids.MOMENT, balance_ids.AFTER_MOMENT),
        ("M.eq", balance_ids.AFTER_TORQUE),
    )
    return [id for pair in pairs if pair[1] in report.ledger for id in pair]


def rules_table(report: ReportContext) -> Iterator[Sequence[object]]:
    """Yield a row for each rule: its U, angle, greatest and mean force; the first row is without a counterweight."""
    words, turn = report.words["balancing"]["rules"], _turn(report)
    for state in (BEFORE, *turn.products):
        named = (balance_ids.rule_product, balance_ids.rule_angle)
        product = ["–", "–"] if state == BEFORE else [bare(report, name(state), None) for name in named]
        forces = [bare(report, id, None) for id in (balance_ids.greatest("F", state), balance_ids.rms(state))]
        yield words[state], *product, *forces


def cost_table(report: ReportContext) -> Iterator[Sequence[object]]:
    """Yield rows of the greatest force, the moments and the masses, before and after balancing."""
    after = next(iter(_turn(report).products), AFTER)
    for quantity, state in (("F", after), ("M", AFTER), ("cb", AFTER)):
        pair = report.known(balance_ids.greatest(quantity, when) for when in (BEFORE, state))
        if len(pair) == 2:
            yield _compared(report, quantity, pair)
    yield _compared(report, "mass", [balance_ids.whole_mass(state) for state in (BEFORE, AFTER)])


def _compared(report: ReportContext, name: str, pair: Sequence[str]) -> Sequence[object]:
    unit_of = report.ledger.printed_unit(report.ledger[pair[0]].how.unit)
    return report.words["balancing"]["costs"][name], *(bare(report, id, None) for id in pair), unit_of


# --- checks -------------------------------------------------------------------------------------------


def residuals(report: ReportContext) -> dict[str, float]:
    """Return how far the two checks of balancing are from zero, as shares without a unit.

    `balance` is the largest difference of F from the inertia reactions on the frame, as a share of the sum of the
    links' largest inertia forces. `rest`, only of a four-bar whose force is balanced by its links, is the remaining
    force as a share of the force before balancing.
    """
    analysis, turn = report.analysis, balanced_in(report.analysis)
    linkage, motion = analysis.machine.linkage, analysis.motion
    off = np.abs(shaking_force(linkage, motion) - frame_reactions(linkage, motion)).max()
    # Sum of the sizes of all links' inertia forces, since their vector sum may be zero.
    greatest = sum(body.mass * float(np.abs(motion.points[body.centre].a).max()) for body in linkage.inertias)
    entered = {"balance": float(off) / greatest}
    if balancing_state(report) == "links":
        left = turn.left / (turn.curve.greatest()[0] * turn.machine.speed**2)
        entered["rest"] = left
    return entered


# --- figures ------------------------------------------------------------------------------------------


def _of_turn(report: ReportContext) -> tuple[np.ndarray, np.ndarray, tuple[int, ...], tuple[str, ...]]:
    """Return F (N) [N] at the samples of a turn, e^{iφ} there [N], the indices of the shown positions, and
    their names.
    """
    cycle = report.dense_cycle
    count = int(np.searchsorted(cycle.cycle_angle, FULL_TURN * (1 + 1e-9), side="right"))
    force = shaking_force(report.machine.linkage, cycle.motion)[:count]
    positions = [k for k in report.positions if k <= report.machine.count]
    marks = np.searchsorted(cycle.cycle_angle, report.machine.cycle_angles[[k - 1 for k in positions]] - 1e-9)
    return force, unit(cycle.motion.driver)[:count], tuple(map(int, marks)), tuple(map(str, positions))


def hodograph(report: ReportContext) -> FigureScenes:
    """Draw the hodograph of F over the turn: the ends of its vectors from one pole."""
    force, _, marks, names = _of_turn(report)
    curve = PlottedCurve("", force.real, force.imag, marks, names)
    return FigureScenes((_polar(report, (curve,), balance_ids.component),))


def balanced_hodograph(report: ReportContext) -> FigureScenes:
    """Draw the hodographs of F without and with the applied counterweight, which must be one on the crank."""
    force, crank, marks, names = _of_turn(report)
    (weight,) = _turn(report).weights
    left = force + weight.product * report.machine.speed**2 * crank
    curves = (
        PlottedCurve(report.ledger.symbol(balance_ids.FORCE), force.real, force.imag, marks, names),
        PlottedCurve(report.ledger.symbol(balance_ids.AFTER_FORCE), left.real, left.imag, marks, names),
    )
    return FigureScenes((_polar(report, curves, balance_ids.component),))


def discs(report: ReportContext) -> FigureScenes:
    """Draw the scheme with the applied counterweights."""
    factor, index, motion = reduction(report), shown_at(report), report.analysis.motion
    scale = drawing_scale(report) * factor
    discs_drawn = []
    for weight in _turn(report).weights:
        pivot = complex(motion.origins[weight.link].p[index])
        arm = weight.place * complex(unit(motion.links[weight.link].angle[index]))
        discs_drawn.append(
            CounterweightDisc(pivot + arm, pivot, weight.mass, report.ledger.symbol(balance_ids.mass(weight.link)))
        )
    linkage = report.machine.linkage
    return FigureScenes((with_discs(linkage, motion, index, scale, looks(report, scale, factor), discs_drawn),))


def seen_curve(report: ReportContext) -> FigureScenes:
    """Draw F as seen from the crank, the smallest circle round it with its touching points, and the origin by each
    rule.
    """
    turn = _turn(report)
    force, crank, marks, names = _of_turn(report)
    seen = force / crank / report.machine.speed**2
    curves = [PlottedCurve(report.named(Symbol("u")), seen.real, seen.imag, marks, names)]
    if "max" in turn.products:
        round_it = turn.curve.circle
        touching = turn.curve.at(np.array(round_it.touching))
        # The touching points are vertices of the drawn circle, so that they can be marked on it.
        own = np.angle(touching - round_it.centre)
        angles = np.sort(np.concatenate((np.linspace(-np.pi, np.pi, ROUND), own)))
        circle = round_it.centre + round_it.radius * unit(angles)
        at = tuple(int(np.flatnonzero(angles == angle)[0]) for angle in own)
        labels = tuple(Symbol("T", str(number)) for number in range(1, len(own) + 1))
        curves.append(PlottedCurve("", circle.real, circle.imag, at, labels))
    origins = np.array([0j, *(-product for product in turn.products.values())])
    called = (Symbol("O"), *(report.named(Symbol("O", LETTERS[rule])) for rule in turn.products))
    every = tuple(range(origins.size))
    curves.append(PlottedCurve("", origins.real, origins.imag, every, called, dots=True))
    return FigureScenes((_polar(report, tuple(curves), balance_ids.seen),))


def _polar(report: ReportContext, curves: tuple[PlottedCurve, ...], component: ids.Name) -> Scene:
    """Draw hodographs whose axes have the symbols of these components."""
    ledger = report.ledger
    across, up = (
        Chain((ledger.symbol(component(axis)),), ledger.printed_unit(KINDS[ledger[component(axis)].kind].unit))
        for axis in AXES
    )
    diagram = Diagram(curves, across, up, turn=False, equal=True)
    return charts.polar(diagram, area=report.area)


# --- names of all views in templates ------------------------------------------------------------------

VALUES: Mapping[str, Callable[[ReportContext], Any]] = {
    "after_lines": after_lines,
    "balancing_state": balancing_state,
    "on_link_lines": on_link_lines,
    "seen_lines": seen_lines,
    "shaken": shaken,
    "shaking_lines": shaking_lines,
    **order_views.VALUES,
}
FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    "balance_rules": balance_rules,
    "counterweight_lines": counterweight_lines,
    "greatest_left": greatest_left,
    "main_rule": main_rule,
    "other_rules": other_rules,
}
FIGURES: Mapping[str, tuple[str, Callable[..., FigureScenes]]] = {
    "hodograph": ("fig.hodograph", hodograph),
    "seen": ("fig.seen", seen_curve),
    "counterweights": ("fig.counterweights", discs),
    "balanced": ("fig.balanced", balanced_hodograph),
    **order_views.FIGURES,
}

HOOKS = ViewHooks(
    values=VALUES,
    functions=FUNCTIONS,
    figures=FIGURES,
    tables={
        "shaking": QuantityTable(shaking_lines, "all_positions"),
        "rules": RowTable(rules_table, (58.0, 26.0, 22.0, 26.0, 26.0)),
        "factors": RowTable(factors_table, (20.0, 36.0, 36.0, 30.0)),
        "balanced": QuantityTable(balanced_table, "all_positions"),
        "costs": RowTable(cost_table, (78.0, 28.0, 28.0, 22.0)),
    },
    passages={"conclusion": always("balancing/conclusion"), "task": always("balancing/task")},
    residuals=residuals,
    letters="uUψTθrγβ",
)
