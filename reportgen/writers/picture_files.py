"""Render scenes as pictures in true size, one file each: SVG, PNG and PDF by Typst, in the report's fonts."""

from __future__ import annotations

from collections.abc import Sequence

from reportgen.base.units import Language
from reportgen.drawing import Scene
from reportgen.writers import typst, typst_compiler
from reportgen.writers.scene_source import paint_typst
from reportgen.writers.typst_math import TypstFormulas

DPI = 220
"""Resolution of PNG pictures in dots per inch."""


def svgs(scenes: Sequence[Scene], language: Language, dpi: int = 0) -> list[bytes]:
    """Return scenes as SVG, whose lines need no `dpi`; letters are outlines, which look the same everywhere.

    Raises `TypesetterError`.
    """
    # Letters are symbols referred to by `use`; groups look the same, and more programs support them.
    return [
        svg.replace(b"<symbol", b"<g").replace(b"</symbol>", b"</g>")
        for svg in typst_compiler.compile_as(_source(scenes, language), "svg")
    ]


def pngs(scenes: Sequence[Scene], language: Language, dpi: int = 0) -> list[bytes]:
    """Return scenes as PNG with `dpi` dots per inch, `DPI` for 0; raise `TypesetterError`."""
    return typst_compiler.compile_as(_source(scenes, language), "png", dpi=dpi or DPI)


def pdfs(scenes: Sequence[Scene], language: Language, dpi: int = 0) -> list[bytes]:
    """Return a PDF for each scene, whose lines need no `dpi`; raise `TypesetterError`."""
    return [typst_compiler.compile(_source([scene], language), standards=()) for scene in scenes]


def for_word(scenes: Sequence[Scene], language: Language) -> list[tuple[bytes, bytes]]:
    """Return scenes as PNG and as SVG, because a Word file needs both."""
    return list(zip(pngs(scenes, language), svgs(scenes, language), strict=True)) if scenes else []


def _source(scenes: Sequence[Scene], language: Language) -> str:
    """Return a Typst source with a page for each scene, of its size."""
    formulas = TypstFormulas(language)
    pages = (
        f"#page(width:{scene.width}mm,height:{scene.height}mm,margin:0pt)[#{paint_typst(scene, formulas)}]"
        for scene in scenes
    )
    return "\n".join((typst.frame(language), typst.sheet_look(language), *pages))
