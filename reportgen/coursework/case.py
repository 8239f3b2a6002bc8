"""A coursework as a case: the joined results of a machine's case and its parts' cases."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise, takewhile
from typing import Any, Self

import numpy as np

from reportgen.assignment.common import PARTS, AssignedPart, Assignment, LengthOfPart, TakenDatum
from reportgen.base.records import Record, replace
from reportgen.case import Case, CaseOfParts, DriverMotion, Misconceptions
from reportgen.case.answer_key import Key, PartOfKey, Span, capitalised
from reportgen.case.missing_chapters import MissingChapter
from reportgen.case.quantity_wording import phrase
from reportgen.case.result_entries import ResultEntries
from reportgen.case.shafts import Shaft
from reportgen.coursework import senses
from reportgen.coursework.booklet import PartReport, booklet, handout, with_lengths
from reportgen.coursework.senses import PartShafts
from reportgen.coursework.symbol_renaming import Letters, changed, letters_of, nodes, relettered
from reportgen.document import Block, Document, Equation, InlineMath, Inlines, Paragraph, Text, listed
from reportgen.document.used_symbols import explained, is_explained, used_symbols
from reportgen.drawing.animation import Animation
from reportgen.drawing.drawing_sheet import DrawingSheet
from reportgen.drawing.plates import DrawingPlate
from reportgen.drawing.plates import changed as with_change
from reportgen.formula import Chain, Expression, Number, Ref, Symbol, ids, size
from reportgen.formula.calculation import Family
from reportgen.formula.ledger import Ledger

_NUMBER = re.compile(r"\b\d\b")
"""The number of a wheel in the name of a quantity."""
PINS = "ABCD"
"""Letters of the pins of a four-bar or slider-crank, which its synthesis uses too."""
MACHINE = "machine"
"""The name of the first part, the machine."""


class PartCase(Record, dict=True):
    """A part with its case; the coursework does not change either."""

    part: AssignedPart
    case: Case

    @cached_property
    def document(self) -> Document:
        """The report of the part alone."""
        return self.case.document()

    @cached_property
    def animations(self) -> tuple[Animation, ...]:
        return self.case.animations()

    @cached_property
    def used(self) -> frozenset[Symbol]:
        """The symbols that its report uses."""
        known = self.case.used
        return frozenset(nodes(self.document.blocks, Symbol) if known is None else known)

    @property
    def assigned(self) -> Assignment:
        """The assignment of its case, without the parts that follow it."""
        return replace(self.case.assignment, parts=())

    @property
    def name(self) -> str:
        return self.part.name

    @property
    def title(self) -> str:
        return self.part.title or self.case.title

    @property
    def index(self) -> str:
        """The index of its symbols that others also use: the word for its kind, with the number in its name."""
        return f"{self.case.words['index']}{self.name.removeprefix(self.part.head)}"

    def id(self, own: str) -> str:
        """Return the id in the coursework of a quantity of the part: cam.s, or cam2.s for the second cam."""
        return self.name + own.removeprefix(self.part.head)

    def whole(self, ledger: Ledger, letters: Letters) -> Mapping[str, Family]:
        """Return the families of a ledger of the part under their ids in the coursework."""

        def renamed(family: Family) -> Family:
            inner = changed(family, Ref, lambda ref: Ref(self.id(ref.id)))
            symbol = letters.get(family.symbol, family.symbol)
            of, about = (self.id(one) if one else "" for one in (family.of, family.about))
            return replace(inner, id=self.id(family.id), of=of, about=about, symbol=symbol)

        return {self.id(id): renamed(family) for id, family in ledger.families.items()}


@dataclass(frozen=True)
class Coursework(CaseOfParts):
    """A machine and the parts that follow it, as one `Case`."""

    first: PartCase
    members: tuple[PartCase, ...]

    @classmethod
    def of(cls, machine: Case, cases: Sequence[Case]) -> Self:
        """Return the coursework of a machine with parts, from the machine's case and the parts' cases."""
        whole = machine.assignment
        members = tuple(PartCase(part, case) for part, case in zip(whole.parts, cases, strict=True))
        return cls(whole, PartCase(AssignedPart(MACHINE, "", "", replace(whole, parts=())), machine), members)

    def after(self, earlier: Case | None) -> Coursework:
        """Return the same coursework; parts that have not changed since the `earlier` one keep their computed
        values.
        """
        known = (earlier.first, *earlier.members) if isinstance(earlier, Coursework) else ()

        def kept(member: PartCase) -> PartCase:
            same = (one for one in known if (one.part, one.assigned) == (member.part, member.assigned))
            return next(same, member)

        return Coursework(self.assignment, kept(self.first), tuple(map(kept, self.members)))

    @property
    def machine(self) -> Case:
        return self.first.case

    @cached_property
    def lengths_of_parts(self) -> Mapping[str, str]:
        return {ids.of_part(id): member.id(length.id) for id, member, length in self._lengths()}

    def _lengths(self) -> Iterator[tuple[str, PartCase, LengthOfPart]]:
        """Yield the lengths that parts give: the machine's id, the part, and the length in it."""
        own = {family.from_part: id for id, family in self.machine.printed.families.items() if family.from_part}
        for length in self.assignment.lengths:
            yield own[length.key], self.members[length.part], length

    @property
    def words(self) -> Mapping[str, Any]:
        return self.machine.words

    @property
    def title(self) -> str:
        return self.machine.title

    @property
    def course(self) -> str:
        return self.machine.course

    @property
    def parts(self) -> Mapping[str, Case]:
        return {MACHINE: self.machine, **{member.name: member.case for member in self.members}}

    # --- numbers

    @cached_property
    def ledger(self) -> Ledger:
        return self._joined(self.machine.ledger, [member.case.ledger for member in self.members])

    @cached_property
    def printed(self) -> Ledger:
        return self._joined(self.machine.printed, [member.case.printed for member in self.members])

    def _joined(self, machine: Ledger, parts: Sequence[Ledger]) -> Ledger:
        families, decimals = dict(machine.families), dict(machine.decimals)
        for member, ledger in zip(self.members, parts, strict=True):
            families |= member.whole(ledger, self.letters[member.name])
            decimals |= {member.id(id): digits for id, digits in ledger.decimals.items()}
        return replace(machine, families=families, decimals=decimals)

    def _gives(self, member: PartCase) -> bool:
        """Return True if a part gives the machine lengths, so that its chapters come first."""
        return any(self.members[length.part] is member for length in self.assignment.lengths)

    @property
    def families(self) -> Mapping[str, Family]:
        parts = [member.whole(member.case.ledger, {}) for member in self.members]
        return {id: family for families in (self.machine.families, *parts) for id, family in families.items()}

    @property
    def span(self) -> Span:
        return self.machine.span

    @property
    def entries(self) -> ResultEntries:
        """Entries of its machine; each part has its own."""
        return self.machine.entries

    @property
    def speed(self) -> float | None:
        return self.machine.speed

    @property
    def driver_motion(self) -> DriverMotion | None:
        return self.machine.driver_motion

    @property
    def balance(self) -> np.ndarray | None:
        return self.machine.balance

    @property
    def misconceptions(self) -> Misconceptions:
        return self.machine.misconceptions

    def fault(self) -> str:
        return next(filter(None, (case.fault() for case in self.parts.values())), "")

    # --- letters

    @cached_property
    def letters(self) -> Mapping[str, Letters]:
        """The renamed symbols of each part: those of quantities whose letters an earlier part uses for something else.

        Keys and answer sheets need them too, so they do not depend on the machine's report.
        """
        used: set[Symbol] = set()
        letters_of_parts: dict[str, Letters] = {}
        for before, member in pairwise((self.first, *self.members)):
            letters = letters_of_parts.get(before.name, {})
            used.update(letters.get(symbol, symbol) for symbol in before.used)
            same = {self._taken_symbols(member, datum)[0] for datum in member.part.taken if datum.times == "1"}
            quantities = {one.symbol for one in member.case.printed.families.values() if not one.hidden} - same
            letters = letters_of(sorted(quantities, key=str), used, member.index)
            letters_of_parts[member.name] = letters
        return letters_of_parts

    def _points(self, member: PartCase) -> list[Symbol]:
        """Return the points of a part whose names an earlier part uses for another point."""
        earlier = takewhile(lambda one: one is not member, (self.first, *self.members))
        taken = {one for before in earlier for one in nodes(before.document.blocks, Symbol)}
        own = {one.symbol for one in member.case.printed.families.values() if not one.hidden and not one.is_plane}
        points = set(nodes(member.document.blocks, Symbol)) - own
        if self._gives(member):
            # The pins of the mechanism that it finds are those of the machine.
            points -= {one for one in points if one.base in PINS and not one.sub}
        return sorted((one for one in points & taken if _names_a_point(one)), key=lambda one: (one.base, one.sub))

    @cached_property
    def documents(self) -> Mapping[str, Document]:
        """The separate reports of the machine and the parts."""
        return {member.name: member.document for member in (self.first, *self.members)}

    @property
    def missing_chapters(self) -> Sequence[MissingChapter]:
        """Those of the machine, and of the parts that are in the same file."""
        of_parts = [
            chapter.below((PARTS, index), member.title)
            for index, member in enumerate(self.members)
            if member.assigned.source == self.assignment.source
            for chapter in member.case.missing_chapters
        ]
        return [*self.machine.missing_chapters, *of_parts]

    # --- papers

    def document(self) -> Document:
        parts = [self._report(member) for member in self.members]
        machine = with_lengths(self.documents[MACHINE], self._named_lengths())
        return booklet(machine, parts, self.words, tuple(self._senses()))

    def _senses(self) -> Iterator[Block]:
        """Yield the senses in which the shafts turn, if the machine's driver turns."""
        unit = str(self.machine.printed.units.get("rpm", "rpm"))
        parts = [
            PartShafts(
                member.title,
                member.case.shafts,
                {datum.key: datum.of for datum in member.part.taken if datum.times == "1"},
            )
            for member in self.members
        ]
        for driver in self.machine.shafts[:1]:
            yield from senses.senses_of_shafts(driver, parts, self.words, unit)

    @property
    def shafts(self) -> Sequence[Shaft]:
        return [shaft for case in self.parts.values() for shaft in case.shafts]

    def _report(self, member: PartCase) -> PartReport:
        letters = self.letters[member.name]
        document = relettered(self.documents[member.name], letters)
        rows = tuple(self._symbols(member)) if self.assignment.report.extent == "full" else ()
        lettered = tuple(self._symbol_remarks(letters, member))
        summary = tuple(relettered(member.case.summary(), letters))
        taken = tuple(self._taken(member))
        return PartReport(
            member.name,
            member.title,
            document,
            taken,
            lettered,
            symbols=rows,
            summary=summary,
            lengths=tuple(self._given_lengths(member)),
        )

    def _symbol_remarks(self, letters: Letters, member: PartCase) -> Iterator[Paragraph]:
        """Yield the sentences on the symbols of a part with its index, and on its points that share a name with earlier
        ones.
        """
        keys = ("letters_of_machine", "points_of_machine") if self._gives(member) else ("letters", "points")
        for key, symbols in zip(keys, (list(letters.values()), self._points(member)), strict=True):
            if symbols:
                lead = str(self.words["coursework"][key]).format(index=member.index)
                yield Paragraph((Text(lead), *listed(map(InlineMath, symbols)), Text(".")))

    def _taken(self, member: PartCase) -> Iterator[Paragraph | Equation]:
        """Yield the data that a part takes from the machine: n_cam = 1/2 · n = 45 rpm."""
        chains = []
        for datum in member.part.taken:
            own, of = self._taken_symbols(member, datum)
            id = _datum(member.case, datum.key, member.part.head)
            value = (member.case.printed.number(id),) if id else ()
            symbol = self.letters[member.name].get(own, own)
            times: tuple[Expression, ...] = () if symbol == of else (_times(datum.times, of),)
            chains.append(Chain((symbol, *times, *value)))
        if chains:
            yield Paragraph((Text(str(self.words["coursework"]["taken"]).strip()),))
            yield Equation(tuple(chains))

    def _named_lengths(self) -> Iterator[Paragraph]:
        """Yield the names of the lengths of the machine that parts give; a task must not show more."""
        for giver in filter(self._gives, self.members):
            symbols = [self.machine.printed.symbol(id) for id, member, _ in self._lengths() if member is giver]
            text = str(self.words["coursework"]["lengths"]).format(title=giver.title)
            yield Paragraph((Text(text), *listed(map(InlineMath, symbols)), Text(".")))

    def _given_lengths(self, giver: PartCase) -> Iterator[Paragraph | Equation]:
        """Yield the lengths that a part gives the machine: l_AB = a = 39.53 mm."""
        letters, chains = self.letters[giver.name], list[Chain]()
        for id, member, length in self._lengths():
            if member is giver:
                own, number = member.case.printed.symbol(length.id), member.case.printed.number(length.id)
                symbol = letters.get(own, own)
                of: Expression = size(symbol) if number.value < 0 else symbol
                chains.append(Chain((self.machine.printed.symbol(id), of, replace(number, value=abs(number.value)))))
        if chains:
            yield Paragraph((Text(str(self.words["coursework"]["given_lengths"]).strip()),))
            yield Equation(tuple(chains))

    def _taken_symbols(self, member: PartCase, datum: TakenDatum) -> tuple[Symbol, Symbol]:
        """Return the part's symbol for a datum, and the machine's."""
        own, of = _datum(member.case, datum.key, member.part.head), _datum(self.machine, datum.of)
        return (
            member.case.printed.symbol(own) if own else Symbol(datum.key),
            self.machine.printed.symbol(of) if of else Symbol(datum.of.rpartition(".")[2]),
        )

    def _symbols(self, member: PartCase) -> Iterator[tuple[Inlines, Inlines, Inlines]]:
        """Yield a row for the symbols of each meaning that the part's report uses without an explanation."""
        ledger, letters = member.case.printed, self.letters[member.name]
        blocks = member.document.blocks
        used, known = used_symbols(blocks), explained(blocks)
        alike: dict[tuple[str, str], dict[Symbol, str]] = {}
        for id, family in ledger.families.items():
            meaning = "" if family.hidden or family.is_plane else phrase(id, ledger, member.case.words)
            if meaning and family.symbol in used and not is_explained(family.symbol, known):
                unit = ledger.units.get(family.how.unit, family.how.unit)
                symbol = letters.get(family.symbol, family.symbol)
                alike.setdefault((_NUMBER.sub("", meaning), unit), {}).setdefault(symbol, meaning)
        for (_, unit), symbols in alike.items():
            meanings = list(dict.fromkeys(symbols.values()))
            numbers = ", ".join(number[0] for one in meanings if (number := _NUMBER.search(one)))
            meaning = _NUMBER.sub(numbers, meanings[0]) if len(meanings) > 1 else meanings[0]
            yield listed(map(InlineMath, symbols)), (Text(capitalised(meaning)),), (Text(unit or "–"),)

    def joined_key(self, keys: Sequence[Key]) -> Key:
        machine, *others = keys
        rows, parts = list(machine.rows), [PartOfKey(MACHINE, machine, self.title)]
        for member, alone in zip(self.members, others, strict=True):
            key = relettered(alone, self.letters[member.name])
            own = [
                replace(
                    row,
                    id=member.id(row.id),
                    size=member.id(row.size) if row.size else "",
                    plans=tuple(map(member.id, row.plans)),
                )
                for row in key.rows
            ]
            rows += own
            parts.append(PartOfKey(member.name, replace(key, rows=tuple(own)), member.title, member.part.head))
        return replace(machine, rows=tuple(rows), parts=tuple(parts))

    def joined_task(self, papers: Sequence[Document]) -> Document:
        machine, *others = papers
        machine = with_lengths(machine, self._named_lengths())
        return handout(machine, list(map(self._handout, self.members, others)))

    def _handout(self, member: PartCase, paper: Document) -> PartReport:
        own = relettered(paper, self.letters[member.name])
        return PartReport(member.name, member.title, own, tuple(self._taken(member)))

    def animations(self) -> tuple[Animation, ...]:
        """Return the animations of the machine, then those of the parts by their names and titles."""
        parts = (
            replace(relettered(animation, self.letters[member.name]), name=member.name, title=member.title)
            for member in self.members
            for animation in member.animations
        )
        return (*self.first.animations, *parts)

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return the plates of its machine."""
        return self.machine.plates(sets, every)

    @property
    def redrawn(self) -> tuple[float, Callable[[float], Case]] | None:
        return self.machine.redrawn

    def joined_plates(self) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return one set of plates, named after its contents; with several parts of a kind each plate names its
        part.
        """
        titles: list[str] = []
        plates_of_parts: list[DrawingPlate] = []
        for member in self.members:
            alike = sum(one.part.head == member.part.head for one in self.members)
            for name, plates in member.case.plates().items():
                title = str(member.case.words["plates"]["sets"][name])
                titles.append(title[:1].lower() + title[1:])
                plates_of_parts += [self._of_part(plate, member, alike > 1) for plate in plates]
        return {capitalised("; ".join(dict.fromkeys(titles))): plates_of_parts}

    def _of_part(self, plate: DrawingPlate, member: PartCase, named: bool) -> DrawingPlate:
        lines = (member.title,) if named else ()
        letters = self.letters[member.name]
        return with_change(plate, lambda one: replace(relettered(one, letters), lines=(*lines, *one.lines)))

    def true_sizes(self) -> Sequence[DrawingSheet]:
        return [
            relettered(sheet, self.letters[member.name])
            for member in self.members
            for sheet in member.case.true_sizes()
        ]


def _names_a_point(symbol: Symbol) -> bool:
    """Return True if a symbol is a capital, perhaps with a number, which names a point."""
    return symbol in (Symbol(symbol.base), Symbol(symbol.base, symbol.sub)) and (
        len(symbol.base) == 1 and "A" <= symbol.base <= "Z" and (symbol.sub or "0").isdecimal()
    )


def _datum(case: Case, key: str, head: str = "") -> str:
    """Return the id of the quantity that a key of the parameters gives; "" if the ledger has none.

    Most ids are the key with points between its components: z1 is gears.z.1, n_in is train.n.in.  A datum with another
    name, such as a length named by its points, is identified by its value if only one datum has that value.
    """
    given = {id: one for id, one in case.printed.families.items() if one.definition is None and len(one.values) == 1}
    wanted = f"{head}.{key}" if head else key
    if wanted in given:
        return wanted
    alike = [id for id in given if _letters(id) == _letters(wanted)]
    if not alike and (value := _typed(case.assignment, key)) is not None:
        printed = [id for id, one in given.items() if not one.hidden and not one.is_plane]
        alike = [id for id in printed if math.isclose(float(case.ledger[id].values[0]), value, rel_tol=1e-9)]
    return alike[0] if len(alike) == 1 else ""


def _letters(name: str) -> str:
    return name.replace(".", "").replace("_", "")


def _typed(assignment: Assignment, key: str) -> float | None:
    """Return the value of a parameter in SI units; None if it is not a number."""
    parameter: Any = assignment.parameters
    for step in key.split("."):
        parameter = getattr(parameter, step, None)
    value = getattr(parameter, "si", parameter)
    return float(value) if isinstance(value, (int, float)) else None


def _times(ratio: str, of: Symbol) -> Expression:
    """Return a symbol multiplied by a ratio as typed."""
    above, _, below = ratio.partition("/")
    factor: Expression = Number(float(above))
    if below:
        factor = factor / Number(float(below))
    return of if ratio == "1" else factor * of
