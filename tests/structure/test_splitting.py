"""Splitting into Assur groups: known mechanisms, mechanisms put together of known groups, all subsets of links."""

from __future__ import annotations

import random

import numpy as np
import pytest

from reportgen.structure.splitting import ChainJoint, KinematicChain, StructureError, split

THREE_DYADS = "01 12 23 34 35 40 50"
STEPHENSON = "01 12 23 30 24 45 50"
TWO_TRIADS = "0-1 1-2 2-3 3-4 3-5 4-0 5-0 3-6 6-7 7-8 7-9 8-0 9-0 9-10 10-11 11-0"
CONTOUR = "01 12 23 34 45 52 40"
Sets = set[frozenset[int]]


def chain(text: str) -> KinematicChain:
    """Return the chain of joints written as `01` or `0-11`; `0~1` is a higher pair, `234` a multiple joint."""
    joints = list[ChainJoint]()
    for word in text.split():
        marked = next((mark for mark in "-~" if mark in word), "")
        numbers = word.split(marked) if marked else list(word)
        joints.append(ChainJoint(tuple(map(int, numbers)), marked == "~"))
    return KinematicChain(tuple(joints))


def groups(of: KinematicChain, driver: int) -> list[tuple[int, ...]]:
    return [group.links for group in split(of, driver).groups]


@pytest.mark.parametrize(
    ("text", "driver", "expected", "classes"),
    [
        ("01 12 23 30", 1, [(2, 3)], [2]),
        (THREE_DYADS, 1, [(2, 3, 4, 5)], [3]),
        (THREE_DYADS, 4, [(3, 5), (1, 2)], [2, 2]),
        (STEPHENSON, 5, [(1, 2, 3, 4)], [3]),
        (STEPHENSON, 1, [(2, 3), (4, 5)], [2, 2]),
        (TWO_TRIADS, 1, [(2, 3, 4, 5), (6, 7, 8, 9), (10, 11)], [3, 3, 2]),
        (CONTOUR, 1, [(2, 3, 4, 5)], [4]),
        # Two dyads on one pin B: the joint of links 2, 3 and 4 is two pairs.
        ("01 12 30 234 45 50", 1, [(2, 3), (4, 5)], [2, 2]),
    ],
)
def test_known_mechanisms_have_their_groups_and_classes(
    text: str, driver: int, expected: list[tuple[int, ...]], classes: list[int]
) -> None:
    made = split(chain(text), driver)
    assert chain(text).mobility == 1
    assert [group.links for group in made.groups] == expected
    assert [group.assur_class for group in made.groups] == classes
    assert made.mechanism_class == max(classes)


def test_orders_count_the_outer_pairs() -> None:
    assert [group.order for group in split(chain(TWO_TRIADS), 1).groups] == [3, 3, 2]
    assert [group.order for group in split(chain(CONTOUR), 1).groups] == [2]


def test_a_multiple_joint_does_not_depend_on_the_order_of_its_links() -> None:
    """Links 2 and 3 on the pin of crank 1 are in different groups, though the joint names them together."""
    for joint in ("123", "213", "321"):
        assert groups(chain(f"01 {joint} 24 40 35 50"), 1) == [(2, 4), (3, 5)]


@pytest.mark.parametrize(
    ("text", "links", "overdetermined"),
    [
        ("01 12 23 30 24 40", (1, 2, 3, 4), True),
        ("01 12 23 34 40", (2, 3, 4), False),
        ("01 12 23 34 45 56 60", (2, 3, 4, 5, 6), False),
        ("01 12 23 30 34", (4,), False),
        # Links 4 to 7 have one pair too many and turn about their pin on 3: the formula gives W = 1 nevertheless.
        ("01 12 23 30 34 45 56 67 74 46", (4, 5, 6, 7), True),
    ],
)
def test_sets_with_too_many_or_too_few_pairs_are_named(text: str, links: tuple[int, ...], overdetermined: bool) -> None:
    with pytest.raises(StructureError) as fault:
        split(chain(text), 1)
    assert (fault.value.links, fault.value.overdetermined) == (links, overdetermined)


def test_higher_pairs_become_links_and_rollers_are_removed() -> None:
    """Cam 1, roller 2 on follower 3: W is 2 with the roller, 1 without it; the equivalent is a four-bar."""
    cam = chain("01 1~2 23 30")
    assert (cam.mobility, cam.lower_pairs, cam.higher_pairs) == (2, 3, 1)
    rigid = cam.without([2])
    assert (rigid.mobility, rigid.lower_pairs, rigid.higher_pairs) == (1, 2, 1)
    lower, added = rigid.with_lower_pairs()
    assert lower.mobility == 1
    assert added == {4: (1, 3)}
    assert groups(lower, 1) == [(3, 4)]
    with pytest.raises(StructureError) as fault:
        split(cam.with_lower_pairs()[0], 1)
    assert not fault.value.overdetermined


# --- against other methods ------------------------------------------------------------------------

KINDS = {
    # Pairs inside the group, links with an outer pair, class.
    "dyad": ("01", (0, 1), 2),
    "triad": ("01 02 03", (1, 2, 3), 3),
    "contour": ("01 12 23 30", (0, 2), 4),
    "two triangles": ("01 02 03 14 15", (2, 3, 4, 5), 3),
}


def assembled(draw: random.Random, most: int) -> tuple[KinematicChain, dict[frozenset[int], int]]:
    """Return a mechanism of random known groups with at most so many links, and its groups with their classes."""
    joints, placed, expected = [(0, 1)], [0, 1], dict[frozenset[int], int]()
    while True:
        inner, outer, grade = KINDS[draw.choice(list(KINDS))]
        size = max(int(digit) for digit in inner if digit != " ") + 1
        first = len(placed)
        if first + size > most + 1:
            break
        hosts = draw.choices(placed, k=len(outer))
        if len(set(hosts)) == 1:
            hosts[0] = next(link for link in placed if link != hosts[0])
        joints += [(first + int(word[0]), first + int(word[1])) for word in inner.split()]
        joints += [(first + link, host) for link, host in zip(outer, hosts, strict=True)]
        links = range(first, first + size)
        placed += links
        expected[frozenset(links)] = grade
    numbers = [*range(1, len(placed))]
    draw.shuffle(numbers)
    draw.shuffle(joints)
    renamed = dict(enumerate([0, *numbers]))
    made = KinematicChain(tuple(ChainJoint(tuple(renamed[link] for link in draw.sample(pair, 2))) for pair in joints))
    return made, {frozenset(renamed[link] for link in links): grade for links, grade in expected.items()} | {
        frozenset(): renamed[1]
    }


def test_mechanisms_put_together_of_known_groups_are_split_into_them() -> None:
    draw = random.Random(66)
    for _ in range(2000):
        made, expected = assembled(draw, draw.randint(3, 14))
        driver = expected.pop(frozenset())
        result = split(made, driver)
        assert {frozenset(group.links): group.assur_class for group in result.groups} == expected
        before = {0, driver}
        for group in result.groups:
            assert {link for joint in group.outer for link in joint.links[1:]} <= before
            assert 2 * group.pairs == 3 * len(group.links)
            before |= {*group.links}


def tight_subsets(made: KinematicChain, placed: int) -> Sets:
    """Return the smallest sets of links outside `placed` (bits) with 3n = 2p, of all subsets."""
    free = [link for link in made.links if not placed >> link & 1]
    picks = np.arange(1, 1 << len(free))
    masks = np.zeros(len(picks), int)
    for place, link in enumerate(free):
        masks |= (picks >> place & 1) << link
    pairs = np.zeros(len(picks), int)
    for joint in made.joints:
        bits = sum(1 << link for link in joint.links)
        pairs += ((masks | placed) & bits == bits) & (masks & bits != 0)
    sizes = np.array([bin(mask).count("1") for mask in masks])
    tight = masks[3 * sizes == 2 * pairs]
    smallest = [mask for mask in tight if not any(mask & each == each and mask != each for each in tight)]
    return {frozenset(link for link in free if mask >> link & 1) for mask in smallest}


def test_no_subset_of_links_is_a_smaller_group() -> None:
    draw = random.Random(12)
    for _ in range(100):
        made, _ = assembled(draw, 12)
        for driver in made.drivers[:2]:
            try:
                result = split(made, driver)
            except StructureError:
                continue
            left, placed = {frozenset(group.links) for group in result.groups}, 1 | 1 << driver
            while left:
                smallest = tight_subsets(made, placed)
                assert smallest <= left
                assert smallest
                left -= smallest
                placed |= sum(1 << link for links in smallest for link in links)
