"""Read a school's Word file as data: its styles, header and footer, and page margins.

The package is checked like a workbook's. Embedded objects, links that lead out of the file, and fields that could do so
are refused as well. The body text is ignored. Header and footer keep their text with its fields, but no pictures.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from xml.etree import ElementTree

from reportgen.base.errors import Fault, Location, TemplateError
from reportgen.base.files import cause, contents
from reportgen.base.records import Record, field
from reportgen.base.units import Language
from reportgen.base.words import as_problem
from reportgen.workbook.zip_package import Attributes, Package, RefusedError

LETTERHEAD = "report.docx"
"""Name of the Word file in a folder of templates."""
LARGEST = 5_000_000
"""Largest size of the file in bytes."""
DEEPEST = 60
"""Largest nesting of elements."""
MOST = 20_000
"""Largest number of elements of a part."""
FIELDS = frozenset({"PAGE", "NUMPAGES", "SECTION", "SECTIONPAGES", "STYLEREF", "TITLE", "AUTHOR", "SUBJECT"})
"""Fields allowed in a header; other fields can reach for files or change from day to day."""
WORD = "http://schemas.openxmlformats.org/wordprocessingml/2006/main"
_XML = "http://www.w3.org/XML/1998/namespace"
_W = f"{{{WORD}}}"
_BLOCKS = frozenset({"p", "tbl", "sdt", "bookmarkStart", "bookmarkEnd"})
_CONTENTS = {"styles": frozenset({"docDefaults", "latentStyles", "style"}), "hdr": _BLOCKS, "ftr": _BLOCKS}
"""Root elements of the parts, with the elements allowed directly inside."""
_WITHIN = {
    child: frozenset(parents.split())
    for children, parents in (
        ("p tbl", "hdr ftr tc sdtContent customXml"),
        ("tr", "tbl sdtContent customXml"),
        ("tc", "tr sdtContent customXml"),
        (
            "r fldSimple hyperlink",
            "p hyperlink fldSimple smartTag sdtContent customXml ins del moveTo moveFrom rt rubyBase",
        ),
        ("t instrText fldChar ptab br", "r"),
        ("pPr", "p style tblStylePr pPrDefault pPrChange"),
        ("rPr", "r pPr style tblStylePr rPrDefault rPrChange sdtPr sdtEndPr"),
        ("tblPr", "tbl style tblStylePr tblPrChange"),
        ("trPr", "tr style tblStylePr trPrChange"),
        ("tcPr", "tc style tblStylePr tcPrChange"),
        ("tblGrid", "tbl tblGridChange"),
        ("gridCol", "tblGrid"),
        ("tblW", "tblPr"),
        ("tcW", "tcPr"),
        ("basedOn next link uiPriority qFormat semiHidden", "style"),
        ("sz szCs rFonts lang kern", "rPr"),
        ("numPr keepNext tabs outlineLvl pBdr pStyle ind", "pPr"),
        ("spacing", "pPr rPr"),
    )
    for child in children.split()
}
"""Allowed parents of elements; elements that are not listed are allowed anywhere."""
_FIRST = {"pPr": "p", "rPr": "r", "tcPr": "tc"}
"""Elements that must be the first child of their parent and occur once."""
_KINDS = frozenset({"paragraph", "character", "table", "numbering"})
_LENGTHS = frozenset(
    {"left", "right", "start", "end", "firstLine", "hanging", "before", "after", "line", "pos", "w", "h"}
)
"""Attributes that are lengths, usually in twips."""
_VALUES = {"sz": (2, 3276), "szCs": (2, 3276), "kern": (0, 3276), "position": (-3276, 3276), "outlineLvl": (0, 9)}
"""Elements whose value is a whole number, with the least and the greatest that Word takes."""
FARTHEST = 31_680
"""Longest length (twips) that Word accepts: 22 inches."""
_NUMBER = re.compile(r"[+-]?[0-9]+")
_LENGTH = re.compile(r"[+-]?[0-9]+(\.[0-9]+)?(mm|cm|in|pt|pc|pi|%)?")
_COLOUR = re.compile(r"auto|[0-9A-Fa-f]{6}")
_IN_UNITS = frozenset({"auto", "dxa", "nil", "pct"})
"""Units of a width."""
_PICTURES = frozenset({"drawing", "pict"})
_OBJECTS = frozenset({"object", "control", "altChunk", "subDoc"})
_CODES = {name: f"letterhead-{name}" for name in ("bomb", "macros", "links", "entities")}
_TWIPS = 1440 / 25.4
PAGE = {("left", "right"): 210.0, ("top", "bottom"): 297.0}
"""The page of a report, in mm, along its margins."""
LEAST_ROOM = 100.0
"""Distance (mm) between two margins that the widest words of a report need."""
MARGINS = {"top": "top", "bottom": "bottom", "left": "left", "right": "right", "header": "above", "footer": "below"}
"""The margins of a section by the names that pages have for them."""


class Letterhead(Record):
    """Parts as XML, "" for missing ones; margins in mm."""

    styles: str
    header: str = ""
    footer: str = ""
    margins: Mapping[str, float] = field(default_factory=dict)


def read_letterhead(path: Path, language: Language) -> Letterhead:
    """Return the letterhead that a report takes over from a file; raise `TemplateError` if the file is refused."""
    try:
        return _read(path)
    except RefusedError as refused:
        fault = refused.fault
        code = fault.code if fault.code.startswith("letterhead") else _CODES.get(fault.code[6:], "letterhead-damaged")
        raise TemplateError(str(as_problem(Fault(code, fault.location, fault.arguments), language))) from None
    except OSError as error:
        fault = Fault("unreadable", Location(str(path)), {"reason": cause(error)})
        raise TemplateError(str(as_problem(fault, language))) from error


def _read(path: Path) -> Letterhead:
    data = contents(path, LARGEST + 1)
    if len(data) > LARGEST:
        raise RefusedError("letterhead-bomb", Location(str(path)), largest=str(LARGEST // 1_000_000))
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
            margins = _margins(attributes, package)
        elif attributes.get("type") == "default" and (name := named.get(attributes.get("id", ""), "")) in package:
            parts[tag.removesuffix("Reference")] = _part(package, name, "hdr" if tag == "headerReference" else "ftr")
    return Letterhead(_part(package, "word/styles.xml", "styles"), margins=margins, **parts)


def _last_section(package: Package) -> Iterator[tuple[str, Attributes]]:
    """Yield the elements of the last section's properties for margins, header and footer."""
    elements = package.elements("word/document.xml")
    starts = [index for index, (tag, _) in enumerate(elements) if tag == "sectPr"]
    for tag, attributes in elements[starts[-1] :] if starts else ():
        if tag in ("pgMar", "headerReference", "footerReference"):
            yield tag, attributes


def _margins(attributes: Attributes, package: Package) -> dict[str, float]:
    """Return the margins by the names that pages have for them (mm); they leave room on the page of a report."""
    margins = {}
    for name, own in MARGINS.items():
        if name in attributes:
            if not _NUMBER.fullmatch(attributes[name]):
                raise package.refused("letterhead-value", text=f"{name}={attributes[name]}")
            margins[own] = abs(float(attributes[name])) / _TWIPS
    for sides, size in PAGE.items():
        # Missing margins are those of reports; half a page is enough for any single one.
        if sum(margins.get(side, 0.0) for side in sides) > size - LEAST_ROOM:
            lengths = ", ".join(f"{margins[side]:.6g}" for side in sides if side in margins)
            raise package.refused("letterhead-margins", text=lengths)
    if max((margins.get(side, 0.0) for side in ("above", "below")), default=0.0) > LEAST_ROOM:
        raise package.refused(
            "letterhead-margins", text=", ".join(f"{margins[side]:.6g}" for side in ("above", "below"))
        )
    return margins


def _part(package: Package, name: str, called: str) -> str:
    """Return a part with only Word's own elements and attributes, without references to other parts."""
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
    if root is None or root.tag != f"{_W}{called}":
        raise package.refused("letterhead-part", text=name)
    _judge(root, called, package, name)
    ElementTree.register_namespace("w", WORD)
    return ElementTree.tostring(root, encoding="unicode")


def _judge(root: ElementTree.Element, called: str, package: Package, name: str) -> None:
    """Refuse a part that Word would call damaged: misplaced elements, duplicate ids and names, values out of range."""
    if any(one.tag.removeprefix(_W) not in _CONTENTS[called] for one in root) or (called != "styles" and not len(root)):
        raise package.refused("letterhead-part", text=name)
    if any(not len(cell) or cell[-1].tag != f"{_W}p" for cell in root.iter(f"{_W}tc")):
        raise package.refused("letterhead-part", text=name)
    if any(not _is_allowed(child, parent) for parent in root.iter() for child in parent):
        raise package.refused("letterhead-part", text=name)
    marks = [one.get(f"{_W}fldCharType") for one in root.iter(f"{_W}fldChar")]
    if marks.count("begin") != marks.count("end"):
        raise package.refused("letterhead-part", text=name)
    for element in root.iter():
        if (wrong := _wrong_value(element)) is not None:
            raise package.refused("letterhead-value", text=wrong)
    if called == "styles":
        _judge_styles(root.findall(f"{_W}style"), package, name)


def _is_allowed(child: ElementTree.Element, parent: ElementTree.Element) -> bool:
    """Return True if an element is allowed at its place."""
    local, above = child.tag.removeprefix(_W), parent.tag.removeprefix(_W)
    first = _FIRST.get(local) != above or (parent[0] is child and len(parent.findall(child.tag)) == 1)
    return first and above in _WITHIN.get(local, (above,))


def _wrong_value(element: ElementTree.Element) -> str | None:
    """Return a number of an element that is out of Word's range; None if all are in range."""
    local = element.tag.removeprefix(_W)
    for key, value in element.attrib.items():
        attribute = key.removeprefix(_W)
        ends = (-FARTHEST, FARTHEST) if attribute in _LENGTHS else _VALUES.get(local) if attribute == "val" else None
        if ends and _NUMBER.fullmatch(value) and not (len(value) < 9 and ends[0] <= int(value) <= ends[1]):
            return f"{local} {attribute}={value[:20]}"
        is_length = attribute in _LENGTHS or (attribute == "val" and local in _VALUES)
        is_width = attribute == "type" and local in ("tcW", "tblW", "tblInd")
        is_colour = attribute in ("color", "fill") or (attribute == "val" and local == "color")
        if (
            (is_length and not _LENGTH.fullmatch(value))
            or (is_width and value not in _IN_UNITS)
            or (is_colour and not _COLOUR.fullmatch(value))
        ):
            return f"{local} {attribute}={value[:20]}"
    return None


def _judge_styles(styles: Sequence[ElementTree.Element], package: Package, name: str) -> None:
    """Refuse styles without a kind, an id or a unique name, and styles that are based on themselves."""
    bases: dict[str, str] = {}
    names = set[str]()
    for style in styles:
        id, kind, title = style.get(f"{_W}styleId", ""), style.get(f"{_W}type", ""), style.find(f"{_W}name")
        named = "" if title is None else title.get(f"{_W}val", "")
        if not id or not named or kind not in _KINDS:
            raise package.refused("letterhead-part", text=name)
        if id in bases or named.casefold() in names:
            raise package.refused("letterhead-twice", text=id if id in bases else named)
        base = style.find(f"{_W}basedOn")
        bases[id] = "" if base is None else base.get(f"{_W}val", "")
        names.add(named.casefold())
    for id in bases:
        met = set[str]()
        at = id
        while at:
            if at in met:
                raise package.refused("letterhead-part", text=name)
            met.add(at)
            at = bases.get(at, "")
