"""A school's own Word file: its styles, header and footer and the margins of its pages, read as data.

The package is judged as a workbook's is.  Refused are also embedded objects, everything that leads out of the file, and
fields that could.  Of its text nothing is taken, of header and footer the text with its fields; pictures are left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

from reportgen.base.errors import Fault, Mark, TemplateError
from reportgen.base.files import cause, contents
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.workbook.package import Attributes, Package, RefusedError

LETTERHEAD = "report.docx"
"""What it is called in a folder of templates."""
LARGEST = 5_000_000
"""Bytes of the file."""
DEEPEST = 60
"""Elements inside one another."""
MOST = 20_000
"""Elements of a part."""
FIELDS = frozenset({"PAGE", "NUMPAGES", "SECTION", "SECTIONPAGES", "STYLEREF", "TITLE", "AUTHOR", "SUBJECT"})
"""What a header may have Word fill in; other fields can reach for files or change from day to day."""
WORD = "http://schemas.openxmlformats.org/wordprocessingml/2006/main"
_XML = "http://www.w3.org/XML/1998/namespace"
_ROOTS = frozenset(f"{{{WORD}}}{name}" for name in ("styles", "hdr", "ftr"))
_PICTURES = frozenset({"drawing", "pict"})
_OBJECTS = frozenset({"object", "control", "altChunk", "subDoc"})
_CODES = {name: f"letterhead-{name}" for name in ("bomb", "macros", "links", "entities")}
_TWIPS = 1440 / 25.4
MARGINS = {"top": "top", "bottom": "bottom", "left": "left", "right": "right", "header": "above", "footer": "below"}
"""The margins of a section by the names that pages have for them."""


@dataclass(frozen=True, slots=True)
class Letterhead:
    """Parts as XML, "" for what the file does not have; margins in mm."""

    styles: str
    header: str = ""
    footer: str = ""
    margins: Mapping[str, float] = field(default_factory=dict)


def read_letterhead(path: Path, language: Language) -> Letterhead:
    """What a report takes over from a file; raises `TemplateError` for one that is refused."""
    try:
        return _read(path)
    except RefusedError as refused:
        fault = refused.fault
        code = fault.code if fault.code.startswith("letterhead") else _CODES.get(fault.code[6:], "letterhead-damaged")
        raise TemplateError(str(as_problem(Fault(code, fault.mark, fault.arguments), language))) from None
    except OSError as error:
        fault = Fault("unreadable", Mark(str(path)), {"reason": cause(error)})
        raise TemplateError(str(as_problem(fault, language))) from error


def _read(path: Path) -> Letterhead:
    data = contents(path, LARGEST + 1)
    if len(data) > LARGEST:
        raise RefusedError("letterhead-bomb", Mark(str(path)), largest=str(LARGEST // 1_000_000))
    package = Package(data, str(path))
    for name in package.names:
        if "/embeddings/" in name.lower():
            raise package.refused("letterhead-objects", text=name)
        if name.lower().endswith(".rels"):
            for relation in package.relations(name).values():
                if relation.external:
                    raise package.refused("letterhead-links")
    relations = package.relations("word/_rels/document.xml.rels")
    named = {id: f"word/{relation.target.removeprefix('/word/')}" for id, relation in relations.items()}
    if "word/document.xml" not in package or "word/styles.xml" not in package:
        raise package.refused("letterhead-damaged")
    parts: dict[str, str] = {}
    margins: dict[str, float] = {}
    for tag, attributes in _last_section(package):
        if tag == "pgMar":
            margins = dict(_margins(attributes, package))
        elif attributes.get("type") == "default" and (name := named.get(attributes.get("id", ""), "")) in package:
            parts[tag.removesuffix("Reference")] = _part(package, name)
    return Letterhead(_part(package, "word/styles.xml"), margins=margins, **parts)


def _last_section(package: Package) -> Iterator[tuple[str, Attributes]]:
    """What the properties of the last section say of margins, header and footer."""
    elements = package.elements("word/document.xml")
    starts = [index for index, (tag, _) in enumerate(elements) if tag == "sectPr"]
    for tag, attributes in elements[starts[-1] :] if starts else ():
        if tag in ("pgMar", "headerReference", "footerReference"):
            yield tag, attributes


def _margins(attributes: Attributes, package: Package) -> Iterator[tuple[str, float]]:
    for name, own in MARGINS.items():
        if name in attributes:
            try:
                yield own, abs(int(attributes[name])) / _TWIPS
            except ValueError:
                raise package.refused("letterhead-damaged") from None


def _part(package: Package, name: str) -> str:
    """A part with nothing in it but Word's own elements and attributes, none of which names another part."""
    builder = ElementTree.TreeBuilder()
    codes: list[str] = []
    skipped = depth = count = 0
    in_code = False

    def start(tag: str, attributes: Attributes) -> None:
        nonlocal skipped, depth, count, in_code
        space, _, local = tag.rpartition(" ")
        depth, count = depth + 1, count + 1
        if local in _OBJECTS:
            raise package.refused("letterhead-objects", text=name)
        if depth > DEEPEST or count > MOST:
            raise package.refused("letterhead-bomb", largest=str(LARGEST // 1_000_000))
        if skipped or space != WORD or local in _PICTURES:
            skipped += 1
            return
        in_code = local == "instrText"
        if attributes.get(f"{WORD} fldCharType") == "begin":
            codes.append("")
        if (code := attributes.get(f"{WORD} instr")) is not None:
            codes.append(code)
        names = {f"{{{WORD}}}": f"{WORD} ", f"{{{_XML}}}": f"{_XML} "}
        kept = {
            key.replace(known, bracketed): value
            for key, value in attributes.items()
            for bracketed, known in names.items()
            if key.startswith(known)
        }
        builder.start(f"{{{WORD}}}{local}", kept)

    def end(tag: str) -> None:
        nonlocal skipped, depth, in_code
        depth -= 1
        if skipped:
            skipped -= 1
        else:
            in_code = False
            builder.end(f"{{{WORD}}}{tag.rpartition(' ')[2]}")

    def text(letters: str) -> None:
        if not skipped:
            builder.data(letters)
            if in_code and codes:
                codes[-1] += letters

    package.walk(name, start, end, text)
    for code in codes:
        if (code.split() or [""])[0].upper() not in FIELDS:
            raise package.refused("letterhead-field", text=code.strip(), known=", ".join(sorted(FIELDS)))
    root: ElementTree.Element | None = builder.close()
    if root is None or root.tag not in _ROOTS:
        raise package.refused("letterhead-damaged")
    ElementTree.register_namespace("w", WORD)
    return ElementTree.tostring(root, encoding="unicode")
