"""A Word file put together by hand, for made-up reports: paragraphs, runs, built formulas, tables, and a package."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Sequence
from xml.sax.saxutils import escape

W = "http://schemas.openxmlformats.org/wordprocessingml/2006/main"
M = "http://schemas.openxmlformats.org/officeDocument/2006/math"
R = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
OPC = "http://schemas.openxmlformats.org/package/2006"
OFFICE = "application/vnd.openxmlformats-officedocument.wordprocessingml"


def run(text: str, look: str = "") -> str:
    properties = f"<w:rPr>{look}</w:rPr>" if look else ""
    return f'<w:r>{properties}<w:t xml:space="preserve">{escape(text)}</w:t></w:r>'


BOLD, STRUCK, HIDDEN = "<w:b/>", "<w:strike/>", "<w:vanish/>"
LOW, HIGH = '<w:vertAlign w:val="subscript"/>', '<w:vertAlign w:val="superscript"/>'


def math_run(text: str) -> str:
    return f'<m:r><m:t xml:space="preserve">{escape(text)}</m:t></m:r>'


def formula(inner: str) -> str:
    return f"<m:oMath>{inner}</m:oMath>"


def scripts(base: str, sub: str = "", sup: str = "") -> str:
    """A letter with index and exponent, built."""
    whole = f"<m:e>{math_run(base)}</m:e>"
    low, high = f"<m:sub>{math_run(sub)}</m:sub>", f"<m:sup>{math_run(sup)}</m:sup>"
    if sub and sup:
        return f"<m:sSubSup>{whole}{low}{high}</m:sSubSup>"
    if sub:
        return f"<m:sSub>{whole}{low}</m:sSub>"
    return f"<m:sSup>{whole}{high}</m:sSup>" if sup else math_run(base)


def fraction(top: str, bottom: str) -> str:
    return f"<m:f><m:num>{top}</m:num><m:den>{bottom}</m:den></m:f>"


def paragraph(inner: str, style: str = "") -> str:
    properties = f'<w:pPr><w:pStyle w:val="{style}"/></w:pPr>' if style else ""
    return f"<w:p>{properties}{inner}</w:p>"


def cell(inner: str, span: int = 1, merged: str = "") -> str:
    properties = '<w:tcW w:w="1500" w:type="dxa"/>'
    properties += f'<w:gridSpan w:val="{span}"/>' if span > 1 else ""
    properties += {"": "", "first": '<w:vMerge w:val="restart"/>', "more": "<w:vMerge/>"}[merged]
    return f"<w:tc><w:tcPr>{properties}</w:tcPr>{paragraph(inner)}</w:tc>"


def table(rows: Sequence[Sequence[str]], columns: int) -> str:
    """Rows of cells that are written already."""
    grid = '<w:gridCol w:w="1500"/>' * columns
    body = "".join(f"<w:tr>{''.join(row)}</w:tr>" for row in rows)
    properties = '<w:tblPr><w:tblW w:w="0" w:type="auto"/></w:tblPr>'
    return f"<w:tbl>{properties}<w:tblGrid>{grid}</w:tblGrid>{body}</w:tbl>{paragraph('')}"


STYLES = f'<w:styles xmlns:w="{W}">' + "".join(
    f'<w:style w:type="paragraph" w:styleId="{id}"><w:name w:val="{name}"/></w:style>'
    for id, name in (("Normal", "Normal"), ("u1", "heading 1"), ("u2", "heading 2"), ("u3", "heading 3"))
)
STYLES += "</w:styles>"


def package(body: str, parts: dict[str, str] | None = None, relations: str = "", types: str = "") -> bytes:
    """A file of a body; further parts by name, with what the text refers to and what they are."""
    document = (
        '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'
        f'<w:document xmlns:w="{W}" xmlns:m="{M}" xmlns:r="{R}" '
        'xmlns:o="urn:schemas-microsoft-com:office:office" xmlns:v="urn:schemas-microsoft-com:vml">'
        f'<w:body>{body}<w:sectPr><w:pgSz w:w="11906" w:h="16838"/></w:sectPr></w:body></w:document>'
    )
    files = {
        "[Content_Types].xml": f'<Types xmlns="{OPC}/content-types">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        '<Default Extension="xml" ContentType="application/xml"/>'
        f'<Override PartName="/word/document.xml" ContentType="{OFFICE}.document.main+xml"/>'
        f'<Override PartName="/word/styles.xml" ContentType="{OFFICE}.styles+xml"/>{types}</Types>',
        "_rels/.rels": f'<Relationships xmlns="{OPC}/relationships"><Relationship Id="rId1" '
        f'Type="{R}/officeDocument" Target="word/document.xml"/></Relationships>',
        "word/_rels/document.xml.rels": f'<Relationships xmlns="{OPC}/relationships"><Relationship Id="rId1" '
        f'Type="{R}/styles" Target="styles.xml"/>{relations}</Relationships>',
        "word/document.xml": document,
        "word/styles.xml": STYLES,
        **(parts or {}),
    }
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return stream.getvalue()
