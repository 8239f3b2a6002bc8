"""Typst source → PDF, by typst inside this process.

Where figures stand depends on where those before them stand, and the typesetter looks at a document five times at
most.  If it has come to no end by then, it goes on with the choices that it has made so far: it reads them from a file
beside the source, so that it lays out anew only what they have changed.
"""

from __future__ import annotations

import json
import re
import tempfile
import unicodedata
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any

from reportgen.base.errors import TypesetterError

UNSETTLED = "#let settled = (:)"
"""The line of a source that has room for choices."""
READ = '#let settled = json("settled.json")'
"""The same line where they stand in a file, by their names."""
ROUNDS = 40
"""How often the typesetter is asked at most; two or three times are usual, and each makes one choice right at least."""


def compile(source: str, system: bool = False) -> bytes:
    """The PDF of a Typst source, byte for byte the same from run to run; it may name fonts of the `system`.

    Raises `TypesetterError` with the message's first lines.
    """
    with tempfile.TemporaryDirectory(prefix="typst-") as folder:
        return _Run(source, Path(folder), system).compile()[0]


def settle(unsettled: str, system: bool = False) -> tuple[str, bytes]:
    """A source with the choices that it needed, and its PDF; it may name fonts of the `system`.

    Raises `TypesetterError`.
    """
    right: dict[str, Any] = {}
    choices: dict[str, Any] = {}
    with tempfile.TemporaryDirectory(prefix="typst-") as folder:
        run = _Run(unsettled.replace(UNSETTLED, READ, 1), Path(folder), system)
        for _ in range(ROUNDS):
            shown = run.choices(choices)
            pdf, settles = run.compile()
            source = _settled(unsettled, choices)
            if settles:
                if all(choice == seen or name in right for name, choice, seen in shown):
                    break
                right = _right(shown, right)
            choices = {name: seen for name, _, seen in shown} | right
    return source, pdf


def _settled(source: str, choices: Mapping[str, Any]) -> str:
    """A source with choices of its figures and plates written in."""
    entries = "".join(f"{_literal(name)}: {_literal(choice)}," for name, choice in choices.items())
    return source.replace(UNSETTLED, f"#let settled = ({entries or ':'})", 1)


def _literal(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False)


def _right(shown: Iterable[Sequence[Any]], known: Mapping[str, Any]) -> dict[str, Any]:
    """The choices up to the first that the pages it has led to do not show; of that one, what they show.

    A choice stands on those before it only.
    """
    right = dict(known)
    for name, choice, seen in shown:
        if name in known:
            continue
        right[name] = seen
        if choice != seen:
            break
    return right


class _Run:
    """A source in the typesetter's hands: what it has worked out for one question serves the next."""

    def __init__(self, source: str, folder: Path, system: bool = False) -> None:
        try:
            import typst
        except ModuleNotFoundError as error:
            raise TypesetterError("typst is not installed: pip install typst") from error
        except ImportError as error:
            raise TypesetterError(f"typst cannot be loaded, most likely for too little memory: {error}") from error
        self._folder, self._error = folder, typst.TypstError
        (folder / "report.typ").write_text(source, encoding="utf-8", newline="")
        own = not needs_system_fonts(source, lacking) and not system
        self._typesetter = typst.Compiler(folder / "report.typ", root=folder, ignore_system_fonts=own)

    def choices(self, known: Mapping[str, Any]) -> list[list[Any]]:
        """Of each figure and plate that may wait, in order: its name, what is chosen, what the pages then show.

        What is `known` is chosen so; to ask makes the typesetter read it.  Raises `TypesetterError`.
        """
        (self._folder / "settled.json").write_text(_literal(known), encoding="utf-8")
        with self._told():
            answer = self._typesetter.query("<settled>", field="value")
        found: list[list[Any]] = json.loads(answer)
        return found

    def compile(self) -> tuple[bytes, bool]:
        """The PDF, and whether all places in it are final; raises `TypesetterError`."""
        with self._told():
            pdf, warnings = self._typesetter.compile_with_warnings()
        assert isinstance(pdf, bytes)
        return pdf, not any("did not converge" in warning.message for warning in warnings)

    @contextmanager
    def _told(self) -> Iterator[None]:
        """What the typesetter complains of as a `TypesetterError` with the message's first lines."""
        try:
            yield
        except self._error as error:
            lines = str(getattr(error, "message", error)).splitlines()
            raise TypesetterError("typst: " + "\n".join(lines[:4])) from error


def families() -> list[str]:
    """The fonts that a source may name: the typesetter's own and those of the system, in order."""
    import typst

    return sorted(typst.Fonts(include_system_fonts=True).families())


@lru_cache(maxsize=16)
def breadth(font: str) -> float:
    """How many times as broad as in the typesetter's own font a text is in another, at least 1."""
    import typst

    answer = typst.query(BREADTH.format(font=font, own=FONT).encode(), "<breadth>", field="value", one=True)
    return max(1.0, float(json.loads(answer)))


def lacking(letters: str, system: bool) -> str:
    """Those of the letters that none of the typesetter's own fonts, or the `system`'s either, has."""
    import typst

    if not letters:
        return ""
    asked = question(letters).encode()
    answer = typst.query(asked, "<lacking>", field="value", one=True, ignore_system_fonts=not system)
    return "".join(json.loads(answer))


# --- letters that Typst's own fonts do not have ---------------------------------------------------
# Names in Chinese, Thai, Lao and other scripts, emoji.
# Typst leaves out in silence what no font has. So its fonts are asked first, then those of the system; what neither
# has is told as a warning.

COMMON = re.compile("[\u0000-\u024f\u0300-\u052f\u1e00-\u2bff\u3000-\u3003\ufb00-\ufb06\ufe00-\ufe0f]+")
"""Latin (Vietnamese included), Greek, Cyrillic, punctuation, arrows and the signs of mathematics: never asked for."""
FONT = "New Computer Modern"
NOWHERE = r"\u{10fffe}"
"""No character, and therefore in no font: the typesetter sets the same in its place as for a letter it lacks."""
BATCH = 400
"""So many different letters are asked for at most; a text of more is not worth a warning."""

Lacking = Callable[[str, bool], str]
"""Those of some letters that none of the typesetter's own fonts has, or, if asked, the system's either."""

QUESTION = """\
#set text(font: "{font}", size: 10pt, top-edge: "bounds", bottom-edge: "bounds")
#context [
  #let size(letter) = {{ let box = measure(letter); (box.width, box.height) }}
  #metadata(({letters},).filter(letter => size(letter) == size("{nowhere}"))) <lacking>
]
"""


BREADTH = """\
#let breadth(font, weight) = measure(text(font: font, weight: weight, size: 10pt)[
  Hamburgefonstiv vận tốc góc của khâu 0123456789,0123456789]).width
#context [#metadata(calc.max(..("regular", "bold").map(weight =>
  breadth("{font}", weight) / breadth("{own}", weight)))) <breadth>]
"""
"""What the typesetter is asked about the letters of a font; words and numbers, as tables have them."""


class MissingLettersWarning(UserWarning):
    """Letters of a text have no place on the page, since no font has them."""

    def __init__(self, letters: str) -> None:
        self.letters = letters
        super().__init__(f"no font has {' '.join(letters)}: left out on the page")


def uncommon(text: str) -> str:
    """The letters, digits and signs of a text, each once, that the typesetter's own fonts may lack."""
    left = dict.fromkeys(COMMON.sub("", text))
    return "".join(letter for letter in left if unicodedata.category(letter)[0] in "LNPS")[:BATCH]


def question(letters: str) -> str:
    """What the typesetter is asked: which of the letters, one at least, it sets as it sets what no font has."""
    listed = ", ".join(f'"\\u{{{ord(letter):x}}}"' for letter in letters)
    return QUESTION.format(font=FONT, letters=listed, nowhere=NOWHERE)


def needs_system_fonts(text: str, lacking: Lacking) -> bool:
    """Whether a text has letters that only the system's fonts may have; warns of those that no font has."""
    wanted = lacking(uncommon(text), False)
    if not wanted:
        return False
    if missing := lacking(wanted, True):
        warnings.warn(MissingLettersWarning(missing), stacklevel=2)
    return missing != wanted
