"""Common mistakes in the true motion of a machine, as alternative definitions of quantities."""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.derivation.topic_ledger import Changed
from reportgen.formula import PI, Expression, Fraction, Negative, Number, Ref, Root, Sum, call
from reportgen.formula.ledger import Ledger
from reportgen.machine.analysis import Machine
from reportgen.motion import run_ids


def mistakes(ledger: Ledger, machine: Machine) -> Changed:
    """Return mistaken definitions of quantities of `run`, by id, with the names of the mistakes."""
    turns = machine.turns
    changed: dict[str, list[tuple[str, Expression]]] = {}
    for state in ((), (run_ids.WHEEL,)):
        speed = run_ids.quantity("omega", *state)
        if speed not in ledger:
            continue
        ω, M_r = Ref(speed), Ref("M.r")
        match ledger[speed].definition:
            case Root(Fraction(_, J)):
                changed[speed] = [("half-forgotten", Root(Fraction(Ref(run_ids.quantity("T", *state)), J)))]
        ε = run_ids.quantity("eps", *state)
        match ledger[ε].definition:
            case Fraction(Sum(terms), J):
                changed[ε] = list(_accelerations(terms, J, ω, M_r).items())
        highest, lowest = call("highest", ω), call("lowest", ω)
        bounds = 2 * (highest - lowest) / (highest + lowest)
        changed[run_ids.quantity("delta", *state)] = [("bounds-of-table", bounds)]
        work, period = Ref(run_ids.quantity("work", *state)), Ref(run_ids.quantity("period", *state))
        changed[run_ids.quantity("power", *state)] = [("two-pi-forgotten", work / (2.0 * turns * PI) / period)]
        drive = run_ids.quantity("Md", *state)
        if drive in ledger and len(ledger[drive].values) > 1:
            even = -call("level", M_r, Ref("steps"))
            changed[drive] = [("motor-constant", 0 * M_r + even)]
    return changed


def _accelerations(terms: tuple[Expression, ...], J: Expression, ω: Ref, M_r: Ref) -> Mapping[str, Expression]:
    """Return ε with common mistakes: ½ω²J′ left out, ω for ω², or the resistance with the wrong sign."""
    torques, change = terms[:2], terms[2:]
    reversed_load = Sum((Negative(M_r), *terms[1:])) / J
    wrong: dict[str, Expression] = {"load-sign": reversed_load}
    if change:
        slope = Ref(run_ids.slope())
        wrong["slope-left-out"] = Sum(torques) / J
        wrong["speed-not-squared"] = Sum((*torques, Negative(ω * slope / Number(2.0)))) / J
        wrong["half-of-slope"] = Sum((*torques, Negative(ω**2 * slope))) / J
    return wrong
