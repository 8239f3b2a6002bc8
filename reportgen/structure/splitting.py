"""Split a plane mechanism into Assur groups.

Every moving link has three unknown coordinates and every lower pair gives two equations for them. A matching of
equations to unknowns shows which sets of links have too many equations or too few. If there are none, the links that
depend on each other (the strong components of the matching) are the groups, in the order of assembly.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property

from reportgen.base.records import Record

FRAME = 0
LINK_UNKNOWNS, PAIR_EQUATIONS, POINT_UNKNOWNS = 3, 2, 2

Unknown = tuple[str, int]
"""A link, or the point of a multiple joint, whose coordinates are unknown: `link` or `point` with its number."""


class ChainJoint(Record):
    """Two links in a pair, or several links on one pin, which are one lower pair fewer than links."""

    links: tuple[int, ...]
    higher: bool = False

    @property
    def pairs(self) -> int:
        """Number of pairs that this joint counts as."""
        return len(self.links) - 1


class KinematicChain(Record, dict=True):
    """The joints of a mechanism; link 0 is the frame.  A higher pair joins exactly two links."""

    joints: tuple[ChainJoint, ...]

    @cached_property
    def links(self) -> tuple[int, ...]:
        """The moving links in ascending order."""
        return tuple(sorted({link for joint in self.joints for link in joint.links} - {FRAME}))

    @property
    def lower_pairs(self) -> int:
        return sum(joint.pairs for joint in self.joints if not joint.higher)

    @property
    def higher_pairs(self) -> int:
        return sum(joint.higher for joint in self.joints)

    @property
    def mobility(self) -> int:
        """W = 3n − 2p₅ − p₄ by Chebyshev's formula."""
        return 3 * len(self.links) - 2 * self.lower_pairs - self.higher_pairs

    @property
    def drivers(self) -> tuple[int, ...]:
        """The links that are joined to the frame by a lower pair and could drive the mechanism."""
        on_frame = (joint.links for joint in self.joints if not joint.higher and FRAME in joint.links)
        return tuple(sorted({link for links in on_frame for link in links} - {FRAME}))

    def without(self, links: Iterable[int]) -> KinematicChain:
        """Return the chain with rollers removed: each is fixed to the link that carries its pin.

        A roller has one pin and any number of higher pairs, which pass to the link that carries it.
        """
        joints = self.joints
        for roller in links:
            pin = next(joint for joint in joints if roller in joint.links and not joint.higher)
            carrier = next(link for link in pin.links if link != roller)
            kept = []
            for joint in joints:
                rest = tuple(link for link in joint.links if link != roller)
                if roller in joint.links and joint.higher:
                    rest = (*rest, carrier)
                if len(rest) > 1:
                    kept.append(ChainJoint(rest, joint.higher))
            joints = tuple(kept)
        return KinematicChain(joints)

    def with_lower_pairs(self) -> tuple[KinematicChain, Mapping[int, tuple[int, int]]]:
        """Return the equivalent chain of lower pairs, and by number of each added link the links in contact.

        Each higher pair becomes a link with two lower pairs, numbered after the last link.
        """
        joints, added, number = list[ChainJoint](), dict[int, tuple[int, int]](), max(self.links, default=0)
        for joint in self.joints:
            if joint.higher:
                number += 1
                first, second = joint.links
                added[number] = (first, second)
                joints += [ChainJoint((first, number)), ChainJoint((number, second))]
            else:
                joints.append(joint)
        return KinematicChain(tuple(joints)), added


class AssurGroup(Record, dict=True):
    """An Assur group: its links, the joints of its own, and the number of pairs that join it to earlier links."""

    links: tuple[int, ...]
    inner: tuple[ChainJoint, ...]
    outer: tuple[ChainJoint, ...]
    """Each with one link of the group, then the earlier links."""

    @property
    def pairs(self) -> int:
        return sum(joint.pairs for joint in self.inner) + len(self.outer)

    @property
    def order(self) -> int:
        """Number of the pairs that join the group to earlier links."""
        return len(self.outer)

    @cached_property
    def contours(self) -> tuple[int, ...]:
        """By inner joint that is part of a closed contour of the group: the number of links in its smallest one."""
        lengths = (self._smallest_contour(joint) for joint in self.inner)
        return tuple(length for length in lengths if length)

    @property
    def assur_class(self) -> int:
        """Class after Artobolevsky: of its highest contour.

        A closed contour of links has as its class the number of its links, a link with three or more pairs
        class 3, a link with two pairs class 2.
        """
        joints = (*self.inner, *self.outer)
        per_link = (sum(link in joint.links for joint in joints) for link in self.links)
        return max(3 if any(count > 2 for count in per_link) else 2, *self.contours, 2)

    def _smallest_contour(self, joint: ChainJoint) -> int:
        """Return the number of links of the smallest closed contour through a joint; 0 if there is none."""
        start = joint.links[0]
        rest = [each for each in self.inner if each is not joint]
        distances, queue = {start: 1}, deque([start])
        while queue:
            link = queue.popleft()
            for each in rest:
                if link in each.links:
                    for following in each.links:
                        if following not in distances:
                            distances[following] = distances[link] + 1
                            queue.append(following)
        return min((distances[link] for link in joint.links[1:] if link in distances), default=0)


class Splitting(Record):
    """The groups of a mechanism with a driver, in the order of assembly."""

    driver: int
    groups: tuple[AssurGroup, ...]

    @property
    def mechanism_class(self) -> int:
        """The class of its highest group, 1 for a driver alone."""
        return max((group.assur_class for group in self.groups), default=1)


class StructureError(Exception):
    """A chain that cannot be split: some of its links have too many pairs, or too few."""

    def __init__(self, links: Iterable[int], overdetermined: bool) -> None:
        self.links = tuple(sorted(links))
        self.overdetermined = overdetermined
        super().__init__(f"links {self.links} are {'overdetermined' if overdetermined else 'loose'}")


def split(chain: KinematicChain, driver: int) -> Splitting:
    """Return the groups of a chain of lower pairs whose motion is that of one driver on the frame.

    Raises `StructureError` with the links that have too many pairs or too few.
    """
    equations = _equations(chain, driver)
    excess = _excess(equations)
    if excess:
        raise StructureError(_links(_smallest(equations, excess)), overdetermined=True)
    matching = _match(equations, ("link", FRAME))
    loose = matching.loose([("link", link) for link in chain.links])
    if loose:
        raise StructureError(_links(loose), overdetermined=False)
    placed: set[Unknown] = {("link", FRAME)}
    groups = list[AssurGroup]()
    for component in _components(matching.dependencies):
        links = tuple(sorted(_links(component)))
        if links and links != (driver,):
            groups.append(_group(chain, links, placed))
        placed |= component
    return Splitting(driver, tuple(groups))


def rigid_links(chain: KinematicChain) -> tuple[int, ...]:
    """Return the smallest set of links, the frame perhaps among them, that a chain with one freedom makes one body.

    A motion between any two links that are in a pair could drive the chain, unless they belong to one body. Return ()
    if there is no such set.
    """
    equations = _equations(chain, None)
    for joint in chain.joints:
        first, *others = joint.links
        for second in others:
            driven = [*equations, (("link", first), ("link", second))]
            excess = _excess(driven)
            if excess:
                return tuple(sorted(number for sort, number in _smallest(driven, excess) if sort == "link"))
    return ()


def _links(nodes: Iterable[Unknown]) -> set[int]:
    return {number for sort, number in nodes if sort == "link" and number != FRAME}


def _group(chain: KinematicChain, links: tuple[int, ...], placed: set[Unknown]) -> AssurGroup:
    """Return the group of these links, which earlier nodes carry."""
    inner, outer = list[ChainJoint](), list[ChainJoint]()
    for index, joint in enumerate(chain.joints):
        own = tuple(link for link in joint.links if link in links)
        earlier = tuple(link for link in joint.links if ("link", link) in placed)
        if earlier or ("point", index) in placed:
            outer += [ChainJoint((link, *earlier)) for link in own]
        elif len(own) > 1:
            inner.append(ChainJoint(own))
    return AssurGroup(links, tuple(inner), tuple(outer))


# --- writing ----------------------------------------------------------------------------------------

ROMAN = ("0", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X")


def roman(number: int) -> str:
    """Return the class of a group or mechanism as it is written."""
    return ROMAN[number] if number < len(ROMAN) else str(number)


def formula_part(number: int, links: Iterable[int]) -> str:
    """Return the part of a formula of structure for the links of a class: II(2, 3)."""
    return f"{roman(number)}({', '.join(map(str, links))})"


# --- equations and unknowns -----------------------------------------------------------------------

Equation = tuple[Unknown, Unknown]
"""One equation between the coordinates of two nodes."""


def _equations(chain: KinematicChain, driver: int | None) -> list[Equation]:
    """Return all equations: two a pair, a third one for the pair of the driver, if there is one, with the frame.

    The point of a multiple joint is a node of its own, so the result does not depend on how its links are paired.
    """
    equations, driven = list[Equation](), driver is None
    for index, joint in enumerate(chain.joints):
        if len(joint.links) == 2:
            first, second = joint.links
            count = PAIR_EQUATIONS
            if not driven and {first, second} == {FRAME, driver}:
                count, driven = count + 1, True
            equations += [(("link", first), ("link", second))] * count
        else:
            equations += [(("link", link), ("point", index)) for link in joint.links for _ in range(PAIR_EQUATIONS)]
    if driver is not None and not driven:
        equations.append((("link", FRAME), ("link", driver)))
    return equations


class Matching(Record):
    """Equations matched to unknowns, each node with as many as it has unknown coordinates."""

    equations: Sequence[Equation]
    root: Unknown
    of_node: Mapping[Unknown, list[int]]
    """By node: the equations matched to it."""
    excess: frozenset[Unknown]
    """Nodes of the first set with more equations than unknowns; empty if every equation is matched."""

    def unknown(self, index: int) -> list[Unknown]:
        """Return the nodes of an equation that are not the root."""
        return [node for node in self.equations[index] if node != self.root]

    def loose(self, nodes: Iterable[Unknown]) -> set[Unknown]:
        """Return the nodes that can move: those from which an alternating path leads to a free unknown."""
        movable = {node for node in nodes if len(self.of_node.get(node, ())) < _unknowns(node)}
        queue = deque(movable)
        while queue:
            node = queue.popleft()
            for index in range(len(self.equations)):
                if node not in self.equations[index]:
                    continue
                for owner in self.unknown(index):
                    if index in self.of_node.get(owner, ()) and owner not in movable:
                        movable.add(owner)
                        queue.append(owner)
        return movable

    @property
    def dependencies(self) -> dict[Unknown, set[Unknown]]:
        """By node: the nodes that its equations name besides it."""
        return {
            node: {other for index in owned for other in self.unknown(index) if other != node}
            for node, owned in self.of_node.items()
        }


def _unknowns(node: Unknown) -> int:
    return LINK_UNKNOWNS if node[0] == "link" else POINT_UNKNOWNS


def _match(equations: Sequence[Equation], root: Unknown) -> Matching:
    """Match equations to the unknowns of all nodes but the root, which is at rest.

    Any set of links with too many equations leaves one unmatched if the root is one of its links.
    """
    of_node: dict[Unknown, list[int]] = {node: [] for pair in equations for node in pair if node != root}

    def augment(index: int, seen: set[Unknown]) -> bool:
        for node in equations[index]:
            if node == root or node in seen:
                continue
            seen.add(node)
            owned = of_node[node]
            if len(owned) < _unknowns(node):
                owned.append(index)
                return True
            for place, moved in enumerate(owned):
                if augment(moved, seen):
                    owned[place] = index
                    return True
        return False

    for index in range(len(equations)):
        seen: set[Unknown] = set()
        if not augment(index, seen):
            return Matching(equations, root, of_node, frozenset(seen | {root}))
    return Matching(equations, root, of_node, frozenset())


def _excess(equations: Sequence[Equation]) -> frozenset[Unknown]:
    """Return the links and points of a set with more equations than unknowns; empty if there is none."""
    for root in sorted({node for pair in equations for node in pair if node[0] == "link"}):
        matching = _match(equations, root)
        if matching.excess:
            return matching.excess
    return frozenset()


def _smallest(equations: Sequence[Equation], excess: frozenset[Unknown]) -> frozenset[Unknown]:
    """Return a part of a set with too many equations none of whose links can be left out."""
    for node in sorted(excess):
        less = excess - {node}
        smaller = _excess([pair for pair in equations if less.issuperset(pair)])
        if smaller:
            return _smallest(equations, smaller)
    return excess


def _components(graph: Mapping[Unknown, set[Unknown]]) -> Iterator[set[Unknown]]:
    """Yield the strong components of a graph (Tarjan), each after those that it depends on."""
    index: dict[Unknown, int] = {}
    low: dict[Unknown, int] = {}
    stack: list[Unknown] = []
    waiting: set[Unknown] = set()

    def visit(node: Unknown) -> Iterator[set[Unknown]]:
        index[node] = low[node] = len(index)
        stack.append(node)
        waiting.add(node)
        for following in sorted(graph[node]):
            if following not in index:
                yield from visit(following)
                low[node] = min(low[node], low[following])
            elif following in waiting:
                low[node] = min(low[node], index[following])
        if low[node] == index[node]:
            component: set[Unknown] = set()
            while node not in component:
                last = stack.pop()
                waiting.discard(last)
                component.add(last)
            yield component

    for node in sorted(graph):
        if node not in index:
            yield from visit(node)
