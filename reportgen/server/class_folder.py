"""The folder of a class: the files of `variants`, `batch` and `grade`, and in `server/` what only the server needs.

spec.yaml  roster.csv  policy.yaml  corrections.csv
variants/  tasks/  keys/  marked/     made by `variants`, `batch`, `grade`, or by the server: the same files
handed/    ID/answers.xlsx and the uploads of each student, as `grade` reads them
server/    class.db  secret  uploads/  sheets/
"""

from __future__ import annotations

import hashlib
import json
import os
from functools import lru_cache
from pathlib import Path
from typing import Any

from reportgen.assignment.reading import words_beside
from reportgen.base.errors import Fault, Location, ReportgenError
from reportgen.base.files import contents, leads_out, put_file, put_files, put_set, reported, version
from reportgen.base.records import Record
from reportgen.base.units import Language
from reportgen.base.words import as_error, language_of
from reportgen.base.yaml_source import read_source
from reportgen.classes.earlier_draw import read_earlier
from reportgen.classes.roster import PERSONAL, Roster, RosterEntry, comparable, read_roster
from reportgen.classes.variant_spec import read_spec
from reportgen.marking.marking_policy import Policy, read_policy
from reportgen.workbook import write_csv

LONGEST_NAME = 80
"""Characters kept of the name of an uploaded file."""


class ClassFolder(Record):
    """The paths of a class."""

    path: Path

    @property
    def spec(self) -> Path:
        return self.path / "spec.yaml"

    @property
    def roster(self) -> Path:
        return self.path / "roster.csv"

    @property
    def variants(self) -> Path:
        return self.path / "variants"

    @property
    def tasks(self) -> Path:
        return self.path / "tasks"

    @property
    def keys(self) -> Path:
        return self.path / "keys"

    @property
    def handed(self) -> Path:
        return self.path / "handed"

    @property
    def marked(self) -> Path:
        return self.path / "marked"

    @property
    def corrections(self) -> Path:
        return self.path / "corrections.csv"

    @property
    def handed_roster(self) -> Path:
        """The roster with the times of the hand-ins, for marking."""
        return self.path / "handed-in.csv"

    @property
    def server(self) -> Path:
        return self.path / "server"

    @property
    def uploads(self) -> Path:
        return self.server / "uploads"

    @property
    def sheets(self) -> Path:
        return self.server / "sheets"

    @property
    def policy_file(self) -> Path | None:
        """The policy; None if the class has none."""
        file = self.path / "policy.yaml"
        return file if file.exists() else None

    def policy(self) -> Policy:
        """Return the policy of the class, or the last valid one while there is a mistake in the file."""
        return self.valid_policy()[0]

    def valid_policy(self) -> tuple[Policy, ReportgenError | None]:
        """Return the same with the mistake; a valid policy is kept for then."""
        file = self.policy_file
        if file is None:
            return Policy(), None
        about = file.stat()
        return _valid_at(file, about.st_mtime_ns, about.st_size, self.server / "policy.yaml")

    def students(self, language: Language | None = None) -> tuple[RosterEntry, ...]:
        return read_roster(self.roster, language).students

    @property
    def language(self) -> Language:
        """The language of the class, that of its spec."""
        return language_of(read_source(self.spec))

    def assignment(self, folder: str) -> Path:
        """Return the assignment file of a student."""
        return self.variants / f"{folder}.yaml"

    def content(self, folder: str) -> str:
        """Return a hash of a student's assignment file, its parts and what is asked for; "" without a file."""
        files = sorted((self.assignment(folder), *self.variants.glob(f"{folder}.*.yaml")))
        made = hashlib.sha256(str(self.policy().ask).encode())
        for file in files:
            try:
                made.update(file.name.encode() + b"\0" + contents(file) + b"\0")
            except OSError:
                return ""
        return made.hexdigest()[:32]

    def draws(self, language: Language | None = None) -> dict[str, str]:
        """Return for each student the number of the redrawn variant, "0" without one, and a hash of the files."""
        redrawn = read_earlier(self.variants / "variants.csv", language).redrawn
        made: dict[str, str] = {}
        for student in self.students(language):
            files = sorted((self.assignment(student.folder), *self.variants.glob(f"{student.folder}.*.yaml")))
            hashed = hashlib.sha256(b"\0".join(contents(file) for file in files if file.exists())).hexdigest()
            made[student.folder] = f"{redrawn.get(comparable(student.id), 0)} {hashed}"
        return made

    def sheet(self, folder: str) -> dict[str, Any] | None:
        """Return the answer sheet of a student's variant for a browser; None if it is not made yet."""
        try:
            made: dict[str, Any] = json.loads((self.sheets / f"{folder}.json").read_bytes())
        except (OSError, ValueError):
            return None
        return made if made["content"] == self.content(folder) else None

    def kept_file(self, folder: str, content: str, name: str) -> Path:
        """Return the path of a file that was made for a student's assignment; `content` is its hash."""
        return self.server / "made" / folder / f"{version()}-{content[:12]}-{name}"

    def put_sheet(self, folder: str, sheet: dict[str, Any]) -> None:
        put_files(self.sheets, {f"{folder}.json": json.dumps(sheet, ensure_ascii=False).encode()})

    def begin(self, spec: Path, roster: Path, policy: Path | None, language: Language | None) -> None:
        """Copy the files of a new class into its folder; raise `AssignmentError` if there is one already."""
        if self.spec.exists() or self.roster.exists():
            raise as_error([Fault("serve-class-there", Location(str(self.path)))], language)
        read, students = read_spec(spec, language), read_roster(roster, language)
        base = spec.absolute().parent
        files: dict[Path, bytes] = {}
        for file in read.files:
            if leads_out(file, base):
                raise as_error([Fault("serve-outside", Location(str(file)))], language)
            name = "spec.yaml" if file == spec else file.absolute().relative_to(base).as_posix()
            files[self.path / name] = contents(file)
        files |= {self.path / name: content for name, content in words_beside(spec).items()}
        files[self.roster] = roster_table(students)
        if policy is not None:
            read_policy(policy, language)
            files[self.path / "policy.yaml"] = contents(policy)
        with reported(self.path):
            for target in files:
                target.parent.mkdir(parents=True, exist_ok=True)
            put_set(files)

    def add(self, card: dict[str, str], language: Language | None) -> RosterEntry:
        """Add a student to the roster; raise `AssignmentError` for an invalid or known id."""
        known = read_roster(self.roster, language)
        before = contents(self.roster)
        entry = RosterEntry(card, {}, Location(str(self.roster)))
        with reported(self.path):
            put_set({self.roster: roster_table(Roster((*known.students, entry), known.columns))})
            try:
                listed = read_roster(self.roster, language)
            except Exception:
                put_set({self.roster: before})
                raise
        return listed.students[-1]

    def add_upload(self, content: bytes, sha256: str) -> Path:
        """Keep the content of an upload under its hash; it is on the disk when this returns."""
        self.uploads.mkdir(parents=True, exist_ok=True, mode=0o700)
        target = self.uploads / sha256
        if not target.exists():
            part = self.uploads / f"{sha256}.{os.getpid()}.{id(content):x}.part"
            try:
                with open(part, "xb") as file:
                    file.write(content)
                    file.flush()
                    os.fsync(file.fileno())
                os.replace(part, target)
            finally:
                part.unlink(missing_ok=True)
            synced(self.uploads)
        return target


@lru_cache(maxsize=4)
def _valid_at(file: Path, changed: int, size: int, kept: Path) -> tuple[Policy, ReportgenError | None]:
    """Return a policy as it was at the time of a change; after a mistake, the one that was `kept`, and the mistake."""
    try:
        policy = read_policy(file)
    except ReportgenError as error:
        return (read_policy(kept) if kept.exists() else Policy()), error
    put_file(kept, contents(file))
    return policy, None


def synced(folder: Path) -> None:
    """Have the names in a folder on the disk."""
    if hasattr(os, "O_DIRECTORY"):
        handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def roster_table(roster: Roster) -> bytes:
    """Return a roster as CSV: personal data and the values that it sets."""
    paths = list(dict.fromkeys(name for student in roster.students for name in student.overrides))
    rows: list[list[str]] = [[*PERSONAL, *paths]]
    for student in roster.students:
        own = [student.card.get(name, "") for name in PERSONAL]
        rows.append(own + [student.overrides[path].text if path in student.overrides else "" for path in paths])
    return write_csv(rows)


def safe_name(name: str) -> str:
    """Return the name of an uploaded file without folders, control characters and what systems forbid in names."""
    last = name.replace("\\", "/").rsplit("/", 1)[-1]
    kept = "".join(sign if sign.isprintable() and sign not in '<>:"|?*' else "_" for sign in last).strip(" .")
    stem, dot, suffix = kept.rpartition(".")
    if not dot or len(suffix) > 8:
        return kept[:LONGEST_NAME] or "file"
    return f"{stem[: LONGEST_NAME - len(suffix) - 1] or 'file'}.{suffix}"
