"""The parts of a Word file: elements as text, styles, numbering, settings, and the package that holds them.

Texts become XML in `escape` and nowhere else.  The package has fixed dates and a fixed order, so that the same
document is the same bytes.
"""

from __future__ import annotations

import io
import re
import unicodedata
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape as escaped
from typing import Any
from xml.etree import ElementTree

from reportgen.base.units import Language

NAMESPACES = {
    "w": "http://schemas.openxmlformats.org/wordprocessingml/2006/main",
    "r": "http://schemas.openxmlformats.org/officeDocument/2006/relationships",
    "m": "http://schemas.openxmlformats.org/officeDocument/2006/math",
    "wp": "http://schemas.openxmlformats.org/drawingml/2006/wordprocessingDrawing",
    "a": "http://schemas.openxmlformats.org/drawingml/2006/main",
    "pic": "http://schemas.openxmlformats.org/drawingml/2006/picture",
    "asvg": "http://schemas.microsoft.com/office/drawing/2016/SVG/main",
}
DECLARED = " ".join(f'xmlns:{prefix}="{uri}"' for prefix, uri in NAMESPACES.items())
PROLOGUE = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'
_IMPOSSIBLE = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that no XML can hold, not even by their numbers."""

TWIPS, EMU = 1440 / 25.4, 36000
"""Of a millimetre: Word's unit of lengths, and that of pictures."""
CODES: Mapping[Language, str] = {"vi": "vi-VN", "en": "en-GB"}
MATH_FONT = "Cambria Math"


def escape(text: str) -> str:
    """A text that reads back as typed, composed, in an element or an attribute; what XML cannot hold shows as �."""
    return escaped(_IMPOSSIBLE.sub("\ufffd", unicodedata.normalize("NFC", text)))


def twips(millimetres: float) -> int:
    return round(millimetres * TWIPS)


# --- elements -------------------------------------------------------------------------------------


def run(text: str, look: str = "") -> str:
    """Letters that look alike; `look` are the elements that say how, in the schema's order."""
    properties = f"<w:rPr>{look}</w:rPr>" if look else ""
    return f'<w:r>{properties}<w:t xml:space="preserve">{escape(text)}</w:t></w:r>' if text else ""


def field(code: str, result: str, look: str = "") -> str:
    """A field with the result that it has as long as nobody recounts it."""
    properties = f"<w:rPr>{look}</w:rPr>" if look else ""

    def mark(kind: str) -> str:
        return f'<w:r>{properties}<w:fldChar w:fldCharType="{kind}"/></w:r>'

    instruction = f'<w:r>{properties}<w:instrText xml:space="preserve"> {escape(code)} </w:instrText></w:r>'
    return mark("begin") + instruction + mark("separate") + run(result, look) + mark("end")


def paragraph(style: str, content: str, properties: str = "") -> str:
    """A paragraph in a style; further properties in the schema's order."""
    return f'<w:p><w:pPr><w:pStyle w:val="{style}"/>{properties}</w:pPr>{content}</w:p>'


SVG = "{96DAC541-7B7A-43D3-8B79-37D633B846F1}"
"""What a picture's extension with its SVG is called; who does not know it shows the PNG."""


def drawing(number: int, width: float, height: float, told: str) -> str:
    """The picture of a number in a line of text, in its size (mm), with what is told in its place."""
    size = f'cx="{round(width * EMU)}" cy="{round(height * EMU)}"'
    named = f'id="{number}" name="figure{number}"'
    vector = f'<a:extLst><a:ext uri="{SVG}"><asvg:svgBlip r:embed="rel-figure{number}.svg"/></a:ext></a:extLst>'
    return (
        f'<w:r><w:drawing><wp:inline distT="0" distB="0" distL="0" distR="0"><wp:extent {size}/>'
        f'<wp:docPr {named} descr="{escape(told)}"/><wp:cNvGraphicFramePr>'
        '<a:graphicFrameLocks noChangeAspect="1"/></wp:cNvGraphicFramePr>'
        f'<a:graphic><a:graphicData uri="{NAMESPACES["pic"]}"><pic:pic>'
        f"<pic:nvPicPr><pic:cNvPr {named}/><pic:cNvPicPr/></pic:nvPicPr><pic:blipFill>"
        f'<a:blip r:embed="rel-figure{number}.png">{vector}</a:blip><a:stretch><a:fillRect/></a:stretch></pic:blipFill>'
        f'<pic:spPr><a:xfrm><a:off x="0" y="0"/><a:ext {size}/></a:xfrm>'
        '<a:prstGeom prst="rect"><a:avLst/></a:prstGeom></pic:spPr>'
        "</pic:pic></a:graphicData></a:graphic></wp:inline></w:drawing></w:r>"
    )


@dataclass(frozen=True, slots=True)
class PageSetup:
    """Paper and margins of a section (mm); its header stands `above`, its footer `below`, from the paper's edge."""

    width: float = 210.0
    height: float = 297.0
    left: float = 30.0
    right: float = 20.0
    top: float = 22.0
    bottom: float = 20.0
    above: float = 11.0
    below: float = 9.0
    running: bool = True
    """Whether it has header and footer."""
    framed: bool = False

    @property
    def room(self) -> float:
        """What text takes across."""
        return self.width - self.left - self.right


A4 = PageSetup()


@dataclass(frozen=True, slots=True)
class Own:
    """What a school has of its own: parts as XML, "" for ours; margins by the names that pages have for them (mm)."""

    styles: str = ""
    header: str = ""
    footer: str = ""
    margins: Mapping[str, Any] | None = None

    @property
    def page(self) -> PageSetup:
        """The page of the text, which leaves it no less room than figures and tables are made for."""
        page = replace(A4, **(self.margins or {}))
        return page if page.room >= A4.room else replace(page, left=A4.left, right=A4.right)


def section(page: PageSetup, running: str) -> str:
    """The properties of a section, which begins a page; `running` are the references to its header and footer."""
    turned = ' w:orient="landscape"' if page.width > page.height else ""
    names = ("top", "right", "bottom", "left")
    lengths = {**{name: getattr(page, name) for name in names}, "header": page.above, "footer": page.below}
    margins = " ".join(f'w:{name}="{twips(length)}"' for name, length in {**lengths, "gutter": 0.0}.items())
    sides = "".join(f'<w:{name} w:val="double" w:sz="6" w:space="31" w:color="auto"/>' for name in _SIDES)
    frame = f'<w:pgBorders w:offsetFrom="text">{sides}</w:pgBorders>' if page.framed else ""
    size = f'<w:pgSz w:w="{twips(page.width)}" w:h="{twips(page.height)}"{turned}/>'
    return f'<w:sectPr>{running}<w:type w:val="nextPage"/>{size}<w:pgMar {margins}/>{frame}</w:sectPr>'


_SIDES = ("top", "left", "bottom", "right")

# --- styles ---------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Style:
    """A paragraph style by its name in Word; its elements in the schema's order."""

    id: str
    name: str
    lines: str = ""
    letters: str = ""
    based: str = "Normal"
    following: str = ""

    def written(self) -> str:
        based = f'<w:basedOn w:val="{self.based}"/>' if self.based else ""
        following = f'<w:next w:val="{self.following}"/>' if self.following else ""
        lines = f"<w:pPr>{self.lines}</w:pPr>" if self.lines else ""
        letters = f"<w:rPr>{self.letters}</w:rPr>" if self.letters else ""
        default = "" if self.based else ' w:default="1"'
        return (
            f'<w:style w:type="paragraph"{default} w:styleId="{self.id}"><w:name w:val="{self.name}"/>'
            f"{based}{following}<w:qFormat/>{lines}{letters}</w:style>"
        )


def spaced(before: float, after: float, line: float = 0.0) -> str:
    """The white of a paragraph (points), and its pitch in lines where it is not that of Normal."""
    pitch = f' w:line="{round(240 * line)}" w:lineRule="auto"' if line else ""
    return f'<w:spacing w:before="{round(20 * before)}" w:after="{round(20 * after)}"{pitch}/>'


def sized(points: float) -> str:
    return f'<w:sz w:val="{round(2 * points)}"/><w:szCs w:val="{round(2 * points)}"/>'


def right_tab(at: float, leader: str = "") -> str:
    """A stop for the right end of what stands at it (mm)."""
    dots = f' w:leader="{leader}"' if leader else ""
    return f'<w:tab w:val="right"{dots} w:pos="{twips(at)}"/>'


CENTRE, LEFT = '<w:jc w:val="center"/>', '<w:jc w:val="left"/>'
BOLD, ITALIC = "<w:b/><w:bCs/>", "<w:i/><w:iCs/>"
KEPT, MONO = "<w:keepNext/>", '<w:rFonts w:ascii="Courier New" w:hAnsi="Courier New"/>'
EQUATION_SIZE, KNOWN_SIZE = 12.0, 9.5
"""Of displayed formulas, whose lines are measured in it, and of what is known of vectors below them (points)."""


def paragraph_styles(font: str, size: float, close: bool, room: float) -> list[Style]:
    """The styles of a report; of one that is set `close`, type and gaps are smaller."""
    size, gap = (size - 1, 4.0) if close else (size, 5.0)
    face = " ".join(f'w:{one}="{escape(font)}"' for one in ("ascii", "hAnsi", "eastAsia", "cs"))
    letters = f"<w:rFonts {face}/>{sized(size)}"
    contents = f'<w:tabs><w:tab w:val="left" w:pos="{{tab}}"/>{right_tab(room, "dot")}</w:tabs>'

    def heading(level: int, before: float, after: float, points: float, place: str = "") -> Style:
        numbered = f'<w:numPr><w:ilvl w:val="{level - 1}"/><w:numId w:val="{HEADINGS}"/></w:numPr>'
        lines = f"{KEPT}<w:keepLines/>{numbered}{spaced(before, after)}{place or LEFT}"
        outline = f'<w:outlineLvl w:val="{level - 1}"/>'
        return Style(f"Heading{level}", f"heading {level}", lines + outline, BOLD + sized(points), following="Normal")

    def entry(level: int, left: float, width: float, before: float, letters: str = "") -> Style:
        tabs = contents.format(tab=twips(left + width))
        lines = f'{tabs}{spaced(before, 2, 1)}<w:ind w:left="{twips(left)}" w:right="{twips(8)}"/>{LEFT}'
        return Style(f"TOC{level}", f"toc {level}", lines, letters, following="Normal")

    return [
        Style("Normal", "Normal", f'<w:widowControl/>{spaced(0, gap, 1)}<w:jc w:val="both"/>', letters, based=""),
        heading(1, 24, 14, size + 4, CENTRE),
        heading(2, 14, 8, size + 2),
        heading(3, 12, 7, size),
        Style("Title", "Title", spaced(0, 10) + CENTRE, BOLD + sized(21), following="Normal"),
        Style("Subtitle", "Subtitle", spaced(0, 8) + CENTRE, sized(15), following="Normal"),
        Style("Institution", "Institution", spaced(0, 4) + CENTRE, sized(15)),
        Style("CoverField", "Cover Field", f"{spaced(0, 8)}{LEFT}", sized(13)),
        Style("Caption", "caption", spaced(4, 8, 1) + CENTRE, sized(11), following="Normal"),
        Style("List", "List", f"{spaced(0, gap / 2)}<w:contextualSpacing/>"),
        Style("Table", "Table", spaced(0, 0, 1) + LEFT, sized(10)),
        Style("Listing", "Listing", spaced(0, 0, 1) + LEFT, MONO + sized(7.5)),
        Style("Equation", "Equation", spaced(gap / 2, gap / 2, 1) + CENTRE, sized(EQUATION_SIZE), following="Normal"),
        Style("Known", "Known Quantity", "", sized(KNOWN_SIZE), based="Equation"),
        Style("Figure", "Figure", KEPT + spaced(6, 3, 1) + CENTRE, sized(2), following="Caption"),
        Style("FigureTitle", "Figure Title", KEPT + spaced(0, 3, 1) + CENTRE, sized(11)),
        Style("Gap", "Gap", '<w:spacing w:before="0" w:after="0" w:line="40" w:lineRule="exact"/>', sized(1)),
        Style("TOCHeading", "TOC Heading", KEPT + spaced(0, 16) + CENTRE, BOLD + sized(size + 4), following="Normal"),
        entry(1, 0, 8, 6, BOLD),
        entry(2, 8, 12, 0),
        entry(3, 20, 15, 0),
        Style(
            "Header",
            "header",
            '<w:pBdr><w:bottom w:val="single" w:sz="4" w:space="3" w:color="auto"/></w:pBdr>'
            f"<w:tabs>{right_tab(room)}</w:tabs>{spaced(0, 0, 1)}{LEFT}",
            sized(10),
        ),
        Style("Footer", "footer", f"<w:tabs>{right_tab(room)}</w:tabs>{spaced(0, 0, 1)}{LEFT}", sized(10)),
    ]


GRID = "Grid"
"""The table style without rules and margins, for what only stands side by side."""
RULED = "Ruled"
"""That of a report's tables."""
_ACROSS, _DOWN = twips(1.5), twips(0.6)
"""The white in a cell beside that of a line, which Word sets higher than the letters are."""
HEAVY, LIGHT, HAIR = 6, 4, 2
"""Rules, in eighths of a point: 0.8, 0.5 and 0.3 pt to the next one that Word has."""
HAIR_COLOUR = "BFBFBF"


def rule(side: str, width: int, colour: str = "auto") -> str:
    """A rule at a side of a table or a cell; without `width` there is none."""
    kind = "single" if width else "nil"
    return f'<w:{side} w:val="{kind}" w:sz="{width}" w:space="0" w:color="{colour}"/>'


def _table_styles() -> str:
    def margins(across: int, down: int) -> str:
        sizes = {"top": down, "left": across, "bottom": down, "right": across}
        sides = "".join(f'<w:{side} w:w="{size}" w:type="dxa"/>' for side, size in sizes.items())
        return f"<w:tblCellMar>{sides}</w:tblCellMar>"

    rules = rule("top", HEAVY) + rule("bottom", HEAVY) + rule("insideH", HAIR, HAIR_COLOUR)
    looks = {
        "TableNormal": ("Normal Table", margins(0, 0), ' w:default="1"'),
        GRID: ("Equation Grid", margins(0, 0), ' w:customStyle="1"'),
        RULED: ("Report Table", f"<w:tblBorders>{rules}</w:tblBorders>{margins(_ACROSS, _DOWN)}", ' w:customStyle="1"'),
    }
    return "".join(
        f'<w:style w:type="table"{kind} w:styleId="{id}"><w:name w:val="{name}"/>'
        + ("" if id == "TableNormal" else '<w:basedOn w:val="TableNormal"/>')
        + f'<w:tblPr><w:tblInd w:w="0" w:type="dxa"/>{look}</w:tblPr></w:style>'
        for id, (name, look, kind) in looks.items()
    )


def styles(font: str, size: float, language: Language, close: bool, room: float) -> str:
    """The part of styles; without a school's own, all that the report names."""
    code = CODES[language]
    return (
        f"{PROLOGUE}<w:styles {DECLARED}><w:docDefaults><w:rPrDefault><w:rPr>"
        f'<w:lang w:val="{code}" w:eastAsia="{code}" w:bidi="ar-SA"/></w:rPr></w:rPrDefault>'
        "<w:pPrDefault/></w:docDefaults>"
        + "".join(style.written() for style in paragraph_styles(font, size, close, room))
        + '<w:style w:type="character" w:default="1" w:styleId="DefaultParagraphFont">'
        '<w:name w:val="Default Paragraph Font"/></w:style>'
        + _table_styles()
        + '<w:style w:type="numbering" w:default="1" w:styleId="NoList"><w:name w:val="No List"/></w:style></w:styles>'
    )


_W = f"{{{NAMESPACES['w']}}}"
_REFERENCES = frozenset(f"{_W}{name}" for name in ("basedOn", "next", "link"))
_BEFORE_NUMBERS = frozenset(
    f"{_W}{name}" for name in ("pStyle", "keepNext", "keepLines", "pageBreakBefore", "framePr", "widowControl")
)
"""What stands before the list of a style in the schema's order."""


def merged(ours: str, school: str, language: Language) -> str:
    """A school's styles under the names that the report uses, with what they lack; lists and language stay ours."""
    own, usual = ElementTree.fromstring(school), ElementTree.fromstring(ours)
    styles, wanted = ({_named(style): style for style in one.iter(f"{_W}style")} for one in (own, usual))
    ids = {_id(styles[name]): _id(style) for name, style in wanted.items() if name in styles}
    taken = set(ids.values())
    for style in styles.values():
        ids.setdefault(_id(style), f"own-{_id(style)}" if _id(style) in taken else _id(style))
    for name, style in styles.items():
        style.set(f"{_W}styleId", ids[_id(style)])
        for reference in (one for one in style if one.tag in _REFERENCES):
            reference.set(f"{_W}val", ids.get(reference.get(f"{_W}val", ""), "Normal"))
        lines = style.find(f"{_W}pPr")
        if lines is not None:
            for numbers in lines.findall(f"{_W}numPr"):
                lines.remove(numbers)
        if name in wanted and (numbers_wanted := wanted[name].find(f"{_W}pPr/{_W}numPr")) is not None:
            _put_in_list(style, numbers_wanted)
    own.extend(style for name, style in wanted.items() if name not in styles)
    letters = own.find(f"{_W}docDefaults/{_W}rPrDefault/{_W}rPr")
    if letters is None:
        for incomplete in own.findall(f"{_W}docDefaults"):
            own.remove(incomplete)
        own[:0] = usual.findall(f"{_W}docDefaults")
    else:
        for other in letters.findall(f"{_W}lang"):
            letters.remove(other)
        ElementTree.SubElement(letters, f"{_W}lang", {f"{_W}val": CODES[language], f"{_W}eastAsia": CODES[language]})
    ElementTree.register_namespace("w", NAMESPACES["w"])
    return PROLOGUE + ElementTree.tostring(own, encoding="unicode")


def _put_in_list(style: ElementTree.Element, numbers: ElementTree.Element) -> None:
    """Give a style the list that it is numbered in, at its place in the schema's order."""
    lines = style.find(f"{_W}pPr")
    if lines is None:
        lines = ElementTree.Element(f"{_W}pPr")
        letters = style.find(f"{_W}rPr")
        style.insert(len(style) if letters is None else list(style).index(letters), lines)
    lines.insert(sum(one.tag in _BEFORE_NUMBERS for one in lines), numbers)


def _id(style: ElementTree.Element) -> str:
    return style.get(f"{_W}styleId", "")


def _named(style: ElementTree.Element) -> str:
    name = style.find(f"{_W}name")
    return "" if name is None else name.get(f"{_W}val", "").casefold()


# --- numbering ------------------------------------------------------------------------------------

HEADINGS, BULLETS = 1, 2
"""The lists that headings and lists without numbers are in; those with numbers follow, one each."""
LIST_INDENT = 8.0
"""What each level of a list stands further right (mm)."""
_DEEPEST = 9


def numbering(starts: Sequence[tuple[int, int]]) -> str:
    """The part of lists; `starts` are level and first number of each ordered one."""

    def level(index: int, kind: str, text: str, look: str, start: int = 1) -> str:
        return (
            f'<w:lvl w:ilvl="{index}"><w:start w:val="{start}"/><w:numFmt w:val="{kind}"/>{look}'
            f'<w:lvlText w:val="{text}"/><w:lvlJc w:val="left"/>'
        )

    def hanging(index: int) -> str:
        left = twips(LIST_INDENT * (index + 1))
        return f'<w:pPr><w:ind w:left="{left}" w:hanging="{twips(6)}"/></w:pPr></w:lvl>'

    headings = "".join(
        level(
            index,
            "decimal",
            ".".join(f"%{one + 1}" for one in range(index + 1)),
            f'<w:pStyle w:val="Heading{index + 1}"/><w:suff w:val="space"/>',
        )
        + '<w:pPr><w:ind w:left="0" w:firstLine="0"/></w:pPr></w:lvl>'
        for index in range(3)
    )
    bullets = "".join(level(index, "bullet", "–•"[index % 2], "") + hanging(index) for index in range(_DEEPEST))
    decimals = "".join(level(index, "decimal", f"%{index + 1}.", "") + hanging(index) for index in range(_DEEPEST))
    abstract = "".join(
        f'<w:abstractNum w:abstractNumId="{index}"><w:multiLevelType w:val="multilevel"/>{levels}</w:abstractNum>'
        for index, levels in enumerate((headings, bullets, decimals))
    )
    ordered = "".join(
        f'<w:num w:numId="{BULLETS + 1 + index}"><w:abstractNumId w:val="2"/><w:lvlOverride w:ilvl="{at}">'
        f'<w:startOverride w:val="{start}"/></w:lvlOverride></w:num>'
        for index, (at, start) in enumerate(starts)
    )
    fixed = "".join(f'<w:num w:numId="{id}"><w:abstractNumId w:val="{id - 1}"/></w:num>' for id in (HEADINGS, BULLETS))
    return f"{PROLOGUE}<w:numbering {DECLARED}>{abstract}{fixed}{ordered}</w:numbering>"


# --- the package ----------------------------------------------------------------------------------

_OFFICE = "application/vnd.openxmlformats-officedocument.wordprocessingml"
_TYPES = {
    "document": f"{_OFFICE}.document.main+xml",
    "core": "application/vnd.openxmlformats-package.core-properties+xml",
}
_RELATIONS = "http://schemas.openxmlformats.org/package/2006/relationships"
_CORE = "http://schemas.openxmlformats.org/package/2006/relationships/metadata/core-properties"
_PROPERTIES = "http://schemas.openxmlformats.org/package/2006/metadata/core-properties"


def settings(language: Language) -> str:
    """The part of settings: what Word 2013 and later do, the font of formulas, the language's marks."""
    decimal, separator = (",", ";") if language == "vi" else (".", ",")
    uri = "http://schemas.microsoft.com/office/word"
    compatible = f'<w:compatSetting w:name="compatibilityMode" w:uri="{uri}" w:val="15"/>'
    return (
        f'{PROLOGUE}<w:settings {DECLARED}><w:defaultTabStop w:val="{twips(10)}"/><w:compat>{compatible}</w:compat>'
        f'<m:mathPr><m:mathFont m:val="{MATH_FONT}"/><m:brkBin m:val="before"/><m:dispDef/><m:defJc m:val="center"/>'
        f'</m:mathPr><w:themeFontLang w:val="{CODES[language]}"/><w:decimalSymbol w:val="{decimal}"/>'
        f'<w:listSeparator w:val="{separator}"/></w:settings>'
    )


def properties(title: str, author: str, language: Language) -> str:
    """The part that says what the file is, without a date."""
    return (
        f'{PROLOGUE}<cp:coreProperties xmlns:cp="{_PROPERTIES}" xmlns:dc="http://purl.org/dc/elements/1.1/">'
        f"<dc:title>{escape(title)}</dc:title><dc:creator>{escape(author)}</dc:creator>"
        f"<dc:language>{CODES[language]}</dc:language></cp:coreProperties>"
    )


def packed(parts: Mapping[str, str], media: Mapping[str, bytes]) -> bytes:
    """A Word file of its parts by name, `document` among them, and of pictures by name."""
    beside = {name: f"rel-{name}" for name in parts if name not in ("document", "core")}
    related = "".join(_relation(id, _kind(name), f"{name}.xml") for name, id in beside.items())
    related += "".join(_relation(f"rel-{name}", "image", f"media/{name}") for name in media)
    overrides = "".join(
        f'<Override PartName="/{_place(name)}" ContentType="{_TYPES.get(name, f"{_OFFICE}.{_kind(name)}+xml")}"/>'
        for name in parts
    )
    defaults = {"rels": "application/vnd.openxmlformats-package.relationships+xml", "xml": "application/xml"}
    if media:
        defaults |= {"png": "image/png", "svg": "image/svg+xml"}
    known = "".join(f'<Default Extension="{end}" ContentType="{kind}"/>' for end, kind in defaults.items())
    types = "http://schemas.openxmlformats.org/package/2006/content-types"
    top = _relation("rel-document", "officeDocument", "word/document.xml")
    top += f'<Relationship Id="rel-core" Type="{_CORE}" Target="docProps/core.xml"/>'
    files: list[tuple[str, bytes]] = [
        ("[Content_Types].xml", f'{PROLOGUE}<Types xmlns="{types}">{known}{overrides}</Types>'.encode()),
        ("_rels/.rels", _relations(top)),
        ("word/_rels/document.xml.rels", _relations(related)),
        *((_place(name), part.encode()) for name, part in parts.items()),
        *((f"word/media/{name}", content) for name, content in media.items()),
    ]
    return _zipped(files)


def _kind(name: str) -> str:
    """The kind of a part: `header` of `header2`."""
    return name.rstrip("0123456789")


def _place(name: str) -> str:
    return "docProps/core.xml" if name == "core" else f"word/{name}.xml"


def _relation(id: str, kind: str, target: str) -> str:
    return f'<Relationship Id="{id}" Type="{NAMESPACES["r"]}/{kind}" Target="{target}"/>'


def _relations(relations: str) -> bytes:
    return f'{PROLOGUE}<Relationships xmlns="{_RELATIONS}">{relations}</Relationships>'.encode()


def _zipped(files: Iterable[tuple[str, bytes]]) -> bytes:
    """Files in a zip that depends on nothing but their names and contents; pictures in PNG are packed as they are."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, content in files:
            info = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            info.create_system = 0
            info.compress_type = zipfile.ZIP_STORED if name.endswith(".png") else zipfile.ZIP_DEFLATED
            archive.writestr(info, content)
    return stream.getvalue()
