"""Write `docs/reference/keys.md` and its translations: the keys of each kind, from the words that the form shows.

`make pictures` runs this in the project's folder, too. `docs/reference/machines.md` shows the kinds and explains them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from reportgen import catalogue
from reportgen.assignment.schema import Schema, alternatives_to, choices_of, file_schema, places
from reportgen.base.errors import Where
from reportgen.base.field_words import PARAMETERS, field_words, shared_keys
from reportgen.base.kinds import title
from reportgen.base.units import Language

FOLDER = Path(__file__).resolve().parent / "reference"
KINDS = (
    *("engine-twin", "engine-single", "engine-v", "slider-crank", "four-bar", "lever-six-bar", "toggle-press"),
    *("scotch-yoke", "slotted-lever", "shaper", "linkage", "cam", "gear-pair", "planetary-train", "plane-motion"),
    *("rotor", "engine-balance", "friction", "turning-moment", "structure", "synthesis"),
)
LAST_MACHINE = "linkage"
"""Last of the kinds that are machines; the others are mechanisms and exercises."""

FIND = "`find`"
TEXTS: Mapping[Language, Mapping[str, str]] = {
    "en": {
        "file": "keys.md",
        "top": """# Keys of each kind

The keys under `parameters` of an assignment file, in the order of the form. A quantity is written with its unit. Keys
with a point are within the key before the point: `force.F` is `force: {F: 800 N}`. [The machines](machines.md) shows
and explains the kinds; [The assignment file](assignment.md) lists the keys outside `parameters`. The machines are the
kinds from `engine-twin` to `linkage`.
""",
        "shared": "Keys of several kinds",
        "head": "| key of `parameters` | meaning |",
        "of": "| key of `parameters` | meaning | kinds |",
        "machines": "every machine",
        "but": " but",
        "or": "; or ",
        "keys": " or ",
        "default": "; default",
    },
    "vi": {
        "file": "keys.vi.md",
        "top": """# Các khóa của từng loại cơ cấu

Các khóa nằm dưới `parameters` của tệp đề bài, theo thứ tự của biểu mẫu. Mỗi đại lượng viết kèm đơn vị. Khóa có dấu
chấm nằm bên trong khóa đứng trước dấu chấm: `force.F` nghĩa là `force: {F: 800 N}`. Trang [các loại cơ
cấu](machines.vi.md) có hình và giải thích từng loại; trang [tệp đề bài](assignment.vi.md) liệt kê các khóa nằm ngoài
`parameters`.
“Mọi máy” là các loại từ `engine-twin` đến `linkage`.
""",
        "shared": "Các khóa chung của nhiều loại",
        "head": "| khóa của `parameters` | ý nghĩa |",
        "of": "| khóa của `parameters` | ý nghĩa | loại |",
        "machines": "mọi máy",
        "but": ", trừ",
        "or": "; hoặc ",
        "keys": " hoặc ",
        "default": "; mặc định",
    },
}
"""Words of the page by language, and its file."""


def page(language: Language) -> str:
    """Return the page of all keys in a language."""
    texts = TEXTS[language]
    sections = (f"## `{name}`\n\n{title(name, language)}.\n\n{table(name, language)}" for name in KINDS)
    return "\n".join((texts["top"], f"## {texts['shared']}\n\n{shared(language)}", *sections))


def shared(language: Language) -> str:
    """Return the table of the keys that have one meaning in every kind, with the kinds that have them."""
    texts, lines = TEXTS[language], list[str]()
    owners = {name: [kind for kind in KINDS if name in _names(kind)] for name in sorted(shared_keys(language))}
    order = dict.fromkeys(name for kind in KINDS for name in _names(kind) if owners.get(name))
    for name in order:
        words = field_words(owners[name][0], language)
        if (path := f"{PARAMETERS}.{name}") in words:
            kinds = _listed(owners[name], language)
            lines.append(f"| `{name}` | {words[path].whole} | {kinds} |\n".replace("\\|", "|"))
    return f"{texts['of']}\n| --- | --- | --- |\n" + "".join(lines)


def _listed(kinds: list[str], language: Language) -> str:
    """Return a list of kinds, with all machines by one word."""
    texts = TEXTS[language]
    machines = KINDS[: KINDS.index(LAST_MACHINE) + 1]
    lacking = [kind for kind in machines if kind not in kinds]
    if len(lacking) > 1:
        return ", ".join(f"`{kind}`" for kind in kinds)
    all_but = texts["machines"] + "".join(f"{texts['but']} `{kind}`" for kind in lacking)
    return ", ".join((all_but, *(f"`{kind}`" for kind in kinds if kind not in machines)))


def _names(kind: str) -> list[str]:
    return [field.alias or name for name, field in catalogue.kind(kind).parameters.model_fields.items()]


def table(name: str, language: Language) -> str:
    """Return the table of the keys of a kind: one per line, or two that give the same quantity."""
    head = f"{TEXTS[language]['head']}\n| --- | --- |\n"
    return head + "".join(f"| {keys} | {text} |\n" for keys, text in rows(name, language))


def rows(name: str, language: Language) -> Iterator[tuple[str, str]]:
    """Yield the keys of each line and their meaning, with choices and default."""
    kind, texts = catalogue.kind(name), TEXTS[language]
    schema, words, met = file_schema(kind), field_words(name, language), set[str]()
    for path in words:
        head, _, key = path.partition(".")
        if head != PARAMETERS or not key or key.partition(".")[0] in shared_keys(language) or path in met:
            continue
        steps = tuple(path.split("."))
        alike = [".".join((*steps[:-1], key)) for key in alternatives_to(kind, steps)]
        others = [other for other in alike if other in words and other not in met]
        met |= set(others)
        where = place(schema, steps)
        allowed = places(schema, schema, where)
        choices = list(dict.fromkeys(f"`{choice}`" for about in allowed for choice in choices_of(about)))
        default = next(iter(defaults(schema, where)), "")
        text = texts["or"].join(words[each].whole for each in (path, *others))
        # `find` stands beside what may be typed, which the words say where it is not plain.
        if choices == [FIND]:
            text += "" if "find" in text else f"{texts['or']}{FIND}"
        elif choices:
            text += f": {', '.join(choices)}"
        text += f"{texts['default']} `{default}`" if default else ""
        keys = texts["keys"].join(f"`{each.partition('.')[2]}`" for each in (path, *others))
        yield keys, text.replace("|", "\\|")


def place(schema: Schema, steps: tuple[str, ...]) -> Where:
    """Return the place of a key in a file: the first item of a list, any name of a table of names."""
    where: Where = ()
    for step in steps[:-1]:
        where = (*where, step)
        alternatives = places(schema, schema, where)
        if any(isinstance(each.get("items"), dict) for each in alternatives):
            where = (*where, 0)
        elif not any("properties" in each for each in alternatives):
            where = (*where, "name")
    return (*where, steps[-1])


def defaults(schema: Schema, where: Where) -> Iterator[str]:
    """Yield the value of an omitted key, as a file would have it."""
    for above in places(schema, schema, where[:-1]):
        default = above.get("properties", {}).get(where[-1], {}).get("default")
        if isinstance(default, str | int | float) and not isinstance(default, bool):
            yield str(default)


def pages() -> dict[Path, str]:
    """Return the text of each file that this script writes."""
    return {FOLDER / texts["file"]: page(language) for language, texts in TEXTS.items()}


if __name__ == "__main__":
    for file, text in pages().items():
        file.write_text(text, encoding="utf-8")
