"""Write the tables of keys in `docs/machines.md` of the words of the kinds, as the form and the remarks of `new` are.

`make pictures` runs this in the project's folder, too.  Keys that several kinds share have a table of their own there,
and kinds whose keys need more than a line each are told by hand.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from reportgen import catalogue
from reportgen.assignment.schema import alternatives_to, choices_of, file_schema, places
from reportgen.base.field_words import PARAMETERS, field_words, shared_keys

PAGE = Path(__file__).resolve().parent / "machines.md"
KINDS = (
    *("engine-twin", "engine-single", "engine-v", "slider-crank", "four-bar", "lever-six-bar", "toggle-press"),
    *("scotch-yoke", "slotted-lever", "shaper"),
)
"""The kinds whose table is written."""
HEAD = "| key of `parameters` | is |\n| --- | --- |\n"


def table(name: str) -> str:
    """The table of the keys of a kind, one a line, or two that say the same."""
    return HEAD + "".join(f"| {keys} | {text} |\n" for keys, text in rows(name))


def rows(name: str) -> Iterator[tuple[str, str]]:
    kind = catalogue.kind(name)
    schema, words, met = file_schema(kind), field_words(name, "en"), set[str]()
    for path in words:
        head, _, key = path.partition(".")
        if head != PARAMETERS or not key or key in shared_keys("en") or path in met:
            continue
        steps = tuple(path.split("."))
        alike = [".".join((*steps[:-1], key)) for key in alternatives_to(kind, steps)]
        others = [other for other in alike if other in words and other not in met]
        met |= set(others)
        choices = [f"`{choice}`" for about in places(schema, schema, steps) for choice in choices_of(about)]
        default = next(iter(defaults(schema, steps)), "")
        text = "; or ".join(words[each].whole for each in (path, *others))
        text += (f": {', '.join(choices)}" if choices else "") + (f"; default `{default}`" if default else "")
        keys = " or ".join(f"`{each.partition('.')[2]}`" for each in (path, *others))
        yield keys, text.replace("|", "\\|")


def defaults(schema: dict[str, object], steps: tuple[str, ...]) -> Iterator[str]:
    """What a key is where it is left out, as a file would have it."""
    for above in places(schema, schema, steps[:-1]):
        default = above.get("properties", {}).get(steps[-1], {}).get("default")
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
