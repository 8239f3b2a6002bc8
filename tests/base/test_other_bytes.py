"""Random changes of YAML texts in different styles: everything outside the changed entry stays."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from reportgen import catalogue
from reportgen.base.errors import Location, Where
from reportgen.base.kinds import kinds
from reportgen.base.yaml_comments import remarks
from reportgen.base.yaml_edit import EditError, exchanged, with_value, without
from reportgen.base.yaml_remarks import restored, set_aside
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, plain, read_text
from reportgen.base.yaml_values import at
from tests.lanes import matrix

STYLES = """\
kind: x   # kind\t
a:
    deep:  # comment: with colon
        one: 1 mm        # one
        "two": '2, 5'    # it's quoted
        # three: 3
        row: [1,  2 ,
              3]  # row
        table: {p: 1,  # first
                q: , r: [ {s: 1}, {s: 2} ] }
    text: |
      a line # no comment
      another

    folded: several
      lines   # of text
list:
- by: x     # after a dash
  # set: aside
  size: 2
- {by: y, size: 3,}   # braces
-   by: z
    many:
    - 1
    - 2   # two
empty:
"quoted key": "a # b"
last: [x, y]"""
TEXTS = "5 mm", "", "a # b", "0,5", "x: y", "-", "{", "it's", "1e3", "null", "två"


def style(number: int) -> str:
    names = list(kinds())
    texts = [STYLES, *(catalogue.sample(name, "en") for name in names[:: len(names) // 4])]
    text = texts[number % len(texts)]
    return text.replace("\n", "\r\n") if number % 2 else text


def places(node: Node | None, where: Where = ()) -> Iterator[tuple[Where, Node]]:
    if isinstance(node, MappingNode):
        for key, value in node.entries:
            yield (*where, key.text), value
            yield from places(value, (*where, key.text))
    if isinstance(node, SequenceNode):
        for index, value in enumerate(node.items):
            yield (*where, index), value
            yield from places(value, (*where, index))


def comments(text: str) -> list[str]:
    """The comments of lines that no text in quotation marks or in a block reaches."""
    return [line.partition("#")[2].strip() for line in text.splitlines() if "#" in line and '"' not in line]


@pytest.mark.parametrize(("first", "count"), matrix([(0, 20), (20, 120)], [(0, 20)]))
def test_all_other_bytes_stay(first: int, count: int) -> None:
    refused = 0
    for seed in range(first, first + count):
        refused += changed_at_random(seed)
    assert refused <= count / 4


def changed_at_random(seed: int) -> bool:
    """Change a text once; return True if the change was refused."""
    chance = random.Random(seed)
    text = style(seed)
    top = read_text(text).top
    where, node = chance.choice(list(places(top)))
    value = Scalar(chance.choice(TEXTS), Location(""))
    value = Scalar("", Location(""), null=True) if not value.text else value
    table = at(top, where[:-1])
    try:
        match chance.choice(["set", "set", "add", "remove", "aside", "move"]):
            case "set":
                after = with_value(text, where, value)
                start, end = node.span
                end = start + len(text[start:end].rstrip("\r\n"))
                assert after.startswith(text[:start]), (seed, where)
                # An empty value takes the blank behind its colon.
                assert after.endswith(text[end:].lstrip(" ")), (seed, where)
            case "add":
                inner = where if isinstance(node, MappingNode) else where[:-1]
                if not isinstance(at(top, inner), MappingNode) and inner:
                    return False
                after = with_value(text, (*inner, "new"), value)
                assert is_within(text, after), (seed, inner)
            case "remove":
                after = without(text, where)
                fewer = is_within(after.replace("# ", ""), text.replace("# ", ""))
                # After a dash, the next entry moves up; the comment between them stays.
                assert fewer or is_a_line_less(text, after), (seed, where)
            case "aside" if isinstance(table, MappingNode) and len(table.entries) > 1:
                after = set_aside(text, where, "by: z")
                assert comments_kept(text, after), (seed, where)
                noted = [note for note in remarks(after, where[:-1]) if (note.key, note.mark) == (where[-1], "by: z")]
                assert len(noted) == 1, (seed, where)
                back = restored(after, where[:-1], noted[0], "by: z")
                assert plain(read_text(back).top) == plain(top), (seed, where)  # type: ignore[arg-type]
            case "move" if isinstance(node, SequenceNode) and len(node.items) > 1:
                after = exchanged(text, where, 0)
                assert sorted(after) == sorted(text), (seed, where)
                assert exchanged(after, where, 0) == text, (seed, where)
    except EditError:
        return True
    return False


def is_within(short: str, long: str) -> bool:
    """Return True if a text is another one with one piece more."""
    begin = 0
    while begin < len(short) and short[begin] == long[begin]:
        begin += 1
    return len(long) >= len(short) and short[begin:] == long[len(long) - len(short) + begin :]


def is_a_line_less(text: str, after: str) -> bool:
    before, lines = ([line.strip(" -\t") for line in one.splitlines()] for one in (text, after))
    return len(lines) == len(before) - 1 and all(before.count(line) >= lines.count(line) for line in lines)


def comments_kept(before: str, after: str) -> bool:
    there = " ".join(after.split())
    return all(" ".join(comment.split()) in there for comment in comments(before))
