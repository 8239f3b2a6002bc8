"""The names in templates, one table a kind of name: what a template may write, and what it then gets.

`{{ count }}` is a property of the report, `{{ started }}` what a function makes of the report, `{{ symbol("l.AB") }}` a
function of the report and of what stands in the parentheses.  `{{ figure("scheme") }}` and `{{ table("given") }}` name
their figure and table in tables of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import chain
from operator import attrgetter
from typing import Any

from reportgen.base.shown import shown
from reportgen.case import MachineAnalysis
from reportgen.case.finished import finished
from reportgen.document import (
    Block,
    Document,
    Figure,
    InlineMath,
    Inlines,
    PageBreak,
    Paragraph,
    Plate,
    Reference,
    Section,
    Text,
)
from reportgen.document.layout import contents
from reportgen.document.paper import PAPERS, FigureScenes, close
from reportgen.document.used_symbols import used_symbols
from reportgen.machine.analysis import Position
from reportgen.report import (
    chapters,
    comments,
    curves,
    equations,
    figures,
    force_figures,
    guide_couples,
    interpolations,
    listing,
    percussion,
    phrases,
    plans,
    tables,
    topic_views,
)
from reportgen.report import chapters as overview
from reportgen.report import figures as centres
from reportgen.report import phrases as steps
from reportgen.report.groups import GroupView
from reportgen.report.named_tables import table
from reportgen.report.report import Report
from reportgen.report.topic_views import DrawnFigure

# --- names without parentheses ----------------------------------------------------------------------

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
"""What functions make of a report."""

# --- figures ----------------------------------------------------------------------------------------

VELOCITY, ACCELERATION = plans.MotionFigures("v"), plans.MotionFigures("a")

FIGURES: Mapping[str, tuple[str, Callable[..., FigureScenes]]] = {
    "line-styles": ("fig.line-styles", figures.line_styles),
    # the machine
    "scheme": ("fig.scheme", figures.scheme),
    "groups": ("fig.groups", figures.groups),
    "positions": ("fig.positions", figures.positions),
    "extremes": ("fig.extremes", figures.extremes),
    "swing": ("fig.swing", figures.swing),
    # motion
    "velocity": ("fig.v", VELOCITY.whole),
    "velocity-stages": ("fig.v.stages", VELOCITY.in_stages),
    "velocity-plates": ("fig.v.plates", VELOCITY.on_plates),
    "acceleration": ("fig.a", ACCELERATION.whole),
    "acceleration-stages": ("fig.a.stages", ACCELERATION.in_stages),
    "acceleration-plates": ("fig.a.plates", ACCELERATION.on_plates),
    "coriolis": ("fig.coriolis", figures.coriolis),
    "inclination": ("fig.inclination", figures.inclination),
    "two-equations": ("fig.twice", figures.two_equations),
    "similarity": ("fig.similarity", figures.similarity),
    "centres": ("fig.centres", centres.centres),
    "motion": ("fig.motion", curves.motion),
    # forces
    "indicator": ("fig.indicator", figures.indicator),
    "bodies": ("fig.bodies", force_figures.bodies),
    "forces": ("fig.R", plans.forces),
    "force-stages": ("fig.R.stages", plans.force_stages),
    "force-plates": ("fig.R.plates", plans.force_plates),
    "crank": ("fig.crank", force_figures.driver),
    "slide": ("fig.slide", force_figures.driver),
    "lever": ("fig.lever", force_figures.lever),
    "polar": ("fig.polar", curves.polar),
    "torque": ("fig.M", curves.torque),
}
"""What the keys of a figure begin with, and who draws it; its caption stands in `words.yaml` under `captions`."""


def figure(report: Report, name: str, *arguments: Any, words: str = "") -> tuple[Figure | Plate, ...]:
    """A figure by its name: `figure(name, …)`, or `figure(name, key, caption, …)` with words of its own;
    `words` names other ones of `words.yaml`.

    A figure on plates is a block for each of them; the first has key and caption.  Raises `KeyError` for a
    name that nobody draws.
    """
    key, draw = _drawn(report, name)
    at = ""
    if arguments and isinstance(arguments[0], str):
        key, caption, *shown = arguments
    else:
        shown = list(arguments)
        group = next((one for one in shown if isinstance(one, GroupView)), None)
        position = next((one for one in shown if isinstance(one, Position)), None)
        key = ".".join(str(part) for part in (key, group, position) if part is not None)
        at = "" if position is None else str(position)
        links = {"i": group.i, "j": group.j} if group else None
        caption = report.words["captions"][words or name].format(k=position, g=links)
    drawn = draw(report, *shown)
    if drawn.paper is None and not drawn.turned and not report.parts("usual-type"):
        drawn = replace(drawn, scenes=tuple(map(close, drawn.scenes)))
    inlines = report.prose.inlines(caption)
    inlines = (*inlines, *phrases.shown_smaller(report, drawn.smaller, "caption"))
    if drawn.note is not None:
        inlines = (*inlines, Text("; "), InlineMath(drawn.note))
    if drawn.paper is None:
        return (Figure(drawn.scenes, inlines, key, turned=drawn.turned, at=at),)
    first, *others = drawn.scenes
    further = (Plate(scene, drawn.paper, continues=True) for scene in others)
    return Plate(first, drawn.paper, inlines, key, at=at), *further


def _drawn(report: Report, name: str) -> DrawnFigure:
    """Return the key of a figure, and the function that draws it.  Raises `KeyError` for a name that is not known."""
    return FIGURES[name] if name in FIGURES else topic_views.merged(report, attrgetter("figures"))[name]


def smaller(report: Report, name: str) -> Inlines:
    """What the text says of a figure by its name that is shown smaller than to the scales of the text."""
    return phrases.shown_smaller(report, _drawn(report, name)[1](report).smaller, name)


def plates_last(blocks: Iterable[Block], said: Callable[[Plate], Paragraph]) -> Iterator[Block]:
    """Yield the blocks with the plates of each chapter at its end; where one was called for, `said` tells that.

    A page of text ends early before a plate: so once in a chapter at most.
    """
    plates: list[Plate] = []
    for block in blocks:
        if isinstance(block, Plate):
            plates.append(block)
            if not block.continues:
                yield said(block)
            continue
        if isinstance(block, Section) and block.level == 1:
            yield from plates
            plates.clear()
        yield block
    yield from plates


# --- names with parentheses -------------------------------------------------------------------------

FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    "figure": figure,
    "table": table,
    "tables": tables.tables,
    # symbols, numbers, formulas
    "R": equations.R,
    "a": equations.a,
    "image": equations.image,
    "images": overview.images,
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
    "centre_state": centres.centre_state,
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
    "smaller": smaller,
    # steps of a construction
    "along": steps.along,
    "base_motion": steps.base_motion,
    "base_step": steps.base_step,
    "found_senses": steps.found_senses,
    "known_sense": steps.known_sense,
    "line_start": steps.line_start,
    "shows_coriolis": steps.shows_coriolis,
    "sought": steps.sought,
    "start": steps.start,
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


# --- case → Document ------------------------------------------------------------------------------
# Cover, contents and the sections that the machine's outline names.


LISTING = "symbols"
"""The section of what all others use."""
OWN_LETTERS = "structure"
"""The section of the formula of mobility, whose letters are its own and told below it: its W is no work."""


def compose(case: MachineAnalysis) -> Document:
    """The finished, numbered report of a machine; raises `TemplateError` for a fault in its words."""
    report = Report(case)
    words, named = report.words, names(report)
    written: dict[str, Sequence[Block]] = {}
    # The list of symbols comes last: it lists those of all other sections.
    for section in sorted(report.sections, key=LISTING.__eq__):
        if section == "contents":
            continue
        if section == LISTING:
            others = (blocks for name, blocks in written.items() if name != OWN_LETTERS)
            whole = replace(report, used_symbols=used_symbols(chain.from_iterable(others)))
            named["table"] = partial(table, whole)
        written[section] = report.prose.render(section, named)
    if "contents" in report.sections:
        brief = not report.parts("contents-page")
        every = chain.from_iterable(written.values())
        written["contents"] = [PageBreak(), contents(words["document"]["contents"], every, brief)]
    blocks = [case.cover, *chain.from_iterable(written[section] for section in report.sections)]
    return finished(case, plates_last(blocks, partial(_plate_is_last, report)), close=not report.parts("usual-type"))


def _plate_is_last(report: Report, plate: Plate) -> Paragraph:
    """Says where a plate stands."""
    paper = PAPERS.get(min(plate.paper), "")
    return Paragraph(phrases.say(report, report.words["plate"], figure=(Reference(plate.key),), paper=paper))
