"""A class that hands in reports in place of sheets: marked as ever, what is not read neither earning nor costing."""

from __future__ import annotations

import csv
import io
import zipfile
from pathlib import Path

import openpyxl
import pytest

from reportgen.base.errors import AssignmentError, Location
from reportgen.base.records import replace
from reportgen.case.answer_key import Key
from reportgen.cases import open_case
from reportgen.classes import class_marking, class_outputs
from reportgen.handin import agree, submission, word_report
from reportgen.handin.reading_book import NAME, is_unchanged, reading_book
from reportgen.handin.self_check import compare, read, reading
from reportgen.marking.answer_sheet import read_submission
from reportgen.marking.class_marks import grade_rows
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Answer, Submission, Verdict
from reportgen.marking.marking_policy import Policy, read_policy
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.summary_comment import comment
from reportgen.marking.toleranced_key import Ask, key_of
from tests.handin import made_reports, reports, wml
from tests.lanes import proof

FILE = made_reports.ROOT / "slotted-lever-01.yaml"
STUDENTS = {"K01": "Nguyễn Văn An", "K02": "Trần Thị Bình", "K03": "Lê Cường"}
RULES = Policy(guard=False)


@pytest.fixture(scope="module")
def assignments(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("assignments")
    text = FILE.read_text(encoding="utf-8")
    for id, name in STUDENTS.items():
        student = f"report:\n  student: {{name: {name}, id: {id}}}"
        (folder / f"{id}.yaml").write_text(text.replace("report:", student), encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def key() -> Key:
    return Ask().of(key_of(open_case(FILE, "vi")))


def report(
    key: Key,
    but: dict[str, str] | None = None,
    left: int = 0,
    head: str = "",
    parts: dict[str, str] | None = None,
    relations: str = "",
) -> bytes:
    """A report of all right values; `but` some by id, `left` of them without a position, with further `parts`."""
    lines = [wml.paragraph(wml.run(head))]
    later: list[str] = []
    for row in key.asked:
        place = row.positions[0]
        number = f"{row.values[row.at(place)]:.5g}".replace(".", ",")
        symbol = row.symbol.base + (f"_{row.symbol.sub}" if row.symbol.sub else "")
        symbol += f"^{row.symbol.sup}" if row.symbol.sup else ""
        written = (but or {}).get(row.id, f"{symbol} = {number} {row.unit}")
        if not row.single and len(later) < left:
            later.append(wml.paragraph(wml.run(written)))
        else:
            lines.append(wml.paragraph(wml.run(f"Vị trí 2: {written}")))
    ended = wml.paragraph(wml.run("Phần khác"), "u1")
    return wml.package("".join((*lines, ended, *later)), parts, relations)


def grades(graded: class_marking.Graded, policy: Policy = RULES) -> list[dict[str, str]]:
    made = {str(path): content for path, content in class_outputs.files_of(graded, policy, "typst", "en")}
    return list(csv.DictReader(io.StringIO(made["grades.csv"].decode("utf-8-sig"))))


def test_the_same_values_give_the_same_verdicts_by_sheet_and_by_report() -> None:
    for manner, seed in (("mixed", 5),):
        made = reports.report(manner, "four-bar-01", seed)
        scheme = marking_scheme(open_case(made_reports.ROOT / "four-bar-01.yaml", made.key.language), RULES)
        scheme = replace(scheme, key=made.key)
        own = submission([word_report.read(Path("r.docx"), made.file(), made.key)], made.key.language)
        typed = {place: Answer(answer.value, answer.text, Location("s.xlsx")) for place, answer in own.values.items()}
        sheet = Submission(own.assignment, "s.xlsx", typed, {})
        by_report, by_sheet = mark(scheme, own), mark(scheme, sheet)
        verdicts = [
            [
                (one.id, one.position, one.verdict, one.points, one.first)
                for one in marking.cells
                if (one.id, one.position) not in own.unread
            ]
            for marking in (by_report, by_sheet)
        ]
        assert verdicts[0] == verdicts[1]


def test_what_is_left_open_earns_nothing_and_the_total_stays(key: Key) -> None:
    """Else who leaves a fifth of the values open, “3 or 4”, has full marks for the rest."""
    scheme = marking_scheme(open_case(FILE, "vi"), RULES)
    content = report(key, {"a.D": "a_D = 3 m/s² hoặc 4 m/s²"})
    own = submission([word_report.read(Path("r.docx"), content, key)], "vi")
    marking = mark(replace(scheme, key=key), own)
    (cell,) = (cell for cell in marking.cells if cell.verdict is Verdict.unread)
    assert (cell.id, cell.points) == ("a.D", 0)
    assert marking.out_of == sum(one.worth for one in marking.cells)
    assert marking.points == marking.out_of - cell.worth
    # It is open, not wrong, and everybody is told.
    assert marking.open == (cell,)
    assert not marking.first_errors
    (line,) = (line for line in comment(marking, RULES) if line.startswith("– a_D"))
    assert "3 m/s² hoặc 4 m/s²" in line
    rows = grade_rows([marking], "en", (), RULES)
    assert (rows[0][-1], str(rows[1][-1])[:3]) == ("not read", "a_D")
    assert own.share_read == len(own.values) / (len(own.values) + 1)


@proof
def test_a_class_hands_in_reports_and_sheets_together(assignments: Path, key: Key, tmp_path: Path) -> None:
    handed = tmp_path / "handed"
    handed.mkdir()
    # Whose it is tells the file, the text, the folder; beside a sheet the sheet counts.
    (handed / "K01.docx").write_bytes(report(key, {"v.D": "v_D = 9,99 m/s", "a.D": "a_D = 3 m/s² hoặc 4 m/s²"}))
    (handed / "bai tap lon.docx").write_bytes(report(key, head="MSSV: K02"))
    (handed / "K03").mkdir()
    (handed / "K03" / "report.docx").write_bytes(report(key, {"v.D": "v_D = 9,99 m/s"}))
    scheme = marking_scheme(open_case(assignments / "K03.yaml"), RULES)
    right = {
        (row.id, k): Answer(float(row.values[row.at(k)]), "", Location("")) for row in key.asked for k in row.positions
    }
    book = reading_book(scheme.key, Submission("K03", "", right, {}))
    (handed / "K03" / "answers.xlsx").write_bytes(_as_plain_sheet(book))
    graded = class_marking.grade([handed], assignments, RULES, "en")
    assert [marking.key.id for marking in graded.markings] == ["K01", "K02", "K03"]
    assert [one.code for one in graded.problems if one.level == "note"] == ["own-beside-sheet"]
    first, second, third = grades(graded)
    assert (first["read"], first["to settle"]) == (f"{100 * (len(right) - 1) / len(right):.1f}".rstrip("0"), "1")
    assert first["not read"].startswith("a_D")
    assert (second["read"], second["to settle"], second["per cent"]) == ("100", "0", "100")
    assert (third["read"], third["per cent"]) == ("", "100")
    out = tmp_path / "out"
    files = {path.relative_to(out).as_posix() for path in class_outputs.put(graded, RULES, out, "typst", "en")}
    assert {f"{id}/marked.docx" for id in STUDENTS} <= files
    assert {f"{id}/{NAME}" for id in ("K01", "K02")} <= files
    assert f"K03/{NAME}" not in files
    said = [*class_outputs.student_lines(graded, "en").values(), *class_outputs.without_marks(graded, "en")]
    assert said[0].startswith("K01 Nguyễn Văn An: ")
    assert said[0].endswith(f"values to decide: 1 ({NAME})")


def _as_plain_sheet(book: bytes) -> bytes:
    """A reading without its fingerprint is a sheet like any other."""
    loaded = openpyxl.load_workbook(io.BytesIO(book))
    info = loaded.worksheets[-1]
    info.delete_rows(info.max_row)
    stream = io.BytesIO()
    loaded.save(stream)
    return stream.getvalue()


@proof
def test_a_reading_is_completed_by_hand_and_stays(assignments: Path, key: Key, tmp_path: Path) -> None:
    """As it was written it says nothing new; once a value is put in it is the sheet, and is not written over."""
    handed, out = tmp_path / "K01.docx", tmp_path / "out"
    handed.write_bytes(report(key, {"a.D": "a_D = 3 m/s² hoặc 4 m/s²", "v.D": "v_D: 1 m/s"}))
    first = class_marking.grade([handed], assignments, RULES, "en", out=out)
    list(class_outputs.put(first, RULES, out, "typst", "en"))
    target = out / "K01" / NAME
    written = target.read_bytes()
    again = class_marking.grade([handed], assignments, RULES, "en", out=out)
    assert again.markings[0].submission.file == str(handed)
    list(class_outputs.put(again, RULES, out, "typst", "en"))
    assert target.read_bytes() == written
    loaded = openpyxl.load_workbook(target)
    (cell,) = (
        one
        for row in loaded.worksheets[0].iter_rows()
        for one in row
        if one.value == "?" and loaded.worksheets[0].cell(one.row, 1).value == "a.D"
    )
    value = float(key.row("a.D").values[1])
    cell.value = value
    loaded.save(target)
    changed = target.read_bytes()
    completed = class_marking.grade([handed], assignments, RULES, "en", out=out)
    (marking,) = completed.markings
    assert marking.submission.values["a.D", 2].value == pytest.approx(value)
    # What is still open stays open.
    assert list(marking.submission.unread) == [("v.D", 2)]
    list(class_outputs.put(completed, RULES, out, "typst", "en"))
    assert target.read_bytes() == changed
    # Left beside the hand-in, it counts as well.
    (tmp_path / "both").mkdir()
    (tmp_path / "both" / "K01.docx").write_bytes(handed.read_bytes())
    (tmp_path / "both" / NAME).write_bytes(changed)
    beside = class_marking.grade([tmp_path / "both"], assignments, RULES, "en")
    assert beside.markings[0].points == marking.points


def test_where_too_little_is_read_there_is_no_mark(assignments: Path, key: Key, tmp_path: Path) -> None:
    handed = tmp_path / "K01.docx"
    handed.write_bytes(report(key, left=8))
    graded = class_marking.grade([handed], assignments, RULES, "en")
    assert not graded.markings
    (unsettled,) = graded.unsettled
    assert unsettled.key.id == "K01"
    assert len(graded.missing) == 2
    assert not graded.refused
    made = dict(class_outputs.files_of(graded, RULES, "typst", "en"))
    assert list(map(str, made)) == ["K01/feedback.txt", f"K01/{NAME}", "grades.csv", "class.pdf"]
    assert "This is no mark of 0" not in made[Path("grades.csv")].decode("utf-8-sig")
    assert "no mark" in "".join(class_outputs.student_lines(graded, "en").values())
    # A policy may take less.
    policy = tmp_path / "policy.yaml"
    policy.write_text("least_read: 40 %\nguard: false\n", encoding="utf-8")
    rules = read_policy(policy)
    assert rules.least_read == pytest.approx(0.4)
    (marking,) = class_marking.grade([handed], assignments, rules, "en").markings
    assert marking.points == len(marking.submission.values)
    assert not marking.first_errors


def test_a_report_of_pictures_only_has_no_mark(assignments: Path, key: Key, tmp_path: Path) -> None:
    """Nothing recognised is no mark of 0: log, grades.csv and the student say so, whatever `least_read` is."""
    (tmp_path / "K01.docx").write_bytes(wml.package(wml.paragraph(wml.run("Báo cáo K01"))))
    for rules in (RULES, replace(RULES, least_read=0.0)):
        graded = class_marking.grade([tmp_path / "K01.docx"], assignments, rules, "en")
        assert not graded.markings
        (student,) = graded.unsettled
        assert student.unsettled is not None
        assert student.unsettled.is_unrecognised
        made = dict(class_outputs.files_of(graded, rules, "typst", "en"))
        assert "0" in made[Path("K01/feedback.txt")].decode().splitlines()[0]
        rows = made[Path("grades.csv")].decode("utf-8-sig").splitlines()
        assert "handed in, but no mark: nothing was recognised" in rows[1]
        said = next(iter(class_outputs.student_lines(graded, "en").values()))
        assert said.startswith("K01 Nguyễn Văn An: no mark: nothing was recognised")


def test_right_values_in_white_earn_nothing_and_the_lecturer_hears_of_it(
    assignments: Path, key: Key, tmp_path: Path
) -> None:
    """A report that shows nothing and holds the key in white had 100 %."""
    white = report(key)
    with zipfile.ZipFile(io.BytesIO(white)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    document = parts["word/document.xml"].decode()
    parts["word/document.xml"] = document.replace("<w:r>", '<w:r><w:rPr><w:color w:val="FFFFFF"/></w:rPr>').encode()
    with zipfile.ZipFile(tmp_path / "K01.docx", "w") as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    graded = class_marking.grade([tmp_path / "K01.docx"], assignments, RULES, "en")
    assert not graded.markings
    assert {problem.code for problem in graded.problems} == {"word-unseen", "word-nothing"}
    (student,) = graded.unsettled
    assert student.unsettled is not None
    assert len(student.unsettled.unseen) > 10
    rows = grade_rows((), "en", graded.unmarked, RULES)
    assert "values in text that nobody sees" in rows[1]
    # A part of it in white is flagged on the marking.
    seen, hidden = report(key), word_report.read(tmp_path / "K01.docx", (tmp_path / "K01.docx").read_bytes(), key)
    own = submission([replace(word_report.read(tmp_path / "r.docx", seen, key), unseen=hidden.unseen)], "en")
    marking = mark(replace(marking_scheme(open_case(FILE, "vi"), RULES), key=key), own)
    assert marking.warnings == ("unseen",)


@proof
def test_a_download_of_moodle_has_reports_and_gets_marked_copies(assignments: Path, key: Key, tmp_path: Path) -> None:
    download = tmp_path / "download.zip"
    with zipfile.ZipFile(download, "w") as archive:
        archive.writestr("Nguyễn Văn An_4711_assignsubmission_file/bai.docx", report(key))
        archive.writestr("Trần Thị Bình_4712_assignsubmission_file/scan.pdf", b"%PDF")
        archive.writestr("Lê Cường_4713_assignsubmission_file/bai.docx", b"text")
    graded = class_marking.grade([download], assignments, RULES, "en")
    assert [marking.key.id for marking in graded.markings] == ["K01"]
    assert sorted(one.code for one in graded.problems) == ["own-not-read", "word-damaged"]
    assert {key.id for key in graded.refused} == {"K02", "K03"}
    made = {str(path): content for path, content in class_outputs.files_of(graded, RULES, "typst", "en")}
    names = zipfile.ZipFile(io.BytesIO(made["feedback.zip"])).namelist()
    assert "Nguyễn Văn An_4711_assignsubmission_file/marked.docx" in names


@proof
def test_a_report_of_nobody_and_one_of_two_are_told(assignments: Path, key: Key, tmp_path: Path) -> None:
    for name, head in (("a.docx", ""), ("b.docx", "Nhóm: K01 và K02")):
        (tmp_path / name).write_bytes(report(key, head=head))
    graded = class_marking.grade([tmp_path], assignments, RULES, "en")
    assert [one.code for one in graded.problems] == ["own-whose", "own-whose"]
    assert not graded.markings


def test_a_student_compares_the_report(key: Key, tmp_path: Path) -> None:
    case = open_case(FILE, "en")
    path = tmp_path / "report.docx"
    path.write_bytes(report(key))
    lines, agrees = compare(case, open_case(FILE), [path])
    assert agrees
    assert lines[-1].startswith("everything")
    path.write_bytes(report(key, {"v.D": "v_D = 9,99 m/s", "a.D": "a_D: 3 m/s²"}))
    lines, agrees = compare(case, open_case(FILE), [path])
    assert not agrees
    (first,) = (one for one in lines if "does not agree" in one)
    assert first.startswith(f"{path}:¶")
    assert "9,99" in first
    assert any("a_D at position 2 is not read" in one for one in lines)
    with pytest.raises(AssignmentError):
        compare(case, open_case(FILE), [tmp_path / "photo.jpg"])


def test_read_writes_a_sheet_that_nobody_loses(key: Key, tmp_path: Path) -> None:
    case = open_case(FILE, "en")
    path, target = tmp_path / "report.docx", tmp_path / NAME
    path.write_bytes(report(key, {"a.D": "a_D: 3 m/s²"}))
    own_key, own = read(case, open_case(FILE), [path], Ask())
    target.write_bytes(reading(own_key, own, target))
    back = read_submission(target, own_key, "en")
    assert is_unchanged(back)
    assert {place: answer.value for place, answer in back.values.items()} == pytest.approx(
        {place: answer.value for place, answer in own.values.items()}
    )
    assert back.unread.keys() == own.unread.keys()
    book = openpyxl.load_workbook(target)
    page = next(one for one in book.worksheets if one.title == "Not read")
    assert [one.value for one in page[2]][:4] == ["a.D", "a_D", "2", "report.docx:¶17"] or page[2][0].value == "a.D"
    reading(own_key, own, target)
    book.worksheets[0].cell(4, 5)
    next(one for row in book.worksheets[0].iter_rows() for one in row if one.value == "?").value = 3
    book.save(target)
    with pytest.raises(AssignmentError) as refused:
        reading(own_key, own, target)
    assert [one.code for one in refused.value.problems] == ["reading-completed"]


@pytest.mark.parametrize(
    ("first", "second", "same"),
    [
        ("3,214", "3,21", True),
        ("3,214", "3,2", True),
        ("3,214", "3,3", False),
        ("0,0512", "0,051", True),
        ("12", "13", False),
    ],
)
def test_two_values_are_one_where_one_is_rounded(first: str, second: str, same: bool) -> None:
    answers = [Answer(float(text.replace(",", ".")), text, Location("")) for text in (first, second)]
    assert agree(*answers) is same
