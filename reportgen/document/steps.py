"""The steps in which a plan is drawn, in words: where a line begins, its direction, what it stands for.

`what` is "v" for the velocity plan, "a" for the acceleration plan.
"""

from __future__ import annotations

from reportgen.document.equations import a, image, math, quantity, v
from reportgen.document.groups import CarriedPoint, GroupView
from reportgen.document.phrases import say, sign
from reportgen.document.prose import PointName
from reportgen.document.report import Report, lower_digits
from reportgen.document.tree import Inlines, Reference
from reportgen.ledger.kinematics.sides import Side
from reportgen.notation.expressions import Symbol

POLES = {"v": "p", "a": "π"}


def _image(report: Report, what: str, name: str) -> Symbol:
    return image(report, name, what == "a")


def start(report: Report, what: str, of: Side | CarriedPoint) -> Inlines:
    """Where the vector relative to a base begins on a plan: in the pole, or at the end of the base's own vector."""
    words = report.words["plan"]
    if of.still:
        return say(report, words["pole"], pole=math(report, POLES[what]))
    return say(report, words["end"], image=_image(report, what, of.base))


def line_start(report: Report, what: str, side: Side) -> Inlines:
    """Where the line of what is sought begins: at the end of the known relative acceleration, if there is one."""
    if what == "a" and side.part:
        return say(report, report.words["plan"]["end_of"], vector=a(report, side, side.part))
    return start(report, what, side)


def along(report: Report, side: Side) -> Inlines:
    """The direction of what is sought on a side."""
    return say(report, report.words["plan"]["directions"][side.way], rod=lower_digits(side.rod))


def sought(report: Report, what: str, group: GroupView, side: Side) -> Symbol:
    """The vector that is sought on a side: of the point itself where the side's base is at rest, else the relative."""
    if what == "v":
        return v(report, group.M if side.still else side)
    if side.turns:
        return a(report, side, "τ")
    return a(report, group.M) if side.still and not side.turning else a(report, side, "r")


def base_step(report: Report, what: str, group: GroupView, side: Side, position: int) -> Inlines:
    """How the vector of a side's base comes on the plan."""
    return say(
        report,
        report.words["plan"]["base"][group.base(what, side, position)],
        vector=(v if what == "v" else a)(report, side.shown),
        image=_image(report, what, side.base),
        pole=math(report, POLES[what]),
        segment=quantity(report, group.base_segment(what, side), position),
    )


def known_sense(report: Report, side: Side) -> Inlines:
    """The sense of the relative acceleration that velocities give: towards the base, or as Coriolis turned it."""
    ends = {"point": PointName(side.point), "base": PointName(side.base)}
    return say(report, report.words["plan"]["senses"]["centre" if side.turns else "coriolis"], **ends)


def base_motion(report: Report, side: Side) -> Inlines:
    """What is known of a side's base: that it is fixed, or its velocity."""
    return say(report, report.words["plan"]["bases"][side.state], base=PointName(side.base))


def shows_coriolis(report: Report, group: GroupView, side: Side, position: int) -> bool:
    """Whether a figure shows the turn that gives the Coriolis acceleration of a slot its sense."""
    return group.kind == "RPR" and not any(report.is_zero(id, position) for id in (side.velocity, side.omega))


def found_senses(report: Report, group: GroupView, position: int) -> Inlines:
    """What the signs of the reactions say that moments gave."""
    words, figure = report.words["plan"]["found"], Reference(f"fig.bodies.{group}.{position}")
    found = [(id, sign(report, id, position)) for id in group.assumed]
    return tuple(
        part
        for id, way in found
        if way != "zero"
        for part in say(report, words[way], force=report.ledger.symbol(id), figure=figure)
    )
