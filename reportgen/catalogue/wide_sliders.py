"""Sliders as wide as a file says: the face along which a guide holds them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from pydantic import Field

from reportgen.assignment.common import Part
from reportgen.assignment.fields import Coordinate
from reportgen.base.errors import Finding
from reportgen.base.units import Given
from reportgen.catalogue.declared_loads import listed
from reportgen.formula import Symbol, ids
from reportgen.machine import DRIVER, Crank, Linkage
from reportgen.machine.faces import Faces
from reportgen.machine.loads import carriers

Datum = Callable[[str, Given, Symbol | str, str], object]
"""Enters a quantity as typed on a sheet: its id, what is given, its symbol, its kind."""


class Face(Part):
    """The face of a slider from its pin along the guide, and how far below the pin it lies."""

    from_: Coordinate = Field(alias="from")
    to: Coordinate
    below: Coordinate = Given(0.0, 0.0, "mm", "0 mm")


def faults(faces: Mapping[int, Face], linkage: Linkage) -> Iterator[Finding]:
    """A face belongs to a slider on a guide that does not drive, and its ends are in their order."""
    sliders = carriers(linkage)
    for link, face in faces.items():
        where = ("parameters", "faces", str(link))
        if link == DRIVER and not isinstance(linkage.driver, Crank):
            yield Finding("faces-of-driver", where, at="key")
        elif link not in sliders:
            yield Finding("no-slider", where, {"text": str(link), "known": listed(sliders) or "–"}, at="key")
        elif face.from_.si >= face.to.si:
            yield Finding("face-turned", (*where, "to"), {"text": face.to.text, "from": face.from_.text})


def entered(faces: Mapping[int, Face], linkage: Linkage, datum: Datum) -> dict[int, Faces]:
    """The faces, whose data are entered; faulty ones, which the file's checks tell, are left out."""
    sliders, found = carriers(linkage), {}
    for link, face in faces.items():
        if link not in sliders or face.from_.si >= face.to.si:
            continue
        datum(ids.face_from(link), face.from_, "", "")
        datum(ids.face_to(link), face.to, "", "")
        if face.below.si:
            datum(ids.face_below(link), face.below, "", "")
        found[link] = Faces(face.from_.si, face.to.si, face.below.si)
    return found
