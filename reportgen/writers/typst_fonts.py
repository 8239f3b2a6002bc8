"""Find fonts for Typst, and letters that its own fonts lack: Chinese, names in Thai or Lao, emoji.

Typst silently omits letters that no font has, and rejects them in a file that conforms to a standard. So its own fonts
are checked first, then those of the extra `zh` if it is installed, then those of the system. Letters that no font has
are reported as a warning.
"""

from __future__ import annotations

import json
import re
import unicodedata
from collections.abc import Callable, Sequence
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from reportgen.base.errors import OutputWarning
from reportgen.base.pdf_standards import Standards, titled
from reportgen.base.words import word

COMMON = re.compile("[\u0000-\u024f\u0300-\u052f\u1e00-\u2bff\u3000-\u3003\ufb00-\ufb06\ufe00-\ufe0f]+")
"""Latin (with Vietnamese), Greek, Cyrillic, punctuation, arrows and mathematical signs, never checked."""
FONT = "New Computer Modern"
NOWHERE = r"\u{10fffe}"
"""A code point without a character: the typesetter renders it like any letter that its fonts lack."""
BATCH = 400
"""Largest number of different letters that are checked."""

Folders = tuple[str, ...]
MissingFromFonts = Callable[[str, bool, Folders], str]
"""Returns the letters that neither the typesetter's own fonts, nor folders, nor (if asked) the system have."""

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
"""Typst query for the relative width of a font, with words and numbers as in tables."""


@cache
def added() -> Folders:
    """Return the font folders of the extra `zh`: Noto Serif SC, from a package that contains nothing else."""
    try:
        import pylopdf_fonts_zh_cn
    except ImportError:
        return ()
    return (str(Path(pylopdf_fonts_zh_cn.serif_path()).parent),)


def families(system: bool = True) -> list[str]:
    """Return the fonts that a source may name: the typesetter's own, those of the extra and of the system, sorted."""
    import typst

    return sorted(typst.Fonts(include_system_fonts=system, font_paths=[*added()]).families())


def there_is_one_of(fonts: Sequence[str]) -> bool:
    """Return True if one of some fonts is available; the system's fonts are searched last."""
    return any(not set(families(system)).isdisjoint(fonts) for system in (False, True))


@lru_cache(maxsize=16)
def breadth(font: str) -> float:
    """Return the factor, at least 1, by which a text in another font is wider than in the typesetter's own."""
    import typst

    answer = typst.query(BREADTH.format(font=font, own=FONT).encode(), "<breadth>", field="value", one=True)
    return max(1.0, float(json.loads(answer)))


def lacking(letters: str, system: bool, folders: Folders = ()) -> str:
    """Return the letters that the typesetter's own fonts, those of the folders and (if asked) the `system`'s lack."""
    import typst

    if not letters:
        return ""
    # A source is bytes and a path is a string, although both have one type in the typesetter's annotations.
    asked: Any = question(letters).encode()
    paths = [*folders]
    answer = typst.query(asked, "<lacking>", field="value", one=True, font_paths=paths, ignore_system_fonts=not system)
    return "".join(json.loads(answer))


class MissingLettersWarning(OutputWarning):
    """Warning that letters are missing on the page, since no font has them; the file keeps no `standards`."""

    def __init__(self, letters: str, standards: Standards = ()) -> None:
        self.letters, self.standards = letters, standards
        super().__init__(letters, standards)

    def __str__(self) -> str:
        key = "letters_and_standards" if self.standards else "letters"
        return word(key, None, letters=" ".join(self.letters), standards=titled(self.standards))


def uncommon(text: str) -> str:
    """Return the letters, digits and signs of a text, each once, that the typesetter's own fonts may lack."""
    left = dict.fromkeys(COMMON.sub("", text))
    return "".join(letter for letter in left if unicodedata.category(letter)[0] in "LNPS")[:BATCH]


def question(letters: str) -> str:
    """Return the query for the letters (at least one) that the typesetter renders like a letter that no font has."""
    listed = ", ".join(f'"\\u{{{ord(letter):x}}}"' for letter in letters)
    return QUESTION.format(font=FONT, letters=listed, nowhere=NOWHERE)


def sought(text: str, lacking: MissingFromFonts = lacking) -> tuple[Folders, bool, str]:
    """Return further font folders for a text, True if it needs system fonts, and letters that no font has."""
    wanted = uncommon(text)
    folders = added() if wanted else ()
    left = lacking(wanted, False, folders)
    if not left:
        return folders, False, ""
    missing = lacking(left, True, folders)
    return folders, missing != left, missing
