"""Common mistakes in balancing, as alternative definitions of quantities."""

from __future__ import annotations

from reportgen.balancing import balance_ids
from reportgen.derivation.topic_ledger import Changed
from reportgen.formula import Expression, Ref, heading, substitute, turned
from reportgen.formula.ledger import Ledger
from reportgen.machine.analysis import Machine

AXES = ("x", "y")


def mistakes(ledger: Ledger, machine: Machine) -> Changed:
    """Return mistaken definitions by id: the counterweight on the pin's side, ω not squared, a share of all masses."""
    changed: dict[str, list[tuple[str, Expression]]] = {}
    for id, family in ledger.families.items():
        definition = family.definition
        if definition is None:
            continue
        angle = balance_ids.rule_angle.read(id)
        if angle is not None:
            # An applied counterweight has the angle of its rule, or the angle of its components.
            own = definition.id.removeprefix("balance.psi.") if isinstance(definition, Ref) else angle["rule"]
            parts = [balance_ids.rule_component(own, axis) for axis in AXES]
            x, y = (Ref(part) if part in ledger else None for part in parts)
            vector = x if y is None else turned(y) if x is None else x + turned(y)
            if vector is not None:
                changed[id] = [("counterweight-on-pin-side", heading(-vector))]
        elif id in balance_ids.centrifugal or id in balance_ids.seen:
            ω = Ref("omega.1")
            changed[id] = [("omega-not-squared", definition / ω if id in balance_ids.centrifugal else definition * ω)]
        elif (names := balance_ids.star.read(id)) is not None and names["number"] != "1":
            first = ledger[balance_ids.star(1, names["sense"], names["axis"])].definition
            changed[id] = [] if first is None else [("order-with-single-angle", first)]
        elif id in balance_ids.rule_component and balance_ids.SHARE in ledger.inputs[id]:
            changed[id] = [("share-of-turning-part", _of_all(ledger, definition))]
    return changed


def _of_all(ledger: Ledger, definition: Expression) -> Expression:
    """Return the definition with the share applied to the rotating masses too: κ(m_A + m_B + m) instead of m_A + κ(m_B
    + m).
    """
    κ = Ref(balance_ids.SHARE)
    # The mass at the crank's pin depends on the mass at the other end.
    turning = [
        id
        for id in ledger.families
        if id in balance_ids.point_mass and any(before in balance_ids.point_mass for before in ledger.inputs[id])
    ]
    return substitute(definition, lambda ref: κ * ref if ref.id in turning else ref)
