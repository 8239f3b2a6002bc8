"""Scale is true: every arrow of the PDF, and those of the plans against the ledger's segments, with a ruler."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator

import pytest

from reportgen.document import Figure, InlineMath, Plate, text_of
from reportgen.drawing import Arrow, Label
from reportgen.formula import Chain, Number, Symbol
from reportgen.machine import DRIVER
from tests.report import built, pages
from tests.report.built import Report, Written

pytest.importorskip("pymupdf")

RULER = 0.1
"""Millimetres: what a ruler on paper can tell apart."""
MM = 1e3
VANISHING = 0.01
"""Millimetres: the last digit of a measured length; what is shorter is not drawn."""


def drawn(written: Written) -> list[tuple[str, Arrow]]:
    """(figure, arrow) of every arrow, in printed order."""
    return [
        (key, item) for key, scene in built.scenes(written.document) for item in scene.items if isinstance(item, Arrow)
    ]


def measured(report: Report) -> list[tuple[str, str, float]]:
    """(figure, name, mm on paper) of every arrow."""
    lengths = [length for page in report.pages for length in pages.arrows(page)]
    expected = drawn(report.written)
    assert len(lengths) == len(expected)
    return [(key, arrow.name, length) for (key, arrow), length in zip(expected, lengths, strict=True)]


def test_every_arrow_is_as_long_on_paper_as_in_its_scene(report: Report) -> None:
    expected = [abs(arrow.end - arrow.start) for _, arrow in drawn(report.written)]
    assert len(expected) > 10
    off = [
        (key, name, length, true)
        for (key, name, length), true in zip(measured(report), expected, strict=True)
        if abs(length - true) > RULER
    ]
    assert off == []


def segment(name: str, plan: str) -> str:
    """The ledger's id of a vector of a velocity or acceleration plan: v_B is pb, v_BA is ab, a^n_BA is a′n."""
    of = re.fullmatch(r"([nkrτ]?)(([A-Z]\d*)([A-Z]\d*))", name)
    if not of:
        return f"seg.{plan}.p{name.lower()}"
    part, both, first, second = of.groups()
    return f"seg.{plan}.{part.replace('τ', 't')}.{both}" if part else f"seg.{plan}.{second.lower()}{first.lower()}"


def segments(written: Written, key: str) -> dict[str, list[float]]:
    """Lengths (mm) at the positions of one plan's figure by the vector's name; none for other figures."""
    ledger = written.case.printed
    motion = re.fullmatch(r"fig\.([va])\.(?:stages\.\w+\.)?(\w+)", key)
    forces = re.fullmatch(
        r"fig\.R\.(?:plates\.(\w+)|(?:stages\.)?(\w+)\.(\w+))", key.replace("fig.crank.", f"fig.R.{DRIVER}.")
    )
    if motion:
        ids = {name: [segment(name, motion[1])] for name in names(written, key)}
        position = motion[2]
    elif forces:
        group = forces[1] or forces[2]
        polygon = next(polygon for polygon in written.case.polygons if polygon.name == group)
        sides = (*polygon.edges, *polygon.reads)
        ids = defaultdict(list)
        for side in sides:
            ids[side.start + side.end].append(f"seg.{polygon.name}.{side.name}")
        position = forces[3] or "plates"
    else:
        return {}
    count = written.case.analysis.machine.count if motion else written.case.analysis.machine.positions
    positions = on_plates(written, key, count) if position == "plates" else [worked(written, position, count)]
    scale = f"mu.{motion[1]}" if motion else f"mu.R{polygon.name}"
    if forces and position == "plates":
        printed = own_scales(written, key, positions, ledger.symbol(scale))
    else:
        printed = dict.fromkeys(positions, scale_of(written, key, ledger.symbol(scale)))
    share = {k: ledger.number(scale, k).value / printed[k] for k in positions}
    return {
        name: [abs(complex(ledger[id].at(k))) * MM * share[k] for id in of for k in positions]
        for name, of in ids.items()
    }


def on_plates(written: Written, key: str, count: int) -> list[int]:
    """The positions whose plans a figure draws, by the titles of its scenes; the text names the others."""
    titles = set()
    for figure, scene in built.scenes(written.document):
        if figure == key:
            titles |= {scene.title, *(item.content for item in scene.items if isinstance(item, Label))}
    word = written.case.words["table"]["position"]
    position = written.case.analysis.machine.position
    found = [k for k in range(1, count + 1) if f"{word} {position(k)}" in titles]
    if len(found) < count:
        before, between, _ = re.split(r"\{list\}|\{drawn\}", written.case.words["counted"]["mirrored"])
        sentence = re.compile(f"{re.escape(before)}(.+?){re.escape(between)}")
        told = {name for names in sentence.findall(text_of(written.document)) for name in names.split(", ")}
        assert told >= {str(position(k)) for k in range(1, count + 1) if k not in found}
    return found


def own_scales(written: Written, key: str, positions: list[int], symbol: Symbol) -> dict[int, float]:
    """The scale μ that each force plan of all positions prints below itself; 1 where there is nothing to draw."""
    found = dict.fromkeys(positions, 1.0)
    label = {str(written.case.analysis.machine.position(k)): k for k in positions}
    for figure, scene in built.scenes(written.document):
        if figure == key:
            for shown in (item.content for item in scene.items if isinstance(item, Label)):
                if isinstance(shown, Chain) and shown.parts[0] == symbol and isinstance(shown.parts[-1], Number):
                    found[label[scene.at]] = shown.parts[-1].printed
    return found


def scale_of(written: Written, key: str, symbol: Symbol) -> float:
    """The one scale μ that a figure prints, in its caption or on its sheets."""
    scenes = [scene for figure, scene in built.scenes(written.document) if figure == key]
    shown = [item.content for scene in scenes for item in scene.items if isinstance(item, Label)]
    for block in built.walk(written.document.blocks):
        if isinstance(block, (Figure, Plate)) and block.key == key:
            shown += [inline.expression for inline in block.caption if isinstance(inline, InlineMath)]
    found = {
        part.printed
        for one in shown
        if isinstance(one, Chain) and one.parts[0] == symbol
        for part in one.parts[1:]
        if isinstance(part, Number)
    }
    (scale,) = found
    return scale


def worked(written: Written, label: str, count: int) -> int:
    """The position that a figure's key names: keys hold the labels of the worked positions, in order."""
    family = r"fig\.v\.(?!stages|plates)(\w+)" if count == written.case.analysis.machine.count else r"fig\.crank\.(\w+)"
    keys = (re.fullmatch(family, key) for key, _ in built.scenes(written.document))
    labels = dict.fromkeys(found[1] for found in keys if found)
    numbers = dict.fromkeys((k - 1) % count + 1 for k in written.case.assignment.worked_positions)
    return dict(zip(labels, numbers, strict=True))[label]


def names(written: Written, key: str) -> set[str]:
    return {arrow.name.split(" ×")[0] for figure, arrow in drawn(written) if figure == key}


def plans(report: Report) -> Iterator[tuple[str, str, list[float]]]:
    """(figure, name, lengths on paper) of the vectors of every plan, of all its sheets."""
    found: dict[tuple[str, str], list[float]] = defaultdict(list)
    for key, name, length in measured(report):
        found[key, name].append(length)
    for (key, name), lengths in found.items():
        yield key, name, lengths


def test_every_vector_of_a_plan_is_its_segment_of_the_ledger(report: Report) -> None:
    compared = 0
    for key, name, lengths in plans(report):
        known = segments(report.written, key)
        base, _, ratio = name.partition(" ×")
        if base not in known:
            # The crank's plan shares its figure with the body and its forces, which are not to scale.
            assert not re.match(r"fig\.[vaR]\.", key), (key, name)
            continue
        # Printed lengths are whole hundredths: one of 0.01 mm is drawn.
        true = [length for length in known[base] if length > VANISHING / 2]
        if ratio:
            true = [length * float(ratio) for length in known[base]]
            assert all(min(abs(length - other) for other in true) < RULER for length in lengths), (key, name)
        elif ".stages." in key:
            assert all(abs(length - true[0]) < RULER for length in lengths), (key, name)
        else:
            assert sorted(lengths) == pytest.approx(sorted(true), abs=RULER), (key, name)
        compared += len(lengths)
    assert compared > 100
