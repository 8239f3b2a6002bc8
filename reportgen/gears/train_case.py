"""A planetary train as a case: its report and its task with their tables and lines, its key, its results."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from reportgen.base.units import MM
from reportgen.drawing.film import Film
from reportgen.drawing.sheet import DrawingSheet
from reportgen.formula import Chain, Number, Product, Symbol, ids, signed, vocabulary
from reportgen.formula.sheet import Family
from reportgen.gears import train_drawings
from reportgen.gears.train import LEAST_DIFFERENCE, LEAST_OUTER, Train, sizes
from reportgen.gears.train_drawings import scheme_views, velocity_triangles
from reportgen.gears.train_solution import OTHER, SolvedTrain, term_of
from reportgen.report import (
    Block,
    Cell,
    Column,
    Contents,
    Document,
    Equation,
    Figure,
    InlineMath,
    Inlines,
    PageBreak,
    Section,
    Table,
    Text,
    Value,
    Words,
    listed,
)
from reportgen.report.case import Key
from reportgen.report.numbering import number
from reportgen.report.prose import Prose

SECTIONS = ("given", "ratio", "conditions", "candidates", "choice", "checks", "total", "scheme", "rates")
LATER = ("triangles", "efficiency", "conclusion")
SHORT = frozenset({"triangles"})
"""The sections that a short report goes without."""
ROWS, SHORT_ROWS = 15, 6
"""So many of the tooth numbers found stand in the table."""
DATA = (82.0, 20.0, 58.0)
CHECKS = (62.0, 34.0, 40.0, 24.0)
SHOWN_SETS = 500
"""So many of the tooth numbers that are found stand in the results."""
RATES = (40.0, 40.0, 40.0, 40.0)


def report(case: SolvedTrain) -> Document:
    """The finished, numbered report."""
    page, words, assignment = TrainPage(case), case.words, case.assignment
    prose, full = Prose(case.places), assignment.report.extent == "full"
    names = page.names()
    found: list[Block] = [case.cover, PageBreak(), Contents(words["document"]["contents"], not full)]
    for section in (*SECTIONS, *LATER):
        if page.has(section) and (full or section not in SHORT):
            found += prose.render(f"train-{section}", names)
    return number(
        Document(
            language=assignment.language,
            title=f"{words['cover']['title']} – {case.title}",
            author=assignment.report.student.name or "",
            header=(words["header"].format(course=case.course), case.variant_line),
            footer=("", words["document"]["page"]),
            words=Words.among(words["document"]),
            blocks=tuple(found),
            close=not full,
        )
    )


def task(case: SolvedTrain, key: Key, by_section: bool = False) -> Document:
    """The student's handout: the given data and the empty answer sheet."""
    from reportgen.marking.paper import empty_sheet, task_paper

    names = {**TrainPage(case).names(), "answer_tables": empty_sheet(key, by_section)}
    title = (Section(1, (Text(case.words["train"]["task"].format(title=case.title)),), numbered=False),)
    return task_paper(case, key, title, Prose(case.places).render("train-task", names))


@dataclass(frozen=True)
class TrainPage:
    """A planetary train as templates name it."""

    case: SolvedTrain

    @property
    def words(self) -> Mapping[str, Any]:
        found: Mapping[str, Any] = self.case.words["train"]
        return found

    def has(self, section: str) -> bool:
        given = self.case.given
        return {"total": bool(given.before or given.behind), "efficiency": given.efficiency is not None}.get(
            section, True
        )

    def names(self) -> dict[str, Any]:
        case, given, choice = self.case, self.case.given, self.case.choice
        families, written = case.ledger.families, case.printed
        return {
            "words": case.words,
            "given": given,
            "choice": choice,
            "single": case.scheme.single,
            "inner": case.scheme.inner,
            "met": written["train.off"].at(1) == 0,
            "free": bool(choice.free[choice.first]),
            "rows": len(given.before) + len(given.behind),
            "row_ratios": [id for id in families if id in ids.train_row_ratio],
            "teeth": [ids.train_teeth(wheel) for wheel in self.wheels],
            "rates": [id for id in families if id in ids.train_omega],
            "readings": [id for id in families if id in ids.train_read],
            "segments": [id for id in families if id in ids.train_segment],
            "self_locking": given.efficiency is not None and written[ids.train_efficiency("train")].at(1) <= 0,
            "tolerance": Value(self._share(given.tolerance.si)),
            "possible": listed(Text(str(k)) for k in case.train.satellites),
            "shown": min(self.rows, len(choice.sets)),
            "data": self.data,
            "relation": self.relation,
            "assembly": self.assembly,
            "candidates": self.candidates,
            "checks": self.checks,
            "rates_table": self.rates_table,
            "known": lambda id: id in written,
            "value": lambda id: Value(written.number(id)),
            "quantity": lambda id: (InlineMath(written.symbol(id)), Text(" = "), Value(written.number(id))),
            "lines": lambda quantities: Equation(tuple(written.chain(id) for id in quantities if id in written)),
            "formulas": lambda quantities: Equation(tuple(Chain(written.chain(id).parts[:2]) for id in quantities)),
            "math": self.math,
            "figure": self.figure,
        }

    @property
    def wheels(self) -> tuple[str, ...]:
        return ("1", "2", "3") if self.case.scheme.single else ("1", "2", OTHER, "3")

    @property
    def rows(self) -> int:
        return ROWS if self.case.assignment.report.extent == "full" else SHORT_ROWS

    # --- symbols and lines

    def math(self, text: str) -> Symbol:
        """What a template writes as `$…$`: a quantity by its id, else letters with what is lowered."""
        if text in self.case.printed:
            return self.case.printed.symbol(text)
        base, _, sub = text.partition("_")
        return vocabulary.in_language(Symbol(base, sub.replace("2p", OTHER)), self.case.words["symbols"])

    @property
    def _z(self) -> dict[str, Any]:
        z = {wheel: Symbol("z", wheel) for wheel in ("1", "2", OTHER, "3")}
        return z | {OTHER: z["2"]} if self.case.scheme.single else z

    @property
    def relation(self) -> Equation:
        """The formula of Willis, and the ratio with wheel 3 at rest."""
        ω = {wheel: Symbol("ω", wheel) for wheel in "123H"}
        u0, u, scheme = Symbol("u", "13", "(H)"), Symbol("u", "1H"), self.case.scheme
        term = term_of(scheme, self._z)
        willis = Chain((u0, (ω["1"] - ω["H"]) / (ω["3"] - ω["H"]), signed(-scheme.sign, term)))
        return Equation((willis, Chain((u, ω["1"] / ω["H"], 1 - u0, 1 + signed(scheme.sign, term)))))

    @property
    def assembly(self) -> Equation:
        k, P, N, z, u = Symbol("k"), Symbol("P"), Symbol("N"), self._z, Symbol("u", "1H")
        if self.case.scheme.single:
            return Equation((Chain((N, u * z["1"] / k, (z["1"] + z["3"]) / k)),))
        return Equation((Chain((N, Product((u, z["1"], 1 + k * P)) / k)),))

    @staticmethod
    def _share(of: float) -> Number:
        return Number(float(f"{of * 100:.6g}"), None, "%")

    # --- tables

    def _table(
        self, name: str, head: Iterable[Inlines], rows: Iterable[Iterable[Inlines]], widths: Iterable[Column]
    ) -> Table:
        caption = Prose(self.case.places).inlines(self.words["captions"][name])
        cells = tuple(tuple(map(Cell, row)) for row in rows)
        return Table(tuple(widths), (tuple(map(Cell, head)),), cells, caption, f"tab.{name}")

    @property
    def data(self) -> Table:
        """The data with their names, symbols and values."""
        case, heads = self.case, self.case.words["table"]
        rows: list[tuple[Inlines, ...]] = []
        for key in ("scheme", "drives"):
            choice = self.words["choices"][key]
            rows.append(((Text(choice["name"]),), (Text("–"),), (Text(choice[getattr(case.given, key)]),)))
        for id, name in case.words["given"].items():
            if id in case.printed and (id != "train.u" or case.given.u) and (id != "train.n.out" or case.given.n_out):
                number = case.printed.number(id)
                rows.append(((Text(str(name)),), (InlineMath(case.printed.symbol(id)),), (Value(number),)))
        for i, (a, b) in enumerate((*case.given.before, *case.given.behind)):
            key = "row_before" if i < len(case.given.before) else "row_behind"
            symbols = InlineMath(Symbol("z", str(4 + 2 * i))), Text(", "), InlineMath(Symbol("z", str(5 + 2 * i)))
            rows.append(((Text(self.words[key]),), symbols, (Text(f"{a}, {b}"),)))
        limits = f"{case.given.z.from_} … {case.given.z.to}"
        rows.append(((Text(self.words["limits"]),), (InlineMath(Symbol("z")),), (Text(limits),)))
        tolerance = Value(self._share(case.given.tolerance.si))
        rows.append(((Text(self.words["tolerance"]),), (InlineMath(Symbol("Δu")),), (tolerance,)))
        head = [(Text(heads[key]),) for key in ("quantity", "symbol", "value")]
        return self._table("data", head, rows, (Column(DATA[0], "left"), Column(DATA[1]), Column(DATA[2])))

    @property
    def candidates(self) -> Table:
        """The smallest of the tooth numbers found, up to the chosen ones at least, with what decides."""
        case, choice, words = self.case, self.case.choice, self.words["candidates"]
        m2 = case.given.second_module.si
        columns = [choice.sets[:, i] for i in range(4)]
        across = sizes(case.scheme, (columns[0], columns[1], columns[2], columns[3]), case.train.modules) * m2 * MM
        shown = [*range(min(self.rows, len(choice.sets)))]
        if choice.first not in shown:
            shown.append(choice.first)
        rows: list[list[Inlines]] = []
        for n in shown:
            train = choice.train(n)
            u = case.given.of_input(float(train.ratio))
            off = (u - case.given.wanted) / case.given.wanted * 100
            z = train.teeth
            wheels = (z.one, z.two, z.three) if case.scheme.single else z
            mark = words["yes" if choice.free[n] else "no"] + (f" {words['chosen']}" if n == choice.first else "")
            rows.append(
                [
                    (Text(str(n + 1)),),
                    *((Text(str(one)),) for one in wheels),
                    (Value(_short(u, 4)),),
                    (Value(_short(off, 2)),),
                    (Value(_short(float(across[n]), 2)),),
                    (Text(mark),),
                ]
            )
        symbol = Symbol("u", "H1" if case.given.by_carrier else "1H")
        head: list[Inlines] = [
            (Text("№"),),
            *((InlineMath(Symbol("z", wheel)),) for wheel in self.wheels),
            (InlineMath(symbol),),
            (InlineMath(Symbol("Δu")), Text(", %")),
            (InlineMath(Symbol("D")), Text(", mm")),
            (Text(words["unshifted"]),),
        ]
        widths = (Column(10), *(Column(14),) * len(self.wheels), Column(22), Column(18), Column(22), Column(32))
        return self._table("candidates", head, rows, widths)

    @property
    def checks(self) -> Table:
        """What is required, what there is, and whether it holds."""
        case, words, z = self.case, self.words["checks"], self.case.train.teeth
        ledger = case.printed
        rows: list[tuple[Inlines, ...]] = []

        def row(name: str, wanted: Inlines, actual: Inlines, holds: bool = True) -> None:
            rows.append(((Text(words[name]),), wanted, actual, (Text(words["yes" if holds else "no"]),)))

        def of(id: str) -> Value:
            return Value(ledger.number(id))

        def bare(id: str) -> Value:
            number = ledger.number(id)
            return Value(Number(number.value, number.decimals))

        row("coaxial", (InlineMath(ledger.symbol("train.a.1")), Text(" = "), InlineMath(ledger.symbol("train.a.2"))),
            (of("train.a.1"), Text(" = "), of("train.a.2")))  # fmt: skip
        row("neighbours", (Text("< "), of("train.room")), (of("train.gap"),))
        row("assembly", (Text(words["whole"]),), (InlineMath(ledger.symbol("train.N")), Text(" = "), of("train.N")))
        outer = [z.two, z.other] + [
            wheel for wheel, inner in zip((z.one, z.three), case.scheme.inner, strict=True) if not inner
        ]
        row("outer", (Text(f"≥ {LEAST_OUTER}"),), (Text(str(min(outer))),))
        for name, inner, wheel, satellite in zip(
            ("first", "second"), case.scheme.inner, (z.one, z.three), (z.two, z.other), strict=True
        ):
            if inner:
                row(name, (Text(f"≥ {LEAST_DIFFERENCE}"),), (Text(f"{wheel} − {satellite} = {wheel - satellite}"),))
        if any(case.scheme.inner):
            free = bool(case.choice.free[case.choice.first])
            row("unshifted", (Text("–"),), (Text(words["free" if free else "shift"]),), free)
        widths = (Column(CHECKS[0], "left"), *(Column(one) for one in CHECKS[1:]))
        return self._table("checks", [(Text(one),) for one in words["head"]], rows, widths)

    @property
    def rates_table(self) -> Table:
        """Angular velocities by Willis and as they are read off, with the difference."""
        ledger = self.case.printed
        rows: list[list[Inlines]] = []
        for wheel in ("1", "2", "H"):
            by, read = (ledger.number(id(wheel)) for id in (ids.train_omega, ids.train_read))
            off = (read.shown - by.shown) / by.shown * 100
            numbers = (Value(Number(one.value, one.decimals)) for one in (by, read))
            rows.append([(InlineMath(Symbol("ω", wheel)),), *((one,) for one in numbers), (Value(Number(off, 2)),)])
        head = [(Text(one),) for one in self.words["rates"]]
        return self._table("rates", head, rows, map(Column, RATES))

    # --- figures

    def figure(self, name: str) -> Figure:
        caption = Prose(self.case.places).inlines(self.words["captions"][f"figure-{name}"])
        scene = scheme_views(self.case) if name == "scheme" else velocity_triangles(self.case)
        return Figure((scene,), caption, f"fig.{name}")


def _short(value: float, decimals: int) -> Number:
    """A number as it is where it has few decimals, else rounded."""
    short = round(value, decimals)
    return Number(short + 0.0, None) if np.isclose(value, short, rtol=1e-12, atol=1e-12) else Number(value, decimals)


# --- the case --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class TrainCase(SolvedTrain):
    """A planetary train, as a `Case`."""

    @property
    def families(self) -> Mapping[str, Family]:
        return self.ledger.families

    @property
    def positions_of_a_turn(self) -> int:
        return 1

    @property
    def balance(self) -> None:
        """It has no forces."""

    def fault(self) -> str:
        return "" if self.choice.free[self.choice.first] else "train-shift"

    def document(self) -> Document:
        return self.bounded(report)

    def key(self) -> Key:
        from reportgen.marking.key import make_key

        return make_key(self, self.ledger, self.printed, sense_of=self._sense)

    def _sense(self, id: str) -> str:
        family = self.ledger[id]
        return str(next(vocabulary.words_of(self.words["positive"], id, family.kind, family.symbol), ""))

    def task(self, key: Key, by_section: bool = False) -> Document:
        return self.bounded(partial(task, key=key, by_section=by_section))

    def results(self) -> dict[str, Any]:
        """All tooth numbers that fulfil the conditions, by size; the chosen ones, their ratio and their rates."""
        from reportgen.marking.results import results

        found = self.choice
        omega = {id.rpartition(".")[2]: self.ledger[id].at(1) for id in self.ledger.families if id in ids.train_omega}
        shown = range(min(len(found.sets), SHOWN_SETS))
        sets = [{**_told(found.train(n)), "unshifted": bool(found.free[n])} for n in shown]
        return results(
            self,
            [{"number": 1, "wheels": {wheel: {"omega": float(rate)} for wheel, rate in omega.items()}}],
            train={**_told(self.train), "satellites": self.given.k, "possible": list(self.train.satellites)},
            found=len(found.sets),
            sets=sets,
        )

    def film(self) -> Film:
        return train_drawings.film(self)

    def sheets(self, size: str = "", sets: Collection[str] = (), block: Path | None = None) -> list[DrawingSheet]:
        return train_drawings.drawing_sheets(self, size, block)


def _told(train: Train) -> dict[str, Any]:
    z = train.teeth
    return {"z": [z.one, z.two, z.other, z.three], "ratio": float(train.ratio)}
