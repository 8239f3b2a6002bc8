"""Write `docs/reference/quantity-ids.md` and its translation: the ids of quantities, from the keys of example files.

`make pictures` runs this in the project's folder, too. `reportgen/formula/ids.py` defines the families of ids.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from reportgen import api
from reportgen.base.kinds import title
from reportgen.base.template_folders import search_path
from reportgen.base.units import Language
from reportgen.base.words import load_words
from reportgen.cases import opened
from reportgen.formula import ids
from reportgen.formula.vocabulary import KeyChapter
from reportgen.marking.marking_scheme import marking_scheme
from reportgen.marking.toleranced_key import symbol_text

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "docs" / "reference"
MACHINES = ("four-bar-02", "engine-twin-05", "slider-crank-04", "shaper-04", "linkage-8")
TOPICS = ("slider-crank-friction", "lever-six-bar-02", "shaper-03", "toggle-press-02")
OTHERS: Mapping[str, tuple[str, ...]] = {
    "cam": ("cam/roller-01", "cam/rocker-flat-01", "cam/flat-01"),
    "gear-pair": ("gears/pair-equal-sliding",),
    "planetary-train": ("gears/train-double", "gears/train-motor"),
    "plane-motion": ("plane-motion/06", "plane-motion/18"),
    "rotor": ("rotor/rotor-two-planes",),
    "engine-balance": ("engine-balance/v-six",),
    "friction": tuple(
        f"friction/{task}" for task in ("incline", "wedge", "screw-jack", "belt", "band-brake", "shoe-brake")
    ),
    "turning-moment": tuple(f"turning-moment/{name}" for name in ("curve", "areas", "two-curves", "by-speed")),
    "structure": ("structure/geared-bars",),
    "synthesis": tuple(
        f"synthesis/{name}" for name in ("best-crank-rocker", "crank-rocker-by-frame", "slider-crank-by-offset")
    ),
}
"""Example files by section of the page; each adds the ids that those before it do not have."""

FAMILIES = {name: family for name, family in vars(ids).items() if isinstance(family, ids.Name)}
TEXTS: Mapping[Language, Mapping[str, str]] = {
    "en": {
        "file": "quantity-ids.md",
        "top": """# Ids of quantities

Answer sheets, keys, policies, corrections and curves name a quantity by its id. An id is the same in all languages. In
this page, the links, points and positions are those of an example: `v.B` is the velocity of B, so `v.C` is that of C.
`reportgen key FILE --format csv` lists all ids of one assignment.
""",
        "machines": "Machines",
        "topics": "Friction, springs and other topics of machines",
        "head": "| id | symbol | quantity | unit | section |",
    },
    "vi": {
        "file": "quantity-ids.vi.md",
        "top": """# Mã của các đại lượng

Bảng trả lời, đáp án, quy định chấm, bảng sửa điểm và đồ thị đều gọi mỗi đại lượng bằng mã của nó. Mã giống nhau trong
mọi ngôn ngữ. Trên trang này, các khâu, các điểm và các vị trí lấy từ một ví dụ: `v.B` là vận tốc điểm B, vậy `v.C` là
vận tốc điểm C. Lệnh `reportgen key TỆP --format csv` liệt kê mọi mã của một đề bài.
""",
        "machines": "Các loại máy",
        "topics": "Ma sát, lò xo và các chủ đề khác của máy",
        "head": "| mã | ký hiệu | đại lượng | đơn vị | phần |",
    },
}
"""Words of the page by language, and its file."""


def page(language: Language) -> str:
    """Return the page of all ids in a language."""
    texts, met = TEXTS[language], set[str]()
    groups = {texts["machines"]: MACHINES, texts["topics"]: TOPICS}
    groups |= {title(kind, language): files for kind, files in OTHERS.items()}
    tables = (f"## {head}\n\n{table(files, language, met)}" for head, files in groups.items())
    return "\n".join((texts["top"], *tables))


def table(files: tuple[str, ...], language: Language, met: set[str]) -> str:
    """Return the table of the ids of some files whose families are not yet `met`, by chapters, and add these."""
    lines = sorted((line for file in files for line in lines_of(file, language, met)), key=lambda line: line[0])
    return f"{TEXTS[language]['head']}\n| --- | --- | --- | --- | --- |\n" + "".join(line for _, line in lines)


def lines_of(file: str, language: Language, met: set[str]) -> Iterator[tuple[int, str]]:
    """Yield the lines of the ids of one file, each with the place of its chapter."""
    chapters = list(KeyChapter)
    assignment = api.load(ROOT / "assignments" / f"{file}.yaml", language)
    key, parts = marking_scheme(opened(assignment)).key, load_words(search_path(language, assignment.kind))["parts"]
    for row in key.rows:
        if (family := family_of(row.id)) not in met:
            met.add(family)
            cells = (f"`{row.id}`", symbol_text(row, key), row.what, row.unit, parts[row.part])
            text = " | ".join(str(cell).replace("|", "\\|") for cell in cells)
            yield chapters.index(row.part), f"| {text} |\n"


def family_of(id: str) -> str:
    """Return the name of the family of an id, or the id without its numbers if it belongs to no family."""
    found = (name for name, family in FAMILIES.items() if id in family)
    return next(found, re.sub(r"(?<![A-Za-z\d])\d+", "#", id))


def pages() -> dict[Path, str]:
    """Return the text of each file that this script writes."""
    return {FOLDER / texts["file"]: page(language) for language, texts in TEXTS.items()}


if __name__ == "__main__":
    for file, text in pages().items():
        file.write_text(text, encoding="utf-8")
