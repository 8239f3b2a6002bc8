"""A structure exercise with its groups, its ledger, and common mistakes in its numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from reportgen.case import Misconceptions
from reportgen.case.design_case import DesignCase
from reportgen.formula import Expression, Number, Ref, call, plus
from reportgen.formula.calculation import Calculation
from reportgen.formula.ledger import MistakenValues
from reportgen.structure import structure_ids as names
from reportgen.structure.placed_joints import PlacedJoints, placed
from reportgen.structure.splitting import (
    FRAME,
    AssurGroup,
    KinematicChain,
    Splitting,
    StructureError,
    formula_part,
    split,
)
from reportgen.structure.structure_file import Parameters, active


def whole(number: int) -> Expression:
    return Number(float(number), 0)


@dataclass(frozen=True)
class SolvedStructure(DesignCase):
    """An assignment of a mechanism's structure with its groups and its ledger."""

    @property
    def given(self) -> Parameters:
        parameters: Parameters = self.assignment.parameters
        return parameters

    @cached_property
    def chain(self) -> KinematicChain:
        """The mechanism without passive links and loose rollers."""
        return self.given.needed_chain

    @cached_property
    def _equivalent(self) -> tuple[KinematicChain, Mapping[int, tuple[int, int]]]:
        return self.chain.with_lower_pairs()

    @property
    def lower_chain(self) -> KinematicChain:
        """The mechanism with a link and two lower pairs for each higher pair."""
        return self._equivalent[0]

    @property
    def replacements(self) -> Mapping[int, tuple[int, int]]:
        """The links in contact by the link that replaces their higher pair."""
        return self._equivalent[1]

    @cached_property
    def placed(self) -> PlacedJoints:
        """The pairs as given, at their places; none without points."""
        return placed(self.given)

    @cached_property
    def placed_active(self) -> PlacedJoints:
        """The same without passive links and rollers, whose higher pairs pass to the links that carry them."""
        return self.placed.active(self.given)

    @cached_property
    def splitting(self) -> Splitting:
        return split(self.lower_chain, self.given.driver)

    @property
    def groups(self) -> tuple[AssurGroup, ...]:
        """The groups in the order of assembly."""
        return self.splitting.groups

    @cached_property
    def other_drivers(self) -> Mapping[int, Splitting | None]:
        """By every other link on the frame that the file asks for: the groups; None if it cannot drive."""
        if self.given.other_drivers is None:
            return {}
        others = (link for link in self.chain.drivers if link != self.given.driver)
        return {link: split_or_none(self.lower_chain, link) for link in others}

    # --- ledger

    @cached_property
    def calculation(self) -> Calculation:
        q = Calculation()
        q.give(names.TABLE, 1.0, hidden=True)
        self._count(q)
        _counted(q, names.GROUPS, len(self.groups))
        classes = list[Ref]()
        for group in self.groups:
            first = group.links[0]
            for link in group.links:
                _counted(q, names.group(link), first)
                of_link = _counted(q, names.group_class(link), group.assur_class)
            classes.append(of_link)
        if len(classes) > 1:
            q.define(names.MECHANISM_CLASS, call("max", *classes))
        else:
            _counted(q, names.MECHANISM_CLASS, self.splitting.mechanism_class)
        for link, splitting in self.other_drivers.items():
            if splitting is not None:
                _counted(q, names.class_by(link), splitting.mechanism_class)
        return q

    def _count(self, q: Calculation) -> None:
        """Enter the numbers of moving links and pairs, the mobility, and those of the equivalent mechanism."""
        chain = self.chain
        n = _counted(q, names.LINKS, len(chain.links), whole(len(chain.links) + 1) - 1)
        single = sum(len(joint.links) == 2 for joint in chain.joints if not joint.higher)
        multiple = [len(joint.links) for joint in chain.joints if len(joint.links) > 2]
        p5 = _counted(q, names.LOWER, chain.lower_pairs, plus(whole(single), *(whole(links) - 1 for links in multiple)))
        q.set_out("counts", n, *([p5] if multiple else []))
        if not chain.higher_pairs:
            q.set_out("mobility", q.define(names.MOBILITY, 3 * n - 2 * p5))
            return
        p4 = _counted(q, names.HIGHER, chain.higher_pairs)
        q.set_out("mobility", q.define(names.MOBILITY, 3 * n - 2 * p5 - p4))
        n2 = q.define(names.EQUIVALENT_LINKS, n + p4)
        p2 = q.define(names.EQUIVALENT_PAIRS, p5 + 2 * p4)
        q.set_out("equivalent", n2, p2, q.define(names.EQUIVALENT_MOBILITY, 3 * n2 - 2 * p2))

    # --- what is often taken for something else

    @cached_property
    def misconceptions(self) -> Misconceptions:
        """Common mistakes: frame counted, a multiple joint counted once, higher pairs as lower ones, a roller or a
        passive link kept, a class of the wrong group.
        """
        changed: dict[str, list[tuple[str, Expression]]] = {}
        for id, name, formula in (*self._of_counts(), *self._of_mobility(), *self._of_groups()):
            if id in self.ledger:
                changed.setdefault(id, []).append((name, formula))
        return Misconceptions(changed=changed)

    def _of_counts(self) -> MistakenValues:
        """Yield wrong counts; of several that give one number, only the first, the likeliest."""
        counted = dict[tuple[str, int], str]()
        for id, name, number in self._wrong_counts():
            counted.setdefault((id, number), name)
        for (id, number), name in counted.items():
            yield id, name, whole(number)

    def _wrong_counts(self) -> Iterator[tuple[str, str, int]]:
        chain, given = self.chain, self.given
        if given.rollers:
            kept = active(given.whole_chain, given.passive or ())
            yield names.LINKS, "structure-roller-kept", len(kept.links)
            yield names.LOWER, "structure-roller-kept", kept.lower_pairs
        if given.passive:
            kept = given.whole_chain.without(given.rollers or ())
            yield names.LINKS, "structure-passive-kept", len(kept.links)
            yield names.LOWER, "structure-passive-kept", kept.lower_pairs
        yield names.LINKS, "structure-frame", len(chain.links) + 1
        joints = sum(not joint.higher for joint in chain.joints)
        if joints != chain.lower_pairs:
            yield names.LOWER, "structure-multiple", joints
        if chain.higher_pairs:
            yield names.LOWER, "structure-higher", chain.lower_pairs + chain.higher_pairs

    def _of_mobility(self) -> MistakenValues:
        n, p5 = Ref(names.LINKS), Ref(names.LOWER)
        if self.chain.higher_pairs:
            p4 = Ref(names.HIGHER)
            yield names.MOBILITY, "structure-higher", 3 * n - 2 * (p5 + p4)
            yield names.MOBILITY, "structure-higher-left-out", 3 * n - 2 * p5
            yield names.MOBILITY, "structure-exchanged", 3 * n - p5 - 2 * p4

    def _of_groups(self) -> MistakenValues:
        for group in self.groups:
            for link in group.links:
                if group.order != group.assur_class:
                    yield names.group_class(link), "structure-order-for-class", whole(group.order)
        classes = [Ref(names.group_class(group.links[-1])) for group in self.groups]
        if len({group.assur_class for group in self.groups}) > 1:
            yield names.MECHANISM_CLASS, "structure-lowest-class", call("min", *classes)
        yield names.GROUPS, "structure-driver-as-group", whole(len(self.groups) + 1)


def _counted(q: Calculation, id: str, number: int, written: Expression | None = None) -> Ref:
    """Enter a number that is counted in the table of pairs.

    It depends on the table, so that it is a result and not given data.
    """
    return q.define(id, Ref(names.TABLE) * number, written=whole(number) if written is None else written)


def split_or_none(chain: KinematicChain, driver: int) -> Splitting | None:
    """Return the groups with a driver; None if it does not determine the motion of all links."""
    try:
        return split(chain, driver)
    except StructureError:
        return None


def formula_of(splitting: Splitting) -> str:
    """Return the formula of structure: I(0, 1) → II(2, 3)."""
    groups = (formula_part(group.assur_class, group.links) for group in splitting.groups)
    return " → ".join((formula_part(1, (FRAME, splitting.driver)), *groups))
