"""The section of a file with the widths of sliders: the faces along which they touch their guides."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Coordinate
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.catalogue.declared_loads import MOST_LOADS, Link, listed
from reportgen.catalogue.topic_sections import Opening, TopicData, TopicParameters, TopicSection
from reportgen.formula import ids
from reportgen.machine import DRIVER, Crank
from reportgen.machine.analysis import Machine
from reportgen.machine.loads import carriers
from reportgen.machine.shared_results import FACES
from reportgen.machine.slider_faces import Faces


class Face(Part):
    """The face of a slider from its pin along the guide, and how far below the pin it lies."""

    from_: Coordinate = Field(alias="from")
    to: Coordinate
    below: Coordinate = Given(0.0, 0.0, "mm", "0 mm")


def faults(parameters: TopicParameters, machine: Machine) -> Iterator[Finding]:
    """Yield faults unless a face belongs to a slider on a guide that does not drive, and its ends are in their
    order.
    """
    linkage, faces = machine.linkage, parameters.section("faces", dict) or {}
    sliders = carriers(linkage)
    for link, face in faces.items():
        where = ("parameters", "faces", str(link))
        if link == DRIVER and not isinstance(linkage.driver, Crank):
            yield Finding("faces-of-driver", where, at="key")
        elif link not in sliders:
            yield Finding("no-slider", where, {"text": str(link), "known": listed(sliders) or "–"}, at="key")
        elif face.from_.si >= face.to.si:
            yield Finding("face-turned", (*where, "to"), {"text": face.to.text, "from": face.from_.text})


def enter(opening: Opening) -> TopicData:
    """Enter the data of the faces; faulty ones, which the file's checks report, are left out."""
    faces, datum = opening.given.section("faces", dict) or {}, opening.datum
    sliders, entered = carriers(opening.linkage), dict[int, Faces]()
    for link, face in faces.items():
        if link not in sliders or face.from_.si >= face.to.si:
            continue
        datum(ids.face_from(link), face.from_, "", "")
        datum(ids.face_to(link), face.to, "", "")
        if face.below.si:
            datum(ids.face_below(link), face.below, "", "")
        entered[link] = Faces(face.from_.si, face.to.si, face.below.si)
    return TopicData(entered, provided={FACES.name: entered})


HOOKS = TopicSection(
    annotation=Annotated[dict[Link, Face], Field(max_length=MOST_LOADS)],
    default=Field(default_factory=dict),
    order=20,
    chapter="faces",
    place="groups",
    fits=lambda machine: bool(carriers(machine.linkage)),
    enter=enter,
    faults=faults,
)
