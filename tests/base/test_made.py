"""What stands of earlier runs: the same input stays, stale files go as long as nobody changed them."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from reportgen import api
from reportgen.base.provenance import MADE_OF, RECORD, Put, put_made
from reportgen.cli import app
from tests.report import built

OF = dict.fromkeys(MADE_OF, "as it was")


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir() if path.name != RECORD}


def put(folder: Path, *files: str, of: dict[str, str] = OF) -> Put:
    return put_made(folder, {name: name.encode() for name in files}, "report", of)


def test_files_of_the_same_input_stay(tmp_path: Path) -> None:
    put(tmp_path, "report.pdf", "report.typ")
    second = put(tmp_path, "report.docx")
    assert (second.paths, second.gone, second.left) == ((tmp_path / "report.docx",), (), ())
    assert names(tmp_path) == {"report.pdf", "report.typ", "report.docx"}
    # Both are known further on.
    third = put(tmp_path, "report.html", of={**OF, "version": "2"})
    assert {path.name for path in third.gone} == {"report.pdf", "report.typ", "report.docx"}
    assert names(tmp_path) == {"report.html"}


@pytest.mark.parametrize("changed", MADE_OF)
def test_whatever_changes_makes_a_file_stale(tmp_path: Path, changed: str) -> None:
    put(tmp_path, "report.pdf")
    assert put(tmp_path, "report.docx", of={**OF, changed: "otherwise"}).gone == (tmp_path / "report.pdf",)
    assert names(tmp_path) == {"report.docx"}


def test_a_file_that_somebody_went_on_with_is_named_and_left(tmp_path: Path) -> None:
    """For as long as it is stale; beside files of its own input it is in order."""
    put(tmp_path, "report.docx")
    (tmp_path / "report.docx").write_bytes(b"written on")
    assert put(tmp_path, "report.pdf").left == ()
    for version in ("2", "3"):
        later = put(tmp_path, "report.html", of={**OF, "version": version})
        assert (tmp_path / "report.docx") in later.left
        assert (tmp_path / "report.docx") not in later.gone
    assert put(tmp_path, "report.html").left == ()
    assert (tmp_path / "report.docx").read_bytes() == b"written on"


def test_what_nothing_vouches_for_is_left(tmp_path: Path) -> None:
    """A report of an earlier version, or somebody's own; what is written anew is replaced whatever it was."""
    (tmp_path / "report.pdf").write_bytes(b"of an earlier version")
    (tmp_path / "report.html").write_bytes(b"of an earlier version")
    assert put(tmp_path, "report.html").left == (tmp_path / "report.pdf",)
    assert (tmp_path / "report.html").read_bytes() == b"report.html"


def test_what_was_deleted_is_forgotten(tmp_path: Path) -> None:
    put(tmp_path, "report.pdf", "report.html")
    (tmp_path / "report.pdf").unlink()
    put(tmp_path, "report.html")
    (tmp_path / "report.pdf").write_bytes(b"report.pdf")
    assert put(tmp_path, "report.html", of={**OF, "version": "2"}).gone == ()


def test_kinds_of_files_do_not_concern_each_other(tmp_path: Path) -> None:
    put(tmp_path, "report.pdf")
    sheets = put_made(tmp_path, {"sheet-1.pdf": b""}, "sheet", {**OF, "assignment": "new"})
    assert (sheets.gone, sheets.left) == ((), ())
    assert put(tmp_path, "report.docx").left == ()
    assert names(tmp_path) == {"report.pdf", "report.docx", "sheet-1.pdf"}


BROKEN: dict[str, Callable[[str], str]] = {
    "empty": lambda text: "",
    "no JSON": lambda text: text[:-9],
    "a list": lambda text: "[]",
    "another form": lambda text: text.replace("reportgen-made/1", "reportgen-made/9"),
    "a way out": lambda text: text.replace('"report.pdf"', '"../out.pdf"'),
    "a number": lambda text: json.dumps({"format": "reportgen-made/1", "made": 7}),
    "deep": lambda text: "[" * 100_000,
}


@pytest.mark.parametrize("broken", BROKEN)
def test_a_record_that_cannot_be_understood_counts_as_missing(tmp_path: Path, broken: str) -> None:
    """Nothing goes by it, in this folder or beside it."""
    folder = tmp_path / "id"
    put(folder, "report.pdf")
    (tmp_path / "out.pdf").write_bytes(b"report.pdf")
    text = (folder / RECORD).read_text(encoding="utf-8")
    (folder / RECORD).write_text(BROKEN[broken](text), encoding="utf-8")
    later = put(folder, "report.html", of={**OF, "version": "2"})
    assert (later.gone, later.left) == ((), (folder / "report.pdf",))
    assert (tmp_path / "out.pdf").exists()


EXERCISE = built.ROOT / "assignments" / "plane-motion" / "01.yaml"
SHEETS = built.ROOT / "assignments" / "slider-crank-02.yaml"


def run(capsys: pytest.CaptureFixture[str], *arguments: object) -> list[str]:
    """What a command that succeeds says on standard error."""
    with pytest.raises(SystemExit) as end:
        app(list(map(str, arguments)), standalone_mode=True)
    assert end.value.code == 0
    return capsys.readouterr().err.splitlines()


def test_a_build_of_another_format_leaves_the_first(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "mine.yaml"
    file.write_bytes(EXERCISE.read_bytes())
    there, build = tmp_path / "out" / "mine", ("build", file, "--lang", "en", "--out", tmp_path / "out", "--format")
    assert run(capsys, *build, "pdf") == run(capsys, *build, "html") == []
    assert names(there) == {"report.pdf", "report.html"}
    assert run(capsys, *build, "docx") == []
    (there / "report.docx").write_bytes(b"written on")
    file.write_bytes(EXERCISE.read_bytes() + b"\n# looked through\n")
    removed, left = run(capsys, *build, "html")
    assert removed == f"reportgen: removed because its inputs have changed: {there / 'report.pdf'}"
    assert left.startswith("reportgen: kept because it was edited")
    assert left.endswith(str(there / "report.docx"))
    assert names(there) == {"report.html", "report.docx"}


def test_one_set_of_sheets_leaves_the_other(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Sheets laid out otherwise are another set: its second one would belong to nothing."""
    sheet = ("sheet", SHEETS, "--lang", "en", "--out", tmp_path, "--format", "dxf")
    second = tmp_path / SHEETS.stem / "sheet-2.dxf"
    assert run(capsys, *sheet) == []
    assert second.exists()
    assert run(capsys, *sheet, "--set", "kinematics") == []
    assert second.exists()
    told = run(capsys, *sheet, "--set", "kinematics", "--size", "A1")
    assert told == [f"reportgen: removed because its inputs have changed: {second}"]
    assert names(second.parent) == {"sheet-1.dxf"}


def test_a_file_of_a_part_and_a_schools_words_are_input(tmp_path: Path) -> None:
    folder = built.ROOT / "assignments" / "coursework"
    for path in folder.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    file, cam = tmp_path / "shaper.yaml", tmp_path / "feed-cam.yaml"
    before = api.made_of(file, "typst", None)
    assert before == api.made_of(file, "typst", "vi") != api.made_of(file, "typst", "en")
    cam.write_bytes(cam.read_bytes() + b"# another\n")
    assert api.made_of(file, "typst", None) != before
