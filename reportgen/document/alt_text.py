"""Text alternatives for figures, for readers who do not see the drawing: `figure_text`.

The PDF, the page and the Word file use the same text: number and caption, then the facts that the drawing states about
itself, at most `MOST` characters. If this leaves something out, the text names the table that has the rest.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby

from reportgen.base.units import Language
from reportgen.document import Figure, InlineMath, Inlines, Plate, Text, Words, plain
from reportgen.document.cjk_punctuation import set_out
from reportgen.drawing import Content, Description, Scene
from reportgen.drawing.drawing_description import Fact, PaperLength, Told
from reportgen.formula import Number, Symbol
from reportgen.formula.formula_layout import PRIMES, parted
from reportgen.formula.plain_text import Plain

MOST = 600
"""Largest number of characters of the text of a drawing."""
DECIMALS = 2
"""Decimals of a length on paper (mm)."""


class Spoken(Plain):
    """Formulas in a line for speech: an index or exponent follows its letter after a space."""

    def symbol(self, node: Symbol) -> str:
        letters, above = parted(node)
        behind = above.lstrip(PRIMES)
        primes = above[: len(above) - len(behind)]
        return " ".join(filter(None, (letters + primes, node.sub, behind)))


def figure_text(block: Figure | Plate, scene: Scene, words: Words, language: Language) -> str:
    """Return the text alternative of one drawing of a figure; only that of the first drawing has the caption."""
    first = not block.continues if isinstance(block, Plate) else scene is block.scenes[0]
    name = f"{words.figure} {block.number}".strip() if block.number else ""
    caption = _heard(block.caption, language) if first else words.continued if isinstance(block, Plate) else ""
    head = ". ".join(filter(None, (name, caption)))
    titled = ", ".join(filter(None, (head, scene.title)))
    phrase = words.phrases["rest-in-table" if block.rest else "rest-in-text"]
    rest = phrase.format(words.table, block.rest)
    return within(titled, sentences(scene.description, words.phrases, language), language, rest)


def sentences(description: Description, words: Mapping[str, str], language: Language) -> Iterator[str]:
    """Yield the facts of a drawing's description as sentences; a fact repeated in a row appears once.

    Raises `KeyError` for a phrase without words.
    """
    spoken = Spoken(language)
    for fact, _ in groupby(description):
        yield _phrase(fact, words, spoken)


def within(head: str, facts: Iterable[str], language: Language, rest: str = "") -> str:
    """Return head and facts joined to at most `MOST` characters; `rest` says where the omitted facts are."""
    kept, facts = [], list(facts)
    room = MOST - len(head) - 3
    whole = "; ".join(facts)
    if len(whole) <= room:
        kept = facts
    else:
        room -= len(rest) + 2
        for fact in facts:
            room -= len(fact) + 2
            if room < 0:
                break
            kept.append(fact)
        kept += [rest] if rest else []
    text = "; ".join(kept)
    joined = plain(set_out((Text(": ".join(filter(None, (head, text)))),), language), language)
    return joined if len(joined) < MOST else joined[: MOST - 1] + "…"


def _heard(inlines: Inlines, language: Language) -> str:
    spoken = Spoken(language)
    return "".join(
        spoken.math(inline.expression) if isinstance(inline, InlineMath) else plain((inline,), language)
        for inline in inlines
    )


def _phrase(fact: Fact, words: Mapping[str, str], spoken: Spoken) -> str:
    return " ".join(words[fact.phrase].format(*(_value(value, words, spoken) for value in fact.values)).split())


def _value(value: Told, words: Mapping[str, str], spoken: Spoken) -> str:
    match value:
        case PaperLength(length):
            return _content(Number(length, DECIMALS, "mm"), spoken)
        case tuple():
            return ", ".join(_content(one, spoken) for one in value)
    return _content(value, spoken)


def _content(content: Content, spoken: Spoken) -> str:
    return content if isinstance(content, str) else spoken.math(content)
