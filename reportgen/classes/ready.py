"""What all reports of a kind have in common, made ready once by the process that workers are forked from.

The parsed words, the compiled templates and the tables of symbols that the sample of a kind needs stay in the memory
that each worker begins with.  No student's file and no school's template is worked out there: none may end it.
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
from reportgen.classes.pool import KINDS

FEW = 4
"""From so many students on it pays; so many files are asked for their kind."""
COLLECTED = 1_000_000
"""New objects between two searches for garbage: a report makes many that last, and hardly any cycles."""
_KIND, _LANGUAGE = re.compile(r"(?m)^kind: *([\w-]+)"), re.compile(r"(?m)^  +language: *(\w+)")


def kinds(given: Path, language: Language | None) -> frozenset[str]:
    """Kinds and languages, as `kind:language`, of a spec or of the first assignment files of a folder.

    `language` is that of all, if one is given.
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
    """Work the sample of a kind out, up to its pages, and forget it.

    Raises `KeyError` for no kind of this program.
    """
    from reportgen import api

    with TemporaryDirectory(prefix="reportgen-") as folder:
        file = Path(folder) / "sample.yaml"
        file.write_text(sample(kind, language), encoding="utf-8")
        api.document(api.load(file))


def _prepare_named() -> None:
    for named in os.environ[KINDS].split():
        kind, language = named.split(":")
        # What cannot be prepared is done by each worker, which can tell of it.
        with suppress(Exception):
            prepare(kind, language)
    gc.collect()
    gc.freeze()
    gc.set_threshold(COLLECTED)


if KINDS in os.environ:
    _prepare_named()
