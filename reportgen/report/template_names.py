"""Registry of the names in templates of a report: properties, values without parentheses, functions with them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from operator import attrgetter
from typing import Any

from reportgen.base.template_access import shown
from reportgen.report import (
    chapters,
    comments,
    equations,
    figures,
    guide_couples,
    interpolations,
    listing,
    named_figures,
    named_tables,
    percussion,
    phrases,
    plans,
    tables,
    topic_views,
)
from reportgen.report.report import Report

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
    "groups",
    "joined",
    "machine",
    "mobility",
    "own",
    "pistons",
    "plane_links",
    "sheet",
    # what is set out together, by ids
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
"""Properties of the `Report`."""
shown(*PROPERTIES)(Report)

VALUES: Mapping[str, Callable[[Report], Any]] = {
    # the assignment, in words
    "attached": chapters.attached,
    "begins_at": chapters.begins_at,
    "reactions_at": comments.reactions_at,
    "signature": chapters.signature,
    "started": chapters.started,
    "variant_words": chapters.variant_words,
    "worked_at": comments.worked_at,
    # words that follow from what the report has
    "constant_force": phrases.constant_force,
    "coupler": phrases.coupler,
    "diagram_words": chapters.diagram_words,
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
    # what is set out together, by ids
    "coordinate_lengths": interpolations.coordinate_lengths,
    "crank_lines": chapters.crank_lines,
    "driver_joints": chapters.driver_joints,
    "driver_reactions": chapters.driver_reactions,
    "further_loads": chapters.further_loads,
    "topic_loads": chapters.topic_loads,
    "guide_couples": guide_couples.guide_couples,
    "gas_forces": chapters.gas_forces,
    "inertia_parts": chapters.inertia_parts,
    "lever_couples": chapters.lever_couples,
    "mean_lines": chapters.mean_lines,
    "tabled_forces": chapters.tabled_forces,
    "uniform_rods": chapters.uniform_rods,
    "without_mass": chapters.without_mass,
    "work_lines": chapters.work_lines,
    # conditions
    "has_chosen_scale": chapters.has_chosen_scale,
    "has_moment_components": phrases.has_moment_components,
    "has_moments_of_inertia": phrases.has_moments_of_inertia,
    "plan_in_text": figures.plan_in_text,
    "shares_pins": chapters.shares_pins,
}
"""Values that functions compute from a report."""

FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    "figure": named_figures.figure,
    "table": named_tables.table,
    "tables": tables.tables,
    # symbols, numbers, formulas
    "R": equations.R,
    "a": equations.a,
    "image": equations.image,
    "images": chapters.images,
    "known": equations.known,
    "letters": equations.letters,
    "listing": listing.program,
    "line": equations.line,
    "lines": equations.lines,
    "lowered": equations.lowered,
    "math": equations.math,
    "point": equations.point,
    "points": equations.points,
    "quantity": equations.quantity,
    "symbol": equations.symbol,
    "typed": equations.typed,
    "v": equations.v,
    "value": equations.value,
    "vector": equations.vector,
    "theory": equations.theory,
    "theory_of": chapters.theory_of,
    "zero": Report.is_zero,
    # equations of the machine and of its groups
    "acceleration_equation": equations.acceleration_equation,
    "driver_equation": equations.driver_equation,
    "equations": equations.equations,
    "directions": equations.directions,
    "functions": equations.functions,
    "force_equation": equations.force_equation,
    "link_equation": equations.link_equation,
    "mobility_line": equations.mobility_line,
    "opposites": equations.opposites,
    "through_pin": equations.through_pin,
    "velocity_equation": equations.velocity_equation,
    # words
    "balance_sign": phrases.balance_sign,
    "by_moments": equations.by_moments,
    "centre_state": figures.centre_state,
    "couple_sense": guide_couples.couple_sense,
    "counted": phrases.counted,
    "drawn_group": phrases.drawn_group,
    "first_turn": Report.first_turn,
    "parts": Report.parts,
    "passages": topic_views.passages,
    "percussion_state": percussion.percussion_state,
    "force_list": equations.force_list,
    "group_kind": equations.group_kind,
    "load_sense": phrases.load_sense,
    "loads_read": interpolations.loads_read,
    "mirror_images": plans.mirror_images,
    "say": phrases.say,
    "senses": equations.senses,
    "sign": phrases.sign,
    "stop": phrases.stop,
    "stroke_name": equations.stroke_name,
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
    "balance_gaps": comments.balance_gaps,
    "balance_mean": comments.balance_mean,
    "balance_senses": comments.balance_senses,
    "cause": comments.cause,
    "main_peaks": comments.main_peaks,
    "peaks": comments.peaks,
    "remarks": comments.remarks,
    "slider_rates": comments.slider_rates,
    "top_reactions": comments.top_reactions,
}
"""Functions of a report and of what a template puts between the parentheses."""


def names(report: Report) -> dict[str, Any]:
    """Return all that the templates of a report may name."""
    values = {**VALUES, **topic_views.merged(report, attrgetter("values"))}
    functions = {**FUNCTIONS, **topic_views.merged(report, attrgetter("functions"))}
    return {
        **{name: getattr(report, name) for name in PROPERTIES},
        **{name: of(report) for name, of in values.items()},
        **{name: partial(called, report) for name, called in functions.items()},
    }
