"""The question bank, read by a parser of the tests' own as Moodle documents its XML and cloze formats.

docs.moodle.org, “Moodle XML format” and “Embedded Answers (Cloze) question type”: `{weight:NUMERICAL:=value:band}`,
pictures as files in base64 that the text names by @@PLUGINFILE@@, `$course$/top/` before a category.
"""

from __future__ import annotations

import base64
import html
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from reportgen import document as tree
from reportgen.base.errors import AssignmentError
from reportgen.base.records import replace
from reportgen.case.answer_key import Role
from reportgen.cases import open_case
from reportgen.classes import moodle_quiz
from reportgen.classes.moodle_quiz import _answer, question_bank
from reportgen.marking.marking_policy import Policy
from reportgen.marking.task_paper import task_of
from reportgen.marking.toleranced_key import Ask, key_of
from tests.lanes import matrix
from tests.marking.students import ASSIGNMENTS

FILE = ASSIGNMENTS / "slider-crank-02.yaml"
POLICY = Policy(ask=Ask(("velocity", "M.eq")), weights={"M.eq": 2.5})
_CLOZE = re.compile(r"\{(\d+):NUMERICAL:((?:[^{}]|\\\})*)\}")
_RIGHT = re.compile(r"=(-?\d+(?:\.\d+)?):(\d+(?:\.\d+)?)")


@dataclass(frozen=True)
class Subquestion:
    weight: int
    right: tuple[tuple[float, float], ...]

    def takes(self, value: float) -> bool:
        return any(abs(value - middle) <= band for middle, band in self.right)


@dataclass(frozen=True)
class Question:
    name: str
    text: str
    files: dict[str, bytes]
    cells: tuple[Subquestion, ...]


def parsed(bank: bytes) -> tuple[str, list[Question]]:
    """The category and the questions; whatever is not as the format says fails here."""
    root = ElementTree.fromstring(bank)
    assert root.tag == "quiz"
    category, *questions = root
    assert (category.tag, category.get("type")) == ("question", "category")
    found = []
    for one in questions:
        assert one.get("type") == "cloze"
        body = one.find("questiontext")
        assert body is not None
        assert body.get("format") == "html"
        text = body.findtext("text") or ""
        files = {
            file.get("name", ""): base64.b64decode(file.text or "", validate=True) for file in body.findall("file")
        }
        assert set(re.findall(r'"@@PLUGINFILE@@/([^"]+)"', text)) == set(files)
        # The text of the question is a well-formed piece of HTML.
        ElementTree.fromstring(f"<div>{text}</div>")
        cells = []
        for weight, answers in _CLOZE.findall(text):
            parts = [_RIGHT.fullmatch(part) for part in answers.split("~")]
            assert all(parts), answers
            cells.append(Subquestion(int(weight), tuple((float(p[1]), float(p[2])) for p in parts if p)))
        # No other brace opens what Moodle could take for an answer.
        assert text.count("{") == len(cells)
        found.append(Question(one.findtext("name/text") or "", text, files, tuple(cells)))
    return category.findtext("category/text") or "", found


def test_each_variant_has_a_question_with_its_scheme_data_and_cells() -> None:
    category, (question,) = parsed(question_bank([FILE], POLICY, "spring/2026", "en"))
    assert category == "$course$/top/spring//2026"
    assert question.name == FILE.stem
    ((name, picture),) = question.files.items()
    assert name.endswith(".png")
    assert picture.startswith(b"\x89PNG\r\n\x1a\n")
    assert "Slider-crank" in question.text


def _texts(blocks: Iterable[tree.Block]) -> Iterator[tree.Inlines]:
    for block in blocks:
        match block:
            case tree.Paragraph(inlines):
                yield inlines
            case tree.List(items):
                yield from (text for item in items for text in _texts(item))
            case tree.Table():
                yield from (cell.inlines for row in (*block.head, *block.rows) for cell in row)


def _bare(text: str) -> str:
    """Letters and digits alone: spaces and marks of layout are the writer's."""
    return re.sub(r"[^\w,.%°/]", "", html.unescape(re.sub(r"<[^>]*>", "", text)))


def _given(blocks: Iterable[tree.Block]) -> Iterator[tree.Block]:
    """What a task says between whose it is and how its sheet is filled in, in each of its parts."""
    parts: list[list[tree.Block]] = []
    for block in blocks:
        if isinstance(block, tree.Section) and block.level == 1:
            parts.append([])
        parts[-1].append(block)
    for part in parts:
        begin = max((k for k, block in enumerate(part) if isinstance(block, tree.BlankLine)), default=0) + 1
        *_, end, _ = (k for k, block in enumerate(part) if isinstance(block, tree.Section))
        yield from part[begin:end]


def _samples() -> list[Path]:
    """The first sample of each kind, and others with a load table, with friction, of several parts."""
    firsts: dict[str, Path] = {}
    files = [file for file in ASSIGNMENTS.rglob("*.yaml") if file.parent.name not in {"class-demo", "coursework"}]
    for file in sorted(files):
        if match := re.search(r"^kind: *([\w-]+)", file.read_text(encoding="utf-8"), re.MULTILINE):
            firsts.setdefault(match[1], file)
    assert len(firsts) > 15
    further = ("engine-single-I", "engine-single-load", "slider-crank-friction", "coursework/shaper-whole")
    return [*firsts.values(), *(ASSIGNMENTS / f"{name}.yaml" for name in further)]


TELLING = ("shaper-01", "engine-single-load", "shaper-whole", "rocker-flat-01", "01")
"""Forces, a table of loads, several parts, a cam, an exercise."""


@pytest.mark.parametrize(
    "file", matrix(_samples(), [file for file in _samples() if file.stem in TELLING]), ids=lambda file: file.stem
)
def test_a_question_says_all_that_the_task_gives(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(moodle_quiz.picture_files, "pngs", lambda scenes, *_: [b"PNG"] * len(scenes))
    case = open_case(file, "vi")
    key = key_of(case)
    row = next(row for row in key.asked if row.role is Role.asked)
    _, (question,) = parsed(question_bank([file], Policy(ask=Ask((row.id,))), "x", "vi"))
    shown = _bare(question.text)
    for inlines in _texts(_given(task_of(case, key).blocks)):
        for one in inlines:
            if isinstance(one, tree.Text | tree.Value):
                assert _bare(tree.plain((one,), "vi")) in shown, one
    figures = [block for block in task_of(case, key).blocks if isinstance(block, tree.Figure)]
    assert len(question.files) == sum(len(figure.scenes) for figure in figures)
    # Outside the answers, whose numbers Moodle wants with a point, the decimal mark is the comma.
    assert not re.search(r"(?<![\w.-])\d+\.\d+(?![\w.])", re.sub(r"<[^>]*>", " ", _CLOZE.sub("", question.text)))


def test_the_cells_that_the_policy_names_take_what_lies_within_the_keys_bands() -> None:
    _, (question,) = parsed(question_bank([FILE], POLICY, "x", "en"))
    rows = [row for row in POLICY.ask.of(key_of(open_case(FILE, "en"))).asked if row.role is Role.asked]
    wanted = [(row, k) for row in rows for k in row.positions if np.isfinite(row.values[row.at(k)])]
    assert len(question.cells) == len(wanted) > 5
    for cell, (row, position) in zip(question.cells, wanted, strict=True):
        value = row.values[row.at(position)]
        band = max(bands[row.at(position) if len(bands) > 1 else 0] for bands in (row.drawn, row.computed))
        assert cell.takes(value)
        assert cell.takes(value + 0.9 * band)
        assert not cell.takes(value + 1.1 * band + 1e-6 * abs(value))
        assert cell.takes(-value) or not row.open_sense
        # Weights are whole numbers in the ratio of the policy's: 2.5 to 1.
        assert cell.weight == {"M.eq": 5}.get(row.id, 2)


def test_a_direction_may_be_a_whole_turn_on() -> None:
    """Whoever measures 359° where 1° ± 2° is right has measured well."""
    row = next(row for row in key_of(open_case(FILE, "en")).asked if row.unit == "°" and not row.open_sense)
    count = len(row.values)
    row = replace(row, values=np.full(count, 1.0), drawn=np.full(count, 2.5), computed=np.full(count, 0.1))
    text = _answer(row, row.positions[0], 1)
    assert text is not None
    match = _CLOZE.fullmatch(text)
    assert match is not None
    right = [_RIGHT.fullmatch(part) for part in match[2].split("~")]
    cell = Subquestion(1, tuple((float(part[1]), float(part[2])) for part in right if part))
    assert cell.takes(0.0)
    assert cell.takes(359.0)
    assert not cell.takes(180.0)


def test_what_nothing_fits_is_told(tmp_path: Path) -> None:
    policy = tmp_path / "policy.yaml"
    policy.write_text("ask: [nothing.like.it]\n", encoding="utf-8")
    with pytest.raises(AssignmentError):
        question_bank([FILE], Policy(ask=Ask(("nothing.like.it",), file=policy)), "x", "en")
