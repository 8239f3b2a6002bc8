"""What is kept between runs saves time only: it may be damaged, deleted or impossible, and nothing changes."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from reportgen.base import files as kept
from reportgen.document import Block, template_rendering
from reportgen.writers import latex, pdflatex
from tests.lanes import matrix
from tests.writers import sample
from tests.writers.pages import needs_tex


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A cache folder of its own, in which nothing is kept yet."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    kept.folder.cache_clear()
    yield tmp_path / "cache"
    kept.folder.cache_clear()


def rendered(folder: Path) -> tuple[Block, ...]:
    """A template rendered as by a process that has not seen it yet."""
    template_rendering._compiled.codes.clear()
    template_rendering._environment.cache_clear()
    return template_rendering.Prose((folder,)).render("page", {"name": "O₁A \ue000 0 \ue001"})


@pytest.fixture
def words(tmp_path: Path) -> Path:
    (tmp_path / "words").mkdir()
    (tmp_path / "words" / "report.md").write_text("%% page\n# Độ dài {{ name }}\n\nMột câu.\n", encoding="utf-8")
    return tmp_path / "words"


def test_what_was_kept_is_found_again(home: Path) -> None:
    assert kept.kept("one") is None
    path = kept.keep("one", b"1")
    assert path is not None
    assert path.parent.parent == home
    assert kept.keep("one", b"2") == path
    assert kept.kept("one") == b"2"
    assert [entry.name for entry in path.parent.iterdir()] == ["one"], "nothing half-written stays"


def test_a_template_reads_the_same_from_the_store(home: Path, words: Path) -> None:
    first = rendered(words)
    (file,) = (home / "reportgen").iterdir()
    assert template_rendering.SECRET.encode() not in file.read_bytes(), "the number of this process's marks stays in it"
    file_before = file.read_bytes()
    assert rendered(words) == first
    assert file.read_bytes() == file_before


def test_a_changed_template_is_compiled_anew(home: Path, words: Path) -> None:
    first = rendered(words)
    (words / "report.md").write_text("%% page\n# Khác\n", encoding="utf-8")
    assert rendered(words) != first


@pytest.mark.parametrize("damage", [b"", b"?", b"\x80\x05 no bytecode at all" * 9])
def test_a_damaged_store_changes_nothing(home: Path, words: Path, damage: bytes) -> None:
    first = rendered(words)
    (file,) = (home / "reportgen").iterdir()
    whole = file.read_bytes()
    code = kept.kept(file.name)
    assert code is not None
    for content in (damage, whole[:-40], whole.replace(b"reportgen ", b"reportgen 9", 1)):
        file.write_bytes(content)
        assert rendered(words) == first
        assert file.read_bytes() == whole, "it is made anew"
    # Code that was kept whole and is none.
    kept.keep(file.name, damage + code[:-40])
    assert rendered(words) == first


def test_what_another_version_kept_or_was_damaged_is_not_used(home: Path) -> None:
    path = kept.keep("one", b"1" * 100)
    assert path is not None
    whole = path.read_bytes()
    for other in (whole[:-1], whole + b"1", whole[:-1] + b"2", whole.replace(b" ", b" 9.", 1), b"1" * 100, b""):
        path.write_bytes(other)
        assert kept.kept("one") is None
    path.write_bytes(whole)
    assert kept.kept("one") == b"1" * 100


def test_what_was_used_least_goes(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept, "LARGEST", 10_000)
    day, now = 24 * 3600, time.time()
    for name, days in (("a", 5), ("b", 4), ("c", 59), ("old", 61)):
        path = kept.keep(name, b"x" * 2000)
        assert path is not None
        os.utime(path, (now - days * day,) * 2)
    (home / "reportgen" / "left-half").write_bytes(b"x" * 10)
    os.utime(home / "reportgen" / "left-half", (now - 99 * day,) * 2)
    assert kept.kept("c"), "it is used now"

    def names() -> set[str]:
        return {path.name for path in (home / "reportgen").iterdir()}

    # In the next process what is old goes, when something is added.
    kept.prune.cache_clear()
    assert kept.kept("none") is None
    assert names() == {"a", "b", "c", "old", "left-half"}
    kept.keep("d", b"x" * 4500)
    assert names() == {"b", "c", "d"}


def test_without_a_folder_all_goes_on(home: Path, words: Path) -> None:
    home.write_text("a file where the folder should be", encoding="utf-8")
    assert kept.folder() is None
    assert kept.keep("one", b"1") is None
    assert kept.kept("one") is None
    assert rendered(words)


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="no users on this system")
def test_a_folder_of_somebody_else_is_not_used(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "getuid", lambda: 12345)
    assert kept.folder() is None


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="no users on this system")
@pytest.mark.parametrize("mode", [0o770, 0o702])
def test_a_folder_that_others_may_write_to_is_not_used(home: Path, mode: int) -> None:
    (home / "reportgen").mkdir(parents=True)
    (home / "reportgen").chmod(mode)
    assert kept.folder() is None


SPOILT: dict[str, Callable[[str], str]] = {
    "other pages": lambda known: known.replace("}{", "}{9"),
    "wider columns": lambda known: known.replace("pt}", "1pt}"),
    "half a file": lambda known: known[:-4],
    "no auxiliary file": lambda known: "\\undefined",
}


@needs_tex
@pytest.mark.parametrize("how", matrix(SPOILT, ["other pages"]))
def test_page_numbers_of_before_save_a_pass_and_change_nothing(home: Path, how: str) -> None:
    source = latex.write(sample.sample())
    first = pdflatex.compile(source)
    assert first.passes == 2
    again = pdflatex.compile(source)
    assert (again.passes, again.pdf) == (1, first.pdf)
    (file,) = (home / "reportgen").glob("contents-*")
    whole = file.read_bytes()
    known = kept.kept(file.name)
    assert known is not None
    # As another report of the same contents would have left it.
    kept.keep(file.name, SPOILT[how](known.decode()).encode())
    assert file.read_bytes() != whole
    assert pdflatex.compile(source).pdf == first.pdf
    assert file.read_bytes() == whole
