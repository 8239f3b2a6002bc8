"""The command for the documentation that comes with the program."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Iterable, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from reportgen.base.template_folders import Language
from reportgen.cli.common import LangOption, complain, ending, say

if TYPE_CHECKING:
    from reportgen.base.documentation import IndexEntry


def docs(
    page: Annotated[
        str | None, typer.Argument(metavar="PAGE", help="Name of a page.", show_default="all, a line each")
    ] = None,
    browser: Annotated[bool, typer.Option("--open", help="Open the page in a browser.")] = False,
    printed: Annotated[bool, typer.Option("--print", help="Print the page as text.")] = False,
    lang: LangOption = None,
) -> None:
    """Open a PAGE of the documentation in the browser; print it as text where there is none. Without PAGE, list
    the pages.
    """
    from reportgen.base import documentation
    from reportgen.base.words import spoken

    with ending(lang):
        if page is None and not browser:
            _list(documentation.entries(lang))
            return
        known = documentation.pages(lang)
        asked = (page or documentation.INDEX).casefold().removesuffix(documentation.SUFFIX)
        name = next((name for name in known if name.casefold() == asked), None)
        if name is None:
            raise typer.BadParameter(_no_page(asked, list(known), lang), param_hint="PAGE")
        file = known[name]
        if documentation.language_of(file) != (lang or spoken()):
            complain(say("page_in_english", lang))
        wanted = browser or (not printed and sys.stdout.isatty() and _has_browser())
        if not (wanted and _opened(file)):
            _print(file)


def _list(entries: Iterable[IndexEntry]) -> None:
    """Print a line for each page, sorted by kind and subject."""
    entries = list(entries)
    width = max(len(entry.name) for entry in entries)
    for (group, section), rows in groupby(entries, lambda entry: (entry.group, entry.section)):
        print(f"{group} – {section}" if section else group)
        for entry in rows:
            summary = f": {entry.summary}" if entry.summary else ""
            print(f"  {entry.name:{width}}  {entry.title}{summary}".replace("`", ""))


def _no_page(asked: str, known: Sequence[str], lang: Language | None) -> str:
    """Return the message about an unknown page, with the names that are nearest to it."""
    from difflib import get_close_matches

    from reportgen.base.words import unknown

    near = [name for name in known if asked in name] or get_close_matches(asked, known, 5, 0.4)
    return unknown("no_page", asked, near or known, lang)


def _has_browser() -> bool:
    """Return True if the system can show a page in a window; a browser within the terminal does not count."""
    import webbrowser

    try:
        webbrowser.get()
    except webbrowser.Error:
        return False
    screens = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
    return sys.platform in ("win32", "darwin") or any(os.environ.get(name) for name in screens)


def _opened(file: Path) -> bool:
    """Write all pages for a browser and open one; return False if no browser takes it."""
    import tempfile
    import webbrowser

    from reportgen.base.documentation_html import file_name, write_pages
    from reportgen.base.files import folder

    place = (folder() or Path(tempfile.mkdtemp(prefix="reportgen-"))) / "docs"
    write_pages(place)
    page = place / file_name(file)
    print(page)
    return webbrowser.open(page.as_uri())


def _print(file: Path) -> None:
    """Print a page as text, in the width of the terminal if there is one."""
    from reportgen.base.documentation_text import WIDEST, as_text

    terminal = sys.stdout.isatty()
    width = shutil.get_terminal_size().columns if terminal else WIDEST
    print(as_text(file, width, styled=terminal), end="")
