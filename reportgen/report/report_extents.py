"""Sections that a report of each extent (full, short) begins with and leaves out."""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.assignment.common import Extent

OPENING: Mapping[Extent, tuple[str, ...]] = {"full": (), "short": ("contents", "foreword")}
"""Sections that precede all others, independently of the outline's order."""
LEFT_OUT: Mapping[Extent, frozenset[str]] = {
    "full": frozenset(),
    "short": frozenset(
        (
            # sections of the outline
            *("overview", "foreword", "symbols", "centres", "diagrams", "course", "functions", "checks"),
            # extreme positions that nothing else depends on
            *("rocker-extremes", "slider-extremes"),
            # the theory behind the plans
            *("theory-two-equations", "theory-inclination", "theory-similarity"),
            # constructions step by step, plans of the other positions, further curves
            *("velocity-stages", "acceleration-stages", "force-stages"),
            *("velocity-plates", "acceleration-plates", "force-plates", "coriolis-turn"),
            "polar",
            # a second method, and the book that it is taken from
            *("formulas-velocity", "formulas-acceleration", "further-references"),
            # tables that later work does not use, and the remarks on them
            *("joints", "coordinates", "velocity-senses", "acceleration-senses", "inertia-positions"),
            *("reactions", "mean-positions", "conclusion-reactions"),
            # remarks
            *("comments/velocity", "comments/acceleration", "comments/loads", "comments/inertia"),
            *("comments/reactions", "comments/torque"),
            # relative velocities and accelerations in tables, and loads at positions other than worked ones
            *("relative", "loads-everywhere"),
            # positions as large as they are measured by, links and directions that another figure shows as well
            *("true-size", "links-together", "mechanism-beside-forces", "high-curves"),
            # the usual size of type, pages of their own for the contents
            *("usual-type", "contents-page"),
        )
    ),
}
"""Sections, parts of sections and other features that a report of an extent leaves out."""
OF_A_TURN = frozenset(
    (
        # results at the other positions of a turn, curves over the turn
        *("velocity-plates", "acceleration-plates", "force-plates", "polar", "mean-positions"),
        *("diagrams", "torque-curve"),
        # the course of quantities over the turn
        *("comments/velocity", "comments/acceleration", "comments/loads", "comments/inertia"),
        *("comments/reactions", "comments/torque"),
    )
)
"""Sections that a report of single instants leaves out."""
