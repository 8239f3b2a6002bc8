"""Registry of the names that templates of a report may use: properties, values without parentheses, and functions.

Register a new one here; `names(report)` makes the namespace.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from operator import attrgetter
from typing import Any

from reportgen.base.template_access import template_members
from reportgen.report import (
    chapter_functions,
    guide_couples,
    interpolations,
    mechanism_figures,
    named_figures,
    named_tables,
    percussion,
    phrases,
    plan_figures,
    program_listing,
    quantity_tables,
    table_remarks,
    template_equations,
    topic_views,
    vector_equations,
)
from reportgen.report.context import ReportContext

PROPERTIES = (
    # the assignment, in words
    "extent_words",
    "machine_title",
    "turn_sense",
    "turn_words",
    "words",
    # positions
    "count",
    "cycle_count",
    "even_count",
    "even_cycle_count",
    "positions",
    "thinned",
    "worked",
    "worked_forces",
    # the machine
    "couples",
    "crank_pins",
    "driver",
    "driver_polygon",
    "dyads",
    "groups",
    "joined",
    "machine",
    "mobility",
    "own",
    "pistons",
    "plane_links",
    "sheet",
    "triads",
    # ids of quantities that are printed together
    "inertia_lines",
    "lengths",
    "mass_lines",
    # conditions
    "accelerated",
    "all_zero",
    "cyclic",
    "has_force",
    "has_forces",
    "has_own_load",
    "has_formulas",
    "has_gas",
    "has_turning_links",
    "instants",
    "loads_crank",
    "synthesised",
    "speed_in_rpm",
    "weighed",
)
"""Names of properties of the `ReportContext`."""
template_members(*PROPERTIES)(ReportContext)

VALUES: Mapping[str, Callable[[ReportContext], Any]] = {
    # the assignment, in words
    "attached": chapter_functions.attached,
    "begins_at": chapter_functions.begins_at,
    "reactions_at": table_remarks.reactions_at,
    "signature": chapter_functions.signature,
    "started": chapter_functions.started,
    "variant_words": chapter_functions.variant_words,
    "worked_at": table_remarks.worked_at,
    # words that depend on the contents of the report
    "constant_force": phrases.constant_force,
    "coupler": phrases.coupler,
    "diagram_words": chapter_functions.diagram_words,
    "driven": phrases.driven,
    "driver_loads": phrases.driver_loads,
    "energy_key": phrases.energy_key,
    "first_position": phrases.first_position,
    "acting": phrases.acting,
    "form": phrases.form,
    "lever": phrases.lever,
    "lettered": phrases.lettered,
    "load_key": phrases.load_key,
    "medium": phrases.medium,
    "no_mean": phrases.no_mean,
    "at_positions": phrases.at_positions,
    "no_cycle": phrases.no_cycle,
    "opposite_words": phrases.opposite_words,
    "scope": phrases.scope,
    "scope_key": phrases.scope_key,
    "slide_reactions": phrases.slide_reactions,
    "slider_convention": phrases.slider_convention,
    "strokes_at_start": phrases.strokes_at_start,
    "study": phrases.study,
    "turning": phrases.turning,
    # ids of quantities that are printed together
    "coordinate_lengths": interpolations.coordinate_lengths,
    "crank_lines": chapter_functions.crank_lines,
    "driver_joints": chapter_functions.driver_joints,
    "driver_reactions": chapter_functions.driver_reactions,
    "further_loads": chapter_functions.further_loads,
    "topic_loads": chapter_functions.topic_loads,
    "guide_couples": guide_couples.guide_couples,
    "gas_forces": chapter_functions.gas_forces,
    "inertia_parts": chapter_functions.inertia_parts,
    "lever_couples": chapter_functions.lever_couples,
    "mechanism_class": chapter_functions.mechanism_class,
    "mean_lines": chapter_functions.mean_lines,
    "tabled_forces": chapter_functions.tabled_forces,
    "uniform_rods": chapter_functions.uniform_rods,
    "without_mass": chapter_functions.without_mass,
    "work_lines": chapter_functions.work_lines,
    # conditions
    "has_chosen_scale": chapter_functions.has_chosen_scale,
    "has_moment_components": phrases.has_moment_components,
    "has_moments_of_inertia": phrases.has_moments_of_inertia,
    "plan_in_text": mechanism_figures.plan_in_text,
    "shares_pins": chapter_functions.shares_pins,
}
"""Functions of the report alone, whose results templates use as values."""

FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    "figure": named_figures.figure,
    "table": named_tables.table,
    "tables": quantity_tables.tables,
    # symbols, numbers, formulas
    "R": template_equations.R,
    "a": template_equations.a,
    "image": template_equations.image,
    "images": chapter_functions.images,
    "known": template_equations.known,
    "letters": template_equations.letters,
    "listing": program_listing.program,
    "line": template_equations.line,
    "lines": template_equations.lines,
    "lowered": template_equations.lowered,
    "math": template_equations.math,
    "point": template_equations.point,
    "points": template_equations.points,
    "quantity": template_equations.quantity,
    "symbol": template_equations.symbol,
    "typed": template_equations.typed,
    "v": template_equations.v,
    "value": template_equations.value,
    "vector": template_equations.vector,
    "theory": template_equations.theory,
    "theory_of": chapter_functions.theory_of,
    "zero": ReportContext.is_zero,
    # equations of the machine and of its groups
    "acceleration_equation": vector_equations.acceleration_equation,
    "driver_equation": vector_equations.driver_equation,
    "equations": template_equations.equations,
    "directions": template_equations.directions,
    "functions": template_equations.functions,
    "force_equation": vector_equations.force_equation,
    "link_equation": vector_equations.link_equation,
    "mobility_line": template_equations.mobility_line,
    "opposites": template_equations.opposites,
    "special_equation": vector_equations.special_equation,
    "third_equation": vector_equations.third_equation,
    "through_pin": template_equations.through_pin,
    "velocity_equation": vector_equations.velocity_equation,
    # words
    "balance_sign": phrases.balance_sign,
    "called": phrases.called,
    "links_called": phrases.links_called,
    "by_moments": template_equations.by_moments,
    "centre_state": mechanism_figures.centre_state,
    "couple_sense": guide_couples.couple_sense,
    "counted": phrases.counted,
    "drawn_group": phrases.drawn_group,
    "first_turn": ReportContext.first_turn,
    "parts": ReportContext.parts,
    "passages": topic_views.passages,
    "percussion_state": percussion.percussion_state,
    "force_list": template_equations.force_list,
    "group_kind": template_equations.group_kind,
    "load_sense": phrases.load_sense,
    "loads_read": interpolations.loads_read,
    "mode_of": phrases.mode_of,
    "mirror_images": plan_figures.mirror_images,
    "say": phrases.say,
    "senses": template_equations.senses,
    "sign": phrases.sign,
    "stop": phrases.stop,
    "stroke_name": template_equations.stroke_name,
    "smaller": named_figures.smaller,
    # steps of a construction
    "along": phrases.along,
    "base_motion": phrases.base_motion,
    "base_step": phrases.base_step,
    "found_senses": phrases.found_senses,
    "known_sense": phrases.known_sense,
    "line_start": phrases.line_start,
    "shows_coriolis": phrases.shows_coriolis,
    "sought": phrases.sought,
    "start": phrases.start,
    # remarks
    "balance_gaps": table_remarks.balance_gaps,
    "balance_mean": table_remarks.balance_mean,
    "balance_senses": table_remarks.balance_senses,
    "cause": table_remarks.cause,
    "main_peaks": table_remarks.main_peaks,
    "peaks": table_remarks.peaks,
    "remarks": table_remarks.remarks,
    "slider_rates": table_remarks.slider_rates,
    "top_reactions": table_remarks.top_reactions,
}
"""Functions of the report and of the arguments that a template passes."""


def names(report: ReportContext) -> dict[str, Any]:
    """Return the namespace of the report's templates, names of its topics included."""
    values = {**VALUES, **topic_views.merged(report, attrgetter("values"))}
    functions = {**FUNCTIONS, **topic_views.merged(report, attrgetter("functions"))}
    return {
        **{name: getattr(report, name) for name in PROPERTIES},
        **{name: of(report) for name, of in values.items()},
        **{name: partial(called, report) for name, called in functions.items()},
    }
