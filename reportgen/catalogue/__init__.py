"""Registry of the machines: one module each, imported when its kind is requested.

A machine is found by its module in this package and its words in `templates/<language>/catalogue/`: the kind
`slider-crank` is the module `slider_crank` and the file `slider-crank.md`. A module defines `TURNS` of the driver
in a cycle, the model `Parameters`, optionally the model `Indicator`, and `CHECKS`. It defines `position_labels` if
a turn has positions besides the evenly spaced ones, `LENGTHS_OF_PARTS` (the keys of lengths that parts of a
coursework can give), `WARNINGS` (checks for what is allowed but probably not
intended), and `machine`, which makes a `Machine` of an assignment.

A kind that is not a machine has its module in another package and is also found by its words; it defines `case` in
place of `machine`, which makes a case of its type. `PART` is the prefix of the ids of a kind that can be a part of
a coursework; `index` in its words is added to symbols that an earlier part has, too. `lengths` returns the lengths
that such a part finds for the machine (`SolvedLength`), by their letters. `table_rows` returns the entries that
`solve` prints for a position, if they are not its plain entries; `results` in its words has the titles. Ids that
only one kind has are in a module with its name, such as `cam_ids` (`reportgen.formula.vocabulary.heads`).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from reportgen.assignment import reading
from reportgen.assignment.common import Assignment, Drawing, Extended, Kind, Part, Positions, named_worked
from reportgen.assignment.fields import UNIT_KEY
from reportgen.assignment.schema import alternatives_to, choices_of, file_schema, places, schema_of
from reportgen.base.atlas_words import is_machine_file
from reportgen.base.errors import (
    AssignmentError,
    Fault,
    Finding,
    Level,
    Location,
    Problem,
    ReportgenError,
    TemplateError,
)
from reportgen.base.field_words import also, choice_words, field_words, remarked
from reportgen.base.kinds import SAMPLE, kinds
from reportgen.base.records import replace
from reportgen.base.template_folders import (
    MOST_MACHINES,
    ignored_machine_files,
    is_of_atlas,
    is_users_machine,
    kind_words,
    samples,
)
from reportgen.base.topics import topics
from reportgen.base.translation_coverage import is_topic_whole, is_whole, offered
from reportgen.base.units import Language, QuantityFault, measures, read_quantity, read_unit
from reportgen.base.words import as_error, as_problem, language_of, sections, spoken, word
from reportgen.base.yaml_source import MappingNode, Scalar, Source, read_source
from reportgen.base.yaml_values import at as node_at
from reportgen.base.yaml_values import put, text_of
from reportgen.catalogue import assembly_checks, declared_loads
from reportgen.catalogue.parameters import Driven
from reportgen.catalogue.topic_sections import TopicParameters, sections_of, topic_checks, with_topics
from reportgen.machine import Linkage
from reportgen.machine.analysis import Machine
from reportgen.machine.load_laws import FULL_TURN, STEPS

SPEC_KEYS = ("variants", "salt")
"""Keys of a spec for a class, from which assignments are drawn; no assignment has them."""
MOST_KINDS = 64
"""Number of kinds whose data are kept; a machine of the user's folder is another one after each change of its file."""
_KIND = re.compile(r"(?m)^kind: (\S+)$")


def module(kind: str) -> Any:
    """Return the module of a kind, or the machine of the atlas that takes its place.

    Raises `KeyError` for an unknown kind, and `AssignmentError` for a machine of the atlas whose file is faulty.
    """
    return _atlas().machine_of(kind) if is_of_atlas(kind) else import_module(kinds()[kind])


def _atlas() -> ModuleType:
    """Return the module of the machines of the atlas, which loads all of the kind `linkage`."""
    from reportgen.catalogue import atlas

    return atlas


def faults_of(kind: str) -> tuple[Fault, ...]:
    """Return the faults in the file of a machine of the user's folder; () for one that is in order.

    All other kinds are in order, as tests check.
    """
    faults: tuple[Fault, ...] = _atlas().faults_of(kind) if is_users_machine(kind) else ()
    return faults


def is_sound(name: str) -> bool:
    """Return True for a kind, unless it is a machine of the atlas whose file is faulty."""
    return name in kinds() and not faults_of(name)


def sound_kinds() -> list[str]:
    """Return the kinds without the machines of the atlas whose files are faulty."""
    return [name for name in kinds() if is_sound(name)]


def faulty_machines(language: Language | None = None) -> list[Problem]:
    """Return the errors in the files of the atlas."""
    return [as_problem(fault, language) for name in kinds() for fault in faults_of(name)]


def ignored_machines(language: Language | None = None) -> list[Problem]:
    """Return warnings about files of the user's folder that are not machines because of their names or their number."""
    misnamed, further = ignored_machine_files()
    most = {"most": str(MOST_MACHINES)}
    faults = [Fault("machine-file-name", Location(str(file)), {"text": file.name}) for file in misnamed]
    faults += [Fault("machines-too-many", Location(str(file)), most) for file in further[:1]]
    return [as_problem(fault, language, "warning") for fault in faults]


def kind(name: str) -> Kind:
    """Return the data of a kind that the reader of assignment files needs; raises `KeyError`."""
    return _kind_of(name, module(name))


@lru_cache(MOST_KINDS)
def _kind_of(name: str, machine: Any) -> Kind:
    """Return the data of a kind by its module. Schemas are kept by these data, and some checks are made anew."""
    shared = getattr(machine.Parameters, "checks", tuple)
    takes_topics = issubclass(machine.Parameters, TopicParameters)
    return Kind(
        name,
        base=machine.Parameters,
        indicator=getattr(machine, "Indicator", None),
        turns=machine.TURNS,
        checks=(*shared(), *machine.CHECKS),
        labels=getattr(machine, "position_labels", None),
        indicator_optional=getattr(machine, "INDICATOR_OPTIONAL", False),
        has_positions=getattr(machine, "HAS_POSITIONS", True),
        part=getattr(machine, "PART", ""),
        lengths=getattr(machine, "lengths", None),
        lengths_of_parts=getattr(machine, "LENGTHS_OF_PARTS", ()),
        positions=getattr(machine, "PositionsModel", Positions),
        drawing=getattr(machine, "DrawingModel", Drawing),
        topics=topics() if takes_topics else (),
        extended=_extended if takes_topics else None,
    )


def _extended(parameters: type[Part], names: tuple[str, ...]) -> Extended:
    """Return the parameters of a machine with the sections of some topics, and the checks of these."""
    assert issubclass(parameters, TopicParameters), "only a machine has topics"
    return with_topics(parameters, names), topic_checks(parameters, names)


def assess(source: Source, path: Path) -> tuple[Assignment | None, list[Fault]]:
    """Return the assignment of nodes that were read from `path` or put together from several files; else its faults."""
    assignment, faults = understood(source, path)
    if assignment is not None and (machine_of := getattr(module(assignment.kind), "machine", None)) is not None:
        machine = machine_of(assignment)
        findings = [*_misplaced(assignment, machine), *_out_of_reach(machine)]
        for section in sections_of(machine.topics):
            findings = findings or list(section.failures(machine, assignment.worked_positions))
        faults = reading.placed(source, findings)
    return (None if faults else assignment), faults


def understood(source: Source, path: Path) -> tuple[Assignment | None, list[Fault]]:
    """Return the same as `assess`, without the slow check that the machine reaches all positions, for assessed
    nodes.
    """
    if faults := _of_machine(source):
        return None, list(faults)
    return reading.assess(source, path, kinds(), kind)


def _of_machine(source: Source) -> tuple[Fault, ...]:
    """Return the faults of the machine of the atlas that nodes name."""
    name = node_at(source.top, ("kind",))
    return faults_of(name.text) if isinstance(name, Scalar) else ()


def unchecked(source: Source, path: Path) -> Assignment | None:
    """Return the assignment of nodes that may fail the checks, without its parts; None if a value is faulty."""
    if _of_machine(source):
        return None
    return reading.unchecked(source, path, kinds(), kind)


def linkage_of(source: Source, path: Path) -> Linkage | None:
    """Return the linkage of nodes that may fail the checks; None if a value is faulty or no machine has these values.

    Parameters with a property `linkage` give it at once; of another kind the whole machine is made.
    """
    assignment = unchecked(source, path)
    if assignment is None:
        return None
    try:
        linkage: Linkage | None = getattr(assignment.parameters, "linkage", None)
        return linkage or module(assignment.kind).machine(assignment).linkage
    except (ReportgenError, ArithmeticError, ValueError, LookupError, np.linalg.LinAlgError):
        return None


def machine_of(source: Source, path: Path) -> Machine | None:
    """Return the machine of nodes that may fail the checks; None if a value is faulty or there is no machine."""
    assignment = unchecked(source, path)
    make = None if assignment is None else getattr(module(assignment.kind), "machine", None)
    try:
        machine: Machine | None = make and make(assignment)
    except (ReportgenError, ArithmeticError, ValueError, LookupError, np.linalg.LinAlgError):
        return None
    return machine


def _misplaced(assignment: Assignment, machine: Machine) -> Iterator[Finding]:
    """Yield faults for instants at places of another sort of driver, and for loads on missing links and points."""
    slides = bool(machine.span)
    for index, at in enumerate(assignment.positions.at or ()):
        if slides == measures(at.unit, "deg"):
            words = {"given": at.unit, "unit": "mm" if slides else "deg"}
            yield Finding("wrong-unit", ("positions", "at", index), words)
    given = assignment.parameters
    if isinstance(given, TopicParameters):
        for section in sections_of(given.asked()):
            yield from section.faults(given, machine)
    if isinstance(assignment.parameters, Driven):
        points = declared_loads.pins(machine.linkage)
        for index, load in enumerate(assignment.parameters.loads):
            where = ("parameters", "loads", index)
            yield from declared_loads.faults(load, points, machine.turns * FULL_TURN, where)


def _out_of_reach(machine: Machine) -> Iterator[Finding]:
    """Yield findings if a machine comes too close to a dead point, or is too large to draw."""
    angles, whole = machine.angles(machine.cycle_angles), np.linspace(0.0, FULL_TURN, STEPS + 1)
    if machine.instants:
        beyond = tuple(assembly_checks.at_instants(machine.linkage, angles, not machine.span))
        yield from beyond
        if machine.drawn and not beyond:
            yield from assembly_checks.too_large(machine.linkage, angles, machine.drawn, ("drawing", "crank"))
        return
    driven_through = (
        assembly_checks.DriverTravel(machine.start, machine.start + machine.turn * machine.span, False)
        if machine.span
        else assembly_checks.DriverTravel()
    )
    yield from assembly_checks.near_dead_point(machine.linkage, driven_through, ("parameters",))
    if machine.drawn:
        yield from assembly_checks.too_large(machine.linkage, whole, machine.drawn, ("drawing", "crank"))


def load(path: Path | str, language: Language | None = None, whole: Path | None = None) -> Assignment:
    """Return the assignment of a file, in its own language or in `language`; a part takes values from the `whole`.

    Raises `AssignmentError` with all faults of the file, located.
    """
    return _in_order(with_taken(read_source(Path(path)), Path(path), whole), Path(path), language)


def with_taken(source: Source, path: Path, whole: Path | None) -> Source:
    """Return nodes that were read from `path`; a part includes the values taken from the coursework `whole`."""
    return reading.in_coursework(source, path, whole, kinds(), kind) if whole else source


def _in_order(source: Source, path: Path, language: Language | None) -> Assignment:
    """Return the assignment of nodes that were read from `path`; raises `AssignmentError`."""
    assignment, faults = assess(source, path)
    faults = [*reading.name_faults(path), *faults]
    if assignment is None or faults:
        raise as_error(faults, language or language_of(source))
    spoken = language or assignment.language
    if (partial := next(_untold(assignment, spoken), None)) is not None:
        # It is the file's own language or the kind or topic that another one may be taken for.
        if not language and node_at(source.top, ("report", "language")):
            partial = replace(partial, where=("report", "language"), at="value")
        raise as_error(reading.placed(source, [partial]), spoken)
    return assignment.with_language(language) if language else assignment


def _untold(assignment: Assignment, language: Language) -> Iterator[Finding]:
    """Yield findings for the kinds and topics of an assignment that a language does not translate completely."""
    for member in (assignment, *(part.within(assignment) for part in assignment.parts)):
        if not is_whole(language, member.kind):
            words = {"kind": member.kind, "language": language, "known": ", ".join(offered(language)) or "–"}
            yield Finding("language-partial", ("kind",), words)
        asked = member.parameters.asked() if isinstance(member.parameters, TopicParameters) else ()
        for topic in asked:
            if not is_topic_whole(language, topic):
                words = {"kind": topic, "language": language}
                yield Finding("language-partial", ("parameters", topic), words, at="key")


def check(path: Path | str, language: Language | None = None) -> list[Problem]:
    """Return all errors of an assignment file in its order; an empty list if it can be loaded."""
    return [problem for problem in examine(path, language) if problem.level == "error"]


def examine(path: Path | str, language: Language | None = None) -> list[Problem]:
    """Return all faults of an assignment file; if it has none, its warnings and the positions that labels refer to.

    Of a machine's file for the atlas, the faults are returned; if it has none, warnings about its words and bounds.
    A spec for a class has a single fault.
    """
    if is_machine_file(source := read_source(Path(path))):
        faults = [as_problem(fault, language) for fault in _atlas().faults_in(source)]
        return faults or [as_problem(fault, language, "warning") for fault in _atlas().doubts_in(source)]
    if (key := _key_of_spec(source)) is not None:
        return [as_problem(Fault("is-a-spec", key.location, {"key": key.text}), language)]
    return problems_of(source, Path(path), language)


def _key_of_spec(source: Source) -> Scalar | None:
    """Return the key that only a spec for a class has; None for an assignment."""
    entries = source.top.entries if isinstance(source.top, MappingNode) else ()
    return next((key for key, _ in entries if key.text in SPEC_KEYS), None)


def problems_of(source: Source, path: Path, language: Language | None = None) -> list[Problem]:
    """Return the same as `examine` for nodes that were read from `path`."""
    try:
        assignment = _in_order(source, path, language)
    except AssignmentError as error:
        return list(error.problems)
    warnings = getattr(module(assignment.kind), "WARNINGS", ())
    by_level: dict[Level, list[Finding]] = {
        "warning": [*(finding for warning in warnings for finding in warning(assignment)), *_doubts(assignment)],
        "note": list(_understood_positions(assignment)),
    }
    spoken = assignment.language
    problems = [as_problem(one, spoken, level) for level in by_level for one in reading.placed(source, by_level[level])]
    doubtful = (*reading.doubtful(source), *reading.doubtful_parts(source, path))
    problems += [as_problem(one, spoken, "warning") for one in doubtful]
    return sorted(problems, key=lambda problem: problem.location)


def _doubts(assignment: Assignment) -> Iterator[Finding]:
    """Yield warnings about values in a machine's file that are allowed but probably not intended."""
    if (machine_of := getattr(module(assignment.kind), "machine", None)) is not None:
        machine = machine_of(assignment)
        for section in sections_of(machine.topics):
            yield from section.warnings(machine)


def examples(name: str) -> dict[str, Path]:
    """Return the examples of a kind that come with the program, by the stems of their files."""
    return all_examples().get(name, {})


def all_examples() -> dict[str, dict[str, Path]]:
    """Return the examples of every kind, by the stems of their files."""
    listed: dict[str, dict[str, Path]] = {}
    for path in sorted(samples().rglob("*.yaml")):
        text = path.read_text(encoding="utf-8")
        # A spec, which has a salt, is one for a class.
        if (of_kind := _KIND.search(text)) and "\nsalt:" not in text:
            listed.setdefault(of_kind[1], {})[path.stem] = path
    return listed


def example(path: Path, language: Language | None = None) -> str:
    """Return the text of an example, reported in a language if one is given."""
    source = read_source(path)
    assert isinstance(source.top, MappingNode), "an example is in order"
    if language is None:
        return source.text
    top = put(source.top, ("report", "language"), Scalar(language, source.top.location))
    assert isinstance(top, MappingNode), "a key is put into a table"
    before = source.text.splitlines(keepends=True)[: source.top.location.line - 1]
    return "".join(before) + text_of(top, source.text, source.top)


def _understood_positions(assignment: Assignment) -> Iterator[Finding]:
    """Yield a note with the worked positions, if their labels differ from their numbers."""
    if not kind(assignment.kind).has_positions or named_worked(assignment.report, assignment.positions) is None:
        return
    labels = assignment.labels
    pairs = [(number, labels[number - 1]) for number in assignment.worked_positions]
    if any(str(number) != label for number, label in pairs):
        understood = [word("position_pair", assignment.language, number=n, label=label) for n, label in pairs]
        yield Finding("positions", ("report", "worked_positions"), {"known": "; ".join(understood)})


def schema(language: Language | None = None) -> dict[str, Any]:
    """Return the JSON Schema (draft-07, which every editor supports) of files of all kinds, with keys described in a
    language.
    """
    spoken_in = language or spoken()
    return schema_of(map(kind, sound_kinds()), lambda name: field_words(name, spoken_in))


# --- starter files ----------------------------------------------------------------------------------


def sample(name: str, language: Language) -> str:
    """Return the starter file of a kind with a remark on each key; see `starter`."""
    known, words = kind(name), field_words(name, language)
    return remarked(starter(name, language), words, lambda path, value: _more(known, path.split("."), value, language))


def starter(name: str, language: Language) -> str:
    """Return the starter file of a kind; raises `KeyError`, or `TemplateError` if the kind has none."""
    file = kind_words(language, kind(name).name)
    if (section := sections(file).get(SAMPLE)) is None:
        raise TemplateError(f"{file}:1: there is no section {SAMPLE}")
    return _atlas().starter(name, section.text, language) if is_of_atlas(name) else section.text


def _more(known: Kind, path: Sequence[str], value: str, language: Language) -> str:
    """Return text that a remark adds to the words of a key: its choices, and other keys with the same meaning."""
    # Only a topic in which the key lies is loaded.
    known = known.asking(path)
    schema, words = file_schema(known), choice_words(language)
    choices = list(dict.fromkeys(choice for one in places(schema, schema, tuple(path)) for choice in choices_of(one)))
    said = [f"{choice} ({words[choice]})" if words.get(choice, choice) != choice else choice for choice in choices]
    listed = f": {' | '.join(said)}" if len(said) > 1 else ""
    others = alternatives_to(known, path)
    instead = "".join(f", {also(language)}  {_instead(schema, [*path[:-1], other], value)}" for other in others)
    return listed + instead


def _instead(schema: dict[str, Any], path: Sequence[str], value: str) -> str:
    """Return another key with the same meaning as one with this value; with the value itself, if the dimension is the
    same.
    """
    units = [one[UNIT_KEY] for one in places(schema, schema, tuple(path)) if UNIT_KEY in one]
    with suppress(QuantityFault):
        for unit in units:
            return f"{path[-1]}: {read_quantity(value, unit).si / read_unit(unit, unit):.3g} {unit}"
    return path[-1]
