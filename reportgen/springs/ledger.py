"""Common mistakes in the forces of springs, as alternative definitions of quantities."""

from __future__ import annotations

from reportgen.derivation.topic_ledger import Changed, LedgerHooks
from reportgen.formula import Number, ids, refs, substitute
from reportgen.formula.ledger import Ledger
from reportgen.machine.analysis import Machine


def mistakes(ledger: Ledger, machine: Machine) -> Changed:
    """Return, by id, c·l as a mistaken definition of each spring's force c(l − l₀)."""
    return {
        id: [("no-free-length", substitute(definition, lambda ref: Number(0.0) if ref.id in ids.spring_free else ref))]
        for id, family in ledger.families.items()
        if (definition := family.definition) is not None and family.kind == "force"
        if any(ref in ids.spring_free for ref in refs(definition))
    }


HOOKS = LedgerHooks(mistakes=mistakes)
