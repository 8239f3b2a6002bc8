"""How full the pages of a report are: the share of each text block that lies in wide gaps without ink.

python -m tests.report.thin_pages REPORT.pdf…      prints the pages that are thin
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from itertools import groupby

import numpy as np

from tests.report.pages import MM, Page

GAP = 12.0
"""Lower white (mm) is what headings, figures and tables have around them."""
THIN = 0.4
"""A page is thin if this share of its text block or more lies in gaps."""
TOP, BOTTOM = 22.0, 20.0
"""Margins of an A4 page (mm), header and footer in them."""
PLATE = 15.0
"""Margins above and below the drawing of a larger page (mm), at least."""
FINE = 3
"""Pixels a millimetre."""
PAPER = 250
"""A lighter gray is paper: a hair line of the tables is darker at this fineness."""


def emptiness(page: Page) -> float:
    """The share of the text block's height that lies in gaps of 12 mm or more."""
    import pymupdf

    scale = FINE / MM
    picture = page.sheet.get_pixmap(matrix=pymupdf.Matrix(scale, scale), colorspace=pymupdf.csGRAY, alpha=False)
    rows = np.frombuffer(picture.samples, dtype=np.uint8).reshape(picture.height, picture.stride)
    above, below = (PLATE, PLATE) if page.is_plate else (TOP, BOTTOM)
    block = rows[round(above * FINE) : picture.height - round(below * FINE), : picture.width]
    white = (block >= PAPER).all(axis=1)
    gaps = [len(list(run)) for empty, run in groupby(white) if empty]
    return sum(gap for gap in gaps if gap >= GAP * FINE) / len(white)


def thin(pages: Sequence[Page]) -> list[int]:
    """Indices of the thin pages."""
    return [index for index, page in enumerate(pages) if emptiness(page) >= THIN]


def main(files: Sequence[str]) -> None:
    import pymupdf

    for file in files:
        opened = pymupdf.open(file)
        pages = [Page(sheet) for sheet in opened]
        found = thin(pages)
        print(f"{file}: {len(pages)} pages, {len(found)} thin: {' '.join(str(index + 1) for index in found)}")


if __name__ == "__main__":
    main(sys.argv[1:])
