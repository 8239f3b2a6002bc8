"""What a batch has made, and of what: the file that lets a second run do only what is missing or changed.

`manifest.json` is replaced as a whole, at the beginning and at the end of a run.  In between each result
is one line more in a journal beside it, which the next run reads if this one was killed: a line costs the
same for the first and the thousandth student, and a torn one costs no other.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from types import TracebackType
from typing import IO, Any

from reportgen import api
from reportgen.batch.jobs import Job, Outcome

NAME = "manifest.json"
JOURNAL = ".manifest.journal"
FORMAT = "reportgen-batch/1"


@dataclass(frozen=True, slots=True)
class Entry:
    """One product of one student: what it was made of, and its files with their SHA-256, or what failed."""

    student: str
    folder: str
    product: str
    made_of: Mapping[str, str | None] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)
    problems: tuple[str, ...] = ()

    def holds(self, job: Job, out: Path) -> bool:
        """Whether the files are there, unaltered, and would be made of the same again."""
        return (
            not self.problems
            and bool(self.files)
            and (self.folder, self.made_of) == (job.folder, made_of(job))
            and all(_hash(out / self.folder / name) == known for name, known in self.files.items())
        )


def entry(job: Job, outcome: Outcome) -> Entry:
    """What the manifest keeps of an outcome: hashes and words, no times and no paths."""
    hashes = {name: sha256(content).hexdigest() for name, content in outcome.files.items()}
    problems = tuple(map(str, outcome.problems))
    return Entry(job.student, job.folder, job.product, made_of(job), hashes, problems)


def made_of(job: Job) -> dict[str, str | None]:
    """All that decides the bytes of a product."""
    return {
        "assignment": job.assignment,
        "engine": job.making.engine,
        "language": job.making.language,
        "templates": job.making.templates,
        "version": job.making.version,
    }


def read(out: Path) -> dict[tuple[str, str], Entry]:
    """The entries of a folder by student and product, with what a killed run left in its journal.

    A file that cannot be understood counts as missing: its products are made again.
    """
    entries = [*_entries_of_manifest(_text(out / NAME)), *_entries_of_journal(_text(out / JOURNAL))]
    return {(found.student, found.product): found for found in entries}


def write(out: Path, entries: Iterable[Entry]) -> Path:
    """Replaces the manifest, sorted by student and product; then the journal has nothing to add."""
    students: dict[str, Any] = {}
    for found in entries:
        of_student = students.setdefault(found.student, {"folder": found.folder, "products": {}})
        of_student["products"][found.product] = _plain(found)
    content = {"format": FORMAT, "students": students}
    target = out / NAME
    text = json.dumps(content, ensure_ascii=False, indent=1, sort_keys=True) + "\n"
    api.replace(target, text.encode())
    (out / JOURNAL).unlink(missing_ok=True)
    return target


class Journal(AbstractContextManager[Callable[[Entry], None]]):
    """Takes down each entry as soon as its files stand; gone again with the next `write`."""

    def __init__(self, out: Path) -> None:
        self.path = out / JOURNAL
        self.stream: IO[str] | None = None

    def __enter__(self) -> Callable[[Entry], None]:
        stream = self.stream = self.path.open("a", encoding="utf-8", newline="\n")

        def record(made: Entry) -> None:
            head = {"student": made.student, "folder": made.folder, "product": made.product}
            stream.write(json.dumps(head | _plain(made), ensure_ascii=False) + "\n")
            stream.flush()

        return record

    def __exit__(
        self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.stream is not None:
            self.stream.close()


def _plain(made: Entry) -> dict[str, Any]:
    common = {**made.made_of, "state": "failed" if made.problems else "done"}
    return common | ({"problems": list(made.problems)} if made.problems else {"files": dict(made.files)})


def _entries_of_manifest(text: str) -> Iterable[Entry]:
    content = _parsed(text)
    if content.get("format") != FORMAT or not isinstance(content.get("students"), dict):
        return
    for student, of_student in content["students"].items():
        if isinstance(of_student, dict) and isinstance(of_student.get("products"), dict):
            for product, plain in of_student["products"].items():
                yield from _entry(student, of_student.get("folder"), product, plain)


def _entries_of_journal(text: str) -> Iterable[Entry]:
    for line in text.split("\n"):
        plain = _parsed(line)
        yield from _entry(plain.get("student"), plain.get("folder"), plain.get("product"), plain)


def _entry(student: Any, folder: Any, product: Any, plain: Any) -> Iterable[Entry]:
    """The entry, unless it is not of the form that `_plain` gives."""
    if not (isinstance(plain, dict) and all(isinstance(name, str) for name in (student, folder, product))):
        return
    files, problems = plain.get("files", {}), plain.get("problems", [])
    if not (isinstance(files, dict) and isinstance(problems, list)):
        return
    if any(Path(name).name != name for name in files):
        return
    made = {key: plain.get(key) for key in ("assignment", "engine", "language", "templates", "version")}
    names = {str(name): str(known) for name, known in files.items()}
    yield Entry(student, folder, product, made, names, tuple(map(str, problems)))


def _parsed(text: str) -> dict[str, Any]:
    try:
        content = json.loads(text)
    except (ValueError, RecursionError):
        return {}
    return content if isinstance(content, dict) else {}


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except FileNotFoundError:
        return ""


def _hash(path: Path) -> str:
    try:
        return sha256(path.read_bytes()).hexdigest()
    except (OSError, ValueError):
        return ""
