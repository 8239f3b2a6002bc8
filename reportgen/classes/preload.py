"""Make a sample's products in the fork server, up to the typesetter, so that workers start warm.

The modules, the parsed words, the compiled templates and the symbol tables that the products of a kind need are in the
memory with which each worker starts. The server processes no student's file and no school's template, because such a
file could crash it.
"""

from __future__ import annotations

import gc
import os
import re
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import cast

from reportgen.api.report_fonts import Engine
from reportgen.base.output_formats import PRODUCTS
from reportgen.base.template_folders import DEFAULT_LANGUAGE
from reportgen.base.units import Language
from reportgen.catalogue import starter
from reportgen.classes.worker_pool import SAMPLES

FEW = 4
"""Number of students from which preloading pays; as many files are searched for their kind."""
COLLECTED = 1_000_000
"""Number of new objects between two garbage collections: a report makes many lasting objects and hardly any cycles."""
_KIND, _LANGUAGE = re.compile(r"(?m)^kind: *([\w/-]+)"), re.compile(r"(?m)^  +language: *(\w+)")
TYPESET = {product.name: product for product in PRODUCTS if product.typeset}
"""Products that are made completely, but for the typesetter; of a report in other formats, the document is made."""


def samples(given: Path, language: Language | None, engine: Engine, products: Iterable[str]) -> frozenset[str]:
    """Return what to prepare for a spec or the first assignment files of a folder, as `kind:language:engine:product`.

    `language` overrides that of the files if it is given.
    """
    wanted = {product if product in TYPESET else "" for product in products}
    named: set[str] = set()
    for file in sorted(given.rglob("*.yaml"))[:FEW] if given.is_dir() else (given,):
        with suppress(OSError, UnicodeDecodeError):
            text = file.read_text(encoding="utf-8")
            if kind := _KIND.search(text):
                own = _LANGUAGE.search(text)
                spoken = language or (own[1] if own else DEFAULT_LANGUAGE)
                named |= {f"{kind[1]}:{spoken}:{engine}:{product}" for product in wanted}
    return frozenset(named)


def prepare(kind: str, language: Language, engine: Engine, product: str) -> None:
    """Make a product of the sample of a kind up to the typesetter, or its report's document for "", and discard it.

    Raises `KeyError` for an unknown kind.
    """
    from reportgen import api
    from reportgen.api.typesetting import sources_alone

    with TemporaryDirectory(prefix="reportgen-") as folder, sources_alone():
        file = Path(folder) / "sample.yaml"
        file.write_text(starter(kind, language), encoding="utf-8")
        if product:
            TYPESET[product].load()(file, engine, language)
        else:
            api.document(api.load(file))


def _prepare_named() -> None:
    for named in os.environ[SAMPLES].split():
        kind, language, engine, product = named.split(":")
        # If preparing fails, each worker does it itself and can report the failure.
        with suppress(Exception):
            prepare(kind, language, cast(Engine, engine), product)
    gc.collect()
    gc.freeze()
    gc.set_threshold(COLLECTED)


if SAMPLES in os.environ:
    _prepare_named()
