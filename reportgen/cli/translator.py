"""The command for translators: check the words of a language, and typeset them for proofreading."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from reportgen.base.files import put_file, reported
from reportgen.cli.common import AT_FAULT, LangOption, ending, say


def words(
    place: Annotated[str, typer.Argument(metavar="LANG|DIR", help="A language, or the folder of one.")],
    sheet: Annotated[
        bool, typer.Option("--proof", help="Typeset all texts beside the English ones, for proofreading.")
    ] = False,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder of the proof sheet.")] = Path("out"),
    lang: LangOption = None,
) -> None:
    """Compare the words of a language with the English ones: what is missing, what says something else, by its line."""
    from reportgen.api import language_check
    from reportgen.base.template_folders import LANGUAGE_FILE, languages
    from reportgen.base.translation_coverage import offered
    from reportgen.base.words import spoken

    folder = language_check.folder_of(place)
    if not (folder / LANGUAGE_FILE).is_file():
        raise typer.BadParameter(say("no_language", lang, place=place, known=", ".join(languages())))
    with ending(lang):
        problems = language_check.compared(folder, lang or spoken())
        for problem in problems:
            print(problem, file=sys.stderr)
        if sheet:
            path = out / folder.name / language_check.PROOF
            with reported():
                path.parent.mkdir(parents=True, exist_ok=True)
                put_file(path, language_check.proof_sheet(folder, folder.name))
            print(path)
        if place in languages():
            print(say("offered", lang, language=place, known=", ".join(offered(place)) or "–"))
        raise typer.Exit(AT_FAULT if any(problem.level == "error" for problem in problems) else 0)
