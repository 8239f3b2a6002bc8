"""Write `docs/reference/atlas-machines.md` and its translation: the machines of the atlas, from their files.

`make pictures` runs this in the project's folder, too, and draws the schemes.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from reportgen.base.atlas_words import machine_parameters, machine_source, machine_words
from reportgen.base.template_folders import atlas_files
from reportgen.base.units import Language
from reportgen.base.yaml_source import Scalar
from reportgen.base.yaml_values import at

FOLDER = Path(__file__).resolve().parent / "reference"
TEXTS: Mapping[Language, Mapping[str, str]] = {
    "en": {
        "file": "atlas-machines.md",
        "top": """# The machines of the atlas

Machines that many courses use, each with names for its links and parameters. `reportgen new atlas/NAME` begins a
file. It has only the parameters; omitted ones have their defaults. The program also has [kinds with more
options](machines.md), and [you can write a machine of your own](../how-to/write-a-machine-for-your-class.md).
""",
        "table": "| kind | scheme | machine |",
        "scheme": "Scheme: {title}",
        "head": "| parameter | meaning | default | bounds |",
        "links": "Links",
    },
    "vi": {
        "file": "atlas-machines.vi.md",
        "top": """# Các máy mẫu

Những máy hay gặp trong bài tập lớn; khâu và tham số có tên riêng của từng máy. `reportgen new atlas/TÊN` tạo đề bài.
Tệp đề bài chỉ có các tham số; tham số không ghi thì lấy giá trị mặc định. Ngoài ra còn [các loại có nhiều tùy
chọn](machines.vi.md), và [bạn có thể soạn máy riêng](../how-to/write-a-machine-for-your-class.vi.md).
""",
        "table": "| loại | lược đồ | máy |",
        "scheme": "Lược đồ: {title}",
        "head": "| tham số | ý nghĩa | mặc định | giới hạn |",
        "links": "Các khâu",
    },
}
"""Words of the page by language, and its file."""


def page(language: Language) -> str:
    """Return the page of all machines in a language."""
    texts = TEXTS[language]
    rows = "".join(row(kind, file, language) for kind, file in sorted(atlas_files().items()))
    sections = (section(kind, file, language) for kind, file in sorted(atlas_files().items()))
    return "\n".join((texts["top"], f"{texts['table']}\n| --- | --- | --- |\n{rows}", *sections))


def row(kind: str, file: Path, language: Language) -> str:
    """Return the row of a machine with its scheme."""
    words, name = machine_words(file, language), file.stem
    picture = f"![{TEXTS[language]['scheme'].format(title=words['title'])}](../pictures/{kind.replace('/', '-')}.png)"
    return f"| [`{kind}`](#atlas{name}) | {picture} | {words['title']}: {words['uses']} |\n"


def section(kind: str, file: Path, language: Language) -> str:
    """Return the description of a machine, its links and its parameters."""
    words, texts = machine_words(file, language), TEXTS[language]
    links = "; ".join(f"{number} {name}" for number, name in words.get("links", {}).items())
    return (
        f"## `{kind}`\n\n{words['title']}. {words['description']}\n\n{texts['links']}: {links}.\n\n"
        f"{texts['head']}\n| --- | --- | --- | --- |\n"
        + "".join(
            f"| `{key}` | {words['parameters'][key]} | {_default(file, key)} | {about.range} |\n"
            for key, about in machine_parameters(file).items()
        )
    )


def _default(file: Path, key: str) -> str:
    node = at(machine_source(file).top, ("parameters", key, "default"))
    assert isinstance(node, Scalar), "a parameter has a default"
    return node.text


def pages() -> dict[Path, str]:
    """Return the text of each file that this script writes."""
    return {FOLDER / texts["file"]: page(language) for language, texts in TEXTS.items()}


if __name__ == "__main__":
    for file, text in pages().items():
        file.write_text(text, encoding="utf-8")
