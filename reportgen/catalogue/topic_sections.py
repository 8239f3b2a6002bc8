"""Add topics to the parameters of a machine; `TopicSection` has the hooks of a topic for its section of the file.

`with_topics` adds the sections to the parameters of a kind.  A file is read with the sections that it names; the schema
and the form show all.  A topic has its `TopicSection` as `HOOKS` in its module `topic`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any, ClassVar, Literal, TypeVar

from pydantic import create_model

from reportgen.assignment.common import Check, Draft, Part
from reportgen.base.errors import Finding
from reportgen.base.records import Record, field, replace
from reportgen.base.topics import TOPIC_MODULE, HookModule
from reportgen.base.units import Given
from reportgen.formula import Ref, Symbol
from reportgen.machine import Linkage
from reportgen.machine.analysis import Machine
from reportgen.machine.load_laws import MotionAt
from reportgen.machine.loads import Applied, Torque
from reportgen.machine.shared_results import SharedResult

Section = TypeVar("Section")
Datum = Callable[[str, Given, Symbol | str, str], Ref]
"""Function that enters a quantity as typed: its id, the given value, its symbol, its kind."""
ChapterPlace = Literal["loads", "groups", "driver"]
"""Place of a chapter: behind the loads, behind the groups, or behind the balance of the driver."""


class TopicParameters(Part):
    """Parameters that may have sections of topics."""

    acceleration_key: ClassVar[tuple[str, ...]] = ()
    """The place of the driver's acceleration in the file."""
    load_keys: ClassVar[tuple[str, ...]] = ()
    """The parameters that give a mass or a load."""
    mass_keys: ClassVar[tuple[str, ...]] = ()
    """Those of them that give a mass or a moment of inertia."""
    moment_keys: ClassVar[tuple[str, ...]] = ()
    """Those of them that give a moment of inertia alone."""
    is_loaded: ClassVar[bool] = False
    """True if the machine has a mass or a load whatever the file gives."""
    topic_names: ClassVar[tuple[str, ...]] = ()
    """The topics whose sections have been added."""

    def __init_subclass__(cls, extends: tuple[str, ...] = (), **rest: Any) -> None:
        cls.topic_names = extends
        super().__init_subclass__(**rest)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle a model with sections of topics by the model of its kind and the names of the topics."""
        model = type(self).__base__ if self.topic_names else type(self)
        return _blank, (model, self.topic_names), self.__getstate__()

    def section(self, topic: str, of: type[Section]) -> Section | None:
        """Return the section of a topic, None if the file has none."""
        given = getattr(self, topic, None)
        assert given is None or isinstance(given, of), f"the section {topic} is not a {of.__name__}"
        return given

    def asked(self) -> tuple[str, ...]:
        """Return the topics with a section in the file, in the order in which their data are entered."""
        return in_order(name for name in self.topic_names if getattr(self, name))

    @property
    def slides(self) -> bool:
        """True if the driver slides rather than turns."""
        return False


class Opening(Record):
    """The data that a topic can use to enter its own while the calculation of a machine is started."""

    given: TopicParameters
    linkage: Linkage
    datum: Datum
    loads: tuple[Applied | Torque, ...]
    """The loads of the kind and those that the file declares."""
    motion_at: MotionAt
    provided: Mapping[str, object] = field(default_factory=dict)
    """Values provided by earlier topics, by the names of the shared results."""


class TopicData(Record):
    """Result of reading a topic's section: the subject that the machine then has, and loads that act on it."""

    subject: object = None
    loads: tuple[Applied | Torque, ...] = ()
    provided: Mapping[str, object] = field(default_factory=dict)
    """Values for later topics, by the names of the shared results."""


def _no_data(opening: Opening) -> TopicData:
    return TopicData()


def _no_speed(given: TopicParameters, datum: Datum) -> None:
    """Enter nothing: the default for a topic without a datum about the driver's speed."""


def _no_faults(given: TopicParameters, machine: Machine) -> Iterator[Finding]:
    yield from ()


def _no_failures(machine: Machine, worked: Sequence[int]) -> Iterator[Finding]:
    yield from ()


def _no_warnings(machine: Machine) -> Iterator[Finding]:
    yield from ()


def _always(machine: Machine) -> bool:
    return True


def of_whole_turns(machine: Machine) -> bool:
    """Return True if a crank makes whole turns at a speed that is constant in the mean."""
    return machine.cyclic and not machine.span


def _no_checks(parameters: type[TopicParameters]) -> tuple[Check, ...]:
    return ()


class TopicSection(Record):
    """The section of a topic in the file of a machine, and its chapter in the report.

    `annotation` and `default` are those of the field of the parameters.  Topics enter their data, and their chapters of
    one place follow each other, by `order`.
    """

    annotation: object
    order: int
    chapter: str
    place: ChapterPlace = "driver"
    default: object = None
    not_in_short: frozenset[str] = frozenset()
    """Parts of the chapter that a short report leaves out."""
    of_a_turn: frozenset[str] = frozenset()
    """Parts of the chapter that a report of single instants leaves out."""
    acts: bool = False
    """True if it loads the machine."""
    of_masses: bool = False
    """True if it needs a mass; a load alone is not enough."""
    fits: Callable[[Machine], bool] = _always
    """Returns False for a machine that cannot have the topic, whatever the file gives."""
    uses: tuple[SharedResult[object], ...] = ()
    """Results of other topics that it uses if a machine has them."""
    checks: Callable[[type[TopicParameters]], tuple[Check, ...]] = _no_checks
    """Checks of the file alone."""
    enter_speed: Callable[[TopicParameters, Datum], None] = _no_speed
    """Enters data that belong to the driver's speed."""
    enter: Callable[[Opening], TopicData] = _no_data
    faults: Callable[[TopicParameters, Machine], Iterator[Finding]] = _no_faults
    """Yields faults for joints, links or points in the section that the machine does not have."""
    failures: Callable[[Machine, Sequence[int]], Iterator[Finding]] = _no_failures
    """Yields failures of a valid machine during its cycle, for the worked positions or all."""
    warnings: Callable[[Machine], Iterator[Finding]] = _no_warnings
    """Yields warnings about values that are allowed but probably not intended."""


SECTIONS = HookModule(TOPIC_MODULE, TopicSection)


def section_of(topic: str) -> TopicSection:
    """Return the section of a topic."""
    section = SECTIONS.of(topic)
    assert section is not None, f"{topic} is a topic"
    return section


def in_order(names: Iterable[str]) -> tuple[str, ...]:
    """Return the names of topics in the order in which their data are entered."""
    return tuple(sorted(names, key=lambda name: section_of(name).order))


def sections_of(names: Iterable[str]) -> Iterator[TopicSection]:
    """Yield the sections of some topics in their order."""
    return map(section_of, in_order(names))


Model = TypeVar("Model", bound=TopicParameters)


@cache
def with_topics(model: type[Model], names: tuple[str, ...]) -> type[Model]:
    """Return the parameters `model` with the sections of some topics."""
    if not names:
        return model
    fields: dict[str, Any] = {name: (section_of(name).annotation, section_of(name).default) for name in in_order(names)}
    return create_model(
        model.__name__,
        __base__=model,
        __doc__=model.__doc__,
        __module__=model.__module__,
        __cls_kwargs__={"extends": names},
        **fields,
    )


def _blank(model: type[TopicParameters], names: tuple[str, ...]) -> TopicParameters:
    """Return parameters without values, to be filled from a pickle."""
    made = with_topics(model, names)
    blank: TopicParameters = object.__new__(made)
    return blank


def topic_checks(model: type[Part], names: tuple[str, ...]) -> tuple[Check, ...]:
    """Return the checks of some topics in the file of a kind with the parameters `model`."""
    if not issubclass(model, TopicParameters):
        return ()
    return tuple(check for section in sections_of(names) for check in section.checks(model))


class EnteredTopics(Record):
    """The topics of a machine, once their data are entered."""

    subjects: Mapping[str, object] = field(default_factory=dict)
    loads: tuple[Applied | Torque, ...] = ()


def entered(opening: Opening) -> EnteredTopics:
    """Enter the data of all topics in the file; a topic without a subject is left out."""
    made: dict[str, TopicData] = {}
    for name in opening.given.asked():
        provided = {key: value for data in made.values() for key, value in data.provided.items()}
        made[name] = section_of(name).enter(replace(opening, provided=provided))
    return EnteredTopics(
        {name: data.subject for name, data in made.items() if data.subject},
        tuple(load for data in made.values() for load in data.loads),
    )


def on_whole_turns(topic: str) -> Callable[[type[TopicParameters]], tuple[Check, ...]]:
    """Return the checks of a topic that requires whole turns of a crank at a speed that is constant in the mean."""

    def checks(parameters: type[TopicParameters]) -> tuple[Check, ...]:
        def turns(draft: Draft) -> Iterator[Finding]:
            given = draft.sections.get("parameters")
            if isinstance(given, TopicParameters) and given.slides:
                yield Finding(f"{topic}-of-slide", ("parameters", topic), at="key")

        def steadily(draft: Draft) -> Iterator[Finding]:
            keys = (parameters.acceleration_key, ("positions", "at"))
            given = [place[-1] for place in keys if draft.at(*place) is not None]
            if given:
                yield Finding(f"{topic}-without-turn", ("parameters", topic), {"key": given[0]}, at="key")

        return turns, steadily

    return checks


def chapters(names: Iterable[str], place: ChapterPlace) -> tuple[str, ...]:
    """Return the chapters of some topics at a place of the report."""
    return tuple(section.chapter for section in sections_of(names) if section.place == place)
