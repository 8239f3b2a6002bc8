"""A student's variant as an assignment file of its own, which stays as it is once somebody has edited it.

The head names the version, the spec with its SHA-256, the salt and the student; its last line the SHA-256 of all that
follows.  A file whose text still has that hash has not been touched since it was made.
"""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from reportgen.assignment.messages import word
from reportgen.assignment.source import Node, Scalar, Table
from reportgen.batch.draw import Drawn
from reportgen.batch.nodes import at, put
from reportgen.batch.spec import Spec, assembled
from reportgen.batch.written import quoted, text_of
from reportgen.errors import Mark
from reportgen.version import version

State = Literal["new", "changed", "same", "kept"]
"""Of a file: made, made anew, left since nothing changed, left since it was edited by hand."""

HEAD_LINES = 3
_HASH = re.compile(r"#.*\b([0-9a-f]{64})")
_HERE = Mark("")


@dataclass(frozen=True, slots=True)
class Frozen:
    """A student's file: where it belongs, its whole text, and what is to be done with it."""

    path: Path
    text: str
    state: State


def freeze(spec: Spec, drawn: Drawn, folder: Path, force: bool = False) -> Frozen:
    """The assignment file of a student in `folder`; one there that was edited is kept unless `force`."""
    body = _body(spec, drawn)
    path = folder / f"{drawn.student.folder}.yaml"
    text = _head(spec, drawn, body) + body
    return Frozen(path, text, _state(path, body, force))


def _state(path: Path, body: str, force: bool) -> State:
    try:
        old = path.read_bytes().decode("utf-8", "replace").replace("\r\n", "\n")
    except FileNotFoundError:
        return "new"
    *head, present = old.split("\n", HEAD_LINES)
    stated = _HASH.fullmatch(head[-1]) if len(head) == HEAD_LINES else None
    untouched = stated is not None and stated[1] == _digest(present)
    if untouched and present == body:
        return "same"
    return "changed" if untouched or force else "kept"


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _head(spec: Spec, drawn: Drawn, body: str) -> str:
    """Comments; what a user wrote is quoted, so that no line can end in it."""
    lines = (
        word("variants_for", spec.language).format(id=quoted(drawn.student.id)),
        word("variants_made", spec.language).format(
            version=version(), spec=quoted(spec.path.name), digest=spec.digest, salt=quoted(spec.salt)
        ),
        word("variants_body", spec.language).format(digest=_digest(body)),
    )
    return "".join(f"# {line}\n" for line in lines)


def _body(spec: Spec, drawn: Drawn) -> str:
    student = drawn.student
    personal = {
        "name": student.name,
        "id": student.id,
        "class": student.class_,
        "section": student.section,
        "email": student.email,
    }
    card = Table(tuple((_scalar(key), _scalar(text)) for key, text in personal.items() if text), _HERE)
    table: Node = put(assembled(spec.top, drawn.settings), ("report", "student"), card)
    if at(table, ("report", "language")) is None:
        table = put(table, ("report", "language"), _scalar(spec.language))
    if spec.axes:
        table = put(table, ("variant",), _scalar(spec.label(drawn.combination)))
    assert isinstance(table, Table), "keys are put into a table"
    return text_of(_in_order(table), spec.text, spec.whole)


def _in_order(table: Table) -> Table:
    """The kind and the variant before all else."""
    first = {"kind": 0, "variant": 1}
    entries = sorted(table.entries, key=lambda entry: first.get(entry[0].text, 2))
    return Table(tuple(entries), table.mark)


def _scalar(text: str) -> Scalar:
    return Scalar(text, _HERE)
