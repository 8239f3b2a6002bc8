"""What a Word file says, read without the writer: its paragraphs and tables in order, numbers of lists counted anew."""

from __future__ import annotations

import io
import re
import unicodedata
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from xml.etree import ElementTree

W = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"
M = "{http://schemas.openxmlformats.org/officeDocument/2006/math}"
A = "{http://schemas.openxmlformats.org/drawingml/2006/main}"
R = "{http://schemas.openxmlformats.org/officeDocument/2006/relationships}"
WP = "{http://schemas.openxmlformats.org/drawingml/2006/wordprocessingDrawing}"
Element = ElementTree.Element

GAP = "\u200b"
_FREE = re.compile("[\\s\u200b]+")


def squash(text: str) -> str:
    """Text without white, in compatible forms."""
    return _FREE.sub("", unicodedata.normalize("NFKC", text))


@dataclass(frozen=True, slots=True)
class Field:
    """What a field asks for, and the result that stands in the file."""

    code: str
    result: str


class WordFile:
    """The parts of a file by name."""

    def __init__(self, data: bytes) -> None:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            self.parts = {name: archive.read(name) for name in archive.namelist()}
        self.body: Element = self.xml("word/document.xml")[0]

    def xml(self, name: str) -> Element:
        return ElementTree.fromstring(self.parts[name])

    @property
    def media(self) -> dict[str, bytes]:
        return {name: data for name, data in self.parts.items() if name.startswith("word/media/")}

    @cached_property
    def bookmarks(self) -> list[str]:
        return [one.get(f"{W}name", "") for one in self.body.iter(f"{W}bookmarkStart")]

    @cached_property
    def fields(self) -> list[Field]:
        """All fields of the body, inner ones before those round them."""
        found: list[Field] = []
        open_: list[list[str]] = []
        for element in self.body.iter():
            kind = element.get(f"{W}fldCharType")
            if kind == "begin":
                open_.append(["", "", ""])
            elif kind == "separate":
                open_[-1][2] = "1"
            elif kind == "end":
                code, result, _ = open_.pop()
                found.append(Field(code.strip(), result))
            elif element.tag == f"{W}instrText":
                open_[-1][0] += element.text or ""
            elif element.tag == f"{W}t":
                for one in open_:
                    one[1] += (element.text or "") if one[2] else ""
        assert not open_
        return found

    @cached_property
    def lines(self) -> list[tuple[str, str]]:
        """(style, text) of each paragraph, those in tables too, in order; without the entries of contents."""
        return list(_Reader(self).paragraphs(self.body))

    def text(self, *without: str) -> str:
        """All text but that of some styles."""
        return "".join(text for style, text in self.lines if style not in without)


def recounted(file: WordFile) -> Iterator[tuple[str, str, str]]:
    """(code, result in the file, result when all fields are counted anew) of numbers and references, in order.

    By the rules of Word: SEQ counts its name, with `\\s 1` from 1 behind each heading 1, with `\\r` from what it says;
    STYLEREF with `\\s` is the number of the heading before it, REF what its bookmark encloses or, with `\\w`, its
    paragraph's number.
    """
    reader = _Reader(file)
    marked: dict[str, str] = {}
    numbers: dict[str, str] = {}
    counts: dict[str, int] = {}
    part_of: dict[str, int] = {}
    part, heading = 0, ""
    references: list[Field] = []
    for paragraph in _paragraphs(file.body):
        number = reader.mark(paragraph, style_of(paragraph))
        if style_of(paragraph) == "Heading1":
            part, heading = part + 1, number
        inside: dict[str | None, str] = {}
        code, result, state = "", "", ""
        for one in paragraph.iter():
            shown = ""
            match one.tag, one.get(f"{W}fldCharType"):
                case (_, "begin"):
                    code, result, state = "", "", "begin"
                case (_, "separate"):
                    state = "separate"
                case (_, "end"):
                    state = ""
                    words = code.split()
                    if words[0] == "REF":
                        references.append(Field(code.strip(), result))
                        continue
                    if words[0] == "STYLEREF":
                        shown = heading
                    elif "\\r" in words:
                        counts[words[1]] = int(words[-1])
                        continue
                    else:
                        name = words[1]
                        kept = "\\s" not in words or part_of.get(name) == part
                        counts[name] = (counts.get(name, 0) if kept else 0) + 1
                        part_of[name], shown = part, str(counts[name])
                    yield code.strip(), result, shown
                case (tag, _) if tag == f"{W}bookmarkStart":
                    mark = inside[one.get(f"{W}id")] = one.get(f"{W}name", "")
                    marked[mark], numbers[mark] = "", number
                case (tag, _) if tag == f"{W}bookmarkEnd":
                    del inside[one.get(f"{W}id")]
                case (tag, _) if tag == f"{W}instrText":
                    code += one.text or ""
                case (tag, _) if tag in (f"{W}t", f"{M}t"):
                    shown = (one.text or "") * (not state)
                    result += one.text or ""
            for mark in inside.values():
                marked[mark] += shown
    for field in references:
        mark = field.code.split()[1]
        yield field.code, field.result, (numbers if "\\w" in field.code else marked)[mark]


def style_of(paragraph: Element) -> str:
    style = paragraph.find(f"{W}pPr/{W}pStyle")
    return "" if style is None else style.get(f"{W}val", "")


def _paragraphs(element: Element) -> Iterator[Element]:
    """Of a body in order, those of contents left out."""
    for child in element:
        if child.tag == f"{W}p":
            yield child
        elif child.tag != f"{W}sdt":
            yield from _paragraphs(child)


class _Reader:
    def __init__(self, file: WordFile) -> None:
        numbering = file.xml("word/numbering.xml")
        abstract = {one.get(f"{W}abstractNumId"): one for one in numbering.iter(f"{W}abstractNum")}
        self.levels: dict[str, dict[str, tuple[str, str, int]]] = {}
        for num in numbering.iter(f"{W}num"):
            levels = abstract[num.find(f"{W}abstractNumId").get(f"{W}val")]  # type: ignore[union-attr]
            starts = {one.get(f"{W}ilvl"): one[0].get(f"{W}val") for one in num.iter(f"{W}lvlOverride")}
            self.levels[num.get(f"{W}numId", "")] = {
                level.get(f"{W}ilvl", ""): (
                    level.find(f"{W}numFmt").get(f"{W}val", ""),  # type: ignore[union-attr]
                    level.find(f"{W}lvlText").get(f"{W}val", ""),  # type: ignore[union-attr]
                    int(starts.get(level.get(f"{W}ilvl")) or 1),
                )
                for level in levels.iter(f"{W}lvl")
            }
        self.in_style = {
            style.get(f"{W}styleId"): found
            for style in file.xml("word/styles.xml").iter(f"{W}style")
            if (found := style.find(f"{W}pPr/{W}numPr")) is not None
        }
        self.counts: dict[tuple[str, int], int] = {}

    def paragraphs(self, element: Element) -> Iterator[tuple[str, str]]:
        for child in element:
            if child.tag == f"{W}p":
                name = style_of(child)
                yield name, self.mark(child, name) + "".join(text_of(child))
            elif child.tag == f"{W}sdt":
                inner = child.find(f"{W}sdtContent")
                assert inner is not None
                yield next(self.paragraphs(inner))
            elif child.tag in (f"{W}tbl", f"{W}tr", f"{W}tc"):
                yield from self.paragraphs(child)

    def mark(self, paragraph: Element, style: str) -> str:
        """The number or the mark that a list puts before a paragraph."""
        numbers = paragraph.find(f"{W}pPr/{W}numPr")
        numbers = self.in_style.get(style) if numbers is None else numbers
        if numbers is None:
            return ""
        level, id = (int(numbers.find(f"{W}{name}").get(f"{W}val", "0")) for name in ("ilvl", "numId"))  # type: ignore[union-attr]
        if not id:
            return ""
        kind, shown, start = self.levels[str(id)][str(level)]
        key = (str(id), level)
        self.counts[key] = self.counts.get(key, start - 1) + 1
        for deeper in [one for one in self.counts if one[0] == key[0] and one[1] > level]:
            del self.counts[deeper]
        if kind == "bullet":
            return shown
        return re.sub("%(.)", lambda found: str(self.counts[key[0], int(found[1]) - 1]), shown)


def letters_of(element: Element) -> str:
    """All letters of an element, formulas and results of fields included."""
    return "".join(one.text or "" for one in element.iter() if one.tag in (f"{W}t", f"{M}t"))


def text_of(element: Element) -> Iterator[str]:
    """The text of an element, of formulas with the signs that are drawn, a gap after each run."""
    match element.tag.replace(M, "m:").replace(W, "w:"):
        case "w:t":
            yield element.text or ""
        case "m:t":
            yield f"{element.text or ''}{GAP}"
        case "w:tab" | "w:br":
            yield " "
        case "w:tabs" | "w:pPr":
            pass
        case "m:d":
            marks = [element.find(f"{M}dPr/{M}{name}") for name in ("begChr", "endChr")]
            opening, closing = (
                usual if one is None else one.get(f"{M}val", "") for one, usual in zip(marks, "()", strict=True)
            )
            yield opening
            for child in element:
                yield from text_of(child)
            yield closing
        case "m:rad":
            yield "√"
            for child in element:
                yield from text_of(child)
        case _:
            for child in element:
                yield from text_of(child)
