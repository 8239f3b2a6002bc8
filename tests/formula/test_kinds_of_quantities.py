"""Kinds of quantities: each has one name and one unit, in whichever room it stands."""

from __future__ import annotations

from collections import Counter
from importlib import import_module

from reportgen.formula.vocabulary import heads


def test_no_two_rooms_name_a_kind_alike() -> None:
    """Rooms are loaded as their ids are met: the later one would print the other's values in its unit."""
    names = Counter(name for module in heads().values() for name in import_module(module).KINDS)
    assert [name for name, count in names.items() if count > 1] == []
