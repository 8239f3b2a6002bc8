"""Nothing is measured that is not drawn: the ends of each measured length are named in the figure it is read from."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from reportgen import document as tree
from reportgen.derivation.kinematic_entries import POLES
from reportgen.drawing import Content, Label
from reportgen.drawing.force_drawings import LEAST_ARM
from reportgen.formula import Symbol, refs, vocabulary
from reportgen.formula.ledger import Ledger
from tests.lanes import matrix
from tests.report import built
from tests.report.built import Written

MM = 1e3
PLAN = re.compile(r"plan\.([va])\.(?:([nk])\.)?(.+)")
FORCES = re.compile(r"plan\.R(.+)\.(\w+)")


def walk(blocks: Sequence[tree.Block]) -> Iterator[tree.Figure | tree.Plate]:
    for block in blocks:
        if isinstance(block, (tree.Figure, tree.Plate)):
            yield block


def names(document: tree.Document) -> dict[str, set[Content]]:
    """What is written in the figures of a document, by their keys; all plates of one figure under the first key."""
    found: dict[str, set[Content]] = {}
    key = ""
    for block in walk(document.blocks):
        scenes = block.scenes if isinstance(block, tree.Figure) else (block.scene,)
        if not (isinstance(block, tree.Plate) and block.continues):
            key = re.sub(r"^(fig\.centres\.\w+)\.\d+$", r"\1", block.key)
        own = found.setdefault(key, set())
        own |= {item.content for scene in scenes for item in scene.items if isinstance(item, Label)}
    return found


def worked(written: Written) -> set[tuple[str, int | None]]:
    """The quantities with a worked line, and the lengths it shows that they are worked out from: v_B = μ_v · pb."""
    ledger, found = written.case.ledger, set(written.lines)
    for id, k in written.lines:
        definition = ledger[id].definition
        if definition is not None and not ledger[id].constructed:
            found |= {(one, k) for one in refs(definition)}
    return found


def image(what: str, part: str, name: str) -> Symbol:
    """The letter of a vertex of a velocity or acceleration plan: b, s2, or n with the vector it ends."""
    return Symbol(part, name) if part else vocabulary.on_plan(name.upper(), what == "a")


def same(wanted: Content, shown: Content) -> bool:
    """Whether a label is the wanted one; a known part may end with the other block's number: k of B₃B₂ for B₃B."""
    if isinstance(wanted, Symbol) and isinstance(shown, Symbol) and wanted.base in "nk" and len(wanted.sub) > 1:
        return shown.base == wanted.base and shown.sub.startswith(wanted.sub)
    return wanted == shown


def ends(ledger: Ledger, id: str, k: int, label: str, turn: str) -> tuple[list[str], list[Content]]:
    """The figures one of which must show a measured quantity, and what it must name there."""
    family = ledger[id]
    if id.startswith("ic.seg."):
        link, point = id.split(".")[2:]
        return [f"fig.centres.{turn}"], [Symbol("P", link), vocabulary.point(point)]
    if id.startswith("ic.angle."):
        return [f"fig.centres.{turn}"], [family.symbol]
    if family.arm:
        return [f"fig.bodies.*.{label}", f"fig.crank.{label}", f"fig.lever.{label}"], [family.symbol]
    if id.startswith("drawn.H"):
        return [f"fig.bodies.*.{label}"], [Symbol("H", id[7:8])]
    assert family.definition is not None
    wanted: list[Content] = []
    figures: list[str] = []
    for vertex in refs(family.definition):
        if motion := PLAN.fullmatch(vertex):
            what, part, name = motion.groups()
            wanted.append(image(what, part or "", name))
            figures = [f"fig.{what}.{turn}"]
        elif forces := FORCES.fullmatch(vertex):
            wanted.append(Symbol(forces[2]))
            figures = (
                [f"fig.crank.{label}", f"fig.slide.{label}"] if forces[1] == "1" else [f"fig.R.{forces[1]}.{label}"]
            )
    if len(wanted) == 1:
        wanted += [Symbol(POLES[figures[0][4]])] if figures[0][4] in POLES else []
    return figures, wanted


@pytest.mark.parametrize("file", matrix(built.ALL, built.TELLING), ids=lambda file: file.stem)
def test_ends_of_what_is_measured_are_named_in_its_figure(file: Path) -> None:
    written = built.written(file, built.own_language(file))
    ledger, machine, shown = written.case.ledger, written.case.analysis.machine, names(written.document)
    checked, missing = 0, []
    for id, k in sorted(worked(written), key=str):
        family = ledger[id]
        if k is None or not (family.arm or (family.constructed and family.kind in ("segment", "angle"))):
            continue
        size = abs(float(ledger[id].at(k).real))
        # An arm too short to draw, and two points in one, are said to be so and not measured.
        if not size * MM >= LEAST_ARM:
            continue
        turn = str(machine.position((k - 1) % machine.count + 1))
        figures, wanted = ends(ledger, id, k, str(machine.position(k)), turn)
        if not figures:
            continue
        keys = [
            key
            for key in shown
            if any(re.fullmatch(one.replace(".", r"\.").replace("*", "[^.]+"), key) for one in figures)
        ]
        checked += 1
        if not any(all(any(same(one, other) for other in shown[key]) for one in wanted) for key in keys):
            missing.append((id, k, wanted, keys))
    assert missing == []
    assert checked > 4
