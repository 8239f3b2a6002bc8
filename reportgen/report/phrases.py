"""Phrases that depend on a count, a sign or a kind: `words.yaml` contains them, a template selects them by name.

`{{ driven.balance }}` is the balancing load of the report's driver, `{{ counted("each_group", groups) }}` a phrase on
one group or on several.  Placeholders in braces are filled with members of the objects passed with the phrase.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence, Sized
from contextlib import suppress
from math import degrees
from string import Formatter
from typing import TYPE_CHECKING, Any

from reportgen.base.errors import TemplateError
from reportgen.base.languages import setting_of
from reportgen.base.placeholders import place_of
from reportgen.base.template_access import member
from reportgen.base.template_access import text as as_text
from reportgen.base.units import MM
from reportgen.base.words import unfilled
from reportgen.derivation.equation_sides import Side
from reportgen.derivation.kinematic_entries import POLES
from reportgen.document import Inline, InlineMath, Inlines, Reference, Text, Value
from reportgen.document.template_rendering import NamedPoint, subscripted
from reportgen.document.value_insertion import inlines
from reportgen.formula import Chain, Number, Symbol, ids, vocabulary
from reportgen.report.assur_view import AssurView
from reportgen.report.context import ReportContext
from reportgen.report.link_views import CarriedPoint, GroupView
from reportgen.report.template_equations import a, image, math, quantity, slider_ways, v, value

if TYPE_CHECKING:
    from reportgen.catalogue.linkage_words import GroupRow


def say(report: ReportContext, phrase: str, *about: Any, **gaps: Any) -> Inlines:
    """Return a phrase of `words.yaml` with its placeholders filled by name, or from readable members of the objects
    `about`.

    Raises `TemplateError`, or `ValueError` for a phrase of a template, if nothing fills a placeholder.
    """
    said: list[Inline] = []
    try:
        for text, name, how, _ in Formatter().parse(str(phrase)):
            said += [Text(text)] if text else []
            said += _gap(report, name, how or "", about, gaps) if name is not None else ()
    except (LookupError, TypeError, ValueError) as error:
        refusal = unfilled(phrase, gaps, report.assignment.language)
        mark = place_of(phrase, report.words)
        raise (TemplateError(f"{mark}: {refusal}") if mark else ValueError(refusal)) from error
    return tuple(said)


def _gap(report: ReportContext, name: str, how: str, about: Sequence[Any], gaps: Mapping[str, Any]) -> Inlines:
    """Return the inlines for a placeholder: the given value, a member, a reference `@tab.dead`, else a quantity.

    A quantity is named as between dollar signs in a template: `{e}` is its symbol, `{e:value}` its number and
    `{e:quantity}` both.
    """
    if name in gaps:
        return inlines(gaps[name])
    for member_of in about:
        with suppress(LookupError):
            return inlines(member(member_of, name))
    if name.startswith("@"):
        return (Reference(name[1:]),)
    if how == "quantity":
        return quantity(report, name)
    return (value(report, name),) if how == "value" else (InlineMath(math(report, name)),)


def counted(report: ReportContext, name: str, things: Collection[Any], **gaps: Any) -> Inlines:
    """Return the phrase about some things in the form for their number; () for none.

    `words.yaml` has one form for all numbers, two (one, many), or three (Slavic languages: 1; 2 to 4; 5 and more, see
    `form_of`).  The placeholders `count` and `list` stand for the number of things and their names.
    """
    if not len(things):
        return ()
    words = report.words["counted"][name]
    phrase = words if isinstance(words, str) else words[form_of(len(things), len(words))]
    with suppress(TypeError):
        gaps["list"] = ", ".join(map(as_text, things))
    return say(report, phrase, **{"count": len(things), **gaps})


def form_of(count: int, forms: int) -> int:
    """Return the index of the word form, of two or three, for a number: 0 for 1, 21; 1 for 2, 3, 4, 22; 2 for 5, 11,
    20.
    """
    if forms < 3:
        return int(count > 1)
    last, teen = count % 10, count // 10 % 10 == 1
    return 0 if last == 1 and not teen else 1 if 2 <= last <= 4 and not teen else 2


def reduction_remark(report: ReportContext, times: float, name: str) -> Inlines:
    """Return the remark on a figure that is smaller than μ_l by the factor `times`; () if the factor is 1."""
    if times == 1.0:
        return ()
    scale = Chain((report.ledger.symbol("mu.l"), report.ledger.number("mu.l")))
    return say(report, report.words["smaller"][name], times=Number(times), scale=scale)


def sign(report: ReportContext, id: str, position: int | None = None) -> str:
    """Return the key of the phrase for a quantity's printed sign: "zero", "negative" or "positive"."""
    number = report.ledger.number(id, position).value
    return "zero" if number == 0 else "negative" if number < 0 else "positive"


def stop(report: ReportContext, loop: Mapping[str, Any], *further: Sized) -> str:
    """Return the mark at the end of a list item: a full stop after the last one, if nothing `further` follows it."""
    return "." if loop["last"] and not any(map(len, further)) else ";"


# --- phrases by the contents of the report


def _set(report: ReportContext, name: str, key: str, *about: Any, **gaps: Any) -> Mapping[str, Inlines]:
    """Return the phrases that `words.yaml` has under a name and a key, with their placeholders filled."""
    return {one: say(report, phrase, *about, **gaps) for one, phrase in report.words[name][key].items()}


def driven(report: ReportContext) -> Mapping[str, Inlines]:
    """Return the phrases for the driver, a crank or a slide, which may be accelerated, and for its balancing load."""
    words = _set(report, "driven", report.driver.kind, report.driver, report)
    if not report.accelerated:
        return words
    change = "faster" if report.machine.acceleration > 0 else "slower"
    return {**words, **_set(report, "accelerated", f"{report.driver.kind}-{change}", report.driver, report)}


def at_positions(report: ReportContext) -> Inlines:
    """Return the phrase for the positions at which a task asks for the motion: the positions of a turn, or the given
    instants.
    """
    words = report.words["at_positions"]
    return say(report, words["instants"][report.count > 1] if report.instants else words["turn"], report)


def no_cycle(report: ReportContext) -> Inlines:
    """Return the reason why the report says nothing about the cycle as a whole; () if it does."""
    if report.cyclic:
        return ()
    key = "accelerated" if report.accelerated else "instants"
    return say(report, report.words["no_cycle"][key], report.words["driven"][report.driver.kind])


def acting(report: ReportContext) -> str:
    """Return the phrase for the loads of a machine without applied loads: its weights, or its inertia alone."""
    return str(report.words["acting"]["weights" if report.weighed else "inertia"])


def scope(report: ReportContext) -> Mapping[str, Inlines]:
    """Return the phrases for the extent of the analysis: forces, or motion alone."""
    return _set(report, "scope", scope_key(report), report.words["driven"][report.driver.kind])


def scope_key(report: ReportContext) -> str:
    return "forces" if report.has_forces else "motion"


def study(report: ReportContext) -> Mapping[str, Inlines]:
    """Return the phrases for the method: an analysis, or a synthesis and an analysis."""
    return _set(report, "study", "synthesis" if report.synthesised else "analysis")


def turning(report: ReportContext) -> Mapping[str, Inlines]:
    """Return the phrases about links that turn, or those for "none" if no link turns."""
    return _set(report, "turning", "links" if report.has_turning_links else "none")


def lever(report: ReportContext) -> Mapping[str, Inlines]:
    """Return the phrases for Zhukovsky's lever: its velocity plan has a separate round scale, or the crank's.  {}
    without a crank.
    """
    if not report.driver.centre:
        return {}
    symbols = {name: report.ledger.symbol(id) for name, id in (("ω", "omega.1"), ("μ_v", "mu.v"), ("μ_l", "mu.l"))}
    return _set(report, "lever", "round" if report.driver.round_velocity else "crank", **symbols)


def form(report: ReportContext) -> Mapping[str, Inlines]:
    """Return the phrases for the form of a machine that has several, such as an in-line or offset slider-crank."""
    return _set(report, "form", report.own["form"], report) if "form" in report.own else {}


def coupler(report: ReportContext) -> Mapping[str, Inlines]:
    """Return the phrases for the points that a coupler carries."""
    return _set(report, "coupler", report.own["coupler"], report) if "coupler" in report.own else {}


def load_key(report: ReportContext) -> str:
    """Return the key of the phrases for the loads that the calculation prints together, such as "M3-P3"."""
    return "-".join(report.sheet.get("loads", ()))


def driver_loads(report: ReportContext) -> Inlines:
    """Return the driver's own inertia force and weight with their symbols, each followed by a comma."""
    words, loads = report.words["driver_loads"], [id for id in ("Pqt1", "G1") if id in report.on_crank]
    return tuple(part for id in loads for part in say(report, words[id], force=report.ledger.symbol(id)))


def opposite_words(report: ReportContext) -> str:
    """Return the phrase for the sense of rotation opposite to the driver's."""
    return report.sense(-report.machine.turn)


def medium(report: ReportContext) -> str:
    """Return the key of the phrases for the load: "gas" for the gas in the cylinders, else "other"."""
    return "gas" if report.has_gas else "other"


def slider_convention(report: ReportContext) -> Inlines:
    """Return a sentence on the positive directions of sliders; () without sliders."""
    senses = slider_ways(report)
    return say(report, f" {report.words['conventions']['sliders']} {{senses}}.", senses=senses) if senses else ()


def balance_sign(report: ReportContext, position: int) -> Inlines:
    """Return the meaning of the balancing load's sign at a position."""
    words = report.words["balance_signs"][report.driver.kind]
    sense = report.sense(report.ledger.number("M.eq", position).value)
    return say(report, words[sign(report, "M.eq", position)], M=report.ledger.symbol("M.eq"), sense=sense)


def slide_reactions(report: ReportContext) -> Inlines:
    """Return the phrase that says where the reactions of slides act."""
    key = "none" if not report.has_slides else "displaced" if report.displaced_reactions else "at_pin"
    names = report.words["names"]
    parts = {"guide": names["guide"], "wall": names["wall"], "pin": names["pin"]}
    return say(report, report.words["slide_reactions"][key], **parts)


def energy_key(report: ReportContext) -> str:
    """Return the key of the phrase on the balance of energy: gas, a stroke, a turn (idle or not), or none."""
    if not (report.has_forces and report.cyclic):
        return "none"
    if report.has_gas or not report.driver.centre:
        return "gas" if report.has_gas else "stroke"
    return "idle" if report.is_zero("W", 1) else "turn"


def no_mean(report: ReportContext) -> Inlines:
    """Return the reason why the mean of the balancing load is zero; () if it is not."""
    if not (report.has_forces and report.cyclic) or not report.is_zero("M.mean"):
        return ()
    laws = [load.law for load in report.loads]
    key = "free" if not laws else "constant" if all(law.constant for law in laws) else "other"
    return say(report, report.words["no_mean"][key], report.words["driven"][report.driver.kind])


def has_moments_of_inertia(report: ReportContext) -> bool:
    """Return True if any moving link has a moment of inertia."""
    return any(id in ids.inertia for id in report.mass_lines)


def has_moment_components(report: ReportContext) -> bool:
    """Return True if moments give a reaction, or a component of one, before a force plan."""
    return any(group.by_moments for group in report.groups)


def constant_force(report: ReportContext) -> Inlines:
    """Return the phrase for the stroke on which a constant working force acts and its sense; () for any other force."""
    if "P.given" not in report.ledger or "stroke" not in report.own:
        return ()
    senses = report.words["constant_force"][report.own["stroke"]]
    return say(report, senses.get(sign(report, "P.given"), ""), report.words["ways"])


def first_position(report: ReportContext) -> Inlines:
    """Return the phrase for the driver's first position: its usual place, an angle, or a distance along its guide."""
    words, machine = report.words["first_position"], report.machine
    start, first = report.assignment.positions.start, machine.position(1)
    if report.instants:
        at, unit = report.assignment.positions.at or (), "mm" if machine.span else "°"
        sizes = [value.si * MM if machine.span else degrees(value.si) for value in at]
        printed = [Value(Number(_plain(value), unit=unit)) for value in sizes]
        places = [part for value in printed for part in (Text(", "), value)][1:]
        labels = ", ".join(map(str, report.positions))
        pin = NamedPoint(report.driver.pin)
        phrase = words["ways" if machine.span else "instants"][len(at) > 1]
        # Tables of loads count the way of a slide from where it starts, which is none of the instants.
        begun = Number(_plain(machine.start * MM), unit="mm")
        moving = say(report, words["onwards" if machine.turn > 0 else "backwards"], first=begun)
        return say(report, phrase, labels=labels, places=tuple(places), pin=pin, moving=moving)
    if machine.span:
        place_on_guide = Number(_plain(machine.start * MM), unit="mm")
        place: dict[str, Any] = {"label": first.label, "pin": NamedPoint(report.driver.pin), "place": place_on_guide}
        return say(report, words["along" if machine.turn > 0 else "against"], **place)
    natural = report.words.get("beginning", {}).get("dead_centre")
    if start is None and natural:
        return say(report, words["dead_centre"], label=first.label, place=natural.rstrip(","))
    angle = machine.start if start is None else start.si
    return say(report, words["given"], label=first.label, angle=Number(_plain(degrees(angle)), unit="°"))


def _plain(value: float) -> float:
    """Return a typed number without the rounding error of its conversion to SI."""
    return float(f"{value:.10g}") + 0.0


def strokes_at_start(report: ReportContext) -> Inlines:
    """Return the stroke that each piston begins at the first position, which identifies the turn of the cycle.

    With single instants, return the stroke of each piston at each of them.
    """
    machine, strokes = report.machine, report.words["strokes"]
    words = report.words["strokes_at_instants" if machine.instants else "strokes_at_start"]
    begun = [
        {
            "position": machine.position(k + 1),
            "link": state.piston.link,
            "stroke": str(strokes[state.stroke[k]]).lower(),
        }
        for k in range(machine.positions if machine.instants else 1)
        for state in report.analysis.gas.values()
    ]
    phrases = [words[index > 0].format(**stroke) for index, stroke in enumerate(begun)]
    return (Text(f"{''.join(phrases)}."),) if phrases else ()


def lettered(report: ReportContext) -> bool:
    """Return True if positions between the evenly spaced ones are called a, b, …"""
    machine = report.machine
    return not report.instants and any(k.label.isalpha() for k in machine.numbered(range(1, machine.count + 1)))


def load_sense(report: ReportContext, name: str) -> Inlines:
    """Return the words for the sense of a load that is constant or always against the motion."""
    words = report.words["load_senses"]
    if any(load.name == name and load.law.kind == "opposing" for load in report.loads):
        return say(report, words["opposing"])
    return say(report, words[sign(report, name, 1)], sense=report.sense(report.ledger.number(name, 1).value))


def drawn_group(report: ReportContext, row: GroupRow) -> Inlines:
    """Return the phrase for drawing a group of a declared linkage: its rods, its outer joints, the inner one."""
    drawn = [value(report, ids.drawn(rod)) for rod, _ in row.lengths]
    rods = dict(zip(("first", "second"), drawn, strict=False))
    first, *others = map(NamedPoint, row.joints)
    joints = {"start": first} | dict(zip(("inner", "end"), others, strict=False))
    words = report.words["linkage"]["drawing"][row.drawing]
    if row.near:
        ends = dict(zip(("start1", "inner1", "start2", "inner2", "start3", "inner3"), (first, *others), strict=True))
        curve = Reference(f"fig.assemblies.{ids.members(row.links)}.{report.worked[0]}")
        return say(report, words, plate=row.links[1], third=drawn[2], assemblies=curve, **rods, **ends)
    return say(report, words, row, last=row.links[1], **rods, **joints)


def mode_of(report: ReportContext, row: GroupRow) -> Inlines:
    """Return the sentence on the assembly mode of a group of class III."""
    words, places = report.words["linkage"]["mode"], list[Inline]()
    for name, x, y in row.near:
        places += [*([Text(", ")] if places else ()), InlineMath(vocabulary.point(name))]
        places += [Text(" ≈ ("), Value(x), Text("; "), Value(y), Text(")")]
    key = "slide" if row.near_at is None else "crank"
    members = ", ".join(map(str, row.links))
    return say(report, words[key], members=members, places=tuple(places), near_at=row.near_at)


# --- the steps in which a plan is drawn, in words -------------------------------------------------
# They say where a line begins, its direction, and its meaning.
# `what` is "v" for the velocity plan, "a" for the acceleration plan.


def _image(report: ReportContext, what: str, name: str) -> Symbol:
    return image(report, name, what == "a")


def start(report: ReportContext, what: str, of: Side | CarriedPoint) -> Inlines:
    """Return the starting point of the vector relative to a base on a plan: the pole, or the end of the base's
    vector.
    """
    words = report.words["plan"]
    if of.still:
        return say(report, words["pole"], pole=math(report, POLES[what]))
    return say(report, words["end"], image=_image(report, what, of.base))


def line_start(report: ReportContext, what: str, side: Side) -> Inlines:
    """Return the starting point of the unknown's line: the end of the known relative acceleration, if there is one."""
    if what == "a" and side.part:
        return say(report, report.words["plan"]["end_of"], vector=a(report, side, side.part))
    return start(report, what, side)


def along(report: ReportContext, side: Side) -> Inlines:
    """Return the phrase for the direction of the unknown on a side."""
    return say(report, report.words["plan"]["directions"][side.way], rod=subscripted(side.rod), link=side.slide)


def sought(report: ReportContext, what: str, group: GroupView, side: Side) -> Symbol:
    """Return the unknown vector on a side: the point's own if the side's base is at rest, else the relative one."""
    if what == "v":
        return v(report, group.M if side.still else side)
    if side.turns:
        return a(report, side, "τ")
    return a(report, group.M) if side.still and not side.turning else a(report, side, "r")


def base_step(report: ReportContext, what: str, group: AssurView, side: Side, position: int) -> Inlines:
    """Return the step that draws the vector of a side's base on the plan."""
    return say(
        report,
        report.words["plan"]["base"][group.base(what, side, position)],
        vector=(v if what == "v" else a)(report, side.shown),
        image=_image(report, what, side.base),
        pole=math(report, POLES[what]),
        segment=quantity(report, group.base_segment(what, side), position),
    )


def called(report: ReportContext, link: int) -> str:
    """Return the name that a machine of the atlas has for a link, in parentheses; "" if it has none."""
    name = report.own.get("links", {}).get(link, "")
    return report.words["link_called"].format(name=name) if name else ""


def links_called(report: ReportContext, group: AssurView) -> str:
    """Return the links of a group with their names; "" if they have none."""
    between = ", " if setting_of(report.assignment.language).spaced else "、"
    names = [called(report, link) for link in group.links]
    rows = (f"{link}{name}" for link, name in zip(group.links, names, strict=True))
    return between.join(rows) if any(names) else ""


def known_sense(report: ReportContext, side: Side) -> Inlines:
    """Return the sense of the relative acceleration that velocities give: towards the base, or that of the Coriolis
    rotation.
    """
    ends = {"point": NamedPoint(side.point), "base": NamedPoint(side.base)}
    return say(report, report.words["plan"]["senses"]["centre" if side.turns else "coriolis"], **ends)


def base_motion(report: ReportContext, side: Side) -> Inlines:
    """Return the phrase for the known motion of a side's base: that it is fixed, or its velocity."""
    return say(report, report.words["plan"]["bases"][side.state], base=NamedPoint(side.base))


def shows_coriolis(report: ReportContext, group: GroupView, side: Side, position: int) -> bool:
    """Return True if a figure shows how the Coriolis acceleration of a slot gets its sense."""
    moves = not any(report.is_zero(id, position) for id in (side.velocity, side.omega))
    return group.kind == "RPR" and moves and bool(report.parts("coriolis-turn"))


def found_senses(report: ReportContext, group: AssurView, position: int) -> Inlines:
    """Return the meaning of the signs of the reactions that moments gave."""
    words, figure = report.words["plan"]["found"], Reference(f"fig.bodies.{group}.{position}")
    signs = [(id, sign(report, id, position)) for id in group.by_moments]
    return tuple(
        part
        for id, sense in signs
        if sense != "zero"
        for part in say(report, words[sense], force=report.ledger.symbol(id), figure=figure)
    )
