"""Ids of an engine that is balanced by orders, which begin with `orders`, with their vocabulary.

The stars are f and g for forces, p and q for couples: the first of a pair turns with the crank, the second against it.
"""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import KeyChapter, QuantityKind, VocabularyRow

crank = Name("orders.crank.{cylinder}")
bank = Name("orders.bank.{cylinder}")
station = Name("orders.z.{cylinder}")
arm = Name("orders.arm.{cylinder}")
exact = Name("orders.exact.{order}")
factor = Name("orders.A.{order}")
series = Name("orders.series.{order}")
off = Name("orders.off.{order}")
scale = Name("orders.mu.{star}")
angle = Name("orders.angle.{star}.{order}.{cylinder}")
drawn = Name("orders.plan.{star}.{order}")
measured = Name("orders.seg.{star}.{order}")
resultant = Name("orders.star.{star}.{order}")
force = Name("orders.F.{order}")
couple = Name("orders.M.{order}")
least_force = Name("orders.least.F.{order}")
least_couple = Name("orders.least.M.{order}")

own_mass = Name("orders.own.{link}.{cylinder}")  # m1, m2 or m3 of a cylinder
own_radius = Name("orders.r.{cylinder}")
own_ratio = Name("orders.lambda.{cylinder}")
own_exact = Name("orders.exact.{order}.{cylinder}")
own_factor = Name("orders.A.{order}.{cylinder}")
reciprocating = Name("orders.m.{cylinder}")
rotating = Name("orders.mA.{cylinder}")
weight = Name("orders.w.{order}.{cylinder}")  # a vector of the star, compared with that of the data of all
product = Name("orders.product.{of}.{cylinder}")  # m r of what turns: rot or U
turning = Name("orders.turning.{of}.{axis}")  # the sum of these products, and with arms rotM or UM

KINDS: Mapping[str, QuantityKind] = {
    "star on paper": QuantityKind("mm⁻¹", 1e3, digits=6),
    "star of couples on paper": QuantityKind("m/mm", 1e3, digits=6),
    "order factor": QuantityKind("", digits=6),
    "unrounded factor": QuantityKind(""),
    "product of mass, radius and distance": QuantityKind("kg·m²"),
}

_G, _F = KeyChapter.geometry, KeyChapter.forces
_STARS = "fgpq"

ROWS: tuple[VocabularyRow, ...] = (
    VocabularyRow(Name("orders.r"), "r", "length"),
    VocabularyRow(Name("orders.l"), "l", "length"),
    VocabularyRow(Name("orders.n"), "n", "speed of rotation"),
    VocabularyRow(Name("orders.m2"), "m", "mass", below="2"),
    VocabularyRow(Name("orders.m3"), "m", "mass", below="3"),
    VocabularyRow(Name("orders.s"), "s", "ratio"),
    VocabularyRow(Name("orders.m1"), "m", "mass", below="1"),
    *(
        VocabularyRow(own_mass.only(link=k), "m", "mass", below=f"{k},{{cylinder}}", name=f"orders own mass {k}")
        for k in "123"
    ),
    VocabularyRow(own_radius, "r", "length", below="{cylinder}", name="orders own radius"),
    VocabularyRow(crank, "θ", "angle", below="{cylinder}", name="orders crank"),
    VocabularyRow(bank, "ψ", "angle", below="{cylinder}", name="orders bank"),
    VocabularyRow(station, "z", "length", below="{cylinder}", name="orders station"),
    VocabularyRow(Name("orders.z0"), "z", "length", _G, below="0"),
    VocabularyRow(arm, "c", "length", _G, below="{cylinder}", name="orders arm"),
    VocabularyRow(Name("orders.lambda"), "λ", "ratio", _G),
    VocabularyRow(Name("orders.omega"), "ω", "angular velocity", _G),
    VocabularyRow(Name("orders.mA"), "m", "mass", _G, below="A"),
    VocabularyRow(Name("orders.mB"), "m", "mass", _G, below="B"),
    VocabularyRow(Name("orders.m"), "m", "mass", _G, below="rec"),
    VocabularyRow(Name("orders.K"), "K", "force", _G),
    VocabularyRow(exact, "A", "unrounded factor", _G, below="{order}"),
    VocabularyRow(factor, "A", "order factor", _G, below="{order}", name="orders factor"),
    VocabularyRow(series, "A", "order factor", _G, below="{order}", above="*", name="orders series"),
    VocabularyRow(off, "δ", "share", _G, below="{order}"),
    *(VocabularyRow(scale.only(star=star), "μ", "star on paper", _F, below=star) for star in "fg"),
    *(VocabularyRow(scale.only(star=star), "μ", "star of couples on paper", _F, below=star) for star in "pq"),
    VocabularyRow(own_ratio, "λ", "ratio", _G, below="{cylinder}"),
    VocabularyRow(own_exact, "A", "unrounded factor", _G, below="{order},{cylinder}"),
    VocabularyRow(own_factor, "A", "order factor", _G, below="{order},{cylinder}"),
    VocabularyRow(reciprocating, "m", "mass", _G, below="rec,{cylinder}", name="orders own reciprocating mass"),
    VocabularyRow(rotating, "m", "mass", _G, below="A,{cylinder}", name="orders own rotating mass"),
    VocabularyRow(weight.only(order="1"), "w", "ratio", _G, below="1,{cylinder}", name="orders weight"),
    VocabularyRow(weight, "w", "ratio", _G, below="{order},{cylinder}"),
    VocabularyRow(product.only(of="rot"), "h", "product of mass and radius", KeyChapter.torque, below="{cylinder}"),
    VocabularyRow(product.only(of="U"), "u", "product of mass and radius", KeyChapter.torque, below="{cylinder}"),
    *(
        VocabularyRow(turning.only(of=of), letter, f"product of {kind}", KeyChapter.torque, below="{axis}")
        for of, letter, kind in (
            ("rot", "h", "mass and radius"),
            ("U", "u", "mass and radius"),
            ("rotM", "H", "mass, radius and distance"),
            ("UM", "D", "mass, radius and distance"),
        )
    ),
    VocabularyRow(angle, "γ", "angle", _F, below="{cylinder}"),
    VocabularyRow(drawn),
    VocabularyRow(measured, "s", "segment", _F, "orders.mu.{star}", below="{star}{order}"),
    *(
        VocabularyRow(resultant.only(star=star), star, "ratio", _F, below="{order}", name=f"orders star {star}")
        for star in "fg"
    ),
    *(
        VocabularyRow(resultant.only(star=star), star, "length", _F, below="{order}", name=f"orders star {star}")
        for star in "pq"
    ),
    VocabularyRow(force, "F", "force", _F, below="{order}", name="orders force"),
    VocabularyRow(couple, "M", "torque", _F, below="{order}", name="orders couple"),
    VocabularyRow(least_force, "F", "force", _F, below="{order},min", name="orders least force"),
    VocabularyRow(least_couple, "M", "torque", _F, below="{order},min", name="orders least couple"),
    VocabularyRow(Name("orders.rotating"), "F", "force", KeyChapter.torque, below="rot"),
    VocabularyRow(Name("orders.U"), "U", "product of mass and radius", KeyChapter.torque, below="c"),
    VocabularyRow(Name("orders.U.dir"), "α", "direction", KeyChapter.torque, below="c", around=True),
    VocabularyRow(Name("orders.U.M.dir"), "α", "direction", KeyChapter.torque, below="D", around=True),
    VocabularyRow(Name("orders.left"), "F", "force", KeyChapter.torque, below="1", above="′"),
    VocabularyRow(Name("orders.rotating.M"), "M", "torque", KeyChapter.torque, below="rot"),
    VocabularyRow(Name("orders.U.M"), "D", "product of mass, radius and distance", KeyChapter.torque, below="c"),
    VocabularyRow(Name("orders.left.M"), "M", "torque", KeyChapter.torque, below="1", above="′"),
)
