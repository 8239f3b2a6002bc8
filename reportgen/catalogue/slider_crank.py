"""The slider-crank, with its guide through the crank centre or beside it.

Ground 0, crank 1 (AB), rod 2 (BC, mass centre S2), slider 3 (at C).
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator

from reportgen.assignment.checks import of_parameters, one_of
from reportgen.assignment.common import Assignment
from reportgen.assignment.fields import Angle, FoundCoordinate, FoundLength, Share
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.catalogue import given_loads
from reportgen.catalogue.crank_sliders import (
    CENTRE_PLANS,
    OFFSET_PLANS,
    OffsetSlider,
    compared,
    loop_equations,
    offset_slider,
)
from reportgen.catalogue.driven_machine import KindSections, driven
from reportgen.catalogue.found_lengths import LengthSearch, WantedStroke, find_slider_crank, slider_search
from reportgen.catalogue.given_data import MIDDLE, GivenData, cycle_angles
from reportgen.catalogue.parameters import Driven
from reportgen.machine.analysis import Machine
from reportgen.machine.load_laws import TableLaw
from reportgen.machine.loads import Applied, fixed

TURNS = 1
LENGTHS_OF_PARTS = ("r", "l", "e")


class Parameters(Driven, masses=(2, 3), moments=(2,), centres=(2,), loads=("force",)):
    """Lengths, the guide, the speed; a moving link has mass only if it is given.

    r, l and e may be found from the `stroke` that they are to give the slider.
    """

    r: FoundLength
    l: FoundLength  # noqa: E741 - the length's own letter
    e: FoundCoordinate = Given(0.0, 0.0, "mm", "0 mm")
    stroke: WantedStroke | None = None
    guide: Angle = Given(0.0, 0.0, "deg", "0 deg")
    s: Share | None = None
    force: given_loads.WorkingForce | None = None

    @property
    def search(self) -> LengthSearch:
        """The search for the lengths that are not given."""
        return slider_search(self.stroke, self.r, self.l, self.e)


@of_parameters
def _check_turning(given: Parameters) -> Iterator[Finding]:
    """Yield faults unless the crank turns fully: l > r + |e|, or the requested stroke gives the lengths."""
    yield from given.search.findings()
    if given.r is None or given.l is None or given.e is None:
        return
    if given.l.si <= given.r.si + abs(given.e.si):
        least = f"> r + |e| = {(given.r.si + abs(given.e.si)) * 1e3:g} mm"
        yield Finding("out-of-range", ("parameters", "l"), {"text": given.l.text, "range": least})


CHECKS = (one_of("parameters", "s", "S2", required=False), *given_loads.FORCE_CHECKS, _check_turning)


def machine(assignment: Assignment) -> Machine:
    """Return the slider-crank of an assignment: linkage, working force, closed formulas."""
    given: Parameters = assignment.parameters
    positions, turn = assignment.positions, assignment.positions.sign
    q = GivenData(given)
    has_centre = bool(given.s or q.centre_of(2)) or any(q.of_link(letter, 2) for letter in "GmJ")
    for key, id in {"r": "l.AB", "l": "l.BC", "e": "e"}.items():
        length: Given | None = getattr(given, key)
        if length is not None and (length.si or id != "e"):
            q.datum(id, length, from_part=assignment.key_of_part(key))
    if given.stroke is not None:
        find_slider_crank(q, given.stroke, given.search)
    r, l, e = q["l.AB"], q["l.BC"], q.find("e")  # noqa: E741
    if given.guide.si:
        q.datum("guide.angle", given.guide, "α", "angle")
    q.speed()
    q.drawn("A", "B", assignment.drawing.crank)
    q.set_out("rod")
    if has_centre and not q.centre_beside(2, "B", "C", lines="rod"):
        q.set_out("rod", q.define("l.BS2", q.give("s", MIDDLE if given.s is None else given.s.si) * l))
    if isinstance(given.force, given_loads.ConstantForce):
        q.datum("P.given", given.force.F, "P", "force")
    q.gravity()
    q.mass(2)
    m2 = q.find("m.2")
    q.moment(2, None if m2 is None else m2 * l**2 / 12)
    q.mass(3)
    q.set_out("loads", "s.3", "P3")

    geometry = OffsetSlider(q.si(r), q.si(l), 0.0 if e is None else turn * q.si(e), given.guide.si, turn)
    start = geometry.stretched if positions.first is None else geometry.phi(positions.first.si)
    centre = next((point.local for point in q.centre_points({2: "B"})), None)
    linkage = geometry.linkage(q.inertias({2: "S2", 3: "C"}), given.gravity, centre)
    if e is not None:
        q.fix("guide.3.at", geometry.line, e)
    course = geometry.course(start, TURNS)
    offset = None if e is None else e if turn > 0 else -e
    applied: tuple[Applied, ...] = ()
    if given.force is not None:
        outwards = fixed(cmath.rect(1.0, geometry.axis))
        applied = (Applied("P3", 3, "C", outwards, TableLaw(course, given.force.table, turns=TURNS)),)
    return driven(
        assignment,
        q,
        linkage,
        geometry.crank_angle(start),
        KindSections() if given.stroke is None else KindSections(sizes="synthesis"),
        formulas=lambda q: offset_slider(q, turn, start + cycle_angles(positions), offset, has_centre),
        applied=applied,
        sliders=(course,),
        paths=("S2",) if has_centre else (),
        compared=compared((*OFFSET_PLANS, *(CENTRE_PLANS if has_centre else ()))),
        equations=loop_equations(turn, offset is not None, given.acceleration),
        facts={
            "selected": given.search.selected_by,
            "form": "inline" if e is None else "offset",
            "stroke": given_loads.stroke_of(given.force),
            "centre": "share" if "s" in q else "place" if has_centre else "none",
        },
    )
