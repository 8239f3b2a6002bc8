"""`TrainCase`: a planetary train with its report, task, key and results; `TrainPage` has the names of its templates."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from reportgen.base.records import replace
from reportgen.base.units import MM
from reportgen.case.design_case import DesignPage
from reportgen.case.result_entries import ResultEntries
from reportgen.case.shafts import Shaft
from reportgen.document import Column, Equation, InlineMath, Inlines, Table, Text, Value, listed
from reportgen.drawing import Scene
from reportgen.drawing.animation import Animation
from reportgen.drawing.plates import DrawingPlate
from reportgen.formula import Chain, Number, Symbol, signed
from reportgen.gears import train_drawings, train_ids
from reportgen.gears.tooth_numbers import DUST, LEAST_DIFFERENCE, LEAST_OUTER, Train
from reportgen.gears.train_drawings import scheme_views, velocity_triangles
from reportgen.gears.train_file import FIRST_ROW_WHEEL, undercut_wheels
from reportgen.gears.train_formulas import OTHER, term_of
from reportgen.gears.train_ledger import SolvedTrain
from reportgen.sheets.plates import drawn

ROWS, SHORT_ROWS = 15, 6
"""Numbers of rows in the table of tooth numbers."""
WORDS = 60
"""Columns wider than this (mm) contain words."""
SHOWN_SETS = 500
"""Largest number of sets of tooth numbers in the results."""


@dataclass(frozen=True)
class TrainPage(DesignPage[SolvedTrain]):
    """A planetary train as templates read it."""

    NAME, TASK, SUMMARY = "train", "train-task", "train-summary"
    SECTIONS = (
        *("train-given", "train-ratio", "train-conditions", "train-candidates", "train-choice", "train-checks"),
        *("train-total", "train-scheme", "train-rates", "train-triangles", "train-efficiency"),
        *("train-torques", "train-conclusion"),
    )
    SHORT = frozenset({"train-triangles"})

    SWITCHES: ClassVar = {
        "train-total": ("before", "behind"),
        "train-efficiency": ("efficiency",),
        "train-torques": ("torque",),
    }

    def names(self) -> dict[str, Any]:
        case, given, choice = self.case, self.case.given, self.case.choice
        written, rows = case.printed, min(self.rows, len(choice.sets))
        return {
            **self.shared_names,
            "given": given,
            "choice": choice,
            "single": case.scheme.single,
            "inner": any(case.scheme.inner),
            "met": written["train.off"].at(1) == 0,
            "free": bool(choice.free[choice.first]),
            "one_smaller": choice.first == 1,
            "rows": bool(given.before or given.behind),
            "self_locking": given.efficiency is not None and written[train_ids.efficiency("train")].at(1) <= 0,
            "circulates": train_ids.power("circulating") in written,
            "tolerance": Value(self.tolerance),
            "possible": listed(Text(str(k)) for k in case.train.satellites),
            "shown": rows,
            "all_shown": rows == len(choice.sets),
            "data": self.data,
            "relation": self.relation,
            "assembly": self.assembly,
            "candidates": self.candidates,
            "checks": self.checks,
            "rates_table": self.rates_table,
            "sheet": {name: written.known(quantities) for name, quantities in written.lines.items()},
            "value": self.value,
            "formulas": lambda quantities: Equation(tuple(Chain(written.chain(id).parts[:2]) for id in quantities)),
        }

    @property
    def wheels(self) -> tuple[str, ...]:
        return ("1", "2", "3") if self.case.scheme.single else ("1", "2", OTHER, "3")

    @property
    def rows(self) -> int:
        return ROWS if self.full else SHORT_ROWS

    # --- symbols and lines

    def math(self, text: str) -> Symbol:
        return super().math(text.replace("2p", OTHER))

    @property
    def relation(self) -> Equation:
        """Return Willis's formula, and the ratio with wheel 3 at rest."""
        ω, z = ({wheel: Symbol(letter, wheel) for wheel in ("1", "2", OTHER, "3", "H")} for letter in "ωz")
        u0, u, scheme = Symbol("u", "13", "(H)"), Symbol("u", "1H"), self.case.scheme
        term = term_of(scheme, z)
        willis = Chain((u0, (ω["1"] - ω["H"]) / (ω["3"] - ω["H"]), signed(-scheme.sign, term)))
        return Equation((willis, Chain((u, ω["1"] / ω["H"], 1 - u0, 1 + signed(scheme.sign, term)))))

    @property
    def assembly(self) -> Equation:
        """Return the assembly condition; for a single satellite u₁H z₁ is z₁ + z₃, and P = 0 suffices."""
        k, z1, z3 = Symbol("k"), Symbol("z", "1"), Symbol("z", "3")
        top = Symbol("u", "1H") * z1
        if self.case.scheme.single:
            return Equation((Chain((Symbol("N"), top / k, (z1 + z3) / k)),))
        return Equation((Chain((Symbol("N"), top * (1 + k * Symbol("P")) / k)),))

    # --- tables

    def _table(self, name: str, head: Iterable[Any], rows: Iterable[Iterable[Any]], widths: Iterable[float]) -> Table:
        """Return a table with contents printed by `said`; its first column is left-aligned if it is wide."""
        columns = (Column(width, "left" if width > WORDS else "center") for width in widths)
        return self.table(name, columns, (map(said, head),), (map(said, row) for row in rows))

    @property
    def data(self) -> Table:
        """Return the table of data with names, symbols and values."""
        given, printed, words = self.case.given, self.case.printed, self.words
        rows: list[tuple[Any, ...]] = []
        choices: list[tuple[str, str]] = [("scheme", given.scheme), ("drives", given.drives)]
        if given.torque is not None:
            choices.append(("torque", given.torque.of))
        for key, value in choices:
            rows.append((words["choices"][key]["name"], "–", words["choices"][key][value]))
        for id, name in self.case.words["given"].items():
            if id in printed and (given.u or id != "train.u"):
                rows.append((name, printed.symbol(id), printed.number(id)))
        for i, row in enumerate((*given.before, *given.behind)):
            symbols = Symbol("z", str(FIRST_ROW_WHEEL + 2 * i)), ", ", Symbol("z", str(FIRST_ROW_WHEEL + 2 * i + 1))
            rows.append(
                (
                    words["row_before" if i < len(given.before) else "row_behind"],
                    symbols,
                    ", ".join(map(str, row)).replace("-", "−"),
                )
            )
        rows.append((words["limits"], Symbol("z"), f"{given.least} … {given.z.to}"))
        rows.append((words["tolerance"], Symbol("Δu"), self.tolerance))
        heads = (self.case.words["table"][key] for key in ("quantity", "symbol", "value"))
        return self._table("data", heads, rows, (82, 20, 58))

    @property
    def tolerance(self) -> Number:
        return Number(float(f"{self.case.given.tolerance.si * 100:.6g}"), None, "%")

    @property
    def candidates(self) -> Table:
        """Return the table of the smallest sets of tooth numbers and the chosen one, with the values that decide."""
        given, choice, words = self.case.given, self.case.choice, self.words["candidates"]
        rows: list[tuple[Any, ...]] = []
        for n in sorted({*range(min(self.rows, len(choice.sets))), choice.first}):
            train = choice.train(n)
            u = given.of_input(float(train.ratio))
            across = train.size * given.second_module.si * MM
            numbers = _short(u, 4), _short((u / given.wanted - 1) * 100, 2), _short(across, 2)
            z = [str(one) for one in train.teeth]
            mark = words["yes" if choice.free[n] and not train.undercut else "no"] + (
                f" {words['chosen']}" if n == choice.first else ""
            )
            rows.append((str(n + 1), *(z[:2] + z[3:] if self.case.scheme.single else z), *numbers, mark))
        wheels = (Symbol("z", wheel) for wheel in self.wheels)
        u1H = Symbol("u", "H1" if given.by_carrier else "1H")
        diameter = Symbol("D"), f", {self.case.ledger.printed_unit('mm')}"
        head = (words["number"], *wheels, u1H, (Symbol("Δu"), ", %"), diameter, words["unshifted"])
        return self._table("candidates", head, rows, (10, *(14,) * len(self.wheels), 22, 18, 22, 32))

    @property
    def checks(self) -> Table:
        """Return the requirements, the actual values, and whether they are met."""
        case, words, z = self.case, self.words["checks"], self.case.train.teeth
        symbol, value = case.printed.symbol, case.printed.number
        free = bool(case.choice.free[case.choice.first])
        meshes = tuple(zip(case.scheme.inner, (z.z1, z.z3), (z.z2, z.z2_prime), strict=True))
        outer = min(z.z2, z.z2_prime, *(wheel for inner, wheel, _ in meshes if not inner))
        rows: list[tuple[Any, Any, Any, bool]] = [
            self._check_of_ratio,
            ("coaxial", (symbol("train.a.1"), " = ", symbol("train.a.2")), value("train.a.1"), True),
            ("neighbours", ("< ", value("train.room")), value("train.gap"), True),
            ("assembly", words["whole"], (symbol("train.N"), " = ", value("train.N")), True),
            ("outer", f"≥ {case.given.least_teeth}", str(outer), True),
        ]
        if undercut_wheels(case.given, case.train):
            rows.append(("undercut", f"≥ {LEAST_OUTER}", str(outer), False))
        for name, (inner, wheel, satellite) in zip(("first", "second"), meshes, strict=True):
            if inner:
                rows.append((name, f"≥ {LEAST_DIFFERENCE}", f"{wheel} − {satellite} = {wheel - satellite}", True))
        if any(case.scheme.inner):
            rows.append(("unshifted", "–", words["free" if free else "shift"], free))
        printed = ((words[name], *parts, words["yes" if holds else "no"]) for name, *parts, holds in rows)
        return self._table("checks", words["head"], printed, (62, 34, 40, 24))

    @property
    def _check_of_ratio(self) -> tuple[str, Any, Any, bool]:
        """Return the row of the requested ratio, from the driving to the driven shaft, and True if it is within the
        tolerance.
        """
        ledger, given, Δu = self.case.printed, self.case.given, Symbol("Δu")
        off, u = abs(float(self.case.ledger["train.off"].at(1))), "train.uH1" if given.by_carrier else "train.u1H"
        holds = off <= given.tolerance.si + DUST
        if not given.tolerance.si:
            symbol = ledger.symbol(u)
            return "ratio", (symbol, " = ", ledger.number("train.u")), (symbol, " = ", ledger.number(u)), holds
        return "ratio", ("|", Δu, "| ≤ ", self.tolerance), (Δu, " = ", ledger.number("train.off")), holds

    @property
    def rates_table(self) -> Table:
        """Return the table of angular velocities by Willis and as read off the plan, with the difference."""
        rows = []
        for wheel in ("1", "2", "H"):
            by, read = (self.case.printed.number(id(wheel)) for id in (train_ids.omega, train_ids.read))
            off = Number((read.printed / by.printed - 1) * 100, 2)
            rows.append((Symbol("ω", wheel), Number(by.value, by.decimals), Number(read.value, read.decimals), off))
        return self._table("rates", self.words["rates"], rows, (40, 40, 40, 40))

    # --- figures

    def scenes(self, name: str) -> Iterable[Scene]:
        drawings = {"scheme": scheme_views, "triangles": velocity_triangles}
        return (drawings[name](self.case),)


def said(what: Any) -> Inlines:
    """Return words, symbols and numbers, one or several in a row, as inlines of a cell."""
    match what:
        case tuple():
            return tuple(part for one in what for part in said(one))
        case Symbol():
            return (InlineMath(what),)
        case Number():
            return (Value(what),)
        case _:
            return (Text(str(what)),)


def _short(value: float, decimals: int) -> Number:
    """Return a number unrounded if it has few decimals, otherwise rounded."""
    short = round(value, decimals)
    return Number(short + 0.0, None) if np.isclose(value, short, rtol=1e-12, atol=1e-12) else Number(value, decimals)


# --- the case --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class TrainCase(SolvedTrain):
    """A solved planetary train, as a `Case`."""

    PAGE = TrainPage

    # The checks of the file already prove that a train exists, so no fault shows in the results.

    @property
    def shafts(self) -> Sequence[Shaft]:
        driving, driven = self.words["train"]["shafts"]
        reached = float(self.ledger["train.n.reached"].values[0])
        speed = abs(reached / float(self.ledger["train.n.in"].values[0])) * self.speed
        turn, share = round(math.copysign(1, reached)), self.given.tolerance.si
        return Shaft(driving, self.speed, 1, datum="n_in"), Shaft(driven, speed, turn, share=share)

    @cached_property
    def entries(self) -> ResultEntries:
        """Return all tooth numbers that fulfil the conditions, by size; the chosen ones, their ratio and their
        rates.
        """
        choice, rates = self.choice, [id for id in self.ledger.families if id in train_ids.omega]
        wheels = {id.rpartition(".")[2]: {"omega": self.ledger[id].at(1)} for id in rates}
        listed = range(min(len(choice.sets), SHOWN_SETS))
        return ResultEntries(
            [{"number": 1, "wheels": wheels}],
            {
                "train": {
                    **_train_entry(self.train),
                    "satellites": self.given.k,
                    "possible": list(self.train.satellites),
                },
                **self._torque_entries,
                "found": len(choice.sets),
                "sets": [self._set_entry(n) for n in listed],
            },
        )

    def _set_entry(self, number: int) -> dict[str, Any]:
        train = self.choice.train(number)
        return {**_train_entry(train), "unshifted": self.choice.free[number] and not train.undercut}

    @property
    def _torque_entries(self) -> dict[str, Any]:
        """Return the torques (N·m) by shafts and the powers (W), if a torque is known."""
        if self.given.torque is None:
            return {}
        families, given = {"torques": train_ids.torque, "power": train_ids.power}, train_ids.torque("given")
        return {
            name: {
                id.rpartition(".")[2]: float(self.ledger[id].at(1))
                for id in self.ledger.families
                if id in of and id != given
            }
            for name, of in families.items()
        }

    def animations(self) -> tuple[Animation, ...]:
        return (train_drawings.animation(self),)

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return the scheme, the triangles and the tables; there are no sets to choose from."""
        page, captions = TrainPage(self), self.words["train"]["captions"]
        tables = [(name, getattr(page, f"{name}_table" if name == "rates" else name)) for name in ("checks", "rates")]
        in_tables = [
            DrawingPlate(captions[name], (), "tables", (drawn(table, self.assignment.language),))
            for name, table in tables
        ]
        return {"train": [*train_drawings.plates(self), *(replace(table, spare=True) for table in in_tables)]}


def _train_entry(train: Train) -> dict[str, Any]:
    z = train.teeth
    return {"z": [z.z1, z.z2, z.z2_prime, z.z3], "ratio": float(train.ratio)}
