"""Which kinds of assignments there are, what each is called, and a file to begin with: all without any mathematics."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path

from reportgen.notation.numbers import Language
from reportgen.words import FILE, load_words, templates


@cache
def kinds() -> Mapping[str, str]:
    """The module of every kind, by the name that stands in a file, in alphabetical order."""
    modules = (path.stem for path in sorted((Path(__file__).parent / "catalogue").glob("*.py")))
    named = {module.replace("_", "-"): module for module in modules}
    words = templates() / "vi"
    return {kind: module for kind, module in named.items() if (words / kind / FILE).is_file()}


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
