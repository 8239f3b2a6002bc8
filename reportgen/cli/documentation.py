"""The command for the documentation that comes with the program."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from reportgen.cli.common import LangOption, ending


def docs(
    page: Annotated[
        str | None, typer.Argument(metavar="PAGE", help="One of the pages.", show_default="all, a line each")
    ] = None,
    browser: Annotated[bool, typer.Option("--open", help="Open the page in a browser.")] = False,
    lang: LangOption = None,
) -> None:
    """Print a PAGE of the documentation, or list the pages. README is where to begin."""
    from reportgen.base import documentation
    from reportgen.base.words import unknown

    with ending(lang):
        known = documentation.pages(lang)
        if page is None:
            width = max(map(len, known))
            print(*(f"{name:{width}}  {documentation.heading(path)}" for name, path in known.items()), sep="\n")
            return
        name = next((name for name in known if name.casefold() == page.casefold().removesuffix(".md")), None)
        if name is None:
            raise typer.BadParameter(unknown("no_page", page, list(known), lang), param_hint="PAGE")
        if browser:
            import webbrowser

            print(made := documentation.as_html(known[name]))
            webbrowser.open(made.as_uri())
        else:
            _show(known[name].read_text(encoding="utf-8"))


def _show(text: str) -> None:
    """Print a page; a terminal shows its headings and tables formatted."""
    if sys.stdout.isatty():
        from rich.console import Console
        from rich.markdown import Markdown

        Console().print(Markdown(text))
    else:
        print(text, end="")
