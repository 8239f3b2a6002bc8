"""Labels of the moving drawings: large enough to read, each beside its own arrow, without jumping about."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import pytest

from reportgen import catalogue
from reportgen.cases import opener
from reportgen.drawing import Label
from reportgen.drawing.label_size import POINT, box
from reportgen.drawing.style import SMALL
from reportgen.formula import Symbol
from reportgen.page.file_watch import edited
from reportgen.page.svg_elements import Painter, Pens
from tests.lanes import proof
from tests.page.browser import Browser
from tests.page.made import made
from tests.report import built

READABLE = 14
ALIKE = 1.5
"""Arrows nearer to each other than this (px) count as one."""
JUMP = 12
"""A label that moves by more than this (px) from one moment to the next has taken another place."""
MACHINES = "shaper-01", "linkage-8"

SEEN = r"""
moving.pause();
const items = JSON.parse(document.getElementById("samples").textContent).items;
const hidden = (one) => one.getAttribute("display") === "none" || one.hasAttribute("hidden");
const first = (path) => /M([-\d.e]+) ([-\d.e]+)/.exec(path.getAttribute("d")).slice(1).map(Number);
const edges = (text) => {
  const found = [text, ...text.parentElement.querySelectorAll("path")].map((part) => part.getBoundingClientRect());
  const left = Math.min(...found.map((edge) => edge.left)), right = Math.max(...found.map((edge) => edge.right));
  return [left, found[found.length - 1].top, right, found[0].bottom];
};
const size = (text) => parseFloat(getComputedStyle(text).fontSize) * text.getScreenCTM().a;
return arguments[0].map((angle) => {
  moving.seek(angle);
  return [...document.querySelectorAll("[data-stage]")].map((stage) => {
    const matrix = stage.querySelector("svg").getScreenCTM(), arrows = [];
    for (const one of stage.querySelectorAll("[data-i]")) {
      const item = items[one.dataset.i];
      if (item.from === undefined || !item.head || hidden(one)) continue;
      const ends = [first(one.children[0]), first(one.children[1])];
      const text = item.size && !hidden(one.lastElementChild) ? one.querySelector("text") : null;
      const placed = ends.map(([x, y]) => [matrix.a * x + matrix.e, matrix.d * y + matrix.f]);
      arrows.push([one.dataset.i, placed, text && edges(text)]);
    }
    const texts = [...stage.querySelectorAll("text")].filter((text) => text.getBoundingClientRect().width);
    return [stage.dataset.stage, arrows, Math.min(...texts.map(size))];
  });
});
"""
"""At each angle the stages: name, arrows as number, ends and box of the label (px), and the least size of letters."""

Arrow = tuple[str, list[list[float]], list[float] | None]


def distance(edges: list[float], ends: list[list[float]]) -> float:
    """From a box to a segment, to a part of a pixel: along it in steps."""
    (x1, y1), (x2, y2) = ends
    left, top, right, bottom = edges
    steps = max(int(2 * max(abs(x2 - x1), abs(y2 - y1))), 1)
    along = ((x1 + (x2 - x1) * n / steps, y1 + (y2 - y1) * n / steps) for n in range(steps + 1))
    return min(math.hypot(max(left - x, 0.0, x - right), max(top - y, 0.0, y - bottom)) for x, y in along)


def belongs(number: str, edges: list[float], arrows: list[Arrow]) -> bool:
    """Whether a label is nearest to its own arrow."""
    off = {one: distance(edges, ends) for one, ends, _ in arrows}
    return off[number] <= min(off.values()) + ALIKE


@proof
@pytest.mark.parametrize("name", MACHINES)
def test_letters_can_be_read_and_stand_beside_their_own_arrow(name: str, browser: Browser) -> None:
    """On a wide and a narrow screen, at 8 moments; 85 of 100 labels, as arrows may nearly coincide."""
    path = built.ROOT / "assignments" / f"{name}.yaml"
    page = made(path, built.own_language(path))
    for width in (1280, 390):
        browser.show(page.file, width=width, still=True)
        found: list[Any] = browser.run(SEEN, [45.0 * n for n in range(8)])
        labels: list[bool] = []
        for stages in found:
            for key, arrows, size in stages:
                assert size >= READABLE - 0.05, (width, key, size)
                labels += [belongs(number, edges, arrows) for number, _, edges in arrows if edges]
        assert sum(labels) >= 0.85 * len(labels), (width, sum(labels), len(labels))
    browser.leave()


@proof
def test_letters_of_a_form_are_measured_in_their_own_font(browser: Browser, tmp_path: Path) -> None:
    """Also those measured first, before the server has said anything: no label is far from its arrow."""
    (file := tmp_path / "mine.yaml").write_text(catalogue.sample("shaper", "en"), encoding="utf-8")
    with edited(file, opener(), "en") as server:
        browser.show(server.address, width=1280, height=800, still=True)
        for stages in browser.run(SEEN, [30, 200]):
            for key, arrows, size in stages:
                assert size >= READABLE - 0.05, (key, size)
                for number, ends, edges in arrows:
                    assert not edges or distance(edges, ends) <= 2 * READABLE, (key, number)
        browser.leave()


@proof
def test_labels_stay_while_the_machine_moves(browser: Browser) -> None:
    """Over a sixth of a turn in steps of a degree, a label takes another place a few times at most."""
    path = built.ROOT / "assignments" / "linkage-8.yaml"
    browser.show(made(path, built.own_language(path)).file, width=1280, still=True)
    found: list[Any] = browser.run(SEEN, list(range(60)))
    before: dict[tuple[str, str], list[float]] = {}
    jumps, labels = 0, set()
    for stages in found:
        for key, arrows, _ in stages:
            for number, _, edges in arrows:
                if edges:
                    was = before.get((key, number), edges)
                    jumps += abs(was[0] - edges[0]) + abs(was[1] - edges[1]) > JUMP
                    before[key, number] = edges
                    labels.add((key, number))
    browser.leave()
    assert jumps <= 6 * len(labels), (jumps, len(labels))


def test_an_arrow_over_a_letter_is_apart_from_it() -> None:
    """It has a head of its own, and white below it: “v” under an arrow must not look like “τ”."""
    letter = Symbol("v", "B", over="vector")
    drawn = Painter("en", Pens()).label(Label(0j, letter, size=SMALL))
    base = float(re.findall(r'<text[^>]* y="([-\d.]+)"', drawn)[0])
    (path,) = re.findall(r'<path[^>]* d="([^"]+)"', drawn)
    heights = [base - float(y) for _, y in re.findall(r"([-\d.]+) ([-\d.]+)", path)]
    em, letters = SMALL * POINT, box(Symbol("v", "B"), SMALL).height
    assert min(heights) - letters > 0.07 * em
    assert max(heights) - min(heights) > 0.2 * em
