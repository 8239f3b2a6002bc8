"""The tags of a PDF, as a program reads them that says a file aloud, and what the file says of itself."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pytest

SHOWS = re.compile(rb"(?<![\w/])(?:Tj|TJ|')(?!\w)")
PAINTS = re.compile(rb"(?<![\w/])(?:S|s|f|F|f\*|B|B\*|b|b\*|sh|Do)(?!\w)")
SEQUENCE = re.compile(rb"(?<![\w/])(?:BDC|BMC|EMC)(?!\w)")


@dataclass(frozen=True)
class Tag:
    """A tag with all below it; `content` counts the pieces of the pages that it holds itself."""

    name: str
    alt: str
    scope: str
    below: tuple[Tag, ...]
    content: int

    def walk(self) -> Iterator[Tag]:
        """It and all below it, as they are read."""
        yield self
        for tag in self.below:
            yield from tag.walk()


@dataclass(frozen=True)
class Archived:
    """A file by its tags, its metadata and how it is written."""

    tags: tuple[Tag, ...]
    metadata: str
    language: str
    title: str
    author: str
    date: str
    is_marked: bool
    shows_title: bool

    def of(self, *names: str) -> list[Tag]:
        """The tags of some names, as they are read."""
        return [tag for top in self.tags for tag in top.walk() if tag.name in names]

    def says(self, name: str) -> str:
        """A property of the metadata, pdfuaid:part."""
        found = re.search(rf"<{name}>(.*?)</{name}>", self.metadata)
        return found[1] if found else ""

    @property
    def standards(self) -> tuple[str, str]:
        """The part of PDF/UA and that of PDF/A with its level, as an archive reads them."""
        return self.says("pdfuaid:part"), self.says("pdfaid:part") + self.says("pdfaid:conformance").lower()


def read(pdf: bytes) -> Archived:
    """What a file says of itself."""
    pymupdf = pytest.importorskip("pymupdf")
    mupdf = pymupdf.mupdf
    with pymupdf.open(stream=pdf, filetype="pdf") as document:
        whole = pymupdf._as_pdf_document(document)
        root = mupdf.pdf_dict_gets(mupdf.pdf_trailer(whole), "Root")

        def text(at: Any, key: str) -> str:
            value = mupdf.pdf_dict_gets(at, key)
            return mupdf.pdf_to_text_string(value) if mupdf.pdf_is_string(value) else ""

        def items(value: Any) -> Iterator[Any]:
            if mupdf.pdf_is_array(value):
                yield from (mupdf.pdf_array_get(value, index) for index in range(mupdf.pdf_array_len(value)))
            elif not mupdf.pdf_is_null(value):
                yield value

        def tags(at: Any) -> Iterator[Tag]:
            for one in items(mupdf.pdf_dict_gets(at, "K")):
                if mupdf.pdf_is_name(mupdf.pdf_dict_gets(one, "S")):
                    yield tag(one)

        def tag(at: Any) -> Tag:
            scopes = (mupdf.pdf_dict_gets(one, "Scope") for one in items(mupdf.pdf_dict_gets(at, "A")))
            scope = "".join(mupdf.pdf_to_name(one) for one in scopes if mupdf.pdf_is_name(one))
            below = tuple(tags(at))
            content = len(list(items(mupdf.pdf_dict_gets(at, "K")))) - len(below)
            return Tag(mupdf.pdf_to_name(mupdf.pdf_dict_gets(at, "S")), text(at, "Alt"), scope, below, content)

        told = document.metadata
        return Archived(
            tags=tuple(tags(mupdf.pdf_dict_gets(root, "StructTreeRoot"))),
            metadata=document.get_xml_metadata(),
            language=text(root, "Lang"),
            title=told["title"] or "",
            author=told["author"] or "",
            date=told["creationDate"] or "",
            is_marked=mupdf.pdf_to_bool(mupdf.pdf_dict_gets(mupdf.pdf_dict_gets(root, "MarkInfo"), "Marked")) == 1,
            shows_title=mupdf.pdf_to_bool(
                mupdf.pdf_dict_gets(mupdf.pdf_dict_gets(root, "ViewerPreferences"), "DisplayDocTitle")
            )
            == 1,
        )
