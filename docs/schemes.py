"""Draw the scheme of each kind, which the form shows when a user chooses a kind.

    python docs/schemes.py

writes the drawings to `templates/frames/schemes/`. `tests/page/test_first_view.py` compares them with new drawings.
"""

from __future__ import annotations

from reportgen import catalogue
from reportgen.base.kinds import kinds
from reportgen.base.template_folders import REFERENCE, samples
from reportgen.cases import open_case
from reportgen.document import Document, Figure
from reportgen.drawing import Scene
from reportgen.page.kind_cards import scheme_file
from reportgen.page.scheme_drawings import card_drawing

SCHEMES = ("fig.scheme", "fig.velocity", "fig.inversion", "fig.mesh", "fig.diagram", "fig.construction")
"""The figure that shows a machine, the system of an exercise, a cam, gears in mesh, a diagram, or a construction."""
SHOWN = {
    "slider-crank": "slider-crank-02.yaml",
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
    """Return the scheme of a kind as a file."""
    return as_file(kind, scene_of(kind))


def as_file(kind: str, scene: Scene) -> str:
    """Return a scene of a kind as a file: the rules of its pens, in the colours of the page, and its elements."""
    drawing = card_drawing(kind, scene)
    elements = drawing.elements.replace("><", ">\n<")
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{drawing.box}">\n'
        f"<style>{drawing.rules}</style>\n{elements}\n</svg>\n"
    )


def main() -> None:
    """Write the scheme of every kind."""
    for kind in kinds():
        file = scheme_file(kind)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(drawn(kind), encoding="utf-8")


if __name__ == "__main__":
    main()
