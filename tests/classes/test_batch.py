"""Batches: a failure costs nobody else, a second run makes only what is missing or changed."""

from __future__ import annotations

import errno
import io
import os
from collections.abc import Mapping
from pathlib import Path

import pytest

from reportgen.api import Engine
from reportgen.base import files
from reportgen.base.errors import AssignmentError, OutputError
from reportgen.base.records import replace
from reportgen.base.units import Language
from reportgen.classes.batch_run import Order, locked, run_batch, watching
from tests.classes.classes import Batch, here, tree, write_class
from tests.classes.little import little
from tests.commands import process, reportgen
from tests.lanes import proof

ROOT = Path(__file__).parents[2]


def test_each_student_gets_a_folder(tmp_path: Path) -> None:
    batch = Batch(tmp_path, {"K1": "seconds: 0", "K2": "seconds: 0.0"})
    done = batch.run("little")
    assert set(tree(batch.out)) == {*("K1", "K1/a.pdf", "K1/b.xlsx", "K2", "K2/a.pdf", "K2/b.xlsx"), "manifest.json"}
    assert batch.events == [("K1", "little", "done"), ("K2", "little", "done")]
    assert (done.made, done.kept, done.exit_code, done.notes) == (2, 0, 0, [])


def test_files_that_are_no_longer_made_go_and_others_stay(tmp_path: Path) -> None:
    batch = Batch(tmp_path, {"K1": "seconds: 0", "K2": "seconds: 0"})
    batch.run("little")
    (batch.out / "K1" / "mine.txt").write_text("mine", encoding="utf-8")
    (batch.given / "K1.yaml").write_text("files: a.pdf", encoding="utf-8")
    assert batch.run("little").made == 1
    assert set(tree(batch.out)) == {"K1", "K1/a.pdf", "K1/mine.txt", "K2", "K2/a.pdf", "K2/b.xlsx", "manifest.json"}


def test_a_failure_is_a_result(tmp_path: Path) -> None:
    batch = Batch(tmp_path, {"K1": "wrong: not so", "K2": "seconds: 0", "K3": "seconds: 0.0"})
    (batch.given / "K3.yaml").unlink()
    done = batch.run()
    assert batch.students("done") == ["K2"]
    assert [(failure.student, *map(str, failure.problems)) for failure in done.failures] == [
        ("K1", f"{batch.given / 'K1.yaml'}:1:8: error[wrong]: not so"),
        ("K3", f"{batch.roster}:4:1: error[no-assignment]: there is no assignment file for “K3”"),
    ]
    assert done.exit_code == 1


def test_a_file_that_cannot_be_read_costs_one_student(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    batch = Batch(tmp_path, {"K1": "seconds: 0", "K2": "seconds: 0"})
    read = files.contents

    def guarded(path: Path, most: int = -1) -> bytes:
        if path.name == "K1.yaml":
            raise PermissionError(errno.EACCES, "no", str(path))
        return read(path, most)

    monkeypatch.setattr("reportgen.assignment.reading.contents", guarded)
    done = batch.run()
    assert batch.students("done") == ["K2"]
    ((problem,),) = [failure.problems for failure in done.failures]
    assert str(problem).startswith(f"{batch.given / 'K1.yaml'}:1:1: error[unreadable]: ")
    assert '"K1.yaml:1:1: error[unreadable]' in done.manifest.read_text(encoding="utf-8")


def test_a_fault_of_the_program_costs_one_student(tmp_path: Path) -> None:
    batch = Batch(tmp_path, {"K1": "crash: yes", "K2": "seconds: 0"})
    done = batch.run()
    assert batch.students("done") == ["K2"]
    ((problem,),) = [failure.problems for failure in done.failures]
    assert str(problem).endswith("ZeroDivisionError: in K1.yaml")
    assert done.exit_code == 3


def test_files_are_matched_by_id_whatever_the_spelling(tmp_path: Path) -> None:
    batch = Batch(tmp_path, {"K1": "seconds: 0", "e\u0301 9": "seconds: 0"})
    (batch.given / "é 9.yaml").unlink(missing_ok=True)
    (batch.given / "e\u0301 9.yaml").unlink(missing_ok=True)
    (batch.given / "sub").mkdir()
    (batch.given / "K1.yaml").rename(batch.given / "sub" / "k1.yml")
    (batch.given / "É 9.yaml").write_text("seconds: 0", encoding="utf-8")
    (batch.given / "K7.yaml").write_text("seconds: 0", encoding="utf-8")
    done = batch.run()
    assert len(batch.students("done")) == 2
    assert done.notes == [f"no student of the roster has this assignment file: {batch.given / 'K7.yaml'}"]
    assert done.exit_code == 0


def test_the_examples_can_be_the_files_of_a_class() -> None:
    stems = sorted(file.stem for file in (ROOT / "assignments").rglob("*.yaml"))
    assert stems == sorted(set(stems))


@pytest.mark.parametrize("second", ["K1.yml", "sub/K1.yaml", "k1.YAML"])
def test_two_files_of_one_stem_are_a_fault(tmp_path: Path, second: str) -> None:
    batch = Batch(tmp_path, {"K1": "seconds: 0"})
    (batch.given / second).parent.mkdir(exist_ok=True)
    (batch.given / second).write_text("seconds: 0", encoding="utf-8")
    with pytest.raises(AssignmentError, match="same-stem"):
        batch.run()
    assert batch.events == []


def test_a_second_run_makes_only_what_is_missing_or_changed(tmp_path: Path) -> None:
    log = tmp_path / "log"
    batch = Batch(tmp_path, {f"K{k}": f"log: {log}" for k in range(5)})
    batch.run()
    log.unlink()
    (batch.out / "K1" / "a.pdf").unlink()
    (batch.out / "K2" / "b.xlsx").unlink()
    (batch.given / "K3.yaml").write_text(f"log: {log}\nseconds: 0", encoding="utf-8")
    batch.run()
    assert log.read_text().splitlines() == ["K1 begun", "K2 begun", "K3 begun"]
    assert (batch.students("kept"), batch.students("done")) == (["K0", "K4"], ["K1", "K2", "K3"])
    before = tree(batch.out)
    done = batch.run()
    assert (done.made, done.kept) == (0, 5)
    assert tree(batch.out) == before


@pytest.mark.parametrize("changed", ["seconds: 0", "seconds: 0\nnote: anew"], ids=["same", "changed"])
def test_a_sheet_that_is_filled_in_is_kept_and_told(tmp_path: Path, changed: str) -> None:
    batch = Batch(tmp_path, {"K1": "seconds: 0", "K2": "seconds: 0"})
    batch.run()
    sheet, page = batch.out / "K1" / "b.xlsx", batch.out / "K1" / "a.pdf"
    before = page.read_bytes()
    sheet.write_bytes(b"filled in")
    (batch.given / "K1.yaml").write_text(changed, encoding="utf-8")
    for _ in range(2):
        done = batch.run()
        assert done.notes == [f"kept because it was edited (move it away to make it again): {sheet}"]
        assert sheet.read_bytes() == b"filled in"
        assert (page.read_bytes() == before) == (changed == "seconds: 0")
    assert (done.made, done.kept) == (0, 2)
    sheet.rename(tmp_path / "mine.xlsx")
    done = batch.run()
    assert (done.made, done.kept, done.notes) == (1, 1, [])
    assert sheet.is_file()


def test_a_sheet_that_is_filled_in_outlasts_a_failure(tmp_path: Path) -> None:
    batch = Batch(tmp_path, {"K1": "seconds: 0"})
    batch.run()
    sheet, before = batch.out / "K1" / "b.xlsx", tree(batch.out / "K1")
    sheet.write_bytes(b"filled in")
    for text in ("wrong: not so", "seconds: 0\nnote: mended"):
        (batch.given / "K1.yaml").write_text(text, encoding="utf-8")
        assert len(batch.run().notes) == 1
        assert tree(batch.out / "K1").keys() == before.keys()
        assert sheet.read_bytes() == b"filled in"


def test_what_failed_is_tried_again(tmp_path: Path) -> None:
    batch = Batch(tmp_path, {"K1": "wrong: not so"})
    assert batch.run().exit_code == 1
    (batch.given / "K1.yaml").write_text("seconds: 0", encoding="utf-8")
    assert batch.run().exit_code == 0


def test_products_of_earlier_runs_stay_in_the_manifest(tmp_path: Path) -> None:
    batch = Batch(tmp_path, {"K1": "seconds: 0"})
    batch.run("little")
    batch.run("other")
    done = batch.run("little", "other")
    assert (done.made, done.kept) == (0, 2)


def test_another_engine_language_or_template_makes_all_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log = tmp_path / "log"
    batch = Batch(tmp_path, {"K1": f"log: {log}"})
    order = Order(batch.roster, None, batch.given, batch.out, ("little",), language="en", jobs=1)
    variants = [order, replace(order, engine="latex"), replace(order, language="vi"), order]
    for variant in variants:
        run_batch(variant, io.StringIO(), {"little": little})
    monkeypatch.setattr("reportgen.classes.worker_pool.templates_hash", lambda: "other words")
    batch.run()
    assert len(log.read_text().splitlines()) == len(variants) + 1


def test_students_who_left_keep_their_folder(tmp_path: Path) -> None:
    batch = Batch(tmp_path, {"K1": "seconds: 0", "K2": "seconds: 0.0"})
    batch.run()
    write_class(tmp_path, {"K1": "seconds: 0"})
    (batch.given / "K2.yaml").unlink()
    done = batch.run()
    (note,) = done.notes
    assert note.startswith("one student of an earlier run is no longer on the roster")
    assert (batch.out / "K2" / "a.pdf").exists()
    assert "K2" not in done.manifest.read_text(encoding="utf-8")


@proof
def test_what_met_many_is_said_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The typesetter is missing: one line, however large the class."""
    monkeypatch.setenv("PATH", str(tmp_path))
    text = (ROOT / "assignments" / "slider-crank-01.yaml").read_text(encoding="utf-8")
    roster, given = write_class(tmp_path, {"K1": text, "K2": text})
    order = Order(roster, None, given, tmp_path / "out", ("report",), "latex", "en")
    done = run_batch(order, io.StringIO(), pool=here)
    (said,) = [line for line in done.summary("en") if "pdflatex" in line]
    assert said.startswith("K1 report, K2 report: the LaTeX engine needs pdflatex")
    assert done.exit_code == 3


def test_a_full_disk_stops_the_batch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    batch = Batch(tmp_path, {"K1": "seconds: 0", "K2": "seconds: 0.0"})

    def full(target: Path, content: bytes) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(target))

    monkeypatch.setattr("reportgen.classes.batch_manifest.put_file", full)
    with pytest.raises(OutputError, match="No space") as raised:
        batch.run()
    assert raised.value.exit_code == 3


def test_a_folder_that_cannot_be_written_costs_one_student(tmp_path: Path) -> None:
    batch = Batch(tmp_path, {"K1": "seconds: 0", "K2": "seconds: 0.0"})
    batch.out.mkdir()
    (batch.out / "K1").write_text("a file where the folder should be", encoding="utf-8")
    done = batch.run()
    assert batch.students("done") == ["K2"]
    assert [failure.student for failure in done.failures] == ["K1"]


def test_one_batch_at_a_time_writes_to_a_folder(tmp_path: Path) -> None:
    batch = Batch(tmp_path, {"K1": "seconds: 0"})
    with locked(batch.out, "en"), pytest.raises(OutputError, match="another batch"):
        batch.run()
    assert batch.run().exit_code == 0


@pytest.mark.parametrize("given", ["nowhere", "nowhere.yaml"])
def test_a_missing_folder_or_spec_leaves_no_empty_folder(given: str, tmp_path: Path) -> None:
    roster = tmp_path / "roster.csv"
    roster.write_text("id\nK1\n", encoding="utf-8")
    order = Order(roster=roster, out=tmp_path / "new" / "out")
    missing = tmp_path / given
    order = replace(order, spec=missing) if missing.suffix else replace(order, assignments=missing)
    with pytest.raises(AssignmentError):
        run_batch(order, io.StringIO())
    assert [path.name for path in tmp_path.iterdir()] == ["roster.csv"]


def test_names_of_students_are_in_no_event(tmp_path: Path) -> None:
    batch = Batch(tmp_path, {"K1": "wrong: Nguyễn Văn A", "K2": "seconds: 0"})
    batch.run()
    assert all(len(event) == 3 for event in batch.events)
    assert not any("Sinh viên" in part or "Nguyễn" in part for event in batch.events for part in event)


def test_a_terminal_sees_a_bar(tmp_path: Path) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    terminal = Terminal()
    with watching(3, terminal, "en") as watch:
        watch("K1", "report", "kept")
        watch("K2", "report", "failed")
        watch("K3", "report", "done")
    assert "2/2" in terminal.getvalue()
    assert "1 failed" in terminal.getvalue()
    assert "a minute" in terminal.getvalue()


@proof
def test_the_command_tells_events_failures_and_the_manifest(tmp_path: Path) -> None:
    roster, given = write_class(tmp_path, {"K1": "kind: ship\n"})
    done = process("batch", roster, "--assignments", given, "--out", tmp_path / "out", "--jobs", 1, "--lang", "en")
    assert (done.returncode, done.stdout) == (1, f"{tmp_path / 'out' / 'manifest.json'}\n")
    lines = done.stderr.splitlines()
    assert lines[:3] == [f"K1\t{product}\tfailed" for product in ("task", "report", "key")]
    assert f"{given / 'K1.yaml'}:1:7: error[unknown-kind]: unknown kind of machine “ship”" in lines
    assert lines[-1] == "0 made, 0 kept, 3 failed"


@pytest.mark.parametrize(
    "options", [(), ("--spec", "a.yaml", "--assignments", "."), ("--assignments", ".", "--make", "report,dance")]
)
def test_wrong_usage_ends_with_2(tmp_path: Path, options: tuple[str, ...]) -> None:
    done = reportgen("batch", "roster.csv", *options)
    assert (done.returncode, done.stdout) == (2, "")


SPEC = ROOT / "assignments" / "class-demo" / "spec.yaml"


def test_a_class_is_drawn_from_a_spec_and_drawn_no_second_time(tmp_path: Path) -> None:
    """The student's file decides, once it is there: one edited by hand is what the report is made of."""
    roster, _ = write_class(tmp_path, {"K1": "", "K2": ""})
    out = tmp_path / "out"
    order = Order(roster, SPEC, None, out, ("little",), language="en", jobs=1)
    makers = {"little": text_of_file}
    assert run_batch(order, io.StringIO(), makers).exit_code == 0
    mine, others = (out / "assignments" / f"{name}.yaml" for name in ("K1", "K2"))
    assert (out / "K1" / "text.pdf").read_bytes() == mine.read_bytes()
    before = tree(out)
    (out / "assignments" / ".K1.yaml.a1b2c3d4").write_text("half", encoding="utf-8")
    assert run_batch(order, io.StringIO(), makers).kept == 2
    assert tree(out) == before
    mine.write_text(mine.read_text(encoding="utf-8").replace("s: 0.5", "s: 0.4"), encoding="utf-8")
    done = run_batch(order, io.StringIO(), makers)
    assert (done.made, done.kept) == (1, 1)
    assert (out / "K1" / "text.pdf").read_bytes() == mine.read_bytes()
    assert b"s: 0.4" in mine.read_bytes()
    assert tree(out)["assignments/K2.yaml"] == others.read_bytes() == before["assignments/K2.yaml"]


def text_of_file(path: Path, _engine: Engine, _language: Language | None) -> Mapping[str, bytes]:
    """A product that shows what it was made of."""
    return {"text.pdf": path.read_bytes()}
