"""Preload templates and symbol tables in the fork server, so that workers start warm.

The parsed words, the compiled templates and the symbol tables that the sample of a kind needs are in the memory with
which each worker starts. The server processes no student's file and no school's template, because such a file could
crash it.
"""

from __future__ import annotations

import gc
import os
import re
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

from reportgen.base.template_folders import DEFAULT_LANGUAGE
from reportgen.base.units import Language
from reportgen.catalogue import sample
from reportgen.classes.worker_pool import KINDS

FEW = 4
"""Number of students from which preloading pays; as many files are searched for their kind."""
COLLECTED = 1_000_000
"""Number of new objects between two garbage collections: a report makes many lasting objects and hardly any cycles."""
_KIND, _LANGUAGE = re.compile(r"(?m)^kind: *([\w-]+)"), re.compile(r"(?m)^  +language: *(\w+)")


def kinds(given: Path, language: Language | None) -> frozenset[str]:
    """Return kinds and languages, as `kind:language`, of a spec or of the first assignment files of a folder.

    `language` overrides that of the files if it is given.
    """
    pairs: set[str] = set()
    for file in sorted(given.rglob("*.yaml"))[:FEW] if given.is_dir() else (given,):
        with suppress(OSError, UnicodeDecodeError):
            text = file.read_text(encoding="utf-8")
            if kind := _KIND.search(text):
                own = _LANGUAGE.search(text)
                pairs.add(f"{kind[1]}:{language or (own[1] if own else DEFAULT_LANGUAGE)}")
    return frozenset(pairs)


def prepare(kind: str, language: Language) -> None:
    """Compute the sample of a kind up to its pages, and discard it; raise `KeyError` for an unknown kind."""
    from reportgen import api

    with TemporaryDirectory(prefix="reportgen-") as folder:
        file = Path(folder) / "sample.yaml"
        file.write_text(sample(kind, language), encoding="utf-8")
        api.document(api.load(file))


def _prepare_named() -> None:
    for named in os.environ[KINDS].split():
        kind, language = named.split(":")
        # If preparing fails, each worker does it itself and can report the failure.
        with suppress(Exception):
            prepare(kind, language)
    gc.collect()
    gc.freeze()
    gc.set_threshold(COLLECTED)


if KINDS in os.environ:
    _prepare_named()
