"""Bind many PDFs into one, with a bookmark at the first page of each, for printing the papers of a class."""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterator, Sequence
from contextlib import suppress

from reportgen.base.errors import TypesetterError
from reportgen.writers import typst_compiler
from reportgen.writers.typst_math import literal

_PACKED = re.compile(rb"/Type\s*/ObjStm\b.*?stream\r?\n", re.DOTALL)
_TREE = re.compile(rb"<<(?:[^<>]|<<[^<>]*>>)*/Type\s*/Pages\b(?:[^<>]|<<[^<>]*>>)*>>")
_COUNT = re.compile(rb"/Count\s+(\d+)")


def bound(parts: Sequence[tuple[str, bytes]]) -> bytes:
    """Return one PDF of several, each with its title; raise `TypesetterError`."""
    files = {f"{number}.pdf": content for number, (_, content) in enumerate(parts)}
    lines = [line for name, (title, content) in zip(files, parts, strict=True) for line in _pages(name, title, content)]
    return typst_compiler.compile_as("\n".join(lines), "pdf", beside=files)[0]


def _pages(name: str, title: str, content: bytes) -> Iterator[str]:
    """Yield the Typst source of the pages of a file in their own sizes, with the file's bookmark on the first."""
    for number in range(1, page_count(content) + 1):
        mark = f"#place(hide(heading({literal(title)})))" if number == 1 else ""
        yield f'#page(width: auto, height: auto, margin: 0pt)[{mark}#image("{name}", page: {number})]'


def page_count(pdf: bytes) -> int:
    """Return the number of pages of a typesetter's PDF; raise `TypesetterError` if it has no page tree.

    The root of the tree counts all pages; objects may be packed in streams.
    """
    packed = [pdf]
    for match in _PACKED.finditer(pdf):
        with suppress(zlib.error):
            packed.append(zlib.decompressobj().decompress(pdf[match.end() :]))
    trees = (tree for part in packed for tree in _TREE.findall(part))
    counts = [int(count) for tree in trees for count in _COUNT.findall(tree)]
    if not counts:
        raise TypesetterError("the PDF has no tree of pages")
    return max(counts)
