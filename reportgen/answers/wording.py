"""What each quantity is, in words: "normal acceleration of B about A", for the rows of task, sheet and key.

The phrases stand in `words.yaml` under `quantities`, by the families of the vocabulary; a quantity that a machine
has for itself, or calls by another name, stands there by its own id, or among the names of the given data.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from reportgen.ledger.core import Ledger
from reportgen.notation import vocabulary
from reportgen.notation.expressions import Symbol


def phrase(id: str, ledger: Ledger, words: Mapping[str, Any]) -> str:
    """What a quantity is, without a capital; "" where the words have no phrase for it."""
    phrases: Mapping[str, str] = words["quantities"]
    own = words.get("given", {}).get(id) or phrases.get(id)
    if own:
        return _uncapitalised(str(own))
    shown = ledger[id].symbol if id in ledger else _symbol(id)
    name, parts = vocabulary.wording(id, shown)
    if name not in phrases:
        return ""
    vector = vocabulary.vector_of(id)
    of = phrase(vector, ledger, words) if vector else ""
    bodies = {name: _body(parts[link], phrases) for name, link in (("body", "link"), ("onto", "other"))}
    return str(phrases[name]).format(**parts, **bodies, of=of)


def _body(link: str, phrases: Mapping[str, str]) -> str:
    """A link, or the frame, as what acts or is acted on."""
    return str(phrases["frame"]) if link == "0" else str(phrases["link"]).format(link=link)


def capitalised(text: str) -> str:
    """A phrase as it stands at the head of a row."""
    return text[:1].upper() + text[1:]


def _uncapitalised(text: str) -> str:
    """A name of the given data as it stands in a sentence; what begins with an abbreviation stays."""
    return text if text[1:2].isupper() else text[:1].lower() + text[1:]


def _symbol(id: str) -> Symbol:
    """The symbol of a vector that has no row of its own."""
    try:
        return vocabulary.symbol(id)
    except KeyError:
        return Symbol("")
