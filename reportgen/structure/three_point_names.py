"""Ids of a synthesis through three points, with the rows that they add to the vocabulary of `synthesis_ids`."""

from __future__ import annotations

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import KeyChapter, VocabularyRow

argument = Name("synthesis.x.{number}")
result = Name("synthesis.y.{number}")
driver = Name("synthesis.phi.{number}")
follower = Name("synthesis.follower.{number}")
driver_difference = Name("synthesis.p.{number}")
follower_difference = Name("synthesis.q.{number}")
right_side = Name("synthesis.t.{number}")
factor = Name("synthesis.factor.{number}")
end_angle = Name("synthesis.mu.{number}")
"""Angle between coupler and follower at both ends of the range, 1 and 2; from 3 on, on the frame line between."""
middle_driver = Name("synthesis.between.phi.{number}")
middle_result = Name("synthesis.between.y.{number}")
middle_follower = Name("synthesis.between.follower.{number}")
direction = Name("synthesis.direction.{number}")
opening = Name("synthesis.opening.{number}")
actual = Name("synthesis.actual.{number}")
error = Name("synthesis.error.{number}")

FIRST_X, LAST_X = "synthesis.x.first", "synthesis.x.last"
FIRST_Y, LAST_Y = "synthesis.y.first", "synthesis.y.last"
FIRST_DRIVER, LAST_DRIVER = "synthesis.driver.first", "synthesis.driver.last"
FIRST_FOLLOWER, LAST_FOLLOWER = "synthesis.range.first", "synthesis.range.last"
CRANK, COUPLER, FOLLOWER = "synthesis.points.a", "synthesis.points.b", "synthesis.points.c"
LEAST, LARGEST = "synthesis.mu", "synthesis.error"

_G, _V, _A = KeyChapter.geometry, KeyChapter.velocity, KeyChapter.acceleration
_LENGTH, _FINE = "length in mm", "fine angle"

ROWS: tuple[VocabularyRow, ...] = (
    VocabularyRow(Name(FIRST_X), "x", "ratio", below="0"),
    VocabularyRow(Name(LAST_X), "x", "ratio", below="n"),
    VocabularyRow(Name(FIRST_DRIVER), "φ", "angle", below="0"),
    VocabularyRow(Name(LAST_DRIVER), "φ", "angle", below="n"),
    VocabularyRow(Name(FIRST_FOLLOWER), "ψ", "angle", below="0"),
    VocabularyRow(Name(LAST_FOLLOWER), "ψ", "angle", below="n"),
    VocabularyRow(Name(FIRST_Y), "y", "ratio", _G, below="0"),
    VocabularyRow(Name(LAST_Y), "y", "ratio", _G, below="n"),
    VocabularyRow(argument, "x", "ratio", _G, below="{number}", name="synthesis argument"),
    VocabularyRow(result, "y", "ratio", _G, below="{number}", name="synthesis result"),
    VocabularyRow(driver, "φ", _FINE, _G, below="{number}", name="synthesis driver"),
    VocabularyRow(follower, "ψ", _FINE, _G, below="{number}", name="synthesis follower"),
    VocabularyRow(driver_difference, "p", "ratio", _G, below="{number}", name="synthesis driver difference"),
    VocabularyRow(follower_difference, "q", "ratio", _G, below="{number}", name="synthesis follower difference"),
    VocabularyRow(right_side, "t", "ratio", _G, below="{number}", name="synthesis right side"),
    VocabularyRow(factor, "K", "ratio", _G, below="{number}", name="synthesis factor"),
    VocabularyRow(Name(CRANK), "a", _LENGTH, _G),
    VocabularyRow(Name(COUPLER), "b", _LENGTH, _G),
    VocabularyRow(Name(FOLLOWER), "c", _LENGTH, _G),
    VocabularyRow(end_angle, "γ", _FINE, _V, below="{number}", name="synthesis end angle"),
    VocabularyRow(Name(LEAST), "γ", _FINE, _V, below="min"),
    VocabularyRow(middle_driver, "φ", _FINE, _A, below="m{number}", name="synthesis middle driver"),
    VocabularyRow(middle_result, "y", "ratio", _A, below="m{number}", name="synthesis middle result"),
    VocabularyRow(middle_follower, "ψ", _FINE, _A, below="m{number}", name="synthesis middle follower"),
    VocabularyRow(direction, "δ", _FINE, _A, below="{number}", name="synthesis direction"),
    VocabularyRow(opening, "ε", _FINE, _A, below="{number}", name="synthesis opening"),
    VocabularyRow(actual, "ψ", _FINE, _A, above="′", below="{number}", name="synthesis actual"),
    VocabularyRow(error, "Δψ", _FINE, _A, below="{number}", name="synthesis error"),
    VocabularyRow(Name(LARGEST), "Δψ", _FINE, _A, below="max"),
)
