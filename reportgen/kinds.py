"""Which kinds of assignments there are, what each is called, and a file to begin with: all without any mathematics."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path

from reportgen.notation.numbers import Language
from reportgen.words import FILE, load_words, templates


@cache
def kinds() -> Mapping[str, str]:
    """The module of every kind, dotted, by the name that stands in a file, in alphabetical order.

    A kind is a module in a room of the package that is called as its words are; in the catalogue before any other room.
    """
    package, words = Path(__file__).parent, templates() / "vi"
    modules = sorted(package.glob("*/*.py"), key=lambda path: path.parent.name == "catalogue")
    named = {path.stem.replace("_", "-"): f"{package.name}.{path.parent.name}.{path.stem}" for path in modules}
    return {kind: named[kind] for kind in sorted(named) if (words / kind / FILE).is_file()}


def title(name: str, language: Language) -> str:
    """The line of description of a kind, from its words."""
    return str(load_words((templates() / language / name,))["title"])


def titles(language: Language) -> dict[str, str]:
    """Each kind with its line of description."""
    return {name: title(name, language) for name in kinds()}


def sample(name: str, language: Language) -> str:
    """The commented assignment file to fill in of a kind; raises `KeyError`."""
    if name not in kinds():
        raise KeyError(name)
    file = f"{name}.yaml"
    return (templates() / language / "new" / file).read_text(encoding="utf-8")
