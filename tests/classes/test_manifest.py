"""The manifest: what is believed of an earlier run, and what it tells of a class."""

from __future__ import annotations

import json
from hashlib import sha256
from pathlib import Path

import pytest

from reportgen.base.errors import Location, Problem
from reportgen.base.records import replace
from reportgen.base.template_folders import templates
from reportgen.base.words import templates_hash
from reportgen.classes import batch_manifest
from reportgen.classes.batch_manifest import ManifestEntry, journal
from reportgen.classes.worker_pool import Job, Outcome, making
from tests.classes.classes import Batch
from tests.classes.little import little

JOB = Job("Số 7", "So_7-1", "little", little, "7.yaml", b"seconds: 0", making("typst", None))
FAULT = Problem("wrong", "không đúng", Location("7.yaml", 1, 8))
DONE = batch_manifest.entry_of(JOB, Outcome({"a.pdf": b"A", "b.xlsx": b"B"}))
FAILED = batch_manifest.entry_of(replace(JOB, student="8", folder="8"), Outcome(problems=(FAULT,), exit_code=1))


def test_a_result_is_told_by_hashes(tmp_path: Path) -> None:
    text = batch_manifest.write_manifest(tmp_path, [FAILED, DONE]).read_text(encoding="utf-8")
    assert json.loads(text) == {
        "format": "reportgen-batch/1",
        "students": {
            "8": {
                "folder": "8",
                "products": {
                    "little": {
                        "state": "failed",
                        "problems": ["7.yaml:1:8: error[wrong]: không đúng"],
                        "assignment": sha256(b"seconds: 0").hexdigest(),
                        "version": JOB.making.version,
                        "templates": templates_hash(),
                        "engine": "typst",
                        "language": None,
                    }
                },
            },
            "Số 7": {
                "folder": "So_7-1",
                "products": {
                    "little": {
                        "state": "done",
                        "files": {"a.pdf": sha256(b"A").hexdigest(), "b.xlsx": sha256(b"B").hexdigest()},
                        "assignment": sha256(b"seconds: 0").hexdigest(),
                        "version": JOB.making.version,
                        "templates": templates_hash(),
                        "engine": "typst",
                        "language": None,
                    }
                },
            },
        },
    }


def test_the_order_of_results_leaves_no_trace(tmp_path: Path) -> None:
    texts = [batch_manifest.write_manifest(tmp_path, order).read_bytes() for order in ((DONE, FAILED), (FAILED, DONE))]
    assert texts[0] == texts[1]


def test_it_is_read_as_it_was_written(tmp_path: Path) -> None:
    batch_manifest.write_manifest(tmp_path, [DONE, FAILED])
    assert list(batch_manifest.read_manifest(tmp_path).values()) == [FAILED, DONE]


def test_the_journal_comes_after_the_manifest_and_goes_with_the_next(tmp_path: Path) -> None:
    older = replace(DONE, files={"a.pdf": "0"})
    batch_manifest.write_manifest(tmp_path, [older])
    with journal(tmp_path) as record:
        record(DONE)
        record(FAILED)
    assert batch_manifest.read_manifest(tmp_path) == {("Số 7", "little"): DONE, ("8", "little"): FAILED}
    batch_manifest.write_manifest(tmp_path, batch_manifest.read_manifest(tmp_path).values())
    assert [path.name for path in tmp_path.iterdir()] == ["manifest.json"]


def test_a_torn_line_costs_no_other(tmp_path: Path) -> None:
    """Cut at any byte, the journal gives the lines before the cut, and never a half of one."""
    with journal(tmp_path) as record:
        record(DONE)
        record(FAILED)
    path = tmp_path / batch_manifest.JOURNAL
    whole = path.read_bytes()
    first = whole.index(b"\n")
    for end in range(len(whole)):
        path.write_bytes(whole[:end])
        wanted = [DONE, FAILED][: (end >= first) + (end >= len(whole) - 1)]
        assert list(batch_manifest.read_manifest(tmp_path).values()) == wanted


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "null",
        "{",
        "[" * 100_000,
        '{"format": "reportgen-batch/1"}',
        '{"format": "reportgen-batch/1", "students": [1]}',
        '{"format": "reportgen-batch/1", "students": {"K1": 1, "K2": {"products": {"little": 1}}}}',
        '{"format": "reportgen-batch/1", "students": {"K1": {"folder": "K1", "products": '
        '{"little": {"state": "done", "files": ["a.pdf"]}}}}}',
        '{"format": "reportgen-batch/9", "students": {}}',
        "\ud800\x00",
    ],
)
def test_a_manifest_that_is_none_makes_all_anew(tmp_path: Path, text: str) -> None:
    batch = Batch(tmp_path, {"K1": "seconds: 0"})
    batch.run()
    whole = (batch.out / batch_manifest.NAME).read_bytes()
    (batch.out / batch_manifest.NAME).write_bytes(text.encode("utf-8", "surrogatepass"))
    done = batch.run()
    assert (done.made, done.exit_code) == (1, 0)
    assert (batch.out / batch_manifest.NAME).read_bytes() == whole


@pytest.mark.parametrize("name", ["../secret.pdf", "/etc/hostname", "a\0b", "a" * 500])
def test_a_forged_manifest_vouches_for_nothing(tmp_path: Path, name: str) -> None:
    """Files named so are read at most, and never believed to be the student's."""
    batch = Batch(tmp_path, {"K1": "seconds: 0"})
    batch.run()
    path = batch.out / batch_manifest.NAME
    content = json.loads(path.read_text(encoding="utf-8"))
    (batch.out / "secret.pdf").write_bytes(b"A")
    content["students"]["K1"]["products"]["little"]["files"] = {name: sha256(b"A").hexdigest()}
    path.write_text(json.dumps(content), encoding="utf-8")
    assert batch.run().made == 1
    assert (batch.out / "secret.pdf").read_bytes() == b"A"


def test_neither_times_nor_places_are_told(tmp_path: Path) -> None:
    texts = []
    for name in ("here", "there"):
        (tmp_path / name).mkdir()
        batch = Batch(tmp_path / name, {"K1": "wrong: not so", "K2": "crash: yes", "K3": "seconds: 0", "K4": ""})
        (batch.given / "K4.yaml").unlink()
        texts.append(batch.run().manifest.read_text(encoding="utf-8"))
    assert texts[0] == texts[1]
    assert str(tmp_path) not in texts[0]
    assert not any(folder in texts[0] for folder in ("/tmp", str(templates())))


def test_an_entry_without_files_holds_nothing(tmp_path: Path) -> None:
    assert not replace(DONE, files={}).holds(JOB, tmp_path)
    assert not ManifestEntry("Số 7", "So_7-1", "little", batch_manifest.made_of(JOB)).holds(JOB, tmp_path)


@pytest.mark.parametrize("change", ["added", "altered", "renamed"])
def test_the_hash_of_templates_is_of_names_and_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, change: str
) -> None:
    (tmp_path / "school" / "vi").mkdir(parents=True)
    file = tmp_path / "school" / "vi" / "given.md"
    file.write_text("# Đề bài", encoding="utf-8")
    monkeypatch.setattr("reportgen.base.words.templates", lambda: tmp_path)
    before = templates_hash()
    assert templates_hash() == before
    if change == "added":
        (tmp_path / "empty.md").touch()
    elif change == "altered":
        file.write_text("# Đề", encoding="utf-8")
    else:
        file.rename(file.with_name("givem.d"))
    assert templates_hash() != before
