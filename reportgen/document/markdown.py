"""Parse Markdown with tokens for values into blocks of the tree: `blocks`, `inlines`.

The supported syntax is small on purpose: headings to level 4, paragraphs, emphasis, strong, line breaks, lists and page
breaks (`---`). Template functions make every other kind of block.
"""

from __future__ import annotations

import re
import secrets
from collections.abc import Iterator, Mapping, Sequence
from functools import cache, lru_cache
from itertools import accumulate
from pathlib import Path
from typing import cast, get_args

from markdown_it import MarkdownIt
from markdown_it.token import Token
from markdown_it.tree import SyntaxTreeNode

from reportgen import document as tree
from reportgen.base.errors import TemplateError
from reportgen.base.records import Record
from reportgen.base.words import of_file, word

SECRET = str(secrets.randbelow(10**18)).zfill(18)
"""A number drawn in every process, so that no user's text can imitate a mark or a token; it is never printed."""
TOKEN = re.compile(f"\ue000{SECRET}:(\\d+)\ue001")
"""A value's token in the Markdown text; its group is the index of the value."""


class SectionKey(Record):
    """The name of the section whose heading it ends."""

    name: str


class Unnumbered(Record):
    """A mark that excludes the section whose heading it ends from numbering."""


Emitted = tree.Inline | tree.Block | SectionKey | Unnumbered
TemplateLine = tuple[str, int]


class Rendered(Record):
    """Markdown with tokens: `values` and their `places` by index, `lines` the origin of every line."""

    text: str
    values: Sequence[Emitted]
    places: Mapping[int, TemplateLine]
    lines: Sequence[TemplateLine]


_BLOCKS = get_args(tree.Block)
_DEEPEST = 4
PARSED = 128
"""Number of parsed texts that are kept: a report has some 60, and those of another student differ in values only."""
MOST_NESTED = 12
"""Largest nesting of lists and other blocks; the parser itself reads no more than 20 levels."""

_UNKNOWN = {
    "code_inline": "inline code",
    "fence": "a code block",
    "link": "a link",
    "image": "an image",
    "html_inline": "HTML",
    "html_block": "HTML",
    "blockquote": "a quotation",
}


class _Piece(Record):
    """A value and the index of its token."""

    value: Emitted
    index: int


_Item = str | tree.Inline | _Piece
"""Item of a line being read: static text, an inline made of markup, or the value of a token."""


def blocks(rendered: Rendered) -> tuple[tree.Block, ...]:
    """Return the blocks of a rendered template; raise `TemplateError` for unsupported syntax."""
    root = _parsed(rendered.text)
    if isinstance(root, int):
        file, number = rendered.lines[root]
        raise TemplateError(f"{file}:{number}: {word('template_depth', of_file(Path(file)))}")
    return tuple(_Reader(rendered).blocks(root))


@lru_cache(maxsize=PARSED)
def _parsed(text: str) -> SyntaxTreeNode | int:
    """Return the tree of a text, or the line where it is nested deeper than allowed."""
    tokens = _parser().parse(text)
    line = _too_deep(tokens)
    return SyntaxTreeNode(tokens) if line is None else line


def _too_deep(tokens: Sequence[Token]) -> int | None:
    """Return the line with deeper nesting than allowed; None if there is none."""
    level = line = 0
    for token in tokens:
        line = token.map[0] if token.map else line
        level += token.nesting
        steps = (child.nesting for child in token.children or ())
        if level + max(accumulate(steps), default=0) > MOST_NESTED:
            return line
    return None


def inlines(rendered: Rendered) -> tree.Inlines:
    """Return the inlines of a rendered piece of one paragraph; raise `TemplateError` for anything else."""
    match blocks(rendered):
        case ():
            return ()
        case (tree.Paragraph(inlines=line),):
            return line
    file, line_number = rendered.lines[0]
    raise TemplateError(f"{file}:{line_number}: one line of words is wanted here")


@cache
def _parser() -> MarkdownIt:
    # HTML, links and the like are recognised, to be refused; what would change or swallow plainly
    # typed text (indented code, underlined headings, link definitions, entities) is not.
    parser = MarkdownIt("commonmark", {"html": True, "typographer": False, "linkify": False})
    return parser.disable(["code", "lheading", "reference", "entity"])


class _Reader(Record):
    rendered: Rendered

    # --- blocks

    def blocks(self, parent: SyntaxTreeNode) -> Iterator[tree.Block]:
        for node in parent.children:
            match node.type:
                case "paragraph":
                    yield from self.paragraph(node)
                case "heading":
                    yield self.section(node)
                case "bullet_list" | "ordered_list":
                    items = tuple(tuple(self.blocks(item)) for item in node.children)
                    yield tree.List(items, node.type == "ordered_list", int(node.attrs.get("start", 1)))
                case "hr":
                    yield tree.PageBreak()
                case kind:
                    raise self.fault(node, f"{_UNKNOWN.get(kind, kind)} is not in the vocabulary")

    def paragraph(self, node: SyntaxTreeNode) -> Iterator[tree.Block]:
        items = self.items(node)
        solid = [item for item in items if not (isinstance(item, str) and item.isspace())]
        if solid and all(isinstance(item, _Piece) and isinstance(item.value, _BLOCKS) for item in solid):
            yield from (cast(tree.Block, item.value) for item in solid if isinstance(item, _Piece))
        else:
            yield tree.Paragraph(self.inlines(items))

    def section(self, node: SyntaxTreeNode) -> tree.Section:
        level = int(node.tag[1:])
        if level > _DEEPEST:
            raise self.fault(node, f"a heading of level {level}; the deepest is {_DEEPEST}")
        items, key, numbered = self.items(node), "", True
        while items:
            match items[-1]:
                case _Piece(SectionKey(name)):
                    key = name
                case _Piece(Unnumbered()):
                    numbered = False
                case str(text) if text.isspace():
                    pass
                case _:
                    break
            items.pop()
        if items and isinstance(items[-1], str):
            items[-1] = items[-1].rstrip()
        return tree.Section(level, self.inlines(items), key, numbered)

    # --- inlines

    def inlines(self, items: list[_Item]) -> tree.Inlines:
        return tuple(self.inline(item) for item in items)

    def inline(self, item: _Item) -> tree.Inline:
        match item:
            case str(text):
                return tree.Text(text)
            case _Piece(SectionKey() | Unnumbered() as marker, index):
                name = type(marker).__name__.lower()
                raise self.fault_at(index, f"{name}(…) belongs at the end of a heading")
            case _Piece(value, index):
                if isinstance(value, _BLOCKS):
                    raise self.fault_at(index, f"a {type(value).__name__} stands within running text")
                return cast(tree.Inline, value)
        return item

    def items(self, node: SyntaxTreeNode) -> list[_Item]:
        """Return the items of a paragraph's, heading's or emphasis's line."""
        result: list[_Item] = []
        text = ""
        for child in node.children[0].children if node.type in ("paragraph", "heading") else node.children:
            match child.type:
                case "text":
                    text += child.content
                    continue
                case "softbreak":
                    text += " "
                    continue
            result += self.pieces(text)
            text = ""
            match child.type:
                case "em":
                    result.append(tree.Emph(self.inlines(self.items(child))))
                case "strong":
                    result.append(tree.Strong(self.inlines(self.items(child))))
                case "hardbreak":
                    result.append(tree.LineBreak())
                case kind:
                    raise self.fault(child, f"{_UNKNOWN.get(kind, kind)} is not in the vocabulary")
        return result + self.pieces(text)

    def pieces(self, text: str) -> list[_Item]:
        """Return a text cut at its tokens."""
        result: list[_Item] = []
        for i, part in enumerate(TOKEN.split(text)):
            if i % 2:
                result.append(_Piece(self.rendered.values[int(part)], int(part)))
            elif part:
                result.append(part)
        return result

    # --- faults

    def fault(self, node: SyntaxTreeNode, message: str) -> TemplateError:
        at: SyntaxTreeNode | None = node
        while at is not None and at.map is None:
            at = at.parent
        file, line = self.rendered.lines[at.map[0] if at is not None and at.map is not None else 0]
        return TemplateError(f"{file}:{line}: {message}")

    def fault_at(self, index: int, message: str) -> TemplateError:
        file, line = self.rendered.places[index]
        return TemplateError(f"{file}:{line}: {message}")
