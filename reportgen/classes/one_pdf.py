"""Bind all tasks, reports, keys, sheets or feedback pages of a class into one PDF, for printing or reading."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from reportgen.base.files import contents, put_files, reported, scratch
from reportgen.base.output_formats import PRODUCTS, file_names
from reportgen.writers.bound_pdf import bound

NAMES = {product.name: product.bound for product in PRODUCTS if product.bound}
"""Products that have PDFs, and the name of the bound file of each."""
FEEDBACK = "feedback.pdf"
LARGEST = 100_000_000
"""Largest size (bytes) of one student's file."""


def bind_products(out: Path, students: Sequence[tuple[str, str]], products: Iterable[str]) -> Iterator[Path]:
    """Bind the PDFs of each product below `out`; each student is a folder and a title.

    Raises `OutputError` and `TypesetterError`.
    """
    for product in products:
        if product in NAMES:
            yield from _put(out, NAMES[product], students, file_names(product))


def bind_feedback(out: Path, students: Sequence[tuple[str, str]]) -> Iterator[Path]:
    """Bind the feedback pages of a class, like `bind_products`."""
    yield from _put(out, FEEDBACK, students, re.escape(FEEDBACK))


def _put(out: Path, name: str, students: Sequence[tuple[str, str]], pattern: str) -> list[Path]:
    """Write one PDF of the students' files that match a pattern; write nothing if there are none."""
    with reported(out), scratch(out):
        parts = [
            (title, contents(file, LARGEST)) for folder, title in students for file in _pdfs(out / folder, pattern)
        ]
        return put_files(out, {name: bound(parts)}) if parts else []


def _pdfs(folder: Path, pattern: str) -> list[Path]:
    """Return the PDFs of a student whose names match a pattern, ordered by the numbers in their names."""
    files = (path for path in folder.glob("*.pdf") if re.fullmatch(pattern, path.name))
    return sorted(files, key=lambda path: (len(path.name), path.name))
