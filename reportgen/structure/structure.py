"""The kind `structure`: mobility, Assur groups and class of a mechanism, and the checks of its data."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from reportgen.assignment.checks import of_parameters
from reportgen.base.errors import Finding
from reportgen.structure import structure_file
from reportgen.structure.point_checks import of_points
from reportgen.structure.splitting import FRAME, StructureError, rigid_links, split
from reportgen.structure.structure_file import active

if TYPE_CHECKING:
    from reportgen.assignment import Assignment
    from reportgen.structure.structure_case import StructureCase

Parameters = structure_file.Parameters
TURNS = 1
PART = "structure"
"""Prefix of its ids, in a coursework too."""
HAS_POSITIONS = False
TOP = ("parameters",)
COUNTS: Mapping[str, str] = {"links": "n", "lower": "p₅", "higher": "p₄", "mobility": "W", "groups": "k", "class": "C"}
"""Symbols of the numbers that `solve` prints, by their names in the results."""


def case(assignment: Assignment) -> StructureCase:
    """Return the case of an assignment."""
    from reportgen.structure.structure_case import StructureCase

    return StructureCase(assignment)


def table_rows(position: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Return the rows of results that `solve` prints: the counts, class and order of each group, other drivers."""
    counts = position["structure"]
    rows = {
        "structure": {symbol: counts[name] for name, symbol in COUNTS.items() if name in counts},
        "groups": {f"C({group['links']})": group["class"] for group in position["groups"].values()},
    }
    if "drivers" in position:
        rows["drivers"] = {f"D_{link}": by["class"] for link, by in position["drivers"].items() if by}
    return rows


# --- checks ---------------------------------------------------------------------------------------


def check(given: Parameters) -> Iterator[Finding]:
    """Yield the faults of the pairs; without any, of the named links, then of the mechanism, then of the points."""
    yield from [*_of_pairs(given)] or [*_of_links(given)] or [*_of_mechanism(given)] or of_points(given)


def _of_pairs(given: Parameters) -> Iterator[Finding]:
    """Require different links in each pair, and no number left out."""
    for key in ("pairs", "higher"):
        for index, links in enumerate(getattr(given, key) or ()):
            repeated = [link for place, link in enumerate(links) if link in links[:place]]
            if repeated:
                yield Finding("repeated", (*TOP, key, index), {"text": str(repeated[0])})
    links = given.whole_chain.links
    absent = [link for link in range(1, max(links, default=0)) if link not in links]
    if absent:
        yield Finding("structure-no-pair", (*TOP, "pairs"), {"link": str(absent[0])})
    elif not any(FRAME in pair for pair in given.pairs):
        yield Finding("structure-no-pair", (*TOP, "pairs"), {"link": str(FRAME)})


def _of_links(given: Parameters) -> Iterator[Finding]:
    """Require a driver on the frame, rollers on one pin in contact with another link, and links that exist."""
    chain = given.whole_chain
    if given.driver not in chain.drivers:
        yield Finding("structure-driver", (*TOP, "driver"), {"link": str(given.driver)})
    for index, link in enumerate(given.passive or ()):
        if link not in chain.links or link == given.driver:
            yield Finding("structure-passive", (*TOP, "passive", index), {"link": str(link)})
    rest = active(chain, given.passive or ())
    for index, link in enumerate(given.rollers or ()):
        own = [joint for joint in rest.joints if link in joint.links]
        pins = [joint for joint in own if not joint.higher]
        if link == given.driver or len(pins) != 1 or len(own) == len(pins):
            yield Finding("structure-roller", (*TOP, "rollers", index), {"link": str(link)})


def _of_mechanism(given: Parameters) -> Iterator[Finding]:
    """Require that the driver determines the motion of every link, with no pair too many and no links in one body."""
    chain, added = given.needed_chain.with_lower_pairs()

    def named(links: Iterable[int]) -> dict[str, str]:
        texts = (f"{link} ({'–'.join(map(str, added[link]))})" if link in added else str(link) for link in links)
        return {"links": ", ".join(texts)}

    try:
        split(chain, given.driver)
    except StructureError as error:
        code = "structure-overdetermined" if error.overdetermined else "structure-loose"
        yield Finding(code, (*TOP, "pairs"), named(error.links))
    else:
        if rigid := rigid_links(chain):
            yield Finding("structure-rigid", (*TOP, "pairs"), named(rigid))


CHECKS = (of_parameters(check),)
