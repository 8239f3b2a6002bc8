"""Force plans with friction over those without."""

from __future__ import annotations

from reportgen.base.records import replace
from reportgen.base.units import MM
from reportgen.derivation.load_entries import Edge, Polygon
from reportgen.drawing.vector_plan import SAME_POINT, Plan, PlanPoint, PlanVector
from reportgen.formula import Symbol, ids
from reportgen.friction.joints import with_friction
from reportgen.report.context import ReportContext
from reportgen.report.plan_figures import force_plan

CLOSING = "n"
"""The corner that closes a force plan."""


def force_plan_with_friction(report: ReportContext, polygon: Polygon, k: int) -> Plan:
    """Return the plan without friction, with whole reactions, and the plan with friction where it differs.

    Both have the same loads; reactions from other groups and those that close the plan include friction in the second.
    """
    drawing, μ = force_plan(report, polygon, k), float(report.ledger[ids.force_scale(polygon.name)].at(k))
    per_newton = MM / μ / report.enlarged
    known = _laid(polygon)
    closing = _closing(polygon)
    named = {vector.name: vector for vector in drawing.vectors}
    corners: dict[str, complex] = {}
    vectors = []
    for edge in (*known, *closing):
        vectors.append(named[edge.start + edge.end])
        corners |= {edge.start: vectors[-1].start, edge.end: vectors[-1].end}
    at = first = corners[closing[-1].end]
    moved: list[PlanVector[complex]] = []
    points: list[PlanPoint[complex]] = []
    for edge in (*known, *closing):
        if edge is closing[-1]:
            end = first
        elif edge.is_reaction:
            end = at + _with_friction(report, edge.name, k) * per_newton
        else:
            end = at + corners[edge.end] - corners[edge.start]
        if abs(at - corners[edge.start]) > SAME_POINT or abs(end - corners[edge.end]) > SAME_POINT:
            digits = edge.name.removeprefix("R")
            symbol = report.named(Symbol("R", digits, "fr", "vector"))
            # A load gets its name at its new place in the plan with friction.
            vector = symbol if edge.is_reaction else report.force_vector(edge.name)
            name = f"{edge.start}{edge.end}.fr"
            moved.append(PlanVector(name, at, end, "relative", vector, lettered=not edge.is_reaction))
            if end != first:
                points.append(PlanPoint(Symbol(edge.end, sup="′"), end))
        at = end
    kept = {corners[letter] for letter in corners}
    return replace(
        drawing, vectors=(*vectors, *moved), points=(*(point for point in drawing.points if point.at in kept), *points)
    )


def _laid(polygon: Polygon) -> list[Edge]:
    """Return the loads of a plan head to tail, with the whole reaction of a triad's third leg where it parts them."""
    loads = [edge for edge in polygon.edges if not edge.unknown and not edge.part]
    whole = [edge for edge in polygon.reads if not edge.part]
    path = loads[:1]
    for edge in loads[1:]:
        path += [each for each in whole if (each.start, each.end) == (path[-1].end, edge.start)]
        path.append(edge)
    return path


def _closing(polygon: Polygon) -> list[Edge]:
    """Return the whole reactions that close a plan, head to tail from the end of its loads."""
    edges = [edge for edge in (*polygon.edges, *polygon.reads) if edge.unknown and not edge.part]
    loads = [edge for edge in polygon.edges if not edge.unknown and not edge.part]
    # Without loads the reaction in the outer joint, which leads to the closing corner, begins where the plan does.
    begin = next((edge.start for edge in edges if edge.end == CLOSING), "")
    at, first = (loads[-1].end, loads[0].start) if loads else (begin, begin)
    path: list[Edge] = []
    while not path or at != first:
        path.append(next(edge for edge in edges if edge.start == at and edge not in path))
        at = path[-1].end
    return path


def _with_friction(report: ReportContext, name: str, k: int) -> complex:
    """Return a reaction by its name (N), with the force of friction in its guide."""
    solved = with_friction(report.analysis)
    assert solved is not None
    rubbing = sum(complex(load.force[k - 1]) for load in solved.loads if load.name == name)
    return complex(solved.forces.reactions[name].force[k - 1]) + rubbing
