"""Results as JSON has them: vectors as pairs, nothing where there is nothing, Python's own numbers."""

from __future__ import annotations

import json

import numpy as np

from reportgen.results import plain


def test_what_is_computed_becomes_plain_data() -> None:
    computed = {
        "p": np.complex128(1 - 2j),
        "far": complex(np.nan, np.nan),
        "omega": np.float64(-3.5),
        "free": np.bool_(True),
        "count": np.int64(3),
        "centre": None,
        2: [{"v": 0j}, ("rise", 0.5)],
    }
    told = json.loads(json.dumps(plain(computed), allow_nan=False))
    assert told == {
        "p": [1, -2],
        "far": None,
        "omega": -3.5,
        "free": True,
        "count": 3,
        "centre": None,
        "2": [{"v": [0, 0]}, ["rise", 0.5]],
    }
