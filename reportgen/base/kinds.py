"""The kinds of assignments, their modules and their descriptions."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from reportgen.base.template_folders import ATLAS_BASE, MACHINES, REFERENCE, atlas_files, kind_places, templates
from reportgen.base.units import Language
from reportgen.base.words import load_words

SAMPLE = "new"
"""The section of a kind's words with the file to begin with."""


def kinds() -> Mapping[str, str]:
    """Return the dotted module name of every kind, by the kind's name in a file, in alphabetical order.

    Behind them are the machines of the atlas, which share a module. `REPORTGEN_ATLAS` may name further ones; their
    files may be faulty.
    """
    shared = program_kinds()[ATLAS_BASE]
    return {**program_kinds(), **dict.fromkeys(sorted(atlas_files()), shared)}


@cache
def program_kinds() -> Mapping[str, str]:
    """Return the same as `kinds` without the machines of the atlas.

    A kind is a module in a package folder that has the same name as its file of words. The catalogue comes before
    other folders.
    """
    package = Path(__file__).parents[1]
    worded = {name.removesuffix(".md") for name in os.listdir(templates() / REFERENCE / MACHINES)}
    folders = sorted(filter(os.DirEntry.is_dir, os.scandir(package)), key=lambda folder: folder.name == "catalogue")
    named = {
        name.removesuffix(".py").replace("_", "-"): f"{package.name}.{folder.name}.{name.removesuffix('.py')}"
        for folder in folders
        for name in os.listdir(folder)
        if name.endswith(".py")
    }
    return {kind: named[kind] for kind in sorted(worded & named.keys())}


def title(name: str, language: Language) -> str:
    """Return the line of description of a kind, from its words."""
    return str(load_words(kind_places(language, name))["title"])


def titles(language: Language) -> dict[str, str]:
    """Return each kind with its line of description."""
    return {name: title(name, language) for name in kinds()}
