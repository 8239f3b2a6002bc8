"""Show the pages of a PDF that was made on a page: `Preview` draws them again, once the PDF is ready."""

from __future__ import annotations

import shutil
import tempfile
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from hashlib import sha256
from itertools import zip_longest
from pathlib import Path
from typing import Any

from reportgen.base.errors import ReportgenError

PDF = "pdf"
Typesetting = Callable[[str], tuple[Sequence[bytes], Sequence[int]]]
"""Returns the pages of a typst source as SVG, and the page of each heading."""
Message = Mapping[str, Any]


def no_pages(source: str) -> tuple[Sequence[bytes], Sequence[int]]:
    """Return no pages."""
    return (), ()


@dataclass
class Preview:
    """The pages of the PDF that was made last.

    `tell` is called with each message about products. It returns False for pages that nobody wants any more.
    """

    pages: Typesetting
    tell: Callable[[Message], object]
    build: int = 0
    """Number of the PDF whose pages are shown."""
    _drawn: Sequence[bytes] = ()
    _hashes: Sequence[str] = ()
    _heard: Message = field(default_factory=dict)
    drawing: threading.Lock = field(default_factory=threading.Lock)

    def __post_init__(self) -> None:
        self._folder = Path(tempfile.mkdtemp(prefix="preview-"))

    @property
    def source(self) -> Path:
        """The file into which the process that makes a PDF puts its typst source."""
        return self._folder / "report.typ"

    def hear(self, message: Message) -> None:
        """Pass a message on, and draw the pages of a PDF that is ready."""
        self._heard = message
        self.tell(message)
        if (message["product"], message["state"]) == (PDF, "done") and self.source.is_file():
            threading.Thread(target=self._draw, args=(message,), daemon=True).start()

    def _draw(self, message: Message) -> None:
        with self.drawing, suppress(OSError, ReportgenError):
            source = self.source.read_text(encoding="utf-8")
            self.source.unlink()
            drawn, headings = self.pages(source)
            if not drawn:
                return
            hashes = [sha256(page).hexdigest() for page in drawn]
            changed = first_changed(self._hashes, hashes)
            before = self._drawn, self._hashes, self.build
            self._drawn, self._hashes, self.build = drawn, hashes, self.build + 1
            preview = {"build": self.build, "pages": len(drawn), "changed": changed, "headings": headings}
            # A later product has a message of its own.
            if self._heard is not message or self.tell({**message, "preview": preview}) is False:
                self._drawn, self._hashes, self.build = before

    def page(self, name: str) -> bytes | None:
        """Return a page by its name, `page-2-17.svg` for page 17 of the second PDF; None for any other name."""
        number = name.removeprefix(f"page-{self.build}-").removesuffix(".svg")
        drawn = self._drawn
        if name != f"page-{self.build}-{number}.svg" or not number.isdecimal() or not 1 <= int(number) <= len(drawn):
            return None
        return drawn[int(number) - 1]

    def close(self) -> None:
        """Delete what was left for the preview."""
        shutil.rmtree(self._folder, ignore_errors=True)


def first_changed(before: Sequence[str], after: Sequence[str]) -> int:
    """Return the number of the first page that is not as before, 0 if all are; 1 for a first PDF."""
    pairs = enumerate(zip_longest(before, after), start=1)
    changed = next((number for number, (old, new) in pairs if old != new), 0)
    return min(changed, len(after))
