"""What each quantity is, in words, and which sense of it counts as positive, for the rows of task, sheet and key.

The phrases ("normal acceleration of B about A") stand in `words.yaml` under `quantities`, by the families of the
vocabulary; a quantity that a machine has for itself, or calls by another name, stands there by its own id, or among
the names of the given data.  Those of the senses stand under `positive`, by patterns of kind and id, of which the
first that fits decides; those of a machine come before the common ones.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from reportgen.document.equations import heading_words
from reportgen.document.report import Report
from reportgen.ledger.core import Ledger
from reportgen.notation import vocabulary
from reportgen.notation.expressions import Expression, Symbol, refs

MAGNITUDE = "magnitude"
"""Stands in place of a phrase where the sign of a quantity says nothing."""


def phrase(id: str, ledger: Ledger, words: Mapping[str, Any]) -> str:
    """What a quantity is, without a capital; "" where the words have no phrase for it."""
    phrases: Mapping[str, str] = words["quantities"]
    # A sliding driver is balanced by a force, which has the ids of the torque.
    kind = f":{ledger[id].kind}" if id in ledger else ""
    own = words.get("given", {}).get(id) or phrases.get(f"{id}{kind}") or phrases.get(id)
    if own:
        return _uncapitalised(str(own))
    shown = ledger[id].symbol if id in ledger else _symbol(id)
    name, parts = vocabulary.wording(id, shown)
    name = f"{name}{kind}" if f"{name}{kind}" in phrases else name
    if name not in phrases:
        return ""
    vector = vocabulary.vector_of(id)
    of = phrase(vector, ledger, words) if vector else ""
    bodies = {name: _body(parts[link], phrases) for name, link in (("body", "link"), ("onto", "other"))}
    return str(phrases[name]).format(**parts, **bodies, of=of)


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
    for pattern, phrase in report.words["positive"].items():
        if re.fullmatch(pattern, f"{family.kind} {id}"):
            try:
                return str(phrase).format(**known)
            except KeyError:
                # It speaks of something that this quantity has not.
                continue
    return ""


def _points(id: str, ledger: Ledger) -> dict[str, str]:
    """Both ends, and the letters, of the rod or slot that a projection or an assumed sense goes by."""
    link = id.split(".")[2] if id.startswith("ic.along.") else ""
    assumed = ledger.known([f"assumed.{id.replace('.', '', 1)}"])
    if assumed:
        along = refs(_definition(ledger, assumed[0]))[0]
        link = along.partition(".")[2] if along.startswith(("rod.", "slot.")) else ""
    rod = f"rod.{link}"
    if rod not in ledger:
        return {}
    end, start = (vocabulary.lowered(point.removeprefix("p.")) for point in refs(_definition(ledger, rod)))
    return {"start": start, "end": end, "line": f"{start}{end}"}


def _definition(ledger: Ledger, id: str) -> Expression:
    definition = ledger[id].definition
    assert definition is not None, f"{id} is constructed from nothing"
    return definition


def _way(id: str, report: Report) -> dict[str, str]:
    """Where a slider's motion counts as positive, in words."""
    way = report.slider_senses.get(id.rpartition(".")[2])
    return {} if way is None else {"way": heading_words(report, float(np.degrees(np.angle(way))))}


def is_open(values: np.ndarray, sense: str) -> bool:
    """Whether the papers leave the sign of values open: there are negative ones, and no words about them."""
    return sense == MAGNITUDE or (not sense and bool(np.nanmin(values, initial=0.0) < 0))
