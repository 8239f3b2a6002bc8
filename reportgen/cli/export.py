"""Commands that export figures and curves as files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Literal

import typer

from reportgen.base.files import reported, standing
from reportgen.cli.common import (
    AtlasOption,
    File,
    Files,
    LangOption,
    TemplatesOption,
    ending,
    format_option,
    listed,
    refuse_inputs,
    tell,
    usual_formats,
)

FIGURES, PLOTS = "figures", "plots"
"""Folders of figures and of plots beside the report."""


def figure(
    file: File,
    names: Annotated[
        list[str] | None, typer.Argument(metavar="NAME", help="Figures, see --list.", show_default="all of the report")
    ] = None,
    at: Annotated[
        str, typer.Option("--at", metavar="POSITION", help="Figures of this position.", show_default=False)
    ] = "",
    format: Annotated[str, format_option("figures")] = usual_formats("figures"),
    dpi: Annotated[
        int | None,
        typer.Option("--dpi", min=10, max=1200, help="Dots per inch.", show_default="220; 110 of GIF and MP4"),
    ] = None,
    layers: Annotated[
        str, typer.Option("--layers", metavar="LIST", help="Additional layers of moving drawings.")
    ] = "paths",
    list_names: Annotated[bool, typer.Option("--list", help="List the figures without writing them.")] = False,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the figures.")] = Path("out"),
    lang: LangOption = None,
    templates: TemplatesOption = None,
    atlas: AtlasOption = None,
) -> None:
    """Write figures of the report as separate files. They go to DIR/<id>/figures/NAME.svg, .png, ….

    A NAME is the key of a figure, v.4, or with --at only what it shows, v; what moves has a name, too, machine.
    """
    from reportgen import api
    from reportgen.api import figures
    from reportgen.base.files import scratch
    from reportgen.base.provenance import put_made

    formats = listed(format, figures.FIGURE_FORMATS, "--format", "no_format", lang)
    layer_names = tuple(dict.fromkeys(name.strip() for name in layers.split(",") if name.strip()))
    with ending(lang):
        if list_names:
            _print_list(file, lang)
            return
        folder = out / file.stem / FIGURES
        refuse_inputs(standing(folder, "figures"), [file], lang)
        with reported(), scratch(out):
            files = figures.figure_files(
                file, names or (), at=at, formats=formats, dpi=dpi or 0, layers=layer_names, language=lang
            )
            of = api.made_of(file, "typst", api.load(file, lang).language)
            tell(put_made(folder, files, "figures", of), lang)


def plot(
    files: Files,
    of: Annotated[
        str, typer.Option("--of", metavar="IDS", help="Quantities, separated by commas.", show_default=False)
    ] = "",
    over: Annotated[
        Literal["phi", "time"], typer.Option("--over", help="Horizontal axis: displacement of the driver, or time.")
    ] = "phi",
    measured: Annotated[
        Path | None, typer.Option("--with", metavar="TABLE", help="Measured values, CSV or XLSX.", show_default=False)
    ] = None,
    format: Annotated[str, format_option("plots")] = usual_formats("plots"),
    dpi: Annotated[int, typer.Option("--dpi", min=10, max=1200, help="Dots per inch.")] = 220,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the charts.")] = Path("out"),
    lang: LangOption = None,
    atlas: AtlasOption = None,
) -> None:
    """Plot quantities of each FILE as curves, one chart per unit. The files are DIR/<id of the first>/plots/ID.svg, ….

    Without --of, list the quantities of the first FILE.

    Ids are those of answer sheets and keys, v.E. A TABLE is headed by ids with their units, v.E (m/s); its first column
    is phi (deg) from position 1, or t (s).
    """
    from reportgen import api
    from reportgen.api import figures
    from reportgen.base.files import scratch
    from reportgen.base.provenance import put_made

    formats = listed(format, figures.PLOT_FORMATS, "--format", "no_format", lang)
    ids = tuple(dict.fromkeys(name.strip() for name in of.split(",") if name.strip()))
    with ending(lang):
        if not ids:
            _print_rows(figures.plot_list(files[0], lang))
            return
        folder = out / files[0].stem / PLOTS
        refuse_inputs(standing(folder, "plots"), [*files, measured], lang)
        with reported(), scratch(out):
            made = figures.plot_files(files, ids, over, measured, formats=formats, dpi=dpi, language=lang)
            of_first = api.made_of(files[0], "", api.load(files[0], lang).language)
            tell(put_made(folder, made, "plots", of_first, alone=True), lang)


def _print_list(file: Path, lang: LangOption) -> None:
    """Print a line per figure: its name, its number or moving formats, its caption, and its positions."""
    from reportgen.api import figures

    still, moving = figures.figure_list(file, lang)
    rows = [
        (named.name, named.number, named.caption + f" ({', '.join(named.positions)})" * bool(named.positions))
        for named in still
    ]
    _print_rows([*rows, *((one.name, "/".join(figures.MOVING), one.pane.title) for one in moving)])


def _print_rows(rows: Sequence[tuple[str, str, str]]) -> None:
    """Print rows of three texts with aligned columns."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for first, second, last in rows:
        print(f"{first:{widths[0]}}  {second:{widths[1]}}  {last}")
