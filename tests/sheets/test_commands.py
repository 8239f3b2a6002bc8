"""The command, the batch and the title blocks: what they write, and what they say of wrong input."""

from __future__ import annotations

import errno
import io
import os
import re
from pathlib import Path

import ezdxf
import pytest
from typer.testing import CliRunner, Result

from reportgen import api
from reportgen.base.errors import AssignmentError
from reportgen.base.languages import languages, setting_of
from reportgen.base.records import replace
from reportgen.cases import open_case
from reportgen.cli import app
from reportgen.drawing import Label
from reportgen.drawing.geometry import frame
from reportgen.sheets import drawing_sheets
from reportgen.sheets.dxf import MText
from reportgen.sheets.title_block import FIELDS, blocks, fields_of, frame_scene, read_block
from tests.classes.classes import here, write_class
from tests.sheets.laid import ROOT

SMALL = ROOT / "assignments" / "four-bar-02.yaml"


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["sheet", *map(str, arguments)])


def test_sheets_are_written_as_both_files_and_those_of_others_stay(tmp_path: Path) -> None:
    """A sheet that nothing vouches for is named and left."""
    folder = tmp_path / SMALL.stem
    folder.mkdir()
    others = ("sheet-9.pdf", "sheet-9.dxf", "sheet-mine.pdf", "report.pdf")
    for name in others:
        (folder / name).write_bytes(b"earlier")
    done = run(SMALL, "--out", tmp_path)
    assert done.exit_code == 0
    assert [line.split()[-1] for line in done.stderr.splitlines()] == [
        f"{folder / name}" for name in sorted(others[:2])
    ]
    names = {path.name for path in folder.iterdir()}
    assert {"sheet-1.pdf", "sheet-1.dxf", *others} <= names
    made = {str(folder / name) for name in names if name[6:7].isdigit()} - {str(folder / name) for name in others}
    assert made == set(done.stdout.split())


def test_a_set_and_a_format_alone(tmp_path: Path) -> None:
    done = run(SMALL, "--out", tmp_path, "--set", "kinematics", "--format", "dxf", "--size", "A2", "--block", "gost")
    assert (done.exit_code, done.stderr) == (0, "")
    assert {path.suffix for path in (tmp_path / SMALL.stem).glob("sheet-*")} == {".dxf"}


@pytest.mark.parametrize(
    "wrong", [("--size", "A5"), ("--set", "all-of-it"), ("--format", "svg"), ("--block", "no-such-block")]
)
def test_unknown_choices_are_wrong_usage(tmp_path: Path, wrong: tuple[str, str]) -> None:
    done = run(SMALL, "--out", tmp_path, *wrong)
    assert done.exit_code == 2
    assert not (tmp_path / SMALL.stem).exists()


@pytest.mark.proof
def test_a_plate_larger_than_the_paper_is_named(tmp_path: Path) -> None:
    """At its crank, with the smallest size that holds all plates: no crank helps those of forces."""
    with pytest.raises(AssignmentError, match=r"engine-v-02.yaml:10:18: .*Họa đồ vị trí(.|\n)*A3(.|\n)*A2"):
        api.sheet_files(ROOT / "assignments" / "engine-v-02.yaml", size="A3", formats=())


@pytest.mark.proof
def test_a_crank_with_which_a_plate_fits_is_told(tmp_path: Path) -> None:
    """And it does."""
    text = SMALL.read_text(encoding="utf-8")
    (tmp_path / "long.yaml").write_text(text.replace("crank: 30 mm", "crank: 75 mm", 1), encoding="utf-8")
    with pytest.raises(AssignmentError) as caught:
        api.sheet_files(tmp_path / "long.yaml", size="A3", formats=())
    crank = re.search(r"drawing\.crank: (\d+) mm", str(caught.value))
    assert crank
    (tmp_path / "long.yaml").write_text(text.replace("crank: 30 mm", f"crank: {crank[1]} mm", 1), encoding="utf-8")
    api.sheet_files(tmp_path / "long.yaml", size="A3", formats=())


def test_a_full_disk_leaves_the_old_set(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The second file has no room: none of the new ones is there, and no file of the old ones is gone."""
    folder = tmp_path / SMALL.stem
    folder.mkdir()
    for number in (1, 2, 3):
        (folder / f"sheet-{number}.pdf").write_bytes(b"earlier")
    write, written = Path.write_bytes, []

    def full(path: Path, content: bytes) -> int:
        if path.parent == folder:
            written.append(path)
        if len(written) == 2:
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(path, content)

    monkeypatch.setattr(Path, "write_bytes", full)
    done = run(SMALL, "--out", tmp_path, "--size", "A1")
    assert done.exit_code == 3
    assert len(written) == 2
    monkeypatch.undo()
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == {
        f"sheet-{number}.pdf": b"earlier" for number in (1, 2, 3)
    }


def test_a_set_without_plates_is_told_and_leaves_earlier_sheets(tmp_path: Path) -> None:
    """The linkage has no loads and no masses."""
    (tmp_path / SMALL.stem).mkdir()
    (tmp_path / SMALL.stem / "sheet-1.pdf").write_bytes(b"earlier")
    done = run(SMALL, "--out", tmp_path, "--set", "forces")
    assert (done.exit_code, done.stdout) == (1, "")
    assert "--set forces" in done.stderr
    assert [path.name for path in (tmp_path / SMALL.stem).iterdir()] == ["sheet-1.pdf"]


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="an administrator may write anywhere")
def test_a_folder_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    done = run(SMALL, "--out", tmp_path / "below")
    assert done.exit_code == 3
    assert list(tmp_path.iterdir()) == []


def test_out_that_is_a_file_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    done = run(SMALL, "--out", tmp_path / "file")
    assert done.exit_code == 3
    assert (tmp_path / "file").read_text() == "mine"


# --- title blocks


@pytest.mark.parametrize("name", ["tcvn", "gost", "gb", "iso"])
def test_a_block_has_every_mandatory_cell(name: str) -> None:
    block = read_block(blocks()[name])
    # Letters that have room in any cell.
    marks = dict(zip(sorted(FIELDS), "abcdefghijklmnop", strict=False))
    shown, empty = (
        [str(item.content) for scene in scenes for item in scene.items if isinstance(item, Label)]
        for scenes in ((block.scene(fields), frame_scene("A3", block, fields)) for fields in (marks, {}))
    )
    filled = " ".join(text for text in shown if text not in empty)
    for field in FIELDS - {"class", "course", "variant"}:
        assert marks[field] in filled, field


@pytest.mark.parametrize(("name", "size"), [("tcvn", (185, 55)), ("gost", (185, 55)), ("gb", (180, 56))])
def test_a_block_has_the_size_of_its_standard(name: str, size: tuple[float, float]) -> None:
    assert read_block(blocks()[name]).size == size


def test_a_block_in_chinese_differs_from_the_one_in_english_in_its_words_alone() -> None:
    english, chinese = read_block(blocks()["gb"]), read_block(blocks(language="zh")["gb"])
    assert [replace(cell, text="") for cell in english.cells] == [replace(cell, text="") for cell in chinese.cells]
    told = "".join(re.sub(r"{\w+}", "", cell.text) for cell in chinese.cells)
    assert not re.search("[A-Za-z]", told)
    assert {"设计", "审核", "阶段标记", "比例"} <= {cell.text for cell in chinese.cells}


def test_each_language_has_a_block() -> None:
    assert {setting_of(language).block for language in languages()} <= set(blocks())


LONG = """  university: Trường Đại học Kỹ thuật Công nghiệp Thái Nguyên
  department: Bộ môn Kỹ thuật Cơ khí
  student: {name: Nguyễn Thị Hồng Phương Anh, id: DTK1051010123, class: K46CCM.01}
  supervisor: PGS. TS. Hoàng Văn Thành Công
  date: 2026-11-23
"""


@pytest.mark.parametrize("name", ["tcvn", "gost", "gb", "iso"])
def test_no_text_of_a_title_block_is_cut(tmp_path: Path, name: str) -> None:
    """However long names are, each word of them is there, and stands in its cell."""
    file = tmp_path / "long.yaml"
    file.write_text(SMALL.read_text(encoding="utf-8").replace("report:\n", f"report:\n{LONG}", 1), encoding="utf-8")
    block = read_block(blocks()[name])
    scene = block.scene({**fields_of(open_case(file), block, 1), "title": "Động lực học", "sheets": "2"})
    labels = [item for item in scene.items if isinstance(item, Label)]
    words = " ".join(str(label.content) for label in labels)
    for told in ("Nguyễn Thị Hồng Phương Anh", "PGS. TS. Hoàng Văn Thành Công", "Công nghiệp Thái Nguyên", "23.11.26"):
        assert all(word in words for word in told.split()), told
    assert "…" not in words
    for cell in block.cells:
        low, high = complex(cell.x, cell.y), complex(cell.x + cell.width, cell.y + cell.height)
        for label in labels:
            middle, half = frame(label)
            if low.real < middle.real < high.real and low.imag < middle.imag < high.imag:
                assert middle.real - half.real >= low.real, label.content
                assert middle.real + half.real <= high.real, label.content


@pytest.mark.parametrize(
    ("sheet", "designation"),
    [("", "TOM-02-01"), ("sheet: {course: ME214}\n", "ME214-02-01"), ("sheet: {designation: AB.07}\n", "AB.07")],
)
def test_a_sheet_is_designated_by_the_file_or_by_course_variant_and_number(
    tmp_path: Path, sheet: str, designation: str
) -> None:
    file = tmp_path / "any.yaml"
    file.write_text(sheet + SMALL.read_text(encoding="utf-8"), encoding="utf-8")
    assert fields_of(open_case(file), read_block(blocks()["iso"]), 1)["designation"] == designation


def test_further_sheets_have_their_own_form() -> None:
    """ГОСТ 2.104: form 1 of 55 mm, form 2a of 15 mm, columns of 145 and 120 mm beside both."""
    sheets = drawing_sheets(open_case(ROOT / "assignments" / "four-bar-01.yaml"), "A1", block=blocks()["gost"])
    heights = [next(part.scene.height for part in one.parts if part.name == "title block") for one in sheets]
    assert heights == [55, 15]
    for one in sheets:
        frame_of = next(part for part in one.parts if part.name == "frame")
        texts = [str(item.content) for item in frame_of.scene.items if isinstance(item, Label) and item.turn]
        assert {"Инв. № подл.", "Перв. примен."} <= set(texts)


BLOCK = """\
width: 100
height: 20
cells:
  - {x: 0, y: 0, width: 60, height: 20, text: "{machine}", letters: 5}
  - {x: 60, y: 0, width: 40, height: 20, text: "{sheet} of {sheets}"}
"""


def test_a_school_draws_a_block_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "ours.yaml").write_text(BLOCK)
    done = run(SMALL, "--out", tmp_path, "--block", tmp_path / "ours.yaml", "--format", "dxf")
    assert (done.exit_code, done.stderr) == (0, "")
    assert " of " in (tmp_path / SMALL.stem / "sheet-1.dxf").read_text()


def test_a_value_that_looks_like_a_field_is_no_field(tmp_path: Path) -> None:
    (tmp_path / "ours.yaml").write_text(BLOCK.replace("{sheet}", "{supervisor} {sheet}"))
    names = {"machine": "{supervisor}", "supervisor": "{sheet} {student} {", "sheet": "{sheets}", "sheets": "{machine}"}
    scene = read_block(tmp_path / "ours.yaml").scene(names)
    letters = [label.content for label in scene.items if isinstance(label, Label)]
    assert " ".join(map(str, letters)) == "{supervisor} {sheet} {student} { {sheets} of {machine}"


@pytest.mark.parametrize("name", ["%%d %%c %%%p %%%%d 5%%065", r"\P \\P C:\Public \H5; \S1^2;", "{supervisor} }{ ^ ^J"])
def test_a_name_in_dxf_stays_letters(name: str) -> None:
    document = ezdxf.new("R2010")
    document.modelspace().add_mtext(MText("vi").content(name))
    stream = io.StringIO()
    document.write(stream)
    (text,) = ezdxf.read(io.StringIO(stream.getvalue())).modelspace().query("MTEXT")
    assert text.plain_text(fast=False) == name


@pytest.mark.parametrize(
    ("wrong", "right", "fault"),
    [
        ("width: 40", "width: 50", ":5:5: error[block-outside]"),
        ("{machine}", "{mashine}", ":4:47: error[block-field]"),
        ("{machine}", "  ", ":4:47: error[block-blank]"),
        ("letters: 5", "letters: 1", ":4:69: error[out-of-range]"),
        ("width: 100", "wide: 100", ":1:1: error[unknown-key]"),
    ],
)
def test_a_wrong_block_is_located(tmp_path: Path, wrong: str, right: str, fault: str) -> None:
    file = tmp_path / "ours.yaml"
    file.write_text(BLOCK.replace(wrong, right))
    with pytest.raises(AssignmentError, match=r"^.*") as caught:
        read_block(file, "en")
    assert any(f"ours.yaml{fault}" in str(problem) for problem in caught.value.problems), caught.value


def test_a_cell_whose_fields_have_no_values_stays_blank(tmp_path: Path) -> None:
    (tmp_path / "ours.yaml").write_text(BLOCK.replace("{machine}", "{mass} {stage}"))
    scene = read_block(tmp_path / "ours.yaml").scene({"sheet": "1", "sheets": "2"})
    assert [item.content for item in scene.items if isinstance(item, Label)] == ["1 of 2"]


# --- a class


def test_a_batch_makes_sheets_of_a_class(tmp_path: Path) -> None:
    from io import StringIO

    from reportgen.classes.batch_run import Order, run_batch

    text = SMALL.read_text(encoding="utf-8")
    roster, given = write_class(tmp_path, {"K1": text, "K2": text.replace("40 mm", "42 mm", 1)})
    order = Order(roster, None, given, tmp_path / "out", ("sheet",), language="en")
    done = run_batch(order, StringIO(), pool=here)
    assert (done.made, done.exit_code) == (2, 0)
    first, second = ((tmp_path / "out" / id / "sheet-1.dxf").read_bytes() for id in ("K1", "K2"))
    assert first != second
