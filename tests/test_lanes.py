"""Only cases that are meant for `make proof` are left to it."""

from __future__ import annotations

from typing import Any

import pytest

from tests.lanes import matrix

slow = pytest.mark.skipif(False, reason="another mark")


def marks(case: Any) -> list[str]:
    return [mark.name for mark in getattr(case, "marks", ())]


def test_all_cases_but_the_telling_are_for_proof() -> None:
    assert [marks(case) for case in matrix("abc", ["b"])] == [["proof"], [], ["proof"]]


def test_a_case_of_several_parameters_tells_by_all_of_them() -> None:
    one, other = matrix([("a", 1), ("a", 2)], telling=[("a", 2)])
    assert (marks(one), one.values) == (["proof"], ("a", 1))
    assert other == ("a", 2)


def test_a_case_keeps_its_name_and_its_own_marks() -> None:
    one, other = matrix([pytest.param("a", id="x", marks=slow), pytest.param("b", id="y")], telling=["b"])
    assert (one.id, marks(one)) == ("x", ["skipif", "proof"])
    assert (other.id, marks(other)) == ("y", [])


def test_what_tells_must_be_a_case() -> None:
    with pytest.raises(ValueError, match="no cases: \\['d'\\]"):
        matrix("abc", ["d"])
