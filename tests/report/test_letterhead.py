"""A school's own Word file: its styles, header and footer are taken over; what could do harm is refused."""

from __future__ import annotations

import io
import re
import shutil
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from xml.etree import ElementTree

import pytest

from reportgen import api
from reportgen.base.errors import TemplateError
from reportgen.base.template_folders import templates
from reportgen.base.units import Language
from reportgen.workbook.letterhead import LARGEST, read_letterhead
from reportgen.writers.word_styles import merged, styles
from tests.lanes import matrix, proof
from tests.writers.word_file import W, WordFile

docx = pytest.importorskip("docx")

EXERCISE = Path(__file__).parents[2] / "assignments" / "plane-motion" / "01.yaml"
INCH = 25.4
FIELD = "<w:fldSimple {} w:instr=' {} '><w:r><w:t>1</w:t></w:r></w:fldSimple>"
NAMESPACE = 'xmlns:w="http://schemas.openxmlformats.org/wordprocessingml/2006/main"'


@pytest.fixture(scope="module")
def letterhead() -> bytes:
    """As a department makes it: in Arial 11, with margins, a header and a footer of its own."""
    from docx.oxml import parse_xml
    from docx.shared import Mm, Pt

    file = docx.Document()
    normal = file.styles["Normal"]
    normal.font.name, normal.font.size = "Arial", Pt(11)
    section = file.sections[0]
    section.top_margin, section.left_margin, section.right_margin = Mm(31), Mm(28), Mm(18)
    section.header.paragraphs[0].text = "Khoa Cơ khí <Mẫu>"
    footer = section.footer.paragraphs[0]
    footer.text = "Số trang: "
    footer._p.append(parse_xml(FIELD.format(NAMESPACE, "NUMPAGES")))
    file.add_paragraph("This text is not taken over.")
    stream = io.BytesIO()
    file.save(stream)
    return stream.getvalue()


Put = Callable[[bytes], Path]


@pytest.fixture
def school(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Put:
    """Puts a file into the templates of a school; gives an assignment of that school."""
    root = tmp_path / "templates"
    shutil.copytree(templates(), root)
    (root / "ours").mkdir()
    monkeypatch.setattr("reportgen.base.template_folders.templates", lambda: root)

    def put(data: bytes) -> Path:
        (root / "ours" / "report.docx").write_bytes(data)
        file = tmp_path / "mine.yaml"
        file.write_text(EXERCISE.read_text(encoding="utf-8") + "\nreport: {school: ours}\n", encoding="utf-8")
        return file

    return put


def changed(data: bytes, parts: Mapping[str, bytes], edit: Callable[[str, bytes], bytes] = lambda _, one: one) -> bytes:
    """A file with further parts, the others edited."""
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as new:
        for name in old.namelist():
            if name not in parts:
                new.writestr(name, edit(name, old.read(name)))
        for name, content in parts.items():
            new.writestr(name, content)
    return stream.getvalue()


def test_styles_header_footer_and_margins_are_taken_over(school: Put, letterhead: bytes, tmp_path: Path) -> None:
    data = api.word_files(school(letterhead), "typst", None)["report.docx"]
    file = WordFile(data)
    styles = {one.get(f"{W}styleId", ""): one for one in file.xml("word/styles.xml").iter(f"{W}style")}
    font, size = (styles["Normal"].find(f"{W}rPr/{W}{name}") for name in ("rFonts", "sz"))
    assert font is not None
    assert size is not None
    assert (font.get(f"{W}ascii"), size.get(f"{W}val")) == ("Arial", "22")
    # What a report needs beyond is added, headings stay in its list, and the language is the report's.
    assert {style for style, _ in file.lines} | {"TOC1"} <= styles.keys()
    assert styles["Heading1"].find(f"{W}pPr/{W}numPr/{W}numId") is not None
    language = file.xml("word/styles.xml").find(f"{W}docDefaults/{W}rPrDefault/{W}rPr/{W}lang")
    assert language is not None
    assert language.get(f"{W}val") == "vi-VN"
    assert "Khoa Cơ khí &lt;Mẫu&gt;" in file.parts["word/header1.xml"].decode()
    assert "NUMPAGES" in file.parts["word/footer1.xml"].decode()
    assert "not taken over" not in file.text()
    margins = next(file.body.iter(f"{W}pgMar"))
    found = [int(margins.get(f"{W}{side}", "0")) / 1440 * INCH for side in ("top", "left", "right")]
    assert found == pytest.approx([31, 28, 18], abs=0.05)


@pytest.mark.usefixtures("here")
def test_it_may_lie_beside_the_assignment(letterhead: bytes, tmp_path: Path) -> None:
    (tmp_path / "ours").mkdir()
    (tmp_path / "ours" / "report.docx").write_bytes(letterhead)
    path = tmp_path / "mine.yaml"
    path.write_text(EXERCISE.read_text(encoding="utf-8") + "\nreport: {templates: ours}\n", encoding="utf-8")
    file = WordFile(api.word_files(path, "typst", None)["report.docx"])
    assert "Khoa Cơ khí" in file.parts["word/header1.xml"].decode()


@pytest.mark.usefixtures("here")
@proof
def test_what_is_made_with_it_is_valid(school: Put, letterhead: bytes, tmp_path: Path) -> None:
    audit = pytest.importorskip("openxml_audit")
    path = tmp_path / "report.docx"
    path.write_bytes(api.word_files(school(letterhead), "typst", None)["report.docx"])
    known = ("A required relationship type", "Numbering definition '0' referenced")
    assert [
        one for one in audit.OpenXmlValidator().validate(path).errors if not one.description.startswith(known)
    ] == []
    assert docx.Document(str(path)).styles["Normal"].font.name == "Arial"


def test_styles_are_found_by_their_names_in_word_of_any_language(letterhead: bytes) -> None:
    """In other languages Word has other ids for them."""

    def renamed(name: str, part: bytes) -> bytes:
        return part.replace(b'"Heading1"', b'"u1"').replace(b'"Normal"', b'"Binhthng"') if "styles" in name else part

    own = WordFile(changed(letterhead, {}, renamed)).parts["word/styles.xml"].decode()
    own = own.replace('<w:name w:val="Binhthng"/>', '<w:name w:val="Normal"/>')
    made = merged(styles("Times New Roman", 13, "vi", False, 160), own, "vi")
    ids = re.findall(r'w:styleId="([^"]*)"', made)
    assert len(ids) == len(set(ids))
    assert {"Normal", "Heading1"} <= set(ids)
    assert not {"u1", "Binhthng"} & set(ids)


EXTERNAL = (
    b'<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="a" '
    b'Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/attachedTemplate" '
    b'Target="file:///c:/x.dotm" TargetMode="External"/></Relationships>'
)


def in_header(inserted: str) -> Callable[[str, bytes], bytes]:
    def edit(name: str, part: bytes) -> bytes:
        return part.replace(b"</w:p>", inserted.encode() + b"</w:p>") if name.startswith("word/header") else part

    return edit


def declared(name: str, part: bytes) -> bytes:
    entity = b'<!DOCTYPE w:styles [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;">]><w:styles'
    return part.replace(b"<w:styles", entity, 1) if name == "word/styles.xml" else part


def nested(name: str, part: bytes) -> bytes:
    return part.replace(b"</w:p>", b"<w:r>" * 100 + b"</w:r>" * 100 + b"</w:p>") if "header" in name else part


def instead(of: str, xml: str) -> Callable[[str, bytes], bytes]:
    return lambda name, part: xml.encode() if name == of else part


def in_styles(inserted: str) -> Callable[[str, bytes], bytes]:
    def edit(name: str, part: bytes) -> bytes:
        return part.replace(b"</w:styles>", inserted.encode() + b"</w:styles>") if name == "word/styles.xml" else part

    return edit


def margin(side: str, value: str) -> Callable[[str, bytes], bytes]:
    def edit(name: str, part: bytes) -> bytes:
        given = rf'(<w:pgMar [^>]*w:{side}=")[^"]*'.encode()
        return re.sub(given, rb"\g<1>" + value.encode(), part) if name == "word/document.xml" else part

    return edit


HEADER = f"<w:hdr {NAMESPACE}><w:p/></w:hdr>"
STYLE = '<w:style w:type="paragraph" w:styleId="{}"><w:name w:val="{}"/></w:style>'


def styled(inside: str) -> str:
    return STYLE.format("A", "a").replace("</w:style>", f"{inside}</w:style>")


def test_styles_of_the_school_never_take_the_ids_of_the_report() -> None:
    """A school may give the id of a style of the report to another style, also one that it lacks by name."""
    own = [("TOC1", "Our contents"), ("Normal", "Our text"), ("own-Normal", "Text"), ("heading1", "Our heading")]
    school = f"<w:styles {NAMESPACE}>{''.join(STYLE.format(id, name) for id, name in own)}</w:styles>"
    made = merged(styles("Times New Roman", 13, "vi", False, 160), school, "vi")
    ids = [one.get(f"{W}styleId", "").casefold() for one in ElementTree.fromstring(made).iter(f"{W}style")]
    assert len(ids) == len(set(ids))
    names = {name.get(f"{W}val") for name in ElementTree.fromstring(made).iter(f"{W}name")}
    assert {name for _, name in own} <= names


REFUSED: Mapping[str, tuple[str, Callable[[bytes], bytes]]] = {
    "macros": ("letterhead-macros", lambda one: changed(one, {"word/vbaProject.bin": b"x"})),
    "template": ("letterhead-links", lambda one: changed(one, {"word/_rels/settings.xml.rels": EXTERNAL})),
    "embedding": ("letterhead-objects", lambda one: changed(one, {"word/embeddings/oleObject1.bin": b"x"})),
    "object": ("letterhead-objects", lambda one: changed(one, {}, in_header("<w:r><w:object/></w:r>"))),
    "field": ("letterhead-field", lambda one: changed(one, {}, in_header(FIELD.format("", "INCLUDETEXT c:/x")))),
    "parted field": (
        "letterhead-field",
        lambda one: changed(
            one,
            {},
            in_header(
                '<w:r><w:fldChar w:fldCharType="begin"/></w:r><w:r><w:instrText> DDE</w:instrText></w:r>'
                '<w:r><w:instrText>AUTO a b</w:instrText></w:r><w:r><w:fldChar w:fldCharType="end"/></w:r>'
            ),
        ),
    ),
    "entities": ("letterhead-entities", lambda one: changed(one, {}, declared)),
    "nested": ("letterhead-bomb", lambda one: changed(one, {}, nested)),
    "bomb": ("letterhead-bomb", lambda one: changed(one, {"word/media/a.bin": b"\0" * 70_000_000})),
    "large": ("letterhead-bomb", lambda _: b"PK" + bytes(LARGEST)),
    "no zip": ("letterhead-damaged", lambda _: b"{\\rtf1}"),
    "damaged": ("letterhead-damaged", lambda one: one[: len(one) // 2]),
    "another root": ("letterhead-part", lambda one: changed(one, {}, instead("word/styles.xml", "<x/>"))),
    "styles that are a header": ("letterhead-part", lambda one: changed(one, {}, instead("word/styles.xml", HEADER))),
    "a header that is styles": (
        "letterhead-part",
        lambda one: changed(one, {}, instead("word/header1.xml", f"<w:styles {NAMESPACE}/>")),
    ),
    "an empty header": (
        "letterhead-part",
        lambda one: changed(one, {}, instead("word/header1.xml", f"<w:hdr {NAMESPACE}/>")),
    ),
    "a field without end": (
        "letterhead-part",
        lambda one: changed(
            one, {}, in_header('<w:r><w:fldChar w:fldCharType="begin"/></w:r><w:instrText>PAGE</w:instrText>')
        ),
    ),
    "a style twice": ("letterhead-twice", lambda one: changed(one, {}, in_styles(STYLE.format("Normal", "Other")))),
    "a name twice": ("letterhead-twice", lambda one: changed(one, {}, in_styles(STYLE.format("Other", "normal")))),
    "a style without name": (
        "letterhead-part",
        lambda one: changed(one, {}, in_styles('<w:style w:type="paragraph" w:styleId="Other"/>')),
    ),
    "a style on itself": (
        "letterhead-part",
        lambda one: changed(
            one, {}, in_styles(STYLE.format("A", "a").replace("</w:style>", '<w:basedOn w:val="A"/></w:style>'))
        ),
    ),
    "a size": (
        "letterhead-value",
        lambda one: changed(one, {}, in_styles(styled('<w:rPr><w:sz w:val="99999"/></w:rPr>'))),
    ),
    "a margin in words": ("letterhead-value", lambda one: changed(one, {}, margin("left", "wide"))),
    "a margin beyond all": ("letterhead-margins", lambda one: changed(one, {}, margin("left", "999999999999"))),
    "a margin beyond the page": ("letterhead-margins", lambda one: changed(one, {}, margin("top", "16000"))),
    "a header below the page": ("letterhead-margins", lambda one: changed(one, {}, margin("header", "16000"))),
    "a cell in a line": ("letterhead-part", lambda one: changed(one, {}, in_header("<w:tc><w:p/></w:tc>"))),
    "a look behind its words": (
        "letterhead-part",
        lambda one: changed(one, {}, in_header("<w:r><w:t>a</w:t><w:rPr/></w:r>")),
    ),
    "a length in words": (
        "letterhead-value",
        lambda one: changed(one, {}, in_styles(styled("<w:pPr><w:ind w:left='far'/></w:pPr>"))),
    ),
    "a colour that is none": (
        "letterhead-value",
        lambda one: changed(one, {}, in_styles(styled("<w:rPr><w:color w:val='-0'/></w:rPr>"))),
    ),
    "no styles": (
        "letterhead-damaged",
        lambda one: changed(one, {}, lambda name, part: b"<" if "styles" in name else part),
    ),
}


@pytest.mark.parametrize("language", matrix(["vi", "en"], ["en"]))
@pytest.mark.parametrize("case", REFUSED)
def test_what_could_do_harm_is_a_located_fault(
    letterhead: bytes, tmp_path: Path, case: str, language: Language
) -> None:
    code, spoilt = REFUSED[case]
    path = tmp_path / "report.docx"
    path.write_bytes(spoilt(letterhead))
    with pytest.raises(TemplateError) as raised:
        read_letterhead(path, language)
    assert str(raised.value).startswith(f"{path}:1:1: error[{code}]: ")


def test_a_picture_is_left_out(letterhead: bytes, tmp_path: Path) -> None:
    path = tmp_path / "report.docx"
    path.write_bytes(changed(letterhead, {}, in_header('<w:r><w:drawing><x xmlns="y"/></w:drawing></w:r>')))
    header = read_letterhead(path, "en").header
    assert "Khoa Cơ khí" in header
    assert "drawing" not in header
