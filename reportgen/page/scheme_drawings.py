"""Draw the scheme of a kind for its card, without labels, which nobody could read there.

The program's kinds have their schemes in files, which `docs/schemes.py` writes. A machine of the user's folder is drawn
when its card is shown.
"""

from __future__ import annotations

from collections.abc import Sequence

from reportgen.base.template_folders import REFERENCE
from reportgen.case import MachineAnalysis
from reportgen.drawing import Circle, Item, Label, Scene
from reportgen.drawing.geometry import bounds, frame, moved
from reportgen.page.kind_cards import CardDrawing
from reportgen.page.svg_elements import Painter, Pens
from reportgen.report import mechanism_figures
from reportgen.report.context import ReportContext

MARGIN = 1.0
"""Room around a drawing (mm), for the width of its lines."""
LARGEST = 4.0
"""Largest radius of a circle around a label (mm)."""


def machine_scheme(case: MachineAnalysis) -> Scene:
    """Return the kinematic scheme in the report of a machine, without composing the report."""
    return mechanism_figures.scheme(ReportContext(case)).scenes[0]


def card_drawing(kind: str, scene: Scene) -> CardDrawing:
    """Return a scene as the drawing on the card of a kind, without its labels and the circles around them."""
    labels = [frame(item)[0] for item in scene.items if isinstance(item, Label)]
    items = [item for item in scene.items if not isinstance(item, Label) and not _is_around(item, labels)]
    low, high = bounds(items)
    pens, size = Pens(f"{kind.replace('/', '-')}-"), high - low + complex(2 * MARGIN, 2 * MARGIN)
    moved_items = (moved(item, complex(MARGIN, MARGIN) - low) for item in items)
    elements = Painter(REFERENCE, pens).items(moved_items, size.imag)
    return CardDrawing(f"0 0 {size.real:.1f} {size.imag:.1f}", pens.rules(), elements)


def _is_around(item: Item, places: Sequence[complex]) -> bool:
    """Return True for the circle around one of the labels at these places."""
    if not isinstance(item, Circle) or item.radius > LARGEST:
        return False
    return any(abs(item.centre - place) < item.radius / 2 for place in places)
