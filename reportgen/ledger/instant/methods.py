"""The methods by which velocities are found, each as the steps that are its own, and in which order they are tried."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from reportgen.catalogue.plane_motion_file import Method
from reportgen.ledger.instant.base_points import by_base_point, from_base_point
from reportgen.ledger.instant.board import Board, Step
from reportgen.ledger.instant.projections import by_projection
from reportgen.ledger.instant.proportion import enter_proportion
from reportgen.ledger.instant.speeds import about_joints, by_centre, by_moving_frame, derive
from reportgen.ledger.instant.systems import solve_velocities_together
from reportgen.ledger.instant.trains import by_train

Finder = Callable[[Board], bool]
"""Enters one more velocity, or those of one more body; whether there was one."""

CHOSEN: tuple[Finder, ...] = (derive, by_base_point, enter_proportion, by_train, solve_velocities_together)
"""Chosen well for each step: the instant centre wherever there is one; all that is left over together."""

OWN: Mapping[Method, tuple[Finder, ...]] = {
    "instant centre": (by_centre, enter_proportion),
    "base point": (from_base_point, by_base_point),
    "projection": (by_projection,),
    "moving frame": (by_moving_frame,),
}

_KINDS: Mapping[Method, tuple[str, ...]] = {
    "instant centre": (
        "rate-contact",
        "rate-normals",
        "rate-parallel",
        "speed-",
        "translation",
        "at-rest",
        "proportion",
    ),
    "base point": ("base-", "two-bases"),
    "projection": ("projection",),
    "moving frame": ("slot-",),
}


def belongs(step: Step, method: Method) -> bool:
    """Whether a step is one of the method's own."""
    return step.kind != "speed-pivot" and step.kind.startswith(_KINDS[method])


def find_velocities(board: Board, method: Method | None, alone: bool = False) -> None:
    """Enters all velocities that the method leads to, and unless it stands alone, those that others then lead to.

    What a joint makes turn about a fixed point or move in translation belongs to every method, and so does the motion
    along the line of a moving body, for which there is no other one; a moving frame in its turn may be carried by
    bodies of any motion.
    """
    finders = CHOSEN
    if method is not None:
        own = (about_joints, *OWN[method], by_moving_frame)
        finders = own if alone and method != "moving frame" else (*own, *CHOSEN)
    while any(find(board) for find in finders):
        pass
