"""Word files of strangers: what is refused, what is only left alone, and that nothing of it is opened or fetched."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import pytest

from reportgen.handin import word_file, word_nodes
from reportgen.handin.word_comments import MarginNote, with_comments
from reportgen.handin.word_file import open_word
from reportgen.handin.word_reader import read_report
from reportgen.workbook.zip_package import RefusedError
from tests.handin import made_reports, wml

BODY = wml.paragraph(wml.run("v_D = 0,25 m/s"))


def refusal(content: bytes) -> str:
    with pytest.raises(RefusedError) as refused:
        open_word(Path("r.docx"), content)
    return refused.value.fault.code


def relation(kind: str, target: str, external: bool = True) -> str:
    mode = ' TargetMode="External"' if external else ""
    return f'<Relationship Id="rId7" Type="{wml.R}/{kind}" Target="{target}"{mode}/>'


def with_part(name: str, content: bytes) -> bytes:
    stream = io.BytesIO(wml.package(BODY))
    with zipfile.ZipFile(stream, "a", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, content)
    return stream.getvalue()


ENTITY = '<?xml version="1.0"?><!DOCTYPE x [<!ENTITY a "aaaa">]><x>&a;</x>'


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"no zip at all", "word-damaged"),
        (b"\xd0\xcf\x11\xe0" + b"\0" * 600, "word-old"),
        (b"\xd0\xcf\x11\xe0" + "EncryptedPackage".encode("utf-16-le"), "word-encrypted"),
        (with_part("word/vbaProject.bin", b"x"), "word-macros"),
        (with_part("word/settings.xml", ENTITY.encode()), "word-entities"),
        (with_part("word/big.bin", bytes(9_000_000)), "word-bomb"),
        (wml.package(BODY, relations=relation("oleObject", "file:///etc/passwd")), "word-links"),
        (wml.package(BODY, relations=relation("subDocument", "other.docx")), "word-links"),
        (wml.package("<w:p>" * 250 + "</w:p>" * 250), "word-elements"),
        (wml.package(BODY, {"word/document.xml": "<w:document"}), "word-damaged"),
        (wml.package(BODY, {"word/document.xml": ENTITY}), "word-entities"),
        (wml.package(BODY, {"word/document.xml": "<other/>"}), "word-damaged"),
    ],
)
def test_it_is_refused(content: bytes, code: str) -> None:
    assert refusal(content) == code


def test_a_text_of_too_many_elements_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(word_nodes, "MOST_ELEMENTS", 50)
    assert refusal(wml.package(BODY * 50)) == "word-elements"


def test_a_file_that_is_too_large_is_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(word_file, "LARGEST", 100)
    assert refusal(wml.package(BODY)) == "word-large"


def test_pictures_and_links_of_honest_files_are_left_alone() -> None:
    """A linked picture is not fetched, a picture inside not looked at, a hyperlink not followed."""
    links = relation("image", "http://example.org/a.png") + relation("hyperlink", "http://example.org").replace(
        "7", "8"
    )
    file = open_word(Path("r.docx"), wml.package(BODY, {"word/media/a.png": "no picture"}, relations=links))
    assert file.blocks
    assert not file.notes


def test_a_template_that_stands_elsewhere_is_told_and_dropped_from_the_copy() -> None:
    """Who opens the copy fetches nothing; the student's own file is honest and is read."""
    template = '<w:zoom w:percent="100"/><w:attachedTemplate r:id="rId1"/>'
    settings = f'<w:settings xmlns:w="{wml.W}" xmlns:r="{wml.R}">{template}</w:settings>'
    attached = relation("attachedTemplate", "file:///C:/Users/x/report.dotm")
    parts = {
        "word/settings.xml": settings,
        "word/_rels/settings.xml.rels": f'<Relationships xmlns="{wml.OPC}/relationships">{attached}</Relationships>',
    }
    own = relation("settings", "settings.xml", external=False)
    file = open_word(Path("r.docx"), wml.package(BODY, parts, relations=own))
    assert [note.code for note in file.notes] == ["word-template"]
    copy = zipfile.ZipFile(io.BytesIO(with_comments(file, [MarginNote("read")])))
    everything = b"".join(copy.read(name) for name in copy.namelist())
    assert b"dotm" not in everything
    assert b"attachedTemplate" not in everything
    assert b'<w:zoom w:percent="100"/>' in copy.read("word/settings.xml")


@pytest.mark.parametrize(
    "text",
    [
        "v" + "_" * 9000 + "= 1",
        "v" + "′" * 9000 + " = 1",
        "v_D=1 " * 1500,
        "v_D = " + "1,2 " * 2200,
        "v_D = 1 " + "(" * 9000,
        "x_{" * 3000,
        "v_D = 1" + "·10^" * 2000,
    ],
)
def test_a_line_made_to_take_long_is_looked_through_once(text: str) -> None:
    """A pattern that tries all ways to part such a line would take minutes, and the run with it."""
    blocks = open_word(Path("r.docx"), wml.package(wml.paragraph(wml.run(text)))).blocks
    assert not read_report(blocks, made_reports.key_for("slotted-lever-01", "vi"), "r.docx").values
