"""Elements of a Word file as text: runs, fields, paragraphs, pictures, sections, rules, in the schema's order.

Only `escape` converts texts into XML. The frames of whole parts are in `templates/frames/word/`.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping
from html import escape as escaped
from typing import Any

from reportgen.base.languages import PageMargins
from reportgen.base.records import Record, asdict, replace

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
"""Characters that XML cannot contain, not even as numeric references."""

MATH_FONT = "Cambria Math"
TWIPS, EMU = 1440 / 25.4, 36000
"""Units per millimetre: Word's unit of lengths, and that of pictures."""


def escape(text: str) -> str:
    """Return a text escaped for an element or an attribute, composed; characters that XML cannot contain become �."""
    return escaped(_IMPOSSIBLE.sub("\ufffd", unicodedata.normalize("NFC", text)))


def twips(millimetres: float) -> int:
    """Return a length in twips, twentieths of a point."""
    return round(millimetres * TWIPS)


# --- elements -------------------------------------------------------------------------------------


def run(text: str, look: str = "") -> str:
    """Return a run of text with one look; `look` are its property elements, in the schema's order."""
    properties = f"<w:rPr>{look}</w:rPr>" if look else ""
    return f'<w:r>{properties}<w:t xml:space="preserve">{escape(text)}</w:t></w:r>' if text else ""


def field(code: str, result: str, look: str = "") -> str:
    """Return a field with the result that it shows until it is updated."""
    properties = f"<w:rPr>{look}</w:rPr>" if look else ""

    def mark(kind: str) -> str:
        return f'<w:r>{properties}<w:fldChar w:fldCharType="{kind}"/></w:r>'

    instruction = f'<w:r>{properties}<w:instrText xml:space="preserve"> {escape(code)} </w:instrText></w:r>'
    return mark("begin") + instruction + mark("separate") + run(result, look) + mark("end")


def paragraph(style: str, content: str, properties: str = "") -> str:
    """Return a paragraph in a style, with further properties in the schema's order."""
    return f'<w:p><w:pPr><w:pStyle w:val="{style}"/>{properties}</w:pPr>{content}</w:p>'


SVG = "{96DAC541-7B7A-43D3-8B79-37D633B846F1}"
"""Id of a picture's SVG extension; programs that do not know it show the PNG."""


def drawing(number: int, width: float, height: float, description: str) -> str:
    """Return an inline picture by its number, in its size (mm), with its text alternative."""
    size = f'cx="{round(width * EMU)}" cy="{round(height * EMU)}"'
    named = f'id="{number}" name="figure{number}"'
    vector = f'<a:extLst><a:ext uri="{SVG}"><asvg:svgBlip r:embed="rel-figure{number}.svg"/></a:ext></a:extLst>'
    return (
        f'<w:r><w:drawing><wp:inline distT="0" distB="0" distL="0" distR="0"><wp:extent {size}/>'
        f'<wp:docPr {named} descr="{escape(description)}"/><wp:cNvGraphicFramePr>'
        '<a:graphicFrameLocks noChangeAspect="1"/></wp:cNvGraphicFramePr>'
        f'<a:graphic><a:graphicData uri="{NAMESPACES["pic"]}"><pic:pic>'
        f"<pic:nvPicPr><pic:cNvPr {named}/><pic:cNvPicPr/></pic:nvPicPr><pic:blipFill>"
        f'<a:blip r:embed="rel-figure{number}.png">{vector}</a:blip><a:stretch><a:fillRect/></a:stretch></pic:blipFill>'
        f'<pic:spPr><a:xfrm><a:off x="0" y="0"/><a:ext {size}/></a:xfrm>'
        '<a:prstGeom prst="rect"><a:avLst/></a:prstGeom></pic:spPr>'
        "</pic:pic></a:graphicData></a:graphic></wp:inline></w:drawing></w:r>"
    )


class PageSetup(Record):
    """Paper and margins of a section (mm); `above` and `below` are the distances of header and footer from the edge."""

    width: float = 210.0
    height: float = 297.0
    left: float = 30.0
    right: float = 20.0
    top: float = 22.0
    bottom: float = 20.0
    above: float = 11.0
    below: float = 9.0
    running: bool = True
    """True if it has header and footer."""
    framed: bool = False

    @property
    def room(self) -> float:
        """Width of the text (mm)."""
        return self.width - self.left - self.right


A4 = PageSetup()


class Own(Record):
    """A school's own parts: XML, "" for the default; margins by the names that pages use for them (mm)."""

    styles: str = ""
    header: str = ""
    footer: str = ""
    margins: Mapping[str, Any] | None = None

    def page(self, usual: PageMargins) -> PageSetup:
        """Return the page of the text, which is never narrower than figures and tables require."""
        page = replace(A4, **asdict(usual) | dict(self.margins or {}))
        return page if page.room >= A4.room else replace(page, left=A4.left, right=A4.right)


def section(page: PageSetup, running: str) -> str:
    """Return the properties of a section, which begins a page; `running` are references to its header and footer."""
    turned = ' w:orient="landscape"' if page.width > page.height else ""
    names = ("top", "right", "bottom", "left")
    lengths = {**{name: getattr(page, name) for name in names}, "header": page.above, "footer": page.below}
    margins = " ".join(f'w:{name}="{twips(length)}"' for name, length in {**lengths, "gutter": 0.0}.items())
    sides = "".join(f'<w:{name} w:val="double" w:sz="6" w:space="31" w:color="auto"/>' for name in _SIDES)
    frame = f'<w:pgBorders w:offsetFrom="text">{sides}</w:pgBorders>' if page.framed else ""
    size = f'<w:pgSz w:w="{twips(page.width)}" w:h="{twips(page.height)}"{turned}/>'
    return f'<w:sectPr>{running}<w:type w:val="nextPage"/>{size}<w:pgMar {margins}/>{frame}</w:sectPr>'


_SIDES = ("top", "left", "bottom", "right")

# --- looks of paragraphs and cells ------------------------------------------------------------------


def spaced(before: float, after: float, line: float = 0.0) -> str:
    """Return the spacing of a paragraph (points), and its line pitch if it differs from Normal."""
    pitch = f' w:line="{round(240 * line)}" w:lineRule="auto"' if line else ""
    return f'<w:spacing w:before="{round(20 * before)}" w:after="{round(20 * after)}"{pitch}/>'


def right_tab(at: float, leader: str = "") -> str:
    """Return a right-aligned tab stop (mm)."""
    dots = f' w:leader="{leader}"' if leader else ""
    return f'<w:tab w:val="right"{dots} w:pos="{twips(at)}"/>'


CENTRE, LEFT = '<w:jc w:val="center"/>', '<w:jc w:val="left"/>'
BOLD, ITALIC = "<w:b/><w:bCs/>", "<w:i/><w:iCs/>"
KEPT = "<w:keepNext/>"

GRID = "Grid"
"""Table style without rules and margins, for content side by side."""
RULED = "Ruled"
"""Table style of a report's tables."""
HEAVY, LIGHT = 6, 4
"""Widths of rules in eighths of a point: 0.8 and 0.5 pt, rounded to widths that Word has."""


def rule(side: str, width: int) -> str:
    """Return a rule at a side of a table or a cell; without `width` there is no rule."""
    kind = "single" if width else "nil"
    return f'<w:{side} w:val="{kind}" w:sz="{width}" w:space="0" w:color="auto"/>'


def control(tag: str, title: str, hint: str) -> str:
    """Return an empty inline content control for plain text; its placeholder disappears when text is typed."""
    about = f'<w:alias w:val="{escape(title)}"/><w:tag w:val="{escape(tag)}"/><w:showingPlcHdr/><w:text/>'
    content = run(hint, '<w:color w:val="808080"/>')
    return f"<w:sdt><w:sdtPr>{about}</w:sdtPr><w:sdtContent>{content}</w:sdtContent></w:sdt>"
