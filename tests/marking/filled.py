"""The answer sheet of a student who has everything from the key, or from it but for some factors."""

from __future__ import annotations

from collections.abc import Mapping

from reportgen.base.records import replace
from reportgen.case.answer_key import Key
from reportgen.marking.answer_sheet import answer_book
from reportgen.workbook import Book, write_xlsx


def filled(key: Key, changed: Mapping[str, float] | None = None, cam: Key | None = None, figures: int = 0) -> bytes:
    """The answer sheet with the key's values, some times a factor, those of the cam perhaps from another key.

    Of each value so many significant figures are written, or those of the report.
    """
    factors, book, pages = changed or {}, answer_book(key), []
    for page in book.sheets:
        rows = []
        for row in page.rows:
            id = getattr(row[0], "value", None) if row else None
            found = key.find(id) if isinstance(id, str) else None
            cells = list(row)
            if found is not None and found.positions:
                own = next(part for _, part in key.pages if part.find(found.id))
                places = [0, *sorted({k for one in own.asked for k in one.positions if k})]
                for column, k in enumerate(places, start=4):
                    if k in found.positions:
                        source = cam.row(found.id) if cam and key.owner(found.id) == "cam" else found
                        shown = source.values if figures else source.printed
                        value = float(shown[source.at(k)]) * factors.get(found.id, 1.0)
                        value = float(f"{value:.{figures}g}") if figures else value
                        cells[column] = replace(cells[column], value=value)  # type: ignore[type-var]
            rows.append(cells)
        pages.append(replace(page, rows=rows))
    return write_xlsx(Book(pages, book.title))
