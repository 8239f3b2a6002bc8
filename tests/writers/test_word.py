"""The Word file: bytes, schemas, styles, fields, sections, pictures, and texts that stay texts."""

from __future__ import annotations

import re
import struct
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from reportgen.base.records import replace
from reportgen.document import Block, Equation, Figure, Paragraph, Plate, Section, Table, Text, plain
from reportgen.document.layout import Letter
from reportgen.drawing import Scene
from reportgen.formula import Matrix, Symbol, VectorEquation
from reportgen.writers import picture_files as drawn
from reportgen.writers import word
from tests.writers import sample
from tests.writers.pages import document
from tests.writers.word_file import WP, A, M, R, W, WordFile, letters_of, recounted, squash, style_of

EMU = 36000
"""Units of a picture's size in a millimetre."""
INCH = 25.4


def pictures(scenes: Any) -> list[tuple[bytes, bytes]]:
    return drawn.for_word(scenes, "vi")


@cache
def sample_bytes() -> bytes:
    return word.write(sample.sample(), pictures)


@cache
def sample_file() -> WordFile:
    return WordFile(sample_bytes())


def of(*blocks: Block) -> WordFile:
    return WordFile(word.write(document(*blocks), pictures))


# --- the package ----------------------------------------------------------------------------------


def test_the_same_document_is_the_same_bytes_without_a_date() -> None:
    assert word.write(sample.sample(), pictures) == sample_bytes()
    assert b"dcterms" not in sample_file().parts["docProps/core.xml"]


def test_every_relation_leads_to_a_part_and_nothing_lies_loose() -> None:
    file = sample_file()
    targets = {f"word/{one.get('Target')}" for one in file.xml("word/_rels/document.xml.rels")}
    assert targets == {
        name for name in file.parts if name.startswith("word/") and not re.search("_rels|document", name)
    }


def test_every_part_is_valid(tmp_path: Path) -> None:
    """By the schemas of the Open XML SDK, which are those of ECMA-376 in the transitional form.

    Left out: it asks for a theme and a table of fonts, which the standard does not, and for a list called 0, which by
    17.9.18 is the mark of a paragraph that is in no list.
    """
    audit = pytest.importorskip("openxml_audit")
    path = tmp_path / "report.docx"
    path.write_bytes(sample_bytes())
    known = ("A required relationship type", "Numbering definition '0' referenced")
    found = [one for one in audit.OpenXmlValidator().validate(path).errors if not one.description.startswith(known)]
    assert found == []


def test_the_properties_say_what_it_is() -> None:
    core = sample_file().xml("docProps/core.xml")
    said = [one.text for one in core]
    made = sample.sample()
    assert said == [made.title, made.author, "vi-VN"]


# --- styles ---------------------------------------------------------------------------------------


def test_every_paragraph_style_comes_of_normal_and_every_used_one_is_there() -> None:
    styles = {
        one.get(f"{W}styleId", ""): one
        for one in sample_file().xml("word/styles.xml").iter(f"{W}style")
        if one.get(f"{W}type") == "paragraph"
    }
    for id, style in styles.items():
        base = style.find(f"{W}basedOn")
        while base is not None and base.get(f"{W}val") != "Normal":
            base = styles[base.get(f"{W}val", "")].find(f"{W}basedOn")
        assert (base is None) == (id == "Normal"), id
    assert {style for style, _ in sample_file().lines} <= styles.keys()
    wanted = {"Normal", "Title", "List", "Table", "Equation", "Caption", "TOC1", "TOC2", "TOC3"}
    assert wanted | {f"Heading{level}" for level in (1, 2, 3)} <= styles.keys()


@pytest.mark.parametrize(("language", "size", "code"), [("vi", "26", "vi-VN"), ("en", "24", "en-GB")])
def test_letter_and_language(language: Any, size: str, code: str) -> None:
    """Times New Roman 13 in Vietnamese and 12 in English, in half points, unless another letter is asked for."""
    made = replace(document(Paragraph((Text("x"),))), language=language)
    for letter, font, wanted in ((None, "Times New Roman", size), (Letter("Arial", 14.0), "Arial", "28")):
        styles = WordFile(word.write(made, pictures, letter)).xml("word/styles.xml")
        normal = next(one for one in styles.iter(f"{W}style") if one.get(f"{W}styleId") == "Normal")
        fonts, points = (normal.find(f"{W}rPr/{W}{name}") for name in ("rFonts", "sz"))
        assert fonts is not None
        assert points is not None
        assert (fonts.get(f"{W}ascii"), points.get(f"{W}val")) == (font, wanted)
        tag = styles.find(f"{W}docDefaults/{W}rPrDefault/{W}rPr/{W}lang")
        assert tag is not None
        assert tag.get(f"{W}val") == code


# --- fields ---------------------------------------------------------------------------------------


def test_fields_have_the_results_that_counting_gives() -> None:
    found = list(recounted(sample_file()))
    assert len(found) > 20
    assert {code.split()[0] for code, _, _ in found} == {"SEQ", "STYLEREF", "REF"}
    assert [(code, squash(counted)) for code, _, counted in found] == [
        (code, squash(shown)) for code, shown, _ in found
    ]


def test_nothing_is_asked_on_opening() -> None:
    """A prompt comes of `updateFields`, of a field marked as dirty, and of fields that reach for other files."""
    file = sample_file()
    assert not any(b"updateFields" in part or b"w:dirty" in part for part in file.parts.values())
    every = {field.code.split()[0] for field in file.fields}
    assert every == {"TOC", "PAGEREF", "SEQ", "STYLEREF", "REF"}


def test_contents_list_the_headings_and_lead_to_them() -> None:
    file, made = sample_file(), sample.sample()
    entries = [
        one for one in file.body.iter(f"{W}p") if style_of(one).startswith("TOC") and style_of(one)[-1].isdigit()
    ]
    headings = [one for one in made.blocks if isinstance(one, Section) and one.level <= 3]
    for entry, heading in zip(entries, headings, strict=True):
        assert style_of(entry) == f"TOC{heading.level}"
        link = next(entry.iter(f"{W}hyperlink"))
        assert link.get(f"{W}anchor") in file.bookmarks
        assert squash(letters_of(link)) == squash(heading.number + plain(heading.title, "vi")).replace("_", "")


def test_bookmarks_are_one_each() -> None:
    marks = sample_file().bookmarks
    assert len(marks) == len(set(marks))
    assert all(re.fullmatch(r"_\w{1,39}", mark) for mark in marks)


# --- texts ----------------------------------------------------------------------------------------


def test_text_full_of_marks_is_text() -> None:
    hostile = sample.HOSTILE + """ <w:p/> &amp; ]]> <!-- --> "x" 'y'"""
    assert ("Normal", hostile) in of(Paragraph((Text(hostile),))).lines


def test_vietnamese_is_composed() -> None:
    assert ("Normal", "Ế ữ") in of(Paragraph((Text("E\u0302\u0301 u\u031b\u0303"),))).lines


def test_what_no_xml_can_hold_is_shown_as_missing() -> None:
    file = of(Paragraph((Text("a\x00b\x1bc\ufffed\ud800e"),)))
    assert ("Normal", "a�b�c�d�e") in file.lines


# --- formulas -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("expression", "shown"),
    [
        (Symbol("a", "BA", "n"), "sSubSup(a|BA|n)"),
        (Symbol("ab", over="segment"), "bar(ab)"),
        (sample.vector("v", "B"), "sSub(acc(v)|B)"),
        (Symbol("a") / Symbol("b"), "f(a|b)"),
        ((Symbol("a") + Symbol("b")) ** 2, "sSup(d(a+b)|2)"),
        (sample.sqrt(Symbol("a")), "rad(|a)"),
        (sample.cos(Symbol("φ")) ** 2, "func(sSup(cos|2)|φ)"),
        (Matrix(((Symbol("a"), Symbol("b")), (Symbol("c"), Symbol("d")))), "d(m(mr(a|b)|mr(c|d)))"),
    ],
)
def test_a_formula_is_words_own(expression: Any, shown: str) -> None:
    file = of(Equation((expression,)))
    (formula,) = file.body.iter(f"{M}oMath")
    assert "".join(_structure(one) for one in formula) == shown


def _structure(element: Any) -> str:
    """An element of a formula with its arguments, without its properties."""
    name = element.tag.rpartition("}")[2]
    if name == "r":
        return letters_of(element)
    parts = [one for one in element if not one.tag.endswith("Pr")]
    inner = ["".join(map(_structure, one)) if name != "m" else _structure(one) for one in parts]
    return f"{name}({'|'.join(inner)})"


def test_long_lines_are_broken_before_a_sign_and_numbered_once() -> None:
    file = of(Equation((sample.wide_chain(),), "eq", "1"), Paragraph((Text("x"),)))
    (table,) = file.body.iter(f"{W}tbl")
    rows = [letters_of(row) for row in table.iter(f"{W}tr")]
    assert len(rows) > 4
    assert all(re.match("[=+−·]", squash(row)) for row in rows[1:])
    assert [row.endswith("(1)") for row in rows] == [False] * (len(rows) - 1) + [True]


def test_a_vector_equation_has_what_is_known_below_each_term() -> None:
    equation = sample.velocity_equation()
    assert isinstance(equation, VectorEquation)
    (table,) = of(Equation((equation,))).body.iter(f"{W}tbl")
    cells = [
        [
            squash("".join(one.text or "" for one in cell.iter() if one.tag.endswith("}t")))
            for cell in row.iter(f"{W}tc")
        ]
        for row in table.iter(f"{W}tr")
    ]
    assert [row[3::2] for row in cells] == [
        ["vB", "vA", "vBA"],
        ["∥x", "⟂OA", "⟂AB"],
        ["?", "→", "?"],
        ["?", "ω1·R", "?"],
    ]
    assert [row[1] for row in cells[1:]] == ["phương", "chiều", "độlớn"]


# --- tables ---------------------------------------------------------------------------------------


def test_tables_are_tables_with_heads_that_repeat() -> None:
    table = sample.long_table(30)
    (element,) = of(table).body.iter(f"{W}tbl")
    rows = list(element.iter(f"{W}tr"))
    heads = [row.find(f"{W}trPr/{W}tblHeader") is not None for row in rows]
    assert heads == [True] * len(table.head) + [False] * len(table.rows)
    assert not list(element.iter(f"{W}trHeight"))
    spans = [one.get(f"{W}val") for one in element.iter(f"{W}gridSpan")]
    assert spans == ["3", "3"]
    widths = [round(int(one.get(f"{W}w", "0")) / 1440 * INCH, 1) for one in element.iter(f"{W}gridCol")]
    assert widths == [column.width for column in table.columns]


def test_a_table_wider_than_the_text_stands_on_a_turned_page() -> None:
    table = sample.long_table(3)
    wide = Table(tuple(type(one)(one.width * 1.5, one.align) for one in table.columns), table.head, table.rows)
    assert _papers(of(Paragraph((Text("x"),)), wide, Paragraph((Text("y"),)))) == [(210, 297), (297, 210), (210, 297)]


def _papers(file: WordFile) -> list[tuple[int, int]]:
    sizes = [(one.get(f"{W}w", "0"), one.get(f"{W}h", "0")) for one in file.body.iter(f"{W}pgSz")]
    return [(round(int(width) / 1440 * INCH), round(int(height) / 1440 * INCH)) for width, height in sizes]


# --- sections and figures -------------------------------------------------------------------------


def test_plates_and_turned_figures_have_pages_of_their_own() -> None:
    text, plate = Paragraph((Text("x"),)), Plate(sample.star(240, 24), (420.0, 297.0))
    file = of(text, plate, plate, text, Figure((Scene(230, 100, ()),), turned=True))
    assert _papers(file) == [(210, 297), (420, 297), (420, 297), (210, 297), (297, 210)]


def test_the_cover_has_neither_header_nor_footer() -> None:
    first, *others = sample_file().body.iter(f"{W}sectPr")
    kinds = [[one.tag for one in section if one.tag.endswith("Reference")] for section in (first, *others)]
    assert kinds[0] == []
    assert all(len(kind) == 2 for kind in kinds[1:])
    names = {one.get("Id"): one.get("Target") for one in sample_file().xml("word/_rels/document.xml.rels")}
    ids = [one.get(f"{R}id") for one in others[0] if one.tag.endswith("Reference")]
    header, footer = (sample_file().parts[f"word/{names[id]}"].decode() for id in ids)
    assert "STYLEREF 1" in header
    assert " PAGE " in footer


def test_pictures_have_their_size_their_svg_and_words_in_their_place() -> None:
    file, made = sample_file(), sample.sample()
    scenes = [scene for one in made.blocks if isinstance(one, Figure) for scene in one.scenes]
    scenes += [one.scene for one in made.blocks if isinstance(one, Plate)]
    drawn = list(file.body.iter(f"{WP}inline"))
    targets = {one.get("Id"): f"word/{one.get('Target')}" for one in file.xml("word/_rels/document.xml.rels")}
    assert len(drawn) == len(scenes)
    for inline, scene in zip(drawn, scenes, strict=True):
        extent, told = inline.find(f"{WP}extent"), inline.find(f"{WP}docPr")
        assert extent is not None
        assert told is not None
        size = [int(extent.get(name, "0")) / EMU for name in ("cx", "cy")]
        assert size == pytest.approx([scene.width, scene.height], abs=1e-4)
        assert re.match(r"\S+ [\d.]+[.,:]", told.get("descr", ""))
        blip = next(inline.iter(f"{A}blip"))
        png = file.parts[targets[blip.get(f"{R}embed")]]
        pixels = struct.unpack(">II", png[16:24])
        assert min(pixel / (length / INCH) for pixel, length in zip(pixels, size, strict=True)) > 200
        (svg,) = (one for one in blip.iter() if one.tag.endswith("}svgBlip"))
        assert file.parts[targets[svg.get(f"{R}embed")]].startswith(b"<svg")
