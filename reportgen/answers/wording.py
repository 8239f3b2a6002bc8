"""What each quantity is, in words, and which sense of it counts as positive, for the rows of task, sheet and key.

The phrases ("normal acceleration of B about A") stand in `words.yaml` under `quantities`, by the families of the
vocabulary; a quantity that a machine has for itself, or calls by another name, stands there by its own id, or among
the names of the given data.  Those of the senses stand under `positive`, by ids, families and kinds, of which the
nearest decides; those of a machine come before the common ones.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from reportgen.document.equations import heading_words
from reportgen.document.report import Report
from reportgen.ledger.core import Ledger
from reportgen.notation import ids, vocabulary
from reportgen.notation.expressions import Expression, Symbol, refs

MAGNITUDE = "magnitude"
"""Stands in place of a phrase where the sign of a quantity says nothing."""


def phrase(id: str, ledger: Ledger, words: Mapping[str, Any]) -> str:
    """What a quantity is, without a capital; "" where the words have no phrase for it."""
    if given := words.get("given", {}).get(id):
        return _uncapitalised(str(given))
    phrases: Mapping[str, str] = words["quantities"]
    shown, kind = (ledger[id].symbol, ledger[id].kind) if id in ledger else (_symbol(id), "")
    vector = vocabulary.vector_of(id)
    _, parts = vocabulary.wording(id, shown)
    of = phrase(vector, ledger, words) if vector else ""
    bodies = {name: _body(parts[link], phrases) for name, link in (("body", "link"), ("onto", "other"))}
    found = next(vocabulary.words_of(phrases, id, kind, shown), "")
    return found.format(**parts, **bodies, of=of)


def _body(link: str, phrases: Mapping[str, str]) -> str:
    """A link, or the frame, as what acts or is acted on."""
    return str(phrases["frame"]) if link == "0" else str(phrases["link"]).format(link=link)


def _uncapitalised(text: str) -> str:
    """A name of the given data as it stands in a sentence; what begins with an abbreviation stays."""
    return text if text[1:2].isupper() else text[:1].lower() + text[1:]


def _symbol(id: str) -> Symbol:
    """The symbol of a vector that has no row of its own."""
    try:
        return vocabulary.symbol(id)
    except KeyError:
        return Symbol("")


# --- senses ----------------------------------------------------------------------------------------


def positive_sense(id: str, report: Report) -> str:
    """The phrase of a quantity, `MAGNITUDE`, or "" where no words say anything."""
    family, ledger = report.ledger[id], report.ledger
    known = _points(id, ledger) | _way(id, report)
    for phrase in vocabulary.words_of(report.words["positive"], id, family.kind, family.symbol):
        try:
            return phrase.format(**known)
        except KeyError:
            # It speaks of something that this quantity has not.
            continue
    return ""


def _points(id: str, ledger: Ledger) -> dict[str, str]:
    """Both ends, and the letters, of the rod or slot that a projection or an assumed sense goes by."""
    along, component = ids.projection.read(id), ids.reaction.read(id)
    if component and (assumed := ids.assumed(ids.reaction_force.of(component))) in ledger:
        (direction, *_) = refs(_definition(ledger, assumed))
        along = ids.rod.read(direction) or ids.slot.read(direction)
    if along is None or (rod := ids.rod(along["link"])) not in ledger:
        return {}
    end, start = (vocabulary.lowered(_point(place)) for place in refs(_definition(ledger, rod)))
    return {"start": start, "end": end, "line": f"{start}{end}"}


def _point(id: str) -> str:
    """The name of the point whose place it is."""
    found = ids.place.read(id)
    assert found is not None, f"{id} is no place"
    return found["point"]


def _definition(ledger: Ledger, id: str) -> Expression:
    definition = ledger[id].definition
    assert definition is not None, f"{id} is constructed from nothing"
    return definition


def _way(id: str, report: Report) -> dict[str, str]:
    """Where a slider's motion counts as positive, in words."""
    found = ids.formula_velocity.read(id) or ids.formula_acceleration.read(id)
    way = report.slider_senses.get(found["point"]) if found else None
    return {} if way is None else {"way": heading_words(report, float(np.degrees(np.angle(way))))}


def is_open(values: np.ndarray, sense: str) -> bool:
    """Whether the papers leave the sign of values open: there are negative ones, and no words about them."""
    return sense == MAGNITUDE or (not sense and bool(np.nanmin(values, initial=0.0) < 0))
