"""One template makes the ids of a family and reads them.

    velocity = Name("v.{point}")
    velocity("B") == "v.B"
    velocity.read("v.B") == {"point": "B"}
    "v.B" in velocity

A template is text with places, of which `PLACES` says what may stand in them; what is in brackets may be missing.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

PLACES: Mapping[str, str] = {
    # links and the forces between them
    "link": r"\d+",
    "number": r"\d+",
    "slider": r"\d|[A-Z][^.]*",
    "group": r"\d[\d,]*",
    "joint": r"\d[\d,]+|cb",
    "force": r"[A-Z][^.]*(?:\.[ntkrs])?",
    # points and what lies between them
    "point": r"[A-Z][^.]*",
    "about": r"[A-Z][^.]*",
    "line": r"[A-Z][^.]*",
    "to": r"[A-Z][^.]*",
    "relative": r"[A-Z][^.]*[A-Z][^.]*",
    "start": r"[a-z]\d*",
    "end": r"[a-z]\d*",
    # what of a quantity is meant
    "what": "[va]",
    "plan": "[lva]",
    "rate": "omega|eps",
    "axis": "[xy]",
    "part": "[ntkrs]",
    "slide": "[kr]",
    "letter": "[a-z]",
    "bound": "max|min",
    "stroke": "work|back",
    "method": "eq|vw",
    "figure": r"r|c|given|mean|mean\.positions|least|greatest|energy|difference",
    "matrix": "d?[AB]",
    # the rest of an id, whatever it is
    "corner": ".+",
    "edge": ".+",
    "id": ".+",
}
"""What may stand in a place, as a regular expression; in any other place one word without dots."""

_PLACE = re.compile(r"\{(\w+)\}")
_MAY_BE_MISSING = re.compile(r"\[(.*?)\]")


@dataclass(frozen=True)
class Name:
    """A family of ids, as a template: `R.{joint}[.{part}]` is R.12 as well as R.12.t."""

    text: str

    def __call__(self, *of: object) -> str:
        """The id with these words in its places.  Raises `KeyError` if they are too many or too few."""
        return self._forms[len(of)] % of

    def read(self, id: str) -> dict[str, str] | None:
        """What stands in the places of an id, "" in one that is missing; None for an id of another family."""
        found = self._pattern.fullmatch(id)
        return None if found is None else {name: text or "" for name, text in found.groupdict().items()}

    def __contains__(self, id: str) -> bool:
        return self._pattern.fullmatch(id) is not None

    def only(self, **words: str) -> Name:
        """The narrower family that has these words in these places."""
        return Name(_PLACE.sub(lambda place: words.get(place[1], place[0]), self.text))

    def of(self, words: Mapping[str, str]) -> str:
        """The id with these words in its places, as `read` gives them: a word that is "" leaves its place out."""
        return self(*(words[place] for place in _PLACE.findall(self.text) if words[place]))

    @cached_property
    def _forms(self) -> Mapping[int, str]:
        """What the words are put into, by their number: with what is in brackets and without."""
        texts = _MAY_BE_MISSING.sub("", self.text), _MAY_BE_MISSING.sub(r"\1", self.text)
        return {len(_PLACE.findall(text)): _PLACE.sub("%s", text) for text in texts}

    @cached_property
    def _pattern(self) -> re.Pattern[str]:
        def plain(text: str) -> str:
            return re.escape(text).replace(r"\[", "(?:").replace(r"\]", ")?")

        between, *places = _PLACE.split(self.text)
        parts = [plain(between)]
        for place, after in zip(places[::2], places[1::2], strict=True):
            parts += [f"(?P<{place}>{PLACES.get(place, '[^.]+')})", plain(after)]
        return re.compile("".join(parts))
