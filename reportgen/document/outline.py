"""Analysis and ledger → Document: cover, contents and the sections that the machine's outline names."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from reportgen.assignment import Assignment
from reportgen.case import Case
from reportgen.catalogue.given_loads import ByOrdinates
from reportgen.document.centres import plane_links, with_centres
from reportgen.document.drawings import Drawings
from reportgen.document.facts import Facts
from reportgen.document.numbering import number
from reportgen.document.prose import Prose
from reportgen.document.tabled import lowered
from reportgen.document.tables import Tables
from reportgen.document.tree import (
    Block,
    Contents,
    Cover,
    Document,
    Equation,
    Figure,
    InlineMath,
    PageBreak,
    Paragraph,
    Plate,
    Reference,
    Text,
    Value,
    Words,
)
from reportgen.document.views import GroupView, driver, groups
from reportgen.document.voice import Voice
from reportgen.ledger.core import Ledger
from reportgen.mechanism.mobility import mobility
from reportgen.notation.expressions import Expression, Number, Ref, Symbol, substitute

PLATES_UP_TO = 24
"""Above this many positions, plates are drawn for worked positions only."""


def compose(case: Case) -> Document:
    """The finished, numbered document of a report; raises `TemplateError` for a fault in its words."""
    assignment, words, title = case.assignment, case.words, case.title
    prose, names = prepare(case)
    blocks: list[Block] = [_cover(assignment, words, title)]
    for section in with_centres(case.analysis.machine.outline, names["plane_links"]):
        if section == "contents":
            blocks += [PageBreak(), Contents(words["document"]["contents"])]
        else:
            blocks += prose.render(f"{section}.md", names)
    report = assignment.report
    course = report.course or words["cover"]["course"]
    return number(
        Document(
            assignment.language,
            f"{words['cover']['title']} – {title}",
            report.student.name or "",
            (words["header"].format(course=course), _variant(assignment, words)),
            ("", words["document"]["page"]),
            Words(**words["document"]),
            tuple(blocks),
        )
    )


def prepare(case: Case) -> tuple[Prose, dict[str, Any]]:
    """The templates of an assignment's language, machine and school, and all that they may name."""
    assignment = case.assignment
    prose = Prose(case.directories)
    facts = Facts(case, groups(case.analysis, case.polygons), driver(case.analysis))
    voice = Voice(case.ledger, prose, case.words)
    tables = Tables(assignment, facts, voice)
    drawings = Drawings(assignment, facts, case.words, plates_for(assignment))
    return prose, _names(assignment, facts, voice, tables, drawings, case.title)


def plates_for(assignment: Assignment) -> tuple[int, ...]:
    """Positions whose plans are drawn: all of the cycle, or the worked ones when there are very many."""
    if assignment.positions.count <= PLATES_UP_TO:
        return tuple(range(1, assignment.cycle_positions + 1))
    return assignment.worked_positions


def _variant(assignment: Assignment, words: Mapping[str, Any]) -> str:
    return words["variant"].format(variant=assignment.variant) if assignment.variant else ""


def _cover(assignment: Assignment, words: Mapping[str, Any], title: str) -> Cover:
    """The title page; a field without a value is a dotted line to fill in."""
    report, labels = assignment.report, words["cover"]
    student = report.student
    fields = (
        (labels["student"], student.name),
        (labels["id"], student.id),
        (labels["class"], student.class_),
        (labels["section"], student.section),
        (labels["email"], student.email),
        (labels["supervisor"], report.supervisor),
    )
    divisions = tuple(part for part in (report.university, report.faculty, report.department) if part)
    course = report.course or labels["course"]
    subtitle = (
        *((f"{labels['variant']}: {assignment.variant}",) if assignment.variant else ()),
        f"{labels['machine']}: {title}",
    )
    return Cover(
        divisions,
        (labels["title"], course),
        subtitle,
        tuple((label, value or "") for label, value in fields),
        _place_and_date(assignment, labels),
    )


def _place_and_date(assignment: Assignment, labels: Mapping[str, Any]) -> str:
    report = assignment.report
    place = report.place or "……………………"
    if report.date is None:
        return str(labels["no_date"]).format(place=place)
    day = report.date
    months = labels.get("months")
    return str(labels["date"]).format(
        place=place,
        day=day.day,
        month=day.month,
        year=day.year,
        month_name=months[day.month - 1] if months else day.month,
    )


def _names(
    assignment: Assignment, facts: Facts, voice: Voice, tables: Tables, drawings: Drawings, title: str
) -> dict[str, Any]:
    """Everything a template may name."""
    analysis, machine = facts.analysis, facts.analysis.machine
    words = voice.words
    worked = assignment.worked_positions
    kinematic = machine.numbered(dict.fromkeys((k - 1) % machine.count + 1 for k in worked))
    senses = words["sense"]
    of_facts = (
        "driver_others turning velocity_lines acceleration_lines similar carried names centre_lines arm_ids"
        " negative zero"
    )
    return {
        **voice.functions(),
        **tables.functions,
        **{name: getattr(facts, name) for name in of_facts.split()},
        "words": words,
        "machine_title": title[:1].lower() + title[1:],
        "variant": assignment.variant,
        "signature": tuple(_signature(assignment, words)),
        "turn_words": senses["anticlockwise"] if machine.turn > 0 else senses["clockwise"],
        "count": machine.count,
        "cycle_count": machine.positions,
        "worked": kinematic,
        "worked_forces": machine.numbered(worked),
        "worked_list": ", ".join(map(str, machine.numbered(worked))),
        "positions": machine.numbered(range(1, machine.count + 1)),
        "all_positions": machine.numbered(range(1, machine.positions + 1)),
        "computed": [id for id, family in facts.ledger.families.items() if family.definition is not None],
        "mobility": mobility(machine.linkage),
        "groups": facts.groups,
        "plane_links": plane_links(facts),
        "centre_state": drawings.centres.state,
        "centres_drawn": drawings.centres.drawn,
        "driver": facts.driver,
        "own": machine.facts,
        "pistons": machine.pistons,
        "sliders": machine.sliders,
        "known": lambda id: id in facts.ledger,
        "even_count": assignment.positions.count,
        "has_ordinates": isinstance(assignment.indicator, ByOrdinates),
        "synthesised": "synthesis" in machine.outline,
        "has_force": bool(machine.applied),
        "has_forces": bool(analysis.loads),
        "has_formulas": bool(machine.compared),
        "velocity_segments": facts.velocity_segments,
        "velocity_columns": facts.velocity_columns,
        "acceleration_segments": facts.acceleration_segments,
        "acceleration_columns": facts.acceleration_columns,
        "mass_lines": facts.mass_lines,
        "inertia_lines": facts.inertia_lines,
        "couples": facts.couples,
        "reaction_ids": facts.reaction_ids,
        "reaction_angles": facts.reaction_angles,
        "crank_lines": facts.crank_lines,
        "lever_couples": facts.lever_couples,
        "crank_pins": facts.crank_pins,
        "driver_polygon": facts.driver_polygon if facts.case.polygons else None,
        "lowered": lowered,
        "not_recomputing": _listed(voice.symbol(id) for id in facts.ledger.cancellations),
        "equations": lambda name, k=None: Equation(
            tuple(_filled(facts.ledger, row, k) for row in machine.equations[name])
        ),
        "group_kind": lambda group: words["groups"][group.kind],
        "stroke_name": lambda link, k: words["strokes"][int(analysis.gas[f"P{link}"].stroke[k - 1])],
        "last_known": lambda group: group.polygon.sides[-3].end,
        "force_list": lambda group, k: _force_list(voice, facts, group, k),
        "plate_refs": lambda prefix: _references(
            f"{prefix}{group.name}" for group in reversed(facts.groups)
        ),
        "figure": lambda name, key, caption, *arguments: _figure(
            voice, drawings, name, key, caption, *arguments
        ),
    }


def _filled(ledger: Ledger, node: Expression, position: int | None) -> Expression:
    """An equation with the ledger's numbers in place of the quantities it names."""

    def bare(ref: Ref) -> Number:
        number = ledger.number(ref.id, position)
        return Number(number.value, number.decimals, "°" if number.unit == "°" else "")

    return substitute(node, bare)


def _signature(assignment: Assignment, words: Mapping[str, Any]) -> Iterator[Block]:
    """Place, date and name under the foreword; without a name the label stands over a line to sign."""
    labels = words["cover"]
    yield Paragraph((Text(_place_and_date(assignment, labels)),), "right")
    yield Paragraph((Text(f"{labels['student']}: {assignment.report.student.name or '…' * 20}"),), "right")


def _force_list(voice: Voice, facts: Facts, group: GroupView, k: int) -> tuple[Any, ...]:
    """The known sides of a force plan with their drawn lengths: ef = 40.30 mm for P_qt5, …"""
    assert group.polygon is not None
    result: list[Any] = []
    for side in group.polygon.sides:
        if side.unknown:
            continue
        result += [Text(", ")] if result else []
        segment = f"seg.{group.name}.{side.name}"
        result += [
            InlineMath(voice.symbol(segment)),
            Text(" = "),
            Value(facts.ledger.number(segment, k)),
            Text(" ("),
            InlineMath(voice.force_symbol(side.name)),
            Text(")"),
        ]
    return tuple(result)


def _listed(symbols: Iterable[Symbol]) -> tuple[Any, ...]:
    """Symbols side by side with commas, each once."""
    result: list[Any] = []
    for symbol in dict.fromkeys(symbols):
        result += [Text(", ")] if result else []
        result.append(InlineMath(symbol))
    return tuple(result)


def _references(keys: Iterator[str]) -> tuple[Any, ...]:
    result: list[Any] = []
    for key in keys:
        result += [Text(", ")] if result else []
        result.append(Reference(key))
    return tuple(result)


def _figure(
    voice: Voice, drawings: Drawings, name: str, key: str, caption: str, *arguments: Any
) -> tuple[Figure | Plate, ...]:
    """A figure's block, or one for each of its plates; the key names the first."""
    drawn = drawings.draw(name, *arguments)
    inlines = voice.prose.inlines(caption)
    if drawn.note is not None:
        inlines = (*inlines, Text("; "), InlineMath(drawn.note))
    if drawn.paper is None:
        return (Figure(drawn.scenes, inlines, key),)
    count = len(drawn.scenes)
    return tuple(
        Plate(
            scene,
            drawn.paper,
            inlines if count == 1 else (*inlines, Text(f" ({index}/{count})")),
            key if index == 1 else f"{key}.{index}",
        )
        for index, scene in enumerate(drawn.scenes, start=1)
    )
