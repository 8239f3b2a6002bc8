"""Write other items into a list of a YAML text: `with_items`.  Items that stay keep their text, comments and spacing.

Old and new items are paired first. The list is then taken apart into items and what is between them, changed from its
end to its beginning, and put together again.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import Any

from reportgen.base.errors import Where
from reportgen.base.yaml_edit import EditError, replacement, with_value
from reportgen.base.yaml_places import (
    behind,
    column_of,
    is_flow,
    line_start,
    more_in_brackets,
    newline,
    read_nodes,
    without_comma,
)
from reportgen.base.yaml_source import MappingNode, Node, SequenceNode, Span, plain
from reportgen.base.yaml_values import at, flow, item_lines, put

MOST_COMPARED = 10_000
"""Largest number of pairs of items among which equal ones are searched for; further items are paired in order."""

Pair = tuple[int | None, int | None]
"""The numbers of an old item and of the new one in its place; None if there is none."""


def with_items(text: str, where: Where, value: SequenceNode) -> str:
    """Return the text with another list at a place, in which only items that differ change; raises `EditError`."""
    top = read_nodes(text).top
    old = at(top, where)
    if isinstance(old, SequenceNode) and isinstance(top, MappingNode) and old.items and value.items:
        try:
            start, end, new = _changed(text, old, value)
        except EditError:
            return with_value(text, where, value)
        changed = text[:start] + new + text[end:]
        read = read_nodes(changed).top
        if read is not None and plain(read) == plain(put(top, where, value)):
            return changed
    return with_value(text, where, value)


def _changed(text: str, old: Node, new: Node) -> tuple[int, int, str]:
    """Return begin and end of the text of a value, and its new text."""
    if isinstance(old, SequenceNode) and isinstance(new, SequenceNode) and old.items and new.items:
        pieces = _in_brackets(text, old) if is_flow(text, old) else _in_lines(text, old)
        following = len(old.items)
        for before, after in reversed(_pairs(old.items, new.items)):
            if before is None:
                assert after is not None, "a pair has an item"
                pieces.insert(following, new.items[after])
                continue
            following = before
            if after is None:
                pieces.delete(before)
            elif plain(old.items[before]) != plain(new.items[after]):
                pieces.replace(before, _changed(text, old.items[before], new.items[after]))
        return (*pieces.span, pieces.joined())
    return replacement(text, old, new)


def _pairs(old: Sequence[Node], new: Sequence[Node]) -> list[Pair]:
    """Return the pairs of old and new items, in the order of both: equal ones, others in the same place."""
    if len(old) == len(new):
        return [(index, index) for index in range(len(old))]
    a, b = ([_key(plain(item)) for item in items] for items in (old, new))
    first = next((index for index, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(len(a), len(b)))
    backwards = zip(reversed(a[first:]), reversed(b[first:]), strict=False)
    last = next((index for index, (x, y) in enumerate(backwards) if x != y), min(len(a), len(b)) - first)
    between, others = a[first : len(a) - last], b[first : len(b) - last]
    pairs: list[Pair] = [(index, index) for index in range(first)]
    for start, end, begin, until in _blocks(between, others):
        count = max(end - start, until - begin)
        here, there = _or_none(start + first, end + first, count), _or_none(begin + first, until + first, count)
        pairs += zip(here, there, strict=True)
    return pairs + [(len(a) - index, len(b) - index) for index in range(last, 0, -1)]


def _blocks(old: list[Any], new: list[Any]) -> list[tuple[int, int, int, int]]:
    """Return runs of old items with the runs of new ones in their place, which are equal or replace them."""
    if len(old) * len(new) > MOST_COMPARED:
        return [(0, len(old), 0, len(new))]
    return [block[1:] for block in SequenceMatcher(None, old, new, autojunk=False).get_opcodes()]


def _or_none(start: int, end: int, count: int) -> Iterator[int | None]:
    """Yield numbers from `start` to `end`, and then None until there are `count` in all."""
    yield from range(start, end)
    yield from [None] * (count - (end - start))


def _key(content: Any) -> Any:
    """Return a content that can be compared as part of a dictionary's key."""
    if isinstance(content, dict):
        return "table", *((key, _key(value)) for key, value in content.items())
    return ("list", *map(_key, content)) if isinstance(content, list) else content


@dataclass
class _Pieces(ABC):
    """The items of a list as texts, and the texts before, between and after them, one more than items."""

    text: str
    spans: list[Span]
    span: Span
    """Begin and end of everything."""

    def __post_init__(self) -> None:
        ends = [self.span[0], *(end for _, end in self.spans)]
        starts = [*(start for start, _ in self.spans), self.span[1]]
        self.items = [self.text[start:end] for start, end in self.spans]
        self.between = [self.text[start:end] for start, end in zip(ends, starts, strict=True)]

    def replace(self, index: int, change: tuple[int, int, str]) -> None:
        """Put the changed text of a value in place of an item that has not moved."""
        (start, end), (begin, until, new) = self.spans[index], change
        self.items[index] = self.text[start:begin] + new + self.text[until:end]

    def joined(self) -> str:
        first, *others = self.between
        return first + "".join(item + between for item, between in zip(self.items, others, strict=True))

    @abstractmethod
    def delete(self, index: int) -> None:
        """Take an item out, with its comma or its line."""

    @abstractmethod
    def insert(self, index: int, item: Node) -> None:
        """Put a new item before the one with an index."""


class _Bracketed(_Pieces):
    """The items of a list in brackets, which have commas between them."""

    def delete(self, index: int) -> None:
        left, right = self.between[index : index + 2]
        last = index == len(self.items) - 1
        if "#" in left or "#" in right:
            # Comments stay; the comma that goes is that after the item, or that before the last one.
            merged = without_comma(left) + right if last else left + without_comma(right)
        else:
            merged = right if last else left
        del self.items[index]
        self.between[index : index + 2] = [merged]

    def insert(self, index: int, item: Node) -> None:
        if index == len(self.items):
            self.between[index:] = more_in_brackets(self.text, self.spans[-1][0], self.between[index])
        else:
            inner = self.between[1:-1]
            lines = bool(inner) and all("\n" in between for between in inner)
            column = column_of(self.text, self.spans[-1][0])
            self.between.insert(index + 1, f",{newline(self.text)}{' ' * column}" if lines else ", ")
        self.items.insert(index, flow(item))


class _Lined(_Pieces):
    """The items of a list in block form: whole lines, with the comments that are deeper than the dash."""

    def delete(self, index: int) -> None:
        del self.items[index]
        self.between[index : index + 2] = ["".join(self.between[index : index + 2])]

    def insert(self, index: int, item: Node) -> None:
        dash = self.text.index("-", self.spans[0][0]) - self.spans[0][0]
        end = newline(self.text)
        if index and not self.items[index - 1].endswith("\n"):
            self.items[index - 1] += end
        self.items.insert(index, "".join(f"{line}{end}" for line in item_lines(item, dash)))
        # What is between two items stays before the second one.
        self.between.insert(index, "")


def _in_brackets(text: str, listed: SequenceNode) -> _Pieces:
    return _Bracketed(text, [item.span for item in listed.items], (listed.span[0] + 1, listed.span[1] - 1))


def _in_lines(text: str, listed: SequenceNode) -> _Pieces:
    """Return the lines of a list in block form; raises `EditError` if its items share lines with something else."""
    dash, spans = column_of(text, listed.span[0]), []
    for item in listed.items:
        start = line_start(text, item.span[0])
        if text[start : item.span[0]].rstrip(" ") != " " * dash + "-":
            raise EditError("otherwise")
        spans.append((start, behind(text, item.span[1], dash)))
    return _Lined(text, spans, (spans[0][0], spans[-1][1]))
