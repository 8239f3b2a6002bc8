"""A structure exercise as a case: report and task with their tables, key, results, drawing sheet."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from reportgen.case.design_case import DesignPage
from reportgen.case.result_entries import ResultEntries
from reportgen.document import Column, Equation, InlineMath, Inlines, Table, Text
from reportgen.drawing import Scene
from reportgen.drawing.drawing_sheet import lettered
from reportgen.drawing.plates import DrawingPlate
from reportgen.formula import Chain, vocabulary
from reportgen.sheets.plates import drawn
from reportgen.structure import scheme_drawing, structure_drawings
from reportgen.structure import structure_ids as ids
from reportgen.structure.splitting import roman
from reportgen.structure.structure_solution import SolvedStructure, formula_of

LINES = "counts", "mobility", "equivalent"
NARROW, MIDDLE, WIDE = 16.0, 34.0, 70.0
"""Widths (mm) of the columns of tables."""


def listed(links: Iterable[int]) -> str:
    return ", ".join(map(str, links))


@dataclass(frozen=True)
class StructurePage(DesignPage[SolvedStructure]):
    """A structure exercise for its templates."""

    NAME, TASK, SUMMARY = "structure", "structure-task", "structure-summary"
    SECTIONS = (
        *("structure-given", "structure-mobility", "structure-higher", "structure-groups", "structure-drivers"),
        "structure-conclusion",
    )
    SHORT: ClassVar[frozenset[str]] = frozenset()
    SWITCHES: ClassVar = {"structure-drivers": ("other_drivers",)}

    def has(self, section: str) -> bool:
        """Return False for the replacement of higher pairs if there are none."""
        return bool(self.case.replacements) if section == "structure-higher" else super().has(section)

    def names(self) -> dict[str, Any]:
        case, given = self.case, self.case.given
        lines: dict[str, list[str]] = {name: [] for name in LINES}
        lines |= {name: list(case.printed.known(quantities)) for name, quantities in case.printed.lines.items()}
        return {
            **self.shared_names,
            "driver": str(given.driver),
            "pair_table": self.pair_table,
            "has_points": bool(case.placed.joints),
            "rollers": listed(given.rollers or ()),
            "passive": listed(given.passive or ()),
            "has_multiple": any(len(joint.links) > 2 for joint in case.chain.joints),
            "has_higher": bool(case.replacements),
            "replacement_table": self.replacement_table if case.replacements else "",
            "has_groups": bool(case.groups),
            "group_table": self.group_table if case.groups else "",
            "numbers": self.equation((*self._numbers_of_links, ids.MECHANISM_CLASS)),
            "formula": formula_of(case.splitting),
            "mechanism_class": roman(case.splitting.mechanism_class),
            "asks_drivers": given.other_drivers is not None,
            "driver_table": self.driver_table if case.other_drivers else "",
            "driver_classes": self.equation(ids.class_by(link) for link in case.other_drivers),
            "sheet": lines,
        }

    def equation(self, quantities: Iterable[str]) -> tuple[Equation, ...]:
        """Return the numbers of these quantities, each on a line; () if there are none."""
        printed = self.case.printed
        rows = tuple(Chain((printed.symbol(id), printed.result(id))) for id in quantities if id in printed)
        return (Equation(rows),) if rows else ()

    @property
    def _numbers_of_links(self) -> Iterator[str]:
        """Yield the ids of the group and the class of every link."""
        for link in sorted(link for group in self.case.groups for link in group.links):
            yield from (ids.group(link), ids.group_class(link))

    @property
    def pair_table(self) -> Table:
        """The table of the given pairs, with their letters in the scheme if it is drawn."""
        words, chain = self.words["heads"], self.case.given.whole_chain
        names = ("number", "links", "pair", *(["point"] if self.case.placed.joints else []))
        heads = tuple((Text(str(words[name])),) for name in names)
        letters = {frozenset(joint.links): joint for joint in self.case.placed.joints}
        rows: list[tuple[Inlines, ...]] = []
        for number, joint in enumerate(chain.joints, start=1):
            sort = "higher" if joint.higher else "multiple" if len(joint.links) > 2 else "lower"
            point = letters.get(frozenset(joint.links))
            if point is not None and sort == "lower":
                sort = "turning" if point.turns else "sliding"
            cells: list[Inlines] = [
                (Text(text),) for text in (str(number), listed(joint.links), self.words["pairs"][sort])
            ]
            rows.append((*cells, *([] if point is None else [(InlineMath(vocabulary.point(point.name)),)])))
        widths = (NARROW, MIDDLE, WIDE, NARROW)[: len(names)]
        return self.table("pairs", tuple(map(Column, widths)), (heads,), rows)

    @property
    def replacement_table(self) -> Table:
        """The table of the links that replace higher pairs."""
        words = self.words["heads"]
        heads = ((Text(str(words["replacement"])),), (Text(str(words["contact"])),))
        rows = [((Text(str(link)),), (Text(listed(pair)),)) for link, pair in self.case.replacements.items()]
        return self.table("replacements", (Column(MIDDLE), Column(MIDDLE)), (heads,), rows)

    @property
    def group_table(self) -> Table:
        """The table of the groups in the order in which they are split off, the last of the assembly first."""
        words = self.words["heads"]
        names = ("step", "links", "group_pairs", "class", "order")
        heads = tuple((Text(str(words[name])),) for name in names)
        rows: list[tuple[Inlines, ...]] = []
        for step, group in enumerate(reversed(self.case.groups), start=1):
            cells = str(step), listed(group.links), str(group.pairs), roman(group.assur_class), str(group.order)
            rows.append(tuple((Text(cell),) for cell in cells))
        columns = (Column(NARROW), Column(MIDDLE), Column(MIDDLE), Column(NARROW), Column(NARROW))
        return self.table("groups", columns, (heads,), rows)

    @property
    def driver_table(self) -> Table:
        """The table of the formulas of structure with the other drivers."""
        words = self.words["heads"]
        heads = tuple((Text(str(words[name])),) for name in ("driver", "formula", "class"))
        rows: list[tuple[Inlines, ...]] = []
        for link, splitting in self.case.other_drivers.items():
            formula = str(self.words["cannot_drive"]) if splitting is None else formula_of(splitting)
            grade = "–" if splitting is None else roman(splitting.mechanism_class)
            rows.append(((Text(str(link)),), (Text(formula),), (Text(grade),)))
        return self.table("drivers", (Column(NARROW), Column(110.0, "left"), Column(NARROW)), (heads,), rows)

    def scenes(self, name: str) -> Iterable[Scene]:
        match name:
            case "diagram":
                return (structure_drawings.diagram(self.case),)
            case "scheme":
                return (scheme_drawing.scheme(self.case.placed, self.case.given.driver),)
            case "replacement":
                return scheme_drawing.replacement(self.case.placed_active, self.case.given.driver)
            case "steps":
                return scheme_drawing.steps(self.case.placed_active.with_lower_pairs, self.case.splitting)
            case _:
                raise KeyError(name)


@dataclass(frozen=True)
class StructureCase(SolvedStructure):
    """A structure exercise, as a `Case`."""

    PAGE = StructurePage

    @cached_property
    def entries(self) -> ResultEntries:
        """The counts, the groups by their lowest links in the order of assembly, and the class with each other driver.

        A list of links is a text, because a list would be a vector in a table of results.
        """
        counted = {
            "links": ids.LINKS,
            "lower": ids.LOWER,
            "higher": ids.HIGHER,
            "mobility": ids.MOBILITY,
            "groups": ids.GROUPS,
            "class": ids.MECHANISM_CLASS,
        }
        counts = {name: round(float(self.ledger[id].at(1))) for name, id in counted.items() if id in self.ledger}
        position: dict[str, Any] = {
            "number": 1,
            "structure": counts,
            "groups": {
                str(group.links[0]): {"links": listed(group.links), "class": group.assur_class, "order": group.order}
                for group in self.groups
            },
        }
        if self.other_drivers:
            position["drivers"] = {
                str(link): None
                if splitting is None
                else {"class": splitting.mechanism_class, "formula": formula_of(splitting)}
                for link, splitting in self.other_drivers.items()
            }
        return ResultEntries([position])

    def plates(self, sets: Collection[str] = (), every: bool = False) -> Mapping[str, Sequence[DrawingPlate]]:
        """Return the scheme, the graph of the structure and the tables; `sets` is ignored, since there is only one."""
        page, captions = StructurePage(self), self.words["structure"]["captions"]
        scene = lettered(structure_drawings.diagram(self))
        plates = [DrawingPlate(captions["figure-diagram"], (), "schemes", (scene,))]
        if self.placed.joints:
            figures = ("scheme", *(["replacement"] if self.replacements else []), "steps")
            plates[:0] = [
                DrawingPlate(captions[f"figure-{name}"], (), "schemes", tuple(map(lettered, page.scenes(name))))
                for name in figures
            ]
        if self.groups:
            table = page.group_table
            plates.append(
                DrawingPlate(captions["groups"], (), "tables", (drawn(table, self.assignment.language),), spare=True)
            )
        return {"structure": plates}
