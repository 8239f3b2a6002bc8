"""Pages that are served while their file is edited: `watch`, `edit`, and the choice of a kind to begin with."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from reportgen.api.typesetting import typeset
from reportgen.base.units import Language
from reportgen.cases import opener
from reportgen.page import watch as served
from reportgen.page.watch import Products

if TYPE_CHECKING:
    from reportgen.case import Case
    from reportgen.document import Document

Written = Callable[[Callable[[], bytes], Language], None]
"""What is told of each finished report: a function that gives its PDF, or raises `TypesetterError`; its language."""


def watch(path: Path, language: Language | None = None, written: Written | None = None, browser: bool = True) -> None:
    """Show the report of a file in a browser, renewed whenever it changes, until the program is interrupted.

    Raises `AssignmentError` if there is no file, `OutputError`.
    """

    def tell(case: Case, document: Document) -> None:
        if written is not None:
            written(lambda: typeset(document, "typst")[1], case.assignment.language)

    served.watch(path, opener(), language, tell, browser=browser)


def edit(path: Path, products: Products, language: Language | None = None, browser: bool = True) -> None:
    """As `watch`, with a form beside what moves, by which the file is changed and its `products` are made."""
    served.edit(path, opener(), language, products, browser=browser)


def choose(
    begins: Callable[[str], Path], products: Products, language: Language | None = None, browser: bool = True
) -> None:
    """Show the kinds in a browser; the file of the one that is chosen, which `begins` makes, is then edited."""
    served.choose(begins, opener(), language, products, browser=browser)
