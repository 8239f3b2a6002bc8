"""A record behaves like a frozen dataclass with slots."""

import pickle
from abc import abstractmethod
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import pytest

from reportgen.base.records import AbstractRecord, Record, replace, uncompared


class Point(Record):
    """A class with a value that may be left out."""

    x: Any
    y: float = 0.0


class Named(Point, kw_only=True):
    """A derived class with a value that is given by its name."""

    name: str


class Other(Point):
    """A derived class with the same fields."""


@uncompared("place")
class Word(Record):
    """A class with a field that does not count in comparisons."""

    text: str
    place: list[int]


class Name(Word):
    """A class derived from it."""


@dataclass(frozen=True, slots=True)
class _Point:
    x: Any
    y: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class _Named(_Point):
    name: str


@dataclass(frozen=True, slots=True)
class _Other(_Point):
    pass


NAN = float("nan")


def _made(point: Any, named: Any, other: Any) -> list[Any]:
    """Return objects of three classes with equal and other values; a number that equals nothing equals itself."""
    values = ((1.0,), (1.0, 0.0), (0.0, 1.0), (NAN,), ((NAN, 2.0), 3.0), ("a",))
    return [
        *(point(*some) for some in values),
        *(other(*some) for some in values),
        *(named(x=some[0], name=name) for some in values for name in "ab"),
    ]


def test_equality_is_that_of_a_frozen_dataclass() -> None:
    """For every pair of values, of the same class and of two classes."""
    records, dataclasses = _made(Point, Named, Other), _made(_Point, _Named, _Other)
    assert [[a == b for b in records] for a in records] == [[a == b for b in dataclasses] for a in dataclasses]
    assert [repr(a) for a in records] == [repr(a).removeprefix("_") for a in dataclasses]
    assert all(hash(a) == hash(b) for a in records for b in records if a == b)
    assert len(set(records)) == len(set(dataclasses))


def test_fields_are_set_once_and_there_are_no_others() -> None:
    for name in ("x", "z"):
        with pytest.raises(AttributeError):
            setattr(Point(1), name, 2.0)


def test_fields_that_are_left_out_are_not_compared() -> None:
    """Not even for the hash, which a list does not have."""
    assert Word("a", [1]) == Word("a", [2]) != Word("b", [1])
    assert Word("a", [1]) != Name("a", [1]) == Name("a", [2])
    assert len({Word("a", [1]), Word("a", [2]), Name("a", [1])}) == 2


@pytest.mark.parametrize("given", [Named(x=1.0, y=2.0, name="a"), _Named(x=1.0, y=2.0, name="a")])
def test_copies_are_equal_and_change_what_is_named(given: Any) -> None:
    assert pickle.loads(pickle.dumps(given)) == deepcopy(given) == given
    assert replace(given, y=3.0, name="b") == type(given)(x=1.0, y=3.0, name="b")
    with pytest.raises(TypeError):
        replace(given, z=3.0)


def test_a_record_with_a_value_that_has_no_hash_has_none() -> None:
    with pytest.raises(TypeError):
        hash(Point([]))


def test_a_record_without_one_of_its_methods_is_not_made() -> None:
    class Shape(AbstractRecord):
        @abstractmethod
        def area(self) -> float: ...

    class Square(Shape):
        side: float

        def area(self) -> float:
            return self.side**2

    class Unfinished(Shape):
        side: float

    assert Square(3.0).area() == 9.0
    with pytest.raises(TypeError, match="area"):
        Unfinished(3.0)  # type: ignore[abstract]
