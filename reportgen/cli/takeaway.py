"""Commands that take something along: figures as files."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from reportgen.base.files import reported, standing
from reportgen.cli.common import File, LangOption, TemplatesOption, ending, listed, refuse_inputs, tell

FIGURES = "figures"
"""The folder of figures beside the report."""


def figure(
    file: File,
    names: Annotated[
        list[str] | None, typer.Argument(metavar="NAME", help="Figures, see --list.", show_default="all of the report")
    ] = None,
    at: Annotated[
        str, typer.Option("--at", metavar="POSITION", help="What shows this position.", show_default=False)
    ] = "",
    format: Annotated[
        str, typer.Option("--format", metavar="LIST", help="Of svg, png, pdf, eps, gif, mp4; parted by commas.")
    ] = "svg",
    dpi: Annotated[
        int | None,
        typer.Option("--dpi", min=10, max=1200, help="Dots an inch.", show_default="220; 110 of GIF and MP4"),
    ] = None,
    layers: Annotated[
        str, typer.Option("--layers", metavar="LIST", help="What moving drawings show besides.")
    ] = "paths",
    list_names: Annotated[bool, typer.Option("--list", help="Only name the figures.")] = False,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the figures.")] = Path("out"),
    lang: LangOption = None,
    templates: TemplatesOption = None,
) -> None:
    """Write figures of the report as files of their own. They go to DIR/<id>/figures/NAME.svg, .png, ….

    A NAME is the key of a figure, v.4, or with --at only what it shows, v; what moves has a name, too, machine.
    """
    from reportgen import api
    from reportgen.base.files import scratch
    from reportgen.base.made import put_made

    formats = listed(format, api.FIGURE_FORMATS, "--format", "no_format", lang)
    shown = tuple(dict.fromkeys(name.strip() for name in layers.split(",") if name.strip()))
    with ending(lang):
        if list_names:
            _print_list(file, lang)
            return
        folder = out / file.stem / FIGURES
        refuse_inputs(standing(folder, "figures"), [file], lang)
        with reported(), scratch(out):
            files = api.figure_files(
                file, names or (), at=at, formats=formats, dpi=dpi or 0, layers=shown, language=lang
            )
            of = api.made_of(file, "typst", api.load(file, lang).language)
            tell(put_made(folder, files, "figures", of), lang)


def _print_list(file: Path, lang: LangOption) -> None:
    """A line a figure: its name, its number or the formats of what moves, what it shows, and at which positions."""
    from reportgen import api
    from reportgen.export.figures import MOVING

    still, moving = api.figure_list(file, lang)
    rows = [(one.name, one.number, one.caption, ", ".join(one.positions)) for one in still]
    rows += [(one.name, "/".join(MOVING), one.pane.title, "") for one in moving]
    widths = [max(len(row[column]) for row in rows) for column in (0, 1)] if rows else [0, 0]
    for name, number, caption, positions in rows:
        print(f"{name:{widths[0]}}  {number:{widths[1]}}  {caption}{f' ({positions})' * bool(positions)}")
