"""Every pair of topics in every kind of machine is computed, or refused at its place; none is ignored."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from itertools import combinations
from typing import Any

import numpy as np
import pytest
import yaml

import reportgen
from reportgen import catalogue
from reportgen.base.errors import AssignmentError
from reportgen.base.kinds import program_kinds
from reportgen.base.topics import topics
from reportgen.cases import MachineCase
from reportgen.catalogue.declared_loads import pins
from reportgen.catalogue.parameters import Driven
from reportgen.catalogue.topic_sections import TopicParameters, section_of, sections_of
from reportgen.friction.joints import friction_of
from reportgen.machine import Linkage, joints
from reportgen.machine.loads import carriers
from reportgen.machine.shared_results import PHYSICS
from reportgen.notebook import Model
from reportgen.report.context import ReportContext
from tests.lanes import matrix

MACHINES = [kind for kind in program_kinds() if issubclass(catalogue.kind(kind).base, TopicParameters)]
PAIRS = list(combinations(topics(), 2))
SEEN_TOGETHER = {
    ("flywheel", "friction"): lambda case: "friction.reduced" in case.ledger,
    ("friction", "motion"): lambda case: "friction.reduced" in case.ledger,
    ("faces", "friction"): lambda case: bool(friction_of(case.analysis.machine).faces),
    ("flywheel", "motion"): lambda case: "run.delta" in case.ledger and "unevenness" in case.ledger,
}
"""How the results show that one topic of a pair takes what the other provides."""


@cache
def sample(kind: str) -> Mapping[str, Any]:
    """The sample file of a kind as data, with a mass on each link that may have one."""
    data = yaml.load(catalogue.sample(kind, "en"), yaml.BaseLoader)
    parameters, base = dict(data["parameters"]), catalogue.kind(kind).base
    if issubclass(base, Driven):
        wanted = [link for link in base.links["m"] if not {f"m{link}", f"G{link}"} & parameters.keys()]
        parameters |= {f"m{link}": "2 kg" for link in wanted if link > 1}
    return {**data, "report": {"language": "en"}, "parameters": parameters}


@cache
def sections(kind: str) -> Mapping[str, object]:
    """A section of each topic for the sample of a kind, by what its linkage has."""
    linkage: Linkage = reportgen.open(sample(kind)).case.analysis.machine.linkage
    pin = next(joint.point for joint in joints(linkage) if joint.kind == "R")
    sliders = list(carriers(linkage))
    points = pins(linkage)
    link, at = next((link, name) for link in sorted(points) if link > 1 for name in sorted(points[link]))
    spring = {"link": link, "at": at, "to": ["2 m", "1.5 m"], "c": "0.1 N/mm", "free": "0.5 m"}
    return {
        "balancing": {},
        "faces": {str(sliders[-1] if sliders else link): {"from": "-30 mm", "to": "40 mm"}},
        "flywheel": {"delta": "1/30"},
        "friction": {"pins": {pin: {"f": "0.05", "r": "10 mm"}}},
        "motion": {"drive": {"constant": "find", "J": "20 kg m2"}},
        "springs": [spring],
    }


def with_topics(kind: str, names: tuple[str, ...]) -> Model:
    data = sample(kind)
    asked = {name: sections(kind)[name] for name in names}
    return reportgen.open({**data, "parameters": {**data["parameters"], **asked}})


def numbers(entries: object) -> Iterator[float]:
    """All numbers of nested results."""
    match entries:
        case Mapping():
            for name, one in entries.items():
                # A couple in a guide acts at no point.
                if name != "point":
                    yield from numbers(one)
        case list() | tuple():
            for one in entries:
                yield from numbers(one)
        case float() | complex() | np.number():
            yield abs(entries)


def test_each_topic_has_a_section_here() -> None:
    """A new topic enters the table of pairs by existing, and needs an example."""
    assert set(sections("slider-crank")) == set(topics())


@pytest.mark.parametrize(
    ("kind", "pair"),
    matrix(
        [(kind, pair) for kind in MACHINES for pair in PAIRS],
        telling=[(MACHINES[number % len(MACHINES)], pair) for number, pair in enumerate(PAIRS)],
    ),
)
def test_two_topics_of_one_machine(kind: str, pair: tuple[str, str]) -> None:
    if "faces" in pair and not carriers(reportgen.open(sample(kind)).case.analysis.machine.linkage):
        # Only what the machine does not have is refused: it says where.
        with pytest.raises(AssignmentError) as refused:
            with_topics(kind, pair)
        (problem,) = refused.value.problems
        assert (problem.code, problem.where[:2]) == ("no-slider", ("parameters", "faces"))
        return
    case = with_topics(kind, pair).case
    assert isinstance(case, MachineCase)
    machine = case.analysis.machine
    assert set(pair) <= machine.topics.keys()
    assert case.fault() == ""
    assert {section_of(topic).chapter for topic in pair} <= set(ReportContext(case).sections)
    assert all(map(np.isfinite, numbers(case.entries.positions)))
    if pair in SEEN_TOGETHER:
        assert SEEN_TOGETHER[pair](case)


def test_what_a_topic_uses_another_one_provides() -> None:
    provided = {one.result.name for hooks in PHYSICS.among(topics()) for one in hooks.provides}
    used = {result.name for section in sections_of(topics()) for result in section.uses}
    assert used <= provided


@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
def test_a_pair_that_shares_a_result_is_in_the_table(pair: tuple[str, str]) -> None:
    """Of two topics of which one provides what the other uses the results show it."""
    shares = any(
        {one.result.name for hooks in PHYSICS.among([giver]) for one in hooks.provides}
        & {result.name for result in section_of(taker).uses}
        for giver, taker in (pair, pair[::-1])
    )
    assert shares == (pair in SEEN_TOGETHER)
