"""A coursework of a machine and its parts: one booklet, one key, one mark, sheets and motion together."""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from collections.abc import Callable
from functools import cache
from io import BytesIO
from pathlib import Path

import pytest
from openpyxl import load_workbook

from reportgen import check, load, solve
from reportgen.api import result_files
from reportgen.base.errors import Location
from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.cases import open_case, opener
from reportgen.coursework.case import Coursework, PartCase
from reportgen.coursework.symbol_renaming import nodes
from reportgen.document import Contents, Document, Section, plain, text_of
from reportgen.document.numbering import unreferenced
from reportgen.drawing import Scene
from reportgen.formula import Symbol
from reportgen.marking.judging import mark
from reportgen.marking.marking_data import Answer, Marking, Submission, Verdict
from reportgen.marking.marking_policy import Policy
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.task_paper import task_of
from reportgen.marking.toleranced_key import Ask, key_of
from reportgen.page import panels
from reportgen.results.result_files import table, workbook
from reportgen.sheets import drawing_sheets
from tests.drawing.overlaps import overlaps
from tests.lanes import proof
from tests.report import built

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
FOLDER = ASSIGNMENTS / "coursework"
SHAPER, TWIN = FOLDER / "shaper.yaml", FOLDER / "engine-twin.yaml"
SECOND = """
  - title: Cam thứ hai
    from: {n: {of: n, times: 1/2}}
    kind: cam
    parameters:
      follower: translating
      end: knife
      h: 30 mm
      phases: {rise: 120 deg, far: 60 deg, return: 120 deg, near: 60 deg}
      laws: {rise: parabolic, return: sine}
      r0: 40 mm
      e: 0 mm
      limits: {rise: 60 deg, return: 60 deg}
      positions: 8
"""


@cache
def coursework(path: Path = SHAPER) -> Coursework:
    case = built.case(path)
    assert isinstance(case, Coursework)
    return case


@pytest.fixture(scope="module")
def three(tmp_path_factory: pytest.TempPathFactory) -> Coursework:
    """The shaper with two cams, the second one in the file itself."""
    folder = tmp_path_factory.mktemp("three")
    (folder / "feed-cam.yaml").write_bytes((FOLDER / "feed-cam.yaml").read_bytes())
    (folder / "three.yaml").write_text(SHAPER.read_text(encoding="utf-8") + SECOND, encoding="utf-8")
    case = open_case(folder / "three.yaml")
    assert isinstance(case, Coursework)
    return case


def headings(document: Document, level: int) -> list[tuple[str, str]]:
    found = [block for block in document.blocks if isinstance(block, Section) and block.level == level]
    return [(one.number, plain(one.title, document.language)) for one in found]


# --- one booklet ------------------------------------------------------------------------------------


def test_machine_train_pair_and_cam_are_one_booklet_from_motor_to_cam() -> None:
    """The motor's 960 rpm become the crank's 80 rpm: 6 by the train, 2 by the pair behind it."""
    whole = coursework(FOLDER / "shaper-whole.yaml")
    document = built.document(FOLDER / "shaper-whole.yaml")
    numbers = [number for number, _ in headings(document, 1) if number]
    assert numbers == ["1", "2", "3", "4", "5"]
    asked = {row.id.partition(".")[0] for row in key_of(whole).rows}
    assert {"train", "gears", "cam"} <= asked
    # Outer wheels turn against each other.
    assert whole.printed.number("train.n.reached").value == -whole.printed.number("n").value == -80
    assert whole.printed.number("cam.n").value == 80


def test_the_chapters_of_the_parts_follow_those_of_the_machine(three: Coursework) -> None:
    document, alone = three.document(), three.machine.document()
    chapters = [title for number, title in headings(document, 1) if number]
    own = [title for number, title in headings(alone, 1) if number]
    assert chapters == [*own, "Thiết kế cơ cấu cam đẩy bàn máy", "Cam thứ hai"]
    assert [number for number, _ in headings(document, 1) if number] == ["1", "2", "3", "4"]
    unnumbered = [title for number, title in headings(document, 1) if not number]
    assert unnumbered == [title for number, title in headings(alone, 1) if not number]
    assert next(number for number, _ in headings(document, 2) if number.startswith("4.")) == "4.1"


@pytest.mark.proof
def test_nothing_of_the_machines_chapters_is_another_one() -> None:
    """But for the numbers of tables at the front, where those of the parts have come in."""
    case = coursework()
    both = (text_of(one) for one in (built.document(SHAPER), case.machine.document()))
    whole, alone = (re.sub(r"bảng \d+(?!\.?\d)", "bảng", one).splitlines() for one in both)
    first = alone.index("1 Tổng hợp và phân tích động học cơ cấu")
    last = alone.index("Kết luận", first)
    there = whole.index("1 Tổng hợp và phân tích động học cơ cấu")
    assert whole[there : there + last - first] == alone[first:last]


def test_its_contents_are_those_of_all_parts() -> None:
    """The 53 lines of shaper and cam are three more than a page holds: the task goes on below these."""
    (listed,) = nodes(built.document(SHAPER).blocks, Contents)
    assert not listed.alone
    (of_machine,) = nodes(coursework().machine.document().blocks, Contents)
    assert of_machine.alone


def test_every_table_and_figure_is_spoken_of_by_its_number() -> None:
    case = coursework()
    new = set(unreferenced(built.document(SHAPER)))
    old = set(unreferenced(case.machine.document()))
    own = {f"cam.{key}" for key in unreferenced(case.members[0].case.document())}
    assert new <= old | own


def test_each_quantity_has_a_symbol_of_its_own(three: Coursework) -> None:
    """What two parts name alike is the machine's datum itself, taken as it is."""
    machine = {one.symbol for one in three.machine.printed.families.values() if not one.hidden}
    for member in three.members:
        own = {id for id in three.printed.families if id.startswith(f"{member.name}.")}
        alike = {id for id in own if three.printed[id].symbol in machine and not three.printed[id].hidden}
        assert alike <= {f"{member.name}.{one.key}" for one in member.part.taken if one.times == "1"}
    cams = [
        {one.symbol for id, one in three.printed.families.items() if id.startswith(f"{name}.") and not one.hidden}
        for name in ("cam", "cam2")
    ]
    assert not cams[0] & cams[1]


@cache
def of_designs() -> frozenset[Symbol]:
    """The symbols of all cams and gears."""
    parts = [built.case(one) for folder in ("cam", "gears") for one in (ASSIGNMENTS / folder).glob("*.yaml")]
    return frozenset(one.symbol for part in parts for one in part.printed.families.values() if not one.hidden)


@proof
@pytest.mark.parametrize("file", built.TYPESET, ids=lambda file: file.stem)
def test_a_machine_knows_its_symbols_without_its_report(file: Path) -> None:
    """Whatever its report has of the symbols of any part's quantities: keys are made without the report."""
    case = built.case(file)
    assert case.used is not None
    assert set(nodes(built.document(file).blocks, Symbol)) & of_designs() <= set(case.used)


def test_a_key_and_a_task_are_made_without_any_report(monkeypatch: pytest.MonkeyPatch) -> None:
    case = open_case(SHAPER)
    monkeypatch.setattr(PartCase, "document", property(lambda _: pytest.fail("a report was composed")))
    assert task_of(case, key_of(case)).blocks


def test_points_that_are_named_anew_are_said(three: Coursework) -> None:
    """A and O of the shaper's first cam are another axis and another pivot than the machine's."""
    text = text_of(three.document())
    (first, second) = (line for line in text.splitlines() if line.startswith("Tên điểm được đặt riêng cho từng phần"))
    assert first.endswith(": A, O.")
    assert "O" in second.rpartition(": ")[2]


@pytest.mark.parametrize(
    ("language", "indices"), [("vi", {"ht", "br", "cam"}), ("en", {"train", "gears", "cam"})], ids=["vi", "en"]
)
def test_indices_are_words_of_the_language(language: Language, indices: set[str]) -> None:
    case = built.case(FOLDER / "shaper-whole.yaml", language)
    assert isinstance(case, Coursework)
    assert {new.sub.rpartition(",")[2] for letters in case.letters.values() for new in letters.values()} == indices


def test_a_derivative_goes_with_what_it_is_of() -> None:
    letters = coursework(TWIN).letters["cam"]
    assert letters[Symbol("s")] == Symbol("s", "cam")
    assert letters[Symbol("s′")] == Symbol("s′", "cam")


@pytest.mark.parametrize("extent", ["full", "short"])
def test_what_is_taken_from_the_machine_is_printed_with_where_it_comes_from(extent: str) -> None:
    text = text_of(built.document(TWIN, "en", extent))  # type: ignore[arg-type]
    assert "Taken from the data of the machine:\nn_cam = 1/2·n = 1100 rpm" in text


def test_the_camshaft_turns_half_as_fast() -> None:
    case = coursework(TWIN)
    assert case.members[0].case.speed == pytest.approx(2 * math.pi * 2200 / 60 / 2, rel=1e-12)


def test_the_cover_and_the_extent_are_those_of_the_machine() -> None:
    part = coursework(TWIN).members[0].case.assignment
    assert part.report.university == "Trường Đại học Kỹ thuật Công nghiệp Thái Nguyên"
    assert part.report.extent == "full"
    assert "worked_positions" not in part.report.model_fields_set


# --- key and marks ----------------------------------------------------------------------------------


def test_ids_have_the_name_of_their_part_in_front(three: Coursework) -> None:
    key = key_of(three)
    names = Counter(key.owner(row.id) for row in key.rows)
    assert list(names) == ["machine", "cam", "cam2"]
    assert names["machine"] == len(key_of(three.machine).rows)
    assert key.row("cam2.n").values[0] == pytest.approx(26)
    assert key.row("cam.n").values[0] == pytest.approx(52)
    assert len({row.id for row in key.rows}) == len(key.rows)


def marked(case: Coursework, change: Callable[[str, float], float], policy: Policy | None = None) -> Marking:
    """A sheet with every value of the key but for what is changed."""
    scheme = marking_scheme(case, policy or Policy(guard=False))
    key = Ask().of(scheme.key)
    values = {
        (row.id, k): Answer(change(row.id, float(row.values[row.at(k)])), "", Location("sheet"))
        for row in key.asked
        for k in row.positions
    }
    sheet = Submission(key.id, "sheet", values, {})
    return mark(replace(scheme, key=key), sheet)


def test_the_key_itself_is_right_in_every_part(three: Coursework) -> None:
    found = marked(three, lambda id, value: value)
    assert {cell.verdict for cell in found.cells} == {Verdict.right}
    assert found.points == found.out_of == len(found.cells)


def test_a_mistake_is_found_in_the_part_in_which_it_was_made(three: Coursework) -> None:
    found = marked(three, lambda id, value: -value if id == "cam.psi" else 2 * value if id == "cam2.r0" else value)
    assert {key for one in found.first_errors if (key := found.key.owner(one.id))} == {"cam"}
    assert {(one.mistake, one.where) for one in found.first_errors if one.id == "cam.psi"} == {
        ("sign-reversed", "cam.psi")
    }


def test_each_part_has_its_share_of_the_mark(three: Coursework) -> None:
    """With 6 : 3 : 1 the parts are worth 60, 30 and 10 of a hundred, whatever they ask for."""
    policy = Policy(guard=False, parts={"machine": 6, "cam": 3, "cam2": 1})
    found = marked(three, lambda id, value: 3 * value if id == "cam.psi" else value, policy)
    worth = Counter[str]()
    for cell in found.cells:
        worth[found.key.owner(cell.id)] += cell.worth  # type: ignore[assignment]
    whole = sum(worth.values())
    assert [worth[name] / whole for name in ("machine", "cam", "cam2")] == pytest.approx([0.6, 0.3, 0.1])
    assert found.out_of == pytest.approx(len(found.cells))


def test_results_have_those_of_each_part(three: Coursework) -> None:
    found = solve(three.assignment, printed=True)
    assert list(found["parts"]) == ["cam", "cam2"]
    assert found["parts"]["cam2"]["kind"] == "cam"
    assert found["printed"]["cam2.n"]["values"] == [26]
    assert [page.title for page in load_workbook(BytesIO(workbook(found))).worksheets] == ["shaper 4", "cam", "cam2"]


# --- motion, sheets, watching -----------------------------------------------------------------------


def test_each_part_moves_in_a_panel_of_its_own() -> None:
    """The machine's is the one it has alone; a part's says the same as alone, in the coursework's letters."""
    case = coursework(TWIN)
    machine, cam = panels(case)
    assert (machine,) == panels(case.machine)
    (alone,) = panels(case.members[0].case)
    assert (machine.own, cam.own, cam.title) == ("", "cam-", "Thiết kế cơ cấu cam xupap nạp")
    assert not set(nodes(case.animations()[1], Symbol)) & set(case.letters["cam"])
    samples, own = json.loads(cam.data), json.loads(alone.data)
    for key in ("knots", "positions", "lengths", "tracks"):
        assert samples[key] == own[key]


def test_sheets_are_numbered_on() -> None:
    case = coursework()
    sheets = drawing_sheets(case, "A1")
    framed = [sheet.fields for sheet in sheets if sheet.fields]
    assert [one["sheet"] for one in framed] == [str(number) for number in range(1, len(framed) + 1)]
    assert {one["sheets"] for one in framed} == {str(len(framed))}
    assert len(sheets) - len(framed) == 1, "the profile in true size has no frame"


def test_a_part_that_has_not_changed_is_not_computed_again(tmp_path: Path) -> None:
    for file in (SHAPER, FOLDER / "feed-cam.yaml"):
        (tmp_path / file.name).write_bytes(file.read_bytes())
    opens, path = opener(), tmp_path / "shaper.yaml"
    before = opens(path, None)
    part = tmp_path / "feed-cam.yaml"
    part.write_text(part.read_text(encoding="utf-8").replace("15 deg", "14 deg"), encoding="utf-8")
    after = opens(path, None)
    assert isinstance(before, Coursework)
    assert isinstance(after, Coursework)
    assert after.first is before.first
    assert after.members[0].case.ledger["cam.swing"].values[0] == pytest.approx(math.radians(14))


def test_no_symbol_of_a_part_stays_in_its_drawings() -> None:
    """A letter that has an index has it in formulas, tables and figures alike."""
    case = coursework(TWIN)
    document = built.document(TWIN)
    first = next(i for i, one in enumerate(document.blocks) if isinstance(one, Section) and one.number == "3")
    last = next(i for i, one in enumerate(document.blocks) if isinstance(one, Section) and one.number == "3.7")
    assert not set(nodes(document.blocks[first:last], Symbol)) & set(case.letters["cam"])


def test_a_letter_with_an_index_has_room_in_its_drawings() -> None:
    """φ_cam is three times as wide as φ: it stands neither on the arrow of its axis nor off the sheet."""
    case = coursework(TWIN)
    widened = {str(symbol) for symbol in case.letters["cam"].values()}
    scenes = list(nodes(tuple(case.joined_plates().values()), Scene))
    assert widened & {str(symbol) for symbol in nodes(scenes, Symbol)}
    assert [one for scene in scenes for one in overlaps(scene) if one.startswith(tuple(widened))] == []


# --- faults -----------------------------------------------------------------------------------------

PARTS = "parts:\n  - file: part.yaml\n"
CAM = (FOLDER / "feed-cam.yaml").read_text(encoding="utf-8")
MACHINE = SHAPER.read_text(encoding="utf-8").partition("parts:")[0]
LINE = MACHINE.count("\n")

FAULTS = {
    "outside": ("parts:\n  - file: ../part.yaml\n", CAM, f"whole.yaml:{LINE + 2}:11 path-outside"),
    "missing file": ("parts:\n  - file: other.yaml\n", CAM, f"whole.yaml:{LINE + 2}:11 unreadable"),
    "circle": ("parts:\n  - file: whole.yaml\n", CAM, "whole.yaml:2:7 no-part"),
    "a machine": (PARTS, MACHINE, "part.yaml:2:7 no-part"),
    "parts of a part": (PARTS, f"{CAM}parts:\n  - file: part.yaml\n", "part.yaml:17:1 unknown-key"),
    "fault of the part": (PARTS, CAM.replace("arm: 132 mm", "arm: 132"), "part.yaml:7:8 missing-unit"),
    "no such datum": (f"{PARTS}    from: {{n: {{of: speed}}}}\n", CAM, f"whole.yaml:{LINE + 3}:20 no-datum"),
    "given twice": (
        f"{PARTS}    from: {{n: {{of: n}}}}\n",
        CAM.replace("  end:", "  n: 9 rpm\n  end:"),
        "part.yaml:5:6 datum-twice",
    ),
    "against the shaft that it sits on": (
        f"{PARTS}    from: {{n: {{of: n}}}}\n",
        CAM.replace("  end:", "  direction: clockwise\n  end:"),
        "part.yaml:5:14 shaft-sense",
    ),
    "of another kind": (f"{PARTS}    from: {{n: {{of: H}}}}\n", CAM, f"whole.yaml:{LINE + 3}:20 wrong-unit"),
    "unknown key": (f"{PARTS}    form: {{}}\n", CAM, f"whole.yaml:{LINE + 3}:5 unknown-key"),
}


TAKEN = """parts:
  - from: {m: {of: a, times: 1/54}, z1: {of: positions.count, times: 3/2}}
    kind: gear-pair
    parameters: {z2: 36, shifts: find, by: equal-sliding, a_w: find}
  - from: {n_in: {of: n, times: 12}}
    kind: planetary-train
    parameters: {scheme: single, u: 6, k: 3, z: {from: 17, to: 100}, m: 2.5 mm}
  - file: part.yaml
    from: {n: {of: n}, arm: {of: l3, times: 0.24}}
"""


@pytest.mark.proof
def test_where_a_datum_comes_from_is_said_in_symbols_whatever_its_kind_and_key(tmp_path: Path) -> None:
    """z1 is z_1 and n_in is n_v; the arm of a cam is l, and the machine's l3 is l_3 by its value."""
    (tmp_path / "part.yaml").write_text(CAM.replace("  arm: 132 mm\n", ""), encoding="utf-8")
    (tmp_path / "whole.yaml").write_text(MACHINE + TAKEN, encoding="utf-8")
    lines = text_of(open_case(tmp_path / "whole.yaml").document()).splitlines()
    starts = [number for number, line in enumerate(lines) if line.startswith("Lấy từ số liệu của máy")]
    assert [lines[number + 1] for number in starts] == ["m = 1/54·a = 5 mm", "n_v = 12·n = 624 vg/ph", "n = 52 vg/ph"]
    assert [lines[number + 2] for number in starts[::2]] == ["z_1 = 3/2·count = 18", "l_cam = 0,24·l_3 = 132 mm"]


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_told_where_it_stands(name: str, tmp_path: Path) -> None:
    whole, part, wanted = FAULTS[name]
    (tmp_path / "whole.yaml").write_text(MACHINE + whole, encoding="utf-8")
    (tmp_path / "part.yaml").write_text(part, encoding="utf-8")
    found = [
        f"{Path(one.location.file).name}:{one.location.line}:{one.location.column} {one.code}"
        for one in check(tmp_path / "whole.yaml")
    ]
    assert found == [wanted]


def test_the_csv_of_results_has_a_file_for_each_part() -> None:
    """Its heads and numbers are those of the part alone."""
    files = result_files(FOLDER / "shaper-whole.yaml", ["csv", "json"], 12)
    assert list(files) == ["results.csv", "results.json", "results-train.csv", "results-gears.csv", "results-cam.csv"]
    alone = solve(load(FOLDER / "motor-train.yaml"))
    assert files["results-train.csv"] == table(alone)


def test_notes_on_filling_in_are_said_once() -> None:
    """A part has only what is its own: that a ratio has a sign, that an involute function needs six digits."""
    case = coursework(FOLDER / "shaper-whole.yaml")
    text = text_of(task_of(case, key_of(case)))
    assert text.count("theo đơn vị của dòng") == 1
    assert text.count("Cách điền phiếu trả lời") == 1
    assert text.count("Khi điền phần này") == 3
    assert "hàm thân khai cần sáu" in text
