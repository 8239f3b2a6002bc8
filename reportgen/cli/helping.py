"""Help in the language that is spoken: the texts of commands and options, and the words around them.

The commands say in English what they do; `help.yaml` of another language has each of these texts in its own, by the
English one.  It is read only where help is asked for.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

from typer.core import TyperCommand, TyperGroup

PAGES = {
    "build": "report",
    "edit": "edit",
    "watch": "page",
    "sheet": "sheets",
    "figure": "figures",
    "plot": "figures",
    "solve": "results",
    "check": "assignment",
    "schema": "assignment",
    "words": "language",
    "new": "machines",
    "kinds": "machines",
    "compare": "class",
    "read": "class",
    "variants": "class",
    "batch": "class",
    "key": "class",
    "grade": "class",
}
"""The page of the documentation that a command is explained on; that of all commands for any other."""
OTHERS = "commands"
_EXTRA = re.compile(r"^(?P<help>.*?)(?P<extra>(?:  |^)\[[^\[\]]*\])$", re.DOTALL)
_PYTHON_TYPE = re.compile(r" <[\w\[\]]+>$")
_NAME = r"[\w-]+"
_DEFAULT = re.compile(r"\bdefault: (\((.+?)\)(?=; |\]))?")


class _Spoken:
    """What a command and the group of all commands have in common: help in words of the language."""

    name: str | None
    help: str | None
    collect_usage_pieces: Callable[[Any], list[str]]
    get_params: Callable[[Any], list[Any]]

    def format_usage(self, ctx: Any, formatter: Any) -> None:
        """The line that shows how the command is called."""
        frame = _helps()["frame"]
        pieces = " ".join(self.collect_usage_pieces(ctx))
        shown = re.sub(r"\w+", lambda piece: frame["pieces"].get(piece[0], piece[0]), pieces)
        formatter.write_usage(ctx.command_path, shown, prefix=f"{frame['usage']}: ")

    def format_help_text(self, ctx: Any, formatter: Any) -> None:
        """What the command does."""
        for paragraph in (self.help or "").split("\n\n"):
            formatter.write_paragraph()
            with formatter.indentation():
                formatter.write_text(translated(paragraph))

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Arguments, then options; behind them the page that tells more."""
        frame = _helps()["frame"]
        for kind, head in (("argument", "arguments"), ("option", "options")):
            records = [each.get_help_record(ctx) for each in self.get_params(ctx) if each.param_type_name == kind]
            # Behind an argument typer writes its Python type, which says nothing to a user.
            rows = [(_PYTHON_TYPE.sub("", names), _record(text)) for names, text in filter(None, records)]
            if rows:
                with formatter.section(frame[head]):
                    formatter.write_dl(rows)

    def format_epilog(self, ctx: Any, formatter: Any) -> None:
        """Where more is told."""
        page = PAGES.get(self.name or "", OTHERS)
        formatter.write_paragraph()
        formatter.write_text(_helps()["frame"]["more"].format(page=page))


class Command(_Spoken, TyperCommand):
    """A command whose help is in the language that is spoken."""

    def get_short_help_str(self, limit: int = 45) -> str:
        """The first sentence of what it does."""
        return re.split(r"(?<=\.)\s", translated((self.help or "").split("\n\n")[0]))[0]


class Commands(_Spoken, TyperGroup):
    """All commands, of which an unknown one is told with the one it was probably meant to be."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Options, then the commands."""
        super().format_options(ctx, formatter)
        rows = [(name, command.get_short_help_str()) for name, command in self.commands.items()]
        with formatter.section(_helps()["frame"]["commands"]):
            formatter.write_dl(rows)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """The command that a line names.  Raises `BadParameter` for none."""
        if args[0] not in self.commands:
            import typer

            from reportgen.base.words import unknown

            raise typer.BadParameter(unknown("no_command", args[0], list(self.commands), None), ctx=ctx)
        return super().resolve_command(ctx, args)


def start() -> str:
    """The short start that is printed where no command is named."""
    return "\n".join(_helps()["start"])


def translated(text: str) -> str:
    """A text of the commands in the language that is spoken; one that has none there stays English.

    A text with `{names}` in `help.yaml` is that of every list of names in its place.
    """
    plain = " ".join(text.split())
    texts = _helps()["texts"]
    if plain not in texts:
        for english, own in texts.items():
            around = map(re.escape, english.split("{names}"))
            if "{names}" in english and (found := re.fullmatch(rf"({_NAME}(?:, {_NAME})*)".join(around), plain)):
                return str(own).replace("{names}", found[1].replace(", ", _helps()["frame"]["comma"]))
    return str(texts.get(plain, plain))


def _record(text: str) -> str:
    """What is said of an option, with its default and whether it is required."""
    match = _EXTRA.match(text)
    if match is None:
        return translated(text)
    frame = _helps()["frame"]
    extra = _DEFAULT.sub(
        lambda found: f"{frame['default']}: {translated(found[2]) if found[2] else ''}", match["extra"].strip()
    )
    for english in ("required", "env var"):
        extra = re.sub(rf"\b{english}\b", frame[english], extra)
    return f"{translated(match['help'])}  {extra}".strip()


def _helps() -> Mapping[str, Any]:
    from reportgen.base.words import helps, spoken

    return helps(spoken())
