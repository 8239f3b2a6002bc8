"""Write `docs/reference/error-codes.md` and its translation: the codes of faults with their texts and hints.

`make pictures` runs this in the project's folder, too. The texts are those of `templates/<language>/messages.yaml` and
of the topics, so the page has every code that the program can print.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from reportgen.base.units import Language
from reportgen.base.words import messages

FOLDER = Path(__file__).resolve().parent / "reference"
OTHERWISE = "-otherwise"
"""Ending of the second hint of a code, for the case that the first one has nothing to name."""
TEXTS: Mapping[Language, Mapping[str, str]] = {
    "en": {
        "file": "error-codes.md",
        "top": """# Error codes

An error is printed as `FILE:LINE:COLUMN: error[code]: message`; a warning has `warning[code]`, a note `note[code]`. The
place is where the faulty text begins; in a workbook it is the cell. This page has each code with its message. In
place of “…”, the program shows texts, names and numbers from your file. [The assignment file](assignment.md) explains
how to write one.
""",
        "do": "What to do",
        "or": "Or",
    },
    "vi": {
        "file": "error-codes.vi.md",
        "top": """# Mã lỗi

Mỗi lỗi được in ra theo dạng `TỆP:DÒNG:CỘT: error[mã]: nội dung`; cảnh báo là `warning[mã]`, lưu ý là `note[mã]`.
Vị trí được báo là chỗ bắt đầu của phần sai; trong bảng tính, đó là ô. Trang này liệt kê từng mã cùng nội dung của nó;
dấu “…” thay cho chữ, tên và số trong tệp của bạn.
""",
        "do": "Cách sửa",
        "or": "Hoặc",
    },
}
"""Words of the page by language, and its file."""


def page(language: Language) -> str:
    """Return the page of all codes in a language, in alphabetical order."""
    texts, table = TEXTS[language], messages(language)
    faults: Mapping[str, str] = table["faults"]
    hints: Mapping[str, str] = table["hints"]
    sections = []
    for code in sorted(faults):
        lines = [f"## `{code}`", "", as_text(faults[code])]
        given = [as_text(hints[key]) for key in (code, code + OTHERWISE) if key in hints]
        for label, hint in zip((texts["do"], texts["or"]), given, strict=False):
            lines += ["", f"{label}: {hint}"]
        sections.append("\n".join((*lines, "")))
    return "\n".join((texts["top"], *sections))


def as_text(message: str) -> str:
    """Return a message as a sentence of Markdown, with “…” for its placeholders and a full stop at its end."""
    plain = re.sub(r"(?<!\{)\{\w+\}(?!\})", "…", message).replace("{{", "{").replace("}}", "}")
    escaped = re.sub(r"[*_<\[\]|]", r"\\\g<0>", plain).strip().removesuffix(".")
    return escaped[:1].upper() + escaped[1:] + "." * (escaped[-1] not in "?…")


def pages() -> dict[Path, str]:
    """Return the text of each file that this script writes."""
    return {FOLDER / texts["file"]: page(language) for language, texts in TEXTS.items()}


if __name__ == "__main__":
    for file, text in pages().items():
        file.write_text(text, encoding="utf-8")
