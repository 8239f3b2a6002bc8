"""What a page says, read from its source by a parser of its own: no browser is needed for that."""

from __future__ import annotations

from collections.abc import Iterator
from html.parser import HTMLParser

VOID = frozenset({"br", "mspace", "path", "circle", "rect", "input", "meta", "link", "wbr"})
APPLIED = "\N{FUNCTION APPLICATION}"


class Text(HTMLParser):
    """The text of a report's elements as print has it: items with their marks, roots with their sign.

    Left out is what prints are not compared in: cover, contents, names of the rows below a vector equation, and the
    arrows over vectors, which are accents in print.
    """

    def __init__(self, source: str) -> None:
        super().__init__()
        self.open: list[tuple[str, bool]] = []
        self.counts: list[int | None] = []
        self.parts: list[str] = []
        self.feed(source)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        if tag in VOID:
            return
        given = dict(attributes)
        if tag in ("ol", "ul"):
            self.counts.append(int(given.get("start") or 1) if tag == "ol" else None)
        skipped = tag in ("header", "nav") or (tag == "th" and given.get("scope") == "row")
        skipped |= tag == "mo" and bool(self.open) and self.open[-1][0] == "mover"
        self.open.append((tag, skipped))
        if tag == "li":
            self.say(self.mark())
        elif tag == "msqrt":
            self.say("√")

    def mark(self) -> str:
        """The mark of the next item of a list."""
        count = self.counts[-1]
        if count is None:
            return "–"
        self.counts[-1] = count + 1
        return f"{count}."

    def handle_endtag(self, tag: str) -> None:
        if tag in VOID:
            return
        assert self.open[-1][0] == tag, (self.open, tag)
        self.open.pop()
        if tag in ("ol", "ul"):
            self.counts.pop()

    def handle_data(self, data: str) -> None:
        self.say(data)

    def say(self, text: str) -> None:
        if not any(skipped for _, skipped in self.open):
            self.parts.append(text.replace(APPLIED, ""))

    @property
    def text(self) -> str:
        return "".join(self.parts)


def elements(source: str) -> Iterator[str]:
    """The names of the elements in a source, in order."""

    class Names(HTMLParser):
        found: list[str]

        def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
            self.found.append(tag)

    names = Names()
    names.found = []
    names.feed(source)
    yield from names.found
