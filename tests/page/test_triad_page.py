"""The page and the sheets of a press with a group of class III: the force plan is that of its four links."""

from __future__ import annotations

from functools import cache

from reportgen.cases import MachineCase, open_case
from reportgen.page.motion_samples import animation
from reportgen.sheets import drawing_sheets
from tests.report import built

PRESS = built.ROOT / "assignments" / "linkage" / "press-class-iii.yaml"


@cache
def press() -> MachineCase:
    case = open_case(PRESS, "en")
    assert isinstance(case, MachineCase)
    return case


def test_the_page_names_the_group_by_its_four_links() -> None:
    titles = {pane.key: pane.title for pane in animation(press()).panes}
    assert titles["R2345"] == "Force plan of group (2, 3, 4, 5)"
    assert titles["R67"] == "Force plan of group (6, 7)"


def test_the_sheets_draw_the_force_plan_of_four_links() -> None:
    parts = [part for sheet in drawing_sheets(press(), "A1") for part in sheet.parts]
    heads = {fact.values for part in parts for fact in part.scene.description if fact.phrase in ("plate", "line")}
    assert ("Group (2,3,4,5), position 2",) in heads
    assert ("Group (6,7), position 2",) in heads
