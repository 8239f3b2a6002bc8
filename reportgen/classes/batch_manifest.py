"""The record of a batch's products and their inputs, with which a second run makes only what is missing or changed.

`manifest.json` is replaced as a whole at the beginning and at the end of a run. In between, each result is one line in
a journal beside it, which the next run reads if this one was killed. So a line costs the same for the first and the
thousandth student, and a torn line loses no other.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from reportgen.base.files import contents, put_file
from reportgen.base.provenance import MADE_OF, Made, hash_of
from reportgen.base.provenance import made_of as made_of_input
from reportgen.base.records import Record, field
from reportgen.classes.worker_pool import Job, Outcome

if TYPE_CHECKING:
    pass

NAME = "manifest.json"
JOURNAL = ".manifest.journal"
FORMAT = "reportgen-batch/1"
ASK = "ask"
"""Name of the input for the answer sheet's selection, if a policy gives one."""
STANDARDS = "standards"
"""Name of the input for the standards of a PDF, if they are not the default."""


class ManifestEntry(Record):
    """One product of one student: its inputs, and its files with their SHA-256, or the problems that made it fail."""

    student: str
    folder: str
    product: str
    made_of: Mapping[str, str | None] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)
    problems: tuple[str, ...] = ()

    def holds(self, job: Job, out: Path) -> bool:
        """Return True if the files exist and have the same inputs; an edited file counts as existing."""
        return (
            not self.problems
            and bool(self.files)
            and (self.folder, self.made_of) == (job.folder, made_of(job))
            and all(hash_of(out / self.folder / name) for name in self.files)
        )

    @property
    def made(self) -> Made:
        return Made(self.made_of, self.files)

    def edited(self, out: Path) -> Iterator[Path]:
        """Yield the files that were changed since they were made, for example a filled answer sheet."""
        return self.made.edited(out / self.folder)


def entry_of(job: Job, outcome: Outcome) -> ManifestEntry:
    """Return the manifest entry of an outcome: hashes and words, without times or paths."""
    hashes = {name: sha256(content).hexdigest() for name, content in outcome.files.items()}
    problems = tuple(map(str, outcome.problems))
    return ManifestEntry(job.student, job.folder, job.product, made_of(job), hashes, problems)


def made_of(job: Job) -> dict[str, str | None]:
    """Return the inputs of a job's product, including `ASK` for the sheet's selection and `STANDARDS` for its PDF."""
    how = job.making
    more = {ASK: how.ask, STANDARDS: how.standards}
    return made_of_input(job.assignment, how.engine, how.language, how.templates, how.version, **more)


def read_manifest(out: Path) -> dict[tuple[str, str], ManifestEntry]:
    """Return the entries of a folder by student and product, including the journal of a killed run.

    A file that cannot be parsed counts as missing: its products are made again.
    """
    lines = map(_parsed, _text(out / JOURNAL).split("\n"))
    entries = (_entry(line) for line in (*_lines(_parsed(_text(out / NAME))), *lines))
    return {(entry.student, entry.product): entry for entry in entries if entry is not None}


def write_manifest(out: Path, entries: Iterable[ManifestEntry]) -> Path:
    """Replace the manifest, sorted by student and product, and delete the journal."""
    students: dict[str, Any] = {}
    for entry in entries:
        of_student = students.setdefault(entry.student, {"folder": entry.folder, "products": {}})
        of_student["products"][entry.product] = _plain(entry)
    content = {"format": FORMAT, "students": students}
    target = out / NAME
    text = json.dumps(content, ensure_ascii=False, indent=1, sort_keys=True) + "\n"
    put_file(target, text.encode())
    (out / JOURNAL).unlink(missing_ok=True)
    return target


@contextmanager
def journal(out: Path) -> Iterator[Callable[[ManifestEntry], None]]:
    """Yield a function that journals each entry once its files exist; `write_manifest` deletes the journal."""
    with (out / JOURNAL).open("a", encoding="utf-8", newline="\n") as stream:

        def record(entry: ManifestEntry) -> None:
            head = {"student": entry.student, "folder": entry.folder, "product": entry.product}
            stream.write(json.dumps(head | _plain(entry), ensure_ascii=False) + "\n")
            stream.flush()

        yield record


def _plain(entry: ManifestEntry) -> dict[str, Any]:
    common = {**entry.made_of, "state": "failed" if entry.problems else "done"}
    details = {"problems": list(entry.problems), "files": dict(entry.files)}
    return common | {name: some for name, some in details.items() if some}


def _lines(content: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the entries of a manifest in the form of journal lines."""
    students = content.get("students")
    if content.get("format") != FORMAT or not isinstance(students, dict):
        return
    for student, of_student in students.items():
        if isinstance(of_student, dict) and isinstance(of_student.get("products"), dict):
            for product, plain in of_student["products"].items():
                if isinstance(plain, dict):
                    yield plain | {"student": student, "folder": of_student.get("folder"), "product": product}


def _entry(line: dict[str, Any]) -> ManifestEntry | None:
    """Return the entry of a line, or None if the line does not have the form that `journal` writes."""
    made = {key: line.get(key) for key in (*MADE_OF, *(name for name in (ASK, STANDARDS) if name in line))}
    try:
        entry = msgspec.convert({**line, "made_of": made}, ManifestEntry)
    except msgspec.ValidationError:
        return None
    return entry if all(Path(name).name == name for name in entry.files) else None


def _parsed(text: str) -> dict[str, Any]:
    try:
        content = json.loads(text)
    except (ValueError, RecursionError):
        return {}
    return content if isinstance(content, dict) else {}


def _text(path: Path) -> str:
    try:
        return contents(path).decode("utf-8", "replace")
    except FileNotFoundError:
        return ""
