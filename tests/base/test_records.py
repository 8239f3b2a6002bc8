"""A record behaves like the frozen dataclass with slots that it replaces."""

import pickle
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import pytest

from reportgen.base.records import record


def _classes(decorated: Callable[[type], type]) -> tuple[Any, Any, Any, Any]:
    """A class without fields, one with each sort of field, and two derived from it."""

    @decorated
    class Empty:
        """Nothing."""

    @decorated
    class Base:
        """Each sort of field."""

        name: str
        values: tuple[float, ...] = ()
        place: int = field(default=0, compare=False, repr=False)
        tags: frozenset[str] = field(default_factory=frozenset, kw_only=True)

    @decorated
    class Derived(Base):
        """Another field."""

        unit: str = "mm"

    @decorated
    class Named(Base):
        """A class that defines its own text."""

        def __repr__(self) -> str:
            return f"<{self.name}>"

    return Empty, Base, Derived, Named


@record
class Point:
    """A record that pickle finds by its name."""

    x: float
    y: float = 0.0


NAN = float("nan")
ARGUMENTS = (("a",), ("b",), ("a", (1.0,)), ("a", (NAN,)), ("a", (), 3), ("a", (1.0,), 4))


def test_equality_and_text_are_those_of_a_frozen_dataclass() -> None:
    """For every pair of values, of the same class and of two classes."""
    records, dataclasses = (
        [empty(), *(of(*values) for of in (base, derived, named) for values in ARGUMENTS)]
        for empty, base, derived, named in (_classes(record), _classes(dataclass(frozen=True, slots=True)))
    )
    assert [[a == b for b in records] for a in records] == [[a == b for b in dataclasses] for a in dataclasses]
    assert [repr(a) for a in records] == [repr(a) for a in dataclasses]
    assert all(hash(a) == hash(b) for a in records for b in records if a == b)
    assert len(set(records)) == len(set(dataclasses))


def test_records_have_slots_and_are_copied_and_pickled() -> None:
    with pytest.raises(AttributeError):
        Point(1).z = 2.0
    assert replace(Point(1.0, 2.0), y=3.0) == Point(1.0, 3.0)
    assert pickle.loads(pickle.dumps(Point(1.0, 2.0))) == Point(1.0, 2.0)


def test_a_record_with_a_value_that_has_no_hash_has_none() -> None:
    with pytest.raises(TypeError):
        hash(Point([]))
