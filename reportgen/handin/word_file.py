"""Open a Word file from an untrusted source: check it as a package, then parse only its text.

Bombs, macros, entities, passwords and external content are rejected. Objects are never opened, links are never
followed, and pictures are ignored. A template that the file names, as honest files may, is dropped.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path

from reportgen.base.errors import Fault, Location
from reportgen.base.records import Record
from reportgen.handin.covered_text import covered_runs
from reportgen.handin.invisible_text import Styles, mark_unseen
from reportgen.handin.word_nodes import XmlNode, parse
from reportgen.handin.word_text import TextReader, WordBlock, heading_levels
from reportgen.workbook.zip_package import Bounds, Package, RefusedError

LARGEST = 50_000_000
"""Largest size (bytes) of the file."""
BOUNDS = Bounds(unpacked=200_000_000, links=frozenset({"hyperlink", "image", "attachedTemplate"}))
"""Bounds of the package; pictures of a report are large, and are not unpacked."""
LARGEST_TEXT = 60_000_000
"""Largest size (bytes) of a part of text."""
TEMPLATE = "attachedTemplate"
_CODES = {
    "sheet-no-zip": "word-damaged",
    "sheet-damaged": "word-damaged",
    "sheet-encrypted": "word-encrypted",
    "sheet-old": "word-old",
    "sheet-bomb": "word-bomb",
    "sheet-macros": "word-macros",
    "sheet-links": "word-links",
    "sheet-entities": "word-entities",
    "sheet-beyond-elements": "word-elements",
}


PICTURES = frozenset({"w:drawing", "w:pict"})


class WordFile(Record, dict=True):
    """A checked file: its package, the part with its text, and the text as a tree."""

    path: Path
    package: Package
    document: str
    content: bytes
    tree: XmlNode

    @cached_property
    def blocks(self) -> tuple[WordBlock, ...]:
        """The paragraphs and tables of the body."""
        return self._blocks()

    @property
    def all_blocks(self) -> tuple[WordBlock, ...]:
        """The same including hidden text."""
        return self._blocks(everything=True)

    @cached_property
    def unseen(self) -> tuple[XmlNode, ...]:
        """The hidden runs that contain a digit."""
        styles = Styles() if self._styles is None else Styles.of(self._styles)
        mark_unseen(self.tree, styles)
        for run in covered_runs(self.tree, styles):
            run.unseen = True
        runs = (node for node in self.tree.walk() if node.unseen)
        return tuple(run for run in runs if any(map(str.isdecimal, "".join(child.text for child in run.children))))

    @cached_property
    def _styles(self) -> XmlNode | None:
        part = self.related("styles")
        return parse(self.package, part, self.package.content(part)) if part in self.package else None

    def _blocks(self, everything: bool = False) -> tuple[WordBlock, ...]:
        body, _ = self.tree.child("w:body"), self.unseen
        levels = heading_levels(self._styles) if self._styles is not None else {}
        return tuple(TextReader(levels, everything).blocks(body.children if body else ()))

    @property
    def pictures(self) -> int:
        """The number of pictures in the text."""
        return sum(node.tag in PICTURES for node in self.tree.walk())

    @property
    def relations(self) -> str:
        """The part that lists the relationships of the text."""
        folder, name = posixpath.split(self.document)
        return f"{folder}/_rels/{name}.rels"

    def related(self, kind: str) -> str:
        """Return the name of the part of a kind that the text refers to; "" if there is none."""
        relations = self.package.relations(self.relations).values()
        targets = (one.target for one in relations if one.kind == kind and not one.external)
        return next((resolved(self.document, target) for target in targets), "")

    @property
    def template(self) -> bool:
        """True if it names an external template."""
        names = [name for name in self.package.names if name.lower().endswith(".rels")]
        return any(one.kind == TEMPLATE for name in names for one in self.package.relations(name).values())

    @property
    def notes(self) -> tuple[Fault, ...]:
        """Faults about the file as a whole."""
        return (Fault("word-template", Location(str(self.path))),) if self.template else ()


def resolved(part: str, target: str) -> str:
    """Return the name of the part that another one refers to."""
    joined = target if target.startswith("/") else posixpath.join(posixpath.dirname(part), target)
    return posixpath.normpath(joined).lstrip("/")


@contextmanager
def word_faults() -> Iterator[None]:
    """Convert faults of packages to those of Word files, whichever part is read."""
    try:
        yield
    except RefusedError as refused:
        fault = refused.fault
        raise RefusedError(_CODES.get(fault.code, fault.code), fault.location, **fault.arguments) from None


@word_faults()
def open_word(path: Path, data: bytes) -> WordFile:
    """Return a Word file that may be read; raise `RefusedError` with a fault of Word files."""
    if len(data) > LARGEST:
        raise RefusedError("word-large", Location(str(path)), largest=str(LARGEST // 1_000_000))
    package = Package(data, str(path), BOUNDS)
    tops = [one.target for one in package.relations("_rels/.rels").values() if one.kind == "officeDocument"]
    document = resolved("", tops[0]) if tops else ""
    if document not in package:
        raise package.refused("word-damaged", text=document)
    if package.size(document) > LARGEST_TEXT:
        raise package.bomb()
    content = package.content(document)
    tree = parse(package, document, content)
    if tree.tag != "w:document":
        raise package.refused("word-damaged", text=document)
    return WordFile(path, package, document, content, tree)
