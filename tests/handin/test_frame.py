"""The frame of a report filled in and read again: by the tags of its fields, by its bookmarks, by its text."""

from __future__ import annotations

import io
import random
import re
import shutil
import subprocess
import zipfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import pytest

from reportgen import api
from reportgen.case.answer_key import Key
from reportgen.cases import open_case
from reportgen.handin import FileReading, word_report
from reportgen.marking.blank_report import LONGEST, blank_name, bookmark_name
from reportgen.marking.toleranced_key import Ask, key_of
from tests.handin import made_reports
from tests.lanes import matrix, proof

CONTROL = re.compile(
    r'(<w:sdt><w:sdtPr><w:alias [^>]*/><w:tag w:val="([^"]*)"/>)<w:showingPlcHdr/>(<w:text/></w:sdtPr><w:sdtContent>)'
    r"<w:r><w:rPr>.*?</w:rPr><w:t[^>]*>……</w:t></w:r>"
)
NAMES = ("slotted-lever-01", "four-bar-01", "coursework/shaper", "gears/pair-least-shift")


@cache
def frame(name: str) -> bytes:
    return api.frame_files(made_reports.ROOT / f"{name}.yaml", "typst", "vi")["frame.docx"]


@cache
def key(name: str) -> Key:
    return Ask().of(key_of(open_case(made_reports.ROOT / f"{name}.yaml", "vi")))


def changed(content: bytes, text: str) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as new:
        for part in old.namelist():
            new.writestr(part, text if part == "word/document.xml" else old.read(part))
    return stream.getvalue()


def document(content: bytes) -> str:
    return zipfile.ZipFile(io.BytesIO(content)).read("word/document.xml").decode()


def filled(name: str) -> tuple[bytes, dict[str, str]]:
    """The frame with a number in each field, as Word leaves it, and the numbers by the names of the fields."""
    chance = random.Random(name)
    numbers: dict[str, str] = {}

    def fill(match: re.Match[str]) -> str:
        numbers[match[2]] = f"{chance.uniform(1, 900):.4g}".replace(".", ",")
        return f"{match[1]}{match[3]}<w:r><w:t>{numbers[match[2]]}</w:t></w:r>"

    return changed(frame(name), CONTROL.sub(fill, document(frame(name)))), numbers


def assert_read(name: str, reading: FileReading, numbers: Mapping[str, str]) -> None:
    names = {blank_name(key(name), (row.id, k)): (row.id, k) for row in key(name).asked for k in row.positions}
    assert numbers.keys() == names.keys()
    read = {field: abs(reading.values[names[field]].value) for field in numbers if names[field] in reading.values}
    assert read == pytest.approx({field: float(number.replace(",", ".")) for field, number in numbers.items()})
    assert not reading.unread


@pytest.mark.parametrize("name", matrix(NAMES, ["slotted-lever-01"]))
def test_a_frame_is_read_by_tags_or_bookmarks_or_as_text(name: str) -> None:
    content, numbers = filled(name)
    empty = word_report.read(Path("r.docx"), frame(name), key(name))
    assert not empty.values
    assert not empty.unread
    text = document(content)
    without_tags = re.sub(r"<w:tag [^>]*/>", "", text)
    plain = re.sub(r"<w:bookmark(?:Start|End)[^>]*/>", "", without_tags)
    for version in (text, without_tags, plain) if "/" not in name else (text, without_tags):
        assert_read(name, word_report.read(Path("r.docx"), changed(content, version), key(name)), numbers)


def test_a_field_goes_before_the_text_around_it() -> None:
    """What a student tries in between does not make two values of a field."""
    content, numbers = filled("slotted-lever-01")
    tried = '<w:p><w:r><w:t xml:space="preserve">Vị trí 2: v_D = 999 m/s</w:t></w:r></w:p>'
    text = document(content).replace("<w:body>", f"<w:body>{tried}")
    assert_read(
        "slotted-lever-01", word_report.read(Path("r.docx"), changed(content, text), key("slotted-lever-01")), numbers
    )


def test_the_names_of_bookmarks_are_words_that_word_takes_and_none_is_there_twice() -> None:
    names = [
        blank_name(key("coursework/shaper"), (row.id, k))
        for row in key("coursework/shaper").asked
        for k in row.positions
    ]
    marks = [bookmark_name(name) for name in names]
    assert len(set(marks)) == len(marks)
    assert all(re.fullmatch(rf"[A-Za-z]\w{{0,{LONGEST - 1}}}", mark, re.ASCII) for mark in marks)


@proof
@pytest.mark.skipif(shutil.which("soffice") is None, reason="LibreOffice is not installed")
def test_libreoffice_keeps_what_is_read(tmp_path: Path) -> None:
    """Through its own format and back: it loses all tags and keeps all bookmarks."""
    content, numbers = filled("slotted-lever-01")
    (tmp_path / "filled.docx").write_bytes(content)
    own = f"-env:UserInstallation={(tmp_path / 'profile').as_uri()}"
    for source, ending, out in (("filled.docx", "odt", "one"), ("one/filled.odt", "docx", "two")):
        command = ["soffice", "--headless", own, "--convert-to", ending, "--outdir", str(tmp_path / out)]
        subprocess.run([*command, str(tmp_path / source)], check=True, capture_output=True, timeout=170)
    back = (tmp_path / "two" / "filled.docx").read_bytes()
    assert_read("slotted-lever-01", word_report.read(Path("r.docx"), back, key("slotted-lever-01")), numbers)
