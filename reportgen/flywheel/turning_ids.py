"""Ids of a turning-moment diagram, which begin with `turning`, with their vocabulary.

A side is `d`, the driving torque, or `r`, the resisting one. Points of the cycle are numbered from 1, its start.
"""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import KeyChapter, QuantityKind, VocabularyRow

cosine = Name("turning.a.{side}.{number}")
sine = Name("turning.b.{side}.{number}")
node_angle = Name("turning.x.{side}.{number}")
node_torque = Name("turning.y.{side}.{number}")
point = Name("turning.phi.{number}")
on_paper = Name("turning.area.{number}")
area = Name("turning.A.{number}")
energy = Name("turning.E.{number}")
extreme = Name("turning.E.{bound}")
speed = Name("turning.omega.{bound}")
scale = Name("turning.mu.{of}")

MEAN, FACTOR, CYCLE = "turning.M.mean", "turning.kappa", "turning.cycle"
MEAN_OF_LOAD = "turning.M.load"
RANGE, WORK, SHARE, POWER = "turning.range", "turning.W", "turning.share", "turning.P"
N, OMEGA, DELTA = "turning.n", "turning.omega", "turning.delta"
J, MASS, RADIUS = "turning.J", "turning.m", "turning.k"
AT, TORQUE_AT, ACCELERATION = "turning.at", "turning.M.at", "turning.eps"
PER_SPEED = "turning.c"

KINDS: Mapping[str, QuantityKind] = {
    "area on paper": QuantityKind("mm²"),
    "torque on paper": QuantityKind("N·m/mm"),
    "work on paper": QuantityKind("J/mm²", digits=6),
    "torque per speed": QuantityKind("N·m·s/rad"),
}

_G, _L, _E, _T = KeyChapter.geometry, KeyChapter.loads, KeyChapter.forces, KeyChapter.torque
_AT = KeyChapter.cycle

ROWS: tuple[VocabularyRow, ...] = (
    VocabularyRow(cosine, "p", "torque", below="{number}", name="turning cosine"),
    VocabularyRow(sine, "q", "torque", below="{number}", name="turning sine"),
    VocabularyRow(node_angle, "φ", "angle", below="t{number}", name="turning node angle"),
    VocabularyRow(node_torque, "M", "torque", below="t{number}", name="turning node torque"),
    VocabularyRow(Name(CYCLE), "Φ", "angle"),
    VocabularyRow(Name(MEAN), "M", "torque", _G, below="m"),
    VocabularyRow(Name(MEAN_OF_LOAD), "M", "torque", _G, below="rm"),
    VocabularyRow(Name(FACTOR), "κ", "ratio", _G),
    VocabularyRow(Name(PER_SPEED), "c", "torque per speed", _G),
    VocabularyRow(point, "φ", "angle", _G, below="{number}", name="turning point"),
    VocabularyRow(scale.only(of="M"), "μ", "torque on paper", below="M"),
    VocabularyRow(scale.only(of="phi"), "μ", "angle", below="φ"),
    VocabularyRow(scale.only(of="A"), "μ", "work on paper", _L, below="A"),
    VocabularyRow(on_paper, "F", "area on paper", below="{number}", name="turning area on paper"),
    VocabularyRow(area, "A", "work", _L, below="{number}", name="turning area"),
    VocabularyRow(extreme.only(bound="max"), "E", "work", _E, below="max"),
    VocabularyRow(extreme.only(bound="min"), "E", "work", _E, below="min"),
    VocabularyRow(energy, "E", "work", _E, below="{number}", name="turning energy"),
    VocabularyRow(Name(RANGE), "ΔE", "work", _E),
    VocabularyRow(Name(WORK), "W", "work", _E),
    VocabularyRow(Name(SHARE), "K", "ratio", _E, below="E"),
    VocabularyRow(Name(POWER), "P", "power", _E),
    VocabularyRow(Name(N), "n", "speed of rotation"),
    VocabularyRow(Name(OMEGA), "ω", "angular velocity", _T, below="m"),
    VocabularyRow(Name(DELTA), "δ", "ratio", _T),
    VocabularyRow(Name(J), "J", "moment of inertia", _T),
    VocabularyRow(Name(MASS), "m", "mass", _T),
    VocabularyRow(Name(RADIUS), "k", "length"),
    VocabularyRow(speed.only(bound="max"), "ω", "angular velocity", _T, below="max"),
    VocabularyRow(speed.only(bound="min"), "ω", "angular velocity", _T, below="min"),
    VocabularyRow(Name(AT), "φ", "angle"),
    VocabularyRow(Name(TORQUE_AT), "ΔM", "torque", _AT),
    VocabularyRow(Name(ACCELERATION), "ε", "angular acceleration", _AT),
)
