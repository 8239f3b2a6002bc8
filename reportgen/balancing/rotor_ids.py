"""Ids of a rotor, which begin with `rotor`, with their vocabulary.

A place is the number of a mass, a correction plane A or B, or a bearing C or D.
"""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import KeyChapter, QuantityKind, VocabularyRow

mass = Name("rotor.m.{place}")
radius = Name("rotor.r.{place}")
angle = Name("rotor.alpha.{place}")
station = Name("rotor.z.{place}")
unbalance = Name("rotor.U.{place}")  # m r
moment = Name("rotor.V.{place}")  # m r z, about plane A
scale = Name("rotor.mu.{of}")  # scale of the plan of U or V
laid_off = Name("rotor.seg.{of}.{place}")  # on paper
drawn = Name("rotor.plan.{of}.{place}")  # the vector on paper
direction = Name("rotor.dir.{place}")
component = Name("rotor.part.{of}.{axis}.{place}")
resultant = Name("rotor.sum.{of}.{axis}")
by_components = Name("rotor.f.{of}.{place}")  # U or alpha
share = Name("rotor.share.{when}.{axis}.{place}")  # share of a bearing, before and after
at_bearing = Name("rotor.bearing.{when}.{place}")
in_metres = Name("rotor.metres.{when}.{place}")  # the same in kg·m
bearing_force = Name("rotor.N.{when}.{place}")
permitted = Name("rotor.permitted.{of}")
tolerance = Name("rotor.tolerance.{place}")

KINDS: Mapping[str, QuantityKind] = {
    "rotor length": QuantityKind("mm", 1e-3),
    "rotor unbalance": QuantityKind("kg·mm", 1e-3),
    "rotor moment": QuantityKind("kg·mm²", 1e-6),
    "rotor unbalance on paper": QuantityKind("kg·mm/mm", digits=6),
    "rotor moment on paper": QuantityKind("kg·mm²/mm", 1e-3, digits=6),
    "balance quality": QuantityKind("mm/s", 1e-3),
    "product of mass and radius": QuantityKind("kg·m"),
    "eccentricity": QuantityKind("mm", 1e-3),
}

_G, _L, _F = KeyChapter.geometry, KeyChapter.loads, KeyChapter.forces
_AXIS = "{place}{axis}"

ROWS: tuple[VocabularyRow, ...] = (
    *(VocabularyRow(mass.only(place=plane), "m", "mass", below=plane, name="rotor correction mass") for plane in "AB"),
    *(
        VocabularyRow(radius.only(place=plane), "r", "rotor length", below=plane, name="rotor correction radius")
        for plane in "AB"
    ),
    VocabularyRow(mass, "m", "mass", below="{place}", name="rotor mass"),
    VocabularyRow(radius, "r", "rotor length", below="{place}", name="rotor radius"),
    VocabularyRow(angle, "α", "angle", below="{place}", name="rotor angle"),
    VocabularyRow(station, "z", "rotor length", below="{place}", name="rotor station"),
    VocabularyRow(Name("rotor.n"), "n", "speed of rotation"),
    VocabularyRow(Name("rotor.grade"), "G", "balance quality"),
    VocabularyRow(Name("rotor.M"), "M", "mass"),
    VocabularyRow(Name("rotor.L"), "L", "rotor length", _G),
    VocabularyRow(Name("rotor.b"), "b", "rotor length", _F),
    VocabularyRow(Name("rotor.omega"), "ω", "angular velocity", _F),
    *(
        VocabularyRow(unbalance.only(place=plane), "U", "rotor unbalance", _L, below=plane, name="rotor correction")
        for plane in "AB"
    ),
    VocabularyRow(unbalance, "U", "rotor unbalance", _G, below="{place}", name="rotor unbalance"),
    VocabularyRow(moment.only(place="B"), "V", "rotor moment", _L, below="B", name="rotor correction moment"),
    VocabularyRow(moment, "V", "rotor moment", _G, below="{place}", name="rotor moment"),
    VocabularyRow(scale.only(of="U"), "μ", "rotor unbalance on paper", _L, below="U"),
    VocabularyRow(scale.only(of="V"), "μ", "rotor moment on paper", _L, below="V"),
    VocabularyRow(laid_off, "", "segment", _L, "rotor.mu.{of}", below="{place}"),
    VocabularyRow(drawn),
    VocabularyRow(direction, "α", "direction", _L, below="{place}", around=True, name="rotor direction"),
    VocabularyRow(component.only(of="U"), "U", "rotor unbalance", _G, below=_AXIS),
    VocabularyRow(component.only(of="V"), "V", "rotor moment", _G, below=_AXIS),
    VocabularyRow(resultant.only(of="U"), "U", "rotor unbalance", _G, below="{axis}", name="rotor resultant"),
    VocabularyRow(resultant.only(of="V"), "V", "rotor moment", _G, below="{axis}", name="rotor resultant"),
    VocabularyRow(by_components.only(of="U"), "U", "rotor unbalance", below="{place}", name="rotor computed"),
    VocabularyRow(by_components.only(of="alpha"), "α", "angle", below="{place}", name="rotor computed direction"),
    VocabularyRow(by_components.only(of="z"), "z", "rotor length", below="{place}", name="rotor computed place"),
    VocabularyRow(by_components.only(of="V"), "V", "rotor moment", below="{place}"),
    VocabularyRow(by_components.only(of="m"), "m", "mass", below="{place}", name="rotor computed mass"),
    VocabularyRow(share.only(when="after"), "U", "rotor unbalance", _F, below=_AXIS, above="′"),
    VocabularyRow(share, "U", "rotor unbalance", _F, below=_AXIS),
    VocabularyRow(
        at_bearing.only(when="after"), "U", "rotor unbalance", _F, below="{place}", above="′", name="rotor share after"
    ),
    VocabularyRow(at_bearing, "U", "rotor unbalance", _F, below="{place}", name="rotor share"),
    VocabularyRow(in_metres, "U", "product of mass and radius", _F, below="{place}"),
    VocabularyRow(
        bearing_force.only(when="after"), "N", "force", _F, below="{place}", above="′", name="rotor force after"
    ),
    VocabularyRow(bearing_force, "N", "force", _F, below="{place}", name="rotor force"),
    VocabularyRow(permitted.only(of="e"), "e", "eccentricity", KeyChapter.cycle, below="per"),
    VocabularyRow(permitted.only(of="U"), "U", "rotor unbalance", KeyChapter.cycle, below="per"),
    VocabularyRow(permitted.only(of="plane"), "U", "rotor unbalance", KeyChapter.cycle, below="per,1"),
    VocabularyRow(tolerance, "Δm", "mass", KeyChapter.cycle, below="{place}", name="rotor tolerance"),
)
