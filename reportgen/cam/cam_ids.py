"""Ids of a cam, which begin with `cam`, and their meaning."""

from __future__ import annotations

import math
from collections.abc import Mapping

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import KeyChapter, QuantityKind, VocabularyRow

phase = Name("cam.phase.{phase}")
arc = Name("cam.arc.{phase}")
limit = Name("cam.limit.{phase}")
touch = Name("cam.touch.{phase}.{quantity}")  # where a limit line touches
intercept = Name("cam.c.{phase}")
node = Name("cam.node.{phase}.{number}.{quantity}")  # of an acceleration given as a graph
diagram = Name("cam.diagram.{quantity}")  # the length of the turn, the distances of poles
scale = Name("cam.mu.{quantity}")
bend = Name("cam.m.{number}")
pitch = Name("cam.pitch.{axis}")
profile = Name("cam.profile.{axis}")

KINDS: Mapping[str, QuantityKind] = {
    "cam length": QuantityKind("mm", 1e-3, decimals=3),
    "radius of curvature": QuantityKind("mm", 1e-3),
    "reduced velocity": QuantityKind("mm/rad", 1e-3, decimals=3),
    "reduced acceleration": QuantityKind("mm/rad²", 1e-3, decimals=3),
    "angle on paper": QuantityKind("rad/mm", 1e3, digits=6),
    "reduced velocity on paper": QuantityKind("mm/(rad·mm)", digits=6),
    "reduced acceleration on paper": QuantityKind("mm/(rad²·mm)", digits=6),
    "rate on paper": QuantityKind("mm⁻¹", 1e3, digits=6),
    "phase share": QuantityKind("", decimals=5),
    "follower acceleration": QuantityKind("mm/s²", 1e-3),
    "graph value": QuantityKind("", decimals=5),
    "swing": QuantityKind("°", math.pi / 180, decimals=4),
    "arc": QuantityKind("rad", digits=6),
}

_G, _V, _A = KeyChapter.geometry, KeyChapter.velocity, KeyChapter.acceleration

ROWS: tuple[VocabularyRow, ...] = (
    VocabularyRow(Name("cam.h"), "h", "cam length"),
    VocabularyRow(Name("cam.swing"), "ψ", "swing", below="max"),
    VocabularyRow(phase, "Φ", "angle", below="{phase}", name="cam phase"),
    VocabularyRow(arc.only(phase="swing"), "ψ", "arc", _V, below="max"),
    VocabularyRow(arc, "Φ", "arc", _V, below="{phase}", name="cam arc"),
    VocabularyRow(Name("cam.start.return"), "φ", "angle", _V, below="0"),
    VocabularyRow(Name("cam.limit.rise"), "[α]", "angle"),
    VocabularyRow(Name("cam.limit.return"), "[α′]", "angle"),
    VocabularyRow(Name("cam.limit.rho"), "[ρ]", "cam length"),
    VocabularyRow(Name("cam.n"), "n", "speed of rotation"),
    VocabularyRow(Name("cam.omega"), "ω", "angular velocity", _V),
    VocabularyRow(Name("cam.r0"), "r", "cam length", below="0"),
    VocabularyRow(Name("cam.e"), "e", "cam length"),
    VocabularyRow(Name("cam.a"), "a", "cam length"),
    VocabularyRow(Name("cam.l"), "l", "cam length"),
    VocabularyRow(Name("cam.roller"), "r", "cam length", below="rol"),
    VocabularyRow(Name("cam.s0"), "s", "cam length", _G, below="0"),
    VocabularyRow(Name("cam.psi0"), "ψ", "swing", _G, below="0"),
    VocabularyRow(touch.only(quantity="s"), "s", "cam length", _G, below="{phase}", name="cam touch"),
    VocabularyRow(touch.only(quantity="ds"), "s′", "reduced velocity", _G, below="{phase}", name="cam touch"),
    VocabularyRow(touch.only(quantity="psi"), "ψ", "swing", _G, below="{phase}", name="cam touch"),
    VocabularyRow(touch.only(quantity="dpsi"), "ψ′", "ratio", _G, below="{phase}", name="cam touch"),
    VocabularyRow(touch.only(quantity="phi"), "φ", "angle", _G, below="{phase}", name="cam touch"),
    VocabularyRow(intercept, "c", "cam length", _G, below="{phase}", name="cam intercept"),
    VocabularyRow(Name("cam.apex.s0"), "s", "cam length", _G, below="A"),
    VocabularyRow(Name("cam.apex.e"), "e", "cam length", _G, below="A"),
    VocabularyRow(Name("cam.least.e"), "e", "cam length", _G, below="lim"),
    VocabularyRow(Name("cam.least.s0"), "s", "cam length", _G, below="0lim"),
    VocabularyRow(Name("cam.least.psi0"), "ψ", "swing", _G, below="0lim"),
    VocabularyRow(Name("cam.least.r0"), "r", "cam length", _G, below="0min"),
    VocabularyRow(Name("cam.valley"), "m", "cam length", _G),
    VocabularyRow(node, "{quantity}", "graph value", _V, below="{phase},{number}", name="cam node {quantity}"),
    VocabularyRow(Name("cam.phi"), "φ", "angle", _V),
    VocabularyRow(Name("cam.x"), "x", "phase share", _V),
    VocabularyRow(Name("cam.z"), "z", "phase share", _V),
    VocabularyRow(Name("cam.s"), "s", "cam length", _V),
    VocabularyRow(Name("cam.ds"), "s′", "reduced velocity", _V),
    VocabularyRow(Name("cam.dds"), "s″", "reduced acceleration", _V),
    VocabularyRow(Name("cam.psi"), "ψ", "swing", _V),
    VocabularyRow(Name("cam.dpsi"), "ψ′", "ratio", _V),
    VocabularyRow(Name("cam.ddpsi"), "ψ″", "ratio", _V),
    VocabularyRow(Name("cam.v"), "v", "follower velocity", _V),
    VocabularyRow(Name("cam.acceleration"), "a", "follower acceleration", _V, below="f"),
    VocabularyRow(Name("cam.omega.f"), "ω", "angular velocity", _V, below="f"),
    VocabularyRow(Name("cam.epsilon.f"), "ε", "angular acceleration", _V, below="f"),
    VocabularyRow(diagram.only(quantity="L"), "L", "cam length", _V),
    VocabularyRow(diagram, "K", "cam length", _V),
    VocabularyRow(scale, "μ", "ratio", _V),
    VocabularyRow(Name("cam.q"), "q", "swing", _A),
    VocabularyRow(Name("cam.k"), "k", "ratio", _A),
    VocabularyRow(Name("cam.alpha"), "α", "angle", _A),
    VocabularyRow(pitch, "{axis}", "cam length", _A, below="B", name="cam pitch"),
    VocabularyRow(profile, "{axis}", "cam length", _A, below="K", name="cam profile"),
    VocabularyRow(Name("cam.contact"), "L", "cam length", _A),
    VocabularyRow(Name("cam.u"), "u", "cam length", _A),
    VocabularyRow(Name("cam.w"), "w", "cam length", _A),
    VocabularyRow(bend, "m", "cam length", _A, name="cam bend"),
    VocabularyRow(Name("cam.rho"), "ρ", "radius of curvature", _A),
    VocabularyRow(Name("cam.rho.working"), "ρ", "radius of curvature", _A, below="K"),
)
