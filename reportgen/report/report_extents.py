"""Contents of a report of each extent, and the sections that it leaves out."""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.assignment.common import Extent

OPENING: Mapping[Extent, tuple[str, ...]] = {"full": (), "short": ("contents", "foreword")}
"""Sections before all others, whatever the order of the outline."""
LEFT_OUT: Mapping[Extent, frozenset[str]] = {
    "full": frozenset(),
    "short": frozenset(
        (
            # sections of the outline
            *("overview", "foreword", "symbols", "centres", "diagrams", "course", "functions", "checks"),
            # extreme positions that nothing else stands on
            *("rocker-extremes", "slider-extremes"),
            # what the plans stand on
            *("theory-two-equations", "theory-inclination", "theory-similarity"),
            # constructions step by step, plans of the other positions, further curves
            *("velocity-stages", "acceleration-stages", "force-stages"),
            *("velocity-plates", "acceleration-plates", "force-plates", "coriolis-turn"),
            "polar",
            # a second method, and the book that it is taken from
            *("formulas-velocity", "formulas-acceleration", "further-references"),
            # tables that the work goes on without, and what is said of them
            *("joints", "coordinates", "velocity-senses", "acceleration-senses", "inertia-positions"),
            *("reactions", "mean-positions", "conclusion-reactions"),
            # remarks
            *("comments/velocity", "comments/acceleration", "comments/loads", "comments/inertia"),
            *("comments/reactions", "comments/torque"),
            # in tables relative velocities and accelerations, and loads at other than worked positions
            *("relative", "loads-everywhere"),
            # positions as large as they are measured by, links and directions that another figure shows as well
            *("true-size", "links-together", "mechanism-beside-forces", "high-curves"),
            # the usual size of type, pages of their own for the contents
            *("usual-type", "contents-page"),
        )
    ),
}
"""The sections, parts of sections and further parts that a report of an extent goes without."""
OF_A_TURN = frozenset(
    (
        # what is worked out for the other positions of a turn, curves over the turn
        *("velocity-plates", "acceleration-plates", "force-plates", "polar", "mean-positions"),
        *("diagrams", "torque-curve"),
        # how quantities go over the turn
        *("comments/velocity", "comments/acceleration", "comments/loads", "comments/inertia"),
        *("comments/reactions", "comments/torque"),
    )
)
"""Sections that a report of single instants leaves out."""
