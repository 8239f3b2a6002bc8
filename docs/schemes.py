"""Draw the scheme of each kind, which the form shows when a user chooses a kind.

    python docs/schemes.py

writes the drawings to `templates/frames/schemes/`. `tests/page/test_first_view.py` compares them with new drawings.
"""

from __future__ import annotations

from collections.abc import Sequence

from reportgen import catalogue
from reportgen.base.kinds import kinds
from reportgen.base.template_folders import REFERENCE, samples
from reportgen.cases import open_case
from reportgen.document import Document, Figure
from reportgen.drawing import Circle, Item, Label, Scene
from reportgen.drawing.geometry import bounds, frame, moved
from reportgen.page.kind_cards import scheme_file
from reportgen.page.svg_elements import Painter, Pens

SCHEMES = ("fig.scheme", "fig.velocity", "fig.inversion", "fig.mesh", "fig.diagram", "fig.construction")
"""The figure that shows a machine, the system of an exercise, a cam, gears in mesh, a diagram, or a construction."""
MARGIN = 1.0
"""Room around a drawing (mm), for the width of its lines."""
LARGEST = 4.0
"""Largest radius of a circle around a label (mm)."""
SHOWN = {
    "plane-motion": "plane-motion/17.yaml",
    "cam": "cam/roller-01.yaml",
    "gear-pair": "gears/pair-centre-distance.yaml",
    "planetary-train": "gears/train-double.yaml",
    "rotor": "rotor/rotor-two-planes.yaml",
    "engine-balance": "engine-balance/v-six.yaml",
    "turning-moment": "turning-moment/curve.yaml",
    "structure": "structure/class-three.yaml",
    "synthesis": "synthesis/slider-crank-by-offset.yaml",
}
"""Examples that show more of their kind than its smallest one."""


def scene_of(kind: str) -> Scene:
    """Return the scheme of a kind's example."""
    smallest = min(catalogue.examples(kind).values(), key=lambda path: path.stat().st_size)
    return scheme_in(open_case(samples() / SHOWN.get(kind, smallest), REFERENCE).document())


def scheme_in(document: Document) -> Scene:
    """Return the scheme in a report."""
    figure = next(block for block in document.blocks if isinstance(block, Figure) and block.key in SCHEMES)
    return figure.scenes[0]


def drawn(kind: str) -> str:
    """Return the scheme of a kind as a file: its rules, in the colours of the page, and its elements.

    It has no labels, nor the circles around them, which nobody could read on a card.
    """
    return as_file(kind, scene_of(kind))


def as_file(kind: str, drawn: Scene) -> str:
    """Return a scheme of a kind as a file."""
    scene = drawn.items
    labels = [frame(item)[0] for item in scene if isinstance(item, Label)]
    items = [item for item in scene if not isinstance(item, Label) and not _is_around(item, labels)]
    low, high = bounds(items)
    pens, size = Pens(f"{kind.replace('/', '-')}-"), high - low + complex(2 * MARGIN, 2 * MARGIN)
    moved_items = (moved(item, complex(MARGIN, MARGIN) - low) for item in items)
    elements = Painter(REFERENCE, pens).items(moved_items, size.imag).replace("><", ">\n<")
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size.real:.1f} {size.imag:.1f}">\n'
        f"<style>{pens.rules()}</style>\n{elements}\n</svg>\n"
    )


def _is_around(item: Item, places: Sequence[complex]) -> bool:
    """Return True for the circle around one of the labels at these places."""
    if not isinstance(item, Circle) or item.radius > LARGEST:
        return False
    return any(abs(item.centre - place) < item.radius / 2 for place in places)


def main() -> None:
    """Write the scheme of every kind."""
    for kind in kinds():
        file = scheme_file(kind)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(drawn(kind), encoding="utf-8")


if __name__ == "__main__":
    main()
