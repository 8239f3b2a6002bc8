"""Help in the current language: the texts of commands and options, and the words around them.

The commands have English texts; `help.yaml` of another language maps each of them to a translation. It is read only
when help is requested.
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
    "compare": "papers",
    "read": "reading",
    "variants": "variants",
    "batch": "papers",
    "key": "papers",
    "grade": "grading",
}
"""Documentation page for a command; others have the page of all commands."""
OTHERS = "commands"
_EXTRA = re.compile(r"^(?P<help>.*?)(?P<extra>(?:  |^)\[[^\[\]]*\])$", re.DOTALL)
_PYTHON_TYPE = re.compile(r" <[\w\[\]]+>$")
_NAME = r"[\w-]+"
_DEFAULT = re.compile(r"\bdefault: (\((.+?)\)(?=; |\]))?")


class _Spoken:
    """Common base of a command and the group of commands: help in the current language."""

    name: str | None
    help: str | None
    collect_usage_pieces: Callable[[Any], list[str]]
    get_params: Callable[[Any], list[Any]]

    def format_usage(self, ctx: Any, formatter: Any) -> None:
        """Write the usage line of the command."""
        frame = _helps()["frame"]
        pieces = " ".join(self.collect_usage_pieces(ctx))
        usage = re.sub(r"\w+", lambda piece: frame["pieces"].get(piece[0], piece[0]), pieces)
        formatter.write_usage(ctx.command_path, usage, prefix=f"{frame['usage']}: ")

    def format_help_text(self, ctx: Any, formatter: Any) -> None:
        """Write the description of the command."""
        for paragraph in (self.help or "").split("\n\n"):
            formatter.write_paragraph()
            with formatter.indentation():
                formatter.write_text(translated(paragraph))

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the arguments, then the options."""
        frame = _helps()["frame"]
        for kind, head in (("argument", "arguments"), ("option", "options")):
            if rows := described(self, ctx, kind):
                with formatter.section(frame[head]):
                    formatter.write_dl(rows)

    def format_epilog(self, ctx: Any, formatter: Any) -> None:
        """Write the reference to the documentation page."""
        page = PAGES.get(self.name or "", OTHERS)
        formatter.write_paragraph()
        formatter.write_text(_helps()["frame"]["more"].format(page=page))


class Command(_Spoken, TyperCommand):
    """A command whose help is in the current language."""

    def get_short_help_str(self, limit: int = 45) -> str:
        """Return the first sentence of the description."""
        return re.split(r"(?<=\.)\s", translated((self.help or "").split("\n\n")[0]))[0]


class Commands(_Spoken, TyperGroup):
    """The group of all commands; an unknown one is reported with the closest known one."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the options, then the commands."""
        super().format_options(ctx, formatter)
        rows = [(name, command.get_short_help_str()) for name, command in self.commands.items()]
        with formatter.section(_helps()["frame"]["commands"]):
            formatter.write_dl(rows)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Return the command that a line names; raise `BadParameter` for an unknown one."""
        if args[0] not in self.commands:
            import typer

            from reportgen.base.words import unknown

            raise typer.BadParameter(unknown("no_command", args[0], list(self.commands), None), ctx=ctx)
        return super().resolve_command(ctx, args)


def start() -> str:
    """Return the short introduction that is printed if no command is given."""
    return "\n".join(_helps()["start"])


def translated(text: str) -> str:
    """Return a text of the commands in the current language, or in English if it has no translation.

    A text with `{names}` in `help.yaml` matches any list of names in its place.
    """
    plain = " ".join(text.split())
    texts = _helps()["texts"]
    if plain not in texts:
        for english, own in texts.items():
            around = map(re.escape, english.split("{names}"))
            if "{names}" in english and (match := re.fullmatch(rf"({_NAME}(?:, {_NAME})*)".join(around), plain)):
                return str(own).replace("{names}", match[1].replace(", ", _helps()["frame"]["comma"]))
    return str(texts.get(plain, plain))


def described(command: Any, ctx: Any, kind: str) -> list[tuple[str, str]]:
    """Return the names and the help of each parameter of a kind, `argument` or `option`, in the current language."""
    records = [each.get_help_record(ctx) for each in command.get_params(ctx) if each.param_type_name == kind]
    # typer appends the Python type to an argument, which is meaningless to a user.
    return [(_PYTHON_TYPE.sub("", names), _record(text)) for names, text in filter(None, records)]


def _record(text: str) -> str:
    """Return the help of an option, with its default and whether it is required."""
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
