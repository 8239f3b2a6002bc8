"""Compile Typst source into PDF or pictures with the compiler embedded in its Python package.

It runs once for each source, or twice if a standard rejects it.
"""

from __future__ import annotations

import json
import tempfile
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

from reportgen.base.errors import OutputWarning, TypesetterError
from reportgen.base.pdf_standards import STANDARDS, Standards, titled
from reportgen.base.process_limits import give_memory_back
from reportgen.base.words import word
from reportgen.writers.typst_fonts import MissingLettersWarning, sought


class StandardWarning(OutputWarning):
    """Warning that a file conforms to none of the requested `standards`, since they reject it for a `reason`."""

    def __init__(self, standards: Standards, reason: str) -> None:
        self.standards, self.reason = standards, reason
        super().__init__(standards, reason)

    def __str__(self) -> str:
        return word("standards_refused", None, standards=titled(self.standards), reason=self.reason)


def compile(source: str, system: bool = False, standards: Standards = STANDARDS) -> bytes:
    """Return the PDF of a Typst source, byte for byte the same in every run; it may use fonts of the `system`.

    It conforms to the `standards`, or to none of them (with a warning) if they do not allow its content. Raises
    `TypesetterError` with the message's first lines.
    """
    (pdf,) = compile_as(source, "pdf", system, standards=standards)
    return pdf


def compile_as(
    source: str,
    format: Literal["pdf", "png", "svg"],
    system: bool = False,
    dpi: int = 0,
    standards: Standards = (),
    beside: Mapping[str, bytes] | None = None,
) -> list[bytes]:
    """Return a PDF of a Typst source, or a picture of each of its pages with `dpi` dots per inch.

    The source may refer to the files `beside` it. Raises `TypesetterError`.
    """
    try:
        import typst
    except ModuleNotFoundError as error:
        raise TypesetterError("typst is not installed: pip install typst") from error
    except ImportError as error:
        raise TypesetterError(f"typst cannot be loaded, most likely for too little memory: {error}") from error
    folders, needs_system, missing = sought(source)
    if missing:
        warnings.warn(MissingLettersWarning(missing, standards), stacklevel=2)
        standards = ()
    own = not needs_system and not system
    give_memory_back()
    with tempfile.TemporaryDirectory(prefix="typst-") as folder:
        path = Path(folder) / "report.typ"
        path.write_text(source, encoding="utf-8", newline="")
        for name, content in (beside or {}).items():
            (Path(folder) / name).write_bytes(content)

        def made(kept: Standards) -> Any:
            asked: dict[str, Any] = {"pdf_standards": list(kept)} if kept else {}
            return typst.compile(
                str(path),
                root=folder,
                font_paths=[*folders],
                ignore_system_fonts=own,
                format=format,
                ppi=dpi or None,
                **asked,
            )

        try:
            try:
                pages = made(standards)
            except typst.TypstError as error:
                if not standards:
                    raise
                pages = made(())
                warnings.warn(StandardWarning(standards, _refusal(error)), stacklevel=2)
        except typst.TypstError as error:
            raise TypesetterError(f"typst: {_first_lines(error, 4)}") from error
    # A single page is not returned as a list.
    return [pages] if isinstance(pages, bytes) else list(pages)


HEADINGS = "\n#context [#metadata(query(heading).map(one => one.location().page())) <heading-pages>]\n"
"""Addition to a source that makes the pages of its headings known."""


def heading_pages(source: str, system: bool = False) -> list[int]:
    """Return the page of each heading of a Typst source, in order.  Raises `TypesetterError`."""
    import typst

    folders, needs_system, _ = sought(source)
    with tempfile.TemporaryDirectory(prefix="typst-") as folder:
        path = Path(folder) / "report.typ"
        path.write_text(source + HEADINGS, encoding="utf-8", newline="")
        try:
            pages = typst.query(
                str(path),
                "<heading-pages>",
                field="value",
                one=True,
                root=folder,
                font_paths=[*folders],
                ignore_system_fonts=not needs_system and not system,
            )
        except typst.TypstError as error:
            raise TypesetterError(f"typst: {_first_lines(error, 4)}") from error
    return [int(page) for page in json.loads(pages)]


def _refusal(error: Exception) -> str:
    """Return the reason why standards reject a source, without their names; if they are incompatible, say so."""
    line = _first_lines(error, 1).partition(" error: ")[2]
    return line.split('"')[1] if line.startswith("HintedString") else line


def _first_lines(error: Exception, count: int) -> str:
    return "\n".join(str(getattr(error, "message", error)).splitlines()[:count])
