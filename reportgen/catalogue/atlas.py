"""Serve the machines of the atlas as kinds: `machine_of` returns what a module of the catalogue would define.

A machine's parameters expand to those of a linkage, whose report, checks and formulas it has. Its file is read again
when it changes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import Annotated, Any, ClassVar

from pydantic import create_model

from reportgen.assignment.common import Assignment, Draft, Drawing, Kind, Positions
from reportgen.assignment.parameter_formulas import FormulaError
from reportgen.assignment.reading import placed, read_section
from reportgen.base.atlas_words import machine_source, machine_words
from reportgen.base.errors import Fault, Finding, Where
from reportgen.base.field_words import FieldWords
from reportgen.base.records import replace
from reportgen.base.template_folders import ATLAS_BASE, atlas_files, is_machine_name, is_own_machine
from reportgen.base.units import Given, Language
from reportgen.base.words import as_error
from reportgen.base.yaml_source import Source
from reportgen.catalogue import linkage, linkage_file
from reportgen.catalogue.atlas_file import CompiledMachine, at_bounds, checked, read_machine, without_names
from reportgen.catalogue.derived_values import PLACES, derived_lines, free_parameters, ids_by_place
from reportgen.catalogue.parameters import UnderGravity
from reportgen.catalogue.topic_sections import with_topics
from reportgen.formula import Symbol
from reportgen.machine import Linkage
from reportgen.machine.analysis import Machine

KEPT = 256
"""Largest number of cached machines."""
BASE = Kind(ATLAS_BASE, base=linkage_file.Parameters)
"""The kind of the linkage, without topics, which belong to the student's file."""


class AtlasParameters(UnderGravity):
    """Parameters of a machine of the atlas; a subclass has the fields of its file."""

    machine: ClassVar[str] = ""
    """The kind."""

    @property
    def expanded(self) -> linkage_file.Parameters:
        """The parameters of the linkage, with the topics of the student's file.

        Raises `ValueError` if a formula has no value, or a value is not allowed.
        """
        expanded, findings = machine_of(self.machine).expanded(self)
        if expanded is None:
            raise ValueError(findings)
        return expanded

    @property
    def linkage(self) -> Linkage:
        return self.expanded.linkage

    @property
    def slides(self) -> bool:
        """False also if there is no such linkage, which a check reports."""
        expanded, _ = machine_of(self.machine).expanded(self)
        return expanded is not None and expanded.slides

    def __reduce__(self) -> tuple[Any, ...]:
        return _blank, (self.machine, self.topic_names), self.__getstate__()


class AtlasPositions(Positions):
    """Positions whose defaults are those of a machine's file."""

    machine: ClassVar[str] = ""

    def __reduce__(self) -> tuple[Any, ...]:
        return _section_of, (self.machine, "PositionsModel"), self.__getstate__()


class AtlasDrawing(Drawing):
    """Lengths on paper whose defaults are those of a machine's file."""

    machine: ClassVar[str] = ""

    def __reduce__(self) -> tuple[Any, ...]:
        return _section_of, (self.machine, "DrawingModel"), self.__getstate__()


def _section_of(kind: str, name: str) -> Any:
    """Return a section without values, to be filled from a pickle."""
    return object.__new__(getattr(machine_of(kind), name))


def _blank(kind: str, topics: tuple[str, ...]) -> AtlasParameters:
    """Return parameters without values, to be filled from a pickle."""
    blank: AtlasParameters = object.__new__(with_topics(machine_of(kind).Parameters, topics))
    return blank


@dataclass(frozen=True, eq=False)
class AtlasMachine:
    """A machine of the atlas in place of a module: the attributes that `reportgen.catalogue` describes."""

    kind: str
    compiled: CompiledMachine
    Parameters: type[AtlasParameters]
    PositionsModel: type[Positions]
    DrawingModel: type[Drawing]

    TURNS: ClassVar[int] = linkage.TURNS

    def __reduce__(self) -> tuple[Callable[[str], AtlasMachine], tuple[str]]:
        return machine_of, (self.kind,)

    @property
    def CHECKS(self) -> tuple[Callable[[Draft], Iterator[Finding]], ...]:
        return (self.check,)

    def expanded(self, given: AtlasParameters) -> tuple[linkage_file.Parameters | None, list[Finding]]:
        """Return the parameters of the linkage; None and the faults, at the parameters, if there is no such linkage."""
        try:
            content = self._content(given)
        except FormulaError as problem:
            return None, [Finding(problem.code, ("parameters",), problem.arguments)]
        plain, findings = read_section("parameters", linkage_file.Parameters, content)
        if plain is None or findings:
            return None, [self._of_student(finding) for finding in findings]
        topics = {name: getattr(given, name) for name in given.topic_names}
        model = with_topics(linkage_file.Parameters, given.topic_names)
        return model.model_construct(given.model_fields_set | plain.model_fields_set, **{**dict(plain), **topics}), []

    def _content(self, given: AtlasParameters) -> dict[str, Any]:
        """Return the plain content of the linkage for some parameters.  Raises `FormulaError`."""
        typed = {name: getattr(given, name) for name in self.compiled.parameters}
        further = {"g": given.g.text, "plane": given.plane}
        return {**self.compiled.expanded(typed), **{key: further[key] for key in given.model_fields_set & {*further}}}

    def check(self, draft: Draft) -> Iterator[Finding]:
        """Yield the faults that the linkage has with the student's parameters, at these."""
        given = draft.sections.get("parameters")
        if not isinstance(given, AtlasParameters):
            return
        made, findings = self.expanded(given)
        if made is not None:
            content = self._content(given)
            inner = Draft({**draft.raw, "parameters": content}, {**draft.sections, "parameters": made})
            findings = [self._of_student(finding) for check in linkage.CHECKS for finding in check(inner)]
        yield from findings_by_place(findings)

    def _of_student(self, finding: Finding) -> Finding:
        """Return a fault of the linkage at the parameter that causes it, or at all if several may."""
        top, *inner = finding.where
        if top != "parameters" or (inner and inner[0] in ("g", "plane")):
            return finding
        names = self.compiled.names_at(tuple(inner)) if inner else []
        where: Where = ("parameters", *(names if len(names) == 1 else ()))
        return replace(finding, where=where, at="value")

    def position_labels(self, parameters: AtlasParameters, positions: Positions) -> tuple[str, ...]:
        """Return the labels of the positions of the cycle: their numbers, if a check refuses the parameters."""
        made, _ = self.expanded(parameters)
        if made is None:
            return tuple(map(str, range(1, positions.count * self.TURNS + 1)))
        return linkage.position_labels(made, positions)

    def machine(self, assignment: Assignment) -> Machine:
        """Return the linkage of an assignment, with the machine's names of its parts."""
        given: AtlasParameters = assignment.parameters
        expanded = given.expanded
        made = linkage.machine(replace(assignment, parameters=expanded))
        typed = {name: getattr(given, name) for name in self.compiled.parameters}
        about = self.compiled, typed, expanded, made.calculation
        lines, closed = derived_lines(*about), made.closed_formulas
        words = self._facts(expanded, made, assignment.language)
        names = machine_words(atlas_files()[self.kind], assignment.language).get("parameters", {})
        free = [(FieldWords(names.get(name, name)).label, *row) for name, *row in free_parameters(*about)]
        places = any(isinstance(first, Symbol) and first.base in PLACES for first, *_ in (one.parts for one in lines))
        return replace(
            made,
            closed_formulas=replace(closed, equations={**closed.equations, "derived": lines}),
            facts={**made.facts, **words, "parameters": free, "derived": bool(lines), "derived_places": places},
        )

    def _facts(self, expanded: linkage_file.Parameters, made: Machine, language: Language) -> Mapping[str, Any]:
        """Return the words of the machine for the linkage's templates."""
        words = machine_words(atlas_files()[self.kind], language)
        links, names = words.get("links", {}), words.get("parameters", {})
        called = {id: FieldWords(names[key]).label for id, key in self._data(expanded) if key in names}
        return {
            "about": words.get("description", ""),
            "task": words.get("task", ""),
            "called": called,
            "links": {int(link): name for link, name in links.items() if link.isdecimal()},
            "first": links.get("1", ""),
            "motions": tuple(replace(row, called=links.get(str(row.link), "")) for row in made.facts["motions"]),
        }

    def _data(self, expanded: linkage_file.Parameters) -> Iterator[tuple[str, str]]:
        """Yield the ids of given data that are parameters as typed, with these."""
        bare = {at.where: at.formula.bare for at in self.compiled.formulas if at.formula.bare}
        for where, id in ids_by_place(expanded):
            if where in bare:
                yield id, bare[where]


def findings_by_place(findings: Sequence[Finding]) -> list[Finding]:
    """Return the first fault of each code at a place: several values of the linkage may come from one parameter."""
    return list({(finding.code, finding.where): finding for finding in reversed(findings)}.values())[::-1]


# --- by kind --------------------------------------------------------------------------------------


def machine_of(kind: str) -> AtlasMachine:
    """Return a machine of the atlas.

    Raises `KeyError` for an unknown one, and `AssignmentError` with the faults of its file.
    """
    machine, faults = _read(kind)
    if machine is None:
        raise as_error(faults, None)
    return machine


def faults_of(kind: str) -> tuple[Fault, ...]:
    """Return the faults of a machine's file; () for one that is in order, and for an unknown kind."""
    return _read(kind)[1] if kind in atlas_files() else ()


def faults_in(source: Source) -> list[Fault]:
    """Return the faults of a machine's file, with those of its assembly."""
    compiled, faults = read_machine(source, BASE)
    return faults if compiled is None else checked(compiled, source, linkage.CHECKS)


def doubts_in(source: Source) -> list[Fault]:
    """Return warnings about the name, the words and the bounds of a machine's file that has no faults."""
    compiled, _ = read_machine(source, BASE)
    if compiled is None:
        return []
    stem = Path(source.file).stem
    misnamed = [] if is_machine_name(stem) else placed(source, [Finding("machine-file-name", (), {"text": stem})])
    return [*misnamed, *without_names(compiled, source), *at_bounds(compiled, source, linkage.CHECKS)]


def _read(kind: str) -> tuple[AtlasMachine | None, tuple[Fault, ...]]:
    file = atlas_files()[kind]
    return _made(kind, machine_source(file), is_own_machine(file))


_cache: dict[str, tuple[Source, tuple[AtlasMachine | None, tuple[Fault, ...]]]] = {}


def _made(kind: str, source: Source, is_own: bool) -> tuple[AtlasMachine | None, tuple[Fault, ...]]:
    """Return the machine of nodes, read once; tests check the assembly of the program's own machines."""
    if kind in _cache and _cache[kind][0] is source:
        return _cache[kind][1]
    compiled, faults = read_machine(source, BASE)
    if compiled is not None and is_own:
        faults = checked(compiled, source, linkage.CHECKS)
    made = None if compiled is None or faults else _machine(kind, compiled)
    _cache[kind] = source, (made, tuple(faults))
    return _cache[kind][1]


def _machine(kind: str, compiled: CompiledMachine) -> AtlasMachine:
    name = kind.rpartition("/")[2].replace("-", "_")
    fields: dict[str, Any] = {
        key: (Annotated[Given, about.reader], about.default) for key, about in compiled.parameters.items()
    }
    parameters = create_model(
        "Parameters", __base__=AtlasParameters, __doc__=AtlasParameters.__doc__, __module__=f"atlas.{name}", **fields
    )
    loads, masses = (compiled.names_at((key,)) for key in ("loads", "masses"))
    accelerations = [name for key in ("epsilon1", "acceleration") for name in compiled.names_at(("driver", key))]
    parameters.machine = kind
    parameters.load_keys = (*dict.fromkeys((*masses, *loads)),)
    parameters.mass_keys = tuple(masses)
    parameters.is_loaded = any(compiled.content.linkage.get(key) for key in ("masses", "loads"))
    # Without such a parameter no file has this key.
    parameters.acceleration_key = ("parameters", next(iter(accelerations), "epsilon1"))
    content = compiled.content
    return AtlasMachine(
        kind,
        compiled,
        parameters,
        _with_defaults(AtlasPositions, content.positions, parameters),
        _with_defaults(AtlasDrawing, content.drawing, parameters),
    )


def _with_defaults(model: type[Any], given: Any, parameters: type[AtlasParameters]) -> type[Any]:
    """Return a section whose keys have the values of a given one as defaults."""
    fields: dict[str, Any] = {
        name: (model.model_fields[name].rebuild_annotation(), getattr(given, name)) for name in given.model_fields_set
    }
    made = create_model(
        model.__name__, __base__=model, __doc__=model.__doc__, __module__=parameters.__module__, **fields
    )
    made.machine = parameters.machine
    return made


# --- the file to begin with -----------------------------------------------------------------------


def starter(kind: str, text: str, language: Language) -> str:
    """Return the starter file of a machine, made of that of a linkage: its report, and the machine's own data."""
    words, machine = machine_words(atlas_files()[kind], language), machine_of(kind)
    lines = text.splitlines()
    report = lines[lines.index(f"kind: {ATLAS_BASE}") : lines.index("positions:")]
    given = machine.compiled.content.positions
    start = "" if given.start is None else f"  start: {given.start.text}\n"
    parameters = "".join(f"  {name}: {one.default.text}\n" for name, one in machine.compiled.parameters.items())
    return (
        f"# {words['title']}.\n"
        + "".join(
            f"{line}\n" for line in wrap(words.get("description", ""), 110, initial_indent="# ", subsequent_indent="# ")
        )
        + "".join(f"{line}\n" for line in (*lines[1:3], *report)).replace(f"kind: {ATLAS_BASE}", f"kind: {kind}")
        + f"positions:\n  count: {given.count}\n  direction: {given.direction}\n{start}\nparameters:\n{parameters}"
    )
