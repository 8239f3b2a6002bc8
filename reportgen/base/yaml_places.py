"""Find the places of entries in a YAML text: lines, columns, ends, and the text of an entry in braces."""

from __future__ import annotations

import re
from collections.abc import Iterator

from reportgen.base.yaml_source import MappingNode, Node, SequenceNode, Source, Span, read_own, read_text

BRACKETS = 2000
"""A text with fewer brackets is not set in itself deeper than any reader bears."""

_MARK = re.compile(r"  # (?P<mark>[a-z_]+: [^#\r\n]*[^#\s])$")
"""Pattern of the mark behind an entry that is set aside: the choice that it belongs to, `# by: constant`."""


def read_nodes(text: str) -> Source:
    """Return the nodes of a text, by libyaml, which takes a tenth of the time, unless it may be deeply nested."""
    return read_own(text) if text.count("[") + text.count("{") < BRACKETS else read_text(text)


def is_flow(text: str, node: Node) -> bool:
    return text[node.span[0] : node.span[0] + 1] in ("[", "{")


def entry_start(above: Node, step: str | int, node: Node) -> int:
    """Return the index at which an entry begins: that of its key, or of the item."""
    entry = above.find(step) if isinstance(above, MappingNode) else None
    return entry[0].span[0] if entry else node.span[0]


def line_start(text: str, index: int) -> int:
    return text.rfind("\n", 0, index) + 1


def line_end(text: str, index: int) -> int:
    """Return the index at which the next line begins."""
    end = text.find("\n", index)
    return len(text) if end < 0 else end + 1


def lines_from(text: str, start: int) -> Iterator[Span]:
    """Yield begin and end of each line from the start of one on."""
    while start < len(text):
        end = line_end(text, start)
        yield start, end
        start = end


def column(text: str, start: int, end: int) -> int:
    """Return the number of blanks with which a line begins."""
    return end - start - len(text[start:end].lstrip(" "))


def column_of(text: str, index: int) -> int:
    """Return the column of an index, from 0."""
    return index - line_start(text, index)


def content_end(text: str, index: int) -> int:
    """Return the end of the content before an index, without the line break behind a text in block form."""
    return index - len(text[:index]) + len(text[:index].rstrip("\r\n"))


def behind(text: str, index: int, depth: int) -> int:
    """Return the start of the line after an entry that ends at an index, after comments indented deeper than the entry.

    Such comments belong to the table in the entry, as `# G3: 200 N` below the last of the `parameters`.
    """
    end = line = line_end(text, content_end(text, index))
    while line < len(text):
        following = line_end(text, line)
        bare = text[line:following].strip()
        if bare and not (bare.startswith("#") and text.index("#", line) - line > depth):
            break
        line = following
        if bare:
            end = line
    return end


def newline(text: str) -> str:
    return "\r\n" if "\r\n" in text else "\n"


def ends_in_braces(above: MappingNode | SequenceNode) -> int:
    """Return where the last entry in brackets ends, or where the first one would begin."""
    if isinstance(above, SequenceNode):
        return above.items[-1].span[1] if above.items else above.span[0] + 1
    key, value = above.entries[-1] if above.entries else (None, None)
    return max(key.span[1], value.span[1]) if key and value else above.span[0] + 1


def more_in_brackets(text: str, last: int, tail: str) -> list[str]:
    """Return what comes before one more entry in brackets, and after it, instead of the `tail` after the last one.

    The last entry begins at the index `last`. A comment after it stays in its line.
    """
    if "#" not in tail:
        return [", ", tail]
    cut = tail.rindex("\n")
    body = tail[:cut].removesuffix("\r")
    comma = "," if without_comma(body) == body else ""
    return [f"{comma}{body}{newline(text)}{' ' * column_of(text, last)}", tail[len(body) :]]


def without_in_braces(text: str, above: MappingNode | SequenceNode, step: str | int) -> str:
    """Return the text without an entry in brackets and without the comma beside it."""
    if isinstance(above, MappingNode):
        spans = [(key.span[0], max(value.span[1], key.span[1])) for key, value in above.entries]
        index = [key.text for key, _ in above.entries].index(str(step))
    else:
        spans, index = [item.span for item in above.items], int(step)
    start, end = spans[index]
    opening, closing = above.span[0] + 1, above.span[1] - 1
    before = spans[index - 1][1] if index else opening
    after = spans[index + 1][0] if index + 1 < len(spans) else closing
    if "#" in text[before:start] or "#" in text[end:after]:
        # Comments stay; the comma that goes is that after the entry, or that before the last one.
        left, right = text[before:start], text[end:after]
        if index + 1 < len(spans):
            right = without_comma(right)
        elif index:
            left = without_comma(left)
        return text[:before] + left + right + text[after:]
    if index + 1 < len(spans):
        return text[:start] + text[after:]
    return text[:before] + text[closing:]


def without_comma(between: str) -> str:
    """Return the text between two entries without its comma, which is no comma of a comment."""
    comma = re.match(r"(?:#[^\n]*|[^#,])*", between)
    end = comma.end() if comma else 0
    return between[:end] + between[end + 1 :]


def unmarked(line: str) -> tuple[str, str]:
    """Return the line of an entry that is a comment, without its mark, and the mark; "" if it has none."""
    match = _MARK.search(line)
    return (line[: match.start()], match["mark"]) if match else (line, "")
