"""Ids of the quantities that balancing enters in the ledger, which all begin with `balance`, and their vocabulary.

An id with parameters is a `Name`: `component("x")` is the id `balance.F.x`. `ROWS` maps each id to its symbol, the kind
of its quantity and its chapter. This module only declares them; `ledger.py` and
`orders_ledger.py` enter the quantities.
"""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.formula.ids import Name
from reportgen.formula.vocabulary import KeyChapter, QuantityKind, VocabularyRow

# --- shaking force and moment

FORCE, DIRECTION, MOMENT = "balance.F", "balance.F.dir", "balance.M"
component = Name("balance.F.{axis}")
force_of_link = Name("balance.P.{link}.{axis}")
moment_of_link = Name("balance.M.{link}")
place = Name("balance.r.{point}.{axis}")  # from the crank's centre, or from the centre that a counterweight turns about
seen = Name("balance.u.{axis}")  # F e^{−iφ}/ω², seen from the crank
mean = Name("balance.mean.{axis}")  # mean of F as seen from the crank

# --- counterweights, by their links or by the rules that they are compared by

touching = Name("balance.touch.{number}.{axis}")
beside = Name("balance.beside.{number}")  # which position is next to a point of touch
point_mass = Name("balance.rod.{link}.{point}")  # point mass of a rod, at one of its pins
pin_turn = Name("balance.delta.{link}")  # turn of a pin from the crank
on_link = Name("balance.on.{link}.{axis}")  # place of the mass centre of a link in the link's frame
product = Name("balance.U.{link}")
product_component = Name("balance.U.{link}.{axis}")
angle = Name("balance.psi.{link}")
rule_product = Name("balance.U.{rule}")
rule_component = Name("balance.U.{rule}.{axis}")
rule_angle = Name("balance.psi.{rule}")
RADIUS, SHARE = "balance.radius", "balance.share"
mass = Name("balance.m.{link}")
weight = Name("balance.G.{link}")
centrifugal = Name("balance.C.{link}")
outward = Name("balance.way.{link}")  # direction of a counterweight from the centre of its link
hold = Name("balance.hold.{link}")  # moment that turns a counterweight with its link

# --- over the turn, without a counterweight (`before`), with that of a rule, or with the applied ones (`after`) --

greatest = Name("balance.top.{quantity}.{state}")
rms = Name("balance.rms.{state}")
whole_mass = Name("balance.mass.{state}")

# --- the orders of an engine

RATIO, TO_AND_FRO = "balance.lambda", "balance.reciprocating"
factor = Name("balance.A.{number}")
series = Name("balance.series.{number}")
series_error = Name("balance.off.{number}")
bank = Name("balance.bank.{slider}")
pin_from_bank = Name("balance.gamma.{slider}")
star = Name("balance.star.{number}.{sense}.{axis}")
star_size = Name("balance.star.{number}.{sense}")
order_force = Name("balance.order.{number}")
couple = Name("balance.couple.{number}")

# --- with the applied counterweights ------------

AFTER_FORCE, AFTER_MOMENT = "balance.after.F", "balance.after.M"
AFTER_REACTION, AFTER_TORQUE = "balance.after.R01", "balance.after.cb"
after_component = Name("balance.after.F.{axis}")

KINDS: Mapping[str, QuantityKind] = {"counterweight product": QuantityKind("kg·m")}

_B = KeyChapter("balancing")

ROWS: tuple[VocabularyRow, ...] = (
    VocabularyRow(Name(FORCE), "F", "force", _B, below="qt"),
    VocabularyRow(Name(DIRECTION), "α", "direction", _B, below="F", around=True),
    VocabularyRow(component, "F", "force", _B, below="qt,{axis}", name="balance component"),
    VocabularyRow(Name(MOMENT), "M", "torque", _B, below="qt"),
    VocabularyRow(force_of_link, "P", "force", _B, below="qt{link},{axis}", name="balance force of link"),
    VocabularyRow(moment_of_link, "M", "torque", _B, below="{link}", name="balance moment of link"),
    VocabularyRow(place, "{axis}", "length", _B, below="{point}", name="balance place"),
    VocabularyRow(seen, "u", "counterweight product", _B, below="{axis}", name="balance seen"),
    VocabularyRow(mean, "u", "counterweight product", _B, below="m,{axis}", name="balance mean"),
    VocabularyRow(touching, "u", "counterweight product", below="{axis},{number}", name="balance touching"),
    VocabularyRow(point_mass, "m", "mass", _B, below="{link}{point}", name="balance point mass"),
    VocabularyRow(pin_turn, "δ", "angle", _B, name="balance pin turn"),
    VocabularyRow(on_link.only(axis="x"), "ξ", "length", _B, below="{link}", name="balance along link"),
    VocabularyRow(on_link.only(axis="y"), "η", "length", _B, below="{link}", name="balance across link"),
    VocabularyRow(product, "U", "counterweight product", name="balance product"),
    VocabularyRow(
        product_component, "U", "counterweight product", below="{link},{axis}", name="balance product component"
    ),
    VocabularyRow(angle, "ψ", "angle", around=True, name="balance angle"),
    VocabularyRow(rule_product, "U", "counterweight product", name="balance product of {rule}"),
    VocabularyRow(
        rule_component, "U", "counterweight product", below="{rule},{axis}", name="balance product component of {rule}"
    ),
    VocabularyRow(rule_angle, "ψ", "angle", around=True, name="balance angle of {rule}"),
    VocabularyRow(Name(RADIUS), "r", "length", below="c"),
    VocabularyRow(Name(SHARE), "κ", "ratio"),
    VocabularyRow(mass, "m", "mass", below="c{link}", name="balance mass"),
    VocabularyRow(weight, "G", "weight", below="c{link}", name="balance weight"),
    VocabularyRow(centrifugal, "P", "force", below="c{link}", name="balance centrifugal"),
    VocabularyRow(hold, "M", "torque", _B, below="c{link}", name="balance hold"),
    VocabularyRow(greatest.only(quantity="F"), "F", "force", _B, below="max,{state}", name="balance top F {state}"),
    VocabularyRow(greatest.only(quantity="M"), "M", "torque", _B, below="qt,{state}", name="balance top M {state}"),
    VocabularyRow(greatest.only(quantity="cb"), "M", "torque", _B, below="cb,{state}", name="balance top cb {state}"),
    VocabularyRow(rms, "F", "force", _B, below="rms,{state}", name="balance rms {state}"),
    VocabularyRow(whole_mass, "m", "mass", _B, below="{state}", name="balance whole mass {state}"),
    VocabularyRow(Name(RATIO), "λ", "ratio", _B),
    VocabularyRow(Name(TO_AND_FRO), "m", "mass", _B, below="p"),
    VocabularyRow(factor, "A", "ratio", _B, name="balance factor"),
    VocabularyRow(series, "A", "ratio", _B, above="λ", name="balance series"),
    VocabularyRow(series_error, "δ", "share", _B, below="A{number}", name="balance series error"),
    VocabularyRow(bank, "β", "angle", _B, name="balance bank"),
    VocabularyRow(pin_from_bank, "γ", "angle", _B, name="balance pin from bank"),
    VocabularyRow(star.only(sense="forward"), "s", "ratio", _B, below="{number},{axis}", name="balance star"),
    VocabularyRow(
        star.only(sense="backward"), "s", "ratio", _B, below="{number},{axis}", above="′", name="balance star"
    ),
    VocabularyRow(star_size.only(sense="forward"), "s", "ratio", _B, below="{number}", name="balance star size"),
    VocabularyRow(
        star_size.only(sense="backward"), "s", "ratio", _B, below="{number}", above="′", name="balance star size"
    ),
    VocabularyRow(order_force, "F", "force", _B, below="({number})", name="balance order"),
    VocabularyRow(couple, "k", "ratio", _B, below="{number}", name="balance couple"),
    VocabularyRow(Name(AFTER_FORCE), "F", "force", _B, below="qt", above="′"),
    VocabularyRow(after_component, "F", "force", _B, below="qt,{axis}", above="′", name="balance after component"),
    VocabularyRow(Name(AFTER_MOMENT), "M", "torque", _B, below="qt", above="′"),
    VocabularyRow(Name(AFTER_REACTION), "R", "force", _B, below="01", above="′"),
    VocabularyRow(Name(AFTER_TORQUE), "M", "torque", _B, below="cb", above="′"),
)
