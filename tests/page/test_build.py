"""Pages as files: asked for by name, whole or not at all, small, the same in every run; tables of a full turn."""

from __future__ import annotations

import hashlib
import json
import re
from base64 import b64encode
from pathlib import Path

import pytest

from reportgen import api
from reportgen.cases import MachineCase, opened
from reportgen.page import page, panels
from reportgen.page.html import quoted
from reportgen.workbook import read
from tests.commands import reportgen
from tests.lanes import proof
from tests.page.made import made
from tests.page.text import elements
from tests.report import built

SLIDE = built.SLIDE
EXERCISE = built.ROOT / "assignments" / "plane-motion" / "01.yaml"
LARGEST = 3_000_000


def test_the_sample_s_page_is_small_and_the_same_in_every_run() -> None:
    one = made(built.SAMPLE, "vi")
    assert len(one.text.encode()) < LARGEST
    assert page(MachineCase(one.case.assignment)) == one.text


def test_what_moves_is_the_same_before_and_behind_the_report() -> None:
    """While a file is watched the moving part is made before the report."""
    assignment = built.assignment(SLIDE)
    behind, before = MachineCase(assignment), MachineCase(assignment)
    behind.document()
    assert panels(behind) == panels(before)


@pytest.mark.parametrize("file", [SLIDE, EXERCISE], ids=lambda file: file.stem)
def test_the_policy_allows_its_own_style_and_script_alone(file: Path) -> None:
    text = page(opened(api.load(file)))
    (policy,) = re.findall(r'http-equiv="Content-Security-Policy" content="([^"]+)"', text)
    policy = policy.replace("&#39;", "'")
    for name, part in (("style", "style-src"), ("script", "script-src")):
        (body,) = re.findall(rf"<{name}>(.*?)</{name}>", text, re.DOTALL)
        digest = b64encode(hashlib.sha256(body.encode()).digest()).decode()
        assert f"{part} 'sha256-{digest}'" in policy
    assert policy.startswith("default-src 'none'")
    assert "unsafe" not in policy
    assert not re.search(r"""\s(style|on\w+|src)=["']""", text)
    found = set(elements(text))
    assert not found & {"img", "iframe", "object", "embed", "audio", "video"}
    # An exercise has one instant: nothing on its page moves.
    assert ('id="moving"' in text) == (file != EXERCISE)


def test_running_lines_cannot_end_their_style() -> None:
    """A course may be called anything: in a style sheet every mark is an escape, every letter stays."""
    assert quoted("Nguyên lý máy 2") == "'Nguyên\\20 lý\\20 máy\\20 2'"
    assert not set(quoted("</style>'\"\\;}<!--\n")[1:-1]) & set("</>'\";}!-\n")


@proof
def test_formats_of_a_report(tmp_path: Path) -> None:
    done = reportgen("build", SLIDE, "--format", "html,pdf", "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    names = ["report.html", "report.pdf"]
    assert done.stdout.splitlines() == [str(tmp_path / SLIDE.stem / name) for name in names]
    assert sorted(path.name for path in (tmp_path / SLIDE.stem).glob("[!.]*")) == names
    assert (tmp_path / SLIDE.stem / "report.html").read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    assert reportgen("build", SLIDE, "--format", "html", "--out", tmp_path / "one").returncode == 0
    assert [path.name for path in (tmp_path / "one" / SLIDE.stem).glob("[!.]*")] == ["report.html"]


def test_an_unknown_format_is_wrong_usage(tmp_path: Path) -> None:
    for arguments in (("build", SLIDE), ("solve", SLIDE)):
        done = reportgen(*arguments, "--format", "htm", "--out", tmp_path, "--lang", "en")
        assert done.returncode == 2
        assert "--format: there is no format “htm”: " in done.stderr
    assert list(tmp_path.iterdir()) == []


@proof
def test_a_faulty_file_leaves_the_last_page(tmp_path: Path) -> None:
    file = tmp_path / "one.yaml"
    file.write_text(SLIDE.read_text(encoding="utf-8"), encoding="utf-8")
    assert reportgen("build", file, "--format", "html", "--out", tmp_path).returncode == 0
    before = (tmp_path / "one" / "report.html").read_bytes()
    file.write_text("kind: linkage\nvariant: 1\nwrong: 1\n", encoding="utf-8")
    assert reportgen("build", file, "--format", "html", "--out", tmp_path).returncode == 1
    assert (tmp_path / "one" / "report.html").read_bytes() == before


@proof
def test_tables_of_a_full_turn_say_what_the_json_says(tmp_path: Path) -> None:
    done = reportgen("solve", built.SAMPLE, "--format", "csv,xlsx,json", "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    folder = tmp_path / built.SAMPLE.stem
    assert done.stdout.splitlines() == [str(folder / f"results.{name}") for name in ("csv", "xlsx", "json")]
    found = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    assert found == api.solve(api.load(built.SAMPLE), 360)
    (table,), (book,) = (read(folder / f"results.{name}") for name in ("csv", "xlsx"))
    for page_of in (table, book):
        head, *rows = [[cell.value for cell in row] for row in page_of.rows]
        assert len(rows) == 720
        column = {name: index for index, name in enumerate(head)}
        for k in (0, 100, 719):
            position = found["positions"][k]
            assert float(rows[k][column["points.B.v.y"]]) == pytest.approx(position["points"]["B"]["v"][1], rel=1e-12)
            assert float(rows[k][column["reactions.R12.x"]]) == pytest.approx(
                position["reactions"]["R12"][0], rel=1e-12
            )
            torque = position["balancing_torque"]["equilibrium"]
            assert float(rows[k][column["balancing_torque.equilibrium"]]) == pytest.approx(torque, rel=1e-12)


def test_tables_of_fewer_positions_and_of_one_instant(tmp_path: Path) -> None:
    files = api.result_files(SLIDE, ["csv"], 12)
    assert files["results.csv"].count(b"\r\n") == 13
    files = api.result_files(EXERCISE, ["csv", "json"])
    assert files["results.csv"].count(b"\r\n") == 2
    assert json.loads(files["results.json"]) == api.solve(api.load(EXERCISE))
