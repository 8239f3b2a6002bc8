"""Downloads of Moodle and Canvas as they come, and their tables, by the rules that the platforms document.

Moodle: a folder `Full name_4711_assignsubmission_file` (before 4.1 with `_` at its end, or all in the file's name), a
worksheet whose first column is "Participant 4711" and in which the greatest grade follows the grade.  Canvas: files
`sortablename[_LATE]_user_attachment_name`, the gradebook "Student, ID, SIS User ID, SIS Login ID, Section, Title (id)".
"""

from __future__ import annotations

import io
import stat
import zipfile
from collections.abc import Mapping
from pathlib import Path

import pytest

from reportgen.base.errors import AssignmentError, Fault
from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.classes import class_marking, class_outputs
from reportgen.classes.archives import MOST_MEMBERS
from reportgen.classes.gradebooks import Participant, StudentResult, read_gradebook
from reportgen.classes.platforms import Owner, handed_in, owner_of
from reportgen.classes.roster import read_roster
from reportgen.classes.variants import make_variants
from reportgen.marking.marking_policy import Policy, Scale
from reportgen.workbook.table_reading import LARGEST
from tests.commands import reportgen
from tests.lanes import matrix
from tests.marking import demo

AN, ANH, BAO = "K225520103001", "K225520103004", "K225520103007"
PEOPLE = {AN: "Nguyễn Hoàng An", ANH: "Trần Thị Ngọc Ánh", BAO: "Lê Văn Bảo"}
SHEETS = {path.stem: path for path in demo.SHEETS.iterdir()}


@pytest.fixture(scope="module")
def assignments(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Those of three students of the class: all that are there are computed, and more would show nothing more."""
    folder = tmp_path_factory.mktemp("assignments")
    make_variants(demo.DEMO / "spec.yaml", demo.DEMO / "roster.csv", folder, False, None)
    for file in folder.glob("*.yaml"):
        if file.stem not in PEOPLE:
            file.unlink()
    return folder


def archive(path: Path, members: Mapping[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as made:
        for name, content in members.items():
            made.writestr(name, content)
    return path


def sheet(id: str) -> tuple[str, bytes]:
    return SHEETS[id].suffix, SHEETS[id].read_bytes()


def moodle(numbers: Mapping[str, str]) -> dict[str, bytes]:
    return {
        f"{PEOPLE[id]}_{number}_assignsubmission_file/phiếu{sheet(id)[0]}": sheet(id)[1]
        for id, number in numbers.items()
    }


# --- whose it is ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "number", "name", "prefix"),
    [
        (
            "Lê Văn Bảo_4711_assignsubmission_file/a.xlsx",
            "4711",
            "Lê Văn Bảo",
            "Lê Văn Bảo_4711_assignsubmission_file/",
        ),
        ("d/Lê B_4711_assignsubmission_file_/x/a.csv", "4711", "Lê B", "Lê B_4711_assignsubmission_file_/"),
        ("Lê B_47_assignsubmission_file_a.xlsx", "47", "Lê B", "Lê B_47_assignsubmission_file_"),
        ("bảolêvăn_812_9001_bài_2.xlsx", "812", "bảolêvăn", "bảolêvăn_812_9001_"),
        ("bảolêvăn_LATE_812_9001_a.xlsx", "812", "bảolêvăn", "bảolêvăn_LATE_812_9001_"),
        ("anon_x7Yq2_9001_a.xlsx", "x7Yq2", "", "anon_x7Yq2_9001_"),
    ],
)
def test_the_name_of_a_file_says_who_handed_it_in(path: str, number: str, name: str, prefix: str) -> None:
    assert owner_of(path) == Owner(number, name, prefix)


def test_other_files_have_no_owner() -> None:
    assert owner_of("sheets/K225520103001.xlsx") is None
    assert owner_of("K22_7.csv") is None


def test_names_are_compared_without_order_case_and_accents() -> None:
    assert Owner("1", "bảolêvăn", "").may_be("Lê Văn Bảo")
    assert Owner("1", "BAO Le Van", "").may_be("Lê Văn Bảo")
    assert Owner("1", "Lê Văn Bảo - K22", "").may_be("Lê Văn Bảo")
    assert Owner("1", "Đỗ Hà", "").may_be("do ha")
    assert not Owner("1", "Trần Thị Ngọc Ánh", "").may_be("Lê Văn Bảo")


# --- a class from a download ------------------------------------------------------------------------


@pytest.mark.parametrize("packed", matrix([True, False], [True]))
def test_moodles_download_is_marked_and_given_back_under_its_names(
    packed: bool, assignments: Path, tmp_path: Path
) -> None:
    members = moodle({AN: "4711", ANH: "4712", BAO: "4713"})
    members["Vũ Hà_4714_assignsubmission_file/bai.txt"] = b"text"
    download = archive(tmp_path / "download.zip", members)
    if not packed:
        zipfile.ZipFile(download).extractall(tmp_path / "unpacked")
    result = class_marking.grade([download if packed else tmp_path / "unpacked"], assignments, Policy())
    assert [marking.key.id for marking in result.markings] == [AN, ANH, BAO]
    assert {id: owner.number for id, owner in result.owners.items()} == {AN: "4711", ANH: "4712", BAO: "4713"}
    # Whoever handed in no sheet is told, by the place of what there is.
    assert [problem.code for problem in result.problems] == ["download-no-sheet"]
    assert result.problems[0].location.file.endswith("Vũ Hà_4714_assignsubmission_file/bai.txt")
    files = dict(class_outputs.files_of(result, Policy(), "typst", None))
    with zipfile.ZipFile(io.BytesIO(files[Path("feedback.zip")])) as back:
        names = back.namelist()
        folder = f"{PEOPLE[BAO]}_4713_assignsubmission_file"
        assert back.read(f"{folder}/feedback.pdf") == files[Path(BAO, "feedback.pdf")]
    assert len(names) == 6
    assert {owner.number for name in names if (owner := owner_of(name))} == {"4711", "4712", "4713"}


def test_canvas_download_is_given_back_with_user_and_attachment(assignments: Path, tmp_path: Path) -> None:
    """Canvas finds the student by the first two numbers between underscores."""
    suffix, content = sheet(BAO)
    download = archive(tmp_path / "submissions.zip", {f"bảolêvăn_LATE_812_9001_bai_3{suffix}": content})
    result = class_marking.grade([download], assignments, Policy())
    files = dict(class_outputs.files_of(result, Policy(), "typst", None))
    with zipfile.ZipFile(io.BytesIO(files[Path("feedback.zip")])) as back:
        for name in back.namelist():
            assert [part for part in name.split("_") if part.isdigit()][:2] == ["812", "9001"]


def test_nobody_hands_in_for_another(assignments: Path, tmp_path: Path) -> None:
    """A sheet of Bảo in the folder of Ánh is told, not marked, and displaces nobody's own."""
    members = moodle({BAO: "4713"})
    suffix, content = sheet(BAO)
    members[f"{PEOPLE[ANH]}_4712_assignsubmission_file/a{suffix}"] = content
    result = class_marking.grade([archive(tmp_path / "d.zip", members)], assignments, Policy())
    assert [problem.code for problem in result.problems] == ["sheet-other-hands"]
    assert result.owners[BAO].number == "4713"


def test_hidden_names_tell_nothing(tmp_path: Path) -> None:
    members = {f"Participant_{n}_assignsubmission_file/a.csv": b"x" for n in (1, 2)}
    found = list(handed_in([archive(tmp_path / "d.zip", members)], []))
    assert [one.owner.name for one in found if one.owner] == ["", ""]


@pytest.mark.parametrize("word", ["Participant", "Участник", "Teilnehmer"])
def test_a_hand_in_without_a_name_is_matched_by_its_number(word: str, assignments: Path, tmp_path: Path) -> None:
    """With blind marking Moodle writes "Participant_553_assignsubmission_file" and "Participant 553"; one is alone."""
    suffix, content = sheet(BAO)
    members = {f"{word}_553_assignsubmission_file/phiếu{suffix}": content}
    worksheet = tmp_path / "worksheet.csv"
    rows = "".join(f"{word} {n},Submitted for grading,,10.00,Yes,-,-\n" for n in (552, 553))
    worksheet.write_text(
        "Identifier,Status,Grade,Maximum Grade,Grade can be changed,Last modified (submission),"
        f"Last modified (grade)\n{rows}",
        encoding="utf-8",
    )
    table = read_gradebook(worksheet)
    graded = class_marking.grade(
        [archive(tmp_path / "d.zip", members)], assignments, Policy(guard=False), gradebook=table
    )
    assert [marking.key.id for marking in graded.markings] == [BAO]
    written, unknown = class_outputs.put_gradebook(graded, table, Policy(), tmp_path / "out", None)
    mark = Policy().mark(graded.markings[0].share, 0)
    assert (
        written.read_text(encoding="utf-8").splitlines()[2].startswith(f"{word} 553,Submitted for grading,{mark:.2f},")
    )
    assert [problem.code for problem in unknown] == ["gradebook-no-comments"]


# --- hostile archives -------------------------------------------------------------------------------


def refused(path: Path) -> list[Fault]:
    faults: list[Fault] = []
    assert list(handed_in([path], faults)) == []
    return faults


@pytest.mark.parametrize("name", ["../a.csv", "/etc/a.csv", "x/../../a.csv", "C:/a.csv", "a\\..\\b.csv", "a\nb.csv"])
def test_a_name_that_leads_elsewhere_refuses_the_archive(name: str, tmp_path: Path) -> None:
    (fault,) = refused(archive(tmp_path / "d.zip", {"good.csv": b"x", name: b"x"}))
    assert fault.code == "archive-path"
    assert fault.location.file.startswith(str(tmp_path / "d.zip"))


def test_links_bombs_and_damage_are_refused(tmp_path: Path) -> None:
    link = zipfile.ZipInfo("a.csv")
    link.external_attr = (stat.S_IFLNK | 0o777) << 16
    with zipfile.ZipFile(tmp_path / "link.zip", "w") as made:
        made.writestr(link, "/etc/passwd")
    archive(tmp_path / "bomb.zip", {"a.csv": b"0" * 20_000_000})
    archive(tmp_path / "many.zip", {f"{n}.csv": b"" for n in range(MOST_MEMBERS + 1)})
    (tmp_path / "no.zip").write_bytes(b"PK\x03\x04 no archive")
    codes = {path.stem: refused(path)[0].code for path in tmp_path.glob("*.zip")}
    assert codes == {"link": "archive-path", "bomb": "archive-bomb", "many": "archive-bomb", "no": "archive-damaged"}


def test_a_sheet_that_is_too_large_is_a_fault_of_its_own(assignments: Path, tmp_path: Path) -> None:
    """Not more than a sheet may have is ever held of a member."""
    noise = bytes(range(256)) * (LARGEST // 256 + 256)
    with zipfile.ZipFile(tmp_path / "d.zip", "w", zipfile.ZIP_STORED) as made:
        made.writestr("large.csv", noise)
        made.writestr(f"{AN}{sheet(AN)[0]}", sheet(AN)[1])
    result = class_marking.grade([tmp_path / "d.zip"], assignments, Policy())
    assert [problem.code for problem in result.problems] == ["too-large"]
    assert result.problems[0].location.file == str(tmp_path / "d.zip" / "large.csv")
    assert len(result.markings) == 1


# --- Moodle's worksheet -----------------------------------------------------------------------------

EN = "Identifier,Full name,ID number,Email address,Status,Grade,Maximum Grade,Grade can be changed,"
EN += "Last modified (submission),Last modified (grade),Feedback comments"
VI = "Mã nhận dạng;Họ và tên;Email;Trạng thái;Điểm;Điểm tối đa;Có thể sửa điểm;Sửa lần cuối;Nhận xét"
RESULTS = [
    StudentResult(Participant("Bảo", frozenset({BAO.casefold()}), "4713"), 0.85),
    StudentResult(Participant("Ánh", frozenset({ANH.casefold()}), ""), 0.5),
]


def fill(
    path: Path, results: list[StudentResult], scale: Scale, column: str = "", language: Language | None = None
) -> tuple[bytes, list[Fault]]:
    marked = [replace(one, mark=scale.mark(one.mark) / scale.highest) for one in results]
    return read_gradebook(path, column, language).filled(marked)


def test_a_worksheet_is_filled_in_and_stays_as_it_was_otherwise(tmp_path: Path) -> None:
    text = (
        f"\ufeff{EN}\r\n"
        f'Participant 4713,"Lê Văn ""B"" Bảo",{BAO},b@x.vn,"Submitted, late",,10.00,Yes,"Monday, 2 June",-,\r\n'
        f'Participant 4712,Trần Thị Ngọc Ánh,{ANH},a@x.vn,Submitted,"3.00",10.00,Yes,-,-,"see\r\nsheet"\r\n'
        "Participant 4799,Vũ Hà,K9,h@x.vn,No submission,,10.00,Yes,-,-,\r\n"
    )
    path = tmp_path / "grades.csv"
    path.write_bytes(text.encode())
    filled, faults = fill(path, RESULTS, Scale())
    assert faults == []
    assert filled.decode() == text.replace(',,10.00,Yes,"Mon', ',8.50,10.00,Yes,"Mon').replace('"3.00"', '"5.00"')


def test_a_worksheet_in_utf_16_is_given_back_in_it(tmp_path: Path) -> None:
    text = f"{VI}\nNgười tham gia 4713;B;b@x.vn;Nộp;;10,00;Có;-;\n"
    path = tmp_path / "w.csv"
    path.write_bytes(text.encode("utf-16"))
    filled, _ = fill(path, RESULTS[:1], Scale())
    assert filled == text.replace("Nộp;;", "Nộp;8,50;").encode("utf-16")


def test_a_worksheet_in_vietnamese_with_semicolons_and_decimal_commas(tmp_path: Path) -> None:
    text = (
        f"{VI}\n"
        "Người tham gia 4713;Lê Văn Bảo;b@x.vn;Đã nộp;;100,00;Có;-;\n"
        f"Người tham gia 4712;Trần Thị Ngọc Ánh;{ANH};Đã nộp;;100,00;Có;-;\n"
    )
    path = tmp_path / "bang.csv"
    path.write_text(text, encoding="utf-8")
    filled, _ = fill(path, RESULTS, Scale())
    assert filled.decode() == text.replace("nộp;;", "nộp;85,00;", 1).replace("nộp;;", "nộp;50,00;")
    # With commas between the cells a decimal comma needs quotation marks.
    path.write_text(text.replace("100,00", '"100,00"').replace(";", ","), encoding="utf-8")
    assert 'Đã nộp,"85,00","100,00"' in fill(path, RESULTS, Scale())[0].decode()


def test_without_an_id_the_full_name_finds_the_row_if_only_one_has_it(tmp_path: Path) -> None:
    head = "Student,ID,SIS User ID,SIS Login ID,Section,Bài 1 (5)\n    Points Possible,,,,,10.00\n"
    rows = ('"Lê Văn, Bảo",1,,,S,\n', '"Trần, Ánh",2,,,S,\n', '"Trần, Ánh",3,,,S,\n', '"Vũ Hà",4,,,S,\n')
    path = tmp_path / "canvas.csv"
    path.write_text(head + "".join(rows), encoding="utf-8")
    people = [
        Participant("K1", frozenset({"k1"}), "", "Bảo Lê Văn"),
        Participant("K2", frozenset({"k2"}), "", "Ánh Trần"),
        # Who is known by the number keeps the row; whose name is also there does not get it.
        Participant("K3", frozenset({"k3"}), "4", "Vũ Hà B"),
        Participant("K4", frozenset({"k4"}), "", "Vũ Hà"),
    ]
    filled, faults = fill(path, [StudentResult(one, 0.5) for one in people], Scale())
    assert filled.decode() == (head + "".join(rows)).replace("1,,,S,", "1,,,S,5.00").replace("4,,,S,", "4,,,S,5.00")
    assert [fault.arguments["text"] for fault in faults] == ["K2", "K4"]


def test_whom_the_worksheet_does_not_name_is_told(tmp_path: Path) -> None:
    path = tmp_path / "w.csv"
    path.write_text(f"{VI}\nNgười tham gia 4713;B;b@x.vn;Nộp;;10,00;Có;-;\n", encoding="utf-8")
    _, faults = fill(path, RESULTS, Scale())
    assert [(fault.code, fault.arguments["text"]) for fault in faults] == [("gradebook-no-row", "Ánh")]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("id,name\n1,An\n", "gradebook-unknown"),
        (f'{EN}\nParticipant 1,A,,a@x,S,good,"bad\ngood",Yes,-,-,\n', "gradebook-no-column"),
        ('Student,ID,SIS User ID,SIS Login ID,Section,Bài 1 (5)\n"A, B",1,K1,b,S,\n', "gradebook-unknown"),
    ],
)
def test_another_table_is_refused(text: str, code: str, tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(AssignmentError) as found:
        fill(path, RESULTS, Scale())
    assert [(one.code, one.location.file) for one in found.value.problems] == [(code, str(path))]


def test_a_workbook_is_refused_since_no_platform_takes_it_back(tmp_path: Path) -> None:
    with pytest.raises(AssignmentError) as found:
        fill(tmp_path / "w.xlsx", RESULTS, Scale())
    assert found.value.problems[0].code == "gradebook-no-csv"


# --- Canvas's gradebook -----------------------------------------------------------------------------

CANVAS = (
    "Student,ID,SIS User ID,SIS Login ID,Section,Bài tập lớn (501),Kiểm tra (502),Current Score\n"
    ",,,,,Manual Posting,,\n"
    "    Points Possible,,,,,20,10,(read only)\n"
    f'"Bảo, Lê Văn",4713,{BAO},b@x.vn,NLM 01,,7,35\n'
    f'"Ánh, Trần Thị Ngọc",815,{ANH},a@x.vn,NLM 01,3,8,40\n'
    '"Student, Test",999,,5f0,NLM 01,,,\n'
)


def test_a_gradebook_is_filled_in_for_the_assignment_that_is_named(tmp_path: Path) -> None:
    path = tmp_path / "gradebook.csv"
    path.write_text(CANVAS, encoding="utf-8")
    wanted = CANVAS.replace("01,,7", "01,17.00,7").replace("01,3,8", "01,10.00,8")
    for column in ("501", "Bài tập lớn", "Bài tập lớn (501)"):
        assert fill(path, RESULTS, Scale(), column)[0].decode() == wanted
    with pytest.raises(AssignmentError) as found:
        fill(path, RESULTS, Scale(), language="en")
    (problem,) = found.value.problems
    assert "Bài tập lớn (501); Kiểm tra (502)" in problem.message


def test_the_mark_is_told_on_the_platforms_scale(tmp_path: Path) -> None:
    """A mark rounded to halves of 4 is the same share of the platform's points."""
    path = tmp_path / "gradebook.csv"
    path.write_text(CANVAS, encoding="utf-8")
    assert "01,17.50,7" in fill(path, RESULTS, Scale(4, 0.5), "501")[0].decode()


def test_a_wrong_gradebook_is_told_before_anything_is_marked(tmp_path: Path) -> None:
    """There are no assignments here either, which would be the fault that marking meets first."""
    book = tmp_path / "gradebook.csv"
    book.write_text(CANVAS, encoding="utf-8")
    out = tmp_path / "out"
    options = ("--assignments", tmp_path, "--gradebook", book, "--out", out, "--lang", "en")
    done = reportgen("grade", demo.SHEETS, *options)
    assert (done.returncode, done.stdout, out.exists()) == (1, "", False)
    assert done.stderr.startswith(f"{book}:1:1: error[gradebook-which-column]: ")


def test_put_does_not_overwrite_what_was_downloaded(assignments: Path, tmp_path: Path) -> None:
    result = class_marking.grade([SHEETS[BAO]], assignments, Policy())
    for place, name in ((tmp_path, "filled-gradebook.csv"), (tmp_path / "out", "gradebook.csv")):
        source = tmp_path / "gradebook.csv"
        source.write_text(CANVAS, encoding="utf-8")
        written, problems = class_outputs.put_gradebook(result, read_gradebook(source, "501"), Policy(), place, "en")
        assert (written, [one.code for one in problems]) == (place / name, ["gradebook-no-comments"])
        assert source.read_text(encoding="utf-8") == CANVAS


# --- lists of participants as rosters ---------------------------------------------------------------


def test_the_gradebook_of_canvas_is_a_roster(tmp_path: Path) -> None:
    path = tmp_path / "gradebook.csv"
    path.write_text(f"\ufeff{CANVAS}", encoding="utf-8")
    students = read_roster(path).students
    assert [(one.id, one.card["name"], one.card["section"]) for one in students] == [
        (BAO, "Lê Văn Bảo", "NLM 01"),
        (ANH, "Trần Thị Ngọc Ánh", "NLM 01"),
    ]


@pytest.mark.parametrize(
    "text",
    [
        f"First name,Last name,ID number,Email address,Groups\nLê Văn,Bảo,{BAO},b@x.vn,\n",
        f"\ufeffHọ;Tên;Số ID;Địa chỉ thư điện tử\nLê Văn;Bảo;{BAO};b@x.vn\n",
        f"{EN}\nParticipant 4713,Lê Văn Bảo,{BAO},b@x.vn,-,,10.00,Yes,-,-,\n",
    ],
)
def test_the_participants_of_moodle_are_a_roster(text: str, tmp_path: Path) -> None:
    path = tmp_path / "participants.csv"
    path.write_text(text, encoding="utf-8")
    (student,) = read_roster(path).students
    assert (student.id, student.card["name"], student.card["email"]) == (BAO, "Lê Văn Bảo", "b@x.vn")


def test_a_roster_gives_names_and_addresses(assignments: Path, tmp_path: Path) -> None:
    for id in (ANH, BAO):
        text = (assignments / f"{id}.yaml").read_text(encoding="utf-8")
        kept = [line for line in text.splitlines() if not line.lstrip().startswith(("name:", "email:", "#"))]
        (tmp_path / f"{id}.yaml").write_text("\n".join(kept), encoding="utf-8")
    roster = tmp_path / "gradebook.csv"
    roster.write_text(f"id,name,email\n{BAO},Lê Văn Bảo,b@x.vn\n", encoding="utf-8")
    result = class_marking.grade([SHEETS[BAO]], tmp_path, Policy(), roster=roster)
    assert result.markings[0].key.student["name"] == "Lê Văn Bảo"
    assert result.known[BAO] == Participant(
        f"{BAO} Lê Văn Bảo", frozenset({BAO.casefold(), "b@x.vn"}), "", "Lê Văn Bảo"
    )


def test_a_link_out_of_the_folder_handed_in_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "handed"
    folder.mkdir()
    secret = tmp_path / "secret.csv"
    secret.write_text("nobody,may,see\n", encoding="utf-8")
    (folder / "a.csv").symlink_to(secret)
    (folder / "b.csv").write_text("id,value\n", encoding="utf-8")
    faults: list[Fault] = []
    assert [handed.path.name for handed in handed_in([folder], faults)] == ["b.csv"]
    assert [(fault.code, fault.location.file) for fault in faults] == [("path-outside", str(folder / "a.csv"))]
