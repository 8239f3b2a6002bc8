"""Ids of a synthesis, which begin with `synthesis`, with their vocabulary.

Solutions are numbered: 1 with the crank's centre beyond the chord of the driven pin, 2 with it before the chord.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import KeyChapter, QuantityKind, VocabularyRow
from reportgen.structure import three_point_names

centre = Name("synthesis.O.{number}")
along = Name("synthesis.beta.{number}")
far = Name("synthesis.far.{number}")
near = Name("synthesis.near.{number}")
crank = Name("synthesis.crank.{number}")
coupler = Name("synthesis.coupler.{number}")
frame = Name("synthesis.frame.{number}")
pivot_angle = Name("synthesis.delta.{number}")
ends = Name("synthesis.ends.{number}")
others = Name("synthesis.others.{number}")
near_angle = Name("synthesis.towards.{number}")
far_angle = Name("synthesis.away.{number}")
transmission = Name("synthesis.gamma.{number}")

SCAN = "synthesis.scan"
"""1; the places of best transmission, which a search over the arc gives, depend on it."""
K, SWING, ROCKER, STROKE = "synthesis.K", "synthesis.psi", "synthesis.c", "synthesis.H"
CRANK, FRAME, OFFSET, PERMITTED = "synthesis.a", "synthesis.d", "synthesis.e", "synthesis.permitted"
ANGLE, RADIUS, BEST = "synthesis.theta", "synthesis.rho", "synthesis.best"
FARTHEST = "synthesis.farthest"
"""The offset from which on one end of the stroke is below the crank's centre."""

KINDS: Mapping[str, QuantityKind] = {
    "length in mm": QuantityKind("mm", 1e-3),
    # Structural errors are hundredths of a degree.
    "fine angle": QuantityKind("°", math.pi / 180, decimals=4),
}

_G, _V = KeyChapter.geometry, KeyChapter.velocity
_LENGTH = "length in mm"

ROWS: tuple[VocabularyRow, ...] = (
    VocabularyRow(Name(SCAN), "S", "count"),
    VocabularyRow(Name(K), "K", "ratio"),
    VocabularyRow(Name(SWING), "ψ", "angle"),
    VocabularyRow(Name(ROCKER), "c", _LENGTH),
    VocabularyRow(Name(STROKE), "H", _LENGTH),
    VocabularyRow(Name(CRANK), "a", _LENGTH),
    VocabularyRow(Name(FRAME), "d", _LENGTH),
    VocabularyRow(Name(OFFSET), "e", _LENGTH, _G),
    VocabularyRow(Name(PERMITTED), "γ", "angle", below="per"),
    VocabularyRow(Name(ANGLE), "θ", "angle", _G),
    VocabularyRow(Name(RADIUS), "ρ", _LENGTH, _G),
    VocabularyRow(centre, "y", _LENGTH, _G, below="O", name="synthesis centre"),
    VocabularyRow(along, "β", "angle", _G, name="synthesis place"),
    VocabularyRow(far, "l", _LENGTH, _G, name="synthesis far"),
    VocabularyRow(near, "l", _LENGTH, _G, name="synthesis near"),
    VocabularyRow(crank, "a", _LENGTH, _G, name="synthesis crank"),
    VocabularyRow(coupler, "b", _LENGTH, _G, name="synthesis coupler"),
    VocabularyRow(frame, "d", _LENGTH, _G, name="synthesis frame"),
    VocabularyRow(pivot_angle, "δ", "angle", _G, name="synthesis pivot angle"),
    VocabularyRow(ends, "s", _LENGTH, _G, name="synthesis ends"),
    VocabularyRow(others, "s", _LENGTH, _G, name="synthesis others"),
    VocabularyRow(near_angle, "γ", "angle", _V, name="synthesis towards"),
    VocabularyRow(far_angle, "γ", "angle", _V, name="synthesis away"),
    VocabularyRow(transmission, "γ", "angle", _V, name="synthesis transmission"),
    VocabularyRow(Name(BEST), "γ", "angle", _V, below="max"),
    VocabularyRow(Name(FARTHEST), "e", _LENGTH, _G, below="max"),
    *three_point_names.ROWS,
)
