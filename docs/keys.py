"""Write the tables of keys in `docs/reference/machines.md` from the words that the form and `new` show.

`make pictures` runs this in the project's folder, too.  Keys that several kinds share, and what stands in them, have
tables of their own there.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from reportgen import catalogue
from reportgen.assignment.schema import Schema, alternatives_to, choices_of, file_schema, places
from reportgen.base.errors import Where
from reportgen.base.field_words import PARAMETERS, field_words, shared_keys

PAGE = Path(__file__).resolve().parent / "reference" / "machines.md"
KINDS = (
    *("engine-twin", "engine-single", "engine-v", "slider-crank", "four-bar", "lever-six-bar", "toggle-press"),
    *("scotch-yoke", "slotted-lever", "shaper", "linkage", "cam", "gear-pair", "planetary-train", "plane-motion"),
    *("rotor", "engine-balance", "friction"),
)
FIND = "`find`"
HEAD = "| key of `parameters` | is |\n| --- | --- |\n"


def table(name: str) -> str:
    """The table of the keys of a kind, one a line, or two that say the same."""
    return HEAD + "".join(f"| {keys} | {text} |\n" for keys, text in rows(name))


def rows(name: str) -> Iterator[tuple[str, str]]:
    kind = catalogue.kind(name)
    schema, words, met = file_schema(kind), field_words(name, "en"), set[str]()
    for path in words:
        head, _, key = path.partition(".")
        if head != PARAMETERS or not key or key.partition(".")[0] in shared_keys("en") or path in met:
            continue
        steps = tuple(path.split("."))
        alike = [".".join((*steps[:-1], key)) for key in alternatives_to(kind, steps)]
        others = [other for other in alike if other in words and other not in met]
        met |= set(others)
        where = place(schema, steps)
        allowed = places(schema, schema, where)
        choices = list(dict.fromkeys(f"`{choice}`" for about in allowed for choice in choices_of(about)))
        default = next(iter(defaults(schema, where)), "")
        text = "; or ".join(words[each].whole for each in (path, *others))
        # `find` stands beside what may be typed, which the words say where it is not plain.
        if choices == [FIND]:
            text += "" if "find" in text else f"; or {FIND}"
        elif choices:
            text += f": {', '.join(choices)}"
        text += f"; default `{default}`" if default else ""
        keys = " or ".join(f"`{each.partition('.')[2]}`" for each in (path, *others))
        yield keys, text.replace("|", "\\|")


def place(schema: Schema, steps: tuple[str, ...]) -> Where:
    """The place of a key in a file: of a list the first item, of a table of names one of them."""
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
    """What a key is where it is left out, as a file would have it."""
    for above in places(schema, schema, where[:-1]):
        default = above.get("properties", {}).get(where[-1], {}).get("default")
        if isinstance(default, str | int | float) and not isinstance(default, bool):
            yield str(default)


def written(text: str) -> str:
    """The page with the tables in place of those that it has."""
    for name in KINDS:
        section = re.search(rf"(?ms)^## `{name}`\n.*?(?=^## |\Z)", text)
        assert section, name
        old = re.search(r"(?m)^\| key of `parameters` \| is \|\n(\|.*\n)+", section[0])
        assert old, name
        text = text[: section.start()] + section[0].replace(old[0], table(name)) + text[section.end() :]
    return text


if __name__ == "__main__":
    PAGE.write_text(written(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
