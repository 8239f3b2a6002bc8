"""The fonts that Typst sets in, and the letters that its own ones lack: Chinese, names in Thai, Lao, emoji.

Typst leaves out in silence what no font has, and refuses it in a file that keeps a standard.  So its fonts are asked
first, then those that came with the extra `zh`, if it is installed, then those of the system; what none has is told as
a warning.
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
from reportgen.base.standards import Standards, titled
from reportgen.base.words import word

COMMON = re.compile("[\u0000-\u024f\u0300-\u052f\u1e00-\u2bff\u3000-\u3003\ufb00-\ufb06\ufe00-\ufe0f]+")
"""Latin (Vietnamese included), Greek, Cyrillic, punctuation, arrows and the signs of mathematics: never asked for."""
FONT = "New Computer Modern"
NOWHERE = r"\u{10fffe}"
"""No character, and therefore in no font: the typesetter sets the same in its place as for a letter it lacks."""
BATCH = 400
"""So many different letters are asked for at most; a text of more is not worth a warning."""

Folders = tuple[str, ...]
MissingFromFonts = Callable[[str, bool, Folders], str]
"""Those of some letters that none of the typesetter's own fonts has, nor those in folders, or the system's if asked."""

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


@cache
def added() -> Folders:
    """The folders of fonts that came with the extra `zh`: Noto Serif SC, by a package that holds nothing else."""
    try:
        import pylopdf_fonts_zh_cn
    except ImportError:
        return ()
    return (str(Path(pylopdf_fonts_zh_cn.serif_path()).parent),)


def families(system: bool = True) -> list[str]:
    """The fonts that a source may name: the typesetter's own, those of the extra and of the system, in order."""
    import typst

    return sorted(typst.Fonts(include_system_fonts=system, font_paths=[*added()]).families())


def there_is_one_of(fonts: Sequence[str]) -> bool:
    """Whether one of some fonts is here; the system is asked only where no nearer one is among them."""
    return any(not set(families(system)).isdisjoint(fonts) for system in (False, True))


@lru_cache(maxsize=16)
def breadth(font: str) -> float:
    """By which factor, at least 1, a text in another font is broader than in the typesetter's own."""
    import typst

    answer = typst.query(BREADTH.format(font=font, own=FONT).encode(), "<breadth>", field="value", one=True)
    return max(1.0, float(json.loads(answer)))


def lacking(letters: str, system: bool, folders: Folders = ()) -> str:
    """Those of the letters that none of the typesetter's own fonts, of the folders', or the `system`'s either, has."""
    import typst

    if not letters:
        return ""
    # A source is bytes and a path is a text, though both have one type in the typesetter's annotations.
    asked: Any = question(letters).encode()
    paths = [*folders]
    answer = typst.query(asked, "<lacking>", field="value", one=True, font_paths=paths, ignore_system_fonts=not system)
    return "".join(json.loads(answer))


class MissingLettersWarning(OutputWarning):
    """Letters of a text have no place on the page, since no font has them; so its file keeps no `standards`."""

    def __init__(self, letters: str, standards: Standards = ()) -> None:
        self.letters, self.standards = letters, standards
        super().__init__(letters, standards)

    def __str__(self) -> str:
        key = "letters_and_standards" if self.standards else "letters"
        return word(key, None, letters=" ".join(self.letters), standards=titled(self.standards))


def uncommon(text: str) -> str:
    """The letters, digits and signs of a text, each once, that the typesetter's own fonts may lack."""
    left = dict.fromkeys(COMMON.sub("", text))
    return "".join(letter for letter in left if unicodedata.category(letter)[0] in "LNPS")[:BATCH]


def question(letters: str) -> str:
    """What the typesetter is asked: which of the letters, one at least, it sets as it sets what no font has."""
    listed = ", ".join(f'"\\u{{{ord(letter):x}}}"' for letter in letters)
    return QUESTION.format(font=FONT, letters=listed, nowhere=NOWHERE)


def sought(text: str, lacking: MissingFromFonts = lacking) -> tuple[Folders, bool, str]:
    """The folders of further fonts that a text needs, whether the system's, and those letters that no font has."""
    wanted = uncommon(text)
    folders = added() if wanted else ()
    left = lacking(wanted, False, folders)
    if not left:
        return folders, False, ""
    missing = lacking(left, True, folders)
    return folders, missing != left, missing
