"""What a form offers to mend a fault: read from its HTML, as a browser would find it."""

from __future__ import annotations

import json
from html.parser import HTMLParser

from reportgen.base.errors import Where

VOID = {"input", "br", "path"}


class FormReader(HTMLParser):
    """The places of a form that have a field, a button, or a fault in the list above the fields."""

    def __init__(self, form: str) -> None:
        super().__init__()
        self.fields: set[Where] = set()
        self.mended: set[Where] = set()
        """Places with a button that removes, adds or rewrites something."""
        self.faults: list[Where] = []
        self.choices: dict[Where, list[str]] = {}
        self._open: list[tuple[str, dict[str, str | None]]] = []
        self.feed(form)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        about = dict(attributes)
        place = json.loads(about["data-w"] or "[]") if "data-w" in about else None
        if tag in ("input", "select") and place is not None:
            if "readonly" not in about:
                self.fields.add(tuple(place))
            self._around("field")["data-w"] = about["data-w"]
        if tag == "select" and place is not None:
            self.choices[tuple(place)] = []
        if tag == "option" and self._open[-1][0] == "select" and "data-w" in self._open[-1][1]:
            self.choices[tuple(json.loads(self._open[-1][1]["data-w"] or "[]"))].append(about.get("value") or "")
        if tag == "button" and about.keys() & {"data-remove", "data-remedy", "data-add", "data-name"}:
            self.mended.add(tuple(json.loads(self._around("field")["data-w"] or "[]")))
        if tag == "button" and "data-goto" in about:
            self.faults.append(tuple(json.loads(about["data-goto"] or "[]")))
        if tag not in VOID:
            self._open.append((tag, about))

    def handle_endtag(self, tag: str) -> None:
        while self._open and self._open.pop()[0] != tag:
            pass

    def _around(self, name: str) -> dict[str, str | None]:
        """Return the attributes of the field or the set of fields around what is being read."""
        return next(
            about
            for tag, about in reversed(self._open)
            if name in (about.get("class") or "").split() or tag == "fieldset"
        )

    @property
    def stuck(self) -> list[Where]:
        """The places of faults at which nothing can be changed, removed or added."""
        return [where for where in self.faults if not self._can_be_mended(where)]

    def _can_be_mended(self, where: Where) -> bool:
        while where and isinstance(where[-1], int) and where not in self.fields | self.mended:
            where = where[:-1]
        inner = any(field[: len(where)] == where for field in self.fields | self.mended)
        return bool(where) and (where in self.mended or inner)
