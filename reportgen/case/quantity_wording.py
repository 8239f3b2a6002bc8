"""Name each quantity in words and give its positive sense, for the rows of task, answer sheet and key.

The phrases ("normal acceleration of B about A") are in `words.yaml` under `quantities`, by the families of the
vocabulary.  A quantity that only one machine has, or that it names differently, has a phrase under its own id, or among
the names of the given data.  Senses are under `positive`, by ids, families and kinds; the most specific entry applies.
The words of a machine take precedence over the common ones.
"""

from __future__ import annotations

from collections.abc import Mapping
from string import Formatter
from typing import Any

from reportgen.base.placeholders import gaps
from reportgen.document import Inline, Inlines, Text
from reportgen.formula import Expression, Symbol, ids, refs, vocabulary
from reportgen.formula.ledger import Ledger

MAGNITUDE = "magnitude"
"""Marker used instead of a phrase if the sign of a quantity has no meaning."""
FORMULA, EITHER_SIGN = "formula", "formula, either sign"
"""Markers for a quantity defined by its formula; with the second, the opposite sign is also allowed."""
BY_FORMULA, OPEN = frozenset({FORMULA, EITHER_SIGN}), frozenset({MAGNITUDE, EITHER_SIGN})


def phrase(id: str, ledger: Ledger, words: Mapping[str, Any]) -> str:
    """Return the name of a quantity in words, without a capital; "" if the words have no phrase for it."""
    if given := words.get("given", {}).get(id):
        return _uncapitalised(str(given))
    phrases: Mapping[str, str] = words["quantities"]
    symbol, kind = (ledger[id].symbol, ledger[id].kind) if id in ledger else (_symbol(id), "")
    vector = vocabulary.vector_of(id)
    _, parts = vocabulary.wording(id, symbol)
    of = phrase(vector, ledger, words) if vector else ""
    bodies = {name: _body(parts[link], phrases) for name, link in (("body", "link"), ("onto", "other"))}
    wording = next(vocabulary.words_of(phrases, id, kind, symbol), "")
    return wording.format(**parts, **bodies, of=of)


def _body(link: str, phrases: Mapping[str, str]) -> str:
    """Return the phrase for a link, or for the frame if `link` is "0"."""
    return str(phrases["frame"]) if link == "0" else str(phrases["link"]).format(link=link)


def _uncapitalised(text: str) -> str:
    """Return a name of the given data in the form for a sentence; one that begins with an abbreviation is unchanged."""
    return text if text[1:2].isupper() else text[:1].lower() + text[1:]


def _symbol(id: str) -> Symbol:
    """Return the symbol of a vector that has no separate row."""
    try:
        return vocabulary.symbol(id)
    except KeyError:
        return Symbol("")


# --- senses ----------------------------------------------------------------------------------------


def positive_sense(id: str, ledger: Ledger, words: Mapping[str, Any], ways: Mapping[str, str] | None = None) -> str:
    """Return the phrase for the positive sense of a quantity, or a marker such as `MAGNITUDE`; "" without words.

    `ways` gives the positive direction of the motion of sliders, by their points.
    """
    family = ledger[id]
    known = _points(id, ledger) | _sliding_sense(id, ways or {})
    for phrase in vocabulary.words_of(words["positive"], id, family.kind, family.symbol):
        # A phrase is skipped if it has a placeholder that this quantity cannot fill.
        if gaps(phrase) <= known.keys():
            return phrase.format(**known)
    return ""


def _points(id: str, ledger: Ledger) -> dict[str, str]:
    """Return the ends and the letters of the rod or slot that defines a projection or an assumed sense."""
    along, component = ids.projection.read(id), ids.reaction.read(id)
    if component and (assumed := ids.assumed(ids.reaction_force.of(component))) in ledger:
        (direction, *_) = refs(definition_of(ledger, assumed))
        along = ids.rod.read(direction) or ids.slot.read(direction)
    if along is None or (rod := ids.rod(along["link"])) not in ledger:
        return {}
    end, start = (vocabulary.lowered(_point(place)) for place in refs(definition_of(ledger, rod)))
    return {"start": start, "end": end, "line": f"{start}{end}"}


def _point(id: str) -> str:
    """Return the name of the point whose place has this id."""
    names = ids.place.read(id)
    assert names is not None, f"{id} is no place"
    return names["point"]


def definition_of(ledger: Ledger, id: str) -> Expression:
    definition = ledger[id].definition
    assert definition is not None, f"{id} is constructed from nothing"
    return definition


def _sliding_sense(id: str, ways: Mapping[str, str]) -> dict[str, str]:
    """Return the positive direction of a slider's motion, in words."""
    names = ids.formula_velocity.read(id) or ids.formula_acceleration.read(id)
    return {"way": ways[names["point"]]} if names and names["point"] in ways else {}


# --- sentences ---------------------------------------------------------------------------------------


def sentence(words: str, /, **parts: Inline | str) -> Inlines:
    """Return a phrase with texts and inlines in place of its placeholders."""
    result: list[Inline] = []
    for text, name, _, _ in Formatter().parse(words):
        result += [Text(text)] if text else []
        if name:
            part = parts[name]
            result.append(Text(part) if isinstance(part, str) else part)
    return tuple(result)
