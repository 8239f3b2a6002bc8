"""Typst source → PDF, by typst inside this process.

Where figures stand depends on where those before them stand.  Should the typesetter come to no end with that, the
choices that it has found right are written into the source, and it goes on behind them.
"""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path

from reportgen.errors import TypesetterError
from reportgen.writers.scripts import needs_system_fonts, question

UNSETTLED = "#let settled = (:)"
"""The line of a source that choices are written into."""
ROUNDS = 8
"""How often the typesetter is helped on at most."""
MEMORY = 11
"""What the typesetter has worked out it keeps for ten further runs."""


def compile(source: str) -> bytes:
    """The PDF of a Typst source, byte for byte the same from run to run.

    Raises `TypesetterError` with the message's first lines.
    """
    with tempfile.TemporaryDirectory(prefix="typst-") as folder:
        return _Run(source, Path(folder)).compile()[0]


def settle(unsettled: str) -> tuple[str, bytes]:
    """A source with the choices that it needed, and its PDF.  Raises `TypesetterError`."""
    known: dict[str, str] = {}
    with tempfile.TemporaryDirectory(prefix="typst-") as folder:
        run = _Run(unsettled, Path(folder))
        pdf, settles = run.compile()
        for _ in range(ROUNDS):
            if settles:
                break
            found = {name: choice for name, choice, _ in run.choices()}
            _forget(Path(folder))
            trial = _Run(_settled(unsettled, {**found, **known}), Path(folder))
            shown = trial.choices()
            known = _right(shown, known)
            settled = all(choice == seen for _, choice, seen in shown)
            if not settled:
                _forget(Path(folder))
            run = trial if settled else _Run(_settled(unsettled, known), Path(folder))
            pdf, settles = run.compile()
    return run.source, pdf


def _settled(source: str, choices: Mapping[str, str]) -> str:
    """A source with choices of its figures and plates written in."""
    entries = "".join(f"{json.dumps(name, ensure_ascii=False)}: {choice}," for name, choice in choices.items())
    return source.replace(UNSETTLED, f"#let settled = ({entries or ':'})", 1)


def _right(choices: Iterable[tuple[str, str, str]], known: Mapping[str, str]) -> dict[str, str]:
    """The choices up to the first that the pages it has led to do not show; of that one, what they show.

    A choice stands on those before it only.
    """
    right = dict(known)
    for name, choice, seen in choices:
        if name in known:
            continue
        right[name] = seen
        if choice != seen:
            break
    return right


def _forget(folder: Path) -> None:
    """Make the typesetter drop what it keeps of documents before: hundreds of MB each, of little use to the next."""
    for _ in range(MEMORY):
        _Run(".", folder).compile()


class _Run:
    """A source in the typesetter's hands: what it has worked out for one question serves the next."""

    def __init__(self, source: str, folder: Path) -> None:
        try:
            import typst
        except ImportError as error:
            raise TypesetterError("typst is not installed: pip install typst") from error
        self.source, self._error = source, typst.TypstError
        handle, name = tempfile.mkstemp(suffix=".typ", dir=folder)
        with os.fdopen(handle, "w", encoding="utf-8", newline="") as stream:
            stream.write(source)
        own = not needs_system_fonts(source, lacking)
        self._typesetter = typst.Compiler(name, root=str(folder), ignore_system_fonts=own)

    def compile(self) -> tuple[bytes, bool]:
        """The PDF, and whether all places in it are final; raises `TypesetterError`."""
        try:
            pdf, warnings = self._typesetter.compile_with_warnings()
        except self._error as error:
            lines = str(getattr(error, "message", error)).splitlines()
            raise TypesetterError("typst: " + "\n".join(lines[:4])) from error
        assert isinstance(pdf, bytes)
        return pdf, not any("did not converge" in warning.message for warning in warnings)

    def choices(self) -> list[tuple[str, str, str]]:
        """Of each figure and plate that may wait, in order: its name, what was chosen, what the pages show."""
        found = json.loads(self._typesetter.query("<settled>", field="value"))
        return [(name, json.dumps(choice), json.dumps(seen)) for name, choice, seen in found]


def lacking(letters: str, system: bool) -> str:
    """Those of the letters that none of the typesetter's own fonts, or the `system`'s either, has."""
    import typst

    if not letters:
        return ""
    asked = question(letters).encode()
    answer = typst.query(asked, "<lacking>", field="value", one=True, ignore_system_fonts=not system)
    return "".join(json.loads(answer))
