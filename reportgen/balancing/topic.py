"""The balancing section of a file: the shaking force, a counterweight on the crank, a four-bar's whole balance."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Length, Share
from reportgen.balancing import balance_ids
from reportgen.balancing.counterweights import Balancing, CounterweightRule, crank_rods, four_bar
from reportgen.base.errors import Finding
from reportgen.catalogue.declared_loads import Link, listed
from reportgen.catalogue.topic_sections import Opening, TopicData, TopicParameters, TopicSection, of_whole_turns
from reportgen.machine import DRIVER, Crank
from reportgen.machine.analysis import Machine

MOST_RULES = 4
RODS = ("rotating", "share")
"""Rules that distinguish the masses turning with the crank from the reciprocating ones."""


class CrankCounterweight(Part):
    """A counterweight on the crank at a `radius` from its centre, by the first of the `rules`; the others are
    compared.
    """

    rules: Annotated[tuple[CounterweightRule, ...], Field(min_length=1, max_length=MOST_RULES)]
    share: Share | None = None
    radius: Length


class BalancingTask(Part):
    """The chapter on balancing, with a counterweight on the crank or with counterweights on the links of a four-bar."""

    counterweight: CrankCounterweight | None = None
    links: Annotated[tuple[Link, ...], Field(min_length=1, max_length=MOST_RULES)] | None = None
    radius: Length | None = None

    @property
    def asked(self) -> Balancing:
        """The request in the form that the machine stores."""
        if (weight := self.counterweight) is not None:
            share = 0.0 if weight.share is None else weight.share.si
            return Balancing(weight.rules, share, radius=weight.radius.si)
        return Balancing(links=self.links or (), radius=0.0 if self.radius is None else self.radius.si)


def enter(opening: Opening) -> TopicData:
    """Enter the data of the counterweights."""
    given, datum = opening.given.section("balancing", BalancingTask), opening.datum
    assert given is not None, "the file asks for balancing"
    weight = given.counterweight
    radius = given.radius if weight is None else weight.radius
    if radius is not None:
        datum(balance_ids.RADIUS, radius, "", "")
    if weight is not None and weight.share is not None:
        datum(balance_ids.SHARE, weight.share, "", "")
    return TopicData(given.asked)


# --- faults -----------------------------------------------------------------------------------------


def faults(parameters: TopicParameters, machine: Machine) -> Iterator[Finding]:
    """Yield faults unless there are masses to balance and an evenly turning crank, and the request is unique and
    possible.
    """
    given = parameters.section("balancing", BalancingTask)
    if given is None:
        return
    where = ("parameters", "balancing")
    linkage = machine.linkage
    if not isinstance(linkage.driver, Crank):
        yield Finding("balancing-of-slide", where, at="key")
    elif not machine.cyclic:
        yield Finding("balancing-without-turn", where, {"key": "at" if machine.instants else "epsilon1"}, at="key")
    elif not any(body.mass and body.centre not in linkage.ground for body in linkage.inertias):
        yield Finding("balancing-without-mass", where, at="key")
    elif given.counterweight is not None:
        for key in ("links", "radius"):
            if getattr(given, key) is not None:
                yield Finding("both-given", (*where, key), {"first": "counterweight", "second": key}, at="key")
        yield from _of_rules(given.counterweight, machine)
    else:
        yield from _of_links(given, machine)


def _of_rules(given: CrankCounterweight, machine: Machine) -> Iterator[Finding]:
    """Yield faults unless rules are not repeated, those for slider-cranks find rods on the crank, and the rule that
    needs a share has it.
    """
    where = ("parameters", "balancing", "counterweight")
    offered = bool(crank_rods(machine.linkage))
    for index, rule in enumerate(given.rules):
        if rule in given.rules[:index]:
            yield Finding("repeated", (*where, "rules", index), {"text": rule})
        elif rule in RODS and not offered:
            yield Finding("rule-of-slider-cranks", (*where, "rules", index), {"text": rule})
    if "share" in given.rules and given.share is None:
        yield Finding("missing-key", (*where, "share"), {"key": "share"})
    if "share" not in given.rules and given.share is not None:
        yield Finding("share-without-rule", (*where, "share"), at="key")


def _of_links(given: BalancingTask, machine: Machine) -> Iterator[Finding]:
    """Yield faults of counterweights that are not on crank and rocker of a four-bar, or have no distance from their
    centres.
    """
    where = ("parameters", "balancing")
    if given.links is None:
        if given.radius is not None:
            yield Finding("missing-key", (*where, "links"), {"key": "counterweight | links"})
        return
    dyad = four_bar(machine.linkage)
    if dyad is None:
        yield Finding("balancing-of-four-bar", (*where, "links"), at="key")
        return
    wanted = (DRIVER, dyad.links[1])
    if tuple(sorted(given.links)) != wanted:
        about = {"text": listed(given.links), "known": listed(wanted)}
        yield Finding("balancing-links", (*where, "links"), about, at="key")
    if given.radius is None:
        yield Finding("missing-key", (*where, "radius"), {"key": "radius"})


HOOKS = TopicSection(
    annotation=BalancingTask | None,
    order=40,
    chapter="balancing/chapter",
    of_masses=True,
    fits=of_whole_turns,
    enter=enter,
    faults=faults,
    not_in_short=frozenset(("balancing/hodograph",)),
)
