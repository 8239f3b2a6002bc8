"""The two lanes of the tests.

`make test` proves each behaviour once; `make proof` runs what that leaves out: all other cases of each matrix (every
assignment, size, language and engine), pages in a browser, batches killed in other ways, fuzz.  A test, or a case of
one, that is marked `proof` is of the second lane.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any

import pytest

proof = pytest.mark.proof


def matrix(cases: Iterable[Any], telling: Collection[Any]) -> list[Any]:
    """Return cases as parameters of a test; those that are not `telling` are marked for `make proof`.

    A case of several parameters tells by all of them, as a tuple.  Raises `ValueError` for what tells and is no case.
    """
    cases = list(cases)
    unknown = [one for one in telling if one not in map(_values, cases)]
    if unknown:
        raise ValueError(f"no cases: {unknown}")
    return [case if _values(case) in telling else _of_proof(case) for case in cases]


def _values(case: Any) -> Any:
    """Return the parameters of a case, unpacked if there is only one."""
    if not isinstance(case, _PARAMETERS):
        return case
    return case.values[0] if len(case.values) == 1 else tuple(case.values)


def _of_proof(case: Any) -> Any:
    if isinstance(case, _PARAMETERS):
        return pytest.param(*case.values, marks=(*case.marks, proof), id=case.id)
    return pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=proof)


_PARAMETERS = type(pytest.param())
