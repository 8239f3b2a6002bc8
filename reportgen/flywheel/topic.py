"""The flywheel section of a file: the permitted unevenness of the speed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from reportgen.assignment.common import Check, Draft, Part
from reportgen.assignment.fields import Interval, Ratio
from reportgen.base.errors import Finding
from reportgen.base.topics import topics
from reportgen.base.units import Given
from reportgen.catalogue.topic_sections import (
    Datum,
    Opening,
    TopicData,
    TopicParameters,
    TopicSection,
    of_whole_turns,
    on_whole_turns,
    sections_of,
)
from reportgen.formula import Symbol
from reportgen.machine.shared_results import LOST_TORQUE

Unevenness = Annotated[Given, Ratio(Interval(least=1e-4, most=0.5))]


class Flywheel(Part):
    """Permitted unevenness of the speed: δ = (ω_max − ω_min)/ω_m."""

    delta: Unevenness


def checks(parameters: type[TopicParameters]) -> tuple[Check, ...]:
    """Check that a mass or a load is given to even out, and that the crank makes whole turns."""

    def loaded(draft: Draft) -> Iterator[Finding]:
        given = [topic for topic in topics() if draft.at("parameters", topic)]
        loads = parameters.is_loaded or any(draft.at("parameters", key) for key in parameters.load_keys)
        if not loads and not any(section.acts for section in sections_of(given)):
            yield Finding("flywheel-without-loads", ("parameters", "flywheel"), at="key")

    return loaded, *on_whole_turns("flywheel")(parameters)


def enter_speed(given: TopicParameters, datum: Datum) -> None:
    """Enter δ."""
    flywheel = given.section("flywheel", Flywheel)
    if flywheel is not None:
        datum("unevenness", flywheel.delta, Symbol("δ", "ω"), "ratio")


def enter(opening: Opening) -> TopicData:
    """Return δ as the subject of the topic."""
    flywheel = opening.given.section("flywheel", Flywheel)
    assert flywheel is not None, "the file asks for a flywheel"
    return TopicData(flywheel.delta.si)


HOOKS = TopicSection(
    annotation=Flywheel | None,
    order=50,
    chapter="flywheel",
    uses=(LOST_TORQUE,),
    checks=checks,
    enter_speed=enter_speed,
    fits=of_whole_turns,
    enter=enter,
    not_in_short=frozenset(("flywheel-work", "flywheel-speed", "flywheel-table", "comments/flywheel")),
)
