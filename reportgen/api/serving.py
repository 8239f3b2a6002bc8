"""Serve pages while their file is edited: `watch`, `edit`, and the choice of a kind to begin with."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from reportgen.api.typesetting import pages_of, typeset
from reportgen.base.units import Language
from reportgen.case import MachineAnalysis
from reportgen.cases import opener, starter_case
from reportgen.page import file_watch as served
from reportgen.page.file_watch import Products

if TYPE_CHECKING:
    from reportgen.case import Case
    from reportgen.document import Document
    from reportgen.page.kind_cards import CardDrawing

Written = Callable[[Callable[[], bytes], Language], None]
"""Called for each finished report with its language and a function that returns its PDF or raises `TypesetterError`."""


def watch(path: Path, language: Language | None = None, written: Written | None = None, browser: bool = True) -> None:
    """Show the report of a file in a browser, renewed whenever it changes, until the program is interrupted.

    Raises `AssignmentError` if there is no file, and `OutputError`.
    """

    def tell(case: Case, document: Document) -> None:
        if written is not None:
            written(lambda: typeset(document, "typst")[1], case.assignment.language)

    served.watch(path, opener(), language, tell, browser=browser)


def edit(path: Path, products: Products, language: Language | None = None, browser: bool = True) -> None:
    """Like `watch`, with a form beside the moving figure that changes the file and makes its `products`."""
    served.edit(path, opener(), language, products, pages=pages_of, browser=browser)


def choose(
    begins: Callable[[str, str], Path], products: Products, language: Language | None = None, browser: bool = True
) -> None:
    """Show the kinds in a browser; `begins` creates a file of a kind or a copy of its sample, which is then edited."""
    served.choose(begins, opener(), language, products, pages=pages_of, draws=_drawn_scheme, browser=browser)


def _drawn_scheme(kind: str) -> CardDrawing:
    """Return the scheme of a machine with its default parameters, for its card.  Raises `AssignmentError`."""
    # It loads the makers of reports.
    from reportgen.page.scheme_drawings import card_drawing, machine_scheme

    case = starter_case(kind)
    assert isinstance(case, MachineAnalysis), "a machine of the atlas is a linkage"
    return card_drawing(kind, machine_scheme(case))
