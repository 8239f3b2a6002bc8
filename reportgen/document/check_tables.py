"""Checks in numbers: the degree of freedom, residuals of what must agree."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from reportgen.document.tabled import Tabled
from reportgen.document.tree import InlineMath, Table, Text, Value
from reportgen.mechanism.mobility import mobility
from reportgen.notation.expressions import Chain, Number, Power, Symbol


class CheckTables(Tabled):
    """What agrees, and how well."""

    @property
    def functions(self) -> dict[str, Callable[..., Any]]:
        """What templates may call, by name."""
        return {
            "mobility_line": self.mobility_line,
            "checks_table": self.checks_table,
        }

    def mobility_line(self) -> Any:
        """W = 3n − (2t + c) + r − s with the numbers put in."""
        counted = mobility(self.facts.analysis.machine.linkage)
        n, t, c, r, s = (Symbol(letter) for letter in "ntcrs")
        sizes = counted.n, counted.lower_pairs, counted.higher_pairs, counted.passive, counted.redundant
        formula = 3 * n - (2 * t + c) + r - s
        n_, t_, c_, r_, s_ = map(Number, sizes)
        numbers = 3 * n_ - (2 * t_ + c_) + r_ - s_
        return self.voice.equal(Chain((Symbol("W"), formula, numbers, Number(counted.W))))

    def checks_table(self, key: str, caption: str, head: Sequence[str], names: Mapping[str, str]) -> Table:
        """Residuals of the independent checks, as powers of ten."""
        residuals = self.residuals()
        rows = [
            (name, _scientific(residuals[id][0]), residuals[id][1])
            for id, name in names.items()
            if id in residuals
        ]
        return self.voice.list_table(key, caption, head, rows, (95.0, 35.0, 20.0))

    def residuals(self) -> dict[str, tuple[float, str]]:
        """The largest residual of each check and its unit: closure, formulas, reactions, torques, energy."""
        analysis, values = self.facts.analysis, self.facts.ledger.families
        found = {"closure": (self._closure(), "m")}
        for name, prefix, unit in (("formulas", ("v.", "omega."), ""), ("formulas_a", ("a.", "eps."), "")):
            differences = [
                float(np.max(np.abs(np.abs(values[one].values) - np.abs(values[other].values))))
                / float(np.max(np.abs(values[one].values)))
                for one, other in analysis.machine.compared
                if one.startswith(prefix)
            ]
            if differences:
                found[name] = (max(differences), unit)
        if analysis.loads:
            found["ledger"] = (
                max(
                    float(np.nanmax(np.abs(reaction.force - values[f"F.{name}"].values)))
                    for name, reaction in analysis.forces.reactions.items()
                    if f"F.{name}" in values
                ),
                "N",
            )
            difference = float(np.nanmax(np.abs(analysis.torque - analysis.torque_by_work)))
            found["torque"] = (difference, "N" if analysis.machine.span else "N·m")
            found["energy"] = (analysis.summary.energy_error, "")
        return found

    def _closure(self) -> float:
        """How far a distance of two points of one link is from its length at any position (m)."""
        motion, families = self.facts.analysis.motion, self.facts.ledger.families
        pairs = [(group.P, group.Q) for group in self.facts.groups]
        pairs += [(group.T, group.Q) for group in self.facts.groups if group.kind == "RRR"]
        lengths = [(p, q, families[f"l.{p}{q}"].values) for p, q in pairs if f"l.{p}{q}" in families]
        differences = [np.abs(motion.points[p].p - motion.points[q].p) - length for p, q, length in lengths]
        differences += [
            np.abs(motion.points[point.name].p - motion.origins[point.link].p) - abs(point.local)
            for point in self.facts.analysis.machine.linkage.points
        ]
        return max(float(np.nanmax(np.abs(difference))) for difference in differences)


def _scientific(value: float) -> tuple[Any, ...]:
    """A residual as a power of ten: < 10⁻¹² m."""
    if value == 0:
        return (Value(Number(0.0)),)
    exponent = math.ceil(math.log10(value))
    return (Text("< "), InlineMath(Power(Number(10), Number(exponent))))
