"""Descriptions of a machine's given quantities, for the table of given data: `given_names`."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any

from reportgen.document.template_rendering import subscripted
from reportgen.formula import ids
from reportgen.machine import Linkage, rods


def given_names(
    words: Mapping[str, Any], own: Mapping[str, Any], entered: Collection[str], linkage: Linkage
) -> Mapping[str, str]:
    """Return descriptions by the ids of given quantities.

    `own` are the facts of the machine, `entered` the ids that its ledger has.  A declared linkage describes its own
    quantities; a machine of the atlas has names for some of them.
    """
    if "quantities" not in own:
        names = dict(words.get("given", {}))
        beside = {**words["given_of_crank"], **dict(_centres(words, linkage)), **words["given_of_topics"]}
        further = {id: name for id, name in beside.items() if id not in names}
        # The acceleration of the crank follows its speed in the list.
        places = [*names].index("omega.1") + 1 if "omega.1" in names else len(names)
        ordered = list(names.items())
        return dict((*ordered[:places], *further.items(), *ordered[places:]))
    of_kind = words["linkage"]["given"]
    declared = {id: of_kind[what] + (subscripted(of) if what == "length" else of) for id, what, of in own["quantities"]}
    named = {id: name for id, name in of_kind.items() if id in entered and id not in declared}
    return {**declared, **own["called"], **named, **words["given_of_topics"]}


def _centres(words: Mapping[str, Any], linkage: Linkage) -> Iterator[tuple[str, str]]:
    """Yield the coordinates of mass centres in the frames of their links: ids and descriptions."""
    for link, (start, end) in rods(linkage).items():
        called = {"centre": subscripted(f"S{link}"), "start": subscripted(start), "end": subscripted(end)}
        for id, axis in ((ids.along_link, "along"), (ids.across_link, "across")):
            yield id(f"S{link}"), words["given_of_centres"][axis].format(**called)
