"""Archives as systems and students make them: names in other encodings, archives within a hand-in."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from pathlib import Path

import pytest

from reportgen.base.errors import Fault
from reportgen.classes.platforms import Handed, Owner, handed_in
from reportgen.classes.submission_matching import named_after


class RawName(zipfile.ZipInfo):
    """A member whose name is written as bytes, without the mark of UTF-8."""

    raw = b""

    def _encodeFilenameFlags(self) -> tuple[bytes, int]:
        return self.raw, 0


def unmarked(path: Path, names: Mapping[str, bytes]) -> Path:
    """An archive of files with a name that is encoded somehow."""
    with zipfile.ZipFile(path, "w") as made:
        for number, (content, raw) in enumerate(names.items()):
            member = RawName(f"{number}")
            member.raw = raw
            made.writestr(member, content)
    return path


def packed(members: Mapping[str, bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as made:
        for name, content in members.items():
            made.writestr(name, content)
    return stream.getvalue()


def found(path: Path, *people: str) -> list[Handed]:
    faults: list[Fault] = []
    handed = list(handed_in([path], faults, people))
    assert faults == []
    return handed


CLASS = {
    "utf-8": ("Nguyễn Văn Ân", "Trần Thị Ngọc Ánh"),
    "cp437": ("Müller José", "Peña Zoë"),
    "cp866": ("Иванов Пётр", "Сидорова Ольга"),
    "cp1251": ("Иванов Пётр", "Сидорова Ольга"),
    "gbk": ("王明", "欧阳小燕"),
}


@pytest.mark.parametrize("encoding", CLASS)
def test_names_without_the_mark_of_utf_8_are_those_of_the_class(encoding: str, tmp_path: Path) -> None:
    """The bytes are written as old programs write them; ASCII letters alone say nothing of the encoding."""
    names = {
        f"{number}": f"{name}_{number}_assignsubmission_file/bài.csv".encode(encoding, "replace")
        for number, name in enumerate(CLASS[encoding], start=10)
    }
    handed = found(unmarked(tmp_path / "d.zip", names), *CLASS[encoding])
    assert [one.owner.name for one in handed if one.owner] == list(CLASS[encoding])
    assert [one.data for one in handed] == [number.encode() for number in names]


def test_lost_letters_of_a_name_are_those_of_the_student() -> None:
    assert Owner("1", "Nguy?n V?n ?n", "").may_be("Nguyễn Văn Ân")
    assert Owner("1", "Nguy_n V_n An", "").may_be("Nguyễn Văn An")
    assert Owner("1", "王???", "").may_be("王明")
    assert not Owner("1", "Nguy?n V?n An", "").may_be("Nguyễn Văn Bình")


def test_an_archive_within_a_hand_in_is_opened(tmp_path: Path) -> None:
    """Its files are the student's, by the platform's folder, or by the archive's own name."""
    inner = packed({"bài tập/report.docx": b"docx", "plans.dxf": b"dxf", "~$report.docx": b""})
    download = tmp_path / "d.zip"
    download.write_bytes(packed({"Lê Bảo_47_assignsubmission_file/bai.zip": inner}))
    handed = found(download, "Lê Bảo")
    assert [(one.path.name, one.data, one.owner and one.owner.number) for one in handed] == [
        ("report.docx", b"docx", "47"),
        ("plans.dxf", b"dxf", "47"),
    ]
    folder = tmp_path / "handed"
    folder.mkdir()
    (folder / "K01.zip").write_bytes(inner)
    assert {named_after(one.path, {"k01"}) for one in found(folder)} == {"k01"}


def test_an_archive_that_is_not_opened_is_named_and_stops_nobody(tmp_path: Path) -> None:
    download = tmp_path / "d.zip"
    deep = packed({"a.zip": packed({"a.csv": b"x"})})
    members = {
        "A A_1_assignsubmission_file/a.zip": deep,
        "B B_2_assignsubmission_file/b.zip": packed({"b.csv": b"0" * 20_000_000}),
        "C C_3_assignsubmission_file/c.zip": b"PK no archive",
        "D D_4_assignsubmission_file/d.zip": packed({"d.txt": b"text"}),
        "E E_5_assignsubmission_file/e.csv": b"x",
        "F F_6_assignsubmission_file/f.rar": b"Rar!",
    }
    with zipfile.ZipFile(download, "w") as made:
        for name, content in members.items():
            made.writestr(name, content)
    told = {one.owner.number: one.fault and one.fault.code for one in found(download) if one.owner}
    assert told == {
        "1": "archive-nested",
        "2": "archive-bomb",
        "3": "archive-damaged",
        "4": "download-no-sheet",
        "5": None,
        "6": "own-not-read",
    }
