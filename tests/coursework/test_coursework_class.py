"""A class of courseworks: the parts are drawn with the machine, frozen beside it, made, handed in and marked."""

from __future__ import annotations

import re
from hashlib import sha256
from pathlib import Path

import pytest

from reportgen.api import task_files
from reportgen.assignment.common import Assignment
from reportgen.base.errors import AssignmentError
from reportgen.base.records import replace
from reportgen.cases import open_case
from reportgen.catalogue import load
from reportgen.classes.batch_run import Order, Result, run_batch
from reportgen.classes.class_marking import grade
from reportgen.classes.roster import assignment_files, beside
from reportgen.classes.variant_draw import pick
from reportgen.classes.variants import Variants, make_variants
from reportgen.classes.worker_pool import Job, making, run_job
from reportgen.marking.answer_sheet import read_submission
from reportgen.marking.class_marks import grade_rows
from reportgen.marking.judging import compare, mark
from reportgen.marking.marking_policy import Policy, read_policy
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.toleranced_key import Ask, key_of
from reportgen.workbook import write_csv
from tests.lanes import proof
from tests.marking.filled import filled

FOLDER = Path(__file__).parents[2] / "assignments" / "coursework"
STUDENTS = [f"K2255201030{number:02d}" for number in range(1, 13)]
ANGLES = ("12 deg", "15 deg", "18 deg")


def drawn(folder: Path, count: int = 12, sample: str = "shaper") -> Variants:
    """The files of a class in `out`, from a spec of a shaper with a spec of its cam."""
    spec = re.sub(r"variant: \d", "salt: s", (FOLDER / f"{sample}.yaml").read_text(encoding="utf-8"))
    spec = re.sub(r"H: 3.0 mm", "H: {from: 280 mm, to: 340 mm, step: 10 mm}", spec).replace("feed-cam", "cams")
    for name in ("motor-train.yaml", "drive-pair.yaml"):
        (folder / name).write_bytes((FOLDER / name).read_bytes())
    cams = (FOLDER / "feed-cam.yaml").read_text(encoding="utf-8")
    (folder / "spec.yaml").write_text(spec, encoding="utf-8")
    (folder / "cams.yaml").write_text(
        cams.replace("15 deg", f"[{', '.join(ANGLES)}]").replace(
            "r0: 80 mm", "r0: {from: 76 mm, to: 84 mm, step: 4 mm}"
        ),
        encoding="utf-8",
    )
    rows = "".join(f"{id},Student {id}\n" for id in STUDENTS[:count])
    (folder / "roster.csv").write_text(f"id,name\n{rows}", encoding="utf-8")
    return make_variants(folder / "spec.yaml", folder / "roster.csv", folder / "out")


def part_of(file: Path) -> Assignment:
    (part,) = load(file).parts
    return part.alone


def edited(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


def cam_of(file: Path) -> Path:
    return file.with_suffix(".cam.yaml")


def test_a_part_is_drawn_with_the_machine_and_frozen_beside_it(tmp_path: Path) -> None:
    """The value of a part is drawn by the rule of all, by the name of the part and the path there."""
    files = drawn(tmp_path).files
    names = {path.name for path in (tmp_path / "out").glob("*.yaml")}
    assert names == {f"{id}{end}" for id in STUDENTS for end in (".yaml", ".cam.yaml")}
    assert {path.stem for path in assignment_files(tmp_path / "out", None).values()} == set(STUDENTS)
    first = files[0].drawn.student.id
    wanted = ANGLES[pick("spec", "s", first, "cam.parameters.psi_max", 0, 3)]
    assert part_of(files[0].path).parameters.psi_max.text == wanted
    assert len({(str(load(one.path).parameters), str(part_of(one.path).parameters)) for one in files}) == len(files)
    assert {one.state for one in drawn(tmp_path).files} == {"same"}


def test_the_hash_of_a_student_covers_the_parts(tmp_path: Path) -> None:
    """It is that of what follows: `{ tail -n +4 K1.yaml; cat K1.cam.yaml; } | sha256sum`."""
    one, two, three = (file.path for file in drawn(tmp_path, 3).files)
    *head, body = one.read_text(encoding="utf-8").split("\n", 3)
    both = body + cam_of(one).read_text(encoding="utf-8")
    assert head[-1].endswith(sha256(both.encode()).hexdigest())
    edited(cam_of(one), "132 mm", "133 mm")
    cam_of(two).unlink()
    again = drawn(tmp_path, 3)
    assert [file.state for file in again.files] == ["kept", "changed", "same"]
    assert str(one) in " ".join(again.remarks)
    assert "133 mm" in cam_of(one).read_text(encoding="utf-8")
    assert part_of(two).parameters.psi_max.text in ANGLES
    table = (tmp_path / "out" / "variants.csv").read_text(encoding="utf-8-sig").splitlines()
    assert all(
        part_of(path).parameters.psi_max.text in row for path, row in zip((one, two, three), table[1:], strict=True)
    )


def test_a_students_files_build_in_any_folder(tmp_path: Path) -> None:
    (file,) = (one.path for one in drawn(tmp_path, 1).files)
    (tmp_path / "elsewhere").mkdir()
    for path in (file, cam_of(file)):
        path.rename(tmp_path / "elsewhere" / path.name)
    assert load(tmp_path / "elsewhere" / file.name).parts


def test_a_parts_file_is_never_a_students(tmp_path: Path) -> None:
    """Neither if its machine's file is gone or torn, nor if it is torn itself; a machine that another names stays."""
    one, two, three = (file.path for file in drawn(tmp_path, 3).files)
    one.unlink()
    two.write_text("kind: [", encoding="utf-8")
    cam_of(three).write_text("kind: [", encoding="utf-8")
    assert list(assignment_files(tmp_path / "out", None).values()) == [two, three]
    two.write_text(f"kind: shaper\nparts:\n  - file: {three.name}\n", encoding="utf-8")
    assert list(assignment_files(tmp_path / "out", None).values()) == [two, three]


def key_only(path: Path, *_: object) -> dict[str, bytes]:
    return {"n": str(key_of(open_case(path)).row("cam.swing").values[0]).encode()}


@proof
def test_a_missing_or_wrong_part_is_told_where_it_stands_and_harms_nobody_else(tmp_path: Path) -> None:
    """A batch makes what can be made; a part that has been edited renews its student alone."""
    files = [file.path for file in drawn(tmp_path, 4).files]
    roster = tmp_path / "roster.csv"
    order = Order(roster, assignments=tmp_path / "out", out=tmp_path / "made", products=("key",), jobs=1)

    def made() -> Result:
        with (tmp_path / "log").open("w") as log:
            return run_batch(order, log, {"key": key_only})

    assert (made().made, made().kept) == (4, 4)
    cam_of(files[1]).unlink()
    edited(cam_of(files[2]), "132 mm", "132")
    edited(cam_of(files[3]), "132 mm", "133 mm")
    result = made()
    assert (result.made, result.kept) == (1, 1)
    told = {
        failure.student: [(Path(one.location.file).name, one.location.line, one.code) for one in failure.problems]  # type: ignore[union-attr]
        for failure in result.failures
    }
    line = 1 + next(n for n, text in enumerate(files[1].read_text(encoding="utf-8").splitlines()) if "- file:" in text)
    assert told == {
        STUDENTS[1]: [(files[1].name, line, "unreadable")],
        STUDENTS[2]: [(cam_of(files[2]).name, 7, "missing-unit")],
    }
    key = Ask().of(key_of(open_case(files[0])))
    (tmp_path / "sheet.xlsx").write_bytes(filled(key, {}))
    graded = grade([tmp_path / "sheet.xlsx"], tmp_path / "out", Policy(guard=False))
    assert [marking.key.id for marking in graded.markings] == [STUDENTS[0]]
    assert [key.id for key in graded.missing] == [STUDENTS[3]]


def test_a_fault_of_a_parts_spec_stands_in_its_file(tmp_path: Path) -> None:
    drawn(tmp_path, 1)
    cams = tmp_path / "cams.yaml"
    cams.write_text(cams.read_text(encoding="utf-8").replace("arm: 132 mm", "arm: 132"), encoding="utf-8")
    with pytest.raises(AssignmentError) as caught:
        make_variants(tmp_path / "spec.yaml", tmp_path / "roster.csv", tmp_path / "out")
    places = [(Path(one.location.file).name, one.location.line, one.code) for one in caught.value.problems]
    assert ("cams.yaml", 7, "missing-unit") in places


def test_a_job_takes_the_files_of_the_parts_along(tmp_path: Path) -> None:
    """Its product is another one as soon as a part is; a fault of the part is told in its file."""

    def maker(path: Path, *_: object) -> dict[str, bytes]:
        return {"n": str(key_of(open_case(path)).row("cam.n").values[0]).encode()}

    for name in ("shaper.yaml", "feed-cam.yaml"):
        (tmp_path / name).write_bytes((FOLDER / name).read_bytes())
    whole = tmp_path / "shaper.yaml"
    (part,) = beside(whole)
    assert list(assignment_files(tmp_path, None).values()) == [whole], "a part is nobody's own assignment"
    content = part.read_bytes()
    making_now = making("typst", None)
    job = Job("K", "K", "report", maker, whole.name, whole.read_bytes(), making_now, {part.name: content})
    assert float(run_job(job).files["n"]) == pytest.approx(52)
    edited = replace(job, beside={part.name: content.replace(b"132 mm", b"132")})
    assert edited.assignment != job.assignment
    assert [one.location.file for one in run_job(edited).problems if not isinstance(one, str)] == [part.name]


def test_a_sheet_goes_out_comes_back_and_is_marked_by_parts(tmp_path: Path) -> None:
    (one,) = drawn(tmp_path, 1).files
    assert one.parts
    assert set(task_files(one.path, "typst", None)) == {"task.pdf", "answers.xlsx", "assignment.yaml"}
    key = Ask().of(key_of(open_case(one.path)))
    (tmp_path / "sheet.xlsx").write_bytes(filled(key, {"cam.psi": -1.0}))
    (tmp_path / "policy.yaml").write_text("parts: {machine: 7, cam: 3}\n", encoding="utf-8")
    graded = grade([tmp_path / "sheet.xlsx"], tmp_path / "out", read_policy(tmp_path / "policy.yaml"))
    (marking,) = graded.markings
    assert not graded.problems
    assert {cell.id for cell in marking.first_errors} == {"cam.psi"}
    head, row = grade_rows(graded.markings, "en")
    points = dict(zip(head, row, strict=True))
    whole = points["out of"]
    assert isinstance(whole, float)
    assert points["Máy bào ngang"] == pytest.approx(0.7 * whole, abs=0.01)
    assert points["Thiết kế cơ cấu cam đẩy bàn máy"] < 0.3 * whole - 0.5  # type: ignore[operator]


def test_shares_name_every_part(tmp_path: Path) -> None:
    drawn(tmp_path, 1)
    (tmp_path / "policy.yaml").write_text("parts: {machine: 7, gears: 3}\n", encoding="utf-8")
    with pytest.raises(AssignmentError) as caught:
        grade([], tmp_path / "out", read_policy(tmp_path / "policy.yaml"))
    assert sorted(one.code for one in caught.value.problems) == ["missing-key", "unknown-key"]


@proof
def test_a_class_of_twelve(tmp_path: Path) -> None:
    """Some went wrong in the machine or in one of three parts, one has copied a cam: each is told, nobody else."""
    files = drawn(tmp_path, sample="shaper-whole").files
    assert all(len(one.parts) == 3 and all(part.is_file() for part in one.parts) for one in files)
    keys = [Ask().of(key_of(open_case(one.path))) for one in files]
    handed = tmp_path / "handed"
    handed.mkdir()
    wrong = {
        1: {"cam.psi": -1.0},
        2: {"v.B": 2.0},
        3: {"cam.pitch.x": -1.0},
        5: {"train.omega.H": -1.0},
        6: {"gears.d.1": 2.0},
        7: {"v.B": 2.0, "gears.d.1": 2.0, "cam.psi": -1.0},
    }
    for number, key in enumerate(keys):
        cam = keys[0] if number == 4 else None
        (handed / f"{key.id}.xlsx").write_bytes(filled(key, wrong.get(number, {}), cam))
    graded = grade([handed], tmp_path / "out", Policy())
    assert not graded.problems
    assert not graded.missing
    firsts = {number: {cell.id for cell in one.first_errors} for number, one in enumerate(graded.markings)}
    copied = firsts.pop(4)
    assert copied
    assert all(id.startswith("cam.") for id in copied)
    assert {number: ids for number, ids in firsts.items() if ids} == {n: set(ids) for n, ids in wrong.items()}
    flags = {number: marking.flags for number, marking in enumerate(graded.markings) if marking.flags}
    assert set(flags) <= {0, 4}
    assert 4 in flags
    assert {id.partition(".")[0] for flag in flags[4] for id, _ in flag.places} == {"cam"}
    assert {flag.classmate for flag in flags[4]} == {keys[0].id}
    for number, agrees in ((0, True), (5, False), (6, False)):
        told, found = compare(open_case(files[number].path), handed / f"{keys[number].id}.xlsx", hint=True)
        assert found == agrees
        assert agrees or any(symbol in " ".join(told) for symbol in ("ω_H", "d_1"))
    with (tmp_path / "log").open("w") as log:
        order = Order(tmp_path / "roster.csv", assignments=tmp_path / "out", out=tmp_path / "made", products=("task",))
        result = run_batch(order, log)
        assert (result.made, result.failures, result.notes) == (12, [], [])
        # One part edited: its student's alone are made again.
        edited(cam_of(files[3].path), "132 mm", "133 mm")
        again = run_batch(order, log)
        assert (again.made, again.kept) == (1, 11)


UNEQUAL = """
kind: shaper
salt: unequal
report: {language: en, worked_positions: %(worked)s}
positions: {count: 8}
parameters:
  a: 270 mm
  b: 520 mm
  l3: 550 mm
  l4: 100 mm
  H: {from: 280 mm, to: 340 mm, step: 10 mm}
  n: 52 rpm
  cutting: {F: 1000 N, free: 0.05}
  G3: 200 N
  J3: 0.6 kg m2
  G5: 600 N
parts:
  - {file: few.yaml, from: {n: {of: n}}}
  - {file: motor-train.yaml}
  - {file: pairs.yaml}
  - {file: many.yaml, from: {n: {of: n, times: 1/2}}}
"""
"""A machine of 8 positions with a cam of 4 and one of 24, a train of one, a gear pair of 9."""


def of_unequal_counts(folder: Path, count: int, worked: str = "[2, 8]") -> list[Path]:
    """The files of a class whose parts have fewer and more positions than the machine."""
    drawn(folder, count)
    (folder / "unequal.yaml").write_text(UNEQUAL % {"worked": worked}, encoding="utf-8")
    for name, steps in (("few", "{rise: 1, return: 1, far: 1, near: 1}"), ("many", "{rise: 9, return: 9, near: 6}")):
        cam = (FOLDER / "feed-cam.yaml").read_text(encoding="utf-8").replace("15 deg", f"[{', '.join(ANGLES)}]")
        cam = cam.replace("far: 0 deg", "far: 20 deg" if name == "few" else "far: 0 deg")
        cam = cam.replace("positions: 12", f"positions: {steps}")
        (folder / f"{name}.yaml").write_text(cam, encoding="utf-8")
    pair = (FOLDER / "drive-pair.yaml").read_text(encoding="utf-8").replace("m: 5 mm", "m: [4 mm, 5 mm, 6 mm]")
    (folder / "pairs.yaml").write_text(pair, encoding="utf-8")
    made = make_variants(folder / "unequal.yaml", folder / "roster.csv", folder / "class")
    return [one.path for one in made.files]


def test_a_part_may_have_more_and_fewer_positions_than_the_machine(tmp_path: Path) -> None:
    """Each row of the sheet is read by the positions of its own part: no cell of any part is lost."""
    (file,) = of_unequal_counts(tmp_path, 1)
    scheme = marking_scheme(open_case(file))
    scheme = replace(scheme, key=Ask().of(scheme.key))
    counts = [len(part.labels) for _, part in scheme.key.pages]
    assert counts == [8, 4, 1, 9, 24]
    asked = [max(k for row in part.asked for k in row.positions) for _, part in scheme.key.pages]
    assert asked[0] == 8
    assert asked[1] < 8 < asked[3] == 9 < asked[4]
    path = tmp_path / "sheet.xlsx"
    path.write_bytes(filled(scheme.key, {}, figures=3))
    submission = read_submission(path, scheme.key)
    assert (submission.notes, submission.problems) == ((), {})
    assert len(submission.values) == sum(len(row.positions) for row in scheme.key.asked)
    marking = mark(scheme, submission)
    assert [(cell.id, cell.position) for cell in marking.cells if cell.points < cell.worth] == []


def test_rows_of_two_parts_on_one_page_keep_their_own_positions(tmp_path: Path) -> None:
    """All pages joined to one CSV, with the columns of the longest: a label means what it means in the row's part."""
    (file,) = of_unequal_counts(tmp_path, 1)
    key = Ask().of(key_of(open_case(file)))
    (tmp_path / "sheet.xlsx").write_bytes(filled(key, {}))
    wanted = read_submission(tmp_path / "sheet.xlsx", key)
    places = sorted({k for row in key.asked for k in row.positions})
    head = ["id", "symbol", "what", "unit", "value", *(f"position {k}" for k in places if k)]
    rows = [
        [row.id, "", "", "", *(wanted.values[row.id, k].value if k in row.positions else None for k in places)]
        for row in key.asked
    ]
    path = tmp_path / f"{key.id}.csv"
    path.write_bytes(write_csv([head, *rows]))
    found = read_submission(path, key)
    assert found.notes == ()
    assert {place: one.value for place, one in found.values.items()} == {
        place: one.value for place, one in wanted.values.items()
    }


@proof
def test_a_class_of_twelve_with_unequal_counts_loses_no_mark(tmp_path: Path) -> None:
    """Honest sheets in three and in four figures, every position of the machine asked for."""
    files = of_unequal_counts(tmp_path, 12, "all")
    handed = tmp_path / "handed"
    handed.mkdir()
    for number, file in enumerate(files):
        key = Ask().of(key_of(open_case(file)))
        (handed / f"{key.id}.xlsx").write_bytes(filled(key, {}, figures=3 + number % 2))
    graded = grade([handed], tmp_path / "class", Policy())
    assert (graded.problems, graded.missing) == ((), ())
    assert len(graded.markings) == 12
    for marking in graded.markings:
        assert marking.submission.notes == ()
        assert [(cell.id, cell.position) for cell in marking.cells if cell.points < cell.worth] == []
        assert marking.flags == ()
