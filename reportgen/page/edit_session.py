"""Edit a file on its page: the form of the current file, changes to its text, undo and redo.

The file is the only source. A change is applied by its place to the newest text, whoever wrote it. If that value has
changed meanwhile, nothing is written and both values are reported.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from errno import errorcode
from pathlib import Path
from typing import Any

from reportgen import catalogue
from reportgen.assignment import parts
from reportgen.base.errors import Fault, Location, Problem, Where
from reportgen.base.files import contents, renew_file
from reportgen.base.kinds import kinds, title
from reportgen.base.records import Record, replace
from reportgen.base.units import Language
from reportgen.base.yaml_edit import EditError, with_value
from reportgen.base.yaml_source import (
    LARGEST,
    MOST_TOKENS,
    MappingNode,
    Node,
    Scalar,
    Source,
    decoded,
    encoding_of,
    read_own,
    read_text,
    text_in,
)
from reportgen.base.yaml_values import at
from reportgen.page import html
from reportgen.page.background_builds import Maker
from reportgen.page.controlled_parts import owners
from reportgen.page.drag_samples import Resident
from reportgen.page.form_fields import Form, written_at
from reportgen.page.html import Live
from reportgen.page.live_view import PART, LiveSession, empty_document
from reportgen.page.missing_values import MissingPanel
from reportgen.page.preview_pages import Preview, Typesetting, no_pages
from reportgen.page.pulls import Asked, Pulls, asked_place
from reportgen.page.stray_entries import by_field, with_strays
from reportgen.page.text_changes import changed_text, part_kinds
from reportgen.page.typed_values import only_meaning
from reportgen.page.value_uses import data_of, uses

MOST_STEPS = 500
"""Largest number of changes that can be undone."""
REST = 0.3
"""Time (s) without change after which a dragged value is at rest."""
PATIENCE = 10.0
"""Longest delay (s) of work that can wait."""
HERE = Location("")
FIELD_TABLES = "pasting.js", "tables.js"
REPORT_PARTS = "missing.js", "preview.js", "uses.js"
FIELDS = "drafts.js", "redraw.js", *FIELD_TABLES, "notices.js", "dragging.js", "edit.js", "owned.js", *REPORT_PARTS
PULLED = "locks.js", "pull.js", "handle.js", "region.js"
SCRIPTS = "live.js", *FIELDS, *PULLED
STYLES = "live.css", "edit.css", "notices.css", "pull.css", "preview.css"


class Change(Record):
    """The file before and after a change."""

    before: bytes
    after: bytes
    typing: str = ""
    """The typing that it belongs to: changes sent during one typing are undone together."""


class RefusedChangeError(Exception):
    """A request that cannot be carried out: the key of the words for the reason, and their arguments.

    For an error of the system, the reason is the name of its number if there are words for it, else the system's
    message.
    """

    def __init__(self, key: str, system: OSError | None = None, /, **arguments: str) -> None:
        super().__init__(key)
        self.key, self.arguments, self.system = key, arguments, system

    def in_words(self, words: Mapping[str, Any]) -> str:
        """Return the refusal as text, in the words of the form."""
        arguments = dict(self.arguments)
        if self.system is not None:
            said = self.system.strerror or str(self.system)
            arguments["reason"] = words["reasons"].get(errorcode.get(self.system.errno or 0), said)
        return str(words["refused"][self.key]).format(**arguments)


@dataclass
class EditSession(LiveSession):
    """The live session of the file at `path`, with its form."""

    path: Path = Path()
    products: Mapping[str, Sequence[str]] = field(default_factory=dict)
    """The commands that make something of the file, by the names of their products."""
    of_part: Callable[[Path], EditSession] | None = None
    """Begins the form of a part's file; None if parts have no forms."""
    pages: Typesetting = no_pages
    """Returns the pages of a typst source as pictures."""
    whole: Path | None = None
    """Coursework's file of a part, whose machine gives values to the part."""
    lock: threading.RLock = field(default_factory=threading.RLock)
    done: list[Change] = field(default_factory=list)
    undone: list[Change] = field(default_factory=list)
    dragging: threading.Lock = field(default_factory=threading.Lock)
    _resident: tuple[int, Resident | None] = 0, None
    """The machine as it moves, by the number of its revision."""
    _form: tuple[object, str, int] = None, "", 0
    """Input of the form written last, the form, and how many others there were before."""
    _missing: MissingPanel = field(default_factory=MissingPanel)
    _forming: threading.Lock = field(default_factory=threading.Lock)
    _drawn: float = 0.0
    """When a value was drawn last (s)."""
    _read: tuple[str, Node | None] | None = None
    """The text of the file and its nodes, as they were read last."""
    _opening: threading.Lock = field(default_factory=threading.Lock)
    _parts: dict[Path, tuple[int, EditSession | None]] = field(default_factory=dict)
    """The files of parts by the numbers under which they are served, which stay when parts are moved."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.preview = Preview(self.pages, self._tell_making)
        self.maker = Maker(self.products, self.preview.hear, self.preview.source)
        self.pulls = Pulls(self.path, self._resident_machine, self._nodes)

    def _tell_making(self, making: Mapping[str, Any]) -> bool:
        """Publish the state of a product; return False for pages of a PDF whose file has been read again since."""
        with self.changed:
            if "preview" in making and not self.revision.making:
                return False
            self._publish(making=making)
            return True

    def close(self) -> None:
        self.maker.close()
        self.preview.close()
        super().close()

    # --- requests of the page

    def made(self, name: str) -> bytes | None:
        if (page := self.preview.page(name)) is not None:
            return page
        file = self.maker.files.get(name)
        return file.read_bytes() if file is not None and file.is_file() else None

    def make(self, asked: Asked) -> Mapping[str, Any]:
        """Begin to make a product by its name, or end the process that is making one."""
        if asked.get("end"):
            self.maker.end()
            return {}
        return {"begun": self.maker.make(str(asked["product"]))}

    def _written_page(self) -> str:
        now = self.revision
        live = Live({**now.words["live"], **now.words["edit"]}, now.moving, now.reports, SCRIPTS, STYLES, self.form())
        return html.write(now.document or empty_document(now), now.words["page"], now.panels, live, now.report)

    @property
    def answers(self) -> Mapping[str, Callable[[], Mapping[str, Any]]]:
        return {
            **super().answers,
            "form.json": self.numbered_form,
            "owners.json": self.owners,
            "grips.json": self.grips,
        }

    @property
    def takes(self) -> Mapping[str, Callable[[Asked], Mapping[str, Any] | bytes]]:
        return {
            "edit.json": self.edit,
            "drag.json": self.drag,
            "uses.json": self.uses,
            "pull.json": self.pull,
            **self.pulls.takes,
            "make.json": self.make,
        }

    def uses(self, asked: Asked) -> Mapping[str, Any]:
        """Return where the report of the last valid file uses the value at a place; nothing without a report."""
        now, top = self.revision, self._nodes()
        if now.case is None or now.document is None or top is None:
            return {"lines": [], "following": 0}
        return uses(now.case, now.document, data_of(top, asked_place(asked["where"]), self.path))

    def below(self, name: str) -> EditSession | None:
        """Return the open form of a part's file by its number: a file that the text names now, in its folder or below.

        No request names a file: its place is read from the coursework's text each time.
        """
        allowed = self._part_files() if self.of_part is not None else []
        with self._opening:
            for file, (number, session) in self._parts.items():
                if str(number) == name and file in allowed and self.of_part is not None:
                    opened = session or self.of_part(file)
                    self._parts[file] = number, opened
                    return opened
        return None

    def _part_files(self, source: Source | None = None) -> list[Path]:
        """Return the files of parts that the text names and that may be opened."""
        if source is None:
            with self.lock:
                text = text_in(self.path)
            source = Source("") if isinstance(text, Fault) else read_text(text)
        return [file for file in parts.files(source, self.path) if file.is_file()]

    def _pages(self, source: Source) -> Mapping[str, tuple[str, str]]:
        """Return the address of each part's own page, or of the coursework's, and the name of its file, by path."""
        if self.whole is not None:
            return {str(self.whole): ("../../", self.whole.name)}
        if self.of_part is None:
            return {}
        files = self._part_files(source)
        with self._opening:
            for file in files:
                self._parts.setdefault(file, (len(self._parts), None))
            return {str(file): (f"{PART}{self._parts[file][0]}/", file.name) for file in files}

    def form(self) -> str:
        """Return the form of the file as it is, with its faults; of a text that is not a table, the faults alone."""
        return str(self.numbered_form()["form"])

    def numbered_form(self) -> Mapping[str, Any]:
        """Return the form with the number of its revision.

        Forms are made one at a time, so that a page can ignore an answer that is older than its own form.
        """
        with self._forming:
            written = self._written_form()
            return {"form": written, "revision": self._form[2]}

    def _written_form(self) -> str:
        language, words = self._spoken()
        with self.lock:
            text, undo, redo = text_in(self.path), bool(self.done), bool(self.undone)
        source = Source(str(self.path), faults=(text,)) if isinstance(text, Fault) else read_text(text, str(self.path))
        given = catalogue.with_taken(source, self.path, self.whole)
        problems, pages = catalogue.problems_of(given, self.path, language), self._pages(source)
        inputs = given, tuple(problems), language, undo, redo, tuple(pages.items()), self.revision.case
        # The page that made a change requests the form again when it receives the news.
        if self._form[0] == inputs:
            return self._form[1]
        kind = at(source.top, ("kind",))
        known = isinstance(kind, Scalar) and catalogue.is_sound(kind.text)
        form = (
            Form(catalogue.kind(kind.text), language, given.top, source.top)
            if known and isinstance(kind, Scalar) and isinstance(given.top, MappingNode)
            else None
        )
        faults = _by_place(problems, source)
        groups = with_strays(form.groups, source.top, faults) if form else []
        written = html.template("form.html.j2").render(
            words=words["edit"],
            groups=groups,
            kind=kind.text if isinstance(kind, Scalar) else "",
            title=title(kind.text, language) if isinstance(kind, Scalar) and kind.text in kinds() else "",
            file=self.path.name,
            problems=problems,
            elsewhere={file: Path(file).name for problem in problems if (file := problem.location.file) != source.file},
            faults=by_field(groups, faults),
            can_undo=undo,
            can_redo=redo,
            # What takes something from a machine cannot be made without it.
            products=[] if given.top is not source.top else list(self.products),
            # To know the kinds of parts, all kinds are loaded.
            part_kinds={name: title(name, language) for name in part_kinds()} if form and form.has_parts else {},
            pages=pages,
            folder=self.path.parent,
            whole=self.whole and self.whole.name,
            missing=self._missing.rows(self.revision.case, problems, form, source),
        )
        self._form = inputs, written, self._form[2] + 1
        return written

    def owners(self) -> Mapping[str, Any]:
        """Return the bars and points of each value by the place of its field, and the places of fixed points (mm).

        This can wait: the report is written first, and dragging has priority. The search ends when the machine is no
        longer the newest.
        """
        with self.dragging:
            resident = self._resident_machine()
        number = self.revision.moving
        with self.changed:
            self.changed.wait_for(lambda: self._is_over(number) or not self.revision.busy, PATIENCE)
        top = self._nodes()
        if resident is None or not isinstance(top, MappingNode):
            return {"fields": [], "ground": {}}
        machine, scale = resident.samples.machine, resident.samples.scale
        fields = []
        for where, own in owners(machine, top, Source(str(self.path), top=top)):
            while not self._is_over(number) and time.monotonic() < self._drawn + REST:
                time.sleep(REST)
            if self._is_over(number):
                break
            fields += [{"where": list(where), "bars": own.bars, "points": own.points}] if own else []
        ground = {name: [at.real * scale, -at.imag * scale] for name, at in machine.linkage.ground.items()}
        return {"fields": fields, "ground": ground}

    def _is_over(self, number: int) -> bool:
        """Return True if a machine, by the number of its revision, is no longer the newest, or the form is
        closed.
        """
        return self.closed or self.revision.moving != number

    def _resident_machine(self) -> Resident | None:
        """Return the machine of the last valid file, ready to be sampled; None for a case of another kind."""
        now = self.revision
        if now.case is not None and self._resident[0] != now.moving:
            self._resident = now.moving, Resident.of(now.case, now.moving)
        return self._resident[1]

    def _spoken(self) -> tuple[Language, Mapping[str, Any]]:
        return self.revision.language, self.revision.words

    # --- changes and drags

    def edit(self, asked: Asked) -> Mapping[str, Any]:
        """Make a change and return the new form, with `written`, the value that is now at its place.

        If the change cannot be made, `refused` says why, and the file stays as it was. Raise `KeyError`, `TypeError` or
        `ValueError` for a request that no page of this program makes.
        """
        operation, where = str(asked["op"]), asked_place(asked.get("where", []))
        said: dict[str, Any] = {}
        with self.lock:
            try:
                if operation in ("undo", "redo"):
                    self._step(operation)
                else:
                    said["written"] = self._change(operation, where, asked)
            except RefusedChangeError as refusal:
                said["refused"] = refusal.in_words(self._spoken()[1]["edit"])
                if refusal.key == "meanwhile":
                    said["meanwhile"] = refusal.arguments["there"]
        self.touched.set()
        return {**self.numbered_form(), **said}

    def _change(self, operation: str, where: Where, asked: Asked) -> str | list[str]:
        """Make a change and return the text that the file then has at its place; a list if several values are set.

        Several values are written all or none.
        """
        before = self._bytes()
        text = changed = self._decoded(before)
        changes = asked["changes"] if operation == "set all" else [asked]
        places = [asked_place(each["where"]) for each in changes] if operation == "set all" else [where]
        for place, each in zip(places, changes, strict=True):
            changed = self._altered(changed, "set" if operation == "set all" else operation, place, each)
        # Only a long text can exceed the limits of a file, for which no form could be made.
        if len(changed) > MOST_TOKENS and read_text(changed).faults:
            raise RefusedChangeError("too_large")
        if changed != text:
            bom, codec = encoding_of(before)
            try:
                after = bom + changed.encode(codec)
            except UnicodeEncodeError as error:
                raise RefusedChangeError("no_letter", codec=codec) from error
            self._write(Change(before, after, str(asked.get("typing", ""))))
            self.undone.clear()
        written = [written_at(at(read_text(changed).top, place)) for place in places]
        return written if operation == "set all" else written[0]

    def _altered(self, text: str, operation: str, where: Where, asked: Asked) -> str:
        """Return the text of the file with one change."""
        if not where:
            raise ValueError("the whole file is no value")
        if "was" in asked and operation in ("set", "instead"):
            self._same(text, where, str(asked["was"]), str(asked["value"]))
        try:
            changed = changed_text(text, operation, where, asked)
            while operation == "set" and (meant := self._meant(changed, where)):
                changed = with_value(text, where, Scalar(meant, HERE))
        except EditError as error:
            raise RefusedChangeError(error.key, **error.arguments) from error
        return changed

    def _meant(self, text: str, where: Where) -> str:
        """Return how the program writes the value typed at a place if it is faulty but can mean only one thing."""
        given = catalogue.with_taken(read_text(text, str(self.path)), self.path, self.whole)
        problems = catalogue.problems_of(given, self.path, self._spoken()[0])
        return only_meaning(problem for problem in problems if problem.where == where)

    def _same(self, text: str, place: Where, was: str, wanted: str) -> None:
        """Raise `RefusedChangeError` if the value at a place is neither the page's value nor the requested one."""
        there = written_at(at(read_text(text).top, place))
        if there not in (was, wanted):
            raise RefusedChangeError("meanwhile", there=there, here=wanted)

    def _step(self, operation: str) -> None:
        """Undo or redo the last change: the file gets the bytes from before it, or from after it."""
        steps = self.done if operation == "undo" else self.undone
        if not steps:
            return
        change = steps[-1] if operation == "undo" else Change(steps[-1].after, steps[-1].before)
        if self._bytes() != change.after:
            steps.clear()
            raise RefusedChangeError("changed")
        self._put(change.before)
        (self.undone if operation == "undo" else self.done).append(steps.pop())

    def drag(self, asked: Asked) -> Mapping[str, Any] | bytes:
        """Return the samples of everything that moves with another value at a place; write nothing.

        The samples are four-byte numbers. Return no bytes if no machine has that value. For a kind that is not a
        machine the answer is empty, and the page is renewed when the value is released.
        """
        self._drawn = time.monotonic()
        with self.dragging:
            return self.pulls.drag(asked)

    def pull(self, asked: Asked) -> Mapping[str, Any] | bytes:
        """Return the samples of everything that moves with a point that is pulled; see `Pulls.pull`."""
        self._drawn = time.monotonic()
        with self.dragging:
            return self.pulls.pull(asked)

    def grips(self) -> Mapping[str, Any]:
        """Return what can be pulled on the machine; see `Pulls.grips`."""
        with self.dragging:
            self._resident_machine()
        return self.pulls.grips()

    def _nodes(self) -> Node | None:
        """Return the nodes of the file as it is, None if it cannot be read."""
        with self.lock:
            text = text_in(self.path)
        if isinstance(text, Fault):
            return None
        if self._read is None or self._read[0] != text:
            self._read = text, read_own(text).top
        return self._read[1]

    # --- the file

    def _bytes(self) -> bytes:
        try:
            data = contents(self.path, LARGEST + 1)
        except OSError as error:
            raise RefusedChangeError("unreadable", error) from error
        if len(data) > LARGEST:
            raise RefusedChangeError("too_large")
        return data

    def _decoded(self, data: bytes) -> str:
        text = decoded(data, str(self.path))
        if isinstance(text, Fault):
            raise RefusedChangeError("no_table")
        return text

    def _write(self, change: Change) -> None:
        if len(change.after) > LARGEST:
            raise RefusedChangeError("too_large")
        self._put(change.after)
        last = self.done[-1] if self.done else None
        if last is not None and change.typing and (last.typing, last.after) == (change.typing, change.before):
            self.done.pop()
            change = replace(change, before=last.before)
        self.done.append(change)
        del self.done[:-MOST_STEPS]

    def _put(self, content: bytes) -> None:
        try:
            renew_file(self.path, content)
        except OSError as error:
            raise RefusedChangeError("unwritten", error) from error


def _by_place(problems: list[Problem], source: Source) -> dict[Where, list[Problem]]:
    """Return the faults by the places of the fields that show them: for an item of a list of values, its list."""
    places: dict[Where, list[Problem]] = {}
    for problem in problems:
        where = problem.where
        while where and isinstance(where[-1], int) and not isinstance(at(source.top, where), MappingNode):
            where = where[:-1]
        if problem.location.file == source.file:
            places.setdefault(where, []).append(problem)
    return places
